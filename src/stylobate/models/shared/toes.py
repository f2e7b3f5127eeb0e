"""Energy of joints when their load stands on their edge: soft joints overturn with less energy than rigid ones."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column

#: The toe's laws are those of a short arc: with this factor they bound what a true one gives.
SHORT_ARC = 1.05

#: Of the half width of a face that a chip leaves less of, this much is reckoned with [-]: its toe is beyond all barriers.
LEAST_LEFT = 0.1


def rim_toes(column: Column, kn: np.ndarray) -> np.ndarray:
    """By how much gravitational and elastic energy are less with the weight on the edge of each joint than rigidly [J].

    Beyond what the closed joint gives under the same weight, shape (n,). A toe on a spring of N ∝ eᵖ that is pressed by e
    lowers the energy by N e p/(p + 1). Here of joints that carry on their rim.

    Parameters
    ----------
    column : Column
    kn : array
        Normal stiffness per area [N/m³], shape (n,).
    """
    weight, radius = column.joint_weights, 0.5 * column.joint_widths
    height = column.parts_above[1]
    # N = 4/3 k_n (R/2) R √2 e^1.5 / √(R sin α)
    stiffness = (2.0 * np.sqrt(2.0) / 3.0) * kn * radius**2 / np.sqrt(radius * radius / np.hypot(radius, height))
    return _chipped(column, SHORT_ARC * 0.6 * weight * (weight / stiffness) ** (2.0 / 3.0) - _closed(column, kn))


def bed_toes(column: Column, kn: np.ndarray) -> np.ndarray:
    """As :func:`rim_toes`, of joints on an elastic bed; of rings the toe is found from the law itself."""
    if column.on_rings:
        rings = np.array([_ring_toe(column, float(kn[j]), j) for j in range(column.n)])
        return _chipped(column, rings - _closed(column, kn))
    weight, radius = column.joint_weights, 0.5 * column.joint_widths
    # N = 8 √2/15 k_n √R e^2.5 / (tan α)^1.5
    steepness = (column.parts_above[1] / radius) ** 1.5
    stiffness = (8.0 * np.sqrt(2.0) / 15.0) * kn * np.sqrt(radius) * steepness
    return _chipped(column, SHORT_ARC * 5.0 / 7.0 * weight * (weight / stiffness) ** 0.4 - _closed(column, kn))


def _ring_toe(column: Column, kn: float, j: int) -> float:
    """By how much the toe of a ring under the weight above lowers the energy [J]: its depth is found by bisection."""
    weight, outer = float(column.joint_weights[j]), 0.5 * float(column.joint_widths[j])
    inner, slope = 0.5 * max(column.sunken_widths(j)), outer / float(column.parts_above[1][j])

    def carried(toe: float) -> tuple[float, float]:
        force, stored = disc_on_bed(kn, outer, toe - slope * outer, slope)
        less = disc_on_bed(kn, inner, toe - slope * outer, slope) if inner > 0.0 else (0.0, 0.0)
        return force - less[0], stored - less[1]

    low, high = 0.0, 1e-9
    while carried(high)[0] < weight:
        high *= 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if carried(middle)[0] < weight else (low, middle)
    return SHORT_ARC * (weight * high - carried(high)[1])


def disc_on_bed(kn: float, radius: float, depth: float, slope: float) -> tuple[float, float]:
    """Force [N] and elastic energy [J] of a disc on an elastic bed without tension, in closed form.  # Eq. (E11)

    Parameters
    ----------
    kn : float
        Stiffness per area [N/m³].
    radius : float
        [m]
    depth : float
        Of the disc's middle [m]; negative above the bed.
    slope : float
        Change of depth along the steepest descent [-].
    """
    edge = slope * radius
    x = min(max(-depth / max(edge, 1e-300), -1.0), 1.0)
    w, angle = math.sqrt(1.0 - x * x), math.acos(x)
    area, first = angle - x * w, 2.0 / 3.0 * w**3
    second = 0.25 * (angle + x * w * (1.0 - 2.0 * x * x))
    force = kn * radius**2 * (depth * area + edge * first)
    return force, 0.5 * kn * radius**2 * (depth * depth * area + 2.0 * depth * edge * first + edge * edge * second)


def point_toes(column: Column, kn: np.ndarray, share: float | np.ndarray) -> np.ndarray:
    """As :func:`rim_toes`, of joints whose edge has a share of the joint's stiffness: a corner, the last of some points."""
    closed = _closed(column, kn)
    return _chipped(column, SHORT_ARC * closed / share - closed)


def _chipped(column: Column, toes: np.ndarray) -> np.ndarray:
    """Toes of faces that chips leave smaller: they bound what is given under a moment by its share of the largest, squared.

    That largest one is of the whole face; of what is left it is smaller as its smallest half width is, and the area is
    smaller by no more than the square of that.
    """
    chips = np.array([max(column.as_found.of(i + 1).chips) for i in range(column.n)])
    left = 1.0 - chips / np.array([0.5 * min(drum.bottom_width, drum.depth) for drum in column.drums])
    return toes / np.maximum(left, LEAST_LEFT) ** 4


def _closed(column: Column, kn: np.ndarray) -> np.ndarray:
    return column.joint_weights**2 / (2.0 * kn * column.joint_areas)
