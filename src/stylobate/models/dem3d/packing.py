"""Columns in space as the kernels want them: records, what shares lanes, drums, joints, links, starts, step, verdict."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ...column import Column, Drum
from ...column.as_found import FoundDrum
from ...column.found_geometry import SpaceGeometry, SpaceLoad, base_axes, rotation, space_geometry, space_load, upward
from ...constants import DEGREE
from ...errors import InputError
from ...kernels.dem3d.records import CHIPS, RINGS, types
from ...kernels.run_codes import LANES
from ...kernels.shared.records import GROUND, JOINT, STATE
from ..drums.links import acting, hold_of, law_fields
from ..drums.records import UNSEEN, LaneRecords, Topology, body_fields
from ..shared.stable_step import highest_frequency as of_springs
from ..start import Start


class Records(LaneRecords):
    """Records of bodies of which each stands on the one below; others as for :class:`LaneRecords`.

    Parameters
    ----------
    kernel : module
        Of the engine.
    """

    axes_of_base = 3

    def __init__(self, kernel: Any, types: Mapping[str, np.dtype], topology: Topology, joints: int) -> None:
        super().__init__(types, topology, joints, spare=1)  # for what all loads of a body add up to
        self.kernel = kernel

    def put(self, lane: int, numbers: np.ndarray) -> None:
        """Write all numbers of a lane."""
        super().put(lane, numbers)
        if "near" in (self.lane.dtype.names or ()):
            self.look_at_all_vertices()

    def look_at_all_vertices(self) -> None:
        """Let every vertex count as near the ground: the engine finds those that are before it steps."""
        every = np.arange(len(self.joint))
        self.lane["near"].reshape(-1)[every] = every
        self.lane["count"] = len(every)

    # -- looks at a lane, which change nothing that matters ------------------------------------------------------

    def ledgers(
        self, state: tuple[Any, ...], lanes: np.ndarray, dt: np.ndarray, bases: np.ndarray, out: np.ndarray
    ) -> None:
        """Write the ledgers of lanes of a state whose forces are those of its positions."""
        state[GROUND]["a"][0][:, lanes] = bases.T  # filled anew before the next step
        self.kernel.ledgers(state, dt, lanes, out)

    def net(self, lane: int) -> tuple[np.ndarray, np.ndarray]:
        """Forces [N] and moments [N m] of their contacts on every body in its present position, each of shape (n, 3)."""
        state = self.now()
        state[STATE.index("lane")]["dt"][0, lane] = 0.0
        self.kernel.gather(state)
        return self.body["f"][1:, :, lane], self.body["mo"][1:, :, lane]

    # of a lane, or of an array of them, whose axis comes first

    def joints(self, lane: int | np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Opening of every joint [m], and since the start its slip where it is closest [m], and twist with full turns [rad].

        Shapes (…, n), (…, n, 2), (…, n).
        """
        size = np.size(lane), len(self.body) - 1
        opening, slip, twist = np.empty(size), np.empty((*size, 2)), np.empty(size)
        self.kernel.joint_states(self.state, np.atleast_1d(lane), opening, slip, twist)
        selection: Any = ... if np.ndim(lane) else 0
        return opening[selection], slip[selection], twist[selection]

    def places(self, lane: int | np.ndarray) -> np.ndarray:
        """Centroids of all bodies [m], shape (…, n, 3)."""
        return self.vectors(lane, "x y z")

    def axes(self, lane: int | np.ndarray) -> np.ndarray:
        """Axes of every body as the columns of a matrix [-], shape (…, n, 3, 3)."""
        matrices = np.empty((*np.shape(lane), len(self.body) - 1, 3, 3))
        for axis, a in enumerate("ijk"):
            self._copy_fields(matrices[..., axis], lane, (f"{a}x", f"{a}y", f"{a}z"))
        return matrices

    def vectors(self, lane: int | np.ndarray, names: str) -> np.ndarray:
        """Vectors of all bodies but the base, by the names of their fields, shape (…, n, 3)."""
        values = np.empty((*np.shape(lane), len(self.body) - 1, 3))
        self._copy_fields(values, lane, names.split())
        return values

    def _copy_fields(self, target: np.ndarray, lane: int | np.ndarray, names: Sequence[str]) -> None:
        for c, name in enumerate(names):
            target[..., c] = self.body[name][1:, lane].T

    def acceleration(self, lane: int) -> float:
        """Largest acceleration of a body in its present position without input; of its edge, where it turns [m/s²]."""
        force, moment = self.net(lane)
        im, ia, ib, ic, reach = (self.body[name][1:, lane] for name in ("im", "ia", "ib", "ic", "rb"))
        linear = np.abs(force * im[:, None] - self.lane["g"][0, :, lane]).max()
        easiest = ia + np.maximum(np.maximum(ib, ic), 0.0)  # about the axis of the least moment of inertia
        return float(max(linear, (np.abs(moment).max(axis=1) * easiest * reach).max()))


#: In place of a section: one body that stands on its vertices; round drums on rings, or with chips.
SPECIMEN, RING, CHIPPED = "specimen", "ring", "chipped"

#: On what the bodies of a section stand, as the kernels' records are told; others by the law of contact.
FACES = {SPECIMEN: "vertex", "rectangular": "corner", RING: "ring", CHIPPED: "chip"}

#: The contacts of a single body: with the base.
ALONE = Topology(2, ((0, 1),), stack=1)


class Kind(NamedTuple):
    """Common block of lanes.

    Parameters
    ----------
    topology : Topology
    section : str
    rows : int
        Of the records of joints.
    law : str
        Of round faces.
    damped, rolls : bool
        Whether there are dashpots, and resistance to rolling.
    """

    topology: Topology
    section: str
    rows: int
    law: str
    damped: bool
    rolls: bool

    @property
    def face(self) -> str:
        """On what the bodies stand, as the kernels' records are told."""
        return FACES.get(self.section, self.law)

    def record_types(self, linked: bool, lanes: int = LANES) -> dict[str, np.dtype]:
        """Types of the kernel's records, with links or without."""
        return types(self.face, self.damped, self.rolls, linked, lanes)


def highest_frequency(column: Column, kn: np.ndarray, ks: np.ndarray, share: float) -> float:
    """Highest angular frequency of the column with all joints closed [rad/s].

    Parameters
    ----------
    column : Column
    kn, ks : array
        Normal and shear stiffness per area of each joint [N/m³], shape (n,).
    share : float
        χ: bending stiffness of a joint over k_n J, less 1 (1 for the rim law, 0 for an elastic bed, 2 for corners).

    Notes
    -----
    An open or sliding joint is softer than a closed one, so that this bounds every state. Bending and sway of a vertical
    plane (x, z, θ per drum), the same in all directions for round drums, in two for rectangular ones; and torsion.
    """
    n = column.n
    second, across = column.joint_second_moments, column.joint_second_moments
    torsion_of, mass = 1.0, column.masses
    planes = [(second, column.inertias)]
    if column.section != "circular":
        depth = column.joint_areas / column.joint_widths
        across = column.joint_areas * depth**2 / 12.0
        torsion_of = 1.0 + share  # the corners are at the same distance in torsion as in bending
        planes.append((across, np.array([drum.cross_inertia for drum in column.drums])))
    axial = np.array([drum.axial_inertia for drum in column.drums])
    around = np.eye(n) - np.eye(n, k=-1)
    torsion = around.T @ np.diag(torsion_of * ks * (second + across)) @ around
    highest = of_springs(torsion, 1.0 / axial)
    for bending, inertia in planes:
        stiffness = _sway(column, kn, ks, (1.0 + share) * bending)
        highest = max(highest, of_springs(stiffness, 1.0 / np.stack((mass, mass, inertia), axis=1).ravel()))
    return highest


def _sway(column: Column, kn: np.ndarray, ks: np.ndarray, bending: np.ndarray) -> np.ndarray:
    """Stiffness of the closed column in a vertical plane, for x, z and θ of every drum, shape (3 n, 3 n)."""
    n = column.n
    stiffness = np.zeros((3 * n, 3 * n))
    centroid = np.array([drum.centroid_height for drum in column.drums])
    for j in range(n):
        area = column.joint_areas[j]
        rows = np.zeros((3, 3 * n))  # shear, closure, rotation of the joint per degree of freedom
        rows[0, 3 * j], rows[0, 3 * j + 2] = 1.0, centroid[j]
        rows[1, 3 * j + 1] = rows[2, 3 * j + 2] = 1.0
        if j:
            rows[0, 3 * j - 3], rows[0, 3 * j - 1] = -1.0, column.drums[j - 1].height - centroid[j - 1]
            rows[1, 3 * j - 2] = rows[2, 3 * j - 1] = -1.0
        stiffness += rows.T @ np.diag([ks[j] * area, kn[j] * area, kn[j] * bending[j]]) @ rows
    return stiffness


def pack_column(
    records: Records,
    column: Column,
    fields: tuple[dict[str, np.ndarray], dict[str, np.ndarray], dict[str, Any]],
    links: Mapping[str, np.ndarray],
    top: Callable[[Records, np.ndarray], np.ndarray],
) -> np.ndarray:
    """Numbers of a lane with a column, from the fields of its drums, joints and lane; ``records`` are empty ones.

    Slips and twists count from where the joints are, turns from where the axes are.
    """
    body, joint, lane = fields
    records.fill(0, body=body | {"a" + c: body["k" + c] for c in "xyz"}, joint=joint, lane=lane)
    _, slip, twist = records.joints(0)
    records.fill(0, joint={"ox": slip[:, 0], "oy": slip[:, 1], "ot": twist, "tw": twist})
    records.fill(0, feed={"r": base_axes(column).T.ravel()}, link=links)
    records.fill(0, watch=UNSEEN | dict(zip(("sx", "sy"), top(records, np.array([0]))[0], strict=True)))
    return records.taken(0)


#: Radius of the base, wide enough to be a half-space [m].
BASE_RADIUS = 1.0e3

#: Radius of a sunken middle that is none [m].
LEAST = 1e-9


def drum_fields(column: Column, closure: np.ndarray) -> dict[str, np.ndarray]:
    """Fields of the drums that are not 0, or that links need, the base first: upright, at rest, each joint closed by
    ``closure`` [m], shape (n,)."""
    n, plane = column.n + 1, body_fields(column, closure)
    centroid = np.array([drum.centroid_height for drum in column.drums])
    axial = np.array([drum.axial_inertia for drum in column.drums])
    zeros, ones = np.zeros(n), np.ones(n)

    def on_base(values: Any, base: float = 0.0) -> np.ndarray:
        return np.concatenate(([base], values))

    cross = np.array([drum.cross_inertia for drum in column.drums])
    half = {
        name: [0.5 * getattr(drum, name) for drum in column.drums]
        for name in ("bottom_width", "top_width", "depth", "upper_depth")
    }
    axes = {axis + c: ones if "ijk".index(axis) == "xyz".index(c) else zeros for axis in "ijk" for c in "xyz"}
    return (
        axes
        | {name: plane[name] for name in ("x", "z", "m", "im")}
        | {
            "y": zeros,
            "ia": plane["ii"],
            "ic": on_base(1.0 / axial - 1.0 / column.inertias),
            "ib": on_base(np.where(cross == column.inertias, 0.0, 1.0 / cross - 1.0 / column.inertias)),
            "fx": zeros,
            "fy": zeros,
            "fz": on_base(-centroid),
            "nz": ones,
            "ht": on_base(column.heights - centroid),
            "tx": on_base(half["top_width"], BASE_RADIUS),
            "ty": on_base(half["upper_depth"], BASE_RADIUS),
        }
        | (_round(half, on_base) if column.section == "circular" else _cornered(half, on_base))
    )


def _round(half: dict[str, list[float]], on_base: Callable[..., np.ndarray]) -> dict[str, np.ndarray]:
    """Radii of the faces."""
    return {"rb": on_base(half["bottom_width"]), "rt": on_base(half["top_width"], BASE_RADIUS)}


#: Signs of the corners of a face in order round it; mirror images in the plane of x and z follow one another.
CORNERS = np.array([(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)])


def _cornered(half: dict[str, list[float]], on_base: Callable[..., np.ndarray]) -> dict[str, np.ndarray]:
    """Corners of the faces, and how far the farthest is."""
    along, depth = on_base(half["bottom_width"]), on_base(half["depth"])
    return {
        "px": along[:, None] * CORNERS[:, 0],
        "py": depth[:, None] * CORNERS[:, 1],
        "rb": np.hypot(along, depth),
        "rt": np.hypot(on_base(half["top_width"], BASE_RADIUS), on_base(half["upper_depth"])),
    }


def joint_fields(column: Column, kn: np.ndarray, ks: np.ndarray) -> dict[str, np.ndarray]:
    """Fields of the joints that are not 0, the one with the base first."""
    own = {"ring": _sunken(column)} if column.on_rings else {"chip": _lost(column)} if chipped(column) else {}
    cohesion = np.array([joint.cohesion for joint in column.joints])
    return own | {"kn": kn, "ks": ks, "co": cohesion, "mu": column.friction}


def chipped(column: Column) -> bool:
    """Whether drums are round and chipped."""
    return column.section == "circular" and any(drum.chipped for drum in column.as_found.drums)


def chip_directions(column: Column) -> np.ndarray:
    """Towards the chip of every drum's lower face, in the axes of the drum [-], shape (n, 3)."""
    found_drums = [column.as_found.of(i + 1) for i in range(column.n)]
    azimuth = np.radians([drum.chip_azimuth for drum in found_drums])
    away = [-1.0 if drum.chip_left else 1.0 for drum in found_drums]
    flat = np.stack((away * np.cos(azimuth), away * np.sin(azimuth)), axis=1)
    return np.einsum("nca,na->nc", space_geometry(column).bed[:, :, :2], flat)


def _lost(column: Column) -> np.ndarray:
    """Loss by chips of the upper face of every joint (legend of kernels), (n, 6)."""
    lost = np.zeros((column.n, CHIPS))
    lost[:, :3] = chip_directions(column)
    for i, drum in enumerate(column.drums):
        versine = 2.0 * max(column.as_found.of(i + 1).chips) / drum.bottom_width
        sine = math.sqrt(versine * (2.0 - versine))
        lost[i, 3:] = math.atan2(sine, 1.0 - versine), 1.0 - versine, sine
    return lost


def _sunken(column: Column) -> np.ndarray:
    """Radii of the sunken middles of the upper and the lower face [m], and the limit of torsion over ρ μ N, (n, 3).

    The limit is that of two concentric rings under even pressure.
    """
    holes = np.zeros((column.n, RINGS))
    for j in range(column.n):
        radius = 0.5 * column.joint_widths[j]
        upper, lower = (0.5 * width for width in column.sunken_widths(j))
        inner = max(upper, lower)
        evenly = 2.0 / 3.0 * (radius**3 - inner**3) / (radius**2 - inner**2)  # Eq. (E11)
        holes[j] = max(upper, LEAST), max(lower, LEAST), evenly / math.sqrt(0.5 * (radius**2 + inner**2))
    return holes


def lane_fields(
    column: Column,
    damping: np.ndarray,
    pivot_friction: float,
    planar: bool,
    rolling_resistance: float = 0.0,
) -> dict[str, Any]:
    """Fields of a lane that are not 0; ``damping`` from :func:`damping_rows`, other parameters as of the model."""
    return {
        "g": column.gravity * upward(column),
        "damp": damping,
        "pivot": pivot_friction,
        "roll": rolling_resistance,
        "free": 0.0 if planar else 1.0,
    }


def link_fields(column: Column, drum: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Fields of the links of a column in space that are not 0, whose drums stand as these fields of the records say."""
    links = acting(column)
    if not links:
        return {}
    joint, line, ends = np.zeros((len(links), 3)), np.zeros(len(links)), np.zeros((2, len(links), 3))
    axes = np.stack([np.stack([drum[a + c] for c in "xyz"], axis=-1) for a in "ijk"], axis=-1)
    centroids, foot = (np.stack([drum[a + c] for c in "xyz"], axis=-1) for a in ("", "f"))
    beds = space_geometry(column).bed if column.as_found else np.repeat(np.eye(3)[None], column.n, axis=0)
    for m, link in enumerate(links):
        low, up = link.lower, link.upper
        if link.straight:
            ends[:, m] = link.arms
            lower_end, upper_end = (
                centroids[body] + axes[body] @ end for body, end in ((low, ends[0, m]), (up, ends[1, m]))
            )
            line[m] = math.dist(lower_end, upper_end)
            continue
        ends[1, m] = foot[up] + beds[up - 1] @ (*link.high[:2], 0.0)
        joint[m] = axes[low].T @ (centroids[up] + axes[up] @ ends[1, m] - centroids[low]) - (0.0, 0.0, drum["ht"][low])
    laws = law_fields(links)
    pretension = np.array([link.pretension for link in links])
    start = np.where(laws["line"] > 0, line, joint[:, 2])
    stretch = np.where(laws["ka"] > 0.0, pretension / np.where(laws["ka"] > 0.0, laws["ka"], 1.0), 0.0)
    own = {
        **{name: laws[name] for name in ("ka", "fa", "ua", "gap")},
        "h": start,
        "l0": start - stretch,
        "on": np.ones(len(links)),
        "ft": pretension,
        "sx": joint[:, 0],
        "sy": joint[:, 1],
        "px": joint[:, 0],
        "py": joint[:, 1],
        "when": np.full(len(links), -1),
        "whole": np.array([hold_of(column, link) for link in links]),
    }
    return own | {f"{end}{c}": ends[e][:, i] for e, end in enumerate("ab") for i, c in enumerate("xyz")}


def placed(
    column: Column, start: Start, drum: np.ndarray, lane: int
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray], float]:
    """Fields of drums and joints of a column that stands tilted and turns as one rigid body, and what it rests on.

    The friction of the base's contact, and the normal force [N] that comes back with the fields, are those that carry the
    rigid body rolling from there: nothing rings at the start.

    Parameters
    ----------
    column : Column
    start : Start
    drum : array
        Records of the column upright and at rest.
    lane : int
    """
    h = np.array([math.cos(start.azimuth), math.sin(start.azimuth), 0.0])
    turn = rotation(np.cross([0.0, 0.0, 1.0], h), start.tilt)
    omega = np.array(start.angular_velocity)
    centroids = np.stack([drum[c][1:, lane] for c in "xyz"], axis=-1)
    centroids[:, 2] += -drum["fz"][1, lane] - drum["z"][1, lane]  # the base's joint as yet open
    radius = float(drum["rb"][1, lane])
    rim, low = (radius * h, None) if column.section == "circular" else _lowest_corners(drum, lane, h)
    arms = (centroids - rim) @ turn.T
    mass, axial = drum["m"][1:, lane], turn[:, 2]
    transverse = 1.0 / drum["ia"][1:, lane]
    difference = 1.0 / (drum["ic"][1:, lane] + drum["ia"][1:, lane]) - transverse
    first = turn[:, 0]
    other = 1.0 / (drum["ib"][1:, lane] + drum["ia"][1:, lane]) - transverse
    momentum = np.outer(transverse, omega) + np.outer(difference * (axial @ omega), axial)
    momentum = momentum + np.outer(other * (first @ omega), first)
    # the column as one body, rolling
    whole = mass @ arms / mass.sum()
    spread = arms - whole
    own = float(transverse.sum()) * np.eye(3) + float(difference.sum()) * np.outer(axial, axial)
    own = own + float(other.sum()) * np.outer(first, first)
    inertia = own + sum(m * (r @ r * np.eye(3) - np.outer(r, r)) for m, r in zip(mass, spread, strict=True))
    force = _rolling_force(float(mass.sum()), inertia, -whole, axial, omega, column.gravity, rolls=low is None)
    places = rim + arms
    velocities = np.cross(omega, arms)
    fields = {}
    for c, name in enumerate("xyz"):
        fields[name] = np.concatenate(([0.0], places[:, c]))
        fields["v" + name] = np.concatenate(([0.0], velocities[:, c]))
        fields["l" + name] = np.concatenate(([0.0], momentum[:, c]))
        fields["w" + name] = np.concatenate(([0.0], np.full(column.n, omega[c])))
        for a, axis in enumerate("ijk"):
            fields[axis + name] = np.concatenate(([float(a == c)], np.full(column.n, turn[c, a])))
    for name in "xyz":  # the base stays where it is
        fields[name][0] = drum[name][0, lane]
    shear = np.zeros((column.n, 3 if low is None else 3 * len(CORNERS)))
    for corner in (0,) if low is None else low:
        shear[0, 3 * corner : 3 * corner + 2] = force[:2] / (1 if low is None else len(low))
    return fields, {"s": shear}, max(float(force[2]), 0.0)


def _lowest_corners(drum: np.ndarray, lane: int, h: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Middle of the corners that stay down when the lowest drum leans towards h [m], and their numbers: one or two."""
    corners = np.stack([drum[name][1, :, lane] for name in ("px", "py", "pz")], axis=-1)
    far = corners @ h
    low = np.flatnonzero(far > far.max() - 1e-9 * np.abs(corners).max())
    return corners[low].mean(axis=0), low


def _rolling_force(
    mass: float,
    inertia: np.ndarray,
    arm: np.ndarray,
    axis: np.ndarray,
    omega: np.ndarray,
    gravity: float,
    rolls: bool,
) -> np.ndarray:
    """Force of the ground on a body that rolls, or turns about a corner, without slipping [N], shape (3,).

    ``arm`` goes from the centroid to the contact [m]. The contact of a round body stays lowest, so that ``arm`` turns with
    the direction of lean, not with the body: v + ω × r = 0 at all times gives a = −ω̇ × r − ω × (Ω × r). A corner turns
    with the body.
    """
    up = np.array([0.0, 0.0, 1.0])
    sine2 = axis[0] ** 2 + axis[1] ** 2
    frame = np.zeros(3) if rolls else omega
    if rolls and sine2 > 0.0:
        change = np.cross(omega, axis)  # of the axis
        frame = np.cross(axis, change) + axis * axis[2] * (axis[0] * change[1] - axis[1] * change[0]) / sine2
    centripetal = np.cross(omega, np.cross(frame, arm))

    def moment(turning: np.ndarray) -> np.ndarray:
        return inertia @ turning + mass * np.cross(arm, np.cross(turning, arm))

    matrix = np.stack([moment(column) for column in np.eye(3)], axis=1)
    given = np.cross(arm, mass * (gravity * up - centripetal)) - np.cross(omega, inertia @ omega)
    turning = np.linalg.solve(matrix, given)
    return mass * (gravity * up - np.cross(turning, arm) - centripetal)


#: Rest of a joint's force and moment over its load and its load's lever; from where on Newton's steps are taken whole, and
#: for how many rounds whatever comes of it; rounds to get there.
ALLOWED, NEAR, WHOLE, ROUNDS = 1e-6, 1e-3, 30, 60

#: Steps of the differences in place of derivatives, over the closure: from flat, where the strips of a bed are still to
#: take their direction, and later.
DIFFERENCES = 0.1, 1e-4

#: Friction that asks a corner for its pressure [N].
PROBE = 1e30


def face_corners(drum: Drum, as_found: FoundDrum) -> np.ndarray:
    """Corners of a rectangular drum's lower face, less its chips, from the middle of the whole face [m], shape (4, 2)."""
    corners = CORNERS * (0.5 * drum.bottom_width, 0.5 * drum.depth)
    left, right, front, back = as_found.chips
    return corners - np.where(CORNERS > 0.0, (right, back), (-left, -front))


def found_fields(column: Column, at: SpaceGeometry) -> dict[str, np.ndarray]:
    """Fields of the drums of a column as found, the base first: axes, centroids, lower faces in the drums' axes."""
    fields = {}
    for c, name in enumerate("xyz"):
        fields[name] = np.concatenate(([0.0], at.centroid[:, c]))
        fields["n" + name] = np.concatenate(([float(c == 2)], at.bed[:, c, 2]))
        for a, axis in enumerate("ijk"):
            fields[axis + name] = np.concatenate(([float(a == c)], at.axes[:, c, a]))
    if column.section != "circular":
        corners = np.array([face_corners(drum, column.as_found.of(i)) for i, drum in enumerate(column.drums, 1)])
        for c, name in enumerate(("px", "py", "pz")):
            values = np.einsum("nb,nkb->nk", at.bed[:, c, :2], corners)
            fields[name] = np.concatenate((np.zeros((1, len(CORNERS))), values))
    return fields


def found_start(
    column: Column, kernel: Any, types: dict[str, np.dtype], fields: tuple[dict[str, Any], ...], closure: np.ndarray
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Fields of the drums, and friction held by the joints, in equilibrium under gravity.

    Each joint has three unknowns, its closure and two rotations, that the law of contact itself must balance with the
    weight above: Newton's method for all joints at once, with differences in lanes. Shear is what statics asks for.

    Parameters
    ----------
    column : Column
    kernel : module
        Of the law of contact.
    types : dict of dtype
        Of its records.
    fields : tuple of dict
        Fields of drums, joints and lane of the column as built.
    closure : array
        Of each joint under the weight above, if it were centred [m], shape (n,).

    Raises
    ------
    InputError
        A joint cannot carry its load.
    """
    contact = _Contact(column, kernel, types, fields)
    half = contact.half
    unknowns = _Unknowns.closed(closure)
    scale = closure[:, None] / np.stack((np.ones(column.n), half, half), axis=1)
    friction = _Friction.of_statics(column)
    start_fields: tuple[dict[str, np.ndarray], dict[str, np.ndarray]] | None = None
    residual = np.inf
    for count in range(ROUNDS):
        step = DIFFERENCES[count > 0] * scale
        poses = [space_geometry(column, unknowns.now + step * (np.arange(3) == c - 1)) for c in range(4)]
        forces, stored = contact.ask(poses, friction)
        loads = [space_load(column, poses[0], j) for j in range(column.n)]
        missing, size, slid, twisting = contact.unbalanced(forces[0], loads)
        pressing = np.array([load.normal for load in loads])
        worst = max(float((np.abs(excess).T / pressing).max()) for excess in (slid, twisting / half))
        worst = max(worst, float(size.max()))
        if worst > 0.5 * residual:  # no better than rounding lets it be
            break
        if worst < ALLOWED:
            places = {name: contact.drum[name][..., 0].copy() for name in found_fields(column, poses[0])}
            start_fields, residual = (places, {"s": stored, "t": friction.turning.copy()}), worst
        friction.take(size < NEAR, slid, twisting)
        unknowns.go_on(size, missing, forces, step, halved=count >= WHOLE)
    if start_fields is None:
        raise InputError(
            f"joint {int(np.argmax(unknowns.rest)) + 1} of {column.name!r} as found carries its load at the very edge; "
            "make its offset or tilt, or base_tilt, smaller."
        )
    return start_fields


@dataclass
class _Friction:
    """Friction in every joint: shear in space [N], shape (n, 3), torsion moment [N m], each corner's share."""

    shear: np.ndarray
    turning: np.ndarray
    bears: np.ndarray

    @classmethod
    def of_statics(cls, column: Column) -> _Friction:
        """The shear that statics asks for, evenly on the corners."""
        at, n = space_geometry(column), column.n
        shear = np.array([(*(-space_load(column, at, j).shear), 0.0) for j in range(n)])
        return cls(shear, np.zeros(n), np.full((n, len(CORNERS)), 1.0 / len(CORNERS)))

    def take(self, near: np.ndarray, slid: np.ndarray, twisting: np.ndarray) -> None:
        """Take over what the joints near equilibrium lack."""
        self.shear[near, :2] -= slid[near]
        self.turning[near] -= twisting[near]  # of pressure on two rims that lean to one another


@dataclass
class _Unknowns:
    """Closure [m] and two rotations of every joint: now, at their best, and on the way from there; each of shape (n, 3)."""

    now: np.ndarray
    best: np.ndarray
    moves: np.ndarray
    rest: np.ndarray
    share: np.ndarray

    @classmethod
    def closed(cls, closure: np.ndarray) -> _Unknowns:
        """All joints closed evenly."""
        now = np.zeros((len(closure), 3))
        now[:, 0] = -closure
        return cls(now, now.copy(), np.zeros_like(now), np.full(len(now), np.inf), np.ones(len(now)))

    def go_on(
        self, size: np.ndarray, missing: np.ndarray, forces: np.ndarray, step: np.ndarray, *, halved: bool = False
    ) -> None:
        """Newton's step of every joint that has come nearer; half of the last one from its best place for the others.

        Where steps are ``halved``, those near the solution are: at a kink of the law of contact whole ones lead to and fro
        over it for ever.
        """
        for j in range(len(self.now)):
            if size[j] <= self.rest[j] or size[j] < NEAR:
                slopes = (forces[1:, j, :3] - forces[0, j, :3]).T / step[j]
                self.share[j] = 0.5 if halved and size[j] < NEAR else 1.0
                self.rest[j], self.best[j] = size[j], self.now[j]
                self.moves[j] = -np.linalg.lstsq(slopes, missing[j], rcond=None)[0]
            else:
                self.share[j] *= 0.5
            self.now[j] = self.best[j] + self.share[j] * self.moves[j]


class _Contact:
    """The law of contact with the column's drums in lanes: as they stand, and with each unknown of the joints changed."""

    def __init__(
        self, column: Column, kernel: Any, types: dict[str, np.dtype], fields: tuple[dict[str, Any], ...]
    ) -> None:
        n = column.n
        self.column, self.cornered = column, column.section != "circular"
        self.records = records = Records(kernel, types, replace(Topology.of(column), links=()), n)
        self.drum, self.joint, lane = records.body, records.joint, records.lane
        for array, values in zip((self.drum, self.joint, lane), fields, strict=True):
            for name, value in values.items():
                array[name][...] = np.asarray(value)[..., None]
        lane["damp"] = lane["dt"] = 0.0
        self.half = np.array([0.5 * drum.bottom_width for drum in column.drums])
        self.pivots = not self.cornered and float(lane["pivot"][0, 0]) > 0.0

    def ask(self, poses: list[SpaceGeometry], friction: _Friction) -> tuple[np.ndarray, np.ndarray]:
        """Forces in the joints in their own frames at every pose: normal force, moments and shear, shape (poses, n, 6); and
        the shear as the kernel stores it. Notes what each corner bears."""
        column, at, n = self.column, poses[0], self.column.n
        for k, pose in enumerate(poses + [at] * (len(CORNERS) if self.cornered else 0)):
            for name, values in found_fields(column, pose).items():
                self.drum[name][..., k] = values
        lower = np.concatenate((np.eye(3)[None], at.axes[:-1]))
        own = np.einsum("nba,nbc,nc->na", lower, at.frame, friction.shear)
        state = self.records.now()
        memory = state[JOINT]
        stored = (friction.bears[:, :, None] * own[:, None, :]).reshape(n, -1) if self.cornered else own
        memory["s"][..., :4] = stored[..., None]
        memory["t"][:] = friction.turning[:, None]
        for p in range(len(CORNERS) if self.cornered else 0):  # in lanes of their own: what each corner bears
            memory["mu"][:, 4 + p], memory["co"][:, 4 + p] = 1.0, 0.0
            memory["s"][:, 3 * p, 4 + p] = PROBE
        load = self.records.load
        self.records.kernel.forces(state)
        forces = np.empty((len(poses), n, 6))
        for k, pose in enumerate(poses):
            force = load["f"][:n, :, k]
            moment = load["up"][:n, :, k] + np.cross(pose.centroid - pose.origin, force)
            force, moment = (np.einsum("nba,nb->na", pose.frame, vectors) for vectors in (force, moment))
            forces[k] = np.column_stack((force[:, 2], moment, force[:, :2]))
        if self.cornered:
            each = np.einsum("nb,nbp->np", lower[:n, :, 0], load["f"][:n, :, 4 : 4 + len(CORNERS)])
            each = np.maximum(each, 0.0)
            friction.bears = each / np.maximum(each.sum(axis=1, keepdims=True), 1e-300)
        return forces, stored

    def unbalanced(
        self, forces: np.ndarray, loads: list[SpaceLoad]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Normal force and moments that a joint holds too much, shape (n, 3), their size over the load and its lever; shear
        [N], shape (n, 2), and torsion moment [N m] too much."""
        pressing = np.array([load.normal for load in loads])
        weights = np.array(
            [(-load.normal, -load.place[1] * load.normal, load.place[0] * load.normal) for load in loads]
        )
        missing = forces[:, :3] + weights
        levers = np.stack((np.ones(len(loads)), self.half, self.half), axis=1)
        size = np.linalg.norm(missing / (pressing[:, None] * levers), axis=1)
        about = [load.place[0] * load.shear[1] - load.place[1] * load.shear[0] for load in loads]
        slid = forces[:, 4:] + np.array([load.shear for load in loads])
        return missing, size, slid, (forces[:, 3] + about) * self.pivots


@lru_cache(maxsize=4096)
def found_numbers(column: Column) -> tuple[np.ndarray, np.ndarray, float]:
    """Numbers of a column as found for the law, see ``kernels/dem3d/standing.py``: of its drums; the direction against
    gravity [-], and mass times height of all drums as they were found [kg m]."""
    from ...kernels.dem3d.standing import FOUND_DRUM_TYPE

    at, up, drums = space_geometry(column), upward(column), column.drums
    numbers: Any = np.zeros(column.n, FOUND_DRUM_TYPE)
    numbers["lean"] = at.bed.transpose(0, 2, 1)
    below = np.concatenate(([0.0], at.turned[:-1]))  # offsets as found are in axes that do not turn with the drums
    c, s = np.cos(below), np.sin(below)
    numbers["x"], numbers["y"] = c * at.offset[:, 0] + s * at.offset[:, 1], c * at.offset[:, 1] - s * at.offset[:, 0]
    numbers["low"], numbers["high"] = np.transpose([(drum.centroid_height, drum.height) for drum in drums])
    half, deep = (np.array([0.5 * getattr(drum, name) for drum in drums]) for name in ("bottom_width", "depth"))
    left, right, front, back = np.transpose([column.as_found.of(i + 1).chips for i in range(column.n)])
    if column.section == "circular":
        cut = left + right > 0.0
        numbers["left"], numbers["right"] = (np.where(cut, half - chip, math.inf) for chip in (left, right))
        numbers["front"] = numbers["back"] = math.inf
    else:
        numbers["left"], numbers["right"], numbers["front"], numbers["back"] = (
            half - left,
            half - right,
            deep - front,
            deep - back,
        )
    numbers["towards"] = [column.as_found.of(i + 1).chip_azimuth * DEGREE for i in range(column.n)]
    return numbers, up, float(column.masses @ at.centroid @ up)


def numbers_for(column: Column, toes: np.ndarray) -> np.ndarray:
    """Numbers of a column for the law, see ``kernels/dem3d/standing.py``.

    ``toes`` is what each joint, and what all others give with the part above it on its edge
    (:mod:`stylobate.models.shared.toes`) [J], shape (2, n).
    """
    from ...kernels.dem3d.standing import STAND_TYPE

    stand: Any = np.zeros(column.n, STAND_TYPE)
    drums, below = column.drums, column.drums[:-1]
    stand["m"], stand["rough"], stand["over"] = column.masses, column.friction, column.parts_above[1]
    stand["edge"], (stand["toe"], stand["others"]) = 0.5 * column.joint_widths, toes
    stand["along"], stand["across"] = np.transpose([(0.5 * drum.bottom_width, 0.5 * drum.depth) for drum in drums])
    stand["under"] = [math.inf, *(0.5 * drum.top_width for drum in below)]
    stand["beside"] = [math.inf, *(0.5 * drum.upper_depth for drum in below)]
    return stand
