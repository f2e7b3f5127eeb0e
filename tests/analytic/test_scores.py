"""Scores of predictions: Matthews, Brier, fragility and reliability against closed forms."""

import math

import numpy as np
import pytest
from scipy.special import ndtr

from stylobate_studies.experiments import scores


def test_matthews_of_a_table_by_hand():
    """6 and 3 right, 1 and 2 wrong: (6·3 − 1·2)/√(7·8·4·5)."""
    observed = np.array([True] * 8 + [False] * 4)
    computed = np.array([True] * 6 + [False] * 2 + [True] * 1 + [False] * 3)
    assert scores.matthews(observed, computed) == pytest.approx((6 * 3 - 1 * 2) / math.sqrt(7 * 8 * 4 * 5))
    assert math.isnan(scores.matthews(observed, np.ones(12, dtype=bool)))


def test_score_counts_what_it_says():
    observed, computed = np.array([1, 1, 0, 0], dtype=bool), np.array([1, 0, 0, 1], dtype=bool)
    hard, chance = np.array([True, True, False, False]), np.array([0.9, 0.4, 0.0, 0.5])
    score = scores.score(observed, computed, hard, chance)
    assert (score["accuracy"], score["hard_accuracy"], score["hard_tests"]) == (0.5, 0.5, 2)
    assert score["predicted_over_observed"] == 1.0
    assert score["brier"] == pytest.approx((0.01 + 0.36 + 0.0 + 0.25) / 4)
    assert scores.score(observed, computed, hard, None)["brier"] is None


def test_a_fragility_curve_is_found_again():
    rng = np.random.default_rng(3)
    pgv = np.exp(rng.uniform(-3.0, 1.0, 4000))
    toppled = rng.uniform(size=4000) < ndtr(np.log(pgv / 0.3) / 0.5)
    (median,), (beta,) = scores.fragility(pgv, toppled)
    assert median == pytest.approx(0.3, rel=0.06)  # three standard errors
    assert beta == pytest.approx(0.5, rel=0.12)
    assert np.isnan(scores.fragility(pgv, np.zeros(4000, dtype=bool))[0]).all()


def test_an_interval_holds_its_median():
    rng = np.random.default_rng(1)
    pgv = np.exp(rng.uniform(-2.0, 0.0, 60))
    interval = scores.with_interval(pgv, pgv > 0.4 * np.exp(rng.normal(0.0, 0.3, 60)))
    assert interval["median_low"] < interval["median"] < interval["median_high"]


def test_reliability_of_what_is_reliable():
    rng = np.random.default_rng(2)
    chance = rng.uniform(size=5000)
    rows = scores.reliability(chance, rng.uniform(size=5000) < chance)
    assert sum(row["tests"] for row in rows) == 5000
    assert all(row["observed_low"] < row["probability"] < row["observed_high"] for row in rows)
