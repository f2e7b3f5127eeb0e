"""Words on the amplitudes of a column: the lowest collapse, and no factor that is none.

From the JSON object of ``stylobate critical``, so that the command and the report of its folder say the same.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ..messages import joined, say
from . import verdicts as v
from .population import CHANCE, chance_words

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
    words = [_with_twins(s, kind, like, twins) if twins else "", _alone(s, kind, twins), _open(s, twins)]
    return joined(" ", [*words, "" if twins else one_alone(like)])


def sentence_of_suite(s: Mapping[str, Any], kind: str = "column", like: str = "columns") -> str:
    """Results of several motions over one grid of peaks; ``s`` as of :func:`sentence`, for several motions."""
    rows, worst, twins = s["records"], s["worst"], s["certainty"]
    records, or_like = len({row["record"] for row in rows}), say(" or one like it") if twins else ""
    alone, several = say("record"), say("records")
    if records != len(rows):
        of = say(" of {count} records") if records > 1 else say(" of {count} record")
        alone, several = (one + of.of(count=records) for one in (say("motion"), say("motions")))
    grid = say("{low:g} to {high:g} g", low=s["amplitudes_g"][0], high=s["amplitudes_g"][-1])
    known = {
        "the": THE.get(kind, kind),
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
        each = say("{the} or one of {count} like it", the=THE.get(kind, kind), count=number)
        return _none(s, each, s["open_below"])
    shares = [(share, _by(twins, f"critical_{share}_g")) for share in (16, 50, 84)]
    said = joined(", ", (say("{share} % {by}", share=share, by=by) for share, by in shares if by))
    words = say("Of {all} {like}, this one and {count} like it, the first falls {where}", all=number + 1, like=say(like),
                count=number, where=_at(s, lowest, s["amplitudes_g"]))  # fmt: skip
    words += say("; of those like it fall {shares}", shares=said) if said else ""
    words += say(", whichever way the undecided end") if said and twins.get(v.UNDECIDED) else ""
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


def _alone(s: Mapping[str, Any], kind: str, twins: Mapping[str, Any] | None) -> str:
    """At which amplitudes the column itself falls, and at which larger ones it stands again."""
    first, stretches = s["critical_g"], s["alternation"]
    without = [stretch for stretch in stretches if stretch["verdict"] not in (v.STANDS, v.COLLAPSED)]
    before = sum(one["runs"] for one in without if first is None or one["to_g"] < first)
    if first is None:
        if not twins:
            return _none(s, THE.get(kind, kind), before)
        return "" if s["lowest_collapse_g"] is None else _none(s, say("this one"), before)
    after = [stretch for stretch in stretches if stretch["from_g"] > first and stretch["verdict"] != v.COLLAPSED]
    there = twins and first == s["lowest_collapse_g"]
    who = say("This one collapses {where}") if twins else say("{the:capital} collapses {where}")
    words = say("This one falls there") if there else who.of(the=THE.get(kind, kind), where=_at(s, first))
    if again := [one for one in after if one["verdict"] == v.STANDS]:
        said = joined(", ", (_stretch(one) for one in again[:MOST]))
        said += say(" and {count} times more", count=len(again) - MOST) if len(again) > MOST else ""
        words += say(", but stands again at {again}: no single amplitude is its limit", again=said)
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
    found = [
        (s, v.UNDECIDED, say("{some} of {all} runs ended far from rest ({cure})")),
        (s, v.FAILED, say("{some} of {all} runs failed")),
        (twins or {}, v.UNDECIDED, say("{some} runs of those like it ended far from rest ({cure})")),
        (twins or {}, v.FAILED, say("{some} runs of those like it failed")),
    ]
    alone = {2: say("1 run of those like it ended far from rest ({cure})"), 3: say("1 run of those like it failed")}
    said = [
        (alone[k] if told[name] == 1 and k in alone else words).of(some=told[name], all=s["runs"], cure=cure)
        for k, (told, name, words) in enumerate(found)
        if told.get(name)
    ]
    return say("{runs}: not counted as collapse.", runs=joined("; ", said)) if said else ""


def _at(s: Mapping[str, Any], amplitude: float, of_twins: Sequence[float] = ()) -> str:
    """An amplitude, its factor of the record where there is one, and the next smaller one that was looked at.

    Columns alike went through fewer amplitudes; where ``of_twins`` has these, theirs is told as well.
    """
    words = say("at {at:.4g} g", at=amplitude)
    if s["lowest_collapse_factor"] is not None:
        factor = s["lowest_collapse_factor"] / s["lowest_collapse_g"] * amplitude
        words += say(", {factor:.3g} times the record", factor=factor)
    looked_at = [one[end] for one in s["alternation"] for end in ("from_g", "to_g")]
    own, theirs = (max((one for one in some if one < amplitude), default=None) for some in (looked_at, of_twins))
    own = own if amplitude == s["critical_g"] else theirs
    if own is None:
        return say("already {where}, the lowest amplitude looked at", where=words)
    next_ = say(" (the next below that was looked at is {own:.4g} g)", own=own)
    if theirs is not None and theirs < own:
        next_ = say(" (the next below that was looked at is {own:.4g} g, for those like it {theirs:.4g} g)")
        next_ = next_.of(own=own, theirs=theirs)
    return words + next_


def _stretch(one: Mapping[str, Any]) -> str:
    alike = f"{one['from_g']:.4g}" == f"{one['to_g']:.4g}"
    return say("{s[from_g]:.4g} g", s=one) if alike else say("{s[from_g]:.4g} to {s[to_g]:.4g} g", s=one)


def _range(s: Mapping[str, Any]) -> str:
    return say("{low:.4g} to {high:.4g} g", low=s["alternation"][0]["from_g"], high=_last(s))


def _last(s: Mapping[str, Any]) -> float:
    return s["alternation"][-1]["to_g"]
