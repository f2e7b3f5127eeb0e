"""Reference rows of assemblies in space: the fast ones computed, all of them as they are kept, and how rows are judged."""

from collections import Counter

import pytest
from references import needs_references
from references import rows as rows_of
from validation.in_space import plane, study
from validation.in_space.row import FAMILIES, MET, MISSED, NONE, allowed, both_sides, near

#: Families that take less than a second each.
FAST = (
    "drum_rolls_down",
    "skid_to_roll",
    "lying_drum_spins",
    "drum_over_edge",
    "three_lying_drums",
    "beam_leans_on_wall",
    "drop_on_rim",
    "drop_on_corner",
    "arch_across",
    "portal_rocking",
    "wall_mid_push",
)


@needs_references
@pytest.mark.parametrize("name", FAST)
def test_fast_families_are_met(name):
    for result in study.judged(name, study.families()[name]):
        assert result.verdict != MISSED, result


@needs_references
def test_every_row_is_kept_and_is_the_one_of_the_table():
    groups, kept = study.families(), study.stored()["rows"]
    assert list(kept) == list(groups)
    for name, rows in groups.items():
        mine = [{key: entry[key] for key in study.named(rows[0])} for entry in kept[name]]
        assert mine == [study.named(entry) for entry in rows]
    assert sum(map(len, kept.values())) == len(rows_of(""))


def test_what_is_kept_is_as_the_page_says():
    """Closed forms and multipliers are met; of the engines' verdicts on which they agree at least 95 %."""
    kept = study.stored()["rows"]
    assert set(kept) == set(study.TITLES) == set(FAMILIES)
    for name, rows in kept.items():
        if not name.startswith("engines_"):
            assert all(row["verdict"] != MISSED for row in rows), name
    agreed, same = study.verdicts_of_engines()
    assert same >= 0.95 * agreed
    assert all(row["why"] for rows in kept.values() for row in rows if row["verdict"] != MET)
    whole = Counter(row["verdict"] for rows in kept.values() for row in rows)
    assert f"**{whole[MET]}**" in study.counts()


def row(value, unit, spread):
    return {"value": value, "unit": unit, "spread": spread}


@pytest.mark.parametrize(
    ("entry", "most"),
    [
        (row("2.0", "m/s", "1 %"), 0.02),
        (row("2.0", "m/s2", "1e-3"), 2e-3),
        (row("50", "deg", "0.5 deg"), 0.5),
        (row("-3.0", "rad", "0.17"), 0.17),
        (row("0.3 0.4", "m", "10 mm"), 0.01),
        (row("0.3 0.4", "rad/s", "2 % of its length"), 0.01),
        (row("1.0", "-", "same"), None),
        (row("0.25", "-", "closed form 2 t/h"), None),
    ],
)
def test_spreads_as_rows_write_them(entry, most):
    assert allowed(entry) == (None if most is None else pytest.approx(most))


def test_a_row_can_be_missed():
    entry = row("2.0", "m/s", "1 %")
    assert [near(entry, ours).verdict for ours in (2.019, 2.021, float("nan"))] == [MET, MISSED, MISSED]
    assert near(row("2.0", "m/s", ""), 2.0).verdict == NONE
    assert both_sides(entry, True, False, "a|b").verdict == MET
    assert both_sides(entry, True, True, "a|b").verdict == MISSED


def test_plane_assemblies_in_space_swing_as_in_the_plane():
    """A face 0.9 m long and 1 m deep resists bending with 2.05 k_n J for the plane's 3; 20 m deep with 2.91."""
    flat, square, deep = (plane.swing("portal", depth) for depth in (None, plane.DEPTH, plane.DEEP))
    assert square.aside < 1e-8  # rounding, which rocking makes grow
    assert square.peak == pytest.approx(flat.peak, rel=0.1)
    assert deep.peak == pytest.approx(flat.peak, rel=0.02)
    assert deep.time == pytest.approx(flat.time, rel=2e-3)
    assert flat.peak < deep.peak < square.peak
