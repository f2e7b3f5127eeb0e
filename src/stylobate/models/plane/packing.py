"""A column in the numbers of the engine in the plane: one lane of its records, and which contacts there are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from ...column import Column
from ...column.found_geometry import gravity_vector
from ...column.structure import Structure
from ..drums.joints import contact_points
from ..drums.links import acting, kind_of


@dataclass(frozen=True)
class Topology:
    """Which contacts there are, the same in all lanes of a block.

    Parameters
    ----------
    bodies : int
    joints : tuple of (int, int)
        Lower and upper body of each joint.
    links : tuple of (int, int)
        The same of each link.
    fixed : tuple of int
        Bodies that move with the ground.
    stack : int
        Drums of the column that is looked at, bodies 1 … stack on joints 0 … stack − 1; 0 for none.
    which : tuple
        What else tells whose runs can share a block: the links themselves.
    """

    bodies: int
    joints: tuple[tuple[int, int], ...]
    links: tuple[tuple[int, int], ...] = ()
    fixed: tuple[int, ...] = (0,)
    stack: int = 0
    which: tuple[Any, ...] = ()

    @classmethod
    @lru_cache(maxsize=4096)
    def of_column(cls, column: Column) -> Topology:
        """Each drum on the one below, the base first."""
        links = tuple((one.lower, one.upper) for one in acting(column))
        joints = tuple((i, i + 1) for i in range(column.n))
        return cls(column.n + 1, joints, links, stack=column.n, which=kind_of(column))


@dataclass(frozen=True)
class Packed:
    """One run's lane of the records that differ from lane to lane, before it begins.

    Parameters
    ----------
    lane : dict of str to array
        Records of one lane by their names in ``kernels/shared/records.py``: body, joint, link, lane.
    bond : array
        Records of what links are in all lanes.
    step : float
        Time step [s].
    toes : array
        What joints give with their load on their edge [J], shape (n,).
    top : dict of str to float
        The topmost face, as ``watch`` wants it.
    """

    lane: dict[str, np.ndarray]
    bond: np.ndarray
    step: float
    toes: np.ndarray
    top: dict[str, float]


def one_lane(dtype: np.dtype, rows: int, fields: Mapping[str, Any]) -> np.ndarray:
    """Records of one lane from fields whose first axis is that of the records, shape (rows,)."""
    records: Any = np.zeros(rows, dtype)
    for name, values in fields.items():
        records[name][..., 0] = values
    return records


#: Fields of a body that a run begins with.
OF_BODY = ("x", "z", "th", "c", "s", "vx", "vz", "w", "m", "i", "im", "ii")


def drum_fields(column: Column, closure: np.ndarray) -> dict[str, np.ndarray]:
    """Fields of the bodies, the base first: upright, at rest, each joint closed by ``closure`` [m], shape (n,)."""
    n = column.n + 1

    def on_base(values: np.ndarray) -> np.ndarray:
        return np.concatenate(([0.0], values))

    at_rest = {name: np.zeros(n) for name in ("x", "th", "s", "vx", "vz", "w")}
    return at_rest | {
        "z": on_base(column.centroid_heights - np.cumsum(closure)),
        "c": np.ones(n),
        "m": on_base(column.masses),
        "i": on_base(column.inertias),
        "im": on_base(1.0 / column.masses),
        "ii": on_base(1.0 / column.inertias),
    }


def face_fields(structure: Structure) -> dict[str, np.ndarray]:
    """Fields that say where the faces of the joints are, each of shape (joints,)."""
    pairs = structure.face_pairs
    names = (("lc", "ls", "ht", "wl", "wr"), ("uc", "us", "hb", "bl", "br"))
    faces = ([one.below for one in pairs], [one.above for one in pairs])
    return {
        name: values
        for of, some in zip(names, faces, strict=True)
        for name, values in zip(
            of, np.array([(*one.direction, *one[1:]) for one in some]).reshape(-1, 5).T, strict=True
        )
    }


def joint_fields(structure: Structure, kn: np.ndarray, ks: np.ndarray) -> dict[str, np.ndarray]:
    """Faces and law of joints of contact points, from their normal and shear stiffness per area [N/m³], shape (joints,)."""
    pairs = structure.face_pairs
    area, width = (np.array([getattr(one, name) for one in pairs]) for name in ("area", "width"))
    return face_fields(structure) | {
        "kn": kn * area / width,
        "ks": ks * area / width,
        "co": np.array([one.law.cohesion for one in pairs]) * area / width,
        "mu": np.array([one.law.tan_phi for one in pairs]),
    }


def lane_fields(column: Column) -> dict[str, Any]:
    """Fields of a lane at the start of a run, but for damping and contact points."""
    down = gravity_vector(column)
    return dict.fromkeys(("work", "shear", "visc"), 0.0) | {"g": float(-down[1]), "gx": float(-down[0])}


def damping(damped: bool, stiffness_damping: float, mass_damping: float) -> np.ndarray:
    """The rows of ``damp``."""
    return np.array([stiffness_damping, mass_damping, 0.0]) if damped else np.zeros(1)


def top_face(column: Column) -> dict[str, float]:
    """The topmost face, as ``watch`` wants it."""
    top = column.upper_faces[-1]
    return {"th": top.height, "tc": top.direction[0], "ts": top.direction[1]}


def lane_of(gravity: float, contacts: Any) -> dict[str, Any]:
    """Fields of a lane of an assembly at the start: level base, contact points and damping; always with rows for damping."""
    xi, share = contact_points("rectangular", contacts.points)
    damp = damping(True, contacts.stiffness_damping, contacts.mass_damping)
    return {"g": gravity, "gx": 0.0, "xi": xi, "sh": share, "damp": damp}
