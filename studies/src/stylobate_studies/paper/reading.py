"""Numbers out of the results of the study, as its sentences need them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stylobate.constants import g
from stylobate.messages import percent
from stylobate.verdicts import verdict as v
from stylobate.verdicts.domain import Domain

from .cases import BEAM, DEM, REFERENCE, VARIANTS
from .study import PaperResults


class Reader:
    """Values of the results by name."""

    def __init__(self, results: PaperResults) -> None:
        self.results = results

    def domain(self, name: str, label: str) -> Domain:
        """The domain of the rectangular column."""
        return self.results.domains[name, label, "rectangular"]

    def unsafe(self, name: str, label: str) -> float:
        """Share of the domain's cells that collapse [-]."""
        return share(self.domain(name, label))

    def variants(self, name: str, label: str) -> dict[str, Domain]:
        """Domains with one parameter changed, of one model."""
        chosen = [key for key in self.results.grids.variants if VARIANTS[key][0] == label]
        return {key: self.results.variants[name, key] for key in chosen}

    def spread(self, name: str, label: str, frequency: float) -> str:
        """First collapse at a frequency over the open parameters."""
        thresholds = {key: nearest(domain, frequency) for key, domain in self.variants(name, label).items()}
        low, high = min(thresholds, key=thresholds.__getitem__), max(thresholds, key=thresholds.__getitem__)
        return f"at {frequency:g} Hz from {in_g(thresholds[low])} ({low}) to {in_g(thresholds[high])} ({high})"

    def verdict(self, name: str, label: str, frequency: float, amplitude: float) -> str:
        """Verdict of one of the thirty cases."""
        case = self.results.histories[name, label].sel(frequency=frequency, amplitude=amplitude * g, method="nearest")
        return v.VERDICTS[int(case["verdict"])]

    def agreement(self, name: str) -> np.ndarray:
        """In which of the thirty cases rigid beam and distinct elements agree whether it collapses."""
        return self._falls(name, BEAM) == self._falls(name, DEM)

    def shaken(self, variant: str) -> tuple[np.ndarray, np.ndarray]:
        """The monolith's thirty cases up to the end of the shaking, a variant of the rigid beam and distinct elements.

        Whether they agree that it collapses, (cases,), and the ratios of the peak top displacements, beam over DEM, where
        both rock and neither collapses.
        """
        beam, dem = self.results.shaken[variant], self.results.shaken[REFERENCE]
        falls = [domain.verdicts == v.COLLAPSED for domain in (beam, dem)]
        peaks = [domain.grid("peak_top_displacement_m") for domain in (beam, dem)]
        both = ~falls[0] & ~falls[1] & (peaks[0] > 0.005) & (peaks[1] > 0.005)
        return (falls[0] == falls[1]).ravel(), peaks[0][both] / peaks[1][both]

    def _falls(self, name: str, label: str) -> np.ndarray:
        return self.results.histories[name, label]["verdict"].values == v.VERDICTS.index(v.COLLAPSED)


def first(domain: Domain, low: float = 0.0, high: float = np.inf) -> np.ndarray:
    """First collapse [g] at the frequencies in a range; infinite where none collapses."""
    chosen = (domain.frequencies >= low - 1e-9) & (domain.frequencies <= high + 1e-9)
    return np.nan_to_num(domain.first_collapse[chosen] / g, nan=np.inf)


def nearest(domain: Domain, frequency: float) -> float:
    """First collapse [g] at the frequency next to the given one."""
    return float(
        np.nan_to_num(domain.first_collapse[np.argmin(np.abs(domain.frequencies - frequency))] / g, nan=np.inf)
    )


def rising(domain: Domain) -> float:
    """Of all pairs of frequencies with different first collapses, the share in which the higher one has the larger [-].

    No collapse is the largest.
    """
    values = np.where(np.isfinite(first(domain)), first(domain), 9.0)
    change = np.sign(values[None, :] - values[:, None])[np.triu_indices(values.size, 1)]
    return float((change > 0).sum() / max(1, (change != 0).sum()))


def share(domain: Domain) -> float:
    """Share of the cells that collapse [-]."""
    return domain.counts[v.COLLAPSED] / len(domain.rows)


def step(domain: Domain) -> float:
    """Step of the amplitudes [g]."""
    return float(np.diff(domain.amplitudes).max() / g)


def in_g(value: float) -> str:
    """An amplitude, or that none collapses."""
    return f"{value:.3f} g" if np.isfinite(value) else "no collapse"


def span(values: Sequence[float] | np.ndarray) -> str:
    """The range of amplitudes."""
    low, high = float(np.min(values)), float(np.max(values))
    return in_g(low) if low == high else f"{in_g(low)} to {in_g(high)}"


def percents(values: Sequence[float]) -> str:
    """The range of shares in per cent."""
    return f"{percent(min(values))} to {percent(max(values))}"


def all_but(outcomes: dict[str, bool]) -> str:
    """In how many variants something is so, and in which it is not."""
    other = [key for key, value in outcomes.items() if not value]
    return f"The same in {sum(outcomes.values())} of {len(outcomes)} variants" + (
        f" (not: {'; '.join(other)})." if other else "."
    )
