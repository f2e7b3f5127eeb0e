"""A stone that rocks on the ground in lanes, each with a damping of its own: what an impact of it leaves."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ...column import Column
from ...column.spatial.assembly import SpatialAssembly
from ...column.spatial.stone import Stone
from ..base import Case, RunOptions
from ..drums.impact import TRIED, longest, undamped
from .lanes import IntactLanes


def rocking_stone(body: Column, model: Any, tilt: float) -> Iterator[np.ndarray]:
    """Leans of a stone of the same sides; see :data:`stylobate.models.drums.impact.Rocking`."""
    drum, foot = body.drums[0], (0.0, 0.0, 0.0)
    width, height = drum.bottom_width, drum.height
    if drum.section == "circular":
        stone = Stone.drum(width, drum.top_width, height, foot, drum.density, name=body.name)
    else:
        stone = Stone.box((width, drum.depth, height), foot, drum.density, name=body.name)
    alone = SpatialAssembly((stone,), body.joint_laws[0], gravity=body.gravity)
    lanes = IntactLanes(replace(model, **undamped()).spatial_numbers, RunOptions())
    case = Case(alone, longest(alone))
    for lane in range(len(TRIED)):
        lanes.load(lane, case)
    _lean(lanes, tilt, 0.5 * width)
    lanes.lane["beta"][0, : len(TRIED)] = TRIED
    while not lanes.is_over(0):
        lanes.kernel.advance(lanes.state, 1)
        yield np.arcsin(_axes(lanes)[: len(TRIED), 0, 2])


def _axes(lanes: IntactLanes) -> np.ndarray:
    """Axes of the stone in each lane as columns, shape (lanes, 3, 3)."""
    stone = lanes.body[1]
    principal = np.array([[stone[axis + c] for axis in "ijk"] for c in "xyz"])
    return np.einsum("cal,bal->lcb", principal, lanes.turn[1])


def _lean(lanes: IntactLanes, tilt: float, half: float) -> None:
    """Turn the stone in all lanes about its edge (or the point of its rim) at ``half`` towards +x."""
    stone, (c, s) = lanes.body[1], (math.cos(tilt), math.sin(tilt))
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    principal = np.einsum("dc,lcb,bal->dal", turn, _axes(lanes), lanes.turn[1])
    for (d, name), (a, axis) in itertools.product(enumerate("xyz"), enumerate("ijk")):
        stone[axis + name][:] = principal[d, a]
    stone["x"][:], stone["z"][:] = half - half * c + stone["z"] * s, half * s + stone["z"] * c
