"""Pictures of ground motions: spectra, suites, verdicts of records; readable without colour, nothing cut off."""

import dataclasses
import math
import subprocess
import sys

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread

import stylobate as st
from stylobate import plots
from stylobate.column.catalogue import preset
from stylobate.errors import InputError
from stylobate.plots.domain import _FILL, SHADES
from stylobate.probability.suite import INTENSITIES, suite_table
from stylobate.verdicts.critical import CriticalAmplitude, CriticalSuite
from stylobate.verdicts.rocking_spectrum import RockingSpectrum
from stylobate.verdicts.verdict import VERDICTS

THREE = st.Motion(0.01, *(np.random.default_rng(i).normal(size=500) for i in range(3)), name="noise")


def grey(color):
    return float(np.dot(to_rgb(color), (0.299, 0.587, 0.114)))


def rocking_spectrum(pga=3.5, period=0.8, undecided=True):
    p, alpha = np.geomspace(0.8, 8.0, 12), np.linspace(0.05, 0.4, 10)
    peak = np.outer(p / 8.0, 1.2 - 3.0 * alpha).clip(0.0) * alpha
    peak[:, -2:] = 0.0
    collapsed = peak / alpha > 0.8
    decided = np.ones_like(collapsed)
    decided[-1, 4] = not undecided
    return RockingSpectrum(p, alpha, peak, collapsed, decided, "a motion", pga, period)


def critical_suite(verdicts):
    amplitudes = np.linspace(0.1, 0.8, len(verdicts[0])) * st.g
    results = []
    for i, row in enumerate(verdicts):
        rows = [
            {"outcome": verdict if verdict in ("failed", "collapsed") else "rocked", "collapsed": verdict == "collapsed",
             "decided": verdict != "undecided", "peak_top_displacement_m": 0.2}
            for verdict in row
        ]  # fmt: skip
        motion = THREE.replace(name=f"record of a station with a long name {i}")
        results.append(CriticalAmplitude(preset("paper-monolithic"), motion, "housner", amplitudes, rows, 1.0))
    return CriticalSuite(tuple(results), 2.0)


VERDICTS_OF_RECORDS = [["stands", "collapsed", "undecided", "collapsed"], ["stands", "stands", "failed", "collapsed"]]


def table(outcomes=("at_rest", "rocked", "displaced", "collapsed", "rocked", "failed")):
    motions = [st.half_sine_pulse(1.0, size * st.g, 8.0) for size in np.geomspace(0.05, 1.0, len(outcomes))]
    frame = suite_table(preset("paper-monolithic"), motions, st.HousnerBlock(), threads=1)
    frame["outcome"] = outcomes
    frame["verdict"] = ["stands", "stands", "stands", "collapsed", "undecided", "failed"]
    frame["peak_top_over_base_width"] = [0.0, 0.02, 0.3, 5.0, 0.4, math.nan]
    return frame


PICTURES = {
    "spectra": lambda: plots.draw_spectra(THREE),
    "rocking spectrum": lambda: plots.draw_rocking_spectrum(rocking_spectrum()),
    "rocking spectrum of a motion without pulse": lambda: plots.draw_rocking_spectrum(rocking_spectrum(0.0, math.nan)),
    "one block": lambda: plots.draw_rocking_spectrum(
        RockingSpectrum(*(np.array(v) for v in ([1.0], [0.1], [[0.05]], [[False]], [[True]])), "m", 2.0, 1.0)
    ),
    "suite": lambda: plots.draw_suite(table()),
    "suite against slenderness": lambda: plots.draw_suite(table(), "pga_over_g_tan_alpha"),
    "verdicts of records": lambda: plots.draw_record_verdicts(critical_suite(VERDICTS_OF_RECORDS)),
}


@pytest.mark.parametrize("name", PICTURES)
def test_axes_say_what_and_in_which_unit_and_nothing_is_cut_off(name):
    figure = PICTURES[name]()
    figure.draw_without_rendering()
    for axes in figure.axes:
        labels = [axes.get_ylabel(), axes.get_xlabel()]
        assert any(labels)
        for label in filter(None, labels):
            assert "[" in label or "/" in label, f"{label!r} has no unit"
        tight = axes.get_tightbbox()
        assert tight.x0 >= figure.bbox.x0 - 1
        assert tight.x1 <= figure.bbox.x1 + 1
        assert tight.y0 >= figure.bbox.y0 - 1
        assert tight.y1 <= figure.bbox.y1 + 1
    assert figure.get_suptitle() or figure.axes[0].get_title(loc="left")


def test_no_letter_is_cut_in_the_file(tmp_path):
    """Letters are up to a tenth wider in the resolution of the file than in that of a screen, and long names add up."""
    suite = critical_suite([["stands", "collapsed"]])
    (result,) = suite.results
    named = dataclasses.replace(result, motion=result.motion.replace(name="W" * 40))
    png, _ = plots.save(plots.draw_record_verdicts(dataclasses.replace(suite, results=(named,))), tmp_path / "verdicts")
    assert (imread(png)[:, :4, :3] == 1.0).all()  # white at the left edge, where the label of the axis stands


def test_the_rocking_spectrum_is_read_in_grey():
    shades = [grey(SHADES(x)[:3]) for x in np.linspace(0.0, 1.0, 50)]
    assert (np.diff(shades) < 0.0).all()  # the larger the rotation, the darker
    assert grey(_FILL["overturned"]["facecolor"]) < shades[-1] - 0.2
    assert grey(_FILL["closed"]["facecolor"]) == pytest.approx(1.0)
    assert _FILL["undecided"]["hatch"]


def test_the_rocking_spectrum_counts_its_blocks_and_has_the_second_scales():
    spectrum = rocking_spectrum()
    figure = plots.draw_rocking_spectrum(spectrum)
    figure.draw_without_rendering()
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    fallen = int((spectrum.collapsed & spectrum.decided).sum())
    assert labels == [f"closed ({int(spectrum.closed.sum())})", f"overturned ({fallen})", "undecided (1)"]
    # The scale at the right: the tick of PGA = g tan α stands at α = atan(PGA/g).
    right = next(axes for axes in figure.axes if "PGA" in axes.get_ylabel())
    ticks = {text.get_text(): at for text, at in zip(right.get_yticklabels(), right.get_yticks())}
    assert ticks["1"] == pytest.approx(math.atan(3.5 / st.g))
    assert ticks["2"] == pytest.approx(math.atan(3.5 / st.g / 2.0))
    assert spectrum.acceleration_ratio == pytest.approx(3.5 / st.g / np.tan(spectrum.slenderness))
    assert spectrum.frequency_ratio == pytest.approx(2.0 * math.pi / 0.8 / spectrum.frequency_parameter)


def test_the_suite_draws_every_outcome_apart_and_the_collapses_at_the_top():
    axes = plots.draw_suite(table()).axes[0]
    marks = {(line.get_marker(), line.get_fillstyle()) for line in axes.lines}
    assert len(marks) == 6
    heights = {line.get_marker(): line.get_ydata()[0] for line in axes.lines}
    assert heights["X"] == max(heights.values())
    assert heights["s"] == pytest.approx(0.4)
    assert len(axes.texts) == 6
    with pytest.raises(st.InputError, match="no measure 'pgx'"):
        plots.draw_suite(table(), "pgx")


@pytest.mark.parametrize("against", sorted(INTENSITIES))
def test_every_measure_can_be_drawn_against(against):
    assert plots.draw_suite(TABLE, against).axes[-1].get_xlabel() == INTENSITIES[against]


TABLE = table()


def test_the_share_of_collapse_counts_undecided_records_as_not_collapsed():
    suite = critical_suite(VERDICTS_OF_RECORDS)
    assert suite.share_collapsed[[0, 1, 3]] == pytest.approx([0.0, 0.5, 1.0])
    assert math.isnan(suite.share_collapsed[2])
    assert suite.critical == pytest.approx(suite.amplitudes[1])
    assert suite.all_collapse_above == pytest.approx(suite.amplitudes[3])
    assert suite.summary()["runs"] == len(suite.runs) == 8
    figure = plots.draw_record_verdicts(suite)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert [label.split(" ")[0] for label in labels[:-1]] == [verdict for verdict in VERDICTS if verdict != "not run"]
    names = [text.get_text() for text in figure.axes[1].get_yticklabels()]
    assert all(name.endswith("…") for name in names)
    alone = dataclasses.replace(suite, results=suite.results[1:])
    assert len(plots.draw_record_verdicts(alone).axes[1].get_yticks()) == 1


def test_a_name_with_an_ending_is_the_one_file_that_is_written(tmp_path):
    figure = plots.draw_motion(st.harmonic(1.0, 1.0, 1.0))
    assert plots.save(figure, tmp_path / "a.png") == [tmp_path / "a.png"]
    assert plots.save(figure, tmp_path / "b.PDF") == [tmp_path / "b.PDF"]
    assert [path.name for path in plots.save(figure, tmp_path / "at 0.3g")] == ["at 0.3g.png", "at 0.3g.svg"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.png", "at 0.3g.png", "at 0.3g.svg", "b.PDF"]
    with pytest.raises(
        InputError, match=r"the ending of a picture is '.jpg'; did you mean .png. allowed are .png, .svg, .pdf"
    ):
        plots.save_as(figure, tmp_path / "a.jpg")


def test_pictures_are_loaded_when_they_are_asked_for():
    code = "import sys, stylobate as st; assert 'matplotlib' not in sys.modules; st.plots.draw_fragility"
    subprocess.run([sys.executable, "-c", code], check=True)
