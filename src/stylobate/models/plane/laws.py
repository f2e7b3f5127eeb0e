"""The laws of joints that the engine in the plane is compiled for: types of its records by their names, which tell them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np

#: Types of records by their names in ``kernels/shared/records.py``.
Types = Mapping[str, np.dtype]


@cache
def point_law(points: int, damped: bool, lanes: int, linked: bool, turned: bool = False) -> Types:
    """Joints with contact points, so many each; with damping and links or without.

    Parameters
    ----------
    points : int
    damped : bool
    lanes : int
    linked : bool
    turned : bool
        Whether upper faces may be inclined in the axes of their bodies, as those of blocks may.
    """
    from ...kernels.plane import records

    return records.types(records.point_joint(points, damped, lanes, turned), damped, points, lanes, linked)


@cache
def interface_law(crushing: bool, damped: bool, lanes: int, linked: bool) -> Types:
    """Joints that are one interface each; with a compressive strength, damping and links or without."""
    from ...kernels.plane import records

    return records.types(records.interface_joint(crushing, damped, lanes), damped, 1, lanes, linked)
