"""The same domain under two step sizes: how many verdicts hang on the arithmetic."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..campaign.campaign import RUNS, Campaign
from ..column import Column
from ..errors import InputError
from ..models.base import Model
from ..motion import harmonic
from . import verdicts as v
from .compare import compare_domains
from .domain import Domain


@dataclass(frozen=True, eq=False)
class StepComparison:
    """A domain, and the same one with half of the time step."""

    domain: Domain
    halved: Domain

    @property
    def comparable(self) -> np.ndarray:
        """Cells with a verdict under both steps, shape (F, A)."""
        certain = (v.STANDS, v.COLLAPSED)
        return np.isin(self.domain.verdicts, certain) & np.isin(self.halved.verdicts, certain)

    @property
    def differing(self) -> np.ndarray:
        """Comparable cells whose verdicts differ, shape (F, A)."""
        return self.comparable & (self.domain.verdicts != self.halved.verdicts)

    def summary(self) -> dict:
        """Counts, as in the JSON object of ``stylobate domain --half-step``."""
        collapsed = [int((one.verdicts == v.COLLAPSED).sum()) for one in (self.domain, self.halved)]
        return {
            "comparable": int(self.comparable.sum()),
            "differing": int(self.differing.sum()),
            "collapsed": collapsed[0],
            "collapsed_half_step": collapsed[1],
        }


def compare_steps(
    column: Column,
    model: Model,
    frequencies: Sequence[float] | np.ndarray,
    amplitudes: Sequence[float] | np.ndarray,
    duration: float = 10.0,
    *,
    campaign: Campaign | None = None,
    **settings: Any,
) -> StepComparison:
    """Run a domain under the model's step and under half of it; parameters as in :func:`compare_domains`."""
    campaign = Campaign.of("compare_steps", campaign, settings, RUNS)
    finest = harmonic(float(np.max(frequencies)), 1.0, duration)
    models = [model, halved_step(model, column, finest)]
    pair = compare_domains(column, models, frequencies, amplitudes, duration, campaign=campaign)
    return StepComparison(*pair.domains)


def halved_step(model: Model, column: Column, motion: Any) -> Model:
    """The model with half of the time step that it would take for this column and motion.

    Raises
    ------
    InputError
        The model chooses its steps by itself.
    """
    step = getattr(model, "time_step", None)
    if step is not None:
        return dataclasses.replace(model, time_step=0.5 * step)
    factor = getattr(model, "step_factor", None)
    if factor is not None:
        return dataclasses.replace(model, step_factor=0.5 * factor)
    step_for = getattr(model, "step_for", None)
    if step_for is None:
        raise InputError(f"{model.name} chooses its steps by itself; give a time_step to compare it with half of it.")
    seen = getattr(model, "idealised", lambda one: one)(column)
    return dataclasses.replace(model, time_step=0.5 * step_for(seen, motion))
