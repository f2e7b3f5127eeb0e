"""Time columns: equal steps recognised as such, unequal ones resampled and said so."""

from __future__ import annotations

import math

import numpy as np

from ...errors import InputError
from ...messages import say
from ..motion import MAX_SAMPLES
from .checks import check_sampling
from .component import Component

#: Departure from equal steps that is rounding of the printed times, as a share of the step.
ROUNDING_SHARE = 0.05


def step_of(time: np.ndarray) -> float | None:
    """Step of times that are equally spaced but for rounding [s], or None."""
    if len(time) < 2 or not time[-1] > time[0]:
        return None
    dt = float((time[-1] - time[0]) / (len(time) - 1))
    grid = time[0] + dt * np.arange(len(time))
    if np.abs(time - grid).max() > ROUNDING_SHARE * dt:
        return None
    # The step as it was meant: the shortest decimal that fits all the times as well.
    for digits in range(1, 13):
        short = float(f"{dt:.{digits}g}")
        if abs(short - dt) * (len(time) - 1) <= 1e-3 * dt:
            return short
    return dt


def first_bad_step(time: np.ndarray) -> int:
    """Index of the first sample that does not lie one step after the one before it."""
    steps = np.diff(time)
    dt = float(np.median(steps))
    bad = np.flatnonzero(np.abs(steps - dt) > ROUNDING_SHARE * abs(dt))
    return int(bad[0]) + 1 if bad.size else len(time) - 1


def resampled(time: np.ndarray, values: np.ndarray, dt: float | None, name: str) -> tuple[float, np.ndarray, str]:
    """Values at equal steps, linear between the given ones.

    Parameters
    ----------
    time : array
        Increasing times [s], shape (steps,); equal neighbours are merged.
    values : array
        Shape (steps,).
    dt : float, optional
        Step [s]. By default the decimal in which the times are given, if a median step holds few of it: that keeps
        every sample. Else the median step, halved until the samples are kept to 0.1 % of the peak, at most four times.
    name : str
        For messages.

    Returns
    -------
    dt : float
    values : array
    note : str
        What was done, for the processing history.
    """
    keep = np.concatenate([[True], np.diff(time) > 0.0])
    time, values = time[keep], values[keep]
    if len(time) < 2:
        raise InputError(f"{name}: the times do not increase; give a record with increasing times.")
    steps = np.diff(time)
    median = float(f"{np.median(steps):.6g}")
    span = float(time[-1] - time[0])
    peak = max(float(np.abs(values).max()), 1e-300)

    def at(step: float) -> tuple[np.ndarray, float]:
        count = math.floor(span / step + 1e-6) + 1
        if count > MAX_SAMPLES:
            raise InputError(f"{name}: {count} samples at a step of {step:g} s; allowed is up to {MAX_SAMPLES}.")
        if dt is None and count > 100 * len(time) + 1000:
            raise InputError(
                f"{name}: the steps of the times range from {steps.min():.4g} to {steps.max():.4g} s, which is a "
                "gap, not film; mend the times, or state a step to resample to: `dt=0.01`.",
                "dt",
            )
        grid = time[0] + step * np.arange(count)
        found = np.interp(grid, time, values)
        return found, float(
            np.abs(np.interp(time[time <= grid[-1]], grid, found) - values[time <= grid[-1]]).max()
        ) / peak

    if dt is not None:
        step = check_sampling(dt, "`dt`")
        new, departure = at(step)
    else:
        step = decimal_of(time, median)
        if step is None:
            step = median
            for _ in range(4):
                if at(step)[1] <= 1e-3:
                    break
                step *= 0.5
        new, departure = at(step)
    note = say(
        "resampled linearly from unequal steps ({min:.4g} to {max:.4g} s, median {median:.4g} s) to {step:.6g} "
        "s; departs by up to {departure:.2%} of the peak at the original times",
        min=steps.min(),
        max=steps.max(),
        median=median,
        step=step,
        departure=departure,
    )
    return step, new, note


def decimal_of(time: np.ndarray, median: float) -> float | None:
    """The decimal (0.001 s …) of which all times are multiples, if a median step holds no more than 16 of it."""
    for digits in range(1, 7):
        unit = 10.0**-digits
        if median / unit > 16.0:
            return None
        if np.abs(time / unit - np.round(time / unit)).max() < 1e-3:
            return unit
    return None


def same_step(components: list[Component], name: str, dt: float | None, processing: list[str]) -> float:
    """Bring all components to one step; irregular ones are resampled, and ``processing`` says so."""
    irregular = [component for component in components if component.time is not None]
    if irregular:
        wanted = dt
        for one in irregular:
            assert one.time is not None
            check_sampling(float(np.median(np.diff(one.time))), f"the median step of the times of {name}")
            step, one.values, note = resampled(one.time, one.values, wanted, name)
            one.dt = wanted = step
            one.processing.append(note)
    steps = [component.dt for component in components]
    if any(math.isnan(step) for step in steps):
        if dt is None:
            raise InputError(f"{name} has no time column and states no step; state it: `dt=0.01`.", "dt")
        return check_sampling(dt, f"the step of {name}, `dt`,")
    if max(steps) - min(steps) > 1e-6 * max(steps):
        shown = ", ".join(f"{step:g} s" for step in steps)
        raise InputError(f"components of {name} have different steps ({shown}); resample them to one step before use.")
    if dt is not None and not irregular and abs(dt - steps[0]) > 1e-3 * steps[0]:
        raise InputError(f"{name} states a step of {steps[0]:g} s, but dt is given as {dt:g} s; leave dt out.")
    if irregular or all(component.proven for component in components):
        return steps[0]
    return check_sampling(steps[0], f"the step of {name}")
