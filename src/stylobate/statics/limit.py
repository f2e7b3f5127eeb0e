"""Limit analysis of a stack of blocks: the largest multiple of a force that it bears, and the least forces in its links."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..column import Column
from ..column.structure import Structure
from ..errors import InputError, StylobateError, check_choice, check_kind
from ..models.rigid_block.block_stack import SHEAR, BlockStack, link_strains
from ..notebook import Shown
from .loads import check_standing, contact_limits, crushing_forces, gravity_forces, horizontal_forces

#: A multiplier is the same if it differs by less than this share of itself [-].
SAME = 1e-6

#: A link holds its capacity if it must hold more than all but this share of it [-].
NEARLY = 1e-3

#: Most steps towards the least force of a link.
STEPS = 40


class Borne(NamedTuple):
    """Load of a programme with links of given capacities.

    ``multiplier`` [g]; ``worth``, by how much a larger capacity of each link would raise it [g/N], and ``held``, what each
    holds in this answer [N], shapes (links,); ``forces``, all of this answer.
    """

    multiplier: float
    worth: np.ndarray
    held: np.ndarray
    forces: np.ndarray


class Needed(NamedTuple):
    """Links in every answer of a programme.

    ``least`` [N], the least that each holds, with the sign of that answer; ``yields``, whether that is its capacity;
    ``idle``, whether it need not act: all that are idle may be so at once. ``forces`` of an answer in which they are.
    """

    least: np.ndarray
    yields: np.ndarray
    idle: np.ndarray
    forces: np.ndarray


def needed_forces(solve: Callable[[np.ndarray, float], Borne], capacity: np.ndarray, whole: Borne) -> Needed:
    """Demand on links at the multiplier that they reach together.

    Parameters
    ----------
    solve : callable
        The programme for capacities of the links [N], shape (links,); it may leave off where its multiplier is as large as
        the second argument [g], and says −∞ where what stands does not without them.
    capacity : array
        [N], infinite without limit.
    whole : Borne
        The programme's answer for these.

    Notes
    -----
    The multiplier λ(c) is a concave function of the capacities c that does not fall. A link that is worth something in one
    dual answer holds its capacity in every answer (complementary slackness). Of the others the least force is the smallest
    capacity with which λ stays the same: Newton's steps along the tangents of a concave function come to it from below,
    and never pass it. First all of them are left out at once, because mostly none is needed.
    """
    same = whole.multiplier - SAME * max(abs(whole.multiplier), 1e-3)
    finite = np.where(np.isfinite(capacity), capacity, 0.0)
    # The worth of what is left to this share of its capacity is beyond the errors of the programme.
    yields = whole.worth * finite > NEARLY * max(abs(whole.multiplier), 1e-3)
    least, idle = np.where(yields, np.sign(whole.held) * finite, 0.0), ~yields
    answer = solve(np.where(idle, 0.0, capacity), same) if idle.any() else whole
    if answer.multiplier >= same:
        return Needed(least, yields, idle, answer.forces)
    for k in np.flatnonzero(idle):
        least[k], yields[k] = _least(solve, capacity, int(k), whole, same)
    idle = least == 0.0
    answer = solve(np.where(idle, 0.0, capacity), same) if idle.any() else whole
    if answer.multiplier < same:  # each can be left out, all at once cannot: one stands in for another
        idle[:] = False
        answer = whole
    return Needed(least, yields, idle, answer.forces)


def _least(
    solve: Callable[[np.ndarray, float], Borne], capacity: np.ndarray, k: int, whole: Borne, same: float
) -> tuple[float, bool]:
    """The least that a link must hold [N], with its sign, and whether that is its capacity."""
    less, most = capacity.copy(), float(capacity[k])
    less[k], enough = 0.0, abs(float(whole.held[k]))
    for _ in range(STEPS):
        found = solve(less, same)
        if found.multiplier >= same:
            return float(found.held[k]) if less[k] else 0.0, False
        slope = float(found.worth[k])
        if found.multiplier == -np.inf and enough - less[k] > NEARLY * enough:  # without so much nothing stands
            less[k] = 0.5 * (less[k] + enough)
            continue
        if slope <= 0.0:
            break
        less[k] += (whole.multiplier - found.multiplier) / slope
        if less[k] >= most * (1.0 - NEARLY):
            return float(np.copysign(most, whole.held[k])), True
    return float(np.copysign(less[k], whole.held[k])), False


#: Strength counts as used up when less than this share of it is left [-].
ACTIVE = 1e-7

#: A multiplier stays if it falls by no more than this share of itself [-].
STAYS = 1e-9

_TIGHT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


def equilibrium_matrix(stack: BlockStack) -> np.ndarray:
    """Openings, slips and rotations of the joints, and strains of the links, from small displacements of the blocks.

    Its transpose turns joint forces (N, V, M) on the part above, and what each link pushes apart with, into forces on the
    blocks; shape (3 n + links, 3 n).
    """
    joints = stack.compatibility()
    return np.vstack((joints, link_strains(stack.links, stack.centroid, stack.angle)[1])) if stack.links else joints


class Facets:
    """Strength of joints and links as rows f · s ≤ k over all joint and link forces, with the place and kind of each.

    A place below ``n`` is a joint, beyond it a link.
    """

    def __init__(self, stack: BlockStack) -> None:
        self.stack = stack
        self.size = 3 * stack.n + len(stack.links)
        self.rows: list[np.ndarray] = []
        self.bound: list[float] = []
        self.place: list[int] = []
        self.kind: list[str] = []
        left, right = contact_limits(stack)
        self.left, self.right = left, right
        for i in range(stack.n):
            mu, cohesion = stack.friction[i], stack.cohesion[i]
            # M = N e: the eccentricity stays inside the contact section.  # theory/limit_analysis, strength
            self.add(i, [-right[i], 0.0, 1.0], 0.0, "rocking right")
            self.add(i, [left[i], 0.0, -1.0], 0.0, "rocking left")
            # |V| ≤ c A + N tan φ; V acts on the part above: towards −x when that slides to the right.
            self.add(i, [-mu, -1.0, 0.0], cohesion, "sliding right")
            self.add(i, [-mu, 1.0, 0.0], cohesion, "sliding left")
        for k, link in enumerate(stack.links):
            place, most = stack.n + k, link.capacity if link.strength else 0.0
            if link.action == SHEAR:
                self.add(place, [-1.0], most, "yields to the right")
                self.add(place, [1.0], most, "yields to the left")
            else:  # it pulls, so that what it pushes with lies between −capacity and 0
                self.add(place, [-1.0], most, "yields")
                self.add(place, [1.0], 0.0, "slack")

    def add(self, place: int, values: Sequence[float], bound: float, kind: str) -> None:
        """One facet; without a finite bound there is none."""
        if not np.isfinite(bound):
            return
        row = np.zeros(self.size)
        first = 3 * place if place < self.stack.n else 2 * self.stack.n + place
        row[first : first + len(values)] = values
        self.rows.append(row)
        self.bound.append(bound)
        self.place.append(place)
        self.kind.append(kind)

    def cut(self, forces: np.ndarray, strength: np.ndarray) -> bool:
        """Add tangents of the crushing domain M ≤ N a (1 − N/(f_c A)) that the forces violate."""
        added = False
        for i in map(int, np.flatnonzero(np.isfinite(strength))):
            n, _, m = forces[3 * i : 3 * i + 3]
            for half, sign, kind in ((self.right[i], 1.0, "rocking right"), (-self.left[i], -1.0, "rocking left")):
                if sign * m > half * n * (1.0 - n / strength[i]) + 1e-10 * half * n:
                    # Tangent at N: M ≤ a [N (1 − 2 n/F) + n²/F].
                    slope, offset = half * (1.0 - 2.0 * n / strength[i]), half * n * n / strength[i]
                    self.add(i, [-slope, 0.0, sign], offset, kind)
                    added = True
        return added

    def matrix(self, *, dilatancy: bool = True) -> np.ndarray:
        """Rows as one matrix, shape (facets, forces); without dilatancy the flow of friction has no opening."""
        out = np.array(self.rows)
        if not dilatancy:
            for k, (place, kind) in enumerate(zip(self.place, self.kind)):
                if kind.startswith("sliding"):
                    out[k, 3 * place] = 0.0
        return out

    def worth(self, slopes: np.ndarray) -> np.ndarray:
        """By how much a larger capacity of each link raises λ [1/N], of ∂λ/∂k of the facets; shape (links,)."""
        found = np.zeros(len(self.stack.links))
        for place, kind, slope in zip(self.place, self.kind, slopes, strict=True):
            if place >= self.stack.n and kind != "slack":
                found[place - self.stack.n] += slope
        return found

    def used(self, forces: np.ndarray) -> np.ndarray:
        """Which facets the forces have used up, shape (facets,)."""
        left_over = np.array(self.bound) - self.matrix() @ forces
        n = self.stack.n
        scale = np.array([forces[3 * place] if place < n else self.stack.weight for place in self.place])
        return left_over < ACTIVE * scale


def static_bound(
    equilibrium: np.ndarray, dead: np.ndarray, live: np.ndarray, facets: Facets
) -> tuple[float, np.ndarray, np.ndarray]:
    """Largest λ in equilibrium with admissible forces (lower bound theorem), these forces, and ∂λ/∂k of the facets [1/N]."""
    scale = np.abs(dead).max()
    found = _admissible(equilibrium, dead, live, facets, np.append(np.zeros(len(equilibrium)), -1.0))
    if found.status == 3:
        endless = [link.name for link in facets.stack.links if link.capacity == np.inf and link.strength]
        raise InputError(
            f"the column bears any push, because {' and '.join(endless[:2]) or 'a link'} has no capacity; give it one [N]."
        )
    _check_solved(found, "static")
    return float(found.x[-1]), found.x[:-1] * scale, -found.ineqlin.marginals / scale


def largest_forces(
    equilibrium: np.ndarray, dead: np.ndarray, live: np.ndarray, facets: Facets, multiplier: float, strength: np.ndarray
) -> np.ndarray:
    """The most that each link holds in any admissible answer at a multiplier [N], infinite without limit; shape (links,).

    Two programmes for each link: the largest and the smallest force that equilibrium and strength admit while λ stays.
    ``strength`` is that of the joints against crushing [N], whose tangents are added as they are needed.
    """
    size, links = len(equilibrium), len(facets.stack.links)
    scale, most = np.abs(dead).max(), np.zeros(links)
    least = multiplier - STAYS * max(abs(multiplier), 1e-3)
    for k in range(links):
        for sign in (1.0, -1.0):
            cost = np.zeros(size + 1)
            cost[size - links + k] = sign
            found = _admissible(equilibrium, dead, live, facets, cost, least)
            while found.status == 0 and facets.cut(found.x[:-1] * scale, strength):
                found = _admissible(equilibrium, dead, live, facets, cost, least)
            if found.status == 3:
                most[k] = np.inf
                continue
            _check_solved(found, "static")
            most[k] = max(most[k], -sign * found.x[size - links + k] * scale)
    return most


def _admissible(
    equilibrium: np.ndarray,
    dead: np.ndarray,
    live: np.ndarray,
    facets: Facets,
    cost: np.ndarray,
    least: float | None = None,
) -> Any:
    """The admissible forces over the largest load, and λ, of least cost; λ not below ``least``."""
    from scipy.optimize import linprog

    scale = np.abs(dead).max()
    return linprog(
        cost,
        A_ub=np.column_stack((facets.matrix(), np.zeros(len(facets.rows)))),
        b_ub=np.array(facets.bound) / scale,
        A_eq=np.column_stack((equilibrium.T, live.ravel() / scale)),
        b_eq=-dead.ravel() / scale,
        bounds=[(None, None)] * len(equilibrium) + [(least, None)],
        method="highs",
        options=_TIGHT,
    )


def kinematic_bound(
    equilibrium: np.ndarray, dead: np.ndarray, live: np.ndarray, facets: Facets
) -> tuple[float, np.ndarray, np.ndarray]:
    """Smallest λ = (dissipation − power of gravity) / (power of the live load), associated flow (upper bound)."""
    from scipy.optimize import linprog

    size = dead.size
    scale = np.abs(dead).max()
    flow = facets.matrix()
    # Normality: what joints and links dissipate is −s · B q̇, so that B q̇ + Σ γ f = 0.
    compatible = np.column_stack((equilibrium, flow.T))
    power = np.append(live.ravel() / scale, np.zeros(len(flow)))
    found = linprog(
        np.append(-dead.ravel() / scale, np.array(facets.bound) / scale),
        A_eq=np.vstack((compatible, power)),
        b_eq=np.append(np.zeros(len(equilibrium)), 1.0),
        bounds=[(None, None)] * size + [(0.0, None)] * len(flow),
        method="highs",
        options=_TIGHT,
    )
    _check_solved(found, "kinematic")
    return float(found.fun), found.x[:size].reshape(-1, 3), found.x[size:]


def non_associated(
    equilibrium: np.ndarray, live: np.ndarray, facets: Facets, forces: np.ndarray
) -> tuple[np.ndarray, np.ndarray] | None:
    """Mechanism of the facets that the forces use up, friction without dilatancy: the one of least movement.

    None where there is none: with links the forces of both bounds need not allow it.
    """
    from scipy.optimize import linprog

    size = live.size
    scale = np.abs(live).max()
    flow = facets.matrix(dilatancy=False)
    compatible = np.column_stack((equilibrium, flow.T))
    power = np.append(live.ravel() / scale, np.zeros(len(flow)))
    found = linprog(
        np.append(np.zeros(size), np.ones(len(flow))),
        A_eq=np.vstack((compatible, power)),
        b_eq=np.append(np.zeros(len(equilibrium)), 1.0),
        bounds=[(None, None)] * size + [(0.0, None if use else 0.0) for use in facets.used(forces)],
        method="highs",
        options=_TIGHT,
    )
    if found.status != 0 and facets.stack.links:
        return None
    _check_solved(found, "mechanism")
    return found.x[:size].reshape(-1, 3), found.x[size:]


def _check_solved(found, which: str) -> None:
    if found.status != 0:
        raise StylobateError(f"the {which} programme of the limit analysis was not solved: {found.message}")


FLOWS = ("non-associated", "associated")


@dataclass(frozen=True)
class ActiveJoint:
    """A joint that takes part in the mechanism.

    Parameters
    ----------
    joint : int
        Counted from 1 at the base.
    mode : str
        ``rocking right``, ``rocking left``, ``sliding right``, ``sliding left``: what the part above does.
    rate : float
        Relative rotation [rad] or slip [m] per metre that the fastest block moves.
    """

    joint: int
    mode: str
    rate: float


@dataclass(frozen=True)
class LinkForce:
    """Demand on a link at collapse: forces at the collapse multiplier need not be unique.

    Parameters
    ----------
    name, action : str
        The link, and what it does: ``shear``, ``closing`` of its joint, a ``line`` in tension; a clamp that is pressed holds
        ``apart``.
    force, capacity : float
        The least that it holds in any answer, and what it can hold [N]; of shear towards +x on the part below positive.
    yields : bool
        Whether it holds all its capacity in every answer.
    idle : bool
        Whether it need not act; all links that are idle may be left out together.
    largest : float
        The most that it holds in any answer [N], infinite where nothing limits it; NaN where it is not computed, in space in
        other directions than the weakest.
    towards : (float, float, float), optional
        In space, the direction of the largest force on the part above, a unit vector along x, y, z.
    """

    name: str
    action: str
    force: float
    capacity: float
    yields: bool
    idle: bool
    largest: float = math.nan
    towards: tuple[float, float, float] | None = None

    def row(self) -> dict[str, Any]:
        """Its demand in the JSON object of ``stylobate limit``."""
        return {
            "link": self.name,
            "action": self.action,
            "force_n": self.force,
            "largest_force_n": None if math.isnan(self.largest) else self.largest,
            "largest_force_towards": None if self.towards is None else list(self.towards),
            "capacity_n": self.capacity,
            "yields": self.yields,
            "need_not_act": self.idle,
        }


@dataclass(frozen=True)
class DirectionLimit:
    """What horizontal forces in one direction make of what stands in space.

    Parameters
    ----------
    azimuth : float
        Where the forces push to, from x towards y [degrees].
    multiplier : float
        λ at which the structure becomes a mechanism [g].
    joint : int
        That gives way first, from 1 at the base: the lowest one of the mechanism.
    mode : str
        ``rocking``, ``sliding`` or, with links, ``twisting``.
    links : tuple of LinkForce
        What each link must hold then; of shear its size.
    between : tuple of str
        The two bodies of that joint, and ``moving``, all that take part in the mechanism, by name; of an assembly.
    upper_bound : bool
        Whether stones slide or round faces twist on one another, where dry friction may bear less than λ; of an assembly.
    """

    azimuth: float
    multiplier: float
    joint: int
    mode: str
    links: tuple[LinkForce, ...] = ()
    between: tuple[str, ...] = ()
    moving: tuple[str, ...] = ()
    upper_bound: bool = False

    def summary(self) -> dict[str, Any]:
        """Links, and of an assembly who moves, in the JSON object of ``stylobate limit``."""
        links = {"links": [link.row() for link in self.links]}
        if not self.moving:
            return links
        moves = {"between": list(self.between), "moving": list(self.moving)}
        return links | moves | {"upper_bound": self.upper_bound, "flow": "associated"}


@dataclass(frozen=True, eq=False)
class LimitResult(Shown):
    """Result of :func:`limit_analysis`.

    Parameters
    ----------
    multiplier : float
        Collapse multiplier λ: horizontal forces of λ times the weight make the column a mechanism [g].
    lower, upper : float
        Bounds of the static and the kinematic programme [g].
    mechanism : array
        Velocities of each block's centroid and its rotation, for a unit horizontal velocity of the fastest block:
        x, z [m], rotation counter-clockwise positive [rad], shape (n, 3).
    active : tuple of ActiveJoint
    compression, shear, eccentricity : array
        Joint forces at collapse: N [N], V [N] on the part above, towards +x positive, and M/N [m], shape (n,); with links
        those of one answer, in which those that need not act do not.
    at_limit : tuple of int
        Joints whose strength is used up, whether or not the mechanism shown uses them; counted from 1.
    flow : str
        Flow rule of the mechanism that is shown.
    links : tuple of LinkForce
        What each link must hold at collapse.
    """

    multiplier: float
    lower: float
    upper: float
    mechanism: np.ndarray
    active: tuple[ActiveJoint, ...]
    compression: np.ndarray
    shear: np.ndarray
    eccentricity: np.ndarray
    at_limit: tuple[int, ...]
    flow: str
    links: tuple[LinkForce, ...] = ()

    @property
    def governing_joint(self) -> int:
        """Lowest joint of the mechanism, counted from 1."""
        return min(item.joint for item in self.active)

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate limit``."""
        return {
            "collapse_multiplier_g": self.multiplier,
            "lower_bound_g": self.lower,
            "upper_bound_g": self.upper,
            "flow": self.flow,
            "active_joints": [{"joint": item.joint, "mode": item.mode, "rate": item.rate} for item in self.active],
            "joints_at_strength": list(self.at_limit),
            "links": [link.row() for link in self.links],
            "mechanism": mechanism_rows(self.mechanism),
        }


def limit_analysis(
    column: Column | BlockStack,
    *,
    pattern: Sequence[float] | None = None,
    base_tilt: float = 0.0,
    direction: float = 0.0,
    flow: str = "non-associated",
    compressive_strength: float | None = None,
) -> LimitResult:
    """Collapse multiplier of horizontal forces on a column of rigid blocks, from below and from above.

    The forces push towards +x, or to the other side with ``direction=180``. What is found then is told as seen in a
    mirror: the forces push to the right again.

    Parameters
    ----------
    column : Column or BlockStack
    pattern : sequence of float, optional
        Relative horizontal force on each drum, bottom to top; proportional to mass by default. Their sum is λ W.
    base_tilt : float
        Tilt of the base, downhill towards +x, where the forces push along it [degrees]; a negative one makes them push
        uphill. A column as found brings its own ``base_tilt``, counted the other way, counter-clockwise; its forces are
        horizontal.
    direction : {0, 180}
        Where the forces push to [degrees], in the plane; in space see
        :func:`stylobate.statics.limit_assemblies.limit_in_space`.
    flow : {"non-associated", "associated"}
        Flow rule of friction in the mechanism: sliding without or with dilatancy tan φ. In a stack without links the joint
        forces follow from equilibrium alone, so that the multiplier is the same; with links it is that of associated flow,
        and so is the mechanism where no other one is found.
    compressive_strength : float, optional
        f_c of the joints [Pa]; unlimited by default.

    Returns
    -------
    LimitResult

    Raises
    ------
    InputError
        The column cannot stand under its own weight, or an argument cannot be used.
    """
    check_choice("`flow`", flow, FLOWS)
    stack = towards(column, direction)
    strength = crushing_forces(stack, compressive_strength)
    dead = gravity_forces(stack, base_tilt)
    live = horizontal_forces(stack, pattern)
    check_standing(stack, dead, strength, base_tilt)
    equilibrium = equilibrium_matrix(stack)

    def bear(facets: Facets) -> Borne:
        lower, forces, slopes = static_bound(equilibrium, dead, live, facets)
        # The crushing domain is curved: its tangents are added where the last answer left it.  (Kelley's cutting planes)
        while facets.cut(forces, strength):
            lower, forces, slopes = static_bound(equilibrium, dead, live, facets)
        return Borne(lower, facets.worth(slopes), -forces[3 * stack.n :], forces)

    facets = Facets(stack)
    whole = bear(facets)
    lower, forces, links = whole.multiplier, whole.forces, ()
    if stack.links:
        capacity = np.array([link.capacity for link in stack.links])
        needed = needed_forces(lambda some, _: bear(Facets(stack.with_capacities(some))), capacity, whole)
        largest = largest_forces(equilibrium, dead, live, facets, lower, strength)
        forces, links = needed.forces, link_forces(stack.links, needed, largest)
    upper, rates, multipliers = kinematic_bound(equilibrium, dead, live, facets)
    other = non_associated(equilibrium, live, facets, forces) if flow == "non-associated" else None
    if other is not None:
        rates, multipliers = other
    control = float(np.abs(rates[:, 0]).max())  # of the block that moves most, which makes mechanisms comparable
    shown = "associated" if other is None else flow
    return _result(stack, lower, upper, forces, rates / control, multipliers / control, facets, shown, links)


def link_forces(
    links: Sequence[Any], needed: Needed, largest: np.ndarray | None = None, towards: Sequence[Any] | None = None
) -> tuple[LinkForce, ...]:
    """Demand on the links of a programme, which have a name, an action and a capacity; the most of it [N] where known, and
    in space its direction."""
    most = np.full(len(links), math.nan) if largest is None else np.maximum(largest, np.abs(needed.least))
    ways = [None] * len(links) if towards is None else towards
    told = zip(
        links, needed.least.tolist(), needed.yields.tolist(), needed.idle.tolist(), most.tolist(), ways, strict=True
    )
    return tuple(LinkForce(link.name, link.action, least, link.capacity, *rest) for link, least, *rest in told)


def towards(column: Column | BlockStack, direction: float) -> BlockStack:
    """The stack of a column, seen in a mirror where the forces push to the left.

    Raises
    ------
    InputError
        A direction out of the plane.
    """
    check_kind("column", column, (Structure, BlockStack), allowed=Structure.wanted)
    if not isinstance(column, BlockStack) and column.stack is None:
        raise InputError(
            f"limit_analysis is of columns in the plane, and {column.name!r} is {column.described}; use limit_directions."
        )
    stack = column if isinstance(column, BlockStack) else BlockStack.of_column(column)
    if direction % 360.0 not in (0.0, 180.0):
        raise InputError(f"direction is {direction:g} degrees; allowed in the plane are 0 (to the right) and 180.")
    return stack.mirrored() if direction % 360.0 else stack


def _result(
    stack: BlockStack,
    lower: float,
    upper: float,
    forces: np.ndarray,
    rates: np.ndarray,
    multipliers: np.ndarray,
    facets: Facets,
    flow: str,
    links: tuple[LinkForce, ...],
) -> LimitResult:
    threshold, n = ACTIVE * multipliers.max(), stack.n
    places, kinds = facets.place, facets.kind
    moving = [k for k, rate in enumerate(multipliers) if rate > threshold]
    active = [ActiveJoint(places[k] + 1, kinds[k], float(multipliers[k])) for k in moving if places[k] < n]
    joints = forces[: 3 * n].reshape(-1, 3)
    compression = joints[:, 0]
    return LimitResult(
        multiplier=0.5 * (lower + upper),
        lower=lower,
        upper=upper,
        mechanism=rates,
        active=tuple(sorted(active, key=lambda item: item.joint)),
        compression=compression,
        shear=joints[:, 1],
        eccentricity=joints[:, 2] / np.where(compression > 0.0, compression, np.nan),
        at_limit=tuple(sorted({places[k] + 1 for k in np.flatnonzero(facets.used(forces)) if places[k] < n})),
        flow=flow,
        links=links,
    )


def mechanism_rows(mechanism: np.ndarray) -> list[dict[str, float]]:
    """One row per drum: x, z and rotation for a unit horizontal movement of the drum that moves most."""
    return [
        {"drum": i + 1, "x": float(x), "z": float(z), "rotation_rad_per_m": float(turn)}
        for i, (x, z, turn) in enumerate(mechanism)
    ]
