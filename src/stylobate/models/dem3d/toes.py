"""What joints in space give when their load stands on their edge: soft joints overturn with less energy than rigid ones."""

from __future__ import annotations

import numpy as np

from ...column import Column

#: The toe's laws are those of a short arc: with this factor they bound what a true one gives.
SHORT_ARC = 1.05


def toe_energies(column: Column, kn: np.ndarray, law: str) -> np.ndarray:
    """By how much gravitational and elastic energy are less with the weight on the edge of each joint than rigidly [J].

    Beyond what the closed joint gives under the same weight, shape (n,). A toe on a spring of N ∝ eᵖ that is pressed by e
    lowers the energy by N e p/(p + 1).

    Parameters
    ----------
    column : Column
    kn : array
        Normal stiffness per area [N/m³], shape (n,).
    law : {"rim", "bed", "corners"}
    """
    weight, area, radius = column.joint_weights, column.joint_areas, 0.5 * column.joint_widths
    closed = weight**2 / (2.0 * kn * area)
    if law == "corners":  # on a single one of the four
        return SHORT_ARC * 2.0 * weight**2 / (kn * area) - closed
    height = centroids_above(column)
    if law == "rim":  # N = 4/3 k_n (R/2) R √2 e^1.5 / √(R sin α)
        stiffness = (2.0 * np.sqrt(2.0) / 3.0) * kn * radius**2 / np.sqrt(radius * radius / np.hypot(radius, height))
        return SHORT_ARC * 0.6 * weight * (weight / stiffness) ** (2.0 / 3.0) - closed
    # N = 8 √2/15 k_n √R e^2.5 / (tan α)^1.5
    stiffness = (8.0 * np.sqrt(2.0) / 15.0) * kn * np.sqrt(radius) * (height / radius) ** 1.5
    return SHORT_ARC * 5.0 / 7.0 * weight * (weight / stiffness) ** 0.4 - closed


def given_by_toes(column: Column, toes: np.ndarray, j: int, half: float, height: float) -> float:
    """What all joints give, at most, while the part above joint j stands on an edge ``half`` from under its centroid [J].

    A joint gives more than in proportion to the square of the moment that it carries: with the moment's share of the
    largest one squared, the toe's energy bounds it.
    """
    moments = column.joint_weights * 0.5 * column.joint_widths
    carried = np.minimum(
        moments, column.joint_weights * centroids_above(column) * half / height
    )  # above j: all lean alike
    carried[:j] = np.minimum(moments[:j], moments[j])
    carried[j] = moments[j]
    return float(toes @ (carried / moments) ** 2)


def centroids_above(column: Column) -> np.ndarray:
    """Height of the centroid of the part above each joint over that joint [m], shape (n,)."""
    mass = np.cumsum(column.masses[::-1])[::-1]
    arms = np.cumsum((column.masses * column.centroid_heights)[::-1])[::-1]
    return arms / mass - column.joint_heights
