"""``stylobate domain``: the safe-unsafe domain of a column over frequency and amplitude."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..analysis.domain import Domain
    from ..analysis.probability import CollapseProbability
    from ..campaign.grid import HarmonicGrid


def domain(
    context: typer.Context,
    what: Annotated[
        str, typer.Argument(metavar="STUDY|COLUMN", help="A study file (TOML), or a column: preset or column file.")
    ],
    model: Annotated[
        str | None, typer.Option("--model", metavar="MODEL", help="How it is computed; dem2d by default.")
    ] = None,
    frequencies: Annotated[
        str | None, typer.Option("--frequencies", metavar="F:F:N", help="First, last and number, such as 0.33:4:24.")
    ] = None,
    amplitudes: Annotated[
        str | None, typer.Option("--amplitudes", metavar="A:A:N", help="Likewise, such as 0.05g:0.6g:32.")
    ] = None,
    duration: Annotated[str | None, typer.Option("--duration", metavar="TIME", help="Of each motion; 10s.")] = None,
    tail: Annotated[
        str | None, typer.Option("--tail", metavar="TIME", help="Go on for this long after each motion; 0s.")
    ] = None,
    replicates: o.Replicates = None,
    scatter: o.ScatterSizes = None,
    motion_scatter: Annotated[
        str | None,
        typer.Option(
            "--motion-scatter",
            metavar="NAME=SIZE,…",
            help="How the motions of a cell differ then; amplitude=1%,phase=0.1,across=1%, nothing by default.",
        ),
    ] = None,
    seed: o.Seed = None,
    half_step: Annotated[
        bool, typer.Option("--half-step", help="Run it again with half of the time step and count what differs.")
    ] = False,
    settings: o.Settings = None,
    project: o.Project = None,
    threads: o.Threads = None,
    dask: o.Dask = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Safe-unsafe domain over frequency and amplitude.

    With --replicates, the probability of collapse over columns like this one. With --out, a domain that was
    interrupted goes on where it was.
    """
    from ..analysis.difference import round_drums
    from ..analysis.domain import collapse_domain
    from ..analysis.step_sensitivity import compare_steps
    from ..campaign.runs import Stopped
    from . import console

    count = o.the_threads(threads)
    study = _study(what, model, frequencies, amplitudes, duration, tail, settings, project)
    population = o.the_population(replicates, scatter, seed, **{"--motion-scatter": motion_scatter})
    if population is not None:
        if half_step:
            raise InputError("--half-step is for a domain without --replicates; give one of the two.")
        shaking = None if motion_scatter is None else o.motion_scatter(motion_scatter)
        o.the_engine(context, dask, count)
        run_probability(study, population | {"motion_scatter": shaking}, count, out, as_json)
        return
    o.the_engine(context, dask, count)
    with console.folder(out, "domain.nc", "domain.csv", "domain.json", "domain", "asked-domain.json") as folder:
        ledger = console.ledger(folder)
        with console.progress("cells") as progress:
            how: dict[str, Any] = {"tail": study.tail, "threads": count, "progress": progress, "ledger": ledger}
            pair = compare_steps(*_grid(study), **how) if half_step else None
            result = pair.domain if pair else collapse_domain(*_grid(study), **how)
        if not result.complete:
            raise Stopped(result.rows.finished, len(result.rows), ledger)
        summary = result.summary() | ({"half_step": pair.summary()} if pair else {})
        summary["doubt"] = round_drums([study.column], study.model)
        files = [] if folder is None else write(result, folder, summary)
        if folder is not None:
            files.append(asked(folder, study))
    if as_json:
        console.emit(summary | {"files": [str(file) for file in files]})
        return
    console.print_doubt(summary)
    describe(result, files)
    if half_step:
        step = summary["half_step"]
        print(f"With half of the time step {step['differing']} of {step['comparable']} verdicts are different ones.")


def asked(folder: Path, study: HarmonicGrid) -> Path:
    """What was asked for, beside the results."""
    from . import console

    what = {"structures": [study.column], "models": [study.model]}
    return console.asked(folder, "domain", **what, duration_s=study.duration, tail_s=study.tail)


def write(result: Domain, folder: Path, summary: dict) -> list[Path]:
    """The domain, its summary and its figure."""
    from .. import plots
    from . import console

    return [
        result.save(folder / "domain.nc"),
        result.save(folder / "domain.csv"),
        *plots.save(plots.draw_domain(result), folder / "domain"),
        console.write_json(folder / "domain.json", summary),
    ]


def run_probability(study: HarmonicGrid, population: dict, threads: int, out: Path | None, as_json: bool) -> None:
    """The domain with many variations in every cell."""
    from ..analysis.difference import round_drums
    from ..analysis.replicates import collapse_probability
    from ..campaign.runs import Stopped
    from . import console

    with console.folder(
        out, *(f"probability{end}" for end in (".nc", ".csv", ".json", "")), "asked-domain.json"
    ) as folder:
        with console.progress("runs") as progress:
            result = collapse_probability(
                *_grid(study), **population, tail=study.tail, threads=threads, progress=progress, out=folder
            )
        summary = result.summary()
        summary["doubt"] = round_drums([study.column], study.model)
        if not result.complete:
            raise Stopped(summary["runs"], result.codes.size, console.ledger(folder))
        files = []
        if folder is not None:
            from .. import plots

            files = [
                folder / "probability.nc",
                folder / "probability.csv",
                *plots.save(plots.draw_probability(result), folder / "probability"),
                console.write_json(folder / "probability.json", summary),
                asked(folder, study),
            ]
    if as_json:
        console.emit(summary | {"files": [str(file) for file in files]})
    else:
        console.print_doubt(summary)
        describe_probability(result, files)


def describe_probability(result: CollapseProbability, files: list[Path]) -> None:
    """Print the probabilities for people."""
    from ..analysis.verdicts import open_runs
    from ..campaign.twins import described
    from ..response.words import longer_tail
    from . import console

    s = result.summary()
    sentence = (
        f"Of {s['cells']} cells, all columns stand in {s['all_stand']} and all collapse in {s['all_collapse']}; "
        f"{s['some_collapse']} are uncertain"
    )
    sentence += f", {s['no_verdict']} have no verdict." if s["no_verdict"] else "."
    sentence += open_runs(s)
    if s["undecided"]:
        sentence += f" Go on with {longer_tail(float(result.provenance['tail']))}."
    facts = {
        "column": result.column.name,
        "model": result.model,
        "columns like this": described(result.replicates, result.scatter, result.seed, result.provenance["left_out"]),
        "time": f"{result.wall_time:.1f} s",
    }
    if result.motion_scatter.given:
        facts["motions like this"] = f"vary by {result.motion_scatter.describe()}"
    if s["band_width_median_g"] is not None:
        width = f"{s['band_width_median_g']:.3g} g (median), up to {s['band_width_largest_g']:.3g} g"
        facts["uncertain band"] = width
    if s["band_open_frequencies"]:
        facts["top of the band not seen"] = f"at {s['band_open_frequencies']} of {len(result.frequencies)} frequencies"
    console.say(sentence, facts, files)


def describe(result: Domain, files: list[Path]) -> None:
    """Print the domain for people."""
    from ..constants import g
    from ..response.words import longer_tail
    from . import console

    counts, cells = result.counts, len(result.rows)
    sentence = f"{counts['collapsed']} of {cells} cells collapse, {counts['stands']} stand."
    far = f"ended far from rest (try {longer_tail(float(result.provenance['tail']))})"
    for one, meaning in (("undecided", far), ("failed", "could not be computed")):
        if counts[one]:
            sentence += f" {counts[one]} {meaning} and are not counted as collapse."
    f, a = result.frequencies, result.amplitudes / g
    facts = {
        "column": result.column.name,
        "model": result.model,
        "frequencies": f"{f[0]:g} to {f[-1]:g} Hz, {len(f)}",
        "amplitudes": f"{a[0]:g} to {a[-1]:g} g, {len(a)}",
        "static uplift": f"{result.column.uplift_acceleration / g:.4g} g",
        "time": f"{result.wall_time:.1f} s",
    }
    console.say(sentence, facts, files)


def _study(
    what: str,
    model: str | None,
    frequencies: str | None,
    amplitudes: str | None,
    duration: str | None,
    tail: str | None,
    settings: list[str] | None,
    project: str | None,
) -> HarmonicGrid:
    from ..campaign.grid import HarmonicGrid, is_grid, read_grid
    from ..motion.ranges import amplitude_range, frequency_range
    from ..motion.specs import parse_time

    given = {
        "--model": model,
        "--frequencies": frequencies,
        "--amplitudes": amplitudes,
        "--duration": duration,
        "--tail": tail,
        "--set": settings,
        "--project": project,
    }
    if Path(what).is_file() and is_grid(what):
        for option, value in given.items():
            if value:
                raise InputError(f"{what} is a study file and {option} is given as well; state it in the file.")
        return read_grid(what)
    column = o.the_column(what, project)
    return HarmonicGrid(
        column,
        o.the_model(model or "dem2d", settings),
        frequency_range(_needed("--frequencies", frequencies, "0.33:4:24")),
        amplitude_range(_needed("--amplitudes", amplitudes, "0.05g:0.6g:32")),
        parse_time(duration or "10s"),
        parse_time(tail or "0s"),
    )


def _grid(study: HarmonicGrid) -> tuple[Any, ...]:
    """Column, model, frequencies, amplitudes and duration, as the analyses of a grid take them."""
    return study.column, study.model, study.frequencies, study.amplitudes, study.duration


def _needed(option: str, value: str | None, example: str) -> str:
    if value is None:
        raise InputError(f"{option} is missing; a domain of a column needs it, e.g. {option} {example}.")
    return value
