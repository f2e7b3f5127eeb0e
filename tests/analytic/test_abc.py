"""The posterior of approximate Bayesian computation against exact ones."""

import numpy as np
import pytest
from scipy.stats import chi2, norm

from stylobate.analysis import abc

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


def test_draws_are_foretold_without_themselves(monkeypatch):
    # The closed form of what is left out (Allen 1974) against regressions that leave each of forty draws out in turn.
    monkeypatch.setattr(abc, "PENALTIES", np.array([1e-2]))
    stream = np.random.default_rng(2)
    features, targets = stream.standard_normal((40, 5)), stream.standard_normal((40, 2))
    own, found = abc.expected(features, targets, features)
    scaled = (features - features.mean(axis=0)) / features.std(axis=0)
    design = np.column_stack((np.ones(40), scaled))
    penalty = 1e-2 * np.linalg.svd(scaled, compute_uv=False)[0] ** 2 * np.diag([0.0, 1, 1, 1, 1, 1])
    for k in range(40):
        rest = np.delete(np.arange(40), k)
        line = np.linalg.solve(design[rest].T @ design[rest] + penalty, design[rest].T @ targets[rest])
        assert own[k] == pytest.approx(design[k] @ line, abs=1e-9)  # of numbers of order one, in double precision
    line = np.linalg.solve(design.T @ design + penalty, design.T @ targets)
    assert found == pytest.approx(design @ line, abs=1e-9)


def test_ranks_of_the_truth_are_even():
    # Simulation-based calibration of the same model: 300 truths, ten bins.
    theta, measured = conjugate()
    ranks = []
    for k in range(300):
        taken = abc.accepted(measured[300:3300], theta[300:3300, None], measured[k], 900)
        ranks.append(taken.weights[taken.targets[:, 0] < theta[k]].sum())
    counts, _ = np.histogram(ranks, 10, (0.0, 1.0))
    assert chi2.sf(((counts - 30.0) ** 2 / 30.0).sum(), 9) > 0.01


def test_what_tells_nothing_leaves_the_prior():
    theta, _ = conjugate()
    noise = np.random.default_rng(3).standard_normal((DRAWS, 4))
    taken = abc.accepted(noise, theta[:, None], np.zeros(4), 6000)
    assert abc.spread(taken.targets[:, 0], taken.weights) == pytest.approx(1.0, abs=0.04)  # 4 standard errors
    same = abc.accepted(np.zeros((DRAWS, 0)), theta[:, None], np.zeros(0), 10)
    assert len(same.which) == DRAWS
    assert np.array_equal(same.targets[:, 0], theta)


def test_likelihood_of_a_linear_model_is_exact():
    # What is left is Gaussian about a line in the parameter: the synthetic likelihood is the likelihood.
    theta, measured = conjugate()
    mean = measured.mean(axis=1, keepdims=True)
    weights = abc.likelihood_weights(mean, np.array([0.9]), theta[:, None])
    precision = 1.0 + 3.0 / SD**2
    assert np.average(theta, weights=weights) == pytest.approx(3.0 / SD**2 * 0.9 / precision, abs=0.02)
    assert abc.spread(theta, weights) == pytest.approx(precision**-0.5, rel=0.04)


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
