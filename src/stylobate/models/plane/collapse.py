"""A column followed to the ground: the plane distinct elements of a single run, with every pair of drums in contact."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...column import Column
from ...constants import LONGEST_WAIT
from ...kernels.run_codes import CHUNK, COLLAPSED, FAILED, RUNNING
from ...motion import Motion
from ...response import Collapse, Histories, Measures, Response
from ...response.assemblies import first_touch
from ...response.collapse import SLID_OFF
from ...response.mechanism import find_mechanism
from ..base import Case, RunOptions, given_back
from ..drums.runs import FinalStates, histories
from .columns import ColumnLanes, residuals_in
from .loose import ENDLESS, Loose
from .packing import OF_BODY


def follow(column: Column, motion: Motion, block: ColumnLanes, model: Any, options: RunOptions) -> Response:
    """One run of a column in which drums may strike one another and the ground.

    Until bodies that are no neighbours come close to each other, or a joint is close to handing over, this is the run
    of ``DistinctElement2D`` bit by bit; the verdict has the same definition throughout.

    Parameters
    ----------
    column : Column
    motion : Motion
    block : ColumnLanes
        Lanes for the column, that go on after a collapse.
    model : DistinctElement2D
        With what acts in the run.
    options : RunOptions
        A run goes on after its collapse with ``until_end``, and after the motion until everything lies still with
        ``until_rest``.
    """
    run = _ColumnRun(column, motion, block, model, options)
    engine = run.engine
    every = max(1, min(engine.chunks, round(options.output_interval / (CHUNK * engine.dt))))
    residual = engine.residual_acceleration()
    states = [run.state()]
    while not run.is_over():
        remaining = run.chunks_left()
        run.advance(min(every, remaining) if remaining > 0 else every)
        states.append(run.state())
    return run.response(states, residual)


class _ColumnRun:
    """A column in the lanes as long as only neighbours can touch, in the engine of assemblies from there on."""

    def __init__(self, column: Column, motion: Motion, block: ColumnLanes, model: Any, options: RunOptions) -> None:
        motion = motion.multiplied
        self.column, self.motion, self.block, self.name, self.options = column, motion, block, model.name, options
        self.restitution = given_back(model)
        block.load(0, Case(column, motion))
        duration = motion.duration + options.tail
        self.engine = engine = Loose(column, model, motion, duration, self.restitution)
        engine.start(block.packed[0].step)
        self.loose, self.ahead = False, 0
        self.take_over()
        self.start = block.start[0].copy()
        self.resting = False

    def take_over(self) -> None:
        """State of the lanes into the engine: the numbers of the lanes to the last bit, not those of the drawing."""
        there, here = self.block.records, self.engine.records
        for name in OF_BODY:
            here.body[name][:, 0] = there.body[name][:, 0]
        for name in there.joint.dtype.names or ():
            if there.joint[name].shape[:-1] == here.joint[name].shape[:-1]:
                here.joint[name][..., 0] = there.joint[name][..., 0]
        for name in ("work", "shear", "visc", "g", "gx", "xi", "sh"):
            here.lane[name][..., 0] = there.lane[name][..., 0]
        tied = ((here.link, there.link),) if len(there.link) else ()
        for target, source in ((here.feed, there.feed), (here.watch, there.watch), *tied):
            for name in target.dtype.names or ():
                target[name][..., 0] = source[name][..., 0]
        here.bond[...] = there.bond
        here.feed["end"] = ENDLESS
        self.engine.renew_pairs()

    def give_back(self) -> None:
        """State of the engine into the lanes, where it is looked at."""
        there, here = self.block.records, self.engine.records
        for name in OF_BODY:
            there.body[name][:, 0] = here.body[name][:, 0]
        tied = ((here.link, there.link),) if len(there.link) else ()
        for source, target in ((here.watch, there.watch), *tied):
            for name in source.dtype.names or ():
                target[name][..., 0] = source[name][..., 0]
        there.feed["step"][0, 0] = here.feed["step"][0, 0]

    def advance(self, chunks: int) -> None:
        """Advance by some chunks of steps, in pieces short enough that nothing comes loose unseen."""
        while chunks > 0 and not self.engine.failed:
            if self.loose:
                # with the verdict given, joints between fallen drums need not ring for ever either
                self.engine.now["dull"] = self.engine.now["eta"] if self.collapsed else 0.0
                self.engine.advance(chunks)
                self.give_back()
                return
            if self.block.is_over(0):  # the lanes end with the motion; what goes on after it is the engine's
                self.watch_on()
                self.take_over()
                self.loose = True
                continue
            if self.ahead <= 0:
                self.look_ahead()
                continue
            piece = min(chunks, self.ahead)
            before = int(self.block.feed["step"][0, 0])
            self.block.advance(piece)
            chunks -= (int(self.block.feed["step"][0, 0]) - before) // self.block.chunk
            self.ahead -= piece

    def watch_on(self) -> None:
        """Go on after the motion, and look for collapses; nothing of it is left to set against them."""
        watch = self.block.watch[0]
        if watch["status"][0] != FAILED:
            watch["status"][0] = RUNNING
            watch["amax"][0] = watch["vmax"][0] = 0.0

    def look_ahead(self) -> None:
        """Number of chunks that the lanes can go on alone; none: the engine takes over."""
        self.take_over()
        self.ahead = self.engine.chunks_ahead()
        self.loose = self.ahead == 0

    def chunks_left(self) -> int:
        """Chunks until the end of the motion and its tail."""
        step = self.engine.steps if self.loose else int(self.block.feed["step"][0, 0])
        return self.engine.chunks - step // CHUNK

    @property
    def collapsed(self) -> bool:
        """Whether a collapse is certain."""
        return bool(self.block.watch["when"][0, 0] >= 0)

    def is_over(self) -> bool:
        """Whether the run ends here."""
        engine, options = self.engine, self.options
        if engine.failed or (self.collapsed and not options.until_end and not options.until_rest):
            return True
        if self.chunks_left() > 0:
            return False
        self.resting = engine.at_rest()
        return not options.until_rest or self.resting or engine.time > engine.duration + LONGEST_WAIT

    def state(self) -> dict[str, Any]:
        """Everything that a history keeps of the present state."""
        if not self.loose:
            return self.block.snapshot(0)
        return self.block.snapshot(0) | {"time": self.engine.time, "energy": self.engine.energies()}

    def response(self, states: list[dict[str, Any]], residual: float) -> Response:
        """The run as a response; what is special to it stands in its provenance."""
        run_histories = histories(self.motion, states)
        measures = self.measures(states[-1], run_histories)
        engine, lost = self.engine, self.block.collapse(0) if self.collapsed else None
        mechanism = find_mechanism(
            self.column,
            run_histories,
            measures,
            0 if lost is None else lost.joint or 0,
            slid_off=lost is not None and lost.mechanism == SLID_OFF,
            at_rest=self.resting if self.options.until_rest else None,
        )
        provenance = {
            "time_step_s": engine.dt,
            "residual_acceleration_at_start_m_s2": residual,
            "restitution": self.restitution,
            "deepest_penetration_m": engine.deepest(),
            "first_foreign_contact_s": self.touched_at,
        }
        return Response(self.column, run_histories, measures, self.name, provenance, mechanism=mechanism, followed=True)

    @property
    def touched_at(self) -> float | None:
        """When bodies that are no neighbours touched first [s]."""
        step = int(self.engine.now["touched"][0])
        return step * self.engine.dt if step >= 0 else None

    def collapse(self, run_histories: Histories) -> Collapse:
        """The collapse, with what touched first."""
        lost, when = self.block.collapse(0), self.touched_at
        if when is None:
            return lost
        bodies = self.column.bodies
        poses = np.zeros((3, len(run_histories.time), len(bodies)))
        poses[:2] = np.array([body.place for body in bodies]).T[:, None]
        poses[:, :, 1:] += (run_histories.drum_x, run_histories.drum_z, run_histories.drum_rotation)
        x, z, rotation = poses
        return replace(lost, touched=first_touch(self.column, run_histories.time, x, z, rotation, when))

    def measures(self, last: dict[str, Any], run_histories: Histories) -> Measures:
        """Measures of the run; peaks end with a collapse, as in the lanes."""
        block, watch = self.block, self.block.watch[0]
        if self.collapsed and watch["status"][0] != FAILED:
            watch["status"][0] = COLLAPSED
        residual = float(run_histories.top_displacement[-1])
        change = last["energy"] - self.start
        residuals, slip = residuals_in(last), block.poses([0])["slip"]
        offset = np.array([residuals.slips])
        final = FinalStates([residuals], offset, slip, np.array([residual]), block.peaks([0], "turn"))
        (measures,) = block.measures([0], final, since=change[None])
        return measures if measures.collapse is None else replace(measures, collapse=self.collapse(run_histories))
