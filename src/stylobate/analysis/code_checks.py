"""Checks by a code: a rocking mechanism against the spectrum of a site, every coefficient with its source."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..errors import InputError
from ..models.rigid_block.block_stack import BlockStack
from .capacity_spectrum import SECANT, USABLE, CapacityCheck, capacity_spectrum_check
from .code_spectra import (
    Coefficient,
    EurocodeSpectrum,
    NtcSpectrum,
    SecondEurocodeSpectrum,
    parse_code,
    spectrum_of_code,
)
from .pushover import PushoverResult

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
        Of the column, as pushed (:func:`stylobate.analysis.limit.towards`).
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
    found = capacity_spectrum_check(stack, path, site.spectrum, confidence_factor=factor)
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
    return CodeCheck(site.code, found, demand, coefficients, tuple(left_out))
