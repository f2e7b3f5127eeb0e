"""A block of lanes of bodies in the plane: the engine's records, the way of a run into them, and what they tell."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ...kernels.run_codes import CHUNK, RUNNING
from ...kernels.shared.records import STATE
from ...motion import Motion
from ..drums.bodies import Topology
from ..shared.ground import along_base
from ..shared.lanes import aligned_zeros, in_rows, with_copies
from .packing import Packed


class Law(NamedTuple):
    """The law of the joints of a block.

    Parameters
    ----------
    types : dict of str to dtype
        Of its records by their names, see ``kernels/plane/records.py``.
    advance, gather, ledger : callable
        Kernels: see ``kernels/plane/step.py``.
    """

    types: dict[str, np.dtype]
    advance: Callable[..., None]
    gather: Callable[..., None]
    ledger: Callable[..., None]


class Records:
    """Records of bodies of one topology in lanes, as the engine takes them.

    Parameters
    ----------
    law : Law
    topology : Topology
    spare : int
        Contacts that a search may add.
    """

    def __init__(self, law: Law, topology: Topology, spare: int = 0) -> None:
        from ...kernels.plane import step

        self.law, self.topology, self.step = law, topology, step
        self.lanes = int(law.types["body"]["x"].shape[0])
        contacts = len(topology.joints) + len(topology.links)
        rows = {
            "body": topology.bodies, "joint": len(topology.joints), "load": contacts + spare + 1,
            "link": len(topology.links), "bond": len(topology.links), "lane": 1, "ground": CHUNK + 1, "feed": 1, "watch": 1,
            "hold": topology.stack if topology.links else 0, "pair": contacts + spare, "span": topology.bodies,
            "touch": 2 * (contacts + spare),
        }  # fmt: skip
        arrays = (
            aligned_zeros(rows[name], law.types[name]) if rows[name] else np.zeros(0, law.types[name])
            for name in STATE[:-1]
        )
        self.state: tuple[Any, ...] = (*arrays, topology.stack)
        (self.body, self.joint, self.load, self.link, self.bond, self.lane, self.ground, self.feed, self.watch, self.hold,
         self.pair, self.span, self.touch, _) = self.state  # fmt: skip
        for k, (lower, upper) in enumerate((*topology.joints, *topology.links)):
            self.pair[k] = lower, upper
        self.span["fixed"][list(topology.fixed)] = 1
        self.contacts = contacts
        self.forget_pairs()

    def forget_pairs(self) -> None:
        """Let the bodies have the contacts of joints and links alone, whatever a search has found."""
        from ...kernels.shared.contacts import list_contacts

        list_contacts(self.pair, self.contacts, len(self.load) - 1, self.span, self.touch)

    def fill(self, lane: int, /, **records: Mapping[str, Any]) -> None:
        """Write fields of some records into a lane."""
        for record, fields in records.items():
            array = getattr(self, record)
            for name, values in fields.items():
                array[name][..., lane] = values

    def put(self, lane: int, packed: Packed) -> None:
        """Write the numbers of a run into a lane: of all records that differ from lane to lane."""
        for name, values in packed.lane.items():
            if len(values):
                in_rows(getattr(self, name), self.lanes)[:, lane] = in_rows(values, 1)[:, 0]
        self.bond[...] = packed.bond

    def forces(self, lane: int) -> tuple[np.ndarray, ...]:
        """Force along x and z [N] and moment [N m] on every body in its present position, on a copy; shapes (N,)."""
        state = self.now()
        state[STATE.index("lane")]["dt"][0, lane] = 0.0
        self.law.gather(state)
        body = state[STATE.index("body")]
        return tuple(body[name][:, lane] for name in ("fx", "fz", "mo"))

    def now(self) -> tuple[Any, ...]:
        """A state of copies of all records that a look at the forces changes."""
        return with_copies(self.state)

    def energies(self, lane: int, dt: float, ground: tuple[float, float]) -> np.ndarray:
        """Ledger of a lane now: input, kinetic, gravitational, elastic, friction, viscous; the middle two absolute [J]."""
        state = self.now()  # the forces at the present positions, as the next step will find them
        state[STATE.index("lane")]["dt"][0, lane] = dt
        self.law.gather(state)
        out = np.empty(6)
        self.law.ledger(state, ground[0], ground[1], dt, lane, out)
        return out

    def joint_state(self, lane: int) -> tuple[np.ndarray, np.ndarray]:
        """Opening of every joint, and where the body above it is along it [m], each of shape (joints,)."""
        opening, slip = np.empty(len(self.joint)), np.empty(len(self.joint))
        self.step.joint_state(self.state, lane, opening, slip)
        return opening, slip

    def acceleration(self, lane: int) -> float:
        """Largest acceleration of a body in its present position without input; of its edge, where it turns [m/s²]."""
        fx, fz, mo = self.forces(lane)
        free = self.span["fixed"] == 0
        ax = (fx * self.body["im"][:, lane] - self.lane["gx"][0, lane])[free]
        az = (fz * self.body["im"][:, lane] - self.lane["g"][0, lane])[free]
        edge = np.zeros(len(self.body))
        np.maximum.at(edge, self.pair["upper"][: len(self.joint)].astype(int), self.edges(lane))
        turn = (mo * self.body["ii"][:, lane] * edge)[free]
        return float(np.abs(np.concatenate((ax, az, turn))).max())

    def edges(self, lane: int) -> np.ndarray:
        """How far the ends of every joint's upper face are from the centroid's foot on it, at most [m], shape (joints,)."""
        return np.maximum(self.joint["bl"][:, lane], self.joint["br"][:, lane])


def feed_motion(records: Records, lane: int, motion: Motion, dt: float, slope: float) -> None:
    """Let a lane's base move with a motion, taken along a slope [rad], in steps of dt [s]."""
    feed, watch = records.feed[0], records.watch[0]
    x, z = motion.samples, motion.z_samples
    feed["x"][lane] = x.ctypes.data
    feed["z"][lane] = 0 if z is None else z.ctypes.data
    feed["last"][lane] = len(x) - 1
    feed["ratio"][lane] = dt / motion.dt
    feed["factor"][lane] = motion.factor
    feed["bc"][lane], feed["bs"][lane] = math.cos(slope), math.sin(slope)
    peak_z = 0.0 if z is None else float(np.abs(z).max()) * abs(motion.factor)
    watch["amax"][lane] = motion.pga * math.cos(slope) + peak_z * abs(math.sin(slope))
    watch["vmax"][lane] = motion.pga * abs(math.sin(slope)) + peak_z * math.cos(slope)


def clear_watch(records: Records, lane: int, follow: bool) -> None:
    """Let a lane be looked at from the start: nothing has happened."""
    watch = records.watch[0]
    in_rows(records.watch, records.lanes)[:, lane] = 0
    watch["status"][lane] = RUNNING
    watch["follow"][lane] = follow
    watch["when"][lane] = watch["which"][lane] = watch["wide"][lane] = -1


def base_acceleration(records: Records, lane: int, motion: Motion, time: float) -> tuple[float, float]:
    """Acceleration of the base along and normal to it at a time [m/s²]."""
    return along_base(motion, time, float(records.feed["bc"][0, lane]), float(records.feed["bs"][0, lane]))
