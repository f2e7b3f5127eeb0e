"""Share of columns that collapse where the law of their joints is not known: what columns of a few laws say of another.

Columns of one law share what is not known of all joints alike: β, c, stiffness, where a face carries. Under law g the share
that collapses is p_g, and the laws' shares follow a beta distribution of mean m and intraclass correlation r:

    p_g ~ Beta(m (1 − r)/r, (1 − m)(1 − r)/r),   k_g ~ Binomial(n_g, p_g)

The truth is one more law. What is known of its share is the mean of these distributions over m and r after what was
counted, with m even from 0 to 1 before, and r as :data:`ALIKE`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

#: Exponents of the density of r before anything is counted, (1 − r)³: its mean 0.2 is about that of the counts of other
#: pages, 2, 18 and 0 of 24 (r = 0.5), 4, 10 and 1 of 16 (0.2), and 11 to 19 of 25 (0.05).
ALIKE = 3.0

#: Values of m and r that are looked at.
MEANS, CORRELATIONS = 61, 30

#: Shares are told by hundredths: limits nearer to none or to all of the columns than that are none, and all.
FINEST = 100


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
    from scipy.special import betainc, betaln

    k, n = np.asarray(fell, dtype=float), np.asarray(number, dtype=float)
    m = (np.arange(MEANS) + 0.5) / MEANS
    r = (np.arange(CORRELATIONS) + 0.5) / CORRELATIONS
    a, b = m[:, None] * (1.0 - r) / r, (1.0 - m[:, None]) * (1.0 - r) / r
    seen = sum(betaln(a + one, b + all_ - one) - betaln(a, b) for one, all_ in zip(k, n, strict=True))
    weight = np.exp(seen - np.max(seen)) * (1.0 - r) ** ALIKE
    weight /= weight.sum()
    shares = np.arange(1, FINEST) / FINEST
    below = np.array([float((weight * betainc(a, b, x)).sum()) for x in shares])
    outside = 0.5 * (1.0 - confidence)
    low = 0.0 if below[0] > outside or not k.sum() else float(np.interp(outside, below, shares))
    high = 1.0 if below[-1] < 1.0 - outside or k.sum() == n.sum() else float(np.interp(1.0 - outside, below, shares))
    return low, high
