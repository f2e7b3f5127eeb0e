"""Survival as an observation: what stands has outlasted all shaking since a date, of which a hazard curve says how often."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stylobate.errors import InputError, as_typed, check_kind, check_range

#: Years in which something may have been built, shaken and surveyed; those before Christ are negative.
FIRST, LAST = -10_000.0, 3000.0

#: Pairs of dates that are drawn, and the fewest of them that must be in their order.
DATES, FEWEST_IN_ORDER = 4000, 40

#: A date: a year, or the first and the last that it may be.
Year = float | tuple[float, float]


@dataclass(frozen=True)
class Outlasted:
    """What stands today has outlasted all shaking since a date but the earthquake that left it so.

    Parameters
    ----------
    hazard : path
        Hazard curve of PGV or PGA, as ``stylobate risk`` reads it.
    until : float
        Year of the survey.
    since : float or pair of float, optional
        Year from which on it has stood, negative before Christ; of a pair each year between is as likely.
    earthquake : float or pair of float, optional
        Year of the earthquake; by default any since ``since``.
    since_sd, earthquake_sd : float
        Standard deviations of years [y].
    site : pair of float, optional
        Longitude and latitude [degrees], for a hazard file of several sites.

    Raises
    ------
    InputError
        Neither of the dates, a number outside its range, or dates that contradict one another.
    """

    hazard: str | Path
    until: float
    since: Year | None = None
    earthquake: Year | None = None
    since_sd: float = 0.0
    earthquake_sd: float = 0.0
    site: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        check_kind("hazard", self.hazard, (str, Path))
        check_range("until", self.until, FIRST, LAST, unit="(a year)", field="until")
        if self.since is None and self.earthquake is None:
            raise InputError("neither since nor earthquake is given; give at least one of the two years.", "since")
        for name in ("since", "earthquake"):
            given, sd = getattr(self, name), getattr(self, f"{name}_sd")
            pair = isinstance(given, (list, tuple))
            if pair and (len(given) != 2 or not given[0] < given[1]):
                raise InputError(
                    f"`{name}` is {as_typed(list(given))}; allowed are a year, or the first and the last.", name
                )
            for year in () if given is None else given if pair else (given,):
                check_range(f"a year of `{name}`", year, FIRST, LAST, unit="(a year)", field=name)
            check_range(f"`{name}_sd`", sd, 0.0, 5000.0, unit="y", field=f"{name}_sd")
            if sd and (pair or given is None):
                raise InputError(
                    f"{name}_sd is given, and {name} is no single year; leave one of the two out.", f"{name}_sd"
                )
        if self.site is not None and len(self.site) != 2:
            raise InputError("`site` holds longitude and latitude, two numbers.", "site")
        self.dates(0)

    def dates(self, seed: int) -> np.ndarray:
        """Years from which on it has stood, and of the earthquake, drawn in their order, shape (draws, 2)."""
        stream = np.random.default_rng([seed, 3])
        even, normal = stream.random((DATES, 3)), stream.standard_normal((DATES, 2))
        drawn = [
            None if one is None else one[0] + (one[1] - one[0]) * even[:, k] if isinstance(one, (list, tuple))
            else one + sd * normal[:, k]
            for k, (one, sd) in enumerate(((self.since, self.since_sd), (self.earthquake, self.earthquake_sd)))
        ]  # fmt: skip
        built, shaken = drawn
        if shaken is None:
            assert built is not None
            shaken = built + (self.until - built) * even[:, 2]
        built = shaken if built is None else built
        ordered = (built <= shaken) & (shaken <= self.until)
        if ordered.sum() < FEWEST_IN_ORDER:
            raise InputError(
                "the years contradict one another: since comes first, then the earthquake, then until; mend them.",
                "until",
            )
        return np.stack((built, shaken), axis=1)[ordered]
