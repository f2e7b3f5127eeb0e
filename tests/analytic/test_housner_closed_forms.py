"""Housner's block against closed forms: pulses that just overturn it, periods of free rocking, loss at an impact."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.models.base import Case
from stylobate.models.housner import HousnerBlock
from stylobate.motion import Motion
from stylobate.simulate import simulate, simulate_iter

JOINT = Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_coefficient=5.0)


def prism(slenderness: float, height: float = 5.0) -> Column:
    """A prism of given α; its 2b over 2h is tan α."""
    width = height * math.tan(slenderness)
    return Column.of_drums([Drum(height, width, width, 1600.0)], JOINT)


def pulse(shape, duration: float, amplitude: float, samples: int = 2001) -> Motion:
    time = np.linspace(0.0, duration, samples)
    return Motion(time[1], shape(time), factor=amplitude)


def still(duration: float) -> Motion:
    return Motion(duration / 10, np.zeros(11))


def collapses(column: Column, motions: list[Motion], model: HousnerBlock, tail: float) -> list[bool]:
    found = [False] * len(motions)
    cases = [Case(column, motion) for motion in motions]
    for index, measures in simulate_iter(cases, model, tail=tail, threads=1):
        assert measures.decided
        found[index] = measures.collapsed
    return found


def edge(column, make, model, expected, tail=3.0) -> None:
    """The verdict changes between 0.999 and 1.001 of the expected amplitude, and so does the single run's."""
    motions = [make(expected * factor) for factor in (0.99, 0.999, 1.001, 1.01)]
    assert collapses(column, motions, model, tail) == [False, False, True, True]
    assert [simulate(column, motion, model, tail=tail).collapsed for motion in motions[1:3]] == [False, True]


@pytest.mark.parametrize(
    ("pt", "printed"), [(0.25, 4.52081), (0.5, 2.54149), (1.0, 1.58198), (2.0, 1.15652), (3.0, 1.05240)]
)
def test_constant_pulse(pt, printed):
    # Housner 1963: A/(α g) = 1/(1 − exp(−p t)), linearised.
    ratio = 1.0 / (1.0 - math.exp(-pt))
    assert ratio == pytest.approx(printed, abs=6e-6)
    column = prism(0.16)
    p, scale = column.frequency_parameter, column.slenderness * g
    edge(column, lambda r: pulse(np.ones_like, pt / p, r * scale), HousnerBlock(linear=True, restitution=0.0), ratio)


@pytest.mark.parametrize(("w", "printed"), [(1.0, 1.3224), (2.0, 1.8007), (4.0, 2.7908), (8.0, 4.7871)])
def test_half_sine(w, printed):
    # Linearised: √(a²−1) + a exp[−(p/ω)(π − asin 1/a)] = ω/p, a = A/(α g).
    ratio = brentq(lambda a: math.sqrt(a * a - 1) + a * math.exp(-(math.pi - math.asin(1 / a)) / w) - w, 1.0, 50.0)
    assert ratio == pytest.approx(printed, abs=6e-5)
    column = prism(0.16)
    omega = w * column.frequency_parameter

    def make(r):
        return pulse(lambda t: np.sin(omega * t), math.pi / omega, r * column.slenderness * g)

    edge(column, make, HousnerBlock(linear=True, restitution=0.0), ratio)


@pytest.mark.parametrize(("w", "printed"), [(1.0, 1.4183), (2.0, 2.3499), (4.0, 5.2390), (8.0, 14.871)])
def test_one_sine_without_impact(w, printed):
    # Linearised: √(a²−1) − a exp[−(p/ω)(2π − asin 1/a)] = ω/p. Below the edge the block impacts, and with e = 0 stops.
    ratio = brentq(
        lambda a: math.sqrt(a * a - 1) - a * math.exp(-(2 * math.pi - math.asin(1 / a)) / w) - w, 1.0001, 100.0
    )
    assert ratio == pytest.approx(printed, rel=6e-5)
    column = prism(0.16)
    omega = w * column.frequency_parameter
    model = HousnerBlock(linear=True, restitution=0.0)
    rotations = []
    for factor in (0.999, 1.001):
        motion = pulse(lambda t: np.sin(omega * t), 2 * math.pi / omega, ratio * factor * column.slenderness * g)
        response = simulate(column, motion, model, tail=4.0)
        rotations.append(response.drum_rotation.min())
        expected_fall = factor > 1.0
        # without impact the block falls on the side it rose to first: −x, counter-clockwise positive
        assert (response.collapsed and response.drum_rotation[-1, 0] > column.slenderness) == expected_fall
    assert rotations[1] == 0.0


@pytest.mark.parametrize(("w", "printed"), [(0.5, 1.2500), (1.0, 2.0037), (2.0, 5.2258)])
def test_one_cosine_without_impact(w, printed):
    # Linearised: [1+(ω/p)²] / [1−exp(−2πp/ω)].
    ratio = (1 + w * w) / (1 - math.exp(-2 * math.pi / w))
    assert ratio == pytest.approx(printed, abs=6e-5)
    column = prism(0.16)
    omega = w * column.frequency_parameter
    fell = []
    for factor in (0.999, 1.001):
        motion = pulse(lambda t: np.cos(omega * t), 2 * math.pi / omega, ratio * factor * column.slenderness * g)
        response = simulate(column, motion, HousnerBlock(linear=True, restitution=0.0), tail=4.0)
        fell.append(bool(response.collapsed and response.drum_rotation[-1, 0] > column.slenderness))
    assert fell == [False, True]


def test_one_sine_nonlinear_edges():
    # α = 0.25, e = 0.9, ω/p = 2, in g tan α: overturns from 1.225, safe again from 2.325, without impact from 2.358.
    column = prism(0.25)
    omega = 2.0 * column.frequency_parameter
    ratios = np.arange(1.150, 2.450, 0.0025)
    motions = [pulse(lambda t: np.sin(omega * t), 2 * math.pi / omega, r * g * math.tan(0.25)) for r in ratios]
    fell = np.array(collapses(column, motions, HousnerBlock(restitution=0.9), tail=12.0))
    changes = ratios[1:][fell[1:] != fell[:-1]]
    assert changes == pytest.approx([1.225, 2.325, 2.358], abs=0.01)


@pytest.mark.parametrize("share", [0.1, 0.25, 0.5, 0.75, 0.9])
@pytest.mark.parametrize("linear", [True, False])
def test_free_rocking_period(share, linear):
    # Housner 1963: p T/4 = arccosh[1/(1 − θ₀/α)]; nonlinear by quadrature of dθ/√(2 (U(θ₀) − U(θ))).
    column = preset("paper-monolithic").as_prism()
    alpha, p = column.slenderness, column.frequency_parameter
    start = share * alpha
    if linear:
        quarter = math.acosh(1.0 / (1.0 - share)) / p
    else:  # θ = θ₀ − q² takes the singularity away

        def integrand(q):
            return 2.0 * q / math.sqrt(2.0 * (math.cos(alpha - start) - math.cos(alpha - start + q * q))) if q else (
                2.0 / math.sqrt(2.0 * math.sin(alpha - start))
            )  # fmt: skip

        quarter = quad(integrand, 0.0, math.sqrt(start))[0] / p
    model = HousnerBlock(linear=linear, restitution=1.0, initial_rotation=start)
    response = simulate(column, still(3.2 * quarter), model, output_interval=1e-4)
    rotation, time = response.drum_rotation[:, 0], response.time
    k = np.flatnonzero(np.diff(np.sign(rotation)) != 0)
    crossings = [time[i] - rotation[i] * (time[i + 1] - time[i]) / (rotation[i + 1] - rotation[i]) for i in k]
    assert crossings[0] == pytest.approx(quarter, rel=1e-5)
    assert crossings[1] == pytest.approx(3 * quarter, rel=1e-5)
    assert response.decided
    assert not response.collapsed


@pytest.mark.parametrize("e", [0.0, 0.5, 0.9, None])
def test_loss_at_an_impact(e):
    # Housner 1963: the share 1 − e² of the kinetic energy.
    column = preset("paper-monolithic")
    model = HousnerBlock(restitution=e, initial_rotation=0.5 * column.slenderness)
    response = simulate(column, still(1.2), model, output_interval=0.01)
    e = column.restitution if e is None else e
    fallen = model.block(column).inertia * model.block(column).potential(0.5 * column.slenderness)
    assert -response.energy["gravitational"].min() == pytest.approx(
        fallen, rel=2e-2
    )  # upright, to the recording's grid
    assert response.energy["impact"][-1] == pytest.approx((1 - e * e) * fallen, rel=1e-7)


@pytest.mark.parametrize(
    ("column", "p", "e"),
    [
        (preset("paper-monolithic").as_prism(), 1.7044, 0.9616),
        (preset("paper-monolithic"), 1.7299, 0.9413),
        (Column.tapered(height=5.0, bottom_width=0.96, top_width=0.66, drums=1, density=1600.0, joint=JOINT,
                        section="circular"), 1.7619, 0.9351),
    ],
)  # fmt: skip
def test_parameters_of_the_papers_column(column, p, e):
    assert column.frequency_parameter == pytest.approx(p, abs=6e-5)
    assert HousnerBlock().block(column).restitution == pytest.approx(e, abs=6e-5)


def test_uplift_threshold():
    # |a_g| cos α > (g + a_v) sin α
    column = preset("paper-monolithic")
    limit = g * math.tan(column.slenderness)
    for factor, moved in ((0.9999, False), (1.0001, True)):
        motion = pulse(lambda t: np.sin(2 * t), 3.0, limit * factor)
        assert (simulate(column, motion, HousnerBlock()).peak_rotation > 0.0) == moved
    lighter = Motion(1.5e-3, np.sin(np.linspace(0, 6, 2001)), vertical=np.full(2001, -0.2 * g / limit), factor=limit)
    for factor, moved in ((0.9999, False), (1.0001, True)):
        scaled = lighter.replace(acceleration=0.8 * factor * lighter.samples)
        assert (simulate(column, scaled, HousnerBlock()).peak_rotation > 0.0) == moved
