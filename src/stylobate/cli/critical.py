"""``stylobate critical``: the smallest amplitude that collapses a column, on a stated grid."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from . import options as o

if TYPE_CHECKING:
    from ..analysis.critical import CriticalAmplitude
    from ..column import Column
    from ..models.base import Model
    from ..motion import Motion, Suite

#: Files that every run of the command writes.
WRITES = ("critical.csv", "critical.json", "critical", "asked-critical.json")


def critical(
    context: typer.Context,
    column: o.StructureName,
    start: Annotated[str, typer.Option("--from", metavar="A", help="Smallest amplitude, such as 0.05g.")],
    stop: Annotated[str, typer.Option("--to", metavar="A", help="Largest amplitude, such as 1.0g.")],
    step: Annotated[str, typer.Option("--step", metavar="A", help="Step of the grid.")] = "0.005g",
    model: o.ModelName = "dem2d",
    harmonic: Annotated[
        str | None, typer.Option("--harmonic", metavar="F,?g,T", help="Sine from rest, such as 1.0Hz,?g,10s.")
    ] = None,
    across: Annotated[
        str | None, typer.Option("--across", metavar="F,?g,PHASE", help="Sine along y, such as 1.0Hz,?g,90deg.")
    ] = None,
    pulse: Annotated[
        str | None, typer.Option("--pulse", metavar="KIND,F,?g[,T]", help="Pulse, such as ricker,1.0Hz,?g.")
    ] = None,
    synthetic: o.Synthetic = None,
    motion: o.MotionFiles = None,
    unit: o.Unit = None,
    dt: o.Step = None,
    component: o.ComponentName = None,
    azimuth: o.Azimuth = None,
    azimuths: o.Azimuths = None,
    signs: o.Signs = "+",
    condition: o.Condition = None,
    vertical: o.Vertical = "on",
    tail: o.Tail = "0s",
    whole: o.Whole = False,
    settings: o.Settings = None,
    project: o.Project = None,
    replicates: o.Replicates = None,
    scatter: o.ScatterSizes = None,
    seed: o.Seed = None,
    threads: o.Threads = None,
    dask: o.Dask = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Smallest amplitude that collapses a column.

    The amplitude of a record or a simulated motion is its horizontal peak; a folder of records, or several directions, is
    run on one grid. With --replicates, the probability of collapse over the amplitude, with its interval.
    """
    from ..analysis.critical import amplitude_grid, critical_amplitude
    from ..motion.specs import parse_acceleration
    from . import console

    asked = o.the_request(context)
    grid = [parse_acceleration(text) for text in (start, stop, step)]
    amplitude_grid(*grid)
    stone: Any = o.the_structure(column, project)
    how = o.the_model(model, settings)
    after, count = o.the_tail(tail), o.the_threads(threads)
    twins = o.the_population(replicates, scatter, seed) or {}
    if asked.several:
        suite = asked.expand(stone.frequency_parameter, amplitude_open=True)
        o.the_engine(context, dask, count)
        over_suite(stone, suite, how, grid, twins, after, whole, count, out, as_json)
        return
    shaking = asked.motion(stone.frequency_parameter, amplitude_open=True)
    # the amplitude of a formula is that of its sine; of a record, or once it is conditioned, the peak that it has along x
    nominal = 1.0 if (harmonic or pulse) and not condition else None
    o.the_engine(context, dask, count)
    with console.folder(out, *WRITES, "probability.csv", "probability") as folder:
        with console.progress("amplitudes") as progress:
            ledger = console.ledger(folder)
            result = critical_amplitude(
                stone,
                shaking,
                how,
                *grid,
                nominal=nominal,
                **twins,
                tail=after,
                whole=whole,
                threads=count,
                progress=progress,
                ledger=ledger,
            )
        summary, files = result.summary() | o.input_facts(how.taken(shaking)), []
        if folder is not None:
            files = write(result, summary, folder)
            what = {"structures": [stone], "models": [how], "motions": [how.taken(shaking)]}
            files.append(console.asked(folder, "critical", **what, tail_s=after))
            summary["files"] = [str(file) for file in files]
    if as_json:
        console.emit(summary)
    else:
        describe(result, how.taken(shaking), files, after)


def over_suite(
    column: Column,
    suite: Suite,
    model: Model,
    grid: list[float],
    twins: dict[str, Any],
    tail: float,
    whole: bool,
    threads: int,
    out: Path | None,
    as_json: bool,
) -> None:
    """The critical amplitude under each record of a folder."""
    from ..analysis.critical_suite import critical_suite
    from . import console

    with console.folder(out, *WRITES, "runs.csv", "directions") as folder:
        with console.progress("runs") as progress:
            ledger = console.ledger(folder)
            result = critical_suite(
                column,
                suite.motions,
                model,
                *grid,
                **twins,
                tail=tail,
                whole=whole,
                threads=threads,
                progress=progress,
                ledger=ledger,
            )
        summary, files = result.summary() | {"refused": suite.refused}, []
        if folder is not None:
            from .. import plots

            files = [
                console.write_table(result.table, folder / "critical.csv"),
                console.write_table(result.runs, folder / "runs.csv"),
                console.write_json(folder / "critical.json", summary),
                *plots.save(plots.draw_record_verdicts(result), folder / "critical"),
            ]
            if len(result.compass.bearings) > 1:
                title = f"{column.name}, {model.name}"
                drawn = plots.draw_directions(result.compass, title, worst="smallest")
                files += plots.save(drawn, folder / "directions")
            taken = [model.taken(one) for one in suite.motions]
            what = {"structures": [column], "models": [model], "motions": taken}
            files.append(console.asked(folder, "critical", **what, tail_s=tail))
            summary["files"] = [str(file) for file in files]
    if as_json:
        console.emit(summary)
        return
    console.print_table(result.table)
    if result.worst is not None and len(result.results) > 1:
        print(f"Most harm: {result.worst.motion.name}, from {result.worst.critical_factor:.3g} times the record on.")
    console.print_refused(suite.refused)
    console.print_files(files)


def write(result: CriticalAmplitude, summary: dict, folder: Path) -> list[Path]:
    """Table, summary and figure."""
    from .. import plots
    from . import console

    files = [
        console.write_table(result.table, folder / "critical.csv"),
        console.write_json(folder / "critical.json", summary),
        *plots.save(plots.draw_amplitudes(result), folder / "critical"),
    ]
    if result.population is not None:
        files.append(console.write_table(result.population.table, folder / "probability.csv"))
        drawn = plots.draw_collapse_over_amplitude(result.population, f"{result.column.name}, {result.model}")
        files += plots.save(drawn, folder / "probability")
    return files


def describe(result: CriticalAmplitude, taken: Motion, files: list[Path], tail: float) -> None:
    """Print the answer for people."""
    from ..constants import g
    from ..response.words import longer_tail
    from . import console

    counts = result.counts
    low, high = result.amplitudes[0] / g, result.amplitudes[-1] / g
    kind = result.column.kind
    if result.critical is None:
        sentence = f"No amplitude from {low:g} to {high:g} g collapses the {kind}."
    else:
        first, all_above = result.critical / g, result.all_collapse_above
        if all_above is None:
            sentence = (
                f"The {kind} first collapses at {first:.4g} g; from there to {high:g} g some amplitudes collapse it."
            )
        elif all_above > result.critical:
            sentence = (
                f"The {kind} first collapses at {first:.4g} g; from there some amplitudes collapse it, and from "
                f"{all_above / g:.4g} g to {high:g} g all do."
            )
        else:
            sentence = f"The {kind} collapses from {first:.4g} g on."
    if result.critical_factor is not None:
        sentence += f" That is {result.critical_factor:.3g} times the record."
    if result.population is not None:
        parts = result.population.percentiles.items()
        shares = ", ".join(
            f"{share} % from {one:.3g} g" for share, (_, one) in zip((16, 50, 84), parts) if one < math.inf
        )
        sentence += f" Of {len(result.population.verdicts)} columns like this {shares or 'few collapse on this grid'}"
        sentence += " on." if shares else "."
    far = f"ended far from rest (try {longer_tail(tail)})"
    for one, meaning in (("undecided", far), ("failed", "could not be computed")):
        if counts[one]:
            sentence += f" {counts[one]} of {len(result.rows)} runs {meaning} and are not counted as collapse."
    facts = {
        kind: result.column.name,
        "motion": result.motion.name if result.motion.factor != 1.0 else f"{result.motion.name.split(',')[0]}, ? g",
        **{name: text for name, text in o.input_lines(taken).items() if name != "motion"},
        "model": result.model,
        "grid": f"{low:g} to {high:g} g, {len(result.rows)} runs, {result.wall_time:.1f} s",
    }
    for row in result.alternation.to_dict("records"):
        facts[f"{row['from_g']:.4g} to {row['to_g']:.4g} g"] = f"{row['verdict']} ({row['runs']} runs)"
    console.say(sentence, facts, files)
