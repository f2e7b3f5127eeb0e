"""Elastic spectra of codes: EN 1998-1:2004, types 1 and 2, and NTC 2018, with the tables of their soils."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ..constants import g
from ..errors import check_choice, check_range


class Coefficient(NamedTuple):
    """A number of a code that was used: what it is, its value, and where it stands."""

    name: str
    value: float
    source: str


#: Ground types of EN 1998-1:2004, Tables 3.2 (type 1) and 3.3 (type 2): S, T_B, T_C, T_D [s].
GROUND_TYPES = {
    1: {
        "A": (1.0, 0.15, 0.4, 2.0),
        "B": (1.2, 0.15, 0.5, 2.0),
        "C": (1.15, 0.20, 0.6, 2.0),
        "D": (1.35, 0.20, 0.8, 2.0),
        "E": (1.4, 0.15, 0.5, 2.0),
    },
    2: {
        "A": (1.0, 0.05, 0.25, 1.2),
        "B": (1.35, 0.05, 0.25, 1.2),
        "C": (1.5, 0.10, 0.25, 1.2),
        "D": (1.8, 0.10, 0.30, 1.2),
        "E": (1.6, 0.05, 0.25, 1.2),
    },
}

#: Soils of NTC 2018, Table 3.2.IV: S_S = least ≤ a − b F₀ a_g/g ≤ most, C_C = c (T_C*)^d.
SOILS = {
    "A": (1.0, 1.0, 0.0, 1.0, 1.0, 0.0),
    "B": (1.0, 1.4, 0.4, 1.2, 1.10, -0.20),
    "C": (1.0, 1.7, 0.6, 1.5, 1.05, -0.33),
    "D": (0.9, 2.4, 1.5, 1.8, 1.25, -0.50),
    "E": (1.0, 2.0, 1.1, 1.6, 1.15, -0.40),
}

#: Topographic categories of NTC 2018, Table 3.2.V: S_T at the top of the slope.
TOPOGRAPHY = {"T1": 1.0, "T2": 1.2, "T3": 1.2, "T4": 1.4}

#: Longest period of both spectra [s].
LONGEST = 4.0


def _shape(t: float, eta: float, top: float, tb: float, tc: float, td: float) -> float:
    """Spectral acceleration over S a_g: the four branches that both codes share."""
    if t <= tb:
        return 1.0 + t / tb * (top * eta - 1.0)
    if t <= tc:
        return top * eta
    return top * eta * tc / t if t <= td else top * eta * tc * td / t**2


def _damping(share: float) -> float:
    """η = √(10/(5 + ξ)) ≥ 0.55, EN 1998-1:2004, Eq. 3.6, and NTC 2018, Eq. 3.2.4."""
    return max(math.sqrt(10.0 / (5.0 + 100.0 * share)), 0.55)


@dataclass(frozen=True)
class EurocodeSpectrum:
    """Elastic displacement spectrum of EN 1998-1:2004: S_De(T) = S_e(T) (T/2π)², Eq. 3.2 to 3.5 and 3.7.

    Parameters
    ----------
    ground_acceleration : float
        a_g, design acceleration on ground type A [m/s²].
    ground_type : {"A", "B", "C", "D", "E"}
    damping : float
        Share of the critical damping [-].
    kind : {1, 2}
        Type of the spectrum; 2 where earthquakes above a magnitude of 5.5 matter little.

    Notes
    -----
    Up to T = 4 s, as 3.2.2.2; Annex A for longer periods is not implemented. The recommended values; a National Annex may
    have others.
    """

    ground_acceleration: float
    ground_type: str = "A"
    damping: float = 0.05
    kind: int = 1

    def __post_init__(self) -> None:
        check_range("ground_acceleration", self.ground_acceleration, 0.0, 100.0, unit="m/s²", open_low=True)
        check_range("damping", self.damping, 0.0, 0.5)
        check_choice("type of the spectrum", self.kind, GROUND_TYPES, field="kind")
        check_choice("ground_type", self.ground_type, GROUND_TYPES[self.kind])

    @property
    def soil_factor(self) -> float:
        """S [-]."""
        return GROUND_TYPES[self.kind][self.ground_type][0]

    @property
    def coefficients(self) -> tuple[Coefficient, ...]:
        """Values taken from the code."""
        table = f"EN 1998-1:2004, Table 3.{self.kind + 1}"
        names = ("S", "T_B [s]", "T_C [s]", "T_D [s]")
        found = [Coefficient(*one, table) for one in zip(names, GROUND_TYPES[self.kind][self.ground_type], strict=True)]
        return (*found, Coefficient("η", _damping(self.damping), "EN 1998-1:2004, Eq. 3.6"))

    def acceleration(self, period: float) -> float:
        """S_e(T) [m/s²].

        Raises
        ------
        InputError
            A period outside 0 to 4 s.
        """
        t = check_range("period", period, 0.0, LONGEST, unit="s", remedy="EN 1998-1, 3.2.2.2 ends there")
        soil, tb, tc, td = GROUND_TYPES[self.kind][self.ground_type]
        return self.ground_acceleration * soil * _shape(t, _damping(self.damping), 2.5, tb, tc, td)

    def __call__(self, period: float) -> float:
        """S_De(T) [m]."""
        return self.acceleration(period) * (period / (2.0 * math.pi)) ** 2


@dataclass(frozen=True)
class NtcSpectrum:
    """Elastic displacement spectrum of NTC 2018 (D.M. 17 January 2018), 3.2.3.2: S_De(T) = S_e(T) (T/2π)².

    Parameters
    ----------
    ground_acceleration, amplification, corner_period : float
        a_g [m/s²], F₀ [-] and T_C* [s] of the site and the return period: the code gives them on a grid (Annexes of
        NTC 2008), which is not part of this package.
    soil : {"A", "B", "C", "D", "E"}
    topography : {"T1", "T2", "T3", "T4"}
    damping : float
        Share of the critical damping [-].
    """

    ground_acceleration: float
    amplification: float
    corner_period: float
    soil: str = "A"
    topography: str = "T1"
    damping: float = 0.05

    def __post_init__(self) -> None:
        check_range("ground_acceleration", self.ground_acceleration, 0.0, 100.0, unit="m/s²", open_low=True)
        check_range("F0", self.amplification, 2.2, 5.0, remedy="NTC 2018, 3.2.3.2.1: not below 2.2")
        check_range("Tc*", self.corner_period, 0.05, 2.0, unit="s")
        check_range("damping", self.damping, 0.0, 0.5)
        for name, known in (("soil", SOILS), ("topography", TOPOGRAPHY)):
            check_choice(name, getattr(self, name), known)

    @property
    def soil_factor(self) -> float:
        """S = S_S S_T [-]."""
        low, a, b, high, _, _ = SOILS[self.soil]
        found = min(max(a - b * self.amplification * self.ground_acceleration / g, low), high)
        return found * TOPOGRAPHY[self.topography]

    @property
    def corners(self) -> tuple[float, float, float]:
        """T_B, T_C and T_D [s]."""
        *_, c, d = SOILS[self.soil]
        tc = c * self.corner_period**d * self.corner_period
        return tc / 3.0, tc, 4.0 * self.ground_acceleration / g + 1.6

    @property
    def coefficients(self) -> tuple[Coefficient, ...]:
        """Values taken from the code."""
        tb, tc, td = self.corners
        return (
            Coefficient("S_S", self.soil_factor / TOPOGRAPHY[self.topography], "NTC 2018, Table 3.2.IV"),
            Coefficient("S_T", TOPOGRAPHY[self.topography], "NTC 2018, Table 3.2.V"),
            Coefficient("T_B [s]", tb, "NTC 2018, Eq. 3.2.6"),
            Coefficient("T_C [s]", tc, "NTC 2018, Eq. 3.2.5 and Table 3.2.IV"),
            Coefficient("T_D [s]", td, "NTC 2018, Eq. 3.2.7"),
            Coefficient("η", _damping(self.damping), "NTC 2018, Eq. 3.2.4"),
        )

    def acceleration(self, period: float) -> float:
        """S_e(T) [m/s²], NTC 2018, Eq. 3.2.2.

        Raises
        ------
        InputError
            A period outside 0 to 4 s.
        """
        t = check_range("period", period, 0.0, LONGEST, unit="s", remedy="NTC 2018, 3.2.3.2 ends there")
        shape = _shape(t, _damping(self.damping), self.amplification, *self.corners)
        return self.ground_acceleration * self.soil_factor * shape

    def __call__(self, period: float) -> float:
        """S_De(T) [m]."""
        return self.acceleration(period) * (period / (2.0 * math.pi)) ** 2
