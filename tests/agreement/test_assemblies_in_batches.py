"""Assemblies in batches: without histories they come to the same, and what has fallen is not watched for ever."""

from types import SimpleNamespace

import numpy as np
import pytest

import stylobate as st
from stylobate.kernels.run_codes import CHUNK
from stylobate.models.base import Case, RunOptions
from stylobate.models.plane.loose import AFTER_THE_FALL, follow
from stylobate.simulate import run_cases, simulate

JOINT = st.Joint(1e8, 5e7, friction_angle=35.0)
MODEL = st.DistinctElement2D()


def box(name, left, low, width, height):
    corners = [(left, low), (left + width, low), (left + width, low + height), (left, low + height)]
    return st.Block(corners, density=2500.0, name=name, depth=0.8)


PORTAL = st.Assembly(
    [box("left", 0.0, 0.0, 0.8, 4.0), box("right", 3.2, 0.0, 0.8, 4.0), box("architrave", -0.1, 4.0, 4.2, 0.7)],
    JOINT,
    name="portal",
)


def batch(motions, model=MODEL, **options):
    results = dict(run_cases([Case(PORTAL, motion) for motion in motions], model, threads=1, **options))
    return [results[i] for i in range(len(motions))]


@pytest.mark.parametrize("losses", ["none", "stone"])
def test_without_histories_a_run_has_the_same_measures(losses):
    # Neither falls: the batch leaves out the ledger between start and end, and nothing else.
    model = st.DistinctElement2D(losses=losses)
    motions = [st.harmonic(1.0, size * st.g, 2.0) for size in (0.05, 0.25)]
    for measures, motion in zip(batch(motions, model), motions, strict=True):
        alone = simulate(PORTAL, motion, model).measures
        assert not alone.collapsed
        assert measures == alone


def test_a_run_that_is_cut_after_a_fall_is_not_told_at_rest():
    """Whatever lies still while the motion goes on; an engine that is still from the start, with a block 1 m lower."""
    height = np.zeros(len(PORTAL.bodies))

    def advance(chunks):
        height[:], engine.steps, engine.time = -1.0, engine.steps + chunks * CHUNK, engine.time + 0.1 * chunks

    def state():
        return {"z": height.copy(), "rotation": np.zeros(len(height)), "time": engine.time}

    engine = SimpleNamespace(
        structure=PORTAL, chunks=200, steps=0, time=0.0, dt=0.1 / CHUNK, duration=20.0, failed=False, now={"eta": 0.0},
        at_rest=lambda: True, advance=advance, state=state,
    )  # fmt: skip
    states, still = follow(engine, RunOptions())
    assert states[-1]["time"] < 6.0
    assert not still
    engine.steps, engine.time, height[:] = 0, 0.0, 0.0
    states, still = follow(engine, RunOptions(until_end=True))
    assert states[-1]["time"] == pytest.approx(20.0)
    assert still


def test_a_run_of_a_batch_ends_after_the_fall():
    # One push fells it in about two seconds, and 28 s of quiet follow.
    push = np.concatenate([0.6 * st.g * np.sin(np.pi * np.arange(0, 1.001, 0.01)), np.zeros(2900)])
    motion = st.Motion(0.01, push)
    [measures] = batch([motion])
    [whole] = batch([motion], until_end=True)
    alone = simulate(PORTAL, motion, MODEL).measures
    assert whole == alone
    assert measures.collapsed
    for name in ("outcome", "decided", "collapse_time", "peak_rotation", "peak_joint_opening", "time_step"):
        assert getattr(measures, name) == getattr(alone, name)
    assert measures.blocks.peak_displacement == alone.blocks.peak_displacement
    assert measures.blocks.fell_at == alone.blocks.fell_at
    ended = measures.steps * measures.time_step
    assert max(when for _, when in measures.blocks.fell_at) + AFTER_THE_FALL == pytest.approx(ended, abs=0.05)
    assert ended < 15.0 < whole.steps * whole.time_step
