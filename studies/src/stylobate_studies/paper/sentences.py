"""A sentence of the paper and what it comes to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

HOLDS, PARTLY, FAILS, UNDECIDED, DONE = "holds", "holds in part", "does not hold", "undecided", "done here"

#: Meanings of the verdicts, for the page and the documentation.
MEANINGS = {
    HOLDS: "our value meets the criterion that the row states, with the choices of this study where the paper is silent",
    PARTLY: "it does so for some value of a parameter that the paper leaves open, for one of the two columns, or by some "
    "of several tests, or with a slip of print put right; the verdict names them",
    FAILS: "it does so for none of them",
    UNDECIDED: "the interval of what is computed here holds both answers, too few records are behind it, or "
    "nothing that was "
    "measured decides it",
    DONE: "the paper draws or announces it; it is computed or drawn here, and nothing is printed that could be compared",
}


#: So many choices at most are named one by one in a verdict.
NAMED = 4


class Verdict(NamedTuple):
    """What a sentence comes to: a key of :data:`MEANINGS`, and for which part it holds where it does so in part."""

    kind: str
    part: str = ""

    def __str__(self) -> str:
        return f"{self.kind}: {self.part}" if self.part else self.kind


@dataclass(frozen=True)
class Statement:
    """One checkable sentence.

    Parameters
    ----------
    section : str
        Where the paper says it: section and paragraph, the text behind an equation counted as one, equation and figure; or
        another source.
    sentence : str
        What it says, in our words.
    ours : str
        What is computed here.
    verdict : Verdict
    why : str
    sensitivity : str
        How far open parameters move it.
    """

    section: str
    sentence: str
    ours: str
    verdict: Verdict
    why: str
    sensitivity: str = ""


def judged(holds: bool, otherwise: Mapping[str, bool] | None = None) -> Verdict:
    """The verdict: the criterion itself, or what else that is open meets it, by name."""
    met = [name for name, value in (otherwise or {}).items() if value]
    if holds or not met:
        return Verdict(HOLDS if holds else FAILS)
    other = [name for name, value in (otherwise or {}).items() if not value]
    named = "; ".join(met)
    if len(met) + len(other) > NAMED:
        few, sign = (other, "not ") if len(other) < len(met) else (met, "")
        named = "; ".join(sign + name for name in few[:NAMED]) + (" and others" if len(few) > NAMED else "")
        return Verdict(PARTLY, f"{len(met)} of {len(met) + len(other)}, {named}")
    return Verdict(PARTLY, "; ".join((named, *(f"not {name}" for name in other))))
