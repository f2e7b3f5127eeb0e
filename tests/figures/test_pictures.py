"""Pictures: axes with units, everything drawn inside them, files whole, and readable without colour."""

import dataclasses
import math

import matplotlib
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread

import stylobate as st
from stylobate import plots
from stylobate.column.catalogue import preset
from stylobate.plots import style
from stylobate.plots.domain import FILL
from stylobate.response import ENERGY_TERMS, Histories, Measures
from stylobate.verdicts.critical import CriticalAmplitude
from stylobate.verdicts.domain import Domain


def rocking(name="paper-12-drums", collapse=False, size=0.05):
    """A response with a column that leans as one body about its left or right corner."""
    column, time = preset(name), np.linspace(0.0, 10.0, 501)
    angle = -size * np.sin(2 * np.pi * 0.5 * time) * np.minimum(time, 1.0)
    if collapse:
        angle -= np.where(time > 6.0, 0.1 * (time - 6.0) ** 2, 0.0)
    angle = np.maximum(angle, -1.5)
    lever = column.centroid_heights
    corner = np.where(angle < 0.0, 0.5, -0.5)[:, None] * column.base_width
    x = corner + (0.0 - corner) * np.cos(angle)[:, None] - lever * np.sin(angle)[:, None]
    z = (0.0 - corner) * np.sin(angle)[:, None] + lever * np.cos(angle)[:, None] - lever
    opening = np.zeros((501, column.n))
    opening[:, 0] = np.abs(angle) * column.base_width
    top = -column.height * np.sin(angle)
    zero = np.zeros_like(time)
    energy = dict.fromkeys(ENERGY_TERMS, zero) | {
        "input": 1e4 * time,
        "friction": 0.9e4 * time,
        "kinetic": 999.0 * time,
    }
    histories = Histories.of_drums(
        time, x, z, np.repeat(angle[:, None], column.n, 1), opening, 0.01 * opening, 0.01 * np.sin(time), top,
        0.3 * st.g * np.sin(2 * np.pi * time), zero, energy,
    )  # fmt: skip
    outcome = st.Outcome.COLLAPSED if collapse else st.Outcome.ROCKED
    measures = Measures(
        outcome, True, 8.0 if collapse else math.nan, float(np.abs(top).max()), 0.0, 0.1, 0.1, 0.0, 1e-3, 1e-4, 9
    )
    return st.Response(column, histories, measures, "dem2d", {"motion": "harmonic 1 Hz, 0.3 g"})


def rows(verdicts):
    for verdict in verdicts:
        yield (
            None
            if verdict == "not run"
            else {
                "outcome": {"failed": "failed", "collapsed": "collapsed"}.get(verdict, "rocked"),
                "collapsed": verdict == "collapsed",
                "decided": verdict in ("stands", "collapsed"),
                "peak_top_displacement_m": math.nan if verdict == "failed" else 0.2,
            }
        )


def domain(collapses=True):
    f, a = np.linspace(0.33, 4.0, 6), np.linspace(0.05, 0.6, 8) * st.g
    verdicts = np.full((6, 8), "stands", dtype=object)
    if collapses:
        verdicts[0, 3:], verdicts[1, 5:] = "collapsed", "collapsed"
        verdicts[0, 5], verdicts[2, 5], verdicts[3, 5], verdicts[5, 7] = "stands", "undecided", "failed", "not run"
    return Domain(preset("paper-12-drums"), "dem2d", f, a, list(rows(verdicts.ravel())), 1.0, {})


def critical(verdicts):
    a = np.linspace(0.05, 0.6, len(verdicts)) * st.g
    motion = st.harmonic(1.0, 1.0, 1.0)
    return CriticalAmplitude(preset("paper-monolithic"), motion, "dem2d", a, list(rows(verdicts)), 1.0)


STILL = dataclasses.replace(rocking(size=0.0))
THREE_COMPONENTS = st.Motion(0.01, *(np.random.default_rng(i).normal(size=500) for i in range(3)))
PICTURES = {
    "histories": lambda: plots.draw_histories(rocking()),
    "histories of a collapse": lambda: plots.draw_histories(rocking(collapse=True)),
    "histories at rest": lambda: plots.draw_histories(STILL),
    "comparison": lambda: plots.draw_comparison([rocking(), rocking(collapse=True)]),
    "film strip": lambda: plots.draw_filmstrip(rocking()),
    "film strip of a collapse": lambda: plots.draw_filmstrip(rocking(collapse=True)),
    "film strip at rest": lambda: plots.draw_filmstrip(STILL),
    "joints": lambda: plots.draw_joints(rocking()),
    "joints of a monolith": lambda: plots.draw_joints(rocking("paper-monolithic", collapse=True)),
    "joints at rest": lambda: plots.draw_joints(STILL),
    "energy": lambda: plots.draw_energy(rocking()),
    "motion": lambda: plots.draw_motion(st.harmonic(1.0, 3.0, 5.0)),
    "motion of three components": lambda: plots.draw_motion(THREE_COMPONENTS),
    "spectra": lambda: plots.draw_spectra(THREE_COMPONENTS),
    "domain": lambda: plots.draw_domain(domain()),
    "domain without collapse": lambda: plots.draw_domain(domain(False)),
    "boundaries": lambda: plots.draw_boundaries([domain(), domain(False)]),
    "amplitudes": lambda: plots.draw_amplitudes(critical(["stands", "undecided", "collapsed", "failed", "collapsed"])),
    "amplitudes without collapse": lambda: plots.draw_amplitudes(critical(["stands"] * 4)),
}


@pytest.mark.parametrize("name", PICTURES)
def test_axes_say_what_and_in_which_unit(name):
    figure = PICTURES[name]()
    shown = [axes for axes in figure.axes if axes.axison]
    for axes in shown:
        labels = [axes.get_ylabel()] + ([axes.get_xlabel()] if axes is shown[-1] else [])
        for label in labels:
            unit = "[" in label or "joint" in label or "/" in label
            assert unit, f"{label!r} has no unit"
    title = figure.get_suptitle() or figure.axes[0].get_title(loc="left")
    assert title


@pytest.mark.parametrize("name", ["histories of a collapse", "film strip", "joints", "domain", "motion"])
def test_nothing_is_cut_off(name):
    figure = PICTURES[name]()
    figure.draw_without_rendering()
    page = figure.bbox
    for axes in figure.axes:
        tight = axes.get_tightbbox()
        assert tight.x0 >= page.x0 - 1
        assert tight.x1 <= page.x1 + 1
        assert tight.y0 >= page.y0 - 1
        assert tight.y1 <= page.y1 + 1


def test_base_and_top_are_drawn_as_in_the_paper():
    response = rocking()
    lines = {line.get_label(): line for line in plots.draw_histories(response).axes[0].lines}
    red, black = to_rgb(lines["base"].get_color()), to_rgb(lines["top"].get_color())
    assert red[0] > 0.5 > 2 * max(red[1:])
    assert max(black) < 0.2
    assert lines["base"].get_linestyle() == "-"
    assert lines["top"].get_linestyle() == "--"
    np.testing.assert_array_equal(lines["top"].get_ydata(), response.top_displacement)
    np.testing.assert_array_equal(lines["base"].get_ydata(), response.base_displacement)


def test_the_collapse_is_marked_at_its_time():
    axes = plots.draw_histories(rocking(collapse=True)).axes[0]
    assert any("collapse 8.00 s" in text.get_text() for text in axes.texts)
    assert any(list(line.get_xdata()) == [8.0, 8.0] for line in axes.lines)


def test_the_film_strip_draws_rigid_drums_where_they_are():
    response = rocking()
    first = response.column.drums[0]
    moment = 40
    corners = response.outline(moment, 0)
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    slanted = math.hypot(first.height, (first.bottom_width - first.top_width) / 2)
    np.testing.assert_allclose(sides, [first.bottom_width, slanted, first.top_width, slanted], rtol=1e-12)
    # It leans to the right about its right corner, which stays where it was.
    assert response.drum_rotation[moment, 0] < 0.0
    np.testing.assert_allclose(corners[1], [0.5 * first.bottom_width, 0.0], atol=1e-12)
    assert corners[0, 1] > 0.0


def test_the_film_strip_refuses_instants_outside_the_run():
    with pytest.raises(st.InputError, match=r"instant 11 s .* 0 to 10 s"):
        plots.draw_filmstrip(rocking(), [1.0, 11.0])
    with pytest.raises(st.InputError, match="no instant"):
        plots.draw_filmstrip(rocking(), [])
    assert len(plots.draw_filmstrip(rocking(), [1.0, 2.0, 3.0]).axes) == 3


def test_small_displacements_are_magnified_and_it_is_said():
    assert "displacements × 50" in plots.draw_filmstrip(rocking(size=1e-3)).get_suptitle()
    assert "×" not in plots.draw_filmstrip(rocking()).get_suptitle()


def test_the_domain_shows_every_verdict_apart_and_its_boundary():
    figure = plots.draw_domain(domain())
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == [
        "stands (38)", "collapsed (7)", "undecided (1)", "failed (1)", "not run (1)", "first collapse",
        "static uplift, 0.205 g",
    ]  # fmt: skip
    steps = [patch for patch in figure.axes[0].patches if hasattr(patch, "get_data")]
    levels = steps[0].get_data().values
    np.testing.assert_allclose(levels[:2], np.array([2.5, 4.5]) * 0.55 / 7 + 0.05)
    assert np.isnan(levels[2:]).all()


def test_verdicts_differ_in_grey():
    grey = {name: np.dot(to_rgb(fill["facecolor"]), (0.299, 0.587, 0.114)) for name, fill in FILL.items()}
    assert grey["stands"] - grey["collapsed"] > 0.4
    assert grey["undecided"] - grey["collapsed"] > 0.4
    for verdict in ("undecided", "failed"):
        assert FILL[verdict]["hatch"]


def test_a_picture_is_saved_as_png_and_svg_and_is_the_same_each_time(tmp_path):
    files = plots.save(plots.draw_domain(domain()), tmp_path / "domain")
    assert [file.name for file in files] == ["domain.png", "domain.svg"]
    assert sorted(file.name for file in tmp_path.iterdir()) == ["domain.png", "domain.svg"]
    picture = imread(files[0])
    assert picture.shape[1] == round(style.WIDTH * style.DOTS_PER_INCH)
    assert 0.05 < 1.0 - picture[:, :, :3].mean() < 0.9
    again = plots.save(plots.draw_domain(domain()), tmp_path / "again")
    assert again[1].read_bytes() == files[1].read_bytes()
    with pytest.raises(st.InputError, match="does not exist"):
        plots.save(plots.draw_domain(domain()), tmp_path / "none" / "domain")


def test_drawing_leaves_the_settings_of_others_alone():
    with matplotlib.rc_context({"font.size": 20.0, "lines.linewidth": 7.0}):
        figure = plots.draw_histories(rocking())
        assert matplotlib.rcParams["font.size"] == 20.0
        assert {line.get_linewidth() for line in figure.axes[0].lines} == {0.6, 1.1}
