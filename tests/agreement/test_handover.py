"""Joints and the elastic bed: nothing jumps where one hands over to the other; columns keep their bits until then."""

import math
from dataclasses import replace

import numpy as np
import pytest

from stylobate.column import AsFound, Column, Drum, FoundDrum, Joint, preset
from stylobate.column.assembly import Assembly, Block
from stylobate.column.standing import of_column
from stylobate.constants import g
from stylobate.kernels.run_codes import CHUNK
from stylobate.models.base import RunOptions
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.engine import engine_for
from stylobate.models.plane.collapse import _ColumnRun
from stylobate.models.plane.loose import Loose
from stylobate.motion import Motion, harmonic
from stylobate.simulate import simulate

STILL = Motion(1.0, np.zeros(2))
SMOOTH = Joint(1e9, 5e8, friction_coefficient=0.0)


def box(x0, x1, z0, z1, name, **fields):
    return Block(((x0, z0), (x1, z0), (x1, z1), (x0, z1)), 2000.0, name, **fields)


def forces_along(engine, path):
    """Force and moment on the last body at every pose (x, z, angle) of a path that is gone through once."""
    forces = np.empty((len(path), 3))
    engine.start(1e-9)
    for k, (x, z, angle) in enumerate(path):
        b = engine.records.body[-1]
        b["x"], b["z"], b["th"], b["c"], b["s"] = x, z, angle, math.cos(angle), math.sin(angle)
        engine.renew_pairs()
        engine.kernel.loose_forces(engine.records.state, engine.search)
        forces[k] = b["fx"][0], b["fz"][0], b["mo"][0]
    return forces


def overturning(steps, depth=1e-4):
    """The upper of two blocks turns about the lower one's right corner from 20° to 70°, pressed on it by ``depth``."""
    angle = -np.radians(np.linspace(20.0, 70.0, steps))
    # its lower face passes `depth` under the corner (0.5, 1); the corner touches it 0.2 from the middle
    along = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    up = np.stack((-np.sin(angle), np.cos(angle)), axis=1)
    centre = np.array([0.5, 1.0]) - 0.2 * along + (0.5 - depth) * up
    return np.column_stack((centre, angle))


def sliding_off(steps, depth=1e-4):
    """The upper block slides over the edge of the lower one until its faces part."""
    return np.column_stack((np.linspace(0.7, 1.05, steps), np.full(steps, 1.5 - depth), np.zeros(steps)))


@pytest.mark.parametrize("path", [overturning, sliding_off])
def test_no_jump_where_a_joint_hands_over(path):
    blocks = (box(-0.5, 0.5, 0.0, 1.0, "lower", fixed=True), box(-0.5, 0.5, 1.0, 2.0, "upper"))
    assembly = Assembly(blocks, SMOOTH, ground=None)
    jumps, weights = [], None
    for steps in (4_000, 8_000, 16_000):
        engine = Loose(assembly, DistinctElement2D(), STILL, 1.0)
        assert len(engine.records.joint) == 1
        force = forces_along(engine, path(steps))
        weights = engine.hand["weight"][0]
        jumps.append(np.abs(np.diff(force, axis=0)).max() / np.abs(force).max())
    assert weights == 0.0  # the joint is gone at the end of the path
    assert jumps[2] < 0.3 * jumps[0]  # a jump would not shrink with the steps
    assert jumps[2] < 2e-3


def test_no_jump_on_a_slow_path_over_an_edge():
    """A tilted block slides over the corner of a fixed one, from face to side: corner to edge, corner to corner."""
    jumps = []
    for steps in (8_000, 16_000, 32_000):
        blocks = (box(-1.0, 0.0, -1.0, 0.0, "edge", fixed=True), box(2.0, 3.0, 2.0, 3.0, "block"))
        with pytest.warns(UserWarning, match="will fall"):
            engine = Loose(Assembly(blocks, SMOOTH, ground=None), DistinctElement2D(), STILL, 1.0)
        turn = np.linspace(0.0, 0.5 * math.pi, steps)
        radius = 0.5 * math.sqrt(2.0)
        # round the corner (0, 0), pressed in by 0.5 mm, turning on the way
        angle = 0.25 * math.pi - turn + 7e-4 * np.sin(8.0 * turn)
        path = np.column_stack(((radius - 5e-4) * np.sin(turn), (radius - 5e-4) * np.cos(turn), angle))
        force = forces_along(engine, path)
        assert (np.hypot(force[:, 0], force[:, 1]) > 0.0).mean() > 0.05
        jumps.append(np.abs(np.diff(force, axis=0)).max() / np.abs(force).max())
    assert jumps[2] < 0.3 * jumps[0]


#: Every kind of what may be found, in equilibrium.
FOUND = preset("paper-12-drums").replace(
    as_found=AsFound(
        (FoundDrum(1, tilt=0.3), FoundDrum(3, offset=0.02), FoundDrum(7, offset=-0.03, tilt=-0.6, chip_left=0.05)), 0.4
    )
)


@pytest.mark.parametrize(
    "column", [preset("paper-12-drums"), preset("paper-monolithic"), FOUND], ids=["12", "1", "found"]
)
@pytest.mark.parametrize("model", [DistinctElement2D(), DistinctElement2D(points=3, stiffness_damping=1e-5)])
def test_until_something_comes_loose_every_bit_is_that_of_the_joints_alone(column, model):
    motion = harmonic(1.0, 0.35 * g, 3.0)
    alone = simulate(column, motion, model)
    followed = simulate(column, motion, model, until_end=True)
    assert not alone.collapsed
    assert alone.measures == followed.measures
    assert followed.provenance["first_foreign_contact_s"] is None
    for field in ("time", "drum_x", "drum_z", "drum_rotation", "joint_slip", "top_displacement"):
        assert np.array_equal(getattr(alone.histories, field), getattr(followed.histories, field))


@pytest.mark.parametrize("certain", [False, True])
@pytest.mark.parametrize("column", [preset("paper-12-drums"), FOUND], ids=["12", "found"])
def test_what_may_come_loose_has_the_joints_of_the_lanes(column, certain, monkeypatch):
    """As an assembly from the start, a column's motion to rounding: with the search, and without while nothing is loose."""
    if not certain:
        monkeypatch.setattr(Loose, "chunks_ahead", lambda _: 0)
    motion = harmonic(1.0, 0.15 * g, 2.0)
    model = DistinctElement2D(start="settle")
    lanes = simulate(column, motion, model)
    options = RunOptions()
    run = _ColumnRun(column, motion, engine_for(model, column).block(replace(options, until_end=True)), model, options)
    run.loose = True
    start = run.engine.records.body["x"][:, 0].copy()
    run.advance(run.engine.chunks)
    moved = run.engine.records.body["x"][:, 0] - start
    assert moved[1:] == pytest.approx(lanes.drum_x[-1] + moved[0], abs=1e-11)
    assert np.abs(lanes.drum_x).max() > 1e-6


def test_a_column_becomes_an_assembly():
    column = preset("paper-12-drums")
    assembly = of_column(column)
    assert len(assembly.joints) == column.n
    assert sum(block.properties[0] for block in assembly.blocks) == pytest.approx(column.mass)


def test_a_column_on_a_narrow_step_falls_past_its_edge():
    joint = Joint(1e9, 5e8, friction_coefficient=0.7)
    column = Column.tapered(height=2.0, bottom_width=0.4, top_width=0.4, drums=2, density=2000.0, joint=joint)
    motion = harmonic(0.8, 0.5 * g, 2.0)
    blocks = (box(-0.4, 0.4, -0.5, 0.0, "step", fixed=True), *of_column(column).blocks)
    standing = Assembly(blocks, joint, ground=-0.5)
    response = simulate(standing, motion, DistinctElement2D(mass_damping=0.1), until_rest=True, output_interval=0.02)
    assert response.collapsed
    assert response.body_position[-1, :, 2].min() < -0.2  # below the top of the step
    assert response.measures.blocks.at_rest


def test_a_joint_that_has_parted_stays_the_bed_s_where_its_faces_meet_again():
    blocks = (box(-0.5, 0.5, 0.0, 1.0, "lower", fixed=True), box(-0.5, 0.5, 1.0, 2.0, "upper"))
    engine = Loose(Assembly(blocks, SMOOTH, ground=None), DistinctElement2D(), STILL, 1.0)
    engine.start(1e-4)
    assert engine.chunks_ahead() > 0
    forces_along(engine, [(1.05, 1.5, 0.0), (0.0, 1.5, 0.0)])  # off the edge, and back as drawn
    assert engine.hand["live"][0] == 0
    assert engine.chunks_ahead() == 0


def test_a_column_that_collapses_as_its_motion_ends_goes_on():
    """Elastic, so that nothing but the run itself asks for fine steps: it is computed on, not left where it was."""
    column = Column.of_drums([Drum(4.0, 0.4, 0.4, 2000.0)], Joint(1e10, 5e9, friction_coefficient=0.7))
    whole = harmonic(0.5, 0.3 * g, 2.0)
    motion = Motion(whole.dt, whole.factor * whole.samples[: round(1.3 / whole.dt)])
    model, options = DistinctElement2D(restitution=1.0), RunOptions(until_rest=True)
    run = _ColumnRun(column, motion, engine_for(model, column).block(replace(options, until_end=True)), model, options)
    while run.chunks_left() > 0:
        run.advance(run.chunks_left())
    assert run.collapsed
    before = int(run.block.feed["step"][0, 0])
    turned = float(run.block.records.body["th"][1, 0])
    run.advance(8)
    assert run.engine.steps == before + 8 * CHUNK
    assert abs(float(run.block.records.body["th"][1, 0])) > abs(turned)
