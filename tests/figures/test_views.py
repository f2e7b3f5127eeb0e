"""Elevations from two sides and the plan: measures, names, one scale of both elevations."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

import stylobate as st
from stylobate import plots
from stylobate.column.links import block_link
from stylobate.column.shapes import about
from stylobate.plots.style import BLUE

FOLDER = Path(__file__).parents[2] / "gallery" / "assemblies"


def words(axes):
    return [text.get_text() for text in axes.texts]


def test_views_of_an_assembly_in_space():
    """Widths, depth and height in m where they are true; names of what is seen; metres a point the same in elevations."""
    figure = plots.draw_views(st.read_assembly(FOLDER / "portal_in_space.toml"), "portal")
    front, side, plan, oblique = figure.axes
    assert {"3.200 m", "4.600 m", "left", "right", "beam"} <= set(words(front))
    assert {"0.800 m", "4.600 m", "right"} <= set(words(side))
    assert "left" not in words(side)  # behind the other
    assert {"3.200 m", "0.800 m", "beam"} <= set(words(plan))
    assert words(oblique) == []
    figure.draw_without_rendering()
    scales = [np.ptp(axes.get_xlim()) / axes.get_position().width for axes in (front, side)]
    assert scales[0] == pytest.approx(scales[1], rel=1e-6)
    assert len(plan.collections[0].get_paths()) > 3


def test_links_are_marked_where_they_are():
    """A tie beside a turned box, seen from both sides and from above."""
    stone = st.Stone.box((1.0, 0.5, 2.0), (0.0, 0.0, 0.0), 2000.0, name="box", orientation=about((0.0, 0.0, 1.0), 0.5))
    tie = block_link("tie", ("ground", "box"), (0.7, 0.8, 0.0), (0.7, 0.8, 1.5), axial_stiffness=1e6)
    law = st.Joint(1e9, 5e8, friction_coefficient=0.7)
    figure = plots.draw_views(st.SpatialAssembly((stone,), law, links=(tie,)))
    marks = [[line.get_xydata() for line in axes.lines if line.get_color() == BLUE] for axes in figure.axes]
    assert [len(lines) for lines in marks] == [1, 1, 1, 1]
    expected = [(0.7, 0.0), (0.7, 1.5)], [(0.8, 0.0), (0.8, 1.5)], [(0.7, 0.8), (0.7, 0.8)]
    for (segment,), ends in zip(marks, expected):
        assert segment == pytest.approx(np.array(ends), abs=1e-12)


def test_a_column_has_one_height_however_it_leans():
    """That of its drums, 7.0785 m: in words, and drawn from every side; the box around it is 7.1 m high."""
    joint = st.Joint(5e10, 2.5e10, friction_coefficient=0.7)
    drums = [st.Drum(high, 1.1, 1.1, 2600.0, "circular") for high in (2.0, 2.5, 2.5785)]
    leans = st.AsFound((st.FoundDrum(2, tilt=1.0, tilt_azimuth=40.0),), base_tilt=0.5, base_azimuth=70.0)
    column = st.Column.of_drums(drums, joint).replace(as_found=leans)
    box = np.concatenate([part.mesh(48).vertices for body in column.bodies for part in body.placed])
    assert np.ptp(box[:, 2]) > 7.09
    front, side, _, _ = plots.draw_views(column).axes
    (elevation,) = plots.draw_elevation(column).axes
    assert all(f"{column.height:.3f} m" in words(axes) for axes in (front, side, elevation))
    assert "7.0785 m high" in column.describe()
    assert [label for axes in (front, side) for label in words(axes) if re.fullmatch(r"7\.\d+ m", label)] == [
        "7.079 m"
    ] * 2


@pytest.mark.parametrize("north", [0.0, 37.0, 270.0])
def test_north_stands_beside_the_plan_where_it_is_stated(north):
    """x points so far clockwise from north: north is so far from x towards y."""
    column = st.read_column(FOLDER / "column5.toml")
    plan = plots.draw_views(column.replace(north=north)).axes[2]
    (arrow,) = [text for text in plan.texts if text.get_text() == "N"]
    assert math.degrees(math.atan2(*arrow.xyann[::-1])) % 360.0 == pytest.approx(north)
    assert "N" not in words(plots.draw_views(column).axes[2])


@pytest.mark.parametrize("name", ["column", "plane", "specimen", "found"])
def test_views_of_everything_that_stands(name):
    as_found = st.AsFound(
        (st.FoundDrum(2, offset=0.05, tilt=1.0, tilt_azimuth=40.0),), base_tilt=0.5, base_azimuth=90.0
    )
    column = st.read_column(FOLDER / "column5.toml")
    cube = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    structure = {
        "column": column,
        "found": column.replace(as_found=as_found),
        "plane": st.read_assembly(FOLDER / "portal.toml"),
        "specimen": st.Specimen(100.0, [20.0, 20.0, 20.0], cube, name="cube"),
    }[name]
    front, side, plan, _ = plots.draw_views(structure).axes
    assert len(front.collections[0].get_paths()) >= len(structure.shapes) - 1
    sizes = [
        float(text.removesuffix(" m")) for axes in (front, side, plan) for text in words(axes) if text.endswith(" m")
    ]
    assert len(sizes) == 6
    corners = np.concatenate([body.corners for body in structure.bodies if not body.fixed])
    assert max(sizes[:2]) == pytest.approx(np.ptp(corners, axis=0).max(), rel=5e-3)
