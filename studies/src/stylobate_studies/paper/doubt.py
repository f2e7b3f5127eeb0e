"""Certainty of a verdict: the same question asked with half of the time step, and of slightly different columns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stylobate.verdicts import verdict as v
from stylobate.verdicts.compare import StepComparison
from stylobate.verdicts.domain import UNCERTAIN, CollapseProbability


@dataclass(frozen=True, eq=False)
class Doubt:
    """One domain, asked again.

    Parameters
    ----------
    steps : StepComparison
        The domain, and the same one with half of the time step.
    population : CollapseProbability
        The same cells for columns that differ by 1 %.
    """

    steps: StepComparison
    population: CollapseProbability

    @property
    def another(self) -> np.ndarray:
        """Verdicts of the first of the slightly different columns, shape (F, A)."""
        return np.array(v.VERDICTS, dtype=object)[self.population.codes[:, :, 0]]

    @property
    def differing(self) -> np.ndarray:
        """Cells in which that column's verdict is another one than the column's own, shape (F, A)."""
        certain, first = (v.STANDS, v.COLLAPSED), self.steps.domain.verdicts
        return np.isin(first, certain) & np.isin(self.another, certain) & (first != self.another)

    @property
    def uncertain(self) -> float:
        """Share of the cells in which some of the columns collapse and others do not [-]."""
        return float((self.population.kinds == UNCERTAIN).mean())
