"""``stylobate critical``: the smallest amplitude that collapses a column, on a stated grid."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..analysis.critical import CriticalAmplitude
    from ..column import Column
    from ..models.base import Model
    from ..motion import Suite


def critical(
    column: o.ColumnName,
    start: Annotated[str, typer.Option("--from", metavar="A", help="Smallest amplitude, such as 0.05g.")],
    stop: Annotated[str, typer.Option("--to", metavar="A", help="Largest amplitude, such as 1.0g.")],
    step: Annotated[str, typer.Option("--step", metavar="A", help="Step of the grid.")] = "0.005g",
    model: o.ModelName = "dem2d",
    harmonic: Annotated[
        str | None, typer.Option("--harmonic", metavar="F,?g,T", help="Sine from rest, such as 1.0Hz,?g,10s.")
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
    condition: o.Condition = None,
    vertical: o.Vertical = "on",
    tail: o.Tail = "0s",
    settings: o.Settings = None,
    threads: o.Threads = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Smallest amplitude that collapses a column.

    The amplitude of a record or a simulated motion is its horizontal peak; a folder of records is run on one grid.
    """
    from ..analysis.critical import amplitude_grid, critical_amplitude
    from ..column.files import load_column
    from ..motion.specs import parse_acceleration, parse_harmonic, parse_pulse
    from . import console

    o.check_one_motion(harmonic, pulse, motion, unit, dt, synthetic, component)
    grid = [parse_acceleration(text) for text in (start, stop, step)]
    amplitude_grid(*grid)
    stone = load_column(column)
    how = o.the_model(model, settings)
    after, count = o.the_tail(tail), o.the_threads(threads)
    if o.is_suite(motion):
        suite = o.of_each(
            o.the_suite(motion or [], unit, dt, component),
            lambda one: o.plane(o.shaped(one, azimuth, condition), vertical),
        )
        over_suite(stone, suite, how, grid, after, count, out, as_json)
        return
    nominal: float | None = 1.0
    if harmonic is not None:
        shaking, unknown = parse_harmonic(harmonic, allow_unknown=True)
    elif pulse is not None:
        alone, unknown = parse_pulse(pulse, allow_unknown=True)
        length = alone.metadata["pulse_length"] + 20.0 / stone.frequency_parameter
        shaking, unknown = parse_pulse(pulse, length, allow_unknown=True)
    else:
        shaking, unknown, nominal = o.the_record(motion, unit, dt, component, synthetic), True, None
    if not unknown:
        raise InputError(
            f"the motion {harmonic or pulse!r} states its amplitude, which is what is looked for; write ?g for it."
        )
    shaking = o.plane(o.shaped(shaking, azimuth, condition), vertical)
    if condition:
        nominal = None  # the peak that the conditioned motion has
    with console.folder(out, "critical.csv", "critical.json", "critical") as folder:
        with console.progress("amplitudes") as progress:
            ledger = console.ledger(folder)
            result = critical_amplitude(
                stone, shaking, how, *grid, nominal=nominal, tail=after, threads=count, progress=progress, ledger=ledger
            )
        summary, files = result.summary() | o.input_facts(shaking), []
        if folder is not None:
            files = write(result, summary, folder)
            summary["files"] = [str(file) for file in files]
            console.done_with(ledger)
    if as_json:
        console.emit(summary)
    else:
        describe(result, files)


def over_suite(
    column: Column,
    suite: Suite,
    model: Model,
    grid: list[float],
    tail: float,
    threads: int,
    out: Path | None,
    as_json: bool,
) -> None:
    """The critical amplitude under each record of a folder."""
    from ..analysis.critical_suite import critical_suite
    from . import console

    with console.folder(out, "critical.csv", "runs.csv", "critical.json", "critical") as folder:
        with console.progress("runs") as progress:
            ledger = console.ledger(folder)
            result = critical_suite(
                column, suite.motions, model, *grid, tail=tail, threads=threads, progress=progress, ledger=ledger
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
            summary["files"] = [str(file) for file in files]
            console.done_with(ledger)
    if as_json:
        console.emit(summary)
        return
    console.print_table(result.table)
    console.print_refused(suite.refused)
    if files:
        print(f"{len(files)} files in {files[0].parent}: {', '.join(file.name for file in files)}")


def write(result: CriticalAmplitude, summary: dict, folder: Path) -> list[Path]:
    """Table, summary and figure."""
    from .. import plots
    from . import console

    return [
        console.write_table(result.table, folder / "critical.csv"),
        console.write_json(folder / "critical.json", summary),
        *plots.save(plots.draw_amplitudes(result), folder / "critical"),
    ]


def describe(result: CriticalAmplitude, files: list[Path]) -> None:
    """Print the answer for people."""
    from ..constants import g
    from . import console

    counts = result.counts
    low, high = result.amplitudes[0] / g, result.amplitudes[-1] / g
    if result.critical is None:
        sentence = f"No amplitude from {low:g} to {high:g} g collapses the column."
    else:
        first, all_above = result.critical / g, result.all_collapse_above
        if all_above is None:
            sentence = (
                f"The column first collapses at {first:.4g} g; from there to {high:g} g some amplitudes collapse it."
            )
        elif all_above > result.critical:
            sentence = (
                f"The column first collapses at {first:.4g} g; from there some amplitudes collapse it, and from "
                f"{all_above / g:.4g} g to {high:g} g all do."
            )
        else:
            sentence = f"The column collapses from {first:.4g} g on."
    for one, meaning in (("undecided", "ended far from rest (try --tail 5s)"), ("failed", "could not be computed")):
        if counts[one]:
            sentence += f" {counts[one]} of {len(result.rows)} runs {meaning} and are not counted as collapse."
    facts = {
        "column": result.column.name,
        "motion": result.motion.name if result.motion.factor != 1.0 else f"{result.motion.name.split(',')[0]}, ? g",
        **{name: text for name, text in o.input_lines(result.motion).items() if name != "motion"},
        "model": result.model,
        "grid": f"{low:g} to {high:g} g, {len(result.rows)} runs, {result.wall_time:.1f} s",
    }
    for row in result.alternation.to_dict("records"):
        facts[f"{row['from_g']:.4g} to {row['to_g']:.4g} g"] = f"{row['verdict']} ({row['runs']} runs)"
    console.say(sentence, facts, files)
