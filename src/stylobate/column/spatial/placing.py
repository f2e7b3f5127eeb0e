"""Where the bodies of a file stand: columns from their files, beams on them, and blocks of one or several parts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...constants import DEGREE
from ...errors import InputError, as_typed, check_range, suggest
from ..column import Column
from ..drum import LENGTHS
from ..found_geometry import SpaceGeometry, space_geometry
from ..joint import Joint
from ..links.link import Link
from ..links.placed import PlacedLink, Point
from ..shapes import UPRIGHT, Placed, Quaternion, about, matrix_of, product, quaternion_of
from ..standing import links_of_column, standing_column
from .stone import Stone, box_shape, centre_of, drum_shape, hull_shape, read_mesh, triple, unit_quaternion
from .tables import PartTable, SpaceBeamTable, SpaceBlockTable, SpaceColumnsTable
from .touching import TOUCHING, Solid, separation

#: Directions up, for turns.
UP = (0.0, 0.0, 1.0)


class Axis(NamedTuple):
    """A column that stands: its name, x and y of its axis, level of its top [m], its topmost drum and joint."""

    name: str
    place: tuple[float, float]
    level: float
    top: Stone
    law: Joint


def stand_in_space(
    tables: Sequence[SpaceColumnsTable], folder: Path, gravity: float, ground: float | None
) -> tuple[list[Stone], list[Axis], list[Link]]:
    """Drums of columns that stand on the ground, where their axes are, and their links.

    Raises
    ------
    InputError
        A file that is no column, a column that an assembly cannot take, or a place that is missing.
    """
    stones: list[Stone] = []
    axes: list[Axis] = []
    links: list[Link] = []
    if tables and ground is None:
        raise InputError("columns stand on the ground, and ground is false; give its level in m.")
    for table in tables:
        column = standing_column(table.file, folder)
        if column.gravity != gravity:
            raise InputError(
                f"{column.name!r} has a gravity of {column.gravity:g} m/s² and the assembly {gravity:g} m/s²; give one."
            )
        for x, y in _places(table):
            name = f"{table.name or 'column'} {len(axes) + 1}"
            drums, own = drums_in_space(column, (x, y, float(ground or 0.0)), table.turn * DEGREE, f"{name}, ")
            stones += drums
            links += own
            level = float(ground or 0.0) + column.height
            axes.append(Axis(name, (x, y), level, stones[-1], column.joints[-1]))
    return stones, axes, links


def drums_in_space(
    column: Column, foot: Point = (0.0, 0.0, 0.0), angle: float = 0.0, named: str = ""
) -> tuple[list[Stone], list[Link]]:
    """Drums of a column as stones in space, and its links.

    Parameters
    ----------
    column : Column
    foot : (float, float, float)
        Middle of its base [m].
    angle : float
        By which it is turned about the vertical [rad].
    named : str
        Before the names of its drums and links.

    Raises
    ------
    InputError
        Rings or tilts, which stones in space do not have.
    """
    column.must_carry_on_whole_faces("an assembly in space")
    tilted = next((found_drum.drum for found_drum in column.as_found.drums if found_drum.tilt), None)
    if tilted is not None:
        raise InputError(
            f"drum {tilted} of {column.name!r} is found tilted; an assembly in space takes offsets, turns and chips as "
            "found, and no tilt so far: leave it out."
        )
    at, turn = space_geometry(column), about(UP, angle)
    c, s = math.cos(angle), math.sin(angle)
    stones = []
    for i, (drum, body, law) in enumerate(zip(column.drums, column.bodies[1:], column.joints, strict=True)):
        u, v, w = (float(coordinate) for coordinate in at.centroid[i])
        place = (foot[0] + c * u - s * v, foot[1] + s * u + c * v, foot[2] + w)
        turned = product(turn, quaternion_of(at.axes[i]))
        parts = (Placed(body.shape),)  # pyright: ignore[reportArgumentType]
        stones.append(Stone(parts, place, drum.density, f"{named}{body.name}", turned, surface=law))
    called = {"ground": "ground"} | {body.name: f"{named}{body.name}" for body in column.bodies[1:]}
    stands = partial(_ends_of, column, at, np.array(foot), matrix_of(turn))
    return stones, links_of_column(column, stands, called, named)


def _ends_of(column: Column, at: SpaceGeometry, foot: np.ndarray, turned: np.ndarray, link: PlacedLink) -> list[Point]:
    """Ends of a link of a column as found, the middle of whose base is at a foot [m] and whose axes are turned so."""
    arms = list(link.arms)
    if not link.straight:  # it is fixed in the lower face of its upper drum
        below = (0.0, 0.0, -column.drums[link.upper - 1].centroid_height)
        arms[1] = below + at.bed[link.upper - 1] @ (*link.high[:2], 0.0)
    ends = []
    for body, arm in zip((link.lower, link.upper), arms, strict=True):
        end = at.centroid[body - 1] + at.axes[body - 1] @ arm if body else arm
        x, y, z = (float(coordinate) for coordinate in foot + turned @ end)
        ends.append((x, y, z))
    return ends


def _places(table: SpaceColumnsTable) -> list[tuple[float, float]]:
    if (table.at is None) == (table.number is None):
        raise InputError(
            f"[[column]] of {table.file!r} needs at = [[x, y], …], or number and spacing; give one of the two."
        )
    if table.at is not None:
        wrong = next((place for place in table.at if len(place) != 2), None)
        if not table.at or wrong is not None:
            what = "no place in at" if wrong is None else f"a place {as_typed(wrong)} in at"
            raise InputError(f"[[column]] of {table.file!r} has {what}; give x and y of each axis [m].")
        return [
            (check_range("x of a column", x, -1e3, 1e3, unit="m"), check_range("y of a column", y, -1e3, 1e3, unit="m"))
            for x, y in table.at
        ]
    number = table.number or 0
    if not 1 <= number <= 100:
        raise InputError(f"number of [[column]] is {number}; allowed is 1 to 100.")
    if number > 1 and table.spacing is None:
        raise InputError(f"{number} columns of {table.file!r} have no spacing; give the distance of their axes [m].")
    spacing = 0.0 if table.spacing is None else check_range("spacing", table.spacing, 0.0, 1e3, unit="m", open_low=True)
    return [(spacing * i, 0.0) for i in range(number)]


def lay_beam(table: SpaceBeamTable, name: str, density: float, axes: Sequence[Axis], surface: Joint | None) -> Stone:
    """A beam from axis to axis of two columns, and beyond by its overhang.

    Raises
    ------
    InputError
        Columns that are not there, tops of two levels, or a beam that ends in the air.
    """
    named = {axis.name: axis for axis in axes}
    for support in table.between:
        if support not in named:
            known = f"the columns are {', '.join(named) or 'none'}"
            raise InputError(f"beam {name!r} lies between {support!r}; {suggest(support, named)}{known}.")
    if len(table.between) != 2 or len(set(table.between)) != 2:
        raise InputError(f"between of beam {name!r} is {as_typed(table.between)}; name two different columns.")
    if len(table.section) != 2:
        raise InputError(f"section of beam {name!r} is {as_typed(table.section)}; give [across, height] in m.")
    support, other = (named[each] for each in table.between)
    if abs(support.level - other.level) > 1e-9 * max(1.0, abs(support.level)):
        raise InputError(
            f"beam {name!r} lies on tops at {support.level:g} and {other.level:g} m; give columns of one height."
        )
    across, height = (
        check_range(f"a side of the section of beam {name!r}", e, *LENGTHS, unit="m") for e in table.section
    )
    way = np.array(other.place) - np.array(support.place)
    span = float(np.hypot(*way))
    if span <= 0.0:
        raise InputError(f"beam {name!r} lies between two columns on one axis; place them apart.")
    both = table.overhang if isinstance(table.overhang, list) else [table.overhang] * 2
    if len(both) != 2:
        raise InputError(f"overhang of beam {name!r} has {len(both)} values; give one, or that at each of its columns.")
    first, last = (check_range(f"overhang of beam {name!r}", e, -span, 100.0, unit="m") for e in both)
    length = span + first + last
    if length < LENGTHS[0]:
        raise InputError(f"beam {name!r} is {length:g} m long with its overhangs; make it reach from column to column.")
    middle = np.array(support.place) + way / span * (0.5 * (length) - first)
    turn = about(UP, math.atan2(way[1], way[0]))
    beam = Stone.box(
        (length, across, height), (*middle, support.level), density, name=name, orientation=turn, surface=surface
    )  # fmt: skip
    solid = Solid(beam.placed[0])
    for end in (support, other):
        gap, _ = separation(solid, Solid(end.top.placed[0]), math.inf)
        if gap > TOUCHING * solid.size:
            raise InputError(
                f"beam {name!r} ends in the air, {gap:.3g} m from the top of {end.name!r}; make its overhang there larger."
            )
    return beam


def refuse_crossing(beams: Sequence[Stone]) -> None:
    """Refuse beams that reach beyond one another.

    Raises
    ------
    InputError
    """
    solids = [Solid(beam.placed[0]) for beam in beams]
    for i, solid in enumerate(solids):
        for k in range(i):
            gap, _ = separation(solids[k], solid, 0.0)
            if gap < -1e-6 * solid.size:
                ends = np.outer((1.0, -1.0), solid.axes[:, 0])  # the later one, along which it has to be shorter
                beyond = float(min(solid.extent(ends) + solids[k].extent(-ends)))
                raise InputError(
                    f"beams {beams[k].name!r} and {beams[i].name!r} reach beyond one another by {beyond:.3g} m; end one of "
                    "them before the other, such as with overhang = [0.0, -0.4]."
                )


def block_of(table: SpaceBlockTable, name: str, density: float, folder: Path, surface: Joint | None) -> Stone:
    """A block of a file where it stands.

    Raises
    ------
    InputError
        No shape or two of them, or values that are none.
    """
    who = f"block {name!r}"
    if table.parts is not None:
        if _shapes(table):
            raise InputError(f"{who} has parts and a {_shapes(table)[0]}; give one of the two.")
        parts, origin = _glued(table.parts, folder, who), None
        first = centre_of(parts)
    else:
        part, origin = _part(table, folder, who)
        parts = (part,)
        first = np.array([0.0, 0.0, -float(part.mesh(4).vertices[:, 2].min())]) if origin is None else origin
    if table.at is not None:
        where = np.array(triple(f"at of {who}", table.at, 1e4, "m")) + first
    elif origin is not None:
        where = origin
    else:
        raise InputError(f"{who} has no at; give the middle of its lower face [x, y, z] in m.")
    velocities = {
        key: getattr(table, key) for key in ("velocity", "angular_velocity") if getattr(table, key) is not None
    }
    x, y, z = (float(coordinate) for coordinate in where)
    turned = _orientation(table, who)
    return Stone(parts, (x, y, z), density, name, turned, fixed=table.fixed, surface=surface, **velocities)


def _shapes(table: PartTable) -> list[str]:
    return [key for key in ("box", "drum", "vertices", "mesh") if getattr(table, key) is not None]


def _part(table: PartTable, folder: Path, who: str) -> tuple[Placed, np.ndarray | None]:
    """A shape, and where its centroid is in coordinates of its own, if it has such; None of a box or a drum."""
    kinds = _shapes(table)
    if len(kinds) != 1:
        what = f"has {' and '.join(kinds)}" if kinds else "has no shape"
        raise InputError(f"{who} {what}; give one of box, drum, vertices, mesh and parts.")
    if table.unit is not None and table.mesh is None:
        raise InputError(f"{who} has a unit and no mesh; lengths are in m: leave it out.")
    if table.box is not None:
        return Placed(box_shape(table.box, who)), None
    if table.drum is not None:
        drum = table.drum
        return Placed(drum_shape(drum.bottom_diameter, drum.top_diameter, drum.height, who)), None
    if table.mesh is not None:
        shape, middle = hull_shape(read_mesh(folder / table.mesh, table.unit or "m"), who)
    else:
        shape, middle = hull_shape(table.vertices, who)
    return Placed(shape), middle


def _glued(tables: Sequence[PartTable], folder: Path, who: str) -> tuple[Placed, ...]:
    """Parts of one body from the middle of the lowest face; one without a place stands on the one before it."""
    placed_parts: list[Placed] = []
    level = 0.0
    for number, table in enumerate(tables, 1):
        part, origin = _part(table, folder, f"part {number} of {who}")
        low = float(part.mesh(48).vertices[:, 2].min())
        if origin is None:
            x, y, z = (
                (0.0, 0.0, level) if table.at is None else triple(f"at of part {number} of {who}", table.at, 1e3, "m")
            )
            z -= low
        else:
            x, y, z = (
                float(coordinate) for coordinate in origin + (np.zeros(3) if table.at is None else np.array(table.at))
            )
        placed_parts.append(Placed(part.shape, (x, y, z)))
        level = float(placed_parts[-1].mesh(48).vertices[:, 2].max())
    if not placed_parts:
        raise InputError(f"{who} has no parts; give one at least.")
    return tuple(placed_parts)


def _orientation(table: SpaceBlockTable, who: str) -> Quaternion:
    """Turned about the vertical first, then tilted towards an azimuth."""
    if table.orientation is not None:
        if table.turn or table.tilt or table.towards is not None:
            raise InputError(f"{who} has an orientation and a turn or tilt; give one of the two.")
        return unit_quaternion(f"orientation of {who}", table.orientation)
    if table.tilt and table.towards is None:
        raise InputError(f"{who} is tilted and has no towards; give the azimuth it leans to [degrees].")
    turn, tilt = (
        check_range(f"{key} of {who}", getattr(table, key), -360.0, 360.0, unit="°") for key in ("turn", "tilt")
    )
    upright = about(UP, turn * DEGREE) if turn else UPRIGHT
    if not tilt:
        return upright
    azimuth = check_range(f"towards of {who}", table.towards or 0.0, -360.0, 360.0, unit="°") * DEGREE
    return product(about((-math.sin(azimuth), math.cos(azimuth), 0.0), tilt * DEGREE), upright)
