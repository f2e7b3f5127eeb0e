"""Monuments of several sites: what they can bear, what is seen of them, and hazards that are weighed by it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.special import ndtri

from stylobate.errors import InputError, check_choice, check_range
from stylobate.probability.lognormal import BETAS
from stylobate.probability.risk import Hazard

from .ground_motion import GroundMotionModel, Source

#: What is seen of a state.
OBSERVATIONS = ("stands", "reached")

#: Longest time that anything has stood [y].
OLDEST = 1e6

#: By how much the weights of branches may miss 1, as shares that were rounded do [-].
ROUNDED = 0.01


@dataclass(frozen=True)
class Capacity:
    """A lognormal fragility with what is known of its median and dispersion: normal in the logarithms, either side its own.

    Parameters
    ----------
    measure, unit, state : str
    log_median, log_beta : float
        ln θ, ln β.
    median_sides, beta_sides : (float, float)
        Standard deviations of ln θ and of ln β below and above [-].
    correlation : float
        Of both [-].
    doubts : tuple of str
    """

    measure: str
    unit: str
    state: str
    log_median: float
    log_beta: float
    median_sides: tuple[float, float] = (0.0, 0.0)
    beta_sides: tuple[float, float] = (0.0, 0.0)
    correlation: float = 0.0
    doubts: tuple[str, ...] = ()

    @classmethod
    def of(cls, told: Mapping[str, Any]) -> Capacity:
        """Capacity of a fragility, by its JSON object; its intervals hold what open runs may come to.

        Raises
        ------
        InputError
            A limit of the median or the dispersion is not known.
        """
        ends = [
            float(told.get(f"{one}{side}") or "nan") for one in ("median", "beta") for side in ("", "_low", "_high")
        ]
        if not all(math.isfinite(one) and one > 0.0 for one in ends):
            raise InputError(
                f"the fragility of {told.get('name')!r} leaves its median or dispersion without a limit, which nothing can "
                "be weighed by; give it more levels or records.",
                "fragility",
            )
        q = float(ndtri(0.5 + 0.5 * float(told.get("confidence", 0.95))))
        best, low, high, wide, least, most = map(math.log, ends)
        return cls(
            measure=str(told["im"]),
            unit=str(told["unit"]),
            state=str(told["state"]),
            log_median=best,
            log_beta=wide,
            median_sides=(max(best - low, 0.0) / q, max(high - best, 0.0) / q),
            beta_sides=(max(wide - least, 0.0) / q, max(most - wide, 0.0) / q),
            correlation=float(told.get("correlation") or 0.0),
            doubts=tuple(told.get("warnings", ())),
        )

    def draw(self, normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """ln θ and β of standard normal numbers, shape (k, 2)."""
        first, other = normal.T
        second = self.correlation * first + math.sqrt(1.0 - self.correlation**2) * other
        middle, spread = (
            best + np.where(z < 0.0, low, high) * z
            for best, (low, high), z in (
                (self.log_median, self.median_sides, first),
                (self.log_beta, self.beta_sides, second),
            )
        )
        return middle, np.clip(np.exp(spread), *BETAS)


@dataclass(frozen=True)
class Site:
    """A place.

    Parameters
    ----------
    name : str
    at : (float, float), optional
        Longitude and latitude [degrees].
    vs30 : float
        [m/s]
    """

    name: str
    at: tuple[float, float] | None = None
    vs30: float = 800.0


@dataclass(frozen=True)
class Monument:
    """A state of a monument, and whether it has come to it.

    Parameters
    ----------
    name : str
        Of the monument; states of one monument share it.
    site : str
    capacity : Capacity
    seen : str
        ``stands``: it has not come to the state; ``reached``: it has.
    age : (float, float)
        Years before today since when it was as the fragility describes it: anywhere between, as likely.
    until : (float, float)
        Years before today up to which this is known.
    """

    name: str
    site: str
    capacity: Capacity
    seen: str
    age: tuple[float, float]
    until: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        of = self.called
        check_choice("seen", self.seen, OBSERVATIONS, of=of)
        for name in ("age", "until"):
            low, high = getattr(self, name)
            check_range(f"`{name}`", low, 0.0, OLDEST, unit="years", of=of)
            check_range(f"`{name}`", high, low, OLDEST, unit="years", of=of)
        if self.until[1] >= self.age[0]:
            raise InputError(
                f"{of} is known until {self.until[1]:g} years ago and was as it was for no more than {self.age[0]:g}; give "
                "an earlier `age`, or a later until.",
                "until",
            )

    @property
    def called(self) -> str:
        """Name and state."""
        return f"{self.name}, {self.capacity.state}"

    @property
    def words(self) -> str:
        """What is seen, in few words."""
        return f"{self.name} {'has come to' if self.seen == 'reached' else 'without'} {self.capacity.state}"


@dataclass(frozen=True, eq=False)
class Branch:
    """A branch of a logic tree: a hazard curve for each site, or sources with a ground-motion model.

    Parameters
    ----------
    name : str
    weight : float
        Before anything is seen [-]; weights of all branches sum to 1, but for rounding.
    curves : mapping of str to Hazard
        By site.
    sources : tuple of Source
    model : GroundMotionModel, optional
    """

    name: str
    weight: float
    curves: Mapping[str, Hazard] = field(default_factory=dict)
    sources: tuple[Source, ...] = ()
    model: GroundMotionModel | None = None

    def __post_init__(self) -> None:
        check_range("weight", self.weight, 0.0, 1e6, of=f"branch {self.name!r}", open_low=True)
        if bool(self.curves) == bool(self.sources) or (self.model is None) == bool(self.sources):
            raise InputError(
                f"branch {self.name!r} needs a hazard curve for each site, or sources with a ground-motion model; give one."
            )


@dataclass(frozen=True, eq=False)
class Sites:
    """All that is weighed together.

    Parameters
    ----------
    sites : tuple of Site
    monuments : tuple of Monument
    branches : tuple of Branch
    """

    sites: tuple[Site, ...]
    monuments: tuple[Monument, ...]
    branches: tuple[Branch, ...]
    seed: int = 0

    def __post_init__(self) -> None:
        for what, names in (
            ("sites", [one.name for one in self.sites]),
            ("branches", [one.name for one in self.branches]),
            ("states of monuments", [one.called for one in self.monuments]),
        ):
            if not names:
                raise InputError(f"no {what} are given; give at least one.")
            twice = next((one for k, one in enumerate(names) if one in names[:k]), None)
            if twice is not None:
                raise InputError(f"two {what} are called {twice!r}; give each a name of its own.")
        known = {one.name: one for one in self.sites}
        for one in self.monuments:
            check_choice("site", one.site, known, of=repr(one.name))
            if (one.site, one.age, one.until) != next(
                (first.site, first.age, first.until) for first in self.monuments if first.name == one.name
            ):
                raise InputError(
                    f"states of {one.name!r} differ in site, `age` or until; one monument has one of each."
                )
        measures = {(one.capacity.measure, one.capacity.unit) for one in self.monuments}
        if len(measures) > 1:
            told = ", ".join(sorted(f"{measure} in {unit}" for measure, unit in measures))
            raise InputError(f"the fragilities are over different intensities ({told}); give all of one.", "im")
        self._check_branches(known)

    def windows(self, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Begin and end of what is known of each state [years before today], shape (n,).

        Parameters
        ----------
        share : array
            Where in its spans the age of each state lies, and until when it is known, from 0 to 1, shape (n, 2).
        """
        ages, untils = ([getattr(one, name) for one in self.monuments] for name in ("age", "until"))
        begin, end = (
            np.array([low + (high - low) * one for (low, high), one in zip(spans, part, strict=True)])
            for spans, part in zip((ages, untils), share.T, strict=True)
        )
        return begin, end

    def _check_branches(self, known: Mapping[str, Site]) -> None:
        used = dict.fromkeys(one.site for one in self.monuments)
        if len({bool(one.sources) for one in self.branches}) > 1:
            raise InputError("some branches have hazard curves and some have sources; give all of one kind.")
        for branch in self.branches:
            missing = [name for name in used if branch.curves and name not in branch.curves]
            missing += [name for name in used if branch.sources and known[name].at is None]
            if missing:
                what = "place (`at`)" if branch.sources else "hazard curve"
                raise InputError(f"branch {branch.name!r} needs a {what} of site {missing[0]!r}; give one.")
        total = sum(one.weight for one in self.branches)
        if abs(total - 1.0) > ROUNDED * (1.0 + 1e-9):  # three times 0.33 is 0.99
            raise InputError(
                f"the weights of the branches sum to {total:.4g}; allowed is 1, within {ROUNDED:g}: correct them, or divide "
                f"each by {total:.4g}.",
                "weight",
                value=total,
                allowed="1",
            )
