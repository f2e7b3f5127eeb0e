"""Assemblies in space: their engine, and their lanes, in which they ride as long as nothing of them comes loose."""

from __future__ import annotations

import itertools
import math
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import fields, replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ...column import Column
from ...column.spatial.assembly import SpatialAssembly
from ...column.spatial.stone import Stone
from ...column.structure import Structure
from ...errors import InputError
from ...kernels.run_codes import CHUNK, FAILED, FREE, LANES, RUNNING
from ...kernels.space.lane_records import types
from ...kernels.space.records import GROUND
from ...motion import Motion
from ...response import Measures, Response
from ...response.assemblies import fallen
from ..base import Case, RunOptions
from ..drums.impact import TRIED, longest, undamped
from ..drums.stepped import StackEngine, SteppedEngine, with_provenance
from ..plane.loose import one_by_one
from ..shared.lanes import GoesOn, aligned_zeros, copied, run_alike
from .loose import (
    COST,
    REST_TIME,
    REST_WAY,
    Loose,
    StartState,
    chunks_of,
    engine_of,
    go_on,
    lane_as_drawn,
    lane_at_rest,
    response_of,
    run_in_space,
    step_for,
)
from .packing import turned_over

#: Structures that are kept as they have settled, in each thread.
KEPT = 8

#: Fields of a place and of axes, the first of a body's record.
POSE = ("x", "y", "z", "ix", "iy", "iz", "jx", "jy", "jz", "kx", "ky", "kz")

#: Numbers of a lane that the engine's bodies and joints, and ``now``, have too: they go there and back.
OF_BODY = (*POSE, "vx", "vy", "vz", "lx", "ly", "lz", "wx", "wy", "wz", "m", "im", "ia", "ic", "ib")
OF_JOINT = (
    "ml", "il", "jl", "mu", "iu", "ju", "f", "d", "gf", "gm", "n", "ra", "rb",
    "rl", "ru", "kn", "ks", "tan", "co", "width", "from_c", "apart_c", "apart", "t", "dt", "kc", "jc", "en",
    "s", "st", "at", "fs", "ft", "kf", "jf",
)  # fmt: skip
OF_NOW = ("last", "beta", "work", "shear", "visc", "g")


def kind(structure: Structure) -> Hashable:
    """What assemblies in one block have in common; None of one that lanes do not take."""
    if structure.placed_links:
        return None
    bodies: tuple[Any, ...] = tuple(structure.bodies)
    parts = tuple((body.fixed, len(getattr(body, "pieces", None) or ())) for body in bodies)

    def corners(face: Any) -> int:
        return 0 if face.edges.discs and not len(face.edges.sides) else len(face.corners)

    joints = tuple(
        (
            (joint.lower, joint.upper, joint.lower_part, joint.upper_part, turned_over(joint)),
            (corners(joint.below), corners(joint.above)),
        )
        for joint in structure.joined_faces
    )
    return parts, joints


def measures_in_space(
    model: Any, cases: Sequence[Case], options: RunOptions, threads: int
) -> Iterator[tuple[int, Measures]]:
    """(index of the case, measures) of runs of assemblies in space as they finish: in lanes as long as they are intact.

    Runs until rest are made one by one; their histories are kept: the verdict rests on the ledger. However few there are,
    others ride: what a run comes to does not hang on how many are left of a batch that was stopped, nor on the number of
    threads.
    """
    if options.until_rest:
        yield from one_by_one(lambda case: run_in_space(*case, model.acting(case.column), options), cases, threads)
        return

    def block_of(key: Hashable) -> IntactLanes:
        return IntactLanes(model, options, none=key is None)

    yield from run_alike(lambda case: kind(case.column), block_of, cases, threads)


def of_lanes(records: np.ndarray) -> np.ndarray:
    """Fields of records that have a value for each lane, as rows that change with them, shape (records, fields, lanes)."""
    kinds: Any = records.dtype.fields
    fields = [(at, kind.itemsize) for kind, at, *_ in kinds.values() if kind.shape[-1:] == (LANES,)]
    first, end = min(at for at, _ in fields), max(at + size for at, size in fields)
    whole = records.view(np.float64).reshape(len(records), -1)
    return whole[:, first // 8 : end // 8].reshape(len(records), -1, LANES)


class Recorded:
    """States of a lane's run so far: times [s], places and principal axes of its bodies, ledgers [J].

    ``turn`` is that of :class:`Packed`.
    """

    def __init__(self, count: int, bodies: int, turn: np.ndarray) -> None:
        self.count, self.turn = 0, turn
        self.time, self.energy, self.pose = np.empty(count), np.empty((count, 6)), np.empty((count, bodies, len(POSE)))

    def add(self, time: float, pose: np.ndarray, energy: np.ndarray) -> None:
        """Keep a state."""
        k = self.count
        self.time[k], self.pose[k], self.energy[k] = time, pose, energy
        self.count += 1

    def stack(self) -> dict[str, np.ndarray]:
        """All states: times [s], places [m], axes in which the bodies were given, ledgers [J]."""
        k = self.count
        axes = self.pose[:k, :, 3:].reshape(k, -1, 3, 3).swapaxes(2, 3) @ self.turn.transpose(0, 2, 1)
        return {"time": self.time[:k], "position": self.pose[:k, :, :3], "axes": axes, "energy": self.energy[:k]}


class HandedOver(NamedTuple):
    """A run as a lane has kept it last, from where the engine of what is loose goes on with it.

    Parameters
    ----------
    case : Case
    model : DistinctElement3D
        With what acts in the run.
    options : RunOptions
    made : StartState
        How it began; its engine is that of all lanes with this structure.
    states : Recorded
    records : tuple of three dicts of str to array
        Fields of its bodies, its joints and what is of the lane, without lanes.
    step : int
        Steps done.
    stood_at, stood_since : array, float
        As of :class:`Loose`.
    """

    case: Case
    model: Any
    options: RunOptions
    made: StartState
    states: Recorded
    records: tuple[dict[str, np.ndarray], dict[str, np.ndarray], dict[str, np.ndarray]]
    step: int
    stood_at: np.ndarray
    stood_since: float

    def measures(self) -> Measures:
        """Go on to the end of the run."""
        structure, motion = self.case
        engine = lane_as_drawn(structure, self.model)
        engine.take_over(*self.records, self.step)
        engine.stood_at, engine.stood_since = self.stood_at, self.stood_since
        stack = self.states.stack()
        states = [dict(zip(stack, row, strict=True)) for row in zip(*stack.values(), strict=True)]
        made = self.made._replace(engine=engine)
        return go_on(structure, motion, self.model, self.options, made, states).measures


class IntactLanes:
    """A block of lanes of assemblies that stand; see :class:`stylobate.models.shared.lanes.LaneBlock`.

    Parameters
    ----------
    model : DistinctElement3D
    options : RunOptions
    none : bool
        It takes none: each of its cases is run alone.
    """

    def __init__(self, model: Any, options: RunOptions, *, none: bool = False) -> None:
        from ...kernels.space import lanes as kernel

        self.kernel, self.model, self.options, self.none = kernel, model, options, none
        self.lanes = 1 if none else LANES
        self.begun = lru_cache(KEPT)(self._begun)
        self.state: tuple[Any, ...] = ()
        self.cases: list[Case | None] = [None] * self.lanes
        self.ways: list[StartState | None] = [None] * self.lanes
        self.states: list[Recorded | None] = [None] * self.lanes
        self.every, self.chunks = np.ones(self.lanes, dtype=int), np.zeros(self.lanes, dtype=int)
        self.status = np.full(self.lanes, FREE)

    def _begun(self, structure: Structure) -> tuple[StartState, np.ndarray | None]:
        """A structure as it has settled, and the gaps between its bodies; None if something is loose from the start."""
        engine = lane_as_drawn(structure, self.model.acting(structure))
        if self._gaps(engine).min() <= 0.0:
            return StartState(engine, np.zeros(6), None), None
        made, gap = lane_at_rest(structure, engine), self._gaps(engine)
        intact = made.balanced and gap.min() > 0.0 and bool((engine.joint["weight"] == 1.0).all())
        return made, gap if intact else None

    def _gaps(self, engine: Loose) -> np.ndarray:
        """Gaps between any two bodies, infinite where a joint holds them or neither can move [m], shape (N, N)."""
        gap = np.full((len(engine.body),) * 2, np.inf)
        self.kernel.gaps(engine.state, gap)
        gap[np.ix_(~engine.free, ~engine.free)] = np.inf
        return gap

    # -- how a run begins ------------------------------------------------------------------------------------------

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane that is free."""
        case = case.multiplied
        self.cases[lane], self.states[lane], self.status[lane] = case, None, FAILED
        if self.none:
            return
        made, gap = self.begun(case.column)
        chunks, every = chunks_of(case.column, case.motion, made.engine, self.options)
        if gap is None:
            return
        if not self.state:
            self.state = self._records(made.engine)
        self._put(lane, made, gap, case, chunks)
        self.ways[lane], self.every[lane], self.chunks[lane] = made, every, chunks
        self.states[lane] = Recorded(chunks // every + 2, len(made.engine.body), made.engine.packed.turn)
        self.status[lane] = RUNNING
        self._record(np.array([lane]))

    def _records(self, engine: Loose) -> tuple[Any, ...]:
        """Records for bodies and joints as an engine has them."""
        kinds, n, edge = types(), len(engine.body), engine.state[9]
        joined, shape = engine.joint, engine.packed.shape
        self.pairs = np.stack(np.triu_indices(n, 1))
        counts = {
            "body": n, "joint": len(joined), "corner": len(edge), "spot": max(int(joined["many_u"].max(initial=0)), 1),
            "between": self.pairs.shape[1], "ground": CHUNK + 1,
        }  # fmt: skip
        names = ["body", "joint", "corner", "spot", "between", "lane", "ground", "feed", "watch", "work"]
        state = tuple(aligned_zeros(counts.get(name, 1), kinds[name.replace("spot", "corner")]) for name in names)
        self.body, self.joint, self.corner, _, self.between, self.lane, _, self.feed, self.watch, _ = state
        self.body["fixed"] = engine.body["fixed"]
        for name in ("first_l", "many_l", "first_u", "many_u"):
            self.joint[name] = joined[name]
        self.joint["lower"], self.joint["upper"] = shape["body"][joined["a"]], shape["body"][joined["b"]]
        self.joint["level"] = shape["kind"][joined["a"]] == GROUND
        self.between["lower"], self.between["upper"] = self.pairs
        self.watch["status"], self.watch["when"] = FREE, -1
        self.free, self.smallest, self.dt = engine.free, np.zeros(self.lanes), np.zeros(self.lanes)
        self.turn, self.arm = np.zeros((n, 3, 3, self.lanes)), np.zeros((n, 1, 1, self.lanes))
        self.stood_at, self.stood_since = np.full((n, 4, 3, self.lanes), np.inf), np.zeros(self.lanes)
        changing = self.body, self.joint, self.lane
        self.kept = tuple(aligned_zeros(len(array), array.dtype) for array in changing)
        self.rows = [(of_lanes(array), of_lanes(kept)) for array, kept in zip(changing, self.kept, strict=True)]
        return state

    def _put(self, lane: int, made: StartState, gap: np.ndarray, case: Case, chunks: int) -> None:
        """The numbers of an engine that has settled into a lane."""
        engine, now = made.engine, made.engine.now
        for name in OF_BODY:
            self.body[name][:, lane] = engine.body[name][:, 0]
        for name in OF_JOINT:
            self.joint[name][..., lane] = engine.joint[name]
        for name in OF_NOW:
            self.lane[name][0, ..., lane] = now[name][0]
        self.body["r"][:, lane] = np.where(engine.free, engine.body["r"], 0.0)
        for k, name in enumerate(POSE):
            self.body["o"][:, k, lane] = engine.body[name][:, 0]
        self.corner["x"][:, lane], self.corner["y"][:, lane] = engine.state[9].T
        self.between["gap"][:, lane] = gap[tuple(self.pairs)]
        for name, value in (("dt", engine.dt), ("p", 0.0), ("loose", 0)):
            self.lane[name][0, ..., lane] = value
        self.turn[..., lane], self.arm[..., 0, 0, lane] = engine.packed.turn, engine.body["r"]
        self.dt[lane], self.smallest[lane] = engine.dt, engine.smallest
        self.stood_at[..., lane], self.stood_since[lane] = np.inf, 0.0
        feed, motion = self.feed[0], case.motion
        for name, samples in (("x", motion.samples), ("y", motion.y_samples), ("z", motion.z_samples)):
            feed[name][lane] = 0 if samples is None else samples.ctypes.data
        feed["last"][lane], feed["ratio"][lane] = motion.steps - 1, engine.dt / motion.dt
        feed["factor"][lane], feed["r"][:, lane] = motion.factor, np.eye(3).ravel()
        feed["step"][lane], feed["end"][lane] = 0, chunks * CHUNK
        self.watch["status"][0, lane] = RUNNING

    # -- how it goes on --------------------------------------------------------------------------------------------

    def advance(self) -> None:
        """Advance all lanes to where the next state of one of them is kept, again and again until a run is over."""
        for _ in range(LANES):
            going = np.flatnonzero((self.status == RUNNING) & (self._done() < self.chunks))
            if not len(going):
                return
            done = self._done()[going]
            due = np.minimum(done - done % self.every[going] + self.every[going], self.chunks[going])
            self.kernel.advance(self.state, int((due - done).min()))
            self.status[going] = np.where(self.watch["status"][0, going] == FAILED, FAILED, RUNNING)
            after = self._done()[going]
            self._record(going[(after == due) & (self.status[going] == RUNNING)])
            if (self.status[going] == FAILED).any() or (after >= self.chunks[going]).any():
                return

    def _done(self) -> np.ndarray:
        return self.feed["step"][0] // CHUNK if self.state else np.zeros(self.lanes, dtype=int)

    def _record(self, lanes: np.ndarray) -> None:
        """Keep the present states of some lanes: for measures, and whole, for whoever may have to go on with the run."""
        if not len(lanes):
            return
        which, out = np.zeros(self.lanes, dtype=bool), np.empty((6, self.lanes))
        which[lanes] = True
        for array, kept in self.rows:
            np.copyto(kept, array, where=which)
        changed = {0, 1, 5}  # bodies, joints, and what is of lanes
        state = tuple(copied(array) if k in changed else array for k, array in enumerate(self.state))
        self.kernel.energies(state, which, out)
        pose = self.rows[0][0][:, : len(POSE)]
        times = self.feed["step"][0] * self.dt
        for lane in lanes:
            states = self.states[lane]
            assert states is not None
            states.add(times[lane], pose[..., lane], out[:, lane])
        self._look_for_rest(which, pose, times)

    def _look_for_rest(self, which: np.ndarray, pose: np.ndarray, times: np.ndarray) -> None:
        """As :meth:`Loose.at_rest` looks for it, of bodies none of which falls for ever."""
        here = pose.reshape(len(pose), 4, 3, self.lanes).copy()
        here[:, 1:] = np.einsum("nacl,nbal->ncbl", here[:, 1:], self.turn) * self.arm
        moved = np.abs(here - self.stood_at)[self.free].max(axis=(0, 1, 2)) > REST_WAY * self.smallest
        np.copyto(self.stood_at, here, where=moved & which)
        np.copyto(self.stood_since, times, where=moved & which)

    # -- how it ends -----------------------------------------------------------------------------------------------

    def is_over(self, lane: int) -> bool:
        """Whether a lane's run has ended, or has to go on alone."""
        return bool(self.status[lane] == FAILED or self._done()[lane] >= self.chunks[lane])

    def collect(self, lane: int) -> Measures | GoesOn:
        """Measures of a lane whose run has ended, or what goes on with it alone; the lane is free afterwards."""
        case, made, states, intact = self.cases[lane], self.ways[lane], self.states[lane], self.status[lane] == RUNNING
        assert case is not None
        self.status[lane] = FREE
        if states is None:
            return lambda: run_in_space(*case, self.model.acting(case.column), self.options).measures
        assert made is not None
        self.watch["status"][0, lane] = FREE
        self.lane["dt"][0, lane] = 0.0
        stack = states.stack()
        still = bool(stack["time"][-1] - self.stood_since[lane] > REST_TIME)
        poses = (stack[name][k] for k in (0, -1) for name in ("position", "axes"))
        waits = self.options.until_decided and not still and not fallen(case.column, *poses).any()
        if intact and not waits:
            return response_of(*case, self.model.acting(case.column), made, stack, still=still).measures
        return self._handed_over(lane, case, made, states).measures

    def _handed_over(self, lane: int, case: Case, made: StartState, states: Recorded) -> HandedOver:
        """A lane's run as it was kept last."""
        body, joint, now = (
            {name: kept[name][..., lane].copy() for name in names}
            for names, kept in zip((OF_BODY, OF_JOINT, OF_NOW), self.kept, strict=True)
        )
        step = round(float(states.time[states.count - 1]) / made.engine.dt)
        stood = self.stood_at[..., lane].reshape(-1, len(POSE)), float(self.stood_since[lane])
        return HandedOver(
            case, self.model.acting(case.column), self.options, made, states, (body, joint, now), step, *stood
        )


def rocking_stone(body: Column, model: Any, tilt: float) -> Iterator[np.ndarray]:
    """Leans of a stone of the same sides; see :data:`stylobate.models.drums.impact.Rocking`."""
    drum, foot = body.drums[0], (0.0, 0.0, 0.0)
    width, height = drum.bottom_width, drum.height
    if drum.section == "circular":
        stone = Stone.drum(width, drum.top_width, height, foot, drum.density, name=body.name)
    else:
        stone = Stone.box((width, drum.depth, height), foot, drum.density, name=body.name)
    alone = SpatialAssembly((stone,), body.joint_laws[0], gravity=body.gravity)
    lanes = IntactLanes(replace(model, **undamped()), RunOptions())
    case = Case(alone, longest(alone))
    for lane in range(len(TRIED)):
        lanes.load(lane, case)
    _lean(lanes, tilt, 0.5 * width)
    lanes.lane["beta"][0, : len(TRIED)] = TRIED
    while not lanes.is_over(0):
        lanes.kernel.advance(lanes.state, 1)
        yield np.arcsin(_axes(lanes)[: len(TRIED), 0, 2])


def _axes(lanes: IntactLanes) -> np.ndarray:
    """Axes of the stone in each lane as columns, shape (lanes, 3, 3)."""
    stone = lanes.body[1]
    principal = np.array([[stone[axis + c] for axis in "ijk"] for c in "xyz"])
    return np.einsum("cal,bal->lcb", principal, lanes.turn[1])


def _lean(lanes: IntactLanes, tilt: float, half: float) -> None:
    """Turn the stone in all lanes about its edge (or the point of its rim) at ``half`` towards +x."""
    stone, (c, s) = lanes.body[1], (math.cos(tilt), math.sin(tilt))
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    principal = np.einsum("dc,lcb,bal->dal", turn, _axes(lanes), lanes.turn[1])
    for (d, name), (a, axis) in itertools.product(enumerate("xyz"), enumerate("ijk")):
        stone[axis + name][:] = principal[d, a]
    stone["x"][:], stone["z"][:] = half - half * c + stone["z"] * s, half * s + stone["z"] * c


class BodiesInSpace(SteppedEngine):
    """Assemblies in space: in lanes as long as nothing of them comes loose, one by one from there on."""

    computes = (SpatialAssembly,)
    takes = frozenset({"as found", "rings"})
    links = StackEngine.links | {"clamp"}
    rocking = staticmethod(rocking_stone)

    #: Parameters of a model in space that act on columns alone.
    of_columns = ("law", "pivot_friction", "rolling_resistance", "planar", "block_modulus", "mass_damping")

    def check(self, motion: Motion) -> None:
        """Refuse parameters that do nothing."""
        super().check(motion)
        default = {field.name: field.default for field in fields(self.model)}
        given = next((name for name in self.of_columns if getattr(self.model, name) != default[name]), None)
        if given is not None:
            name = self.structure.name
            raise InputError(
                f"{given} is {getattr(self.model, given)!r}, which assemblies in space such as {name!r} do not know; "
                "leave it out."
            )

    def check_start(self) -> None:
        """Refuse a start from a pose."""
        what = self.structure
        raise InputError(
            f"a start from a pose is for columns, and {what.name!r} is {what.described}; give its bodies "
            "orientations and velocities, and leave start out."
        )

    def check_length(self, motion: Motion, options: RunOptions) -> None:
        """The step of what may come loose is known once its contacts are: each run asks for itself."""

    def followed(self) -> SpatialAssembly:
        """The assembly: any two bodies may strike each other."""
        return self.structure

    def expected_step(self, motion: Motion) -> tuple[float, float]:
        """Time step, and about what a step costs on one core as long as all stands, both [s]; what falls is dearer."""
        del motion
        loose = engine_of(self.structure, self.acting, 1.0)
        return step_for(loose, self.structure, self.acting), COST * len(loose.body)

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories, down to the ground."""
        return with_provenance(self, motion, run_in_space(self.structure, motion, self.acting, options))

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs in lanes, as long as nothing comes loose."""
        return measures_in_space(self.model, cases, options, threads)
