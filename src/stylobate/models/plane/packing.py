"""A column in the numbers of the engine in the plane: one lane of its records, and which contacts there are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from ...column import Column
from ...column.found_geometry import gravity_vector
from ..drums.joints import contact_points
from ..drums.links import acting, kind_of

#: Half width of the base, wide enough to be a half-plane [m].
BASE_HALF_WIDTH = 1.0e4


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


def drum_fields(column: Column, closure: np.ndarray) -> dict[str, np.ndarray]:
    """Numbers of the drums, the base first: upright, at rest, each joint closed by ``closure`` [m], shape (n,).

    Besides fields of ``body``: ``hb`` and ``ht``, centroid to the lower and to the upper face [m]; ``bl`` and ``br``, from
    the centroid's foot on the lower face to that face's left and right end, ``t``, half width of the upper face [m];
    ``fc`` and ``fs``, cosine and sine of the upper face's inclination to the lower one.
    """
    centroid = np.array([drum.centroid_height for drum in column.drums])
    n = column.n + 1

    def on_base(values: np.ndarray | list[float], base: float = 0.0) -> np.ndarray:
        return np.concatenate(([base], values))

    half = on_base([drum.bottom_width / 2 for drum in column.drums])

    at_rest = {name: np.zeros(n) for name in ("x", "th", "s", "vx", "vz", "w")}
    return at_rest | {
        "z": on_base(column.centroid_heights - np.cumsum(closure)),
        "c": np.ones(n),
        "m": on_base(column.masses),
        "i": on_base(column.inertias),
        "im": on_base(1.0 / column.masses),
        "ii": on_base(1.0 / column.inertias),
        "hb": on_base(centroid),
        "ht": on_base(column.heights - centroid),
        "bl": half,
        "br": half,
        "fc": np.ones(n),
        "fs": np.zeros(n),
        "t": on_base([drum.top_width / 2 for drum in column.drums], BASE_HALF_WIDTH),
    }


#: Fields of ``body`` among the numbers of the drums.
OF_BODY = ("x", "z", "th", "c", "s", "vx", "vz", "w", "m", "i", "im", "ii")


def body_fields(drums: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Fields of the bodies from the numbers of the drums."""
    return {name: drums[name] for name in OF_BODY}


def face_fields(drums: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Fields that say where the faces of the joints are, from the numbers of the drums, each of shape (n,)."""
    lower = {"ht": "ht", "wl": "t", "wr": "t", "lc": "fc", "ls": "fs"}
    upper = {"hb": "hb", "bl": "bl", "br": "br"}
    n = len(drums["x"]) - 1
    faces = {name: drums[of][:-1] for name, of in lower.items()} | {name: drums[of][1:] for name, of in upper.items()}
    return faces | {"uc": np.ones(n), "us": np.zeros(n)}


def lane_fields(column: Column) -> dict[str, Any]:
    """Fields of a lane at the start of a run, but for damping and contact points."""
    down = gravity_vector(column)
    return dict.fromkeys(("work", "shear", "visc"), 0.0) | {"g": float(-down[1]), "gx": float(-down[0])}


def damping(damped: bool, stiffness_damping: float, mass_damping: float) -> np.ndarray:
    """The rows of ``damp``."""
    return np.array([stiffness_damping, mass_damping, 0.0]) if damped else np.zeros(1)


def top_face(drums: Mapping[str, np.ndarray]) -> dict[str, float]:
    """The topmost face, as ``watch`` wants it."""
    return {"th": float(drums["ht"][-1]), "tc": float(drums["fc"][-1]), "ts": float(drums["fs"][-1])}


def lane_of(gravity: float, contacts: Any) -> dict[str, Any]:
    """Fields of a lane of an assembly at the start: level base, contact points and damping; always with rows for damping."""
    xi, share = contact_points("rectangular", contacts.points)
    damp = damping(True, contacts.stiffness_damping, contacts.mass_damping)
    return {"g": gravity, "gx": 0.0, "xi": xi, "sh": share, "damp": damp}
