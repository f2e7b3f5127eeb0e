"""``stylobate critical``: the smallest amplitude that collapses a column, on a stated grid."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from . import options as o

if TYPE_CHECKING:
    import pandas

    from ..motion import Motion
    from ..verdicts.critical import CriticalAmplitude, CriticalSuite
    from .files import Files

#: Amplitudes that columns like it go through unasked: what they cost then is bounded, and some two hundred runs.
TWIN_AMPLITUDES = 12

#: Most spans of amplitudes with one verdict that are told.
MOST_SPANS = 12


@dataclass(frozen=True)
class Shapes(o.Motions):
    """What is shaken with, whose amplitude is looked for."""

    harmonic: str | None = o.option("F,?g,T", "Sine from rest, such as 1.0Hz,?g,10s.")
    across: str | None = o.option("F,?g,PHASE", "Sine along y, such as 1.0Hz,?g,90deg.")
    pulse: str | None = o.option("KIND,F,?g[,T]", "Pulse, such as ricker,1.0Hz,?g.")


def critical(
    column: str = o.STRUCTURE,
    start: float = o.option("A", "Smallest amplitude, such as 0.05g.", ..., "--from", read=o.acceleration),
    stop: float = o.option("A", "Largest amplitude, such as 1.0g.", ..., "--to", read=o.acceleration),
    step: float = o.option("A", "Step of the grid.", "0.005g", read=o.acceleration),
    model: str = o.model(),
    *,
    motions: Annotated[Shapes, o.Without("scale", "pga")],
    following: o.Following,
    modelling: o.Modelling,
    population: o.Population,
    execution: o.Execution,
) -> None:
    """Smallest amplitude that collapses a column.

    The amplitude of a record or a simulated motion is its horizontal peak; it is run as it is, too. Models that step drums
    take fifteen columns like it through a dozen of the amplitudes; --replicates takes more through all, or none with 0. A
    folder of records, or several directions, is run on one grid, with columns like it by --replicates only.
    """
    from ..verdicts.critical import amplitude_grid, critical_amplitude, critical_suite
    from . import console

    request = motions.request()
    grid = start, stop, step
    amplitude_grid(*grid)
    stone: Any = modelling.structure(column)
    how = modelling.model(model)
    campaign, given = execution.campaign(following, population), population.replicates is not None
    suite = request.expand(stone.frequency_parameter, amplitude_open=True)
    taken = [how.taken(motion) for motion in suite.motions]
    if request.several:
        writes, make = ("runs.csv", "directions"), partial(critical_suite, stone, suite.motions, how, *grid)
    else:
        (shaking,), writes = suite.motions, ("probability.csv", "probability")
        campaign = o.with_twins(stone, how, campaign, given)
        # the amplitude of a formula is that of its sine, once it is conditioned the peak that it has along x, as of a record
        formula = motions.harmonic or motions.pulse
        nominal = None if not formula else shaking.pga if motions.condition else 1.0
        make = partial(critical_amplitude, stone, shaking, how, *grid, nominal=nominal)
        make.keywords["twin_amplitudes"] = None if given else TWIN_AMPLITUDES
    with execution.files("critical", "critical.csv", "critical.json", "critical", *writes) as files:
        with files.campaign(campaign) as tracked_campaign:
            result: Any = make(campaign=tracked_campaign)
        summary = result.summary() | ({"refused": suite.refused} if request.several else o.input_facts(taken[0]))
        if files.wanted:
            (write_suite if request.several else write)(result, summary, files)
            files.write_request(structures=[stone], models=[how], motions=taken, tail_s=campaign.tail)
            summary["files"] = files.names
    if execution.emits(summary):
        return
    console.print_doubt(summary)
    if request.several:
        print(summary["sentence"])
        console.print_table(with_bounds(result))
        console.print_refused(suite.refused)
        console.print_files(files)
    else:
        describe(result, summary, taken[0], files)


def write_suite(result: CriticalSuite, summary: dict, files: Files) -> None:
    """Tables, summary and figures of the records of a folder."""
    from .. import plots

    files.table(result.table, "critical.csv")
    files.table(result.runs, "runs.csv")
    files.json(summary, "critical.json")
    files.picture(plots.draw_record_verdicts(result), "critical")
    if len(result.compass.bearings) > 1:
        first = result.results[0]
        files.picture(plots.draw_directions(result.compass, f"{first.column.name}, {first.model}"), "directions")


def write(result: CriticalAmplitude, summary: dict, files: Files) -> None:
    """Table, summary and figure."""
    from .. import plots

    files.table(result.table, "critical.csv")
    files.json(summary, "critical.json")
    files.picture(plots.draw_amplitudes(result), "critical")
    if result.population is not None:
        files.table(result.population.table, "probability.csv")
        drawn = plots.draw_collapse_over_amplitude(result.population, f"{result.column.name}, {result.model}")
        files.picture(drawn, "probability")


def with_bounds(result: CriticalSuite) -> pandas.DataFrame:
    """The table of a suite for people: bounds, such as "> 1.5", in place of what is no number."""
    table = result.table.drop(columns=["bounds", "lowest_collapse_g", "open_below"])
    if result.results[0].population is None:
        table = table.drop(columns="lowest_collapse_factor")
    if table["record"].tolist() == table["motion"].tolist():
        table = table.drop(columns="motion")
    table = table.astype(object).where(table.notna(), math.nan)
    for place, record in enumerate(result.summary()["records"]):
        for name, bound in record["bounds"].items():
            if name in table:
                table.loc[place, name] = bound
    return table


def describe(result: CriticalAmplitude, summary: dict, taken: Motion, files: list[Path]) -> None:
    """Print the answer for people."""
    from ..constants import g
    from ..verdicts.critical import as_recorded
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
        facts[f"{likes.drawn.like} like this"] = f"{likes.drawn.words}; at {len(likes.amplitudes)} of these amplitudes"
    if (own := summary["as_recorded"]) is not None:
        facts["as recorded"] = as_recorded(own)
    spans = summary["alternation"]
    for row in spans[: MOST_SPANS - 1] if len(spans) > MOST_SPANS else spans:
        span = f"{row['from_g']:.4g}" + (f" to {row['to_g']:.4g}" if row["runs"] > 1 else "")
        facts[f"{span} g"] = f"{row['verdict']} ({console.counted(row['runs'], 'run')})"
    if len(spans) > MOST_SPANS:
        last = spans[-1]
        where = "critical.csv holds all" if files else "--json holds all"
        facts["above that"] = f"{len(spans) - MOST_SPANS} more spans that take turns; {where}"
        facts[f"from {last['from_g']:.4g} g"] = f"{last['verdict']} ({console.counted(last['runs'], 'run')})"
    console.say(summary["sentence"], facts, files)
