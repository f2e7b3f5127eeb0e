"""Verdicts of the rigid beam and of Housner's block that must agree: with the distinct elements, and with each other."""

import warnings
from functools import partial

import numpy as np
import pytest
from oracles.adaptive_beam import run_as

from stylobate.column import Column, Joint
from stylobate.constants import g
from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.models.base import Case
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import Motion
from stylobate.outcome import Outcome
from stylobate.simulate import run_cases, simulate

ROUGH, SMOOTH = (Joint(5e9, 2.5e9, friction_coefficient=mu) for mu in (0.7, 0.05))
COLUMN = Column.tapered(
    height=4.0, bottom_width=1.0, top_width=1.0, drums=4, density=2000.0, joint=ROUGH, overrides={4: SMOOTH}
)


@pytest.mark.parametrize(("push", "expected"), [(0.08, Outcome.DISPLACED), (0.12, Outcome.COLLAPSED)])
@pytest.mark.parametrize("solver", ["fixed", "adaptive"])
def test_a_drum_that_slides_over_the_edge_comes_down(push, expected, solver):
    # The base goes off under the top drum: 0.25 m of slip at 0.08 g, 0.85 m of the 1 m wide joint at 0.12 g.
    motion = Motion(0.005, np.full(201, push * g))
    beam = run_as(solver, COLUMN, motion, RigidBeam(sliding=True), tail=2.0)
    drums = simulate(COLUMN, motion, DistinctElement2D(), tail=2.0)
    assert beam.outcome is drums.outcome is expected
    assert beam.decided
    assert drums.decided
    if expected is Outcome.COLLAPSED:
        assert "drum 4" in beam.measures.reason


def test_a_drum_without_contact_is_lost_while_the_motion_goes_on():
    motion = Motion(0.005, np.full(601, 0.12 * g))
    response = simulate(COLUMN, motion, RigidBeam(sliding=True))
    assert response.outcome is Outcome.COLLAPSED
    assert response.decided
    assert response.collapse_time < motion.duration


ONE = Column.tapered(height=5.0, bottom_width=0.9, top_width=0.9, drums=1, density=2000.0, joint=ROUGH)
MODELS = [
    HousnerBlock,
    RigidBeam,
    partial(RigidBeam, moment_law="bilinear"),
    partial(RigidBeam, moment_law="housner"),
    partial(RigidBeam, second_order="law"),
    partial(RigidBeam, sliding=True),
]


@pytest.mark.parametrize("model", MODELS)
def test_a_column_that_leaves_the_ground_has_no_verdict(model):
    time = np.arange(0.0, 3.0, 0.005)
    push = 0.17 * g * np.sin(2.0 * np.pi * time)
    light, lifted = (Motion(0.005, push, vertical=-f * g * np.sin(2.0 * np.pi * 1.7 * time)) for f in (0.99, 1.02))
    for motion, fails in ((light, False), (lifted, True)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", OutOfRangeWarning)
            single = simulate(ONE, motion, model()).measures
            batch = dict(run_cases([Case(ONE, motion)], model(), threads=1))[0]
        for measures in (single, batch):
            assert (measures.outcome is Outcome.FAILED) == fails
            if fails:
                assert not measures.decided
                # −1.02 sin(2π 1.7 t) reaches −1 at 0.1285 s, between samples drawn straight a little later
                assert "at 0.1286 s" in measures.reason


@pytest.mark.parametrize("model", MODELS)
def test_what_fell_before_the_column_left_the_ground_has_fallen(model):
    # On its side after some two seconds; the vertical component comes after six.
    time = np.arange(0.0, 6.5, 0.005)
    motion = Motion(0.005, np.where(time < 1.0, 0.8 * g, 0.0), vertical=np.where(time > 6.2, -1.2 * g, 0.0))
    with pytest.warns(OutOfRangeWarning, match="leave the ground"):
        response = simulate(ONE.with_joint(friction_coefficient=5.0), motion, model())
    assert response.outcome is Outcome.COLLAPSED
    assert response.decided
    assert 0.5 < response.collapse_time < 6.0


@pytest.mark.parametrize("model", MODELS)
def test_displacements_count_from_the_start(model):
    start = 0.4 * ONE.slenderness
    quiet = Motion(0.01, np.zeros(151))
    block = model(initial_rotation=start)
    single = simulate(ONE, quiet, block, output_interval=0.002)
    batch = dict(run_cases([Case(ONE, quiet)], block, threads=1))[0]
    history = single.top_displacement
    assert history[0] == 0.0
    # let go from a tilt to −x it comes to upright, 0.36 m on, and some way over to the other side
    assert np.abs(history).max() > ONE.height * start
    for measures in (single.measures, batch):
        assert measures.peak_top_displacement == pytest.approx(np.abs(history).max(), rel=1e-2)
        assert measures.residual_top_displacement == pytest.approx(history[-1], rel=2e-2)


def test_a_second_horizontal_component_is_named_as_left_out():
    motion = Motion(0.01, np.zeros(11), lateral=np.ones(11))
    for model in (HousnerBlock(), RigidBeam()):
        with pytest.warns(OutOfRangeWarning, match="left out"):
            simulate(ONE, motion, model)


@pytest.mark.parametrize("model", MODELS)
def test_an_acceleration_beyond_all_measure_is_refused(model):
    for changes in ({"acceleration": np.full(11, 1e30)}, {"vertical": np.full(11, -1e7)}):
        motion = Motion(0.01, **({"acceleration": np.zeros(11)} | changes))
        with pytest.raises(InputError, match="check its unit"):
            simulate(ONE, motion, model())
