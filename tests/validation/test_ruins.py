"""Posteriors of past shaking over ruins that were made, as they are kept (``make ruins``): calibrated, and wary of hands."""

import pytest
from validation.ruins.figures import KINDS, UNITS, stored

KEPT = stored()


@pytest.mark.parametrize("name", UNITS)
@pytest.mark.parametrize("which", ["calibration", "calibration_of_more"])
def test_ranks_are_even_and_intervals_hold_what_they_say(which, name):
    # Intervals hold 50 and 90 % within 3 %, and three standard errors of so many ruins besides.
    statistics, ruins = KEPT[which][name], KEPT[which]["ruins"]
    assert ruins + KEPT[which]["too_few_matched"] in (200, 1000)
    assert statistics["p_ranks"] > 0.01
    for share in (0.5, 0.9):
        assert statistics[f"cover_{100 * share:.0f}"] == pytest.approx(
            share, abs=0.03 + 3.0 * (share * (1 - share) / ruins) ** 0.5
        )


@pytest.mark.parametrize("kind", KINDS)
def test_intervals_hold_by_each_kind_of_observation(kind):
    # Within three standard errors of so many ruins, and 3 % as above: azimuths that nothing tells count from the middle of
    # the draws, and hold less; axes that offsets tell lie either side of it, and hold more.
    statistics = KEPT["by_kind"][kind]
    assert statistics["ruins"] >= 200
    for name in UNITS:
        assert statistics[name] == pytest.approx(0.9, abs=0.03 + 3.0 * (0.09 / statistics["ruins"]) ** 0.5), name


def test_what_tells_nothing_leaves_what_else_is_told():
    by = KEPT["by_kind"]
    assert by["what tells nothing"] == by["states alone"]  # the same draws, of the same ruins
    assert by["one offset, and what tells nothing"]["spread_of_pgv"] == pytest.approx(
        by["the offset of one joint"]["spread_of_pgv"],
        rel=0.02,  # of 240 ruins, whose errors are others
    )


def test_ruins_of_another_law_of_contact_are_held():
    # Asked for: a 90 % interval holds at least 80 % where the law of contact is the wrong one.
    for statistics in KEPT["other_law"].values():
        assert all(statistics[name] >= 0.8 for name in UNITS)


def test_what_hands_have_moved_stands_out():
    counts = KEPT["moved_by_hand"]
    assert min(counts["taken_down"], counts["pushed_out"]) >= 18  # of 20, as asked for
    assert (
        counts["false_alarms"] <= 0.15 * counts["of_shaken"]
    )  # 5 % over states and 5 % over the rest, and three standard errors


def test_slips_tell_more_than_states():
    # A forest on 1,600 runs of columns that are not known left 0.62 of the spread of ln PGV by states, 0.36 with slips that
    # have no errors. One on the runs of here (scikit-learn 1.9.1, 400 trees, out of bag, no ruin that matches fewer than a
    # hundred draws, as here) leaves these; an error over 1,450 ruins is known to 2 %, of which two are let through.
    forest = {"stout": (0.699, 0.477, 0.406), "slender": (0.597, 0.418, 0.368)}
    for columns, errors in forest.items():
        for label, error in zip(("states", "1 mm", "exact"), errors, strict=True):
            assert KEPT["what_slips_tell"][f"{columns}, {label}"] < 1.04 * error
