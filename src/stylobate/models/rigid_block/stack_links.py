"""Links between the blocks of a stack, in the plane: where they hold, what strains them, and how far they go."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...column import Column
from ...column.links.placed import PlacedLink, stands_at
from ...errors import InputError

#: Action of a link: it holds a joint in shear, holds it closed, is a straight line that holds in tension, or, a clamp, holds
#: what it clamps apart.
SHEAR, CLOSING, LINE, APART = "shear", "closing", "line", "apart"


class Hold(NamedTuple):
    """One thing that a link does at rest; a bar across a joint does two. Dashpots do nothing.

    Parameters
    ----------
    link : PlacedLink
        In the plane its ends are where the stack has them, x and z [m].
    action : {"shear", "closing", "line", "apart"}
    """

    link: PlacedLink
    action: str

    @property
    def name(self) -> str:
        """Of the link."""
        return self.link.name

    @property
    def blocks(self) -> tuple[int, int]:
        """The lower and the upper block that it holds, from 0 at the bottom; −1 is the base."""
        return self.link.lower - 1, self.link.upper - 1

    @property
    def stiffness(self) -> float:
        """[N/m]"""
        return self.link.shear_stiffness if self.action == SHEAR else self.link.axial_stiffness

    @property
    def capacity(self) -> float:
        """[N], infinite without limit."""
        return self.link.shear_capacity if self.action == SHEAR else self.link.axial_capacity

    @property
    def slack(self) -> float:
        """Slip to either side before it acts [m]."""
        return self.link.clearance if self.action == SHEAR else 0.0

    @property
    def ultimate(self) -> float:
        """Slip or elongation beyond which it is lost [m]."""
        return self.link.ultimate_slip if self.action == SHEAR else self.link.ultimate_elongation

    @property
    def lift(self) -> float:
        """Opening of its joint beyond which it holds nothing [m]."""
        return self.link.lift if self.action == SHEAR else math.inf

    @property
    def brittle(self) -> bool:
        """Whether it is lost at its capacity."""
        return self.action == SHEAR and self.link.failure == "brittle"

    @property
    def strength(self) -> bool:
        """Whether its capacity is a strength, as limit analysis knows it; that of a sheet's spring without one is not."""
        return self.action != SHEAR or self.link.mark != "sheet" or self.capacity < math.inf

    def with_capacity(self, capacity: float) -> Hold:
        """The same with another capacity [N]."""
        name = "shear_capacity" if self.action == SHEAR else "axial_capacity"
        return self._replace(link=replace(self.link, **{name: capacity}))

    def mirrored(self) -> Hold:
        """As seen in a mirror."""
        (x, y, z), (u, v, w) = self.link.low, self.link.high
        return self._replace(link=replace(self.link, low=(-x, y, z), high=(-u, v, w)))


def holds(links: Sequence[PlacedLink]) -> list[Hold]:
    """All that links do at rest.

    Raises
    ------
    InputError
        A link of a law that statics do not know.
    """
    found = []
    for link in links:
        if link.law == "tie":
            actions = (LINE,) if link.axial_stiffness > 0.0 else ()
        elif link.law in ("dowel", "pad", "clamp"):
            actions = (SHEAR,) if link.shear_stiffness > 0.0 else ()
            actions += (CLOSING,) if link.axial_stiffness > 0.0 else ()
            actions += (APART,) if link.axial_stiffness > 0.0 and link.law == "clamp" else ()
        else:
            raise InputError(
                f"the statics of blocks know links that act as a clamp, dowel, pad or tie, and {link.name!r} does not; "
                "leave it out."
            )
        found += [Hold(link, action) for action in actions]
    return found


def stack_links(column: Column) -> tuple[Hold, ...]:
    """Links of a column in the plane of x and z, where its drums are found."""
    if not column.links:
        return ()

    def found(link: PlacedLink) -> PlacedLink:
        stand = (column.bodies[link.lower], column.bodies[link.upper])
        low, high = (stands_at(body.place, body.angle, arm) for body, arm in zip(stand, link.arms, strict=True))
        return replace(link, low=low, high=high)

    return tuple(holds([found(link) for link in column.placed_links]))


def link_strains(
    links: tuple[Hold, ...], centroid: np.ndarray, joint_angle: np.ndarray, position: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Strain of every link, its derivative, and the opening of the joint at it.

    Parameters
    ----------
    links : tuple of Hold
    centroid : array
        Of the blocks [m], shape (n, 2).
    joint_angle : array
        Of the joints [rad], shape (n,).
    position : array, optional
        Displacement of each centroid in x and z [m] and rotation of each block [rad], shape (n, 3); none if left out.

    Returns
    -------
    strain : array
        Slip of the part above along the joint, opening, or elongation [m], shape (links,); zero where nothing has moved.
    slope : array
        Derivative by the coordinates of the blocks, shape (links, 3 n).
    opening : array
        Of the joint at the link [m]; 0 of a line, shape (links,).
    """
    n = len(centroid)
    moved = np.zeros((n, 3)) if position is None else position
    strain, opening, slope = np.zeros(len(links)), np.zeros(len(links)), np.zeros((len(links), 3 * n))
    for k, link in enumerate(links):
        strain[k], opening[k], by_low, by_high = link_strain(link, centroid, joint_angle, moved)
        for block, by in zip(link.blocks, (by_low, by_high), strict=True):
            if block >= 0:
                slope[k, 3 * block : 3 * block + 3] += by
    return strain, slope, opening


def link_strain(
    one: Hold, centroid: np.ndarray, joint_angle: np.ndarray, moved: np.ndarray
) -> tuple[float, float, np.ndarray, np.ndarray]:
    """Strain of one link and the opening of its joint [m], and derivatives of the strain by its two blocks' coordinates."""
    below, above = one.blocks
    (x, y, z), (u, v, w) = one.link.low, one.link.high
    low, by_low = _point(below, (x, z), centroid, moved)
    high, by_high = _point(above, (u, w), centroid, moved)
    apart, built, aside = high - low, np.array([u - x, w - z]), v - y
    if one.action == LINE:
        length = math.hypot(apart[0], apart[1], aside)
        along = apart / length
        return length - math.hypot(built[0], built[1], aside), 0.0, -(along @ by_low), along @ by_high
    angle = float(joint_angle[above])
    tangent, normal = _axes(angle + (moved[below, 2] if below >= 0 else 0.0))
    first, second = _axes(angle)
    opening = float(apart @ normal - built @ second)
    shear = one.action == SHEAR
    along, across = (tangent, normal) if shear else (normal, -tangent)
    by_lower = -(along @ by_low)
    by_lower[2] += apart @ across
    return (float(apart @ tangent - built @ first) if shear else opening), opening, by_lower, along @ by_high


def _axes(angle: float) -> tuple[np.ndarray, np.ndarray]:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c, s]), np.array([-s, c])


def _point(
    block: int, place: tuple[float, float], centroid: np.ndarray, moved: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Place of a point of a block [m], and its derivative by the block's coordinates, shape (2, 3)."""
    if block < 0:
        return np.array(place), np.zeros((2, 3))
    x, z, turn = moved[block]
    c, s = math.cos(turn), math.sin(turn)
    reach = np.array([[c, -s], [s, c]]) @ (np.array(place) - centroid[block])
    return centroid[block] + (x, z) + reach, np.array([[1.0, 0.0, -reach[1]], [0.0, 1.0, reach[0]]])
