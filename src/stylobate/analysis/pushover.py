"""Pushover: gravity, then horizontal forces that grow and fall along the equilibrium path of the rigid block model."""

from __future__ import annotations

from collections.abc import Sequence

from ..column import Column
from ..errors import check_choice, check_range, check_whole
from ..models.rigid_block.block_stack import BlockStack
from .elastic_stability import check_stable
from .equilibrium_path import EquilibriumPath
from .limit import towards
from .pushover_result import STATES, PushoverResult
from .static_loads import check_standing, crushing_forces, gravity_forces, horizontal_forces

__all__ = ["CONTROLS", "STATES", "PushoverResult", "pushover"]

CONTROLS = ("displacement", "arc-length")


def pushover(
    column: Column | BlockStack,
    *,
    pattern: Sequence[float] | None = None,
    control: str = "displacement",
    geometric: bool = True,
    to: float | None = None,
    at: int | None = None,
    base_tilt: float = 0.0,
    direction: float = 0.0,
    compressive_strength: float | None = None,
) -> PushoverResult:
    """Follow the equilibrium of a column under its weight and growing horizontal forces, over the peak and down.

    The forces push towards +x, or to the other side with ``direction=180``. What is found then is told as seen in a
    mirror: the forces push to the right again.

    Parameters
    ----------
    column : Column or BlockStack
    pattern : sequence of float, optional
        Relative horizontal force on each drum, bottom to top; proportional to mass by default. Their sum is λ W.
    control : {"displacement", "arc-length"}
        What is prescribed in a step: the displacement of the top, or the length of the step along the path.
    geometric : bool
        Equilibrium in the displaced state (large rotations), else in the undisplaced one.
    to : float, optional
        Displacement of the top at which to stop [m], whether or not the column has given way before. By default the
        path is followed until the multiplier is zero or the top has moved by two base widths (geometric), or to a tenth
        of the base width; and on from there while the multiplier still rises.
    at : int, optional
        Drum, from 1 at the base, whose centroid is led and told of instead of the top: of what a tie holds at its top.
    base_tilt : float
        Tilt of the base, downhill towards +x, where the forces push along it [degrees]; a negative one makes them push
        uphill. A column as found brings its own ``base_tilt``, counted the other way, counter-clockwise; its forces are
        horizontal.
    direction : {0, 180}
        Where the forces push to [degrees].
    compressive_strength : float, optional
        f_c of the joints [Pa]; unlimited by default.

    Returns
    -------
    PushoverResult
        Where the path is lost, its part so far, and the reason. Where it ends before the multiplier has stopped rising,
        ``peaked`` is false and the collapse multiplier NaN.

    Raises
    ------
    InputError
        The column cannot stand under its own weight, because it overturns, slides, crushes, or buckles on joints that are
        too soft for it; or an argument cannot be used.
    """
    check_choice("`control`", control, CONTROLS)
    stack = towards(column, direction)
    if at is not None:
        check_whole("`at`", at, 1, stack.n, remedy="it is a drum, from 1 at the base")
    if to is None:
        end = (2.0 if geometric else 0.1) * float(stack.width[0])
    else:
        remedy = "the forces push towards +x, so must it"
        end = check_range("control displacement", to, 0.0, 1e3, unit="m", open_low=True, remedy=remedy)
    strength = crushing_forces(stack, compressive_strength)
    dead = gravity_forces(stack, base_tilt)
    live = horizontal_forces(stack, pattern)
    check_standing(stack, dead, strength, base_tilt)
    if geometric:
        check_stable(stack, dead, strength)
    return EquilibriumPath(stack, dead, live, strength, geometric, at).follow(control, end, extend=to is None)
