"""Stacks of rigid blocks as arrays, from a column or from convex quadrilaterals, with what their links hold."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ...column import Column, Joint
from ...column.found_geometry import geometry
from ...column.links.placed import PlacedLink, stands_at
from ...constants import DEGREE
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
    all_holds = []
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
        all_holds += [Hold(link, action) for action in actions]
    return all_holds


def stack_links(column: Column) -> tuple[Hold, ...]:
    """Links of a column in the plane of x and z, where its drums are found."""
    if not column.links:
        return ()

    def found_link(link: PlacedLink) -> PlacedLink:
        stand = (column.bodies[link.lower], column.bodies[link.upper])
        low, high = (stands_at(body.place, body.angle, arm) for body, arm in zip(stand, link.arms, strict=True))
        return replace(link, low=low, high=high)

    return tuple(holds([found_link(link) for link in column.placed_links]))


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
    hold: Hold, centroid: np.ndarray, joint_angle: np.ndarray, moved: np.ndarray
) -> tuple[float, float, np.ndarray, np.ndarray]:
    """Strain of one link and the opening of its joint [m], and derivatives of the strain by its two blocks' coordinates."""
    below, above = hold.blocks
    (x, y, z), (u, v, w) = hold.link.low, hold.link.high
    low, by_low = _point(below, (x, z), centroid, moved)
    high, by_high = _point(above, (u, w), centroid, moved)
    apart, built, aside = high - low, np.array([u - x, w - z]), v - y
    if hold.action == LINE:
        length = math.hypot(apart[0], apart[1], aside)
        along = apart / length
        return length - math.hypot(built[0], built[1], aside), 0.0, -(along @ by_low), along @ by_high
    angle = float(joint_angle[above])
    tangent, normal = _axes(angle + (moved[below, 2] if below >= 0 else 0.0))
    first, second = _axes(angle)
    opening = float(apart @ normal - built @ second)
    shear = hold.action == SHEAR
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


#: Reach of the base to either side of its joint [m]: a plane without end.
BASE_REACH = 1.0e6


@dataclass(frozen=True, eq=False)
class BlockStack:
    """Blocks i = 0 … n−1 from the bottom; joint i lies under block i, joint 0 on the base.

    Parameters
    ----------
    mass, inertia : array
        [kg], [kg m²] about the block's centroid, shape (n,).
    centroid : array
        Place of each centroid, x and z from the middle of the base joint [m], shape (n, 2).
    joint : array
        Place of the middle of each joint's contact section [m], shape (n, 2).
    angle : array
        Angle of each joint with the horizontal, counter-clockwise positive [rad], shape (n,).
    width, area, second_moment : array
        Of the contact section [m], [m²], [m⁴], shape (n,).
    upper_reach, lower_reach : array
        How far the face above and the face below reach to the left (negative) and the right of the joint's middle
        [m], shape (n, 2).
    normal_stiffness, rotational_stiffness, shear_stiffness : array
        k_n A [N/m], k_n J [N m], k_s A [N/m], shape (n,).
    friction : array
        tan φ [-], shape (n,).
    cohesion : array
        c A [N], shape (n,).
    top : array
        Middle of the topmost face [m], shape (2,).
    gravity : float
        [m/s²]
    outlines : array or sequence of array
        Corners of each block in the plane, counter-clockwise from the lower left [m], shape (n, 4, 2); of columns as found
        one array (k, 2) for each block, because chips have corners too.
    slope : float
        Of the base as found, counter-clockwise positive [rad]; all other angles and places are along and normal to it.
    links : tuple of Hold
        What its links do.
    """

    mass: np.ndarray
    inertia: np.ndarray
    centroid: np.ndarray
    joint: np.ndarray
    angle: np.ndarray
    width: np.ndarray
    area: np.ndarray
    second_moment: np.ndarray
    upper_reach: np.ndarray
    lower_reach: np.ndarray
    normal_stiffness: np.ndarray
    rotational_stiffness: np.ndarray
    shear_stiffness: np.ndarray
    friction: np.ndarray
    cohesion: np.ndarray
    top: np.ndarray
    gravity: float
    outlines: np.ndarray | Sequence[np.ndarray]
    slope: float = 0.0
    links: tuple[Hold, ...] = ()

    @property
    def n(self) -> int:
        """Number of blocks."""
        return len(self.mass)

    @property
    def weight(self) -> float:
        """Total weight [N]."""
        return float(self.mass.sum() * self.gravity)

    @classmethod
    def of_column(cls, column: Column) -> BlockStack:
        """The blocks of a column: true trapezia; circular sections through their areas and second moments.

        Raises
        ------
        InputError
            A column on rings, or found out of the plane.
        """
        column.must_carry_on_whole_faces("the statics of blocks")
        if column.as_found:
            return cls._as_found(column)
        n = column.n
        low = np.array([drum.bottom_width for drum in column.drums]) / 2.0
        high = np.array([drum.top_width for drum in column.drums]) / 2.0
        z = np.append(column.joint_heights, column.height)
        outlines = np.array(
            [[[-low[i], z[i]], [low[i], z[i]], [high[i], z[i + 1]], [-high[i], z[i + 1]]] for i in range(n)]
        )
        below = np.append(BASE_REACH, high[:-1])
        return cls(
            mass=column.masses,
            inertia=column.inertias,
            centroid=np.column_stack((np.zeros(n), column.centroid_heights)),
            joint=np.column_stack((np.zeros(n), column.joint_heights)),
            angle=np.zeros(n),
            width=column.joint_widths,
            area=column.joint_areas,
            second_moment=column.joint_second_moments,
            upper_reach=np.column_stack((-low, low)),
            lower_reach=np.column_stack((-below, below)),
            top=np.array([0.0, column.height]),
            gravity=column.gravity,
            outlines=outlines,
            links=stack_links(column),
            **_stiffness(column.joint_laws, column.joint_areas, column.joint_second_moments, column.friction),
        )

    @classmethod
    def _as_found(cls, column: Column) -> BlockStack:
        """The blocks of a column as found, in axes along and normal to its base."""
        if not column.as_found.in_plane:
            raise InputError(
                f"{column.name!r} is found out of the plane of x and z, and the statics of blocks are plane; "
                "'limit' goes round it in space; project it onto a plane (`project=AZIMUTH`), or leave azimuths "
                "and turns out."
            )
        at, n = geometry(column), column.n
        along = np.column_stack((np.cos(at.lean), np.sin(at.lean)))
        middle, width = 0.5 * (at.low + at.high), at.high - at.low
        # of a round drum: the contact of a round face as wide as what is left of the overlap
        share = width / column.joint_widths
        power = 2.0 if column.section == "circular" else 1.0
        area, second = column.joint_areas * share**power, column.joint_second_moments * share ** (power + 2.0)
        upper, lower = np.empty((n, 2)), np.empty((n, 2))
        outlines = tuple(body.outline for body in column.bodies[1:])
        for i, drum in enumerate(column.drums):
            found_drum = column.as_found.of(i + 1)
            under = 0.5 * column.drums[i - 1].top_width if i else BASE_REACH
            half = 0.5 * drum.bottom_width
            upper[i] = found_drum.offset - half + found_drum.chip_left, found_drum.offset + half - found_drum.chip_right
            lower[i] = -under, under
        top = 0.5 * (outlines[-1][-1] + outlines[-1][-2])
        return cls(
            mass=column.masses,
            inertia=column.inertias,
            centroid=at.centroid,
            joint=at.origin + middle[:, None] * along,
            angle=at.lean,
            width=width,
            area=area,
            second_moment=second,
            upper_reach=upper - middle[:, None],
            lower_reach=lower - middle[:, None],
            top=top,
            gravity=column.gravity,
            outlines=outlines,
            slope=column.as_found.base_tilt * DEGREE,
            links=stack_links(column),
            **_stiffness(column.joint_laws, area, second, column.friction),
        )

    def with_capacities(self, capacity: np.ndarray) -> BlockStack:
        """The same stack whose links have other capacities [N], shape (links,)."""
        links = zip(self.links, capacity.tolist(), strict=True)
        return replace(self, links=tuple(hold.with_capacity(most) for hold, most in links))

    def mirrored(self) -> BlockStack:
        """The same stack with left and right changed."""
        flip = np.array([-1.0, 1.0])
        return replace(
            self,
            centroid=self.centroid * flip,
            joint=self.joint * flip,
            angle=-self.angle,
            upper_reach=-self.upper_reach[:, ::-1],
            lower_reach=-self.lower_reach[:, ::-1],
            top=self.top * flip,
            outlines=tuple(corners[::-1] * flip for corners in self.outlines),
            slope=-self.slope,
            links=tuple(link.mirrored() for link in self.links),
        )

    def parts_above(self) -> tuple[np.ndarray, np.ndarray]:
        """Mass [kg], shape (n,), and centroid [m], shape (n, 2), of the part of the stack above each joint."""
        mass = np.cumsum(self.mass[::-1])[::-1]
        moment = np.cumsum((self.mass[:, None] * self.centroid)[::-1], axis=0)[::-1]
        return mass, moment / mass[:, None]

    def compatibility(self) -> np.ndarray:
        """B: opening, slip and rotation of each joint from the blocks' small displacements, shape (3n, 3n).

        Rows per joint: opening at the joint's middle, slip of the part above along the joint, rotation of the part
        above relative to the part below. Bᵀ turns the joint forces (N, V, M) on the part above into forces on all blocks.
        """
        n = self.n
        matrix = np.zeros((3 * n, 3 * n))
        for i in range(n):
            c, s = np.cos(self.angle[i]), np.sin(self.angle[i])
            for block, sign in ((i, 1.0), (i - 1, -1.0)):
                if block < 0:
                    continue
                arm = self.joint[i] - self.centroid[block]
                rows, columns = slice(3 * i, 3 * i + 3), slice(3 * block, 3 * block + 3)
                matrix[rows, columns] = sign * np.array(
                    [[-s, c, s * arm[1] + c * arm[0]], [c, s, -c * arm[1] + s * arm[0]], [0.0, 0.0, 1.0]]
                )
        return matrix


def _stiffness(joints: Sequence[Joint], area: np.ndarray, second: np.ndarray, friction: np.ndarray) -> dict[str, Any]:
    normal = np.array([joint.normal_stiffness for joint in joints])
    return {
        "normal_stiffness": normal * area,  # Baraldi et al., Eq. 8
        "rotational_stiffness": normal * second,
        "shear_stiffness": np.array([joint.shear_stiffness for joint in joints]) * area,
        "friction": friction,
        "cohesion": np.array([joint.cohesion for joint in joints]) * area,
    }
