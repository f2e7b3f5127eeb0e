"""A column as it stands as an assembly: its drums as blocks, its links between them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from .assembly import Assembly
from .block import Block
from .column import Column
from .found_geometry import Geometry, geometry
from .links.link import Link, Numbers
from .links.placed import PlacedLink


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
    at, found = geometry(column), []
    for link, one in zip(column.links, column.placed_links, strict=True):
        between: Any = tuple(names[f"drum {body}" if body else "ground"] for body in (one.lower, one.upper))
        ends = _ends(column, one) if one.straight else (_in_joint(column, at, one),)
        moved = ((x + place[0], y, z + place[1]) for x, y, z in ends)
        where = dict(zip(("at", "to"), moved, strict=False))
        # what stone a pin leaves was looked at in the column
        held: dict[str, Any] = {field.name: getattr(one, field.name) for field in dataclasses.fields(Numbers)}
        numbers = Numbers(**{**held, "diameter": 0.0})
        found.append(type(link)(between=between, name=prefix + one.name, numbers=numbers, **where))
    return found


def _ends(column: Column, link: PlacedLink) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Ends of a tie or core of a column as it stands [m]."""
    at, ends = geometry(column), []
    for body, place in zip((link.lower, link.upper), link.arms, strict=True):
        x, z = place[0], place[2]
        if body:
            angle = float(at.lean[body - 1] + at.tilt[body - 1])
            c, s = math.cos(angle), math.sin(angle)
            x, z = np.array([c * x - s * z, s * x + c * z]) + at.centroid[body - 1]
        ends.append((float(x), float(place[1]), float(z)))
    return ends[0], ends[1]


def _in_joint(column: Column, at: Geometry, link: PlacedLink) -> tuple[float, float, float]:
    """Place of a dowel, bar or layer on the lower face of its upper drum, as it stands [m]."""
    i = link.upper - 1
    axis, lean = float(at.lean[i] + at.tilt[i]), float(at.lean[i])
    x, z = at.centroid[i] - column.drums[i].centroid_height * np.array([-math.sin(axis), math.cos(axis)])
    return float(x + link.high[0] * math.cos(lean)), link.high[1], float(z + link.high[0] * math.sin(lean))
