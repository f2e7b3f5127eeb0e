"""The whole comparison: what a folder holds, computed and scored, as tables and one object of numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path
from typing import Any, TypeVar

from stylobate.campaign.campaign import Progress
from stylobate.errors import InputError
from stylobate.version import __version__

from . import choices as c
from . import cube, granite, measured
from .cube_files import Tosses, read_tosses
from .granite_files import Granite, read_granite
from .measured_files import FILE, Measured, read_measured

#: Contents of a folder of each experiment.
MARKS = {"granite": "specimens.json", "cube": "tosses.npz"}

#: Called with a title; gives what reports progress.
Bars = Callable[[str], AbstractContextManager[Progress | None]]

Read = TypeVar("Read", Granite, Tosses, Measured)


@dataclass
class Experiments:
    """Experiments that a folder holds."""

    granite: Granite | None = None
    cube: Tosses | None = None
    tested: list[Measured] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)


@dataclass
class Results:
    """Tables, and the numbers of the JSON object."""

    summary: dict[str, Any] = field(default_factory=dict)
    tables: dict[str, Any] = field(default_factory=dict)


def read(folder: Path) -> Experiments:
    """Read the experiments in a folder, or the one that the folder is.

    Raises
    ------
    InputError
        There is none.
    """
    if not folder.is_dir():
        raise InputError(f"{folder} is no folder; give one that holds granite or cube, such as ../shared/experiments.")
    places = {}
    for name, mark in MARKS.items():
        for place in (folder / name, folder):
            if (place / mark).is_file() or (place.is_dir() and place.name == name and name not in places):
                places[name] = place
                break
    tested = [path.parent for path in (folder / FILE, *sorted(folder.glob(f"*/{FILE}"))) if path.is_file()]
    if not places and not tested:
        raise InputError(
            f"{folder} holds no experiment: {FILE}, granite/specimens.json or cube/tosses.npz is expected there; see "
            "docs/evidence/nature.md."
        )
    experiments = Experiments()
    if "granite" in places:
        experiments.granite = _usable(experiments, read_granite, places["granite"])
    if "cube" in places:
        experiments.cube = _usable(experiments, read_tosses, places["cube"])
    for place in tested:
        if (experiment := _usable(experiments, read_measured, place)) is not None:
            experiments.tested.append(experiment)
    names = [experiment.name for experiment in experiments.tested]
    if len(set(names)) < len(names):
        raise InputError(f"two folders of tests are called alike ({', '.join(names)}); give each a name of its own.")
    usable = (experiments.granite and experiments.granite.tests and experiments.granite.scans) or (
        experiments.cube and experiments.cube.tosses
    )
    if not usable and not any(experiment.tests for experiment in experiments.tested):
        raise InputError(
            f"nothing in {folder} can be used: {'; '.join(experiments.refused[:3]) or 'it holds no test'}."
        )
    return experiments


def _usable(experiments: Experiments, read_one: Callable[[Path], Read], place: Path) -> Read | None:
    """What is in a folder, its refused parts noted; None where nothing of it can be used."""
    try:
        content = read_one(place)
    except InputError as error:
        experiments.refused.append(str(error).rstrip("."))
        return None
    experiments.refused += content.refused
    return content


def compute(
    experiments: Experiments,
    *,
    realisations: int = 0,
    calibrate: bool = True,
    threads: int | None = None,
    bars: Bars,
    ledger: Path | None,
    earlier: Mapping[str, Any] | None = None,
) -> Results:
    """Compute and score everything that was found.

    Parameters
    ----------
    experiments : Experiments
    realisations : int
        Of what is uncertain about the boulders; 0 for none.
    calibrate : bool
        Also choose friction and restitution on one part and test them on the other.
    threads : int, optional
    bars : callable
        Progress by title.
    ledger : path, optional
        Where finished runs are kept.
    earlier : mapping, optional
        The summary of an earlier call, whose scores have been seen.
    """
    out = Results()
    if experiments.granite and experiments.granite.tests and experiments.granite.scans:
        _granite(experiments.granite, realisations, calibrate, threads, bars, ledger, out)
    if experiments.cube and experiments.cube.tosses:
        _cube(experiments.cube, calibrate, threads, bars, ledger, out)
    for experiment in experiments.tested:
        if experiment.tests:
            _tested(experiment, threads, bars, ledger, earlier or {}, out)
    out.summary |= {
        "refused": experiments.refused,
        "choices": [choice._asdict() for choice in c.CHOICES],
        "realisations": realisations,
        "date": date.today().isoformat(),
        "version": __version__,
    }
    return out


def _tested(
    tests: Measured,
    threads: int | None,
    bars: Bars,
    ledger: Path | None,
    earlier: Mapping[str, Any],
    out: Results,
) -> None:
    with bars(tests.name) as progress:
        runs = measured.computed(tests, threads=threads, progress=progress, ledger=ledger)
    scores = measured.scores(tests, runs)
    out.tables[f"{tests.name}_tests"] = measured.tests_table(tests, runs)
    out.tables[f"{tests.name}_scores"] = scores
    fixed, seen = tests.fixed, earlier.get("tested", {}).get(tests.name)
    since = None
    if seen:
        since = earlier["date"] if seen["fixed"]["digest"] != fixed["digest"] else seen["changed_since"]
    out.summary.setdefault("tested", {})[tests.name] = {
        "fixed": fixed,
        "changed_since": since,
        "tests": len(tests.tests),
        "runs": len(runs),
        "scores": scores.to_dict("records"),
    }


def _granite(
    tests: Granite,
    realisations: int,
    calibrate: bool,
    threads: int | None,
    bars: Bars,
    ledger: Path | None,
    out: Results,
) -> None:
    import pandas

    variants = granite.variants(tests, realisations, calibrate)
    with bars("boulders") as progress:
        runs = granite.run(tests, variants, threads=threads, progress=progress, ledger=ledger)
    table = granite.tests_table(tests, runs)
    out.tables["granite_tests"] = table
    out.tables["granite_half"] = granite.half_table(table)
    out.tables["granite_worst"] = granite.worst(table)
    out.tables["granite_variants"] = pandas.DataFrame(
        [
            {"variant": v, "kind": variant.kind, "specimen": variant.name} | variant.settings
            for v, variant in enumerate(variants)
        ]
    )
    observed = {(name, test.number): test.toppled[name] for test in tests.tests for name in test.toppled}
    right = runs.assign(right=[row.toppled == observed[row.specimen, row.test] for row in runs.itertuples()])
    by = right.groupby("variant")
    out.tables["granite_variants"]["accuracy"] = by["right"].mean().to_numpy()
    out.tables["granite_variants"]["toppled"] = by["toppled"].sum().to_numpy()
    out.summary["granite"] = granite.summary(tests, table, realisations) | {
        "tests_read": len(tests.tests),
        "outcomes_without_motion": tests.without_motion,
        "runs": len(runs),
        "failed": int(runs["failed"].sum()),
    }
    if calibrate:
        out.summary["granite"]["calibration"] = granite.calibration(tests, variants, runs)
    if realisations:
        from .scores import reliability

        out.tables["granite_reliability"] = pandas.DataFrame(
            [
                {"specimen": name} | row
                for name, rows in table.groupby("specimen")
                for row in reliability(rows["probability"].to_numpy(), rows["observed"].to_numpy(dtype=bool))
            ]
        )


def _cube(tosses: Tosses, calibrate: bool, threads: int | None, bars: Bars, ledger: Path | None, out: Results) -> None:
    with bars("tosses") as progress:
        (table,) = cube.run(
            tosses.tosses,
            [(c.CUBE_FRICTION, c.CUBE_RESTITUTION)],
            threads=threads,
            progress=progress,
            ledger=ledger,
        )
    out.tables["cube_tosses"] = table
    out.summary["cube"] = cube.scores(table) | {"friction": c.CUBE_FRICTION, "restitution": c.CUBE_RESTITUTION}
    third = tosses.tosses[::3]
    if not calibrate or len(third) == len(tosses.tosses):
        return
    grid = [(mu, e) for mu in c.CUBE_FRICTION_GRID for e in c.CUBE_RESTITUTION_GRID]
    with bars("tosses, a third of them") as progress:
        tables = cube.run(third, grid, threads=threads, progress=progress, ledger=ledger)
    best = min(range(len(grid)), key=lambda k: cube.badness(tables[k]))
    rest = [toss for number, toss in enumerate(tosses.tosses) if number % 3]
    with bars("tosses, the rest of them") as progress:
        (tested,) = cube.run(rest, [grid[best]], threads=threads, progress=progress, ledger=ledger)
    names = {toss.name for toss in rest}
    out.tables["cube_calibrated"] = tested
    out.summary["cube"]["calibration"] = {
        "friction": grid[best][0],
        "restitution": grid[best][1],
        "third": cube.scores(tables[best]),
        "rest": cube.scores(tested),
        "rest_as_published": cube.scores(table[table["toss"].isin(names)]),
    }
