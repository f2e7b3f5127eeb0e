"""Pictures of assemblies in space that fell: regions over twins, histories along both axes, a strip that is one draw."""

import numpy as np
import pytest

import stylobate as st
from stylobate import plots
from stylobate.response import Response
from stylobate.response.assemblies import recorded_in_space
from stylobate.verdicts.population import BodyOverTwins, bodies_over_twins, not_yet_debris


@pytest.fixture(scope="module")
def fallen():
    """Two boxes, as if "tall" had gone 2 m along y and lay down there; nothing is computed."""
    stones = (
        st.Stone.box((0.5, 0.5, 2.0), (0.0, 0.0, 0.0), 2500.0, name="tall"),
        st.Stone.box((0.5, 0.5, 0.5), (3.0, 0.0, 0.0), 2500.0, name="low"),
    )
    scene = st.SpatialAssembly(stones, st.Joint(5e9, 2.5e9, 35.0), name="scene")
    time = np.linspace(0.0, 2.0, 41)
    position = np.tile(
        [body.position if hasattr(body, "position") else (0.0, 0.0, 0.0) for body in scene.bodies], (41, 1, 1)
    )
    axes = np.tile(np.eye(3), (41, 3, 1, 1))
    share = np.clip(time - 1.0, 0.0, 1.0)
    position[:, 1, 1] += 2.0 * share
    position[:, 1, 2] -= 0.75 * share
    c, s = np.cos(0.5 * np.pi * share), np.sin(0.5 * np.pi * share)
    axes[:, 1, 1, 1], axes[:, 1, 1, 2], axes[:, 1, 2, 1], axes[:, 1, 2, 2] = c, s, -s, c
    ground = np.zeros((41, 3))
    energy = {name: np.zeros(41) for name in ("input", "kinetic", "gravitational", "elastic", "friction", "viscous")}
    made = recorded_in_space(
        scene, time, position, axes, energy, ground, ground, at_rest=True, failure="", in_equilibrium=True,
        energy_imbalance=0.0, time_step=1e-4, steps=20000, model="dem3d", provenance={"motion": "none"}, struck_at=1.1,
    )  # fmt: skip
    return Response.of(made)


def test_what_it_says(fallen):
    """The way is along y, 90° from x; it struck something before it had fallen."""
    sentence = fallen.sentence
    assert sentence.startswith("1 of 2 blocks fell, the first at ")
    assert (
        "First fell tall, towards azimuth 90° (from x towards y); until then the joint of ground and tall" in sentence
    )
    assert "Assemblies in space are new" in fallen.describe()
    assert fallen.summary()["doubt"].startswith("Assemblies in space are new")
    assert repr(fallen).count("Assemblies in space are new") == 1


def test_histories_have_both_directions_and_the_height(fallen):
    figure = plots.draw_histories(fallen)
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == ["x\ndisplacement [m]", "y\ndisplacement [m]", "vertical\ndisplacement [m]", "ground\n[g]"]
    tall = figure.axes[1].lines[1].get_ydata()
    assert tall[-1] == pytest.approx(2.0)


def test_a_strip_says_that_it_is_one_draw(fallen):
    figure = plots.draw_filmstrip(fallen)
    assert "where pieces lie is one draw of many" in figure.get_suptitle().replace("\n", " ")
    assert {text.get_text() for axes in figure.axes for text in axes.texts} >= {"x →", "y →"}


def test_debris_is_drawn_as_regions(fallen, tmp_path):
    """Circles about the median place of each body that fell in some twin, dots for each run; 90 % is never the smaller."""
    ends = np.random.default_rng(1).normal((0.0, 2.0), size=(20, 2))
    bodies = (
        BodyOverTwins("tall", 18, 2, 0, 20, ends),
        BodyOverTwins("low", 0, 20, 0, 20, np.zeros((20, 2))),
    )
    figure = plots.draw_debris(fallen, bodies)
    (axes,) = figure.axes
    circles = [patch for patch in axes.patches if hasattr(patch, "radius")]
    assert [round(patch.radius, 9) for patch in circles] == [round(radius, 9) for radius in bodies[0].radii]
    inside = [np.mean(np.linalg.norm(ends - bodies[0].middle, axis=1) <= radius + 1e-12) for radius in bodies[0].radii]
    assert inside == [0.5, 0.9]
    assert "in 0 of" not in axes.get_title()
    assert axes.get_legend().get_texts()[0].get_text() == "tall: fell in 18 of 20"
    plots.save(figure, tmp_path / "debris")
    assert "fewer than 20" not in axes.get_xlabel()
    few = plots.draw_debris(fallen, (BodyOverTwins("tall", 3, 1, 1, 4, ends[:5]),))
    assert "from 5 runs, fewer than 20, the 90 % region is only that of what was seen" in few.axes[0].get_xlabel()
    assert few.axes[0].get_legend().get_texts()[0].get_text() == "tall: fell in 3 of 5, 1 undecided"
    plots.save(few, tmp_path / "few")
    moving = (BodyOverTwins("tall", 20, 0, 0, 5, ends),)
    assert not_yet_debris(moving) == "in 15 of 20 runs not all lay still at the end"
    assert bodies_over_twins([]) == ()
    nothing = plots.draw_debris(fallen, (bodies[1],))
    assert "nothing fell" in nothing.axes[0].texts[0].get_text()
