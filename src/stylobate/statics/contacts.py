"""Programmes of contacts: what joins bodies in the plane and in space, and which of many answers is given."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..column.found_geometry import Edges
from ..errors import InputError, StylobateError


@dataclass(frozen=True, eq=False)
class Holder:
    """Holder of two bodies with a bounded force: a link, or the cohesion of a joint.

    Bodies are those of the programme by number, −1 what moves with the ground. Points are places in space of the upper and
    the lower end, ``axes`` the directions of the force on the upper body as columns: two of them for every direction
    between, or one that is pulled along only.
    """

    name: str
    action: str
    upper: int
    lower: int
    high: np.ndarray
    low: np.ndarray
    axes: np.ndarray
    capacity: float


@dataclass(frozen=True, eq=False)
class Rim:
    """The rim of a joint's overlap, seen from a place within it.

    ``frame`` has two directions along the joint and its normal into the body ``upper`` as columns, ``edges`` bound the
    overlap from ``origin`` [m], and so is ``middle``; ``half`` is half of its width [m].
    """

    upper: int
    lower: int
    frame: np.ndarray
    origin: np.ndarray
    edges: Edges
    middle: np.ndarray
    half: float
    friction: float
    cohesion: float = 0.0

    @property
    def holder(self) -> Holder:
        """Its cohesion, as what holds at its middle."""
        place = self.in_space(self.middle)
        return Holder("", "shear", self.upper, self.lower, place, place, self.frame[:, :2], self.cohesion)

    @cached_property
    def corners(self) -> np.ndarray | None:
        """Places of its corners where no arc bounds it [m], shape (k, 2): what is linear is least at one of them."""
        if self.edges.discs:
            return None
        crossings = []
        for i, (side_normal, bound) in enumerate(self.edges.sides):
            for other, limit in self.edges.sides[:i]:
                across = side_normal[0] * other[1] - side_normal[1] * other[0]
                if abs(across) > 1e-9:
                    place = (
                        np.array([bound * other[1] - limit * side_normal[1], limit * side_normal[0] - bound * other[0]])
                        / across
                    )
                    if all(normal @ place <= end + 1e-9 * self.half for normal, end in self.edges.sides):
                        crossings.append(place)
        kept: list[np.ndarray] = []
        for place in crossings:
            if all(math.dist(place, corner) > 1e-6 * self.half for corner in kept):
                kept.append(place)
        return np.array(kept)

    def places(self, angle: np.ndarray) -> np.ndarray:
        """Places of the rim in these directions from the middle, along the joint [m], shape (…, 2)."""
        way = np.stack((np.cos(angle), np.sin(angle)), axis=-1)
        reach = np.full(np.shape(angle), math.inf)
        for centre, radius in self.edges.discs:
            off = self.middle - centre
            along = way @ off
            reach = np.minimum(reach, np.sqrt(along * along + radius * radius - off @ off) - along)
        for normal, bound in self.edges.sides:
            toward = way @ normal
            with np.errstate(divide="ignore"):
                reach = np.minimum(
                    reach,
                    np.where(toward > 1e-12, (bound - normal @ self.middle) / np.maximum(toward, 1e-300), math.inf),
                )
        return self.middle + reach[..., None] * way

    def in_space(self, place: np.ndarray) -> np.ndarray:
        """A place of the joint in space [m]."""
        return self.origin + self.frame[:, :2] @ place

    def force(self, way: np.ndarray) -> np.ndarray:
        """A unit of pressure with all its friction in a direction, on the upper body."""
        return self.frame @ (*(self.friction * way), 1.0)


#: Points of a round rim and directions of friction to begin with; directions that are looked at for more.
POINTS, WAYS, LOOKS = 8, 4, 360

#: The same where nothing grows.
CUT = 48, 16

#: Rounds of growth, and the share of the multiplier between the bounds at which they end [-].
ROUNDS, CLOSE = 60, 1e-7

#: What is left over of all weight where bodies stand [-].
BALANCED = 1e-9

#: The most that a holder holds is found to this share of it [-], or of this share of the weight where it is less.
MOST_WITHIN, NO_FORCE = 1e-3, 1e-3

#: A joint takes part in the mechanism with more than this share of the fastest one [-].
MOVES = 1e-5

_TIGHT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


class Solved(NamedTuple):
    """Multiplier [g], forces over the weight, velocities dual to them, shape (n, 6), prices of the holders' capacities."""

    multiplier: float
    forces: np.ndarray
    rates: np.ndarray
    prices: np.ndarray


class InfeasibleError(StylobateError):
    """Nothing that joints and holders can bear carries the dead load."""


class EndlessError(StylobateError):
    """Nothing limits what is looked for."""


class Aim(NamedTuple):
    """The force of a holder along a direction of its axes, as large as it can be at a multiplier [g] or more."""

    holder: int
    way: np.ndarray
    multiplier: float


class ContactProgramme:
    """The programme of bodies on joints, which grows while it is solved.

    Parameters
    ----------
    masses : array
        Of the bodies that can move [kg], shape (n,).
    centroids : array
        [m], shape (n, 3)
    gravity : float
        [m/s²]
    rims : sequence of Rim
    holders : sequence of Holder
    length : float
        Over which moments are told, so that they are like forces [m].
    name : str
        What the bodies are together, for messages.
    cut : bool
        Whether arcs are cut into 48 corners and cones into 16 sides, once for all directions, instead of growing: a little
        less than the exact multiplier, where growing would take minutes.
    """

    def __init__(
        self,
        masses: np.ndarray,
        centroids: np.ndarray,
        gravity: float,
        rims: Sequence[Rim],
        holders: Sequence[Holder],
        length: float,
        name: str = "the column",
        cut: bool = False,
    ) -> None:
        self.cut = cut
        self.n, self.centroids, self.length, self.name = len(masses), centroids, length, name
        self.weight = float(masses.sum()) * gravity
        self.shares = masses * gravity / self.weight
        self.rims = list(rims)
        self.holders = [*holders, *(rim.holder for rim in self.rims if rim.cohesion > 0.0)]
        self.columns: list[np.ndarray] = []
        self.rows: list[np.ndarray] = []
        self.owner: list[int] = []
        self.ways: list[np.ndarray] = []
        self.keys: list[tuple] = []
        self.known: set[tuple] = set()

    # -- what can act --------------------------------------------------------------------------------------------------

    def body_force(self, direction: np.ndarray) -> np.ndarray:
        """A force on every body in proportion to its mass, over the weight of all, shape (6 n,)."""
        force = np.zeros((self.n, 6))
        force[:, :3] = np.outer(self.shares, direction)
        return force.ravel()

    def _add(
        self, owner: int, way: np.ndarray, ends: tuple[tuple[int, np.ndarray], ...], force: np.ndarray, key: tuple = ()
    ) -> None:
        """A force on the body at its first end and its reaction on that at the second one."""
        rows, values = [], []
        for (body, place), size in zip(ends, (force, -force), strict=True):
            if body >= 0:
                rows.append(np.arange(6 * body, 6 * body + 6))
                values += [size, np.cross(place - self.centroids[body], size) / self.length]
        self.keys.append(key)
        self.owner.append(owner)
        self.ways.append(way)
        self.rows.append(np.concatenate(rows))
        self.columns.append(np.concatenate(values))

    def press(self, rim: Rim, place: np.ndarray, way: np.ndarray) -> None:
        """Let a joint carry at a place, with friction in a direction."""
        point = rim.in_space(place)
        key = (id(rim), *np.round(place / rim.half, 9), *np.round(way, 9))
        if key not in self.known:
            self.known.add(key)
            self._add(-1, way, ((rim.upper, point), (rim.lower, point)), rim.force(way), key)

    def hold(self, k: int, way: np.ndarray) -> None:
        """Let a holder hold in a direction of its axes."""
        holder = self.holders[k]
        self._add(k, way, ((holder.upper, holder.high), (holder.lower, holder.low)), holder.axes @ way)

    def begin(self, push: np.ndarray) -> None:
        """Points and directions to begin with, in the direction of a push."""
        points, count = CUT if self.cut else (POINTS, WAYS)
        for rim in self.rims:
            first = 0.0 if self.cut else math.atan2(*(rim.frame.T @ push)[1::-1])
            ways = [pointing(first + 2.0 * math.pi * k / count) for k in range(count)]
            corners = rim.corners
            if corners is None:
                corners = rim.places(first + 2.0 * math.pi * np.arange(points) / points)
            for place in corners:
                for way in ways if rim.friction > 0.0 else ways[:1]:
                    self.press(rim, place, way)
        for k, holder in enumerate(self.holders):
            if holder.axes.shape[1] == 1:
                self.hold(k, np.ones(1))
                continue
            first = math.atan2(*(holder.axes.T @ push)[::-1])
            for i in range(count):
                self.hold(k, pointing(first + 2.0 * math.pi * i / count))

    def forget(self, first: int, forces: np.ndarray) -> None:
        """Leave out of what can act all that was added after the first ones and bears nothing in an answer."""
        kept = [i for i in range(len(self.owner)) if i < first or (i < len(forces) and forces[i] > 0.0)]
        self.columns, self.rows = [self.columns[i] for i in kept], [self.rows[i] for i in kept]
        self.owner, self.ways = [self.owner[i] for i in kept], [self.ways[i] for i in kept]
        self.keys = [self.keys[i] for i in kept]
        self.known = set(self.keys)

    # -- what is borne -------------------------------------------------------------------------------------------------

    @property
    def capacities(self) -> np.ndarray:
        """Of the holders [N]."""
        return np.array([holder.capacity for holder in self.holders])

    def converged(
        self,
        dead: np.ndarray,
        live: np.ndarray,
        capacity: np.ndarray,
        enough: float = math.inf,
        aim: Aim | None = None,
    ) -> Solved:
        """The answer of the programme for capacities of the holders [N]: it grows until its bounds have met.

        Or until the multiplier, of which it only knows more and more, is ``enough``. With an aim the force of that holder is
        made as large as it can be instead of the multiplier.
        """
        gap = math.inf
        for _ in range(ROUNDS):
            solution = self._solve(dead, live, capacity, aim)
            if solution.multiplier >= enough or self.cut:
                return solution
            gap = self._grow(solution, capacity, aim)
            if aim is None:
                near = CLOSE * max(abs(solution.multiplier), 1e-3)
            else:
                force = float(aim.way @ self.holder_force(solution.forces, aim.holder)) / self.weight
                near = MOST_WITHIN * max(force, NO_FORCE)
            if gap <= near:
                return solution
        raise StylobateError(
            f"limit analysis in space did not come to an end: the bounds are {gap:.2g} g apart after {ROUNDS} rounds"
        )

    def unbalanced(self, dead: np.ndarray) -> tuple[float, np.ndarray]:
        """How much of a load the joints cannot carry, over the weight, and velocities of what moves so, shape (n, 6)."""
        capacity = self.capacities
        for _ in range(ROUNDS):
            solution = self._solve(dead, None, capacity)
            if -solution.multiplier <= BALANCED:
                return 0.0, solution.rates
            if self.cut or self._grow(solution, capacity) <= CLOSE:
                break
        return -solution.multiplier, solution.rates  # pyright: ignore[reportPossiblyUnboundVariable]

    def _solve(self, dead: np.ndarray, live: np.ndarray | None, capacity: np.ndarray, aim: Aim | None = None) -> Solved:
        """Largest multiplier, or force aimed at, with what there is; without a live load, minus the least not balanced."""
        from scipy.optimize import linprog
        from scipy.sparse import coo_array, csc_array, hstack

        owner, size = np.array(self.owner), len(self.owner)
        bounded = np.flatnonzero(np.isfinite(capacity) & (capacity > 0.0))
        left_out = (owner >= 0) & (capacity[owner] == 0.0) if len(capacity) else np.zeros(size, dtype=bool)
        row = np.full(len(self.holders) + 1, -1)
        row[bounded] = np.arange(len(bounded))
        limited = np.flatnonzero(row[owner] >= 0)
        each = np.eye(6 * self.n)
        last = csc_array(np.hstack((each, -each)) if live is None else live[:, None])
        extra = 2 * len(each) if live is None else 1
        known = self.matrix()
        strength = coo_array((np.ones(len(limited)), (row[owner[limited]], limited)), (len(bounded), size + extra))
        free = (None, None) if live is not None else (0.0, None)
        cost = np.append(np.zeros(size), np.full(extra, -1.0 if live is not None else 1.0))
        if aim is not None:
            free, cost = (aim.multiplier, None), np.zeros(size + extra)
            for i in np.flatnonzero(owner == aim.holder):
                cost[i] = -float(self.ways[i] @ aim.way)
        for presolve in (True, False):  # on a face of many answers HiGHS may come to no end with its presolve
            result = linprog(
                cost,
                A_ub=strength if len(bounded) else None,
                b_ub=capacity[bounded] / self.weight if len(bounded) else None,
                A_eq=hstack((known, last), "csc"),
                b_eq=-dead,
                bounds=[(0.0, 0.0 if out else None) for out in left_out] + [free] * extra,
                method="highs",
                options=_TIGHT | {"presolve": presolve},
            )
            if result.status in (0, 3):
                break
        if result.status == 3 and aim is not None:
            raise EndlessError(f"nothing limits what {self.holders[aim.holder].name!r} holds")
        if result.status == 3:
            endless = [holder.name for holder in self.holders if holder.capacity == math.inf]
            if not endless:
                raise InputError(f"{self.name} bears any push in this direction: fixed bodies hold it.")
            raise InputError(
                f"{self.name} bears any push, because {' and '.join(endless[:2])} has no capacity; give it one [N]."
            )
        if result.status == 2:
            raise InfeasibleError(f"{self.name} is not carried by its joints and what holds it: {result.message}")
        if result.status != 0:
            raise StylobateError(f"the programme of the limit analysis was not solved: {result.message}")
        prices = np.zeros(len(self.holders))
        if len(bounded):
            prices[bounded] = -result.ineqlin.marginals
        rates = -result.eqlin.marginals.reshape(-1, 6)
        for k in np.flatnonzero(capacity == 0.0):  # what the first newton of it would be worth
            speed = self._strain_rate(self.holders[k], rates)
            prices[k] = np.hypot(*speed) if len(speed) == 2 else max(-float(speed[0]), 0.0)
        multiplier = float(result.x[-1]) if live is not None else -float(result.x[size:].sum())
        return Solved(multiplier, result.x[:size], rates, prices)

    def matrix(self) -> Any:
        """All that can act as columns, shape (6 n, columns)."""
        from scipy.sparse import csc_array

        pointer = np.cumsum([0, *(len(row) for row in self.rows)])
        entries = np.concatenate(self.columns), np.concatenate(self.rows)
        return csc_array((*entries, pointer), (6 * self.n, len(self.rows)))

    def _strain_rate(self, holder: Holder, rates: np.ndarray) -> np.ndarray:
        """Velocity of the upper end of a holder from its lower one, along its axes."""
        return holder.axes.T @ (
            self.velocity(holder.upper, holder.high, rates) - self.velocity(holder.lower, holder.low, rates)
        )

    def _grow(self, solved: Solved, capacity: np.ndarray, aim: Aim | None = None) -> float:
        """Add what the mechanism works against; how far what is looked for may be below the largest, at most [g]."""
        most = 1.0 + float(capacity[np.isfinite(capacity)].sum()) / self.weight
        gap, rates, prices = 0.0, solved.rates, solved.prices
        for rim in self.rims:
            power, places, ways = self._worst(rim, rates)
            gap += most * max(-float(power.min()), 0.0)
            for i in np.flatnonzero(power < 0.0):
                self.press(rim, places[i], ways[i])
        for k, holder in enumerate(self.holders):
            if holder.axes.shape[1] == 1:
                continue
            speed = self._strain_rate(holder, rates)
            if aim is not None and aim.holder == k:
                speed = speed - aim.way
            size = float(np.hypot(*speed))
            short = size - prices[k]
            if short > 0.0 and size > 0.0:
                gap += short * (capacity[k] / self.weight if math.isfinite(capacity[k]) else most)
                self.hold(k, -speed / size)
        return gap

    def _worst(self, rim: Rim, rates: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Least powers of a unit of pressure on a rim, where they are, and the directions of its friction."""
        ends = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
        speeds = np.array([rim.frame.T @ self._apart(rim, rim.in_space(end), rates) for end in ends])

        def at(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            speed = speeds[0] + places @ (speeds[1:] - speeds[0])
            return speed[:, 2] - rim.friction * np.hypot(speed[:, 0], speed[:, 1]), speed[:, :2]

        places = rim.corners
        if places is None:
            angle, wide = 2.0 * math.pi * np.arange(LOOKS) / LOOKS, 2.0 * math.pi / LOOKS
            while True:
                places = rim.places(angle)
                best = int(np.argmin(at(places)[0]))
                if wide < 1e-7:
                    break
                angle, wide = angle[best] + wide * np.linspace(-1.0, 1.0, 41), wide / 20.0
            places = places[best : best + 1]
        power, slip = at(places)
        size = np.hypot(*slip.T)[:, None]
        return power, places, np.where(size > 0.0, -slip / np.where(size > 0.0, size, 1.0), (1.0, 0.0))

    # -- how it moves --------------------------------------------------------------------------------------------------

    def _apart(self, rim: Rim, point: np.ndarray, rates: np.ndarray) -> np.ndarray:
        return self.velocity(rim.upper, point, rates) - self.velocity(rim.lower, point, rates)

    def velocity(self, body: int, point: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Of a point of a body."""
        if body < 0:
            return np.zeros(3)
        rate = rates[body]
        return rate[:3] + np.cross(rate[3:] / self.length, point - self.centroids[body])

    def movements(self, rates: np.ndarray) -> np.ndarray:
        """How fast each joint rocks, slides and twists, all at its edge or middle, shape (joints, 3)."""
        sizes = []
        for rim in self.rims:
            spins = [rates[body, 3:] if body >= 0 else np.zeros(3) for body in (rim.upper, rim.lower)]
            turning = rim.frame.T @ (spins[0] - spins[1]) / self.length
            slip = rim.frame.T @ self._apart(rim, rim.in_space(rim.middle), rates)
            sizes.append((math.hypot(*turning[:2]) * rim.half, math.hypot(*slip[:2]), abs(turning[2]) * rim.half))
        return np.array(sizes)

    def holder_forces(self, forces: np.ndarray) -> np.ndarray:
        """Size of what each holder holds [N], shape (holders,)."""
        return np.array([float(np.linalg.norm(self.holder_force(forces, k))) for k in range(len(self.holders))])

    def holder_force(self, forces: np.ndarray, k: int) -> np.ndarray:
        """Force of a holder on its upper body along its axes [N]."""
        force = np.zeros(self.holders[k].axes.shape[1])
        for i in np.flatnonzero(np.array(self.owner[: len(forces)]) == k):
            force += forces[i] * self.ways[i]
        return force * self.weight


def pointing(angle: float) -> Any:
    """Unit vector at an angle [rad], shape (2,)."""
    return np.array([math.cos(angle), math.sin(angle)])


#: By how much the work of a mechanism may differ from that of the multiplier [g].
SLACK = 1e-7

#: Directions at most in which the force of a holder is made as large as it can be.
DIRECTIONS = 32


def gentlest(programme: ContactProgramme, dead: np.ndarray, live: np.ndarray, solution: Solved) -> np.ndarray:
    """Velocities of the mechanism of a multiplier in which joints slip and twist least, shape (n, 6).

    Where several do the same work the one that a solver hands out is any of them; of what holds bodies it is that one.
    """
    from scipy.optimize import linprog
    from scipy.sparse import csr_array, eye_array, hstack, vstack

    if programme.holders:
        return solution.rates
    known, moves = programme.matrix().T, _moves(programme)
    count = 3 * len(programme.rims)
    each = eye_array(count)
    power = hstack((csr_array(-dead[None]), csr_array((1, count))))
    rows = vstack(
        (
            hstack((-known, csr_array((len(programme.rows), count)))),
            hstack((moves, -each)),
            hstack((-moves, -each)),
            power,
        )
    )
    bound = np.append(np.zeros(len(programme.rows) + 2 * count), solution.multiplier + SLACK)
    size = 6 * programme.n
    solved = linprog(
        np.append(np.zeros(size), np.ones(count)),
        A_ub=rows.tocsr(),
        b_ub=bound,
        A_eq=hstack((csr_array(live[None]), csr_array((1, count))), "csr"),
        b_eq=[1.0],
        bounds=[(None, None)] * size + [(0.0, None)] * count,
        method="highs",
    )
    return solved.x[:size].reshape(-1, 6) if solved.status == 0 else solution.rates


def largest_holder_force(
    programme: ContactProgramme, dead: np.ndarray, live: np.ndarray, multiplier: float, k: int
) -> tuple[float, np.ndarray | None]:
    """The most that a holder holds in any answer at a multiplier [g] or more [N], and where it pulls its upper body.

    What it can hold in two directions makes a convex figure, which tangents enclose: in each direction the programme
    tells how far it reaches, and the farthest corner of the tangents is the next direction, until what is reached is as
    far but for :data:`MOST_WITHIN`. Infinite, without a direction, where nothing limits it.
    """
    holder, capacity, first = programme.holders[k], programme.capacities, len(programme.rows)
    count = holder.axes.shape[1]
    ways = [np.ones(1)] if count == 1 else [pointing(0.5 * math.pi * i) for i in range(4)]
    reach: list[tuple[np.ndarray, float]] = []
    best = np.zeros(count)
    try:
        while ways and len(reach) < DIRECTIONS:
            way = ways.pop()
            solution = programme.converged(dead, live, capacity, aim=Aim(k, way, multiplier))
            force = programme.holder_force(solution.forces, k)
            programme.forget(first, solution.forces)
            best = force if np.linalg.norm(force) > np.linalg.norm(best) else best
            reach.append((way, float(way @ force)))
            size = float(np.linalg.norm(best))
            if size >= holder.capacity * (1.0 - MOST_WITHIN):
                break
            if not ways and count == 2:
                corner = max(_corners(reach), key=np.linalg.norm)
                far = float(np.linalg.norm(corner))
                ways = (
                    [corner / far] if far > size * (1.0 + MOST_WITHIN) + MOST_WITHIN * 1e-3 * programme.weight else []
                )
    except EndlessError:
        return math.inf, None
    size = float(np.linalg.norm(best))
    return size, holder.axes @ best / size if size > 0.0 else None


def _moves(programme: ContactProgramme) -> Any:
    """What makes slips along both axes of the joints and twists at their edge of velocities, shape (3 joints, 6 n)."""
    from scipy.sparse import csr_array

    out = np.zeros((3 * len(programme.rims), 6 * programme.n))
    for j, rim in enumerate(programme.rims):
        for body, sign in ((rim.upper, 1.0), (rim.lower, -1.0)):
            if body < 0:
                continue
            part = slice(6 * body, 6 * body + 6)
            arm = rim.in_space(rim.middle) - programme.centroids[body]
            for k, way in enumerate(rim.frame.T[:2]):
                out[3 * j + k, part] = sign * np.append(way, np.cross(arm, way) / programme.length)
            out[3 * j + 2, 6 * body + 3 : 6 * body + 6] = sign * rim.half / programme.length * rim.frame[:, 2]
    return csr_array(out)


def _corners(reach: list[tuple[np.ndarray, float]]) -> list[np.ndarray]:
    """Corners of the figure that tangents enclose, each across a direction and so far along it."""
    turned = sorted(reach, key=lambda tangent: math.atan2(*tangent[0][::-1]))
    pairs = zip(turned, [*turned[1:], turned[0]], strict=True)
    return [np.linalg.solve(np.array([a, b]), (far, away)) for (a, far), (b, away) in pairs]
