"""Soft joints: the step resolves the motion, and a column does not sink into its joints."""

import dataclasses
from collections import Counter

import numpy as np
import pytest

import stylobate as st
from stylobate.column import Joint
from stylobate.column.catalogue import preset
from stylobate.models.base import Case
from stylobate.models.engine import engine_for
from stylobate.models.shared.stable_step import longest_step, whole_steps
from stylobate.motion import Motion, harmonic
from stylobate.simulate import run_cases

MODELS = [st.DistinctElement2D(), st.RigidBlock()]


def on_joints(stiffness, name="paper-monolithic"):
    stone = preset(name)
    joint = Joint(stiffness, 0.5 * stiffness, friction_coefficient=0.7)
    return dataclasses.replace(stone, joints=(joint,) * stone.n)


def outcomes(column, motions, model):
    cases = [Case(column, motion) for motion in motions]
    return [measures.outcome.label for _, measures in sorted(run_cases(cases, model, threads=1), key=lambda p: p[0])]


def test_fast_shaking_of_soft_joints_ends_as_with_a_finer_step():
    # The largest stable step, 15 ms here, passes over whole cycles of 25 and 50 Hz: 5 of 15 verdicts were wrong.
    column = on_joints(1e7)
    motions = [harmonic(f, a * st.g, 5.0) for f in (10.0, 25.0, 50.0) for a in (1.0, 2.0, 4.0, 6.0, 8.0)]
    model = st.DistinctElement2D()
    assert engine_for(model, column).step > 10.0 * longest_step(motions[-1])
    actual = outcomes(column, motions, model)
    finer = [
        outcomes(column, [motion], st.DistinctElement2D(time_step=0.2 * longest_step(motion)))[0] for motion in motions
    ]
    assert actual == finer, Counter(zip(actual, finer))


def test_the_step_resolves_the_motion():
    for dt in (0.005, 0.02):
        rng = np.random.default_rng(1)
        record = Motion(dt, rng.standard_normal(2000))
        assert 0.5 * dt <= longest_step(record) < dt
    assert longest_step(harmonic(25.0, 1.0, 4.0)) == pytest.approx(0.01 / 25.0, rel=1e-3)
    assert whole_steps(harmonic(25.0, 1.0, 4.0), 0.0, 0.01)[0] <= 0.01 / 25.0
    assert whole_steps(harmonic(1.0, 1.0, 4.0), 0.0, 1e-4)[0] <= 1e-4  # a stiff column's step is its own
    assert longest_step(Motion(0.1, np.ones(10))) == 0.05


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_a_stated_step_that_passes_over_the_motion_is_refused(model):
    coarse = dataclasses.replace(model, time_step=2e-3)
    with pytest.raises(st.InputError, match=r"time_step is 0\.002 s; the longest one that resolves"):
        st.simulate(on_joints(1e7), harmonic(25.0, 1.0, 1.0), coarse)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
@pytest.mark.parametrize("name", ["paper-monolithic", "paper-12-drums"])
def test_a_column_that_sinks_into_its_joints_is_refused(model, name):
    column = on_joints(1e7, name)
    # as the weights above each joint say: Σ W / (k_n A) against a hundredth of the height
    sinking = sum(w / (1e7 * a) for w, a in zip(column.joint_weights, column.joint_areas, strict=True)) / column.height
    soft = on_joints(1e7 * sinking / 0.0101, name)
    with pytest.raises(
        st.InputError, match=r"sinks by 0\.0101 of its height under its own weight; allowed is up to 0\.01"
    ):
        st.simulate(soft, harmonic(1.0, 0.1, 1.0), model)
    firm = on_joints(1e7 * sinking / 0.0099, name)
    engine_for(model, firm).check(harmonic(1.0, 0.1, 1.0))
