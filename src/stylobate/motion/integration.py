"""Velocity, displacement and intensity of a motion that is linear between its samples, without approximation."""

from __future__ import annotations

import numpy as np

from ..constants import g
from .motion import Motion, integrate


def displacement(acceleration: np.ndarray, dt: float) -> np.ndarray:
    """Displacement from rest: the double integral of an acceleration that is linear between samples [m], same shape."""
    v = integrate(acceleration, dt)
    steps = dt * v[:-1] + dt * dt / 6.0 * (2.0 * acceleration[:-1] + acceleration[1:])
    out = np.zeros_like(v)
    np.cumsum(steps, out=out[1:])
    return out


def square_integral(acceleration: np.ndarray, dt: float) -> np.ndarray:
    """Running integral of the square, from zero, same shape."""
    a, b = acceleration[:-1], acceleration[1:]
    out = np.zeros_like(acceleration)
    np.cumsum(dt / 3.0 * (a * a + a * b + b * b), out=out[1:])
    return out


def absolute_integral(acceleration: np.ndarray, dt: float) -> float:
    """Integral of the absolute value."""
    a, b = acceleration[:-1], acceleration[1:]
    size = np.abs(a) + np.abs(b)
    crossing = a * b < 0.0
    area = 0.5 * size
    area[crossing] = 0.5 * (a[crossing] ** 2 + b[crossing] ** 2) / size[crossing]
    return float(dt * area.sum())


def time_above(acceleration: np.ndarray, dt: float, level: float) -> float:
    """Time during which the absolute value exceeds ``level`` [s]."""
    total = 0.0
    for sign in (1.0, -1.0):
        a = sign * acceleration[:-1] - level
        b = sign * acceleration[1:] - level
        both = (a > 0.0) & (b > 0.0)
        one = (a > 0.0) != (b > 0.0)
        share = np.maximum(a[one], b[one]) / np.abs(a[one] - b[one])
        total += dt * (both.sum() + share.sum())
    return float(total)


def arias_growth(motion: Motion) -> np.ndarray:
    """Share of the Arias intensity of all components together that is reached at each sample, shape (steps,)."""
    total = np.zeros(motion.steps)
    for values in motion.components.values():
        total += square_integral(values, motion.dt)
    return total / total[-1] if total[-1] > 0.0 else np.linspace(0.0, 1.0, motion.steps)


def arias(acceleration: np.ndarray, dt: float) -> float:
    """Arias intensity π/(2g) ∫a² dt [m/s]."""
    return float(np.pi / (2.0 * g) * square_integral(acceleration, dt)[-1])
