"""Measures of each body of an assembly: who fell in which order and to which side, who is shifted."""

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.response.assemblies import body_measures, fallen, recorded_blocks, shifted_bodies
from stylobate.response.measures import BlockMeasures
from stylobate.response.words import sentence_of_blocks


def test_falls_sides_and_ways():
    """By hand: "b" leans 60° and lies 0.3 m along y, "c" drops straight down; the ground has no measures."""
    time = np.array([0.0, 1.0, 2.0])
    position = np.zeros((3, 4, 3))
    position[1:, 2] = (0.0, 0.3, -0.1)
    position[2, 3] = (0.0, 0.0, -2.0)
    tilt = np.zeros((3, 4))
    tilt[1:, 2] = math.radians(60.0)
    sizes = [math.nan, 1.0, 1.0, 1.0]
    a, b, c = body_measures(["ground", "a", "b", "c"], sizes, time, position, tilt, {2: 1, 3: 2}, [1, 2])
    assert (a.fell_at, a.displaced, b.displaced) == (None, True, False)
    assert (b.fell_at, c.fell_at, c.fall_azimuth) == (1.0, 2.0, None)
    assert b.fall_azimuth == pytest.approx(0.5 * math.pi)
    assert b.row()["peak_tilt_rad"] == pytest.approx(math.pi / 3.0)
    assert (b.row()["residual_displacement_m"], a.row()["residual_displacement_m"]) == (None, 0.0)
    assert c.row()["displacement_at_end_m"] == [0.0, 0.0, -2.0]


@pytest.mark.parametrize("drop", [0.24, 0.26])
@pytest.mark.parametrize("along", ["x", "y", "askew", "askew by its corners"])
def test_whether_a_beam_has_fallen_does_not_hang_on_how_it_lies_in_plan(along, drop):
    """Of 3 × 0.5 × 0.6 m: it has when it is lower by half of the 0.5 m."""
    angle = {"x": 0.0, "y": 0.5 * math.pi}.get(along, 0.7)
    if along == "askew by its corners":
        c, s = math.cos(angle), math.sin(angle)
        corners = [(c * x - s * y, s * x + c * y, z) for x in (-1.5, 1.5) for y in (-0.25, 0.25) for z in (0.0, 0.6)]
        beam = st.Stone.hull(corners, 2500.0)
    else:
        spin = (math.cos(0.5 * angle), 0.0, 0.0, math.sin(0.5 * angle))
        beam = st.Stone.box((3.0, 0.5, 0.6), (0.0, 0.0, 0.0), 2500.0, orientation=spin)
    assert sorted(beam.sides) == pytest.approx([0.5, 0.6, 3.0])
    assert beam.size == pytest.approx(3.0)
    scene = st.SpatialAssembly((beam,), st.Joint(5e9, 2.5e9, 35.0))
    first, axes = np.array([(0.0, 0.0, 0.0), beam.position]), np.tile(np.eye(3), (2, 1, 1))
    later = first - [(0.0, 0.0, 0.0), (0.0, 0.0, drop)]
    assert fallen(scene, first, axes, later, axes).tolist() == [False, drop > 0.25]


def made_in_the_plane(at_rest=True, failed=False):
    """Two blocks without joints, as if the first fell to the right and then slid left of where it stood, by its centroid,
    and the second were pushed aside; nothing is computed."""
    tall = [[0.0, 0.0], [0.4, 0.0], [0.4, 2.0], [0.0, 2.0]]
    low = [[3.0, 0.0], [3.5, 0.0], [3.5, 0.5], [3.0, 0.5]]
    blocks = (st.Block(tall, 2500.0, name="tall"), st.Block(low, 2500.0, name="low"))
    assembly = st.Assembly(blocks, st.Joint(5e9, 2.5e9, 35.0))
    time, zero = np.array([0.0, 1.0, 2.0]), np.zeros(3)
    x, z, rotation = (np.zeros((3, 3)) for _ in range(3))
    x[:, 1], x[:, 2] = (0.2, 1.2, -0.8), (3.25, 3.35, 3.35)
    z[:, 1:], rotation[1:, 1] = 1.0, -0.5 * math.pi
    made = recorded_blocks(
        assembly, time, x, z, rotation, {"input": zero}, zero, zero, at_rest=at_rest, failed=failed,
        in_equilibrium=True, energy_imbalance=0.0, time_step=1e-3, steps=2000, model="dem2d", provenance={},
    )  # fmt: skip
    return made.measures, sentence_of_blocks(made)


def test_the_first_to_fall_fell_to_its_own_side():
    measures, sentence = made_in_the_plane()
    assert measures.collapse.azimuth == measures.blocks.bodies[0].fall_azimuth == 0.0
    assert "First fell tall, to the right" in sentence
    assert sentence.endswith("Shifted, but standing: low.")


def test_what_still_moves_is_not_called_standing():
    measures, sentence = made_in_the_plane(at_rest=False)
    assert measures.blocks.displaced == ()
    assert sentence.endswith("Not all is at rest at the end: what has not fallen by then may yet fall.")


def test_a_run_that_failed_tells_nothing_as_fallen_or_displaced():
    blocks = made_in_the_plane(failed=True)[0].blocks
    assert (blocks.fell_at, blocks.displaced) == ((), ())
    assert [body.fell_at for body in blocks.bodies] == [None, None]


def test_of_a_joint_that_slid_the_body_that_moved_is_shifted():
    pairs = [(0, 1), (1, 2)]
    assert shifted_bodies(pairs, np.array([0.0, 0.01]), np.array([0.0, 0.001, 0.02]), [3], np.array([0.5])) == {2, 3}
    assert shifted_bodies(pairs, np.array([0.0005, 0.0005]), np.zeros(3), [], np.zeros(0)) == set()


def test_a_verdict_hangs_on_strikes_before_the_last_fall():
    struck, late = (BlockMeasures((("a", 2.0),), 1.0, 1.0, True, struck_at=when) for when in (1.0, 3.0))
    assert struck.hangs_on_strikes
    assert not late.hangs_on_strikes
    assert BlockMeasures((), 1.0, 1.0, True, struck_at=3.0).hangs_on_strikes
    assert not BlockMeasures((), 1.0, 1.0, True).hangs_on_strikes


def test_an_assembly_in_the_plane_tells_its_bodies_and_velocities(tmp_path):
    """A block thrown to the right at 3 m/s turns the one it strikes over; its file gives velocities back."""
    square = [[0.0, 0.0], [0.3, 0.0], [0.3, 0.3], [0.0, 0.3]]
    tall = [[0.0, 0.0], [0.2, 0.0], [0.2, 1.0], [0.0, 1.0]]
    pushed = st.Block(tall, 2500.0, name="tall")
    side = st.Block([[x - 3.0, z] for x, z in square], 2500.0, name="aside")
    assembly = st.Assembly((pushed, side), st.Joint(5e9, 2.5e9, 35.0))
    motion = st.harmonic(1.0, 0.5 * st.g, 2.0)
    response = st.simulate(assembly, motion, st.DistinctElement2D())
    summary = response.summary()
    assert summary["fallen"] == ["tall"]
    assert summary["bodies"]["tall"]["fall_azimuth_deg"] in (0.0, 180.0)
    assert summary["mechanism"]["first"] == "tall"
    assert "First fell tall, to the " in response.sentence
    assert response.body_velocity.shape == (len(response.time), 3, 3)
    speed = np.gradient(response.x[:, 1], response.time)
    late = slice(5, 40)
    assert response.body_velocity[late, 1, 0] == pytest.approx(speed[late], abs=0.05 * np.abs(speed[late]).max() + 1e-3)
    turning = np.gradient(response.rotation[:, 1], response.time)  # counter-clockwise is about −y
    assert response.body_angular_velocity[late, 1, 1] == pytest.approx(
        -turning[late], abs=0.05 * np.abs(turning[late]).max() + 1e-3
    )
    response.save(tmp_path / "response.nc")
    again = st.Response.load(tmp_path / "response.nc")
    assert np.array_equal(again.body_velocity, response.body_velocity)
    assert again.measures.blocks == response.measures.blocks
    column = st.simulate(st.preset("paper-monolithic"), st.harmonic(1.0, 0.1, 1.0), st.DistinctElement2D())
    with pytest.raises(AttributeError, match="velocities are recorded of assemblies only"):
        _ = column.body_velocity
