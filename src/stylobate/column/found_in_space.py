"""A column as found in space: where its drums and joints are, how its weight goes down, what opens its joints."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..constants import DEGREE
from .drum_stack import DrumStack
from .links.loads import pull_on_part
from .structure import Structure

#: Directions in which the smallest push that opens a joint is looked for, and halvings of it.
DIRECTIONS, HALVINGS = 360, 60


class SpaceGeometry(NamedTuple):
    """A column as it stands, in axes along and normal to the base, from the middle of its contact.

    ``frame`` has the axes of the joint under each drum as columns, ``axes`` those of the drum, ``bed`` those of its lower
    face from its own; ``turned`` [rad] is how far each drum is turned about its axis. ``origin`` [m] is the middle of the
    face under a drum, ``offset`` [m] where the middle of its own face lies along the joint. Shapes (n, 3, 3), (n,),
    (n, 3) and (n, 2).
    """

    frame: np.ndarray
    axes: np.ndarray
    bed: np.ndarray
    turned: np.ndarray
    origin: np.ndarray
    offset: np.ndarray
    centroid: np.ndarray


def rotation(axis: np.ndarray, angle: float) -> np.ndarray:
    """Matrix of a rotation by an angle [rad] about an axis of length 1."""
    if angle == 0.0:  # most of a column is upright: the same bits at a tenth of the time
        return np.eye(3)
    x, y, z = axis
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * skew + (1.0 - math.cos(angle)) * skew @ skew


def space_geometry(column: DrumStack, closing: np.ndarray | None = None) -> SpaceGeometry:
    """Places of a column's drums and joints.

    Parameters
    ----------
    column : DrumStack
    closing : array, optional
        Gap of each joint in the middle of the drum's face [m], and its rotation about the joint's first and second axis
        [rad], shape (n, 3); closed without either if left out.
    """
    n = column.n
    frames, beds = np.empty((n, 3, 3)), np.empty((n, 3, 3))
    out = SpaceGeometry(
        frames, np.empty((n, 3, 3)), beds, np.empty(n), np.empty((n, 3)), np.empty((n, 2)), np.empty((n, 3))
    )
    frame, origin, turned = np.eye(3), np.zeros(3), 0.0
    up = np.array([0.0, 0.0, 1.0])
    for i, drum in enumerate(column.drums):
        one = column.as_found.of(i + 1)
        azimuth = one.offset_azimuth * DEGREE
        offset = one.offset * np.array([math.cos(azimuth), math.sin(azimuth)])
        gap, first, second = (0.0, 0.0, 0.0) if closing is None else closing[i]
        out.frame[i], out.origin[i], out.offset[i] = frame, origin, offset
        middle = origin + frame @ (*offset, gap)
        size = math.hypot(first, second)
        if size > 0.0:
            frame = frame @ rotation(np.array([first / size, second / size, 0.0]), size)
        azimuth = one.tilt_azimuth * DEGREE
        lean = rotation(np.array([math.sin(azimuth), -math.cos(azimuth), 0.0]), one.tilt * DEGREE)
        frame = frame @ lean
        turned += one.turn * DEGREE
        spin = rotation(up, turned)
        out.turned[i], out.axes[i], out.bed[i] = turned, frame @ spin, spin.T @ lean.T @ spin
        out.centroid[i] = middle + drum.centroid_height * frame[:, 2]
        origin = middle + drum.height * frame[:, 2]
    return out


def shares_left(column: DrumStack) -> np.ndarray:
    """Share of each drum's lower face that its chips leave [-], shape (n,)."""
    left = np.ones(column.n)
    for one in column.as_found.drums:
        drum = column.drums[one.drum - 1]
        width, depth = drum.bottom_width, drum.depth
        if drum.circular:
            lost = sum(_segment(0.5 * width, chip) for chip in (one.chip_left, one.chip_right))
            left[one.drum - 1] -= lost / (0.25 * math.pi * width**2)
        else:
            a, b, c, d = one.chips
            left[one.drum - 1] = (width - a - b) * (depth - c - d) / (width * depth)
    return left


def _segment(radius: float, height: float) -> float:
    """Area of the segment of a disc with a height [m²]."""
    angle = math.acos(1.0 - height / radius)
    return radius * radius * (angle - math.sin(angle) * math.cos(angle))


def base_axes(column: Structure) -> np.ndarray:
    """Axes of the base as columns, in those of the motion [-], shape (3, 3): it rises towards its azimuth."""
    azimuth = column.as_found.base_azimuth * DEGREE
    return rotation(np.array([math.sin(azimuth), -math.cos(azimuth), 0.0]), column.as_found.base_tilt * DEGREE)


def upward(column: DrumStack) -> np.ndarray:
    """Direction against gravity in the axes of the base [-], shape (3,)."""
    return base_axes(column)[2]


class SpaceLoad(NamedTuple):
    """Action of the weight above a joint: compression and shear [N], and where along the joint [m]."""

    normal: float
    shear: np.ndarray
    place: np.ndarray


def space_load(column: DrumStack, at: SpaceGeometry, joint: int, acceleration: np.ndarray | None = None) -> SpaceLoad:
    """Load of a joint under what stands on it, in the axes of the joint; under gravity, or −``acceleration`` [m/s²]."""
    mass = column.masses[joint:]
    towards = column.gravity * upward(column) if acceleration is None else acceleration
    force = -float(mass.sum()) * (at.frame[joint].T @ towards)
    arm = at.frame[joint].T @ (mass @ at.centroid[joint:] / mass.sum() - at.origin[joint])
    if column.pretensioned:
        pull, moment = pull_on_part(column.placed_links, at.centroid, at.axes, joint)
        moment = at.frame[joint].T @ (moment - np.cross(at.origin[joint], pull)) + np.cross(arm, force)
        force = force + at.frame[joint].T @ pull
        if force[2] < 0.0:
            return SpaceLoad(-float(force[2]), force[:2], np.array([-moment[1], moment[0]]) / force[2])
    normal = -float(force[2])
    place = arm[:2] + arm[2] * force[:2] / normal if normal > 0.0 else np.full(2, np.nan)
    return SpaceLoad(normal, force[:2], place)


class Edges(NamedTuple):
    """Boundary of the overlap of the two faces of a joint, in the axes of the joint: discs, and sides of straight edges.

    A place p is inside a disc by radius − |p − middle|, and inside a side by bound − normal · p [m].
    """

    discs: tuple[tuple[np.ndarray, float], ...]
    sides: tuple[tuple[np.ndarray, float], ...]


def overlap_edges(column: DrumStack, at: SpaceGeometry, joint: int) -> Edges:
    """Edges of the overlap of the faces of a joint 0 … n−1."""
    drum, one = column.drums[joint], column.as_found.of(joint + 1)
    below = column.drums[joint - 1] if joint else None
    half, middle = 0.5 * drum.bottom_width, at.offset[joint]
    discs: list[tuple[np.ndarray, float]] = []
    sides: list[tuple[np.ndarray, float]] = []

    def straight(angle: float, own: np.ndarray, reach: tuple[float, float], across: tuple[float, float] | None) -> None:
        for axis, ends in zip(_turned_back(np.eye(2), angle), (reach, across), strict=True):
            if ends is not None:
                sides.extend((sign * axis, end + sign * float(axis @ own)) for sign, end in zip((1.0, -1.0), ends))

    along = half - one.chip_right, half - one.chip_left
    angle = at.turned[joint] + one.chip_azimuth * DEGREE
    if drum.circular:
        discs.append((middle, half))
        if one.chipped:
            straight(angle, middle, along, None)
        if below is not None:
            discs.append((np.zeros(2), 0.5 * below.top_width))
        return Edges(tuple(discs), tuple(sides))
    straight(angle, middle, along, (0.5 * drum.depth - one.chip_back, 0.5 * drum.depth - one.chip_front))
    if below is not None:
        wide, deep = 0.5 * below.top_width, 0.5 * below.upper_depth
        straight(at.turned[joint - 1], np.zeros(2), (wide, wide), (deep, deep))
    return Edges(tuple(discs), tuple(sides))


def inside_overlap(column: DrumStack, at: SpaceGeometry, joint: int, place: np.ndarray) -> float:
    """Depth of a place along a joint within both faces; negative outside [m]."""
    return inside(overlap_edges(column, at, joint), place)


def inside(edges: Edges, place: np.ndarray) -> float:
    """Depth of a place along a joint within the edges of an overlap; negative outside [m]."""
    discs, sides = edges
    within = [radius - math.hypot(*(place - middle)) for middle, radius in discs]
    return min(within + [bound - float(normal @ place) for normal, bound in sides])


def _turned_back(point: np.ndarray, angle: float) -> np.ndarray:
    """A place along a joint in axes that are turned by an angle [rad]."""
    return rotation(np.array([0.0, 0.0, 1.0]), -angle)[:2, :2] @ point


def smallest_uplift(column: DrumStack) -> np.ndarray:
    """Smallest static horizontal acceleration in any direction that opens each joint of the rigid stack [m/s²]."""
    return weakest_uplift(column)[0]


def weakest_uplift(column: DrumStack) -> tuple[np.ndarray, np.ndarray]:
    """The same, and where the forces push to then.

    Returns
    -------
    accelerations, azimuths : ndarray
        [m/s²]; from x towards y [degrees], shapes (n,).
    """
    at, out, towards = space_geometry(column), np.full(column.n, math.inf), np.full(column.n, math.nan)
    base, weight = base_axes(column), column.gravity * upward(column)
    for j in range(column.n):
        edges = overlap_edges(column, at, j)
        for azimuth in np.arange(DIRECTIONS) * (2.0 * math.pi / DIRECTIONS):
            push = base.T @ (math.cos(azimuth), math.sin(azimuth), 0.0)
            low, high = 0.0, float(min(out[j], 100.0 * column.gravity))
            if _carries(column, at, j, edges, weight + high * push):
                continue
            for _ in range(HALVINGS):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if _carries(column, at, j, edges, weight + middle * push) else (low, middle)
            if high < out[j] * (1.0 - 1e-9):  # of equal ones the first
                towards[j] = (math.degrees(azimuth) + 180.0) % 360.0
            out[j] = high
    return out, towards


def _carries(column: DrumStack, at: SpaceGeometry, joint: int, edges: Edges, acceleration: np.ndarray) -> bool:
    load = space_load(column, at, joint, acceleration)
    return load.normal > 0.0 and inside(edges, load.place) > 0.0
