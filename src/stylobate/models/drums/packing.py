"""A column of drums in the numbers of the kernel, and the step of its run."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...column import Column
from ...column.found_geometry import gravity_vector
from ...kernels.run_codes import CHUNK
from ...motion import Motion
from ..shared.soft_joints import resolving

#: Half width of the base, wide enough to be a half-plane [m].
BASE_HALF_WIDTH = 1.0e4


@dataclass(frozen=True)
class PackedColumn:
    """A column as the kernel wants it; ``toes`` is what its joints give with their load on their edge [J], shape (n,)."""

    fields: tuple[dict[str, np.ndarray], dict[str, np.ndarray], dict[str, Any]]
    step: float
    toes: np.ndarray
    links: Any = None


def drum_fields(column: Column, closure: np.ndarray) -> dict[str, np.ndarray]:
    """Fields of the drums, the base first: upright, at rest, each joint closed by ``closure`` [m], shape (n,)."""
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


def whole_steps(motion: Motion, tail: float, step: float) -> tuple[float, int]:
    """Largest step up to ``step`` that resolves the motion and of which whole chunks fill it [s], and how many chunks
    there are with the tail.

    The tail has no say in the step: what happens before it does not depend on it.
    """
    step = resolving(step, motion)
    dt = motion.duration / (CHUNK * max(1, math.ceil(motion.duration / (CHUNK * step))))
    return dt, math.ceil((motion.duration + tail) / (CHUNK * dt) * (1.0 - 1e-12))


def lane_fields(column: Column, stiffness_damping: float, mass_damping: float) -> dict[str, Any]:
    """Fields of a lane at the start of a run."""
    sums = dict.fromkeys(("local", "work", "shear", "visc"), 0.0)
    down = gravity_vector(column)
    return sums | {
        "g": float(-down[1]),
        "gx": float(-down[0]),
        "beta": stiffness_damping,
        "alpha": mass_damping,
    }
