"""Monuments of several sites: what they can bear, what is seen of them, and hazards that are weighed by it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import ndtri

from stylobate import text_tables as tables
from stylobate.column.toml import Table, read_table
from stylobate.errors import InputError, as_typed, check_choice, check_range, check_whole, within
from stylobate.motion.intensity import parse_measure
from stylobate.probability.lognormal import BETAS
from stylobate.probability.risk import Hazard, read_hazard
from stylobate.results.command_request import read_json
from stylobate.results.fragilities import fitted
from stylobate.text_tables import printable

from .ground_motion import MODELS, GroundMotionModel, Source

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
    def of(cls, curve: Mapping[str, Any]) -> Capacity:
        """Capacity of a fragility, by its JSON object; its intervals hold what open runs may come to.

        Raises
        ------
        InputError
            A limit of the median or the dispersion is not known.
        """
        ends = [
            float(curve.get(f"{quantity}{side}") or "nan")
            for quantity in ("median", "beta")
            for side in ("", "_low", "_high")
        ]
        if not all(math.isfinite(end) and end > 0.0 for end in ends):
            raise InputError(
                f"the fragility of {curve.get('name')!r} leaves its median or dispersion without a limit, which nothing can "
                "be weighed by; give it more levels or records.",
                "fragility",
            )
        q = float(ndtri(0.5 + 0.5 * float(curve.get("confidence", 0.95))))
        best, low, high, wide, least, most = map(math.log, ends)
        return cls(
            measure=str(curve["im"]),
            unit=str(curve["unit"]),
            state=str(curve["state"]),
            log_median=best,
            log_beta=wide,
            median_sides=(max(best - low, 0.0) / q, max(high - best, 0.0) / q),
            beta_sides=(max(wide - least, 0.0) / q, max(most - wide, 0.0) / q),
            correlation=float(curve.get("correlation") or 0.0),
            doubts=tuple(curve.get("warnings", ())),
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
    """All that is weighed together."""

    sites: tuple[Site, ...]
    monuments: tuple[Monument, ...]
    branches: tuple[Branch, ...]
    seed: int = 0

    def __post_init__(self) -> None:
        for what, names in (
            ("sites", [site.name for site in self.sites]),
            ("branches", [branch.name for branch in self.branches]),
            ("states of monuments", [monument.called for monument in self.monuments]),
        ):
            if not names:
                raise InputError(f"no {what} are given; give at least one.")
            twice = next((name for k, name in enumerate(names) if name in names[:k]), None)
            if twice is not None:
                raise InputError(f"two {what} are called {twice!r}; give each a name of its own.")
        known = {site.name: site for site in self.sites}
        for monument in self.monuments:
            check_choice("site", monument.site, known, of=repr(monument.name))
            if (monument.site, monument.age, monument.until) != next(
                (first.site, first.age, first.until) for first in self.monuments if first.name == monument.name
            ):
                raise InputError(
                    f"states of {monument.name!r} differ in site, `age` or until; one monument has one of each."
                )
        measures = {(monument.capacity.measure, monument.capacity.unit) for monument in self.monuments}
        if len(measures) > 1:
            intensities = ", ".join(sorted(f"{measure} in {unit}" for measure, unit in measures))
            raise InputError(f"the fragilities are over different intensities ({intensities}); give all of one.", "im")
        self._check_branches(known)

    def windows(self, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Begin and end of what is known of each state [years before today], shape (n,).

        Parameters
        ----------
        share : array
            Where in its spans the age of each state lies, and until when it is known, from 0 to 1, shape (n, 2).
        """
        ages, untils = ([getattr(monument, name) for monument in self.monuments] for name in ("age", "until"))
        begin, end = (
            np.array([low + (high - low) * fraction for (low, high), fraction in zip(spans, part, strict=True)])
            for spans, part in zip((ages, untils), share.T, strict=True)
        )
        return begin, end

    def _check_branches(self, known: Mapping[str, Site]) -> None:
        used = dict.fromkeys(monument.site for monument in self.monuments)
        if len({bool(branch.sources) for branch in self.branches}) > 1:
            raise InputError("some branches have hazard curves and some have sources; give all of one kind.")
        for branch in self.branches:
            missing = [name for name in used if branch.curves and name not in branch.curves]
            missing += [name for name in used if branch.sources and known[name].at is None]
            if missing:
                what = "place (`at`)" if branch.sources else "hazard curve"
                raise InputError(f"branch {branch.name!r} needs a {what} of site {missing[0]!r}; give one.")
        total = sum(branch.weight for branch in self.branches)
        if abs(total - 1.0) > ROUNDED * (1.0 + 1e-9):  # three times 0.33 is 0.99
            raise InputError(
                f"the weights of the branches sum to {total:.4g}; allowed is 1, within {ROUNDED:g}: correct them, or divide "
                f"each by {total:.4g}.",
                "weight",
                value=total,
                allowed="1",
            )


# Files of several sites (TOML): monuments, what is seen of them, and the branches of a logic tree that they weigh.

#: Largest table of branches or sources [bytes], and most branches.
MOST, MOST_BRANCHES = 50_000_000, 5000

#: Columns of a table of branches that name no site.
BRANCH_COLUMNS = ("branch", "weight", "sources", "model")


class SiteTable(Table):
    """``[[sites]]``: a place."""

    name: str
    at: list[int | float] | None = None
    vs30: float = 800.0


class MonumentTable(Table):
    """``[[monuments]]``: a state of a monument, and whether it has come to it."""

    name: str
    site: str
    seen: str
    age: Any
    until: Any = 0.0
    fragility: str | None = None
    of: str | None = None
    im: str | None = None
    state: str = "collapse"
    median: float | None = None
    median_95: list[int | float] | None = None
    beta: float | None = None
    beta_95: list[int | float] | None = None
    records_are_one: bool = False


class SitesFile(Table):
    """A file of sites."""

    branches: str
    sites: list[SiteTable]
    monuments: list[MonumentTable]
    seed: int = 0


def read_sites(path: str | Path) -> Sites:
    """Read a file of sites; what it names lies beside it.

    Raises
    ------
    InputError
        The file cannot be read, or describes nothing that can be weighed; the message names the place and the remedy.
    """
    file, folder = read_table(path, SitesFile), Path(path).parent
    with within(printable(path)):
        sites = tuple(
            Site(site.name, None if site.at is None else _pair("at", site.at), site.vs30) for site in file.sites
        )
        monuments = []
        for number, monument in enumerate(file.monuments, 1):
            with within(f"[[monuments]] number {number}", "monuments", number):
                capacity = _capacity(monument, folder)
                monuments.append(
                    Monument(
                        monument.name,
                        monument.site,
                        capacity,
                        monument.seen,
                        _span("age", monument.age),
                        _span("until", monument.until),
                    )
                )
        branches = _branches(folder / file.branches, sites)
        return Sites(sites, tuple(monuments), branches, check_whole("`seed`", file.seed, 0, 2**63 - 1))


def _capacity(table: MonumentTable, folder: Path) -> Capacity:
    numbers = (table.median, table.beta, table.median_95, table.beta_95)
    if table.fragility is None:
        if table.median is None or table.beta is None or table.im is None:
            raise InputError("it needs fragility, a file or folder, or `im`, median and beta; give one of both.")
        measure = parse_measure(table.im)
        fragility: dict[str, Any] = {"name": table.name, "im": measure.name, "unit": measure.unit, "state": table.state}
        for name, best, limits in (("median", table.median, table.median_95), ("beta", table.beta, table.beta_95)):
            low, high = (best, best) if limits is None else _pair(f"{name}_95", limits)
            if not 0.0 < low <= best <= high:
                raise InputError(
                    f"`{name}` is {best:g} and `{name}_95` {low:g} to {high:g}; give 0 < low ≤ {name} ≤ high.", name
                )
            fragility |= {name: best, f"{name}_low": low, f"{name}_high": high}
        return Capacity.of(fragility)
    if any(number is not None for number in numbers):
        raise InputError("fragility and numbers of one are both given; leave one out.", "fragility")
    place = folder / table.fragility
    if (place / "fragility.json").is_file():
        document = read_json(place / "fragility.json")
        curves = [curve for curve in document.get("curves") or [document] if table.of in (None, curve.get("name"))]
        if len(curves) != 1 or not {"median", "beta", "im", "unit", "state"} <= set(curves[0]):
            raise InputError(
                f"{printable(place)} holds {len(curves)} curves that may be meant; name one with `of`.", "of"
            )
        return Capacity.of(curves[0])
    how = {"records_are_one": table.records_are_one}
    (curve,), _ = fitted([place], table.im, table.state, [table.of] if table.of else None, single=True, **how)
    return Capacity.of(curve.summary())


def _branches(path: Path, sites: tuple[Site, ...]) -> tuple[Branch, ...]:
    """A row for each branch: its weight, and a hazard file for each site, or a table of sources and a model."""
    table = tables.read(path, MOST, "branch", "the columns branch, weight, and one for each site, or sources and model")
    known = {site.name.lower(): site for site in sites}
    if "weight" not in table.columns:
        raise InputError(f"{table.name} has no column 'weight'; add what each branch weighs before anything is seen.")
    for column in table.columns:
        check_choice("column", column, [*BRANCH_COLUMNS, *known], of=table.name)
    if len(table.rows) > MOST_BRANCHES:
        raise InputError(f"{table.name} has {len(table.rows)} branches; allowed are {MOST_BRANCHES}.")
    branches = []
    for line, weight, row in zip(table.lines, table.numbers("weight"), table.rows, strict=True):
        cells = dict(zip(table.columns, row, strict=True))
        with within(f"line {line} of {table.name}"):
            curves = {
                site.name: read_hazard(path.parent / cells[key], site.at)
                for key, site in known.items()
                if cells.get(key)
            }
            sources, model = cells.get("sources"), None
            if cells.get("model"):
                check_choice("model", cells["model"], MODELS)
                model = MODELS[cells["model"]]
            events = tuple(_sources(path.parent / sources)) if sources else ()
            branches.append(Branch(cells["branch"], weight, curves, events, model))
    return tuple(branches)


#: Columns of a table of sources.
SOURCE_COLUMNS = ("source", "lon", "lat", "magnitude_min", "magnitude_max", "rate", "b", "mechanism")
FURTHER = ("lon2", "lat2", "radius_km", "strike")


def _sources(path: Path) -> list[Source]:
    table = tables.read(
        path, MOST, "source", f"the columns {', '.join(SOURCE_COLUMNS)}; {', '.join(FURTHER)} where they are known"
    )
    for column in table.columns:
        check_choice("column", column, [*SOURCE_COLUMNS, *FURTHER], of=table.name)
    missing = next((column for column in SOURCE_COLUMNS if column not in table.columns), None)
    if missing:
        raise InputError(f"{table.name} has no column {missing!r}; it needs {', '.join(SOURCE_COLUMNS)}.")
    numbers: dict[str, list[Any]] = {
        column: table.numbers(column, float("nan") if column in FURTHER else None)
        for column in table.columns
        if column not in ("source", "mechanism")
    }
    sources = []
    for k, name in enumerate(table.texts("source")):
        row = {column: values[k] for column, values in numbers.items() if values[k] == values[k]}
        ends = [(row["lon"], row["lat"])]
        if ("lon2" in row) != ("lat2" in row):
            raise InputError(f"source {name!r} of {table.name} has one of lon2 and lat2; give both, or none.")
        if "lon2" in row:
            ends.append((row["lon2"], row["lat2"]))
        with within(f"line {table.lines[k]} of {table.name}"):
            sources.append(
                Source(
                    name, tuple(ends), (row["magnitude_min"], row["magnitude_max"]), row["rate"], row["b"],
                    table.texts("mechanism")[k], row.get("radius_km", 0.0), row.get("strike"),
                )
            )  # fmt: skip
    return sources


def _pair(name: str, values: Any) -> tuple[float, float]:
    plain = isinstance(values, list) and len(values) == 2
    if not plain or any(isinstance(value, bool) or not isinstance(value, (int, float)) for value in values):
        raise InputError(f"`{name}` is {as_typed(values)}; allowed is a list of two numbers.", name)
    return float(values[0]), float(values[1])


def _span(name: str, value: Any) -> tuple[float, float]:
    """A time, or the two between which it lies [years before today]."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value), float(value)
    return _pair(name, value)
