"""``stylobate critical``: the smallest amplitude that collapses a column, on a stated grid."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from . import options as o

if TYPE_CHECKING:
    import pandas

    from ..analysis.critical import CriticalAmplitude
    from ..analysis.critical_suite import CriticalSuite
    from ..column import Column
    from ..models.base import Model
    from ..motion import Motion, Suite

#: Amplitudes that columns like it go through unasked: what they cost then is bounded, and some two hundred runs.
TWIN_AMPLITUDES = 12

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

    The amplitude of a record or a simulated motion is its horizontal peak; it is run as it is, too. Models that step drums
    take fifteen columns like it through a dozen of the amplitudes; --replicates takes more through all, or none with 0. A
    folder of records, or several directions, is run on one grid, with columns like it by --replicates only.
    """
    from ..analysis.critical import amplitude_grid, critical_amplitude
    from ..analysis.difference import round_drums
    from ..motion.specs import parse_acceleration
    from . import console

    asked = o.the_request(context)
    grid = [parse_acceleration(text) for text in (start, stop, step)]
    amplitude_grid(*grid)
    stone: Any = o.the_structure(column, project)
    how = o.the_model(model, settings)
    after, count = o.the_tail(tail), o.the_threads(threads)
    population = o.the_population(replicates, scatter, seed)
    if asked.several:
        suite = asked.expand(stone.frequency_parameter, amplitude_open=True)
        o.the_engine(context, dask, count)
        over_suite(stone, suite, how, grid, population or {}, after, whole, count, out, as_json)
        return
    twins = o.the_twins(stone, how, population) or {}
    if population is None:
        twins["twin_amplitudes"] = TWIN_AMPLITUDES
    shaking = asked.motion(stone.frequency_parameter, amplitude_open=True)
    # the amplitude of a formula is that of its sine, once it is conditioned the peak that it has along x, as of a record
    nominal = None if not (harmonic or pulse) else shaking.pga if condition else 1.0
    o.the_engine(context, dask, count)
    with console.folder(out, *WRITES, "probability.csv", "probability") as folder:
        with console.progress("runs") as progress:
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
        summary["doubt"] = round_drums([stone], how)
        if folder is not None:
            files = write(result, summary, folder)
            what = {"structures": [stone], "models": [how], "motions": [how.taken(shaking)]}
            files.append(console.asked(folder, "critical", **what, tail_s=after))
            summary["files"] = [str(file) for file in files]
    if as_json:
        console.emit(summary)
    else:
        console.print_doubt(summary)
        describe(result, summary, how.taken(shaking), files)


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
    from ..analysis.difference import round_drums
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
        summary, files = result.summary() | {"refused": suite.refused, "doubt": round_drums([column], model)}, []
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
                drawn = plots.draw_directions(result.compass, title)
                files += plots.save(drawn, folder / "directions")
            taken = [model.taken(one) for one in suite.motions]
            what = {"structures": [column], "models": [model], "motions": taken}
            files.append(console.asked(folder, "critical", **what, tail_s=tail))
            summary["files"] = [str(file) for file in files]
    if as_json:
        console.emit(summary)
        return
    console.print_doubt(summary)
    print(summary["sentence"])
    console.print_table(with_bounds(result))
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


def with_bounds(result: CriticalSuite) -> pandas.DataFrame:
    """The table of a suite for people: bounds, such as "> 1.5", in place of what is no number."""
    table = result.table.drop(columns=["bounds", "lowest_collapse_g", "open_below"])
    if result.results[0].population is None:
        table = table.drop(columns="lowest_collapse_factor")
    if table["record"].tolist() == table["motion"].tolist():
        table = table.drop(columns="motion")
    table = table.astype(object).where(table.notna(), math.nan)
    for place, one in enumerate(result.summary()["records"]):
        for name, bound in one["bounds"].items():
            if name in table:
                table.loc[place, name] = bound
    return table


def describe(result: CriticalAmplitude, summary: dict, taken: Motion, files: list[Path]) -> None:
    """Print the answer for people."""
    from ..analysis.critical_words import as_recorded
    from ..campaign.twins import described
    from ..constants import g
    from . import console

    kind, likes = result.column.kind, result.population
    low, high = result.amplitudes[0] / g, result.amplitudes[-1] / g
    facts = {
        kind: result.column.name,
        "motion": result.motion.name if result.motion.factor != 1.0 else f"{result.motion.name.split(',')[0]}, ? g",
        **{name: text for name, text in o.input_lines(taken).items() if name != "motion"},
        "model": result.model,
        "grid": f"{low:.4g} to {high:.4g} g, {len(result.rows)} runs, {result.wall_time:.1f} s",
    }
    if likes is not None:
        known = len(likes.verdicts), likes.scatter, likes.seed, likes.left_out
        facts[f"{kind}s like this"] = f"{described(*known)}; at {len(likes.amplitudes)} of these amplitudes"
    if (own := summary["as_recorded"]) is not None:
        facts["as recorded"] = as_recorded(own)
    for row in summary["alternation"]:
        runs = f"{row['runs']} run" + ("" if row["runs"] == 1 else "s")
        facts[f"{row['from_g']:.4g} to {row['to_g']:.4g} g"] = f"{row['verdict']} ({runs})"
    console.say(summary["sentence"], facts, files)
