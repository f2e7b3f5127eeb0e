"""Quality of predictions of toppled or not: shares, Matthews coefficient, Brier score, fragility, reliability."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from stylobate.probability import lognormal
from stylobate.verdicts.verdict import wilson_interval

#: Samples of a bootstrap.
SAMPLES = 200


def matthews(observed: np.ndarray, computed: np.ndarray) -> float:
    """Matthews' correlation of two rows of yes and no; NaN where one of them is all the same."""
    o, p = observed.astype(float), computed.astype(float)
    spread = o.std() * p.std()
    return float(((o - o.mean()) * (p - p.mean())).mean() / spread) if spread > 0.0 else math.nan


def score(observed: np.ndarray, computed: np.ndarray, hard: np.ndarray, chance: np.ndarray | None) -> dict[str, Any]:
    """All measures of one specimen, under the names of the JSON object.

    Parameters
    ----------
    observed, computed, hard : array of bool, shape (n,)
    chance : array, optional
        Computed probability of toppling [-], shape (n,).
    """
    right = observed == computed
    low, high = wilson_interval(right.sum(), len(right))
    return {
        "tests": len(observed),
        "accuracy": _share(right),
        "accuracy_low": float(low),
        "accuracy_high": float(high),
        "hard_tests": int(hard.sum()),
        "hard_accuracy": _share(right[hard]),
        "matthews": matthews(observed, computed),
        "observed": int(observed.sum()),
        "predicted": int(computed.sum()),
        "predicted_over_observed": float(computed.sum() / observed.sum()) if observed.any() else math.nan,
        "toppled_but_predicted_to_stand": int((observed & ~computed).sum()),
        "stood_but_predicted_to_topple": int((computed & ~observed).sum()),
        "brier": None if chance is None else float(((chance - observed) ** 2).mean()),
        "brier_of_the_mean": float(observed.mean() * (1.0 - observed.mean())),
    }


def _share(right: np.ndarray) -> float:
    return float(right.mean()) if len(right) else math.nan


def fragility(intensity: np.ndarray, toppled: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Median and dispersion of lognormal capacities by maximum likelihood, one per sample; NaN where all or none toppled.

    Parameters
    ----------
    intensity : array
        Shape (n,) or (S, n).
    toppled : array of bool
        Of the same shape.
    """
    x, toppled = np.atleast_2d(np.log(intensity)), np.atleast_2d(toppled)
    fit = lognormal.fit(np.where(toppled, -np.inf, x), np.where(toppled, x, np.inf))
    sound = np.isfinite(fit.log_median) & (toppled.any(axis=1)) & (~toppled.all(axis=1))
    return np.where(sound, np.exp(np.where(sound, fit.log_median, 0.0)), np.nan), np.where(sound, fit.beta, np.nan)


def with_interval(intensity: np.ndarray, toppled: np.ndarray, seed: int = 1) -> dict[str, float]:
    """Median [as the intensity] and dispersion of a fragility curve with 95 % intervals from a bootstrap over tests."""
    drawn = np.random.default_rng(seed).integers(0, len(intensity), (SAMPLES, len(intensity)))
    chosen = np.vstack((np.arange(len(intensity)), drawn))
    medians, betas = fragility(intensity[chosen], toppled[chosen])
    kept = medians[1:][np.isfinite(medians[1:])]
    low, high = np.percentile(kept, (2.5, 97.5)) if len(kept) else (math.nan, math.nan)
    return {
        "median": float(medians[0]),
        "median_low": float(low),
        "median_high": float(high),
        "beta": float(betas[0]),
    }


def half_toppled(
    pgv: np.ndarray, ratio: np.ndarray, observed: np.ndarray, computed: np.ndarray, bins: int = 4
) -> list[dict[str, Any]]:
    """PGV at which half of the tests topple, observed and computed, in bins of PGV/PGA with as many tests each.

    Parameters
    ----------
    pgv : array
        [m/s], shape (n,).
    ratio : array
        PGV/PGA [s], shape (n,).
    observed, computed : array of bool, shape (n,)
    bins : int
    """
    edges = np.quantile(ratio, np.linspace(0.0, 1.0, bins + 1))
    rows = []
    for low, high in itertools.pairwise(edges):
        here = (ratio >= low) & ((ratio < high) | (high == edges[-1]))
        row: dict[str, Any] = {"pgv_over_pga_from_s": low, "pgv_over_pga_to_s": high, "tests": int(here.sum())}
        for name, toppled in (("observed", observed), ("computed", computed)):
            curve = with_interval(pgv[here], toppled[here]) if here.any() else {}
            row |= {f"{name}_{key}": curve.get(key) for key in ("median", "median_low", "median_high", "beta")}
        rows.append(row)
    return rows


def reliability(chance: np.ndarray, observed: np.ndarray, bins: int = 5) -> list[dict[str, Any]]:
    """Mean computed probability and observed share of toppled in bins of the former, with Wilson's 95 % interval."""
    where = np.minimum((chance * bins).astype(int), bins - 1)
    rows = []
    for bin_number in range(bins):
        here = where == bin_number
        if not here.any():
            continue
        low, high = wilson_interval(observed[here].sum(), here.sum())
        rows.append(
            {
                "probability": float(chance[here].mean()),
                "observed": float(observed[here].mean()),
                "observed_low": float(low),
                "observed_high": float(high),
                "tests": int(here.sum()),
            }
        )
    return rows
