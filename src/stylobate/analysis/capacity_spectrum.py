"""Capacity spectrum check of a rocking mechanism, as engineers do it by hand: the pushover curve against a spectrum."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..errors import InputError, check_range
from ..models.rigid_block.block_stack import BlockStack
from ..motion import Motion
from .pushover import PushoverResult

#: Share of the displacement of zero capacity that may be used, and share of that at which the secant period is taken.
#: Circolare 617/2009, C8A.4.2.3
USABLE, SECANT = 0.4, 0.4


@dataclass(frozen=True)
class CapacityCheck:
    """Result of :func:`capacity_spectrum_check`.

    Parameters
    ----------
    mass : float
        Participating mass M* [kg].
    participation : float
        e* = g M*/W [-].
    acceleration : float
        Spectral acceleration a₀* that sets the mechanism off [m/s²].
    zero_displacement : float
        Spectral displacement d₀* at which the capacity is used up [m].
    usable_displacement : float
        d_u* = 0.4 d₀* [m].
    secant_displacement, secant_acceleration : float
        d_s* = 0.4 d_u* and the capacity there [m], [m/s²].
    period : float
        T_s = 2π √(d_s*/a_s*) [s].
    demand : float
        Spectral displacement demand at T_s [m].
    """

    mass: float
    participation: float
    acceleration: float
    zero_displacement: float
    usable_displacement: float
    secant_displacement: float
    secant_acceleration: float
    period: float
    demand: float

    @property
    def factor(self) -> float:
        """Usable displacement over demand: the check is passed from 1 on [-]."""
        return self.usable_displacement / self.demand if self.demand > 0.0 else math.inf

    @property
    def passed(self) -> bool:
        """Whether the demand stays within the usable displacement."""
        return self.factor >= 1.0


def capacity_spectrum_check(
    stack: BlockStack,
    path: PushoverResult,
    spectrum: Motion | Callable[[float], float],
    *,
    confidence_factor: float = 1.0,
    damping: float = 0.05,
) -> CapacityCheck:
    """Check a column against a spectrum with the displacement capacity of its pushover curve.

    Parameters
    ----------
    stack : BlockStack
        The column, ``BlockStack.of_column(column)``.
    path : PushoverResult
        With geometric nonlinearity, followed to zero multiplier.
    spectrum : Motion or callable
        A record, whose elastic displacement spectrum is taken, or the spectral displacement [m] as a function of the
        period [s], such as those of :mod:`stylobate.analysis.code_spectra`.
    confidence_factor : float
        FC, at least 1: divides the capacity.
    damping : float
        Of the spectrum of a record [-].

    Returns
    -------
    CapacityCheck

    Raises
    ------
    InputError
        The path does not reach zero multiplier.

    Notes
    -----
    Nonlinear kinematic analysis of Circolare 2 February 2009 n. 617, C8A.4.2.2 and C8A.4.2.3, for an element that
    stands on the ground (the clause for elements higher up in a building is not implemented).

    Assumptions: one mechanism with the shape it has at small rotations; weights P alone make the mass; the demand is that
    of a linear oscillator with the secant period T_s, which a rocking block is not. It is a rule of practice, checked
    against nothing here: compare it with :func:`stylobate.critical_amplitude`.
    """
    factor = check_range("confidence_factor", confidence_factor, 1.0, 2.0)
    if not math.isfinite(path.ultimate_displacement):
        raise InputError(
            f"the pushover path ends before its multiplier is zero ({path.stop}); "
            "follow it with geometric nonlinearity and without a smaller control displacement."
        )
    weight = stack.mass * stack.gravity
    move, top = _shape(path)
    # Circolare 617/2009, C8A.4.2.2: M* = (Σ P δ)² / (g Σ P δ²)
    mass = float(weight @ move) ** 2 / (stack.gravity * float(weight @ move**2))
    participation = stack.gravity * mass / float(weight.sum())
    # C8A.4.2.3: d* = d_k Σ P δ² / (δ_k Σ P δ);  a* = α g / (e* FC)
    ratio = float(weight @ move**2) / (top * float(weight @ move))
    displacement = path.displacement * ratio
    capacity = path.multiplier * stack.gravity / (participation * factor)
    zero = path.ultimate_displacement * ratio
    usable = USABLE * zero
    secant = SECANT * usable
    at_secant = float(np.interp(secant, displacement, capacity))
    period = 2.0 * math.pi * math.sqrt(secant / at_secant)
    return CapacityCheck(
        mass=mass,
        participation=participation,
        acceleration=float(capacity.max()),
        zero_displacement=zero,
        usable_displacement=usable,
        secant_displacement=secant,
        secant_acceleration=at_secant,
        period=period,
        demand=_demand(spectrum, period, damping),
    )


def _shape(path: PushoverResult) -> tuple[np.ndarray, float]:
    """Horizontal movement of the blocks' centroids, shape (n,), and of the top, from the peak to a small displacement."""
    far = path.displacement[path.peak] + 0.02 * path.ultimate_displacement
    step = max(path.peak + 1, int(np.searchsorted(path.displacement, far)))
    move = path.position[step, :, 0] - path.position[path.peak, :, 0]
    return move, float(path.displacement[step] - path.displacement[path.peak])


def _demand(spectrum: Motion | Callable[[float], float], period: float, damping: float) -> float:
    if isinstance(spectrum, Motion):
        from ..motion.spectra import response_spectrum

        return float(response_spectrum(spectrum, [period], damping).sd[0])
    return float(spectrum(period))
