"""Domains side by side and the same question asked again: shares, marks of what changes, fixed looks, nothing cut off."""

import dataclasses
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.text import Text

import stylobate as st
from stylobate import plots
from stylobate.column import preset
from stylobate.column.scatter import Scatter
from stylobate.motion.pulses import MotionScatter
from stylobate.verdicts import verdict as v
from stylobate.verdicts.compare import StepComparison
from stylobate.verdicts.domain import CollapseProbability, Domain
from stylobate_studies.paper.doubt import Doubt
from stylobate_studies.paper.pictures import draw_domain_panels, draw_doubt

F, A = np.linspace(0.5, 3.0, 6), np.linspace(0.1, 0.5, 5) * st.g
WORDS = {"S": ("rocked", True), "C": ("collapsed", True), "U": ("rocked", False), "F": ("failed", False)}


def domain(letters):
    """Verdicts by frequency, one word each: S stands, C collapsed, U undecided, F failed."""
    rows = [
        {"outcome": WORDS[letter][0], "collapsed": letter == "C", "decided": WORDS[letter][1]}
        for word in letters
        for letter in word
    ]
    return Domain(preset("paper-12-drums"), "dem2d", F, A, rows, 1.0, {})


ONE = domain(["SSCCC", "SSSCC", "SSSSC", "SSSUF", "SSSSS", "SSSSS"])
HALVED = domain(["SSCCC", "SSCCC", "SSSSS", "SSSCC", "SSSSS", "SSSSS"])


def doubt():
    codes = np.array([[v.VERDICTS.index(verdict) for verdict in line] for line in ONE.verdicts], dtype=np.int8)
    codes = np.repeat(codes[:, :, None], 4, axis=2)
    codes[5, 4, 0], codes[0, 2, 1] = v.VERDICTS.index(v.COLLAPSED), v.VERDICTS.index(v.STANDS)
    zero = np.zeros(codes.shape, np.float32)
    population = CollapseProbability(
        ONE.column, "dem2d", F, A, codes, zero, Scatter(), MotionScatter(), 0, 0.95, 1.0, {}
    )
    return Doubt(StepComparison(ONE, HALVED), population)


def test_doubt_counts_only_what_has_a_verdict_both_times():
    uncertainty = doubt()
    assert np.argwhere(uncertainty.steps.differing).tolist() == [[1, 2], [2, 4]]
    assert np.argwhere(uncertainty.differing).tolist() == [[5, 4]]
    assert uncertainty.uncertain == pytest.approx(2 / 30)


def test_what_changes_is_marked_and_counted():
    figure = draw_doubt(doubt(), "title")
    titles = [axes.get_title(loc="left").splitlines() for axes in figure.axes]
    assert titles == [
        ["as computed"],
        ["half of the time step", "2 of 30 verdicts change"],
        ["stones that differ by 1 %", "1 of 30 verdicts change"],
    ]
    dots = [[line for line in axes.lines if line.get_marker() == "o"] for axes in figure.axes]
    assert [sum(len(line.get_xdata()) for line in lines) for lines in dots] == [0, 2, 1]
    np.testing.assert_allclose(dots[2][0].get_xydata(), [[F[5], A[4] / st.g]])


def test_panels_say_how_much_collapses_and_share_their_axes():
    rows = [("One", [("model a", ONE), ("model b", HALVED)]), ("Two", [("model a", HALVED), ("model b", ONE)])]
    figure = draw_domain_panels(rows, "title")
    titles = [axes.get_title(loc="left").splitlines() for axes in figure.axes]
    assert titles[0] == ["model a", "20 to 27 % collapse"]  # one cell is undecided, one failed
    assert titles[1] == ["model b", "27 % collapse"]
    assert len({axes.get_xlim() for axes in figure.axes}) == len({axes.get_ylim() for axes in figure.axes}) == 1
    assert figure.axes[0].get_ylabel() == "One\namplitude [g]"
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["stands", "collapsed", "undecided", "failed", "first collapse", "static uplift"]


@pytest.mark.parametrize("columns", [1, 2, 4])
def test_nothing_is_cut_off(columns):
    rows = [("Column of twelve drums", [("rigid beam with sliding", ONE)] * columns)] * 2
    for figure in (
        draw_domain_panels(rows, "Which shaking brings the column down?"),
        draw_doubt(doubt(), "t"),
    ):
        figure.draw_without_rendering()
        for thing in (*figure.axes, *figure.legends):
            box = thing.get_tightbbox()
            assert box is not None
            assert box.x0 >= figure.bbox.x0 - 1
            assert box.x1 <= figure.bbox.x1 + 1
            assert box.y0 >= figure.bbox.y0 - 1


def test_panel_titles_do_not_run_into_each_other():
    figure = draw_domain_panels([("Column", [("rigid beam with sliding", ONE)] * 4)], "title")
    figure.draw_without_rendering()
    titles = [text for axes in figure.axes for text in axes.findobj(Text) if "% collapse" in text.get_text()]
    assert len(titles) == 4
    boxes = [text.get_window_extent() for text in titles]
    for box, other in pairwise(boxes):
        assert box.x1 < other.x0


def test_a_model_keeps_its_look_in_every_boundary_picture():
    named = [dataclasses.replace(original, model=name) for original, name in ((ONE, "b"), (HALVED, "d"))]
    few = plots.draw_boundaries(named, looks=[1, 3]).axes[0].lines
    many = plots.draw_boundaries([ONE, named[0], HALVED, named[1]]).axes[0].lines
    look = [(line.get_color(), line.get_marker(), line.get_linestyle()) for line in few[:2]]
    assert look == [(many[k].get_color(), many[k].get_marker(), many[k].get_linestyle()) for k in (1, 3)]
