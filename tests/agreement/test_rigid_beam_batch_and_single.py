"""The rigid beam: batch against single run, fixed against adaptive step, drums welded by stiff joints, refused input."""

import numpy as np
import pytest
from oracles.adaptive_beam import run_adaptive, run_as

from stylobate.column import Column, Joint, preset
from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.models.base import Case, RunOptions
from stylobate.models.rigid_beam.lanes import BeamLanes, loop_for
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.motion import Motion, harmonic
from stylobate.outcome import Outcome
from stylobate.response import Measures
from stylobate.simulate import run_cases, simulate

SOFT = Joint(normal_stiffness=1e9, shear_stiffness=5e8, friction_coefficient=0.7)


def stack(drums: int, section: str = "rectangular") -> Column:
    return Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=drums, density=1600.0, joint=SOFT, section=section
    )


def shaken(amplitude: float, vertical: bool = False) -> Motion:
    time = np.linspace(0.0, 1.0, 501)
    up = 0.3 * g * np.sin(20 * time) if vertical else None
    return Motion(time[1], amplitude * np.sin(2 * np.pi * time), vertical=up)


@pytest.mark.slow
@pytest.mark.parametrize("model", [RigidBeam(), RigidBeam(sliding=True)])
def test_same_bits_for_any_order_and_number_of_threads(model):
    cases = []
    for k in range(40):
        motion = shaken((0.15 + 0.01 * k) * g, vertical=k % 5 == 0 and not model.sliding)
        section = "circular" if k % 3 == 0 and not model.sliding else "rectangular"
        cases.append(Case(stack(1 + k % 2, section), motion))
    reference = dict(run_cases(cases, model, threads=1))
    threaded = dict(run_cases(cases, model, threads=2))
    order = np.random.default_rng(1).permutation(len(cases))
    shuffled = {order[i]: m for i, m in run_cases([cases[i] for i in order], model, threads=1)}
    for index, measures in reference.items():
        assert repr(threaded[index]) == repr(measures)
        assert repr(shuffled[index]) == repr(measures)
    for index in (0, 7):
        assert repr(simulate(*cases[index], model).measures) == repr(reference[index])


@pytest.mark.parametrize("model", [RigidBeam(), RigidBeam(sliding=True), RigidBeam(stiffness_damping=1e-4)])
@pytest.mark.parametrize("vertical", [False, True])
def test_a_failed_run_leaves_nothing_behind_in_its_lane(model, vertical):
    case = Case(stack(2), shaken(0.25 * g, vertical))
    block = BeamLanes(model.pack, loop_for(model.pack(case.column), case.motion), RunOptions())

    def run(lane: int) -> Measures:
        while not block.is_over(lane):
            block.advance()
        return block.collect(lane)

    block.load(3, case)
    expected = run(3)
    assert expected.outcome is Outcome.ROCKED
    for lane in (3, 5):
        block.load(lane, case)
    block.drum["w"][2, 3] = np.nan
    assert repr(run(5)) == repr(expected)
    failed = run(3)
    assert failed.outcome is Outcome.FAILED
    assert not failed.decided
    assert "not finite" in failed.reason
    block.load(3, case)
    assert repr(run(3)) == repr(expected)


@pytest.mark.parametrize(
    ("model", "vertical"),
    [
        (RigidBeam(), False),
        (RigidBeam(moment_law="trilinear", xi=0.9, stiffness_damping=1e-4), True),
        (RigidBeam(moment_law="bilinear", second_order="law"), False),
        (RigidBeam(sliding=True, stiffness_damping=1e-4), True),
        (RigidBeam.paper(), True),
    ],
)
def test_fixed_step_agrees_with_the_adaptive_one(model, vertical):
    # The adaptive one uses full matrices: the sweeps through the tridiagonal matrix are checked as well.
    column = stack(3, "circular").with_joint(friction_coefficient=0.17) if model.sliding else stack(3, "circular")
    motion = shaken(0.24 * g, vertical)
    step = 5e-4 if model.sliding else 1e-4
    fixed, adaptive = (
        run_as(solver, column, motion, RigidBeam(**(model.parameters() | {"time_step": step})))
        for solver in ("fixed", "adaptive")
    )
    assert fixed.outcome == adaptive.outcome
    assert fixed.peak_top_displacement == pytest.approx(adaptive.peak_top_displacement, rel=2e-3)
    assert fixed.residual_top_displacement == pytest.approx(adaptive.residual_top_displacement, rel=4e-3, abs=1e-4)
    if model.sliding:
        assert fixed.residual_joint_slip == pytest.approx(adaptive.residual_joint_slip, rel=1e-2)
        assert fixed.residual_joint_slip > 1e-3


def test_both_solvers_count_the_same_collapses():
    column = preset("paper-monolithic")
    motions = [harmonic(f, a * g, 6.0) for f in (0.5, 0.8) for a in (0.22, 0.28, 0.34, 0.40, 0.46)]
    cases = [Case(column, motion) for motion in motions]

    def count(**settings) -> int:
        model = RigidBeam(**settings)
        return sum(m.collapsed for _, m in run_cases(cases, model, threads=1))

    fixed = [count(), count(time_step=5e-4), count(time_step=2.5e-4)]
    adaptive = sum(run_adaptive(column, motion, RigidBeam(), output_interval=0.1).collapsed for motion in motions)
    assert 0 < min(fixed) <= max(fixed) < len(motions)
    spread = max(1, max(fixed) - min(fixed))
    assert abs(adaptive - fixed[0]) <= spread


@pytest.mark.parametrize(
    ("solver", "model"),
    [("fixed", RigidBeam()), ("fixed", RigidBeam(sliding=True)), ("adaptive", RigidBeam.paper())],
)
def test_the_tail_changes_nothing_before_it(solver, model):
    motion = shaken(0.3 * g, vertical=True)
    cut = motion.replace(
        acceleration=motion.samples[:380], vertical=motion.z_samples[:380]
    )  # ends at 0.76 s in full swing
    short, long = (run_as(solver, stack(2), cut, model, tail=tail, output_interval=0.02) for tail in (0.0, 0.5))
    n = len(short.time) - 1
    assert np.allclose(short.time[:n], long.time[:n], rtol=1e-12, atol=0.0)
    assert np.abs(short.drum_rotation[:n]).max() > 1e-3
    if solver == "fixed":
        assert np.array_equal(short.time, long.time[: n + 1])
        assert np.array_equal(short.drum_rotation, long.drum_rotation[: n + 1])
        assert np.array_equal(short.energy["kinetic"], long.energy["kinetic"][: n + 1])
    else:
        assert np.allclose(short.drum_rotation[:n], long.drum_rotation[:n], rtol=1e-6, atol=1e-12)


@pytest.mark.parametrize("solver", ["fixed", "adaptive"])
def test_a_motion_counts_up_to_its_last_sample(solver):
    # The base goes off under a block that hardly holds on to it: the block has the impulse of the push less friction's, all
    # but a thousandth for the shear that builds up first. Half the last sample would lack five times that.
    joint = Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_coefficient=0.01)
    column = Column.tapered(height=1.0, bottom_width=3.0, top_width=3.0, drums=1, density=2000.0, joint=joint)
    push, length = 0.3 * g, 0.005
    motion = Motion(length, np.ones(2), factor=push)
    response = run_as(solver, column, motion, RigidBeam(sliding=True), output_interval=length)
    speed = (push - 0.01 * g) * length
    assert response.energy["kinetic"][-1] == pytest.approx(0.5 * column.mass * speed**2, rel=2e-3)


def test_at_rest_below_the_opening_of_the_bed():
    # The base of a bed without tension opens at a third of what overturns the block: 0.068 g here.
    time = np.linspace(0.0, 0.5, 501)
    motion = Motion(time[1], np.sin(2 * np.pi * time), factor=0.05 * g)
    for drums in (1, 4):
        column = Column.tapered(
            height=5.0, bottom_width=0.96, top_width=0.66, drums=drums, density=1600.0,
            joint=Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_angle=35.0),
        )  # fmt: skip
        response = simulate(column, motion, RigidBeam())
        assert response.outcome is Outcome.AT_REST
        assert response.peak_rotation < 2e-5


def test_collapse_verdicts_are_never_taken_back():
    # Followed after the verdict, every collapsed column ends on its side or far over.
    column = stack(3)
    motions = [harmonic(f, a * g, 4.0) for f in (0.5, 1.0) for a in np.linspace(0.25, 0.6, 12)]
    results = dict(
        run_cases([Case(column, motion) for motion in motions], RigidBeam(), tail=2.0, until_end=True, threads=1)
    )
    collapsed = [m for m in results.values() if m.collapsed]
    assert len(collapsed) >= 4
    for measures in collapsed:
        assert measures.peak_rotation > 1.5


def test_failure_is_no_collapse():
    column = stack(2).with_joint(normal_stiffness=4e9, shear_stiffness=2e9)
    limit = RigidBeam().stable_step(column)
    with pytest.raises(InputError, match=r"time_step.*allowed is up to.*stable"):
        simulate(column, shaken(0.3 * g), RigidBeam(time_step=1.1 * limit))
    for coarse, limit_of in (
        (Motion(1e-5, np.zeros(11)), "4 samples of the motion"),
        (Motion(0.1, np.zeros(11)), "0.02/p of this column"),
    ):
        soft = stack(1).with_joint(normal_stiffness=1e8, shear_stiffness=5e7)
        with pytest.raises(InputError, match=limit_of):
            simulate(soft, coarse, RigidBeam(time_step=0.03))
    # A step just below the limit is stable for the closed column and wrong: its ledger says so.
    response = simulate(column, shaken(0.3 * g), RigidBeam(time_step=0.99 * limit))
    assert response.outcome is Outcome.FAILED or response.energy_imbalance < 0.25


def test_refused_input():
    for settings, word in (
        ({"xi": 0.0, "moment_law": "trilinear"}, "xi"),
        ({"xi": 1.2, "moment_law": "trilinear"}, "xi"),
        ({"xi": 0.9, "moment_law": "bilinear"}, "xi"),
        ({"restitution": 1.2, "moment_law": "housner"}, "restitution"),
        ({"restitution": 0.9}, "restitution"),
        ({"rotation": "absolute", "sliding": True}, "contradict"),
        ({"moment_law": "trilinaer"}, "moment_law"),
        ({"second_order": "none"}, "second_order"),
        ({"moment_law": "housner", "sliding": True}, "housner"),
        ({"stiffness_damping": -1.0}, "stiffness_damping"),
    ):
        with pytest.raises(InputError, match=word):
            RigidBeam(**settings)
    with pytest.raises(InputError, match="12; use bilinear"):
        simulate(preset("paper-12-drums"), shaken(0.1 * g), RigidBeam(moment_law="housner"))
    model = RigidBeam.from_settings({"moment_law": "trilinear", "xi": "0.9", "sliding": "true"})
    assert model == RigidBeam(moment_law="trilinear", xi=0.9, sliding=True)
    assert RigidBeam.paper(xi=0.9, moment_law="trilinear").idealisation == "prism"
