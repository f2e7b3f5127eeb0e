"""Does a column in space that stands now stand for good? What the energy that is left in it could still do."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from ...column import Column
from ...column.found_in_space import SpaceGeometry, inside_overlap, space_geometry, space_load, upward
from ...constants import DEGREE
from ..shared.toes import centroids_above
from .arrays import Records


def stands_for_good(
    column: Column, records: Records, lane: int, energy: float, stand: np.ndarray, walks: bool = True
) -> bool:
    """Whether a column that no input shakes any more can neither overturn nor slide apart. Eq. (V1), in space.

    Parameters
    ----------
    column : Column
    records : Records
        In which the column is.
    lane : int
    energy : float
        Kinetic, gravitational and elastic energy above that of the column at rest [J].
    stand : array
        See :func:`numbers_for`.
    walks : bool
        A drum that wobbles on another one may walk: joints between drums have their support narrowed by ``WALK``
        (``kernels/dem3d/standing.py``). Walking without slip costs nothing, so that no bound by energy is a proof; the
        margin is measured, see the theory page.
    """
    from ...kernels.dem3d.standing import centroids_inside, stands, turns_of

    _, slip, _ = records.joints(lane)
    body, joint, of_lane = records.body, records.joint, records.lane
    if not column.as_found:
        return bool(stands(stand, slip, energy, column.gravity, walks, body, joint, of_lane, lane))
    if not centroids_inside(body, joint, of_lane, lane):
        return False
    twist = np.diff(np.unwrap(turns_of(body, lane)))
    twist -= [column.as_found.of(i + 1).turn * DEGREE for i in range(column.n)]
    flat = space_geometry(column, slip=slip, twist=twist)
    # what sliding down a slope has set free is not there any more to fall back on
    lower = _height_as_found(column) - float(column.masses @ flat.centroid @ upward(column))
    return bool(energy + max(lower * column.gravity, 0.0) < found_barrier(column, flat, stand, walks))


@lru_cache(maxsize=4096)
def _height_as_found(column: Column) -> float:
    """Mass times the height of all drums as they were found [kg m]."""
    return float(column.masses @ space_geometry(column).centroid @ upward(column))


def numbers_for(column: Column, toes: np.ndarray) -> np.ndarray:
    """Numbers of a column for the law, see ``kernels/dem3d/standing.py``.

    ``toes`` is what each joint gives with its load on its edge (:mod:`stylobate.models.shared.toes`) [J], shape (n,).
    """
    from ...kernels.dem3d.standing import STAND_TYPE

    stand: Any = np.zeros(column.n, STAND_TYPE)
    drums, below = column.drums, column.drums[:-1]
    stand["m"], stand["rough"], stand["toe"] = column.masses, column.friction, toes
    stand["along"], stand["across"] = np.transpose([(0.5 * drum.bottom_width, 0.5 * drum.depth) for drum in drums])
    stand["under"] = [math.inf, *(0.5 * drum.top_width for drum in below)]
    stand["beside"] = [math.inf, *(0.5 * drum.upper_depth for drum in below)]
    stand["weight"], stand["moment"] = column.joint_weights, column.joint_weights * 0.5 * column.joint_widths
    stand["over"] = centroids_above(column)
    return stand


def found_barrier(column: Column, flat: SpaceGeometry, stand: np.ndarray, walks: bool = False) -> float:
    """As ``lowest_barrier`` of the law for a column as found, its drums put down flat where they are; a lower bound [J].

    On a joint that slopes by γ the nearest edge is b cos γ away across gravity, and may lie b sin γ lower; friction is what
    the slope leaves of it.
    """
    from ...kernels.dem3d.standing import WALK
    from ...kernels.shared.overturning import barrier

    up = upward(column)
    level = np.minimum(flat.frame[:, :, 2] @ up, 1.0)
    slope = np.arccos(level)
    friction = np.array([math.tan(max(math.atan(one) - s, 0.0)) for one, s in zip(column.friction, slope, strict=True)])
    lowest = math.inf
    for j in range(column.n):
        mass = column.masses[j:]
        load = space_load(column, flat, j)
        inside = inside_overlap(column, flat, j, load.place) if load.normal > 0.0 else 0.0
        if inside <= 0.0:
            return 0.0
        inside *= 1.0 - WALK if walks and j else 1.0
        place = flat.origin[j] + flat.frame[j, :, :2] @ load.place
        height = float((mass @ flat.centroid[j:] / mass.sum() - place) @ up) + inside * math.sin(slope[j])
        weight = column.gravity * float(mass.sum()) * level[j]
        loose = friction[max(j, 1) :].min(initial=math.inf)
        lowest = min(lowest, barrier(stand, j, inside * level[j], height, loose, weight))
    return lowest
