"""Structures in the records of lanes, in the plane and in space alike: contacts, bodies, joints, a packed run."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from ...column.joint import Joint
from ...column.structure import Structure
from ...kernels.run_codes import CHUNK, RUNNING
from ...kernels.shared.records import LANE, STATE
from ...motion import Motion
from ..shared.lanes import aligned_zeros, in_rows, with_copies
from .links import acting


@dataclass(frozen=True)
class Topology:
    """Which contacts there are, the same in all lanes of a block.

    Parameters
    ----------
    bodies : int
    joints : tuple of (int, int)
        Lower and upper body of each joint.
    links : tuple of (int, int)
        The same of each link.
    fixed : tuple of int
        Bodies that move with the ground.
    stack : int
        Drums of the column that is looked at, bodies 1 … stack on joints 0 … stack − 1; 0 for none.
    which : tuple
        What else tells whose runs can share a block: the links themselves.
    """

    bodies: int
    joints: tuple[tuple[int, int], ...]
    links: tuple[tuple[int, int], ...] = ()
    fixed: tuple[int, ...] = (0,)
    stack: int = 0
    which: tuple[Any, ...] = ()

    @classmethod
    @lru_cache(maxsize=4096)
    def of(cls, structure: Structure) -> Topology:
        """Of all bodies of a structure, on its joints and on those of its links that act."""
        joints = tuple((pair.lower, pair.upper) for pair in structure.face_pairs)
        links = tuple((link.lower, link.upper) for link in acting(structure))
        fixed = tuple(i for i, body in enumerate(structure.bodies) if body.fixed)
        stack = 0 if structure.stack is None else structure.stack.n
        return cls(len(structure.bodies), joints, links, fixed, stack, structure.links if links else ())


def body_fields(structure: Structure, closure: np.ndarray | None = None) -> dict[str, np.ndarray]:
    """Fields of the bodies as they stand, at rest; each joint of a stack closed by ``closure`` [m], shape (n,)."""
    bodies = structure.bodies
    x, z, lean, m, i = np.array([(*body.place, body.lean, body.mass, body.inertia) for body in bodies]).T
    if closure is not None:
        z[1:] -= np.cumsum(closure)
    free = np.array([not body.fixed for body in bodies])
    m, i = np.where(free, m, 0.0), np.where(free, i, 0.0)
    im, ii = (np.divide(1.0, values, out=np.zeros(len(bodies)), where=free) for values in (m, i))
    at_rest = {name: np.zeros(len(bodies)) for name in ("th", "vx", "vz", "w")}
    return at_rest | {
        "x": x, "z": z, "c": np.cos(lean), "s": np.sin(lean), "m": m, "i": i, "im": im, "ii": ii
    }  # fmt: skip


def joint_stiffnesses(structure: Structure, block_modulus: float | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Normal and shear stiffness per area of each joint [N/m³]; with a column's stone in series if its modulus is given.

    1/k_n′ = 1/k_n + h/2E of the drum above + h/2E of the drum below (the base is rigid); k_s keeps its ratio to k_n.
    Eq. (D2).
    """
    laws = [pair.law for pair in structure.face_pairs]
    kn, ks = (np.array([getattr(law, name) for law in laws]) for name in ("normal_stiffness", "shear_stiffness"))
    return with_stone(structure, kn, ks, block_modulus)


def with_stone(
    structure: Structure, kn: np.ndarray, ks: np.ndarray, block_modulus: float | None
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffnesses per area [N/m³] with the stone of each drum and of the next below in series, along the last axis."""
    if block_modulus is None:
        return kn, ks
    half = 0.5 * structure.must_be("column").heights / block_modulus
    soft = 1.0 / (1.0 / kn + half + np.concatenate(([0.0], half[:-1])))
    return soft, ks * soft / kn


def bed_laws(structure: Structure, block_modulus: float | None = None) -> np.ndarray:
    """k_n, k_s [N/m³] and tan φ of the bed between any two bodies, shape (N, N, 3); the pair's lower number first.

    As soft as the joints where their springs have the stone of a column in series.
    """
    laws = np.empty((len(structure.bodies), len(structure.bodies), 3))

    def numbers(law: Joint) -> tuple[float, float, float]:
        return law.normal_stiffness, law.shear_stiffness, law.tan_phi

    for i, law in enumerate(structure.surfaces):
        laws[:, i] = numbers(law)
    for i, h, law in structure.laws_of_pairs:
        laws[i, h] = numbers(law)
    if block_modulus is not None:
        laws[:, 1:, 0], laws[:, 1:, 1] = with_stone(structure, laws[:, 1:, 0], laws[:, 1:, 1], block_modulus)
    return laws


def contact_points(section: str, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Places (−1 … 1) and shares of the area of a joint's contact points.

    Gauss–Lobatto's rule for the chord of the section: weight 1 for a rectangle, √(1 − ξ²) for a circle. Its inner points
    are the roots of the Jacobi polynomial for the weight times 1 − ξ²; the ends take what is left.
    """
    if points == 2:
        return np.array([-1.0, 1.0]), np.array([0.5, 0.5])
    from scipy.special import roots_jacobi

    power, total = (1.5, math.pi / 2.0) if section == "circular" else (1.0, 2.0)
    inner, weight = roots_jacobi(points - 2, power, power)
    inner = 0.5 * (inner - inner[::-1])
    weight = 0.5 * (weight + weight[::-1]) / (1.0 - inner**2)
    end = 0.5 * (total - weight.sum())
    return np.concatenate(([-1.0], inner, [1.0])), np.concatenate(([end], weight, [end])) / total


def damping_rows(damped: bool, stiffness_damping: float, mass_damping: float) -> np.ndarray:
    """Rows of a lane's ``damp``, without local damping; one row of nothing where nothing is damped."""
    return np.array([stiffness_damping, mass_damping, 0.0]) if damped else np.zeros(1)


#: Records of which every lane has its own numbers from the start: what moves, and how it is moved and watched.
MOVING = ("body", "joint", "lane", "link")
OF_A_LANE = (*MOVING, "feed", "watch")

#: State of a lane at the start: nothing has happened.
UNSEEN = {"status": RUNNING, "when": -1, "which": -1, "wide": -1}


@dataclass(frozen=True)
class Packed:
    """One run's lane of the records that differ from lane to lane, before it begins, and what its verdict needs.

    Parameters
    ----------
    lane : array
        All numbers of a lane, see :meth:`LaneRecords.taken`.
    bond : array
        Records of what links are in all lanes.
    step : float
        Time step [s].
    widths : array
        Widths that openings and slips are measured by [m], shape (n,).
    barrier : float
        Lowest energy that overturns it [J].
    stand : array
        For the verdict: of a column in the plane what joints give (``models/shared/toes.py``) [J], shape (2, n), in
        space its numbers in ``kernels/dem3d/standing.py``; of a body least heights by tilt [m].
    axes : array, optional
        Axes that histories tell, in those of the records; of a body, shape (3, 3).
    """

    lane: np.ndarray
    bond: np.ndarray
    step: float
    widths: np.ndarray
    barrier: float
    stand: np.ndarray
    axes: np.ndarray | None = None


class LaneRecords:
    """Records of bodies of one topology in lanes.

    Parameters
    ----------
    types : mapping of str to dtype
        Of the records by their names in ``kernels/shared/records.py``.
    topology : Topology
    joints : int
        Rows of the records of joints: as many as there are, or those of a body's vertices.
    spare : int
        Contacts that a search may add.

    Attributes
    ----------
    kernel : module
        Of the engine.
    axes_of_base : int
        Along which its acceleration is told: along and normal to it in the plane, three in space.
    numbers : array
        All numbers of lanes as bits, shape (fields, lanes): those of what moves first.
    moving : int
        How many of the fields are of what moves.
    rows : dict of str to array
        The same by their records.
    """

    kernel: Any
    axes_of_base: int

    def __init__(self, types: Mapping[str, np.dtype], topology: Topology, joints: int, spare: int = 0) -> None:
        self.topology, self.lanes = topology, int(types["body"]["x"].shape[0])
        contacts, links = (*topology.joints, *topology.links), len(topology.links)
        room = len(contacts) + spare
        rows = {
            "body": topology.bodies, "joint": joints, "load": room + 1, "link": links, "bond": links, "ground": CHUNK + 1,
            "hold": topology.stack if links else 0, "pair": room, "span": topology.bodies, "touch": 2 * room,
        }  # fmt: skip
        sizes = [types[name].itemsize * rows.get(name, 1) for name in OF_A_LANE]
        whole = aligned_zeros(sum(sizes), np.dtype(np.uint8))
        parts = dict(zip(OF_A_LANE, np.split(whole, np.cumsum(sizes)[:-1]), strict=True))
        self.numbers = whole.view(np.int64).reshape(-1, self.lanes)
        self.moving = sum(sizes[: len(MOVING)]) // (8 * self.lanes)

        def records(name: str) -> np.ndarray:
            if not (count := rows.get(name, 1)):
                return np.zeros(0, types[name])
            return parts[name].view(types[name]) if name in parts else aligned_zeros(count, types[name])

        arrays = (records(name) for name in STATE[:-1])
        self.state: tuple[Any, ...] = (*arrays, topology.stack)
        (self.body, self.joint, self.load, self.link, self.bond, self.lane, self.ground, self.feed, self.watch, self.hold,
         self.pair, self.span, self.touch, _) = self.state  # fmt: skip
        self.rows = {name: in_rows(getattr(self, name), self.lanes) for name in OF_A_LANE}
        for k, (lower, upper) in enumerate(contacts):
            self.pair[k] = lower, upper
        self.span["fixed"][list(topology.fixed)] = 1
        self.contacts = len(contacts)
        self.forget_pairs()

    def forget_pairs(self) -> None:
        """Let the bodies have the contacts of joints and links alone, whatever a search has found."""
        from ...kernels.shared.records import list_contacts

        list_contacts(
            self.pair, self.contacts, len(self.load) - 1, self.span, self.touch
        )  # the last load is of nothing

    def fill(self, lane: int, /, **records: Mapping[str, Any]) -> None:
        """Write fields of some records into a lane."""
        for record, fields in records.items():
            array = getattr(self, record)
            for name, values in fields.items():
                array[name][..., lane] = values

    def taken(self, lane: int) -> np.ndarray:
        """All numbers of a lane, for :meth:`put`."""
        return self.numbers[:, lane].copy()

    def put(self, lane: int, numbers: np.ndarray) -> None:
        """Write all numbers of a lane."""
        self.numbers[:, lane] = numbers

    def feed_motion(self, lane: int, motion: Motion, dt: float) -> None:
        """Let a lane's base move with a motion, in steps of dt [s]."""
        feed = self.feed[0]
        for name, samples in (("x", motion.samples), ("y", motion.y_samples), ("z", motion.z_samples)):
            if samples is not None and name in (self.feed.dtype.names or ()):
                feed[name][lane] = samples.ctypes.data
        feed["last"][lane] = motion.steps - 1
        feed["ratio"][lane], feed["factor"][lane] = dt / motion.dt, motion.factor

    def energies(
        self, lanes: Sequence[int], dt: np.ndarray, bases: np.ndarray, state: tuple[Any, ...] | None = None
    ) -> np.ndarray:
        """Ledgers of lanes now: input, kinetic, gravitational, elastic, friction, viscous; the middle two absolute [J].

        With the forces at the present positions, as the next step will find them, shape (lanes, 6).

        Parameters
        ----------
        lanes : sequence of int
        dt : array
            Time steps of all lanes [s].
        bases : array
            Acceleration of the base of each of these lanes [m/s²], shape (lanes, axes).
        state : tuple, optional
            What is looked at, and changed, in place of a copy of these records.
        """
        state, which, out = (
            self.now() if state is None else state,
            np.array(lanes, dtype=np.int64),
            np.empty((len(lanes), 6)),
        )
        state[LANE]["dt"][0, which] = dt[which]
        self.kernel.gather(state)
        self.ledgers(state, which, dt[which], bases, out)
        return out

    def ledgers(
        self, state: tuple[Any, ...], lanes: np.ndarray, dt: np.ndarray, bases: np.ndarray, out: np.ndarray
    ) -> None:
        """Write the ledgers of lanes of a state whose forces are those of its positions; ``dt`` is that of each of them."""
        raise NotImplementedError

    def bases(self, lanes: Sequence[int], places: np.ndarray) -> np.ndarray:
        """Acceleration of the bases of lanes in their own axes [m/s²], shape (lanes, axes).

        ``places`` are those in their records, in samples from the first one, shape (lanes,).
        """
        out = np.empty((len(lanes), self.axes_of_base))
        self.kernel.bases(self.feed, np.array(lanes, dtype=np.int64), places, out)
        return out

    def acceleration(self, lane: int) -> float:
        """Largest acceleration of a body in its present position without input; of its edge, where it turns [m/s²]."""
        raise NotImplementedError

    def now(self, *others: str) -> tuple[Any, ...]:
        """A state of copies of all records that a look at the forces changes, and of some others."""
        return with_copies(self.state, *others)


def sink(height: np.ndarray, lane: int, force: float, carried: Callable[[], float]) -> None:
    """Lower a whole column in a lane until the base, which now carries ``carried()``, carries a force [N].

    ``height`` is that of its bodies [m], the base first.
    """
    z = height[1:, lane].copy()

    def carried_at(depth: float) -> float:
        height[1:, lane] = z - depth
        return carried()

    low, high = 0.0, 1e-12
    while carried_at(high) < force:
        high *= 2.0
    while high - low > 1e-15 and carried_at(0.5 * (low + high)) != force:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if carried_at(middle) < force else (low, middle)
    carried_at(high)
