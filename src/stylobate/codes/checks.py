"""Checks of a rocking mechanism by hand: the capacity spectrum, and the kinematic checks of codes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError, check_range
from ..models.rigid_block.block_stack import BlockStack
from ..motion import Motion
from ..statics.pushover import PushoverResult
from .spectra import Coefficient, EurocodeSpectrum, NtcSpectrum, SecondEurocodeSpectrum, parse_code, spectrum_of_code

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
        period [s], such as those of :mod:`stylobate.codes.spectra`.
    confidence_factor : float
        FC, at least 1: divides the capacity.
    damping : float
        Of the spectrum of a record [-].

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


#: Confidence factors by how well a structure is known, and where they stand.
KNOWLEDGE = {
    "ec8": ({"KL1": 1.35, "KL2": 1.20, "KL3": 1.00}, "EN 1998-3:2005, Table 3.1"),
    "ntc2018": ({"LC1": 1.35, "LC2": 1.20, "LC3": 1.00}, "Circolare 7/2019, C8.5.4"),
}

#: q of a mechanism that is checked by its acceleration alone.
BEHAVIOUR = 2.0

#: What is typed of a check beside the spectrum: an example of it.
_LEVELS = {"ec8": "knowledge=KL2", "ntc2018": "knowledge=LC2"}


@dataclass(frozen=True)
class CodeCheck:
    """Result of :func:`code_check`.

    Parameters
    ----------
    code : str
    displacement : CapacityCheck
        Nonlinear kinematic analysis: usable displacement against the demand of the spectrum.
    demand_acceleration : float
        a_g S / q, which the acceleration that sets the mechanism off is held against [m/s²].
    coefficients : tuple of Coefficient
        All that was taken from codes.
    left_out : tuple of str
        What the code has besides, in sentences.
    """

    code: str
    displacement: CapacityCheck
    demand_acceleration: float
    coefficients: tuple[Coefficient, ...]
    left_out: tuple[str, ...]

    @property
    def acceleration_factor(self) -> float:
        """Acceleration of the mechanism over the demand: passed from 1 on [-]."""
        return self.displacement.acceleration / self.demand_acceleration

    @property
    def passed(self) -> bool:
        """Whether one of both checks is passed: the linear one is the simpler and safer of the two."""
        return self.acceleration_factor >= 1.0 or self.displacement.passed

    @property
    def sentence(self) -> str:
        """Result, in a sentence."""
        d = self.displacement
        return (
            f"By {self.code} the mechanism {'passes' if self.passed else 'does not pass'}: acceleration "
            f"{self.acceleration_factor:.2f} and displacement {d.factor:.2f} times what is demanded."
        )

    def summary(self) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate pushover --check``."""
        d = self.displacement
        return {
            "code": self.code,
            "passed": self.passed,
            "acceleration_m_s2": d.acceleration,
            "demand_acceleration_m_s2": self.demand_acceleration,
            "acceleration_factor": self.acceleration_factor,
            "usable_displacement_m": d.usable_displacement,
            "demand_displacement_m": d.demand,
            "displacement_factor": d.factor,
            "secant_period_s": d.period,
            "participation": d.participation,
            "coefficients": [coefficient._asdict() for coefficient in self.coefficients],
            "left_out": list(self.left_out),
            "sentence": self.sentence,
        }


@dataclass(frozen=True)
class CodeSite:
    """A code, the spectrum of a site by it, and how well the column is known.

    Parameters
    ----------
    code : {"ec8", "ntc2018"}
    spectrum : EurocodeSpectrum or NtcSpectrum
    knowledge : str
        ``KL1`` to ``KL3``, or ``LC1`` to ``LC3``.
    """

    code: str
    spectrum: EurocodeSpectrum | NtcSpectrum
    knowledge: str

    @classmethod
    def typed(cls, text: str) -> CodeSite:
        """As typed, such as ``ec8,ag=0.25g,soil=B,type=1,knowledge=KL2``.

        Raises
        ------
        InputError
            A code or a name that is not known, a value that is missing or not allowed.
        """
        code, given = parse_code(text, {code: {"knowledge": example} for code, example in _LEVELS.items()})
        levels = KNOWLEDGE[code][0]
        level = given.pop("knowledge", next(iter(levels)))
        if level not in levels:
            raise InputError(f"knowledge is {level!r}; allowed by {code} are {', '.join(levels)}.")
        spectrum = spectrum_of_code(code, given)
        assert not isinstance(spectrum, SecondEurocodeSpectrum)  # which no check is known by here
        return cls(code, spectrum, level)


def code_check(stack: BlockStack, path: PushoverResult, site: CodeSite) -> CodeCheck:
    """Check the mechanism of a pushover path by a code.

    Parameters
    ----------
    stack : BlockStack
        Of the column, as pushed (:func:`stylobate.statics.limit.towards`).
    path : PushoverResult
        With geometric nonlinearity, followed to zero multiplier.
    site : CodeSite

    Notes
    -----
    Kinematic analysis of a local mechanism, linear and nonlinear, of Circolare 617/2009, C8A.4.2; EN 1998-3 has no clause
    for rocking blocks, so that with ``ec8`` only the spectrum and the confidence factor are the Eurocode's.
    """
    levels, table = KNOWLEDGE[site.code]
    factor = levels[site.knowledge]
    spectrum_check = capacity_spectrum_check(stack, path, site.spectrum, confidence_factor=factor)
    kinematic = "Circolare 617/2009, C8A.4.2.3"
    coefficients = (
        *site.spectrum.coefficients,
        Coefficient("confidence factor", factor, f"{table}, {site.knowledge}"),
        Coefficient("q", BEHAVIOUR, kinematic),
        Coefficient("d_u*/d_0*", USABLE, kinematic),
        Coefficient("d_s*/d_u*", SECANT, kinematic),
    )
    left_out = [
        "the clause for elements high up in a building (the column stands on the ground)",
        "partial factors and importance: a_g is taken as given",
    ]
    if site.code == "ec8":
        left_out.append("EN 1998-3 has no clause for rocking blocks: the kinematic check is the Italian one")
    else:
        left_out += [
            "the displacement shares and secant periods of Circolare 7/2019, C8.7.1.2.1, which could not be checked against "
            "its print: those of 617/2009 stand in for them",
            "the grid of a_g, F0 and Tc*: give those of your site",
        ]
    demand = site.spectrum.ground_acceleration * site.spectrum.soil_factor / BEHAVIOUR
    return CodeCheck(site.code, spectrum_check, demand, coefficients, tuple(left_out))
