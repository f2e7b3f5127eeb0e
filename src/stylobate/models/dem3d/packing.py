"""Structure as the kernels in space want it: one lane of their records; a column's fields of drums, joints and lane."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ...column import Column
from ...column.found_geometry import base_axes, space_geometry, upward
from ...kernels.dem3d.records import CHIPS, RINGS
from ..drums.bodies import body_fields
from ..drums.records import UNSEEN
from .arrays import Records


def pack_column(
    records: Records,
    column: Column,
    fields: tuple[dict[str, np.ndarray], dict[str, np.ndarray], dict[str, Any]],
    links: Mapping[str, np.ndarray],
    top: Callable[[Records, np.ndarray], np.ndarray],
) -> np.ndarray:
    """Numbers of a lane with a column, from the fields of its drums, joints and lane; ``records`` are empty ones.

    Slips and twists count from where the joints are, turns from where the axes are.
    """
    body, joint, lane = fields
    records.fill(0, body=body | {"a" + c: body["k" + c] for c in "xyz"}, joint=joint, lane=lane)
    _, slip, twist = records.joints(0)
    records.fill(0, joint={"ox": slip[:, 0], "oy": slip[:, 1], "ot": twist, "tw": twist})
    records.fill(0, feed={"r": base_axes(column).T.ravel()}, link=links)
    records.fill(0, watch=UNSEEN | dict(zip(("sx", "sy"), top(records, np.array([0]))[0], strict=True)))
    return records.taken(0)


#: Radius of the base, wide enough to be a half-space [m].
BASE_RADIUS = 1.0e3

#: Radius of a sunken middle that is none [m].
LEAST = 1e-9


def drum_fields(column: Column, closure: np.ndarray) -> dict[str, np.ndarray]:
    """Fields of the drums that are not 0, or that links need, the base first: upright, at rest, each joint closed by
    ``closure`` [m], shape (n,)."""
    n, plane = column.n + 1, body_fields(column, closure)
    centroid = np.array([drum.centroid_height for drum in column.drums])
    axial = np.array([drum.axial_inertia for drum in column.drums])
    zero, one = np.zeros(n), np.ones(n)

    def on_base(values: Any, base: float = 0.0) -> np.ndarray:
        return np.concatenate(([base], values))

    cross = np.array([drum.cross_inertia for drum in column.drums])
    half = {
        name: [0.5 * getattr(drum, name) for drum in column.drums]
        for name in ("bottom_width", "top_width", "depth", "upper_depth")
    }
    axes = {axis + c: one if "ijk".index(axis) == "xyz".index(c) else zero for axis in "ijk" for c in "xyz"}
    return (
        axes
        | {name: plane[name] for name in ("x", "z", "m", "im")}
        | {
            "y": zero,
            "ia": plane["ii"],
            "ic": on_base(1.0 / axial - 1.0 / column.inertias),
            "ib": on_base(np.where(cross == column.inertias, 0.0, 1.0 / cross - 1.0 / column.inertias)),
            "fx": zero,
            "fy": zero,
            "fz": on_base(-centroid),
            "nz": one,
            "ht": on_base(column.heights - centroid),
            "tx": on_base(half["top_width"], BASE_RADIUS),
            "ty": on_base(half["upper_depth"], BASE_RADIUS),
        }
        | (_round(half, on_base) if column.section == "circular" else _cornered(half, on_base))
    )


def _round(half: dict[str, list[float]], on_base: Callable[..., np.ndarray]) -> dict[str, np.ndarray]:
    """Radii of the faces."""
    return {"rb": on_base(half["bottom_width"]), "rt": on_base(half["top_width"], BASE_RADIUS)}


#: Signs of the corners of a face in order round it; mirror images in the plane of x and z follow one another.
CORNERS = np.array([(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)])


def _cornered(half: dict[str, list[float]], on_base: Callable[..., np.ndarray]) -> dict[str, np.ndarray]:
    """Corners of the faces, and how far the farthest is."""
    along, depth = on_base(half["bottom_width"]), on_base(half["depth"])
    return {
        "px": along[:, None] * CORNERS[:, 0],
        "py": depth[:, None] * CORNERS[:, 1],
        "rb": np.hypot(along, depth),
        "rt": np.hypot(on_base(half["top_width"], BASE_RADIUS), on_base(half["upper_depth"])),
    }


def joint_fields(column: Column, kn: np.ndarray, ks: np.ndarray) -> dict[str, np.ndarray]:
    """Fields of the joints that are not 0, the one with the base first."""
    own = {"ring": _sunken(column)} if column.on_rings else {"chip": _lost(column)} if chipped(column) else {}
    cohesion = np.array([joint.cohesion for joint in column.joints])
    return own | {"kn": kn, "ks": ks, "co": cohesion, "mu": column.friction}


def chipped(column: Column) -> bool:
    """Whether drums are round and chipped."""
    return column.section == "circular" and any(drum.chipped for drum in column.as_found.drums)


def chip_directions(column: Column) -> np.ndarray:
    """Towards the chip of every drum's lower face, in the axes of the drum [-], shape (n, 3)."""
    found = [column.as_found.of(i + 1) for i in range(column.n)]
    azimuth = np.radians([one.chip_azimuth for one in found])
    away = [-1.0 if one.chip_left else 1.0 for one in found]
    flat = np.stack((away * np.cos(azimuth), away * np.sin(azimuth)), axis=1)
    return np.einsum("nca,na->nc", space_geometry(column).bed[:, :, :2], flat)


def _lost(column: Column) -> np.ndarray:
    """Loss by chips of the upper face of every joint (legend of kernels), (n, 6)."""
    lost = np.zeros((column.n, CHIPS))
    lost[:, :3] = chip_directions(column)
    for i, drum in enumerate(column.drums):
        versine = 2.0 * max(column.as_found.of(i + 1).chips) / drum.bottom_width
        sine = math.sqrt(versine * (2.0 - versine))
        lost[i, 3:] = math.atan2(sine, 1.0 - versine), 1.0 - versine, sine
    return lost


def _sunken(column: Column) -> np.ndarray:
    """Radii of the sunken middles of the upper and the lower face [m], and the limit of torsion over ρ μ N, (n, 3).

    The limit is that of two concentric rings under even pressure.
    """
    holes = np.zeros((column.n, RINGS))
    for j in range(column.n):
        radius = 0.5 * column.joint_widths[j]
        upper, lower = (0.5 * width for width in column.sunken_widths(j))
        inner = max(upper, lower)
        evenly = 2.0 / 3.0 * (radius**3 - inner**3) / (radius**2 - inner**2)  # Eq. (E11)
        holes[j] = max(upper, LEAST), max(lower, LEAST), evenly / math.sqrt(0.5 * (radius**2 + inner**2))
    return holes


def lane_fields(
    column: Column,
    damping: np.ndarray,
    pivot_friction: float,
    planar: bool,
    rolling_resistance: float = 0.0,
) -> dict[str, Any]:
    """Fields of a lane that are not 0; ``damping`` from :func:`damping_rows`, other parameters as of the model."""
    return {
        "g": column.gravity * upward(column),
        "damp": damping,
        "pivot": pivot_friction,
        "roll": rolling_resistance,
        "free": 0.0 if planar else 1.0,
    }
