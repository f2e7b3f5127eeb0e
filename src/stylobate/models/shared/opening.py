"""Static acceleration that rocks a column on soft joints: its toe lets the pivot in, and what has sunk there leans it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...column import Column


class Opening(NamedTuple):
    """What rocks a column as built, joint by joint the least.

    Parameters
    ----------
    acceleration, rigid : float
        Largest static acceleration that it stands [m/s²], on its joints and if they were rigid.
    toe : float
        How far its pressed part reaches in from the edge then, over the joint's width [-].
    joint : int
        Which joint, from 1.
    """

    acceleration: float
    rigid: float
    toe: float
    joint: int


#: Half of the angle that the touching part of a round face's rim takes up [rad].
PRESSED = np.linspace(0.02, np.pi, 800)


def on_rims() -> tuple[np.ndarray, np.ndarray]:
    """Force over k_n R³ times the tilt, and its lever from the middle over R, of a rim pressed as far as ``PRESSED``.

    The rim carries k_n R/2 per length, its depth is R θ (cos φ − cos φ₀).  # Eqs. (E1), (E3)
    """
    s, c = np.sin(PRESSED), np.cos(PRESSED)
    return s - PRESSED * c, 0.5 * (PRESSED - s * c) / (s - PRESSED * c)


def on_beds() -> tuple[np.ndarray, np.ndarray]:
    """The same of an elastic bed of a disc, pressed up to a chord.  # as disc_on_bed, Eq. (E11)"""
    s, c = np.sin(PRESSED), np.cos(PRESSED)
    area, first = PRESSED - c * s, 2.0 / 3.0 * s**3
    second = 0.25 * (PRESSED + c * s * (1.0 - 2.0 * c * c))
    force = first - c * area
    return force, (second - c * first) / force


def opening(column: Column, kn: np.ndarray, law: str) -> Opening | None:
    """What rocks a column, None where it is not as built or joints carry on rings.

    At a tilt θ a joint bears the overturning moment W (lever − h θ): the largest of all tilts counts. Two points or four
    corners bear most as the farther ones open (Eq. D4).

    Parameters
    ----------
    column : Column
    kn : array
        Stiffness per area of each joint [N/m³], shape (n,).
    law : {"rim", "bed", "corners"}
    """
    if column.as_found or column.on_rings or column.links:
        return None
    weight, half, height = column.joint_weights, 0.5 * column.joint_widths, column.parts_above[1]
    if law == "corners":
        tilt = weight / (kn * column.joint_areas * half)
        borne, toe = half - height * tilt, np.zeros(column.n)
    else:
        laws: dict[str, Callable[[], tuple[np.ndarray, np.ndarray]]] = {"rim": on_rims, "bed": on_beds}
        force, lever = laws[law]()
        tilts = (weight / (kn * half**3))[:, None] / force
        every = half[:, None] * lever - height[:, None] * tilts
        most = every.argmax(axis=1)
        borne, toe = every.max(axis=1), 0.5 * (1.0 - np.cos(PRESSED[most]))
    least = int(np.argmin(borne / height))
    gravity = column.gravity
    rigid = float((half / height).min())
    return Opening(gravity * float(borne[least] / height[least]), gravity * rigid, float(toe[least]), least + 1)
