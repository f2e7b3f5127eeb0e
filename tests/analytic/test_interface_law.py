"""The law of a joint: its potential, its domain, and what it gives back."""

import math

import numpy as np
import pytest

from stylobate.kernels.plane import interface_law
from stylobate.kernels.plane.interface_law import compression, compression_with_strength, shear

LAW, STRENGTH, SHEAR = compression.py_func, compression_with_strength.py_func, shear.py_func
KN, KM, HALF = 4.0e9, 3.0e8, 0.45

#: f_c A [N]: the states below press with up to ten times as much.
CRUSHES = 2.0e4


def states(count: int, seed: int = 0) -> np.ndarray:
    generator = np.random.default_rng(seed)
    return generator.normal(size=(count, 2)) * [1e-5, 4e-5]


def energy(delta: float, psi: float, left: float = -HALF, right: float = HALF) -> float:
    n, e = LAW(delta, psi, left, right, KN, KM)
    return 0.5 * n * (delta - e * psi)


@pytest.mark.parametrize(("left", "right"), [(-HALF, HALF), (-HALF, 0.3), (-HALF, -0.1)])
def test_forces_derive_from_a_potential(left, right):
    step = 1e-11
    for delta, psi in states(200):
        n, e = LAW(delta, psi, left, right, KN, KM)
        by_delta = (energy(delta + step, psi, left, right) - energy(delta - step, psi, left, right)) / (2 * step)
        by_psi = (energy(delta, psi + step, left, right) - energy(delta, psi - step, left, right)) / (2 * step)
        assert n == pytest.approx(by_delta, abs=1.0)
        assert -n * e == pytest.approx(by_psi, abs=1.0)


def test_it_is_the_projection_in_the_energy_norm():
    # The distance ½ (n − n_t)²/k_n + ½ (m − m_t)²/k_m is smallest among all admissible (n, m).
    eccentricity = np.linspace(-HALF, HALF, 201)[:, None]
    compressions = np.linspace(0.0, 4e5, 401)[None, :]
    for delta, psi in states(60, 1):
        n, e = LAW(delta, psi, -HALF, HALF, KN, KM)
        trial_n, trial_m = KN * delta, -KM * psi

        def distance(n, m, trial_n=trial_n, trial_m=trial_m):
            return 0.5 * (n - trial_n) ** 2 / KN + 0.5 * (m - trial_m) ** 2 / KM

        others = distance(compressions, compressions * eccentricity)
        assert distance(n, n * e) <= others.min() + 1e-12


def test_domain_and_limits():
    for delta, psi in states(300, 2):
        n, e = LAW(delta, psi, -HALF, HALF, KN, KM)
        assert n >= 0.0
        assert abs(e) <= HALF
        if KN * delta > 0.0 and abs(KM * psi) <= HALF * KN * delta:
            assert n == pytest.approx(KN * delta)  # elastic: Baraldi et al., Eq. 8
            assert n * e == pytest.approx(-KM * psi)
        if delta + abs(psi) * HALF <= 0.0:
            assert n == 0.0
    # Rocking on an edge of a rectangle: a point spring of a quarter of the joint's stiffness.
    depth_wise = KN * (2 * HALF) ** 2 / 12.0
    n, e = LAW(0.0, -1e-3, -HALF, HALF, KN, depth_wise)
    assert e == HALF
    assert n == pytest.approx(KN / 4.0 * 1e-3 * HALF)


def test_rocking_there_and_back_costs_nothing():
    # A closed loop in closure and rotation, through opening: the work of n and m is zero.
    turn = np.linspace(0.0, 2.0 * math.pi, 20001)
    delta, psi = 1e-5 * (0.3 + np.cos(turn)), 5e-5 * np.sin(turn + 0.4)
    work, scale = 0.0, 0.0
    before = LAW(delta[0], psi[0], -HALF, HALF, KN, KM)
    for k in range(1, len(turn)):
        after = LAW(delta[k], psi[k], -HALF, HALF, KN, KM)
        d_delta, d_psi = delta[k] - delta[k - 1], psi[k] - psi[k - 1]
        part = 0.5 * (before[0] + after[0]) * d_delta - 0.5 * (before[0] * before[1] + after[0] * after[1]) * d_psi
        work, scale = work + part, scale + abs(part)
        before = after
    assert abs(work) < 1e-7 * scale


@pytest.fixture
def strength(monkeypatch):
    """The law with f_c A, left to the interpreter: n and e from closure, rotation and the ends of the overlap."""
    monkeypatch.setattr(interface_law, "compression", LAW)
    return lambda delta, psi, left=-HALF, right=HALF: STRENGTH(delta, psi, left, right, KN, KM, 1.0 / CRUSHES)


OVERLAPS = [(-HALF, HALF), (-HALF, 0.3), (0.1, HALF)]


@pytest.mark.parametrize(("left", "right"), OVERLAPS)
def test_with_a_strength_it_is_the_projection_onto_the_curved_domain(strength, left, right):
    # r_left n + w n² ≤ m ≤ r_right n − w n², w = (r_right − r_left)/(2 f_c A), 0 ≤ n ≤ f_c A: theory/rigid_block, Eq. (B6).
    n_all = np.linspace(0.0, CRUSHES, 2001)[:, None]
    narrowing = 0.5 * (right - left) / CRUSHES
    low, high = left * n_all + narrowing * n_all**2, right * n_all - narrowing * n_all**2
    m_all = low + np.linspace(0.0, 1.0, 401) * (high - low)
    modes = set()
    for delta, psi in states(60, 3):
        n, e = strength(delta, psi, left, right)
        assert 0.0 <= n <= CRUSHES
        assert left + narrowing * n <= e <= right - narrowing * n
        others = 0.5 * (n_all - KN * delta) ** 2 / KN + 0.5 * (m_all + KM * psi) ** 2 / KM
        own = 0.5 * (n - KN * delta) ** 2 / KN + 0.5 * (n * e + KM * psi) ** 2 / KM
        assert own <= others.min() * (1.0 + 1e-9)
        modes.add("open" if n == 0.0 else "tip" if n == CRUSHES else "limit" if own > 1e-12 else "elastic")
    assert modes >= {"open", "tip", "limit"}


@pytest.mark.parametrize(("left", "right"), OVERLAPS)
def test_with_a_strength_forces_derive_from_a_potential(strength, left, right):
    def stored(delta, psi):
        n, e = strength(delta, psi, left, right)
        return n * (delta - e * psi) - 0.5 * n * n * (1.0 / KN + e * e / KM)

    step = 1e-10
    for delta, psi in states(200, 4):
        n, e = strength(delta, psi, left, right)
        by_delta = (stored(delta + step, psi) - stored(delta - step, psi)) / (2 * step)
        by_psi = (stored(delta, psi + step) - stored(delta, psi - step)) / (2 * step)
        assert n == pytest.approx(by_delta, abs=1.0)
        assert -n * e == pytest.approx(by_psi, abs=1.0)


def test_on_the_limit_the_force_stands_in_the_middle_of_the_crushed_toe_and_the_drum_turns_about_its_end(strength):
    # A block of stress f_c, as wide as d N/(f_c A), at the edge: at constant n a rotation lifts the joint's middle by the
    # distance from there to the inner end of the block.
    n, psi = 0.3 * CRUSHES, -2e-4
    delta, before, step = 0.0, 0.0, 1e-8

    def closed(psi, n):
        low, high = -1e-3, 1e-3
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if strength(middle, psi)[0] < n else (low, middle)
        return low

    delta, before = closed(psi, n), closed(psi - step, n)
    assert strength(delta, psi)[1] == pytest.approx(HALF * (1.0 - 0.3), rel=1e-6)
    assert (before - delta) / -step == pytest.approx(HALF * (1.0 - 0.6), rel=1e-4)


def test_a_strength_far_above_the_pressure_changes_nothing(monkeypatch):
    monkeypatch.setattr(interface_law, "compression", LAW)
    for delta, psi in states(200, 5):
        n, e = LAW(delta, psi, -HALF, HALF, KN, KM)
        result = STRENGTH(delta, psi, -HALF, HALF, KN, KM, 1e-14)
        assert result == pytest.approx((n, e), rel=1e-7, abs=1e-9)


def test_shear_is_clipped_to_mohr_coulomb():
    assert SHEAR(50.0, 100.0, 0.7, 0.0) == 50.0
    assert SHEAR(90.0, 100.0, 0.7, 0.0) == pytest.approx(70.0)
    assert SHEAR(-90.0, 100.0, 0.7, 5.0) == pytest.approx(-75.0)
    assert SHEAR(90.0, 0.0, 0.7, 5.0) == 0.0  # an open joint has lost its cohesion
