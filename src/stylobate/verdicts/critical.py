"""Critical amplitude of a column, of columns like it, and under the records of a suite."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..campaign.campaign import Campaign
from ..campaign.digests import Hasher
from ..campaign.runs import Request, run_all
from ..campaign.twins import Twins, the_twins
from ..column import Column
from ..column.structure import Structure
from ..constants import g
from ..errors import InputError, check_kind, check_range
from ..messages import joined, say
from ..models.base import Case, Cases, Model
from ..models.engine import engine_for
from ..motion import Motion
from ..motion.orientation import record_of
from ..notebook import NotebookSummary
from ..response.rows import Rows
from ..response.words import to_decide
from . import verdict as v
from .directions import Compass, bearing, direction_of
from .population import CHANCE, OF_COLUMNS, chance_words
from .verdict import SHARES, Capacity, bounds, caveat, of_levels, quantiles, share_limits

if TYPE_CHECKING:
    import pandas


#: Most stretches of amplitudes that are named.
MOST = 4

#: What stands, by its kind, with the article.
THE = {"column": say("the column"), "assembly": say("the assembly")}


def one_alone(like: str) -> str:
    """That one of some columns says little, and what asks others like it; empty where there are none like it."""
    if not like:
        return ""
    return say(
        "Near the boundary small differences decide, and one alone says little: with {count} replicates, "
        "{count} {like} like it run as well.", count=15, like=say(like),
    )  # fmt: skip


def sentence(s: Mapping[str, Any], kind: str = "column", like: str = "columns") -> str:
    """Results of one motion over its amplitudes.

    Parameters
    ----------
    s : mapping
        The JSON object of ``stylobate critical`` for one motion.
    kind, like : str
        What stands: column, assembly; what several like it are, if there are any.
    """
    twins = s.get("certainty")
    words = [_with_twins(s, kind, like, twins) if twins else "", _own_amplitudes(s, kind, twins), _open(s, twins)]
    return joined(" ", [*words, "" if twins else one_alone(like)])


def sentence_of_suite(s: Mapping[str, Any], kind: str = "column", like: str = "columns") -> str:
    """Results of several motions over one grid of peaks; ``s`` as of :func:`sentence`, for several motions."""
    rows, worst, twins = s["records"], s["worst"], s["certainty"]
    records, or_like = len({row["record"] for row in rows}), say(" or one like it") if twins else ""
    alone, several = say("record"), say("records")
    if records != len(rows):
        of = say(" of {count} records") if records > 1 else say(" of {count} record")
        alone, several = (word + of.of(count=records) for word in (say("motion"), say("motions")))
    grid = say("{low:g} to {high:g} g", low=s["amplitudes_g"][0], high=s["amplitudes_g"][-1])
    known = {
        "the": THE.get(kind, say(kind)),
        "or_like": or_like,
        "grid": grid,
        "surely": say("surely ") * bool(s["open_below"]),
    }
    if worst is None:
        none = say("No {motion} {surely}collapses {the}{or_like} at a peak looked at, {grid}.", motion=alone, **known)
        return joined(" ", [none, _open(s, twins), "" if twins else one_alone(like)])
    fell, lowest = (sum(row[name] is not None for row in rows) for name in ("critical_g", "lowest_collapse_g"))
    words = say("{fell} of {all} {motions} collapse {the} at some peak looked at, {grid}", fell=fell, all=len(rows),
                motions=several, **known)  # fmt: skip
    words += say(", {count} it or one like it", count=lowest) if twins else ""
    words += say(
        ". Most harm: {worst[motion]}, which collapses it{or_like} {already}at "
        "{worst[lowest_collapse_factor]:.3g} times the record, {worst[lowest_collapse_g]:.4g} g, the "
        "smallest factor at which any {surely}does.",
        worst=worst, already=say("already ") * ("lowest_collapse_g" in worst["bounds"]), **known,
    )  # fmt: skip
    below = say("Runs below that factor without a verdict, which may be collapses: {count}.", count=s["open_below"])
    return joined(" ", [words, below * bool(s["open_below"]), _open(s, twins), "" if twins else one_alone(like)])


def as_recorded(own: Mapping[str, Any]) -> str:
    """Effect of the record as it is, on the structure and on those like it.

    Parameters
    ----------
    own : mapping
        ``as_recorded`` of the JSON object of ``stylobate critical``.
    """
    likes = chance_words(own)
    words = say("{at:.4g} g: {verdict}", at=own["amplitude_g"], verdict=say(own["verdict"]))
    return say("{run}; {chance}: {likes}", run=words, chance=CHANCE, likes=likes) if likes else words


def _with_twins(s: Mapping[str, Any], kind: str, like: str, twins: Mapping[str, Any]) -> str:
    """The lowest collapse of the column and those like it, and by which amplitude shares of these have fallen."""
    number, lowest = s["replicates"], s["lowest_collapse_g"]
    if lowest is None:
        each = say("{the} or one of {count} like it", the=THE.get(kind, say(kind)), count=number)
        return _none(s, each, s["open_below"])
    shares = [(share, _by(twins, f"critical_{share}_g")) for share in (16, 50, 84)]
    share_words = joined(", ", (say("{share} % {by}", share=share, by=by) for share, by in shares if by))
    words = say("Of {all} {like}, this one and {count} like it, the first falls {where}", all=number + 1, like=say(like),
                count=number, where=_at(s, lowest, s["amplitudes_g"]))  # fmt: skip
    words += say("; of those like it fall {shares}", shares=share_words) if share_words else ""
    words += say(", whichever way the undecided end") if share_words and twins.get(v.UNDECIDED) else ""
    return joined(" ", [words + ".", _below(s["open_below"])])


def _by(twins: Mapping[str, Any], name: str) -> str:
    value, bound = twins.get(name), twins.get("bounds", {}).get(name, "")
    if bound.startswith("≤"):
        return say("at {at:.4g} g or below", at=float(bound[2:]))
    if bound.startswith(">"):
        return say("only above {at:.4g} g", at=float(bound[2:]))
    if value is None or not math.isfinite(value):
        return ""
    least = twins.get(name.replace("_g", "_least_g"), value)
    if least >= value:
        return say("by {at:.4g} g", at=value)
    return say("by {low:.4g} to {high:.4g} g", low=least, high=value)


def _own_amplitudes(s: Mapping[str, Any], kind: str, twins: Mapping[str, Any] | None) -> str:
    """At which amplitudes the column itself falls, and at which larger ones it stands again."""
    first, stretches = s["critical_g"], s["alternation"]
    without = [stretch for stretch in stretches if stretch["verdict"] not in (v.STANDS, v.COLLAPSED)]
    before = sum(stretch["runs"] for stretch in without if first is None or stretch["to_g"] < first)
    if first is None:
        if not twins:
            return _none(s, THE.get(kind, say(kind)), before)
        return "" if s["lowest_collapse_g"] is None else _none(s, say("this one"), before)
    after = [stretch for stretch in stretches if stretch["from_g"] > first and stretch["verdict"] != v.COLLAPSED]
    there = twins and first == s["lowest_collapse_g"]
    who = say("This one collapses {where}") if twins else say("{the:capital} collapses {where}")
    words = say("This one falls there") if there else who.of(the=THE.get(kind, say(kind)), where=_at(s, first))
    if again := [stretch for stretch in after if stretch["verdict"] == v.STANDS]:
        ranges = joined(", ", (_stretch(stretch) for stretch in again[:MOST]))
        ranges += say(" and {count} times more", count=len(again) - MOST) if len(again) > MOST else ""
        words += say(", but stands again at {again}: no single amplitude is its limit", again=ranges)
    elif after:
        words += say(", and not surely at all larger ones")
    elif first < stretches[-1]["to_g"]:
        words += say(", and at all larger ones up to {last:.4g} g", last=_last(s))
    return joined(" ", [words + ".", "" if there else _below(before)])


def _none(s: Mapping[str, Any], whom: str, without_verdict: int) -> str:
    words = say("No amplitude looked at, {range}, {surely}collapses {whom}; larger ones were not looked at.")
    return words.of(range=_range(s), whom=whom, surely=say("surely ") if without_verdict else "")


def _below(without_verdict: int) -> str:
    words = say("Runs below that without a verdict, which may be collapses: {count}.", count=without_verdict)
    return words if without_verdict else ""


def _open(s: Mapping[str, Any], twins: Mapping[str, Any] | None) -> str:
    """Runs without a verdict."""
    cure = s.get("to_decide") or say("a longer tail may decide them")
    remarks = [
        (s, v.UNDECIDED, say("{some} of {all} runs ended far from rest ({cure})")),
        (s, v.FAILED, say("{some} of {all} runs failed")),
        (twins or {}, v.UNDECIDED, say("{some} runs of those like it ended far from rest ({cure})")),
        (twins or {}, v.FAILED, say("{some} runs of those like it failed")),
    ]
    alone = {2: say("1 run of those like it ended far from rest ({cure})"), 3: say("1 run of those like it failed")}
    clauses = [
        (alone[k] if counts[name] == 1 and k in alone else words).of(some=counts[name], all=s["runs"], cure=cure)
        for k, (counts, name, words) in enumerate(remarks)
        if counts.get(name)
    ]
    return say("{runs}: not counted as collapse.", runs=joined("; ", clauses)) if clauses else ""


def _at(s: Mapping[str, Any], amplitude: float, of_twins: Sequence[float] = ()) -> str:
    """An amplitude, its factor of the record where there is one, and the next smaller one that was looked at.

    Columns alike went through fewer amplitudes; where ``of_twins`` has these, theirs is told as well.
    """
    words = say("at {at:.4g} g", at=amplitude)
    if s["lowest_collapse_factor"] is not None:
        factor = s["lowest_collapse_factor"] / s["lowest_collapse_g"] * amplitude
        words += say(", {factor:.3g} times the record", factor=factor)
    looked_at = [stretch[end] for stretch in s["alternation"] for end in ("from_g", "to_g")]
    own, theirs = (
        max((level for level in levels if level < amplitude), default=None) for levels in (looked_at, of_twins)
    )
    own = own if amplitude == s["critical_g"] else theirs
    if own is None:
        return say("already {where}, the lowest amplitude looked at", where=words)
    next_ = say(" (the next below that was looked at is {own:.4g} g)", own=own)
    if theirs is not None and theirs < own:
        next_ = say(" (the next below that was looked at is {own:.4g} g, for those like it {theirs:.4g} g)")
        next_ = next_.of(own=own, theirs=theirs)
    return words + next_


def _stretch(stretch: Mapping[str, Any]) -> str:
    alike = f"{stretch['from_g']:.4g}" == f"{stretch['to_g']:.4g}"
    return say("{s[from_g]:.4g} g", s=stretch) if alike else say("{s[from_g]:.4g} to {s[to_g]:.4g} g", s=stretch)


def _range(s: Mapping[str, Any]) -> str:
    return say("{low:.4g} to {high:.4g} g", low=s["alternation"][0]["from_g"], high=_last(s))


def _last(s: Mapping[str, Any]) -> float:
    return s["alternation"][-1]["to_g"]


@dataclass(frozen=True, eq=False)
class CriticalPopulation(NotebookSummary):
    """Verdicts on twins over a grid of amplitudes.

    Parameters
    ----------
    amplitudes : array
        [m/s²], shape (A,), rising.
    verdicts : array of str
        Shape (twins, A).
    drawn : Twins
    nominal : float, optional
        Amplitude of the record as it is [m/s²]; None for a formula.
    confidence : float
        Level of the interval.
    """

    amplitudes: np.ndarray
    verdicts: np.ndarray
    drawn: Twins
    nominal: float | None = None
    confidence: float = 0.95

    @classmethod
    def of(cls, amplitudes: np.ndarray, rows: Rows, drawn: Twins, nominal: float | None) -> CriticalPopulation:
        """From the rows of all twins at all amplitudes, those of one twin together."""
        verdicts = v.verdicts_of(rows).reshape(-1, len(amplitudes))
        return cls(amplitudes, verdicts, drawn, nominal)

    @property
    def counts(self) -> dict[str, np.ndarray]:
        """Number of twins of each verdict at each amplitude, under the names of tables."""
        return {f"twins_{verdict}": (self.verdicts == verdict).sum(axis=0) for verdict in v.COMPUTED}

    @property
    def probability(self) -> np.ndarray:
        """Share of the twins that collapse at each amplitude; see :func:`stylobate.verdicts.verdict.share_collapsed`."""
        return v.share_collapsed(*v.tally(self.verdicts, axis=0))

    @property
    def undecided_collapsed(self) -> np.ndarray:
        """Share of the twins that collapse at each amplitude if every undecided one does; NaN without a run."""
        fell, stood, open_ = v.tally(self.verdicts, axis=0)
        number = fell + stood + open_
        return np.divide(fell + open_, number, out=np.full(number.shape, np.nan), where=number > 0)

    @property
    def interval(self) -> tuple[np.ndarray, np.ndarray]:
        """Confidence limits of the probability; see :func:`stylobate.verdicts.verdict.share_limits`."""
        return share_limits(self.verdicts.T, self.drawn.groups, self.confidence)

    @property
    def interval_of_columns(self) -> tuple[np.ndarray, np.ndarray]:
        """The same as if the law of their joints were known."""
        return v.collapse_interval(*v.tally(self.verdicts, axis=0), self.confidence)

    @property
    def capacities(self) -> list[Capacity]:
        """Between which amplitudes the first collapse of each twin lies [m/s²]."""
        return [of_levels(self.amplitudes, list(verdict)) for verdict in self.verdicts]

    @property
    def critical(self) -> np.ndarray:
        """Smallest amplitude that collapses each twin [m/s²], shape (twins,); infinite where none of the grid does."""
        return np.array([capacity.high for capacity in self.capacities])

    @property
    def factors(self) -> np.ndarray | None:
        """The amplitudes as factors of the record [-], shape (A,); None for a formula."""
        return None if self.nominal is None else self.amplitudes / self.nominal

    @property
    def percentiles(self) -> dict[str, float]:
        """Amplitudes by which 16, 50 and 84 % of the twins have first collapsed [g]; infinite beyond the grid."""
        return {name: capacity.high / g for name, capacity in self._quantiles.items()}

    @property
    def least(self) -> dict[str, float]:
        """The same if every undecided or failed run were a collapse [g]: the amplitude above the largest surely stood."""
        above = np.append(self.amplitudes, math.inf)
        amplitudes = {
            name: above[np.searchsorted(self.amplitudes, capacity.low, side="right")]
            for name, capacity in self._quantiles.items()
        }
        return {name.replace("_g", "_least_g"): float(value) / g for name, value in amplitudes.items()}

    @property
    def bounds(self) -> dict[str, str]:
        """Of which of these only a bound is known, as nobody stood or nobody fell below it, by name."""
        return bounds({name: (capacity, g) for name, capacity in self._quantiles.items()})

    @property
    def _quantiles(self) -> dict[str, Capacity]:
        pairs = zip(SHARES, quantiles(self.capacities), strict=True)
        return {f"critical_{100 * share:.0f}_g": capacity for share, capacity in pairs}

    @property
    def table(self) -> pandas.DataFrame:
        """One row per amplitude: how many twins have which verdict, the probability of collapse and its limits."""
        import pandas

        low, high = self.interval
        rows = {"amplitude_g": self.amplitudes / g, "factor": self.factors}
        rows |= {
            verdict: (self.verdicts == verdict).sum(axis=0)
            for verdict in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)
        }
        rows |= {"collapse_probability": self.probability, "collapse_interval_low": low, "collapse_interval_high": high}
        if self.drawn.groups:
            rows |= dict(zip(OF_COLUMNS, self.interval_of_columns, strict=True))
        return pandas.DataFrame(rows)

    def summary(self) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate critical``; lists are over the amplitudes."""
        (low, high), of_columns = self.interval, self.interval_of_columns if self.drawn.groups else ()
        total = v.count(self.verdicts)
        return {
            "amplitudes_g": (self.amplitudes / g).tolist(),
            "factors": None if self.factors is None else self.factors.tolist(),
            "collapse_probability": self.probability.tolist(),
            "collapse_interval_low": low.tolist(),
            "collapse_interval_high": high.tolist(),
            **{name: values.tolist() for name, values in zip(OF_COLUMNS, of_columns)},
            **{name: count.tolist() for name, count in self.counts.items()},
            "replicates": len(self.verdicts),
            "certainty": {
                **self.drawn.facts,
                "confidence": self.confidence,
                **self.percentiles,
                **self.least,
                "bounds": self.bounds,
                **{verdict: total[verdict] for verdict in v.COMPUTED},
            },
        }


#: Largest number of amplitudes of a grid.
MAX_AMPLITUDES = 100_000

#: Amplitudes that differ by less are one [-].
CLOSE = 1e-9


@dataclass(frozen=True, eq=False)
class CriticalAmplitude(NotebookSummary):
    """Outcomes over a grid of amplitudes.

    Parameters
    ----------
    column : Column
    motion : Motion
        The shape that was scaled.
    model : str
    amplitudes : array
        Peak accelerations along x [m/s²], shape (runs,), rising: the grid, and that of a record as it is.
    rows : Rows, or a list of dict
        One per amplitude, with the keys of ``Measures.row()``.
    wall_time : float
        [s]
    nominal : float, optional
        Amplitude of the motion as it is [m/s²], of which the amplitudes are factors; None for a formula.
    population : CriticalPopulation, optional
        Twins of the column at the same amplitudes.
    doubt : str
        Caveat before all that rests on the runs, because of their model; empty where nothing does.
    cure : str
        What decides runs that are undecided, see :func:`stylobate.response.words.to_decide`.
    """

    column: Column
    motion: Motion
    model: str
    amplitudes: np.ndarray
    rows: Rows
    wall_time: float
    nominal: float | None = None
    population: CriticalPopulation | None = None
    doubt: str = ""
    cure: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "rows", Rows.of(self.rows))

    @property
    def verdicts(self) -> list[str]:
        """Verdict of each run: stands, collapsed, undecided or failed."""
        return v.verdicts_of(self.rows).tolist()

    @property
    def critical(self) -> float | None:
        """Smallest amplitude of the grid that collapses the column [m/s²]; None when none does.

        It is an upper bound where a smaller amplitude is undecided or failed; :attr:`counts` says whether any is.
        """
        return v.first_collapse(self.amplitudes, self.verdicts)

    @property
    def critical_factor(self) -> float | None:
        """The same as a factor of the record [-]; None for a formula, too."""
        return None if self.critical is None or not self.nominal else self.critical / self.nominal

    @property
    def all_collapse_above(self) -> float | None:
        """Smallest amplitude from which on every run of the grid collapses [m/s²]; None when the last one does not."""
        return v.all_collapse_above(self.amplitudes, self.verdicts)

    @property
    def capacity(self) -> Capacity:
        """Between which amplitudes the first collapse lies [m/s²]."""
        return of_levels(self.amplitudes, self.verdicts)

    @property
    def lowest_capacity(self) -> Capacity:
        """Between which amplitudes the first collapse of the column or one of its twins lies [m/s²]."""
        each = [self.capacity, *([] if self.population is None else self.population.capacities)]
        return Capacity(min(capacity.low for capacity in each), min(capacity.high for capacity in each))

    @property
    def lowest(self) -> float | None:
        """Smallest amplitude that collapses the column or one of its twins [m/s²]; None when none does."""
        return self.lowest_capacity.value

    @property
    def open_below(self) -> int:
        """Number of runs of the column and its twins without a verdict below that amplitude; any may be a collapse."""
        return self.without_verdict(self.lowest_capacity.high)

    def without_verdict(self, below: float) -> int:
        """Number of runs of the column and its twins without a verdict below an amplitude [m/s²]."""
        each = [(self.amplitudes, np.array(self.verdicts))]
        each += [] if self.population is None else [(self.population.amplitudes, self.population.verdicts)]
        open_ = [~np.isin(verdicts[..., a < below * (1.0 - CLOSE)], (v.STANDS, v.COLLAPSED)) for a, verdicts in each]
        return sum(int(mask.sum()) for mask in open_)

    @property
    def lowest_factor(self) -> float | None:
        """The same as a factor of the record [-]; None for a formula, too."""
        return None if self.lowest is None or not self.nominal else self.lowest / self.nominal

    @property
    def bounds(self) -> dict[str, str]:
        """Of which numbers of :meth:`summary` only a bound is known, such as "≤ 0.3" or "> 1.5", by name."""
        above, stood = self.all_collapse_above, self.amplitudes[np.array(self.verdicts) == v.STANDS]
        always = Capacity(float(max(stood, default=0.0)), math.inf if above is None else above)
        named = {"critical_g": (self.capacity, g), "all_collapse_above_g": (always, g)}
        named["lowest_collapse_g"] = self.lowest_capacity, g
        if self.nominal:
            named["critical_factor"] = self.capacity, self.nominal
            named["lowest_collapse_factor"] = self.lowest_capacity, self.nominal
        return bounds(named)

    @property
    def as_recorded(self) -> dict[str, Any] | None:
        """Effect of the record as it is: amplitude, verdict, share of the twins with its interval and their verdicts.

        None for a formula, or beyond the grid.
        """
        if self.nominal is None or self.nominal not in self.amplitudes:
            return None
        verdict = self.verdicts[int(np.flatnonzero(self.amplitudes == self.nominal)[0])]
        effect: dict[str, Any] = {"amplitude_g": self.nominal / g, "verdict": verdict}
        if self.population is not None:
            likes = self.population
            at = likes.amplitudes == self.nominal
            names = "collapse_probability", "collapse_interval_low", "collapse_interval_high"
            shares = zip(names, (likes.probability, *likes.interval), strict=True)
            effect |= {name: float(values[at][0]) for name, values in shares if at.any()}
            effect |= {name: int(count[at].sum()) for name, count in likes.counts.items()}
        return effect

    @property
    def counts(self) -> dict[str, int]:
        """Number of runs by verdict."""
        return v.count(self.verdicts)

    @property
    def undecided(self) -> bool:
        """Whether a run, or one of a twin, is undecided."""
        likes = () if self.population is None else self.population.verdicts.ravel().tolist()
        return v.UNDECIDED in (*self.verdicts, *likes)

    @property
    def table(self) -> pandas.DataFrame:
        """One row per run: ``amplitude_g``, ``verdict`` and the measures."""
        table = self.rows.table()
        table.insert(0, "amplitude_g", self.amplitudes / g)
        table.insert(1, "verdict", self.verdicts)
        return table

    @property
    def alternation(self) -> pandas.DataFrame:
        """Alternation of verdicts with growing amplitude: one row per stretch of equal verdict."""
        import pandas

        return pandas.DataFrame(
            [
                {"from_g": low / g, "to_g": high / g, "verdict": verdict, "runs": runs}
                for low, high, verdict, runs in v.alternations(self.amplitudes, self.verdicts)
            ]
        )

    def summary(self) -> dict:
        """The JSON object of ``stylobate critical``."""
        counts = self.counts
        summary = {
            "critical_g": _in_g(self.critical),
            "first_collapse_g": _in_g(self.critical),
            "critical_factor": self.critical_factor,
            "all_collapse_above_g": _in_g(self.all_collapse_above),
            "lowest_collapse_g": _in_g(self.lowest),
            "lowest_collapse_factor": self.lowest_factor,
            "open_below": self.open_below,
            "bounds": self.bounds,
            "as_recorded": self.as_recorded,
            "runs": len(self.rows),
            "collapsed": counts[v.COLLAPSED],
            "stands": counts[v.STANDS],
            "undecided": counts[v.UNDECIDED],
            "failed": counts[v.FAILED],
            "alternation": self.alternation.to_dict("records"),
            "wall_s": self.wall_time,
            "model": self.model,
            "doubt": self.doubt,
            "to_decide": self.cure if self.undecided else "",
            **({} if self.population is None else self.population.summary()),
        }
        return summary | {"sentence": sentence(summary, self.column.kind, self.column.like)}


def critical_amplitude(
    column: Column,
    motion: Motion,
    model: Model,
    start: float,
    stop: float,
    step: float = 0.005 * g,
    *,
    nominal: float | None = None,
    twin_amplitudes: int | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> CriticalAmplitude:
    """Run a column under one motion at every amplitude of a grid, and under a record as it is.

    Parameters
    ----------
    column : Column
    motion : Motion
        Scaled, all components alike, so that its peak along x takes the amplitudes of the grid.
    model : Model
    start, stop, step : float
        The grid: ``start``, ``start + step`` … up to ``stop`` [m/s²].
    nominal : float, optional
        Amplitude that ``motion`` stands for as it is [m/s²], of a formula; its peak along x by default.
    twin_amplitudes : int, optional
        Most amplitudes of the grid that twins go through, evenly spread; all by default.
    campaign, **settings : Campaign, optional
        With replicates, twins of the column go through the amplitudes as well.

    Raises
    ------
    InputError
        An impossible grid, or input that the model refuses.
    Stopped
        Interrupted (Ctrl-C); a KeyboardInterrupt that says what is kept.
    """
    campaign = Campaign.of("critical_amplitude", campaign, settings)
    check_kind("column", column, Structure)
    check_kind("motion", motion, Motion)
    check_kind("model", model, Model)
    as_is = motion.pga if nominal is None else nominal
    shaken = [Shaken(motion, as_is, nominal is None)]
    results, wall = sweep(column, shaken, model, amplitude_grid(start, stop, step), campaign, twin_amplitudes)
    return dataclasses.replace(results[0], wall_time=wall)


class Shaken(NamedTuple):
    """A motion, its amplitude as it is [m/s²], and whether that is one of a record, not of a formula."""

    motion: Motion
    as_is: float
    recorded: bool


def sweep(
    column: Column,
    shaken: Sequence[Shaken],
    model: Model,
    grid: np.ndarray,
    campaign: Campaign,
    twin_amplitudes: int | None = None,
) -> tuple[list[CriticalAmplitude], float]:
    """Run a column and its twins under motions at every amplitude of a grid; what came of each, and the time it took [s].

    Parameters
    ----------
    column, model
    shaken : sequence of Shaken
    grid : array
        Amplitudes [m/s²], rising.
    campaign : Campaign
    twin_amplitudes : int, optional
        As for :func:`critical_amplitude`.
    """
    drawn = the_twins(column, model, campaign) if campaign.replicates else None
    for motion, as_is, _ in shaken:
        if as_is == 0.0:
            raise InputError(f"motion {motion.name!r} is zero along x and cannot be scaled to an amplitude.")
    twins = () if drawn is None else drawn.columns
    spread = grid[np.unique(np.linspace(0, len(grid) - 1, twin_amplitudes or len(grid)).round().astype(int))]
    own = [_with_own(grid, shaking) for shaking in shaken]
    theirs = [_with_own(spread, shaking) for shaking in shaken]
    counts = np.array([len(a) + len(twins) * len(b) for a, b in zip(own, theirs, strict=True)])
    ends = np.cumsum(counts)

    def case(number: int) -> Case:
        which = int(np.searchsorted(ends, number, side="right"))
        place = number - int(ends[which] - counts[which])
        stands, amplitudes = column, own[which]
        if place >= len(amplitudes):
            twin, place = divmod(place - len(amplitudes), len(theirs[which]))
            stands, amplitudes = twins[twin], theirs[which]
        motion, as_is, recorded = shaken[which]
        size = float(amplitudes[place])
        return Case(stands, motion.scaled_to_pga(size) if recorded else motion.scaled(size / as_is))

    cases = Cases(int(ends[-1]), case)
    if drawn is not None:
        model = engine_for(model, column).paced
    started = time.perf_counter()
    request = Request.of(cases, Hasher(model, campaign.options), campaign.quiet)
    finished = run_all(request, campaign)
    results, doubt, cure = [], caveat([column], model), to_decide(column, model.parameters(), campaign.tail)
    for shaking, amplitudes, spread, count, end in zip(shaken, own, theirs, counts, ends, strict=True):
        rows, record = finished[int(end - count) : int(end)], shaking.as_is if shaking.recorded else None
        known = rows[: len(amplitudes)], rows[len(amplitudes) :]
        population = None if drawn is None else CriticalPopulation.of(spread, known[1], drawn, record)
        details = known[0], 0.0, record, population, doubt, cure
        results.append(CriticalAmplitude(column, shaking.motion, model.name, amplitudes, *details))
    return results, time.perf_counter() - started


def _with_own(grid: np.ndarray, shaken: Shaken) -> np.ndarray:
    """The grid with the amplitude that a record has as it is, unless that is beyond the grid's end."""
    return np.union1d(grid, [shaken.as_is]) if shaken.recorded and shaken.as_is <= grid[-1] else grid


def amplitude_grid(start: float, stop: float, step: float) -> np.ndarray:
    """Amplitudes from ``start`` to ``stop`` in steps [m/s²]; the last one is the last step not beyond ``stop``."""
    low, high, width = (float(value) for value in (start, stop, step))
    least = "it must not be below the smallest"
    check_range("the smallest amplitude", low / g, 0.0, 1e3, unit="g", open_low=True, field="start")
    check_range("the largest amplitude", high / g, low / g, 1e3, unit="g", remedy=least, field="stop")
    check_range("the amplitude step", width / g, 0.0, 1e3, unit="g", open_low=True, field="step")
    steps = int((high - low) / width * (1.0 + 1e-12) + 1e-9)
    if steps >= MAX_AMPLITUDES:
        raise InputError(
            f"the grid of amplitudes has {steps + 1} steps; allowed is up to {MAX_AMPLITUDES}: give a larger step.",
            "step",
        )
    return low + width * np.arange(steps + 1)


def _in_g(value: float | None) -> float | None:
    return None if value is None else value / g


@dataclass(frozen=True, eq=False)
class CriticalSuite(NotebookSummary):
    """Outcomes of many records over one grid of amplitudes.

    Parameters
    ----------
    results : tuple of CriticalAmplitude
        One per record.
    wall_time : float
        [s], of all of them.
    """

    results: tuple[CriticalAmplitude, ...]
    wall_time: float

    @property
    def amplitudes(self) -> np.ndarray:
        """Peak accelerations along x of every record [m/s²], shape (A,): the grid."""
        common = self.results[0].amplitudes
        for result in self.results[1:]:
            common = np.intersect1d(common, result.amplitudes)
        return common

    @property
    def verdicts(self) -> np.ndarray:
        """Verdicts by record on that grid, shape (records, A)."""
        return np.array(
            [np.array(result.verdicts)[np.isin(result.amplitudes, self.amplitudes)] for result in self.results],
            dtype=object,
        )

    @property
    def critical(self) -> float | None:
        """Smallest amplitude at which some record collapses the column [m/s²]; None when none does."""
        return min((result.critical for result in self.results if result.critical is not None), default=None)

    @property
    def critical_factor(self) -> float | None:
        """Smallest factor by which some motion collapses the column [-]; None when none does."""
        return min(
            (result.critical_factor for result in self.results if result.critical_factor is not None), default=None
        )

    @property
    def worst(self) -> CriticalAmplitude | None:
        """The motion that collapses the column, or one of its twins, at the smallest factor; None when none does."""
        fell = [result for result in self.results if result.lowest_factor is not None]
        return min(fell, key=lambda result: result.lowest_factor or math.inf, default=None)

    @property
    def open_below(self) -> int:
        """Number of runs under all motions without a verdict at smaller factors than that; any may be a collapse."""
        factor = math.inf if self.worst is None else self.worst.lowest_factor or math.inf
        return sum(result.without_verdict(factor * (result.nominal or math.inf)) for result in self.results)

    @property
    def compass(self) -> Compass:
        """Factor at which the column, or one of its twins, first collapses, by direction; the smallest of all records."""
        factors: dict[float, float] = {}
        for result in self.results:
            at = bearing(direction_of(result.motion))
            if at is not None:
                factor = math.inf if result.lowest_factor is None else result.lowest_factor
                factors[at] = min(factor, factors.get(at, math.inf))
        bearings = sorted(factors)
        like = "" if self.results[0].population is None else " or one like it"
        name = f"lowest factor that collapses it{like} [-]"
        most = None if self.worst is None else bearing(direction_of(self.worst.motion))
        return Compass(np.array(bearings), np.array([factors[at] for at in bearings]), name, worst=most)

    @property
    def all_collapse_above(self) -> float | None:
        """Smallest amplitude from which on every record collapses the column [m/s²], or None."""
        amplitudes = [result.all_collapse_above for result in self.results]
        return None if None in amplitudes else max(amplitude for amplitude in amplitudes if amplitude is not None)

    @property
    def share_collapsed(self) -> np.ndarray:
        """Share of the records that collapse the column, NaN where none is decided, shape (A,).

        See :func:`stylobate.verdicts.verdict.share_collapsed`.
        """
        return v.share_collapsed(*v.tally(self.verdicts, axis=0))

    @property
    def table(self) -> pandas.DataFrame:
        """One row per motion: its own peak, the critical amplitude, and how many runs came to which verdict."""
        import pandas

        rows = [_row(result) for result in self.results]
        for row in rows:
            row["bounds"] = "; ".join(f"{name} {bound}" for name, bound in row["bounds"].items())
        return pandas.DataFrame(rows)

    @property
    def runs(self) -> pandas.DataFrame:
        """One row per motion and amplitude, as the table of :class:`CriticalAmplitude`, with ``record`` and ``motion``."""
        import pandas

        return pandas.DataFrame(
            [
                {**_named(result), "amplitude_g": a / g, "verdict": verdict, **row}
                for result in self.results
                for a, verdict, row in zip(result.amplitudes, result.verdicts, result.rows)
            ]
        )

    def summary(self) -> dict:
        """The JSON object of ``stylobate critical`` for a folder of records."""
        counts = v.count([verdict for result in self.results for verdict in result.verdicts])
        twins = [result.population.verdicts.ravel() for result in self.results if result.population is not None]
        critical, above, worst = (
            self.critical,
            self.all_collapse_above,
            None if self.worst is None else _row(self.worst),
        )
        lowest = min((result.lowest for result in self.results if result.lowest is not None), default=None)
        summary = {
            "critical_g": None if critical is None else critical / g,
            "first_collapse_g": None if critical is None else critical / g,
            "all_collapse_above_g": None if above is None else above / g,
            "runs": sum(len(result.rows) for result in self.results),
            **{verdict: counts[verdict] for verdict in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)},
            "critical_factor": self.critical_factor,
            "lowest_collapse_g": None if lowest is None else lowest / g,
            "lowest_collapse_factor": None if worst is None else worst["lowest_collapse_factor"],
            "open_below": self.open_below,
            "certainty": v.count(np.concatenate(twins)) if twins else None,
            "amplitudes_g": (self.amplitudes / g).tolist(),
            "share_collapsed": self.share_collapsed.tolist(),
            "records": [_row(result) for result in self.results],
            "worst": worst,
            "wall_s": self.wall_time,
            "model": self.results[0].model,
            "doubt": self.results[0].doubt,
            "to_decide": self.results[0].cure if any(result.undecided for result in self.results) else "",
        }
        stands = self.results[0].column
        return summary | {"sentence": sentence_of_suite(summary, stands.kind, stands.like)}


def critical_suite(
    column: Column,
    motions: Sequence[Motion],
    model: Model,
    start: float,
    stop: float,
    step: float = 0.005 * g,
    *,
    campaign: Campaign | None = None,
    **settings: Any,
) -> CriticalSuite:
    """Run a column under every record at every amplitude of a grid.

    Parameters
    ----------
    column : Column
    motions : sequence of Motion
        Each is scaled, all its components alike, so that its peak along x takes the amplitudes of the grid.
    model : Model
    start, stop, step
        As for :func:`stylobate.verdicts.critical.critical_amplitude`.
    campaign, **settings : Campaign, optional
        As there.

    Raises
    ------
    InputError
        No motion, one that is zero along x, an impossible grid, or input that the model refuses.
    """
    campaign = Campaign.of("critical_suite", campaign, settings)
    if not motions:
        raise InputError("the suite holds no motion; give at least one.")
    grid = amplitude_grid(start, stop, step)
    shaken = [Shaken(motion, motion.pga, recorded=True) for motion in motions]
    results, wall = sweep(column, shaken, model, grid, campaign)
    return CriticalSuite(tuple(results), wall)


def _named(amplitude: CriticalAmplitude) -> dict[str, str]:
    """The record, the same for all its directions and signs, and the motion that is made of it."""
    return {"record": record_of(amplitude.motion), "motion": amplitude.motion.name}


def _row(amplitude: CriticalAmplitude) -> dict[str, Any]:
    critical, above, counts = amplitude.critical, amplitude.all_collapse_above, amplitude.counts
    return {
        **_named(amplitude),
        "pga_g": amplitude.motion.pga / g,
        "pgv_m_s": amplitude.motion.pgv,
        "critical_g": None if critical is None else critical / g,
        "critical_factor": amplitude.critical_factor,
        "all_collapse_above_g": None if above is None else above / g,
        "as_recorded": (amplitude.as_recorded or {}).get("verdict"),
        **direction_of(amplitude.motion),
        **{name: counts[name] for name in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)},
        **({} if amplitude.population is None else amplitude.population.percentiles),
        "lowest_collapse_g": None if amplitude.lowest is None else amplitude.lowest / g,
        "lowest_collapse_factor": amplitude.lowest_factor,
        "open_below": amplitude.open_below,
        "bounds": amplitude.bounds | ({} if amplitude.population is None else amplitude.population.bounds),
    }
