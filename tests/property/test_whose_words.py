"""Messages name parameters in backticks, and no options: only the command line knows these."""

import ast
import pickle
import re
from functools import cache

import pytest
from sources import sources

import stylobate as st
from stylobate.cli import console, main
from stylobate.column.tables import made_of
from stylobate.errors import PARAMETER, InputError, check_range, reworded, within

OPTION = re.compile(r"(?<![\w-])--[a-z]")

#: What makes the command line of a browser.
COMMAND_LINES = {"stylobate_report/page.py"}


@cache
def texts():
    """Every text below the command line but docstrings, with its file; names stand for what is filled in."""
    named_texts = []
    for name, path in sources("py"):
        if name.startswith("stylobate/cli/") or "/commands/" in name or name in COMMAND_LINES:
            continue
        nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
        described = {
            id(node.value) for node in nodes if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        }
        for node in nodes:
            if isinstance(node, ast.JoinedStr):
                parts = [str(part.value) if isinstance(part, ast.Constant) else "X" for part in node.values]
                named_texts.append((name, "".join(parts)))
            elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in described:
                named_texts.append((name, node.value))
    return named_texts


def test_no_message_below_the_command_line_names_an_option():
    assert len(texts()) > 5000
    assert [entry for entry in texts() if OPTION.search(entry[1])] == []


def test_every_parameter_in_a_message_is_given_by_an_option():
    options = {
        option
        for command in [*main.commands().commands.values(), *main.commands().commands["study"].commands.values()]
        for parameter in command.params
        for option in parameter.opts
    }
    named = {match[1] for name, text in texts() if name != "stylobate/errors.py" for match in PARAMETER.finditer(text)}
    assert len(named) > 20
    assert {parameter for parameter in named if console.in_options(f"`{parameter}`") not in options} == set()


@pytest.mark.parametrize(
    ("message", "options", "keys"),
    [
        ("`scale` and `pga` are both given.", "--scale and --pga are both given.", "scale and pga are both given."),
        ("give `files=FILE`.", "give --motion FILE.", "give files FILE."),
        ("`dt=0.01` or `unit='g'`", "--dt 0.01s or --unit g", "dt 0.01s or unit g"),
        ("`until_end` of ``x`` and `X`", "--until-end of ``x`` and `X`", "until_end of ``x`` and `X`"),
    ],
)
def test_the_reader_of_a_message_has_his_own_words(message, options, keys):
    assert console.in_options(InputError(message)) == options
    assert reworded(message, str) == keys
    assert str(InputError(message)) == message


def test_an_error_knows_field_value_range_and_remedy_and_keeps_them():
    with pytest.raises(InputError) as caught, within("my.toml"), within("[[drum]] number 3", "drum", 3):
        check_range("height", -1.0, 0.0, 2.0, unit="m", of="a drum", remedy="use `scale`")
    copy = pickle.loads(pickle.dumps(caught.value))
    for error in (caught.value, copy):
        assert str(error) == "my.toml: [[drum]] number 3: height of a drum is -1 m; allowed is [0, 2] m; use scale."
        assert (error.field, error.value, error.allowed, error.remedy) == (
            "drum.3.height",
            -1.0,
            "[0, 2] m",
            "use `scale`",
        )


def test_errors_of_columns_carry_their_fields_in_python_as_from_files():
    """Fields of a drum, of one as found, of a joint and of a link, wherever the column comes from."""
    drum, joint = st.Drum(1.0, 0.5, 0.5, 2000.0), st.Joint(1e10, 1e10, friction_angle=35.0)
    column = st.Column.of_drums([drum, drum], joint)
    tables = {"drum": [{"height": 1.0, "bottom_width": 0.5, "top_width": 0.5}] * 2, "density": 2000.0} | {
        "joint": {"normal_stiffness": 1e10, "shear_stiffness": 1e10, "friction_angle": 35.0}
    }
    dowel = {"kind": "dowel", "joint": 9, "diameter": 0.03, "embedment": 0.1, "material": "titanium"}
    for made, field in (
        (lambda: st.Drum(-1.0, 0.5, 0.5, 2000.0), "height"),
        (lambda: st.Joint(1e10, 1e10, friction_angle=100.0), "friction_angle"),
        (lambda: st.FoundDrum(2, tilt=80.0), "found.2.tilt"),
        (lambda: column.replace(as_found=st.AsFound((st.FoundDrum(2, offset=0.6),))), "found.2.offset"),
        (
            lambda: column.replace(links=(st.Dowel(joint=9, diameter=0.03, embedment=0.1, material="titanium"),)),
            "link.1.joint",
        ),
        (lambda: made_of(st.Column, tables | {"drum": [tables["drum"][0], {"height": "x"}]}), "drum.2.height"),
        (lambda: made_of(st.Column, tables | {"as_found": {"drum": [{"index": 2, "tilt": "x"}]}}), "found.2.tilt"),
        (lambda: made_of(st.Column, tables | {"as_found": {"base_tilt": "x"}}), "base_tilt"),
        (
            lambda: made_of(st.Column, tables | {"joint_override": [{"index": 2, "cohesion": -1.0}]}),
            "override.2.cohesion",
        ),
        (lambda: made_of(st.Column, tables | {"link": [dowel | {"at": "x"}]}), "link.1.at"),
        (lambda: made_of(st.Column, tables | {"link": [dowel]}), "link.1.joint"),
    ):
        with pytest.raises(InputError) as caught:
            made()
        assert caught.value.field == field, caught.value
