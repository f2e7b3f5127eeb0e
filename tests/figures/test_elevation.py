"""Elevations: every dimension is written where it is true, what is as found and links are marked."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

import stylobate as st
from stylobate import plots
from stylobate.plots.drawing import outlines_of
from stylobate.plots.style import BLUE, RED

DRUMS = [
    st.Drum(h, b, t, 2600.0, section="circular") for h, b, t in ((0.9, 1.1, 1.0), (0.8, 1.0, 0.92), (0.5, 1.2, 1.2))
]
JOINT = st.Joint(5e10, 2.5e10, 35.0)
COLUMN = st.Column.of_drums(
    DRUMS, JOINT, overrides={2: st.Joint(5e10, 2.5e10, friction_coefficient=0.4)}, name="north 5"
)


def words(axes):
    return [text.get_text() for text in axes.texts]


def test_heights_widths_numbers_and_joints():
    (axes,) = plots.draw_elevation(COLUMN).axes
    labels = words(axes)
    assert {"0.900", "0.800", "0.500", "2.200 m", "1", "2", "3"} <= set(labels)
    assert {"⌀ 1.100 – 1.000", "⌀ 1.100 m", "⌀ 1.200 m", "joint 1", "joint 2, μ = 0.4", "joint 3"} <= set(labels)
    assert axes.get_aspect() == 1.0
    drawn = [patch.get_xy() for patch in axes.patches if isinstance(patch, Polygon)]
    assert np.ptp(np.concatenate(drawn), axis=0) == pytest.approx([1.2, 2.2])
    levels = [text.get_position()[1] for text in axes.texts if text.get_text() in ("0.900", "0.800", "0.500")]
    assert levels == pytest.approx([0.45, 1.3, 1.95])


@pytest.mark.parametrize("azimuth", [0.0, 90.0])
def test_what_is_as_found_is_red_and_said(azimuth):
    as_found = st.AsFound(
        (st.FoundDrum(2, offset=0.04, offset_azimuth=azimuth, tilt=0.5, tilt_azimuth=azimuth),), base_tilt=1.0
    )
    (axes,) = plots.draw_elevation(COLUMN.replace(as_found=as_found)).axes
    red = [patch for patch in axes.patches if to_hex(patch.get_edgecolor()) == RED]
    assert len(red) == 2  # the drum above goes along
    to = " to 90°" if azimuth else ""
    assert f"offset +40 mm{to}, lean +0.5°{to}" in words(axes)
    assert "base rises by 1° to the right" in words(axes)
    dashed = [patch for patch in axes.patches if isinstance(patch, Polygon) and not patch.get_fill()]
    assert len(dashed or [p for p in axes.patches if p.get_facecolor()[3] == 0.0]) == 3


def test_a_drum_that_comes_back_and_a_chipped_one_are_in_place():
    """Offsets are over the drum below: the one above a displaced drum that comes back stands where it was built."""
    as_found = st.AsFound(
        (
            st.FoundDrum(1, chip_right=0.06, chip_azimuth=30.0),
            st.FoundDrum(2, offset=0.038, offset_azimuth=120.0),
            st.FoundDrum(3, offset=-0.038, offset_azimuth=120.0),
        )
    )
    assert [as_found.displaced(drum) for drum in (1, 2, 3)] == [False, True, False]
    assert as_found.place(2) == pytest.approx((0.038, 120.0))
    (axes,) = plots.draw_elevation(COLUMN.replace(as_found=as_found)).axes
    filled = [patch for patch in axes.patches if patch.get_facecolor()[3] > 0.0]
    assert [to_hex(patch.get_edgecolor()) == RED for patch in filled] == [False, True, False]
    assert "offset −38 mm to 120°, back in line" in words(axes)
    farther = st.AsFound((st.FoundDrum(1, offset=0.03), st.FoundDrum(2, offset=0.04, offset_azimuth=90.0)))
    assert "offset +40 mm to 90°, in all 50 mm to 53°" in words(
        plots.draw_elevation(COLUMN.replace(as_found=farther)).axes[0]
    )


def test_outlines_stand_as_the_run_begins():
    as_found = st.AsFound((st.FoundDrum(2, offset=0.05, tilt=0.3),), base_tilt=0.4)
    column = COLUMN.replace(as_found=as_found)
    response = st.simulate(column, st.harmonic(2.0, 0.0, 0.02), st.DistinctElement2D())
    for i, shape in enumerate(outlines_of(column)):
        np.testing.assert_allclose(
            shape, response.outline(0, i), atol=1e-5
        )  # but for the joints' closing under the weight


def test_links_are_blue_at_their_place():
    dowel = st.Dowel(joint=2, at=(0.2, 0.0), diameter=0.03, embedment=0.1, material="titanium")
    core = st.Core(diameter=0.02, material="titanium")
    (axes,) = plots.draw_elevation(COLUMN.replace(links=(dowel, core))).axes
    blue = [line for line in axes.lines if line.get_color() == BLUE and len(line.get_xdata()) == 2]
    ends = {tuple(np.round(line.get_xydata().ravel(), 3)) for line in blue}
    assert (0.2, 0.8, 0.2, 1.0) in ends
    assert (0.0, 0.0, 0.0, 2.2) in ends


def test_an_assembly_by_name_and_size():
    corners = ((0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0))
    assembly = st.Assembly((st.Block(corners, 2000.0, name="pier"),), JOINT, name="pier alone")
    (axes,) = plots.draw_elevation(assembly, title="pier").axes
    assert {"pier", "1.000 m", "2.000 m"} <= set(words(axes))
    assert axes.get_title(loc="left") == "pier"


def test_pictures_of_one_axes_are_drawn_beside_each_other(rocking):
    figure = Figure(figsize=(9.0, 4.0))
    panels = figure.subplots(1, 3)
    assert plots.draw_joints(rocking, ax=panels[0]) is figure
    assert plots.draw_orbit(rocking, ax=panels[1]) is figure
    assert plots.draw_elevation(rocking.column, ax=panels[2]) is figure
    assert len(figure.axes) == 3
    assert all(axes.has_data() for axes in panels)


@pytest.fixture
def rocking():
    column = COLUMN.replace(joints=(JOINT,) * 3)
    made = st.simulate(column, st.harmonic(2.0, 0.0, 0.02), st.DistinctElement3D())
    return dataclasses.replace(made)


def test_long_names_of_drums_in_assemblies_are_cut_to_what_fits():
    folder = Path(__file__).parents[2] / "gallery" / "assemblies"
    (axes,) = plots.draw_elevation(st.read_assembly(folder / "clamped.toml")).axes
    assert words(axes).count("drum 5") == 3
    assert "west" in words(axes)
    assert not any(label.startswith("column") for label in words(axes))
