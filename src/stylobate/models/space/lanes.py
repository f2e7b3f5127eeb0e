"""Assemblies in space in lanes, as long as nothing of them comes loose; the others are run one by one."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ...column.structure import Structure
from ...errors import InputError
from ...kernels.run_codes import CHUNK, FAILED, FREE, LANES, RUNNING
from ...kernels.space.lane_records import types
from ...kernels.space.records import GROUND
from ...response import Measures, Response
from ..base import Case, RunOptions
from ..plane.assemblies import measures_of_assemblies
from ..shared.lanes import aligned_zeros, copied, not_computed, run_alike
from .assemblies import Begun, SpatialNumbers, chunks_of, ground_at, response_of, settled, unsettled
from .loose import REST_TIME, REST_WAY, Loose
from .packing import turned_over

#: Cases for each thread from which on lanes are worth it: a block costs as much as two runs, however few are in it.
FEWEST = 4

#: Structures that are kept as they have settled, in each thread.
KEPT = 8

#: Stands for the measures of a run that has to be made alone.
LOOSE = not_computed(InputError("not in lanes"))

#: Fields of a place and of axes, the first of a body's record.
POSE = ("x", "y", "z", "ix", "iy", "iz", "jx", "jy", "jz", "kx", "ky", "kz")

#: Numbers of a lane that the engine's bodies and joints have too.
OF_BODY = (*POSE, "vx", "vy", "vz", "lx", "ly", "lz", "wx", "wy", "wz", "m", "im", "ia", "ic", "ib")
OF_JOINT = (
    "ml", "il", "jl", "mu", "iu", "ju", "f", "d", "gf", "gm", "ra", "rb",
    "rl", "ru", "kn", "ks", "tan", "co", "width", "from_c", "apart_c", "apart", "t", "dt", "kf", "kt", "en",
)  # fmt: skip


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
        for joint in structure.space_joints or ()
    )
    return parts, joints


def measures_in_space(
    run: Callable[..., Response], cases: Sequence[Case], numbers: SpatialNumbers, options: RunOptions, threads: int
) -> Iterator[tuple[int, Measures]]:
    """(index of the case, measures) of runs of assemblies in space as they finish: in lanes what stays intact, then one by
    one, by ``run``, what does not."""
    if options.until_rest or options.start is not None or len(cases) < FEWEST * threads:
        yield from measures_of_assemblies(run, cases, options, threads)
        return
    left: list[tuple[int, Case]] = []
    under_way: dict[int, Case] = {}

    def counted() -> Iterator[Case]:
        for index, case in enumerate(cases):
            under_way[index] = case
            yield case

    def block_of(key: Hashable) -> IntactLanes:
        return IntactLanes(numbers, options, none=key is None)

    for index, measures in run_alike(lambda case: kind(case.column), block_of, counted(), threads):
        case = under_way.pop(index)
        if measures is LOOSE:
            left.append((index, case))
        else:
            yield index, measures
    for k, measures in measures_of_assemblies(run, [case for _, case in left], options, threads):
        yield left[k][0], measures


class Recorded:
    """States of a lane's run so far: times [s], places [m], axes and ledgers [J]."""

    def __init__(self, count: int, bodies: int) -> None:
        self.count = 0
        self.time, self.energy = np.empty(count), np.empty((count, 6))
        self.position, self.axes = np.empty((count, bodies, 3)), np.empty((count, bodies, 3, 3))

    def add(self, time: float, position: np.ndarray, axes: np.ndarray, energy: np.ndarray) -> None:
        """Keep a state."""
        k = self.count
        self.time[k], self.position[k], self.axes[k], self.energy[k] = time, position, axes, energy
        self.count += 1

    def stack(self) -> dict[str, np.ndarray]:
        """All states."""
        return {name: getattr(self, name)[: self.count] for name in ("time", "position", "axes", "energy")}


class IntactLanes:
    """A block of lanes of assemblies that stand; see :class:`stylobate.models.shared.lanes.LaneBlock`.

    Parameters
    ----------
    numbers : SpatialNumbers
    options : RunOptions
    none : bool
        It takes none: each of its cases is for others to run.
    """

    def __init__(self, numbers: SpatialNumbers, options: RunOptions, *, none: bool = False) -> None:
        from ...kernels.space import lanes as kernel

        self.kernel, self.numbers, self.options, self.none = kernel, numbers, options, none
        self.lanes = 1 if none else LANES
        self.begun = lru_cache(KEPT)(self._begun)
        self.state: tuple[Any, ...] = ()
        self.cases: list[Case | None] = [None] * self.lanes
        self.ways: list[Begun | None] = [None] * self.lanes
        self.states: list[Recorded] = [Recorded(0, 0)] * self.lanes
        self.every, self.chunks = np.ones(self.lanes, dtype=int), np.zeros(self.lanes, dtype=int)
        self.status = np.full(self.lanes, FREE)

    def _begun(self, structure: Structure) -> tuple[Begun, np.ndarray | None]:
        """A structure as it has settled, and the gaps between its bodies; None if something is loose from the start."""
        engine = unsettled(structure, self.numbers)
        if self._gaps(engine).min() <= 0.0:
            return Begun(engine, np.zeros(6), None), None
        made, gap = settled(structure, engine), self._gaps(engine)
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
        self.cases[lane], self.status[lane] = case, FAILED
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
        self.states[lane] = Recorded(chunks // every + 2, len(made.engine.body))
        self.status[lane] = RUNNING
        self.stood_at[..., lane], self.stood_since[lane] = np.inf, 0.0
        self._record([lane])

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
        self.stood_at, self.stood_since = np.full((n, 12, self.lanes), np.inf), np.zeros(self.lanes)
        return state

    def _put(self, lane: int, made: Begun, gap: np.ndarray, case: Case, chunks: int) -> None:
        """The numbers of an engine that has settled into a lane."""
        engine, now = made.engine, made.engine.now
        for name in OF_BODY:
            self.body[name][:, lane] = engine.body[name][:, 0]
        for name in OF_JOINT:
            self.joint[name][..., lane] = engine.joint[name]
        self.body["r"][:, lane] = np.where(engine.free, engine.body["r"], 0.0)
        for k, name in enumerate(POSE):
            self.body["o"][:, k, lane] = engine.body[name][:, 0]
        self.corner["x"][:, lane], self.corner["y"][:, lane] = engine.state[9].T
        self.between["gap"][:, lane] = gap[tuple(self.pairs)]
        for name, value in (
            ("dt", engine.dt), ("last", now["last"][0]), ("beta", now["beta"][0]), ("work", now["work"][0]),
            ("shear", now["shear"][0]), ("visc", now["visc"][0]), ("g", now["g"][0]), ("p", 0.0), ("loose", 0),
        ):  # fmt: skip
            self.lane[name][0, ..., lane] = value
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
            self._record(going[(after == due) & (self.status[going] == RUNNING)].tolist())
            if (self.status[going] == FAILED).any() or (after >= self.chunks[going]).any():
                return

    def _done(self) -> np.ndarray:
        return self.feed["step"][0] // CHUNK if self.state else np.zeros(self.lanes, dtype=int)

    def _record(self, lanes: Sequence[int]) -> None:
        """Keep the present states of some lanes."""
        if not lanes:
            return
        n, out, base = len(self.body), np.empty((6, self.lanes)), np.zeros((3, self.lanes))
        times = self.feed["step"][0] * self.lane["dt"][0]
        for lane in lanes:
            made, case = self.ways[lane], self.cases[lane]
            assert made is not None
            assert case is not None
            times[lane] = self.feed["step"][0, lane] * made.engine.dt
            base[:, lane] = ground_at(case.motion, times[lane])
        changed = {0, 1, 5}  # bodies, joints, and what is of lanes
        state = tuple(copied(one) if k in changed else one for k, one in enumerate(self.state))
        self.kernel.energies(state, base, out)
        pose = self.body.view(np.float64).reshape(n, -1)[:, : len(POSE) * self.lanes].reshape(n, len(POSE), self.lanes)
        for lane in lanes:
            made = self.ways[lane]
            assert made is not None
            engine, own = made.engine, pose[:, :, lane]
            place = own[:, :3].copy()
            axes = own[:, 3:].reshape(n, 3, 3).swapaxes(1, 2) @ engine.packed.turn.transpose(0, 2, 1)
            self.states[lane].add(times[lane], place, axes, out[:, lane])
            self._look_for_rest(lane, engine, place, axes, times[lane])

    def _look_for_rest(self, lane: int, engine: Loose, place: np.ndarray, axes: np.ndarray, time: float) -> None:
        """As :meth:`Loose.at_rest` looks for it, of bodies none of which falls for ever."""
        here = np.concatenate((place, axes.reshape(-1, 9) * engine.body["r"][:, None]), axis=1)
        if np.abs(here - self.stood_at[..., lane])[engine.free].max() > REST_WAY * engine.smallest:
            self.stood_at[..., lane], self.stood_since[lane] = here, time

    # -- how it ends -----------------------------------------------------------------------------------------------

    def is_over(self, lane: int) -> bool:
        """Whether a lane's run has ended, or has to be made alone."""
        return bool(self.status[lane] == FAILED or self._done()[lane] >= self.chunks[lane])

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run has ended, or :data:`LOOSE`; the lane is free afterwards."""
        case, made, intact = self.cases[lane], self.ways[lane], self.status[lane] == RUNNING
        self.status[lane] = FREE
        if self.state:
            self.watch["status"][0, lane] = FREE
            self.lane["dt"][0, lane] = 0.0
        if not intact:
            return LOOSE
        assert case is not None
        assert made is not None
        stack = self.states[lane].stack()
        still = bool(stack["time"][-1] - self.stood_since[lane] > REST_TIME)
        if self.options.until_decided and not still:
            return LOOSE
        response = response_of(case.column, case.motion, self.numbers, made, stack, still=still)
        return LOOSE if response.measures.collapsed else response.measures
