"""The picture of the probability of collapse: its message, its classes in grey, and nothing cut off."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb

import stylobate as st
from stylobate import plots
from stylobate.column import preset
from stylobate.column.scatter import Scatter
from stylobate.motion.pulses import MotionScatter
from stylobate.plots.domain import CLASSES
from stylobate.verdicts import verdict as v
from stylobate.verdicts.domain import CollapseProbability


def probability(width=2, top=False):
    """Six frequencies, ten amplitudes, six variations; the boundary rises, ``width`` cells of it are uncertain."""
    f, a = np.linspace(0.5, 3.0, 6), np.linspace(0.1, 0.55, 10) * st.g
    codes = np.full((6, 10, 6), v.VERDICTS.index(v.STANDS), dtype=np.int8)
    for i in range(5):
        for j in range(2 + i, 10):
            share = 6 if j >= 2 + i + width else 6 * (j - 1 - i) // (width + 1)
            codes[i, j, : max(share, 1)] = v.VERDICTS.index(v.COLLAPSED)
    if top:
        codes[:, -1, -1] = v.VERDICTS.index(v.STANDS)
    codes[5, 8] = v.VERDICTS.index(v.UNDECIDED)
    zero = np.zeros(codes.shape, np.float32)
    return CollapseProbability(
        preset("paper-monolithic"), "dem2d", f, a, codes, zero, Scatter(), MotionScatter(), 0, 0.95, 1.0, {}
    )


def test_the_title_says_how_wide_the_doubt_is():
    title = plots.draw_probability(probability()).get_suptitle()
    assert "17 % of the cells are uncertain" in title
    assert "the uncertain band is 0.1 g wide" in title
    assert "beyond the largest amplitude" in plots.draw_probability(probability(top=True)).get_suptitle()


def test_classes_darken_evenly_in_grey():
    grey = [float(np.dot(to_rgb(color), (0.299, 0.587, 0.114))) for _, _, color in CLASSES]
    assert (np.diff(grey) < -0.08).all()


def test_the_cut_shows_intervals_and_shares():
    result = probability()
    cut = plots.draw_probability(result).axes[1]
    shares = cut.lines[0].get_xdata()
    i = int(np.flatnonzero((result.frequency == shares).all(axis=1))[0])
    segments = np.array([segment[:, 0] for segment in cut.collections[0].get_segments()])
    np.testing.assert_allclose(segments.T, [limit[i] for limit in result.interval])


@pytest.mark.parametrize("top", [False, True])
def test_nothing_is_cut_off_and_axes_have_units(top):
    figure = plots.draw_probability(probability(top=top))
    figure.draw_without_rendering()
    for axes in figure.axes:
        box = axes.get_tightbbox()
        assert box.x0 >= figure.bbox.x0 - 1
        assert box.x1 <= figure.bbox.x1 + 1
    assert [axes.get_xlabel()[-1] for axes in figure.axes] == ["]", "]"]
    assert figure.axes[0].get_ylabel().endswith("[g]")
