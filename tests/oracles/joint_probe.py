"""Joints of every law under prescribed displacements: what they resist with, what they store and what they give back.

A rig holds two faces of one law of joints, in as many lanes as its engine has, and calls the engine's own function of
forces. Nothing moves by itself: a path of relative displacements of the upper body is prescribed, slowly, and the force and
moment on it are read. What a joint remembers is never touched from here, so that any law of friction can be tried.

Displacements are three shifts [m] and three turns [rad] of the middle of the upper face, in the axes of the lower one.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import stylobate as st
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.engine import engine_for
from stylobate.models.space import lanes
from stylobate.models.space import loose as assemblies
from stylobate.motion import Motion

#: Time of one step of a path [s]: so slow that dashpots do nothing.
DT = 1e3

#: Stiffness of all joints per area [N/m³], normal and shear, and their friction.
KN, KS, MU = 5e9, 2.5e9, 0.7


def turn(vectors: np.ndarray) -> np.ndarray:
    """Rotation matrices of rotation vectors, shapes (L, 3) and (L, 3, 3)."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    x, y, z = vectors.T
    k = np.zeros((len(vectors), 3, 3))
    k[:, 0, 1], k[:, 0, 2], k[:, 1, 2] = -z, y, -x
    k -= k.swapaxes(1, 2)
    # (1 − cos θ) / θ² without a quotient of nothing by nothing
    return np.eye(3) + np.sinc(angle / np.pi) * k + 0.5 * np.sinc(0.5 * angle / np.pi) ** 2 * k @ k


def small_turn(matrices: np.ndarray) -> np.ndarray:
    """Rotation vectors of small rotations: those of the skew parts, to the third order."""
    skew = 0.5 * (matrices - matrices.swapaxes(1, 2))
    return np.stack((skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]), axis=1)


def arrays_in(state: Any) -> list[np.ndarray]:
    """All arrays of a state."""
    if isinstance(state, np.ndarray):
        return [state]
    return [array for part in state for array in arrays_in(part)] if isinstance(state, tuple) else []


class Rig:
    """Two faces of one law, the lower one at rest.

    Parameters
    ----------
    state : tuple
        Of the engine.
    forces : callable
        Brings the state's forces, and what joints remember, to its positions.
    body, joint : array
        Records, with fields of one number for each lane.
    lower, upper : int
        Bodies; the first one does not move.
    load : callable
        Force on the upper body and its moment about its centroid [N], [N m], each of shape (3, lanes).
    friction : str
        Field of the joint's tan φ.
    half, radius : float
        From the centroid of the upper body down to the middle of its face, and how far that reaches [m].
    """

    def __init__(
        self, state: Any, forces: Callable[[Any], None], body: np.ndarray, joint: np.ndarray, bodies: tuple[int, int],
        load: Callable[[], tuple[np.ndarray, np.ndarray]], friction: str, half: float, radius: float,
    ) -> None:  # fmt: skip
        self.state, self.call, self.body, self.joint, self.load = state, forces, body, joint, load
        self.lower, self.upper = bodies
        self.friction, self.half, self.radius = friction, half, radius
        self.arrays = arrays_in(state)
        self.lanes = np.atleast_1d(body["x"][self.upper]).shape[0]
        self.frame, self.rest = np.stack([np.eye(3)] * self.lanes), self._axes(self.upper)
        self.middle = self._vector("x y z") - half * self.frame[:, :, 2]
        self.set_velocity(np.zeros((self.lanes, 3)), np.zeros((self.lanes, 3)))
        self.began = self.copy()

    def _vector(self, names: str, body: int | None = None) -> np.ndarray:
        which = self.upper if body is None else body
        return np.stack([np.atleast_1d(self.body[name][which]) for name in names.split()], axis=1)

    def _axes(self, body: int) -> np.ndarray:
        return np.stack([self._vector(" ".join(axis + c for c in "xyz"), body) for axis in "ijk"], axis=2)

    def _put(self, names: str, vectors: np.ndarray) -> None:
        for name, values in zip(names.split(), vectors.T, strict=True):
            self.body[name][self.upper] = values

    def set_velocity(self, velocity: np.ndarray, spin: np.ndarray) -> None:
        """Of the upper body."""
        self._put("vx vy vz", velocity)
        self._put("wx wy wz", spin)

    def copy(self) -> list[np.ndarray]:
        """All that the rig is, to come back to."""
        return [array.copy() for array in self.arrays]

    def back(self, kept: list[np.ndarray]) -> None:
        """Come back to what was copied."""
        for array, old in zip(self.arrays, kept, strict=True):
            array[...] = old

    def rub(self, mu: float) -> None:
        """Let friction have this coefficient."""
        self.joint[self.friction] = mu

    def pose(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Middle of the upper face and turn from rest, in space, at displacements of shape (lanes, 6)."""
        whole = self.frame @ turn(q[:, 3:]) @ self.frame.swapaxes(1, 2)
        return self.middle + np.einsum("lij,lj->li", self.frame, q[:, :3]), whole

    def step(self, before: np.ndarray, after: np.ndarray) -> np.ndarray:
        """Go from one displacement to the next; what resists there, in the axes of the lower face, shape (lanes, 6)."""
        (old, was), (new, now) = self.pose(before), self.pose(after)
        arm = self.half * self.frame[:, :, 2]
        place, first = new + np.einsum("lij,lj->li", now, arm), old + np.einsum("lij,lj->li", was, arm)
        axes = now @ self.rest
        self._put("x y z", place)
        for k, axis in enumerate("ijk"):
            self._put(" ".join(axis + c for c in "xyz"), axes[:, :, k])
        self.set_velocity((place - first) / DT, small_turn(now @ was.swapaxes(1, 2)) / DT)
        self.call(self.state)
        force, moment = (vectors.T for vectors in self.load())
        moment = moment + np.cross(place - new, force)
        return np.concatenate([np.einsum("lji,lj->li", self.frame, vectors) for vectors in (force, moment)], axis=1)

    def along(self, path: np.ndarray) -> np.ndarray:
        """What resists along a path, shape (steps, lanes, 6); the first place of the path is where the rig is."""
        loads = [self.step(path[0], path[0])]
        loads += [self.step(a, b) for a, b in itertools.pairwise(path)]
        return np.array(loads)


def work(path: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Work of a joint on the upper body until each place of a path [J], shape (steps, lanes)."""
    middle, way = 0.5 * (path[1:, :, 3:] + path[:-1, :, 3:]), np.diff(path, axis=0)
    mean = 0.5 * (force[1:] + force[:-1])
    # turns as of the vector of rotation: its change is the angular velocity but for half of their cross product
    spin = way[..., 3:] + 0.5 * np.cross(middle, way[..., 3:])
    power = (mean[..., :3] * way[..., :3]).sum(axis=-1) + (mean[..., 3:] * spin).sum(axis=-1)
    return np.concatenate((np.zeros((1, power.shape[1])), np.cumsum(power, axis=0)))


# -- rigs of all laws ------------------------------------------------------------------------------------------------


def joint_of(**changes: Any) -> st.Joint:
    """The joint of all rigs."""
    return st.Joint(KN, KS, friction_coefficient=MU, **changes)


def of_column(column: st.Column, **options: Any) -> Rig:
    """The joint of the second drum of a column in ``dem3d``, of one drum that on the base; sixteen lanes."""
    model = DistinctElement3D(**options)
    block = engine_for(model, column).block(RunOptions(until_end=True))
    for lane in range(block.lanes):
        block.load(lane, Case(column, Motion(1.0, np.zeros(2))))
    records, n = block.records, column.n
    records.lane["dt"][:] = DT

    def load() -> tuple[np.ndarray, np.ndarray]:
        return records.load["f"][n - 1], records.load["up"][n - 1]

    drum = column.drums[n - 1]
    return Rig(
        records.state, records.kernel.forces, records.body, records.joint, (n - 1, n), load, "mu",
        drum.centroid_height, 0.5 * drum.bottom_width,
    )  # fmt: skip


def drums(count: int, section: str = "circular", **joint: Any) -> st.Column:
    """A column 0.5 m wide at its joints."""
    return st.Column.tapered(
        height=0.8 * count, bottom_width=0.5, top_width=0.46, drums=count, density=2500.0, joint=joint_of(**joint),
        section=section,
    )  # fmt: skip


def chipped(count: int) -> st.Column:
    """The same with a segment broken off the upper drum's foot."""
    drum = st.FoundDrum(count, chip_right=0.06, chip_azimuth=50.0)
    return drums(count).replace(as_found=st.AsFound((drum,)))


def stones(kind: str) -> st.SpatialAssembly:
    """Two stones on one another, by the shapes of their faces."""
    low, high = kind.split(" on ")[::-1]

    def hexagon(width: float, z: float, name: str) -> st.Stone:
        around = 0.5 * width * np.array([(math.cos(a), math.sin(a)) for a in np.arange(6) * math.pi / 3.0 + 0.2])
        return st.Stone.hull([(x, y, z + h) for x, y in around for h in (0.0, 0.6)], 2500.0, name=name)

    make = {
        "box": lambda w, z, name: st.Stone.box((w, 0.8 * w, 0.6), (0.0, 0.0, z), 2500.0, name=name),
        "drum": lambda w, z, name: st.Stone.drum(w, w, 0.6, (0.0, 0.0, z), 2500.0, name=name),
        "hexagon": hexagon,
    }
    upper = make[high](0.5, 0.0 if low == "ground" else 0.6, "high")
    lower = () if low == "ground" else (make[low](0.6 if low != high else 0.5, 0.0, "low"),)
    return st.SpatialAssembly((*lower, upper), joint_of(), name=kind)


def of_assembly(assembly: st.SpatialAssembly) -> Rig:
    """The last joint of an assembly in the engine that finds contacts: one lane."""
    engine = assemblies.lane_as_drawn(assembly, engine_for(DistinctElement3D(), assembly).acting)
    engine.now["last"] = engine.now["dt"] = DT
    upper = len(engine.body) - 1
    middle = engine.joint["mu"][-1]

    def load() -> tuple[np.ndarray, np.ndarray]:
        return engine.body["f"][upper].reshape(3, -1), engine.body["mo"][upper].reshape(3, -1)

    return Rig(
        engine.state, engine.kernel.forces, engine.body, engine.joint[-1:], (upper - 1, upper), load, "tan",
        float(np.linalg.norm(middle)), 0.25,
    )  # fmt: skip


def of_bed(assembly: st.SpatialAssembly) -> Rig:
    """The same two stones on an elastic bed: as after their joint has parted for good."""
    rig = of_assembly(assembly)
    joint, law = rig.state[8], rig.state[10]
    joint["live"] = 0
    rig.state[11]["skin"] = 1.0
    assemblies_list(rig.state)
    rig.began = rig.copy()

    def rub(mu: float) -> None:
        law[..., 2] = mu

    rig.rub = rub  # type: ignore[method-assign]
    return rig


def of_vertices() -> Rig:
    """A specimen on its vertices, six below and six above; sixteen lanes."""
    around = np.arange(6) * math.pi / 3.0 + 0.2
    corners = np.array([(0.25 * math.cos(a), 0.25 * math.sin(a), z) for a in around for z in (-0.4, 0.4)])
    stone = st.Specimen(400.0, np.diag([30.0, 30.0, 15.0]), corners, "hexagon", joint_of())
    model = DistinctElement3D()
    block = engine_for(model, stone).block(RunOptions(until_end=True))
    for lane in range(block.lanes):
        block.load(lane, Case(stone, Motion(1.0, np.zeros(2))))
    records = block.records
    records.lane["dt"][:] = DT
    near = records.lane["near"][0]
    records.lane["count"][:] = 6
    for n in range(6):  # those at rest come first
        near[n // near.shape[1], n % near.shape[1]] = n

    def load() -> tuple[np.ndarray, np.ndarray]:
        return records.load["f"][0], records.load["up"][0]

    rig = Rig(records.state, records.kernel.forces, records.body, records.joint, (0, 1), load, "mu", 0.4, 0.25)

    def rub(mu: float) -> None:
        records.lane["mu"][:] = mu

    rig.rub = rub  # type: ignore[method-assign]
    return rig


def assemblies_list(state: Any) -> None:
    """List the pairs of shapes that may touch."""
    from stylobate.kernels.space import step

    step.list_all(state)


def of_lanes(assembly: st.SpatialAssembly, beta: float = 0.0) -> Rig:
    """The last joint of an assembly in lanes of assemblies that stand."""
    model = DistinctElement3D(stiffness_damping=beta)
    block = lanes.IntactLanes(model, RunOptions())
    for lane in range(block.lanes):
        block.load(lane, Case(assembly, Motion(1.0, np.zeros(2))))
    block.lane["last"][:] = block.lane["dt"][:] = DT
    upper = len(block.body) - 1

    def load() -> tuple[np.ndarray, np.ndarray]:
        return block.body["f"][upper], block.body["mo"][upper]

    middle = block.joint["mu"][-1][:, 0]
    return Rig(
        block.state, block.kernel.forces, block.body, block.joint[-1:], (upper - 1, upper), load, "tan",
        float(np.linalg.norm(middle)), 0.25,
    )  # fmt: skip


#: Laws by name.
LAWS: dict[str, Callable[[], Rig]] = {
    "dem3d rim, on the base": lambda: of_column(drums(1)),
    "dem3d rim, drum on drum": lambda: of_column(drums(2)),
    "dem3d rim, damped": lambda: of_column(drums(2), stiffness_damping=1e-4),
    "dem3d bed": lambda: of_column(drums(2), law="bed"),
    "dem3d ring": lambda: of_column(drums(2, ring_width=0.08)),
    "dem3d chipped rim": lambda: of_column(chipped(2)),
    "dem3d corners": lambda: of_column(drums(2, "rectangular")),
    "dem3d vertices": of_vertices,
    "space joint, box on ground": lambda: of_assembly(stones("box on ground")),
    "space joint, box on box": lambda: of_assembly(stones("box on box")),
    "space joint, drum on drum": lambda: of_assembly(stones("drum on drum")),
    "space joint, drum on box": lambda: of_assembly(stones("drum on box")),
    "space joint, hexagon on box": lambda: of_assembly(stones("hexagon on box")),
    "space lanes, box on box": lambda: of_lanes(stones("box on box")),
    "space lanes, drum on drum": lambda: of_lanes(stones("drum on drum")),
    "space lanes, drum on box": lambda: of_lanes(stones("drum on box")),
    "space lanes, hexagon on box": lambda: of_lanes(stones("hexagon on box")),
    "space lanes, damped": lambda: of_lanes(stones("box on box"), 1e-4),
    "space bed, box on ground": lambda: of_bed(stones("box on ground")),
    "space bed, drum on box": lambda: of_bed(stones("drum on box")),
}


# -- what is measured -------------------------------------------------------------------------------------------------


def loaded(rig: Rig, rng: np.random.Generator, lean: float = 0.8) -> np.ndarray:
    """Bring a rig to random loaded poses, closed all over: pressed, leaning, sheared, twisted; the displacement there.

    ``lean`` is the largest tilt, over the one at which the face begins to open.
    """
    rig.back(rig.began)
    shape = (rig.lanes,)
    depth = rng.uniform(4e-6, 3e-5, shape)
    about, share = rng.uniform(0.0, 2.0 * math.pi, shape), lean * np.sqrt(rng.uniform(0.0, 1.0, shape))
    tilt = share * depth / rig.radius
    # shear and torsion to a share of their limits together; the middle of pressure is off by as much as a half of ρ
    way, mixed = rng.uniform(0.0, 2.0 * math.pi, shape), rng.uniform(-0.5 * math.pi, 0.5 * math.pi, shape)
    size = rng.uniform(0.1, 0.6, shape) * (1.0 - 0.4 * share)
    slide, spin = size * np.cos(mixed) * MU * depth * KN / KS, size * np.sin(mixed) * MU * depth * KN / KS / rig.radius
    end = np.stack(
        (slide * np.cos(way), slide * np.sin(way), -depth, tilt * np.cos(about), tilt * np.sin(about), spin), axis=1
    )
    # pressed first, then leaned, then sheared
    order = np.array([[0, 0, 1, 0, 0, 0], [0, 0, 1, 1, 1, 0], [1, 1, 1, 1, 1, 1]], dtype=float)
    knots = np.concatenate((np.zeros((1, rig.lanes, 6)), order[:, None] * end))
    rig.along(straight(knots, 20))
    return end


def straight(knots: np.ndarray, steps: int) -> np.ndarray:
    """A path through some places, straight between them."""
    parts = [a + (b - a) * np.arange(1, steps + 1)[:, None, None] / steps for a, b in itertools.pairwise(knots)]
    return np.concatenate((knots[:1], *parts))


def tangent(rig: Rig, at: np.ndarray, size: float = 1e-8) -> np.ndarray:
    """Stiffness against displacements, turns taken times the radius, by differences from where a rig is, (lanes, 6, 6)."""
    kept, stiffness = rig.copy(), np.empty((rig.lanes, 6, 6))
    scale = np.array([1.0, 1.0, 1.0, *[rig.radius] * 3])
    for k in range(6):
        ends = []
        for sign in (-1.0, 1.0):
            rig.back(kept)
            there = at.copy()
            there[:, k] += sign * size / scale[k]
            ends.append(rig.step(at, there))
        stiffness[:, :, k] = (ends[0] - ends[1]) / (2.0 * size)
    rig.back(kept)
    # a moment that stays as it is in space has an antisymmetric part of its own in angles: half of its cross product
    moment = rig.step(at, at)[:, 3:]
    rig.back(kept)
    x, y, z = moment.T / 2.0 / rig.radius
    cross = np.zeros((rig.lanes, 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -z, y, -x
    cross -= cross.swapaxes(1, 2)
    stiffness[:, 3:, 3:] -= cross
    return stiffness / scale[:, None]


def loops(
    rig: Rig, at: np.ndarray, rng: np.random.Generator, size: float, turns: int = 3, steps: int = 400
) -> np.ndarray:
    """A random closed loop of turns of so much [rad], and of shifts as large times the radius, from where rigs are."""
    planes = np.linalg.qr(rng.normal(size=(rig.lanes, 6, 2)))[0] * np.array([rig.radius] * 3 + [1.0] * 3)[:, None]
    angle = np.linspace(0.0, 2.0 * math.pi * turns, steps * turns + 1)[:, None, None]
    return at + size * (planes[:, :, 0] * np.sin(angle) + planes[:, :, 1] * (1.0 - np.cos(angle)))


class Measured(NamedTuple):
    """Of random loaded poses, of each lane, and which lanes nowhere slipped.

    Parameters
    ----------
    askew, bare : array
        Antisymmetric part of the stiffness of friction over the symmetric part of all; that of pressure alone.
    turns : array
        Work of friction round each turn of a small loop over what shear stored, shape (turns, lanes).
    stuck : array of bool
    """

    askew: np.ndarray
    bare: np.ndarray
    turns: np.ndarray
    stuck: np.ndarray


def measured(rig: Rig, seed: int, size: float = 1e-6, turns: int = 3, steps: int = 400) -> Measured:
    """Stiffness of joints, and their work round small loops, at random loaded poses; without friction, and with any."""
    stiffness, force, path, began = {}, {}, np.empty(0), rig.began
    for mu in (MU, 1e9, 0.0):
        drawn = np.random.default_rng(seed)
        rig.back(began)
        rig.rub(mu)
        rig.began = rig.copy()
        at = loaded(rig, drawn)
        stiffness[mu] = tangent(rig, at)
        path = loops(rig, at, drawn, size, turns, steps)
        force[mu] = rig.along(path)
        rig.began = began
    rig.back(began)
    shear = force[MU][0] - force[0.0][0]
    area = math.pi * rig.radius**2
    stored = 0.5 * ((shear[:, :2] ** 2).sum(axis=1) + (shear[:, 5] / rig.radius) ** 2) / (KS * area)
    done = work(path, force[MU] - force[0.0])[steps::steps] / stored
    stuck = np.abs(force[MU] - force[1e9]).max(axis=(0, 2)) < 1e-9 * np.abs(force[MU][0]).max(axis=1)
    rubbing, whole = stiffness[MU] - stiffness[0.0], np.linalg.norm(both(stiffness[MU], 1.0), axis=(1, 2))
    return Measured(
        np.linalg.norm(both(rubbing, -1.0), axis=(1, 2)) / whole,
        np.linalg.norm(both(stiffness[0.0], -1.0), axis=(1, 2)) / whole,
        np.diff(done, axis=0, prepend=0.0), stuck,
    )  # fmt: skip


def tipped(rig: Rig, degrees: float, seed: int, size: float = 1e-7, turns: int = 3, steps: int = 200) -> np.ndarray:
    """Work of friction of each turn of a small loop over what its shear stored, of a box that is tipped over an edge so far.

    Where a joint hands over to the bed under an edge its share falls with the tilt; shape (turns,).
    """
    rig.state[11]["skin"] = 1.0
    assemblies_list(rig.state)
    began, angle, force, path = rig.copy(), np.linspace(0.0, math.radians(degrees), 300)[:, None], {}, np.empty(0)
    for mu in (MU, 0.0):
        drawn = np.random.default_rng(seed)
        rig.back(began)
        rig.rub(mu)
        rig.state[10][..., 2] = mu
        over = np.zeros((300, 1, 6))
        over[:, :, 0], over[:, :, 4] = rig.radius * (1.0 - np.cos(angle)), angle
        over[:, :, 2] = rig.radius * np.sin(angle) - 2e-5
        rig.along(over)
        end = over[-1:] + np.array([1.0, 2.0, 0.0, 0.0, 0.0, 2.0]) * drawn.uniform(5e-7, 1.5e-6)
        rig.along(straight(np.concatenate((over[-1:], end)), 40))
        path = loops(rig, end[0], drawn, size, turns, steps)
        force[mu] = rig.along(path)
    rig.state[10][..., 2] = MU
    rig.back(began)
    shear = force[MU][0] - force[0.0][0]
    stored = 0.5 * ((shear[:, :2] ** 2).sum() + (shear[:, 5] / rig.radius) ** 2).sum() / (KS * math.pi * rig.radius**2)
    return np.diff(work(path, force[MU] - force[0.0])[steps::steps, 0], prepend=0.0) / stored


def both(stiffness: np.ndarray, sign: float) -> np.ndarray:
    """Stiffness and its transpose, added or subtracted."""
    return stiffness + sign * stiffness.swapaxes(1, 2)


def given_back(rig: Rig, seed: int, legs: int = 12, steps: int = 150) -> np.ndarray:
    """Most that friction gave back, all counted from the start, over what it took, on random paths: faces open, close, slide
    and spin; shape (lanes,)."""
    drawn, began = np.random.default_rng(seed), rig.began
    size = (legs, rig.lanes)
    depth = drawn.uniform(-0.5, 2.0, size) * 1e-5
    lean = drawn.normal(0.0, 1.0, (*size, 2)) * 1e-5 / rig.radius
    slide = drawn.normal(0.0, 1.5, (*size, 2)) * MU * 1e-5 * KN / KS
    spin = drawn.normal(0.0, 1.5, size) * MU * 1e-5 * KN / KS / rig.radius
    knots = np.concatenate((slide, -depth[..., None], lean, spin[..., None]), axis=2)
    path = straight(np.concatenate((np.zeros((1, rig.lanes, 6)), knots)), steps)
    force = []
    for mu in (MU, 0.0):
        rig.back(began)
        rig.rub(mu)
        force.append(rig.along(path))
    rig.back(began)
    done = work(path, force[0] - force[1])
    return done.max(axis=0) / np.abs(done).max(axis=0)


def lost_by_rocking(rig: Rig, seed: int, cycles: int = 8, steps: int = 60) -> np.ndarray:
    """Share of its shear that a joint loses from the third to the last time that a part of it opens and closes again, while
    it is displaced by the same all the time; shape (lanes,)."""
    drawn = np.random.default_rng(seed)
    rig.back(rig.began)
    at = loaded(rig, drawn, 0.5)
    wide = at.copy()
    about = drawn.uniform(0.0, 2.0 * math.pi, rig.lanes)
    tilt = drawn.uniform(1.2, 2.0, rig.lanes) * -at[:, 2] / rig.radius  # a sixth to a third of the face opens
    wide[:, 3], wide[:, 4] = tilt * np.cos(about), tilt * np.sin(about)
    wide[:, 2] *= 1.2
    shear = []
    for _ in range(cycles):
        rig.along(straight(np.stack((at, wide, at)), steps))
        shear.append(np.linalg.norm(rig.step(at, at)[:, :2], axis=1))
    rig.back(rig.began)
    return 1.0 - shear[-1] / shear[2]


def all_of(name: str, poses: int, seed: int = 47) -> dict[str, float]:
    """The largest of what is measured of a law, over random poses that nowhere slip."""
    rig = LAWS[name]()
    measurements = [measured(rig, seed + k) for k in range(-(-poses // rig.lanes))]
    stuck = np.concatenate([measurement.stuck for measurement in measurements])
    turns = np.abs(np.concatenate([measurement.turns for measurement in measurements], axis=1))[:, stuck]
    return {
        "askew": float(np.concatenate([measurement.askew for measurement in measurements])[stuck].max()),
        "pressure askew": float(np.concatenate([measurement.bare for measurement in measurements])[stuck].max()),
        "first turn": float(turns[0].max()), "third turn": float(turns[2].max()),
        "given back": float(max(given_back(rig, seed + k).max() for k in range(len(measurements)))),
        "lost by rocking": float(np.concatenate([lost_by_rocking(rig, seed + k) for k in range(len(measurements))]).max()),
        "stuck": int(stuck.sum()), "of": len(stuck),
    }  # fmt: skip


if __name__ == "__main__":
    import sys

    for law in LAWS:
        if not sys.argv[1:] or any(word in law for word in sys.argv[1:]):
            print(law, {key: float(f"{value:.2g}") for key, value in all_of(law, 16).items()}, flush=True)
