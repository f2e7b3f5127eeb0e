"""A column as the kernels in space want it: fields of drums, joints and lanes."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...column import Column

#: Radius of the base, wide enough to be a half-space [m].
BASE_RADIUS = 1.0e3


def drum_fields(column: Column, closure: np.ndarray) -> dict[str, np.ndarray]:
    """Fields of the drums, the base first: upright, at rest, each joint closed by ``closure`` [m], shape (n,)."""
    n = column.n + 1
    centroid = np.array([drum.centroid_height for drum in column.drums])
    axial = np.array([drum.axial_inertia for drum in column.drums])
    zero, one = np.zeros(n), np.ones(n)

    def on_base(values: Any, base: float = 0.0) -> np.ndarray:
        return np.concatenate(([base], values))

    fields = dict.fromkeys(("x", "y", "vx", "vy", "vz", "lx", "ly", "lz", "wx", "wy", "wz"), zero)
    fields |= {axis + c: one if "ijk".index(axis) == "xyz".index(c) else zero for axis in "ijk" for c in "xyz"}
    return fields | {
        "z": on_base(column.centroid_heights - np.cumsum(closure)),
        "m": on_base(column.masses),
        "im": on_base(1.0 / column.masses),
        "ia": on_base(1.0 / column.inertias),
        "ic": on_base(1.0 / axial - 1.0 / column.inertias),
        "fx": zero,
        "fy": zero,
        "fz": on_base(-centroid),
        "nx": zero,
        "ny": zero,
        "nz": one,
        "ht": on_base(column.heights - centroid),
        "rb": on_base([0.5 * drum.bottom_width for drum in column.drums]),
        "rt": on_base([0.5 * drum.top_width for drum in column.drums], BASE_RADIUS),
    }


def joint_fields(column: Column, kn: np.ndarray, ks: np.ndarray) -> dict[str, np.ndarray]:
    """Fields of the joints, the one with the base first; behind the topmost joint stands one without force."""

    def with_free_top(values: Any) -> np.ndarray:
        return np.concatenate((values, [0.0]))

    memory = {name: np.zeros(column.n + 1) for name in ("t", "kf", "kt", "en", "ox", "oy", "ot")}
    memory |= {name: np.zeros((column.n + 1, 3)) for name in ("s", "f", "up", "lo")}
    return memory | {
        "kn": with_free_top(kn),
        "ks": with_free_top(ks),
        "co": with_free_top([joint.cohesion for joint in column.joints]),
        "mu": with_free_top([joint.tan_phi for joint in column.joints]),
    }


def lane_fields(column: Column, model: Any) -> dict[str, Any]:
    """Fields of a lane at the start of a run."""
    sums = dict.fromkeys(("local", "work", "shear", "visc"), 0.0)
    return sums | {
        "g": np.array([0.0, 0.0, column.gravity]),
        "beta": model.stiffness_damping,
        "alpha": model.mass_damping,
        "pivot": model.pivot_friction,
        "free": 0.0 if model.planar else 1.0,
    }
