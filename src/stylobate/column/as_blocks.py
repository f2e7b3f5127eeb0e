"""A column as it stands as an assembly: its drums as blocks, its links between them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from .assembly import Assembly
from .block import Block
from .column import Column
from .links.link import Link
from .links.placed import PlacedLink, Point, stands_at


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
    for link, one in zip(column.links, column.placed_links, strict=True):
        between: Any = tuple(names[f"drum {body}" if body else "ground"] for body in (one.lower, one.upper))
        places = ends(one)
        crossing = places[1:]  # what crosses a joint lies on the lower face of its upper drum
        where = dict(zip(("at", "to"), places if one.straight else crossing, strict=False))
        links.append(type(link)(between=between, name=prefix + one.name, numbers=one.alone, **where))
    return links


def ends_in_plane(column: Column, link: PlacedLink, place: tuple[float, float]) -> list[Point]:
    """Ends of a link of a column in the plane, the middle of whose base is at a place x, z [m]."""
    stand = (column.bodies[link.lower], column.bodies[link.upper])
    arms = column.link_ends(link)[:2]
    ends = [stands_at(body.place, body.lean, arm) for body, arm in zip(stand, arms, strict=True)]
    return [(x + place[0], y, z + place[1]) for x, y, z in ends]
