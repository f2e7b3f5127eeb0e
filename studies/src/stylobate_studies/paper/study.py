"""The study of Baraldi, Sarhosis and Milani, recomputed: everything that its figures and its sentences need."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate.atomic import own_files
from stylobate.campaign.campaign import Progress
from stylobate.column import preset
from stylobate.column.catalogue import PAPER
from stylobate.constants import g
from stylobate.models.base import Model
from stylobate.motion import Motion, harmonic
from stylobate.probability.studies import StudyResult
from stylobate.simulate import thread_count
from stylobate.statics.pushover import PushoverResult, pushover
from stylobate.verdicts.compare import StepComparison, halved_step
from stylobate.verdicts.domain import CollapseProbability, Domain

from . import cases as c
from .ahead import compiled_meanwhile
from .company.study import company_piece
from .contacts import contacts_piece
from .doubt import Doubt
from .folder import check_folder, claim, is_ready
from .literature import literature_piece
from .mechanisms import COUNTED, mechanisms_piece
from .motions import motions_piece
from .pieces import POPULATION, cost_piece, domain_piece, histories_piece, population_piece, slug
from .records import read_records

if TYPE_CHECKING:
    import xarray

#: Says (what is being computed, finished, all).
Report = Callable[[str, int, int], None]


@dataclass(eq=False)
class PaperResults:
    """Everything that the study has computed.

    Parameters
    ----------
    grids : Grids
    quick : bool
    domains : dict
        By (column, model, section), e.g. ("paper-12-drums", "rigid block", "rectangular").
    histories : dict
        By (column, model): data sets over frequency, amplitude and time.
    variants : dict
        By (column, variant).
    limits : dict
        By (column, model): domains of one very low frequency, finely stepped.
    paths : dict
        Pushover paths by (column, section).
    doubts : dict
        By column: how far verdicts of distinct elements can be relied on.
    shaken : dict
        By variant of the rigid beam, and for distinct elements: the monolith's thirty cases up to the end of the shaking.
    spots : dict
        By model: slightly different monoliths at 0.66 Hz and 0.2 g.
    space : dict
        By (column, population of :data:`stylobate.paper.cases.POPULATIONS`): round columns in the plane and in space.
    rivals : dict
        By (column, model, section): plane domains on the grid of ``space``.
    literature : dict
        By population of round columns as others have tested them: peaks, residuals and verdicts of each column.
    mechanisms : dict
        By model: how many collapses of the drums are of each kind.
    contacts : dict
        By (column, plane or space, setting): round columns with other contact parameters; none in the coarse study.
    company : pandas.DataFrame, optional
        Runs of columns alone and in company; none in the coarse study.
    motions : StudyResult, optional
        Both columns under real motions; none in the coarse study.
    cost : dict
        By model: computing time of two seconds of a column of drums [s].
    """

    grids: c.Grids
    quick: bool
    domains: dict[tuple[str, str, str], Domain] = field(default_factory=dict)
    histories: dict[tuple[str, str], xarray.Dataset] = field(default_factory=dict)
    variants: dict[tuple[str, str], Domain] = field(default_factory=dict)
    limits: dict[tuple[str, str], Domain] = field(default_factory=dict)
    paths: dict[tuple[str, str], PushoverResult] = field(default_factory=dict)
    doubts: dict[str, Doubt] = field(default_factory=dict)
    shaken: dict[str, Domain] = field(default_factory=dict)
    spots: dict[str, CollapseProbability] = field(default_factory=dict)
    space: dict[tuple[str, str], CollapseProbability] = field(default_factory=dict)
    rivals: dict[tuple[str, str, str], Domain] = field(default_factory=dict)
    literature: dict[str, dict[str, list[float]]] = field(default_factory=dict)
    mechanisms: dict[str, dict[str, int]] = field(default_factory=dict)
    contacts: dict[tuple[str, str, str], CollapseProbability] = field(default_factory=dict)
    company: Any = None
    motions: StudyResult | None = None
    cost: dict[str, float] = field(default_factory=dict)

    @property
    def runs(self) -> int:
        """Number of time histories behind all of it."""
        single = [*self.domains.values(), *self.variants.values(), *self.limits.values()]
        single += [*self.shaken.values(), *self.rivals.values()]
        single += [domain for doubt in self.doubts.values() for domain in (doubt.steps.domain, doubt.steps.halved)]
        many = [*(doubt.population for doubt in self.doubts.values()), *self.spots.values(), *self.space.values()]
        many += self.contacts.values()
        tested = sum(len(population["peak"]) for population in self.literature.values())
        cases = tested + sum(history["verdict"].size for history in self.histories.values())
        cases += sum(len(table) for table in (self.company, self.motions and self.motions.plan) if table is not None)
        return sum(len(domain.rows) for domain in single) + sum(population.codes.size for population in many) + cases


def run_study(
    folder: Path,
    quick: bool,
    threads: int | None = None,
    report: Report | None = None,
    grids: c.Grids | None = None,
    records: Path | None = None,
) -> PaperResults:
    """Compute what the folder does not hold yet.

    Parameters
    ----------
    folder : path
        Holds the pieces, in ``data``; it must exist.
    quick : bool
        The coarse study.
    threads : int, optional
        All cores by default.
    report : callable, optional
        Called with (what is being computed, finished, all).
    grids : Grids, optional
        Other grids than those of ``quick``.
    records : path, optional
        Folder with the nine records of the fine study; the samples among them by default.

    Raises
    ------
    InputError
        The folder holds a study on other grids, or anything else.
    KeyboardInterrupt
        It was stopped; what is finished is kept.
    """
    grids = c.Grids.of(quick) if grids is None else grids
    read = [] if quick else read_records(records)
    check_folder(folder)
    with own_files(folder) as own:
        claim(own, grids)
        spaces = (folder / "data" / slug("space", *pair) / POPULATION for pair in product(PAPER, c.POPULATIONS))
        with compiled_meanwhile(not all(map(is_ready, spaces))) as wait:
            return _pieces(folder, quick, grids, threads, report, wait, read)


def _pieces(
    folder: Path,
    quick: bool,
    grids: c.Grids,
    threads: int | None,
    report: Report | None,
    wait: Callable[[], object],
    records: Sequence[Motion],
) -> PaperResults:
    data = folder / "data"
    pieces, count = PaperResults(grids, quick), thread_count(threads)

    def advance(what: str) -> Progress | None:
        if report is None:
            return None
        tell = report
        tell(what, 0, 0)
        return lambda done, total: tell(what, done, total)

    for name, label in product(PAPER, (c.BEAM, c.DEM)):
        what = f"histories, {name}: {label}"
        pieces.histories[name, label] = histories_piece(data, name, label, grids.tail, count, advance(what))
    for name in PAPER:
        for label, section in [(model, "rectangular") for model in c.MODELS] + [
            (model, "circular") for model in grids.circular
        ]:
            grid = (grids.frequencies, grids.amplitudes, c.DURATION)
            pieces.domains[name, label, section] = domain_piece(
                data / slug("domain", name, label, section), c.paper_column(name, section), c.MODELS[label], grid,
                grids.tail, count, advance(f"domains, {name}: {label}, {section}"),
            )  # fmt: skip
        for label in (c.BEAM, c.BLOCKS, c.DEM):
            grid = (np.array([0.1]), grids.limit_amplitudes, 20.0)
            pieces.limits[name, label] = domain_piece(
                data / slug("limit", name, label), preset(name), c.MODELS[label], grid, 0.0, count,
                advance(f"low frequency, {name}: {label}"),
            )  # fmt: skip
        for variant in grids.variants:
            _, model, change, duration = c.VARIANTS[variant]
            column = preset(name).with_joint(**change) if change else preset(name)
            grid = (grids.variant_frequencies, grids.variant_amplitudes, duration)
            pieces.variants[name, variant] = domain_piece(
                data / slug("variant", name, variant), column, model, grid, grids.tail, count,
                advance(f"open parameters, {name}: {variant}"),
            )  # fmt: skip
        pieces.doubts[name] = _doubt(data, name, grids, count, advance)
    falls = {label: pieces.domains[c.DRUMS, label, "rectangular"] for label in COUNTED}
    pieces.mechanisms = mechanisms_piece(data, falls, grids.tail, count, advance)
    for variant in grids.variants:
        label, model, change, duration = c.VARIANTS[variant]
        if duration == c.VARIANTS[c.REFERENCE][3] and (label == c.BEAM or variant == c.REFERENCE):
            column = preset(c.MONOLITH).with_joint(**change) if change else preset(c.MONOLITH)
            grid = (c.FREQUENCIES, c.AMPLITUDES, c.DURATION)
            folder_of = data / slug("shaken", variant)
            pieces.shaken[variant] = domain_piece(folder_of, column, model, grid, 0.0, count, None)
    for label in (c.BEAM, c.DEM):
        grid = (np.array([0.66]), np.array([0.2 * g]), c.DURATION)
        pieces.spots[label] = population_piece(
            data / slug("spot", label), preset(c.MONOLITH), c.MODELS[label], grid, 50, grids.tail, count, None
        )
    grid = (grids.space_frequencies, grids.space_amplitudes, c.DURATION)
    wait()  # for the compiler
    for name in PAPER:
        for label, model in c.POPULATIONS.items():
            pieces.space[name, label] = population_piece(
                data / slug("space", name, label), c.paper_column(name, "circular"), model, grid, grids.space_replicates,
                grids.tail, count, advance(f"round columns, {name}: {label}"), c.ACROSS,
            )  # fmt: skip
        for label, section in c.RIVALS:
            pieces.rivals[name, label, section] = domain_piece(
                data / slug("rival", name, label, section), c.paper_column(name, section), c.MODELS[label], grid,
                grids.tail, count, None,
            )  # fmt: skip
    wait()
    pieces.literature = literature_piece(data)
    if records:
        pieces.contacts = contacts_piece(data, grids.tail, count, advance)
        pieces.motions = motions_piece(data / "motions", records, count, advance("real motions"))
        pieces.company = company_piece(data / "company", records, count, advance("columns in company"))
    pieces.cost = cost_piece(data)
    for name, section in product(PAPER, ("rectangular", "circular")):
        pieces.paths[name, section] = pushover(c.paper_column(name, section))
    return pieces


def _doubt(data: Path, name: str, grids: c.Grids, threads: int, advance: Callable[[str], Progress | None]) -> Doubt:
    column, model = preset(name), c.MODELS[c.DEM]
    grid = (grids.doubt_frequencies, grids.doubt_amplitudes, c.DURATION)
    steps: list[tuple[str, Model]] = [
        ("whole step", model),
        ("half step", halved_step(model, column, harmonic(grid[0][-1], 1.0, c.DURATION))),
    ]
    pair = [
        domain_piece(data / slug("doubt", name, what), column, variant, grid, grids.tail, threads,
                     advance(f"certainty, {name}: {what}"))
        for what, variant in steps
    ]  # fmt: skip
    population = population_piece(
        data / slug("doubt", name, "population"), column, model, grid, grids.replicates, grids.tail, threads,
        advance(f"certainty, {name}: {grids.replicates} columns that differ by 1 %"),
    )  # fmt: skip
    return Doubt(StepComparison(*pair), population)
