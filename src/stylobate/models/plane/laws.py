"""The laws of joints that the engine in the plane is compiled for."""

from __future__ import annotations

from functools import cache

from .block import Law


@cache
def point_law(points: int, damped: bool, lanes: int, linked: bool) -> Law:
    """Joints with contact points, so many each; with damping and links or without."""
    from ...kernels.plane import records, step

    types = records.types(records.point_joint(points, damped, lanes), damped, points, lanes, linked)
    return Law(types, step.advance_points, step.gather_points, step.ledger_points)


@cache
def interface_law(crushing: bool, damped: bool, lanes: int, linked: bool) -> Law:
    """Joints that are one interface each; with a compressive strength, damping and links or without."""
    from ...kernels.plane import records, step

    types = records.types(records.interface_joint(crushing, damped, lanes), damped, 1, lanes, linked)
    return Law(types, step.advance_interfaces, step.gather_interfaces, step.ledger_interfaces)
