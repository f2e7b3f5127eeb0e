"""A response in words: what happened in a sentence, and what was run in a line."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..constants import LONGEST_WAIT, g
from ..messages import joined, say
from ..outcome import Outcome
from .links import sentence_of as sentence_of_links

if TYPE_CHECKING:
    from ..column.structure import Structure
    from .recorded import Recorded


#: A body slower than this lies, or rocks where it is [m/s].
SLOW = 0.05

#: Most names that a sentence tells.
MOST_NAMES = 6


def sentence_of_blocks(response: Recorded) -> str:
    """Outcome of a run of an assembly, and its mechanism, in one to four sentences."""
    m, blocks = response.measures, response.measures.blocks
    assert blocks is not None
    moving = [i for i, fixed in enumerate(response.bodies.fixed) if not fixed]
    if response.outcome is Outcome.FAILED:
        failed = say("The computation could not be completed; this is no verdict on the assembly.")
        return joined(" ", [failed, say("Reason: {reason}.", reason=m.reason) if m.reason else ""])
    if response.outcome is Outcome.COLLAPSED:
        order = [name for name, _ in blocks.fell_at]
        sentence = say("{fallen} of {all} blocks fell, the first at {time:.2f} s: {names}.", fallen=len(order),
                   all=len(moving), time=m.collapse_time, names=_names(order))  # fmt: skip
        words = [sentence, _first(response) + _widest(response) + "."]
        if blocks.displaced:
            words.append(say("Shifted, but standing: {names}.", names=_names(blocks.displaced)))
        if len(order) < len(moving) and not blocks.at_rest:
            words.append(say("Not all is at rest at the end: what has not fallen by then may yet fall."))
        return joined(" ", [*words, _moving(response)])
    stand = {1: say("The block stands"), 2: say("Both blocks stand")}.get(
        len(moving), say("All {count} blocks stand", count=len(moving))
    )
    stand = stand if response.decided else say("Nothing has fallen so far")
    if response.outcome is Outcome.AT_REST:
        return say("{stand}: no joint opened.", stand=stand)
    if response.outcome is Outcome.ROCKED:
        closed = say("{stand}: joints opened and closed, none is shifted", stand=stand)
        return closed + _widest(response) + "."
    gone = response.displacement[-1]
    far = max(moving, key=lambda i: gone[i])
    words = [stand, say(", but shifted") if response.decided else say("; out of place at the end")]
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
        "opened_most": _joint_facts(response, "opening"),
        "slid_most": _joint_facts(response, "slip"),
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
    opened, slid = (_joint_facts(response, what) for what in ("opening", "slip"))
    words = []
    if opened is not None:
        words.append(say("the joint of {one} and {other} opened most, by {far}", **_joint(opened, "opening_m")))
    if slid is not None and opened is not None and slid["joint"] == opened["joint"]:
        words.append(say("it slid most, by {far}", far=_length(slid["slip_m"])))
    elif slid is not None:
        words.append(say("the joint of {one} and {other} slid most, by {far}", **_joint(slid, "slip_m")))
    then = say("; until then ") if response.collapsed else "; "
    return then + joined(say(", and "), words) if words else ""


def _joint(joint: dict[str, Any], far: str) -> dict[str, Any]:
    """Values of a sentence on a joint: the bodies that it joins, and how far it went."""
    return {"one": joint["between"][0], "other": joint["between"][1], "far": _length(joint[far])}


def _joint_facts(response: Recorded, what: str) -> dict[str, Any] | None:
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
    all_names = list(names)
    more = len(all_names) - MOST_NAMES
    return joined(", ", all_names[:MOST_NAMES]) + (say(" and {count} more", count=more) if more > 0 else "")


def _length(value: float) -> str:
    return say("{value:.2f} m", value=value) if value >= 1.0 else say("{value:.3g} mm", value=1000.0 * value)


def title_of(response: Recorded) -> str:
    """Structure, motion, model and outcome in one line."""
    undecided = "" if response.decided else ", undecided"
    motion = response.provenance.get("motion", "motion")
    outcome = response.outcome.label.replace("_", " ")
    return f"{response.structure.name}, {motion}, {response.model}: {outcome}{undecided}"


def sentence_of(response: Recorded) -> str:
    """Outcome, in one to three sentences."""
    m = response.measures
    links = sentence_of_links(m.links)
    if m.blocks is not None:
        return joined(" ", [sentence_of_blocks(response), links if m.outcome is not Outcome.FAILED else ""])
    if m.collapsed:
        return joined(" ", [_of_collapse(response), links])
    words = [m.outcome.sentence_of(len(response.bodies.names)), links]
    if m.reason:
        words.append(say("Reason: {reason}.", reason=m.reason))
    if not m.decided and m.outcome is not Outcome.FAILED:
        words.append(_undecided(response))
    return joined(" ", words)


#: Damping of a run in space, by the names of the parameters, and the value with which there is none.
UNDAMPED = {
    "losses": "none",
    "stiffness_damping": 0.0,
    "mass_damping": 0.0,
    "restitution": 1.0,
    "rolling_resistance": 0.0,
}

#: Tilt beyond which a column wobbles, as a share of its slenderness [-].
WOBBLES = 0.02


#: Share of a joint's width beyond which its toe is wider than that of any stiff joint of stone [-].
WIDE_TOE = 0.05


def opening_words(opens: Mapping[str, float] | None) -> str:
    """What rocks a column statically, beside that on rigid joints, and whether its toe is wide; empty if unknown."""
    if opens is None:
        return ""
    soft, rigid, toe = opens["acceleration"] / g, opens["rigid"] / g, 100.0 * opens["toe"]
    words = say("{soft:.4g} g; on rigid joints {rigid:.4g} g", soft=soft, rigid=rigid)
    if opens["toe"] <= WIDE_TOE:
        return words
    return words + say(". Its toe reaches {share:.2g} % of the width in: is normal_stiffness in N/m³?", share=toe)


#: What stands before all that rests on wobbles without damping.
UNDAMPED_WOBBLE = say(
    "Wobbling was not damped, and in space a verdict can hang on that, either way: see how many of a population "
    "fall with a stiffness damping of 1e-4 s, and of 1e-3 s, or with losses = stone (2 to 35 times the computing "
    "time), before relying on it."
)

#: What stands before all that rests on round columns in the plane; of several drums they leave it by themselves.
ROUND_IN_THE_PLANE = say(
    "Round columns, computed in the plane: in space they can fall under much weaker motions, those of several drums "
    "under one component too; compute them in space (dem3d) before relying on it."
)


def round_in_the_plane(structure: Structure) -> str:
    """What stands before a favourable verdict of a model in the plane on what stands; empty where nothing does."""
    return ROUND_IN_THE_PLANE if structure.section == "circular" else ""


#: What stands beside whatever rests on assemblies in space whose bodies struck one another.
STRUCK_IN_SPACE = say(
    "Assemblies in space are new: where bodies strike one another the outcome depends on how stiff a base is "
    "beside the contact, and a fall is one draw of many; near the limit repeat with half the step and twice the "
    "stiffness."
)


def struck_in_space(structure: Structure) -> str:
    """What stands beside runs of what stands, if it is an assembly in space; empty if not."""
    return "" if structure.space_joints is None else STRUCK_IN_SPACE


def wobble_in_space(structure: Structure, parameters: Mapping[str, Any]) -> str:
    """What stands beside runs of what stands in a model in space with these parameters, if nothing damps its wobble.

    Of assemblies round joints wobble; a restitution is that of bodies that no joint holds, and damps none of them.
    """
    if structure.space_joints is None:
        return UNDAMPED_WOBBLE if structure.slenderness is not None and undamped(parameters) else ""
    round_ = any(joint.round for joint in structure.space_joints)
    return UNDAMPED_WOBBLE if round_ and not parameters.get("stiffness_damping") else ""


def cautions_in_space(structures: Sequence[Structure], parameters: Mapping[str, Any]) -> list[str]:
    """All that stands beside runs of what stands in a model in space with these parameters, each once."""
    struck = map(struck_in_space, structures)
    wobble = (wobble_in_space(structure, parameters) for structure in structures)
    return list(dict.fromkeys(filter(None, (*struck, *wobble))))


def each_doubt(doubts: Iterable[str]) -> list[str]:
    """Doubts of several runs, each once; what a longer one says as well is left out."""
    unique = list(dict.fromkeys(filter(None, doubts)))
    return [doubt for doubt in unique if not any(doubt != other and doubt in other for other in unique)]


def doubt_of(response: Recorded) -> str:
    """Why a verdict may be another one in space; empty where there is no reason.

    Of an assembly in space, if the verdict hangs on bodies that struck one another, or if round joints opened undamped.

    In a plane, round drums that stand although joints opened: their own wobble is left out. In space, what nobody has
    measured: without damping a column on rims wobbles long, and how many of a population fall differs several times with
    and without a little of it, in either direction.
    """
    known, space = response.provenance.get("parameters", {}), response.measures.space
    slenderness = response.structure.slenderness
    if space is None:
        blocks = response.measures.blocks
        if blocks is not None and response.structure.space_joints is not None:
            if response.outcome is Outcome.FAILED:
                return ""
            struck = struck_in_space(response.structure) if blocks.hangs_on_strikes else ""
            opened = response.outcome is not Outcome.AT_REST
            return joined(" ", [struck, wobble_in_space(response.structure, known) if opened else ""])
        several = len(response.bodies.names) > 1 and response.outcome in (Outcome.ROCKED, Outcome.DISPLACED)
        return round_in_the_plane(response.structure) if several else ""
    wobbled = slenderness is not None and space.peak_tilt > WOBBLES * slenderness
    return UNDAMPED_WOBBLE if wobbled and undamped(known) else ""


def undamped(parameters: Mapping[str, Any]) -> bool:
    """Whether a model in space with these parameters takes no energy from the wobble of what it computes."""
    if "stiffness_damping" not in parameters or parameters.get("planar"):
        return False
    return all(parameters.get(name) in (None, none) for name, none in UNDAMPED.items())


def longer_tail(given: float) -> str:
    """The tail that follows a run which ended before its verdict was certain longer than it was.

    Parameters
    ----------
    given : float
        How long it went on after the motion [s].
    """
    return say("a tail of {tail:g} s", tail=max(SHORTEST_TAIL, 2.0 * given))


#: The least time after a motion in which a run may become certain [s].
SHORTEST_TAIL = 5.0


def to_decide(structure: Structure, parameters: Mapping[str, Any], tail: float, waited: bool = True) -> str:
    """What decides a run that ended before its verdict was certain, in a clause.

    Parameters
    ----------
    structure : Structure
    parameters : mapping
        Of the model.
    tail : float
        That was given [s].
    waited : bool
        Whether it went on after it for its verdict, as runs of campaigns do (``until_decided``).
    """
    if structure.stack is None and structure.slenderness is None:
        damp = say("damp it (stiffness_damping)")
        return damp if waited else say("follow it with `until_rest`, or {damp}", damp=damp)
    free = parameters.get("pivot_friction", 1.0) < 1.0 and not parameters.get("planar")
    moved = any(drum.offset or drum.tilt or drum.chipped for drum in structure.as_found.drums)
    if free and moved and structure.section == "circular":
        return say(
            "no tail decides it, as drums that pivot freely turn with their offsets, slopes and chips at no cost"
        )
    steps = "stiffness_damping" in parameters  # only what steps drums waits
    if waited and structure.section == "circular" and not parameters.get("planar", True) and undamped(parameters):
        return say("no tail decides it, as nothing damps its wobble: damp it as stone (losses = stone)")
    return say("go on with {tail}", tail=longer_tail(tail + LONGEST_WAIT * (waited and steps)))


def _undecided(response: Recorded) -> str:
    """That a run ended before its verdict was certain, and what to do.

    Of a column whose links pulled from the start, what they and the joints that they press hold counts against it.
    """
    known = response.provenance
    waited = bool(known.get("until_decided"))
    cure = to_decide(response.structure, known.get("parameters", {}), float(known.get("tail_s", 0.0)), waited)
    if response.structure.pretensioned:
        return say(
            "The verdict may still change: at the end it is not at rest ({cure}), or it is, and what its "
            "pretension holds could overturn it if it came free, which no tail decides.",
            cure=cure,
        )
    return say("The verdict may still change: at the end it is far from rest; {cure}.", cure=cure)


def describe(response: Recorded) -> str:
    """One paragraph: what stood, what was run, what happened, and the measures."""
    m, structure = response.measures, response.structure
    n = len(response.bodies.names)
    size = f"{n} {structure.counted[n > 1]}"
    motion = response.provenance.get("motion", "a motion")
    end = float(response.time[-1]) if len(response.time) else 0.0
    until = " before the fall" if m.collapsed else ""
    top = "" if m.blocks else f"peak top displacement{until} {length(m.peak_top_displacement)}, "
    words = [
        f"<Response of {structure.name} ({size}) under {motion}, {response.model}, {end:.4g} s.",
        f"{sentence_of(response)} {doubt_of(response)}".rstrip(),
        f"{top[:1].upper() + top[1:]}{'p' if top else 'P'}eak rotation{until} {m.peak_rotation:.4g} rad;"
        f" energy imbalance {m.energy_imbalance:.1e}; {len(response.time)} recorded states in {response.dims}.>",
    ]
    return " ".join(words)


def length(value: float) -> str:
    """A length for people: in m, or in mm below a metre."""
    return say("{value:.3g} mm", value=1000.0 * value) if abs(value) < 1.0 else say("{value:.2f} m", value=value)


def _of_collapse(response: Recorded) -> str:
    m, mechanism = response.measures, response.mechanism
    words = [m.outcome.sentence_of(len(response.bodies.names))]
    if m.reason:
        words.append(say("Reason: {reason}.", reason=m.reason))
    if mechanism is not None:
        words.append(say("That was certain at {time:.2f} s.", time=m.collapse_time))
    if m.collapse is not None and (touched := m.collapse.touched) is not None and touched.bodies is not None:
        words.append(say("First to touch were {t.bodies[0]} and {t.bodies[1]}, at {t.time:.2f} s.", t=touched))
    if mechanism is not None:
        words.append(mechanism.describe())
    return joined(" ", words)
