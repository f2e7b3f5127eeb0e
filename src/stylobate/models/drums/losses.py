"""Models of columns whose losses have a name: what acts in a run of one column."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Self

from ...column.joint import NAMED, Losses
from ...column.materials import ROLLING
from ...errors import InputError, check_choice
from ...motion import Motion
from ...response import Response
from ..shared.opening import Opening
from .impact import Rocking, damping_of_stone, rocking_column
from .stepped import SteppedDrums


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

    def acting(self, column: Any) -> Self:
        """The model with what acts in a run of a column in place of the name of its losses."""
        own = None if column.stack is None else column.stack.losses
        return self if self.losses == "none" and own is None else _acting(column, self)

    def rocking(self, structure: Any) -> Rocking:
        """How single bodies of a structure rock in the engine that computes it."""
        del structure
        return rocking_column

    def step_for(self, column: Any) -> float:
        """As of all models that step drums, with what acts in a run of the column [s]."""
        return super(LossyDrums, self.acting(column)).step_for(column)

    def expected_step(self, column: Any, motion: Motion) -> tuple[float, float]:
        """As of all models that step drums, with what acts in a run of the column, both [s]."""
        return super(LossyDrums, self.acting(column)).expected_step(column, motion)

    def paced(self, column: Any) -> SteppedDrums:
        """As of all models that step drums; with the losses of the column, by name no more."""
        return super(LossyDrums, self.acting(column)).paced(column)

    def opening(self, column: Any) -> Opening | None:
        """What rocks a column statically, on soft joints and on rigid ones, where that has a closed form."""
        raise NotImplementedError

    def told(self, structure: Any, motion: Motion, response: Response) -> Response:
        """A response whose provenance says what opens the column, and what acted by the name of the losses."""
        opens = None if structure.stack is None else self.opening(structure)
        if opens is not None:
            response = replace(response, provenance=response.provenance | {"opening": opens._asdict()})
        if self.losses == "none":
            return response
        how, free = self.acting(structure), replace(self, losses="none")
        chosen = {name: getattr(how, name.removesuffix("_s")) for name in ("stiffness_damping_s", *self._chosen[1:])}
        steps = [one.expected_step(structure, motion)[0] for one in (free, how)]
        return replace(response, provenance=response.provenance | chosen | {"steps_over_undamped": steps[0] / steps[1]})


@lru_cache(maxsize=4096)
def _acting(column: Any, model: Any) -> Any:
    changes: dict[str, Any] = {"losses": "none"}
    round_ = column.section == "circular" and "rolling_resistance" in model._chosen
    drawn = None if column.stack is None or "y" not in model.axes else column.stack.losses
    own = drawn or model.losses
    if isinstance(own, Losses):
        changes |= {"stiffness_damping": own.stiffness_damping}
        changes |= {"rolling_resistance": own.rolling_resistance, "law": own.law or model.law} if round_ else {}
        changes |= {} if drawn is None else {"restitution": None, "time_step": None}
    elif model.losses == "stone":
        free = replace(model, losses="none")
        changes["stiffness_damping"] = damping_of_stone(column, free, model.rocking(column))
        changes |= {"rolling_resistance": ROLLING.value} if round_ else {}
    return replace(model, **changes)
