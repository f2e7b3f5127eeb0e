"""Share of columns that collapse where the law of their joints is not known: what columns of a few laws say of another.

Columns of one law share what is not known of all joints alike: β, c, stiffness, where a face carries. Under law g the share
that collapses is p_g, and the laws' shares follow a beta distribution of mean m and intraclass correlation r:

    p_g ~ Beta(m (1 − r)/r, (1 − m)(1 − r)/r),   k_g ~ Binomial(n_g, p_g)

The truth is one more law. What is known of its share is the mean of these distributions over m and r after what was
counted, with m even from 0 to 1 before, and r as :data:`ALIKE`. Of medians and of differences, which every law has over the
same records, one more is foretold from the mean and spread of the few (:func:`under_another_law`).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ..campaign.twins import PER_LAW
from ..messages import say
from . import verdicts as v

#: Exponents of the density of r before anything is counted, (1 − r)³: its mean 0.2 is about that of the counts of other
#: pages, 2, 18 and 0 of 24 (r = 0.5), 4, 10 and 1 of 16 (0.2), and 11 to 19 of 25 (0.05).
ALIKE = 3.0

#: Values of m and r that are looked at.
MEANS, CORRELATIONS = 61, 30

#: Laws of the joints from fewer than which how much they decide is not told.
FEW_LAWS = 4

#: Shares are told by hundredths: limits nearer to none or to all of the columns than that are none, and all.
FINEST = 100


def share_limits(
    verdicts: np.ndarray, groups: Sequence[int], confidence: float = 0.95
) -> tuple[np.ndarray, np.ndarray]:
    """Confidence limits of the probability of collapse over twins of a column, whatever undecided ones come to.

    Parameters
    ----------
    verdicts : array of str, shape (…, twins)
    groups : sequence of int, shape (twins,)
        Law of the joints of each; empty where all have that of the column. Limits are then those of
        :func:`stylobate.analysis.verdicts.collapse_interval`, else they hold those under one more law as well.
    confidence : float
    """
    low, high = v.collapse_interval(*v.tally(verdicts, axis=-1), confidence)
    if not len(groups):
        return low, high
    low, high, law = np.array(low), np.array(high), np.eye(max(groups) + 1, dtype=int)[list(groups)]
    kinds = ((v.COLLAPSED,), (v.COLLAPSED, v.UNDECIDED), (v.COLLAPSED, v.STANDS, v.UNDECIDED))
    fell, may, number = (np.isin(verdicts, kind) @ law for kind in kinds)
    for cell in np.ndindex(low.shape):
        low[cell] = min(low[cell], share_under_another_law(fell[cell], number[cell], confidence)[0])
        high[cell] = max(high[cell], share_under_another_law(may[cell], number[cell], confidence)[1])
    return low, high


def under_another_law(values: np.ndarray, samples: int, rng: np.random.Generator) -> np.ndarray:
    """How far what one more law comes to may lie from the mean of a few, drawn so many times.

    Values of laws follow a normal distribution of which nothing else is known, so that one more of G differs from their mean
    by s √(1 + 1/G) times Student's t of G − 1.

    Parameters
    ----------
    values : array, shape (G,)
        Of each law, over the same records; infinite where its runs only tell a bound, NaN where they tell nothing: the draws
        on that side are infinite then, as they are on both of fewer than two.
    samples : int
    rng : numpy.random.Generator

    Returns
    -------
    array, shape (samples,)
    """
    freedom, below, above = _foretold(values)
    draws = rng.standard_t(freedom, samples)
    return draws * np.where(draws > 0.0, above, below)


def limits_under_another_law(values: np.ndarray, confidence: float = 0.95) -> tuple[float, float]:
    """Limits of what one more law comes to: the mean of what is finite, less and more what :func:`under_another_law` draws.

    Parameters
    ----------
    values : array, shape (G,)
        As there.
    confidence : float
    """
    from scipy.special import stdtrit

    freedom, below, above = _foretold(values)
    far, known = float(stdtrit(freedom, 0.5 + 0.5 * confidence)), values[np.isfinite(values)]
    middle = float(known.mean()) if len(known) else 0.0
    return middle - far * below, middle + far * above


def _foretold(values: np.ndarray) -> tuple[int, float, float]:
    """Degrees of freedom of what one more law comes to, and its spread s √(1 + 1/G) to below and to above the mean."""
    known = values[np.isfinite(values)]
    if len(known) < 2:
        return 1, np.inf, np.inf
    spread = float(known.std(ddof=1) * np.sqrt(1.0 + 1.0 / len(known)))
    told_by_none = np.isnan(values).any()
    below, above = (
        np.inf if told_by_none or end.any() else spread for end in (np.isneginf(values), np.isposinf(values))
    )
    return len(known) - 1, below, above


def few_laws(number: int) -> str:
    """Caveat on twins of so few laws; empty where there are enough, or none as one is taken as known."""
    if not 0 < number < FEW_LAWS:
        return ""
    some = (
        say("the twins share 1 law of the joints") if number == 1 else say("the twins share {count} laws of the joints")
    )
    more = say(
        ", too few to tell how much it decides: give more replicates, of which every {each} share one, such as {such}"
    )
    return some.of(count=number) + more.of(each=PER_LAW, such=FEW_LAWS * PER_LAW)


def share_under_another_law(
    fell: Sequence[int] | np.ndarray, number: Sequence[int] | np.ndarray, confidence: float = 0.95
) -> tuple[float, float]:
    """Limits of the share of columns that collapse under one more law.

    Parameters
    ----------
    fell, number : sequence of int
        Columns that collapsed, and all of them, law by law.
    confidence : float
    """
    return _limits(tuple(sorted(zip(map(int, fell), map(int, number), strict=True))), confidence)


@lru_cache(maxsize=4096)
def _limits(counted: tuple[tuple[int, int], ...], confidence: float) -> tuple[float, float]:
    """The same of laws in any order; cells of a grid and amplitudes of a curve often count alike."""
    from scipy.special import betaln

    k, n = np.array(counted, dtype=float).T
    a, b, before, shares, below_each = _before()
    seen = sum(betaln(a + one, b + all_ - one) - betaln(a, b) for one, all_ in zip(k, n, strict=True))
    weight = np.exp(seen - np.max(seen)) * before
    below = np.tensordot(below_each, weight / weight.sum(), axes=2)
    outside = 0.5 * (1.0 - confidence)
    low = 0.0 if below[0] > outside or not k.sum() else float(np.interp(outside, below, shares))
    high = 1.0 if below[-1] < 1.0 - outside or k.sum() == n.sum() else float(np.interp(1.0 - outside, below, shares))
    return low, high


@lru_cache(maxsize=1)
def _before() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Exponents of the beta distributions over m and r, their weight before anything is counted, and how much of each lies
    below every share that is told."""
    from scipy.special import betainc

    m = (np.arange(MEANS) + 0.5) / MEANS
    r = (np.arange(CORRELATIONS) + 0.5) / CORRELATIONS
    a, b = m[:, None] * (1.0 - r) / r, (1.0 - m[:, None]) * (1.0 - r) / r
    shares = np.arange(1, FINEST) / FINEST
    return a, b, (1.0 - r) ** ALIKE, shares, np.array([betainc(a, b, x) for x in shares])
