"""What a run of an assembly comes down to: opening and slip of its joints, what fell and when, and the outcome."""

from __future__ import annotations

import numpy as np

from ..column.assembly import Assembly, Block, FaceJoint
from ..outcome import Outcome, classify

#: A block has fallen when its centroid is lower than at the start by this share of the smaller side of its box …
DROP = 0.5

#: … or when it has turned by more than this [rad].
TURNED = 0.25 * np.pi


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
    found = [_joint_history(assembly, joint, x, z, rotation) for joint in assembly.joints]
    shape = (2, 0, len(x))
    opening, slip = np.moveaxis(np.array(found), 1, 0) if found else np.zeros(shape)
    return opening.T, slip.T


def fallen_since(assembly: Assembly, z: np.ndarray, rotation: np.ndarray) -> dict[int, int]:
    """Bodies that have fallen at the end, and the recorded state from which on each of them had."""
    smaller = np.array([np.ptp(block.corners, axis=0).min() for block in assembly.bodies])
    down = (z < z[0] - DROP * smaller) | (np.abs(rotation - rotation[0]) > TURNED)
    return {int(i): int(np.flatnonzero(~down[:, i])[-1]) + 1 for i in np.flatnonzero(down[-1])}


def classify_assembly(
    assembly: Assembly,
    moved: np.ndarray,
    opening: np.ndarray,
    slip: np.ndarray,
    collapsed: bool,
) -> Outcome:
    """Outcome as for columns; a block that no joint holds counts by its own displacement, as a share of its size.

    Parameters
    ----------
    assembly : Assembly
    moved : array
        Distance of every centroid from where it was at the start [m], shape (T, N).
    opening, slip : array
        Of the joints [m], shape (T, J).
    collapsed : bool
    """
    joints, bodies = assembly.joints, assembly.bodies
    width = np.array(
        [min(_length(bodies[j.lower], j.lower_face), _length(bodies[j.upper], j.upper_face)) for j in joints]
    )
    held = {i for joint in joints for i in (joint.lower, joint.upper)}
    free = [i for i, block in enumerate(bodies) if i not in held and not block.fixed]
    size = np.array([bodies[i].size for i in free])
    opened = max(_largest(opening / width), _largest(moved[:, free] / size))
    shifted = max(_largest(np.abs(slip[-1]) / width), _largest(moved[-1, free] / size))
    return classify(collapsed, False, opened, shifted)


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


def _length(block: Block, face: int) -> float:
    corners = block.corners
    return float(np.hypot(*(corners[(face + 1) % len(corners)] - corners[face])))


def _largest(values: np.ndarray) -> float:
    return float(np.nan_to_num(values, nan=np.inf).max(initial=0.0))
