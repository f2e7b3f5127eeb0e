"""Difference of a state of a column from another under the same motions, and the advice that follows, in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..column.structure import Structure
from ..messages import joined, say
from ..models.base import Model
from ..percent import whole
from ..response.words import ROUND_IN_THE_PLANE, cautions_in_space, round_in_the_plane
from .fragility_checks import FEWEST

#: Kinds of difference.
STRONGER, WEAKER, NOT_TOLD = "stronger", "weaker", "not told"

#: Sentence where there is nothing to compare.
NO_PAIR = say("no pair of runs could be computed")

#: States that are no measure: nobody can adopt them.
NO_MEASURE = ("as built", "as found")


#: What stands before any advice on measures for round columns that were computed in a plane, however many the records.
NO_MEASURE_YET = say(
    ", and what helps here need not help there. No measure is to be adopted before a model in space (dem3d) has told "
    "the same"
)


def caveat(columns: Sequence[Structure], *models: Model) -> str:
    """Caveats before many runs of these columns, or of assemblies, each once; empty where no model gives reason for any.

    In a plane, columns of several round drums leave it by themselves; in space, bodies that strike one another hang on how
    stiff they are, and the wobble of what is round may be damped by nothing.
    """
    return joined(" ", dict.fromkeys(caution for model in models for caution in _cautions(columns, model)))


def _cautions(columns: Sequence[Structure], model: Model) -> list[str]:
    known = model.parameters()
    if not model.is_plane(known):
        return cautions_in_space(columns, known)
    stacks = (column for column in columns if column.stack is not None and column.stack.n > 1)
    return list(filter(None, map(round_in_the_plane, stacks)))[:1]


def doubt(labels: Sequence[str], columns: Sequence[Structure], model: Model) -> str:
    """Caveat before any advice on these states, because of the model; empty where nothing does."""
    if not model.is_plane(model.parameters()):
        return caveat(columns, model)
    if all(column.section != "circular" for column in columns):
        return ""
    return ROUND_IN_THE_PLANE + NO_MEASURE_YET * any(label not in NO_MEASURE for label in labels) + "."


def reference(labels: Sequence[str], label: str) -> str:
    """The state that another one is compared with: a measure with the column as it stands today, all else with the first.

    The column as it stands today is as found, or else as built; where there is none of the two, the first of all.
    """
    today = [one for one in NO_MEASURE if one in labels]
    return today[-1] if today and label not in NO_MEASURE else labels[0]


@dataclass(frozen=True)
class Difference:
    """Difference of a state from another one, the same records, levels and twins against one another.

    Intervals hold what is undecided: their one end is that of the case in which every undecided run ends in favour of this
    state and against the other, their other end that of the opposite.

    Parameters
    ----------
    state, against : str
        Labels.
    pairs : int
        Pairs of runs that both have a verdict.
    saved, harmed : int
        Pairs in which only the other state exceeds the limit state, and only this one.
    share, share_low, share_high : float
        Share of the pairs that exceed it, less that of the other state, and its interval over records [-].
    ratio, ratio_low, ratio_high : float
        Median capacity over that of the other state, from the runs that both know, and its interval over records [-]; NaN
        where a curve is missing, 0 and infinite where no limit is known.
    undecided, failed : int
        Pairs of which a run has no verdict, and of which a run could not be computed.
    records : int
        That the pairs are of.
    share_best, share_worst, ratio_best, ratio_worst : float
        Share and ratio of all pairs that could be computed, if every undecided run ends in favour of this state, and
        against it [-]; share and ratio themselves where all is decided.
    limit_state, im : str
        As typed; the measure is empty where the levels are of none.
    confidence : float
        Of the intervals.
    stone : str
        What limits the links of this state instead of them, in words.
    lacking : str
        What the runs lack for a comparison of medians; empty where they lack nothing, or a state has no curve.
    """

    state: str
    against: str
    pairs: int
    saved: int
    harmed: int
    share: float
    share_low: float
    share_high: float
    ratio: float
    ratio_low: float
    ratio_high: float
    undecided: int = 0
    failed: int = 0
    records: int = 0
    share_best: float = math.nan
    share_worst: float = math.nan
    ratio_best: float = math.nan
    ratio_worst: float = math.nan
    limit_state: str = "collapse"
    im: str = ""
    confidence: float = 0.95
    stone: str = ""
    lacking: str = ""

    @property
    def conclusion(self) -> str:
        """Stronger or weaker than the other state beyond the chance of these records, or not told.

        Of fewer records than a fragility takes nothing is concluded. Any sure sign of harm makes a state weaker; where share
        and median contradict one another, nothing is told.
        """
        if self.records < FEWEST:
            return NOT_TOLD
        fewer, more = self.share_high < 0.0, self.share_low > 0.0
        higher, lower = self.ratio_low > 1.0, self.ratio_high < 1.0
        if more or lower:
            return NOT_TOLD if fewer or higher else WEAKER
        return STRONGER if fewer and not self.ratio < 1.0 else NOT_TOLD

    @property
    def sentence(self) -> str:
        """The advice, and what it rests on."""
        return joined(" ", [self.advice, self.basis])

    @property
    def basis(self) -> str:
        """Basis of the advice: median, pairs and share, with their intervals."""
        return joined(" ", [self._median(), self._pairs(), self._share()])

    @property
    def advice(self) -> str:
        """Advice, in one sentence that can be read in one way only, and what to mind beside it."""
        return joined(" ", [self._advice, self.stone])

    @property
    def _advice(self) -> str:
        known = {
            "state": self.state,
            "against": say("than “{name}” against {state}", name=self.against, state=say(self.limit_state)),
        }
        measure = self.state not in NO_MEASURE
        if self.conclusion == STRONGER:
            return say("“{state}”: stronger {against}, under these motions.", **known)
        if self.conclusion == WEAKER:
            never = say("“{state}”: weaker {against}: do not adopt it for safety.", **known)
            return never if measure else say("“{state}”: weaker {against}.", **known)
        words: list[str] = [say("it fares better in {saved} of {number} and worse in {harmed}").of(
            saved=self.saved, number=self._number, harmed=self.harmed)]  # fmt: skip
        if self.records < FEWEST:
            words.append(say("nothing is concluded from fewer than {fewest} records", fewest=FEWEST))
        if self.undecided:
            alone = self.undecided == 1
            said = (
                say("{open} of {all} pairs of runs is undecided")
                if alone
                else say("{open} of {all} pairs of runs are undecided")
            )
            later = say(", and longer runs may settle them") if self.records >= FEWEST else ""
            words.append(said.of(open=self.undecided, all=self.pairs + self.undecided) + later)
        here = joined("; ", words) if self.pairs + self.undecided else NO_PAIR
        if measure:
            no = say(
                "“{state}”: not shown to be stronger {against}, nor weaker: no ground to adopt it for safety ({here})."
            )
            return no.of(here=here, **known)
        return say("“{state}”: not shown to be weaker or stronger {against} ({here}).", here=here, **known)

    @property
    def _number(self) -> str:
        """Number of pairs of runs, and of their records: the runs of one record are no independent evidence."""
        pairs = self.pairs + self.undecided
        runs = say("{count} pair of runs", count=1) if pairs == 1 else say("{count} pairs of runs", count=pairs)
        if self.records == 1:
            return say("{pairs} under 1 record", pairs=runs)
        return say("{pairs} under {count} records", pairs=runs, count=self.records)

    def _median(self) -> str:
        if math.isnan(self.ratio):
            return say("Medians are not compared: {lacking}.", lacking=self.lacking) if self.lacking else ""
        low, high = sorted((self.ratio_best - 1.0, self.ratio_worst - 1.0))
        measure = f" ({self.im})" if self.im else ""
        change = self._change((low, high), (self.ratio_low - 1.0, self.ratio_high - 1.0), _percent)
        words = say("The median intensity of {state}{measure} is {change}.")
        return words.of(state=say(self.limit_state), measure=measure, change=change)

    def _pairs(self) -> str:
        if not self.pairs + self.undecided:
            return say("{none:capital}.", none=NO_PAIR)
        how = say("collapse") if self.limit_state == "collapse" else say("exceed {state}", state=self.limit_state)
        said = say("Of {number}, {saved} {how} with “{against}” only and {harmed} with “{state}” only").of(
            number=self._number, saved=self.saved, how=how, against=self.against, harmed=self.harmed, state=self.state
        )
        if self.undecided:
            open_ = say("; {count} is undecided") if self.undecided == 1 else say("; {count} are undecided")
            said += open_.of(count=self.undecided)
        return said + (say("; {count} more could not be computed.", count=self.failed) if self.failed else ".")

    def _share(self) -> str:
        if not self.pairs + self.undecided:
            return ""
        change = self._change((self.share_best, self.share_worst), (self.share_low, self.share_high), _points)
        if self.limit_state == "collapse":
            return say("The share that collapses is {change}.", change=change)
        return say("The share that exceeds {state} is {change}.", state=self.limit_state, change=change)

    def _change(
        self, of_these: tuple[float, float], of_others: tuple[float, float], words: Callable[[float, bool], str]
    ) -> str:
        """The interval over records, which decides, and what these records alone show."""
        here = say("{here} in these records", here=_span(*of_these, words))
        if self.records < FEWEST or math.isnan(of_others[0]) or math.isnan(of_others[1]):
            return here + (say(", whichever way the undecided end") if self.undecided else "")
        both = say(", undecided runs counted both ways") if self.undecided else ""
        said = say("{span} ({level:g} % interval over records{both}; {here})")
        return said.of(span=_span(*of_others, words), level=100.0 * self.confidence, both=both, here=here)


def _percent(value: float, direction: bool = True) -> str:
    """A change of a ratio by its size, and its direction where that is asked for."""
    size = whole(abs(value))
    if size == "0":
        return say("the same")
    if not direction:
        return size
    return say("{size} % higher", size=size) if value > 0.0 else say("{size} % lower", size=size)


def _points(value: float, direction: bool = True) -> str:
    """A change of a share by its size, and its direction where that is asked for."""
    size = whole(abs(value))
    if size == "0":
        return say("the same")
    if not direction:
        return size
    if size in ("1", "<1"):
        alone = say("{size} percentage point higher") if value > 0.0 else say("{size} percentage point lower")
        return alone.of(size=size)
    return (say("{size} percentage points higher") if value > 0.0 else say("{size} percentage points lower")).of(
        size=size
    )


def _span(low: float, high: float, words: Callable[[float, bool], str]) -> str:
    """From which to which change; a lower end of −1 of a ratio and an infinite upper one are no limits."""
    if math.isinf(high) and low <= -1.0:
        return say("not known")
    if math.isinf(high):
        return (say("at least {low}") if low > 0.0 else say("{low} or any more")).of(low=words(low, True))
    below, above = words(low, True), words(high, True)
    if below == above:
        return below
    changes = whole(abs(low)) != "0" and whole(abs(high)) != "0"
    if low > 0.0 and high > 0.0 and changes:
        below = words(low, False)
    if low < 0.0 and high < 0.0 and changes:
        below, above = words(high, False), below
    return say("{low} to {high}", low=below, high=above)
