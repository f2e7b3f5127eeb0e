"""An assembly in space as the engine wants it: bodies as plain numbers, laws between them, joints of their faces."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...column.joint import Joint
from ...column.shapes import CircularFrustum, Placed
from ...column.spatial.touching import SpaceJoint
from ...column.structure import Structure
from ...column.turning import matrix_of
from .solids import Drum, Face, FacesJoined, HalfSpace, Solid

#: Corners around a round part that is not whole.
AROUND = 24

#: Half the side of a face of the ground: no body that stands on it comes to its end [m].
WIDE = 1e3

#: Normals that rise less than this are level: either body of such a joint counts as the lower one.
LEVEL = 1e-6

#: Relative tilt from which faces that lay on one another are a bed like all others [rad].
LAST_TILT = math.radians(50.0)


def solids_of(structure: Structure) -> tuple[list[Solid], np.ndarray]:
    """Bodies of an assembly in space in their order, and the number of the first part of each, shape (N + 1,)."""
    solids = []
    for body in structure.bodies:
        stone: Any = body
        if getattr(stone, "pieces", None) is None:
            solids.append(Solid([HalfSpace()], np.array([0.0, 0.0, structure.ground]), np.eye(3)))
            continue
        mass = 0.0 if stone.fixed else stone.mass
        solids.append(
            Solid(
                [part_of(piece) for piece in stone.pieces],
                np.array(stone.position),
                stone.axes,
                mass,
                stone.inertia_tensor if mass else np.eye(3),
                np.array(stone.velocity),
                np.array(stone.angular_velocity),
            )
        )
    return solids, np.cumsum([0, *(len(solid.parts) for solid in solids)])


def part_of(part: Placed) -> Any:
    """A convex part in the axes of its body: exact where it is a round drum, else its surface."""
    shape, turned = part.shape, matrix_of(part.orientation)
    if isinstance(shape, CircularFrustum):
        foot = np.array(part.place) - shape.centroid * turned[:, 2]
        return Drum(foot, turned[:, 2], shape.height, 0.5 * shape.bottom, 0.5 * shape.top)
    return part.mesh(AROUND)


def laws_of(structure: Structure) -> np.ndarray:
    """k_n, k_s [N/m³] and tan φ of the bed between any two bodies, shape (N, N, 3); the pair's lower number first."""
    laws = np.empty((len(structure.bodies), len(structure.bodies), 3))

    def numbers(law: Joint) -> tuple[float, float, float]:
        return law.normal_stiffness, law.shear_stiffness, law.tan_phi

    for i, law in enumerate(structure.surfaces):
        laws[:, i] = numbers(law)
    for i, h, law in structure.laws_of_pairs:
        laws[i, h] = numbers(law)
    return laws


def joints_of(structure: Structure, solids: list[Solid], first: np.ndarray) -> list[FacesJoined]:
    """Joints of the faces that lie on one another at the start."""
    joints = []
    for joint in structure.space_joints or ():
        lower, upper = solids[joint.lower], solids[joint.upper]
        ground = isinstance(lower.parts[0], HalfSpace)
        sides = [
            (int(first[joint.lower]) + joint.lower_part, _level(joint, lower) if ground else _face(joint.below, lower)),
            (int(first[joint.upper]) + joint.upper_part, _face(joint.above, upper)),
        ]
        (low, below), (high, above) = sides[::-1] if turned_over(joint) else sides
        law = joint.law
        joints.append(
            FacesJoined(
                low,
                high,
                below,
                above,
                law.normal_stiffness,
                law.shear_stiffness,
                law.tan_phi,
                law.cohesion,
                LAST_TILT,
                joint.area,
            )
        )
    return joints


def turned_over(joint: SpaceJoint) -> bool:
    """Whether the second body of a joint is under the first one, however they are numbered."""
    return bool(joint.frame[2, 2] < -LEVEL)


def _face(face: Any, solid: Solid) -> Face:
    """A face from space into the axes of its body; a disc where nothing but a circle bounds it."""
    middle = solid.axes.T @ (face.middle - solid.place)
    frame = solid.axes.T @ face.frame
    if face.edges.discs and not len(face.edges.sides):
        offset, radius = face.edges.discs[0]
        return Face(middle + frame[:, :2] @ offset, frame, np.zeros((0, 2)), float(radius))
    return Face(middle, frame, face.corners)


def _level(joint: Any, ground: Solid) -> Face:
    """The face of the ground under a joint, without ends."""
    corners = WIDE * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return Face(joint.origin - ground.place, joint.frame, corners)
