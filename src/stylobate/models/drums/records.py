"""Records of bodies in lanes, as the engines in the plane and in space take them: arrays, contacts, numbers of a lane."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...kernels.run_codes import CHUNK, RUNNING
from ...kernels.shared.records import LANE, STATE
from ...motion import Motion
from ..shared.lanes import aligned_zeros, in_rows, with_copies
from .bodies import Topology

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
        from ...kernels.shared.contacts import list_contacts

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
