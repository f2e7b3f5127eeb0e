"""``stylobate run``: one column or assembly, one motion, one verdict."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import options as o
from .run_words import describe

if TYPE_CHECKING:
    from ..analysis.population import Population
    from ..campaign.campaign import Campaign, Progress
    from ..column.structure import Structure
    from ..models.base import Model
    from ..motion import Motion
    from ..response import Response
    from .files import Files


class Drawn(NamedTuple):
    """Pictures of a run: its figures, and the strip of the median column like it."""

    all: bool = True
    median: bool = False


#: Pictures of what a model in space computes, besides those of every column.
SPACE_PICTURES = ["orbit", "uplift", "residuals"]


def run(
    column: o.StructureName,
    model: o.ModelName = "dem2d",
    *,
    motions: o.Motions,
    following: o.Following,
    until_end: bool = o.option(None, "Go on after the collapse is certain.", False),
    until_rest: bool = o.option(
        None, "Go on until everything lies still, on the ground if need be (dem2d, dem3d).", False
    ),
    output_interval: str = o.option("TIME", "Time between recorded states.", "0.01s"),
    settings: o.Settings = None,
    losses: o.LossesName = None,
    project: o.Project = None,
    population: o.Population,
    pictures: bool = o.option(None, "Whether --out has figures too.", True, flag="--pictures/--no-pictures"),
    execution: o.Plain,
) -> None:
    """Shake one column once, or one assembly of blocks (dem2d, in space dem3d).

    Prints the outcome and, for columns, how sure it is: models that step drums take fifteen columns like this one along at
    next to no cost; --replicates 0 leaves them out. With --out, writes histories and figures. A folder of records, or
    several directions, is one run after the other.
    """
    from ..analysis.directions import table_of_runs, worst
    from ..models.engine import engine_for
    from ..motion.specs import parse_time
    from . import console

    asked = motions.request()
    stone = o.the_structure(column, project)
    how = o.the_model(model, settings, losses)
    if until_rest:
        stone = engine_for(how, stone).followed()
    found = asked.expand(stone.frequency_parameter)
    options = {"output_interval": parse_time(output_interval), "until_end": until_end, "until_rest": until_rest}
    campaign, given = execution.campaign(following, population), population.replicates is not None
    if given or not (until_end or until_rest):
        campaign = o.with_twins(stone, how, campaign, given)
    drawn = Drawn(pictures, pictures and given and campaign.replicates > 0)
    follow = partial(run_one, stone, model=how, campaign=campaign, **options)
    out = execution.out
    if asked.several:
        summaries = each_record(stone, found.motions, how, follow, out, drawn)
        if not execution.as_json:
            console.print_doubt(*summaries)
            console.print_table(table_of_runs(summaries), digits=3)
            console.print_left_out(summaries)
            if out is not None:
                print(f"{len(summaries)} folders with a run each in {out}")
    else:
        summaries = [conclude(follow, stone, found.motions[0], how, out, execution.as_json, drawn)]
    several: dict[str, Any] = {"runs": summaries, "refused": found.refused, "worst": worst(summaries)}
    if len(asked.azimuths) > 1 or asked.signs == "both":
        several["sentence"] = directions(summaries, stone, how, out, campaign.tail)
        if not execution.as_json and several["sentence"]:
            print(several["sentence"])
    if not execution.emits(several if asked.several else summaries[0]):
        console.print_refused(found.refused)


def directions(summaries: Sequence[dict], stone: Structure, model: Model, out: Path | None, tail: float) -> str:
    """Which direction does most harm: in words, empty where all failed; and where a folder is given on a compass."""
    from ..analysis.directions import compass_of_chances, harm_words, worst
    from ..response.words import to_decide
    from . import console

    chances = compass_of_chances(summaries, to_decide(stone, model.parameters(), tail))
    found = worst(summaries, chances)
    if out is not None and len(chances.bearings) > 1:
        from .. import plots

        with console.folder(out, "directions") as folder:
            assert folder is not None
            plots.save(plots.draw_directions(chances, f"{stone.name}, {model.name}"), folder / "directions")
    return "" if found is None else harm_words(found, chances)


def run_one(
    stone: Structure, motion: Motion, model: Model, campaign: Campaign, progress: Progress | None = None, **options: Any
) -> tuple[Response, Population | None]:
    """One run, and what became of columns like it."""
    from ..analysis.certainty import certainty
    from ..simulate import simulate

    options["quiet"] = campaign.quiet
    if not campaign.replicates:
        follow: dict[str, Any] = {"tail": campaign.tail, "until_decided": True, "progress": progress}
        return simulate(stone, motion, model, **follow, **options), None
    made = dataclasses.replace(campaign, whole=False, progress=progress)
    kept = None if campaign.ledger is None else Path(campaign.ledger).with_name("response.nc")
    found = certainty(stone.stack or stone, motion, model, kept=kept, campaign=made, **options)
    return found.response, found.population


def each_record(
    stone: Structure,
    motions: Sequence[Motion],
    model: Model,
    follow: partial[tuple[Response, Population | None]],
    out: Path | None,
    drawn: Drawn,
) -> list[dict]:
    """One run after the other, each with a folder of its own; those that are finished already are not run again."""
    import numpy as np

    from ..analysis.certainty import wait_for
    from ..campaign.campaign import Campaign
    from ..campaign.digests import Digests, Hasher
    from ..campaign.runs import Request, Runs, Stopped
    from ..models.base import Case
    from ..simulate import run_options, tell_wait
    from . import console

    places: list[Path | None] = []
    for motion in motions:
        places.append(None if out is None else out / safe_name(motion.name, places))
    campaign = follow.keywords["campaign"]
    following = {name: one for name, one in follow.keywords.items() if name not in ("model", "campaign")}
    options = run_options(campaign.tail, until_decided=True, **following)
    hasher = Hasher(model, options)
    made = {"twins": [campaign.replicates, campaign.scatter, campaign.seed], "whole": campaign.whole, **following}
    each = [
        hasher.of_product(
            {"run": [stone.digest, motion.name, motion.digest, place and place.name], "drawn": drawn, **made}, __file__
        )
        for motion, place in zip(motions, places, strict=True)
    ]

    cases = [Case(stone, motion) for motion in motions]
    request = Request(cases, Digests.of(each), [(np.arange(len(cases)), model, options)])
    request.check()  # before anything is forecast

    def make(number: int) -> dict[str, Any]:
        if len(motions) > 1 and wait > console.FIRST_LINE:
            console.note(f"run {number + 1} of {len(motions)}: {motions[number].name}")
        summary = conclude(follow, stone, motions[number], model, places[number], True, drawn)
        files = {} if out is None else {"files": [str(Path(file).relative_to(out)) for file in summary["files"]]}
        return {"summary": json.loads(console.as_json(summary)), **files}

    summaries: dict[int, dict] = {}
    with console.folder(out) as folder:
        ledger = console.ledger(folder)
        twins = f", each with {campaign.replicates} like it," if campaign.replicates else ""
        wait = wait_for(stone.stack or stone, motions, model, campaign, options, _followed(follow))
        tell_wait(f"{len(motions)} runs{twins} take", wait, stone)
        try:
            with closing(Runs(Campaign(ledger=ledger))) as runs:
                for number, row in runs.products(request, make):
                    files = {} if out is None else {"files": [str(out / name) for name in row["files"]]}
                    summaries[number] = row["summary"] | files
        except KeyboardInterrupt as interrupt:
            part = ""
            if isinstance(interrupt, Stopped):
                part = f"of the one under way itself and {interrupt.done} of {interrupt.total} like it"
            raise Stopped(len(summaries), len(motions), ledger, part=part) from None
    return [summaries[number] for number in range(len(motions))]


def conclude(
    follow: partial[tuple[Response, Population | None]],
    stone: Structure,
    motion: Motion,
    model: Model,
    out: Path | None,
    quiet: bool,
    drawn: Drawn,
) -> dict:
    """Make a run; its files where a folder is given, its words where they are wanted. Returns its summary."""
    from ..analysis.directions import direction_of
    from ..analysis.other_laws import other_laws
    from ..motion.writing import write_csv
    from . import console
    from .files import files as files_of

    pictures = ["histories", "filmstrip", "joints", "energy", "motion", *SPACE_PICTURES]
    names = ("response.nc", "run.json", "motion.csv", "replicates.csv", "bodies.csv", "debris", "median")
    with files_of(out, "run", *names, *pictures) as files:
        console.ledger(files.folder)
        with console.progress("seconds of motion") as progress:
            campaign = follow.keywords["campaign"].kept_in(files.folder)
            response, population = follow(motion, campaign=campaign, progress=progress)
        console.show(response)
        taken = model.taken(motion)
        summary = response.summary() | o.input_facts(taken) | direction_of(motion)
        if population is not None:
            summary |= population.summary(summary)
        elif response.measures.blocks is not None:  # carried along by no run
            summary["replicates"] = 0
        laws = None
        if population is not None and not population.drawn.groups and not _followed(follow):
            laws = other_laws(response, motion, model, campaign)
        if laws is not None:
            summary |= {
                "other_laws": laws.verdicts,
                "under_other_laws": laws.words,
                "law_changes_verdict": laws.changes,
            }
            summary |= {"doubt": laws.sentence} if laws.changes else {}
        if files.folder is not None:
            files += [*write(response, taken, files.folder, drawn.all), write_csv(taken, files / "motion.csv")]
            if population is not None:
                write_population(population, motion, model, response, files, drawn.median)
            files.asked(structures=[stone], models=[model], motions=[taken])
            files.summary(summary, "run.json")
    if not quiet:
        describe(response, taken, files, population, laws)
    return summary


def _followed(follow: partial[tuple[Response, Population | None]]) -> bool:
    """Whether a run is followed beyond its tail."""
    return bool(follow.keywords.get("until_end") or follow.keywords.get("until_rest"))


def write_population(
    population: Population, motion: Motion, model: Model, response: Response, files: Files, strip: bool
) -> None:
    """The table of the columns like this one and, where it is wanted, the strip of the median run, which is run again."""
    from .. import plots
    from ..models.engine import engine_for
    from ..simulate import simulate

    files.table(population.table, "replicates.csv")
    if population.bodies:
        files.table(population.table_of_bodies, "bodies.csv")
        files.picture(plots.draw_debris(response, population.bodies), "debris")
    if population.median is None or not strip:
        return
    engine = engine_for(model, response.structure)
    options: dict[str, Any] = {name: response.provenance[f"{name}_s"] for name in ("tail", "output_interval")}
    options["quiet"] = response.provenance["quiet_share"]
    options["until_decided"] = response.provenance.get("until_decided", False)
    options["until_rest"] = response.provenance.get("until_rest", False) and not engine.twins
    middle = simulate(population.drawn.columns[population.median], motion, engine.paced, **options)
    files.picture(plots.draw_filmstrip(middle), "median")


def safe_name(name: str, taken: Sequence[Path | None]) -> str:
    """Name of a folder for a record: its own, without what file systems dislike, numbered if it is taken."""
    plain = "".join(one if one.isalnum() or one in "-_." else "_" for one in name.split(",")[0]).strip("._") or "record"
    used = {path.name for path in taken if path is not None}
    return next(one for one in (plain, *(f"{plain}-{i}" for i in range(2, len(used) + 3))) if one not in used)


def write(response: Response, motion: Motion, folder: Path, figures: bool = True) -> list[Path]:
    """Histories and figures of one run."""
    files = [response.save(folder / "response.nc")]
    if not figures:
        return files
    from .. import plots

    pictures = {"histories": plots.draw_histories(response), "filmstrip": plots.draw_filmstrip(response)}
    if response.histories.top is not None:
        pictures["joints"] = plots.draw_joints(response)
    if response.dims == "xyz" and response.histories.top is not None:
        drawn = plots.draw_orbit, plots.draw_uplift, plots.draw_residuals
        pictures |= {name: draw(response) for name, draw in zip(SPACE_PICTURES, drawn, strict=True)}
    pictures |= {"energy": plots.draw_energy(response), "motion": plots.draw_motion(motion)}
    for name, figure in pictures.items():
        files += plots.save(figure, folder / name)
    return files
