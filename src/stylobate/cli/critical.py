"""``stylobate critical``: the smallest amplitude that collapses a column, on a stated grid."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..analysis.critical import CriticalAmplitude


def critical(
    column: o.ColumnName,
    model: o.ModelName,
    start: Annotated[str, typer.Option("--from", metavar="A", help="Smallest amplitude, such as 0.05g.")],
    stop: Annotated[str, typer.Option("--to", metavar="A", help="Largest amplitude, such as 1.0g.")],
    step: Annotated[str, typer.Option("--step", metavar="A", help="Step of the grid.")] = "0.005g",
    harmonic: Annotated[
        str | None, typer.Option("--harmonic", metavar="F,?g,T", help="Sine from rest, such as 1.0Hz,?g,10s.")
    ] = None,
    pulse: Annotated[
        str | None, typer.Option("--pulse", metavar="KIND,F,?g[,T]", help="Pulse, such as ricker,1.0Hz,?g.")
    ] = None,
    motion: o.MotionFile = None,
    unit: o.Unit = None,
    dt: o.Step = None,
    vertical: o.Vertical = "on",
    tail: o.Tail = "0s",
    settings: o.Settings = None,
    threads: o.Threads = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Smallest amplitude that collapses a column.

    The amplitude of a record is its horizontal peak.
    """
    from ..analysis.critical import amplitude_grid, critical_amplitude
    from ..column.files import load_column
    from ..motion.specs import parse_acceleration, parse_harmonic, parse_pulse
    from . import console

    o.check_one_motion(harmonic, pulse, motion, unit, dt)
    grid = [parse_acceleration(text) for text in (start, stop, step)]
    amplitude_grid(*grid)
    stone = load_column(column)
    how = o.the_model(model, settings)
    nominal: float | None = 1.0
    if harmonic is not None:
        shaking, unknown = parse_harmonic(harmonic, allow_unknown=True)
    elif pulse is not None:
        alone, unknown = parse_pulse(pulse, allow_unknown=True)
        length = alone.metadata["pulse_length"] + 20.0 / stone.frequency_parameter
        shaking, unknown = parse_pulse(pulse, length, allow_unknown=True)
    else:
        shaking, unknown, nominal = o.the_record(motion, unit, dt), True, None
    if not unknown:
        raise InputError(
            f"the motion {harmonic or pulse!r} states its amplitude, which is what is looked for; write ?g for it."
        )
    shaking = o.with_vertical(shaking, vertical)
    after, count = o.the_tail(tail), o.the_threads(threads)
    with console.folder(out) as folder:
        with console.progress("amplitudes") as progress:
            result = critical_amplitude(
                stone, shaking, how, *grid, nominal=nominal, tail=after, threads=count, progress=progress
            )
        summary, files = result.summary(), []
        if folder is not None:
            files = write(result, folder)
            summary["files"] = [str(file) for file in files]
    if as_json:
        console.emit(summary)
    else:
        describe(result, files)


def write(result: CriticalAmplitude, folder: Path) -> list[Path]:
    """Table, summary and figure."""
    from .. import plots
    from ..atomic import replacing
    from . import console

    table = folder / "critical.csv"
    with replacing(table) as partial:
        result.table.to_csv(partial, index=False)
    return [
        table,
        console.write_json(folder / "critical.json", result.summary()),
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
        sentence = f"The column collapses from {result.critical / g:.4g} g on."
        if result.all_collapse_above is None:
            sentence += f" Not every larger amplitude up to {high:g} g collapses it."
        elif result.all_collapse_above > result.critical:
            sentence += f" From {result.all_collapse_above / g:.4g} g on every amplitude up to {high:g} g does."
    for one, meaning in (("undecided", "ended far from rest (try --tail 5s)"), ("failed", "could not be computed")):
        if counts[one]:
            sentence += f" {counts[one]} of {len(result.rows)} runs {meaning} and are not counted as collapse."
    facts = {
        "column": result.column.name,
        "motion": result.motion.name if result.motion.factor != 1.0 else f"{result.motion.name.split(',')[0]}, ? g",
        "model": result.model,
        "grid": f"{low:g} to {high:g} g, {len(result.rows)} runs, {result.wall_time:.1f} s",
    }
    for row in result.alternation.to_dict("records"):
        facts[f"{row['from_g']:.4g} to {row['to_g']:.4g} g"] = f"{row['verdict']} ({row['runs']} runs)"
    console.say(sentence, facts, files)
