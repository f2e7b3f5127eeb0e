"""Files of several sites (TOML): monuments, what is seen of them, and the branches of a logic tree that they weigh."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stylobate import text_tables as tables
from stylobate.column.toml import Table, read_table
from stylobate.errors import InputError, as_typed, check_choice, check_whole, within
from stylobate.motion.intensity_specs import parse_measure
from stylobate.probability.risk import read_hazard
from stylobate.results.asked import read_json
from stylobate.results.fragilities import fitted
from stylobate.text_tables import printable

from .ground_motion import MODELS, Source
from .monuments import Branch, Capacity, Monument, Site, Sites

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
        sites = tuple(Site(one.name, None if one.at is None else _pair("at", one.at), one.vs30) for one in file.sites)
        monuments = []
        for number, one in enumerate(file.monuments, 1):
            with within(f"[[monuments]] number {number}", "monuments", number):
                capacity = _capacity(one, folder)
                monuments.append(
                    Monument(one.name, one.site, capacity, one.seen, _span("age", one.age), _span("until", one.until))
                )
        branches = _branches(folder / file.branches, sites)
        return Sites(sites, tuple(monuments), branches, check_whole("`seed`", file.seed, 0, 2**63 - 1))


def _capacity(table: MonumentTable, folder: Path) -> Capacity:
    numbers = (table.median, table.beta, table.median_95, table.beta_95)
    if table.fragility is None:
        if table.median is None or table.beta is None or table.im is None:
            raise InputError("it needs fragility, a file or folder, or `im`, median and beta; give one of both.")
        measure = parse_measure(table.im)
        told: dict[str, Any] = {"name": table.name, "im": measure.name, "unit": measure.unit, "state": table.state}
        for name, best, limits in (("median", table.median, table.median_95), ("beta", table.beta, table.beta_95)):
            low, high = (best, best) if limits is None else _pair(f"{name}_95", limits)
            if not 0.0 < low <= best <= high:
                raise InputError(
                    f"`{name}` is {best:g} and `{name}_95` {low:g} to {high:g}; give 0 < low ≤ {name} ≤ high.", name
                )
            told |= {name: best, f"{name}_low": low, f"{name}_high": high}
        return Capacity.of(told)
    if any(one is not None for one in numbers):
        raise InputError("fragility and numbers of one are both given; leave one out.", "fragility")
    place = folder / table.fragility
    if (place / "fragility.json").is_file():
        found = read_json(place / "fragility.json")
        curves = [one for one in found.get("curves") or [found] if table.of in (None, one.get("name"))]
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
    known = {one.name.lower(): one for one in sites}
    if "weight" not in table.columns:
        raise InputError(f"{table.name} has no column 'weight'; add what each branch weighs before anything is seen.")
    for column in table.columns:
        check_choice("column", column, [*BRANCH_COLUMNS, *known], of=table.name)
    if len(table.rows) > MOST_BRANCHES:
        raise InputError(f"{table.name} has {len(table.rows)} branches; allowed are {MOST_BRANCHES}.")
    found = []
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
            found.append(Branch(cells["branch"], weight, curves, events, model))
    return tuple(found)


#: Columns of a table of sources.
SOURCE_COLUMNS = ("source", "lon", "lat", "magnitude_min", "magnitude_max", "rate", "b", "mechanism")
FURTHER = ("lon2", "lat2", "radius_km", "strike")


def _sources(path: Path) -> list[Source]:
    table = tables.read(
        path, MOST, "source", f"the columns {', '.join(SOURCE_COLUMNS)}; {', '.join(FURTHER)} where they are known"
    )
    for column in table.columns:
        check_choice("column", column, [*SOURCE_COLUMNS, *FURTHER], of=table.name)
    missing = next((one for one in SOURCE_COLUMNS if one not in table.columns), None)
    if missing:
        raise InputError(f"{table.name} has no column {missing!r}; it needs {', '.join(SOURCE_COLUMNS)}.")
    numbers: dict[str, list[Any]] = {
        one: table.numbers(one, float("nan") if one in FURTHER else None)
        for one in table.columns
        if one not in ("source", "mechanism")
    }
    found = []
    for k, name in enumerate(table.texts("source")):
        row = {one: values[k] for one, values in numbers.items() if values[k] == values[k]}
        ends = [(row["lon"], row["lat"])]
        if ("lon2" in row) != ("lat2" in row):
            raise InputError(f"source {name!r} of {table.name} has one of lon2 and lat2; give both, or none.")
        if "lon2" in row:
            ends.append((row["lon2"], row["lat2"]))
        with within(f"line {table.lines[k]} of {table.name}"):
            found.append(
                Source(
                    name, tuple(ends), (row["magnitude_min"], row["magnitude_max"]), row["rate"], row["b"],
                    table.texts("mechanism")[k], row.get("radius_km", 0.0), row.get("strike"),
                )
            )  # fmt: skip
    return found


def _pair(name: str, values: Any) -> tuple[float, float]:
    plain = isinstance(values, list) and len(values) == 2
    if not plain or any(isinstance(one, bool) or not isinstance(one, (int, float)) for one in values):
        raise InputError(f"`{name}` is {as_typed(values)}; allowed is a list of two numbers.", name)
    return float(values[0]), float(values[1])


def _span(name: str, value: Any) -> tuple[float, float]:
    """A time, or the two between which it lies [years before today]."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value), float(value)
    return _pair(name, value)
