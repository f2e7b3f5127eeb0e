"""Orientations of bodies in space: unit quaternions (w, x, y, z) and their matrices."""

from __future__ import annotations

import math

import numpy as np

#: Axes as those of space.
UPRIGHT = (1.0, 0.0, 0.0, 0.0)

Quaternion = tuple[float, float, float, float]


def matrix_of(turn: Quaternion) -> np.ndarray:
    """Axes of a body as columns [-], shape (3, 3)."""
    w, x, y, z = turn
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def quaternion_of(axes: np.ndarray) -> Quaternion:
    """The quaternion of a rotation matrix, its first component not negative."""
    four = np.array(
        [
            1.0 + axes[0, 0] + axes[1, 1] + axes[2, 2],
            1.0 + axes[0, 0] - axes[1, 1] - axes[2, 2],
            1.0 - axes[0, 0] + axes[1, 1] - axes[2, 2],
            1.0 - axes[0, 0] - axes[1, 1] + axes[2, 2],
        ]
    )
    largest = int(four.argmax())
    size = 2.0 * math.sqrt(four[largest])
    skew = axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]
    both = axes[1, 0] + axes[0, 1], axes[2, 0] + axes[0, 2], axes[2, 1] + axes[1, 2]
    rows = (
        (0.25 * size * size, skew[0], skew[1], skew[2]),
        (skew[0], 0.25 * size * size, both[0], both[1]),
        (skew[1], both[0], 0.25 * size * size, both[2]),
        (skew[2], both[1], both[2], 0.25 * size * size),
    )
    w, x, y, z = (float(one) / size for one in rows[largest])
    return (w, x, y, z) if w >= 0.0 else (-w, -x, -y, -z)


def product(one: Quaternion, other: Quaternion) -> Quaternion:
    """The turn that is the second and then the first."""
    a, b, c, d = one
    e, f, g, h = other
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


def about(axis: tuple[float, float, float], angle: float) -> Quaternion:
    """Turn by an angle [rad] about an axis of length 1."""
    if angle == 0.0:
        return UPRIGHT
    s = math.sin(0.5 * angle)
    return math.cos(0.5 * angle), axis[0] * s, axis[1] * s, axis[2] * s
