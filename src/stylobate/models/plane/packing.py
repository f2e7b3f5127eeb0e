"""Structure in the numbers of the engine in the plane: the fields of its records at rest."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...column import Column
from ...column.found_geometry import gravity_vector
from ...column.structure import Structure
from ..drums.bodies import Topology
from ..drums.joints import contact_points
from ..drums.links import bonds
from ..drums.records import UNSEEN, LaneRecords, Packed
from .links import links_at_rest


def pack_column(
    column: Column,
    types: Mapping[str, np.dtype],
    fields: tuple[Mapping[str, Any], Mapping[str, Any], Mapping[str, Any]],
    step: float,
    toes: np.ndarray,
) -> Packed:
    """A column's lane from the fields of its bodies, joints and lane; ``types`` are those of records of one lane."""
    records = LaneRecords(types, Topology.of(column), column.n)
    body, joint, lane = fields
    top = column.upper_faces[-1]
    face = {"th": top.height, "tc": top.direction[0], "ts": top.direction[1]}
    records.fill(0, body=body, joint=joint, lane=lane, watch=UNSEEN | face)
    records.link[...] = links_at_rest(column, records.body)
    return Packed(records.taken(0), bonds(column), step, column.joint_widths, column.lowest_barrier, toes)


#: Fields of a body that a run begins with.
OF_BODY = ("x", "z", "th", "c", "s", "vx", "vz", "w", "m", "i", "im", "ii")


def face_fields(structure: Structure, *, turned: bool = False) -> dict[str, np.ndarray]:
    """Fields that say where the faces of the joints are, by rows of shape (joints,); ``turned`` as of their records."""
    pairs = structure.face_pairs
    below, above = (
        np.array([(*one.direction, *one[1:]) for one in some]).reshape(-1, 5)
        for some in ([pair.below for pair in pairs], [pair.above for pair in pairs])
    )
    names = ("lc", "ls", "ht", "wl", "wr", "hb", "bl", "br")
    found = dict(zip(names, (*below.T, *above[:, 2:].T), strict=True))
    return found | ({"turned": above[:, :2]} if turned else {})


def joint_fields(
    structure: Structure, kn: np.ndarray, ks: np.ndarray, *, turned: bool = False
) -> dict[str, np.ndarray]:
    """Faces and law of joints of contact points, from their normal and shear stiffness per area [N/m³], shape (joints,)."""
    pairs = structure.face_pairs
    area, width = (np.array([getattr(pair, name) for pair in pairs]) for name in ("area", "width"))
    return face_fields(structure, turned=turned) | {
        "kn": kn * area / width,
        "ks": ks * area / width,
        "co": np.array([pair.law.cohesion for pair in pairs]) * area / width,
        "mu": np.array([pair.law.tan_phi for pair in pairs]),
    }


def lane_fields(structure: Structure, damp: np.ndarray, points: int | None = None) -> dict[str, Any]:
    """Fields of a lane at the start of a run; with the contact points of a joint, where it has so many."""
    down = gravity_vector(structure)
    xi, share = (0.0, 0.0) if points is None else contact_points(structure.section or "rectangular", points)
    return {"g": float(-down[1]), "gx": float(-down[0]), "damp": damp, "xi": xi, "sh": share}
