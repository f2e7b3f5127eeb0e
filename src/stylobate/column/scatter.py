"""Scatter: columns that could as well stand there, by what nobody has measured of this one."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from ..errors import check_range
from ..messages import joined, say
from .as_found import FoundDrum
from .column import Column
from .materials import material
from .structure import Structure

#: Draws lie within so many standard deviations.
WITHIN = 2.5

#: Largest coefficient of variation of each part.
LARGEST = {
    "friction": 0.5, "joint_stiffness": 2.0, "density": 0.2, "width": 0.1, "height": 0.1, "offset": 0.1,
    "stiffness_damping": 2.0, "rolling_resistance": 2.0, "law": 1.0,
}  # fmt: skip


@dataclass(frozen=True)
class Scatter:
    """Coefficients of variation of what a survey does not know to the last digit; lognormal, cut at 2.5 standard deviations.

    Half of the variance of friction, joint stiffness and density is common to the whole column, because it is one stone and
    one hand; the other half, and all of width, height and offset, is each joint's or drum's own. The medians are those of
    the column given.

    In space what nobody knows of the joints varies too, if it is asked for: twins in threes share a law, to which half of
    the variance of β, c and joint stiffness is common; the other half is each twin's or joint's own.

    Of an assembly in space friction and stiffness are those of each stone's contacts with those before it, and an offset is
    that of each stone in plan, over the side of a square as large as its smallest joint; stones that touch otherwise than
    on level faces move together. Width and height do not vary: stones that fit one another cannot vary one by one.

    Parameters
    ----------
    friction : float
        Of the friction coefficient of each joint [-].
    joint_stiffness : float
        Of both stiffnesses of each joint alike [-].
    density : float
        Of the density of each drum [-].
    width, height : float
        Of each drum; both its widths vary alike, so that it keeps its taper [-].
    offset : float
        Standard deviation (normal) of the place of each drum on the one below, relative to the joint's width [-]; along x
        for models in the plane, in any direction for those in space. Left out where a model takes columns as built only.
    stiffness_damping : float
        Of the damping β of the joints, about the model's; about that of a contact of stone where the model has none [-].
    rolling_resistance : float
        Of the resistance to rolling c of round faces, likewise [-].
    law : float
        Share of the laws by which round faces carry otherwise than in the model: on a bed, not on rims, or the reverse [-].

    Raises
    ------
    InputError
        A value outside its range.
    """

    friction: float = 0.10
    joint_stiffness: float = 0.20
    density: float = 0.02
    width: float = 0.005
    height: float = 0.005
    offset: float = 0.003
    stiffness_damping: float = 0.0
    rolling_resistance: float = 0.0
    law: float = 0.0

    def __post_init__(self) -> None:
        for name, high in LARGEST.items():
            check_range(f"{name} of the scatter", getattr(self, name), 0.0, high, remedy="0.05 is five per cent")

    @property
    def given(self) -> dict[str, float]:
        """Scattered parts, by name."""
        return {name: value for name, value in dataclasses.asdict(self).items() if value}

    def describe(self) -> str:
        """The sizes in words."""
        name_and_size = say("{name} {size:.3g} %")
        words = (name_and_size.of(name=say(key.replace("_", " ")), size=100.0 * one) for key, one in self.given.items())
        return joined(", ", words) or say("nothing")


def usual_scatter(structure: Structure) -> Scatter:
    """Scatter of columns like this one where nobody states it: that of its material, else the defaults.

    The friction and density of a column that differ from its material's were given by hand: they scatter by the defaults. Of
    anything else, what its twins vary by scatters by the defaults.
    """
    usual, column = Scatter(), structure.stack
    if column is None:
        return dataclasses.replace(usual, **{name: 0.0 for name in usual.given if name not in structure.scattered})
    if column.material is None:
        return usual
    stone, changes = material(column.material), {}
    rough, dense = stone.friction_coefficient, stone.density
    if rough is not None and rough.variation and all(_same(joint.tan_phi, rough.value) for joint in column.joints):
        changes["friction"] = min(rough.variation, LARGEST["friction"])
    if dense.variation and all(_same(drum.density, dense.value) for drum in column.drums):
        changes["density"] = min(dense.variation, LARGEST["density"])
    return dataclasses.replace(usual, **changes)


def _same(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=1e-9)


def factors_of(size: Scatter, common: np.ndarray, own: np.ndarray) -> tuple[np.ndarray, ...]:
    """Factors of friction, stiffness, density, width, height of n bodies, shape (n,), and draws of their places, (2, n).

    Parameters
    ----------
    size : Scatter
    common, own : array
        Draws [-] of the material, shape (3,), and of each body, shape (7, n).
    """
    material = math.sqrt(0.5) * (common[:, None] + own[:3])
    factors = np.exp(
        np.vstack((material, own[3:5]))
        * [[spread_of(one)] for one in (size.friction, size.joint_stiffness, size.density, size.width, size.height)]
    )
    return (*factors, own[5:])


def drawn_column(
    column: Column,
    size: Scatter,
    stream: np.random.Generator,
    k: int,
    space: bool,
    stiffness: float | None = None,
) -> tuple[Column, float]:
    """Column number k that could as well stand there, and the share of its offsets that is left: all of them.

    ``stiffness`` is the draw of the stiffness that its joints have in common, where others share it.
    """
    # The order of the draws is part of what a seed means.
    common, own = normal(stream, 3), normal(stream, (7, column.n))
    if stiffness is not None:
        common[1] = stiffness
    rough, stiff, dense, wide, high, (aside, across) = factors_of(size, common, own)
    varied = _rebuilt(column, wide, high, rough, stiff, dense, f"{column.name}, twin {k + 1}")
    if not size.offset:
        return varied, 1.0
    shifts = size.offset * varied.joint_widths * np.array([aside, across if space else np.zeros(column.n)])
    found = tuple(_shifted(column.as_found.of(i + 1), *shifts[:, i]) for i in range(column.n))
    return varied.unwarned(as_found=dataclasses.replace(column.as_found, drums=found)), 1.0


def _rebuilt(
    column: Column,
    wide: np.ndarray,
    high: np.ndarray,
    rough: np.ndarray,
    stiff: np.ndarray,
    dense: np.ndarray,
    name: str,
) -> Column:
    """The column with every drum and joint multiplied by factors of its own.

    Parameters
    ----------
    column : Column
    wide, high, dense : array
        Of each drum's two widths, height and density [-], shape (n,).
    rough, stiff : array
        Of each joint's friction coefficient, and of its two stiffnesses [-], shape (n,).
    name : str
        Of the new column.
    """
    drums = tuple(
        dataclasses.replace(
            drum,
            bottom_width=drum.bottom_width * wide[i],
            top_width=drum.top_width * wide[i],
            height=drum.height * high[i],
            density=drum.density * dense[i],
        )
        for i, drum in enumerate(column.drums)
    )
    joints = tuple(
        joint.changed(
            normal_stiffness=joint.normal_stiffness * stiff[i],
            shear_stiffness=joint.shear_stiffness * stiff[i],
            friction_coefficient=joint.tan_phi * rough[i],
        )
        for i, joint in enumerate(column.joints)
    )
    return column.unwarned(drums=drums, joints=joints, name=name)


def _shifted(drum: FoundDrum, x: float, y: float) -> FoundDrum:
    """The drum as found, moved on by these lengths [m]."""
    angle = math.radians(drum.offset_azimuth)
    along, across = drum.offset * math.cos(angle) + x, drum.offset * math.sin(angle) + y
    if across == 0.0:
        return dataclasses.replace(drum, offset=along, offset_azimuth=0.0)
    azimuth = math.degrees(math.atan2(across, along))
    return dataclasses.replace(drum, offset=math.hypot(along, across), offset_azimuth=azimuth)


def normal(stream: np.random.Generator, shape: int | tuple[int, int]) -> np.ndarray:
    """Draws of a standard normal distribution within :data:`WITHIN` [-]."""
    return np.clip(stream.standard_normal(shape), -WITHIN, WITHIN)


def spread_of(variation: float) -> float:
    """Standard deviation of the logarithm that belongs to a coefficient of variation."""
    return math.sqrt(math.log1p(variation * variation))
