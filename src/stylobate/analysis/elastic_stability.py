"""Elastic stability under the own weight: whether the joints are stiff enough for what stands on them, or how much not."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..errors import InputError
from ..models.rigid_block.block_stack import BlockStack
from .equilibrium_path import EquilibriumPath

#: Stiffness that is looked for at most, over the given one, and how closely [-].
STIFFEST, PRECISION = 2.0**40, 1e-4


def check_stable(stack: BlockStack, dead: np.ndarray, strength: np.ndarray) -> None:
    """Refuse a column that buckles under its own weight, because its joints are too soft for it.

    One block on its base is stable for k_n J > W z_C; it then rights itself from a small rotation.

    Parameters
    ----------
    stack : BlockStack
    dead : array
        Weight of each block [N, N, N m], shape (n, 3).
    strength : array
        f_c A of each joint [N], shape (n,).

    Raises
    ------
    InputError
        Names the joint that is softest for what it carries, and the stiffness needed.
    """

    def stands(factor: float) -> bool:
        return stable(_stiffer(stack, factor), dead, strength)

    if stands(1.0):
        return
    high = 2.0
    while not stands(high):
        high *= 2.0
        if high > STIFFEST:
            return  # The stiffness is not the cause; the pushover reports the real one.
    low = 0.5 * high
    while high - low > PRECISION * low:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if stands(middle) else (middle, high)
    mass, centroid = stack.parts_above()
    softness = mass * stack.gravity * (centroid - stack.joint)[:, 1] / stack.rotational_stiffness
    worst = int(np.argmax(softness))
    given = stack.normal_stiffness[worst] / stack.area[worst]
    others = "" if stack.n == 1 else f", and {high:.4g} times as much as given in all other joints"
    raise InputError(
        f"the column buckles under its own weight, first of all on joint {worst + 1}: its normal_stiffness is "
        f"{given:.4g} N/m³; needed is more than {high * given:.4g} N/m³{others}."
    )


def stable(stack: BlockStack, dead: np.ndarray, strength: np.ndarray) -> bool:
    """Whether a stack has an upright equilibrium under its weight in which every small displacement takes work."""
    path = EquilibriumPath(stack, dead, np.zeros_like(dead), strength, geometric=True)
    if path.settle() or float(np.abs(path.position[:, 2]).max()) > 0.5 * math.pi:
        return False
    path.residual(path.position, 0.0)
    # Scaled so that forces and moments are comparable; this changes no sign of an eigenvalue.
    unit = 1.0 / np.sqrt(np.tile([1.0, 1.0, path.height**2], stack.n))
    tangent = path.stiffness * np.outer(unit, unit)
    return bool(np.linalg.eigvalsh(0.5 * (tangent + tangent.T))[0] > 0.0)


def _stiffer(stack: BlockStack, factor: float) -> BlockStack:
    return replace(
        stack,
        normal_stiffness=factor * stack.normal_stiffness,
        rotational_stiffness=factor * stack.rotational_stiffness,
        shear_stiffness=factor * stack.shear_stiffness,
        # Friction is left out: a joint that slides is not one that is too soft.
        cohesion=np.full(stack.n, np.inf),
    )
