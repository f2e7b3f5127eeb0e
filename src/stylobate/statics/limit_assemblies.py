"""Limit analysis of assemblies, of what has links, and of forces from all directions."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..campaign.campaign import Progress
from ..column import Column
from ..column.found_geometry import (
    SpaceGeometry,
    base_axes,
    inside_overlap,
    overlap_edges,
    space_geometry,
    space_load,
    upward,
)
from ..column.spatial.assembly import in_space
from ..column.structure import Structure
from ..constants import DEGREE
from ..errors import InputError, check_kind
from ..messages import joined, say
from ..models.rigid_block.block_stack import APART, LINE, SHEAR, Hold, holds
from ..notebook import Shown
from .contacts import MOVES, ContactProgramme, Holder, InfeasibleError, Rim, Solved, gentlest, largest_held
from .limit import SAME, Borne, DirectionLimit, LinkForce, limit_analysis, link_forces, needed_forces


class SpaceLimit(NamedTuple):
    """Multiplier [g], the lowest joint of the mechanism and what it does, and what every link holds."""

    multiplier: float
    joint: int
    mode: str
    links: tuple[LinkForce, ...]


class SpaceProgramme:
    """The programmes of a column: a new one for each direction, which stays small.

    Parameters
    ----------
    column : Column

    Raises
    ------
    InputError
        The column does not stand without its links.
    """

    def __init__(self, column: Column) -> None:
        self.column, self.at = column, space_geometry(column)
        bare = column.replace(links=())
        self.rims = [self._rim(bare, j) for j in range(column.n)]
        self.links = [self._holder(one) for one in holds(column.placed_links) if one.strength]

    def _rim(self, bare: Column, joint: int) -> Rim:
        """The rim of a joint, seen from where its load acts without links."""
        load, edges = space_load(bare, self.at, joint), overlap_edges(bare, self.at, joint)
        inside = load.normal > 0.0 and all(math.dist(load.place, centre) < radius for centre, radius in edges.discs)
        if not (inside and all(normal @ load.place < bound for normal, bound in edges.sides)):
            raise InputError(
                f"the part of {bare.name!r} above joint {joint + 1} does not stand without links; limit analysis in space "
                "takes columns that do."
            )
        cohesion = bare.joints[joint].cohesion * float(bare.joint_areas[joint])
        half, frame, origin = 0.5 * float(bare.joint_widths[joint]), self.at.frame[joint], self.at.origin[joint]
        friction = float(self.column.friction[joint])
        return Rim(joint, joint - 1, frame, origin, edges, load.place, half, friction, cohesion)

    def _holder(self, hold: Hold) -> Holder:
        link, at, (low, high) = hold.link, self.at, hold.link.arms
        bodies = link.upper - 1, link.lower - 1
        upper = at.centroid[bodies[0]] + at.axes[bodies[0]] @ high
        if hold.action == LINE:
            lower = low if link.lower == 0 else at.centroid[bodies[1]] + at.axes[bodies[1]] @ low
            axes = ((lower - upper) / np.linalg.norm(lower - upper))[:, None]
            return Holder(hold.name, hold.action, *bodies, upper, lower, axes, hold.capacity)
        frame = at.frame[link.joint - 1]
        return Holder(hold.name, hold.action, *bodies, upper, upper, held_along(hold, frame), hold.capacity)

    def solve(self, azimuth: float, largest: bool = False) -> SpaceLimit:
        """The multiplier of horizontal forces in proportion to mass towards an azimuth [degrees].

        With ``largest`` also the most that every link holds then, in the column's own axes.
        """
        column, angle = self.column, azimuth * DEGREE
        length = float(column.joint_heights[-1] + column.heights[-1])
        programme = ContactProgramme(column.masses, self.at.centroid, column.gravity, self.rims, self.links, length)
        push = base_axes(column).T @ (math.cos(angle), math.sin(angle), 0.0)
        dead, live = programme.body_force(-upward(column)), programme.body_force(push)
        programme.begin(push)
        found = programme.converged(dead, live, programme.capacities)
        sizes = programme.movements(found.rates)
        joint = int(np.argmax(sizes.max(axis=1) > MOVES * sizes.max()))
        mode = ("rocking", "sliding", "twisting")[int(np.argmax(sizes[joint]))]
        return SpaceLimit(found.multiplier + 0.0, joint + 1, mode, demand(programme, dead, live, found, largest))


def held_along(hold: Hold, frame: np.ndarray) -> np.ndarray:
    """Directions of the force that something across a joint puts on the body above, as columns; ``frame`` the joint's."""
    if hold.action == SHEAR:
        return frame[:, :2]
    return frame[:, 2:] if hold.action == APART else -frame[:, 2:]


def demand(
    programme: ContactProgramme, dead: np.ndarray, live: np.ndarray, found: Solved, largest: bool = False
) -> tuple[LinkForce, ...]:
    """Action of the links at the multiplier of an answer, for these loads.

    Parameters
    ----------
    programme : ContactProgramme
        Its holders with a name are links.
    dead, live : array
        Over the weight, shape (6 n,).
    found : Solved
    largest : bool
        Whether to look for the most that each holds as well.
    """
    links = [k for k, holder in enumerate(programme.holders) if holder.name]
    if not links:
        return ()
    every = programme.capacities

    def borne(found: Solved) -> Borne:
        prices, held = found.prices[links] / programme.weight, programme.held(found.forces)[links]
        return Borne(found.multiplier, prices, held, found.forces)

    def bear(some: np.ndarray, enough: float) -> Borne:
        capacity = every.copy()
        capacity[links] = some
        try:
            return borne(programme.converged(dead, live, capacity, enough))
        except InfeasibleError:  # it does not even stand
            none = np.zeros(len(links))
            return Borne(-math.inf, none, none, found.forces)

    needed = needed_forces(bear, every[links], borne(found))
    told = [programme.holders[k] for k in links]
    if not largest:
        return link_forces(told, needed)
    least = found.multiplier - SAME * max(abs(found.multiplier), 1e-3)
    most = [largest_held(programme, dead, live, least, k) for k in links]
    towards = [None if way is None else tuple(way.tolist()) for _, way in most]
    return link_forces(told, needed, np.array([size for size, _ in most]), towards)


#: What moves with more than this share of the fastest takes part in the mechanism [-].
TAKES_PART = 1e-3

#: Most joints, and what the programme of so many takes in one direction [s]; it grows with their number to this power.
MOST_JOINTS, TAKES, GROWS = 800, 180.0, 2.5

#: Most bodies that a sentence names.
NAMED = 4


class AssemblyProgramme:
    """The programme of an assembly: what has been added for one direction stays for the next.

    Parameters
    ----------
    structure : SpatialAssembly

    Raises
    ------
    InputError
        It does not stand under its own weight, or only rests on edges and corners.
    """

    def __init__(self, structure: Structure) -> None:
        joints = structure.space_joints or ()
        if len(joints) > MOST_JOINTS:
            minutes = TAKES / 60.0 * (len(joints) / MOST_JOINTS) ** GROWS
            raise InputError(
                f"{structure.name!r} has {len(joints)} joints, whose limit analysis would take about {minutes:.0f} minutes "
                f"a direction; allowed are up to {MOST_JOINTS}: take a part of it."
            )
        if not structure.gravity:
            raise InputError(
                f"{structure.name!r} has no gravity, in parts of which forces are told; give it one [m/s²]."
            )
        bodies = structure.bodies
        self.structure = structure
        self.moving = [i for i, one in enumerate(bodies) if not one.fixed]
        number = {body: k for k, body in enumerate(self.moving)}
        stones = [bodies[i] for i in self.moving]
        rims = [
            Rim(
                number.get(joint.upper, -1), number.get(joint.lower, -1), joint.frame, joint.origin, joint.edges,
                np.zeros(2), 0.5 * joint.width, joint.law.tan_phi, joint.law.cohesion * joint.area,
            )
            for joint in joints
        ]  # fmt: skip
        holders = [_holder(one, number) for one in holds(structure.placed_links) if one.strength]
        self.points = [stone.vertices for stone in stones]  # pyright: ignore[reportAttributeAccessIssue]
        every = np.concatenate(self.points)
        centroids = np.array([stone.position for stone in stones])  # pyright: ignore[reportAttributeAccessIssue]
        masses = np.array([stone.mass for stone in stones])
        length = float(np.ptp(every, axis=0).max())
        self.programme = ContactProgramme(
            masses, centroids, structure.gravity, rims, holders, length, repr(structure.name), cut=True
        )
        self.dead = self.programme.body_force(np.array([0.0, 0.0, -1.0]))
        self.programme.begin(np.array([1.0, 0.0, 0.0]))
        self._must_stand()

    def _must_stand(self) -> None:
        held = (*(self.structure.space_joints or ()), *self.structure.placed_links)
        resting = {body for one in held for body in (one.lower, one.upper)}
        loose = next((i for i in self.moving if i not in resting), None)
        if loose is not None:
            raise InputError(
                f"block {self.structure.bodies[loose].name!r} rests on no face, only on edges or corners; limit "
                "analysis takes what lies on faces: lay it on one."
            )
        missing, rates = self.programme.unbalanced(self.dead)
        if missing:
            names = self._who(rates)
            raise InputError(
                f"{self.structure.name!r} does not stand under its own weight: {listed(names)} "
                f"{'begins' if len(names) == 1 else 'begin'} to move; correct its geometry or its friction."
            )

    def solve(self, azimuth: float, largest: bool = False) -> DirectionLimit:
        """The limit of horizontal forces in proportion to mass towards an azimuth [degrees].

        With ``largest`` also the most that every link holds then.
        """
        angle, programme = azimuth * DEGREE, self.programme
        push = np.array([math.cos(angle), math.sin(angle), 0.0])
        live = programme.body_force(push)
        found = programme.converged(self.dead, live, programme.capacities)
        rates = gentlest(programme, self.dead, live, found)
        sizes = programme.movements(rates)
        active = np.flatnonzero(sizes.max(axis=1) > TAKES_PART * sizes.max())
        joint = int(min(active, key=lambda k: (round(float(programme.rims[k].origin[2]), 6), k)))
        mode = ("rocking", "sliding", "twisting")[int(np.argmax(sizes[joint]))]
        joints = self.structure.space_joints or ()
        slides = bool((sizes[:, 1] > TAKES_PART * sizes.max()).any())
        twists = any(
            one.round and size > TAKES_PART * sizes.max() for one, size in zip(joints, sizes[:, 2], strict=True)
        )
        between = joints[joint].lower, joints[joint].upper
        return DirectionLimit(
            azimuth,
            found.multiplier + 0.0,
            joint + 1,
            mode,
            demand(programme, self.dead, live, found, largest),
            between=tuple(self.structure.bodies[i].name for i in between),
            moving=tuple(self._who(rates)),
            upper_bound=slides or twists,
        )

    def _who(self, rates: np.ndarray) -> list[str]:
        """Bodies that move, in their order."""
        fastest = [
            max(float(np.linalg.norm(self.programme.velocity(k, point, rates))) for point in corners)
            for k, corners in enumerate(self.points)
        ]
        most = max(fastest)
        return [self.structure.bodies[i].name for i, one in zip(self.moving, fastest) if one > TAKES_PART * most]


def _holder(hold: Hold, number: Mapping[int, int]) -> Holder:
    """What a link holds, by the numbers of the bodies in the programme."""
    link = hold.link
    bodies = number.get(link.upper, -1), number.get(link.lower, -1)
    if hold.action == LINE:
        low, high = np.array(link.low), np.array(link.high)
        return Holder(hold.name, LINE, *bodies, high, low, ((low - high) / link.length)[:, None], hold.capacity)
    middle = np.array(link.middle)
    axes = held_along(hold, np.array(link.frame).T)
    return Holder(hold.name, hold.action, *bodies, middle, middle, axes, hold.capacity)


def listed(names: Sequence[str]) -> str:
    """Names in a sentence, not too many of them; drums of one column together."""
    groups: dict[str, list[str]] = {}
    for name in names:
        column, _, drum = name.rpartition(", ")
        groups.setdefault(column if column and drum.startswith("drum ") else name, []).append(name)
    alone = [some[0] if len(some) == 1 else "" for some in groups.values()]
    several = [say("{column} ({count} drums)", column=name, count=len(some)) for name, some in groups.items()]
    said = [one or many for one, many in zip(alone, several, strict=True)]
    if len(said) > NAMED:
        return say("{names} and {count} more", names=joined(", ", said[:NAMED]), count=len(said) - NAMED)
    return joined(say(" and "), [joined(", ", said[:-1]), said[-1]])


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
    :mod:`stylobate.statics.limit_assemblies`.

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
