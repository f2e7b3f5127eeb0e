"""Structures in the numbers of the engine in the plane: laws, links, beds, bodies at rest, starts as found, the verdict."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache, lru_cache, partial
from typing import Any

import numpy as np

from ...column import Column
from ...column.block import smallest_turn
from ...column.found_geometry import Geometry, geometry, gravity_vector, joint_load
from ...column.links.placed import PlacedLink
from ...column.structure import Structure
from ...constants import DEGREE
from ...errors import InputError
from ...kernels.shared.records import NO_LINK, OWN, link_types
from ..drums.links import LinkStiffness, acting, bonds, hold_of, law_fields, link_matrices
from ..drums.records import UNSEEN, LaneRecords, Packed, Topology, contact_points
from ..shared.stable_step import highest_frequency

#: Types of records by their names in ``kernels/shared/records.py``.
Types = Mapping[str, np.dtype]


@cache
def point_law(points: int, damped: bool, lanes: int, linked: bool, turned: bool = False) -> Types:
    """Joints with contact points, so many each; with damping and links or without.

    Parameters
    ----------
    points : int
    damped : bool
    lanes : int
    linked : bool
    turned : bool
        Whether upper faces may be inclined in the axes of their bodies, as those of blocks may.
    """
    from ...kernels.plane import records

    return records.types(records.point_joint(points, damped, lanes, turned), damped, points, lanes, linked)


@cache
def interface_law(crushing: bool, damped: bool, lanes: int, linked: bool) -> Types:
    """Joints that are one interface each; with a compressive strength, damping and links or without."""
    from ...kernels.plane import records

    return records.types(records.interface_joint(crushing, damped, lanes), damped, 1, lanes, linked)


def links_at_rest(structure: Structure, body: Any) -> np.ndarray:
    """Links of a structure whose bodies stand as these records of one lane say: whole, and free of force but for their
    pretension."""
    links = acting(structure)
    if not links:
        return np.zeros(0, NO_LINK)
    records = np.zeros(len(links), link_types(1)[0])
    for name, values in law_fields(links).items():
        if name in OWN.split():
            records[name][:, 0] = values
    x, z, c, s = (body[name][:, 0] for name in ("x", "z", "c", "s"))
    for k, link in zip(records, links, strict=True):
        low, up, (tc, ts) = structure.link_ends(link)
        k["tc"], k["ts"], k["on"], k["when"], k["ft"] = tc, ts, 1.0, -1, link.pretension
        k["whole"] = 0.0 if structure.stack is None else hold_of(structure.stack, link)
        places = []
        for end, i, (px, py, pz) in (("a", link.lower, low), ("b", link.upper, up)):
            k[end + "x"], k[end + "y"], k[end + "z"] = px, py, pz
            places.append((x[i] + c[i] * px - s[i] * pz, py, z[i] + s[i] * px + c[i] * pz))
        start = math.dist(*places)
        if not link.straight:
            i = link.lower
            tc, ts = c[i] * tc - s[i] * ts, s[i] * tc + c[i] * ts
            ax, az = places[1][0] - x[i], places[1][2] - z[i]
            k["sx"] = k["px"] = tc * ax + ts * az
            start = tc * az - ts * ax
        k["h"] = start
        k["l0"] = start - (link.pretension / link.axial_stiffness if link.pretension else 0.0)
    return records


def stiffness_between(structure: Structure, inverse: np.ndarray) -> LinkStiffness:
    """Stiffness of the links against the bodies' masses.

    Parameters
    ----------
    structure : Structure
    inverse : array
        1/m, 1/m and 1/I of every body, 0 where it is held, shape (3N,).
    """
    links, count = acting(structure), len(inverse)
    if not links:
        return LinkStiffness(0.0, 0.0)
    springs, dashpots = link_matrices(links, partial(_row, count), count, 1)
    return LinkStiffness(highest_frequency(springs, inverse), highest_frequency(dashpots, inverse) ** 2)


def _row(count: int, link: PlacedLink, way: np.ndarray) -> np.ndarray:
    """Of the bodies in the plane, two places and a turn each."""
    row, (x, _, z) = np.zeros(count), way
    low, high = link.arms
    for body, arm, sign in ((link.upper, high, 1.0), (link.lower, low, -1.0)):
        row[3 * body : 3 * body + 3] = sign * np.array([x, z, arm[0] * z - arm[2] * x])
    return row


#: Relative rotation from which a joint's faces are a bed like all others [rad].
LAST_ROTATION = math.radians(50.0)


def fill_shapes(records: Any, structure: Structure) -> np.ndarray:
    """Fill records of shapes; returns the corners of all bodies, one after another, each from its place [m]."""
    corners = [body.polygon for body in structure.bodies]
    counts = [len(corner) for corner in corners]
    records["first"], records["count"] = np.cumsum([0, *counts])[:-1], counts
    # a contact with what moves with the ground is as deep as the moving body
    records["depth"] = [1e9 if body.fixed else body.shape.depth for body in structure.bodies]
    records["r"] = [float(np.hypot(corner[:, 0], corner[:, 1]).max()) for corner in corners]
    return np.concatenate(corners)


def fill_hands(records: Any, structure: Structure) -> None:
    """Fill records of how each joint hands over."""
    for h, pair in zip(records, structure.face_pairs, strict=True):
        below, above = (structure.bodies[i].outline for i in (pair.lower, pair.upper))
        # the next faces come down on each other where the joint has turned as far as the outlines do at its ends
        last = min(LAST_ROTATION, 0.9 * smallest_turn(below, pair.sides[0], above, pair.sides[1]))
        h["live"], h["weight"] = 1, 1.0
        h["from_c"], h["to_c"] = math.cos(0.7 * last), math.cos(last)
        h["width"] = min(pair.below.width, pair.above.width)


def pack_column(
    column: Column,
    types: Mapping[str, np.dtype],
    fields: tuple[Mapping[str, Any], Mapping[str, Any], Mapping[str, Any]],
    step: float,
    toes: np.ndarray,
) -> Packed:
    """A column's lane from the fields of its bodies, joints and lane; ``types`` are those of records of one lane."""
    records = LaneRecords(types, Topology.of(column), column.n)
    body, joint, lane = fields
    top = column.upper_faces[-1]
    face = {"th": top.height, "tc": top.direction[0], "ts": top.direction[1]}
    records.fill(0, body=body, joint=joint, lane=lane, watch=UNSEEN | face)
    records.link[...] = links_at_rest(column, records.body)
    return Packed(records.taken(0), bonds(column), step, column.joint_widths, column.lowest_barrier, toes)


#: Fields of a body that a run begins with.
OF_BODY = ("x", "z", "th", "c", "s", "vx", "vz", "w", "m", "i", "im", "ii")


def face_fields(structure: Structure, *, turned: bool = False) -> dict[str, np.ndarray]:
    """Fields that say where the faces of the joints are, by rows of shape (joints,); ``turned`` as of their records."""
    pairs = structure.face_pairs
    below, above = (
        np.array([(*face.direction, *face[1:]) for face in faces]).reshape(-1, 5)
        for faces in ([pair.below for pair in pairs], [pair.above for pair in pairs])
    )
    names = ("lc", "ls", "ht", "wl", "wr", "hb", "bl", "br")
    fields = dict(zip(names, (*below.T, *above[:, 2:].T), strict=True))
    return fields | ({"turned": above[:, :2]} if turned else {})


def joint_fields(
    structure: Structure, kn: np.ndarray, ks: np.ndarray, *, turned: bool = False
) -> dict[str, np.ndarray]:
    """Faces and law of joints of contact points, from their normal and shear stiffness per area [N/m³], shape (joints,)."""
    pairs = structure.face_pairs
    area, width = (np.array([getattr(pair, name) for pair in pairs]) for name in ("area", "width"))
    return face_fields(structure, turned=turned) | {
        "kn": kn * area / width,
        "ks": ks * area / width,
        "co": np.array([pair.law.cohesion for pair in pairs]) * area / width,
        "mu": np.array([pair.law.tan_phi for pair in pairs]),
    }


def lane_fields(structure: Structure, damp: np.ndarray, points: int | None = None) -> dict[str, Any]:
    """Fields of a lane at the start of a run; with the contact points of a joint, where it has so many."""
    down = gravity_vector(structure)
    xi, share = (0.0, 0.0) if points is None else contact_points(structure.section or "rectangular", points)
    return {"g": float(-down[1]), "gx": float(-down[0]), "damp": damp, "xi": xi, "sh": share}


#: Rounds of loads from positions and positions from loads; the elastic closures move the loads by 1e-5 of themselves.
ROUNDS = 4


def found_start(
    column: Column, stiffness: np.ndarray, xi: np.ndarray, share: np.ndarray
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Positions of the drums, and shear forces in the joints, in equilibrium under gravity.

    Parameters
    ----------
    column : Column
    stiffness : array
        Normal stiffness of each joint per length of its overlap [N/m²], shape (n,).
    xi, share : array
        Places (−1 … 1) and shares of the contact points of a joint, shapes (points,).

    Returns
    -------
    drum : dict of str to array
        Fields of the drums of the kernel that differ from those of a column as built, the base first, shapes (n + 1,).
    shear : array
        Shear force of every contact point [N], shape (n, points).
    """
    as_built = geometry(column)
    at, turned = as_built, np.zeros(column.n)
    gaps, shear = np.zeros((column.n, 2)), np.zeros((column.n, len(xi)))
    for _ in range(ROUNDS):
        for j in range(column.n):
            load = joint_load(column, at, j)
            length = float(as_built.high[j] - as_built.low[j])
            places = as_built.low[j] + 0.5 * length * (1.0 + xi)
            gaps[j], force = _closure(stiffness[j] * length * share, places, load.normal, load.place)
            shear[j] = -load.shear * force / load.normal
        at, turned = _settled(column, as_built, gaps)
    angle = at.lean + turned
    drum = {
        "x": (0.0, at.centroid[:, 0]),
        "z": (0.0, at.centroid[:, 1]),
        "c": (1.0, np.cos(angle)),
        "s": (0.0, np.sin(angle)),
    }
    return {name: np.concatenate(([base], values)) for name, (base, values) in drum.items()}, shear


def _closure(spring: np.ndarray, place: np.ndarray, load: float, at: float) -> tuple[np.ndarray, np.ndarray]:
    """Gaps at the first and the last contact point [m], and forces of all [N], that carry a load at a place.

    No-tension springs under a rigid face: two equations, linear as long as the same points bear; Newton's method.
    """
    reach = place - at
    line = np.array([load / spring.sum(), 0.0])  # closure at the load, and its slope along the joint
    for _ in range(100):
        closure = line[0] + line[1] * reach
        force = np.where(closure > 0.0, spring * closure, 0.0)
        rest = np.array([force.sum() - load, force @ reach])
        if abs(rest[0]) + abs(rest[1]) / np.ptp(reach) < 1e-12 * load:
            return -(line[0] + line[1] * reach[[0, -1]]), force
        bearing = np.where(closure > 0.0, spring, 0.0)
        moments = [float(bearing @ reach**power) for power in range(3)]
        if moments[0] * moments[2] - moments[1] ** 2 <= 0.0:  # one point bears: let all of them, half as much
            line = 0.5 * line + 0.5 * np.array([load / spring.sum(), 0.0])
            continue
        line = line - np.linalg.solve([[moments[0], moments[1]], [moments[1], moments[2]]], rest)
    raise InputError(
        "a joint of the column as found carries its load at the very edge; make its offset or tilt smaller."
    )


def _settled(column: Column, as_built: Geometry, gaps: np.ndarray) -> tuple[Geometry, np.ndarray]:
    """The column with its joints closed by these gaps at the ends of their contacts; rotation in each joint [rad]."""
    lean, origins, centroids = np.empty(column.n), np.empty((column.n, 2)), np.empty((column.n, 2))
    rotation = np.arctan2(gaps[:, 1] - gaps[:, 0], as_built.high - as_built.low)
    origin, angle = np.zeros(2), 0.0
    for i, drum in enumerate(column.drums):
        offset = column.as_found.of(i + 1).offset
        along = np.array([math.cos(angle), math.sin(angle)])
        gap = gaps[i, 0] + (offset - as_built.low[i]) * math.tan(rotation[i])
        lean[i], origins[i] = angle, origin
        middle = origin + offset * along + gap * np.array([-along[1], along[0]])
        angle += rotation[i] + as_built.tilt[i]
        up = np.array([-math.sin(angle), math.cos(angle)])
        centroids[i] = middle + drum.centroid_height * up
        origin = middle + drum.height * up
    return as_built._replace(lean=lean, origin=origins, centroid=centroids), rotation


@lru_cache(maxsize=4096)
def numbers_for(column: Column) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of the drums for the law, put down flat as found, but for what joints give; their offsets as found [m]."""
    from ...kernels.plane.standing import STAND_TYPE, put_down

    found_drums = [column.as_found.of(i + 1) for i in range(column.n)]
    bottom = np.array([0.5 * drum.bottom_width for drum in column.drums])
    stand: Any = np.zeros(column.n, STAND_TYPE)
    stand["m"], stand["h"], stand["rough"] = column.masses, column.heights, column.friction
    stand["hc"] = [drum.centroid_height for drum in column.drums]
    stand["tilt"] = [drum.tilt * DEGREE for drum in found_drums]
    stand["left"] = bottom - [drum.chip_left for drum in found_drums]
    stand["right"] = bottom - [drum.chip_right for drum in found_drums]
    stand["under"] = [math.inf, *(0.5 * drum.top_width for drum in column.drums[:-1])]
    stand["edge"] = 0.5 * column.joint_widths
    offsets = np.array([drum.offset for drum in found_drums])
    put_down(stand, offsets)
    return stand, offsets
