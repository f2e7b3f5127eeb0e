"""Twins of a column at every amplitude of a grid: the probability of collapse over the amplitude, with its interval."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.twins import Twins
from ..constants import g
from ..notebook import Shown
from ..response.rows import Rows
from . import verdicts as v
from .capacity import SHARES, Capacity, bounds, of_levels, quantiles
from .population import OF_COLUMNS
from .unknown_law import share_limits

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, eq=False)
class CriticalPopulation(Shown):
    """Verdicts on twins over a grid of amplitudes.

    Parameters
    ----------
    amplitudes : array
        [m/s²], shape (A,), rising.
    verdicts : array of str
        Shape (twins, A).
    drawn : Twins
    nominal : float, optional
        Amplitude of the record as it is [m/s²]; None for a formula.
    confidence : float
        Level of the interval.
    """

    amplitudes: np.ndarray
    verdicts: np.ndarray
    drawn: Twins
    nominal: float | None = None
    confidence: float = 0.95

    @classmethod
    def of(cls, amplitudes: np.ndarray, rows: Rows, drawn: Twins, nominal: float | None) -> CriticalPopulation:
        """From the rows of all twins at all amplitudes, those of one twin together."""
        verdicts = v.verdicts_of(rows).reshape(-1, len(amplitudes))
        return cls(amplitudes, verdicts, drawn, nominal)

    @property
    def counts(self) -> dict[str, np.ndarray]:
        """Number of twins of each verdict at each amplitude, under the names of tables."""
        return {f"twins_{one}": (self.verdicts == one).sum(axis=0) for one in v.MADE}

    @property
    def probability(self) -> np.ndarray:
        """Share of the twins that collapse at each amplitude; see :func:`stylobate.analysis.verdicts.share_collapsed`."""
        return v.share_collapsed(*v.tally(self.verdicts, axis=0))

    @property
    def undecided_collapsed(self) -> np.ndarray:
        """Share of the twins that collapse at each amplitude if every undecided one does; NaN without a run."""
        fell, stood, open_ = v.tally(self.verdicts, axis=0)
        number = fell + stood + open_
        return np.divide(fell + open_, number, out=np.full(number.shape, np.nan), where=number > 0)

    @property
    def interval(self) -> tuple[np.ndarray, np.ndarray]:
        """Confidence limits of the probability; see :func:`stylobate.analysis.unknown_law.share_limits`."""
        return share_limits(self.verdicts.T, self.drawn.groups, self.confidence)

    @property
    def interval_of_columns(self) -> tuple[np.ndarray, np.ndarray]:
        """The same as if the law of their joints were known."""
        return v.collapse_interval(*v.tally(self.verdicts, axis=0), self.confidence)

    @property
    def capacities(self) -> list[Capacity]:
        """Between which amplitudes the first collapse of each twin lies [m/s²]."""
        return [of_levels(self.amplitudes, list(verdict)) for verdict in self.verdicts]

    @property
    def critical(self) -> np.ndarray:
        """Smallest amplitude that collapses each twin [m/s²], shape (twins,); infinite where none of the grid does."""
        return np.array([capacity.high for capacity in self.capacities])

    @property
    def factors(self) -> np.ndarray | None:
        """The amplitudes as factors of the record [-], shape (A,); None for a formula."""
        return None if self.nominal is None else self.amplitudes / self.nominal

    @property
    def percentiles(self) -> dict[str, float]:
        """Amplitudes by which 16, 50 and 84 % of the twins have first collapsed [g]; infinite beyond the grid."""
        return {name: one.high / g for name, one in self._quantiles.items()}

    @property
    def least(self) -> dict[str, float]:
        """The same if every undecided or failed run were a collapse [g]: the amplitude above the largest surely stood."""
        above = np.append(self.amplitudes, math.inf)
        found = {
            name: above[np.searchsorted(self.amplitudes, one.low, side="right")]
            for name, one in self._quantiles.items()
        }
        return {name.replace("_g", "_least_g"): float(value) / g for name, value in found.items()}

    @property
    def bounds(self) -> dict[str, str]:
        """Of which of these only a bound is known, as nobody stood or nobody fell below it, by name."""
        return bounds({name: (one, g) for name, one in self._quantiles.items()})

    @property
    def _quantiles(self) -> dict[str, Capacity]:
        found = zip(SHARES, quantiles(self.capacities), strict=True)
        return {f"critical_{100 * share:.0f}_g": one for share, one in found}

    @property
    def table(self) -> pandas.DataFrame:
        """One row per amplitude: how many twins have which verdict, the probability of collapse and its limits."""
        import pandas

        low, high = self.interval
        rows = {"amplitude_g": self.amplitudes / g, "factor": self.factors}
        rows |= {one: (self.verdicts == one).sum(axis=0) for one in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)}
        rows |= {"collapse_probability": self.probability, "collapse_interval_low": low, "collapse_interval_high": high}
        if self.drawn.groups:
            rows |= dict(zip(OF_COLUMNS, self.interval_of_columns, strict=True))
        return pandas.DataFrame(rows)

    def summary(self) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate critical``; lists are over the amplitudes."""
        (low, high), of_columns = self.interval, self.interval_of_columns if self.drawn.groups else ()
        total = v.count(self.verdicts)
        return {
            "amplitudes_g": (self.amplitudes / g).tolist(),
            "factors": None if self.factors is None else self.factors.tolist(),
            "collapse_probability": self.probability.tolist(),
            "collapse_interval_low": low.tolist(),
            "collapse_interval_high": high.tolist(),
            **{name: one.tolist() for name, one in zip(OF_COLUMNS, of_columns)},
            **{name: count.tolist() for name, count in self.counts.items()},
            "replicates": len(self.verdicts),
            "certainty": {
                **self.drawn.facts,
                "confidence": self.confidence,
                **self.percentiles,
                **self.least,
                "bounds": self.bounds,
                **{one: total[one] for one in v.MADE},
            },
        }
