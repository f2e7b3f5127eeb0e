"""Models that step drums explicitly, their losses by name, and the base of the engines that run them in blocks of lanes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from threading import Lock
from typing import TYPE_CHECKING, Any, ClassVar, Self

from ...column.joint import NAMED, Losses
from ...column.materials import ROLLING
from ...errors import InputError, check_choice, check_range
from ...kernels.run_codes import LANES
from ...motion import Motion
from ...outcome import Outcome
from ...response import Measures, Response
from ..base import Case, Model, RunOptions
from ..engine import Engine, engine_for
from ..shared.ground import expected_length
from ..shared.lanes import LaneBlock, Riders, run_alike
from ..shared.stable_step import check_sinking, check_step_resolves, chosen_step, whole_steps
from ..shared.toes import Opening
from .impact import damping_of_stone
from .records import Topology
from .runs import histories

if TYPE_CHECKING:
    from ..devices import Device

#: Largest share of the stable step at which columns alike are computed in one step: joints 2.8 times as stiff bear it.
SAFE_FACTOR = 0.6

#: What a link costs in a step over what a drum does [-]: five drums with five dowels took 1.5 times as long in the plane as
#: without them, 1.7 times in space.
LINK = 0.6


@dataclass(frozen=True, kw_only=True)
class SteppedDrums(Model):
    """Base of the models whose kernels step rigid drums explicitly.

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

    def acting(self, structure: Any) -> Self:
        """The model with what acts in a run of a structure."""
        del structure
        return self

    def cost(self, drums: int) -> float:
        """About what a step of a single run costs on one core [s]; a batch shares it among its lanes."""
        return 1.2e-7 * drums


class SteppedEngine(Engine):
    """Base of the engines of models that step drums explicitly."""

    @property
    def acting(self) -> Any:
        """The model with what acts in a run."""
        return self.model.acting(self.structure)

    @property
    def paced(self) -> Any:
        """The model with what acts in a run; what may come loose chooses its step run by run."""
        return self.acting

    def expected_time(self, motion: Motion, options: RunOptions, *, alone: bool) -> float:
        """About how long a run takes on one core [s], without the quiet that is not stepped."""
        del alone
        step, cost = self.expected_step(motion)
        return cost * expected_length(Case(self.structure, motion), options) / step


class LaneEngine(SteppedEngine):
    """Base of the engines of what is stepped in blocks of lanes; each gives its kinds, packing and largest stable step."""

    twins: ClassVar[int] = 15

    # -- given by each engine ------------------------------------------------------------------------------------------

    @property
    def kind(self) -> Any:
        """Mark of structures that can share a block of lanes: which contacts there are."""
        return Topology.of(self.structure)

    def pack(self, structure: Any) -> Any:
        """A structure of the same kinds in numbers of a lane."""
        raise NotImplementedError

    @property
    def stable_step(self) -> float:
        """Largest stable time step of the closed joints [s]."""
        raise NotImplementedError

    def block_for(self, kind: Any, options: RunOptions, lanes: int = LANES) -> Any:
        """A block of lanes for structures of a kind."""
        raise NotImplementedError

    # -- shared --------------------------------------------------------------------------------------------------------

    def block(self, options: RunOptions, lanes: int = LANES) -> Any:
        """A block of lanes for structures that can share it with this one."""
        return self.block_for(self.kind, options, lanes)

    @property
    def called(self) -> str:
        """What it is called in messages."""
        return "this column"

    @property
    def step(self) -> float:
        """Time step [s].

        Raises
        ------
        InputError
            The step asked for is above the largest stable one.
        """
        acting = self.acting
        return chosen_step(self.stable_step, acting.step_factor, acting.time_step, self.called)

    def expected_step(self, motion: Motion) -> tuple[float, float]:
        """Time step and its cost [s]; whole chunks of steps fill the motion."""
        structure, n = self.structure, self.structure.n
        links = sum(link.acts for link in structure.placed_links)
        return whole_steps(motion, 0.0, self.step)[0], self.acting.cost(n) * (1.0 + LINK * links / n)

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories, through the same kernel as a batch; twins of the structure in the free lanes.

        States are recorded at equal times; where quiet is left out, that in which the column lies at rest.
        """
        paced = engine_for(self.paced, self.structure) if options.twins else self
        block = paced.block(options)
        block.load(0, Case(self.structure, motion))
        chunks = math.ceil(block.steps[0] / block.chunk)
        stride = max(1, min(chunks, round(options.output_interval / (block.chunk * block.dt[0]))))
        every, end, dt = stride * block.chunk, int(block.steps[0]), float(block.dt[0])
        twins = Riders(block, [Case(twin, motion) for twin in options.twins])
        residual = block.residual_acceleration(0)
        states: list[dict[str, Any]] = []

        def record(last: bool = False, until: int | None = None) -> None:
            """Keep the present state, for every time up to a step that has none; the last one at that step itself."""
            step = int(block.feed["step"][0, 0]) if until is None else until
            times = [number * dt for number in range(len(states) * every, step + 1, every)]
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
        shown = histories(motion, states)
        return Response(self.structure, shown, measures, self.model.name, provenance, twins=twins.measures())

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs through blocks of lanes; columns, joints and motions may differ from lane to lane."""
        return run_alike(self._kind_of, lambda kind: self.block_for(kind, options), cases, threads)

    def _kind_of(self, case: Case) -> Any:
        return engine_for(self.model, case.column).kind


class StackEngine(LaneEngine):
    """Base of the engines of columns that are stepped."""

    links: ClassVar[frozenset[str]] = frozenset({"dowel", "tie", "pad"})

    def check(self, motion: Motion) -> None:
        """Refuse joints that are too soft, and a step that is unstable or passes over the motion."""
        super().check(motion)
        check_sinking(self.structure)
        self.step  # noqa: B018 (which refuses)
        check_step_resolves(self.model.time_step, motion)

    @property
    def paced(self) -> Any:
        """The model in the column's own time step, far enough below the largest stable one of columns like it."""
        acting = self.acting
        stated = acting.time_step is not None or acting.step_factor > SAFE_FACTOR
        return acting if stated else replace(acting, time_step=self.step)

    def run_on_card(
        self, device: Device, cases: Sequence[Case], options: RunOptions, threads: int
    ) -> Iterator[tuple[int, Measures]]:
        """As :meth:`run_many`, where a graphics card steps what it has kernels for, and threads the rest."""
        turn = Lock()

        def lanes(kind: Any) -> LaneBlock:
            if not device.steps(self.model, kind):
                return self.block_for(kind, options)
            return device.lanes(self, kind, options, len(cases), turn)

        return run_alike(
            self._kind_of, lanes, cases, lambda kind: device.threads if device.steps(self.model, kind) else threads
        )

    def on_card(self, device: Device) -> bool:
        """Whether a graphics card steps runs of the column: of those without links for which it has kernels."""
        return device.steps(self.model, self.kind)


@dataclass(frozen=True, kw_only=True)
class LossyDrums(SteppedDrums):
    """Base of the models that take losses by name.

    Parameters
    ----------
    losses : {"none", "stone"} or Losses
        ``stone`` chooses β so that impacts of a column as one body, and of what else stands on the ground with all that it
        carries, leave what those of stone do, and a resistance to rolling of round columns in space. A stack keeps less at
        an impact than one body (twelve drums 0.95 to 0.98 of its velocity), as joints slip. A wobble has no impact: it
        loses what rolling and the dashpots of its toe take (Eq. E29), and may last for half a minute. ``none`` leaves both
        to the other parameters, by default none. Or those that were measured
        (:func:`stylobate.calibrate`, :func:`stylobate.read_losses`).
    """

    losses: str | Losses = "none"

    def __post_init__(self) -> None:
        super().__post_init__()
        if not isinstance(self.losses, Losses):
            check_choice("losses", self.losses, NAMED)
        elif self.losses.law is not None and getattr(self, "law", "rim") not in ("rim", self.losses.law):
            raise InputError(
                f"law = {getattr(self, 'law', None)!r} is given, and the losses are of law {self.losses.law!r}; give one.",
                "law",
            )
        chosen = (*self._chosen, *(("restitution",) if "y" in self.axes else ()))
        given = next((name for name in chosen if self.losses != "none" and getattr(self, name)), None)
        if given is not None:
            raise InputError(
                f"losses = {self.losses!r} and {given} = {getattr(self, given):g} are both given, and the one chooses the "
                "other; give one of the two.",
                "losses",
            )

    @property
    def _chosen(self) -> tuple[str, ...]:
        """Parameters that losses by name choose."""
        return tuple(name for name in ("stiffness_damping", "rolling_resistance") if hasattr(self, name))

    @property
    def damped(self) -> bool:
        """Whether any damping acts during the run."""
        return super().damped or self.losses != "none"

    def acting(self, structure: Any) -> Self:
        """The model with what acts in a run of a structure in place of the name of its losses."""
        return self if self.losses == "none" and structure.losses is None else _acting(structure, self)


def with_provenance(engine: Any, motion: Motion, response: Response, opens: Opening | None = None) -> Response:
    """A response of an engine whose provenance says what opens a column, and what acted by the name of the losses."""
    if opens is not None:
        response = replace(response, provenance=response.provenance | {"opening": opens._asdict()})
    if engine.model.losses == "none":
        return response
    how, free = engine.acting, replace(engine.model, losses="none")
    chosen = {name: getattr(how, name.removesuffix("_s")) for name in ("stiffness_damping_s", *how._chosen[1:])}
    steps = [engine_for(model, engine.structure).expected_step(motion)[0] for model in (free, how)]
    return replace(response, provenance=response.provenance | chosen | {"steps_over_undamped": steps[0] / steps[1]})


@lru_cache(maxsize=4096)
def _acting(structure: Any, model: Any) -> Any:
    changes: dict[str, Any] = {"losses": "none"}
    round_ = structure.section == "circular" and "rolling_resistance" in model._chosen
    drawn = structure.losses if "y" in model.axes else None
    own = drawn or model.losses
    if isinstance(own, Losses):
        changes |= {"stiffness_damping": own.stiffness_damping}
        changes |= {"rolling_resistance": own.rolling_resistance, "law": own.law or model.law} if round_ else {}
        changes |= {} if drawn is None else {"restitution": None, "time_step": None}
    elif model.losses == "stone":
        free = replace(model, losses="none")
        changes["stiffness_damping"] = damping_of_stone(structure, free, engine_for(model, structure).rocking)
        changes |= {"rolling_resistance": ROLLING.value} if round_ else {}
    return replace(model, **changes)
