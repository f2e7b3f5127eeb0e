"""Records in the paper's study: columns in company, and all models under real motions; on made-up runs and tiny ones."""

import itertools

import numpy as np
import pandas
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate_studies.paper import announced, motions
from stylobate_studies.paper.cases import DEM, MONOLITH
from stylobate_studies.paper.company import shares, study
from stylobate_studies.paper.pictures.company import draw_shares
from stylobate_studies.paper.sentences import FAILS, HOLDS, PARTLY, UNDECIDED

NAMES = [structure.name for structure in study.structures()]
COLUMNS = dict(zip(NAMES, (1, 2, 4, 3), strict=True))


def made_up(falls=lambda structure, record, level: level > 0.5):
    """Runs of all structures under nine records in two directions, decided by a rule."""
    rows = []
    for name, number, azimuth, level in itertools.product(NAMES, range(9), study.AZIMUTHS, (0.4, 0.6, 0.8)):
        down = bool(falls(name, number, level))
        rows.append(
            {
                "structure": name,
                "record": f"record {number}",
                "azimuth_deg": azimuth,
                "pgv_m_s": level,
            }
            | {"failed": False, "open": False, "at_rest": True, "columns": COLUMNS[name]}
            | {"columns_fallen": COLUMNS[name] * down, "bodies_fallen": 3 * down}
        )
    return pandas.DataFrame(rows)


def test_the_same_columns_stand_in_every_structure():
    assert [structure.n for structure in study.structures()] == [3, 7, 15, 11]
    drums = {
        (stone.density, round(stone.mass, 6))
        for structure in study.structures()
        for stone in structure.stones
        if "drum 1" in stone.name
    }
    assert len(drums) == 1


def test_what_shakes_along_one_line_is_turned_as_a_whole():
    t = np.arange(0.0, 1.0, 0.01)
    record = st.Motion(0.01, np.sin(t), name="line")
    assert np.allclose(study.directed(record, 0.0).lateral, 0.01 * record.acceleration)
    across = study.directed(record, 90.0)
    assert np.allclose(np.abs(across.lateral), np.abs(record.acceleration))


def test_rows_of_runs_tell_columns_from_architraves():
    """A pulse that overturns everything: each column has lost a drum, and more than drums has fallen."""
    t = np.arange(0.0, 1.0, 0.01)
    record = st.Motion(0.01, 9.0 * np.sin(np.pi * t), name="pulse")
    small_study = st.Study(study.structures()[:2], [study.directed(record, 0.0)], (study.MODEL,), tail=1.0)
    table = study.falls(st.run_study(small_study))
    assert table["columns_fallen"].tolist() == [1, 2]
    assert table["bodies_fallen"].tolist() == [3, 7]
    assert table["azimuth_deg"].tolist() == [0.0, 0.0]
    assert not table["open"].any()


def test_no_difference_is_told_where_there_is_none():
    made = shares.summary(made_up())
    for kind, name in itertools.product(shares.KINDS, NAMES):
        row = made[kind][name]
        assert row["share"] == pytest.approx(2.0 / 3.0)
        assert 0.4 <= row["median_m_s"] <= 0.6
        if name != NAMES[0]:
            against = row["against_alone"]
            assert (against["difference"], against["better"], against["worse"]) == (0.0, 0, 0)
            assert against["low"] < 0.0 < against["high"]
    assert announced.company_statement(made).verdict.kind == UNDECIDED


@pytest.mark.parametrize(("safe", "verdict"), [(NAMES[1:], HOLDS), (NAMES[1:2], PARTLY), (NAMES[:1], FAILS)])
def test_the_sentence_holds_as_far_as_intervals_tell(safe, verdict):
    made = shares.summary(made_up(lambda name, record, level: name not in safe and level > 0.5))
    assert announced.company_statement(made | {"records": 10}).verdict.kind == verdict
    assert announced.company_statement(made).verdict.kind == UNDECIDED  # nine records


def test_a_difference_is_of_pairs_that_both_have_a_verdict():
    """Two under an architrave never fall; one of its 54 runs failed, one is undecided, and their pairs are left out."""
    table = made_up(lambda name, record, level: name != "two" and level > 0.5)
    mine = table.index[table["structure"] == "two"]
    table.loc[mine[0], "failed"] = True
    table.loc[mine[3], "open"] = True
    row = shares.difference(table, "columns", "two", "alone")
    assert (row["pairs"], row["better"], row["worse"]) == (52, 36, 0)
    assert row["difference"] == pytest.approx(-36 / 52)
    assert row["low"] < row["difference"] < row["high"] < 0.0
    assert "1 failed and 1 are undecided" in shares.runs_in_words(shares.summary(table))


def test_the_table_of_companies_and_their_picture():
    made = shares.summary(made_up())
    header, body = shares.share_rows(made, "columns")
    assert [len(row) for row in body] == [len(header)] * 4
    assert body[0][3] == ""
    assert body[1][4] == "0, 0"
    assert [axes.get_xlabel() for axes in draw_shares(made_up()).axes] == ["PGV, largest of all directions [m/s]"] * 2


def test_all_models_under_a_record(tmp_path, monkeypatch):
    """A pulse that overturns the monolith by distinct elements in the plane at its largest level, and by itself agrees."""
    monkeypatch.setattr(motions, "TAIL", 0.5)
    t = np.arange(0.0, 1.2, 0.01)
    pulse = st.Motion(0.01, np.sin(2.0 * np.pi * t / 1.2), lateral=0.01 * np.sin(2.0 * np.pi * t / 1.2), name="pulse")
    result = motions.motions_piece(tmp_path / "motions", [pulse], 2, None)
    header, body = announced.motions_rows(result)
    assert len(body) == 2 * len(motions.COMPARED)
    assert {len(row) for row in body} == {len(header)}
    assert all(row[2] == "3" for row in body)
    assert motions.against(result, MONOLITH, DEM)[0].all()
    row = announced.motions_statement(result)
    assert row.verdict.kind in (HOLDS, PARTLY, FAILS)
    assert "nan" not in row.ours


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (
            ["--records", "nowhere"],
            "nowhere is no folder; give one with the nine records, or leave it out for the samples",
        ),
        (["--records", "."], "lacks 9 of the 9 records, csmip_v1_Northridge1994_LA116thSt.RAW among them"),
        (["--records", ".", "--quick"], "--quick takes no records; leave one of --quick and --records out"),
    ],
)
def test_bad_records_are_refused_before_anything_is_computed(tmp_path, monkeypatch, capsys, arguments, says):
    monkeypatch.chdir(tmp_path)
    assert call(["reproduce", *arguments, "--out", "out"]) == 2
    assert says in capsys.readouterr().err
    assert not list(tmp_path.rglob("*.nc"))
