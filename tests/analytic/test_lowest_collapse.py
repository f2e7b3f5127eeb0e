"""The lowest collapse over amplitudes: what is said first is never above what was seen, and bounds are told as bounds."""

import dataclasses
import json
import math
from types import SimpleNamespace

import numpy as np
import pytest

import stylobate as st
from stylobate import plots
from stylobate.campaign.twins import Twins
from stylobate.column.catalogue import preset
from stylobate.column.scatter import Scatter
from stylobate.verdicts.critical import (
    CriticalAmplitude,
    CriticalPopulation,
    CriticalSuite,
    as_recorded,
    sentence,
    sentence_of_suite,
)
from stylobate.verdicts.verdict import Capacity, of_levels, quantiles

COLUMN = preset("paper-monolithic")
AMPLITUDES = np.array([0.2, 0.3, 0.4, 0.5])
RECORD = st.Motion(0.01, 0.25 * st.g * np.sin(2.0 * np.pi * 0.01 * np.arange(200)), name="record.csv")


def row(verdict):
    fell = verdict == "collapsed"
    return {"outcome": "collapsed" if fell else "rocked", "collapsed": fell, "decided": verdict != "undecided"}


def verdicts(text):
    return [{"s": "stands", "c": "collapsed", "u": "undecided"}[letter] for letter in text]


def over(own, twins=(), motion=RECORD):
    """The column and its twins over four amplitudes, a letter for each verdict."""
    population = None
    if twins:
        codes = np.array([verdicts(word) for word in twins])
        population = CriticalPopulation(AMPLITUDES * st.g, codes, Twins((), Scatter(), 0, ()), motion.pga)
    rows = [row(verdict) for verdict in verdicts(own)]
    return CriticalAmplitude(COLUMN, motion, "dem2d", AMPLITUDES * st.g, rows, 1.0, motion.pga, population)


def test_what_is_known_of_a_capacity_is_two_levels_or_a_bound():
    assert of_levels([1.0, 2.0, 3.0], verdicts("ssc")) == (2.0, 3.0)
    assert of_levels([1.0, 2.0, 3.0], verdicts("usc")) == (0.0, 3.0)  # the undecided may be a collapse
    bounds = [of_levels([1.0, 2.0], verdicts(word)).bound() for word in ("sc", "cc", "ss", "us")]
    assert bounds == [None, "≤ 1", "> 2", "not known"]


def test_shares_of_capacities_are_between_those_of_their_ends():
    capacities = [Capacity(0.0, 1.0), Capacity(1.0, 2.0), Capacity(2.0, math.inf), Capacity(2.0, math.inf)]
    assert quantiles(capacities) == [(0.0, 1.0), (1.0, 2.0), (2.0, math.inf)]  # the first, second and fourth of four
    assert [capacity.bound() for capacity in quantiles(capacities)] == ["≤ 1", None, "> 2"]


def test_a_record_is_run_as_it_is_between_the_levels_of_the_grid():
    pulse = st.half_sine_pulse(0.5, 0.6 * st.g, 6.0)
    record = st.Motion(pulse.dt, pulse.samples * pulse.factor, name="r")
    assert st.simulate(COLUMN, record, st.HousnerBlock()).collapsed
    grid = 0.1 * record.pga, 1.6 * record.pga, 1.3 * record.pga  # 0.1 and 1.4 times the record
    result = st.critical_amplitude(COLUMN, record, st.HousnerBlock(), *grid)
    assert result.critical_factor == 1.0
    assert result.as_recorded == {"amplitude_g": record.pga / st.g, "verdict": "collapsed"}
    assert len(result.rows) == 3


def test_shares_of_columns_alike_say_what_the_undecided_leave_open():
    """Three of fifteen fall at 0.5 g and the others are undecided from 0.3 g on: 16 % fall by any amplitude from there."""
    result = over("sssc", ["ssuc"] * 3 + ["suuu"] * 12)
    summary = result.summary()
    assert summary["certainty"]["critical_16_least_g"] == pytest.approx(0.3)
    assert "fall 16 % by 0.3 to 0.5 g" in summary["sentence"]
    assert "whichever way the undecided end" in summary["sentence"]
    cured = dataclasses.replace(result, cure="go on with a tail of 130 s").summary()["sentence"]
    assert "ended far from rest (go on with a tail of 130 s)" in cured
    sure = over("sssc", ["sssc"] * 15).summary()
    assert "fall 16 % by 0.5 g, 50 % by 0.5 g, 84 % by 0.5 g." in sure["sentence"]
    assert sure["to_decide"] == ""


def test_the_first_number_is_the_lowest_collapse_of_all_columns():
    summary = over("sssc", ["sscc", "scsc", "ssss", "sssc"]).summary()
    assert (summary["critical_g"], summary["lowest_collapse_g"]) == pytest.approx((0.5, 0.3))
    assert summary["lowest_collapse_factor"] == pytest.approx(1.2)
    assert summary["sentence"].startswith(
        "Of 5 columns, this one and 4 like it, the first falls at 0.3 g, 1.2 times the record (the next below that was "
        "looked at is 0.2 g); of those like it fall 16 % by 0.3 g, 50 % by 0.4 g, 84 % only above 0.5 g. "
        "This one collapses at 0.5 g"
    )
    assert "--replicates" not in summary["sentence"]
    read_again = json.loads(json.dumps(summary).replace("Infinity", "null"))  # as a report finds it in its folder
    assert sentence(read_again) == summary["sentence"]


def test_no_single_amplitude_where_verdicts_alternate_and_none_below_what_has_no_verdict():
    assert "at 0.3 g, 1.2 times the record (" in (words := over("scsc").summary()["sentence"])
    assert "but stands again at 0.4 g: no single amplitude is its limit." in words
    assert "Runs below that without a verdict, which may be collapses: 1." in over("sucs").summary()["sentence"]


def test_what_has_no_verdict_is_no_collapse_of_a_column_alike():
    result = over("ssss", ["ussc", "usss"])  # nothing is decided at the first amplitude, so its share is not known
    assert math.isnan(result.population.probability[0])
    assert result.summary()["sentence"].startswith("Of 3 columns, this one and 2 like it, the first falls at 0.5 g")
    assert ". Runs below that without a verdict, which may be collapses: 2." in result.summary()["sentence"]
    assert over("usss").summary()["sentence"].startswith("No amplitude looked at, 0.2 to 0.5 g, surely collapses the")
    alike = over("ssus", ["sssc", "sssc"]).summary()["sentence"]
    assert (
        "84 % by 0.5 g. Runs below that without a verdict, which may be collapses: 1. No amplitude looked at" in alike
    )
    assert "No amplitude looked at, 0.2 to 0.5 g, surely collapses this one; larger ones" in alike
    assert "0.5 g, collapses this one" in over("ssss", ["sssc", "sssc"]).summary()["sentence"]


def test_only_amplitudes_that_stand_bound_what_is_not_seen():
    assert over("uccc").bounds["all_collapse_above_g"] == "≤ 0.3"
    assert over("ssus").bounds["all_collapse_above_g"] == "> 0.5"
    assert over("sssu").bounds["all_collapse_above_g"] == "> 0.4"
    assert over("uuuu").bounds["all_collapse_above_g"] == "not known"
    assert over("sssc", ["uscc", "ssss"]).bounds["lowest_collapse_g"] == "≤ 0.4"  # the undecided may be the lowest


def test_the_next_lower_amplitude_is_told_of_both_grids():
    codes = np.array([verdicts("sc"), verdicts("ss")])
    population = CriticalPopulation(AMPLITUDES[[0, 3]] * st.g, codes, Twins((), Scatter(), 0, ()), RECORD.pga)
    summary = dataclasses.replace(over("sssc"), population=population).summary()
    both = "(the next below that was looked at is 0.4 g, for those like it 0.2 g)"
    assert f"first falls at 0.5 g, 2 times the record {both}" in summary["sentence"]


def test_motions_of_a_record_are_told_apart_from_records_and_what_is_undecided_is_told():
    critical_result = pytest.importorskip("stylobate_report.critical").critical_result
    both = [RECORD.replace(name=f"a {k}", metadata={"direction": {"record": "a", "azimuth": 90.0 * k}}) for k in (0, 1)]
    suite = CriticalSuite((over("succ", ["sssc"], both[0]), over("ssss", ["scsu"], both[1])), 1.0)
    summary = suite.summary()
    assert summary["sentence"] == (
        "1 of 2 motions of 1 record collapse the column at some peak looked at, 0.2 to 0.5 g, 2 it or one like it. Most "
        "harm: a 1, which collapses it or one like it at 1.2 times the record, 0.3 g, the smallest factor at which any "
        "does. 1 of 8 runs ended far from rest (a longer tail may decide them); 1 run of those like it ended far from rest "
        "(a longer tail may decide them): not counted as collapse."
    )
    assert (summary["lowest_collapse_g"], summary["lowest_collapse_factor"]) == pytest.approx((0.3, 1.2))
    assert suite.compass.values.tolist() == pytest.approx([1.6, 1.2])  # as the sentence, not of the column alone
    assert suite.runs["record"].tolist() == ["a"] * 8
    assert suite.runs["motion"].tolist() == ["a 0"] * 4 + ["a 1"] * 4
    (_, _), (_, table) = critical_result(SimpleNamespace(summary=summary, structures=[], pictures={}))
    shown = [dict(zip(table.header, row)) for row in table.body]
    assert [cells["lowest collapse factor"] for cells in shown] == ["1.6", "1.2"]
    assert [cells["undecided"] for cells in shown] == ["1", "0"]
    none = CriticalSuite((over("ssus"), over("ssss", motion=both[1])), 1.0).summary()["sentence"]
    assert none.startswith("No record surely collapses the column at a peak looked at, 0.2 to 0.5 g. 1 of 8 runs ended")


def test_what_is_undecided_under_another_motion_may_be_a_smaller_factor():
    """The smallest factor was told as that of all motions, with what is undecided under its own motion alone."""
    suite = CriticalSuite((over("sssc"), over("suuu", motion=RECORD.replace(name="other.csv"))), 1.0).summary()
    assert suite["open_below"] == 2  # at 0.3 and 0.4 g
    assert (
        "0.5 g, the smallest factor at which any surely does. Runs below that factor without a verdict, which may be "
        "collapses: 2."
    ) in suite["sentence"]


def test_bounds_are_told_as_bounds():
    low = over("cccc", ["cccc", "cccc", "sccc"]).summary()
    at = dict.fromkeys(("critical_g", "all_collapse_above_g", "lowest_collapse_g"), "≤ 0.2")
    assert low["bounds"] == at | dict.fromkeys(("critical_factor", "lowest_collapse_factor"), "≤ 0.8")
    assert low["certainty"]["bounds"] == {"critical_16_g": "≤ 0.2", "critical_50_g": "≤ 0.2"}
    assert "16 % at 0.2 g or below" in low["sentence"]
    suite = CriticalSuite((over("ssss", ["ssss"]), over("sccc", ["cccc"], RECORD.replace(name="other.csv"))), 1.0)
    first, second = suite.summary()["records"]
    assert first["bounds"]["critical_50_g"] == "> 0.5"
    shares = dict.fromkeys(("critical_16_g", "critical_50_g", "critical_84_g"), "≤ 0.2")
    assert second["bounds"] == {"lowest_collapse_g": "≤ 0.2", "lowest_collapse_factor": "≤ 0.8"} | shares
    assert suite.table["bounds"].tolist()[1].endswith("critical_16_g ≤ 0.2; critical_50_g ≤ 0.2; critical_84_g ≤ 0.2")
    assert "1 of 2 records collapse the column" in (words := sentence_of_suite(suite.summary()))
    assert "which collapses it or one like it already at 0.8 times the record" in words


def test_the_report_has_the_shares_of_the_columns_alike():
    critical_result = pytest.importorskip("stylobate_report.critical").critical_result
    summary = over("sssc", ["sscc", "scsc", "ssss", "sssc"]).summary()
    folder = SimpleNamespace(summary=json.loads(json.dumps(summary)), structures=[], pictures={})
    (words, _), (_, facts, table, *_) = critical_result(folder)
    assert words == summary["sentence"]
    assert dict(facts.pairs) == {
        f"{share} % of 4 columns like this one have fallen by": at
        for share, at in ((16, "0.3 g"), (50, "0.4 g"), (84, "> 0.5 g"))
    }
    assert table.body[1] == ["0.3", "1.2", "1", "3", "0", "0", "25 %", "5 to 70 %"]  # Wilson's interval for 1 of 4
    records = CriticalSuite((over("ssss", ["ssss"]),), 1.0).summary()
    (_, _), (_, table) = critical_result(SimpleNamespace(summary=records, structures=[], pictures={}))
    assert dict(zip(table.header, table.body[0]))["critical 50 [g]"] == "> 0.5"


def test_what_is_undecided_is_told_beside_the_share_of_the_columns_alike():
    critical_result = pytest.importorskip("stylobate_report.critical").critical_result
    record = st.Motion(0.01, 0.2 * st.g * np.sin(2.0 * np.pi * 0.01 * np.arange(200)), name="record.csv")
    record = record.scaled_to_pga(0.2 * st.g)
    result = over("ussc", ["ussc"] * 13 + ["sscc"] * 2, record)
    own = dict(result.as_recorded)
    assert (own["twins_undecided"], own["twins_stands"]) == (13, 2)
    words = "undecided; those like it that collapse: 0 to 87 % of 15 (0 to 96 %); 13 undecided"
    assert as_recorded(own) == f"0.2 g: {words}"
    items = critical_result(SimpleNamespace(summary=json.loads(json.dumps(result.summary())), pictures={}))[1]
    assert words in str(items[0])
    (table,) = [item for item in items if "undecided" in getattr(item, "header", ())]
    assert table.body[0][2:] == ["0", "2", "13", "0", "0 to 87 %", "0 to 96 %"]
    assert table.body[1][2:] == ["0", "15", "0", "0", "0 %", "0 to 20 %"]
    axes = plots.draw_collapse_over_amplitude(result.population).axes[0]
    (line,) = axes.lines
    assert list(line.get_ydata()) == pytest.approx([np.nan, 0.0, 2 / 15, 1.0], nan_ok=True)
    (bar,) = axes.collections[1].get_segments()  # behind the band
    assert bar[:, 1] == pytest.approx([0.0, 13 / 15])
