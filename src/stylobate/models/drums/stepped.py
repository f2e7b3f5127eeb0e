"""Common parts of models of stacked drums that step them explicitly in blocks of lanes: options, time step, runs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from threading import Lock
from typing import TYPE_CHECKING, Any, ClassVar

from ...column import Column
from ...errors import check_range
from ...kernels.run_codes import LANES
from ...motion import Motion
from ...outcome import Outcome
from ...response import Measures, Response
from ..base import Case, Model, RunOptions
from ..shared.lanes import LaneBlock, Riders, run_alike
from ..shared.soft_joints import check_sinking, check_step_resolves
from ..shared.stable_step import chosen_step, whole_steps
from .bodies import Topology
from .histories import histories

if TYPE_CHECKING:
    from ..devices import Device

#: Largest share of the stable step at which columns alike are computed in one step: joints 2.8 times as stiff bear it.
SAFE_FACTOR = 0.6

#: What a link costs in a step over what a drum does [-]: five drums with five dowels took 1.5 times as long in the plane as
#: without them, 1.7 times in space.
LINK = 0.6


@dataclass(frozen=True, kw_only=True)
class SteppedDrums(Model):
    """Base of the models whose kernels step rigid drums explicitly. A model gives its kernel, types and packing.

    Parameters
    ----------
    step_factor : float
        Time step as a share of the largest stable one.
    time_step : float, optional
        Time step [s], instead of ``step_factor``.
    stiffness_damping : float
        β: dashpots of β times the stiffness of what is in contact [s].
    mass_damping : float
        α: force −α m v on every drum, v relative to the base [1/s].
    """

    carries: ClassVar[int] = 15
    takes_links: ClassVar[frozenset[str]] = frozenset({"dowel", "tie", "pad"})

    step_factor: float = 0.4
    time_step: float | None = None
    stiffness_damping: float = 0.0
    mass_damping: float = 0.0

    def __post_init__(self) -> None:
        default = next(field.default for field in fields(self) if field.name == "step_factor")
        remedy = f"{default:g} is the default"
        check_range("step_factor", self.step_factor, 0.0, 1.0, open_low=True, open_high=True, remedy=remedy)
        if self.time_step is not None:
            check_range("time_step", self.time_step, 0.0, 1.0, unit="s", open_low=True)
        check_range("stiffness_damping", self.stiffness_damping, 0.0, 1.0, unit="s")
        check_range("mass_damping", self.mass_damping, 0.0, 1e3, unit="1/s")

    @property
    def damped(self) -> bool:
        """Whether any damping acts during the run."""
        return self.stiffness_damping > 0.0 or self.mass_damping > 0.0

    # -- given by each model -------------------------------------------------------------------------------------

    def pack(self, column: Any) -> Any:
        """A column as the engine wants it."""
        raise NotImplementedError

    def stable_step(self, column: Any) -> float:
        """Largest stable time step of the closed column [s]."""
        raise NotImplementedError

    def block_for(self, kind: Any, options: RunOptions, lanes: int = LANES) -> Any:
        """A block of lanes for columns of a kind."""
        raise NotImplementedError

    def cost(self, drums: int) -> float:
        """About what a step of a single run costs on one core [s]; a batch shares it among its lanes."""
        return 1.2e-7 * drums

    # -- shared --------------------------------------------------------------------------------------------------

    def kind(self, column: Any) -> Any:
        """Mark of columns that can share a block of lanes: which contacts there are."""
        return Topology.of(column)

    def check(self, column: Column, motion: Motion) -> None:
        """Refuse joints of a stack that are too soft, and a step that is unstable or passes over the motion."""
        super().check(column, motion)
        if column.stack is None:
            return
        check_sinking(column)
        self.step_for(column)
        check_step_resolves(self.time_step, motion)

    def step_for(self, column: Column) -> float:
        """Time step for a column [s].

        Raises
        ------
        InputError
            The step asked for is above the largest stable one.
        """
        return chosen_step(self.stable_step(column), self.step_factor, self.time_step, "this column")

    def expected_step(self, column: Column, motion: Motion) -> tuple[float, float]:
        """Time step and its cost [s]; whole chunks of steps fill the motion."""
        links = sum(link.acts for link in column.placed_links)
        return whole_steps(motion, 0.0, self.step_for(column))[0], self.cost(column.n) * (1.0 + LINK * links / column.n)

    def paced(self, column: Column) -> SteppedDrums:
        """The model in the column's own time step, far enough below the largest stable one of columns like it.

        What is no stack chooses its step run by run.
        """
        if self.time_step is not None or self.step_factor > SAFE_FACTOR:
            return self
        return self if column.stack is None else replace(self, time_step=self.step_for(column))

    def run(self, column: Column, motion: Motion, options: RunOptions) -> Response:
        """One run with histories, through the same kernel as a batch; twins of the column in the free lanes.

        States are recorded at equal times; where quiet is left out, that in which the column lies at rest.
        """
        kind = self.kind(column)
        block = (self.paced(column) if options.twins else self).block_for(kind, options)
        block.load(0, Case(column, motion))
        chunks = math.ceil(block.steps[0] / block.chunk)
        stride = max(1, min(chunks, round(options.output_interval / (block.chunk * block.dt[0]))))
        every, end, dt = stride * block.chunk, int(block.steps[0]), float(block.dt[0])
        twins = Riders(block, [Case(twin, motion) for twin in options.twins])
        residual = block.residual_acceleration(0)
        states: list[dict[str, Any]] = []

        def record(last: bool = False, until: int | None = None) -> None:
            """Keep the present state, for every time up to a step that has none; the last one at that step itself."""
            step = int(block.feed["step"][0, 0]) if until is None else until
            times = [one * dt for one in range(len(states) * every, step + 1, every)]
            if last and (len(states) + len(times) - 1) * every < step:
                times.append(step * dt)
            if times:
                present = block.snapshot(0)
                states.extend(present | {"time": time} for time in times)
            if options.progress:
                options.progress(step * dt, end * dt)

        record()
        while not block.is_over(0):
            block.follow(len(states) * stride - int(block.feed["step"][0, 0]) // block.chunk, twins.collect)
            record()
        provenance = {"time_step_s": float(block.dt[0]), "residual_acceleration_at_start_m_s2": residual}
        measures = block.collect(0)
        rests = measures.stepped is not None and measures.outcome not in (Outcome.COLLAPSED, Outcome.FAILED)
        record(last=True, until=max(end, int(block.feed["step"][0, 0])) if rests else None)
        return Response(column, histories(motion, states), measures, self.name, provenance, twins=twins.measures())

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs through blocks of lanes; columns, joints and motions may differ from lane to lane."""
        return run_alike(
            lambda case: self.kind(case.column), lambda kind: self.block_for(kind, options), cases, threads
        )

    def run_on_card(
        self, device: Device, cases: Sequence[Case], options: RunOptions, threads: int
    ) -> Iterator[tuple[int, Measures]]:
        """As :meth:`run_many`, where a graphics card steps what it has kernels for, and threads the rest."""
        if len(cases) and cases[0].column.stack is None:
            return self.run_many(cases, options, threads)

        turn = Lock()

        def lanes(kind: Any) -> LaneBlock:
            if not device.steps(self, kind):
                return self.block_for(kind, options)
            return device.lanes(self, kind, options, len(cases), turn)

        return run_alike(
            lambda case: self.kind(case.column),
            lanes,
            cases,
            lambda kind: device.threads if device.steps(self, kind) else threads,
        )

    def on_card(self, device: Device, column: Any) -> bool:
        """Whether a graphics card steps runs of what stands: of columns without links for which it has kernels."""
        return column.stack is not None and device.steps(self, self.kind(column.stack))
