"""The posterior of approximate Bayesian computation against exact ones."""

import numpy as np
import pytest
from scipy.stats import chi2, norm

from stylobate_ruins import abc

#: Draws of the prior; standard deviation of what is measured.
DRAWS, SD = 20_000, 0.5


def conjugate(seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Standard normal parameters, and three measurements of each with normal errors."""
    stream = np.random.default_rng(seed)
    theta = stream.standard_normal(DRAWS)
    return theta, theta[:, None] + SD * stream.standard_normal((DRAWS, 3))


@pytest.mark.parametrize("mean", [-1.2, 0.0, 0.7])
def test_posterior_of_a_normal_mean(mean):
    # Conjugate: precision 1 + 3/sd², mean by its share. 6000 draws of weight up to 1: standard errors of mean and spread are
    # 1.5 % of the spread; four of them are let through.
    theta, measured = conjugate()
    precision = 1.0 + 3.0 / SD**2
    exact, spread = 3.0 / SD**2 * mean / precision, precision**-0.5
    taken = abc.accepted(measured, theta[:, None], np.full(3, mean), 6000)
    values = taken.targets[:, 0]
    assert np.average(values, weights=taken.weights) == pytest.approx(exact, abs=0.06 * spread)
    assert abc.spread(values, taken.weights) == pytest.approx(spread, rel=0.06)
    low, middle, high = abc.quantiles(values, taken.weights)
    assert (low, middle, high) == pytest.approx(exact + spread * norm.ppf(abc.SHARES), abs=0.12 * spread)


def test_ridge_regression_is_that_of_its_normal_equations(monkeypatch):
    monkeypatch.setattr(abc, "PENALTIES", np.array([1e-2]))
    stream = np.random.default_rng(2)
    features, targets = stream.standard_normal((40, 5)), stream.standard_normal((40, 2))
    scaled = (features - features.mean(axis=0)) / features.std(axis=0)
    design = np.column_stack((np.ones(40), scaled))
    penalty = 1e-2 * np.linalg.svd(scaled, compute_uv=False)[0] ** 2 * np.diag([0.0, 1, 1, 1, 1, 1])
    line = np.linalg.solve(design.T @ design + penalty, design.T @ targets)
    # of numbers of order one, in double precision
    assert abc.expected(features, targets, features) == pytest.approx(design @ line, abs=1e-9)


def test_ranks_of_the_truth_are_even():
    # Simulation-based calibration of the same model: 300 truths, ten bins.
    theta, measured = conjugate()
    ranks = []
    for k in range(300):
        taken = abc.accepted(measured[300:3300], theta[300:3300, None], measured[k], 900)
        ranks.append(taken.weights[taken.targets[:, 0] < theta[k]].sum())
    counts, _ = np.histogram(ranks, 10, (0.0, 1.0))
    assert chi2.sf(((counts - 30.0) ** 2 / 30.0).sum(), 9) > 0.01


@pytest.mark.parametrize("features", [0, 1, 2, 6, 30])
@pytest.mark.parametrize("draws", [350, 4000])
def test_what_tells_nothing_leaves_the_prior(draws, features):
    # Features that are noise, few or many: means stay within four of their standard errors, and so do standard deviations.
    stream = np.random.default_rng([draws, features])
    targets = stream.standard_normal((draws, 4))
    taken = abc.accepted(
        stream.standard_normal((draws, features)), targets, np.zeros(features), max(100, int(0.3 * draws))
    )
    for prior, after in zip(targets.T, taken.targets.T, strict=True):
        error = taken.effective**-0.5
        assert np.average(after, weights=taken.weights) == pytest.approx(prior.mean(), abs=4.0 * error)
        assert abc.spread(after, taken.weights) == pytest.approx(prior.std(), rel=4.0 * error / 2.0**0.5)


@pytest.mark.parametrize("noise", [1, 8])
def test_intervals_hold_the_truth_with_and_without_what_tells(noise):
    # 300 truths, each beside draws of its own: one parameter of which a feature tells something, one of which none does.
    stream, inside = np.random.default_rng(5), []
    for _ in range(300):
        theta = stream.standard_normal((401, 2))
        features = np.column_stack(
            (theta[:, 0] + SD * stream.standard_normal(401), stream.standard_normal((401, noise)))
        )
        taken = abc.accepted(features[1:], theta[1:], features[0], 120)
        ends = [abc.quantiles(taken.targets[:, k], taken.weights)[[0, 2]] for k in range(2)]
        inside.append([low <= true <= high for (low, high), true in zip(ends, theta[0], strict=True)])
    assert np.mean(inside, axis=0) == pytest.approx(0.9, abs=3.0 * (0.09 / 300) ** 0.5)


def test_fewer_draws_give_wider_intervals():
    # Nine draws part a line into ten pieces of which the next is as likely in any (Weibull); what weighs nothing is none.
    nine, ones = np.arange(1.0, 10.0), np.ones(9)
    assert abc.quantiles(nine, ones, (0.1, 0.5, 0.9)) == pytest.approx([1.0, 5.0, 9.0])
    doubled = np.append(nine, nine), np.append(ones, np.zeros(9))
    assert abc.quantiles(*doubled, (0.1, 0.5, 0.9)) == pytest.approx([1.0, 5.0, 9.0])
    many = np.linspace(1.0, 9.0, 1000)
    assert abc.quantiles(many, np.ones(1000))[0] > abc.quantiles(nine, ones)[0]


def test_scores_are_normal_and_go_back():
    values = np.random.default_rng(1).lognormal(size=4000)
    scores = abc.Scores(values)
    assert scores.scores.mean() == pytest.approx(0.0, abs=1e-9)  # symmetric by construction
    assert scores.scores.std() == pytest.approx(1.0, abs=2e-3)
    assert scores.value(scores.scores) == pytest.approx(values, rel=1e-12)
    assert scores.value(np.array([-99.0, 99.0])) == pytest.approx([values.min(), values.max()])


def test_directions_go_round():
    # 170° and 10° of axes are 20° apart, their middle is 0; of directions it is 90°.
    ones = np.ones(2)
    assert abc.apart(0.0, abc.middle_direction(np.array([170.0, 10.0]), ones, 180.0), 180.0) == pytest.approx(
        0.0, abs=1e-9
    )
    assert abc.middle_direction(np.array([170.0, 10.0]), ones, 360.0) == pytest.approx(90.0)
    even = np.arange(0.0, 180.0, 0.01)
    assert abc.spread_around(even, np.ones(len(even)), 180.0) == pytest.approx(180.0 / np.sqrt(12.0), rel=1e-3)
    low, middle, high = abc.quantiles_around(np.array([175.0, 178.0, 1.0, 4.0, 7.0]), np.ones(5), 180.0)
    assert high - low < 15.0
    assert abc.apart(middle, 1.0, 180.0) == pytest.approx(0.0, abs=0.5)
