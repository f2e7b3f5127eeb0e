"""Elastic spectra of codes: EN 1998-1 of both generations and NTC 2018, with the tables of their soils, and as typed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from ..constants import g
from ..errors import InputError, as_typed, check_choice, check_range, suggest, within
from ..motion.specs import parse_acceleration, parse_number, parse_time


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


#: Largest acceleration of the ground on rock, and plateau over it, that any site is designed for, with room above [g], [-].
LARGEST, PLATEAU = 2.0, 2.5


def _check_acceleration(name: str, value: float, over: float = 1.0) -> None:
    """A spectral acceleration on rock as a code means it, so many times that of the ground [m/s²]."""
    remedy = "no design ground shakes harder; write it as 0.25g"
    check_range(name, value / g, 0.0, LARGEST * over, unit="g", open_low=True, remedy=remedy)


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
    ground_type: str
    damping: float = 0.05
    kind: int = 1

    def __post_init__(self) -> None:
        _check_acceleration("ground_acceleration", self.ground_acceleration)
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
    soil: str
    topography: str = "T1"
    damping: float = 0.05

    def __post_init__(self) -> None:
        _check_acceleration("ground_acceleration", self.ground_acceleration)
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


@dataclass(frozen=True)
class SecondEurocodeSpectrum:
    """Elastic spectrum of the second generation of EN 1998-1-1, by its draft of 2019 (prEN 1998-1-1:2019, 5.2.2.2).

    Parameters
    ----------
    plateau, at_one_second : float
        S_α,RP and S_β,RP, spectral accelerations on site category A at the plateau and at 1 s [m/s²].
    plateau_factor, one_second_factor : float
        F_α and F_β with that of topography in them [-]: the draft's tables of them were changed on the way to the standard,
        so that they are yours to give.

    Notes
    -----
    With 5 % damping. T_A = 0.02 s, χ = 4, F_A = 2.5, T_β = 1 s.
    """

    plateau: float
    at_one_second: float
    plateau_factor: float
    one_second_factor: float

    def __post_init__(self) -> None:
        for name, value in (("S_alpha", self.plateau), ("S_beta", self.at_one_second)):
            _check_acceleration(name, value, PLATEAU)
        for name, value in (("F_alpha", self.plateau_factor), ("F_beta", self.one_second_factor)):
            check_range(name, value, 0.5, 10.0)
        if not 0.05 < self.corners[1] < 1.0:
            raise InputError(
                f"S_beta over S_alpha on the site makes T_C {self.corners[1]:.3g} s; allowed is 0.05 to 1 s, beyond it the "
                "code wants a study of the site: check both values.",
                "S_beta",
            )

    @property
    def corners(self) -> tuple[float, float, float]:
        """T_B, T_C and T_D [s]."""
        tc = self.at_one_second * self.one_second_factor / (self.plateau * self.plateau_factor)
        return min(max(tc / 4.0, 0.05), 0.1), tc, max(2.0, 1.0 + self.at_one_second)

    @property
    def coefficients(self) -> tuple[Coefficient, ...]:
        """Values taken from the code."""
        draft = "prEN 1998-1-1:2019, 5.2.2.2"
        return tuple(
            Coefficient(name, value, draft) for name, value in zip(("T_B [s]", "T_C [s]", "T_D [s]"), self.corners)
        )

    def acceleration(self, period: float) -> float:
        """S_e(T) [m/s²].

        Raises
        ------
        InputError
            A period outside 0 to 4 s.
        """
        t = check_range("period", period, 0.0, LONGEST, unit="s")
        top, (tb, tc, td) = self.plateau * self.plateau_factor, self.corners
        if t <= tb:
            return top * (1.0 + 1.5 * max(t - 0.02, 0.0) / (tb - 0.02)) / 2.5
        return top * min(1.0, tc / t, tc * td / t**2)


#: Codes as typed: examples of what must be given to each, and of what may be.
CODES: dict[str, tuple[dict[str, str], dict[str, str]]] = {
    "ec8": ({"ag": "ag=0.25g", "soil": "soil=B"}, {"type": "type=1"}),
    "ec8-2": (
        {"S_alpha": "S_alpha=0.6g", "S_beta": "S_beta=0.2g", "F_alpha": "F_alpha=1.3", "F_beta": "F_beta=1.8"},
        {},
    ),
    "ntc2018": (
        {"ag": "ag=0.25g", "F0": "F0=2.4", "Tc*": "Tc*=0.35s", "soil": "soil=B"},
        {"topography": "topography=T1"},
    ),
}

#: What is taken where it is not typed, and told.
ASSUMED = {"type": "1", "topography": "T1"}

#: What makes a site shake harder than rock, and what stands for rock.
_SITE = {
    "soil": "the ground of the site, A (rock) to E",
    "F_alpha": "the site factor of the plateau, 1 on rock",
    "F_beta": "the site factor at 1 s, 1 on rock",
}


def parse_code(text: str, more: Mapping[str, Mapping[str, str]] | None = None) -> tuple[str, dict[str, str]]:
    """A code and what is typed of it, such as ``ec8,ag=0.25g,soil=B,type=1``.

    Parameters
    ----------
    text : str
    more : dict of str to dict, optional
        Codes that are known here, each with further names and their examples; all codes with no more by default.

    Returns
    -------
    (str, dict of str to str)

    Raises
    ------
    InputError
        A code or a name that is not known, a value that is missing.
    """
    further = {code: {} for code in CODES} if more is None else more
    code, *parts = (part.strip() for part in text.split(","))
    code = code.lower()
    if code not in further:
        raise InputError(f"code {code!r} is not known here; {suggest(code, further)}codes are {', '.join(further)}.")
    needed, known = CODES[code][0], CODES[code][0] | CODES[code][1] | dict(further[code])
    example = ",".join((code, *known.values()))
    given: dict[str, str] = {}
    for part in parts:
        key, sign, value = (one.strip() for one in part.partition("="))
        if not sign or key not in known:
            raise InputError(f"{part!r} says nothing to {code}; write it as {example}.")
        if key in given:
            raise InputError(f"{key} is given twice to {code}; write it as {example}.")
        given[key] = value
    missing = next((name for name in needed if name not in given), None)
    if missing is not None:
        meant = f", {_SITE[missing]}" if missing in _SITE else ""
        raise InputError(f"{code} needs {missing}{meant}; write it as {example}.")
    return code, given


def _acceleration(given: Mapping[str, str], name: str) -> float:
    """What is typed under a name [m/s²]."""
    with within(name, name):
        return parse_acceleration(given[name])


def assumed_of(code: str, given: Mapping[str, str]) -> str:
    """What is taken for a spectrum of a code and is not typed, such as ``type=1 assumed``; nothing where all is typed."""
    taken = ", ".join(f"{name}={value}" for name, value in ASSUMED.items() if name in CODES[code][1].keys() - given)
    return f"{taken} assumed" if taken else ""


def spectrum_of_code(code: str, given: Mapping[str, str]) -> EurocodeSpectrum | SecondEurocodeSpectrum | NtcSpectrum:
    """The spectrum of a code from what :func:`parse_code` returns."""
    if code == "ec8-2":
        factors = (parse_number(name, given[name]) for name in ("F_alpha", "F_beta"))
        return SecondEurocodeSpectrum(*(_acceleration(given, name) for name in ("S_alpha", "S_beta")), *factors)
    ag, soil, other = _acceleration(given, "ag"), given["soil"], ASSUMED | dict(given)
    _check_acceleration("ag", ag)
    if code == "ec8":
        check_choice("type of the spectrum", other["type"], ("1", "2"), field="type")
        return EurocodeSpectrum(ag, soil, kind=int(other["type"]))
    try:
        amplification = float(given["F0"])
    except ValueError:
        raise InputError(f"F0 is {as_typed(given['F0'])}; allowed is a number from 2.2.") from None
    return NtcSpectrum(ag, amplification, parse_time(given["Tc*"]), soil, other["topography"])
