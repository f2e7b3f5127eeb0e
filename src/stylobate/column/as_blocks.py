"""A column as it stands as an assembly: its drums as blocks, its links between them."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

from .assembly import Assembly
from .block import Block
from .column import Column
from .links.link import Link, Numbers
from .links.placed import stands_at


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
    column: Column, place: tuple[float, float], names: Mapping[str, str], prefix: str = ""
) -> list[Link]:
    """Links of a column that stands at a place of an assembly [m].

    Parameters
    ----------
    column : Column
    place : (float, float)
        Of the middle of its base, x and z [m].
    names : mapping of str to str
        What ``ground`` and ``drum 1`` … are called there.
    prefix : str
        Of the names of the links.
    """
    links = []
    for link, one in zip(column.links, column.placed_links, strict=True):
        between: Any = tuple(names[f"drum {body}" if body else "ground"] for body in (one.lower, one.upper))
        stand = (column.bodies[one.lower], column.bodies[one.upper])
        places = [
            stands_at(body.place, body.lean, end) for body, end in zip(stand, column.link_ends(one)[:2], strict=True)
        ]
        ends = places if one.straight else places[1:]  # what crosses a joint lies on the lower face of its upper drum
        moved = ((x + place[0], y, z + place[1]) for x, y, z in ends)
        where = dict(zip(("at", "to"), moved, strict=False))
        # what stone a pin leaves was looked at in the column
        held: dict[str, Any] = {field.name: getattr(one, field.name) for field in dataclasses.fields(Numbers)}
        numbers = Numbers(**{**held, "diameter": 0.0})
        links.append(type(link)(between=between, name=prefix + one.name, numbers=numbers, **where))
    return links
