"""Links between the blocks of a stack, in the plane: where they hold, what strains them, and how far they go."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...column import Column
from ...column.found_geometry import geometry
from ...column.link_laws import LinkProperties, properties

#: What a link does: it holds a joint in shear, holds it closed, or is a straight line that holds in tension.
SHEAR, CLOSING, LINE = "shear", "closing", "line"


@dataclass(frozen=True)
class StackLink:
    """One thing that a link does; a bar across a joint is two of them.

    Parameters
    ----------
    name : str
        Of the link.
    action : {"shear", "closing", "line"}
    lower, upper : int
        Blocks that it links, from 0 at the bottom; −1 is the base.
    low, high : (float, float)
        Its ends, x and z as those of the stack [m].
    aside : float
        How far a line goes out of the plane [m].
    stiffness, capacity : float
        [N/m], [N]; the capacity infinite without limit.
    slack : float
        Slip to either side before it acts [m].
    ultimate : float
        Slip or elongation beyond which it is lost [m].
    lift : float
        Opening of its joint beyond which it holds nothing [m].
    pretension : float
        [N]
    brittle : bool
        Whether it is lost at its capacity.
    strength : bool
        Whether its capacity is a strength, as limit analysis knows it; that of a spring of a layer without capacity is not.
    """

    name: str
    action: str
    lower: int
    upper: int
    low: tuple[float, float]
    high: tuple[float, float]
    stiffness: float
    capacity: float = math.inf
    slack: float = 0.0
    ultimate: float = math.inf
    lift: float = math.inf
    pretension: float = 0.0
    brittle: bool = False
    strength: bool = True
    aside: float = 0.0

    def mirrored(self) -> StackLink:
        """As seen in a mirror."""
        (x, z), (u, w) = self.low, self.high
        return replace(self, low=(-x, z), high=(-u, w))


def actions(link: LinkProperties) -> tuple[str, ...]:
    """What a link does at rest; dashpots nothing."""
    if link.straight:
        return (LINE,) if link.axial_stiffness > 0.0 else ()
    across = (SHEAR,) if link.shear_stiffness > 0.0 else ()
    return (*across, CLOSING) if link.axial_stiffness > 0.0 else across


def is_strength(link: LinkProperties, action: str) -> bool:
    """Whether the capacity of what a link does is a strength; that of a layer's spring without capacity is not."""
    return action != SHEAR or link.kind != "layer" or link.shear_capacity < math.inf


def stack_links(column: Column) -> tuple[StackLink, ...]:
    """The links of a column in the plane of x and z, where its drums are found; dashpots do nothing at rest."""
    if not column.links:
        return ()
    at = geometry(column)

    def place(body: int, point: tuple[float, float, float]) -> tuple[float, float]:
        """A point of a body in the column as built, as the column is found; body 0 is the base."""
        if body == 0:
            return point[0], point[2]
        i = body - 1
        angle = at.lean[i] + at.tilt[i]
        x, z = point[0], point[2] - column.centroid_heights[i]
        c, s = math.cos(angle), math.sin(angle)
        return float(at.centroid[i, 0] + c * x - s * z), float(at.centroid[i, 1] + s * x + c * z)

    found: list[StackLink] = []
    for one in properties(column):
        low, high = place(one.lower, one.low), place(one.upper, one.high)
        bodies = one.lower - 1, one.upper - 1
        for action in actions(one):
            if action == SHEAR:
                own = StackLink(
                    one.name, SHEAR, *bodies, low, high, one.shear_stiffness, one.shear_capacity, one.clearance,
                    one.ultimate_slip, one.lift, brittle=one.failure == "brittle", strength=is_strength(one, action),
                )  # fmt: skip
            else:
                own = StackLink(
                    one.name, action, *bodies, low, high, one.axial_stiffness, one.axial_capacity,
                    ultimate=one.ultimate_elongation, pretension=one.pretension,
                    aside=one.high[1] - one.low[1] if action == LINE else 0.0,
                )  # fmt: skip
            found.append(own)
    return tuple(found)


def link_strains(
    links: tuple[StackLink, ...], centroid: np.ndarray, joint_angle: np.ndarray, position: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Strain of every link, its derivative, and the opening of the joint at it.

    Parameters
    ----------
    links : tuple of StackLink
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
    for k, one in enumerate(links):
        strain[k], opening[k], by_low, by_high = link_strain(one, centroid, joint_angle, moved)
        for block, by in ((one.lower, by_low), (one.upper, by_high)):
            if block >= 0:
                slope[k, 3 * block : 3 * block + 3] += by
    return strain, slope, opening


def link_strain(
    one: StackLink, centroid: np.ndarray, joint_angle: np.ndarray, moved: np.ndarray
) -> tuple[float, float, np.ndarray, np.ndarray]:
    """Strain of one link and the opening of its joint [m], and derivatives of the strain by its two blocks' coordinates."""
    low, by_low = _point(one.lower, one.low, centroid, moved)
    high, by_high = _point(one.upper, one.high, centroid, moved)
    apart, built = high - low, np.subtract(one.high, one.low)
    if one.action == LINE:
        length = math.hypot(apart[0], apart[1], one.aside)
        along = apart / length
        return length - math.hypot(built[0], built[1], one.aside), 0.0, -(along @ by_low), along @ by_high
    angle = float(joint_angle[one.upper])
    tangent, normal = _axes(angle + (moved[one.lower, 2] if one.lower >= 0 else 0.0))
    first, second = _axes(angle)
    opening = float(apart @ normal - built @ second)
    shear = one.action == SHEAR
    along, across = (tangent, normal) if shear else (normal, -tangent)
    below = -(along @ by_low)
    below[2] += apart @ across
    return (float(apart @ tangent - built @ first) if shear else opening), opening, below, along @ by_high


def _axes(angle: float) -> tuple[np.ndarray, np.ndarray]:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c, s]), np.array([-s, c])


def _point(
    block: int, place: tuple[float, float], centroid: np.ndarray, moved: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Where a point of a block is [m], and its derivative by the block's coordinates, shape (2, 3)."""
    if block < 0:
        return np.array(place), np.zeros((2, 3))
    x, z, turn = moved[block]
    c, s = math.cos(turn), math.sin(turn)
    reach = np.array([[c, -s], [s, c]]) @ (np.array(place) - centroid[block])
    return centroid[block] + (x, z) + reach, np.array([[1.0, 0.0, -reach[1]], [0.0, 1.0, reach[0]]])
