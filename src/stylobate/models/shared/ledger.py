"""The energy ledger that every model keeps, and the one measure of what it cannot account for.

A ledger is a row of six energies since the start of a run, in the order of ``TERMS``; input = the sum of the others +
what is not accounted for.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...messages import say

#: Terms of a ledger.
TERMS = ("input", "kinetic", "gravitational", "elastic", "friction", "viscous")

#: A run has failed when its ledger misses a larger share than this [-].
LARGEST_IMBALANCE = 0.25

#: Why a run has failed whose column overturns without the energy for it.
MADE_ENERGY = say(
    "the column overturns by energy that the steps have made: its input never was enough; shorten the time_step"
)


#: Why a run has failed in which what was at rest moves.
SET_OFF = say("what lay at rest began to move though the ground did nothing; shorten the time_step")


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
    return say(
        "the energy ledger is out of balance by {share:.2g} (allowed is {allowed}); shorten the time_step",
        share=share,
        allowed=allowed,
    )


#: At rest: for so long [s], no more kinetic energy than this share of what the weight stores in the contacts.
REST_TIME, REST_SHARE = 0.5, 1e-2


def set_off_by_itself(time: np.ndarray, base: np.ndarray, kinetic: np.ndarray, stored: float) -> str:
    """Why a run has failed in which what lies at rest gathers way while the ground does nothing; empty if it does not.

    What is in equilibrium and at rest stays so as long as the acceleration of the ground does not change: that it moves all
    the same is a fault of the law of contact or of the step, which no ledger shows where stones slide down.

    Parameters
    ----------
    time, base : array
        [s], shape (T,), and acceleration of the ground [m/s²], shape (T, 3).
    kinetic : array
        Kinetic energy [J], shape (T,), of a structure that was in equilibrium at the start.
    stored : float
        What its contacts store under its weight [J].
    """
    changes = np.flatnonzero((np.diff(base, axis=0) != 0.0).any(axis=1)) + 1
    for first, end in zip([0, *changes], [*changes, len(time)], strict=True):
        rested, since = first == 0 and not base[0].any(), math.inf
        for now, energy in zip(time[first:end], kinetic[first:end], strict=True):
            since = min(since, now) if energy <= REST_SHARE * stored else math.inf
            rested = rested or now - since >= REST_TIME
            if rested and energy > stored:
                return SET_OFF
    return ""
