"""Fragility: a lognormal curve fitted to what runs tell of a limit state, with what is known of it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..errors import InputError, check_choice, check_kind
from . import lognormal
from .evidence import Evidence, independent, intervals, medians_by_law
from .evidence import evidence as evidence_of
from .fragility_checks import check_bootstrap, check_number, check_shape
from .fragility_curve import Fragility
from .fragility_points import goodness, points_of
from .ida_curves import Ida
from .likelihood_region import dispersions, region
from .limit_states import EXCEEDED, NOT_EXCEEDED
from .unknown_law import under_another_law

#: Samples of the bootstrap.
SAMPLES = 1000

#: What counts: every run, or the capacity under each record.
METHODS = ("runs", "records")


def fragility(
    evidence: Evidence | Ida,
    *,
    method: str | None = None,
    samples: int = SAMPLES,
    seed: int = 0,
    confidence: float = 0.95,
    records_are_one: bool = False,
) -> Fragility:
    """Fit a lognormal fragility.

    Parameters
    ----------
    evidence : Evidence or Ida
        An incremental dynamic analysis is taken for collapse over its own measure; for another limit state or measure
        give ``st.evidence(ida, measure, state)``.
    method : str, optional
        ``runs`` or ``records``, see :class:`Fragility`; by default ``records`` for an IDA whose levels were hunted, and
        ``runs`` for all else, an IDA of given levels among it. ``Fragility.method`` and its summary tell which it is.
    samples : int
        Of the bootstrap, 40 or more.
    seed : int
        Of the bootstrap, from 0.
    confidence : float
        Of the intervals, between 0 and 1 [-].
    records_are_one : bool
        Runs of few records count as if each had a record of its own: the curve is then that of these records.

    Returns
    -------
    Fragility

    Raises
    ------
    InputError
        Fewer than ten records of which a run is decided; no run that exceeds the state, or none that does not; all runs at
        one intensity; or runs that exceed it no oftener where the intensity is larger: that is no fragility.
    """
    check_bootstrap(samples, seed, confidence)
    check_choice("`method`", method, (None, *METHODS))
    if isinstance(evidence, Ida):
        evidence = evidence_of(evidence)
    check_kind("evidence", evidence, Evidence, allowed="an Evidence, or an Ida")
    clusters = np.arange(len(evidence.im)).astype(str).astype(object)
    used = replace(evidence, records=clusters, curves=None) if records_are_one else evidence
    check_number(used, records_are_one)
    how = method or ("records" if evidence.brackets and not records_are_one else "runs")
    codes = evidence.codes
    low, high, owner = intervals(used, codes, how)
    best = lognormal.fit(low, high)
    check_shape(used, low, high, best)
    log_median, beta = (float(one[0]) for one in best)
    rng = np.random.default_rng(seed)
    extremes = []
    for counted in (EXCEEDED, NOT_EXCEEDED):
        one = lognormal.fit(*intervals(used, np.where(codes < 0, counted, codes), how)[:2])
        extremes.append(
            (math.nan, math.nan) if lognormal.falls(one) else (float(one.log_median[0]), float(one.beta[0]))
        )
    points = points_of(used, codes, how, both_ways=True)
    distance, p_value = goodness(used, how, points, log_median, beta, rng)
    found = _with_laws(Fragility(
        used, how, log_median, beta, *_known(low, high, owner, how, samples, rng, confidence), (extremes[0], extremes[1]),
        points, distance, p_value, confidence, records_are_one,
    ), rng)  # fmt: skip
    if (codes >= 0).all():
        return found
    return replace(found, ends=tuple(_ended(found, counted, samples, seed) for counted in (EXCEEDED, NOT_EXCEEDED)))


def _known(
    low: np.ndarray,
    high: np.ndarray,
    owner: np.ndarray,
    method: str,
    samples: int,
    rng: np.random.Generator,
    confidence: float,
) -> tuple[np.ndarray, np.ndarray, tuple[float, float], tuple[float, float] | None]:
    """Curve through intervals of ln capacity: samples, region, dispersions and bracket."""
    below, above = float(low.max()), float(high.min())
    weight, number = independent(low, high, owner, method)
    return (
        lognormal.bootstrap(low, high, owner, samples, rng),
        region(low, high, weight, number, confidence),
        dispersions(low, high, weight, number, confidence),
        (math.exp(below), math.exp(above)) if below <= above else None,
    )


def _ended(found: Fragility, counted: int, samples: int, seed: int) -> Fragility | None:
    """The curve as if every run without a verdict had come to the same one; None where that is none."""
    one = found.evidence
    one = replace(one, codes=np.where(one.codes < 0, counted, one.codes))
    low, high, owner = intervals(one, one.codes, found.method)
    best, rng = lognormal.fit(low, high), np.random.default_rng(seed)
    try:
        check_shape(one, low, high, best)
    except InputError:
        return None
    known = _known(low, high, owner, found.method, samples, rng, found.confidence)
    names = ("samples", "region", "dispersions", "bracket")
    middle, spread = (float(each[0]) for each in best)
    return _with_laws(replace(found, evidence=one, log_median=middle, beta=spread, **dict(zip(names, known))), rng)


def _with_laws(found: Fragility, rng: np.random.Generator) -> Fragility:
    """The curve with samples that draw one more law of the joints, where the runs are of several."""
    e = found.evidence
    if e.laws is None:
        return found
    away = under_another_law(medians_by_law(e, e.codes, found.method), len(found.samples), rng)
    return replace(
        found, samples=found.samples + np.stack((away, np.zeros(len(away))), axis=1), samples_of_columns=found.samples
    )
