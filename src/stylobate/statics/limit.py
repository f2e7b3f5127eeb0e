"""Limit analysis of a stack of blocks: the largest multiple of a force that it bears, and the least forces in its links."""

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
from ..errors import InputError, StylobateError, check_choice, check_kind, check_range
from ..messages import joined, say
from ..models.rigid_block.block_stack import APART, LINE, SHEAR, BlockStack, Hold, holds, link_strains
from ..notebook import NotebookSummary
from .contacts import MOVES, ContactProgramme, Holder, InfeasibleError, Rim, Solved, gentlest, largest_holder_force

# Loads and strength of a stack of blocks, for limit analysis and pushover alike; what cannot stand is refused.


def gravity_forces(stack: BlockStack, base_tilt: float = 0.0) -> np.ndarray:
    """Weight of each block in the frame of the base [N, N, N m], shape (n, 3).

    Raises
    ------
    InputError
        A tilt outside its range, or beside that of a column as found.
    """
    tilt = check_range("base_tilt", base_tilt, -60.0, 60.0, unit="degrees") * DEGREE
    if tilt and stack.slope:
        raise InputError(
            f"a tilt of {base_tilt:g} degrees is given for a column whose base is found out of level; leave one of them out."
        )
    tilt -= stack.slope
    weight = stack.mass * stack.gravity
    return np.column_stack((weight * np.sin(tilt), -weight * np.cos(tilt), np.zeros(stack.n)))


def horizontal_forces(stack: BlockStack, pattern: Sequence[float] | None = None) -> np.ndarray:
    """Horizontal forces for λ = 1 g: their sum is the weight [N, N, N m], shape (n, 3).

    Along the base where its tilt is an argument of the analysis; horizontal where the base is found out of level.
    """
    share = stack.mass if pattern is None else np.asarray(pattern, dtype=float)
    if share.shape != (stack.n,):
        raise InputError(
            f"the load pattern has {share.size} values for {stack.n} drums; give one value per drum, bottom to top."
        )
    if not np.isfinite(share).all() or (share < 0.0).any() or share.sum() <= 0.0:
        raise InputError("the load pattern must hold finite values ≥ 0 with a positive sum; give relative forces.")
    forces = np.zeros((stack.n, 3))
    towards = np.array([np.cos(stack.slope), -np.sin(stack.slope)])
    forces[:, :2] = np.outer(share / share.sum() * stack.weight, towards)
    return forces


def crushing_forces(stack: BlockStack, compressive_strength: float | None) -> np.ndarray:
    """f_c A of each joint [N], infinite without a limit, shape (n,)."""
    if compressive_strength is None:
        return np.full(stack.n, np.inf)
    return stack.area * check_range(
        "compressive_strength",
        compressive_strength,
        0.0,
        1e12,
        unit="Pa",
        open_low=True,
        remedy="leave it out for none",
    )


def joint_forces(stack: BlockStack, loads: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compression N, shear V on the part above, and eccentricity of N in each joint under given loads, by equilibrium.

    Parameters
    ----------
    stack : BlockStack
    loads : array
        Forces and moment on each block [N, N, N m], shape (n, 3).

    Returns
    -------
    tuple of array
        [N], [N], [m], each of shape (n,); the eccentricity is NaN where N is not positive.
    """
    forces = np.linalg.solve(stack.compatibility().T, -loads.ravel()).reshape(-1, 3)
    n = forces[:, 0]
    return n, forces[:, 1], np.where(n > 0.0, forces[:, 2] / np.where(n > 0.0, n, 1.0), np.nan)


def check_standing(stack: BlockStack, dead: np.ndarray, strength: np.ndarray, base_tilt: float = 0.0) -> None:
    """Refuse a column that cannot stand under its own weight.

    Raises
    ------
    InputError
        Names the joint, what is needed, what there is, and the remedy.
    """
    n, v, e = joint_forces(stack, dead)
    left, right = contact_limits(stack)
    tilt = f" on a base tilted by {base_tilt:g} degrees" if base_tilt else ""
    for i in range(stack.n):
        where = f"joint {i + 1}"
        if n[i] >= strength[i]:
            raise InputError(
                f"{where} crushes under the column's own weight: it carries {n[i]:.4g} N and bears f_c A = "
                f"{strength[i]:.4g} N; give compressive_strength above {n[i] / stack.area[i]:.4g} Pa."
            )
        share = 1.0 - n[i] / strength[i]
        if abs(v[i]) > stack.friction[i] * n[i] + stack.cohesion[i] + 1e-12 * n[i]:
            raise InputError(
                f"{where} slides under the column's own weight{tilt}: it needs a friction coefficient of "
                f"{(abs(v[i]) - stack.cohesion[i]) / n[i]:.4g} and has {stack.friction[i]:.4g}; raise the friction "
                "or lower the tilt."
            )
        if not left[i] * share <= e[i] <= right[i] * share:
            raise InputError(
                f"the part above {where} overturns under its own weight{tilt}: its weight acts {e[i]:.4g} m from the "
                f"middle of the joint, allowed is {left[i] * share:.4g} to {right[i] * share:.4g} m; lower the tilt."
            )


def contact_limits(stack: BlockStack) -> tuple[np.ndarray, np.ndarray]:
    """Left and right end of each contact section, from the joint's middle [m], each of shape (n,)."""
    left = np.maximum(stack.upper_reach[:, 0], stack.lower_reach[:, 0])
    right = np.minimum(stack.upper_reach[:, 1], stack.lower_reach[:, 1])
    return left, right


#: A multiplier is the same if it differs by less than this share of itself [-].
SAME = 1e-6

#: A link holds its capacity if it must hold more than all but this share of it [-].
NEARLY = 1e-3

#: Most steps towards the least force of a link.
STEPS = 40


class CapacityLoad(NamedTuple):
    """Load of a programme with links of given capacities.

    ``multiplier`` [g]; ``worth``, by how much a larger capacity of each link would raise it [g/N], and ``link_forces``, the
    force of each in this answer [N], shapes (links,); ``forces``, all of this answer.
    """

    multiplier: float
    worth: np.ndarray
    link_forces: np.ndarray
    forces: np.ndarray


class LinkDemand(NamedTuple):
    """Links in every answer of a programme.

    ``least`` [N], the least that each holds, with the sign of that answer; ``yields``, whether that is its capacity;
    ``idle``, whether it need not act: all that are idle may be so at once. ``forces`` of an answer in which they are.
    """

    least: np.ndarray
    yields: np.ndarray
    idle: np.ndarray
    forces: np.ndarray


def needed_forces(
    solve: Callable[[np.ndarray, float], CapacityLoad], capacity: np.ndarray, whole: CapacityLoad
) -> LinkDemand:
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
    least, idle = np.where(yields, np.sign(whole.link_forces) * finite, 0.0), ~yields
    answer = solve(np.where(idle, 0.0, capacity), same) if idle.any() else whole
    if answer.multiplier >= same:
        return LinkDemand(least, yields, idle, answer.forces)
    for k in np.flatnonzero(idle):
        least[k], yields[k] = _least(solve, capacity, int(k), whole, same)
    idle = least == 0.0
    answer = solve(np.where(idle, 0.0, capacity), same) if idle.any() else whole
    if answer.multiplier < same:  # each can be left out, all at once cannot: one stands in for another
        idle[:] = False
        answer = whole
    return LinkDemand(least, yields, idle, answer.forces)


def _least(
    solve: Callable[[np.ndarray, float], CapacityLoad], capacity: np.ndarray, k: int, whole: CapacityLoad, same: float
) -> tuple[float, bool]:
    """The least that a link must hold [N], with its sign, and whether that is its capacity."""
    less, most = capacity.copy(), float(capacity[k])
    less[k], enough = 0.0, abs(float(whole.link_forces[k]))
    for _ in range(STEPS):
        load = solve(less, same)
        if load.multiplier >= same:
            return float(load.link_forces[k]) if less[k] else 0.0, False
        slope = float(load.worth[k])
        if load.multiplier == -np.inf and enough - less[k] > NEARLY * enough:  # without so much nothing stands
            less[k] = 0.5 * (less[k] + enough)
            continue
        if slope <= 0.0:
            break
        less[k] += (whole.multiplier - load.multiplier) / slope
        if less[k] >= most * (1.0 - NEARLY):
            return float(np.copysign(most, whole.link_forces[k])), True
    return float(np.copysign(less[k], whole.link_forces[k])), False


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
        gains = np.zeros(len(self.stack.links))
        for place, kind, slope in zip(self.place, self.kind, slopes, strict=True):
            if place >= self.stack.n and kind != "slack":
                gains[place - self.stack.n] += slope
        return gains

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
    result = _admissible(equilibrium, dead, live, facets, np.append(np.zeros(len(equilibrium)), -1.0))
    if result.status == 3:
        endless = [link.name for link in facets.stack.links if link.capacity == np.inf and link.strength]
        raise InputError(
            f"the column bears any push, because {' and '.join(endless[:2]) or 'a link'} has no capacity; give it one [N]."
        )
    _check_solved(result, "static")
    return float(result.x[-1]), result.x[:-1] * scale, -result.ineqlin.marginals / scale


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
            result = _admissible(equilibrium, dead, live, facets, cost, least)
            while result.status == 0 and facets.cut(result.x[:-1] * scale, strength):
                result = _admissible(equilibrium, dead, live, facets, cost, least)
            if result.status == 3:
                most[k] = np.inf
                continue
            _check_solved(result, "static")
            most[k] = max(most[k], -sign * result.x[size - links + k] * scale)
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
    result = linprog(
        np.append(-dead.ravel() / scale, np.array(facets.bound) / scale),
        A_eq=np.vstack((compatible, power)),
        b_eq=np.append(np.zeros(len(equilibrium)), 1.0),
        bounds=[(None, None)] * size + [(0.0, None)] * len(flow),
        method="highs",
        options=_TIGHT,
    )
    _check_solved(result, "kinematic")
    return float(result.fun), result.x[:size].reshape(-1, 3), result.x[size:]


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
    result = linprog(
        np.append(np.zeros(size), np.ones(len(flow))),
        A_eq=np.vstack((compatible, power)),
        b_eq=np.append(np.zeros(len(equilibrium)), 1.0),
        bounds=[(None, None)] * size + [(0.0, None if use else 0.0) for use in facets.used(forces)],
        method="highs",
        options=_TIGHT,
    )
    if result.status != 0 and facets.stack.links:
        return None
    _check_solved(result, "mechanism")
    return result.x[:size].reshape(-1, 3), result.x[size:]


def _check_solved(result, which: str) -> None:
    if result.status != 0:
        raise StylobateError(f"the {which} programme of the limit analysis was not solved: {result.message}")


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
class LimitResult(NotebookSummary):
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
        :func:`stylobate.statics.limit.limit_in_space`.
    flow : {"non-associated", "associated"}
        Flow rule of friction in the mechanism: sliding without or with dilatancy tan φ. In a stack without links the joint
        forces follow from equilibrium alone, so that the multiplier is the same; with links it is that of associated flow,
        and so is the mechanism where no other one is found.
    compressive_strength : float, optional
        f_c of the joints [Pa]; unlimited by default.

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

    def bear(facets: Facets) -> CapacityLoad:
        lower, forces, slopes = static_bound(equilibrium, dead, live, facets)
        # The crushing domain is curved: its tangents are added where the last answer left it.  (Kelley's cutting planes)
        while facets.cut(forces, strength):
            lower, forces, slopes = static_bound(equilibrium, dead, live, facets)
        return CapacityLoad(lower, facets.worth(slopes), -forces[3 * stack.n :], forces)

    facets = Facets(stack)
    whole = bear(facets)
    lower, forces, links = whole.multiplier, whole.forces, ()
    if stack.links:
        capacity = np.array([link.capacity for link in stack.links])
        needed = needed_forces(lambda capacities, _: bear(Facets(stack.with_capacities(capacities))), capacity, whole)
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
    links: Sequence[Any], needed: LinkDemand, largest: np.ndarray | None = None, towards: Sequence[Any] | None = None
) -> tuple[LinkForce, ...]:
    """Demand on the links of a programme, which have a name, an action and a capacity; the most of it [N] where known, and
    in space its direction."""
    most = np.full(len(links), math.nan) if largest is None else np.maximum(largest, np.abs(needed.least))
    ways = [None] * len(links) if towards is None else towards
    rows = zip(
        links, needed.least.tolist(), needed.yields.tolist(), needed.idle.tolist(), most.tolist(), ways, strict=True
    )
    return tuple(LinkForce(link.name, link.action, least, link.capacity, *rest) for link, least, *rest in rows)


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


# Limit analysis of assemblies, of what has links, and of forces from all directions.


class SpaceLimit(NamedTuple):
    """Multiplier [g], the lowest joint of the mechanism and what it does, and what every link holds."""

    multiplier: float
    joint: int
    mode: str
    links: tuple[LinkForce, ...]


class SpaceProgramme:
    """The programmes of a column: a new one for each direction, which stays small.

    Raises
    ------
    InputError
        The column does not stand without its links.
    """

    def __init__(self, column: Column) -> None:
        self.column, self.at = column, space_geometry(column)
        bare = column.replace(links=())
        self.rims = [self._rim(bare, j) for j in range(column.n)]
        self.links = [self._holder(link) for link in holds(column.placed_links) if link.strength]

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
        return Holder(hold.name, hold.action, *bodies, upper, upper, holder_axes(hold, frame), hold.capacity)

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
        solution = programme.converged(dead, live, programme.capacities)
        sizes = programme.movements(solution.rates)
        joint = int(np.argmax(sizes.max(axis=1) > MOVES * sizes.max()))
        mode = ("rocking", "sliding", "twisting")[int(np.argmax(sizes[joint]))]
        return SpaceLimit(solution.multiplier + 0.0, joint + 1, mode, demand(programme, dead, live, solution, largest))


def holder_axes(hold: Hold, frame: np.ndarray) -> np.ndarray:
    """Directions of the force that something across a joint puts on the body above, as columns; ``frame`` the joint's."""
    if hold.action == SHEAR:
        return frame[:, :2]
    return frame[:, 2:] if hold.action == APART else -frame[:, 2:]


def demand(
    programme: ContactProgramme, dead: np.ndarray, live: np.ndarray, solution: Solved, largest: bool = False
) -> tuple[LinkForce, ...]:
    """Action of the links at the multiplier of an answer, for these loads.

    Parameters
    ----------
    programme : ContactProgramme
        Its holders with a name are links.
    dead, live : array
        Over the weight, shape (6 n,).
    solution : Solved
    largest : bool
        Whether to look for the most that each holds as well.
    """
    links = [k for k, holder in enumerate(programme.holders) if holder.name]
    if not links:
        return ()
    every = programme.capacities

    def borne(answer: Solved) -> CapacityLoad:
        prices, holding_forces = answer.prices[links] / programme.weight, programme.holder_forces(answer.forces)[links]
        return CapacityLoad(answer.multiplier, prices, holding_forces, answer.forces)

    def bear(link_capacities: np.ndarray, enough: float) -> CapacityLoad:
        capacity = every.copy()
        capacity[links] = link_capacities
        try:
            return borne(programme.converged(dead, live, capacity, enough))
        except InfeasibleError:  # it does not even stand
            none = np.zeros(len(links))
            return CapacityLoad(-math.inf, none, none, solution.forces)

    needed = needed_forces(bear, every[links], borne(solution))
    holders = [programme.holders[k] for k in links]
    if not largest:
        return link_forces(holders, needed)
    least = solution.multiplier - SAME * max(abs(solution.multiplier), 1e-3)
    most = [largest_holder_force(programme, dead, live, least, k) for k in links]
    towards = [None if way is None else tuple(way.tolist()) for _, way in most]
    return link_forces(holders, needed, np.array([size for size, _ in most]), towards)


#: What moves with more than this share of the fastest takes part in the mechanism [-].
TAKES_PART = 1e-3

#: Most joints, and what the programme of so many takes in one direction [s]; it grows with their number to this power.
MOST_JOINTS, TAKES, GROWS = 800, 180.0, 2.5

#: Most bodies that a sentence names.
NAMED = 4


class AssemblyProgramme:
    """The programme of an assembly: what has been added for one direction stays for the next.

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
        self.moving = [i for i, body in enumerate(bodies) if not body.fixed]
        number = {body: k for k, body in enumerate(self.moving)}
        stones = [bodies[i] for i in self.moving]
        rims = [
            Rim(
                number.get(joint.upper, -1), number.get(joint.lower, -1), joint.frame, joint.origin, joint.edges,
                np.zeros(2), 0.5 * joint.width, joint.law.tan_phi, joint.law.cohesion * joint.area,
            )
            for joint in joints
        ]  # fmt: skip
        holders = [_holder(link, number) for link in holds(structure.placed_links) if link.strength]
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
        connections = (*(self.structure.space_joints or ()), *self.structure.placed_links)
        resting = {body for connection in connections for body in (connection.lower, connection.upper)}
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
        solution = programme.converged(self.dead, live, programme.capacities)
        rates = gentlest(programme, self.dead, live, solution)
        sizes = programme.movements(rates)
        active = np.flatnonzero(sizes.max(axis=1) > TAKES_PART * sizes.max())
        joint = int(min(active, key=lambda k: (round(float(programme.rims[k].origin[2]), 6), k)))
        mode = ("rocking", "sliding", "twisting")[int(np.argmax(sizes[joint]))]
        joints = self.structure.space_joints or ()
        slides = bool((sizes[:, 1] > TAKES_PART * sizes.max()).any())
        twists = any(
            space_joint.round and size > TAKES_PART * sizes.max()
            for space_joint, size in zip(joints, sizes[:, 2], strict=True)
        )
        between = joints[joint].lower, joints[joint].upper
        return DirectionLimit(
            azimuth,
            solution.multiplier + 0.0,
            joint + 1,
            mode,
            demand(programme, self.dead, live, solution, largest),
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
        return [self.structure.bodies[i].name for i, speed in zip(self.moving, fastest) if speed > TAKES_PART * most]


def _holder(hold: Hold, number: Mapping[int, int]) -> Holder:
    """What a link holds, by the numbers of the bodies in the programme."""
    link = hold.link
    bodies = number.get(link.upper, -1), number.get(link.lower, -1)
    if hold.action == LINE:
        low, high = np.array(link.low), np.array(link.high)
        return Holder(hold.name, LINE, *bodies, high, low, ((low - high) / link.length)[:, None], hold.capacity)
    middle = np.array(link.middle)
    axes = holder_axes(hold, np.array(link.frame).T)
    return Holder(hold.name, hold.action, *bodies, middle, middle, axes, hold.capacity)


def listed(names: Sequence[str]) -> str:
    """Names in a sentence, not too many of them; drums of one column together."""
    groups: dict[str, list[str]] = {}
    for name in names:
        column, _, drum = name.rpartition(", ")
        groups.setdefault(column if column and drum.startswith("drum ") else name, []).append(name)
    alone = [members[0] if len(members) == 1 else "" for members in groups.values()]
    several = [say("{column} ({count} drums)", column=name, count=len(members)) for name, members in groups.items()]
    words = [single or many for single, many in zip(alone, several, strict=True)]
    if len(words) > NAMED:
        return say("{names} and {count} more", names=joined(", ", words[:NAMED]), count=len(words) - NAMED)
    return joined(say(" and "), [joined(", ", words[:-1]), words[-1]])


#: Directions that are looked at where nobody says which [degrees], and halvings of the multiplier.
ALL_ROUND, HALVINGS = tuple(float(azimuth) for azimuth in range(0, 360, 15)), 60

#: Most directions of one analysis.
MOST_DIRECTIONS = 360

#: Multipliers that differ by less than this share are the same where the least of them is looked for [-].
CLOSE = 1e-5

#: A column that bears more than this is not held by its joints alone [g].
LARGEST = 1e3

#: The limit in a direction [degrees], and whether the most that links hold is looked for.
Solve = Callable[[float, bool], DirectionLimit]


@dataclass(frozen=True, eq=False)
class LimitByDirection(NotebookSummary):
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
            {"azimuth_deg": limit.azimuth, "multiplier_g": limit.multiplier, "joint": limit.joint, "mode": limit.mode}
            | limit.summary()
            for limit in self.limits
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
        return LimitByDirection(tuple(_in_plane(column, azimuth, loads) for azimuth in (0.0, 180.0)), "xz")
    stands = in_space(structure)
    if azimuths is None and stands is not structure:
        azimuths = (0.0, 180.0)
    directions = ALL_ROUND if azimuths is None else tuple(float(azimuth) for azimuth in azimuths)
    if not directions or not np.isfinite(directions).all():
        raise InputError("the directions are empty or not finite; give azimuths in degrees, such as 0:345:24.")
    if len(directions) > MOST_DIRECTIONS:
        raise InputError(
            f"there are {len(directions)} directions; allowed are 1 to {MOST_DIRECTIONS}: 0:345:24 is enough, because the "
            "weakest direction between them is looked for.",
            "directions",
            value=len(directions),
            allowed=f"1 to {MOST_DIRECTIONS}",
        )
    solve: Solve = AssemblyProgramme(stands).solve if column is None else _of_column(column)
    by_direction = _all_limits(solve, directions, progress)
    weakest = by_direction.weakest
    if not weakest.links:
        return by_direction
    count = len(weakest.links)
    logging.getLogger("stylobate").info(
        "looking for the most that %d link%s can hold, pushed towards %g degrees.",
        count,
        "s" * (count > 1),
        weakest.azimuth,
    )
    detailed_limit = solve(weakest.azimuth, True)
    limits = tuple(detailed_limit if limit is weakest else limit for limit in by_direction.limits)
    return LimitByDirection(limits, by_direction.dims, by_direction.all_round)


def _of_column(column: Column) -> Solve:
    """Limit of a column by the direction, and whether the most that links hold is looked for."""
    if not column.links:
        return lambda azimuth, _: limit_in_space(column, azimuth)
    column.must_carry_on_whole_faces("limit analysis in space")
    programme = SpaceProgramme(column)
    return lambda azimuth, largest: DirectionLimit(azimuth, *programme.solve(azimuth, largest))


def _all_limits(solve: Solve, directions: Sequence[float], progress: Progress | None = None) -> LimitByDirection:
    """Limits of all directions, and of those in which the weakest of all is looked for where they go all round."""
    turns = np.sort(np.mod(directions, 360.0))
    around = bool((np.diff(turns, append=turns[0] + 360.0) < 180.0).all())
    limits: list[DirectionLimit] = []
    most = len(directions) * (1 + around)

    def look(azimuth: float) -> None:
        limits.append(solve(azimuth, False))
        if progress is not None:
            progress(len(limits), most + 1)

    for azimuth in directions:
        look(azimuth)
    while len(limits) < most and (weaker := _may_be_weaker(limits)) is not None:
        look(weaker)
    return LimitByDirection(tuple(limits), "xyz", around)


def _may_be_weaker(limits: Sequence[DirectionLimit]) -> float | None:
    """Direction in which a chord between neighbours is nearest [degrees]; None where none is nearer than the least."""
    order = sorted(limits, key=lambda limit: limit.azimuth % 360.0)
    nearest, where = min(limit.multiplier for limit in limits) * (1.0 - CLOSE), None
    for current, other in zip(order, [*order[1:], order[0]], strict=True):
        start, end = (
            limit.multiplier * np.array((math.cos(limit.azimuth * DEGREE), math.sin(limit.azimuth * DEGREE)))
            for limit in (current, other)
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
    analysis = limit_analysis(column, direction=direction, **loads)
    lowest = next(item for item in analysis.active if item.joint == analysis.governing_joint)
    return DirectionLimit(direction, analysis.multiplier, lowest.joint, lowest.mode.split()[0], analysis.links)


def limit_in_space(column: Column, azimuth: float = 0.0) -> DirectionLimit:
    """Collapse multiplier of horizontal forces, in proportion to mass, in one direction in space.

    A stack without links is statically determinate: what lies above a joint presses it with one force, which must pass
    through the overlap of its faces and within the cone of friction. A single force does not twist the joint about the point
    at which it acts. Rigid drums, joints of unlimited strength; static and kinematic bound coincide. With links see
    :mod:`stylobate.statics.limit`.

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
