"""What the kernel calls of a column in one lane, in the plane and in space: the laws of the loops over lanes.

Records: ``plane/records.py``, ``dem3d/records.py``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from stylobate.kernels.dem3d import move
from stylobate.kernels.dem3d.bed import disc_beds, ring_beds
from stylobate.kernels.dem3d.corner import corner_joint
from stylobate.kernels.dem3d.look import ground_at as ground_in_space
from stylobate.kernels.dem3d.look import look_at_lane, lose
from stylobate.kernels.dem3d.rim import chipped_rims, whole_rims
from stylobate.kernels.dem3d.round_faces import on_face
from stylobate.kernels.jit import law
from stylobate.kernels.plane import look, motion, point_joint
from stylobate.kernels.shared.frame import goes_on


class OwnRecords(NamedTuple):
    """What threads that step records of their own exchange, and what of these a step changes; names of fields.

    Parameters
    ----------
    to_joint : tuple of str
        What a step changes of a body, and the joint over it asks for.
    to_body : tuple of str
        What a load tells the body under it.
    body, joint : tuple of str
        What steps change of a body and of a joint; of those fields that a joint does not have in its type, nothing.
    """

    to_joint: tuple[str, ...]
    to_body: tuple[str, ...]
    body: tuple[str, ...]
    joint: tuple[str, ...]


class Laws(NamedTuple):
    """Laws of columns of a kind, each for one lane, the last argument.

    Parameters
    ----------
    joint_force : callable
        Load of a joint at t_n, from its upper and lower body, itself, its load, the lane, and what takes its work.
    move : callable
        Motion of a body over a step, from the loads under and over it, the lane, what takes its momentum, and the ground.
    no_momentum, add_work : callable
        Begin the momentum of a step; add the work of the input over it.
    ground_at : callable
        Acceleration of the base at a step of the chunk.
    look : callable
        Looks at a column between chunks, from its bodies, joints, lane, feed, watch, and what links hold.
    momentum : tuple of tuple
        Fields of records for it, without the lanes.
    own_records : OwnRecords, optional
        For threads that step records of their own; by themselves they step those that their block shares.
    """

    joint_force: Callable[..., None]
    move: Callable[..., None]
    no_momentum: Callable[..., None]
    add_work: Callable[..., None]
    ground_at: Callable[..., None]
    look: Callable[..., None]
    momentum: tuple[tuple[str, tuple[int, ...]], ...]
    own_records: OwnRecords | None = None


IN_PLANE = Laws(
    point_joint.joint_force,
    motion.move_between,
    motion.no_momentum,
    motion.add_work,
    look.ground_at,
    look.look_at_lane,
    (("px", ()), ("pz", ())),
    OwnRecords(
        to_joint=("x", "z", "c", "s", "vx", "vz", "w"),
        to_body=("fx", "fz", "ml"),
        body=("x", "z", "th", "c", "s", "vx", "vz", "w"),
        joint=("over", "fs", "fn", "dn", "ds"),
    ),
)


@law
def whole_rim_joint(u, v, e, f, o, sums, l):
    """A joint of whole round faces on their rims."""
    on_face(whole_rims, e, f, o, sums, u, v, l)


@law
def chipped_rim_joint(u, v, e, f, o, sums, l):
    """A joint of chipped round faces on what is left of their rims."""
    on_face(chipped_rims, e, f, o, sums, u, v, l)


@law
def bed_joint(u, v, e, f, o, sums, l):
    """A joint of round faces on an elastic bed."""
    on_face(disc_beds, e, f, o, sums, u, v, l)


@law
def ring_joint(u, v, e, f, o, sums, l):
    """A joint of faces with sunken middles on an elastic bed."""
    on_face(ring_beds, e, f, o, sums, u, v, l)


@law
def cornered_joint(u, v, e, f, o, sums, l):
    """A joint of rectangular faces on their corners."""
    corner_joint(e, f, o, sums, u, v, l)


@law
def look_in_space(body, joint, o, f, w, hold, l):
    """Looks at a column in space."""
    for i in range(1, body.shape[0]):
        lose(body[i], w, l)
    if goes_on(w, l):
        look_at_lane(body, joint, o, w, f.step[l], hold, l)


def laws_for(types: Mapping[str, np.dtype]) -> Laws:
    """Laws of columns by the types of their records."""
    joint = types["joint"]
    rows = {name: 1 if len(field[0].shape) == 1 else field[0].shape[0] for name, field in joint.fields.items()}
    if "over" in rows:
        return IN_PLANE
    if "w" in rows:
        force = cornered_joint
    elif "ring" in rows:
        force = ring_joint if rows["ring"] > 1 else bed_joint
    else:
        force = chipped_rim_joint if rows["chip"] > 1 else whole_rim_joint
    return Laws(force, move.drift, move.no_momentum, move.add_work, ground_in_space, look_in_space, (("p", (3,)),))
