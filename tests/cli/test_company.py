"""``stylobate company``: what it writes of made-up runs, bad input, and what its shares and intervals come to."""

import itertools
import json

import numpy as np
import pandas
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate_studies.company import records, shares, study
from stylobate_studies.company.pictures import draw_shares


def made_up(falls=lambda structure, record, azimuth, level: level > 0.5):
    """Runs of all structures under nine records, decided by a rule."""
    rows = []
    count = {"alone": 1, "two": 2, "four in a row": 4, "corner": 3}
    levels = (0.4, 0.6, 0.8)
    for label, number, azimuth, level in itertools.product(study.STRUCTURES, range(9), study.AZIMUTHS, levels):
        down = bool(falls(label, number, azimuth, level))
        rows.append(
            {
                "structure": label,
                "record": f"record {number}",
                "azimuth_deg": azimuth,
                "pgv_m_s": level,
                "failed": False,
                "decided": True,
                "at_rest": True,
            }
            | {"columns": count[label], "columns_fallen": count[label] * down, "bodies_fallen": 3 * down}
        )
    return pandas.DataFrame(rows)


def test_the_same_columns_stand_in_every_structure():
    built = study.structures()
    assert [one.n for one in built.values()] == [3, 7, 15, 11]
    drums = {(stone.density, stone.mass) for one in built.values() for stone in one.stones if "drum 1" in stone.name}
    assert len({round(mass, 6) for _, mass in drums}) == 1


def test_what_shakes_along_one_line_is_turned_as_a_whole():
    t = np.arange(0.0, 1.0, 0.01)
    record = study.prepared(st.Motion(0.01, np.sin(t), name="one"))
    assert np.allclose(record.lateral, 0.01 * record.acceleration)
    across = study.directed(record, 90.0)
    assert np.allclose(np.abs(across.lateral), np.abs(record.acceleration))
    assert np.allclose(np.abs(across.acceleration), np.abs(record.lateral))


def test_no_difference_is_told_where_there_is_none():
    found = shares.summary(made_up())
    for kind, label in itertools.product(shares.KINDS, study.STRUCTURES):
        one = found[kind][label]
        assert one["share"] == pytest.approx(2.0 / 3.0)
        assert 0.4 <= one["median_m_s"] <= 0.6
        if label != "alone":
            against = one["against_alone"]
            assert (against["difference"], against["better"], against["worse"]) == (0.0, 0, 0)
            assert against["low"] < 0.0 < against["high"]


def test_a_difference_is_of_pairs_that_both_have_a_verdict():
    """Two under an architrave never fall; one of its 54 runs has no verdict, and its pair is left out."""
    table = made_up(lambda structure, record, azimuth, level: structure != "two" and level > 0.5)
    table.loc[table.index[table["structure"] == "two"][0], ["failed", "decided"]] = True, False
    one = shares.difference(table, "columns", "two", "alone")
    assert (one["pairs"], one["better"], one["worse"]) == (53, 36, 0)
    assert one["difference"] == pytest.approx(-36 / 53)
    assert one["low"] < one["difference"] < one["high"] < 0.0


def test_what_still_moves_and_has_not_fallen_is_left_out_and_counted():
    """Of 54 runs of the column alone one is undecided, and in one the fallen still move."""
    table = made_up()
    stands, fell = table.index[(table["structure"] == "alone") & (table["pgv_m_s"] == 0.4)][0], table.index[-1]
    table.loc[stands, ["decided", "at_rest"]] = False
    table.loc[fell, "at_rest"] = False
    found = shares.summary(table)
    assert (found["failed"], found["undecided"], found["fell_and_moving"]) == (0, 1, 1)
    assert found["columns"]["alone"]["share"] == pytest.approx(36 / 53)
    assert "0 failed and 1 are undecided" in shares.runs_told(found)


def test_files_of_the_command(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(records, "read_records", lambda folder: [])
    monkeypatch.setattr(study, "run", lambda found, levels, **others: made_up())
    assert call(["company", "--out", str(tmp_path / "out"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert {"columns", "anything", "runs", "failed", "records", "levels_m_s", "files"} <= set(told)
    assert {one.name for one in (tmp_path / "out").iterdir()} >= {"company.csv", "company.json", "company.png"}
    assert call(["company"]) == 0
    assert "Assemblies in space are new: where bodies strike one another" in capsys.readouterr().out
    assert [axes.get_xlabel() for axes in draw_shares(made_up()).axes] == ["PGV, largest of all directions [m/s]"] * 2


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["nowhere"], "nowhere is no folder; give one with the nine records, or leave it out for the samples"),
        (["."], "lacks 9 of the 9 records, csmip_v1_Northridge1994_LA116thSt.RAW among them"),
        (["--levels", "0.4;0.8"], "--levels is '0.4;0.8'; allowed are different numbers from 0.01 to 5 m/s"),
        (["--levels", "0.4,nan"], "--levels is '0.4,nan'; allowed"),
        (["--levels", "0.4,0.4"], "--levels is '0.4,0.4'; allowed"),
    ],
)
def test_bad_input_is_one_sentence(tmp_path, monkeypatch, capsys, arguments, says):
    monkeypatch.chdir(tmp_path)
    assert call(["company", *arguments, "--out", "out"]) == 2
    assert says in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
