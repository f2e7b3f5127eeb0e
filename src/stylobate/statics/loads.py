"""Loads and strength of a stack of blocks, for limit analysis and pushover alike; what cannot stand is refused."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..constants import DEGREE
from ..errors import InputError, check_range
from ..models.rigid_block.block_stack import BlockStack


def gravity_forces(stack: BlockStack, base_tilt: float = 0.0) -> np.ndarray:
    """Weight of each block in the frame of the base [N, N, N m], shape (n, 3).

    Raises
    ------
    InputError
        A tilt outside its range, or beside that of a column as found.
    """
    tilt = check_range("base_tilt", base_tilt, -60.0, 60.0, unit="degrees") * DEGREE
    if tilt and stack.slope:
        raise InputError(
            f"a tilt of {base_tilt:g} degrees is given for a column whose base is found out of level; leave one of them out."
        )
    tilt -= stack.slope
    weight = stack.mass * stack.gravity
    return np.column_stack((weight * np.sin(tilt), -weight * np.cos(tilt), np.zeros(stack.n)))


def horizontal_forces(stack: BlockStack, pattern: Sequence[float] | None = None) -> np.ndarray:
    """Horizontal forces for λ = 1 g: their sum is the weight [N, N, N m], shape (n, 3).

    Along the base where its tilt is an argument of the analysis; horizontal where the base is found out of level.
    """
    share = stack.mass if pattern is None else np.asarray(pattern, dtype=float)
    if share.shape != (stack.n,):
        raise InputError(
            f"the load pattern has {share.size} values for {stack.n} drums; give one value per drum, bottom to top."
        )
    if not np.isfinite(share).all() or (share < 0.0).any() or share.sum() <= 0.0:
        raise InputError("the load pattern must hold finite values ≥ 0 with a positive sum; give relative forces.")
    forces = np.zeros((stack.n, 3))
    towards = np.array([np.cos(stack.slope), -np.sin(stack.slope)])
    forces[:, :2] = np.outer(share / share.sum() * stack.weight, towards)
    return forces


def crushing_forces(stack: BlockStack, compressive_strength: float | None) -> np.ndarray:
    """f_c A of each joint [N], infinite without a limit, shape (n,)."""
    if compressive_strength is None:
        return np.full(stack.n, np.inf)
    return stack.area * check_range(
        "compressive_strength",
        compressive_strength,
        0.0,
        1e12,
        unit="Pa",
        open_low=True,
        remedy="leave it out for none",
    )


def joint_forces(stack: BlockStack, loads: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compression N, shear V on the part above, and eccentricity of N in each joint under given loads, by equilibrium.

    Parameters
    ----------
    stack : BlockStack
    loads : array
        Forces and moment on each block [N, N, N m], shape (n, 3).

    Returns
    -------
    tuple of array
        [N], [N], [m], each of shape (n,); the eccentricity is NaN where N is not positive.
    """
    forces = np.linalg.solve(stack.compatibility().T, -loads.ravel()).reshape(-1, 3)
    n = forces[:, 0]
    return n, forces[:, 1], np.where(n > 0.0, forces[:, 2] / np.where(n > 0.0, n, 1.0), np.nan)


def check_standing(stack: BlockStack, dead: np.ndarray, strength: np.ndarray, base_tilt: float = 0.0) -> None:
    """Refuse a column that cannot stand under its own weight.

    Raises
    ------
    InputError
        Names the joint, what is needed, what there is, and the remedy.
    """
    n, v, e = joint_forces(stack, dead)
    left, right = contact_limits(stack)
    tilt = f" on a base tilted by {base_tilt:g} degrees" if base_tilt else ""
    for i in range(stack.n):
        where = f"joint {i + 1}"
        if n[i] >= strength[i]:
            raise InputError(
                f"{where} crushes under the column's own weight: it carries {n[i]:.4g} N and bears f_c A = "
                f"{strength[i]:.4g} N; give compressive_strength above {n[i] / stack.area[i]:.4g} Pa."
            )
        share = 1.0 - n[i] / strength[i]
        if abs(v[i]) > stack.friction[i] * n[i] + stack.cohesion[i] + 1e-12 * n[i]:
            raise InputError(
                f"{where} slides under the column's own weight{tilt}: it needs a friction coefficient of "
                f"{(abs(v[i]) - stack.cohesion[i]) / n[i]:.4g} and has {stack.friction[i]:.4g}; raise the friction "
                "or lower the tilt."
            )
        if not left[i] * share <= e[i] <= right[i] * share:
            raise InputError(
                f"the part above {where} overturns under its own weight{tilt}: its weight acts {e[i]:.4g} m from the "
                f"middle of the joint, allowed is {left[i] * share:.4g} to {right[i] * share:.4g} m; lower the tilt."
            )


def contact_limits(stack: BlockStack) -> tuple[np.ndarray, np.ndarray]:
    """Left and right end of each contact section, from the joint's middle [m], each of shape (n,)."""
    left = np.maximum(stack.upper_reach[:, 0], stack.lower_reach[:, 0])
    right = np.minimum(stack.upper_reach[:, 1], stack.lower_reach[:, 1])
    return left, right
