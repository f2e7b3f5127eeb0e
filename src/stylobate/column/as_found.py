"""Columns as they are found: drums offset, edges chipped, the base out of level; each is part of the geometry."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..constants import DEGREE
from ..errors import InputError, check_range
from .assembly import FAR_AWAY, Assembly, Block
from .column import Column

#: Height of a chip as a share of its width: a spall runs steeper than 45°.
CHIP_SLOPE = 1.5


@dataclass(frozen=True)
class Imperfections:
    """What is not as it was built; drums and joints are numbered from 1 at the base.

    Parameters
    ----------
    offsets : mapping of int to float
        Offset of a drum, and of all that stands on it, along the joint under it [m], positive to the right.
    chips : mapping of (int, str) to float
        Width that the lower face of a drum has lost on its ``left`` or ``right`` side [m]; the stone's mass is kept.
    base_tilt : float
        Slope of the base, counter-clockwise positive [degrees].
    """

    offsets: Mapping[int, float] = field(default_factory=dict)
    chips: Mapping[tuple[int, str], float] = field(default_factory=dict)
    base_tilt: float = 0.0

    def __post_init__(self) -> None:
        for drum, value in self.offsets.items():
            check_range(f"offset of drum {drum}", value, -10.0, 10.0, unit="m")
        for (drum, side), value in self.chips.items():
            if side not in ("left", "right"):
                raise InputError(f"the chip of drum {drum} is on side {side!r}; allowed are left and right.")
            check_range(f"chip of drum {drum}", value, 0.0, 10.0, unit="m", open_low=True)
        check_range("base_tilt", self.base_tilt, -45.0, 45.0, unit="degrees")

    def contacts(self, column: Column) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Axis of every drum, and left and right end of the contact in every joint, along the base [m], shapes (n,).

        Raises
        ------
        InputError
            A drum that the column does not have, or two faces that no longer touch.
        """
        for drum in (*self.offsets, *(drum for drum, _ in self.chips)):
            if not 1 <= drum <= column.n:
                raise InputError(f"an imperfection names drum {drum}; {column.name!r} has drums 1 to {column.n}.")
        axis = np.cumsum([self.offsets.get(i + 1, 0.0) for i in range(column.n)])
        bottom = np.array([drum.bottom_width for drum in column.drums])
        low = axis - 0.5 * bottom + [self.chips.get((i + 1, "left"), 0.0) for i in range(column.n)]
        high = axis + 0.5 * bottom - [self.chips.get((i + 1, "right"), 0.0) for i in range(column.n)]
        top = np.array([drum.top_width for drum in column.drums])
        low[1:] = np.maximum(low[1:], (axis - 0.5 * top)[:-1])
        high[1:] = np.minimum(high[1:], (axis + 0.5 * top)[:-1])
        parted = np.flatnonzero(high - low <= 0.0)
        if parted.size:
            raise InputError(
                f"joint {parted[0] + 1} has no contact left with these offsets and chips; make them smaller there."
            )
        return axis, low, high

    def check(self, column: Column) -> None:
        """Refuse what cannot stand.

        The weight above a joint must pass between the ends of its contact, and must not slide down a tilted base.

        Raises
        ------
        InputError
            The column is not in equilibrium; the message names the joint and the missing moment or force.
        """
        axis, low, high = self.contacts(column)
        slope = self.base_tilt * DEGREE
        for j in range(column.n):
            weight = float(column.joint_weights[j])
            mass = column.masses[j:]
            along = float(mass @ axis[j:] / mass.sum())
            height = float(mass @ (column.centroid_heights[j:] - column.joint_heights[j]) / mass.sum())
            # the weight meets the joint where it points to: down the slope by its height
            foot = along - height * math.tan(slope)
            beyond = max(foot - high[j], low[j] - foot)
            if beyond > 0.0:
                raise InputError(
                    f"{column.name!r} is not in equilibrium: at joint {j + 1} the weight above passes "
                    f"{1000.0 * beyond:.3g} mm beyond the contact, {weight * math.cos(slope) * beyond:.4g} N m are missing; "
                    "make the offsets, chips or the tilt smaller."
                )
            excess = abs(math.sin(slope)) - math.cos(slope) * column.joints[j].tan_phi
            if excess > 0.0:
                raise InputError(
                    f"{column.name!r} is not in equilibrium: joint {j + 1} slides down the tilted base, "
                    f"{weight * excess:.4g} N of friction are missing; make base_tilt smaller or the friction larger."
                )


def imperfect(column: Column, imperfections: Imperfections) -> Assembly:
    """The column as found, as an assembly: drums as blocks on a fixed base.

    Raises
    ------
    InputError
        It is not in equilibrium.
    """
    imperfections.check(column)
    axis, *_ = imperfections.contacts(column)
    slope = imperfections.base_tilt * DEGREE
    c, s = math.cos(slope), math.sin(slope)
    turn = np.array([[c, s], [-s, c]])
    far = FAR_AWAY / 10.0
    base = np.array([[-far, -far], [far, -far], [far, 0.0], [-far, 0.0]]) @ turn
    blocks = [Block(_tuples(base), 0.0, "base", fixed=True)]
    for i, (drum, z) in enumerate(zip(column.drums, column.joint_heights, strict=True)):
        b, t = 0.5 * drum.bottom_width, 0.5 * drum.top_width
        corners = []
        for side, sign in (("left", -1.0), ("right", 1.0)):
            chip = imperfections.chips.get((i + 1, side), 0.0)
            rise = min(CHIP_SLOPE * chip, 0.5 * drum.height)
            flank = (sign * (b + (t - b) * rise / drum.height), rise)
            foot = (sign * (b - chip), 0.0)
            pair = [foot] if chip == 0.0 else [flank, foot] if sign < 0.0 else [foot, flank]
            corners += pair
        corners += [(t, drum.height), (-t, drum.height)]
        centroid = np.array([[axis[i], column.centroid_heights[i]]]) @ turn
        depth = drum.depth if not drum.circular else 0.25 * math.pi * drum.mean_width
        blocks.append(
            Block(
                _tuples((np.array(corners) + np.array([axis[i], z])) @ turn),
                drum.density,
                f"drum {i + 1}",
                depth,
                surface=column.joints[i],
                solid=(drum.mass, drum.inertia, float(centroid[0, 0]), float(centroid[0, 1])),
            )
        )
    return Assembly(tuple(blocks), column.joints[0], f"{column.name}, as found", column.gravity, None)


def _tuples(corners: np.ndarray) -> tuple[tuple[float, float], ...]:
    return tuple((float(x), float(z)) for x, z in corners)
