"""Models side by side under one motion, and a domain under two steps."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.campaign import RUNS, TWINS, Campaign
from ..campaign.digests import Digests, Hasher
from ..campaign.grid import HarmonicGrid
from ..campaign.runs import Request, Runs, Stopped
from ..column import Column
from ..column.structure import Structure
from ..errors import InputError, check_all, check_kind
from ..models.base import Case, Model
from ..models.shared.ground import share_of
from ..motion import Motion, harmonic
from ..response import Response, load_response
from ..simulate import run_options, simulate
from . import verdict as v
from .domain import Domain, run_grid

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, eq=False)
class Comparison:
    """Responses of several models to one motion, in the order asked for, and what each is called."""

    responses: list[Response]
    labels: list[str]

    @property
    def table(self) -> pandas.DataFrame:
        """One row per model, columns named as the JSON keys of ``stylobate run``."""
        import pandas

        rows = [
            {"model": label, **response.measures.row(), "wall_s": response.wall_time}
            for label, response in zip(self.labels, self.responses, strict=True)
        ]
        return pandas.DataFrame(rows)


@dataclass(frozen=True, eq=False)
class DomainComparison:
    """Domains of several models over the same cells, in the order asked for, and what each is called."""

    domains: list[Domain]
    labels: list[str]

    def differing(self, first: int, second: int) -> np.ndarray:
        """Cells in which both models have a verdict and the verdicts differ, shape (F, A)."""
        a, b = self.domains[first].verdicts, self.domains[second].verdicts
        return self.comparable(first, second) & (a != b)

    def comparable(self, first: int, second: int) -> np.ndarray:
        """Cells in which both models have a verdict (stands or collapsed), shape (F, A)."""
        certain = (v.STANDS, v.COLLAPSED)
        return np.isin(self.domains[first].verdicts, certain) & np.isin(self.domains[second].verdicts, certain)

    def undecided(self, first: int, second: int) -> np.ndarray:
        """Cells that both models could compute, at least one of them without a verdict, shape (F, A)."""
        computed = (v.STANDS, v.COLLAPSED, v.UNDECIDED)
        both = np.isin(self.domains[first].verdicts, computed) & np.isin(self.domains[second].verdicts, computed)
        return both & ~self.comparable(first, second)

    @property
    def table(self) -> pandas.DataFrame:
        """One row per pair of models: cells that are comparable, differ, how, and are undecided."""
        import pandas

        rows = []
        for i, j in combinations(range(len(self.domains)), 2):
            differs = self.differing(i, j)
            rows.append(
                {
                    "first": self.labels[i],
                    "second": self.labels[j],
                    "comparable": int(self.comparable(i, j).sum()),
                    "differing": int(differs.sum()),
                    "only_first_collapses": int((differs & (self.domains[i].verdicts == v.COLLAPSED)).sum()),
                    "only_second_collapses": int((differs & (self.domains[j].verdicts == v.COLLAPSED)).sum()),
                    "undecided": int(self.undecided(i, j).sum()),
                }
            )
        return pandas.DataFrame(rows)


def compare_models(
    column: Structure,
    motion: Motion,
    models: Sequence[Model],
    *,
    labels: Sequence[str] | None = None,
    output_interval: float = 0.01,
    files: Sequence[Path] = (),
    campaign: Campaign | None = None,
    **settings: Any,
) -> Comparison:
    """One column, or assembly, and one motion through several models.

    Parameters
    ----------
    column, motion
        As in :func:`stylobate.simulate`.
    models : sequence of Model
    labels : sequence of str, optional
        What they are called; their names by default.
    output_interval : float
        As in :func:`stylobate.simulate`.
    files : sequence of path
        With a ledger, one per model in its folder: each response is saved there as soon as it is finished.
    campaign, **settings : Campaign, optional
        How the runs are made.

    Raises
    ------
    Stopped
        Interrupted (Ctrl-C); a KeyboardInterrupt that says what is kept.
    """
    campaign = Campaign.of("compare_models", campaign, settings, (*TWINS, "threads", "dask", "device", "mix_devices"))
    check_kind("column", column, Structure)
    check_kind("motion", motion, Motion)
    models = check_all("models", models, Model)
    names = _labels(models, labels)
    what: dict[str, Any] = {"response": [column.digest, motion.name, motion.digest, output_interval]}
    quiet = share_of(motion, campaign.whole)
    what |= {"quiet": quiet} if quiet else {}
    options = run_options(campaign.tail, output_interval, quiet=quiet)
    hashers = [Hasher(model, options) for model in models]
    same = [hasher.of_product(what, __file__) for hasher in hashers]
    places = [file.name for file in files] or [""] * len(models)
    each = [hasher.of_product([what, place], __file__) for hasher, place in zip(hashers, places, strict=True)]
    groups = [(np.array([number]), model, options) for number, model in enumerate(models)]
    request = Request([Case(column, motion)] * len(models), Digests.of(each), groups)
    responses: dict[str, Response] = {}

    def make(number: int) -> dict:
        if same[number] not in responses:
            how: dict[str, Any] = {"tail": campaign.tail, "output_interval": output_interval, "quiet": quiet}
            responses[same[number]] = simulate(column, motion, models[number], **how)
        return {"files": [responses[same[number]].save(files[number]).name]} if campaign.ledger is not None else {}

    done = 0
    try:
        with closing(Runs(campaign)) as runs:
            for done, (number, _) in enumerate(runs.products(request, make), 1):
                if same[number] not in responses:
                    responses[same[number]] = load_response(files[number])
                if campaign.progress:
                    campaign.progress(done, len(models))
    except KeyboardInterrupt:
        raise Stopped(done, len(models), campaign.ledger) from None
    return Comparison([responses[digest] for digest in same], names)


def compare_domains(
    column: Column,
    models: Sequence[Model],
    frequencies: Sequence[float] | np.ndarray,
    amplitudes: Sequence[float] | np.ndarray,
    duration: float = 10.0,
    *,
    labels: Sequence[str] | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> DomainComparison:
    """One domain through several models; parameters as in :func:`stylobate.collapse_domain`.

    ``labels`` are what the models are called, their names by default. ``progress`` counts the runs of all models. An
    interrupt (Ctrl-C) is passed on, as :class:`~stylobate.campaign.runs.Stopped`: half a comparison is none.
    """
    campaign = Campaign.of("compare_domains", campaign, settings, RUNS)
    axes: tuple[Any, Any] = frequencies, amplitudes  # checked there
    models = check_all("models", models, Model)
    names = _labels(models, labels)
    grids = [HarmonicGrid(column, model, *axes, duration, campaign.tail) for model in models]
    requests = [grid.request() for grid in grids]
    cells, domains = len(requests[0]), []
    with closing(Runs(campaign)) as runs:
        runs.open(*requests)
        for grid, request in zip(grids, requests, strict=True):
            before = len(domains) * cells

            def advance(done: int, _: int, before: int = before) -> None:
                if campaign.progress:
                    campaign.progress(before + done, len(models) * cells)

            domain = run_grid(grid, request, runs, advance)
            if not domain.complete:
                raise Stopped(before + domain.rows.finished, len(models) * cells, campaign.ledger)
            domains.append(domain)
    return DomainComparison(domains, names)


def _labels(models: Sequence[Model], labels: Sequence[str] | None) -> list[str]:
    if not models:
        raise InputError("no model is given to compare; name at least one.")
    names = [model.name for model in models] if labels is None else list(labels)
    if len(names) != len(models):
        raise InputError(f"{len(names)} labels are given for {len(models)} models; give one for each.")
    return names


@dataclass(frozen=True, eq=False)
class StepComparison:
    """A domain, and the same one with half of the time step."""

    domain: Domain
    halved: Domain

    @property
    def comparable(self) -> np.ndarray:
        """Cells with a verdict under both steps, shape (F, A)."""
        certain = (v.STANDS, v.COLLAPSED)
        return np.isin(self.domain.verdicts, certain) & np.isin(self.halved.verdicts, certain)

    @property
    def differing(self) -> np.ndarray:
        """Comparable cells whose verdicts differ, shape (F, A)."""
        return self.comparable & (self.domain.verdicts != self.halved.verdicts)

    def summary(self) -> dict:
        """Counts, as in the JSON object of ``stylobate domain --half-step``."""
        collapsed = [int((domain.verdicts == v.COLLAPSED).sum()) for domain in (self.domain, self.halved)]
        return {
            "comparable": int(self.comparable.sum()),
            "differing": int(self.differing.sum()),
            "collapsed": collapsed[0],
            "collapsed_half_step": collapsed[1],
        }


def compare_steps(
    column: Column,
    model: Model,
    frequencies: Sequence[float] | np.ndarray,
    amplitudes: Sequence[float] | np.ndarray,
    duration: float = 10.0,
    *,
    campaign: Campaign | None = None,
    **settings: Any,
) -> StepComparison:
    """Run a domain under the model's step and under half of it; parameters as in :func:`compare_domains`."""
    campaign = Campaign.of("compare_steps", campaign, settings, RUNS)
    finest = harmonic(float(np.max(frequencies)), 1.0, duration)
    models = [model, halved_step(model, column, finest)]
    pair = compare_domains(column, models, frequencies, amplitudes, duration, campaign=campaign)
    return StepComparison(*pair.domains)


def halved_step(model: Model, column: Column, motion: Any) -> Model:
    """The model with half of the time step that it would take for this column and motion.

    Raises
    ------
    InputError
        The model chooses its steps by itself.
    """
    step = getattr(model, "time_step", None)
    if step is not None:
        return dataclasses.replace(model, time_step=0.5 * step)
    factor = getattr(model, "step_factor", None)
    if factor is not None:
        return dataclasses.replace(model, step_factor=0.5 * factor)
    step_for = getattr(model, "step_for", None)
    if step_for is None:
        raise InputError(f"{model.name} chooses its steps by itself; give a time_step to compare it with half of it.")
    seen = getattr(model, "idealised", lambda structure: structure)(column)
    return dataclasses.replace(model, time_step=0.5 * step_for(seen, motion))
