"""The worst direction: one, in the words and in the picture, by the share and then by what the runs from there do."""

import pytest

from stylobate import plots
from stylobate.verdicts.directions import bearing, compass_of_chances, compass_of_shares, harm_words, worst


def row(azimuth, peak, *, fell=False, **more):
    fields = {"azimuth_deg": azimuth, "reversed": False, "record": "r", "motion": f"r at {azimuth:g}°"}
    fields |= {"outcome": "collapsed" if fell else "rocked", "collapsed": fell, "decided": True}
    return fields | {"peak_top_displacement_m": peak, "collapse_time_s": 1.0 / peak if fell else None} | more


def twins(share, undecided=0):
    limits = {"collapse_interval_low": 0.0, "collapse_interval_high": 0.9}
    return {"collapse_probability": share, **limits, "certainty": {"undecided": undecided}}


def legend(compass):
    return [text.get_text() for text in plots.draw_directions(compass).legends[0].get_texts()]


@pytest.mark.parametrize("compass_of", [compass_of_shares, compass_of_chances])
def test_ties_of_shares_are_told_apart_by_the_runs(compass_of):
    rows = [row(0.0, 1.0, fell=True), row(30.0, 0.2), row(60.0, 2.0, fell=True), row(90.0, 0.3)]
    rows = [entry | twins(float(entry["collapsed"])) for entry in rows]
    compass = compass_of(rows)
    worst_row = worst(rows, compass)
    assert compass.worst == bearing(worst_row) == 60.0  # falls sooner than the other
    assert harm_words(worst_row, compass) == "Most harm: turned to 60°, r at 60°."
    assert "worst: 60°, 1" in legend(compass)


def test_the_worst_run_is_one_from_the_worst_direction():
    """Of two that fall, the sooner one comes from where fewer do."""
    rows = [row(0.0, 9.0, fell=True), row(0.0, 0.1, record="b"), row(30.0, 1.0, fell=True)]
    compass = compass_of_shares(rows)
    assert compass.worst == 30.0
    assert worst(rows, compass)["azimuth_deg"] == 30.0


@pytest.mark.parametrize(
    ("undecided", "sentence"), [(0, "no direction collapses it"), (2, "no direction surely collapses it")]
)
def test_where_none_collapses_the_picture_says_so(undecided, sentence):
    rows = [row(0.0, 0.1) | twins(0.0), row(210.0, 0.2) | twins(0.0, undecided)]
    compass = compass_of_chances(rows)
    assert sentence in legend(compass)
    assert not [text for text in legend(compass) if text.startswith("worst")]
    words = harm_words(worst(rows, compass), compass)
    assert words.startswith(f"N{sentence[1:]}; it moves most turned to 210°, under r at 210°.")
    assert ("From 1 of 2 directions runs are undecided and may collapse it" in words) == bool(undecided)


@pytest.mark.parametrize("compass_of", [compass_of_shares, compass_of_chances])
def test_undecided_runs_compete_for_the_worst_direction(compass_of):
    rows = [row(0.0, 0.3), row(180.0, 0.52), row(270.0, 0.67, decided=False), row(300.0, 0.1, decided=False)]
    compass = compass_of(rows, "go on with a tail of 20 s")
    assert worst(rows, compass)["azimuth_deg"] == 270.0
    assert compass.undecided == (270.0, 300.0)
    words = harm_words(worst(rows, compass), compass)
    assert "turned to 270°" in words
    assert "From 2 of 4 directions runs are undecided and may collapse it" in words
    assert words.endswith(": go on with a tail of 20 s.")
    plots.draw_directions(compass)


def test_a_collapse_beyond_the_rim_is_called_one():
    rows = [row(0.0, 0.4), row(30.0, 1.0, fell=True)]
    texts = legend(compass_of_chances(rows))
    assert "worst: 30°, collapse" in texts
    assert "collapse" in texts
    assert "no collapse seen" not in texts
