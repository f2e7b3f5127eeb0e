"""Pushover curve and mechanism: drawn, with axes and units."""

import pytest

from stylobate.column import preset
from stylobate.models.rigid_block.block_stack import BlockStack
from stylobate.plots import draw_mechanism, draw_pushover
from stylobate.statics.limit import limit_analysis
from stylobate.statics.pushover import pushover


def test_pushover_figure_shows_curve_and_units():
    column = preset("paper-12-drums")
    path = pushover(column)
    figure = draw_pushover(BlockStack.of_column(column), path, 0.2046)
    curve, picture = figure.axes[:2]
    assert "[m]" in curve.get_xlabel()
    assert "[g]" in curve.get_ylabel()
    heights = max(line.get_ydata().max() for line in curve.lines if len(line.get_ydata()) > 50)
    assert heights == pytest.approx(path.collapse_multiplier)
    assert len(picture.patches) == 2 * column.n


def test_a_path_without_a_peak_shows_none():
    column = preset("paper-12-drums")
    figure = draw_pushover(BlockStack.of_column(column), pushover(column, to=1e-4), 0.2046)
    assert len(figure.axes) == 2  # no look at the peak from near
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert not any(label.startswith("peak") for label in labels)
    assert any("still rising" in label for label in labels)
    assert figure.axes[0].get_ylim()[1] > 0.2046


def test_mechanism_leans_to_the_right():
    column = preset("paper-monolithic")
    figure = draw_mechanism(BlockStack.of_column(column), limit_analysis(column))
    axes = figure.axes[0]
    before, after = (patch.get_xy().mean(axis=0) for patch in axes.patches)
    assert after[0] > before[0]
    assert "rocking right" in axes.get_title(loc="left")
