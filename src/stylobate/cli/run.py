"""``stylobate run``: one column or assembly, one motion, one verdict."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..outcome import Outcome
from . import options as o

if TYPE_CHECKING:
    from ..campaign.campaign import Campaign
    from ..column.structure import Structure
    from ..models.base import Model
    from ..motion import Motion
    from ..response import Response
    from ..verdicts.population import OtherLaws, Population
    from .files import Files


class RunPictures(NamedTuple):
    """Pictures of a run: its figures, and the strip of the median column like it."""

    all: bool = True
    median: bool = False


@dataclass(frozen=True)
class Settings:
    """What is run under each motion, and how long: options as for :func:`stylobate.simulate`."""

    stone: Structure
    model: Model
    campaign: Campaign
    output_interval: float
    until_end: bool
    until_rest: bool

    @property
    def options(self) -> dict[str, Any]:
        """How long it goes on and what is recorded, as keywords of :func:`stylobate.simulate`."""
        return {name: getattr(self, name) for name in ("output_interval", "until_end", "until_rest")}

    @property
    def followed(self) -> bool:
        """Whether a run is followed beyond its tail."""
        return self.until_end or self.until_rest

    def run(self, motion: Motion) -> tuple[Response, Population | None]:
        """One run, and what became of columns like it."""
        from ..simulate import simulate
        from ..verdicts.population import certainty

        campaign = self.campaign
        options: dict[str, Any] = self.options | {"quiet": campaign.quiet}
        if not campaign.replicates:
            options |= {"tail": campaign.tail, "until_decided": True, "progress": campaign.progress}
            return simulate(self.stone, motion, self.model, **options), None
        kept = None if campaign.ledger is None else Path(campaign.ledger).with_name("response.nc")
        stone = self.stone.stack or self.stone
        outcome = certainty(stone, motion, self.model, kept=kept, campaign=replace(campaign, whole=False), **options)
        return outcome.response, outcome.population


#: Pictures of what a model in space computes, besides those of every column.
SPACE_PICTURES = ["orbit", "uplift", "residuals"]


def run(
    column: str = o.STRUCTURE,
    model: str = o.model(),
    *,
    motions: o.Motions,
    following: o.Following,
    until_end: bool = o.option(None, "Go on after the collapse is certain.", False),
    until_rest: bool = o.option(
        None, "Go on until everything lies still, on the ground if need be (dem2d, dem3d).", False
    ),
    output_interval: float = o.option("TIME", "Time between recorded states.", "0.01s", read=o.time),
    modelling: o.Modelling,
    population: o.Population,
    pictures: bool = o.option(None, "Whether --out has figures too.", True, flag="--pictures/--no-pictures"),
    execution: o.Plain,
) -> None:
    """Shake one column once, or one assembly of blocks (dem2d, in space dem3d).

    Prints the outcome and, for columns, how sure it is: models that step drums take fifteen columns like this one along at
    next to no cost; --replicates 0 leaves them out. With --out, writes histories and figures. A folder of records, or
    several directions, is one run after the other.
    """
    from ..models.engine import engine_for
    from ..verdicts.directions import table_of_runs, worst
    from . import console

    request = motions.request()
    stone = modelling.structure(column)
    how = modelling.model(model)
    if until_rest:
        stone = engine_for(how, stone).followed()
    suite = request.expand(stone.frequency_parameter)
    campaign, given = execution.campaign(following, population), population.replicates is not None
    if given or not (until_end or until_rest):
        campaign = o.with_twins(stone, how, campaign, given)
    drawn = RunPictures(pictures, pictures and given and campaign.replicates > 0)
    settings = Settings(stone, how, campaign, output_interval, until_end, until_rest)
    out = execution.out
    if request.several:
        summaries = each_record(settings, suite.motions, out, drawn)
        if not execution.as_json:
            console.print_doubt(*summaries)
            console.print_table(table_of_runs(summaries), digits=3)
            console.print_left_out(summaries)
            if out is not None:
                print(f"{len(summaries)} folders with a run each in {out}")
    else:
        summaries = [conclude(settings, suite.motions[0], out, execution.as_json, drawn)]
    several: dict[str, Any] = {"runs": summaries, "refused": suite.refused, "worst": worst(summaries)}
    if len(request.azimuths) > 1 or request.signs == "both":
        several["sentence"] = directions(summaries, stone, how, out, campaign.tail)
        if not execution.as_json and several["sentence"]:
            print(several["sentence"])
    if not execution.emits(several if request.several else summaries[0]):
        console.print_refused(suite.refused)


def directions(summaries: Sequence[dict], stone: Structure, model: Model, out: Path | None, tail: float) -> str:
    """Which direction does most harm: in words, empty where all failed; and where a folder is given on a compass."""
    from ..response.words import to_decide
    from ..verdicts.directions import compass_of_chances, harm_words, worst
    from . import console

    chances = compass_of_chances(summaries, to_decide(stone, model.parameters(), tail))
    worst_direction = worst(summaries, chances)
    if out is not None and len(chances.bearings) > 1:
        from .. import plots

        with console.folder(out, "directions") as folder:
            assert folder is not None
            plots.save(plots.draw_directions(chances, f"{stone.name}, {model.name}"), folder / "directions")
    return "" if worst_direction is None else harm_words(worst_direction, chances)


def each_record(settings: Settings, motions: Sequence[Motion], out: Path | None, drawn: RunPictures) -> list[dict]:
    """One run after the other, each with a folder of its own; those that are finished already are not run again."""
    import numpy as np

    from ..campaign.campaign import Campaign
    from ..campaign.digests import Digests, Hasher
    from ..campaign.runs import Request, Runs, Stopped
    from ..models.base import Case
    from ..simulate import log_expected_time, run_options
    from ..verdicts.population import wait_for
    from . import console

    places: list[Path | None] = []
    for motion in motions:
        places.append(None if out is None else out / safe_name(motion.name, places))
    stone, model, campaign = settings.stone, settings.model, settings.campaign
    options = run_options(campaign.tail, until_decided=True, **settings.options)
    hasher = Hasher(model, options)
    made = {
        "twins": [campaign.replicates, campaign.scatter, campaign.seed],
        "whole": campaign.whole,
        **settings.options,
    }
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
        summary = conclude(settings, motions[number], places[number], True, drawn)
        files = {} if out is None else {"files": [str(Path(file).relative_to(out)) for file in summary["files"]]}
        return {"summary": json.loads(console.as_json(summary)), **files}

    summaries: dict[int, dict] = {}
    with console.folder(out) as folder:
        ledger = console.ledger(folder)
        twins = f", each with {campaign.replicates} like it," if campaign.replicates else ""
        wait = wait_for(stone.stack or stone, motions, model, campaign, options, settings.followed)
        log_expected_time(f"{len(motions)} runs{twins} take", wait, stone)
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


def conclude(settings: Settings, motion: Motion, out: Path | None, quiet: bool, drawn: RunPictures) -> dict:
    """Make a run; its files where a folder is given, its words where they are wanted. Returns its summary."""
    from ..motion.motion import write_csv
    from ..verdicts.directions import direction_of
    from ..verdicts.population import other_laws
    from . import console
    from .files import files as files_of

    pictures = ["histories", "filmstrip", "joints", "energy", "motion", *SPACE_PICTURES]
    names = ("response.nc", "run.json", "motion.csv", "replicates.csv", "bodies.csv", "debris", "median")
    with files_of(out, "run", *names, *pictures) as files:
        console.ledger(files.folder)
        with console.progress("seconds of motion") as progress:
            campaign = replace(settings.campaign.kept_in(files.folder), progress=progress)
            response, population = replace(settings, campaign=campaign).run(motion)
        console.show(response)
        model, taken = settings.model, settings.model.taken(motion)
        summary = response.summary() | o.input_facts(taken) | direction_of(motion)
        if population is not None:
            summary |= population.summary(summary)
        elif response.measures.blocks is not None:  # carried along by no run
            summary["replicates"] = 0
        laws = None
        if population is not None and not population.drawn.groups and not settings.followed:
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
            files.write_request(structures=[settings.stone], models=[model], motions=[taken])
            files.summary(summary, "run.json")
    if not quiet:
        describe(response, taken, files, population, laws)
    return summary


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
    plain = (
        "".join(char if char.isalnum() or char in "-_." else "_" for char in name.split(",")[0]).strip("._") or "record"
    )
    used = {path.name for path in taken if path is not None}
    return next(folder for folder in (plain, *(f"{plain}-{i}" for i in range(2, len(used) + 3))) if folder not in used)


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


#: Most bodies that are told one by one.
MOST_BODIES = 6

#: What losses of stone, which are chosen for one body, do not promise for a stack.
SLIPPING_STACK = "; impacts keep up to 5 % less velocity than those of one body, as joints slip"


def describe(
    response: Response,
    motion: Motion,
    files: list[Path],
    population: Population | None = None,
    laws: OtherLaws | None = None,
) -> None:
    """Print the verdict for people."""
    from ..response.words import doubt_of, opening_words
    from . import console

    description = column_facts(response) if response.measures.blocks is None else assembly_facts(response)
    sentence, what, facts = description
    if population is not None:
        sentence = f"{sentence} {population.sentence} {population.beside(response.summary())}".rstrip()
        facts |= population_facts(population)
    elif response.structure.scattered and response.measures.blocks is not None:
        facts["certainty"] = "one run, of exactly these stones; --replicates 15 runs assemblies like it as well"
    doubt = doubt_of(response) if population is None else population.doubt_about(response)
    if laws is not None:
        doubt = laws.sentence or doubt
        facts["under other laws"] = laws.words
    sentence = f"{sentence} {doubt}".rstrip()
    if opens := opening_words(response.provenance.get("opening")):
        what["rocks at"] = opens
    what |= quiet_facts(response)
    computed = f"{response.model}, step {response.time_step:.3g} s, {response.steps} steps, {response.wall_time:.2f} s"
    console.say(
        sentence, {**what, **o.input_lines(motion), "model": computed, **losses_facts(response), **facts}, files
    )


def losses_facts(response: Response) -> dict[str, str]:
    """What joints lost by name, in numbers."""
    summary = response.summary()
    if summary["losses"] in (None, "none") or "steps_over_undamped" not in response.provenance:
        return {}
    acting, more = summary["losses_acting"], response.provenance["steps_over_undamped"]
    words = ", ".join(f"{name.replace('_', ' ')} {value:.2g}" for name, value in acting.items())
    stack = response.structure.stack
    slips = "" if stack is None or stack.n == 1 or summary["losses"] != "stone" else SLIPPING_STACK
    return {"losses": f"{summary['losses']}: {words}; {more:.2g} times as many steps as undamped{slips}"}


def quiet_facts(response: Response) -> dict[str, str]:
    """Stepped share of a record, where its quiet was left out."""
    stepped = response.measures.stepped
    if stepped is None:
        return {}
    ends = response.time[-1]
    return {"stepped": f"{stepped[2]:.3g} of {ends:.3g} s, without what is quiet (--whole steps all)"}


def population_facts(population: Population) -> dict[str, str]:
    """Columns like this one, or assemblies, and their displacements; of an assembly where its bodies lie."""
    from ..messages import percents
    from ..verdicts.population import OVER_ALL, not_safe, not_yet_debris, only_as_seen
    from . import console

    facts = {f"{population.like} like this": population.drawn.words}
    spreads = {name.split("_")[0]: spread for name, spread in population.spread.items() if "displacement" in name}
    for name, words in (("peak", "their peak, 16/50/84 %"), ("residual", "their residual, 16/50/84 %")):
        if (spread := spreads[name]) is not None:
            facts[words] = ", ".join(
                "collapse" if length == float("inf") else console.length(length) for length in spread
            )
    listed = not_safe(population.bodies)
    for body in listed[:MOST_BODIES]:
        half, most = (console.length(radius) for radius in body.radii)
        x, y = (console.length(coordinate) for coordinate in body.middle)
        open_ = f", {body.open} undecided" * bool(body.open)
        facts[f"body {body.name}"] = (
            f"fell in {body.fell} of {body.runs}{open_} ({percents(*body.interval(population.confidence))}); at the end, "
            f"{OVER_ALL}, {x} along x and {y} along y from where it stood (medians), half of the runs within {half} of "
            f"that and 90 % within {most}"
        )
    if len(listed) > MOST_BODIES:
        facts["other bodies"] = (
            f"{len(listed) - MOST_BODIES} more fell or are undecided in some (bodies.csv with --out)"
        )
    if listed and (seen := only_as_seen(listed[0].runs)):
        facts["regions"] = seen
    if listed and (moving := not_yet_debris(population.bodies)):
        facts["debris"] = f"{moving}: where bodies were is not yet where they lie"
    return facts


def column_facts(response: Response) -> tuple[str, dict[str, str], dict[str, str]]:
    """Verdict on a column, what it is, and its measures."""
    m, column = response.measures, response.column
    drums = f"{column.n} {'drum' if column.n == 1 else 'drums'}"
    shown = f"histories and films show the fall, to {response.time[-1]:.2f} s"
    facts = {"collapse": f"certain at {m.collapse_time:.2f} s; {shown}"} if m.collapsed else {}
    facts |= measure_facts(response, ", before the fall")
    return response.sentence, {"column": f"{column.name}, {drums}, {column.height:g} m high"}, facts


def assembly_facts(response: Response) -> tuple[str, dict[str, str], dict[str, str]]:
    """Verdict on an assembly, what it is, and its measures."""
    from ..response.words import moving_at_end

    structure: Any = response.structure
    sentence = response.sentence
    if response.at_rest:
        sentence += " Everything lies still."
    elif response.outcome is not Outcome.FAILED:
        change = "" if response.decided else " and the verdict may change"
        waited = response.provenance.get("until_rest", False)
        damping = "mass_damping=0.5" if structure.space_joints is None else "stiffness_damping=1e-4"
        remedy = f"; damp it with --set {damping}" if waited else "; go on with --until-rest"
        rolls = waited and structure.space_joints is not None and moving_at_end(response)  # which no damping stops
        sentence += f" Not everything lies still{change}{'' if rolls else remedy}."
    fixed = sum(block.fixed for block in structure.bodies[-structure.n :])
    supports = f", {fixed} of them fixed" if fixed else ""
    joined = structure.joined_faces
    joints = f"{len(joined)} {'joint' if len(joined) == 1 else 'joints'}"
    what = f"{structure.name}, {structure.n} blocks{supports}, {joints}"
    return sentence, {"assembly": what}, measure_facts(response, ", until the first block fell")


def measure_facts(response: Response, until: str) -> dict[str, str]:
    """Measures that are declared with a label, in lines; ``until`` says where peaks end that a collapse has ended."""
    from ..response.measures import TOP
    from . import console

    m, facts, base = response.measures, {}, response.structure.base_width
    for measure, value in m.shown():
        when = "" if not m.collapsed else until if measure.peak else ", at the end"
        share = f" ({value / base:.2f} base widths)" if measure.peak and measure.of == TOP and base is not None else ""
        facts[measure.label + when] = (
            console.length(value) if measure.unit == "m" else f"{value:.4f} {measure.unit}"
        ) + share
    return facts | {"energy imbalance": f"{m.energy_imbalance:.1e} of the energy at stake"}
