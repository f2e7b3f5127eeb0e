"""What amplitudes that were looked at say of a column, in words: the lowest collapse, and no factor that is none.

From the JSON object of ``stylobate critical``, so that the command and the report of its folder say the same.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from . import verdicts as v

#: Most stretches of amplitudes that are named.
MOST = 4

#: That one column says little, and what asks columns like it.
ONE_ALONE = (
    "Near its boundary a column answers to small differences; one alone says little: --replicates 15 asks 15 like it."
)


def sentence(s: Mapping[str, Any], kind: str = "column") -> str:
    """What one motion does over its amplitudes.

    Parameters
    ----------
    s : mapping
        The JSON object of ``stylobate critical`` for one motion.
    kind : str
        What stands: column, assembly.
    """
    twins = s.get("certainty")
    words = [*([_with_twins(s, kind, twins)] if twins else []), _alone(s, kind, twins), _open(s, twins)]
    words.append(ONE_ALONE if not twins and kind == "column" else "")
    return " ".join(filter(None, words))


def sentence_of_suite(s: Mapping[str, Any], kind: str = "column") -> str:
    """What several motions do over one grid of peaks; ``s`` as of :func:`sentence`, for several motions."""
    rows, worst = s["records"], s["worst"]
    twins = any("critical_50_g" in one for one in rows)
    low, high = s["amplitudes_g"][0], s["amplitudes_g"][-1]
    if worst is None:
        words = f"No record collapses the {kind} at a peak looked at, {low:g} to {high:g} g."
    else:
        fell = [sum(one.get(name) is not None for one in rows) for name in ("critical_g", "lowest_collapse_g")]
        factor, amplitude = worst.get("lowest_collapse_factor"), worst.get("lowest_collapse_g")
        if factor is None or amplitude is None:  # of a folder that does not hold them yet
            factor, amplitude = worst["critical_factor"], worst["critical_g"]
        words = (
            f"{fell[0]} of {len(rows)} records collapse the {kind} at some peak looked at, {low:g} to {high:g} g"
            + (f", {fell[1]} it or one like it" if twins else "")
            + f". Most harm: {worst['record']}, which collapses {'it or one like it' if twins else 'it'} at {factor:.3g} "
            f"times the record, {amplitude:.4g} g, the smallest factor at which any does."
        )
    return words if twins or kind != "column" else f"{words} {ONE_ALONE}"


def _with_twins(s: Mapping[str, Any], kind: str, twins: Mapping[str, Any]) -> str:
    """The lowest collapse of the column and those like it, and by which amplitude shares of these have fallen."""
    number, lowest = s["replicates"], lowest_collapse(s)
    if lowest is None:
        return f"No amplitude looked at, {_range(s)}, collapses the {kind} or one of {number} like it; larger ones were not."
    words = f"Of {number + 1} {kind}s, this one and {number} like it, the first falls {_at(s, lowest)}"
    shares = [(share, _by(twins, f"critical_{share}_g")) for share in (16, 50, 84)]
    said = ", ".join(f"{share} % {by}" for share, by in shares if by)
    return f"{words}; of those like it fall {said}." if said else f"{words}."


def _by(twins: Mapping[str, Any], name: str) -> str:
    value, bound = twins.get(name), twins.get("bounds", {}).get(name, "")
    if bound.startswith("≤"):
        return f"at {bound[2:]} g or below"
    if bound.startswith(">"):
        return f"only above {bound[2:]} g"
    return f"by {value:.4g} g" if value is not None and math.isfinite(value) else ""


def _alone(s: Mapping[str, Any], kind: str, twins: Mapping[str, Any] | None) -> str:
    """At which amplitudes the column itself falls, and at which larger ones it stands again."""
    first = s.get("first_collapse_g", s.get("critical_g"))
    if first is None:
        if twins:
            return "" if lowest_collapse(s) is None else "This one falls at none of them."
        return f"No amplitude looked at, {_range(s)}, collapses the {kind}; larger ones were not looked at."
    stretches = s.get("alternation") or []
    before = [one for one in stretches if one["to_g"] < first and one["verdict"] != v.STANDS]
    after = [one for one in stretches if one["from_g"] > first and one["verdict"] != v.COLLAPSED]
    there = twins and first == lowest_collapse(s)
    words = "This one falls there" if there else f"{'This one' if twins else f'The {kind}'} collapses {_at(s, first)}"
    if again := [one for one in after if one["verdict"] == v.STANDS]:
        said = ", ".join(_stretch(one) for one in again[:MOST])
        said += f" and {len(again) - MOST} times more" if len(again) > MOST else ""
        words += f", but stands again at {said}: no single amplitude is its limit"
    elif after:
        words += ", and not surely at all larger ones"
    elif first < stretches[-1]["to_g"]:
        words += f", and at all larger ones up to {_last(s):.4g} g"
    if before:
        words += f"; runs below that without a verdict, which may be collapses: {sum(one['runs'] for one in before)}"
    return words + "."


def _open(s: Mapping[str, Any], twins: Mapping[str, Any] | None) -> str:
    """Runs without a verdict."""
    found = []
    for told, total, whose in ((s, s["runs"], ""), (twins or {}, None, " of those like it")):
        for name, meaning in (
            (v.UNDECIDED, "ended far from rest (a longer --tail decides them)"),
            (v.FAILED, "failed"),
        ):
            if count := told.get(name):
                of = f"{count} of {total} runs" if total else f"{count} runs{whose}"
                found.append(f"{of} {meaning}")
    return f"{'; '.join(found)}: not counted as collapse." if found else ""


def lowest_collapse(s: Mapping[str, Any]) -> float | None:
    """The smallest amplitude that collapses the column or one like it [g]; None where none does."""
    found = [s.get("first_collapse_g", s.get("critical_g"))]
    shares = zip(s.get("amplitudes_g", ()), s.get("collapse_probability", ()), strict=True)
    found += [amplitude for amplitude, share in shares if share is not None and share > 0.0]
    return min((one for one in found if one is not None), default=None)


def _at(s: Mapping[str, Any], amplitude: float) -> str:
    """An amplitude, its factor of the record where there is one, and the next smaller one that was looked at."""
    times = None
    if s.get("factors"):
        times = s["factors"][0] / s["amplitudes_g"][0]
    elif s.get("critical_factor") is not None:
        times = s["critical_factor"] / s["critical_g"]
    words = f"at {amplitude:.4g} g" + (f", {times * amplitude:.3g} times the record" if times else "")
    own = amplitude == s.get("first_collapse_g", s.get("critical_g"))  # those like it went through fewer amplitudes
    looked_at = [one[end] for one in s["alternation"] for end in ("from_g", "to_g")] if own else s["amplitudes_g"]
    if below := max((one for one in looked_at if one < amplitude), default=None):
        return f"{words} (the next below that was looked at is {below:.4g} g)"
    return f"already {words}, the lowest amplitude looked at"


def _stretch(one: Mapping[str, Any]) -> str:
    low, high = f"{one['from_g']:.4g}", f"{one['to_g']:.4g}"
    return f"{low} g" if low == high else f"{low} to {high} g"


def _range(s: Mapping[str, Any]) -> str:
    return f"{s['alternation'][0]['from_g']:.4g} to {_last(s):.4g} g"


def _last(s: Mapping[str, Any]) -> float:
    return s["alternation"][-1]["to_g"]
