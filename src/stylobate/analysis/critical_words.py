"""Words on the amplitudes of a column: the lowest collapse, and no factor that is none.

From the JSON object of ``stylobate critical``, so that the command and the report of its folder say the same.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from . import verdicts as v
from .population import CHANCE, chance_words

#: Most stretches of amplitudes that are named.
MOST = 4


def one_alone(like: str) -> str:
    """That one of some columns says little, and what asks others like it; empty where there are none like it."""
    if not like:
        return ""
    return (
        f"Near the boundary small differences decide, and one alone says little: with 15 replicates, 15 {like} like it "
        "run as well."
    )


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
    words.append("" if twins else one_alone(like))
    return " ".join(filter(None, words))


def sentence_of_suite(s: Mapping[str, Any], kind: str = "column", like: str = "columns") -> str:
    """Results of several motions over one grid of peaks; ``s`` as of :func:`sentence`, for several motions."""
    rows, worst, twins = s["records"], s["worst"], s["certainty"]
    records, or_like = len({row["record"] for row in rows}), " or one like it" if twins else ""
    what, of = ("record", "") if records == len(rows) else ("motion", f" of {records} record{'s' * (records > 1)}")
    grid = f"{s['amplitudes_g'][0]:g} to {s['amplitudes_g'][-1]:g} g"
    if worst is None:
        surely = "surely " * bool(s["open_below"])
        words = f"No {what}{of} {surely}collapses the {kind}{or_like} at a peak looked at, {grid}."
    else:
        fell = [sum(row[name] is not None for row in rows) for name in ("critical_g", "lowest_collapse_g")]
        already = "already " * ("lowest_collapse_g" in worst["bounds"])
        words = (
            f"{fell[0]} of {len(rows)} {what}s{of} collapse the {kind} at some peak looked at, {grid}"
            + (f", {fell[1]} it or one like it" if twins else "")
            + f". Most harm: {worst['motion']}, which collapses it{or_like} {already}at "
            f"{worst['lowest_collapse_factor']:.3g} times the record, {worst['lowest_collapse_g']:.4g} g, the smallest "
            f"factor at which any {'surely ' * bool(s['open_below'])}does."
        )
    below = "" if worst is None else _below(s["open_below"], " that factor")
    return " ".join(filter(None, (words, below, _open(s, twins), "" if twins else one_alone(like))))


def as_recorded(own: Mapping[str, Any]) -> str:
    """Effect of the record as it is, on the structure and on those like it.

    Parameters
    ----------
    own : mapping
        ``as_recorded`` of the JSON object of ``stylobate critical``.
    """
    likes = chance_words(own)
    words = f"{own['amplitude_g']:.4g} g: {own['verdict']}"
    return f"{words}; {CHANCE}: {likes}" if likes else words


def _with_twins(s: Mapping[str, Any], kind: str, like: str, twins: Mapping[str, Any]) -> str:
    """The lowest collapse of the column and those like it, and by which amplitude shares of these have fallen."""
    number, lowest = s["replicates"], s["lowest_collapse_g"]
    if lowest is None:
        return _none(s, f"the {kind} or one of {number} like it", s["open_below"])
    words = (
        f"Of {number + 1} {like}, this one and {number} like it, the first falls {_at(s, lowest, s['amplitudes_g'])}"
    )
    below = _below(s["open_below"])
    shares = [(share, _by(twins, f"critical_{share}_g")) for share in (16, 50, 84)]
    said = ", ".join(f"{share} % {by}" for share, by in shares if by)
    open_ = ", whichever way the undecided end" if twins.get(v.UNDECIDED) else ""
    return f"{words}{f'; of those like it fall {said}{open_}' if said else ''}. {below}".rstrip()


def _by(twins: Mapping[str, Any], name: str) -> str:
    value, bound = twins.get(name), twins.get("bounds", {}).get(name, "")
    if bound.startswith("≤"):
        return f"at {bound[2:]} g or below"
    if bound.startswith(">"):
        return f"only above {bound[2:]} g"
    if value is None or not math.isfinite(value):
        return ""
    least = twins.get(name.replace("_g", "_least_g"), value)
    return f"by {value:.4g} g" if least >= value else f"by {least:.4g} to {value:.4g} g"


def _alone(s: Mapping[str, Any], kind: str, twins: Mapping[str, Any] | None) -> str:
    """At which amplitudes the column itself falls, and at which larger ones it stands again."""
    first, stretches = s["critical_g"], s["alternation"]
    without = [stretch for stretch in stretches if stretch["verdict"] not in (v.STANDS, v.COLLAPSED)]
    before = sum(one["runs"] for one in without if first is None or one["to_g"] < first)
    if first is None:
        if not twins:
            return _none(s, f"the {kind}", before)
        return "" if s["lowest_collapse_g"] is None else _none(s, "this one", before)
    after = [stretch for stretch in stretches if stretch["from_g"] > first and stretch["verdict"] != v.COLLAPSED]
    there = twins and first == s["lowest_collapse_g"]
    words = "This one falls there" if there else f"{'This one' if twins else f'The {kind}'} collapses {_at(s, first)}"
    if again := [one for one in after if one["verdict"] == v.STANDS]:
        said = ", ".join(_stretch(one) for one in again[:MOST])
        said += f" and {len(again) - MOST} times more" if len(again) > MOST else ""
        words += f", but stands again at {said}: no single amplitude is its limit"
    elif after:
        words += ", and not surely at all larger ones"
    elif first < stretches[-1]["to_g"]:
        words += f", and at all larger ones up to {_last(s):.4g} g"
    return f"{words}. {'' if there else _below(before)}".rstrip()


def _none(s: Mapping[str, Any], whom: str, without_verdict: int) -> str:
    surely = "surely " if without_verdict else ""
    return f"No amplitude looked at, {_range(s)}, {surely}collapses {whom}; larger ones were not looked at."


def _below(without_verdict: int, what: str = " that") -> str:
    return f"Runs below{what} without a verdict, which may be collapses: {without_verdict}." if without_verdict else ""


def _open(s: Mapping[str, Any], twins: Mapping[str, Any] | None) -> str:
    """Runs without a verdict."""
    found = []
    for told, total, whose in ((s, s["runs"], ""), (twins or {}, None, " of those like it")):
        for name, meaning in (
            (v.UNDECIDED, f"ended far from rest ({s.get('to_decide') or 'a longer tail may decide them'})"),
            (v.FAILED, "failed"),
        ):
            if count := told.get(name):
                of = f"{count} of {total} runs" if total else f"{count} run{'s' * (count > 1)}{whose}"
                found.append(f"{of} {meaning}")
    return f"{'; '.join(found)}: not counted as collapse." if found else ""


def _at(s: Mapping[str, Any], amplitude: float, of_twins: Sequence[float] = ()) -> str:
    """An amplitude, its factor of the record where there is one, and the next smaller one that was looked at.

    Columns alike went through fewer amplitudes; where ``of_twins`` has these, theirs is told as well.
    """
    words = f"at {amplitude:.4g} g"
    if s["lowest_collapse_factor"] is not None:
        words += f", {s['lowest_collapse_factor'] / s['lowest_collapse_g'] * amplitude:.3g} times the record"
    looked_at = [one[end] for one in s["alternation"] for end in ("from_g", "to_g")]
    own, theirs = (max((one for one in some if one < amplitude), default=None) for some in (looked_at, of_twins))
    own = own if amplitude == s["critical_g"] else theirs
    if own is None:
        return f"already {words}, the lowest amplitude looked at"
    also = f", for those like it {theirs:.4g} g" if theirs is not None and theirs < own else ""
    return f"{words} (the next below that was looked at is {own:.4g} g{also})"


def _stretch(one: Mapping[str, Any]) -> str:
    low, high = f"{one['from_g']:.4g}", f"{one['to_g']:.4g}"
    return f"{low} g" if low == high else f"{low} to {high} g"


def _range(s: Mapping[str, Any]) -> str:
    return f"{s['alternation'][0]['from_g']:.4g} to {_last(s):.4g} g"


def _last(s: Mapping[str, Any]) -> float:
    return s["alternation"][-1]["to_g"]
