"""Bodies in the plane besides their joints: outlines, the bed between any two, how joints hand over to it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...column.block import smallest_turn
from ...column.joint import Joint
from ...column.structure import Structure
from ..drums.joints import with_stone

#: Relative rotation from which a joint's faces are a bed like all others [rad].
LAST_ROTATION = math.radians(50.0)


def fill_shapes(records: Any, structure: Structure) -> np.ndarray:
    """Fill records of shapes; returns the corners of all bodies, one after another, each from its place [m]."""
    corners = [body.polygon for body in structure.bodies]
    counts = [len(corner) for corner in corners]
    records["first"], records["count"] = np.cumsum([0, *counts])[:-1], counts
    # a contact with what moves with the ground is as deep as the moving body
    records["depth"] = [1e9 if body.fixed else body.shape.depth for body in structure.bodies]
    records["r"] = [float(np.hypot(corner[:, 0], corner[:, 1]).max()) for corner in corners]
    return np.concatenate(corners)


def fill_hands(records: Any, structure: Structure) -> None:
    """Fill records of how each joint hands over."""
    for h, pair in zip(records, structure.face_pairs, strict=True):
        below, above = (structure.bodies[i].outline for i in (pair.lower, pair.upper))
        # the next faces come down on each other where the joint has turned as far as the outlines do at its ends
        last = min(LAST_ROTATION, 0.9 * smallest_turn(below, pair.sides[0], above, pair.sides[1]))
        h["live"], h["weight"] = 1, 1.0
        h["from_c"], h["to_c"] = math.cos(0.7 * last), math.cos(last)
        h["width"] = min(pair.below.width, pair.above.width)


def bed_laws(structure: Structure, block_modulus: float | None) -> np.ndarray:
    """k_n, k_s [N/m³] and tan φ of the bed between any two bodies, shape (N, N, 3); the pair's lower number first.

    As soft as the joints where their springs have the stone of a column in series.
    """
    laws = np.empty((len(structure.bodies), len(structure.bodies), 3))

    def numbers(law: Joint) -> tuple[float, float, float]:
        return law.normal_stiffness, law.shear_stiffness, law.tan_phi

    for i, law in enumerate(structure.surfaces):
        laws[:, i] = numbers(law)
    for i, h, law in structure.laws_of_pairs:
        laws[i, h] = numbers(law)
    if block_modulus is not None:
        laws[:, 1:, 0], laws[:, 1:, 1] = with_stone(structure, laws[:, 1:, 0], laws[:, 1:, 1], block_modulus)
    return laws
