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
from ..engine import engine_for
from ..shared.opening import Opening
from .impact import damping_of_stone
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
    steps = [engine_for(one, engine.structure).expected_step(motion)[0] for one in (free, how)]
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
