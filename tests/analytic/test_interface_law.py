"""The law of a joint: its potential, its domain, and what it gives back."""

import math

import numpy as np
import pytest

from stylobate.kernels.interface_law import compression, crushed, shear

LAW, CRUSHED, SHEAR = compression.py_func, crushed.py_func, shear.py_func
KN, KM, HALF = 4.0e9, 3.0e8, 0.45


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


def test_crushing_keeps_to_the_domain_and_only_grows():
    crushing = 1.0 / 3.0e5
    for delta, psi in states(200, 3):
        n, e = LAW(delta, psi, -HALF, HALF, KN, KM)
        if n == 0.0 or n * crushing > 0.9 or psi == 0.0:
            continue
        side = math.copysign(1.0, e)
        if abs(e) <= HALF * (1.0 - n * crushing):
            continue
        limit = CRUSHED(delta, side * psi, HALF, abs(e), KN, KM, crushing)
        assert limit <= abs(e)
        n, e = LAW(delta, psi, -limit if side < 0 else -HALF, limit if side > 0 else HALF, KN, KM)
        # |M| = |N| d/2 (1 − |N|/(f_c A)), theory/rigid_block, Eq. (B6)
        assert abs(n * e) == pytest.approx(n * HALF * (1.0 - n * crushing), rel=1e-6)


def test_shear_is_clipped_to_mohr_coulomb():
    assert SHEAR(50.0, 100.0, 0.7, 0.0) == 50.0
    assert SHEAR(90.0, 100.0, 0.7, 0.0) == pytest.approx(70.0)
    assert SHEAR(-90.0, 100.0, 0.7, 5.0) == pytest.approx(-75.0)
    assert SHEAR(90.0, 0.0, 0.7, 5.0) == 0.0  # an open joint has lost its cohesion
