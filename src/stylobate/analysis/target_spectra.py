"""Target spectra that records are held against: of a code, of a table, and a conditional mean spectrum."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..constants import g
from ..errors import InputError, check_range
from ..messages import say
from ..motion.specs import parse_acceleration, parse_time
from . import tables
from .code_spectra import CODES, LARGEST, LONGEST, PLATEAU, assumed_of, parse_code, spectrum_of_code

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


def correlation(one: float, other: float) -> float:
    """Correlation of the logarithms of spectral accelerations at two periods [s] (Baker and Jayaram 2008, Eq. 5 to 8)."""
    low, high = sorted((one, other))
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
    found = _CONDITIONAL.fullmatch(text)
    if found is None:
        raise InputError(f"target {text!r} cannot be read; write it as cms:FILE.csv,T=1s,sa=0.4g.")
    at, level = parse_time(found["period"]), parse_acceleration(found["level"])
    period, median, sigma = _read(found["file"], "median", "sigma_ln")
    for one in (float(period[0]), float(period[-1]), at):
        check_range(f"period of {text}", one, *CORRELATED, unit="s", remedy="the correlations are known between")
    check_range(f"T of {text}", at, float(period[0]), float(period[-1]), unit="s")
    check_range(f"sa of {text}", level, 0.0, 100.0, unit="m/s²", open_low=True)
    bad = next((one for one in sigma if not 0.0 < one <= 2.0), None)
    if bad is not None:
        raise InputError(
            f"sigma_ln of {found['file']} is {bad:g}; allowed is above 0 up to 2, of the natural logarithm."
        )
    x = np.log(period)
    median_there, sigma_there = (float(np.interp(math.log(at), x, one)) for one in (np.log(median), sigma))
    epsilon = (math.log(level) - median_there) / sigma_there
    rho = np.array([correlation(float(one), at) for one in period])
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
