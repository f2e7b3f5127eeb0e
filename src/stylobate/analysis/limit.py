"""Limit analysis of the rigid–plastic column: lower and upper bound by linear programmes, mechanism, active joints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..column import Column
from ..column.structure import Structure
from ..errors import InputError, check_choice, check_kind
from ..models.rigid_block.block_stack import BlockStack
from ..notebook import Shown
from .least_forces import Borne, Needed, needed_forces
from .limit_programmes import (
    ACTIVE,
    Facets,
    equilibrium_matrix,
    kinematic_bound,
    largest_forces,
    non_associated,
    static_bound,
)  # fmt: skip
from .pushover_result import mechanism_rows
from .static_loads import check_standing, crushing_forces, gravity_forces, horizontal_forces

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
        :func:`stylobate.analysis.limit_directions.limit_in_space`.
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
