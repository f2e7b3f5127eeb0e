"""A column in the plane that starts tilted about its edge: where its drums are, how they move, and what holds it there."""

from __future__ import annotations

import math

import numpy as np

from ...kernels.shared.records import LANE
from ..drums.records import sink
from ..start import Start
from .block import Records


def placed(
    start: Start, records: Records, lane: int, gravity: float
) -> tuple[dict[str, np.ndarray], tuple[float, float]]:
    """Fields of the drums of a column that stands tilted and turns as one rigid body, and the force that it rests on.

    The force along x and z [N] is the one that carries the rigid body turning about its edge from there: nothing rings at
    the start.

    Parameters
    ----------
    start : Start
        In the plane of x and z.
    records : Records
        In which the column is, upright and at rest.
    lane : int
    gravity : float
        [m/s²]
    """
    side = leans_right(start)
    angle, rate = (-start.tilt if side else start.tilt), -start.angular_velocity[1]
    body, base = records.body, records.joint[0]
    x, z, m, i = (body[name][1:, lane] for name in ("x", "z", "m", "i"))
    edge = base["br"][lane] if side else -base["bl"][lane]
    across, along = x - x[0] - edge, z - z[0] + base["hb"][lane]  # the base's joint as yet open
    c, s = math.cos(angle), math.sin(angle)
    across, along = c * across - s * along, s * across + c * along
    # the column as one body that turns about its edge
    turning = -gravity * float(m @ across) / float(i.sum() + m @ (across**2 + along**2))
    push = -float(m @ (turning * along + rate**2 * across))
    lift = float(m @ (turning * across - rate**2 * along)) + float(m.sum()) * gravity
    even = np.ones(len(m))
    values = {
        "x": (0.0, x[0] + edge + across),
        "z": (body["z"][0, lane], along),
        "th": (0.0, angle * even),
        "c": (1.0, c * even),
        "s": (0.0, s * even),
        "vx": (0.0, -rate * along),
        "vz": (0.0, rate * across),
        "w": (0.0, rate * even),
    }
    fields = {name: np.concatenate(([base], rest)) for name, (base, rest) in values.items()}
    return fields, (push, max(lift, 0.0))


def leans_right(start: Start) -> bool:
    """Whether a column that starts in the plane leans towards x."""
    return math.cos(start.azimuth) > 0.0


def sink_in(records: Records, lane: int, force: float) -> None:
    """Lower the whole column in a lane until the base carries a force [N]."""
    state = records.now()
    state[LANE]["dt"][0, lane] = 0.0

    def carried() -> float:
        records.kernel.gather(state)
        return float(records.load["fz"][0, lane])

    sink(records.body["z"], lane, force, carried)
