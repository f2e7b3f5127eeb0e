"""States side by side: of the same runs, undecided ones as an interval, and advice that reads in one way only."""

import dataclasses
import math

import numpy as np
import pytest

import stylobate as st
from stylobate.probability.evidence import Evidence, evidence
from stylobate.probability.fragility import FEWEST, fragility
from stylobate.probability.states import INCONCLUSIVE, STRONGER, WEAKER, Difference, reference, with_undecided
from stylobate.probability.suite import suite_table
from stylobate.verdicts.directions import compass_of_shares
from stylobate.verdicts.limit_states import EXCEEDED, FAILED, NOT_EXCEEDED, OPEN, codes_of, median_words, shares
from stylobate.verdicts.verdict import VERDICTS, wilson_interval


def runs(name, *codes):
    """A run of each record."""
    records = np.array([f"record {k}" for k in range(len(codes))], dtype=object)
    return Evidence(records, np.ones(len(codes)), np.array(codes, dtype=np.int8), "im", "-", "collapse", name)


def difference(first, other):
    return with_undecided(first, other, None, None, 200, 0, 0.95)


def test_runs_that_one_state_leaves_open_do_not_turn_the_comparison_round():
    """Seven of seven with a verdict against seven of nine, twice: what is undecided may stand in both."""
    first = runs("as built", *[EXCEEDED] * 14, *[OPEN] * 4)
    other = runs("dowels", *[EXCEEDED] * 14, *[NOT_EXCEEDED] * 4)
    first_share, other_share = shares({each.name: each.codes for each in (first, other)})
    assert (first_share.exceeded, first_share.not_exceeded, first_share.undecided) == (14, 0, 4)
    assert (first_share.words, other_share.words) == ("78 to 100 %", "78 %")
    assert (first_share.low, first_share.high) == (other_share.low, 1.0)
    comparison = difference(first, other)
    assert (comparison.pairs, comparison.undecided, comparison.saved, comparison.harmed) == (14, 4, 0, 0)
    assert (comparison.share_best, comparison.share_worst) == (pytest.approx(-4 / 18), 0.0)
    assert comparison.share_low <= comparison.share_best
    assert comparison.conclusion == INCONCLUSIVE
    assert "no ground to adopt it for safety" in comparison.advice
    assert "4 are undecided" in comparison.basis
    assert "18 pairs" in comparison.basis


def test_an_interval_holds_whatever_the_undecided_come_to():
    rng = np.random.default_rng(3)
    for _ in range(20):
        first, other = (runs(name, *rng.choice([1, 0, -1, -2], 24, p=[0.4, 0.3, 0.2, 0.1])) for name in "ab")
        comparison = difference(first, other)
        both = (first.codes != FAILED) & (other.codes != FAILED)
        assert comparison.pairs + comparison.undecided + comparison.failed == 24
        for _ in range(20):
            ends = [
                np.where(state.codes == OPEN, rng.integers(0, 2, 24), state.codes)[both] for state in (first, other)
            ]
            change = float(ends[1].mean() - ends[0].mean())
            assert comparison.share_best - 1e-9 <= change <= comparison.share_worst + 1e-9


def test_what_failed_in_one_state_is_left_out_of_all():
    codes = {"a": np.array([1, 1, 0, FAILED, 0]), "b": np.array([1, FAILED, OPEN, 1, 0])}
    first, second = shares(codes)
    assert (first.runs, first.exceeded, first.not_exceeded, first.undecided, first.failed) == (3, 1, 2, 0, 1)
    assert (second.runs, second.exceeded, second.not_exceeded, second.undecided, second.failed) == (3, 1, 1, 1, 1)
    assert [each.words for each in shares({"a": np.array([FAILED])})] == [""]
    assert codes_of(np.array(VERDICTS)).tolist() == [NOT_EXCEEDED, EXCEEDED, OPEN, FAILED, FAILED]


def test_an_interval_of_a_share_is_over_records_however_many_runs_each_has():
    """Five directions of each of four records are four records: Wilson's interval of 2 of 4, not of 10 of 20."""
    (share,) = shares({"a": np.array([EXCEEDED] * 10 + [NOT_EXCEEDED] * 10)}, np.repeat(list("abcd"), 5))
    assert (share.runs, share.records) == (20, 4)
    assert share.interval == pytest.approx(tuple(float(each) for each in wilson_interval(2, 4)), abs=1e-12)
    (open_,) = shares({"a": np.array([EXCEEDED, OPEN, NOT_EXCEEDED])})
    assert open_.interval[0] == pytest.approx(float(wilson_interval(1, 3)[0]), abs=1e-12)
    assert open_.interval[1] == pytest.approx(float(wilson_interval(2, 3)[1]), abs=1e-12)
    assert shares({"a": np.array([FAILED])})[0].interval == (0.0, 1.0)


def test_an_interval_over_records_holds_the_share_of_the_runs():
    """One record of ten with a hundred runs, of which all collapse: their share is 92 %, though nine records stand."""
    (share,) = shares({"a": np.array([EXCEEDED] * 100 + [NOT_EXCEEDED] * 9)}, ["a"] * 100 + list("bcdefghij"))
    assert share.low == pytest.approx(100 / 109)
    assert share.interval == pytest.approx((float(wilson_interval(1, 10)[0]), 100 / 109))


def test_directions_of_a_record_are_no_records_of_their_own():
    """A suite of one record in twelve directions says nothing about the next earthquake."""
    time = np.arange(60) * 0.02
    record = st.Motion(0.02, np.sin(3.0 * time), name="one")
    motions = [
        record.replace(name=f"one at {a}°", metadata={"direction": {"record": "one", "azimuth": a}}).scaled(
            3.0 + 0.2 * a
        )
        for a in range(12)
    ]
    block = st.Column.of_drums([st.Drum(2.0, 0.5, 0.5, 2500.0)], st.Joint(5e10, 2.5e10, 35.0), name="block")
    table = suite_table(block, motions, st.HousnerBlock())
    assert set(table["record"]) == {"one"}
    assert table["motion"].nunique() == 12
    with pytest.raises(st.InputError, match="a fragility of 1 record"):
        fragility(evidence(table, "pga"))


KNOWN = Difference("dowels", "as built", 40, 3, 9, 0.15, 0.05, 0.25, 0.9, 0.8, 0.97, records=20)


@pytest.mark.parametrize(
    ("change", "conclusion"),
    [
        ({}, WEAKER),
        ({"share_low": -0.05}, WEAKER),  # the median alone is a sure sign of harm
        ({"share_low": -0.05, "ratio_high": 1.1}, INCONCLUSIVE),
        ({"share_low": -0.3, "share_high": -0.1}, INCONCLUSIVE),  # share and median contradict one another
        ({"share_low": -0.3, "share_high": -0.1, "ratio": 1.2, "ratio_low": 1.1, "ratio_high": 1.3}, STRONGER),
        ({"share_low": -0.3, "share_high": -0.1, **dict.fromkeys(("ratio", "ratio_low", "ratio_high"), math.nan)}, STRONGER),
        ({"share_low": math.nan, "share_high": math.nan, "ratio_high": 1.1}, INCONCLUSIVE),
        ({"records": FEWEST - 1}, INCONCLUSIVE),
    ],
)  # fmt: skip
def test_advice_reads_in_one_way(change, conclusion):
    comparison = dataclasses.replace(KNOWN, **change)
    assert comparison.conclusion == conclusion
    words = {
        STRONGER: "stronger than “as built” against collapse, under",
        WEAKER: "weaker than “as built” against collapse: do not adopt it for safety",
        INCONCLUSIVE: "not shown to be stronger than “as built” against collapse, nor weaker: no ground to",
    }
    assert [each for each, phrase in words.items() if phrase in comparison.advice] == [conclusion]
    assert comparison.sentence.startswith(comparison.advice)
    as_found = dataclasses.replace(comparison, state="as found")
    assert "adopt" not in as_found.sentence  # it is no measure
    assert ("not shown to be weaker or stronger" in as_found.advice) == (conclusion == INCONCLUSIVE)


def test_a_measure_is_compared_with_the_column_as_it_stands_today():
    labels = ("as built", "as found", "dowels")
    assert [reference(labels, label) for label in labels[1:]] == ["as built", "as found"]
    assert reference(("as built", "dowels", "tendon"), "tendon") == "as built"
    assert reference(("one", "other"), "other") == "one"


def test_what_is_undecided_stands_in_the_advice():
    advice = dataclasses.replace(
        KNOWN, share_low=-0.05, ratio_high=1.1, pairs=27, undecided=13, to_decide="do so"
    ).advice
    assert advice.endswith("; 13 of 40 pairs of runs are undecided: do so).")
    few = dataclasses.replace(KNOWN, records=3, undecided=13).advice  # longer runs of so few would settle nothing
    assert few.endswith(
        "3 records and worse in 9; nothing is concluded from fewer than 10 records; 13 of 53 pairs of runs are undecided)."
    )


def test_changes_are_told_by_size_and_direction():
    known = {"share_best": -0.2, "share_worst": -0.1, "ratio_best": 1.5, "ratio_worst": 1.25, "undecided": 4}
    known |= {"share_low": -0.3, "share_high": -0.04, "ratio": 1.3, "ratio_low": 1.1, "ratio_high": math.inf}
    basis = dataclasses.replace(KNOWN, **known, im="pgv").basis
    both = "(95 % interval over records, undecided runs counted both ways; "
    assert (
        f"median intensity of collapse (pgv) is at least 10 % higher {both}25 to 50 % higher in these records)."
        in basis
    )
    share = f"4 to 30 percentage points lower {both}10 to 20 percentage points lower in these records)."
    assert f"The share that collapses is {share}" in basis
    assert f"Of 44 pairs of runs under {KNOWN.records} records, 3 collapse with “as built” only and 9 with" in basis
    assert "9 with “dowels” only; 4 are undecided." in basis
    across = dataclasses.replace(KNOWN, share_best=0.0, share_worst=0.0, share_low=-0.1, share_high=0.2).basis
    spread = "10 percentage points lower to 20 percentage points higher"
    assert f"is {spread} (95 % interval over records; the same in these records)." in across
    few = dataclasses.replace(KNOWN, records=3).basis
    assert "interval over records" not in few
    none = dataclasses.replace(KNOWN, pairs=0, ratio=math.nan).basis
    assert none == "No pair of runs could be computed."


def test_a_median_is_as_wide_as_what_is_undecided():
    curve = {"median": 0.92, "unit": "g", "undecided": 0, "failed": 0, "levels": [0.5, 1.5]}
    assert median_words(curve) == "0.92 g"
    assert median_words(curve | {"median": 1.7}) == "> 1.5 g"
    assert median_words(curve | {"median": 0.3}) == "≤ 0.5 g"
    ends = {"if_open_exceed": {"median": 0.8}, "if_open_do_not": {"median": 1.1}}
    open_ = curve | {"undecided": 3} | ends
    assert median_words(open_) == "0.8 to 1.1 g"
    assert median_words(open_ | {"if_open_do_not": {"median": None}}) == "0.8 to > 1.5 g"
    assert median_words(open_ | {"median": 1.6, "if_open_do_not": {"median": 2.0}}) == "0.8 to > 1.5 g"
    assert median_words(open_ | {"if_open_exceed": {"median": 1.6}, "if_open_do_not": {"median": 2.0}}) == "> 1.5 g"


def test_a_compass_counts_a_record_once_from_each_direction():
    """Five columns under one record from the north are one record: Wilson's interval of 1 of 2, not of 5 of 6."""
    fell = {"outcome": "collapsed", "decided": True, "collapsed": True, "azimuth_deg": 0.0}
    fell |= {"peak_top_displacement_m": 0.1, "collapse_time_s": 1.0}
    stood = {"outcome": "rocked", "decided": True, "collapsed": False, "azimuth_deg": 0.0}
    stood |= {"peak_top_displacement_m": 0.1}
    open_ = stood | {"decided": False, "azimuth_deg": 90.0, "record": "a"}
    compass = compass_of_shares([*[fell | {"record": "a"}] * 5, stood | {"record": "b"}, open_])
    assert compass.bearings.tolist() == [0.0, 90.0]
    assert compass.values[0] == pytest.approx(5 / 6)
    assert math.isnan(compass.values[1])  # nothing is decided there
    assert compass.low[0] == pytest.approx(float(wilson_interval(1, 2)[0]))


def test_advice_without_pairs_and_of_few_records_says_what_it_is_of():
    none = difference(runs("as built", *[FAILED] * 12), runs("dowels", *[EXCEEDED] * 12))
    assert none.advice.endswith("no ground to adopt it for safety (no pair of runs could be computed).")
    assert none.basis == "No pair of runs could be computed."
    few = difference(runs("as built", EXCEEDED, OPEN), runs("dowels", EXCEEDED, EXCEEDED)).advice
    assert "fewer than 10 records; 1 of 2 pairs of runs is undecided)." in few


@pytest.mark.parametrize(
    ("change", "words"),
    [(0.004, "<1 percentage point higher"), (-0.01, "1 percentage point lower"), (0.02, "2 percentage points higher")],
)
def test_points_are_counted(change, words):
    comparison = dataclasses.replace(
        difference(runs("a", EXCEEDED), runs("b", EXCEEDED)), share_best=change, share_worst=change
    )
    assert f"The share that collapses is {words} in these records." in comparison.basis
