"""A column as found: where its drums and joints are, how its weight goes down, what opens its joints."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..constants import DEGREE
from ..errors import InputError
from .as_found import FoundDrum
from .drum import Drum
from .joint import Joint
from .links.placed import pull_on_part
from .plausible import field_in_doubt, size_doubts
from .shapes import CHIP_SLOPE
from .stack import Stack
from .structure import Standing, Structure


class DrumStack(Stack, Structure):
    """Drums on drums, with links, as found: what a column is to those who look where it stands and what loads it."""

    @cached_property
    def joint_laws(self) -> tuple[Joint, ...]:
        """Law of each joint with the layer or pad that lies in it."""
        laws = list(self.joints)
        for link in self.placed_links:
            if link.joint:
                laws[link.joint - 1] = link.joint_law(laws[link.joint - 1])
        return tuple(laws)

    @cached_property
    def friction(self) -> np.ndarray:
        """tan φ of each joint, that of a layer where there is one [-], shape (n,)."""
        return np.array([law.tan_phi for law in self.joint_laws])

    @property
    def on_rings(self) -> bool:
        """Whether some joint carries on a ring."""
        return any(joint.ring_width is not None for joint in self.joints)


# -- A column as found ------------------------------------------------------------------------------------------------


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
        found_drum = column.as_found.of(i + 1)
        azimuth = found_drum.offset_azimuth * DEGREE
        offset = found_drum.offset * np.array([math.cos(azimuth), math.sin(azimuth)])
        gap, first, second = (0.0, 0.0, 0.0) if closing is None else closing[i]
        out.frame[i], out.origin[i], out.offset[i] = frame, origin, offset
        middle = origin + frame @ (*offset, gap)
        size = math.hypot(first, second)
        if size > 0.0:
            frame = frame @ rotation(np.array([first / size, second / size, 0.0]), size)
        azimuth = found_drum.tilt_azimuth * DEGREE
        lean = rotation(np.array([math.sin(azimuth), -math.cos(azimuth), 0.0]), found_drum.tilt * DEGREE)
        frame = frame @ lean
        turned += found_drum.turn * DEGREE
        spin = rotation(up, turned)
        out.turned[i], out.axes[i], out.bed[i] = turned, frame @ spin, spin.T @ lean.T @ spin
        out.centroid[i] = middle + drum.centroid_height * frame[:, 2]
        origin = middle + drum.height * frame[:, 2]
    return out


def shares_left(column: DrumStack) -> np.ndarray:
    """Share of each drum's lower face that its chips leave [-], shape (n,)."""
    shares = np.ones(column.n)
    for found_drum in column.as_found.drums:
        drum = column.drums[found_drum.drum - 1]
        width, depth = drum.bottom_width, drum.depth
        if drum.circular:
            lost = sum(_segment(0.5 * width, chip) for chip in (found_drum.chip_left, found_drum.chip_right))
            shares[found_drum.drum - 1] -= lost / (0.25 * math.pi * width**2)
        else:
            a, b, c, d = found_drum.chips
            shares[found_drum.drum - 1] = (width - a - b) * (depth - c - d) / (width * depth)
    return shares


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
    drum, found_drum = column.drums[joint], column.as_found.of(joint + 1)
    below = column.drums[joint - 1] if joint else None
    half, middle = 0.5 * drum.bottom_width, at.offset[joint]
    discs: list[tuple[np.ndarray, float]] = []
    sides: list[tuple[np.ndarray, float]] = []

    def straight(angle: float, own: np.ndarray, reach: tuple[float, float], across: tuple[float, float] | None) -> None:
        for axis, ends in zip(rotation(np.array([0.0, 0.0, 1.0]), -angle)[:2, :2], (reach, across), strict=True):
            if ends is not None:
                sides.extend((sign * axis, end + sign * float(axis @ own)) for sign, end in zip((1.0, -1.0), ends))

    along = half - found_drum.chip_right, half - found_drum.chip_left
    angle = at.turned[joint] + found_drum.chip_azimuth * DEGREE
    if drum.circular:
        discs.append((middle, half))
        if found_drum.chipped:
            straight(angle, middle, along, None)
        if below is not None:
            discs.append((np.zeros(2), 0.5 * below.top_width))
        return Edges(tuple(discs), tuple(sides))
    straight(angle, middle, along, (0.5 * drum.depth - found_drum.chip_back, 0.5 * drum.depth - found_drum.chip_front))
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


# -- Drums and contacts of a column as found, the way of its weight down, and what opens its joints -------------------


class Geometry(NamedTuple):
    """A column as it stands, its joints closed; in axes along and normal to the base, from the middle of its contact.

    ``foot`` [m] is where each drum's centroid projects to on its lower face, from the face's middle. ``lean`` [rad] is the
    inclination of each joint, ``tilt`` [rad] that of a drum's axis to the normal of its lower face; ``origin`` [m] the
    middle of the face under each drum; ``low`` and ``high`` [m] the ends of the contact along the joint, from there.
    Shapes (n,), ``origin`` and ``centroid`` (n, 2).
    """

    foot: np.ndarray
    tilt: np.ndarray
    lean: np.ndarray
    origin: np.ndarray
    centroid: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def end(self, joint: int, side: int) -> np.ndarray:
        """End of a contact, to the left (side < 0) or to the right [m], shape (2,)."""
        place = self.high[joint] if side > 0 else self.low[joint]
        return self.origin[joint] + place * np.array([math.cos(self.lean[joint]), math.sin(self.lean[joint])])


def geometry(column: DrumStack) -> Geometry:
    """Places of a column's drums and contacts."""
    n, found_drums = column.n, [column.as_found.of(i + 1) for i in range(column.n)]
    offset = np.array([state.offset for state in found_drums])
    tilt = np.array([state.tilt * DEGREE for state in found_drums])
    lean = np.concatenate(([0.0], np.cumsum(tilt)[:-1]))
    centroid = np.array([drum.centroid_height for drum in column.drums])
    foot = -centroid * np.sin(tilt)
    low, high = np.empty(n), np.empty(n)
    origins, centroids = np.empty((n, 2)), np.empty((n, 2))
    origin = np.zeros(2)
    for i, (drum, found_drum) in enumerate(zip(column.drums, found_drums, strict=True)):
        b = 0.5 * drum.bottom_width
        under = 0.5 * column.drums[i - 1].top_width if i else math.inf
        low[i] = max(offset[i] - b + found_drum.chip_left, -under)
        high[i] = min(offset[i] + b - found_drum.chip_right, under)
        origins[i] = origin
        middle = origin + offset[i] * np.array([math.cos(lean[i]), math.sin(lean[i])])
        axis = lean[i] + tilt[i]
        up = np.array([-math.sin(axis), math.cos(axis)])
        centroids[i] = middle + centroid[i] * up
        origin = middle + drum.height * up
    return Geometry(foot, tilt, lean, origins, centroids, low, high)


def gravity_vector(structure: Structure) -> np.ndarray:
    """Acceleration of gravity along and normal to the base [m/s²], shape (2,)."""
    slope = structure.as_found.base_tilt * DEGREE
    return -structure.gravity * np.array([math.sin(slope), math.cos(slope)])


class JointLoad(NamedTuple):
    """Action of the weight above a joint: compression and downhill shear [N], and where, along the joint [m]."""

    normal: float
    shear: float
    place: float


def joint_load(column: DrumStack, at: Geometry, joint: int) -> JointLoad:
    """Load of a joint under the weight of what stands on it."""
    mass = column.masses[joint:]
    weight = float(mass.sum()) * gravity_vector(column)
    arm = mass @ at.centroid[joint:] / mass.sum() - at.origin[joint]
    along = np.array([math.cos(at.lean[joint]), math.sin(at.lean[joint])])
    normal = np.array([-along[1], along[0]])
    if column.pretensioned:
        return _pulled_load(column, at, joint, weight, along)
    pressing = -float(weight @ normal)
    if pressing <= 0.0:
        return JointLoad(pressing, float(weight @ along), math.nan)
    return JointLoad(pressing, float(weight @ along), float(arm @ along + (arm @ normal) * (weight @ along) / pressing))


def _pulled_load(column: DrumStack, at: Geometry, joint: int, weight: np.ndarray, along: np.ndarray) -> JointLoad:
    """As :func:`joint_load`, with the pull of pretensioned links."""
    angle = at.lean + at.tilt
    c, s, zeros, ones = np.cos(angle), np.sin(angle), np.zeros(column.n), np.ones(column.n)
    axes = np.stack((c, zeros, -s, zeros, ones, zeros, s, zeros, c), axis=1).reshape(-1, 3, 3)
    centroids = np.stack((at.centroid[:, 0], zeros, at.centroid[:, 1]), axis=1)
    force, moment = pull_on_part(column.placed_links, centroids, axes, joint)
    mass, origin = column.masses[joint:], at.origin[joint]
    arm = mass @ at.centroid[joint:] / mass.sum() - origin
    total = weight + force[[0, 2]]
    turning = arm[0] * weight[1] - arm[1] * weight[0] - moment[1] - origin[0] * force[2] + origin[1] * force[0]
    pressing = float(along[1] * total[0] - along[0] * total[1])
    if pressing <= 0.0:
        return JointLoad(pressing, float(total @ along), math.nan)
    return JointLoad(pressing, float(total @ along), -float(turning) / pressing)


def uplift_accelerations(column: DrumStack) -> np.ndarray:
    """Static horizontal accelerations of the ground that open each joint of the rigid stack above it [m/s²].

    Returns
    -------
    array, shape (n, 2)
        Of the ground to the left (the part above turns about the right end of its contact), negative; and to the right.

    Notes
    -----
    Weight and inertia force d × (g − a) = 0 about the end of the contact, with d from there to the centroid and the
    acceleration a (cos β, −sin β) along and normal to a base of slope β. Pretensioned links move the place at which the
    joint is pressed, and press it more.
    """
    at, weight, slope = geometry(column), gravity_vector(column), column.as_found.base_tilt * DEGREE
    pulled = column.pretensioned
    out = np.empty((column.n, 2))
    for j in range(column.n):
        mass = column.masses[j:]
        centroid = mass @ at.centroid[j:] / mass.sum()
        load = joint_load(column, at, j) if pulled else None
        for k, (side, end) in enumerate(((1, at.high[j]), (-1, at.low[j]))):
            d = centroid - at.end(j, side)
            moment = d[1] * weight[0] - d[0] * weight[1]  # over the mass
            if load is not None:
                moment = load.normal * (load.place - end) / mass.sum()
            out[j, k] = moment / (d[0] * math.sin(slope) + d[1] * math.cos(slope))
    return out


def check_as_found(column: DrumStack) -> None:
    """Refuse what cannot stand: the weight above each joint must pass through its contact, and not slide on it.

    Pretensioned links pull with it.

    Raises
    ------
    InputError
        A drum that the column does not have, faces that no longer touch, or no equilibrium; the message names the joint
        and the missing moment or force.
    """
    name = repr(column.name)
    for drum in column.as_found.drums:
        if drum.drum > column.n:
            raise InputError(
                f"{name} is given drum {drum.drum} as found; it has drums 1 to {column.n}.", f"found.{drum.drum}"
            )
        if column.section == "circular" and (drum.chip_front or drum.chip_back):
            raise InputError(
                f"drum {drum.drum} of {name} is round, and chip_front = {drum.chip_front:g}, chip_back = {drum.chip_back:g} "
                "m; round drums take chip_left and chip_right with a chip_azimuth.",
                f"found.{drum.drum}.{'chip_front' if drum.chip_front else 'chip_back'}",
            )
        if column.section != "circular" and drum.chip_azimuth:
            raise InputError(
                f"drum {drum.drum} of {name} is rectangular, and its chip_azimuth is {drum.chip_azimuth:g}°; such drums "
                "take chip_left, chip_right, chip_front and chip_back along their edges: leave chip_azimuth out.",
                f"found.{drum.drum}.chip_azimuth",
            )
    if not column.as_found.in_plane:
        _check_in_space(column)
        return
    at = geometry(column)
    parted = np.flatnonzero(at.high - at.low <= 0.0)
    if parted.size:
        raise InputError(
            f"joint {parted[0] + 1} of {name} has no contact left; make its offsets or chips smaller.",
            f"found.{parted[0] + 1}.offset",
        )
    for j in range(column.n):
        load = joint_load(column, at, j)
        beyond = max(load.place - at.high[j], at.low[j] - load.place)
        _check_joint(column, j, load.normal, abs(load.shear), beyond)


def _check_in_space(column: DrumStack) -> None:
    at = space_geometry(column)
    for j, drum in enumerate(column.drums):
        left, right, front, back = column.as_found.of(j + 1).chips
        if left + right >= drum.bottom_width or front + back >= drum.depth:
            raise InputError(
                f"joint {j + 1} of {column.name!r} has no contact left; make its chips smaller.",
                f"found.{j + 1}.chip_{'left' if left + right >= drum.bottom_width else 'front'}",
            )
        load = space_load(column, at, j)
        inside = inside_overlap(column, at, j, load.place)
        _check_joint(column, j, load.normal, float(np.hypot(*load.shear)), -inside)


def _check_joint(column: DrumStack, j: int, normal: float, shear: float, beyond: float) -> None:
    """Refuse a joint that slides under its load [N], or that its load passes beyond its contact [m]."""
    name, law = repr(column.name), column.joint_laws[j]
    friction = column.friction[j] * normal + law.cohesion * column.joint_areas[j]
    if normal <= 0.0 or shear > friction:
        raise InputError(
            f"{name} is not in equilibrium: joint {j + 1} slides down its slope, "
            f"{shear - max(friction, 0.0):.4g} N of friction are missing; "
            "make tilts or base_tilt smaller, or the friction larger.",
            "base_tilt" if column.as_found.base_tilt else f"found.{j + 1}.tilt",
        )
    if beyond > 0.0:
        doubt = next(iter(size_doubts(column)), None)  # a column of a wrong size stands on no slope
        leans = "base_tilt" if column.as_found.base_tilt else f"found.{j + 1}.offset"
        raise InputError(
            f"{name} is not in equilibrium: at joint {j + 1} the weight above passes {1000.0 * beyond:.3g} mm beyond "
            f"the contact, {normal * beyond:.4g} N m are missing; "
            f"{doubt or 'make offsets, chips, tilts or base_tilt smaller.'}",
            field_in_doubt(column) if doubt else leans,
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class StandingDrum(Standing):
    """A drum that stands in a column: its faces are told in axes along and normal to its lower one, inclined by ``lean``."""

    drum: Drum
    as_found: FoundDrum

    @cached_property
    def polygon(self) -> np.ndarray:
        """Corners from its centroid in these axes, counter-clockwise from the lower left [m], shape (k, 2)."""
        drum, found_drum = self.drum, self.as_found
        tilt = found_drum.tilt * DEGREE
        c, s = math.cos(tilt), math.sin(tilt)
        half, high = 0.5 * drum.top_width, drum.height
        top = {side: np.array([c * side * half - s * high, s * side * half + c * high]) for side in (-1, 1)}
        corners = []
        for side, chip in ((-1, found_drum.chip_left), (1, found_drum.chip_right)):
            edge = np.array([side * 0.5 * drum.bottom_width, 0.0])
            flank = edge + min(CHIP_SLOPE * chip / drum.height, 0.5) * (top[side] - edge)
            face = edge - (side * chip, 0.0)
            corners += [face] if chip == 0.0 else [flank, face] if side < 0 else [face, flank]
        return np.array([*corners, top[1], top[-1]]) - drum.centroid_height * np.array([-s, c])
