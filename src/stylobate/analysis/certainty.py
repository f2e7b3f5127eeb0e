"""Certainty of the verdict of one run: the same motion for columns that could as well stand there."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..campaign.campaign import Campaign
from ..campaign.digests import Digests, Hasher
from ..campaign.runs import Request, Runs, Stopped
from ..campaign.twins import Twins, the_twins
from ..column.structure import Structure
from ..models.base import Case, Model, RunOptions
from ..models.engine import engine_for
from ..models.shared.quiet import share_of
from ..motion import Motion
from ..notebook import Shown
from ..response import Response
from ..response.measures import CPU
from ..response.words import to_decide
from ..simulate import expected_wait, run_options, simulate, thread_count
from .difference import caveat
from .population import Population


@dataclass(frozen=True, eq=False)
class Certainty(Shown):
    """One run, and how sure its verdict is.

    Parameters
    ----------
    response : Response
        Of the column itself.
    population : Population
        Of its twins.
    wall_time : float
        [s], of everything.
    """

    response: Response
    population: Population
    wall_time: float

    @property
    def sentence(self) -> str:
        """What happened, how sure that is, and why it may be otherwise in space."""
        beside = self.population.beside(self.response.summary())
        parts = (self.response.sentence, self.population.sentence, beside, self.population.doubt_about(self.response))
        return " ".join(part for part in parts if part)

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate run``."""
        own = self.response.summary()
        return own | self.population.summary(own)


def certainty(
    column: Structure,
    motion: Motion,
    model: Model,
    *,
    output_interval: float = 0.01,
    until_end: bool = False,
    until_rest: bool = False,
    quiet: float | None = None,
    kept: Path | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> Certainty:
    """Shake one column once, and its twins beside it.

    A single run of a model that steps drums fills one of sixteen lanes; fifteen twins in the others cost next to nothing
    while the column stands as long as they do. More twins are computed as a batch after it. All of them go on until their
    verdicts are certain (``until_decided``); the run of the column itself is the same to the last bit with and without them.

    Parameters
    ----------
    column, motion, model, output_interval, until_end, until_rest, quiet
        As in :func:`stylobate.simulate`.
    kept : path, optional
        File for the run of the column itself, beside the ledger of the campaign: where both are as they were written, it is
        read, and not made again.
    campaign, **settings : Campaign, optional
        How many twins, and how; threads, cluster and ledger are for those beyond the first fifteen, and ``progress`` is
        called with times, as in :func:`stylobate.simulate`.

    Raises
    ------
    InputError
        A number that is not allowed, or input that the model refuses.
    """
    campaign = Campaign.of("certainty", campaign, settings, ("whole",), replicates=15)
    began = time.perf_counter()
    if until_rest:
        column = engine_for(model, column).followed()
    drawn = the_twins(column, model, campaign)
    twins, tail = drawn.columns, campaign.tail
    riding = _riding(drawn, column, model, until_end or until_rest)
    quiet = share_of(motion) if quiet is None else quiet
    following = {"output_interval": output_interval, "until_end": until_end, "until_rest": until_rest, "quiet": quiet}
    following["until_decided"] = True

    def make() -> Response:
        return simulate(
            column, motion, model, tail=tail, twins=riding, progress=campaign.progress, **following,
        )  # fmt: skip

    if kept is None or campaign.ledger is None or len(riding) == len(twins):  # then nothing is left to be interrupted
        response = make()
        rows = [twin.row() for twin in response.twins]
    else:
        product = {"own run": [column.digest, motion.name, motion.digest, [one.nameless_digest for one in riding]]}
        digest = Hasher(model, run_options(tail, until_decided=True)).of_product(product | following, __file__)
        response, rows = _kept(Case(column, motion), model, digest, make, kept, campaign)
    rest = until_rest and not engine_for(model, column).twins  # what is followed one by one, so are its twins
    options = run_options(tail, until_rest=rest, quiet=quiet, until_decided=True)
    rows += batch([Case(twin, motion) for twin in twins[len(rows) :]], column, model, campaign, options)
    doubt = "" if column.space_joints is None else caveat([column], model)
    population = Population(drawn, tuple(rows), to_decide=to_decide(column, model.parameters(), tail), doubt=doubt)
    return Certainty(response, population, time.perf_counter() - began)


def _riding(drawn: Twins, column: Structure, model: Model, followed: bool) -> tuple[Any, ...]:
    """Twins that ride along with a run; none where it is ``followed``, or where the law of their joints varies."""
    return () if followed or drawn.groups else tuple(drawn.columns[: engine_for(model, column).twins])


def wait_for(
    column: Structure, motions: Sequence[Motion], model: Model, campaign: Campaign, options: RunOptions, followed: bool
) -> float:
    """About how long :func:`certainty` takes for all of some motions, one after the other [s]; 0 where that is not known.

    Parameters
    ----------
    column, motions, model, campaign
        Without replicates in the campaign, the runs alone.
    options : RunOptions
        Of the run itself.
    followed : bool
        Whether it goes on to its end, or until rest.
    """
    twins: Sequence[Structure] = ()
    if campaign.replicates:
        drawn = the_twins(column, model, campaign)
        twins = drawn.columns[len(_riding(drawn, column, model, followed)) :]
    threads, paced = thread_count(campaign.threads), engine_for(model, column).paced
    return sum(
        expected_wait([Case(column, motion)], model, options)
        + expected_wait([Case(twin, motion) for twin in twins], paced, options, threads)
        for motion in motions
    )


def _kept(
    case: Case, model: Model, digest: str, make: Callable[[], Response], place: Path, campaign: Campaign
) -> tuple[Response, list[dict]]:
    """A run with histories and the rows of those that rode along: from its file, or made and kept there."""
    made: list[Response] = []

    def product(_: int) -> dict[str, Any]:
        made.append(make())
        made[0].save(place)
        return {"riding": [twin.row() for twin in made[0].twins], "files": [place.name]}

    request = Request(
        [case], Digests.of([digest]), [(np.arange(1), model, run_options(campaign.tail, until_decided=True))]
    )
    with closing(Runs(replace(campaign.of_computing, dask=None, device=CPU, progress=None))) as runs:
        ((_, row),) = runs.products(request, product)
    return made[0] if made else Response.load(place), row["riding"]


def batch(
    cases: Sequence[Case], column: Structure, model: Model, campaign: Campaign, options: RunOptions
) -> list[dict]:
    """Rows of twins that did not ride along, computed as those that did; the ledger of the campaign keeps them."""
    rows: list[dict] = [{}] * len(cases)
    if cases:
        request = Request.of(cases, Hasher(engine_for(model, column).paced, options), options.quiet)
        with closing(Runs(replace(campaign, progress=None))) as runs, closing(runs.run(request)) as finished:
            try:
                for number, row in finished:
                    rows[number] = row
            except KeyboardInterrupt:
                raise Stopped(runs.kept, len(cases), runs.path) from None
    return rows
