"""Scatter of columns and assemblies, and their twins: what could as well stand there."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError, check_range
from ..messages import joined, say
from .as_found import FoundDrum
from .column import Column
from .joint import Joint
from .links.link import Link
from .materials import material
from .spatial.assembly import SpatialAssembly
from .structure import Structure

#: Draws lie within so many standard deviations.
WITHIN = 2.5

#: Largest coefficient of variation of each part.
LARGEST = {
    "friction": 0.5, "joint_stiffness": 2.0, "density": 0.2, "width": 0.1, "height": 0.1, "offset": 0.1,
    "stiffness_damping": 2.0, "rolling_resistance": 2.0, "law": 1.0, "unknown_stiffness": 1.0,
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
    unknown_stiffness : float
        How far the stiffness that all joints of a law have in common is unknown [-]: at 1 each order of magnitude from
        1e9 N/m³ to what the stone between them allows is as likely, whatever the column's own; at 0.5 it is half as far
        from the column's own, in its logarithm.

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
    unknown_stiffness: float = 0.0

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
        words = (
            name_and_size.of(name=say(key.replace("_", " ")), size=100.0 * size) for key, size in self.given.items()
        )
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


def _same(value: float, other: float) -> bool:
    return math.isclose(value, other, rel_tol=1e-9)


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
        * [
            [spread_of(spread)]
            for spread in (size.friction, size.joint_stiffness, size.density, size.width, size.height)
        ]
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
    drums = tuple(_shifted(column.as_found.of(i + 1), *shifts[:, i]) for i in range(column.n))
    return varied.unwarned(as_found=dataclasses.replace(column.as_found, drums=drums)), 1.0


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


# -- Twins of an assembly in space ------------------------------------------------------------------------------------


#: A joint whose normal is inclined to the vertical by less than this slides without pushing its bodies apart [rad].
LEVEL = 1e-3

#: Offsets are halved so many times where moved stones would overlap; then the twin has none.
HALVED = 4


def drawn_assembly(
    assembly: SpatialAssembly, size: Scatter, stream: np.random.Generator, k: int, space: bool
) -> tuple[SpatialAssembly, float]:
    """Assembly number k that could as well stand there; its stones fit one another, so that none is wider or higher.

    A stone's deviations are those of its name, so that it has the same ones in every state of what stands. Beside it the
    share of its offsets that is left: 1 where its stones fit as drawn.
    """
    del space
    common, seed = normal(stream, 3), int(stream.integers(2**62))
    own = [normal(np.random.default_rng([seed, *stone.name.encode()]), 7) for stone in assembly.stones]
    rough, stiff, dense, _, _, shifts = factors_of(size, common, np.stack(own, axis=1))
    return varied(assembly, rough, stiff, dense, size.offset * shifts.T, f"{assembly.name}, twin {k + 1}")


def varied(
    assembly: SpatialAssembly, rough: np.ndarray, stiff: np.ndarray, dense: np.ndarray, shifts: np.ndarray, name: str
) -> tuple[SpatialAssembly, float]:
    """The assembly with every stone's contacts and density multiplied by factors of its own, and groups of stones shifted.

    Stones that touch otherwise than on level faces move together, and with what is fixed not at all. Where shifted stones
    would overlap all shifts are halved, in the end left out; what share of them is left stands beside it.

    Parameters
    ----------
    assembly : SpatialAssembly
    rough, stiff, dense : array
        Of the friction coefficient and both stiffnesses of each stone's contacts with those before it, and of its density
        [-], shape (n,).
    shifts : array
        Of each stone in plan, over the side of a square as large as the smallest joint of its group [-], shape (n, 2); of a
        group the first counts.
    name : str
        Of the new assembly.
    """
    first = len(assembly.bodies) - len(assembly.stones)
    stones = tuple(
        dataclasses.replace(
            stone, density=stone.density * dense[i], surface=_law(stone.surface or assembly.joint, rough[i], stiff[i])
        )
        for i, stone in enumerate(assembly.stones)
    )
    numbers = {body.name: i - first for i, body in enumerate(assembly.bodies)}
    overrides = []
    for block, other, law in assembly.overrides:
        later = max(numbers[block], numbers[other])
        overrides.append((block, other, _law(law, rough[later], stiff[later])))
    moved = _shifts(assembly, shifts, first)
    changes: dict[str, Any] = {"overrides": tuple(overrides), "name": name}
    for halved in range(HALVED + 1):
        share = 0.0 if halved == HALVED else 0.5**halved
        placed = tuple(_placed(stone, share * way) for stone, way in zip(stones, moved, strict=True))
        ways = {stone.name: share * way for stone, way in zip(stones, moved, strict=True)}
        links = tuple(_carried(link, ways) for link in assembly.links)
        try:
            return dataclasses.replace(assembly, stones=placed, links=links, **changes), share
        except InputError:
            if not share or not moved.any():
                raise
    raise AssertionError  # the last share is 0: the assembly as it is


def _law(law: Joint, rough: float, stiff: float) -> Joint:
    return law.changed(
        normal_stiffness=law.normal_stiffness * stiff,
        shear_stiffness=law.shear_stiffness * stiff,
        friction_coefficient=law.tan_phi * rough,
    )


def _placed(stone: Any, way: np.ndarray) -> Any:
    if not way.any():
        return stone
    x, y, z = stone.position
    return dataclasses.replace(stone, position=(x + float(way[0]), y + float(way[1]), z))


def _carried(link: Link, ways: Mapping[str, np.ndarray]) -> Link:
    """A link whose ends move with their stones in plan; what lies in a joint, with the first of both."""
    ends = {
        name: (float(place[0] + way[0]), float(place[1] + way[1]), place[2])
        for name, place, body in zip(("at", "to"), link.ends, link.between or (), strict=False)
        if place is not None and (way := ways.get(body, np.zeros(2))).any()
    }
    return dataclasses.replace(link, **ends) if ends else link


def _shifts(assembly: SpatialAssembly, shifts: np.ndarray, first: int) -> np.ndarray:
    """Shift of each stone in plan [m], shape (n, 2)."""
    group = _groups(assembly, first)
    narrowest: dict[int, float] = {}
    for joint in assembly.space_joints:
        for i in (joint.lower - first, joint.upper - first):
            if i >= 0:
                narrowest[group[i]] = min(narrowest.get(group[i], np.inf), float(np.sqrt(joint.area)))
    fixed_groups = {group[i] for i, stone in enumerate(assembly.stones) if stone.fixed} | {-1}
    return np.array(
        [
            np.zeros(2) if leader in fixed_groups else narrowest.get(leader, 0.0) * shifts[leader]
            for leader in group
        ]
    )  # fmt: skip


def _groups(assembly: SpatialAssembly, first: int) -> list[int]:
    """Of each stone the first of its group, by number; −1 of those that move with the ground."""
    group = list(range(len(assembly.stones)))
    level = {}
    for joint in assembly.space_joints:
        pair = joint.lower - first, joint.upper - first
        flat = bool(abs(joint.frame[2, 2]) > np.cos(LEVEL))
        level[pair] = flat and level.get(pair, True)
    for lower, upper in assembly.touching:
        pair = lower - first, upper - first
        if level.get(pair, False):
            continue
        leader, other = (-1 if i < 0 else group[i] for i in pair)
        group = [min(leader, other) if mine in (leader, other) else mine for mine in group]
    return group


# -- Twins ------------------------------------------------------------------------------------------------------------


#: Makers of twin number k and the share of its offsets that is left, from what stands, a scatter and its stream, in space or
#: not, by the kind of what stands.
TWIN_OF: dict[str, Callable[..., tuple[Structure, float]]] = {
    Column.kind: drawn_column,
    SpatialAssembly.kind: drawn_assembly,
}


def twins_of(structure: Structure, scatter: Scatter, number: int, seed: int, *, space: bool = False) -> Sequence[Any]:
    """What could as well stand there.

    Twin k of a seed is the same for any ``number`` above k; where one part does not scatter, the others stay the same.

    Parameters
    ----------
    structure : Column or SpatialAssembly
    scatter : Scatter
    number, seed : int
    space : bool
        Offsets in any direction, for a model in space; along x otherwise.
    """
    return [twin for twin, _ in drawn_twins(structure, scatter, number, seed, space=space)]


def drawn_twins(
    structure: Structure,
    scatter: Scatter,
    number: int,
    seed: int,
    *,
    space: bool = False,
    stiffness: np.ndarray | None = None,
) -> list[tuple[Any, float]]:
    """The same, each with the share of its offsets that is left: below 1 where its stones would have overlapped.

    ``stiffness`` are draws of what the joints of each column have in common, where columns share them.
    """
    shared = [()] * number if stiffness is None else [(float(draw),) for draw in stiffness]
    return [drawn_twin(structure, scatter, k, seed, *shared[k], space=space) for k in range(number)]


def drawn_twin(
    structure: Structure, scatter: Scatter, k: int, seed: int, *shared: float, space: bool = False
) -> tuple[Any, float]:
    """Twin k of a seed alone, as :func:`drawn_twins` gives it: where there are many, each is made when it is asked for.

    ``shared`` is the draw of what its joints have in common, where columns share it.
    """
    stream = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(k,)))
    return TWIN_OF[structure.kind](structure, scatter, stream, k, space, *shared)
