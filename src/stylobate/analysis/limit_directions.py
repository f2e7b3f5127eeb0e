"""Limit analysis by direction: the multiplier all round a column or an assembly, and where it is weakest."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..campaign.campaign import Progress
from ..column import Column
from ..column.found_in_space import SpaceGeometry, base_axes, inside_overlap, space_geometry, space_load, upward
from ..column.spatial.prisms import in_space
from ..column.structure import Structure
from ..constants import DEGREE
from ..errors import InputError, check_kind
from ..notebook import Shown
from .limit import DirectionLimit, LimitResult, limit_analysis
from .limit_assemblies import AssemblyProgramme
from .limit_with_links import SpaceProgramme

#: Directions that are looked at where nobody says which [degrees], and halvings of the multiplier.
ALL_ROUND, HALVINGS = tuple(float(one) for one in range(0, 360, 15)), 60

#: Multipliers that differ by less than this share are the same where only the least of them is asked for [-].
CLOSE = 1e-6

#: A column that bears more than this is not held by its joints alone [g].
LARGEST = 1e3


@dataclass(frozen=True, eq=False)
class LimitByDirection(Shown):
    """Result of :func:`limit_directions`: one limit for each direction."""

    limits: tuple[DirectionLimit, ...]
    dims: str

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
            "active_joints": [{"joint": weak.joint, "mode": weak.mode, "rate": None}],
            "dims": self.dims,
            "directions": directions,
            **weak.summary(),
        }


def limit_directions(
    structure: Structure, azimuths: Sequence[float] | None = None, *, progress: Progress | None = None, **loads: Any
) -> LimitByDirection:
    """Collapse multiplier of a column or of an assembly in space in several directions.

    Parameters
    ----------
    structure : Column, Assembly or SpatialAssembly
    azimuths : sequence of float, optional
        Where the forces push to, from x towards y [degrees]. By default both directions of the plane for an assembly of the
        plane and a column found in it, and every 15 degrees for any other.
    progress : callable, optional
        Hears how many directions are done, of how many; what links hold at most in the weakest is one more.
    **loads
        Of :func:`stylobate.limit_analysis`, for the directions of the plane.

    Raises
    ------
    InputError
        A direction that is not finite, or none; a column on rings; an assembly that does not stand, or
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
    if column is None:
        return _with_largest(AssemblyProgramme(stands).solve, asked, progress)
    if not column.links:
        return LimitByDirection(tuple(limit_in_space(column, one) for one in asked), "xyz")
    column.must_carry_on_whole_faces("limit analysis in space")
    programme = SpaceProgramme(column)  # what it learns in one direction serves the next
    return _with_largest(lambda one, largest: DirectionLimit(one, *programme.solve(one, largest)), asked, progress)


def _with_largest(
    solve: Callable[[float, bool], DirectionLimit], asked: Sequence[float], progress: Progress | None
) -> LimitByDirection:
    """All directions; in the weakest one also the most that links hold."""
    limits = []
    for one in asked:
        limits.append(solve(one, False))
        if progress is not None:
            progress(len(limits), len(asked) + 1)
    found = LimitByDirection(tuple(limits), "xyz")
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
    return LimitByDirection(tuple(told if one is weakest else one for one in found.limits), "xyz")


def weakest_direction(column: Column) -> DirectionLimit:
    """What :func:`limit_directions` finds weakest, without the most that each link holds.

    Without links a column bears no more than with them, and what it bears then costs next to nothing: directions in which
    it bears more than the least that is known with links are not computed with them.
    """
    if not column.links:
        return limit_directions(column).weakest
    bare = limit_directions(column.replace(links=()))
    if bare.dims == "xz":
        return limit_directions(column).weakest
    column.must_carry_on_whole_faces("limit analysis in space")
    programme = SpaceProgramme(column)
    found: list[DirectionLimit] = []
    for one in sorted(bare.limits, key=lambda limit: limit.multiplier):
        if found and one.multiplier * (1.0 + CLOSE) >= min(limit.multiplier for limit in found):
            break
        found.append(DirectionLimit(one.azimuth, *programme.solve(one.azimuth)))
    return LimitByDirection(tuple(sorted(found, key=lambda limit: limit.azimuth)), "xyz").weakest


def _in_plane(column: Column, direction: float, loads: dict[str, Any]) -> DirectionLimit:
    found = limit_analysis(column, direction=direction, **loads)
    return DirectionLimit(direction, found.multiplier, found.governing_joint, mode_of(found), found.links)


def mode_of(found: LimitResult) -> str:
    """``rocking`` or ``sliding``, of the lowest joint of the mechanism."""
    return next(item.mode.split()[0] for item in found.active if item.joint == found.governing_joint)


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
