"""Statistics of many tests: published intervals, closed forms, and how often a verdict is wrong."""

import math

import numpy as np
import pytest

from stylobate_studies.experiments import distributions as d


def test_the_difference_of_shares_has_the_limits_that_newcombe_prints():
    """Newcombe 1998, Statistics in Medicine 17, 873–890, table II, case (a): 56 of 70 and 48 of 80, 0.0524 to 0.3339."""
    first, other = (np.repeat([1.0, 0.0], (k, n - k)) for k, n in ((48, 80), (56, 70)))
    difference = d.share_difference(first, other[:, None])
    assert difference == pytest.approx((0.2, 0.0524, 0.3339), abs=5e-5)


def test_shares_of_tests_that_all_stand_leave_open_what_their_number_does():
    """Wilson's limit of none of n is z²/(n + z²)."""
    difference = d.share_difference(np.zeros(6), np.zeros((6, 4)))
    assert (difference.high, difference.low) == pytest.approx((3.8415 / 9.8415, -3.8415 / 9.8415), abs=1e-4)


def test_distance_of_two_distributions_by_hand():
    """Of 1, 2, 3, 4 and 3, 4, 5, 6 it is a half; the interval is as wide as Massart says."""
    distance = d.distance(np.arange(1.0, 5.0), np.arange(3.0, 7.0)[:, None])
    assert distance.value == 0.5
    assert d.distance(np.arange(400.0), np.arange(200.0, 600.0)[:, None]).low == pytest.approx(
        0.5 - 2.0 * math.sqrt(math.log(80.0) / 800.0)
    )


def test_what_falls_exceeds_every_size():
    assert d.median(np.array([1.0, np.inf, np.inf])) == np.inf
    assert math.isnan(d.median_ratio(np.full(12, np.inf), np.full((12, 2), np.inf)).value)
    difference = d.compared("median", np.full(12, np.inf), np.full((12, 2), np.inf), np.full((12, 2), np.inf))
    assert d.verdict("median", difference, 2.0) == "open"


def test_a_few_tests_say_nothing_of_medians():
    ratio = d.median_ratio(np.ones(9), np.ones((9, 1)))
    assert (ratio.value, ratio.low, ratio.high) == (1.0, 0.0, math.inf)


@pytest.mark.processor
@pytest.mark.parametrize("score", ["share", "median", "distribution"])
def test_what_is_alike_is_never_far_apart_and_what_is_not_is_found(score):
    """200 sets of 60 tests with 5 realisations, all of one distribution: 2.5 % of the intervals may lie on one side of
    the truth, and 13 of 200 is three standard deviations more. Of 40 against twice the size two in three at least are
    told apart, 26 less three standard deviations of 3 and a little."""
    rng = np.random.default_rng(5)
    tolerance = {"share": 0.05, "median": 1.05, "distribution": 0.05}[score]

    def drawn(shape, size):
        return rng.uniform(size=shape) < 0.25 * size if score == "share" else size * rng.lognormal(0.0, 0.5, shape)

    verdicts = {1.0: [], 2.0: []}
    for size in verdicts:
        for _ in range(200 if size == 1.0 else 40):
            low = drawn((60, 5), size).astype(float)
            comparison = d.compared(score, drawn(60, 1.0).astype(float), low, low)
            verdicts[size].append(d.verdict(score, comparison, tolerance))
    assert verdicts[1.0].count("outside") <= 13
    assert verdicts[2.0].count("outside") >= 15
