"""``stylobate sequence``: earthquakes one after another, each of which finds what the one before has left."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    import pandas

    from ..column.structure import Structure
    from ..models.base import Model
    from ..motion import Motion
    from ..verdicts.sequence import SequenceResult, UntilFall

#: Columns of the table that are printed, and how they are headed.
PRINTED_COLUMNS = {
    "earthquake": "earthquake",
    "motion": "motion",
    "outcome": "outcome so far",
    "peak_rotation_rad": "peak rotation [rad]",
    "added_slip_m": "slip added [m]",
    "residual_slip_m": "slip so far [m]",
    "fallen": "fell",
    "links_broken": "links broken",
    "at_rest": "came to rest",
    "fallen_share": "those like it that fell",
}


@dataclass(frozen=True)
class Earthquakes(o.Motions):
    """What is shaken with, one after the other."""

    motion: list[Path] | None = o.option(
        "FILE|DIR",
        "Earthquake: a record, a folder of them, or sample:NAME; may be repeated, and they come in this order.",
    )


def sequence(
    column: str = o.STRUCTURE,
    model: str = o.model(),
    *,
    motions: Annotated[Earthquakes, o.Without(*o.SEVERAL)],
    rest: float = o.option("TIME", "Quiet ground after each earthquake.", "30s", read=o.time),
    repeat: int = o.option("N", "How often all of them come.", "1", read=o.whole_number),
    factors: str | None = o.option("X,X,…", "A factor for each earthquake, or for each time that a single one comes."),
    until_fall: int | None = o.option(
        "N", "How many of each kind it takes until it falls, up to this number.", read=o.whole_number
    ),
    following: Annotated[o.Following, o.Without("tail")],
    until_end: bool = o.option(None, "Go on after the collapse of a column (dem2d).", False),
    output_interval: float = o.option("TIME", "Time between recorded states.", "0.01s", read=o.time),
    modelling: o.Modelling,
    population: o.Population,
    pictures: bool = o.option(None, "Whether --out has figures too.", True, flag="--pictures/--no-pictures"),
    execution: o.Execution,
) -> None:
    """Shake a column or an assembly with earthquakes one after another, each beginning as the last one left it.

    Every --motion is an earthquake of its own, in this order, a folder all of its records. Prints what had become of the
    structure after each; with --out writes histories, a table and figures. With --until-fall each earthquake comes again
    and again by itself.
    """

    campaign, given = execution.campaign(following, population), population.replicates is not None
    stone = modelling.structure(column)
    how = modelling.model(model)
    kinds = scaled(the_kinds(motions, stone), factors)
    if until_fall is not None:
        if repeat != 1:
            raise InputError("`repeat` and `until_fall` are both given; give one of the two.", "repeat")
        from ..verdicts.sequence import earthquakes_until_fall

        with execution.files("sequence", "until_fall.csv", "sequence.json") as files:
            with files.campaign(campaign) as tracked_campaign:
                counts = earthquakes_until_fall(stone, kinds, how, until_fall, rest=rest, campaign=tracked_campaign)
            summary = counts.summary() | {"rest_s": rest, "model": how.name, "files": []}
            if files.wanted:
                files.table(counts.table, "until_fall.csv")
                taken = [how.taken(motion) for motion in kinds]
                files.write_request(structures=[stone], models=[how], motions=taken, rest_s=rest, most=until_fall)
                files.summary(summary, "sequence.json")
        if not execution.emits(summary):
            describe_counts(counts)
        return
    execution.refuse_for_one("computes many runs, and this is one; leave it out, or give `until_fall`.")
    options: dict[str, Any] = {"rest": rest, "repeat": repeat, "until_end": until_end}
    options["output_interval"] = output_interval
    if given or not until_end:
        campaign = o.with_twins(stone, how, campaign, given)
    _run(stone, how, kinds, campaign, options, execution, pictures)


def the_kinds(motions: o.Motions, stone: Structure) -> list[Motion]:
    """The earthquakes as they are named, each a motion of its own."""
    frequency = stone.frequency_parameter
    if motions.component == "all":
        raise InputError(
            "`component` all makes a motion of each component, and earthquakes come with all of theirs; name one, or leave "
            "it out.",
            "component",
        )
    if not motions.motion:
        return [motions.request().motion(frequency)]
    kinds: list[Motion] = []
    for path in motions.motion:
        suite = motions.request(motion=[path]).expand(frequency)
        for name, reason in suite.refused.items():
            raise InputError(f"{name} of {path} cannot be used, and no earthquake is left out: {reason}", "files")
        kinds += suite.motions
    return kinds


def scaled(motions: list[Motion], factors: str | None) -> list[Motion]:
    """The earthquakes with a factor each; a single one comes once for each factor."""
    from ..motion.specs import parse_number

    if factors is None:
        return motions
    sizes = [parse_number("`factors`", text.strip(), "such as 1,0.6,0.4") for text in factors.split(",")]
    if len(motions) == 1:
        motions = motions * len(sizes)
    if len(motions) != len(sizes):
        raise InputError(
            f"{len(sizes)} factors are given for {len(motions)} earthquakes; give one for each.", "factors"
        )
    return [motion if size == 1.0 else motion.scaled(size) for motion, size in zip(motions, sizes, strict=True)]


def _run(
    stone: Structure, how: Model, kinds: list[Motion], campaign: Any, options: dict[str, Any], execution: o.Execution,
    pictures: bool,
) -> None:  # fmt: skip
    from ..motion.motion import write_csv
    from ..verdicts.sequence import sequence as run_sequence
    from . import console
    from .run import SPACE_PICTURES, write, write_population

    names = ("response.nc", "run.json", "motion.csv", "events.csv", "replicates.csv", "bodies.csv", "debris")
    drawn = ("histories", "filmstrip", "joints", "energy", "motion", *SPACE_PICTURES, "sequence", "ends")
    with execution.files("run", *names, *drawn) as files:
        with console.progress("seconds of motion") as progress:
            tracked_campaign = replace(campaign, progress=progress).kept_in(files.folder)
            result = run_sequence(stone, kinds, how, campaign=tracked_campaign, **options)
        console.show(result.response)
        taken = how.taken(result.motion)
        summary = result.summary() | o.input_facts(taken) | {"rest_s": options["rest"], "files": []}
        if files.folder is not None:
            files += [*write(result.response, taken, files.folder, pictures), write_csv(taken, files / "motion.csv")]
            files.table(result.table, "events.csv")
            if pictures and result.events:
                from .. import plots

                files.picture(plots.draw_sequence(result.response, result.events), "sequence")
                files.picture(plots.draw_ends(result.response, result.events), "ends")
            if result.population is not None:
                write_population(result.population, result.motion, how, result.response, files, False)
            files.write_request(structures=[stone], models=[how], motions=[taken])
            files.summary(summary, "run.json")
    if not execution.emits(summary):
        describe(result, taken)
        console.print_files(files)


def describe(result: SequenceResult, motion: Motion) -> None:
    """Print what became of the structure, earthquake by earthquake."""
    from ..response.words import doubt_of
    from . import console
    from .run import quiet_facts

    print(result.sentence)
    table = _printed_columns(result.table)
    if len(table):
        console.print_table(table, digits=3)
    if result.falls is not None and result.falls.low:
        print(f"Earthquakes until those like it fall, {result.falls.sentence}.")
    if result.unsettled:
        numbers = ", ".join(map(str, result.unsettled))
        print(f"Something still moved at the end of the rest after earthquake {numbers}: give a longer --rest.")
    for name, value in (o.input_lines(motion) | quiet_facts(result.response)).items():
        print(f"  {name}: {value}")
    doubt = (result.population.doubt if result.population is not None else "") or doubt_of(result.response)
    if doubt:
        print(doubt)


def describe_counts(counts: UntilFall) -> None:
    """Print how many earthquakes of each kind it takes."""
    from . import console

    console.print_table(counts.table.filter(["motion", "earthquakes"]))
    if len(counts.each) > 1:
        print(f"Over the kinds, {counts.over_motions.sentence}.")


def _printed_columns(table: pandas.DataFrame) -> pandas.DataFrame:
    """Columns that are printed; of what never happened none."""
    never = [name for name in ("fallen", "links_broken") if name in table and not any(table[name])]
    if "at_rest" in table:
        table = table.assign(at_rest=["yes" if rests else "no" for rests in table["at_rest"]])
    return table.filter([name for name in PRINTED_COLUMNS if name not in never]).rename(columns=PRINTED_COLUMNS)
