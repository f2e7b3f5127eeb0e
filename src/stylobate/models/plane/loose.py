"""Bodies in the plane any two of which may touch: one lane with the search for what does, and the engine of assemblies."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...column.assembly import Assembly
from ...column.structure import Structure
from ...constants import DEGREE, LONGEST_WAIT
from ...errors import InputError, OutOfRangeWarning, warn
from ...kernels.plane.records import BETA, LOCAL
from ...kernels.run_codes import CHUNK, FAILED
from ...kernels.shared.records import STATE
from ...messages import say
from ...motion import Motion
from ...response import Measures, Response
from ...response.assemblies import first_touch, have_fallen, lowest_standing, recorded_blocks
from ..base import Case, RunOptions, given_back, refuse_endless, refuse_long_histories
from ..drums.impact import rocking_column
from ..drums.links import acting, bonds, link_histories, link_measures, link_snapshot, with_links
from ..drums.records import UNSEEN, Topology, bed_laws, body_fields, damping_rows, joint_stiffnesses
from ..drums.stepped import StackEngine, SteppedEngine, with_provenance
from ..shared import ledger
from ..shared.ground import ground_histories
from ..shared.lanes import longest_piece
from ..shared.stable_step import (
    AS_DRAWN,
    LOCAL_DAMPING,
    caution_of_settling,
    chosen_step,
    highest_frequency,
    settled,
    stable_step,
    whole_steps,
)
from .columns import Records, slope_base
from .packing import (
    fill_hands,
    fill_shapes,
    joint_fields,
    lane_fields,
    links_at_rest,
    point_law,
    stiffness_between,
)

#: Below this speed the restitution of a contact acts like a dashpot [m/s].
CALM = 0.02

#: At rest: no corner has moved by this share of the smallest block, for so long [s]. (Not a speed: an undamped joint goes
#: on ringing, by far less than that.)
REST_WAY, REST_TIME = 2.0e-4, 0.5

#: Bodies that enter each other by more than this share of the thinnest block are too soft.
DEEPEST = 0.2

#: Parts of a step while bodies may strike each other: impacts are harder than what joints do.
FINER = 8

#: Nothing comes loose unseen: the longest of these times for which it is certain that all holds [s].
AHEAD = (0.08, 0.04, 0.02, 0.01)

#: An assembly is in equilibrium as drawn if its accelerations fall below this [m/s²] within so many steps of local
#: damping, while no corner goes farther than ``AS_DRAWN`` of the smallest block.
SETTLED, SETTLE_STEPS = 1e-4, 40_000

#: About what a step costs on one core for each body and contact point [s]; of blocks that all stand on one another.
COST, COST_STANDING = 2e-7, 5e-8

#: A step that is never reached: who follows a run says when it ends.
ENDLESS = 2**62

#: Skin of the boxes of the contact search, as a share of the smallest block.
SKIN = 0.1


class Loose:
    """One lane of bodies any two of which may touch, and the search for what does.

    Parameters
    ----------
    structure : Structure
    model : DistinctElement2D
        With what acts in the run.
    motion : Motion
    duration : float
        For which the ground moves, and after [s]; the step divides it.
    restitution : float
        Share of the closing speed that contacts of the bed give back: 1 is elastic. Joints have none while the ground
        moves, and in a column that may still stand: what they lose, they lose by sliding.
    """

    def __init__(
        self, structure: Structure, model: Any, motion: Motion, duration: float, restitution: float = 1.0
    ) -> None:
        from ...kernels.plane import links as ties
        from ...kernels.plane import loose as kernel

        self.kernel, self.ties, self.structure, self.motion = kernel, ties, structure, motion
        bodies, topology = structure.bodies, Topology.of(structure)
        n = len(bodies)
        types = point_law(model.points, True, 1, bool(topology.links), turned=True)
        self.records = records = Records(types, topology, spare=n * (n - 1) // 2)
        now, hand, shape = (
            np.zeros(rows, record_type) for rows, record_type in zip((1, len(records.joint), n), kernel.search_types())
        )
        lane = lane_fields(structure, damping_rows(True, model.stiffness_damping, model.mass_damping), model.points)
        records.fill(
            0,
            body=body_fields(structure),
            joint=joint_fields(structure, *joint_stiffnesses(structure, model.block_modulus), turned=True),
            lane=lane,
        )
        corner = fill_shapes(shape, structure)
        fill_hands(hand, structure)
        joined = np.full((n, n), -1, dtype=np.int64)
        for j, (lower, upper) in enumerate(topology.joints):
            joined[lower, upper] = j
        records.bond[...], records.link[...] = bonds(structure), links_at_rest(structure, records.body)
        self.tied = len(records.link) > 0
        if self.tied:
            self.pretension, self.clearance = records.link["ft"].copy(), records.link["gap"].copy()
        e = restitution
        now["eta"], now["calm"] = (1.0 - e * e) / (1.0 + e * e), CALM
        now["touched"], now["finer"] = -1, FINER
        self.smallest = min(body.size for body in bodies if not body.fixed)
        now["skin"] = SKIN * self.smallest
        self.now, self.hand, self.shape = now, hand, shape
        self.law, self.memory = bed_laws(structure, model.block_modulus), np.zeros((n, n, 3))
        real = tuple(np.zeros(kernel.MOST) for _ in range(8))
        whole = tuple(np.zeros(kernel.MOST, dtype=np.int64) for _ in range(2))
        self.search: tuple[Any, ...] = (
            now, hand, shape, corner, np.zeros((n, 4)), np.arange(n), joined, self.law, self.memory, real, whole
        )  # fmt: skip
        self.begin_links()
        self.dt, self.duration, self.safe = 0.0, duration, 0
        self.stood_at, self.stood_since = np.full((3, n), np.inf), 0.0
        # a body below this level has left the model: it falls without end and does not count as moving
        corners = np.concatenate([body.outline for body in bodies])
        self.lowest_level = float(corners[:, 1].min()) - 2.0 * float(np.ptp(corners, axis=0).max())

    def start(self, step: float) -> None:
        """Set the step and the velocities half a step before the start, of bodies that do not move yet."""
        self.dt, self.chunks = whole_steps(self.motion, self.duration - self.motion.duration, step)
        self.now["dt"] = self.now["last"] = self.records.lane["dt"][0] = self.dt
        self.look = max(1, int(AHEAD[0] / (CHUNK * self.dt)))
        self.records.watch[...] = 0
        self.records.fill(0, watch=UNSEEN | {"follow": True})
        self.records.feed_motion(0, self.motion, self.dt)
        slope_base(self.records, 0, self.motion, self.structure.as_found.base_tilt * DEGREE)
        self.records.feed["end"] = ENDLESS
        self.renew_pairs()
        self._push()

    def begin_links(self) -> None:
        """Let the links be free of force where the bodies are now, but for their pretension."""
        records = self.records
        if self.tied:
            records.link["ft"], records.link["gap"] = self.pretension, self.clearance
            records.link["back"] = self.clearance
            self.ties.begin(records.body, records.joint, records.link, records.bond, records.pair)

    def renew_pairs(self) -> None:
        """Search anew for pairs that may touch."""
        self.kernel.renew_pairs(self.records.state, self.search)

    def may_come_loose(self, time: float) -> bool:
        """Whether bodies that are not joined may touch, or a joint may hand over or has, within a time [s]."""
        gone = not self.hand["live"].all()  # where its faces meet again the bed holds them
        return gone or bool(self.kernel.may_come_loose(self.records.state, self.search, time))

    def chunks_ahead(self) -> int:
        """Chunks of steps for which it is certain that joints and links alone hold everything; 0 if something is loose."""
        time = next((time for time in AHEAD if not self.may_come_loose(time)), 0.0)
        return max(1, int(time / (CHUNK * self.dt))) if time > 0.0 else 0

    def ground_acceleration(self, time: float) -> tuple[float, float]:
        """Acceleration of the base along and normal to it at a time [m/s²]."""
        along, normal = self.records.bases([0], np.array([time / self.motion.dt]))[0]
        return float(along), float(normal)

    def _push(self) -> None:
        """Velocities half a step before the start, of bodies that do not move yet, whatever accelerates them."""
        records = self.records
        for name in ("vx", "vz", "w"):
            records.body[name] = 0.0
        body, free = self._forces()[0][0], records.span["fixed"] == 0
        ax, az = self.ground_acceleration(0.0) if self.records.feed["x"][0, 0] else (0.0, 0.0)
        ax, az = ax + records.lane["gx"][0, 0], az + records.lane["g"][0, 0]
        here = records.body
        here["vx"][free, 0] = -0.5 * self.dt * (body["fx"] * body["im"] - ax)[free, 0]
        here["vz"][free, 0] = -0.5 * self.dt * (body["fz"] * body["im"] - az)[free, 0]
        here["w"][free, 0] = -0.5 * self.dt * (body["mo"] * body["ii"])[free, 0]

    def advance(self, chunks: int) -> None:
        """Advance by some chunks of steps: as lanes do while joints and links hold everything, with the search otherwise."""
        while chunks > 0 and not self.failed:
            even = float(self.now["last"][0]) == self.dt and float(self.now["dull"][0]) == 0.0
            if not even:
                self.safe = 0
            elif self.safe <= 0:
                self.safe = self.chunks_ahead()
            piece = min(chunks, longest_piece(self.cost, CHUNK), self.safe if self.safe > 0 else self.look)
            if self.safe > 0:
                if self.tied:
                    self.records.link["dt"] = self.dt
                self.records.forget_pairs()  # none of them touches, but their last loads are kept
                self.records.kernel.advance(self.records.state, piece)
                self.safe -= piece
            else:
                self.records.bond["near"] = 1
                self.renew_pairs()
                self.kernel.advance_loose(self.records.state, self.search, piece)
            chunks -= piece

    @property
    def cost(self) -> float:
        """About what a step costs on one core [s]."""
        return COST * len(self.records.body) * len(self.records.lane["xi"][0])

    @property
    def steps(self) -> int:
        """Steps done."""
        return int(self.records.feed["step"][0, 0])

    @property
    def time(self) -> float:
        """Time of the present state [s]."""
        return float(self.steps) * self.dt

    @property
    def failed(self) -> bool:
        """Whether the state is no longer finite."""
        return bool(self.records.watch["status"][0, 0] == FAILED)

    def at_rest(self) -> bool:
        """Whether nothing has moved for ``REST_TIME``, but what falls for ever; to be asked again and again."""
        b = {name: self.records.body[name][:, 0] for name in ("x", "z", "th")}
        here = np.stack((b["x"], b["z"], self.shape["r"] * b["th"]))
        way = np.abs(here - self.stood_at).sum(axis=0)
        if way[~(b["z"] < self.lowest_level)].max(initial=0.0) > REST_WAY * float(self.now["skin"][0]) / SKIN:
            self.stood_at, self.stood_since = here, self.time
        return self.time - self.stood_since > REST_TIME

    def _forces(self) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
        """State and search, copies of what that changes, with the forces at the present positions."""
        state = self.records.now()
        now, hand, *fixed = self.search
        fixed[6] = self.memory.copy()
        search = (now.copy(), hand.copy(), *fixed)
        self.kernel.loose_forces(state, search)
        return state, search

    def energies(self) -> np.ndarray:
        """Ledger now: input, kinetic, gravitational, elastic, friction, viscous; the middle three absolute [J]."""
        state, search = self._forces()
        gx, gz = self.ground_acceleration(self.time)
        out = np.empty(6)
        self.kernel.ledger_loose(state, search, gx, gz, float(self.now["last"][0]), out)
        return out

    def residual_acceleration(self) -> float:
        """Largest acceleration of a body without input; of its farthest corner, where it turns [m/s²]."""
        body, lane = (self._forces()[0][STATE.index(name)] for name in ("body", "lane"))
        free = self.records.span["fixed"] == 0
        b = {name: body[name][free, 0] for name in ("fx", "fz", "mo", "im", "ii")}
        turn = b["mo"] * b["ii"] * self.shape["r"][free]
        g, gx = lane["g"][0, 0], lane["gx"][0, 0]
        return float(np.abs(np.concatenate((b["fx"] * b["im"] - gx, b["fz"] * b["im"] - g, turn))).max())

    def settle(self) -> float:
        """Close the contacts by the weight that they carry, with local damping.

        Returns
        -------
        float
            How far the farthest corner is from where it was drawn [m]; infinite if it does not rest near there, and then
            everything is as it was.
        """
        records = self.records
        arrays: tuple[Any, ...] = (
            records.body,
            records.joint,
            records.lane,
            records.feed,
            self.hand,
            self.now,
            self.memory,
        )
        drawn = [array.copy() for array in arrays]
        records.lane["damp"][0, LOCAL] = LOCAL_DAMPING
        records.feed["x"], records.feed["z"] = 0, 0
        rests = settled(
            self._relax, self.residual_acceleration, SETTLED, SETTLE_STEPS // CHUNK,
            lost=lambda: self._farthest_from(drawn[0]) > AS_DRAWN * self.smallest or self.failed,
        )  # fmt: skip
        records.lane["damp"][0, LOCAL] = 0.0
        for name in ("work", "shear", "visc"):
            records.lane[name] = drawn[2][name]
        records.feed[...] = drawn[3]
        if not rests:
            for array, before in zip(arrays, drawn, strict=True):
                array[...] = before
            self.renew_pairs()
            self.begin_links()
        self.safe = 0
        self._push()
        return self._farthest_from(drawn[0]) if rests else math.inf

    def _relax(self, chunks: int) -> None:
        self.advance(chunks)
        self.begin_links()

    def _farthest_from(self, before: np.ndarray) -> float:
        """Way of the farthest corner from other poses [m]."""
        b = self.records.body
        way = np.hypot(b["x"] - before["x"], b["z"] - before["z"])[:, 0]
        way = way + self.shape["r"] * np.abs(b["th"] - before["th"])[:, 0]
        return float(way.max())

    def deepest(self) -> float:
        """Depth to which bodies have entered each other, joints aside [m].

        Warns
        -----
        OutOfRangeWarning
            It is no longer small beside the thinnest block.
        """
        depth = float(self.now["deepest"][0])
        thin = min((body.thickness, body.name) for body in self.structure.bodies if not body.fixed)
        if depth > DEEPEST * thin[0]:
            warn(
                say(
                    "blocks of {name!r} entered each other by {depth:.3g} mm, and {thin!r} is {size:.3g} mm thick; its "
                    "impacts mean little: raise normal_stiffness.",
                    name=self.structure.name,
                    depth=1000.0 * depth,
                    thin=thin[1],
                    size=1000.0 * thin[0],
                ),
                OutOfRangeWarning,
            )
        return depth

    def pose(self) -> dict[str, Any]:
        """State for measures; of the ledger the input alone, the first of its terms."""
        b = {name: self.records.body[key][:, 0].copy() for name, key in (("x", "x"), ("z", "z"), ("rotation", "th"))}
        return b | {"time": self.time, "energy": np.array([float(self.records.lane["work"][0, 0]), *[math.nan] * 5])}

    def state(self) -> dict[str, Any]:
        """Part of the present state in a history."""
        extras = {"links": link_snapshot(self.records.link, 0)} if self.tied else {}
        extras["velocity"] = np.stack([self.records.body[key][:, 0] for key in ("vx", "vz", "w")], axis=-1)
        return self.pose() | extras | {"energy": self.energies()}


#: Time after the last block has fallen at which a run of a batch ends [s].
AFTER_THE_FALL = 5.0


def step_for(engine: Loose, model: Any) -> float:
    """Time step of a run [s]; whole chunks of steps fill the motion.

    Raises
    ------
    InputError
        The step asked for is unstable.
    """
    name = repr(engine.structure.name)
    return min(
        chosen_step(stable_step_of(engine), model.step_factor, model.time_step, name),
        engine.motion.duration / CHUNK,
    )


class LooseInPlane(SteppedEngine):
    """Assemblies of blocks in the plane, any two of which may touch: one by one, each to the end of its run."""

    computes = (Assembly,)
    takes = frozenset({"as found"})
    links = StackEngine.links | {"clamp"}
    rocking = staticmethod(rocking_column)

    def check_start(self) -> None:
        """Refuse a start from a pose."""
        what = self.structure
        raise InputError(f"a start from a pose is for columns, and {what.name!r} is {what.described}; leave start out.")

    def check_length(self, motion: Motion, options: RunOptions) -> None:
        """The step of what may come loose is known once its contacts are: each run asks for itself."""

    def followed(self) -> Assembly:
        """The assembly: any two of its blocks may strike each other."""
        return self.structure

    def check(self, motion: Motion) -> None:
        """Refuse a modulus of the stone, besides what all refuse."""
        super().check(motion)
        self.check_rigid()

    def check_rigid(self) -> None:
        """Refuse a modulus of the stone."""
        if self.model.block_modulus is not None:
            raise InputError(
                f"block_modulus is {self.model.block_modulus:g} Pa; the blocks of an assembly are rigid: leave it out."
            )

    def expected_step(self, motion: Motion) -> tuple[float, float]:
        """Time step, and about what a step costs on one core as long as all stands, both [s]; what falls is dearer."""
        acting = self.acting
        loose = Loose(self.structure, acting, motion, motion.duration)
        return step_for(loose, acting), COST_STANDING * len(loose.records.body) * acting.points

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories, however much falls."""
        response = run_assembly(self.structure, motion, self.acting, replace(options, until_end=True))
        return with_provenance(self, motion, response)

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs one by one in threads, without histories."""

        def alone(case: Case) -> Response:
            return run_assembly(*case, self.model.acting(case.column), options, recorded=False)

        return one_by_one(alone, cases, threads)


def run_assembly(
    assembly: Assembly, motion: Motion, model: Any, options: RunOptions, *, recorded: bool = True
) -> Response:
    """One run of an assembly to the end of the motion and its tail, or until rest.

    With neither ``until_end`` nor ``until_rest`` it ends some seconds after the last block has fallen.

    The contacts are closed by the weight they carry. An assembly that is not in equilibrium begins as drawn, with a
    warning, or is refused.

    Parameters
    ----------
    assembly : Assembly
    motion : Motion
    model : DistinctElement2D
        With what acts in the run.
    options : RunOptions
    recorded : bool
        Whether histories are wanted; without them the ledger is drawn up at the end only, and forces of links are not kept.

    Raises
    ------
    InputError
        The step asked for is unstable, or the assembly cannot settle.

    Warns
    -----
    OutOfRangeWarning
        The assembly is not in equilibrium as drawn.
    """
    motion, restitution = motion.multiplied, given_back(model)
    engine = Loose(assembly, model, motion, motion.duration + options.tail, restitution)
    step = step_for(engine, model)
    length = engine.duration + (LONGEST_WAIT if options.until_rest else 0.0)
    refuse_endless(f"{assembly.name!r} under {motion.name!r}", length, step, engine.cost)
    refuse_long_histories(length / options.output_interval, len(assembly.blocks))
    engine.start(step)
    way = engine.settle()
    balanced = math.isfinite(way)
    if not balanced and model.start == "settle":
        raise InputError(
            f"{assembly.name!r} is not in equilibrium as drawn; support its blocks, or leave start=settle out to let "
            "it move."
        )
    if caution := caution_of_settling(assembly.name, way, engine.smallest):
        warn(caution)
    start = engine.energies()
    states, still = follow(engine, options, recorded)
    stack = {key: np.array([state[key] for state in states]) for key in states[0] if key != "links"}
    change = stack["energy"] - np.where([0, 0, 1, 1, 1, 1], start, 0.0)
    imbalance = ledger.imbalance(
        ledger.unaccounted(change[-1]), work=float(np.abs(change[:, 0]).max()), start=float(start[3]), barrier=0.0,
        released=ledger.released(change[-1]),
    )  # fmt: skip
    acceleration, displacement = ground_histories(motion, stack["time"])
    step, poses = int(engine.now["touched"][0]), (stack["x"], stack["z"], stack["rotation"])
    touched = first_touch(assembly, stack["time"], *poses, step * engine.dt) if step >= 0 else None
    made = recorded_blocks(
        assembly,
        stack["time"],
        *poses,
        {name: change[:, k] for k, name in enumerate(ledger.TERMS)},
        acceleration,
        displacement,
        at_rest=still,
        in_equilibrium=balanced,
        failed=engine.failed or bool(ledger.out_of_balance(imbalance)),
        energy_imbalance=imbalance,
        time_step=engine.dt,
        steps=engine.steps,
        model=model.name,
        touched=touched,
        links=link_measures(acting(assembly), engine.records.link, 0, engine.dt),
        link_histories=link_histories(states) if recorded else None,
        velocity=stack.get("velocity"),
        provenance={
            "restitution": restitution,
            "joints": len(assembly.joints),
            "deepest_penetration_m": engine.deepest(),
        },
    )
    return Response.of(made)


def follow(engine: Loose, options: RunOptions, recorded: bool = True) -> tuple[list[dict[str, Any]], bool]:
    """Go on to where the run ends; the states on the way, and whether all lies still after the motion.

    It ends with the motion and its tail, when all lies still, or some time after the last block has fallen.
    """
    every = max(1, min(engine.chunks, round(options.output_interval / (CHUNK * engine.dt))))
    keep = engine.state if recorded else engine.pose
    states, still, over = [keep()], False, False
    lowest, rotation = lowest_standing(engine.structure, states[0]["z"]), states[0]["rotation"]
    fallen, since = np.zeros(len(rotation), dtype=bool), 0.0
    while not engine.failed:
        remaining = engine.chunks - engine.steps // CHUNK
        still, over = engine.at_rest(), remaining <= 0
        if over:
            waits = options.until_rest or (options.until_decided and not fallen.any())
            if not waits or still or engine.time > engine.duration + LONGEST_WAIT:
                break
            engine.now["dull"] = engine.now["eta"]
        engine.advance(every if over else min(every, remaining))
        states.append(keep())
        if options.progress:
            options.progress(min(engine.time, engine.duration), engine.duration)
        now = have_fallen(lowest, states[-1]["z"], states[-1]["rotation"] - rotation)
        if (now != fallen).any():
            fallen, since = now, engine.time
        ends = not (options.until_end or options.until_rest)
        if ends and fallen.any() and engine.time - since > AFTER_THE_FALL:
            break
    if not recorded:
        states[-1]["energy"] = engine.energies()
    return states, still and over


def one_by_one(run: Callable[[Case], Response], cases: Sequence[Case], threads: int) -> Iterator[tuple[int, Measures]]:
    """(index of the case, measures) of runs as they finish."""
    from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

    under_way: dict[Future[Response], int] = {}
    with ThreadPoolExecutor(threads) as pool:
        try:
            for index, case in enumerate(cases):
                if len(under_way) >= 2 * threads:
                    for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                        yield under_way.pop(future), future.result().measures
                under_way[pool.submit(run, case)] = index
            while under_way:
                for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                    yield under_way.pop(future), future.result().measures
        finally:
            for future in under_way:
                future.cancel()


def stable_step_of(loose: Loose) -> float:
    """Largest stable step of the joints as they are closed at the start, and of every block's longest face as a bed [s]."""
    records = loose.records
    body: Any = {name: records.body[name][:, 0] for name in ("x", "z", "im", "ii")}
    joint: Any = {name: records.joint[name][:, 0] for name in ("lc", "ls", "ht", "wl", "wr", "bl", "br", "kn", "ks")}
    xis, shares = records.lane["xi"][0, :, 0], records.lane["sh"][0, :, 0]
    n = len(records.body)
    stiffness = np.zeros((3 * n, 3 * n))
    for k, (lower, upper) in enumerate(records.topology.joints):
        e = {name: values[k] for name, values in joint.items()}
        u, v = (np.array([body["x"][i], body["z"][i]]) for i in (upper, lower))
        t = np.array([e["lc"], e["ls"]])
        normal = np.array([-t[1], t[0]])
        foot = v + e["ht"] * normal
        above = float((u - foot) @ t)
        lo, hi = max(-e["wl"], above - e["bl"]), min(e["wr"], above + e["br"])
        for xi, share in zip(xis, shares, strict=True):
            point = foot + (0.5 * (lo + hi) + 0.5 * xi * (hi - lo)) * t
            for along, stiff in ((normal, e["kn"]), (t, e["ks"])):
                row = np.zeros(3 * n)
                for number, place, sign in ((upper, u, 1.0), (lower, v, -1.0)):
                    arm = point - place
                    row[3 * number : 3 * number + 3] = sign * np.array([*along, arm[0] * along[1] - arm[1] * along[0]])
                stiffness += stiff * (hi - lo) * share * np.outer(row, row)
    omega = highest_frequency(stiffness, np.stack((body["im"], body["im"], body["ii"]), axis=1).ravel())
    for i, block in enumerate(loose.structure.bodies):
        if not block.fixed:
            # between two others on its longest face
            side = np.roll(block.corners, -1, axis=0) - block.corners
            k = (
                float(loose.law[:, :, 0].max())
                * float(loose.shape["depth"][i])
                * float(np.hypot(side[:, 0], side[:, 1]).max())
            )
            omega = max(
                omega,
                0.4 * math.sqrt(4.0 * k * (body["im"][i] + body["ii"][i] * float(loose.shape["r"][i]) ** 2 / 3.0)),
            )
    inverse = np.stack((body["im"], body["im"], body["ii"]), axis=1).ravel()
    beta = float(records.lane["damp"][0, BETA, 0])
    return stable_step(*with_links(stiffness_between(loose.structure, inverse), omega, beta))
