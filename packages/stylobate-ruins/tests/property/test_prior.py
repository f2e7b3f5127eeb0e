"""Draws of a prior: what a seed means, and that motions are what their numbers say."""

import numpy as np
import pytest

import stylobate as st
from stylobate.column.joint import Losses
from stylobate_ruins.ground_motion import elliptical_pulse
from stylobate_ruins.prior import peaks

PRIOR = st.Prior(pgv=(0.1, 1.5), period=(0.3, 1.6))
COLUMN = st.preset("paper-monolithic")


def test_draw_is_the_same_whatever_their_number():
    few, many = PRIOR.draws(5, 3).parameters, PRIOR.draws(9, 3).parameters
    for name, values in few.items():
        assert np.array_equal(values, many[name][:5])


def test_motions_are_what_their_numbers_say():
    # Peaks of the sampled motion; velocities are told to 1e-3 by a hundred samples in a period.
    draws = PRIOR.draws(20, 1)
    for k in range(20):
        speed, acceleration = peaks(draws.motion(k))
        assert speed == pytest.approx(draws.parameters["pgv_m_s"][k], rel=2e-3)
        assert acceleration == pytest.approx(st.g * draws.parameters["pga_g"][k], rel=1e-9)


def test_pulse_turned_by_half_a_turn_is_that_of_the_other_phase():
    pulse = elliptical_pulse(0.8, 0.5, azimuth=30.0, ellipticity=0.3, cycles=2.5, phase=40.0)
    other = elliptical_pulse(0.8, 0.5, azimuth=210.0, ellipticity=0.3, cycles=2.5, phase=220.0)
    assert other.acceleration == pytest.approx(pulse.acceleration, abs=1e-9 * np.abs(pulse.acceleration).max())
    assert other.lateral == pytest.approx(pulse.lateral, abs=1e-9 * np.abs(pulse.acceleration).max())


def test_pulse_ends_at_rest_along_its_axis():
    pulse = elliptical_pulse(0.8, 0.5, azimuth=90.0)
    assert np.abs(pulse.acceleration).max() < 1e-9
    assert np.trapezoid(pulse.lateral, dx=pulse.dt) == pytest.approx(0.0, abs=1e-3 * 0.5)  # of 100 samples a period


def test_records_are_turned_and_scaled():
    record = st.harmonic(1.0, 1.0, 3.0)
    draws = st.Prior(records=[record], scale=(0.5, 2.0)).draws(4, 1)
    for k in range(4):
        speed, _ = peaks(draws.motion(k))
        assert speed == pytest.approx(draws.parameters["pgv_m_s"][k], rel=1e-9)
    x, y = draws.motion(1).acceleration, draws.motion(1).lateral
    angle = np.radians(draws.parameters["azimuth_deg"][1])
    assert np.abs(np.sin(angle) * x - np.cos(angle) * y).max() < 1e-9


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, "needs pgv"),
        ({"pgv": (0.1, 1.0)}, "needs pgv"),
        ({"pgv": (0.1, 1.0), "pga": (0.1, 1.0), "period": (0.3, 1.0)}, "not both"),
        ({"pgv": (1.0, 0.1), "period": (0.3, 1.0)}, "below the second"),
        ({"pgv": (0.1,), "period": (0.3, 1.0)}, "two numbers"),
        ({"pgv": (0.1, 1.0), "period": (0.3, 1.0), "scale": (0.5, 2.0)}, "for records"),
        ({"pgv": (0.1, 1.0), "period": (0.3, 1.0), "law": ("rim", "rim")}, "different values"),
        ({"pgv": (0.1, 1.0), "period": (0.3, 1.0), "law": ("glue",)}, "rim, bed"),
    ],
)
def test_what_is_no_prior_is_refused(fields, message):
    with pytest.raises(st.InputError, match=message):
        st.Prior(**fields)


def test_joints_are_of_any_stiffness_from_1e9_to_that_of_stone_unless_they_are_known():
    """100 GPa over the one drum of 5 m are 2e10 N/m³; a prior whose scatter is stated takes joints as they are."""
    draws = PRIOR.draws(200, 2)
    k = np.log([draws.on_joints(COLUMN, i).joints[0].normal_stiffness for i in range(200)])
    assert k.min() == pytest.approx(np.log(1e9), abs=0.1)
    assert k.max() == pytest.approx(np.log(2e10), abs=0.1)
    assert k.std() == pytest.approx(np.log(20.0) / np.sqrt(12.0), rel=0.1)
    known = st.Prior(pgv=(0.1, 1.5), period=(0.3, 1.6), scatter=st.Scatter())
    assert known.draws(3, 2).on_joints(COLUMN, 1) is COLUMN


def test_columns_carry_the_losses_of_a_draw_but_keep_their_own():
    draws = PRIOR.draws(6, 2)
    own = COLUMN.replace(losses=Losses(2e-4, 0.003))
    for k in range(6):
        law = PRIOR.law[int(draws.parameters["law"][k])]
        assert draws.losses(COLUMN, k, 0.01) == Losses(draws.parameters["stiffness_damping_s"][k], 0.01, law)
        assert draws.losses(own, k, 0.01) == Losses(2e-4, 0.003, law)


def test_what_cannot_vary_is_no_ruin():
    with pytest.raises(st.InputError, match="restitution is drawn with the motions"):
        st.Ruin([COLUMN], [], PRIOR, model=st.DistinctElement3D(restitution=0.9))
    box = 0.5 * np.array([[x, y, 2 * z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    with pytest.raises(st.InputError, match="a ruin is of columns and assemblies in space"):
        st.Ruin([st.Specimen(1.0, [0.5, 0.5, 0.2], box)], [], PRIOR)
