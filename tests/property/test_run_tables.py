"""Tables of runs of other programs: read whole and as they are meant, or refused with the line and the remedy."""

import numpy as np
import pandas
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.codes.records import facts_of_records
from stylobate.errors import InputError, as_typed
from stylobate.probability.evidence import evidence, read_table, scaled_to
from stylobate.probability.risk import read_hazard

GOOD = "record,im,collapsed\na,0.5,0\na,1.0,\nb,0.5,1\n"


def read(path, text, encoding="utf-8"):
    path.write_bytes(text.encode(encoding))
    runs = evidence(read_table(path), "pgv")
    return [*zip(runs.records.tolist(), runs.im.tolist(), runs.codes.tolist(), strict=True)]


@pytest.mark.parametrize(
    "text",
    [
        GOOD,
        "\ufeff" + GOOD,
        GOOD.replace(",", ";"),
        GOOD.replace(",", "\t"),
        GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\r"),
        GOOD.replace("record,im", "Record, IM"),
        GOOD.replace("a,0.5", '"a", "0.5"'),
        GOOD.replace("\na,1", "\n\n,,\na,1"),
        "# of another program, 0,5\n" + GOOD,
        "record,note,im,collapsed,\na,x,0.5,0,\na,\"1,5\",1.0,NaN,\nb,,0.5,true,\n",
    ],
)  # fmt: skip
def test_dialects_are_the_same_table(tmp_path, text):
    assert read(tmp_path / "runs.csv", text) == [("a", 0.5, 0), ("a", 1.0, -1), ("b", 0.5, 1)]


def test_names_of_records_stay_as_they_are(tmp_path):
    names = ["01", "1", "1.0", "#7", "a#b", "nan", "NA", "x, y", "1e3"]
    rows = "".join(f'"{name}",0.5,1\n' for name in names)
    assert [record for record, _, _ in read(tmp_path / "runs.csv", "record,im,collapsed\n" + rows)] == names


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (
            GOOD.replace("0.5", "0,5"),
            r"line 2 of .* has 4 fields where the header names 3: 'a,0,5,0'; .* decimal points",
        ),
        (GOOD.replace(",", ";").replace("0.5", "0,5"), r"'0,5'.*decimal points"),
        (GOOD + "b,0.7\n", r"line 5 of .* has 2 fields .* an empty field needs its separator"),
        (GOOD + "b,0.7,1,\n", "line 5 of .* has 4 fields"),
        (GOOD + "# the end\n", "comments stand above the header"),
        (GOOD.replace("im,", "im,im,").replace("0.5", "0.5,0.5").replace("1.0", "1,1"), "two columns called 'im'"),
        (GOOD.replace("\nb,", "\n,"), "run 3 of runs has no record"),
        (GOOD.replace("b,0.5", 'b,"0.5'), "line 4 of .* is no row of a table"),
        (GOOD.replace("1.0", '"1,234.5"'), "'1,234.5'; allowed is a number from 0 .*nothing between thousands"),
        (GOOD.replace("1.0", "-1"), "is '-1.0'; allowed is a number from 0"),
        (GOOD.replace("b,0.5", "b,0"), "run 3 of runs exceeds collapse at an intensity 'im' of 0"),
        ("r0,0.5,1\n", "no column 'record'; its first line is 'r0,0.5,1'"),
        ("record,im,collapsed,\na,0.5,1,7\n", "line 2 .* a column without a name"),
        (
            "record,im,verdict\na,0.5,collapse\n",
            "'verdict' of a run of runs is 'collapse'; allowed is stands, collapsed",
        ),
        ("record,collapsed,im,note\na,0,1,45\nb,1,2,3\n", "whole numbers only as im and as 'note' behind it"),
        ("record,im,outcome\na,0.5,collapsed\n", "no column 'decided'"),
        ("record,im,outcome,decided,collapsed\na,0.5,fell,1,1\n", "'outcome' of a run of runs is 'fell'"),
    ],
)
def test_what_is_not_understood_is_refused(tmp_path, text, why):
    with pytest.raises(InputError, match=why) as error:
        read(tmp_path / "runs.csv", text)
    assert "np." not in str(error.value)


def test_other_encodings_are_read_or_named(tmp_path):
    text = GOOD.replace("b,", "Kalamáta,")
    for encoding in ("utf-8", "utf-16", "latin-1"):
        assert "Kalamáta" in {record for record, *_ in read(tmp_path / "runs.csv", "sep=,\n" + text, encoding)}
    with pytest.raises(InputError, match="is no text"):
        read(tmp_path / "runs.csv", text, "utf-16-le")


def test_runs_over_two_intensities_are_refused():
    table = pandas.DataFrame({"record": ["a", "b"], "im": [0.1, 0.2], "measure": ["pgv", "pga"]})
    with pytest.raises(InputError, match=r"different intensities \(pgv, pga\)"):
        scaled_to(table)


def test_decimal_commas_in_a_hazard_curve_and_in_facts_of_records(tmp_path):
    path = tmp_path / "site.csv"
    path.write_text("im_g,annual_rate\n0,1,0,01\n0,2,0,001\n")
    with pytest.raises(InputError, match=r"line 2 of .* has 4 fields where the header names 2"):
        read_hazard(path)
    path.write_text("record,magnitude,distance_km\na,6,5,20\n")
    with pytest.raises(InputError, match=r"line 2 of .* has 4 fields where the header names 3"):
        facts_of_records(path, [], [])
    path.write_text("record,magnitude\na,six\n")
    with pytest.raises(InputError, match="'six' as magnitude"):
        facts_of_records(path, [], [])
    path.write_text("record,magnitude,distance_km\n01,6.5,\n")
    facts = facts_of_records(path, [], [])["01"]
    assert facts["magnitude"] == 6.5
    assert np.isnan(facts["distance_km"])


def test_commands_say_it_in_one_sentence(tmp_path, capsys):
    path = tmp_path / "runs.csv"
    rows = "".join(f"r{k},{x},{int(x > 0.5)}\n" for k in range(12) for x in (0.2, 0.4, 0.6))
    path.write_text("record,im,collapsed\n" + rows)
    assert call(["fragility", str(path), "--im", "pgv"]) == 0
    output = capsys.readouterr().out
    assert "half of the records bring collapse at pgv between 0.4 and 0.6 m/s" in output
    assert "not seen in these runs (95 %: up to 0." in output
    (alone := tmp_path / "alone.csv").write_text("record,pgv_m_s,collapsed\n" + rows)
    assert call(["fragility", str(alone)]) == 0  # its one intensity is called after its measure
    assert capsys.readouterr().out.replace("alone:", "runs:") == output
    path.write_text(path.read_text().replace("0.4", "0,4"))
    assert call(["fragility", str(path), "--im", "pgv"]) == 2
    output = capsys.readouterr()
    assert (output.out, output.err.count("\n")) == ("", 1)
    assert "line 3 of" in output.err


@pytest.mark.parametrize(
    ("refused", "shown"),
    [
        (
            lambda: st.Joint(1e9, 1e9, friction_angle=np.float64(30.0), friction_coefficient=np.float64(0.5)),
            "= 30.0 and",
        ),
        (lambda: st.DistinctElement2D(points=np.int64(1)), "points is 1;"),
        (lambda: st.Start(tilt=0.1, angular_velocity=(np.float64(1.0), np.float64(2.0))), r"is \(1.0, 2.0\)"),
        (lambda: evidence(pandas.DataFrame({"record": ["a"], "im": [-0.5], "collapsed": [1]})), "is '-0.5'"),
    ],
)
def test_numbers_of_numpy_are_shown_as_numbers(refused, shown):
    with pytest.raises(InputError, match=shown) as error:
        refused()
    assert "np." not in str(error.value)


def test_as_typed():
    assert as_typed([np.float64(1.5), (np.int64(2), np.str_("x")), None]) == "[1.5, (2, 'x'), None]"
