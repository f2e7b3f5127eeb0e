"""Limit analysis in space of columns with links: what contact and links can bear together; see ``contact_programme.py``."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..column import Column
from ..column.found_geometry import base_axes, overlap_edges, space_geometry, space_load, upward
from ..constants import DEGREE
from ..errors import InputError
from ..models.rigid_block.block_stack import APART, LINE, SHEAR, Hold, holds
from .contact_programme import MOVES, ContactProgramme, InfeasibleError, Solved
from .contact_rims import Holder, Rim
from .least_forces import SAME, Borne, needed_forces
from .limit import LinkForce, link_forces
from .programme_choices import largest_held


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
