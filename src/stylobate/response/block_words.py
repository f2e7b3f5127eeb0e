"""A run of an assembly in words: what fell, in which order and to which side, what is shifted, which joints opened most."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

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
        why = f" Reason: {m.reason}." if m.reason else ""
        return f"The computation could not be completed; this is no verdict on the assembly.{why}"
    if response.outcome is Outcome.COLLAPSED:
        order = [name for name, _ in blocks.fell_at]
        said = f"{len(order)} of {len(moving)} blocks fell, the first at {m.collapse_time:.2f} s: {_names(order)}."
        words = [said, f"{_first(response)}{_widest(response)}."]
        if blocks.displaced:
            words.append(f"Shifted, but standing: {_names(blocks.displaced)}.")
        if len(order) < len(moving) and not blocks.at_rest:
            words.append("Not all is at rest at the end: what has not fallen by then may yet fall.")
        return " ".join(words) + _moving(response)
    all_of_them = {1: "The block is", 2: "Both blocks are"}.get(len(moving), f"All {len(moving)} blocks are")
    in_place = f"{all_of_them} in place" if response.decided else "Nothing has fallen so far"
    if response.outcome is Outcome.AT_REST:
        return f"{in_place}: no joint opened."
    if response.outcome is Outcome.ROCKED:
        return f"{in_place}: joints opened and closed, none is shifted{_widest(response)}."
    gone = response.displacement[-1]
    far = max(moving, key=lambda i: gone[i])
    others = ", the others by less" if len(moving) > 1 else ""
    shifted = f"{response.bodies.names[far]} by {_length(float(gone[far]))}{others}"
    where = ", but shifted" if response.decided else "; out of place at the end"
    return f"{in_place}{where}: {shifted}{_widest(response)}.{_moving(response)}"


def _moving(response: Recorded) -> str:
    """What rolls on after a wait for rest, in a sentence; empty where nothing does."""
    moving = moving_at_end(response) if response.provenance.get("until_rest") else {}
    fast = _names(f"{name} ({speed:.2g} m/s)" for name, speed in moving.items())
    words = f" Still moving at the end: {fast}. How far they come is not computed: nothing here resists rolling."
    return words if moving else ""


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
        return f"First fell {name}, straight down"
    if response.dims == "xz":
        return f"First fell {name}, to the {collapse.side}"
    return f"First fell {name}, towards azimuth {round(math.degrees(collapse.azimuth)) % 360}° (from x towards y)"


def _widest(response: Recorded) -> str:
    """The joints that opened and slid most, in a clause; empty where none did."""
    opened, slid = (_joint_told(response, what) for what in ("opening", "slip"))
    words = []
    if opened is not None:
        words.append(f"{_joint(opened)} opened most, by {_length(opened['opening_m'])}")
    if slid is not None:
        same = opened is not None and slid["joint"] == opened["joint"]
        words.append(f"{'it' if same else _joint(slid)} slid most, by {_length(slid['slip_m'])}")
    then = "until then " if response.collapsed else ""
    return f"; {then}{', and '.join(words)}" if words else ""


def _joint(told: dict[str, Any]) -> str:
    return f"the joint of {told['between'][0]} and {told['between'][1]}"


def _joint_told(response: Recorded, what: str) -> dict[str, Any] | None:
    """The joint with the largest opening or slip: until the first block fell, of slips at the end where none did.

    None where there is no joint, or none that did.
    """
    structure, h, m = response.structure, response.histories, response.measures
    joints = structure.face_pairs if structure.space_joints is None else structure.space_joints
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
    return ", ".join(told[:MOST_NAMES]) + (f" and {len(told) - MOST_NAMES} more" if len(told) > MOST_NAMES else "")


def _length(value: float) -> str:
    return f"{value:.2f} m" if value >= 1.0 else f"{1000.0 * value:.3g} mm"
