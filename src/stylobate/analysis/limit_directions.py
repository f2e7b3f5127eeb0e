"""Limit analysis by direction: the multiplier all round a column or an assembly, and where it is weakest."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..campaign.campaign import Progress
from ..column import Column
from ..column.found_geometry import SpaceGeometry, base_axes, inside_overlap, space_geometry, space_load, upward
from ..column.spatial.assembly import in_space
from ..column.structure import Structure
from ..constants import DEGREE
from ..errors import InputError, check_kind
from ..notebook import Shown
from .limit import DirectionLimit, limit_analysis
from .limit_assemblies import AssemblyProgramme
from .limit_with_links import SpaceProgramme

#: Directions that are looked at where nobody says which [degrees], and halvings of the multiplier.
ALL_ROUND, HALVINGS = tuple(float(one) for one in range(0, 360, 15)), 60

#: Most directions of one analysis.
MOST_DIRECTIONS = 360

#: Multipliers that differ by less than this share are the same where the least of them is looked for [-].
CLOSE = 1e-5

#: A column that bears more than this is not held by its joints alone [g].
LARGEST = 1e3

#: The limit in a direction [degrees], and whether the most that links hold is looked for.
Solve = Callable[[float, bool], DirectionLimit]


@dataclass(frozen=True, eq=False)
class LimitByDirection(Shown):
    """Result of :func:`limit_directions`: one limit for each direction.

    Parameters
    ----------
    limits : tuple of DirectionLimit
        Of the directions given, then of those in which the weakest was looked for between them.
    dims : str
        ``xz`` or ``xyz``.
    all_round : bool
        Whether the weakest one is that of all directions, and not only of those given.
    """

    limits: tuple[DirectionLimit, ...]
    dims: str
    all_round: bool = False

    @property
    def azimuths(self) -> np.ndarray:
        """Direction of the forces [degrees]."""
        return np.array([limit.azimuth for limit in self.limits])

    @property
    def multipliers(self) -> np.ndarray:
        """λ [g], shape of :attr:`azimuths`."""
        return np.array([limit.multiplier for limit in self.limits])

    @property
    def weakest(self) -> DirectionLimit:
        """The direction in which least is borne; the first of equal ones."""
        least = self.multipliers.min() * (1.0 + 1e-9)
        return next(limit for limit in self.limits if limit.multiplier <= least)

    def summary(self) -> dict[str, Any]:
        """Several directions in the JSON object of ``stylobate limit``."""
        weak = self.weakest
        directions = [
            {"azimuth_deg": one.azimuth, "multiplier_g": one.multiplier, "joint": one.joint, "mode": one.mode}
            | one.summary()
            for one in self.limits
        ]
        return {
            "collapse_multiplier_g": weak.multiplier,
            "weakest_azimuth_deg": weak.azimuth,
            "all_round": self.all_round,
            "active_joints": [{"joint": weak.joint, "mode": weak.mode, "rate": None}],
            "dims": self.dims,
            "directions": directions,
            **weak.summary(),
        }


def limit_directions(
    structure: Structure, azimuths: Sequence[float] | None = None, *, progress: Progress | None = None, **loads: Any
) -> LimitByDirection:
    """Collapse multiplier of a column or of an assembly in space in several directions.

    Where the directions go all round, without a gap of 180 degrees or more, the weakest of all is looked for between them:
    the pushes that are borne make a convex figure, so that nothing less is borne between two directions than the chord
    between what is borne in them. The direction in which a chord is nearest is looked at next, until none is nearer than the
    least multiplier by more than 1e-5 of it, or as many directions again have been.

    Parameters
    ----------
    structure : Column, Assembly or SpatialAssembly
    azimuths : sequence of float, optional
        Where the forces push to, from x towards y [degrees]; up to 360 of them. By default both directions of the plane for
        an assembly of the plane and a column found in it, and every 15 degrees for any other.
    progress : callable, optional
        Hears how many directions are done, of how many at most; what links hold at most in the weakest is one more.
    **loads
        Of :func:`stylobate.limit_analysis`, for the directions of the plane.

    Raises
    ------
    InputError
        A direction that is not finite, none, or too many; a column on rings; an assembly that does not stand, or
        of the plane and has links or round drums.
    """
    column = check_kind("structure", structure, Structure).stack
    if azimuths is None and column is not None and column.as_found and column.as_found.in_plane:
        return LimitByDirection(tuple(_in_plane(column, one, loads) for one in (0.0, 180.0)), "xz")
    stands = in_space(structure)
    if azimuths is None and stands is not structure:
        azimuths = (0.0, 180.0)
    asked = ALL_ROUND if azimuths is None else tuple(float(azimuth) for azimuth in azimuths)
    if not asked or not np.isfinite(asked).all():
        raise InputError("the directions are empty or not finite; give azimuths in degrees, such as 0:345:24.")
    if len(asked) > MOST_DIRECTIONS:
        raise InputError(
            f"there are {len(asked)} directions; allowed are 1 to {MOST_DIRECTIONS}: 0:345:24 is enough, because the "
            "weakest direction between them is looked for.",
            "directions",
            value=len(asked),
            allowed=f"1 to {MOST_DIRECTIONS}",
        )
    solve: Solve = AssemblyProgramme(stands).solve if column is None else _of_column(column)
    found = _all_limits(solve, asked, progress)
    weakest = found.weakest
    if not weakest.links:
        return found
    count = len(weakest.links)
    logging.getLogger("stylobate").info(
        "looking for the most that %d link%s can hold, pushed towards %g degrees.",
        count,
        "s" * (count > 1),
        weakest.azimuth,
    )
    told = solve(weakest.azimuth, True)
    limits = tuple(told if one is weakest else one for one in found.limits)
    return LimitByDirection(limits, found.dims, found.all_round)


def _of_column(column: Column) -> Solve:
    """Limit of a column by the direction, and whether the most that links hold is looked for."""
    if not column.links:
        return lambda one, _: limit_in_space(column, one)
    column.must_carry_on_whole_faces("limit analysis in space")
    programme = SpaceProgramme(column)
    return lambda one, largest: DirectionLimit(one, *programme.solve(one, largest))


def _all_limits(solve: Solve, asked: Sequence[float], progress: Progress | None = None) -> LimitByDirection:
    """Limits of all directions, and of those in which the weakest of all is looked for where they go all round."""
    turns = np.sort(np.mod(asked, 360.0))
    around = bool((np.diff(turns, append=turns[0] + 360.0) < 180.0).all())
    limits: list[DirectionLimit] = []
    most = len(asked) * (1 + around)

    def look(azimuth: float) -> None:
        limits.append(solve(azimuth, False))
        if progress is not None:
            progress(len(limits), most + 1)

    for one in asked:
        look(one)
    while len(limits) < most and (weaker := _may_be_weaker(limits)) is not None:
        look(weaker)
    return LimitByDirection(tuple(limits), "xyz", around)


def _may_be_weaker(limits: Sequence[DirectionLimit]) -> float | None:
    """Direction in which a chord between neighbours is nearest [degrees]; None where none is nearer than the least."""
    order = sorted(limits, key=lambda limit: limit.azimuth % 360.0)
    nearest, where = min(limit.multiplier for limit in limits) * (1.0 - CLOSE), None
    for one, other in zip(order, [*order[1:], order[0]], strict=True):
        start, end = (
            limit.multiplier * np.array((math.cos(limit.azimuth * DEGREE), math.sin(limit.azimuth * DEGREE)))
            for limit in (one, other)
        )
        chord = end - start
        along = -float(start @ chord)
        if 0.0 < along < float(chord @ chord):
            x, y = (start + along / float(chord @ chord) * chord).tolist()
            if math.hypot(x, y) < nearest:
                nearest, where = math.hypot(x, y), round(math.atan2(y, x) / DEGREE % 360.0, 2) % 360.0
    return where


def weakest_direction(column: Column) -> DirectionLimit:
    """What :func:`limit_directions` finds weakest, without the most that each link holds.

    Without links a column bears no more than with them, and what it bears then costs next to nothing: where it bears no
    more with them in the direction that is weakest without, no other direction is weaker.
    """
    bare = limit_directions(column.replace(links=()))
    if not column.links or bare.dims == "xz":
        return limit_directions(column).weakest
    solve = _of_column(column)
    weak = solve(bare.weakest.azimuth, False)
    if weak.multiplier <= bare.weakest.multiplier * (1.0 + CLOSE):
        return weak
    return _all_limits(solve, ALL_ROUND).weakest


def _in_plane(column: Column, direction: float, loads: dict[str, Any]) -> DirectionLimit:
    found = limit_analysis(column, direction=direction, **loads)
    lowest = next(item for item in found.active if item.joint == found.governing_joint)
    return DirectionLimit(direction, found.multiplier, lowest.joint, lowest.mode.split()[0], found.links)


def limit_in_space(column: Column, azimuth: float = 0.0) -> DirectionLimit:
    """Collapse multiplier of horizontal forces, in proportion to mass, in one direction in space.

    A stack without links is statically determinate: what lies above a joint presses it with one force, which must pass
    through the overlap of its faces and within the cone of friction. A single force does not twist the joint about the point
    at which it acts. Rigid drums, joints of unlimited strength; static and kinematic bound coincide. With links see
    :mod:`stylobate.analysis.limit_with_links`.

    Parameters
    ----------
    column : Column
    azimuth : float
        Where the forces push to, from x towards y [degrees].
    """
    column.must_carry_on_whole_faces("limit analysis in space")
    if column.links:
        return limit_directions(column, [azimuth]).limits[0]
    at = space_geometry(column)
    angle = azimuth * DEGREE
    push = base_axes(column).T @ (np.cos(angle), np.sin(angle), 0.0)
    best = DirectionLimit(azimuth, LARGEST, 0, "")
    for joint in range(column.n):
        if not _gives_way(column, at, joint, best.multiplier, push):
            continue
        low, high = 0.0, best.multiplier
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if _gives_way(column, at, joint, middle, push) else (middle, high)
        # equal ones, as of sliding on equal joints, are told of the lowest
        if best.joint == 0 or high < best.multiplier * (1.0 - 1e-9):
            best = DirectionLimit(azimuth, high, joint + 1, _gives_way(column, at, joint, high, push))
    if best.joint == 0:
        raise InputError(
            f"{column.name!r} bears more than {LARGEST:g} g towards {azimuth:g} degrees; no such column stands freely."
        )
    return best


def _gives_way(column: Column, at: SpaceGeometry, joint: int, multiplier: float, push: np.ndarray) -> str:
    """Mechanism of a joint under a multiplier; empty where it holds."""
    load = space_load(column, at, joint, column.gravity * (upward(column) - multiplier * push))
    law = column.joints[joint]
    if load.normal <= 0.0:
        return "rocking"
    if np.hypot(*load.shear) > column.friction[joint] * load.normal + law.cohesion * column.joint_areas[joint]:
        return "sliding"
    return "rocking" if inside_overlap(column, at, joint, load.place) < 0.0 else ""
