"""Whether a graphics card is used: there is room for a column, and it computes what the processor computes.

Before a kernel is used for the first time a few short runs are made by both: columns that stay shut, and columns that open,
rock and slide. Where they differ by more than rounding, nothing is computed there.
"""

from __future__ import annotations

from functools import cache, partial
from threading import Lock
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate.column import Column, Joint
from stylobate.errors import StylobateError
from stylobate.models.base import Case, Model, RunOptions
from stylobate.models.engine import engine_for
from stylobate.models.shared.lanes import run_lanes
from stylobate.motion import Motion

from .lanes import CardLanes

if TYPE_CHECKING:
    from .card import Device

#: Largest difference of a peak from that of the processor, over the peak [-]: in so short runs rounding has not grown.
ALIKE = 1e-6

#: Amplitudes of the runs: some leave all joints shut, others open them [m/s²]; length of a run [s].
AMPLITUDES, LENGTH = (0.1, 0.3, 0.5, 0.8, 3.0, 4.0, 5.0, 7.0), 0.2


@cache
def usable(device: Device, name: str, drums: int, kind: type[Model]) -> bool:
    """Whether columns of so many drums fit on a card, with a kernel that computes as the processor does.

    Raises
    ------
    StylobateError
        It computes otherwise.
    """
    from .card import fits

    if not fits(device, name, drums):
        return False
    check(device, name, kind)
    return True


@cache
def check(device: Device, name: str, kind: type[Model]) -> None:
    """Compute a few runs by a kernel and by the processor.

    Raises
    ------
    StylobateError
        They differ.
    """
    model, cases = cases_for(name, kind)
    options = RunOptions()
    block = partial(engine_for(model, cases[0].column).block, options)
    there = dict(run_lanes(lambda: CardLanes(device, name, block, len(cases), Lock()), cases, 1))
    here = dict(run_lanes(block, cases, 1))
    for number in range(len(cases)):
        mine, theirs = here[number], there[number]
        numbers = [
            (getattr(mine, peak), getattr(theirs, peak))
            for peak in ("peak_top_displacement", "peak_joint_opening", "peak_rotation")
        ]
        if mine.steps != theirs.steps or not all(np.isclose(b, a, rtol=ALIKE, atol=1e-15) for a, b in numbers):
            raise StylobateError(
                f"the graphics card ({device.name}) computes otherwise than the processor with the kernel {name!r} (a top "
                f"moves by {numbers[0][1]:.9g} m instead of {numbers[0][0]:.9g} m); nothing is computed there: leave "
                "`device` out."
            )


def cases_for(name: str, kind: type[Model]) -> tuple[Any, list[Case]]:
    """The model and the runs by which a kernel is checked."""
    damped, rolling = name.endswith(("damped", "rolling")), name.endswith("rolling")
    losses = {"stiffness_damping": 1e-5} if damped else {}
    model = kind(**losses | ({"rolling_resistance": 0.003} if rolling else {}))
    size: dict[str, Any] = {"height": 3.0, "bottom_width": 0.6, "top_width": 0.5, "drums": 3, "density": 2400.0}
    size |= {"section": "circular"} if name.startswith("rim") else {"section": "rectangular", "depth": 0.6}
    rough, smooth = (Column.tapered(**size, joint=Joint(5e8, 2.5e8, friction_angle=angle)) for angle in (30.0, 8.0))
    t = np.arange(0.0, LENGTH, 0.005)
    shape = 0.8 + 0.2 * np.sin(40.0 * t)
    across = None if kind.axes == "xz" else 0.3 * shape
    up = 0.2 * np.cos(55.0 * t)
    return model, [
        Case(column, Motion(0.005, most * shape, None if across is None else most * across, most * up))
        for column in (rough, smooth)
        for most in AMPLITUDES
    ]
