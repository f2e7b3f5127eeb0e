"""Measures of a run of an assembly: opening and slip of its joints, what fell and when, and the outcome."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..column.assembly import Assembly, Block, FaceJoint, separation
from ..column.structure import Structure
from ..outcome import SHIFT_RATIO, classify
from .collapse import FELL, Collapse, Touch
from .histories import Histories
from .links import LinkHistories
from .measures import BlockMeasures, BodyMeasures, Measures
from .poses import quaternions
from .recorded import Recorded
from .residuals import Residuals, turned_up

#: A body that fell with its centroid nearly over its place, to this share of its size, fell to no side.
STRAIGHT_DOWN = 0.01


def body_measures(
    names: Sequence[str],
    sizes: Sequence[float],
    time: np.ndarray,
    position: np.ndarray,
    tilt: np.ndarray,
    since: dict[int, int],
    shifted: Iterable[int],
) -> tuple[BodyMeasures, ...]:
    """Measures of the bodies that can move.

    Parameters
    ----------
    names, sizes
        Of all bodies; the size of one that cannot move is NaN [m].
    time : array
        [s], shape (T,)
    position, tilt : array
        Centroids [m], shape (T, N, 3), and turns since the start of what was vertical [rad], shape (T, N).
    since : dict of int to int
        Recorded state from which on a body had fallen, by its number.
    shifted : iterable of int
        Bodies that are shifted at the end, by their numbers; none where not all lies still then.
    """
    measures, out_of_place = [], set(shifted)
    for i, (name, size) in enumerate(zip(names, sizes, strict=True)):
        if math.isnan(size):
            continue
        fell, azimuth = since.get(i), None
        if fell is not None:
            x, y = (position[fell, i] - position[0, i])[:2]
            azimuth = math.atan2(y, x) if math.hypot(x, y) > STRAIGHT_DOWN * size else None
        x, y, z = (float(component) for component in position[-1, i] - position[0, i])
        measures.append(
            BodyMeasures(
                name,
                float(np.nanmax(tilt[:, i], initial=0.0)),
                None if fell is None else float(time[fell]),
                azimuth,
                (x, y, z),
                fell is None and i in out_of_place,
            )
        )
    return tuple(measures)


def azimuth_of_fall(bodies: Iterable[BodyMeasures], fell_at: Sequence[tuple[str, float]]) -> float | None:
    """Side to which the first body fell [rad]; None where none fell, or straight down."""
    first = next((name for name, _ in fell_at), None)
    return next((body.fall_azimuth for body in bodies if body.name == first), None)


def shifted_bodies(
    joints: Sequence[tuple[int, int]], slip: np.ndarray, moved: np.ndarray, free: Sequence[int], free_shares: np.ndarray
) -> set[int]:
    """Bodies that are shifted: by a joint the one of its two bodies that moved more, and what no joint holds by itself.

    Parameters
    ----------
    joints : sequence of (int, int)
        Bodies of each joint.
    slip : array
        Residual slip of each joint over its width [-], shape (J,).
    moved : array
        Of each body at the end [m], shape (N,).
    free : sequence of int
        Bodies that no joint holds.
    free_shares : array
        Their way at the end over their size [-].
    """
    by_joints = {
        max(pair, key=lambda i: moved[i]) for pair, share in zip(joints, slip, strict=True) if not share <= SHIFT_RATIO
    }
    return by_joints | {i for i, share in zip(free, free_shares, strict=True) if not share <= SHIFT_RATIO}


#: A block has fallen when its centroid is lower than at the start by this share of the smallest side of its box …
DROP = 0.5

#: … or when it has turned by more than this [rad].
TURNED = 0.25 * np.pi

#: Bodies can have touched since the last recorded state if their boxes are this close, as a share of the smallest body.
NEAR = 0.5


def recorded_blocks(
    assembly: Assembly,
    time: np.ndarray,
    x: np.ndarray,
    z: np.ndarray,
    rotation: np.ndarray,
    energy: dict[str, np.ndarray],
    ground_acceleration: np.ndarray,
    ground_displacement: np.ndarray,
    *,
    failed: bool,
    model: str,
    provenance: dict[str, Any],
    touched: Touch | None = None,
    link_histories: LinkHistories | None = None,
    velocity: np.ndarray | None = None,
    **ended: Any,
) -> Recorded:
    """A run of an assembly from the recorded poses of its bodies.

    Parameters
    ----------
    assembly : Assembly
    time : array
        [s], shape (T,)
    x, z, rotation : array
        Poses of ``assembly.bodies`` [m], [rad], shape (T, N).
    energy : dict of str to array
        Ledger [J], each term of shape (T,).
    ground_acceleration, ground_displacement : array
        [m/s²], [m], shape (T,) or (T, 3)
    failed : bool
        Whether the computation could not go on, or its energy is out of balance.
    model : str
    provenance : dict
    touched : Touch, optional
    link_histories : LinkHistories, optional
        Histories of the links that act.
    velocity : array, optional
        Along x and z [m/s] and of the rotation [rad/s], shape (T, N, 3).
    **ended
        How the run began and ended: see :func:`measures_of_bodies`.
    """
    opening, slip = joint_histories(assembly, x, z, rotation)
    moved = np.hypot(x - x[0], z - z[0])
    turned = np.abs(rotation - rotation[0])
    since = {} if failed else fallen_since(have_fallen(lowest_standing(assembly, z[0]), z, turned))
    free = [not body.fixed for body in assembly.bodies]
    ways = (history[-1, free] - history[0, free] for history in (x, z, rotation))
    measures = measures_of_bodies(
        assembly, time, np.stack((x, np.zeros_like(x), z), axis=-1), moved, turned, since, opening, np.abs(slip[-1]),
        failed=failed, touched=touched, residuals=Residuals.in_plane(slip[-1], *ways), **ended,
    )  # fmt: skip
    histories = Histories.of_blocks(
        time, x, z, rotation, opening, slip, ground_acceleration, ground_displacement, energy, velocity
    )
    if link_histories is not None:
        histories = replace(histories, links=link_histories)
    return Recorded(assembly, histories, measures, model, provenance, followed=True)


def measures_of_bodies(
    structure: Structure,
    time: np.ndarray,
    position: np.ndarray,
    moved: np.ndarray,
    tilt: np.ndarray,
    since: dict[int, int],
    opening: np.ndarray,
    slip: np.ndarray,
    *,
    at_rest: bool,
    failed: bool,
    in_equilibrium: bool | None,
    touched: Touch | None,
    residuals: Residuals,
    **numbers: Any,
) -> Measures:
    """Measures of a run of any assembly, in the plane or in space, from what became of its bodies and joints.

    Parameters
    ----------
    structure : Structure
    time : array
        [s], shape (T,)
    position, moved, tilt : array
        Centroids [m], shape (T, N, 3), their distance from the start [m] and the turn of what was vertical [rad],
        shape (T, N).
    since : dict of int to int
        Recorded state from which on a body had fallen, by its number, in the order of falling; empty where the run failed.
    opening, slip : array
        Of each joint over time [m], shape (T, J), and at the end [m], shape (J,).
    at_rest, failed : bool
        Whether everything lies still at the end; whether the run has no verdict.
    in_equilibrium : bool or None
        As drawn; None if it is not known.
    touched : Touch or None
        First touch of bodies that no joint holds.
    residuals : Residuals
    **numbers
        Fields of the measures that hang on the computation: ``energy_imbalance``, ``time_step``, ``steps``, ``links`` …
    """
    bodies, (joined, width) = structure.bodies, joined_bodies(structure)
    joined_numbers = {i for pair in joined for i in pair}
    free = [i for i, body in enumerate(bodies) if i not in joined_numbers and not body.fixed]
    size = np.array([bodies[i].size for i in free])
    opened = max(_largest(opening / width), _largest(moved[:, free] / size))
    shares, free_shares = slip / width, moved[-1, free] / size
    stands = at_rest and not failed  # what still moves may yet fall
    shifted = shifted_bodies(joined, shares, moved[-1], free, free_shares) if stands else ()
    names = [body.name for body in bodies]
    sizes = [math.nan if body.fixed else body.size for body in bodies]
    each = body_measures(names, sizes, time, position, tilt, since, shifted)
    fell_at = tuple((names[i], float(time[k])) for i, k in since.items())
    collapsed = bool(fell_at)
    first = fell_at[0][1] if collapsed else math.nan
    until = time <= first if collapsed else slice(None)
    lies = at_rest or not collapsed  # where debris rolls on, nothing is what will remain
    return Measures(
        outcome=classify(collapsed, failed, opened, max(_largest(shares), _largest(free_shares))),
        decided=not failed and (at_rest or collapsed),
        collapse_time=first,
        peak_rotation=float(tilt[until].max()),
        peak_joint_opening=float(opening[until].max(initial=0.0)),
        residual_joint_slip=float(slip.max(initial=0.0)) if lies else math.nan,
        residuals=residuals,
        collapse=Collapse(first, None, FELL, azimuth_of_fall(each, fell_at), touched) if collapsed else None,
        blocks=BlockMeasures(
            fell_at, float(moved[until].max()), float(moved[-1].max()) if lies else math.nan, at_rest, in_equilibrium, each,
            None if touched is None else touched.time,
        ),
        **numbers,
    )  # fmt: skip


def joined_bodies(structure: Structure) -> tuple[list[tuple[int, int]], np.ndarray]:
    """Bodies of each joint of an assembly by their numbers, and the width of each [m]."""
    if structure.space_joints is not None:
        joints: Sequence[Any] = structure.space_joints
        width = [joint.width for joint in joints]
    else:
        assembly: Assembly = structure.must_be("assembly")
        joints = assembly.joints
        width = [_width(assembly, joint) for joint in joints]
    return [(joint.lower, joint.upper) for joint in joints], np.array(width)


def joint_histories(
    assembly: Assembly, x: np.ndarray, z: np.ndarray, rotation: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Largest gap between the faces of every joint, and offset along it, both from the start [m], shape (T, J).

    Parameters
    ----------
    assembly : Assembly
    x, z, rotation : array
        Poses of ``assembly.bodies`` [m], [rad], shape (T, N).
    """
    histories = [_joint_history(assembly, joint, x, z, rotation) for joint in assembly.joints]
    shape = (2, 0, len(x))
    opening, slip = np.moveaxis(np.array(histories), 1, 0) if histories else np.zeros(shape)
    return opening.T, slip.T


def fallen_since(down: np.ndarray) -> dict[int, int]:
    """Bodies that have fallen at the end in the order in which they fell, and the recorded state from which on each had.

    Parameters
    ----------
    down : array of bool
        Which bodies were down at which state, shape (T, N).
    """
    first_states = {int(i): int(np.flatnonzero(~down[:, i])[-1]) + 1 for i in np.flatnonzero(down[-1])}
    return dict(sorted(first_states.items(), key=lambda item: item[1]))


def lowest_standing(structure: Structure, z: np.ndarray) -> np.ndarray:
    """Height below which the centroid of each body has fallen, from that at the start [m], shape (N,)."""
    return z - DROP * np.array([min(body.sides) for body in structure.bodies])


def have_fallen(lowest: np.ndarray, z: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """Which bodies have fallen, from their heights [m] and rotations since the start [rad], shape of these."""
    return (z < lowest) | (np.abs(turned) > TURNED)


def first_touch(
    structure: Structure, time: np.ndarray, x: np.ndarray, z: np.ndarray, rotation: np.ndarray, when: float
) -> Touch:
    """First touch of bodies that are not joined: the closest two bodies in the first recorded state after it.

    Parameters
    ----------
    structure : Structure
    time : array
        [s], shape (T,)
    x, z, rotation : array
        Poses of its bodies [m], [rad], shape (T, N).
    when : float
        When a contact of bodies without a joint was first seen [s].
    """
    k = min(int(np.searchsorted(time, when)), len(time) - 1)
    outlines = []
    for i, body in enumerate(structure.bodies):
        c, s = math.cos(rotation[k, i]), math.sin(rotation[k, i])
        outlines.append((body.outline - body.place) @ np.array([[c, s], [-s, c]]) + (x[k, i], z[k, i]))
    if not all(np.isfinite(corners).all() for corners in outlines):
        return Touch(when)
    low, high = (np.array([end(corners, axis=0) for corners in outlines]) for end in (np.min, np.max))
    gap = np.maximum(low[:, None] - high[None], low[None] - high[:, None]).max(axis=2)  # of the boxes, one way or other
    joined = {frozenset((joint.lower, joint.upper)) for joint in structure.face_pairs}
    near = NEAR * min(body.size for body in structure.bodies)
    best, pair = math.inf, None
    for i, j in np.argwhere(np.triu(gap < near, 1)).tolist():
        first_body, second_body = structure.bodies[i], structure.bodies[j]
        if frozenset((i, j)) in joined or (first_body.fixed and second_body.fixed):
            continue
        apart = separation(outlines[i], outlines[j])
        if apart < best:
            best, pair = apart, (first_body.name, second_body.name)
    return Touch(when, pair)


def _joint_history(
    assembly: Assembly, joint: FaceJoint, x: np.ndarray, z: np.ndarray, rotation: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    def ends(body: int, face: int) -> np.ndarray:  # where the face starts and ends, shape (2, 2, T)
        corners = assembly.bodies[body].corners
        local = np.stack((corners[face], corners[(face + 1) % len(corners)])) - assembly.bodies[body].origin
        c, s = np.cos(rotation[:, body]), np.sin(rotation[:, body])
        px, pz = local[:, 0, None], local[:, 1, None]
        return np.stack((x[:, body] + c * px - s * pz, z[:, body] + s * px + c * pz), axis=1)

    first, last = ends(joint.lower, joint.lower_face)
    start, end = ends(joint.upper, joint.upper_face)  # faces run against each other
    length = np.hypot(*(last - first))
    along = (last - first) / length
    # place along the lower face, from where it starts, and height over it
    s0, s1 = ((p - first)[0] * along[0] + (p - first)[1] * along[1] for p in (end, start))
    q0, q1 = ((p - first)[0] * along[1] - (p - first)[1] * along[0] for p in (end, start))
    low, high = np.maximum(s0, 0.0), np.minimum(s1, length)
    gap = [q0 + (q1 - q0) * np.clip((place - s0) / np.where(s1 > s0, s1 - s0, 1.0), 0.0, 1.0) for place in (low, high)]
    opening = np.maximum(np.maximum(*gap), 0.0)
    middle = 0.5 * (s0 + s1)
    return np.maximum(opening - opening[0], 0.0), middle - middle[0]


def _width(assembly: Assembly, joint: FaceJoint) -> float:
    """Length of the smaller face of a joint [m]."""
    lower, upper = assembly.bodies[joint.lower], assembly.bodies[joint.upper]
    return min(_length(lower, joint.lower_face), _length(upper, joint.upper_face))


def _length(block: Block, face: int) -> float:
    corners = block.corners
    return float(np.hypot(*(corners[(face + 1) % len(corners)] - corners[face])))


def _largest(values: np.ndarray) -> float:
    return float(np.nan_to_num(values, nan=np.inf).max(initial=0.0))


def recorded_in_space(
    structure: Structure,
    time: np.ndarray,
    position: np.ndarray,
    axes: np.ndarray,
    energy: dict[str, np.ndarray],
    ground_acceleration: np.ndarray,
    ground_displacement: np.ndarray,
    *,
    failure: str,
    model: str,
    provenance: dict[str, Any],
    link_histories: LinkHistories | None = None,
    velocity: np.ndarray | None = None,
    spin: np.ndarray | None = None,
    struck_at: float | None = None,
    **ended: Any,
) -> Recorded:
    """A run of an assembly in space from the recorded poses of its bodies.

    Parameters
    ----------
    structure : Structure
    time : array
        [s], shape (T,)
    position, axes : array
        Centroids of ``structure.bodies`` [m], shape (T, N, 3), and their axes as columns, shape (T, N, 3, 3).
    energy : dict of str to array
        Ledger [J], each term of shape (T,).
    ground_acceleration, ground_displacement : array
        [m/s²], [m], shape (T, 3)
    failure : str
        Why the run has failed and has no verdict; empty if it has one.
    model, provenance, held
        As of an assembly in the plane.
    velocity, spin : array, optional
        Of the centroids [m/s], and of the bodies' turning in the axes of space [rad/s], shape (T, N, 3).
    struck_at : float, optional
        When bodies that no joint holds together first touched [s].
    **ended
        How the run began and ended: see :func:`~stylobate.response.assemblies.measures_of_bodies`.
    """
    opening, slip, twist = joint_histories_in_space(structure, position, axes)
    moved = np.linalg.norm(position - position[0], axis=-1)
    down = fallen(structure, position[0], axes[0], position, axes)
    since = {} if failure else fallen_since(down)
    tilt = np.arccos(np.clip(_upright(axes[0], axes), -1.0, 1.0))
    free = [not body.fixed for body in structure.bodies]
    residuals = Residuals.in_space(
        slip[-1], twist[-1], (position[-1] - position[0])[free], turned_up(axes[-1, free], axes[0, free])
    )
    measures = measures_of_bodies(
        structure, time, position, moved, tilt, since, opening, np.linalg.norm(slip[-1], axis=-1),
        failed=bool(failure), reason=failure, touched=None if struck_at is None else Touch(struck_at), residuals=residuals,
        **ended,
    )  # fmt: skip
    histories = Histories.in_space(
        time, position, quaternions(axes), opening, slip, twist, None, None, ground_acceleration,
        ground_displacement, energy, velocity=velocity, spin=spin,
    )  # fmt: skip
    if link_histories is not None:
        histories = replace(histories, links=link_histories)
    return Recorded(structure, histories, measures, model, provenance, followed=True)


def fallen(
    structure: Structure, first: np.ndarray, first_axes: np.ndarray, position: np.ndarray, axes: np.ndarray
) -> np.ndarray:
    """Which bodies have fallen: lower than at the start by a share of their size, or tilted by more than 45°.

    Parameters
    ----------
    structure : Structure
    first, first_axes : array
        Centroids and axes at the start [m], [-], shape (N, 3), (N, 3, 3).
    position, axes : array
        At other times, shape (…, N, 3), (…, N, 3, 3).
    """
    return (position[..., 2] < lowest_standing(structure, first[:, 2])) | (
        _upright(first_axes, axes) < math.cos(TURNED)
    )


def _upright(first: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Cosine of the tilt since the start of what was vertical then, shape (…, N)."""
    return np.einsum("nk,...nk->...n", first[:, 2, :], axes[..., 2, :])


def _as_drawn(structure: Structure, body: int) -> tuple[np.ndarray, np.ndarray]:
    """Centroid of a body as drawn [m], and its axes as columns; those of the ground for the body that is it."""
    stone: Any = structure.bodies[body]
    if getattr(stone, "pieces", None) is None:
        return np.array([0.0, 0.0, structure.ground]), np.eye(3)
    return np.array(stone.position), stone.axes


def joint_histories_in_space(
    structure: Structure, position: np.ndarray, axes: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Largest gap of every joint [m], and since the start offset along it [m] and twist about its normal [rad].

    A gap is counted from where the faces touch without pressure, as they are drawn: an edge that rises less than its weight
    has pressed it has not opened. Shapes (T, J), (T, J, 2), (T, J).
    """
    joints = structure.space_joints or ()
    count = len(position), len(joints)
    opening, slip, twist = np.zeros(count), np.zeros((*count, 2)), np.zeros(count)
    for k, joint in enumerate(joints):
        u, v = joint.lower, joint.upper
        (place_u, axes_u), (place_v, axes_v) = (_as_drawn(structure, i) for i in (u, v))
        # what was drawn at the joint on either body, seen from the body below in the axes of the joint
        frame = axes[:, u] @ (axes_u.T @ joint.frame)
        below = position[:, u] + frame @ (joint.frame.T @ (joint.origin - place_u))
        turned = frame.swapaxes(1, 2) @ (axes[:, v] @ axes_v.T)
        moved = np.einsum("tba,tb->ta", frame, position[:, v] - below)
        corners = joint.origin + joint.corners @ joint.frame[:, :2].T - place_v
        gap = np.maximum((moved[:, 2, None] + turned[:, 2] @ corners.T).max(axis=1), 0.0)
        offset = moved[:, :2] + turned[:, :2] @ corners.mean(axis=0)
        opening[:, k] = np.maximum(gap - gap[0], 0.0)
        slip[:, k] = offset - offset[0]
        relative = turned @ joint.frame
        twist[:, k] = np.unwrap(
            np.arctan2(relative[:, 1, 0] - relative[:, 0, 1], relative[:, 0, 0] + relative[:, 1, 1])
        )
    return opening, slip, twist
