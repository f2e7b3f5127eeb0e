"""Marks of links: where they are in a picture, and what becomes of them when they break."""

from __future__ import annotations

import numpy as np
import pytest

import stylobate as st
from stylobate.column.assembly import Assembly, Block
from stylobate.column.links import block_link
from stylobate.plots.film import draw_filmstrip, draw_frame, film_data
from stylobate.plots.scene import Scene, link_marks
from stylobate.simulate import simulate

JOINT = st.Joint(normal_stiffness=5e9, shear_stiffness=2.5e9, friction_coefficient=0.2)
LINKS = (
    st.Dowel(joint=2, at=(0.1, 0.0), shear_stiffness=1e7, shear_capacity=100.0, failure="brittle", embedment=0.1),
    st.Tie(at=(0.3, 0.0), from_height=0.0, to_height=1.1, axial_stiffness=1e5),
    st.Layer(joint=1, damping=1.0),
)


@pytest.fixture(scope="module")
def response() -> st.Response:
    column = st.Column.of_drums([st.Drum(0.6, 0.5, 0.5, 2500.0)] * 2, JOINT).replace(links=LINKS)
    return st.simulate(column, st.harmonic(frequency=2.0, amplitude=4.0, duration=0.5), st.DistinctElement2D())


def test_marks_stand_where_the_links_are_and_know_which_are_broken(response) -> None:
    first, last = (link_marks(Scene(response), index) for index in (0, len(response.time) - 1))
    assert len(first) == len(last) == 2  # a layer has no mark
    assert first[0][0] == pytest.approx(np.array([(0.1, 0.5), (0.1, 0.7)]), abs=1e-4)
    assert first[1][0] == pytest.approx(np.array([(0.3, 0.0), (0.3, 1.1)]), abs=1e-4)
    assert [broken for _, broken in first] == [False, False]
    assert [broken for _, broken in last] == [True, False]


def test_players_are_told_of_them(response) -> None:
    (dowel, tie) = film_data(Scene(response), np.array([0, 5]))["links"]
    assert dowel[:3] == [0, [0.1, 0.0, 0.2], 0]  # over the joint's middle by its embedment, on the lower drum
    assert dowel[4] == response.measures.links[0].broken_at
    assert tie == [None, [0.3, 0.0, 0.0], 1, [0.3, 0.0, 0.2], None]


def test_marks_between_blocks_stay_on_them() -> None:
    blocks = (
        Block(((0.0, 0.0), (1.0, 0.0), (1.0, 0.5), (0.0, 0.5)), 2000.0, "a"),
        Block(((1.0, 0.0), (2.0, 0.0), (2.0, 0.5), (1.0, 0.5)), 2000.0, "b"),
    )
    links = (
        block_link("clamp", ("a", "b"), (0.8, 0.4), (1.2, 0.4), axial_stiffness=1e7, shear_stiffness=1e7),
        block_link("dowel", ("ground", "a"), (0.5, 0.0), shear_stiffness=1e7, embedment=0.1),
    )
    pair = Assembly(blocks, JOINT, "pair", links=links)
    response = simulate(pair, st.harmonic(frequency=2.0, amplitude=1.0, duration=0.05), st.DistinctElement2D())
    marks = link_marks(Scene(response), 0)
    assert marks[0][0] == pytest.approx(np.array([(0.8, 0.4), (1.2, 0.4)]), abs=1e-4)
    assert marks[1][0] == pytest.approx(np.array([(0.5, -0.1), (0.5, 0.1)]), abs=1e-4)
    clamp, dowel = film_data(Scene(response), np.array([0]))["links"]
    assert (clamp[0], clamp[2], dowel[0]) == (0, 1, None)


def test_strips_and_frames_draw_them(response) -> None:
    strip = draw_filmstrip(response)
    panels = [axes for axes in strip.axes if any(line.get_gid() == "link" for line in axes.lines)]
    assert len(panels) > 1
    styles = {line.get_linestyle() for line in panels[-1].lines if line.get_gid() == "link"}
    assert styles == {"-", ":"}
    frame = draw_frame(Scene(response), 0)
    assert sum(line.get_gid() == "link" for line in frame.axes[0].lines) == 2
