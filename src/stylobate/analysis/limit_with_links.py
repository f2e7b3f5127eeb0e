"""Limit analysis in space with links: what contact and links can bear together, by linear programmes that grow.

Each joint carries at points of the rim of its overlap, pressed only and within Coulomb's cone at each, with whatever
distribution of pressure bears most; links carry up to their capacities. That is the exact multiplier for associated flow,
and an upper bound for dry friction. Points and directions of friction are added where the mechanism of the last programme
would open or slip against them, until none is left that changes the multiplier.  # theory/limit_analysis
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..column import Column
from ..column.found_in_space import SpaceGeometry, base_axes, overlap_edges, space_geometry, space_load, upward
from ..constants import DEGREE
from ..errors import InputError, StylobateError
from ..models.rigid_block.stack_links import LINE, SHEAR, Hold, holds
from .least_forces import Borne, needed_forces
from .limit import LinkForce, link_forces

#: Points of a rim and directions of friction to begin with; directions that are looked at for more.
POINTS, WAYS, LOOKS = 8, 4, 360

#: Rounds of growth, and the share of the multiplier between the bounds at which they end [-].
ROUNDS, CLOSE = 60, 1e-7

#: A joint takes part in the mechanism with more than this share of the fastest one [-].
MOVES = 1e-5


_TIGHT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


class SpaceLimit(NamedTuple):
    """Multiplier [g], the lowest joint of the mechanism and what it does, and what every link holds."""

    multiplier: float
    joint: int
    mode: str
    links: tuple[LinkForce, ...]


@dataclass(frozen=True)
class _Holder:
    """What holds two bodies with a bounded force: a link, or the cohesion of a joint.

    Points are places in space of the upper and the lower end, ``axes`` the directions of the force on the upper body as
    columns: two of them for every direction between, or one that is pulled along only.
    """

    name: str
    action: str
    upper: int
    lower: int
    high: np.ndarray
    low: np.ndarray
    axes: np.ndarray
    capacity: float


class _Rim:
    """The rim of a joint's overlap, seen from a place within it."""

    def __init__(self, column: Column, at: SpaceGeometry, joint: int, middle: np.ndarray) -> None:
        self.joint, self.middle = joint, middle
        self.frame, self.origin = at.frame[joint], at.origin[joint]
        self.friction = float(column.friction[joint])
        self.discs, self.sides = overlap_edges(column, at, joint)

    def places(self, angle: np.ndarray) -> np.ndarray:
        """Places of the rim in these directions from the middle, along the joint [m], shape (…, 2)."""
        way = np.stack((np.cos(angle), np.sin(angle)), axis=-1)
        reach = np.full(np.shape(angle), math.inf)
        for centre, radius in self.discs:
            off = self.middle - centre
            along = way @ off
            reach = np.minimum(reach, np.sqrt(along * along + radius * radius - off @ off) - along)
        for normal, bound in self.sides:
            toward = way @ normal
            with np.errstate(divide="ignore"):
                reach = np.minimum(
                    reach,
                    np.where(toward > 1e-12, (bound - normal @ self.middle) / np.maximum(toward, 1e-300), math.inf),
                )
        return self.middle + reach[..., None] * way

    def in_space(self, place: np.ndarray) -> np.ndarray:
        """A place of the joint in the axes of the base [m]."""
        return self.origin + self.frame[:, :2] @ place

    def force(self, way: np.ndarray) -> np.ndarray:
        """A unit of pressure with all its friction in a direction, on the upper drum, in the axes of the base."""
        return self.frame @ (*(self.friction * way), 1.0)


class SpaceProgramme:
    """The programme of a column: what has been added for one direction stays for the next.

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
        self.weight = float(column.masses.sum()) * column.gravity
        self.length = float(column.joint_heights[-1] + column.heights[-1])
        bare = column.replace(links=())
        self.rims = [_Rim(column, self.at, j, self._place(bare, j)) for j in range(column.n)]
        self.holders = [*self._links(), *self._cohesion()]
        self.columns: list[np.ndarray] = []
        self.owner: list[int] = []
        self.ways: list[np.ndarray] = []
        self.dead = self._body_force(-upward(column))

    def _place(self, bare: Column, joint: int) -> np.ndarray:
        load = space_load(bare, self.at, joint)
        discs, sides = overlap_edges(bare, self.at, joint)
        inside = load.normal > 0.0 and all(math.dist(load.place, centre) < radius for centre, radius in discs)
        if not (inside and all(normal @ load.place < bound for normal, bound in sides)):
            raise InputError(
                f"the part of {bare.name!r} above joint {joint + 1} does not stand without links; limit analysis in space "
                "takes columns that do."
            )
        return load.place

    def _links(self) -> list[_Holder]:
        return [self._holder(one) for one in holds(self.column.placed_links) if one.strength]

    def _holder(self, one: Hold) -> _Holder:
        link, at, (low, high) = one.link, self.at, one.link.arms
        upper = at.centroid[link.upper - 1] + at.axes[link.upper - 1] @ high
        if one.action == LINE:
            lower = low if link.lower == 0 else at.centroid[link.lower - 1] + at.axes[link.lower - 1] @ low
            axes = ((lower - upper) / np.linalg.norm(lower - upper))[:, None]
            return _Holder(one.name, one.action, link.upper, link.lower, upper, lower, axes, one.capacity)
        frame = at.frame[link.joint - 1]
        axes = frame[:, :2] if one.action == SHEAR else -frame[:, 2:]
        return _Holder(one.name, one.action, link.upper, link.lower, upper, upper, axes, one.capacity)

    def _cohesion(self) -> list[_Holder]:
        found = []
        for rim, law in zip(self.rims, self.column.joints, strict=True):
            capacity = law.cohesion * float(self.column.joint_areas[rim.joint])
            if capacity > 0.0:
                place = rim.in_space(rim.middle)
                found.append(
                    _Holder("", SHEAR, rim.joint + 1, rim.joint, place, place, rim.frame[:, :2], capacity)
                )  # fmt: skip
        return found

    def _body_force(self, direction: np.ndarray) -> np.ndarray:
        force = np.zeros((self.column.n, 6))
        force[:, :3] = np.outer(self.column.masses * self.column.gravity / self.weight, direction)
        return force.ravel()

    def _pair(self, upper: int, lower: int, high: np.ndarray, low: np.ndarray, force: np.ndarray) -> np.ndarray:
        """A force on the upper body at its place and its reaction at that of the lower one, on all drums."""
        out = np.zeros((self.column.n, 6))
        for body, place, size in ((upper, high, force), (lower, low, -force)):
            if body:
                out[body - 1, :3] += size
                out[body - 1, 3:] += np.cross(place - self.at.centroid[body - 1], size) / self.length
        return out.ravel()

    def _add(self, owner: int, way: np.ndarray, column: np.ndarray) -> None:
        self.owner.append(owner)
        self.ways.append(way)
        self.columns.append(column)

    def press(self, rim: _Rim, place: np.ndarray, way: np.ndarray) -> None:
        """Let a joint carry at a place, with friction in a direction."""
        point = rim.in_space(place)
        self._add(-1, way, self._pair(rim.joint + 1, rim.joint, point, point, rim.force(way)))

    def hold(self, k: int, way: np.ndarray) -> None:
        """Let a holder hold in a direction of its axes."""
        one = self.holders[k]
        self._add(k, way, self._pair(one.upper, one.lower, one.high, one.low, one.axes @ way))

    def begin(self, push: np.ndarray) -> None:
        """Points and directions to begin with, in the direction of a push."""
        for rim in self.rims:
            first = math.atan2(*(rim.frame.T @ push)[1::-1])
            ways = [_way(first + 2.0 * math.pi * k / WAYS) for k in range(WAYS)]
            for place in rim.places(first + 2.0 * math.pi * np.arange(POINTS) / POINTS):
                for way in ways if rim.friction > 0.0 else ways[:1]:
                    self.press(rim, place, way)
        for k, one in enumerate(self.holders):
            if one.axes.shape[1] == 1:
                self.hold(k, np.ones(1))
                continue
            first = math.atan2(*(one.axes.T @ push)[::-1])
            for i in range(WAYS):
                self.hold(k, _way(first + 2.0 * math.pi * i / WAYS))

    def solve(self, azimuth: float) -> SpaceLimit:
        """The multiplier of horizontal forces in proportion to mass towards an azimuth [degrees]."""
        angle = azimuth * DEGREE
        push = base_axes(self.column).T @ (math.cos(angle), math.sin(angle), 0.0)
        live = self._body_force(push)
        self.begin(push)
        links = [k for k, one in enumerate(self.holders) if one.name]
        every = np.array([one.capacity for one in self.holders])

        def borne(multiplier: float, forces: np.ndarray, _: np.ndarray, prices: np.ndarray) -> Borne:
            return Borne(multiplier, prices[links] / self.weight, self._held(forces)[links], forces)

        def bear(some: np.ndarray, enough: float) -> Borne:
            capacity = every.copy()
            capacity[links] = some
            return borne(*self._converged(live, capacity, enough))

        found = self._converged(live, every)
        joint, mode = self._mechanism(found[2])
        needed = needed_forces(bear, every[links], borne(*found))
        return SpaceLimit(found[0] + 0.0, joint, mode, link_forces([self.holders[k] for k in links], needed))

    def _converged(
        self, live: np.ndarray, capacity: np.ndarray, enough: float = math.inf
    ) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
        """The answer of the programme for capacities of the holders [N]: it grows until its bounds have met.

        Or until the multiplier, of which it only knows more and more, is ``enough``.
        """
        gap = math.inf
        for _ in range(ROUNDS):
            found = self._programme(live, capacity)
            if found[0] >= enough:
                return found
            gap = self._grow(found[2], found[3], capacity)
            if gap <= CLOSE * max(abs(found[0]), 1e-3):
                return found
        raise StylobateError(
            f"limit analysis in space did not come to an end: the bounds are {gap:.2g} g apart after {ROUNDS} rounds"
        )

    def _programme(self, live: np.ndarray, capacity: np.ndarray) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
        """Largest multiplier with what there is, forces over the weight, and velocities and rates that are dual to them."""
        from scipy.optimize import linprog
        from scipy.sparse import coo_array

        owner = np.array(self.owner)
        bounded = np.flatnonzero(np.isfinite(capacity) & (capacity > 0.0))
        left_out = (owner >= 0) & (capacity[owner] == 0.0) if len(capacity) else np.zeros(len(owner), dtype=bool)
        row = np.full(len(self.holders) + 1, -1)
        row[bounded] = np.arange(len(bounded))
        held = np.flatnonzero(row[owner] >= 0)
        rows = coo_array((np.ones(len(held)), (row[owner[held]], held)), (len(bounded), len(owner) + 1))
        for presolve in (True, False):  # on a face of many answers HiGHS may come to no end with its presolve
            found = linprog(
                np.append(np.zeros(len(owner)), -1.0),
                A_ub=rows if len(bounded) else None,
                b_ub=capacity[bounded] / self.weight if len(bounded) else None,
                A_eq=np.column_stack((*self.columns, live)),
                b_eq=-self.dead,
                bounds=[(0.0, 0.0 if out else None) for out in left_out] + [(None, None)],
                method="highs",
                options=_TIGHT | {"presolve": presolve},
            )
            if found.status in (0, 3):
                break
        if found.status == 3:
            endless = [one.name for one in self.holders if one.capacity == math.inf]
            raise InputError(
                f"the column bears any push, because {' and '.join(endless[:2]) or 'a link'} has no capacity; give it one "
                "[N]."
            )
        if found.status != 0:
            raise StylobateError(f"the programme of the limit analysis was not solved: {found.message}")
        prices = np.zeros(len(self.holders))
        if len(bounded):
            prices[bounded] = -found.ineqlin.marginals
        rates = -found.eqlin.marginals.reshape(-1, 6)
        for k in np.flatnonzero(capacity == 0.0):  # what the first newton of it would be worth
            speed = self._strain_rate(self.holders[k], rates)
            prices[k] = np.hypot(*speed) if len(speed) == 2 else max(-float(speed[0]), 0.0)
        return float(found.x[-1]), found.x[:-1], rates, prices

    def _strain_rate(self, one: _Holder, rates: np.ndarray) -> np.ndarray:
        """Velocity of the upper end of a holder from its lower one, along its axes."""
        return one.axes.T @ (self._velocity(one.upper, one.high, rates) - self._velocity(one.lower, one.low, rates))

    def _grow(self, rates: np.ndarray, prices: np.ndarray, capacity: np.ndarray) -> float:
        """Add what the mechanism works against; how far the multiplier may be below the largest one, at most [g]."""
        most = 1.0 + float(capacity[np.isfinite(capacity)].sum()) / self.weight
        gap = 0.0
        for rim in self.rims:
            least, place, way = self._worst(rim, rates)
            gap += most * max(-least, 0.0)
            if least < 0.0:
                self.press(rim, place, way)
        for k, one in enumerate(self.holders):
            if one.axes.shape[1] == 1:
                continue
            speed = self._strain_rate(one, rates)
            size = float(np.hypot(*speed))
            short = size - prices[k]
            if short > 0.0 and size > 0.0:
                gap += short * (capacity[k] / self.weight if math.isfinite(capacity[k]) else most)
                self.hold(k, -speed / size)
        return gap

    def _worst(self, rim: _Rim, rates: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
        """Least power of a unit of pressure on a rim, where it is, and the direction of its friction."""
        ends = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
        speeds = np.array([rim.frame.T @ self._apart(rim.joint, rim.in_space(one), rates) for one in ends])
        angle, wide = 2.0 * math.pi * np.arange(LOOKS) / LOOKS, 2.0 * math.pi / LOOKS
        while True:
            places = rim.places(angle)
            speed = speeds[0] + places @ (speeds[1:] - speeds[0])
            power = speed[:, 2] - rim.friction * np.hypot(speed[:, 0], speed[:, 1])
            best = int(np.argmin(power))
            if wide < 1e-7:
                break
            angle, wide = angle[best] + wide * np.linspace(-1.0, 1.0, 41), wide / 20.0
        slip = speed[best, :2]
        size = float(np.hypot(*slip))
        return float(power[best]), places[best], -slip / size if size > 0.0 else np.array([1.0, 0.0])

    def _apart(self, joint: int, point: np.ndarray, rates: np.ndarray) -> np.ndarray:
        return self._velocity(joint + 1, point, rates) - self._velocity(joint, point, rates)

    def _velocity(self, body: int, point: np.ndarray, rates: np.ndarray) -> np.ndarray:
        if body == 0:
            return np.zeros(3)
        one = rates[body - 1]
        return one[:3] + np.cross(one[3:] / self.length, point - self.at.centroid[body - 1])

    def _mechanism(self, rates: np.ndarray) -> tuple[int, str]:
        """The lowest joint that moves, and whether it rocks, slides or twists."""
        sizes = []
        for rim in self.rims:
            lower = rates[rim.joint - 1, 3:] if rim.joint else np.zeros(3)
            turning = rim.frame.T @ (rates[rim.joint, 3:] - lower) / self.length
            half = 0.5 * float(self.column.joint_widths[rim.joint])
            slip = rim.frame.T @ self._apart(rim.joint, rim.in_space(rim.middle), rates)
            sizes.append((float(np.hypot(*turning[:2])) * half, float(np.hypot(*slip[:2])), abs(turning[2]) * half))
        found = np.array(sizes)
        joint = int(np.argmax(found.max(axis=1) > MOVES * found.max()))
        return joint + 1, ("rocking", "sliding", "twisting")[int(np.argmax(found[joint]))]

    def _held(self, forces: np.ndarray) -> np.ndarray:
        """Size of what each holder holds [N], shape (holders,)."""
        found = np.zeros((len(self.holders), 2))
        owner = np.array(self.owner[: len(forces)])
        for i in np.flatnonzero((owner >= 0) & (forces > 0.0)):
            found[owner[i], : len(self.ways[i])] += forces[i] * self.ways[i]
        return np.hypot(*found.T) * self.weight


def _way(angle: float) -> Any:
    return np.array([math.cos(angle), math.sin(angle)])
