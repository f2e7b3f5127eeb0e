"""Which conditioning takes the drift off a record: tried, not guessed, so that none is named that does not help."""

from __future__ import annotations

import warnings
from collections.abc import Mapping

import numpy as np

from ..errors import InputError
from .motion import Motion, displacement, integrate, square_integral

#: A displacement that has not come back by the end of a record is drift from this share of its peak on [-], where it
#: also exceeds what a column would be surveyed to [m].
DRIFT_SHARE, SMALLEST_DRIFT = 0.5, 0.1

#: The ground is not at rest at the end beyond this share of its peak velocity [-]; that counts above so much [m/s].
RESIDUAL_SHARE, SMALLEST_RESIDUAL = 0.05, 0.01

#: Filters that are tried, the one that takes least first, each with the longest period that it must be able to see [s].
FILTERS = {"highpass=0.05Hz": 20.0, "highpass=0.1Hz": 10.0}

#: Steps that are tried with their longest periods [s], several in a row joined by :data:`THEN`.
THEN = " + "
CURES = {
    "baseline": 0.0,
    "detrend": 0.0,
    "demean": 0.0,
    **FILTERS,
    **{f"demean{THEN}{k}": t for k, t in FILTERS.items()},
}

#: Shares of the peak acceleration and of the peak velocity that must stay [-].
KEPT, KEPT_VELOCITY = 0.95, 0.9

#: Most of the displacement at the end that shaking makes between 5 and 95 % of its Arias intensity where it is drift [-].
WITHIN_SHAKING = 0.5


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


def cure_of(motion: Motion) -> str | None:
    """The conditioning after which no component of a motion that drifts does so any more, nor moves at its end.

    A step, or ``demean + highpass=0.1Hz`` where no single step does as well; None where nothing that is tried does. Of
    several the one that leaves the smallest displacement, as drift within the record is what makes it large.
    """
    dt = motion.dt
    drifting = [values for values in motion.components.values() if drift_of(values, dt)]
    outside = any(_outside_shaking(values, dt) for values in drifting)  # of one component: the recorder drifts
    each = [cures_of(values, dt, outside=outside) for values in drifting]
    left = {one: max(found[one] for found in each) for one in CURES if each and all(one in found for found in each)}
    return best_of(left)


def best_of(left: Mapping[str, float]) -> str | None:
    """Of conditionings with the displacements that they leave, the one that leaves least; two steps must halve it."""
    return min(left, key=lambda one: left[one] * len(one.split(THEN)), default=None)


def cures_of(values: np.ndarray, dt: float, fastest: float = np.inf, *, outside: bool = False) -> dict[str, float]:
    """What of :data:`CURES` ends the drift of a component and the motion at its end, with the largest displacement left [m].

    None that takes the shaking with it: more than a tenth of the record's own peak velocity, that of a record which still
    moves at its end without a straight line in its acceleration. Where most of the displacement comes before and after the
    shaking, the peak velocity is that of the drift, and what the gentlest filter leaves counts as the record's own. No
    filter whose period is longer than the record.

    Parameters
    ----------
    values, dt
        As of :func:`drift_of`.
    fastest : float
        Velocity that it must not exceed either [m/s].
    outside : bool
        It is known from another component that the displacement comes before and after the shaking.
    """
    peak, left, tops = float(np.abs(values).max()), {}, {}
    for step in (one for one, period in CURES.items() if period <= dt * (len(values) - 1)):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                mended = cured(Motion(dt, values), step).components["x"]
        except InputError:  # too short for it
            continue
        tops[step], rests = _velocity(mended, dt)
        same = KEPT <= float(np.abs(mended).max()) / peak <= 1.0 / KEPT if peak else False
        if same and rests and tops[step] <= fastest and not drift_of(mended, dt):
            left[step] = float(np.abs(displacement(mended, dt)).max())
    own, rests = _velocity(values, dt)
    if outside or _outside_shaking(values, dt):
        own = next((tops[one] for one in FILTERS if one in tops), own)
    elif not rests:
        own = min((tops[one] for one in ("detrend", "demean") if one in tops), default=own)
    return {step: size for step, size in left.items() if tops[step] >= KEPT_VELOCITY * own}


def cured(motion: Motion, cure: str) -> Motion:
    """A motion after the conditioning that :func:`cure_of` names."""
    from .condition_specs import conditioned

    for step in cure.split(THEN):
        motion = conditioned(motion, step)
    return motion


def as_asked(cure: str) -> str:
    """How to ask for the conditioning that :func:`cure_of` names."""
    return ", then ".join(f"`condition={step!r}`" for step in cure.split(THEN))


def _outside_shaking(values: np.ndarray, dt: float) -> bool:
    """Whether most of the displacement at the end comes before and after the shaking, as drift does and no fault's slip."""
    growth, path = square_integral(values, dt), displacement(values, dt)
    first, last = np.searchsorted(growth, [0.05 * growth[-1], 0.95 * growth[-1]])
    return bool(abs(path[last] - path[first]) < WITHIN_SHAKING * abs(path[-1]))


def _velocity(values: np.ndarray, dt: float) -> tuple[float, bool]:
    """Peak velocity of a component [m/s], and whether it is at rest at its end."""
    velocity = np.abs(integrate(values, dt))
    top = float(velocity.max())
    return top, bool(velocity[-1] <= max(RESIDUAL_SHARE * top, SMALLEST_RESIDUAL))
