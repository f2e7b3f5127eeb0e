"""Ground motion for the models: sampled by the kernels' own law, and integrated to the displacement of the base."""

from __future__ import annotations

import numpy as np

from ...motion import Motion

#: Which of the two values at the end of a record is meant, as in ``kernels/ground.py``.
BEFORE, AFTER = -1, 1


def value_at(samples: np.ndarray, position: float, side: int = BEFORE) -> float:
    """Value of a record at a position, in samples from the first one; see ``kernels/ground.py``.

    Parameters
    ----------
    samples : array of float64, shape (n,)
        n of at least 2.
    position : float
    side : int
        What the last sample is: ``BEFORE`` itself, ``AFTER`` zero.
    """
    from ...kernels.ground import sample_one

    return sample_one(samples.ctypes.data, len(samples) - 1, position, side)


def values_at(samples: np.ndarray, positions: np.ndarray, side: int = BEFORE) -> np.ndarray:
    """Values of a record at many positions, as :func:`value_at`, shape of ``positions``."""
    from ...kernels.ground import sample_all

    out = np.empty(len(positions))
    sample_all(samples.ctypes.data, len(samples) - 1, np.ascontiguousarray(positions, dtype=float), side, out)
    return out


def ground_history(motion: Motion, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Acceleration and displacement of the base along x at given times, from rest [m/s²], [m], shape of ``time``.

    The displacement is exact for an acceleration that is linear between samples; after the motion the base keeps its
    velocity.
    """
    a, dt = motion.acceleration, motion.dt
    v = np.concatenate(([0.0], np.cumsum(0.5 * dt * (a[1:] + a[:-1]))))
    u = np.concatenate(([0.0], np.cumsum(v[:-1] * dt + (2.0 * a[:-1] + a[1:]) * (dt * dt / 6.0))))
    i = np.minimum((time / dt).astype(np.int64), len(a) - 1)
    rest = time - i * dt
    start, jerk = np.append(a[:-1], 0.0)[i], np.append(np.diff(a), 0.0)[i] / dt
    displacement = u[i] + v[i] * rest + 0.5 * start * rest**2 + jerk * rest**3 / 6.0
    return values_at(motion.samples, time / dt) * motion.factor, displacement


def ground_histories(motion: Motion, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Acceleration and displacement of the base along x, y and z, from rest [m/s²], [m], shape (T, 3)."""
    found = np.zeros((2, len(time), 3))
    for axis, values in enumerate((motion.acceleration, motion.lateral, motion.vertical)):
        if values is not None:
            found[:, :, axis] = ground_history(Motion(motion.dt, values), time)
    return found[0], found[1]
