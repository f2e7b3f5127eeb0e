"""Earthquakes one after another: what becomes of a structure, and how many of a kind it takes until it falls."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.campaign import Campaign
from ..campaign.twins import the_twins
from ..column.structure import Structure
from ..errors import InputError, check_all, check_kind, check_whole
from ..messages import joined, say
from ..models.base import Case, Model
from ..models.shared.ground import share_of
from ..motion import Motion
from ..motion.sequence import REST, Span, in_sequence, number_at, spans_of
from ..notebook import NotebookSummary
from ..response import Response
from ..response.events import Event, events_of
from ..simulate import simulate
from . import verdict as v
from .population import Population, batch, certainty
from .verdict import share_limits

if TYPE_CHECKING:
    import pandas


#: Most earthquakes of one kind after another.
LONGEST = 200

#: Fewest counts of whose median an interval can be told: of five it lies outside all of them one time in sixteen.
FEWEST = 6


@dataclass(frozen=True)
class Count:
    """Number of earthquakes until a structure falls, over several runs or records: their median and its interval.

    A number above ``most`` says that it had not fallen by then: more than ``most``.

    Parameters
    ----------
    low, high : tuple of int
        For each, the number with which it fell; where its last state is undecided, from which to which.
    most : int
        Earthquakes that were run.
    failed : int
        Runs without a verdict, which are left out.
    """

    low: tuple[int, ...]
    high: tuple[int, ...]
    most: int
    failed: int = 0

    @classmethod
    def of_rows(cls, rows: Sequence[Mapping[str, Any] | None], spans: Sequence[Span]) -> Count:
        """From rows of runs (``Measures.row()``)."""
        most, low, high, failed = len(spans), [], [], 0
        for row in rows:
            verdict = v.verdict(row)
            if row is None or verdict == v.FAILED:
                failed += 1
                continue
            fell = (number_at(spans, row["collapse_time_s"]) or most) if verdict == v.COLLAPSED else None
            low.append(fell or (most if verdict == v.UNDECIDED else most + 1))
            high.append(fell or most + 1)
        return cls(tuple(low), tuple(high), most, failed)

    @property
    def median(self) -> tuple[int, int] | None:
        """Number by which half of them have fallen, from which to which; None without a run that has a verdict."""
        middle = (len(self.low) - 1) // 2
        return (sorted(self.low)[middle], sorted(self.high)[middle]) if self.low else None

    @property
    def interval(self) -> tuple[int, int] | None:
        """95 % confidence limits of the median, from the order of the counts alone; None of fewer than six."""
        from scipy.stats import binom

        count = len(self.low)
        if count < FEWEST:
            return None
        outside = int(binom.ppf(0.025, count, 0.5))  # so many of the smallest, and of the largest, are left out
        outside -= int(binom.cdf(outside, count, 0.5) > 0.025)
        return sorted(self.low)[outside], sorted(self.high)[count - 1 - outside]

    def words(self, low: int, high: int) -> str:
        """A number for people, or from which to which."""
        more = say("more than {most}", most=self.most)
        low_, *rest = dict.fromkeys(more if number > self.most else str(number) for number in (low, high))
        return say("{low} to {high}", low=low_, high=rest[0]) if rest else low_

    @property
    def sentence(self) -> str:
        """The median with its interval, for people."""
        if self.median is None:
            return say("none of {count} could be computed", count=self.failed)
        text = self.words(*self.median)
        if len(self.low) > 1:
            limits = self.interval
            known = {"count": len(self.low), "median": text, "limits": limits and self.words(*limits), "fewest": FEWEST}
            none = say("median of {count}: {median} (no interval of fewer than {fewest})")
            text = (say("median of {count}: {median} (95 %: {limits})") if limits else none).of(**known)
        return joined("; ", [text, say("{count} more failed", count=self.failed) if self.failed else ""])

    def summary(self) -> dict[str, Any]:
        """Plain values; None for more than ``most``."""

        def known(pair: tuple[int, int] | None) -> list[int | None]:
            return [None, None] if pair is None else [None if number > self.most else number for number in pair]

        median, limits = known(self.median), known(self.interval)
        return {
            "median_low": median[0], "median_high": median[1],
            "interval_low": limits[0], "interval_high": limits[1], "interval_known": self.interval is not None,
            "counts": [None if number > self.most else number for number in self.low], "most": self.most,
            "runs": len(self.low), "not_fallen": sum(number > self.most for number in self.high), "failed": self.failed,
            "sentence": self.sentence,
        }  # fmt: skip


@dataclass(frozen=True, eq=False)
class SequenceResult(NotebookSummary):
    """A structure under earthquakes one after another.

    Parameters
    ----------
    response : Response
        Of the whole sequence, one run.
    motion : Motion
        The sequence as one motion.
    population : Population or None
        Columns like this one under the same sequence.
    wall_time : float
        [s]
    """

    response: Response
    motion: Motion
    population: Population | None
    wall_time: float

    @cached_property
    def events(self) -> tuple[Event, ...]:
        """The earthquakes in their order, up to the one with which the run ended."""
        return events_of(self.response, spans_of(self.motion))

    @property
    def fell_in(self) -> int | None:
        """Number of the earthquake in which it fell, from 1; None where it stands."""
        return number_at(spans_of(self.motion), self.response.collapse_time) if self.response.collapsed else None

    @property
    def falls(self) -> Count | None:
        """In which earthquake those like it fall; None without any."""
        return None if self.population is None else Count.of_rows(self.population.rows, spans_of(self.motion))

    @property
    def _laws(self) -> tuple[int, ...]:
        """Law of the joints of each of those like it that has a verdict; empty where all are of one."""
        if self.population is None:
            return ()
        pairs = zip(self.population.rows, self.population.drawn.groups)
        return tuple(law for row, law in pairs if v.verdict(row) != v.FAILED)

    @property
    def table(self) -> pandas.DataFrame:
        """One row per earthquake; with replicates, the share of them that has fallen by then."""
        import pandas

        table = pandas.DataFrame([event.row() for event in self.events])
        falls = self.falls
        if falls is not None and falls.low and len(table):
            numbers = table["earthquake"].to_numpy()[:, None]
            fell, stood = np.array(falls.high) <= numbers, np.array(falls.low) > numbers
            verdicts = np.select([fell, stood], [v.COLLAPSED, v.STANDS], v.UNDECIDED)
            low, high = share_limits(verdicts, self._laws)
            share = v.share_collapsed(*v.tally(verdicts, axis=1))
            table = table.assign(fallen_share=share, fallen_share_low=low, fallen_share_high=high)
        return table

    @property
    def sentence(self) -> str:
        """What happened, in one to three sentences."""
        spans, fell = spans_of(self.motion), self.fell_in
        if not self.events:
            return self.response.sentence
        if fell is not None:
            known = {
                "which": fell,
                "all": len(spans),
                "motion": spans[fell - 1].motion,
                "many": len(self.response.fallen),
            }
            words = say("It falls in earthquake {which} of {all} ({motion}).")
            if self.response.measures.blocks is not None:
                single = say("1 body falls in earthquake {which} of {all} ({motion}).")
                several = say("{many} bodies fall, the first of them in earthquake {which} of {all} ({motion}).")
                words = single if known["many"] == 1 else several
            sentences = [words.of(**known)]
            if len(self.events) < len(spans):
                sentences.append(
                    say("The run ends there: {count} more would have come.", count=len(spans) - len(self.events))
                )
            return joined(" ", sentences)
        after = say("After 1 earthquake: {text}") if len(spans) == 1 else say("After {count} earthquakes: {text}")
        return after.of(count=len(spans), text=self.response.sentence)

    @property
    def unsettled(self) -> tuple[int, ...]:
        """Earthquakes after which something still moved when the next one began."""
        return tuple(event.number for event in self.events[:-1] if not event.at_rest)

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate sequence``: that of the whole run, and each earthquake."""
        own = self.response.summary()
        summary = own | {} if self.population is None else own | self.population.summary(own)
        return summary | {
            "sentence": self.sentence,
            "earthquakes": len(spans_of(self.motion)),
            "fell_in": self.fell_in,
            "unsettled_after": list(self.unsettled),
            "falls": None if self.falls is None else self.falls.summary(),
            "events": [event.summary() for event in self.events],
        }


def sequence(
    structure: Structure,
    motions: Motion | Sequence[Motion],
    model: Model,
    *,
    rest: float = REST,
    repeat: int = 1,
    output_interval: float = 0.01,
    until_end: bool = False,
    campaign: Campaign | None = None,
    **settings: Any,
) -> SequenceResult:
    """Shake a structure with earthquakes one after another; each begins as the one before has left it.

    It is one run of all of them with quiet ground between: poses, velocities, what contacts remember, broken links and what
    has fallen are never handed over, because the run never stops.

    Parameters
    ----------
    structure : Column or Assembly
    motions : sequence of Motion
        In this order; scale them before, such as ``[main, main.scaled(0.6)]``.
    model : Model
    rest : float
        Quiet ground after each of them [s].
    repeat : int
        How often all of them come.
    output_interval : float
        Time between recorded states [s], of which the peaks of each earthquake are told.
    until_end : bool
        Go on after the collapse of a column, where the model does.
    campaign, **settings : Campaign, optional

    Raises
    ------
    InputError
        The input cannot be used.
    """
    campaign = Campaign.of("sequence", campaign, settings, ("tail",))
    began = time.perf_counter()
    check_kind("structure", structure, Structure)
    check_kind("model", model, Model)
    if structure.stack is None and structure.slenderness is not None:
        raise InputError(
            f"sequences are for columns and assemblies, and {structure.name!r} is {structure.described}; simulate it "
            "under `motion.in_sequence(...)`."
        )
    motions = check_all("motions", motions, Motion)
    if len({tuple(motion.components) for motion in motions}) > 1:
        motions = [model.taken(motion) for motion in motions]
    whole = in_sequence(motions, rest, repeat)
    options: dict[str, Any] = {"output_interval": output_interval, "until_end": until_end}
    options["quiet"] = campaign.quiet
    if not campaign.replicates:
        response = simulate(structure, whole, model, progress=campaign.progress, **options)
        return SequenceResult(response, whole, None, time.perf_counter() - began)
    result = certainty(structure.stack or structure, whole, model, campaign=replace(campaign, whole=False), **options)
    return SequenceResult(result.response, whole, result.population, time.perf_counter() - began)


@dataclass(frozen=True, eq=False)
class UntilFall(NotebookSummary):
    """How many earthquakes of a kind, one after another, a structure stands.

    Parameters
    ----------
    names : tuple of str
        Of the motions.
    each : tuple of Count
        Of each motion, over the columns like this one, or of the column alone.
    wall_time : float
        [s]
    """

    names: tuple[str, ...]
    each: tuple[Count, ...]
    wall_time: float

    @property
    def over_motions(self) -> Count:
        """Over the motions, each of which counts once by its median."""
        medians = [count.median for count in self.each if count.median is not None]
        low, high = zip(*medians, strict=True) if medians else ((), ())
        return Count(tuple(low), tuple(high), self.each[0].most, len(self.each) - len(medians))

    @property
    def table(self) -> pandas.DataFrame:
        """One row per motion."""
        import pandas

        rows = []
        for name, count in zip(self.names, self.each, strict=True):
            summary = count.summary()
            rows.append({"motion": name, "earthquakes": count.sentence.split("; ")[0]} | {
                key: summary[key] for key in ("median_low", "median_high", "interval_low", "interval_high", "runs",
                                           "not_fallen", "failed", "most")})  # fmt: skip
        return pandas.DataFrame(rows)

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate sequence --until-fall``."""
        each = [{"motion": name, **count.summary()} for name, count in zip(self.names, self.each, strict=True)]
        return {"until_fall": self.over_motions.summary(), "motions": each, "wall_s": self.wall_time}


def earthquakes_until_fall(
    structure: Structure,
    motions: Motion | Sequence[Motion],
    model: Model,
    most: int = 20,
    *,
    rest: float = REST,
    campaign: Campaign | None = None,
    **settings: Any,
) -> UntilFall:
    """Count how many earthquakes like each of these a structure takes until it falls, each motion coming again and again.

    Parameters
    ----------
    structure : Column or Assembly
    motions : sequence of Motion
    model : Model
    most : int
        Earthquakes after which a run ends; what stands then takes more than that.
    rest : float
        Quiet ground after each of them [s].
    campaign, **settings : Campaign, optional
        With replicates, of columns like this one; over them and over motions the median is told with its interval.

    Raises
    ------
    InputError
        The input cannot be used.
    """
    campaign = Campaign.of("earthquakes_until_fall", campaign, settings, ("tail",))
    began = time.perf_counter()
    check_kind("structure", structure, Structure)
    check_kind("model", model, Model)
    check_whole("most", most, 1, LONGEST)
    structure = structure.stack or structure
    kinds = check_all("motions", motions, Motion)
    if not kinds:
        raise InputError("no motion is given; give at least one.", "motions")
    long = [in_sequence([kind], rest, most) for kind in kinds]
    stands = the_twins(structure, model, campaign, laws=False).columns if campaign.replicates else [structure]
    rows: list[dict] = []
    for motion in long:
        cases = [Case(stone_column, motion) for stone_column in stands]
        options = replace(campaign.options, quiet=share_of(motion, campaign.whole))
        rows += batch(cases, structure, model, campaign, options)
    each = [
        Count.of_rows(rows[k * len(stands) : (k + 1) * len(stands)], spans_of(motion)) for k, motion in enumerate(long)
    ]
    return UntilFall(tuple(kind.name for kind in kinds), tuple(each), time.perf_counter() - began)
