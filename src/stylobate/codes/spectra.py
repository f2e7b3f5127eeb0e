"""Spectra of codes, and spectra that records are chosen for."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from .. import text_tables as tables
from ..constants import g
from ..errors import InputError, as_typed, check_choice, check_range, suggest, within
from ..messages import say
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
        values = [
            Coefficient(*pair, table) for pair in zip(names, GROUND_TYPES[self.kind][self.ground_type], strict=True)
        ]
        return (*values, Coefficient("η", _damping(self.damping), "EN 1998-1:2004, Eq. 3.6"))

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
        soil_amplification = min(max(a - b * self.amplification * self.ground_acceleration / g, low), high)
        return soil_amplification * TOPOGRAPHY[self.topography]

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
        key, sign, value = (piece.strip() for piece in part.partition("="))
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


#: Shortest and longest period of Baker and Jayaram's correlations [s].
CORRELATED = (0.01, 10.0)

#: Codes that also want the mean of the peak ground accelerations, at a period of 0, and the largest excess of the mean that
#: each allows over the target [-].
FROM_ZERO, EXCESS = ("ec8",), {"ntc2018": 1.3}

#: Fewest records of EN 1998-1 (3.2.3.1.2) and NTC 2018.
FEWEST = 3

_MOST = 1_000_000

_CONDITIONAL = re.compile(r"cms:(?P<file>.+),\s*T=(?P<period>[^,]+),\s*sa=(?P<level>[^,]+)")


@dataclass(frozen=True, eq=False)
class TargetSpectrum:
    """Elastic spectrum for 5 % damping that records are held against.

    Parameters
    ----------
    name : str
        As typed.
    words : str
        Where it comes from.
    shortest, longest : float
        Periods between which it is known [s].
    acceleration : callable
        Spectral acceleration [m/s²] at a period [s].
    from_zero : bool
        Its code also wants the mean of the peak ground accelerations.
    most : float, optional
        Largest mean over the target that its code allows [-].
    fewest : int
        Records that its code wants at least.
    assumed : str
        What of its code was not typed, and is taken: ``type=1 assumed``.
    """

    name: str
    words: str
    shortest: float
    longest: float
    acceleration: Callable[[float], float]
    from_zero: bool = False
    most: float | None = None
    fewest: int = 1
    assumed: str = ""

    def at(self, periods: np.ndarray) -> np.ndarray:
        """Spectral accelerations [m/s²] at periods [s], both of shape (P,).

        Raises
        ------
        InputError
            A period at which it is not known.
        """
        for period in (float(periods.min()), float(periods.max())):
            check_range(f"period of the target {self.name}", period, self.shortest, self.longest, unit="s")
        return np.array([self.acceleration(float(period)) for period in periods])


def target_spectrum(text: str) -> TargetSpectrum:
    """The target spectrum as typed.

    Parameters
    ----------
    text : str
        ``ec8,ag=0.25g,soil=B``, ``ec8-2,S_alpha=0.6g,S_beta=0.2g``, ``ntc2018,ag=0.25g,F0=2.4,Tc*=0.35s``; a CSV file with
        the columns period_s and sa_g or sa_m_s2, such as a uniform hazard spectrum; ``cms:FILE.csv,T=1s,sa=0.4g``, with the
        columns period_s, median_g or median_m_s2, and sigma_ln.

    Raises
    ------
    InputError
        It cannot be read.
    """
    text = text.strip()
    if text.lower().startswith("cms:"):
        return _conditional_mean(text)
    if text.lower().endswith((".csv", ".txt", ".tsv")):
        period, level = _read(text, "sa")
        return _over_periods(text, say("table {file}", file=text), period, level)
    code, given = parse_code(text)
    spectrum = spectrum_of_code(code, given)
    assumed = assumed_of(code, given)
    words = f"{_CODE[code]} ({assumed})" if assumed else _CODE[code]
    return TargetSpectrum(
        text, words, 0.0, LONGEST, spectrum.acceleration, code in FROM_ZERO, EXCESS.get(code), FEWEST, assumed
    )


_CODE = dict(zip(CODES, ("EN 1998-1:2004, 3.2.2.2", "prEN 1998-1-1:2019, 5.2.2.2", "NTC 2018, 3.2.3.2"), strict=True))


def correlation(period: float, other: float) -> float:
    """Correlation of the logarithms of spectral accelerations at two periods [s] (Baker and Jayaram 2008, Eq. 5 to 8)."""
    low, high = sorted((period, other))
    c1 = 1.0 - math.cos(math.pi / 2.0 - 0.366 * math.log(high / max(low, 0.109)))
    c2 = 0.0
    if high < 0.2:
        c2 = 1.0 - 0.105 * (1.0 - 1.0 / (1.0 + math.exp(100.0 * high - 5.0))) * (high - low) / (high - 0.0099)
    c3 = c2 if high < 0.109 else c1
    c4 = c1 + 0.5 * (math.sqrt(c3) - c3) * (1.0 + math.cos(math.pi * low / 0.109))
    if high < 0.109:
        return c2
    if low > 0.109:
        return c1
    return min(c2, c4) if high < 0.2 else c4


def _conditional_mean(text: str) -> TargetSpectrum:
    """ln Sa(T) = ln median + ρ ε σ, where ε at the conditioning period makes Sa what is asked for (Baker 2011, Eq. 4)."""
    match = _CONDITIONAL.fullmatch(text)
    if match is None:
        raise InputError(f"target {text!r} cannot be read; write it as cms:FILE.csv,T=1s,sa=0.4g.")
    at, level = parse_time(match["period"]), parse_acceleration(match["level"])
    period, median, sigma = _read(match["file"], "median", "sigma_ln")
    for checked_period in (float(period[0]), float(period[-1]), at):
        check_range(
            f"period of {text}", checked_period, *CORRELATED, unit="s", remedy="the correlations are known between"
        )
    check_range(f"T of {text}", at, float(period[0]), float(period[-1]), unit="s")
    check_range(f"sa of {text}", level, 0.0, 100.0, unit="m/s²", open_low=True)
    bad = next((spread for spread in sigma if not 0.0 < spread <= 2.0), None)
    if bad is not None:
        raise InputError(
            f"sigma_ln of {match['file']} is {bad:g}; allowed is above 0 up to 2, of the natural logarithm."
        )
    x = np.log(period)
    median_there, sigma_there = (float(np.interp(math.log(at), x, ordinates)) for ordinates in (np.log(median), sigma))
    epsilon = (math.log(level) - median_there) / sigma_there
    rho = np.array([correlation(float(other_period), at) for other_period in period])
    mean = np.log(median) + rho * epsilon * sigma
    # the conditioning period is a point of its own: there the spectrum is what is asked for
    k = int(np.searchsorted(period, at))
    if not (k < len(period) and period[k] == at):
        period, mean = np.insert(period, k, at), np.insert(mean, k, math.log(level))
    words = say("conditional mean spectrum, Sa({at:g} s) = {level:g} g, ε = {epsilon:.2f}")
    words = words.of(at=at, level=level / g, epsilon=epsilon)
    return _over_periods(text, words, period, np.exp(mean))


def _over_periods(name: str, words: str, period: np.ndarray, level: np.ndarray) -> TargetSpectrum:
    x, y = np.log(period), np.log(level)
    return TargetSpectrum(
        name, words, float(period[0]), float(period[-1]), lambda t: float(np.exp(np.interp(math.log(t), x, y)))
    )


def _read(path: str, column: str, *more: str) -> tuple[np.ndarray, ...]:
    """Periods [s], accelerations [m/s²] under the name of a column with its unit, and further columns; rising periods."""
    table = tables.read(path, _MOST, "period_s", f"the columns period_s, {column}_g or {column}_m_s2{_and(more)}")
    units = {f"{column}_g": g, f"{column}_m_s2": 1.0}
    there = [name for name in units if name in table.columns]
    missing = next((name for name in more if name not in table.columns), None)
    if len(there) != 1 or missing is not None:
        raise InputError(
            f"{path} needs the columns period_s, {column}_g or {column}_m_s2{_and(more)}; it has {', '.join(table.columns)}."
        )
    period = np.array(table.numbers("period_s"))
    level = np.array(table.numbers(there[0])) * units[there[0]]
    if len(period) < 2 or not np.isfinite(period).all() or (np.diff(period) <= 0.0).any() or period[0] < 0.0:
        raise InputError(f"periods of {path} must rise from 0 or more, two of them at least; sort the rows.")
    if not np.isfinite(level).all() or (level <= 0.0).any():
        raise InputError(f"{there[0]} of {path} must be above 0, and finite; check the column.")
    k = int(level.argmax())
    most = LARGEST * PLATEAU
    if level[k] > most * g:
        meant = (
            f"; if m/s² is meant, call the column {column}_m_s2" if there[0] != f"{column}_m_s2" else "; check the unit"
        )
        raise InputError(
            f"{there[0]} of {path} is {level[k] / units[there[0]]:g} at {period[k]:g} s, which is {level[k] / g:.3g} g; "
            f"allowed is up to {most:g} g{meant}."
        )
    keep = period > 0.0  # the peak ground acceleration, which no logarithm has
    return period[keep], level[keep], *(np.array(table.numbers(name))[keep] for name in more)


def _and(more: tuple[str, ...]) -> str:
    return "".join(f", {name}" for name in more)
