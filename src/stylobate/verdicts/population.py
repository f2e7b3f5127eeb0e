"""Columns like one: their verdicts under one motion and under other laws of joints, and where their bodies lie."""

from __future__ import annotations

import logging
import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.campaign import Campaign
from ..campaign.digests import Digests, Hasher
from ..campaign.runs import Request, Runs, Stopped
from ..campaign.twins import UNDAMPED, Twins, on_rim_or_bed, the_twins
from ..column.column import Column
from ..column.joint import LAWS, Losses
from ..column.materials import CONTACT, ROLLING
from ..column.scatter import spread_of
from ..column.structure import Structure
from ..messages import joined, percents, say
from ..models.base import Case, Model, RunOptions
from ..models.engine import engine_for
from ..models.shared.ground import share_of
from ..motion import Motion
from ..notebook import NotebookSummary
from ..outcome import Outcome
from ..response import Response
from ..response.measures import CPU, SPREAD
from ..response.recorded import Recorded
from ..response.words import doubt_of, to_decide
from ..simulate import expected_wait, run_options, simulate, thread_count
from . import verdict as v
from .directions import peak_of
from .verdict import caveat, share_limits

if TYPE_CHECKING:
    import pandas


#: Shares of the twins whose places the regions hold.
REGIONS = (0.5, 0.9)

#: From fewer twins than this the larger region is only as large as what was seen.
FEW = 20

#: Of which runs places and regions are.
OVER_ALL = say("over all runs, those in which it stands too")


@dataclass(frozen=True, eq=False)
class BodyOverTwins:
    """One body over the twins of an assembly.

    Parameters
    ----------
    name : str
    fell : int
        Twins with a verdict in which it fell.
    stood : int
        Decided ones in which it did not.
    open : int
        Those in which it had not fallen when their runs ended, and not everything lay still.
    still : int
        Runs at whose end everything lay still.
    ends : array
        Ways of its centroid in plan from the start to the end of each run that did not fail [m], shape (k, 2).
    """

    name: str
    fell: int
    stood: int
    open: int
    still: int
    ends: np.ndarray

    @property
    def runs(self) -> int:
        """Twins that could be computed."""
        return self.fell + self.stood + self.open

    @property
    def share(self) -> float:
        """Share of the twins in which it fell; NaN without a verdict."""
        return float(v.share_collapsed(self.fell, self.stood, self.open))

    def interval(self, confidence: float) -> tuple[float, float]:
        """Confidence limits of the probability that it falls; undecided ones are counted both ways."""
        low, high = v.collapse_interval(self.fell, self.stood, self.open, confidence)
        return float(low), float(high)

    @property
    def middle(self) -> np.ndarray:
        """Median way in plan [m], shape (2,)."""
        return np.median(self.ends, axis=0) if len(self.ends) else np.full(2, math.nan)

    @property
    def radii(self) -> tuple[float, ...]:
        """Radii about :attr:`middle` of the circles that hold these shares of the ends (:data:`REGIONS`) [m]."""
        if not len(self.ends):
            return (math.nan,) * len(REGIONS)
        far = np.linalg.norm(self.ends - self.middle, axis=1)
        return tuple(float(radius) for radius in np.quantile(far, REGIONS, method="inverted_cdf"))

    def row(self, confidence: float) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate run`` and of ``bodies.csv``."""
        low, high = self.interval(confidence)
        radii = {f"region_{100 * share:.0f}_m": radius for share, radius in zip(REGIONS, self.radii, strict=True)}
        return {
            "fell": self.fell,
            "stood": self.stood,
            "undecided": self.open,
            "runs_at_rest": self.still,
            "probability": None if math.isnan(self.share) else self.share,
            "interval_low": low,
            "interval_high": high,
            "middle_x_m": float(self.middle[0]),
            "middle_y_m": float(self.middle[1]),
            **radii,
        }


def bodies_over_twins(rows: Sequence[Mapping[str, Any]]) -> tuple[BodyOverTwins, ...]:
    """Each body over twins; none where the rows do not tell of bodies.

    Parameters
    ----------
    rows : sequence of mapping
        One per twin, with the keys of ``Measures.row()``.
    """
    sound = [(row["at_rest"], row["bodies"]) for row in rows if row.get("bodies") and v.verdict(row) != v.FAILED]
    over_twins = []
    for name in sound[0][1] if sound else ():
        mine = [(still, bodies[name]) for still, bodies in sound]
        fell = sum(body["fell_at_s"] is not None for _, body in mine)
        open_ = sum(body["fell_at_s"] is None and not still for still, body in mine)
        ends = np.array([body["displacement_at_end_m"][:2] for _, body in mine])
        still = sum(still for still, _ in mine)
        over_twins.append(BodyOverTwins(name, fell, len(mine) - fell - open_, open_, still, ends))
    return tuple(over_twins)


def not_yet_debris(bodies: Sequence[BodyOverTwins]) -> str:
    """That the regions are of bodies that still move, in a clause; empty where all lies still."""
    moving = len(bodies[0].ends) - bodies[0].still if bodies else 0
    if not moving:
        return ""
    return say("in {moving} of {all} runs not all lay still at the end", moving=moving, all=len(bodies[0].ends))


def only_as_seen(runs: int) -> str:
    """That a region from so few runs is only as large as what was seen, in a clause; empty where they are enough."""
    alone = say("from 1 run, fewer than {few}, the 90 % region is only that of what was seen")
    several = say("from {runs} runs, fewer than {few}, the 90 % region is only that of what was seen")
    return (alone if runs == 1 else several).of(runs=runs, few=FEW) * (0 < runs < FEW)


def not_safe(bodies: Sequence[BodyOverTwins]) -> list[BodyOverTwins]:
    """Bodies that fell in some twin or are undecided in some, those that fell most often first."""
    return sorted((body for body in bodies if body.fell or body.open), key=lambda body: (-body.fell, -body.open))


def words_of_bodies(bodies: Sequence[BodyOverTwins], most: int = 6) -> str:
    """In how many twins each body fell or is undecided, in up to two sentences; empty where all surely stand."""
    listed = not_safe(bodies)
    both = say("{body.name} in {body.fell} ({body.open} undecided)")
    fallen = [(both if body.open else say("{body.name} in {body.fell}")).of(body=body) for body in listed if body.fell]
    open_ = [say("{name} in {count}", name=body.name, count=body.open) for body in listed if not body.fell]
    groups = ((say("What fell: {bodies}."), fallen), (say("Fell in none, but undecided: {bodies}."), open_))
    return joined(" ", (title.of(bodies=_first_of(phrases, most)) for title, phrases in groups if phrases))


def _first_of(names: Sequence[str], most: int) -> str:
    more = len(names) - most
    return joined(", ", names[:most]) + (say(", and {count} more", count=more) if more > 0 else "")


#: Twins that must stand before their largest and least displacement tell where a run belongs.
ENOUGH = 8


#: Interval in tables as if the law of the joints were known, where it is not.
OF_COLUMNS = ("collapse_interval_of_columns_low", "collapse_interval_of_columns_high")

#: Heading of a column of a table that holds :func:`chance_words`.
CHANCE = say("those like it that collapse")


@dataclass(frozen=True, eq=False)
class Population:
    """Twins of a column under one motion.

    Parameters
    ----------
    drawn : Twins
    rows : tuple of dict
        One per twin, with the keys of ``Measures.row()``.
    confidence : float
        Level of the interval.
    to_decide : str
        What decides those whose verdict is open, in a clause.
    doubt : str
        Of assemblies in space, what stands beside all of them: some may have struck where the run itself did not.
    """

    drawn: Twins
    rows: tuple[dict, ...]
    confidence: float = 0.95
    to_decide: str = ""
    doubt: str = ""

    @property
    def verdicts(self) -> list[str]:
        """Verdict on each twin."""
        return [v.verdict(row) for row in self.rows]

    @property
    def counts(self) -> dict[str, int]:
        """Number of twins of each verdict."""
        return v.count(self.verdicts)

    @property
    def probability(self) -> float:
        """Share of the twins that collapse, NaN without a verdict: :func:`stylobate.verdicts.verdict.share_collapsed`."""
        return float(v.share_collapsed(*self._counts))

    @cached_property
    def interval(self) -> tuple[float, float]:
        """Confidence limits of the probability of collapse; see :func:`stylobate.verdicts.verdict.share_limits`."""
        low, high = share_limits(np.array(self.verdicts), self.drawn.groups[: len(self.rows)], self.confidence)
        return float(low), float(high)

    @cached_property
    def interval_of_columns(self) -> tuple[float, float]:
        """The same as if the law of their joints were known."""
        low, high = v.collapse_interval(*self._counts, self.confidence)
        return float(low), float(high)

    @property
    def spread(self) -> dict[str, list[float] | None]:
        """Values that 16, 50 and 84 % of the twins do not exceed, by measure; a collapse exceeds everything.

        None where a verdict is missing, or a percentile lies among the collapses.
        """
        named = (measure.key for measure in SPREAD)
        return {name: self._percentiles(name) for name in named if not self.rows or name in self.rows[0]}

    @cached_property
    def bodies(self) -> tuple[BodyOverTwins, ...]:
        """Each body of an assembly over its twins; empty for columns."""
        return bodies_over_twins(self.rows)

    @property
    def like(self) -> str:
        """What the twins are: columns, assemblies."""
        return self.drawn.like

    @property
    def order(self) -> list[int]:
        """Twins from the least to the most: by peak displacement, then those that collapse, the last one first."""

        def harm(index: int) -> tuple[bool, float]:
            row = self.rows[index]
            fell = bool(row["collapsed"])
            return fell, -row["collapse_time_s"] if fell else abs(row[peak_of(row)])

        sound = [i for i, verdict in enumerate(self.verdicts) if verdict != v.FAILED]
        return sorted(sound, key=harm)

    @property
    def median(self) -> int | None:
        """Index of the twin in the middle; None if all failed."""
        return self.order[(len(self.order) - 1) // 2] if self.order else None

    @property
    def worst(self) -> int | None:
        """Index of the twin that fares worst; None if all failed."""
        return self.order[-1] if self.order else None

    @property
    def sentence(self) -> str:
        """Certainty of the verdict, in a sentence."""
        counts, number = self.counts, len(self.rows)
        trials = number - counts[v.FAILED]
        if trials == 0:
            return f"None of {number} {self.like} like this could be computed."
        text = f"Collapses in {counts[v.COLLAPSED]} of {trials} {self.like} like this"
        text += f" ({100.0 * self.confidence:g} %: {percents(*self.interval)}"
        if self.drawn.groups:
            text += f"; {percents(*self.interval_of_columns)} by the column alone, the rest by the law of its joints"
        text += ")"
        if counts[v.UNDECIDED]:
            text += f"; {_not_fallen(counts)}{f': {self.to_decide}' if self.to_decide else ''}"
        text += f"; {counts[v.FAILED]} more failed." if counts[v.FAILED] else "."
        return f"{text} {words_of_bodies(self.bodies)}".rstrip()

    @property
    def table(self) -> pandas.DataFrame:
        """One row per twin."""
        import pandas

        named = zip(self.drawn.columns, self.verdicts, self.rows, strict=True)
        return pandas.DataFrame([{"column": twin.name, "verdict": verdict, **row} for twin, verdict, row in named])

    @property
    def table_of_bodies(self) -> pandas.DataFrame:
        """One row per body of an assembly: in how many twins it fell, and the regions in which it lay at the end."""
        import pandas

        return pandas.DataFrame([{"body": body.name, **body.row(self.confidence)} for body in self.bodies])

    @property
    def columns(self) -> dict[str, Any]:
        """Certainty of the verdict, as columns of a table; displacements that a share of the twins does not exceed."""
        low, high = self.interval
        columns: dict[str, Any] = {
            "collapse_probability": self.probability,
            "collapse_interval_low": low,
            "collapse_interval_high": high,
            "replicates": len(self.rows),
        }
        if self.drawn.groups:
            columns |= dict(zip(OF_COLUMNS, self.interval_of_columns, strict=True))
        columns |= {f"twins_{verdict}": number for verdict, number in self.counts.items() if verdict != v.NOT_RUN}
        name = next(iter(self.spread))
        spread = self.spread[name]
        for i, share in enumerate((16, 50, 84)):
            columns[f"{name.removesuffix('_m')}_{share}_m"] = None if spread is None else spread[i]
        return columns

    def beside(self, run: Mapping[str, Any]) -> str:
        """Caveat on a run that is no example of its twins; empty where it is one.

        Parameters
        ----------
        run : mapping
            Under the names of the JSON object of ``stylobate run``.
        """
        limits = self.interval if self.drawn.groups else None
        if objection := set_against(run, self.counts, self.confidence, limits):
            return objection
        name = peak_of(run)
        stood = [abs(row[name]) for row, verdict in zip(self.rows, self.verdicts) if verdict == v.STANDS]
        own = run.get(name)
        if run["collapsed"] or own is None or len(stood) < ENOUGH or min(stood) <= abs(own) <= max(stood):
            return ""
        low, high, here = 1e3 * min(stood), 1e3 * max(stood), 1e3 * abs(own)
        return (
            f"{'Its top moves' if 'top' in name else 'It moves'} {'more' if here > high else 'less'} than "
            f"{'that of ' * ('top' in name)}any {'column' if 'top' in name else 'one'} like it that stands "
            f"({low:.3g} to {high:.3g} mm): with this one, from {min(low, here):.3g} to {max(high, here):.3g} mm."
        )

    def doubt_about(self, response: Recorded) -> str:
        """Why the verdict on the run itself may be another one, where its twins do not say so: those of other laws do."""
        return self.doubt or ("" if self.drawn.groups else doubt_of(response))

    def summary(self, run: Mapping[str, Any] | None = None) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate run``; with what must be said of the run itself, if given."""
        low, high = self.interval
        counts = self.counts
        middle = self.median
        return {
            **({"doubt": self.doubt} if self.doubt else {}),
            "collapse_probability": self.probability,
            "collapse_interval_low": low,
            "collapse_interval_high": high,
            "replicates": len(self.rows),
            "certainty": {
                "sentence": self.sentence,
                **{verdict: counts[verdict] for verdict in v.COMPUTED},
                "confidence": self.confidence,
                **({"interval": [low, high]} if self.drawn.groups else {}),
                **({"interval_of_columns": list(self.interval_of_columns)} if self.drawn.groups else {}),
                **self.drawn.facts,
                "percentiles": [16, 50, 84],
                **self.spread,
                "median_twin": None if middle is None else middle + 1,
                "worst_twin": None if self.worst is None else self.worst + 1,
                **({"bodies": {body.name: body.row(self.confidence) for body in self.bodies}} if self.bodies else {}),
                **({} if run is None else {"beside": self.beside(run)}),
            },
        }

    @property
    def _counts(self) -> tuple[int, int, int]:
        counts = self.counts
        return counts[v.COLLAPSED], counts[v.STANDS], counts[v.UNDECIDED]

    def _percentiles(self, name: str) -> list[float] | None:
        sound = [row for row, verdict in zip(self.rows, self.verdicts, strict=True) if verdict != v.FAILED]
        values = np.array([np.inf if row["collapsed"] else abs(row[name]) for row in sound])
        if np.isnan(values).all():  # there are none, or the model does not compute it
            return None
        percentiles = np.quantile(values, (0.16, 0.5, 0.84), method="higher")
        return [float(percentile) for percentile in percentiles]


def chance_words(row: Mapping[str, Any]) -> str:
    """Share of the columns like one that collapse, with its interval and their number; empty where there are none.

    Parameters
    ----------
    row : mapping
        Of a table with :attr:`Population.columns`, or the JSON object of ``stylobate run`` with twins; their interval is
        that of :attr:`Population.interval`, which holds another law of the joints where that is not known.
    """
    known = row.get("certainty") or {verdict: row.get(f"twins_{verdict}") for verdict in v.COMPUTED}
    fell, stood, open_, failed = (
        int(known.get(verdict) or 0) for verdict in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)
    )
    number = fell + stood + open_
    if not number:
        return say("none of {count} could be computed", count=failed) if failed else ""
    low, high = (float(row[f"collapse_interval_{end}"]) for end in ("low", "high"))
    chance = say("{share} of {count} ({interval})", share=percents(fell / number, (fell + open_) / number), count=number,
               interval=percents(low, high))  # fmt: skip
    counts = [say("{count} undecided", count=open_) * bool(open_), say("{count} failed", count=failed) * bool(failed)]
    return joined("; ", [chance, joined(", ", counts)])


def set_against(
    run: Mapping[str, Any],
    counts: Mapping[str, Any],
    confidence: float = 0.95,
    limits: tuple[float, float] | None = None,
) -> str:
    """Caveat where most columns like one end otherwise than it did, the run counted in; empty where they do not.

    The column as surveyed is one of its population: its collapse is never set aside because others stand.

    Parameters
    ----------
    run : mapping
        Of the column itself, under the names of the JSON object of ``stylobate run``.
    counts : mapping
        How many columns like it have which verdict, by its name.
    confidence : float
        Level of the interval.
    limits : (float, float), optional
        Of the share, where more than the columns is unknown; else those of the counts.
    """
    fell, stood, open_ = (int(counts.get(verdict) or 0) for verdict in (v.COLLAPSED, v.STANDS, v.UNDECIDED))
    collapsed, decided = bool(run.get("collapsed")), bool(run.get("decided", True))
    differ = stood + open_ > fell if collapsed else fell > stood
    if run.get("outcome") == "failed" or not differ:
        return ""
    number = fell + stood + open_
    fell, stood, open_ = fell + collapsed, stood + (decided and not collapsed), open_ + (not decided and not collapsed)
    low, high = limits or (float(limit) for limit in v.collapse_interval(fell, stood, open_, confidence))
    several = say("{fell} of {all}, this one and {count} like it, collapse ({level:g} %: {range}); {rest}.")
    alone = say("{fell} of {all}, this one and {count} like it, collapses ({level:g} %: {range}); {rest}.")
    all_ = (alone if fell == 1 else several).of(
        fell=fell, all=number + 1, count=number, level=100.0 * confidence, range=percents(low, high),
        rest=_not_fallen({v.STANDS: stood, v.UNDECIDED: open_}),
    )  # fmt: skip
    if collapsed:
        return say("That others stand does not make this one safe, which falls and is one of them: {all}", all=all_)
    if decided:
        return say("That this one stands does not make it safe, as most like it collapse: {all}", all=all_)
    return say("That this one has not fallen yet does not make it safe, as most like it collapse: {all}", all=all_)


def _not_fallen(counts: Mapping[str, int]) -> str:
    """Numbers of columns that stand and that are undecided."""
    stood, open_ = counts[v.STANDS], counts[v.UNDECIDED]
    words = say("{count} stands", count=stood) if stood == 1 else say("{count} stand", count=stood)
    open_words = say(" and {count} is undecided") if open_ == 1 else say(" and {count} are undecided")
    return words + (open_words.of(count=open_) if open_ else "")


@dataclass(frozen=True, eq=False)
class Certainty(NotebookSummary):
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
        product = {"own run": [column.digest, motion.name, motion.digest, [twin.nameless_digest for twin in riding]]}
        digest = Hasher(model, run_options(tail, until_decided=True)).of_product(product | following, __file__)
        response, rows = _stored_run(Case(column, motion), model, digest, make, kept, campaign)
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


def _stored_run(
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


#: Factor by which joints are stiffer and softer: one standard deviation of a coefficient of variation of 100 %.
FACTOR = math.exp(spread_of(1.0))


@dataclass(frozen=True)
class OtherLaws:
    """Verdicts on a column under other laws of its joints.

    Parameters
    ----------
    own : str
        Verdict of the run itself.
    verdicts : dict of str to str
        By law, in words.
    """

    own: str
    verdicts: dict[str, str]

    @property
    def changes(self) -> bool:
        """Whether the column falls under some of all these laws, the run's own among them, and stands under others."""
        return {v.COLLAPSED, v.STANDS} <= {self.own, *self.verdicts.values()}

    @property
    def sentence(self) -> str:
        """What other laws make of the verdict; empty where they make the same of it."""
        if not self.changes:
            return ""
        other = v.STANDS if self.own == v.COLLAPSED else v.COLLAPSED
        named = [law for law, verdict in self.verdicts.items() if verdict == other]
        made = say("stands") if other == v.STANDS else say("falls")
        return say(
            "The verdict hangs on what nobody knows of the joints: under {some} of {all} other laws it {made} ({laws}); "
            "replicates tell how sure that is.",
            some=len(named), all=len(self.verdicts), made=made, laws=joined(", ", named),
        )  # fmt: skip

    @property
    def words(self) -> str:
        """All verdicts, for people."""
        return joined(
            "; ", (say("{law}: {verdict}", law=law, verdict=say(verdict)) for law, verdict in self.verdicts.items())
        )


def other_laws(response: Response, motion: Motion, model: Model, campaign: Campaign) -> OtherLaws | None:
    """Run a column once more under each other law of its joints; None where no law is at stake.

    None for models in the plane and assemblies, and where nothing opened or slid: then all laws are the same.

    Parameters
    ----------
    response : Response
        Of the run itself.
    motion : Motion
        That shook it.
    model : Model
        That computed it.
    campaign : Campaign
        Its tail, threads and cluster.
    """
    at_stake = engine_for(model, response.structure).draws_laws
    if not at_stake or response.outcome in (Outcome.AT_REST, Outcome.FAILED):
        return None
    column = response.structure
    others = dict(_companions(column, model))
    logging.getLogger("stylobate").info(
        "%s The same is now computed under %d other laws of its joints.", response.sentence, len(others)
    )
    options = run_options(campaign.tail, quiet=response.provenance["quiet_share"], until_decided=True)
    alone = replace(campaign.of_computing, progress=None, ledger=None, tail=campaign.tail)
    rows = batch([Case(other, motion) for other in others.values()], column, model, alone, options)
    own = v.COLLAPSED if response.collapsed else v.STANDS if response.decided else v.UNDECIDED
    return OtherLaws(own, {law: v.verdict(row) for law, row in zip(others, rows, strict=True)})


def _companions(column: Any, model: Any) -> Iterator[tuple[str, Column]]:
    """Columns under other laws, by these laws in words."""
    acting = model.acting(column)
    damped = acting.damping(column) > UNDAMPED
    whole = on_rim_or_bed(column)
    for law in LAWS if whole else (acting.law,):
        for with_losses in (False, True):
            if law == acting.law and with_losses == damped:
                continue
            faces = (say("on rims, ") if law == "rim" else say("on beds, ")) if whole else ""
            words = faces + (say("damped as stone") if with_losses else say("undamped"))
            rolling = ROLLING.value if with_losses and column.section == "circular" else 0.0
            yield words, column.unwarned(losses=Losses(CONTACT.value if with_losses else 0.0, rolling, law))
    own = Losses(acting.damping(column), acting.rolling_resistance, acting.law)
    for words, factor in ((say("stiffer joints"), FACTOR), (say("softer joints"), 1.0 / FACTOR)):
        joints = tuple(
            joint.changed(
                normal_stiffness=joint.normal_stiffness * factor, shear_stiffness=joint.shear_stiffness * factor
            )
            for joint in column.joint_laws
        )
        yield words, column.unwarned(joints=joints, losses=own)
