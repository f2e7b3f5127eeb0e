"""Capacity spectrum check against the closed form of one rocking block."""

import math

import pytest

from stylobate.codes.checks import capacity_spectrum_check
from stylobate.codes.spectra import EurocodeSpectrum
from stylobate.column import preset
from stylobate.errors import InputError
from stylobate.models.rigid_block.block_stack import BlockStack
from stylobate.motion import harmonic
from stylobate.statics.pushover import pushover


def test_one_block_in_closed_form():
    column = preset("paper-monolithic").as_prism()
    check = capacity_spectrum_check(BlockStack.of_column(column), pushover(column), lambda period: 0.1)
    # One centroid: M* = M, e* = 1, a₀* = g tan α; d₀* is the centroid's displacement at θ = α: R (1 − cos α) + …
    assert check.mass == pytest.approx(column.mass, rel=1e-9)
    assert check.participation == pytest.approx(1.0, rel=1e-9)
    assert check.acceleration == pytest.approx(column.gravity * 0.162, rel=1e-3)
    # d* scales with the shape at small rotations, u_C/u_top = z_C/H; d₀* is half the top's displacement at zero.
    turn = column.slenderness
    top = 0.405 * (1 - math.cos(turn)) + 5.0 * math.sin(turn)
    assert check.zero_displacement == pytest.approx(0.5 * top, rel=5e-3)
    assert check.usable_displacement == pytest.approx(0.4 * check.zero_displacement)
    # a* falls as tan(α − θ), nearly linear: at 0.16 of d₀* there is 0.84 of it left.
    assert check.secant_acceleration == pytest.approx(0.84 * column.gravity * 0.162, rel=1e-2)
    secant = 0.16 * check.zero_displacement
    assert check.period == pytest.approx(2 * math.pi * math.sqrt(secant / check.secant_acceleration), rel=1e-9)
    assert check.factor == pytest.approx(check.usable_displacement / 0.1)
    assert check.passed


def test_confidence_factor_and_demand():
    column = preset("paper-12-drums")
    stack, path = BlockStack.of_column(column), pushover(column)
    plain = capacity_spectrum_check(stack, path, EurocodeSpectrum(0.2 * 9.81, "C"))
    careful = capacity_spectrum_check(stack, path, EurocodeSpectrum(0.2 * 9.81, "C"), confidence_factor=1.35)
    assert careful.acceleration == pytest.approx(plain.acceleration / 1.35)
    assert careful.period == pytest.approx(plain.period * math.sqrt(1.35))
    assert 0.5 < plain.participation < 1.0
    record = capacity_spectrum_check(stack, path, harmonic(1.0, 0.2 * 9.81, 10.0))
    assert record.demand > 0.0


def test_eurocode_spectrum_at_its_corners():
    spectrum = EurocodeSpectrum(1.0, "B")
    assert spectrum.acceleration(0.0) == pytest.approx(1.2)
    assert spectrum.acceleration(0.3) == pytest.approx(1.2 * 2.5)
    assert spectrum.acceleration(1.0) == pytest.approx(1.2 * 2.5 * 0.5)
    assert spectrum.acceleration(4.0) == pytest.approx(1.2 * 2.5 * 0.5 * 2.0 / 16.0)
    assert spectrum(2.0) == pytest.approx(spectrum.acceleration(2.0) / math.pi**2)
    # η = √(10/(5 + ξ)) ≥ 0.55, ξ in per cent
    assert EurocodeSpectrum(1.0, "A", 0.2).acceleration(0.2) == pytest.approx(2.5 * math.sqrt(0.4))


def test_bad_input():
    column = preset("paper-monolithic")
    with pytest.raises(InputError, match="ends before its multiplier is zero"):
        capacity_spectrum_check(BlockStack.of_column(column), pushover(column, to=0.01), lambda period: 0.1)
    with pytest.raises(InputError, match="ground_type"):
        EurocodeSpectrum(1.0, "F")
