"""Start of a column as found in space: every joint closed by its eccentric load, every drum where that puts it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...column import Column, Drum
from ...column.as_found import FoundDrum
from ...column.found_geometry import SpaceGeometry, SpaceLoad, space_geometry, space_load
from ...errors import InputError
from ...kernels.shared.records import JOINT
from ..drums.bodies import Topology
from .arrays import Records
from .packing import CORNERS

#: Rest of a joint's force and moment over its load and its load's lever; from where on Newton's steps are taken whole, and
#: for how many rounds whatever comes of it; rounds to get there.
ALLOWED, NEAR, WHOLE, ROUNDS = 1e-6, 1e-3, 30, 60

#: Steps of the differences in place of derivatives, over the closure: from flat, where the strips of a bed are still to
#: take their direction, and later.
DIFFERENCES = 0.1, 1e-4

#: Friction that asks a corner for its pressure [N].
PROBE = 1e30


def face_corners(drum: Drum, found: FoundDrum) -> np.ndarray:
    """Corners of a rectangular drum's lower face, less its chips, from the middle of the whole face [m], shape (4, 2)."""
    corners = CORNERS * (0.5 * drum.bottom_width, 0.5 * drum.depth)
    left, right, front, back = found.chips
    return corners - np.where(CORNERS > 0.0, (right, back), (-left, -front))


def found_fields(column: Column, at: SpaceGeometry) -> dict[str, np.ndarray]:
    """Fields of the drums of a column as found, the base first: axes, centroids, lower faces in the drums' axes."""
    fields = {}
    for c, name in enumerate("xyz"):
        fields[name] = np.concatenate(([0.0], at.centroid[:, c]))
        fields["n" + name] = np.concatenate(([float(c == 2)], at.bed[:, c, 2]))
        for a, axis in enumerate("ijk"):
            fields[axis + name] = np.concatenate(([float(a == c)], at.axes[:, c, a]))
    if column.section != "circular":
        corners = np.array([face_corners(drum, column.as_found.of(i)) for i, drum in enumerate(column.drums, 1)])
        for c, name in enumerate(("px", "py", "pz")):
            values = np.einsum("nb,nkb->nk", at.bed[:, c, :2], corners)
            fields[name] = np.concatenate((np.zeros((1, len(CORNERS))), values))
    return fields


def found_start(
    column: Column, kernel: Any, types: dict[str, np.dtype], fields: tuple[dict[str, Any], ...], closure: np.ndarray
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Fields of the drums, and friction held by the joints, in equilibrium under gravity.

    Each joint has three unknowns, its closure and two rotations, that the law of contact itself must balance with the
    weight above: Newton's method for all joints at once, with differences in lanes. Shear is what statics asks for.

    Parameters
    ----------
    column : Column
    kernel : module
        Of the law of contact.
    types : dict of dtype
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
    contact = _Contact(column, kernel, types, fields)
    half = contact.half
    unknowns = _Unknowns.closed(closure)
    scale = closure[:, None] / np.stack((np.ones(column.n), half, half), axis=1)
    friction = _Friction.of_statics(column)
    found: tuple[dict[str, np.ndarray], dict[str, np.ndarray]] | None = None
    left = np.inf
    for count in range(ROUNDS):
        step = DIFFERENCES[count > 0] * scale
        poses = [space_geometry(column, unknowns.now + step * (np.arange(3) == c - 1)) for c in range(4)]
        held, stored = contact.ask(poses, friction)
        loads = [space_load(column, poses[0], j) for j in range(column.n)]
        missing, size, slid, twisting = contact.unbalanced(held[0], loads)
        pressing = np.array([load.normal for load in loads])
        worst = max(float((np.abs(one).T / pressing).max()) for one in (slid, twisting / half))
        worst = max(worst, float(size.max()))
        if worst > 0.5 * left:  # no better than rounding lets it be
            break
        if worst < ALLOWED:
            places = {name: contact.drum[name][..., 0].copy() for name in found_fields(column, poses[0])}
            found, left = (places, {"s": stored, "t": friction.turning.copy()}), worst
        friction.take(size < NEAR, slid, twisting)
        unknowns.go_on(size, missing, held, step, halved=count >= WHOLE)
    if found is None:
        raise InputError(
            f"joint {int(np.argmax(unknowns.rest)) + 1} of {column.name!r} as found carries its load at the very edge; "
            "make its offset or tilt, or base_tilt, smaller."
        )
    return found


@dataclass
class _Friction:
    """Friction in every joint: shear in space [N], shape (n, 3), torsion moment [N m], each corner's share."""

    shear: np.ndarray
    turning: np.ndarray
    bears: np.ndarray

    @classmethod
    def of_statics(cls, column: Column) -> _Friction:
        """The shear that statics asks for, evenly on the corners."""
        at, n = space_geometry(column), column.n
        shear = np.array([(*(-space_load(column, at, j).shear), 0.0) for j in range(n)])
        return cls(shear, np.zeros(n), np.full((n, len(CORNERS)), 1.0 / len(CORNERS)))

    def take(self, near: np.ndarray, slid: np.ndarray, twisting: np.ndarray) -> None:
        """Take over what the joints near equilibrium lack."""
        self.shear[near, :2] -= slid[near]
        self.turning[near] -= twisting[near]  # of pressure on two rims that lean to one another


@dataclass
class _Unknowns:
    """Closure [m] and two rotations of every joint: now, at their best, and on the way from there; each of shape (n, 3)."""

    now: np.ndarray
    best: np.ndarray
    moves: np.ndarray
    rest: np.ndarray
    share: np.ndarray

    @classmethod
    def closed(cls, closure: np.ndarray) -> _Unknowns:
        """All joints closed evenly."""
        now = np.zeros((len(closure), 3))
        now[:, 0] = -closure
        return cls(now, now.copy(), np.zeros_like(now), np.full(len(now), np.inf), np.ones(len(now)))

    def go_on(
        self, size: np.ndarray, missing: np.ndarray, held: np.ndarray, step: np.ndarray, *, halved: bool = False
    ) -> None:
        """Newton's step of every joint that has come nearer; half of the last one from its best place for the others.

        Where steps are ``halved``, those near the solution are: at a kink of the law of contact whole ones lead to and fro
        over it for ever.
        """
        for j in range(len(self.now)):
            if size[j] <= self.rest[j] or size[j] < NEAR:
                slopes = (held[1:, j, :3] - held[0, j, :3]).T / step[j]
                self.share[j] = 0.5 if halved and size[j] < NEAR else 1.0
                self.rest[j], self.best[j] = size[j], self.now[j]
                self.moves[j] = -np.linalg.lstsq(slopes, missing[j], rcond=None)[0]
            else:
                self.share[j] *= 0.5
            self.now[j] = self.best[j] + self.share[j] * self.moves[j]


class _Contact:
    """The law of contact with the column's drums in lanes: as they stand, and with each unknown of the joints changed."""

    def __init__(
        self, column: Column, kernel: Any, types: dict[str, np.dtype], fields: tuple[dict[str, Any], ...]
    ) -> None:
        n = column.n
        self.column, self.cornered = column, column.section != "circular"
        self.records = records = Records(kernel, types, replace(Topology.of(column), links=()), n)
        self.drum, self.joint, lane = records.body, records.joint, records.lane
        for array, values in zip((self.drum, self.joint, lane), fields, strict=True):
            for name, value in values.items():
                array[name][...] = np.asarray(value)[..., None]
        lane["damp"] = lane["dt"] = 0.0
        self.half = np.array([0.5 * drum.bottom_width for drum in column.drums])
        self.pivots = not self.cornered and float(lane["pivot"][0, 0]) > 0.0

    def ask(self, poses: list[SpaceGeometry], friction: _Friction) -> tuple[np.ndarray, np.ndarray]:
        """Forces in the joints in their own frames at every pose: normal force, moments and shear, shape (poses, n, 6); and
        the shear as the kernel stores it. Notes what each corner bears."""
        column, at, n = self.column, poses[0], self.column.n
        for k, pose in enumerate(poses + [at] * (len(CORNERS) if self.cornered else 0)):
            for name, values in found_fields(column, pose).items():
                self.drum[name][..., k] = values
        lower = np.concatenate((np.eye(3)[None], at.axes[:-1]))
        own = np.einsum("nba,nbc,nc->na", lower, at.frame, friction.shear)
        state = self.records.now()
        memory = state[JOINT]
        stored = (friction.bears[:, :, None] * own[:, None, :]).reshape(n, -1) if self.cornered else own
        memory["s"][..., :4] = stored[..., None]
        memory["t"][:] = friction.turning[:, None]
        for p in range(len(CORNERS) if self.cornered else 0):  # in lanes of their own: what each corner bears
            memory["mu"][:, 4 + p], memory["co"][:, 4 + p] = 1.0, 0.0
            memory["s"][:, 3 * p, 4 + p] = PROBE
        load = self.records.load
        self.records.kernel.forces(state)
        held = np.empty((len(poses), n, 6))
        for k, pose in enumerate(poses):
            force = load["f"][:n, :, k]
            moment = load["up"][:n, :, k] + np.cross(pose.centroid - pose.origin, force)
            force, moment = (np.einsum("nba,nb->na", pose.frame, one) for one in (force, moment))
            held[k] = np.column_stack((force[:, 2], moment, force[:, :2]))
        if self.cornered:
            each = np.einsum("nb,nbp->np", lower[:n, :, 0], load["f"][:n, :, 4 : 4 + len(CORNERS)])
            each = np.maximum(each, 0.0)
            friction.bears = each / np.maximum(each.sum(axis=1, keepdims=True), 1e-300)
        return held, stored

    def unbalanced(
        self, held: np.ndarray, loads: list[SpaceLoad]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Normal force and moments that a joint holds too much, shape (n, 3), their size over the load and its lever; shear
        [N], shape (n, 2), and torsion moment [N m] too much."""
        pressing = np.array([load.normal for load in loads])
        weights = np.array(
            [(-load.normal, -load.place[1] * load.normal, load.place[0] * load.normal) for load in loads]
        )
        missing = held[:, :3] + weights
        levers = np.stack((np.ones(len(loads)), self.half, self.half), axis=1)
        size = np.linalg.norm(missing / (pressing[:, None] * levers), axis=1)
        about = [load.place[0] * load.shear[1] - load.place[1] * load.shear[0] for load in loads]
        slid = held[:, 4:] + np.array([load.shear for load in loads])
        return missing, size, slid, (held[:, 3] + about) * self.pivots
