"""One lane of bodies in space of which any two may touch, and a run of it: closed under its weight, shaken, followed."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...column.links.placed import PlacedLink
from ...column.structure import Structure
from ...constants import LONGEST_WAIT
from ...errors import OutOfRangeWarning
from ...kernels.run_codes import CHUNK, FAILED
from ...kernels.space.records import GROUND, types, workspace, workspace_of_joints
from ...motion import Motion
from ...response import LinkHistories, Response
from ...response.assemblies import fallen, recorded_in_space
from ..base import RunOptions, given_back, refuse_endless, refuse_long_histories
from ..drums.links import acting, link_histories, link_measures, link_snapshot, with_links
from ..drums.records import bed_laws
from ..shared import ledger
from ..shared.ground import BEFORE, ground_histories, value_at
from ..shared.lanes import copied
from ..shared.stable_step import (
    AS_DRAWN,
    LOCAL_DAMPING,
    caution_of_settling,
    chosen_step,
    highest_frequency,
    settled,
    stable_step,
)
from .packing import FacesJoined, Solid, joints_of, pack, pack_joints, solids_of, stiffness_of, ties_of

#: Below this speed the restitution of a contact acts like a dashpot [m/s].
CALM = 0.02

#: Skin of the spheres of the contact search, as a share of the smallest body's radius.
SKIN = 0.1

#: Most pairs of parts that may touch at once, for each part.
MOST_NEAR = 64

#: At rest: nothing has moved by this share of the smallest body's radius, for so long [s].
REST_WAY, REST_TIME = 2.0e-4, 0.5

#: In a run until rest, once the motion is over: bodies of which no point is faster than this [m/s] have local damping, this
#: share of the unbalanced force. Their energy, 0.005 J/kg, decides over no fall.
SLOW, QUIETENED = 0.1, 0.05

#: Bodies are in equilibrium as drawn if their accelerations fall below this [m/s²] within so long with local damping [s],
#: while no point of one goes farther than ``AS_DRAWN`` of the least width of any. The temple of Évora on a podium at 0.97 of
#: the slope that its soft joints bear goes a tenth, and takes 34 s.
SETTLED, SETTLE_TIME = 1e-4, 40.0

#: Step times the circular frequency of a body on its largest face, at the usual share of the largest stable step.
STRUCK, USUAL = 0.5, 0.4

#: Round faces count with so many corners where the largest stable step is looked for.
ROUND = 8


def least_width(body: np.ndarray) -> float:
    """Least width of any of some bodies, each as a box with its mass and moments of inertia [m]."""
    moments = 1.0 / (body["ia"] + np.concatenate((0.0 * body["ib"], body["ib"], body["ic"]), axis=1))
    across = 6.0 * (moments.sum(axis=1) - 2.0 * moments.max(axis=1)) / body["m"][:, 0]
    return float(np.sqrt(across.min()))


class Loose:
    """One lane of bodies in space of which any two may touch, and the search for what does.

    Parameters
    ----------
    solids : sequence of Solid
    law : array
        k_n, k_s [N/m³] and tan φ between any two bodies, shape (N, N, 3); the pair's lower number first.
    gravity : sequence of float
        As an acceleration of the base: up is positive [m/s²].
    restitution : float
        Share of the closing speed that contacts of the bed give back: 1 is elastic.
    stiffness_damping : float
        [s]
    joints : sequence of FacesJoined
    links : tuple of PlacedLink
        That act; they begin where the bodies are.
    """

    def __init__(
        self,
        solids: Sequence[Solid],
        law: np.ndarray,
        gravity: Sequence[float],
        restitution: float = 1.0,
        stiffness_damping: float = 0.0,
        joints: Sequence[FacesJoined] = (),
        links: tuple[PlacedLink, ...] = (),
    ) -> None:
        from ...kernels.space import links as bonds
        from ...kernels.space import step as kernel

        self.bonds, self.kernel, self.restitution, kinds = bonds, kernel, restitution, types()
        self.packed = packed = pack(solids)
        n, e = len(packed.shape), restitution
        self.now, self.feed = np.zeros(1, kinds["now"]), np.zeros(1, kinds["feed"])
        self.feed["r"][0, :, 0] = np.eye(3).ravel()
        now = self.now
        now["g"], now["beta"], now["touched"] = gravity, stiffness_damping, -1
        now["eta"], now["calm"] = (1.0 - e * e) / (1.0 + e * e), CALM
        self.free = packed.body["fixed"] == 0
        self.smallest = float(packed.body["r"][self.free].min())
        self.least_width = least_width(packed.body[self.free])
        now["skin"] = SKIN * self.smallest
        most = min(n * (n - 1) // 2, MOST_NEAR * n)
        self.pair, spare = np.zeros(most, kinds["pair"]), np.zeros(most, kinds["pair"])
        self.joint, edge = pack_joints(joints, packed)
        self.body, self.law = packed.body, np.ascontiguousarray(law)
        self.numbers = self.body.view(np.float64).reshape(len(self.body), -1)
        self.links, self.ties = links, ties_of(links, packed.turn)
        self.state: tuple[Any, ...] = (
            packed.body, packed.shape, packed.vertex, packed.plane, packed.loop, packed.corner, self.pair, spare,
            self.joint, edge, self.law, now, self.feed, np.zeros(CHUNK + 1, kinds["ground"]),
            workspace(), workspace_of_joints(), np.zeros((4, 3)), tuple(self.ties),
        )  # fmt: skip
        self.begin_links()
        self.dt = 0.0
        self.stood_at, self.stood_since = np.full((len(solids), 12), np.inf), 0.0
        ground = np.isin(np.arange(len(solids)), packed.shape["body"][packed.shape["kind"] == GROUND])
        lowest = packed.body["z"][:, 0] - np.where(ground, 0.0, packed.body["r"])
        self.lowest_level = float(lowest.min()) - 10.0 * self.smallest

    def start(self, step: float) -> None:
        """Set the step and list who may touch; velocities are those of the start."""
        self.dt = step
        self.now["dt"] = step
        self.now["last"] = 0.0
        self.kernel.list_all(self.state)

    def begin_links(self) -> None:
        """Let the links be free of force where the bodies are now, but for their pretension."""
        if self.links:
            link = self.ties.link
            link["ft"][:, 0] = [placed.pretension for placed in self.links]
            link["gap"][:, 0] = link["back"][:, 0] = [placed.clearance for placed in self.links]
            self.bonds.begin(self.body, tuple(self.ties))

    def take_over(
        self, body: dict[str, np.ndarray], joint: dict[str, np.ndarray], now: dict[str, np.ndarray], steps: int
    ) -> None:
        """Go on from where the same bodies have come to after so many steps, by fields of their records, without touches."""
        for records, numbers in ((self.body, body), (self.joint, joint), (self.now, now)):
            for name, values in numbers.items():
                records[name] = values.reshape(records[name].shape)
        self.body["past"], self.now["earlier"], self.feed["step"] = self.vectors("w"), self.now["last"], steps
        self.kernel.list_all(self.state)

    def shake(self, motion: Motion) -> None:
        """Let the base move with a motion, which is kept."""
        self.motion, feed = motion, self.feed[0]
        for name, samples in (("x", motion.samples), ("y", motion.y_samples), ("z", motion.z_samples)):
            feed[name][0] = 0 if samples is None else samples.ctypes.data
        feed["last"][0], feed["ratio"][0], feed["factor"][0] = motion.steps - 1, self.dt / motion.dt, motion.factor

    def advance(self, chunks: int) -> None:
        """Advance by some chunks of steps."""
        self.kernel.advance(self.state, chunks)

    @property
    def steps(self) -> int:
        """Steps done."""
        return int(self.feed["step"][0, 0])

    @property
    def time(self) -> float:
        """Time of the present state [s]."""
        return self.steps * self.dt

    @property
    def failed(self) -> bool:
        """Whether the state is no longer finite."""
        return bool(self.now["status"][0] == FAILED)

    # -- the step --------------------------------------------------------------------------------------------------

    def stable_step(self) -> float:
        """Largest stable step of the closed joints, and one in which the impact of a whole face is resolved [s]."""
        u, n = self.packed.body, len(self.packed.body)
        inverse = np.zeros((6 * n, 6 * n))
        for i in np.flatnonzero(self.free):
            axes = self._axes(i)
            moments = u["ia"][i, 0] + np.array([u["ib"][i, 0], 0.0, u["ic"][i, 0]])
            inverse[6 * i : 6 * i + 3, 6 * i : 6 * i + 3] = u["im"][i, 0] * np.eye(3)
            inverse[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] = axes @ np.diag(moments) @ axes.T
        root = np.linalg.cholesky(inverse + 1e-30 * np.eye(6 * n))
        stiffness = np.zeros((6 * n, 6 * n))
        for e in self.joint:
            lower, upper = (int(self.packed.shape["body"][e[name]]) for name in "ab")
            points, frame, area = self._carried(e, upper)
            spring = e["ks"] * np.eye(3) + (e["kn"] - e["ks"]) * np.outer(frame[:, 2], frame[:, 2])
            own = np.concatenate([np.arange(6 * number, 6 * number + 6) for number in (upper, lower)])
            for point in points:
                arms = (1.0, *(point - self.place(upper))), (-1.0, *(point - self.place(lower)))
                rows = np.hstack(
                    [s * np.hstack((np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]])) for s, x, y, z in arms]
                )
                stiffness[np.ix_(own, own)] += area / len(points) * rows.T @ spring @ rows
        omega = highest_frequency(root.T @ stiffness @ root, np.ones(6 * n))
        for i in np.flatnonzero(self.free):
            struck = math.sqrt(float(self.law[:, :, 0].max()) * self._largest_face(i) * float(u["im"][i, 0]))
            omega = max(omega, struck * USUAL * 2.0 / STRUCK)
        return stable_step(*with_links(stiffness_of(self.links, root), omega, float(self.now["beta"][0])))

    def _carried(self, e: Any, upper: int) -> tuple[np.ndarray, np.ndarray, float]:
        """Corners of the smaller face of a joint in space [m], shape (k, 3), its axes as columns, and its area [m²]."""
        lower = int(self.packed.shape["body"][e["a"]])
        body, side = (upper, "u") if self._face_area(e, "u") <= self._face_area(e, "l") else (lower, "l")
        axes = self._axes(body)
        i, j, middle = (axes @ e[name + side] for name in "ijm")
        frame = np.stack((i, j, np.cross(i, j)), axis=1)
        corners = self._face_corners(e, side)
        return self.place(body) + middle + corners @ frame[:, :2].T, frame, float(e["width"])

    def _face_corners(self, e: Any, side: str) -> np.ndarray:
        many, first = int(e["many_" + side]), int(e["first_" + side])
        if many:
            return self.state[9][first : first + many]
        angle = np.arange(ROUND) * (2.0 * math.pi / ROUND)
        return float(e["r" + side]) * np.stack((np.cos(angle), np.sin(angle)), axis=1)

    def _face_area(self, e: Any, side: str) -> float:
        x, y = self._face_corners(e, side).T
        return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))

    def _largest_face(self, body: Any) -> float:
        """Area of the largest face of a body, of a drum the larger of its face and half of its side seen from there [m²]."""
        best = 0.0
        for s in self.packed.shape[self.packed.shape["body"] == body]:
            if s["h"] > 0.0:
                radius = max(float(s["rb"]), float(s["rt"]))
                best = max(best, math.pi * radius**2, 0.54 * radius * float(s["h"]))
            else:
                vertices = self.packed.vertex[s["first"] : s["first"] + s["count"]]
                for face in self.packed.loop[s["face"] : s["face"] + s["faces"]]:
                    around = vertices[self.packed.corner[face["first"] : face["first"] + face["count"]]]
                    best = max(
                        best, 0.5 * float(np.linalg.norm(np.cross(around, np.roll(around, -1, axis=0)).sum(axis=0)))
                    )
        return best

    # -- looks at the state, which change nothing ------------------------------------------------------------------

    def _axes(self, body: Any) -> np.ndarray:
        return np.array([[self.body[axis + c][body, 0] for axis in "ijk"] for c in "xyz"])

    def place(self, body: Any) -> np.ndarray:
        """Centroid of a body [m], shape (3,)."""
        return np.array([self.body[c][body, 0] for c in "xyz"])

    @property
    def places(self) -> np.ndarray:
        """Centroids of all bodies [m], shape (N, 3)."""
        return self._of_all("x").copy()

    def vectors(self, name: str) -> np.ndarray:
        """A vector of all bodies in the axes of space by the name of its fields, such as ``v`` or ``w``, shape (N, 3)."""
        return self._of_all(name + "x").copy()

    def _of_all(self, first: str, count: int = 3) -> np.ndarray:
        """Some fields of all bodies, from the first one on, as numbers that change with them."""
        fields: Any = self.body.dtype.fields
        at = fields[first][1] // self.numbers.itemsize
        return self.numbers[:, at : at + count]

    @property
    def struck_at(self) -> float | None:
        """When bodies that no joint holds together first touched [s]; None if none has."""
        step = int(self.now["touched"][0])
        return None if step < 0 else step * self.dt

    @property
    def axes_of_all(self) -> np.ndarray:
        """Axes in which the bodies were given, as columns, shape (N, 3, 3)."""
        principal = self._of_all("ix", 9).reshape(-1, 3, 3).swapaxes(1, 2)
        return principal @ self.packed.turn.transpose(0, 2, 1)

    def _with_forces(self) -> tuple[Any, ...]:
        """A copy of what the forces at the present positions change, with these."""
        copies = {0, 6, 8, 11}  # bodies, pairs, joints, now
        *state, ties = (copied(array) if k in copies else array for k, array in enumerate(self.state))
        state = *state, tuple(copied(array) for array in ties)
        self.kernel.forces(state)
        return state

    def energies(self, base: np.ndarray | None = None) -> np.ndarray:
        """Ledger now: input, kinetic, gravitational, elastic, friction, viscous; the middle three absolute [J].

        ``base`` is the acceleration of the base now [m/s²].
        """
        out = np.empty(6)
        self.kernel.ledger(self._with_forces(), np.zeros(3) if base is None else base, out)
        return out

    def residual_acceleration(self) -> float:
        """Largest acceleration of a body without input; of its farthest point, where it turns [m/s²]."""
        u = self._with_forces()[0][self.free]
        linear = np.abs(u["f"] * u["im"] - self.now["g"]).max()
        easiest = u["ia"] + np.maximum(np.maximum(u["ib"], u["ic"]), 0.0)
        turning = (np.abs(u["mo"]) * easiest).max(axis=1) * u["r"]
        return float(max(linear, turning.max()))

    @property
    def _poses(self) -> np.ndarray:
        """Centroids, and axes times the reach of their bodies [m], shape (N, 12)."""
        return np.concatenate((self._of_all("x"), self.axes_of_all.reshape(-1, 9) * self.body["r"][:, None]), axis=1)

    def at_rest(self) -> bool:
        """Whether nothing has moved for ``REST_TIME``, but what falls for ever; to be asked again and again."""
        here = self._poses
        way = np.abs(here - self.stood_at).max(axis=1)[self.free]
        there = ~(here[self.free, 2] < self.lowest_level)
        if way[there].max(initial=0.0) > REST_WAY * self.smallest:
            self.stood_at, self.stood_since = here, self.time
        return self.time - self.stood_since > REST_TIME

    def quieten(self) -> None:
        """Damp what moves slowly, so that it comes to rest; what falls loses a twentieth of its acceleration at most."""
        speed, turning = (np.linalg.norm(self._of_all(name + "x"), axis=1) for name in ("v", "w"))
        self.body["local"] = np.where(speed + self.body["r"] * turning < SLOW, QUIETENED, 0.0)

    # -- the start -------------------------------------------------------------------------------------------------

    def settle(self) -> float:
        """Close the contacts by the weight that they carry, with local damping.

        Returns
        -------
        float
            How far the farthest point is from where it was drawn [m]; infinite if it does not rest near there, and then
            everything is as it was.
        """
        arrays = (self.body, self.pair, self.joint, self.now, self.feed, *self.ties)
        drawn, poses = [array.copy() for array in arrays], self._poses
        self.body["local"], self.feed["last"] = LOCAL_DAMPING, 0

        def rests() -> bool:
            return settled(
                self._relax, self.residual_acceleration, SETTLED, math.ceil(SETTLE_TIME / (CHUNK * self.dt)),
                lost=lambda: self.failed or not self._way_from(poses) <= AS_DRAWN * self.least_width,
            )  # fmt: skip

        balanced = rests()
        if balanced:
            self._join_layers()
            balanced = rests()
        before = drawn[3]
        if balanced:
            self.body["local"] = 0.0
            for name in ("work", "shear", "visc", "touched", "last", "earlier"):
                self.now[name] = before[name]
            for c in "xyz":
                for name in ("v", "w", "l"):
                    self.body[name + c] = 0.0
        else:
            for array, old in zip(arrays, drawn, strict=True):
                array[...] = old
        self.feed[...] = drawn[4]
        return self._way_from(poses) if balanced else math.inf

    def _join_layers(self) -> None:
        """Let friction go on from one layer: which part of a face touched first while it settled is an accident."""
        for memory in (self.joint, self.pair):
            for core, fresh in (("s", "fs"), ("st", "ft"), ("kc", "kf"), ("jc", "jf")):
                memory[fresh] += memory[core]
                memory[core] = 0.0

    def _way_from(self, poses: np.ndarray) -> float:
        return float(np.abs(self._poses - poses)[self.free].max())

    def _relax(self, chunks: int) -> None:
        self.advance(chunks)
        self.begin_links()


#: A run has failed when its ledger misses more than this share of the energy at stake, at the end or before anything fell.
LARGEST_IMBALANCE = 0.05

#: Nor has a run a verdict in which a contact was deeper than this share of the least width of any body.
DEEPEST = 0.25

#: About what a step costs on one core for each joint and body [s].
COST = 2e-6


def engine_of(structure: Structure, model: Any, restitution: float) -> Loose:
    """The lane of an assembly in space."""
    solids, first = solids_of(structure)
    joints = joints_of(structure, solids, first)
    gravity = (0.0, 0.0, structure.gravity)
    return Loose(solids, bed_laws(structure), gravity, restitution, model.stiffness_damping, joints, acting(structure))


def step_for(engine: Loose, structure: Structure, model: Any) -> float:
    """Time step of a run [s].

    Raises
    ------
    InputError
        The step asked for is unstable.
    """
    return chosen_step(engine.stable_step(), model.step_factor, model.time_step, repr(structure.name))


def run_in_space(structure: Structure, motion: Motion, model: Any, options: RunOptions) -> Response:
    """One run of an assembly in space to the end of the motion and its tail, or until rest.

    It goes on however much has fallen: what stands may fall later. The contacts are closed by the weight they carry; an
    assembly that is not in equilibrium begins as drawn, with a warning.

    Raises
    ------
    InputError
        The step asked for is unstable.

    Warns
    -----
    OutOfRangeWarning
        The assembly is not in equilibrium as drawn.
    """
    motion, engine = motion.multiplied, lane_as_drawn(structure, model)
    chunks_of(structure, motion, engine, options)
    made = lane_at_rest(structure, engine)
    if made.settled and (caution := caution_of_settling(structure.name, made.settled, made.engine.least_width)):
        warnings.warn(caution, OutOfRangeWarning, stacklevel=4)
    return go_on(structure, motion, model, options, made, [])


def go_on(
    structure: Structure,
    motion: Motion,
    model: Any,
    options: RunOptions,
    made: StartState,
    states: list[dict[str, Any]],
) -> Response:
    """Go on with a run from where its engine is to where it ends.

    Parameters
    ----------
    structure, motion, model, options
        As of :func:`run_in_space`.
    made : StartState
        How it began, with the engine as it is now.
    states : list of dict
        What was recorded so far, the last one now; empty at the start. Of what the first one holds a history is kept.
    """
    engine = made.engine
    engine.shake(motion)
    states, still = _follow(structure, engine, motion, states or [_state(engine, motion)], options)
    stack: dict[str, Any] = {key: np.array([state[key] for state in states]) for key in states[0] if key != "links"}
    failure = ""
    if engine.failed:
        failure = f"the bodies could not be followed beyond {engine.time:.4g} s; try a smaller step_factor"
    return response_of(
        structure, motion, model, made, stack, still=still, failure=failure, link_histories=link_histories(states)
    )


class StartState(NamedTuple):
    """An assembly in space about to be shaken.

    Parameters
    ----------
    engine : Loose
        With its step, begun.
    start : array
        Ledger of its state [J].
    settled : float or None
        How far settling has moved it [m], infinite if it does not rest near there; None if it begins as drawn.
    """

    engine: Loose
    start: np.ndarray
    settled: float | None

    @property
    def balanced(self) -> bool | None:
        """Whether it is in equilibrium as drawn; None if it begins as drawn."""
        return None if self.settled is None else math.isfinite(self.settled)


def lane_as_drawn(structure: Structure, model: Any) -> Loose:
    """The lane of an assembly in space as drawn, with its step.

    Raises
    ------
    InputError
        The step asked for is unstable.
    """
    engine = engine_of(structure, model, given_back(model))
    engine.start(step_for(engine, structure, model))
    return engine


def lane_at_rest(structure: Structure, engine: Loose) -> StartState:
    """An assembly in space with its contacts closed by the weight that they carry, unless it begins as drawn."""
    way = engine.settle() if getattr(structure, "settle", True) else None
    return StartState(engine, engine.energies(), way)


def chunks_of(structure: Structure, motion: Motion, engine: Loose, options: RunOptions) -> tuple[int, int]:
    """Chunks of steps of a run, and after how many of them a state is kept; endless runs are refused.

    Raises
    ------
    InputError
    """
    duration = motion.duration + options.tail
    length = duration + (LONGEST_WAIT if options.until_rest else 0.0)
    refuse_endless(f"{structure.name!r} under {motion.name!r}", length, engine.dt, COST * len(engine.body))
    refuse_long_histories(length / options.output_interval, len(engine.body))
    chunks = math.ceil(duration / (CHUNK * engine.dt) * (1.0 - 1e-12))
    return chunks, max(1, min(chunks, round(options.output_interval / (CHUNK * engine.dt))))


def response_of(
    structure: Structure,
    motion: Motion,
    model: Any,
    made: StartState,
    stack: dict[str, Any],
    *,
    still: bool,
    failure: str = "",
    link_histories: LinkHistories | None = None,
) -> Response:
    """The response of a run from its states, by their names; ``failure`` is why they end before the run does,
    ``link_histories`` are the histories of its links."""
    engine, start = made.engine, made.start
    change = stack["energy"] - np.where([0, 0, 1, 1, 1, 1], start, 0.0)
    imbalance = max(_imbalance(change, start), _imbalance_before_falls(structure, stack, change, start))
    deepest = float(engine.now["deepest"][0])
    if not failure and deepest > DEEPEST * engine.least_width:
        failure = (
            f"bodies sank into one another, {deepest:.3g} m at a contact; try a smaller step_factor, or stiffer joints"
        )
    failure = failure or ledger.out_of_balance(imbalance, LARGEST_IMBALANCE)
    acceleration, displacement = ground_histories(motion, stack["time"])
    if made.balanced:
        failure = failure or ledger.set_off_by_itself(stack["time"], acceleration, change[:, 1], float(start[3]))
    recorded = recorded_in_space(
        structure,
        stack["time"],
        stack["position"],
        stack["axes"],
        {name: change[:, k] for k, name in enumerate(ledger.TERMS)},
        acceleration,
        displacement,
        at_rest=still,
        in_equilibrium=made.balanced,
        failure=failure,
        energy_imbalance=imbalance,
        time_step=engine.dt,
        steps=round(float(stack["time"][-1]) / engine.dt),
        velocity=stack.get("velocity"),
        spin=stack.get("spin"),
        struck_at=engine.struck_at,
        model=model.name,
        links=link_measures(engine.links, engine.ties.link, 0, engine.dt),
        link_histories=link_histories,
        provenance={
            "restitution": engine.restitution,
            "joints": len(engine.joint),
            "deepest_penetration_m": deepest,
        },
    )
    return Response.of(recorded)


def _imbalance(change: np.ndarray, start: np.ndarray) -> float:
    """Energy imbalance at the last of some states, whose ledgers have changed so since the start."""
    return ledger.imbalance(
        ledger.unaccounted(change[-1] - np.where([0, 1, 0, 0, 0, 0], change[0], 0.0)),
        work=float(np.abs(change[:, 0]).max()), start=float(start[1] + start[3]), barrier=0.0,
        released=ledger.released(change[-1]),
    )  # fmt: skip


def _imbalance_before_falls(
    structure: Structure, stack: dict[str, Any], change: np.ndarray, start: np.ndarray
) -> float:
    """Most that the ledger misses before anything fell, over the input by then or what the way there has set free.

    It may have decided over the fall, which sets free far more.
    """
    down = fallen(structure, stack["position"][0], stack["axes"][0], stack["position"], stack["axes"]).any(axis=1)
    if not down.any():
        return 0.0
    upright = change[: np.argmax(down)] - np.where([0, 1, 0, 0, 0, 0], change[0], 0.0)
    return ledger.imbalance(
        max(map(ledger.unaccounted, upright)), work=float(np.abs(upright[:, 0]).max()),
        start=float(start[1] + start[3]), barrier=0.0, released=max(map(ledger.released, upright)),
    )  # fmt: skip


def _follow(
    structure: Structure, engine: Loose, motion: Motion, states: list[dict[str, Any]], options: RunOptions
) -> tuple[list[dict[str, Any]], bool]:
    """Go on to where the run ends; the states until there, and whether all lies still after the motion."""
    chunks, every = chunks_of(structure, motion, engine, options)
    duration = motion.duration + options.tail
    still, over = False, False
    while not engine.failed:
        remaining = chunks - engine.steps // CHUNK
        still, over = engine.at_rest(), remaining <= 0
        if over:
            drawn, now = ((state["position"], state["axes"]) for state in (states[0], states[-1]))
            waits = options.until_rest or (options.until_decided and not fallen(structure, *drawn, *now).any())
            if not waits or still or engine.time > duration + LONGEST_WAIT:
                break
            engine.now["dull"] = engine.now["eta"]
            engine.quieten()
        engine.advance(every if over else min(every, remaining))
        states.append(_state(engine, motion))
        if options.progress:
            options.progress(min(engine.time, duration), duration)
    return states, still and over


def _state(engine: Loose, motion: Motion) -> dict[str, Any]:
    """Part of the present state in a history."""
    return {
        "time": engine.time,
        "position": engine.places,
        "axes": engine.axes_of_all,
        "velocity": engine.vectors("v"),
        "spin": engine.vectors("w"),
        "energy": engine.energies(ground_at(motion, engine.time)),
    } | ({"links": link_snapshot(engine.ties.link, 0)} if engine.links else {})


def ground_at(motion: Motion, time: float) -> np.ndarray:
    """Acceleration of the base at a time [m/s²], shape (3,)."""
    place, base = time / motion.dt, np.zeros(3)
    if place <= motion.steps - 1:
        for c, samples in enumerate((motion.samples, motion.y_samples, motion.z_samples)):
            if samples is not None:
                base[c] = value_at(samples, place, BEFORE) * motion.factor
    return base
