"""Columns from their files that stand in an assembly, their links, and the beams that lie on them."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import InputError, check_range, suggest
from .assembly import Assembly
from .block import TOUCHING, Block
from .column import Column
from .drum import LENGTHS
from .files import load_column
from .joint import Joint
from .links.link import Link
from .links.placed import PlacedLink, Point, stands_at
from .tables import JointTable
from .toml import Table


def of_column(column: Column) -> Assembly:
    """A column as it stands as an assembly: the base is body 0, drum i is body i; in axes along and normal to the base."""
    column.must_carry_on_whole_faces("an assembly of blocks")
    drums = []
    for drum, body, surface in zip(column.drums, column.bodies[1:], column.joints, strict=True):
        corners = tuple((float(x), float(z)) for x, z in body.outline)
        solid = (body.mass, body.inertia, *body.place)
        drums.append(Block(corners, drum.density, body.name, body.shape.depth, surface=surface, solid=solid))
    return Assembly(tuple(drums), column.joints[0], column.name, column.gravity, 0.0)


def links_of_column(
    column: Column, ends: Callable[[PlacedLink], Sequence[Point]], names: Mapping[str, str], prefix: str = ""
) -> list[Link]:
    """Links of a column that stands in an assembly.

    Parameters
    ----------
    column : Column
    ends : callable
        Where the ends of a link of it are there: on its lower body and on its upper one [m].
    names : mapping of str to str
        What ``ground`` and ``drum 1`` … are called there.
    prefix : str
        Of the names of the links.
    """
    links = []
    for link, placed_link in zip(column.links, column.placed_links, strict=True):
        between: Any = tuple(
            names[f"drum {body}" if body else "ground"] for body in (placed_link.lower, placed_link.upper)
        )
        places = ends(placed_link)
        crossing = places[1:]  # what crosses a joint lies on the lower face of its upper drum
        where = dict(zip(("at", "to"), places if placed_link.straight else crossing, strict=False))
        links.append(type(link)(between=between, name=prefix + placed_link.name, numbers=placed_link.alone, **where))
    return links


def ends_in_plane(column: Column, link: PlacedLink, place: tuple[float, float]) -> list[Point]:
    """Ends of a link of a column in the plane, the middle of whose base is at a place x, z [m]."""
    stand = (column.bodies[link.lower], column.bodies[link.upper])
    arms = column.link_ends(link)[:2]
    ends = [stands_at(body.place, body.lean, arm) for body, arm in zip(stand, arms, strict=True)]
    return [(x + place[0], y, z + place[1]) for x, y, z in ends]


# -- Columns from their files that stand in an assembly, and the beams that lie on them -------------------------------


class ColumnsTable(Table):
    """``[[column]]``: columns alike, from a file; ``at`` are the places of their axes, or ``number`` and ``spacing`` [m]."""

    file: str
    name: str | None = None
    at: list[float] | None = None
    number: int | None = None
    spacing: float | None = None


class BeamTable(Table):
    """``[[beam]]``: a block that lies on columns; lengths in m.

    It reaches from the first to the last axis of the columns under it, ``overhang`` beyond; or it has a ``length``, and
    ``centre`` is the x of its middle. ``between`` names two columns, ``on`` counts those under it from 1.
    """

    height: float
    length: float | None = None
    overhang: float | list[float] | None = None
    depth: float = 1.0
    name: str | None = None
    centre: float | None = None
    between: list[str] | None = None
    on: list[int] | None = None
    density: float | None = None
    surface: JointTable | None = None


class Standing(NamedTuple):
    """A column that stands: its name, its place, the ends and the level of its top [m], the law of its topmost joint."""

    name: str
    place: float
    left: float
    right: float
    level: float
    law: Joint


def standing_column(file: str, folder: Path) -> Column:
    """The column of a file beside that of an assembly, or the preset of that name, which stands on level ground.

    Raises
    ------
    InputError
        There is no such column, or its base is out of level.
    """
    beside = folder / file
    column = load_column(beside if beside.is_file() or file.endswith(".toml") else file)
    if column.as_found.base_tilt:
        raise InputError(f"{column.name!r} stands on a base out of level, and the ground of an assembly is level.")
    return column


def stand(
    tables: Sequence[ColumnsTable], folder: Path, gravity: float, ground: float | bool
) -> tuple[list[Block], list[Standing], list[Link]]:
    """Blocks of columns that stand on the ground, where their tops are, and their links.

    Parameters
    ----------
    tables : sequence of ColumnsTable
    folder : Path
        That paths start from.
    gravity : float
        Of the assembly [m/s²].
    ground : float or False
        Level of the ground [m].

    Raises
    ------
    InputError
        A file that is no column, a column that an assembly cannot take, or a place that is missing.
    """
    blocks: list[Block] = []
    standing_columns: list[Standing] = []
    links: list[Link] = []
    if tables and isinstance(ground, bool):
        raise InputError("columns stand on the ground, and ground is false; give its level in m.")
    for table in tables:
        column = standing_column(table.file, folder)
        if not column.as_found.in_plane:
            raise InputError(f"{column.name!r} is found out of the plane of x and z, in which assemblies lie.")
        if column.gravity != gravity:
            raise InputError(
                f"{column.name!r} has a gravity of {column.gravity:g} m/s² and the assembly {gravity:g} m/s²; give one."
            )
        for x in _places(table):
            name = f"{table.name or 'column'} {len(standing_columns) + 1}"
            stones = of_column(column).blocks
            drums = [_moved(stone, f"{name}, {stone.name}", x, float(ground)) for stone in stones]
            blocks += drums
            called = {"ground": "ground"} | {stone.name: f"{name}, {stone.name}" for stone in stones}
            ends = partial(ends_in_plane, column, place=(x, float(ground)))
            links += links_of_column(column, ends, called, f"{name}, ")
            top = sorted(drums[-1].vertices, key=lambda corner: corner[1])[-2:]
            if abs(top[0][1] - top[1][1]) > TOUCHING * column.height:
                level = float("nan")  # it leans: nothing lies on it
            else:
                level = top[1][1]
            left, right = sorted(corner[0] for corner in top)
            standing_columns.append(Standing(name, x, left, right, level, column.joints[-1]))
    return blocks, standing_columns, links


def _places(table: ColumnsTable) -> list[float]:
    if (table.at is None) == (table.number is None):
        raise InputError(f"[[column]] of {table.file!r} needs at = [...], or number and spacing; give one of the two.")
    if table.at is not None:
        if not table.at:
            raise InputError(f"[[column]] of {table.file!r} has no place in at; give at least one x [m].")
        return table.at
    number = table.number or 0
    if not 1 <= number <= 100:
        raise InputError(f"number of [[column]] is {number}; allowed is 1 to 100.")
    if number > 1 and table.spacing is None:
        raise InputError(f"{number} columns of {table.file!r} have no spacing; give the distance of their axes [m].")
    spacing = 0.0 if table.spacing is None else check_range("spacing", table.spacing, 0.0, 1e3, unit="m", open_low=True)
    return [spacing * i for i in range(number)]


def _moved(block: Block, name: str, x: float, z: float) -> Block:
    mass, inertia, cx, cz = block.properties
    corners = tuple((a + x, b + z) for a, b in block.vertices)
    return dataclasses.replace(block, vertices=corners, name=name, solid=(mass, inertia, cx + x, cz + z))


def lay(table: BeamTable, name: str, density: float, columns: Sequence[Standing], surface: Joint | None) -> Block:
    """A beam on the columns that it names, on all of them by default; what ends on an axis lies on half of that top.

    Raises
    ------
    InputError
        Columns that are not there, tops that are not level with one another, or a beam that does not reach them.
    """
    under = _under(table, name, columns)
    levels = [support.level for support in under]
    if not max(levels) - min(levels) <= 1e-9 * max(1.0, max(levels)):
        raise InputError(
            f"beam {name!r} lies on tops at {', '.join(f'{level:g}' for level in levels)} m; give columns of one height "
            "that stand upright."
        )
    left, right = _ends(table, name, [support.place for support in under])
    low, near = levels[0], 1e-9 * max(1.0, abs(left), abs(right))
    for top in under:
        if not left - near <= top.place <= right + near:
            raise InputError(
                f"beam {name!r} reaches from {left:g} to {right:g} m, and {top.name!r} stands at {top.place:g} m; make it "
                "reach the axis, or say on which columns it lies: on = [...]."
            )
    corners = ((left, low), (right, low), (right, low + table.height), (left, low + table.height))
    return Block(corners, density, name, table.depth, surface=surface)


def _under(table: BeamTable, name: str, columns: Sequence[Standing]) -> list[Standing]:
    """The columns that a beam names."""
    if table.on is not None and table.between is not None:
        raise InputError(f"beam {name!r} has on and between; give one of the two.")
    if table.between is not None:
        named = {column.name: column for column in columns}
        for wanted in table.between:
            if wanted not in named:
                known = f"the columns are {', '.join(named) or 'none'}"
                raise InputError(f"beam {name!r} lies between {wanted!r}; {suggest(wanted, named)}{known}.")
        if len(set(table.between)) != 2 or len(table.between) != 2:
            raise InputError(f"beam {name!r} lies between {len(table.between)} columns; name two different ones.")
        return [named[column_name] for column_name in table.between]
    numbers = list(range(1, len(columns) + 1)) if table.on is None else table.on
    wrong = next((number for number in numbers if not 1 <= number <= len(columns)), None)
    if not numbers or wrong is not None:
        what = "no column" if wrong is None else f"column {wrong}"
        raise InputError(f"beam {name!r} lies on {what}; the file has columns 1 to {len(columns)}.")
    return [columns[number - 1] for number in numbers]


def _ends(table: BeamTable, name: str, places: Sequence[float]) -> tuple[float, float]:
    """Ends of a beam [m]."""
    first, last = min(places), max(places)
    if table.length is not None:
        if table.overhang is not None:
            raise InputError(f"beam {name!r} has a length and an overhang; give one of the two.")
        length = check_range(f"length of beam {name!r}", table.length, *LENGTHS, unit="m")
        middle = 0.5 * (first + last) if table.centre is None else table.centre
        return middle - 0.5 * length, middle + 0.5 * length
    if table.centre is not None:
        raise InputError(f"beam {name!r} has a centre and no length; give its length [m], or leave the centre out.")
    given = table.overhang if isinstance(table.overhang, list) else [table.overhang or 0.0] * 2
    if len(given) != 2:
        raise InputError(f"overhang of beam {name!r} has {len(given)} values; give one, or that on the left and right.")
    left, right = (check_range(f"overhang of beam {name!r}", overhang, 0.0, 100.0, unit="m") for overhang in given)
    if last + right - first + left <= 0.0:
        raise InputError(f"beam {name!r} lies on one axis and has no length; give it one, or an overhang [m].")
    return first - left, last + right
