"""A run of an assembly in words: what fell, in which order and to which side, what is shifted, which joints opened most."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..messages import joined, say
from ..outcome import Outcome

if TYPE_CHECKING:
    from .recorded import Recorded

#: A body slower than this lies, or rocks where it is [m/s].
SLOW = 0.05

#: Most names that a sentence tells.
MOST_NAMES = 6


def sentence_of_blocks(response: Recorded) -> str:
    """Outcome of a run of an assembly, and its mechanism, in one to four sentences."""
    m, blocks = response.measures, response.measures.blocks
    assert blocks is not None
    moving = [i for i, held in enumerate(response.bodies.fixed) if not held]
    if response.outcome is Outcome.FAILED:
        failed = say("The computation could not be completed; this is no verdict on the assembly.")
        return joined(" ", [failed, say("Reason: {reason}.", reason=m.reason) if m.reason else ""])
    if response.outcome is Outcome.COLLAPSED:
        order = [name for name, _ in blocks.fell_at]
        said = say("{fallen} of {all} blocks fell, the first at {time:.2f} s: {names}.", fallen=len(order),
                   all=len(moving), time=m.collapse_time, names=_names(order))  # fmt: skip
        words = [said, _first(response) + _widest(response) + "."]
        if blocks.displaced:
            words.append(say("Shifted, but standing: {names}.", names=_names(blocks.displaced)))
        if len(order) < len(moving) and not blocks.at_rest:
            words.append(say("Not all is at rest at the end: what has not fallen by then may yet fall."))
        return joined(" ", [*words, _moving(response)])
    in_place = {1: say("The block is in place"), 2: say("Both blocks are in place")}.get(
        len(moving), say("All {count} blocks are in place", count=len(moving))
    )
    in_place = in_place if response.decided else say("Nothing has fallen so far")
    if response.outcome is Outcome.AT_REST:
        return say("{in_place}: no joint opened.", in_place=in_place)
    if response.outcome is Outcome.ROCKED:
        closed = say("{in_place}: joints opened and closed, none is shifted", in_place=in_place)
        return closed + _widest(response) + "."
    gone = response.displacement[-1]
    far = max(moving, key=lambda i: gone[i])
    words = [in_place, say(", but shifted") if response.decided else say("; out of place at the end")]
    words.append(say(": {body} by {far}", body=response.bodies.names[far], far=_length(float(gone[far]))))
    words += [say(", the others by less") * (len(moving) > 1), _widest(response), "."]
    return joined(" ", [joined("", words), _moving(response)])


def _moving(response: Recorded) -> str:
    """What rolls on after a wait for rest, in a sentence; empty where nothing does."""
    moving = moving_at_end(response) if response.provenance.get("until_rest") else {}
    fast = _names(say("{name} ({speed:.2g} m/s)", name=name, speed=speed) for name, speed in moving.items())
    still = say("Still moving at the end: {names}.", names=fast)
    return joined(" ", [still, say("How far they come is not computed: nothing here resists rolling.")]) * bool(moving)


def moving_at_end(response: Recorded) -> dict[str, float]:
    """Speed of what moves on where the run ends, by name [m/s]: what it has moved by then is no residual."""
    if response.histories.velocity is None or response.outcome is Outcome.FAILED:
        return {}
    speeds = np.linalg.norm(response.histories.velocity[-1], axis=-1).tolist()
    return {name: speed for name, speed in zip(response.bodies.names, speeds, strict=True) if speed > SLOW}


def mechanism_of(response: Recorded) -> dict[str, Any]:
    """The same as plain values: which fell first and to which side, which joint opened and which slid most."""
    m, blocks = response.measures, response.measures.blocks
    assert blocks is not None
    azimuth = None if m.collapse is None or m.collapse.azimuth is None else math.degrees(m.collapse.azimuth)
    return {
        "first": blocks.fell_at[0][0] if blocks.fell_at and m.collapsed else None,
        "azimuth_deg": azimuth,
        "opened_most": _joint_told(response, "opening"),
        "slid_most": _joint_told(response, "slip"),
        "sentence": sentence_of_blocks(response),
    }


def _first(response: Recorded) -> str:
    """Which fell first, and to which side."""
    m, blocks = response.measures, response.measures.blocks
    assert blocks is not None
    name, collapse = blocks.fell_at[0][0], m.collapse
    if collapse is None or collapse.azimuth is None:
        return say("First fell {body}, straight down", body=name)
    if response.dims == "xz":
        left = collapse.side == "left"
        return (
            say("First fell {body}, to the left", body=name)
            if left
            else say("First fell {body}, to the right", body=name)
        )
    towards = round(math.degrees(collapse.azimuth)) % 360
    return say("First fell {body}, towards azimuth {azimuth}° (from x towards y)", body=name, azimuth=towards)


def _widest(response: Recorded) -> str:
    """The joints that opened and slid most, in a clause; empty where none did."""
    opened, slid = (_joint_told(response, what) for what in ("opening", "slip"))
    words = []
    if opened is not None:
        words.append(say("the joint of {one} and {other} opened most, by {far}", **_joint(opened, "opening_m")))
    if slid is not None and opened is not None and slid["joint"] == opened["joint"]:
        words.append(say("it slid most, by {far}", far=_length(slid["slip_m"])))
    elif slid is not None:
        words.append(say("the joint of {one} and {other} slid most, by {far}", **_joint(slid, "slip_m")))
    then = say("; until then ") if response.collapsed else "; "
    return then + joined(say(", and "), words) if words else ""


def _joint(told: dict[str, Any], far: str) -> dict[str, Any]:
    """Values of a sentence on a joint: the bodies that it joins, and how far it went."""
    return {"one": told["between"][0], "other": told["between"][1], "far": _length(told[far])}


def _joint_told(response: Recorded, what: str) -> dict[str, Any] | None:
    """The joint with the largest opening or slip: until the first block fell, of slips at the end where none did.

    None where there is no joint, or none that did.
    """
    structure, h, m = response.structure, response.histories, response.measures
    joints = structure.joined_faces
    until = h.time <= m.collapse_time if m.collapsed else np.ones(len(h.time), dtype=bool)
    slip = np.linalg.norm(h.slip[until], axis=-1)
    values = h.opening[until].max(axis=0) if what == "opening" else slip.max(axis=0) if m.collapsed else slip[-1]
    if not len(joints) or not np.nanmax(values, initial=0.0) > 0.0:
        return None
    k = int(np.nanargmax(values))
    names = [structure.bodies[joints[k].lower].name, structure.bodies[joints[k].upper].name]
    return {"joint": k + 1, "between": names, f"{what}_m": float(values[k])}


def _names(names: Any) -> str:
    """Names, the first of many."""
    told = list(names)
    more = len(told) - MOST_NAMES
    return joined(", ", told[:MOST_NAMES]) + (say(" and {count} more", count=more) if more > 0 else "")


def _length(value: float) -> str:
    return say("{value:.2f} m", value=value) if value >= 1.0 else say("{value:.3g} mm", value=1000.0 * value)
