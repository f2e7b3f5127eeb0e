"""Resting place of a body on springs: the lowest place near its resting face, whichever vertices carry it there."""

from __future__ import annotations

import math

import numpy as np

from ...column.found_geometry import rotation

#: Largest turn of one step [rad], and most steps.
LARGEST, STEPS = 0.01, 400

#: Force that is left, as a share of the weight.
LEFT = 1e-10


def potential(
    vertices: np.ndarray, turn: np.ndarray, height: float, spring: float, weight: float
) -> tuple[float, np.ndarray, np.ndarray]:
    """Potential energy [J], and its first and second derivatives by height and two small rotations about x and y.

    Parameters
    ----------
    vertices : array
        From the centroid, in the axes of the body [m], shape (m, 3).
    turn : array
        From those axes to those of space, shape (3, 3).
    height : float
        Of the centroid over the base [m].
    spring : float
        Stiffness of a vertex [N/m].
    weight : float
        [N]
    """
    arms = vertices @ turn.T
    depth = np.maximum(-(height + arms[:, 2]), 0.0)
    rows = np.stack((np.ones(len(arms)), arms[:, 1], -arms[:, 0]), axis=1)  # rise of a vertex per height, θx, θy
    touching = rows[depth > 0.0]
    curvature = spring * touching.T @ touching
    sinking = spring * float(depth @ arms[:, 2])  # a turn lowers what stands on a vertex
    curvature[1, 1] += sinking
    curvature[2, 2] += sinking
    slope = np.array([weight, 0.0, 0.0]) - spring * depth @ rows
    return 0.5 * spring * float(depth @ depth) + weight * height, slope, curvature


def turned(turn: np.ndarray, step: np.ndarray) -> np.ndarray:
    """A turn followed by the two small rotations of a step."""
    angle = math.hypot(step[1], step[2])
    return rotation(np.array([step[1], step[2], 0.0]) / angle, angle) @ turn if angle > 0.0 else turn


def lying(
    vertices: np.ndarray, turn: np.ndarray, height: float, spring: float, weight: float
) -> tuple[np.ndarray, float]:
    """Turn and height [m] at which the body lies, from those of its resting face; parameters as for :func:`potential`.

    Newton's method down the potential energy: directions in which it bends down are taken as if it bent up, and a step that
    does not go down is halved, so that it ends in a place that is stable.
    """
    size = float(np.linalg.norm(vertices, axis=1).max())
    scale = np.array([1.0, 1.0 / size, 1.0 / size])
    height -= weight / (spring * len(vertices))
    energy, slope, curvature = potential(vertices, turn, height, spring, weight)
    for _ in range(STEPS):
        values, along = np.linalg.eigh(curvature * np.outer(scale, scale))
        values = np.maximum(np.abs(values), 1e-6 * spring)
        step = -scale * (along @ ((along.T @ (slope * scale)) / values))
        step *= min(
            1.0, LARGEST / max(float(np.hypot(step[1], step[2])), 1e-300), LARGEST * size / max(abs(step[0]), 1e-300)
        )
        there, found = turn, (energy, slope, curvature)
        for _ in range(40):
            there = turned(turn, step)
            found = potential(vertices, there, height + float(step[0]), spring, weight)
            if found[0] <= energy:
                break
            step = 0.5 * step
        turn, height = there, height + float(step[0])
        energy, slope, curvature = found
        if np.abs(slope * scale).max() < LEFT * weight:
            break
    return turn, height
