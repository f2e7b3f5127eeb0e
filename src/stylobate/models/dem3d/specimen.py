"""A specimen on the base as the kernels want it: principal axes, vertices, where it lies, stable step, verdict."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from ...column import Column
from ...column.found_geometry import rotation
from ...column.specimen import Specimen
from ...errors import InputError
from ...response import Collapse
from ...response.poses import rotation_matrices
from ..base import RunOptions
from ..drums.impact import in_lanes, undamped
from ..drums.records import UNSEEN, Packed, damping_rows
from ..engine import engine_for
from ..shared.stable_step import highest_frequency
from ..start import Toss
from .packing import Records

#: Largest turn of one step [rad], and most steps.
LARGEST, STEPS = 0.01, 400

#: Force that is left, as a share of the weight.
RESIDUAL_FORCE = 1e-10


def potential(
    vertices: np.ndarray, turn: np.ndarray, height: float, spring: float, weight: float
) -> tuple[float, np.ndarray, np.ndarray]:
    """Potential energy [J], and its first and second derivatives by height and two small rotations about x and y.

    Parameters
    ----------
    vertices : array
        From the centroid, in the axes of the body [m], shape (m, 3).
    turn : array
        From those axes to those of space, shape (3, 3).
    height : float
        Of the centroid over the base [m].
    spring : float
        Stiffness of a vertex [N/m].
    weight : float
        [N]
    """
    arms = vertices @ turn.T
    depth = np.maximum(-(height + arms[:, 2]), 0.0)
    rows = np.stack((np.ones(len(arms)), arms[:, 1], -arms[:, 0]), axis=1)  # rise of a vertex per height, θx, θy
    touching = rows[depth > 0.0]
    curvature = spring * touching.T @ touching
    sinking = spring * float(depth @ arms[:, 2])  # a turn lowers what stands on a vertex
    curvature[1, 1] += sinking
    curvature[2, 2] += sinking
    slope = np.array([weight, 0.0, 0.0]) - spring * depth @ rows
    return 0.5 * spring * float(depth @ depth) + weight * height, slope, curvature


def turned(turn: np.ndarray, step: np.ndarray) -> np.ndarray:
    """A turn followed by the two small rotations of a step."""
    angle = math.hypot(step[1], step[2])
    return rotation(np.array([step[1], step[2], 0.0]) / angle, angle) @ turn if angle > 0.0 else turn


def lying(
    vertices: np.ndarray, turn: np.ndarray, height: float, spring: float, weight: float
) -> tuple[np.ndarray, float]:
    """Turn and height [m] at which the body lies, from those of its resting face; parameters as for :func:`potential`.

    Newton's method down the potential energy: directions in which it bends down are taken as if it bent up, and a step that
    does not go down is halved, so that it ends in a place that is stable.
    """
    size = float(np.linalg.norm(vertices, axis=1).max())
    scale = np.array([1.0, 1.0 / size, 1.0 / size])
    height -= weight / (spring * len(vertices))
    energy, slope, curvature = potential(vertices, turn, height, spring, weight)
    for _ in range(STEPS):
        values, along = np.linalg.eigh(curvature * np.outer(scale, scale))
        values = np.maximum(np.abs(values), 1e-6 * spring)
        step = -scale * (along @ ((along.T @ (slope * scale)) / values))
        step *= min(
            1.0, LARGEST / max(float(np.hypot(step[1], step[2])), 1e-300), LARGEST * size / max(abs(step[0]), 1e-300)
        )
        there, trial = turn, (energy, slope, curvature)
        for _ in range(40):
            there = turned(turn, step)
            trial = potential(vertices, there, height + float(step[0]), spring, weight)
            if trial[0] <= energy:
                break
            step = 0.5 * step
        turn, height = there, height + float(step[0])
        energy, slope, curvature = trial
        if np.abs(slope * scale).max() < RESIDUAL_FORCE * weight:
            break
    return turn, height


#: Vertices of a block's lanes are made up to a multiple of this: specimens of about the same size share a block.
ROUND_UP = 64

#: Share of a body's size within which vertices may strike the base together [-].
TOGETHER = 5e-3

#: Tilt beyond which a body has toppled [rad].
TOPPLED = 0.25 * math.pi


def rows_for(specimen: Specimen) -> int:
    """Rows of vertices that a block for this specimen has."""
    return -(-len(specimen.vertices) // ROUND_UP) * ROUND_UP


def vertex_stiffness(specimen: Specimen) -> tuple[float, float]:
    """Normal and shear stiffness of one vertex [N/m]: those of the resting footprint over its vertices."""
    share = specimen.resting.area / len(specimen.resting.footprint)
    return specimen.joint.normal_stiffness * share, specimen.joint.shear_stiffness * share


def resting_first(specimen: Specimen) -> np.ndarray:
    """Numbers of the vertices in the order of a block's rows: those of the footprint first."""
    foot = specimen.resting.footprint
    return np.concatenate((foot, np.setdiff1d(np.arange(len(specimen.vertices)), foot)))


@lru_cache(maxsize=256)
def principal(specimen: Specimen) -> tuple[np.ndarray, np.ndarray]:
    """Principal moments about body axes i, j, k [kg m²], and those axes as columns in the axes of the vertices.

    The moment that differs most from the other two belongs to k, so that the rotation is nearest to an exact one.
    """
    moments, axes = np.linalg.eigh(specimen.inertia)
    order = [1, 2, 0] if moments[1] - moments[0] > moments[2] - moments[1] else [0, 1, 2]
    moments, axes = moments[order], axes[:, order]
    if np.linalg.det(axes) < 0.0:
        axes[:, 2] = -axes[:, 2]
    return moments, axes


@lru_cache(maxsize=256)
def top_frequency(specimen: Specimen) -> float:
    """Highest angular frequency of the body with all vertices in contact that can strike the base together [rad/s]."""
    from scipy.spatial import ConvexHull

    kn, ks = vertex_stiffness(specimen)
    moments, axes = principal(specimen)
    vertices = specimen.vertices @ axes
    hull: Any = ConvexHull(vertices)
    size = float(np.ptp(vertices, axis=0).max())
    inverse = 1.0 / np.concatenate((np.full(3, specimen.mass), moments))
    highest = 0.0
    for outward in np.unique(np.round(hull.equations, 9), axis=0):
        near = vertices[vertices @ outward[:3] + outward[3] > -TOGETHER * size]
        spring = ks * np.eye(3) + (kn - ks) * np.outer(outward[:3], outward[:3])
        stiffness = np.zeros((6, 6))
        for x, y, z in near:
            skew = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])  # displacement of the vertex per small rotation
            rows = np.hstack((np.eye(3), skew))
            stiffness += rows.T @ spring @ rows
        highest = max(highest, highest_frequency(stiffness, inverse))
    return highest


#: Force that may be left where a body has sunk into its footprint, as a share of its weight.
SUNK = 1e-9


def pack_specimen(records: Records, specimen: Specimen, damping: tuple[float, float], step: float) -> Packed:
    """A specimen at rest as the kernels want it.

    Parameters
    ----------
    records : Records
        Empty ones, whose first lane is filled.
    specimen : Specimen
    damping : tuple of float
        β and α of the model [s], [1/s].
    step : float
        Time step [s].
    """
    rest = specimen.resting
    moments, axes = principal(specimen)
    up = rest.rotation.T[:, 2] @ axes
    vertices = specimen.vertices[resting_first(specimen)] @ axes
    kn, ks = vertex_stiffness(specimen)
    m, rows = len(vertices), len(records.joint)
    corners = {name: np.concatenate((vertices[:, c], np.zeros(rows - m))) for c, name in enumerate("xyz")}
    corners |= {name: np.where(np.arange(rows) < m, value, 0.0) for name, value in (("kn", kn), ("ks", ks))}
    corners["rest"] = np.where(np.arange(rows) < len(rest.footprint), 1.0, 0.0)
    body = {
        "m": specimen.mass,
        "im": 1.0 / specimen.mass,
        "z": rest.height,
        "ia": 1.0 / moments[1],
        "ib": 1.0 / moments[0] - 1.0 / moments[1],
        "ic": 1.0 / moments[2] - 1.0 / moments[1],
        "rb": float(np.linalg.norm(vertices, axis=1).max()),
        "ht": float((vertices @ up).max()),
    } | {"n" + c: up[i] for i, c in enumerate("xyz")}
    lane = {
        "mu": specimen.joint.tan_phi,
        "lost": 1.0 - specimen.restitution**2,
        "g": np.array([0.0, 0.0, specimen.gravity]),
        "damp": damping_rows(True, *damping),
        "free": 1.0,
    }
    records.fill(0, joint=corners, lane=lane, feed={"r": np.eye(3).ravel()})
    records.look_at_all_vertices()
    for name, value in body.items():
        records.body[name][1, 0] = value
    _settle(records, rest.rotation @ axes, specimen)
    bodies = FreeBody()
    for c, place in zip("xyz", bodies.foot(records, 0, specimen), strict=True):  # the base's record keeps how it stood
        for name in (c, *(axis + c for axis in "ijk")):
            records.body[name][0, 0] = place if name == c else records.body[name][1, 0]
    records.fill(0, watch=UNSEEN | dict(zip(("sx", "sy"), bodies.top(records, np.array([0]))[0], strict=True)))
    least = height_barrier(specimen)
    lowest = specimen.mass * specimen.gravity * (least.max() - rest.height)
    width = np.array([math.sqrt(rest.area)])
    return Packed(records.taken(0), records.bond, step, width, max(lowest, 0.0), least, axes.T)


def _turn(records: Records, lane: int, turn: np.ndarray) -> None:
    for a, axis in enumerate("ijk"):
        for c, name in enumerate("xyz"):
            records.body[axis + name][1, lane] = turn[c, a]


def _settle(records: Records, turn: np.ndarray, specimen: Specimen) -> None:
    """Sink and tilt the body until its footprint carries it; where that is not stable, let it lie where it is."""
    kn, weight = vertex_stiffness(specimen)[0], specimen.mass * specimen.gravity
    arms = (specimen.vertices @ specimen.resting.rotation.T)[specimen.resting.footprint]
    rows = np.stack((np.ones(len(arms)), arms[:, 1], -arms[:, 0]), axis=1)  # rise of a vertex per z, θx, θy
    _turn(records, 0, turn)
    sunk_turn = _sunk(records, turn, kn * rows.T @ rows, weight)
    vertices, height = specimen.vertices @ principal(specimen)[1], float(records.body["z"][1, 0])
    if sunk_turn is not None and np.linalg.eigvalsh(potential(vertices, sunk_turn, height, kn, weight)[2])[0] > 0.0:
        return
    turn, height = lying(vertices, turn, specimen.resting.height, kn, weight)
    records.body["z"][1, 0] = height
    _turn(records, 0, turn)
    _sunk(records, turn, potential(vertices, turn, height, kn, weight)[2], weight)


def _sunk(records: Records, turn: np.ndarray, stiffness: np.ndarray, weight: float) -> np.ndarray | None:
    """Newton's method on depth and two small rotations with one stiffness; the turn it ends with, None without end."""
    force = np.full(3, np.inf)
    for _ in range(9):
        carried, moment = records.net(0)
        force = np.array([weight - carried[0, 2], -moment[0, 0], -moment[0, 1]])
        if np.abs(force).max() < 1e-12 * weight:
            break
        step = -np.linalg.lstsq(stiffness, force, rcond=1e-12)[0]
        records.body["z"][1, 0] += step[0]
        turn = turned(turn, step)
        _turn(records, 0, turn)
    return turn if np.abs(force).max() < SUNK * weight else None


class FreeBody:
    """A specimen in the lanes of a block, see :class:`stylobate.models.dem3d.block.Bodies`."""

    def check_start(self, structure: Specimen, start: Any) -> None:
        """Refuse a start that is not one for a specimen."""
        if not isinstance(start, Toss):
            raise InputError(
                f"the specimen {structure.name!r} starts at rest or tossed; give a Toss, or leave start out."
            )

    def take_pose(self, records: Records, lane: int, structure: Specimen, start: Toss) -> None:
        """Put a specimen where it is tossed from, with its velocities."""
        moments, axes = principal(structure)
        turn = rotation_matrices(np.array(start.orientation)) @ axes
        _turn(records, lane, turn)
        body, spin = records.body, np.array(start.angular_velocity)
        momentum = turn @ (moments * (turn.T @ spin))
        for c, name in enumerate("xyz"):
            body[name][1, lane] = start.position[c]
            body["v" + name][1, lane] = start.velocity[c]
            body["w" + name][1, lane] = spin[c]
            body["l" + name][1, lane] = momentum[c]

    def foot(self, records: Records, lane: int, structure: Specimen) -> np.ndarray:
        """Place of the point of the body that was under the centroid at rest [m], shape (3,)."""
        axes, up = records.axes(lane)[0], records.vectors(lane, "nx ny nz")[0]
        return records.places(lane)[0] - structure.resting.height * axes @ up

    def leaning(self, records: Records) -> np.ndarray:
        """Component towards +x of what is upward at rest, in each lane [-]."""
        body = records.body
        return np.sum([body[axis + "x"][1] * body["n" + c][1] for axis, c in zip("ijk", "xyz", strict=True)], axis=0)

    def top(self, records: Records, lanes: np.ndarray) -> np.ndarray:
        """Place in plan of the point that is as high as the highest vertex, above the centroid at rest [m].

        Shape (lanes, 2).
        """
        return np.array([self._top(records, lane) for lane in lanes.tolist()])

    def _top(self, records: Records, lane: int) -> np.ndarray:
        axes, up = records.axes(lane)[0], records.vectors(lane, "nx ny nz")[0]
        return (records.places(lane)[0] + records.body["ht"][1, lane] * axes @ up)[:2]

    def stay(
        self,
        packed: Sequence[Packed],
        records: Records,
        lanes: np.ndarray,
        structures: Sequence[Specimen],
        energy: np.ndarray,
        slip: np.ndarray,
    ) -> np.ndarray:
        """Whether the energy that is left lifts bodies over no ring of tilts between their own and 45°, shape (lanes,)."""
        del slip
        each = zip(packed, lanes.tolist(), structures, energy.tolist(), strict=True)
        return np.array(
            [
                self._stays(packed_body, records, lane, body, remaining_energy)
                for packed_body, lane, body, remaining_energy in each
            ]
        )

    def _stays(self, packed: Packed, records: Records, lane: int, structure: Specimen, energy: float) -> bool:
        least = packed.stand
        up = (records.axes(lane)[0] @ records.vectors(lane, "nx ny nz")[0])[2]
        tilt = math.acos(max(-1.0, min(1.0, float(up))))
        beyond = least[np.linspace(0.0, TOPPLED, len(least)) > tilt]
        rise = structure.mass * structure.gravity * (beyond - structure.resting.height)
        return len(beyond) > 0 and energy < float(rise.max())

    def lost(self, collapse: Collapse, structure: Specimen) -> str:
        """Fallen bodies, in words."""
        return f"toppled, its tilt is beyond {math.degrees(TOPPLED):.0f}°"


@dataclass(frozen=True)
class RockingSpecimen:
    """How single bodies rock on vertices that give back a share: see :data:`stylobate.models.drums.impact.Rocking`.

    Parameters
    ----------
    restitution : float
        Of a vertex [-].
    """

    restitution: float

    def __call__(self, body: Column, model: Any, tilt: float) -> Iterator[np.ndarray]:
        """Leans of a box of the same sides, released at rest on one of its edges."""
        drum, c, s = body.drums[0], math.cos(tilt), math.sin(tilt)
        half = 0.5 * np.array([drum.bottom_width, drum.depth, drum.height])
        corners = half * np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
        inertia = drum.mass / 3.0 * (half @ half - half**2)
        fields = {"joint": body.joint_laws[0], "restitution": self.restitution, "gravity": body.gravity}
        box = Specimen(drum.mass, inertia, corners, body.name, **fields)
        x, _, z = half
        place = x - x * c + z * s, 0.0, x * s + z * c
        start = Toss(place, (math.cos(0.5 * tilt), 0.0, math.sin(0.5 * tilt), 0.0))
        twin = replace(model, **undamped())
        return in_lanes(engine_for(twin, box).block(RunOptions(start=start, until_end=True)), box)


@lru_cache(maxsize=256)
def height_barrier(specimen: Specimen) -> np.ndarray:
    """Least height of the centroid over the base at tilts from 0 to 45°, over all azimuths [m], shape (91,)."""
    vertices = specimen.vertices @ specimen.resting.rotation.T
    azimuth = np.arange(180) * (math.pi / 90.0)
    out = []
    for tilt in np.linspace(0.0, TOPPLED, 91):
        down = np.stack(
            (math.sin(tilt) * np.cos(azimuth), math.sin(tilt) * np.sin(azimuth), np.full(180, -math.cos(tilt))), axis=1
        )
        out.append(float((vertices @ down.T).max(axis=0).min()))
    return np.array(out)
