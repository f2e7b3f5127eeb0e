"""Settling under the own weight, by Cundall's local damping: the same for columns in lanes and for assemblies."""

from __future__ import annotations

from collections.abc import Callable

#: Share of the unbalanced force that acts against the velocity while something settles [-].
LOCAL_DAMPING = 0.8

#: Chunks of steps between two looks, of which there are at least so many however long the step.
CHUNKS, LOOKS = 100, 2


def settled(
    advance: Callable[[int], None],
    residual: Callable[[], float],
    allowed: float,
    most_chunks: int,
    lost: Callable[[], bool] = lambda: False,
) -> bool:
    """Advance with local damping until nothing accelerates any more.

    Parameters
    ----------
    advance : callable
        Takes a number of chunks of steps.
    residual : callable
        Largest acceleration of a body in its present position [m/s²].
    allowed : float
        Residual acceleration at which all has settled [m/s²].
    most_chunks : int
        After which it is given up.
    lost : callable
        Whether to give up at once.

    Returns
    -------
    bool
        Whether it has settled.
    """
    each = min(CHUNKS, max(1, most_chunks // LOOKS))
    for _ in range(max(most_chunks // each, 1)):
        advance(each)
        if lost():
            return False
        if residual() < allowed:
            return True
    return False
