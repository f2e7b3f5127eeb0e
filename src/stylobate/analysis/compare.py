"""Models side by side: the same column and motion through each, or the same domain through each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..campaign.digests import Digests, Hasher
from ..campaign.grid import grid_axis
from ..campaign.runs import Runs, Stopped
from ..column import Column
from ..errors import InputError
from ..models.base import Case, Model
from ..motion import Motion, harmonic
from ..response import Response, load_response
from ..simulate import check_cases, simulate
from . import verdicts as v
from .domain import Domain, collapse_domain

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
            {"model": label, **one.measures.row(), "wall_s": one.wall_time}
            for label, one in zip(self.labels, self.responses, strict=True)
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
    column: Column,
    motion: Motion,
    models: Sequence[Model],
    *,
    labels: Sequence[str] | None = None,
    tail: float = 0.0,
    output_interval: float = 0.01,
    progress: Callable[[int, int], None] | None = None,
    ledger: str | Path | None = None,
    files: Sequence[Path] = (),
) -> Comparison:
    """One column and one motion through several models.

    Parameters
    ----------
    column, motion
        As in :func:`stylobate.simulate`.
    models : sequence of Model
    labels : sequence of str, optional
        What they are called; their names by default.
    tail, output_interval
        As in :func:`stylobate.simulate`.
    progress : callable, optional
        Called with (finished, all).
    ledger : path, optional
        File that says which runs are finished: a call that was stopped goes on from there.
    files : sequence of path
        With a ledger, one per model in its folder: each response is saved there as soon as it is finished.

    Raises
    ------
    Stopped
        Interrupted (Ctrl-C); a KeyboardInterrupt that says what is kept.
    """
    _at_least_one(models)
    _refuse([Case(column, motion)], models, tail)
    names = _labels(models, labels)
    what = {"response": [column.digest, motion.name, motion.digest, output_interval]}
    each = [Hasher(model, tail).of_product([what, name], __file__) for model, name in zip(models, names, strict=True)]
    responses: dict[int, Response] = {}

    def make(number: int) -> dict:
        found = simulate(column, motion, models[number], tail=tail, output_interval=output_interval)
        responses[number] = found
        return {"files": [found.save(files[number]).name]} if ledger is not None else {}

    try:
        with closing(Runs(ledger)) as runs:
            products = runs.products(Digests.of(each), make)
            for done, (number, _) in enumerate(products, 1):
                if number not in responses:
                    responses[number] = load_response(files[number])
                if progress:
                    progress(done, len(models))
    except KeyboardInterrupt:
        raise Stopped(len(responses), len(models), ledger) from None
    return Comparison([responses[number] for number in range(len(models))], names)


def compare_domains(
    column: Column,
    models: Sequence[Model],
    frequencies: Sequence[float] | np.ndarray,
    amplitudes: Sequence[float] | np.ndarray,
    duration: float = 10.0,
    *,
    labels: Sequence[str] | None = None,
    tail: float = 0.0,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    ledger: str | Path | None = None,
) -> DomainComparison:
    """One domain through several models; parameters as in :func:`stylobate.collapse_domain`.

    ``labels`` are what the models are called, their names by default. ``progress`` counts the runs of all models. An
    interrupt (Ctrl-C) is passed on, as :class:`~stylobate.campaign.runs.Stopped`: half a comparison is none.
    """
    _at_least_one(models)
    most = float(grid_axis("amplitudes", amplitudes, 0.0, 1e4, "m/s²").max())
    each = grid_axis("frequencies", frequencies, 1e-3, 1e3, "Hz").tolist()
    _refuse([Case(column, harmonic(one, most, duration)) for one in each], models, tail)
    cells = len(frequencies) * len(amplitudes)
    domains = []
    for i, model in enumerate(models):

        def advance(done: int, _: int, i: int = i) -> None:
            if progress:
                progress(i * cells + done, len(models) * cells)

        domain = collapse_domain(
            column,
            model,
            frequencies,
            amplitudes,
            duration,
            tail=tail,
            threads=threads,
            progress=advance,
            ledger=ledger,
        )
        if not domain.complete:
            raise Stopped(i * cells + domain.rows.finished, len(models) * cells, ledger)
        domains.append(domain)
    return DomainComparison(domains, _labels(models, labels))


def _at_least_one(models: Sequence[Model]) -> None:
    if not models:
        raise InputError("no model is given to compare; name at least one.")


def _refuse(cases: Sequence[Case], models: Sequence[Model], tail: float) -> None:
    """Refuse what any of the models cannot compute before one of them is run, and anything written."""
    for model in models:
        check_cases(cases, model, tail=tail)


def _labels(models: Sequence[Model], labels: Sequence[str] | None) -> list[str]:
    names = [model.name for model in models] if labels is None else list(labels)
    if len(names) != len(models):
        raise InputError(f"{len(names)} labels are given for {len(models)} models; give one for each.")
    return names
