"""Assemblies followed step by step: blocks fall, strike one another and the ground, and come to rest."""

from __future__ import annotations

import math
import warnings
from typing import Any, NamedTuple

import numpy as np

from ...column.assembly import Assembly
from ...errors import OutOfRangeWarning
from ...kernels.run_codes import CHUNK
from ...motion import Motion
from ..drums.joints import contact_points
from ..drums.links import link_snapshot, with_links
from ..drums.packing import whole_steps
from ..shared.ground import along_base
from ..shared.lanes import longest_piece
from ..shared.settling import LOCAL_DAMPING, settled
from ..shared.stable_step import highest_frequency
from ..shared.stable_step import stable_step as stable
from .links import acting, link_records, link_stiffness
from .packing import bed_laws, fill_body, fill_joint, no_column

#: Below this speed the restitution of a contact acts like a dashpot [m/s].
CALM = 0.02

#: At rest: no corner has moved by this share of the smallest block, for so long [s]. (Not a speed: an undamped joint goes
#: on ringing, by far less than that.)
REST_WAY, REST_TIME = 2.0e-4, 0.5

#: Restitution of a run that waits for rest, where the model gives none; elastic contacts never come to rest.
RESTITUTION_TO_REST = 0.3

#: Time after the motion at which a run that waits for rest is given up [s].
LONGEST_WAIT = 60.0

#: Bodies that enter each other by more than this share of the thinnest block are too soft.
DEEPEST = 0.2

#: Parts of a step while bodies may strike each other: impacts are harder than what joints do.
FINER = 8

#: An assembly is in equilibrium as drawn if its accelerations fall below this [m/s²] within so many steps of local
#: damping, while no corner goes farther than this share of the smallest block.
SETTLED, SETTLE_STEPS, AS_DRAWN = 1e-4, 40_000, 0.01

#: About what a step costs on one core for each body and contact point [s]; of blocks that all stand on one another.
COST, COST_STANDING = 2e-7, 5e-8

#: Skin of the boxes of the contact search, as a share of the smallest block.
SKIN = 0.1


class Contacts(NamedTuple):
    """Numbers of the contacts of an assembly.

    Parameters
    ----------
    points : int
        Contact points of a joint.
    stiffness_damping, mass_damping : float
        [s], [1/s]
    """

    points: int
    stiffness_damping: float
    mass_damping: float


class Engine:
    """An assembly in motion: the kernel's arrays, and the way into and out of them.

    Parameters
    ----------
    assembly : Assembly
    contacts : Contacts
    motion : Motion
    duration : float
        For which the ground moves, and after [s]; the step divides it.
    restitution : float
        Share of the closing speed that contacts of the bed give back: 1 is elastic. Joints have none while the ground
        moves, and in a column that may still stand: what they lose, they lose by sliding.
    """

    def __init__(
        self, assembly: Assembly, contacts: Contacts, motion: Motion, duration: float, restitution: float = 1.0
    ) -> None:
        from ...kernels.assembly import links as ties
        from ...kernels.assembly import step as kernel

        self.kernel, self.ties, self.assembly, self.motion = kernel, ties, assembly, motion
        bodies = assembly.bodies
        types = kernel.types(contacts.points)
        self.body = np.zeros(len(bodies), types[0])
        self.joint = np.zeros(len(assembly.joints), types[1])
        self.now = np.zeros(1, types[2])
        self.corner = np.concatenate([fill_body(self.body[i], block, assembly) for i, block in enumerate(bodies)])
        first = np.cumsum([0] + [len(block.vertices) for block in bodies])
        self.body["first"], self.body["count"] = first[:-1], np.diff(first)
        self.joined = np.full((len(bodies), len(bodies)), -1, dtype=np.int64)
        for j, (lower, upper, low_face, up_face, law) in enumerate(assembly.joints):
            self.joined[lower, upper] = j
            fill_joint(self.joint[j], bodies, self.body, lower, upper, low_face, up_face, law)
        self.links = link_records(assembly, ties)
        self.clearance = np.array([one.clearance for one in acting(assembly)])
        self.begin_links()
        xi, share = contact_points("rectangular", contacts.points)
        now = self.now
        now["xi"], now["sh"] = xi, share
        now["bc"], now["g"], now["beta"], now["alpha"] = (
            1.0,
            assembly.gravity,
            contacts.stiffness_damping,
            contacts.mass_damping,
        )
        e = restitution
        now["eta"], now["calm"] = (1.0 - e * e) / (1.0 + e * e), CALM
        now["touched"], now["finer"] = -1, FINER
        moving = [block for block in bodies if not block.fixed]
        now["skin"] = SKIN * min(block.size for block in moving)
        self.box = np.zeros((len(bodies), 4))
        self.order = np.arange(len(bodies))
        self.pairs = np.zeros((len(bodies) * (len(bodies) - 1) // 2 + 1, 2), dtype=np.int64)
        self.law = bed_laws(assembly)
        self.memory = np.zeros((len(bodies), len(bodies), 3))
        self.real = tuple(np.zeros(kernel.MOST) for _ in range(8))
        self.whole = tuple(np.zeros(kernel.MOST, dtype=np.int64) for _ in range(2))
        self.ground = np.zeros((CHUNK + 1, 2))
        self.stack: tuple[np.ndarray, ...] = no_column()
        self.dt = 0.0
        self.stood_at, self.stood_since = np.full((3, len(bodies)), np.inf), 0.0
        self.duration = duration
        # a body below this level has left the model: it falls without end and does not count as moving
        corners = np.concatenate([block.corners for block in bodies])
        self.lowest_level = float(corners[:, 1].min()) - 2.0 * float(np.ptp(corners, axis=0).max())

    def start(self, step: float) -> None:
        """Set the step and the velocities half a step before the start, of bodies that do not move yet."""
        self.dt, self.chunks = whole_steps(self.motion, self.duration - self.motion.duration, step)
        self.now["dt"] = self.now["last"] = self.dt
        x, z = self.motion.samples, self.motion.z_samples
        self.addresses = np.array([x.ctypes.data, 0 if z is None else z.ctypes.data, len(x) - 1])
        self.renew_pairs()
        self._push()

    def begin_links(self) -> None:
        """Let the links be free of force where the bodies are now, but for their pretension."""
        if len(self.links):
            self.ties.begin(self.body, self.links, self.clearance)

    def renew_pairs(self) -> None:
        """Search anew for pairs that may touch."""
        self.kernel.renew_pairs(self.body, self.corner, self.now, self.box, self.order, self.pairs)

    def may_come_loose(self, time: float) -> bool:
        """Whether bodies that are not joined may touch, or a joint may hand over, within a time [s]."""
        return bool(self.kernel.may_come_loose(self.body, self.corner, self.joint, self.now, self.box, self.order,
                                               self.pairs, self.joined, self.real, time))  # fmt: skip

    def ground_acceleration(self, time: float) -> tuple[float, float]:
        """Acceleration of the base along and normal to it at a time [m/s²]."""
        return along_base(self.motion, time, float(self.now["bc"][0]), float(self.now["bs"][0]))

    def _push(self) -> None:
        """Velocities half a step before the start, of bodies that do not move yet, whatever accelerates them."""
        for name in ("vx", "vz", "w"):
            self.body[name] = 0.0
        forces, free = self.present()[0], self.body["im"] > 0.0
        ax, az = self.ground_acceleration(0.0)
        ax, az = ax + self.now["gx"][0], az + self.now["g"][0]
        self.body["vx"][free] = -0.5 * self.dt * (forces["fx"] * forces["im"] - ax)[free]
        self.body["vz"][free] = -0.5 * self.dt * (forces["fz"] * forces["im"] - az)[free]
        self.body["w"][free] = -0.5 * self.dt * (forces["mo"] * forces["ii"])[free]

    def advance(self, chunks: int) -> None:
        """Advance by some chunks of steps."""
        piece = longest_piece(self.cost, CHUNK)
        for left in range(chunks, 0, -piece):
            self.kernel.advance(
                self.body, self.corner, self.joint, self.now, self.box, self.order, self.pairs, self.joined, self.links,
                self.law, self.memory, self.real, self.whole, self.addresses, self.ground, self.motion.factor,
                self.dt / self.motion.dt, self.stack, min(left, piece),
            )  # fmt: skip

    @property
    def cost(self) -> float:
        """About what a step costs on one core [s]."""
        return COST * len(self.body) * len(self.now["xi"][0])

    @property
    def time(self) -> float:
        """Time of the present state [s]."""
        return float(self.now["step"][0]) * self.dt

    @property
    def failed(self) -> bool:
        """Whether the state is no longer finite."""
        return bool(self.now["failed"][0])

    def at_rest(self) -> bool:
        """Whether nothing has moved for ``REST_TIME``, but what falls for ever; to be asked again and again."""
        b = self.body
        here = np.stack((b["x"], b["z"], b["r"] * b["th"]))
        way = np.abs(here - self.stood_at).sum(axis=0)
        if way[~(b["z"] < self.lowest_level)].max(initial=0.0) > REST_WAY * float(self.now["skin"][0]) / SKIN:
            self.stood_at, self.stood_since = here, self.time
        return self.time - self.stood_since > REST_TIME

    def present(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Bodies, joints, scalars, memory and links with the forces at the present positions, on a copy."""
        body, joint, now, memory = self.body.copy(), self.joint.copy(), self.now.copy(), self.memory.copy()
        links = self.links.copy()
        self.kernel.joint_forces(body, joint, now)
        if len(links):
            self.ties.link_forces(body, links, float(now["last"][0]))
        self.kernel.bed_forces(
            body, self.corner, joint, now, self.pairs, self.joined, self.law, memory, self.real, self.whole
        )
        return body, joint, now, memory, links

    def energies(self) -> np.ndarray:
        """Ledger now: input, kinetic, gravitational, elastic, friction, viscous; the middle three absolute [J]."""
        from ...kernels.assembly.ledger import ledger

        body, joint, now, memory, links = self.present()
        gx, gz = self.ground_acceleration(self.time)
        out = np.empty(6)
        ledger(
            body, self.corner, joint, now, self.pairs, self.joined, links, self.law, memory, self.real, self.whole,
            gx, gz, out,
        )  # fmt: skip
        return out

    def residual_acceleration(self) -> float:
        """Largest acceleration of a body without input; of its farthest corner, where it turns [m/s²]."""
        body = self.present()[0]
        free = body["im"] > 0.0
        b = body[free]
        g, gx = self.now["g"][0], self.now["gx"][0]
        turn = b["mo"] * b["ii"] * b["r"]
        return float(np.abs(np.concatenate((b["fx"] * b["im"] - gx, b["fz"] * b["im"] - g, turn))).max())

    def settle(self) -> bool:
        """Close the contacts by the weight that they carry, with local damping.

        Returns
        -------
        bool
            Whether it rests, about where it was drawn; if not, everything is as it was.
        """
        arrays: tuple[Any, ...] = (self.body, self.joint, self.now, self.memory)
        drawn = [array.copy() for array in arrays]
        self.now["local"] = LOCAL_DAMPING
        still = self.addresses
        self.addresses = np.zeros_like(still)
        rests = settled(
            self._relax, self.residual_acceleration, SETTLED, SETTLE_STEPS // CHUNK,
            lost=lambda: self._farthest_from(drawn[0]) > AS_DRAWN or self.failed,
        )  # fmt: skip
        self.addresses = still
        self.now["local"] = 0.0
        for name in ("work", "shear", "visc", "step"):
            self.now[name] = drawn[2][name]
        if not rests:
            for array, before in zip(arrays, drawn, strict=True):
                array[...] = before
            self.renew_pairs()
            self.begin_links()
        self._push()
        return rests

    def _relax(self, chunks: int) -> None:
        self.advance(chunks)
        self.begin_links()

    def _farthest_from(self, before: np.ndarray) -> float:
        """Way of the farthest corner from other poses, as a share of the smallest block [-]."""
        b = self.body
        way = np.hypot(b["x"] - before["x"], b["z"] - before["z"]) + b["r"] * np.abs(b["th"] - before["th"])
        return float(way.max()) * SKIN / float(self.now["skin"][0])

    def deepest(self) -> float:
        """Depth to which bodies have entered each other, joints aside [m].

        Warns
        -----
        OutOfRangeWarning
            It is no longer small beside the thinnest block.
        """
        depth = float(self.now["deepest"][0])
        thin = min((block.thickness, block.name) for block in self.assembly.bodies if not block.fixed)
        if depth > DEEPEST * thin[0]:
            warnings.warn(
                f"blocks of {self.assembly.name!r} entered each other by {1000.0 * depth:.3g} mm, and {thin[1]!r} is "
                f"{1000.0 * thin[0]:.3g} mm thick; its impacts mean little: raise normal_stiffness.",
                OutOfRangeWarning,
                stacklevel=4,
            )
        return depth

    def pose(self) -> dict[str, Any]:
        """What measures need of the present state; of its ledger the input alone, the first of its terms."""
        b, work = self.body, float(self.now["work"][0])
        energy = np.array([work, *[math.nan] * 5])
        return {"time": self.time, "x": b["x"].copy(), "z": b["z"].copy(), "rotation": b["th"].copy(), "energy": energy}

    def state(self) -> dict[str, Any]:
        """What a history keeps of the present state."""
        held = {"links": link_snapshot(self.links, 0)} if len(self.links) else {}
        return self.pose() | held | {"energy": self.energies()}


def stable_step(engine: Engine) -> float:
    """Largest stable step of the joints as they are closed at the start, and of every block's longest face as a bed [s]."""
    body, now = engine.body, engine.now[0]
    n = len(body)
    stiffness = np.zeros((3 * n, 3 * n))
    for e in engine.joint:
        u, v = body[e["upper"]], body[e["lower"]]
        t = np.array([e["lc"], e["ls"]])
        normal = np.array([-t[1], t[0]])
        foot = np.array([v["x"], v["z"]]) + e["ht"] * normal
        above = float((np.array([u["x"], u["z"]]) - foot) @ t)
        lo, hi = max(-e["wl"], above - e["bl"]), min(e["wr"], above + e["br"])
        for xi, share in zip(now["xi"], now["sh"], strict=True):
            point = foot + (0.5 * (lo + hi) + 0.5 * xi * (hi - lo)) * t
            for along, k in ((normal, e["kn"]), (t, e["ks"])):
                row = np.zeros(3 * n)
                for number, one, sign in ((e["upper"], u, 1.0), (e["lower"], v, -1.0)):
                    arm = point - np.array([one["x"], one["z"]])
                    row[3 * number : 3 * number + 3] = sign * np.array([*along, arm[0] * along[1] - arm[1] * along[0]])
                stiffness += k * (hi - lo) * share * np.outer(row, row)
    omega = highest_frequency(stiffness, np.stack((body["im"], body["im"], body["ii"]), axis=1).ravel())
    for i, block in enumerate(engine.assembly.bodies):
        b = body[i]
        if not block.fixed:
            # between two others on its longest face
            side = np.roll(block.corners, -1, axis=0) - block.corners
            k = float(engine.law[:, :, 0].max()) * b["depth"] * float(np.hypot(side[:, 0], side[:, 1]).max())
            omega = max(omega, 0.4 * math.sqrt(4.0 * k * (b["im"] + b["ii"] * b["r"] ** 2 / 3.0)))
    inverse = np.stack((body["im"], body["im"], body["ii"]), axis=1).ravel()
    return stable(*with_links(link_stiffness(engine.assembly, inverse), omega, float(now["beta"])))
