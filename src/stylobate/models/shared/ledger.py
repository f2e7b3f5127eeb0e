"""The energy ledger that every model keeps, and the one measure of what it cannot account for.

A ledger is a row of six energies since the start of a run, in the order of ``TERMS``; input = the sum of the others +
what is not accounted for.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

#: Terms of a ledger.
TERMS = ("input", "kinetic", "gravitational", "elastic", "friction", "viscous")

#: A run has failed when its ledger misses a larger share than this [-].
LARGEST_IMBALANCE = 0.25

#: Why a run has failed whose column overturns without the energy for it.
MADE_ENERGY = (
    "the column overturns by energy that the steps have made: its input never was enough; shorten the time_step"
)


#: A ledger, as an array or as floats.
Row = np.ndarray | Sequence[float]


def unaccounted(row: Row) -> float:
    """Energy that a ledger misses [J]."""
    return abs(float(row[0] - (row[1] + row[2] + row[3] + row[4] + row[5])))


def released(row: Row) -> float:
    """By how much the potential energy, gravitational and elastic, is less than at the start [J]; 0 if it is more."""
    return max(0.0, -float(row[2] + row[3]))


def imbalance(missing: float, *, work: float, start: float, barrier: float, released: float) -> float:
    """Energy imbalance of a run [-]: what its ledger misses, over the largest energy that is at stake in it.  # Eq. (V3)

    A run with little input is measured by what it would take to overturn the column, a fall by what it sets free.

    Parameters
    ----------
    missing : float
        See :func:`unaccounted`; like all others in one unit, [J] or over the inertia [1/s²].
    work : float
        Largest input work so far.
    start : float
        Energy at the start, above that of the column upright and unloaded.
    barrier : float
        Lowest energy that overturns the column, 0 where there is none.
    released : float
        See :func:`released`.
    """
    return abs(missing) / max(work, start, barrier, released, 1e-300)


def out_of_balance(share: float, allowed: float = LARGEST_IMBALANCE) -> str:
    """Why a run with this energy imbalance has failed; empty if it has not. A share that is not finite is no balance."""
    if share <= allowed:
        return ""
    return f"the energy ledger is out of balance by {share:.2g} (allowed is {allowed}); shorten the time_step"
