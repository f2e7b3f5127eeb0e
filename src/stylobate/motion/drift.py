"""Which conditioning takes the drift off a record: tried, not guessed, so that none is named that does not help."""

from __future__ import annotations

import warnings

import numpy as np

from ..errors import InputError
from .integration import displacement
from .motion import Motion, integrate

#: A displacement that has not come back by the end of a record is drift from this share of its peak on [-], where it
#: also exceeds what a column would be surveyed to [m].
DRIFT_SHARE, SMALLEST_DRIFT = 0.5, 0.1

#: The ground is not at rest at the end beyond this share of its peak velocity [-]; that counts above so much [m/s].
RESIDUAL_SHARE, SMALLEST_RESIDUAL = 0.05, 0.01

#: Steps that are tried, each with the longest period that it must be able to see [s], and which shares of the peak
#: acceleration and of the peak velocity must stay [-].
CURES, KEPT, KEPT_VELOCITY = (
    {"baseline": 0.0, "detrend": 0.0, "demean": 0.0, "highpass=0.05Hz": 20.0, "highpass=0.1Hz": 10.0}, 0.95, 0.9
)  # fmt: skip


def drift_of(values: np.ndarray, dt: float) -> float:
    """Displacement at the end, where it makes most of the peak and more than 0.1 m; else 0 [m].

    Parameters
    ----------
    values : array
        Accelerations [m/s²].
    dt : float
        [s]
    """
    path = displacement(values, dt)
    last = float(path[-1])
    return last if abs(last) > max(DRIFT_SHARE * float(np.abs(path).max()), SMALLEST_DRIFT) else 0.0


def cure_of(values: np.ndarray, dt: float, fastest: float = np.inf) -> str | None:
    """The step of conditioning after which a component neither drifts nor moves at its end; None if there is none.

    Of several the one that leaves the smallest displacement, as drift within the record is what makes it large, unless it
    takes the shaking with it: more than a tenth of the record's own peak velocity, that of a record which still moves at its
    end without a straight line in its acceleration. No filter is named whose period is longer than the record.

    Parameters
    ----------
    values, dt
        As of :func:`drift_of`.
    fastest : float
        Velocity that it must not exceed either [m/s].
    """
    from .condition_specs import conditioned

    peak, found, tops = float(np.abs(values).max()), [], {}
    for step in (one for one, period in CURES.items() if period <= dt * (len(values) - 1)):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                mended = conditioned(Motion(dt, values), step).components["x"]
        except InputError:  # too short for it
            continue
        tops[step], rests = _velocity(mended, dt)
        same = KEPT <= float(np.abs(mended).max()) / peak <= 1.0 / KEPT if peak else False
        if same and rests and tops[step] <= fastest and not drift_of(mended, dt):
            found.append((float(np.abs(displacement(mended, dt)).max()), tops[step], step))
    own, rests = _velocity(values, dt)
    least = KEPT_VELOCITY * (
        own if rests else min((tops[one] for one in ("detrend", "demean") if one in tops), default=own)
    )
    return min((one for one in found if one[1] >= least), default=(0.0, 0.0, None))[2]


def _velocity(values: np.ndarray, dt: float) -> tuple[float, bool]:
    """Peak velocity of a component [m/s], and whether it is at rest at its end."""
    velocity = np.abs(integrate(values, dt))
    top = float(velocity.max())
    return top, bool(velocity[-1] <= max(RESIDUAL_SHARE * top, SMALLEST_RESIDUAL))
