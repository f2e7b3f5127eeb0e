"""A column followed to the ground: the plane distinct elements of a single run, with every pair of drums in contact."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...column import Column
from ...column.as_blocks import of_column
from ...column.found_geometry import drum_outline
from ...kernels.run_codes import CHUNK, ENDED, RUNNING
from ...motion import Motion
from ...outcome import Outcome, classify
from ...response import Collapse, Histories, Measures, Response
from ...response.assembly_measures import first_touch
from ...response.collapse import SLID_OFF
from ...response.mechanism import find_mechanism
from ..assembly.engine import LONGEST_WAIT, RESTITUTION_TO_REST, Contacts, Engine
from ..base import Case, RunOptions
from ..drums.block import DrumBlock
from ..drums.histories import histories, ledger_imbalance
from ..drums.standing import stands_for_good
from ..shared import ledger

#: The lanes go on for as long as nothing can come loose: the longest of these times [s].
AHEAD = (0.08, 0.04, 0.02, 0.01)


@dataclass(frozen=True, eq=False)
class FollowedColumn:
    """What a column that may fall is computed with.

    Parameters
    ----------
    name : str
        Of the model, for the response.
    block : DrumBlock
        Lanes for the column, that go on after a collapse.
    contacts : Contacts
    bed : array, shape (n, 2)
        k_n and k_s of the faces of each drum [N/m³]: as soft as its joint.
    step : float
        Time step [s].
    restitution : float or None
        Of contacts between drums that are not joined; by default 1, and 0.3 in a run until rest.
    """

    name: str
    block: DrumBlock
    contacts: Contacts
    bed: np.ndarray
    step: float
    restitution: float | None


def follow(
    column: Column,
    motion: Motion,
    numbers: FollowedColumn,
    options: RunOptions,
    steps: Sequence[tuple[float, float]] = (),
) -> Response:
    """One run of a column in which drums may strike one another and the ground.

    Until bodies that are no neighbours come close to each other, or a joint is close to handing over, this is the run
    of ``DistinctElement2D`` bit by bit; the verdict has the same definition throughout.

    Parameters
    ----------
    column : Column
    motion : Motion
    numbers : FollowedColumn
    options : RunOptions
        A run goes on after its collapse with ``until_end``, and after the motion until everything lies still with
        ``until_rest``.
    steps : sequence of (float, float)
        Width and height of the steps under the column, from the top down [m]; a half-plane if none.
    """
    run = _ColumnRun(column, motion, numbers, options, steps)
    engine = run.engine
    every = max(1, min(engine.chunks, round(options.output_interval / (CHUNK * engine.dt))))
    residual = engine.residual_acceleration()
    states = [run.state()]
    while not run.is_over():
        left = run.chunks_left()
        run.advance(min(every, left) if left > 0 else every)
        states.append(run.state())
    return run.response(states, residual)


class _ColumnRun:
    """A column in the lanes as long as only neighbours can touch, in the engine of assemblies from there on."""

    def __init__(
        self,
        column: Column,
        motion: Motion,
        numbers: FollowedColumn,
        options: RunOptions,
        steps: Sequence[tuple[float, float]],
    ) -> None:
        self.column, self.motion, self.name, self.options = column, motion, numbers.name, options
        self.restitution = numbers.restitution
        if self.restitution is None:
            self.restitution = RESTITUTION_TO_REST if options.until_rest else 1.0
        self.block = block = numbers.block
        self.damped = block.joint["dn"].shape[1] > 1
        block.load(0, Case(column, motion))
        duration = motion.duration + options.tail
        self.engine = engine = Engine(of_column(column, steps), numbers.contacts, motion, duration, self.restitution)
        joint, drum = engine.joint, block.drum
        # the numbers of the lanes to the last bit, not those of the drawing
        joint["ht"], joint["hb"] = drum["ht"][:-1, 0], drum["hb"][1:, 0]
        joint["bl"], joint["br"] = drum["bl"][1:, 0], drum["br"][1:, 0]
        joint["lc"], joint["ls"], joint["uc"], joint["us"] = drum["fc"][:-1, 0], drum["fs"][:-1, 0], 1.0, 0.0
        joint["wl"][1:] = joint["wr"][1:] = drum["t"][1:-1, 0]
        if steps:
            drum["t"][0, 0] = joint["wl"][0]
        engine.now["xi"], engine.now["sh"] = block.lane["xi"][0, :, 0], block.lane["sh"][0, :, 0]
        engine.now["g"], engine.now["gx"] = block.lane["g"][0, 0], block.lane["gx"][0, 0]
        engine.now["bc"], engine.now["bs"] = block.feed["bc"][0, 0], block.feed["bs"][0, 0]
        for i in range(column.n):
            first, count = engine.body["first"][i + 1], engine.body["count"][i + 1]
            engine.corner[first : first + count] = drum_outline(column, i)
        engine.law[:, 1 : column.n + 1, :2] = numbers.bed
        engine.stack = (block.drum, block.joint, block.lane, block.feed, block.watch)
        engine.start(numbers.step)
        self.loose, self.safe = False, 0
        self.take_over()
        self.start = block.start[0].copy()
        self.resting = False

    def take_over(self) -> None:
        """State of the lanes into the engine."""
        engine, drum, n = self.engine, self.block.drum, self.column.n + 1
        for name in ("x", "z", "th", "c", "s", "vx", "vz", "w", "m", "i", "im", "ii"):
            engine.body[name][:n] = drum[name][:, 0]
        for name in ("kn", "ks", "co", "mu", "fs", "fn", *(("dn", "ds") if self.damped else ())):
            engine.joint[name][:] = self.block.joint[name][:-1, ..., 0]
        for name in ("work", "shear", "visc"):
            engine.now[name] = self.block.lane[name][0, 0]
        engine.now["step"] = self.block.feed["step"][0, 0]
        engine.renew_pairs()

    def advance(self, chunks: int) -> None:
        """Advance by some chunks of steps, in pieces short enough that nothing comes loose unseen."""
        while chunks > 0 and not self.engine.failed:
            if self.loose:
                # with the verdict given, joints between fallen drums need not ring for ever either
                self.engine.now["dull"] = self.engine.now["eta"] if self.collapsed else 0.0
                self.engine.advance(chunks)
                return
            if self.block.is_over(0):  # the lanes end with the motion; what goes on after it is the engine's
                self.take_over()
                self.loose = True
                self.watch_on()
                continue
            if self.safe <= 0:
                self.look_ahead()
                continue
            piece = min(chunks, self.safe)
            before = int(self.block.feed["step"][0, 0])
            self.block.advance(piece)
            chunks -= (int(self.block.feed["step"][0, 0]) - before) // self.block.chunk
            self.safe -= piece

    def watch_on(self) -> None:
        """Look for collapses after the motion too; nothing of it is left to set against them."""

        watch = self.block.watch[0]
        if watch["status"][0] == ENDED:
            watch["status"][0] = RUNNING
            watch["amax"][0] = watch["vmax"][0] = 0.0

    def look_ahead(self) -> None:
        """How many chunks the lanes can go on alone; none: the engine takes over."""
        self.take_over()
        length = self.block.chunk * self.engine.dt
        time = next((time for time in AHEAD if not self.engine.may_come_loose(time)), 0.0)
        self.safe = max(1, int(time / length)) if time > 0.0 else 0
        if time == 0.0:
            self.engine.renew_pairs()
            self.loose = True

    def chunks_left(self) -> int:
        """Chunks until the end of the motion and its tail."""
        step = self.engine.now["step"][0] if self.loose else self.block.feed["step"][0, 0]
        return self.engine.chunks - int(step) // CHUNK

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
        engine, drum = self.engine, self.block.drum
        for name in ("x", "z", "th", "c", "s"):
            drum[name][:, 0] = engine.body[name][: self.column.n + 1]
        self.block.feed["step"][0, 0] = engine.now["step"][0]
        return self.block.snapshot(0) | {"time": engine.time, "energy": engine.energies()}

    def response(self, states: list[dict[str, Any]], residual: float) -> Response:
        """The run as a response; what is special to it stands in its provenance."""
        found = histories(self.motion, states)
        measures = self.measures(states[-1], found)
        engine, lost = self.engine, self.block.collapse(0) if self.collapsed else None
        mechanism = find_mechanism(
            self.column,
            found,
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
        return Response(self.column, found, measures, self.name, provenance, mechanism=mechanism, followed=True)

    @property
    def touched_at(self) -> float | None:
        """When bodies that are no neighbours touched first [s]."""
        step = int(self.engine.now["touched"][0])
        return step * self.engine.dt if step >= 0 else None

    def collapse(self, found: Histories) -> Collapse:
        """The collapse, with what touched first."""
        engine, n = self.engine, self.column.n
        lost, when = self.block.collapse(0), self.touched_at
        if when is None:
            return lost
        bodies = engine.assembly.bodies
        poses = np.zeros((3, len(found.time), len(bodies)))
        poses[:2] = np.array([block.origin for block in bodies]).T[:, None]
        poses[:, :, 1 : n + 1] += (found.drum_x, found.drum_z, found.drum_rotation)
        x, z, rotation = poses
        return replace(lost, touched=first_touch(engine.assembly, found.time, x, z, rotation, when))

    def measures(self, last: dict[str, Any], found: Histories) -> Measures:
        """Measures of the run; peaks end with a collapse, as in the lanes."""
        watch, engine, column, drum = self.block.watch[0], self.engine, self.column, self.block.drum
        change = last["energy"] - self.start
        imbalance = ledger_imbalance(change, float(watch["wmax"][0]), self.block.begun(0, change), column)
        failed = engine.failed or bool(ledger.out_of_balance(imbalance))
        slip, widths = last["slip"], column.joint_widths
        outcome = classify(
            self.collapsed, failed, float(watch["open"][0] / widths.min()), float((np.abs(slip) / widths).max())
        )
        mechanical = float(change[1] + change[2] + change[3] + self.block.rest[0])
        when = int(watch["when"][0])
        return Measures(
            outcome=outcome,
            decided=self.collapsed
            or (not failed and stands_for_good(column, drum, 0, slip, mechanical, self.block.toes(column))),
            collapse_time=float(when * engine.dt) if when >= 0 else math.nan,
            peak_top_displacement=self.block.peak(0, "top"),
            residual_top_displacement=float(found.top_displacement[-1]),
            peak_rotation=self.block.peak(0, "turn"),
            peak_joint_opening=self.block.peak(0, "open"),
            residual_joint_slip=float(np.abs(slip).max()),
            energy_imbalance=imbalance,
            time_step=engine.dt,
            steps=int((engine.now["step"] if self.loose else self.block.feed["step"][0])[0]),
            reason=self.block.reason(0, outcome, imbalance),
            collapse=self.collapse(found) if outcome is Outcome.COLLAPSED else None,
        )
