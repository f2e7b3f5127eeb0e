"""JSON schemas of files: what the readers take validates, what they do not know does not."""

import datetime
import json
import re
import tomllib
from pathlib import Path

import pytest

import stylobate as st
from stylobate import added
from stylobate.cli.main import call
from stylobate.cli.schema import schemas
from stylobate.column.catalogue import PRESETS
from stylobate.column.files import tables_of
from stylobate.column.tables import describes_assembly

jsonschema = pytest.importorskip("jsonschema", reason="needs jsonschema")
ROOT = Path(__file__).parents[2]

#: Examples in the documentation by their page: the kind of file that they are of, or parts of.
PAGES = {
    "reference/column_files": "column",
    "start/getting_started": "column",
    "theory/links": "column",
    "reference/assembly_files": "assembly",
    "how_to/studies": "study",
    "how_to/back_analysis": "ruin",
    "how_to/report": "project",
}


def faults(kind, result, part=False):
    """Why a file is none of that kind; ``part`` of a file may lack what the others hold."""
    validator = jsonschema.Draft202012Validator(schemas()[kind])
    errors = validator.iter_errors(json.loads(json.dumps(result, default=str)))
    return [item.message for item in errors if not (part and item.validator == "required" and not item.absolute_path)]


def kind_of(result):
    """Kind of a whole file by its keys, as the commands that take several tell them apart."""
    if "motions" in result or "frequencies" in result:
        return "study"
    if "observed" in result or "prior" in result:
        return "ruin"
    return "assembly" if describes_assembly(result) else "column"


def examples():
    """Files of the gallery and of the studies, by their kind."""
    for folder in ("gallery", "studies/src"):
        for path in sorted((ROOT / folder).rglob("*.toml")):
            result = tomllib.loads(path.read_text(encoding="utf-8"))
            if "branches" not in result:  # of several sites, of which there is no schema
                yield pytest.param(kind_of(result), result, id=path.name)
    for path in sorted((ROOT / "gallery").glob("*.py")):
        for number, text in enumerate(re.findall(r'"""\\?\n(\w+ = .*?)"""', path.read_text(encoding="utf-8"), re.S)):
            try:
                result = tomllib.loads(text)
            except tomllib.TOMLDecodeError:  # no file
                continue
            yield pytest.param(kind_of(result), result, id=f"{path.name} {number + 1}")


def pages():
    """Files in the documentation, and parts of some."""
    for page, kind in PAGES.items():
        text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
        for number, block in enumerate(re.findall(r"^```toml\n(.*?)^```", text, re.S | re.M)):
            if "branches" not in block:
                yield pytest.param(kind, block, id=f"{page} {number + 1}")


@pytest.mark.parametrize("name", PRESETS)
def test_presets(name):
    assert faults("column", tables_of(st.preset(name))) == []


@pytest.mark.parametrize(("kind", "result"), list(examples()))
def test_files_of_the_gallery(kind, result):
    assert faults(kind, result) == []


@pytest.mark.parametrize(("kind", "block"), list(pages()))
def test_examples_of_the_documentation(kind, block):
    assert faults(kind, tomllib.loads(block), part=True) == []


def tables(result, path=()):
    """All tables of a file with their paths, but those of free keys."""
    if isinstance(result, dict):
        if path[-1:] != ("set",):
            yield result, path
            for key, item in result.items():
                yield from tables(item, (*path, key))
    elif isinstance(result, list):
        for number, item in enumerate(result):
            yield from tables(item, (*path, number))


WHOLE = {
    "column": tables_of(st.preset("trajan")) | {"as_found": {"drum": [{"index": 1, "offset": 0.01}]}},
    "assembly": {
        "joint": {"normal_stiffness": 1e9}, "block": [{"box": [1.0, 1.0, 1.0]}],
        "column": [{"file": "a.toml", "at": [[0.0, 0.0]]}],
    },
    "study": {"column": "trajan", "model": "dem2d", "motions": {"files": ["a"]}, "scale": {"levels": [1.0]}},
    "ruin": {"columns": ["trajan"], "prior": {"pgv": ["0.1m/s", "1m/s"]}, "observed": [{"column": "trajan"}]},
    "project": {"client": "a", "site": "b", "engineer": "c", "date": datetime.date(2026, 1, 2)},
}  # fmt: skip


@pytest.mark.parametrize("kind", WHOLE)
def test_a_mistyped_key_does_not_validate(kind):
    result = WHOLE[kind]
    assert faults(kind, result) == []
    for table, path in tables(result):
        table["namee"] = "x"
        assert faults(kind, result) != [], path
        del table["namee"]
    assert set(WHOLE) == set(schemas())


@pytest.mark.parametrize(
    ("kind", "changes"),
    [
        ("column", {"north": "12"}),
        ("column", {"section": "round"}),
        ("column", {"link": [{"kind": "dowl", "joint": 1}]}),
        ("assembly", {"link": [{"kind": "dowl", "between": ["a", "b"]}]}),
        ("ruin", {"observed": [{"column": "trajan", "state": "fallen"}]}),
        ("column", {"drum": {"height": 1.0}}),
        ("study", {"motions": {"files": "one"}}),
        ("ruin", {"prior": {}, "simulations": 1.5}),
        ("project", {"site": 3}),
    ],
)
def test_a_value_of_another_type_or_an_unknown_word_does_not_validate(kind, changes):
    assert faults(kind, WHOLE[kind] | changes) != []


def test_what_is_needed_is_said():
    assert any("'engineer' is a required" in item for item in faults("project", {"client": "a", "site": "b"}))
    assert faults("column", {"drum": [{"height": 1.0, "bottom_width": 1.0}]}) != []


def test_the_command_writes_and_prints_them(tmp_path, capsys):
    assert call(["schema", "--out", str(tmp_path / "schemas")]) == 0
    assert {path.name for path in (tmp_path / "schemas").glob("*.json")} == {f"{kind}.schema.json" for kind in WHOLE}
    assert json.loads((tmp_path / "schemas" / "study.schema.json").read_text()) == schemas()["study"]
    capsys.readouterr()
    assert call(["schema", "column"]) == 0
    assert json.loads(capsys.readouterr().out) == schemas()["column"]
    assert call(["schema", "--json"]) == 0
    assert set(json.loads(capsys.readouterr().out)["schemas"]) == set(WHOLE)
    assert call(["schema", "colum"]) == 2
    assert "did you mean column?" in capsys.readouterr().err


def test_kinds_of_packages_that_are_not_installed_are_named(tmp_path, capsys, monkeypatch):
    """The core's wheel alone reads column, assembly and study files; it says which packages read the others."""
    own = [entry for entry in added.entry_points(added.SCHEMAS) if entry.value.startswith("stylobate.")]
    monkeypatch.setattr(added, "entry_points", lambda group: own)
    assert call(["schema", "--out", str(tmp_path / "schemas")]) == 0
    printed = capsys.readouterr().out
    for kind, package in (("project", "stylobate-report"), ("ruin", "stylobate-ruins")):
        assert f"Not here: {kind} files are read by {package}, which is not installed here; " in printed
        assert call(["schema", kind]) == 2
        assert f"{kind} files are read by {package}, which is not installed here; " in capsys.readouterr().err
