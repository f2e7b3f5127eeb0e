"""Imperfections: columns that differ from a survey by what no survey knows."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import check_range
from .column import Column


@dataclass(frozen=True)
class Imperfection:
    """Half widths of the intervals from which variations are drawn, all even and independent.

    Parameters
    ----------
    geometry : float
        Of the widths and of the height of each drum, relative [-]; both widths of a drum vary alike, so that it keeps
        its taper.
    friction, stiffness : float
        Of each joint's friction coefficient, and of its two stiffnesses alike, relative [-].
    amplitude : float
        Of the motion's amplitude, relative [-].
    phase : float
        Of the instant in its cycle at which a harmonic motion starts [cycles].
    across : float
        Of a second component of a harmonic motion along y, a quarter of a cycle late, relative to its amplitude along x [-].
        No shaking is plane; models in the plane leave this component out.

    Raises
    ------
    InputError
        A value outside its range.
    """

    geometry: float = 0.01
    friction: float = 0.01
    stiffness: float = 0.01
    amplitude: float = 0.0
    phase: float = 0.0
    across: float = 0.0

    def __post_init__(self) -> None:
        for field, high in (
            ("geometry", 0.2),
            ("friction", 0.9),
            ("stiffness", 0.9),
            ("amplitude", 0.5),
            ("phase", 0.5),
            ("across", 1.0),
        ):
            check_range(f"{field} of the imperfections", getattr(self, field), 0.0, high, remedy="0.01 is one per cent")

    @classmethod
    def of_size(cls, size: float) -> Imperfection:
        """Geometry, friction and stiffness alike; the motion is not varied."""
        return cls(geometry=size, friction=size, stiffness=size)


def imperfect_columns(column: Column, imperfection: Imperfection, number: int, seed: int) -> Sequence[Column]:
    """Columns that vary around the given one.

    Column k of a seed is the same for any ``number`` above k.

    Parameters
    ----------
    column : Column
    imperfection : Imperfection
    number : int
    seed : int
    """
    streams = np.random.default_rng(seed).spawn(number)
    return [_varied(column, imperfection, stream, k) for k, stream in enumerate(streams)]


def _varied(column: Column, size: Imperfection, stream: np.random.Generator, k: int) -> Column:
    # The order of the draws is part of what a seed means.
    wide, high, rough, stiff = 1.0 + stream.uniform(-1.0, 1.0, (4, column.n)) * np.array(
        [[size.geometry], [size.geometry], [size.friction], [size.stiffness]]
    )
    return rebuilt(column, wide, high, rough, stiff, f"{column.name}, variation {k + 1}")


def rebuilt(
    column: Column,
    wide: np.ndarray,
    high: np.ndarray,
    rough: np.ndarray,
    stiff: np.ndarray,
    name: str,
    dense: np.ndarray | None = None,
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
    weight = np.ones(column.n) if dense is None else dense
    drums = tuple(
        dataclasses.replace(
            drum,
            bottom_width=drum.bottom_width * wide[i],
            top_width=drum.top_width * wide[i],
            height=drum.height * high[i],
            density=drum.density * weight[i],
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
    return column.replace(drums=drums, joints=joints, name=name)
