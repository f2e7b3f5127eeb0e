"""Start of a column as found in space: every joint closed by its eccentric load, every drum where that puts it."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...column import Column
from ...column.found_in_space import SpaceGeometry, space_geometry, space_load
from ...errors import InputError
from .packing import CORNERS

#: What may be left of a joint's force and moment over its load and its load's lever; from where on Newton's steps are
#: taken whole; rounds to get there.
ALLOWED, NEAR, ROUNDS = 1e-6, 1e-3, 60

#: Steps of the differences in place of derivatives, over the closure: from flat, where the strips of a bed are still to
#: take their direction, and later.
DIFFERENCES = 0.1, 1e-4

#: Friction that asks a corner for its pressure [N].
PROBE = 1e30


def found_fields(column: Column, at: SpaceGeometry) -> dict[str, np.ndarray]:
    """Fields of the drums of a column as found, the base first: axes, centroids, lower faces in the drums' axes."""
    fields = {}
    for c, name in enumerate("xyz"):
        fields[name] = np.concatenate(([0.0], at.centroid[:, c]))
        fields["n" + name] = np.concatenate(([float(c == 2)], at.bed[:, c, 2]))
        for a, axis in enumerate("ijk"):
            fields[axis + name] = np.concatenate(([float(a == c)], at.axes[:, c, a]))
    if column.section != "circular":
        own = np.array([(0.5 * drum.bottom_width, 0.5 * drum.depth) for drum in column.drums])
        corners = own[:, None] * CORNERS
        for c, name in enumerate(("px", "py", "pz")):
            values = np.einsum("nb,nkb->nk", at.bed[:, c, :2], corners)
            fields[name] = np.concatenate((np.zeros((1, len(CORNERS))), values))
    return fields


def found_start(
    column: Column, kernel: Any, types: tuple, fields: tuple[dict[str, Any], ...], closure: np.ndarray
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Fields of the drums, and friction held by the joints, in equilibrium under gravity.

    Each joint has three unknowns, its closure and two rotations, that the law of contact itself must balance with the
    weight above: Newton's method for all joints at once, with differences in lanes. Shear is what statics asks for.

    Parameters
    ----------
    column : Column
    kernel : module
        Of the law of contact.
    types : tuple of dtype
        Of its records.
    fields : tuple of dict
        Fields of drums, joints and lane of the column as built.
    closure : array
        Of each joint under the weight above, if it were centred [m], shape (n,).

    Raises
    ------
    InputError
        A joint cannot carry its load.
    """
    n, cornered = column.n, column.section != "circular"
    drum: Any
    joint: Any
    lane: Any
    drum, joint, lane = (np.zeros(rows, one) for rows, one in zip((n + 1, n + 1, 1), types[:3], strict=True))
    for array, values in zip((drum, joint, lane), fields, strict=True):
        for name, value in values.items():
            array[name][...] = np.asarray(value)[..., None]
    lane["beta"] = lane["dt"] = 0.0
    half = np.array([0.5 * one.bottom_width for one in column.drums])
    scale = closure[:, None] / np.stack((np.ones(n), half, half), axis=1)
    now = np.zeros((n, 3))
    now[:, 0] = -closure
    best, rest, moves, share = now.copy(), np.full(n, np.inf), np.zeros((n, 3)), np.ones(n)
    at = space_geometry(column)
    shear = np.array([(*(-space_load(column, at, j).shear), 0.0) for j in range(n)])
    turning, pivots = np.zeros(n), not cornered and float(lane["pivot"][0, 0]) > 0.0
    bears = np.full((n, len(CORNERS)), 1.0 / len(CORNERS))
    found: tuple[dict[str, np.ndarray], dict[str, np.ndarray]] | None = None
    left = np.inf
    for count in range(ROUNDS):
        step = DIFFERENCES[count > 0] * scale
        poses = [space_geometry(column, now + step * (np.arange(3) == c - 1)) for c in range(4)]
        at = poses[0]
        for k, pose in enumerate(poses + [at] * (len(CORNERS) if cornered else 0)):
            for name, values in found_fields(column, pose).items():
                drum[name][..., k] = values
        loads = [space_load(column, at, j) for j in range(n)]
        lower = np.concatenate((np.eye(3)[None], at.axes[:-1]))
        own = np.einsum("nba,nbc,nc->na", lower, at.frame, shear)
        memory = joint.copy()
        stored = np.zeros((n + 1, *memory["s"].shape[1:2]))
        stored[:n] = (bears[:, :, None] * own[:, None, :]).reshape(n, -1) if cornered else own
        memory["s"][..., :4] = stored[..., None]
        memory["t"][:n] = turning[:, None]
        for p in range(len(CORNERS) if cornered else 0):  # in lanes of their own: what each corner bears
            memory["mu"][:, 4 + p], memory["co"][:, 4 + p] = 1.0, 0.0
            memory["s"][:, 3 * p, 4 + p] = PROBE
        kernel.forces(drum, memory, lane)
        held = np.empty((4, n, 6))
        for k, pose in enumerate(poses):
            force = memory["f"][:n, :, k]
            moment = memory["up"][:n, :, k] + np.cross(pose.centroid - pose.origin, force)
            force, moment = (np.einsum("nba,nb->na", pose.frame, one) for one in (force, moment))
            held[k] = np.column_stack((force[:, 2], moment, force[:, :2]))
        pressing = np.array([load.normal for load in loads])
        weights = np.array(
            [(-load.normal, -load.place[1] * load.normal, load.place[0] * load.normal) for load in loads]
        )
        missing = held[0, :, :3] + weights
        size = np.linalg.norm(missing / (pressing[:, None] * np.stack((np.ones(n), half, half), axis=1)), axis=1)
        if cornered:
            each = np.einsum("nb,nbp->np", lower[:n, :, 0], memory["f"][:n, :, 4 : 4 + len(CORNERS)])
            bears = np.maximum(each, 0.0) / np.maximum(np.maximum(each, 0.0).sum(axis=1, keepdims=True), 1e-300)
        about = [load.place[0] * load.shear[1] - load.place[1] * load.shear[0] for load in loads]
        twisting = (held[0, :, 3] + about) * pivots
        slid = held[0, :, 4:] + np.array([load.shear for load in loads])
        worst = max(float((np.abs(one).T / pressing).max()) for one in (slid, twisting / half))
        worst = max(worst, float(size.max()))
        if worst > 0.5 * left:  # no better than rounding lets it be
            break
        if worst < ALLOWED:
            places = {name: drum[name][..., 0].copy() for name in found_fields(column, at)}
            found, left = (places, {"s": stored, "t": np.concatenate((turning, [0.0]))}), worst
        near = size < NEAR
        shear[near, :2] -= slid[near]
        turning[near] -= twisting[near]  # of pressure on two rims that lean to one another
        for j in range(n):
            if size[j] <= rest[j] or size[j] < NEAR:
                slopes = (held[1:, j, :3] - held[0, j, :3]).T / step[j]
                rest[j], best[j], share[j] = size[j], now[j], 1.0
                moves[j] = -np.linalg.lstsq(slopes, missing[j], rcond=None)[0]
            else:
                share[j] *= 0.5
            now[j] = best[j] + share[j] * moves[j]
    if found is None:
        raise InputError(
            f"joint {int(np.argmax(rest)) + 1} of {column.name!r} as found carries its load at the very edge; "
            "make its offset or tilt, or base_tilt, smaller."
        )
    return found
