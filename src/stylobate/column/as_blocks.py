"""A column as it stands as an assembly: its drums as blocks, its links between them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import check_range
from .assembly import Assembly
from .block import FAR_AWAY, Block
from .column import Column
from .found_geometry import Geometry, drum_outline, geometry
from .links.link import Link, Numbers
from .links.placed import PlacedLink


def of_column(column: Column, steps: Sequence[tuple[float, float]] = ()) -> Assembly:
    """A column as it stands as an assembly: the base is body 0, drum i is body i; in axes along and normal to the base.

    Parameters
    ----------
    column : Column
    steps : sequence of (float, float)
        Width and height of the fixed steps under the column, from the top down [m]; the ground lies below the last.
        None: the base is a half-plane.
    """
    column.must_carry_on_whole_faces("an assembly of blocks")
    blocks, level = [], 0.0
    for i, (width, height) in enumerate(steps):
        width = check_range(f"width of step {i + 1}", width, 0.0, FAR_AWAY, unit="m", open_low=True)
        height = check_range(f"height of step {i + 1}", height, 0.0, FAR_AWAY, unit="m", open_low=True)
        blocks.append(_box(f"step {i + 1}", width, level - height, level))
        level -= height
    drums, at = [], geometry(column)
    for i, drum in enumerate(column.drums):
        c, s = math.cos(at.lean[i]), math.sin(at.lean[i])
        corners = drum_outline(column, i) @ np.array([[c, s], [-s, c]]) + at.centroid[i]
        # the depth of the bed: a round drum's mean thickness across its width
        depth = drum.mean_depth if not drum.circular else 0.25 * math.pi * drum.mean_width
        drums.append(
            Block(
                tuple((float(x), float(z)) for x, z in corners),
                drum.density,
                f"drum {i + 1}",
                depth,
                surface=column.joints[i],
                solid=(drum.mass, drum.inertia, float(at.centroid[i, 0]), float(at.centroid[i, 1])),
            )
        )
    if not steps:
        return Assembly(tuple(drums), column.joints[0], column.name, column.gravity, 0.0)
    # body 0 is what the column stands on; the ground and further steps come after the drums
    far = _box("ground", 2.0 * FAR_AWAY, level - FAR_AWAY, level)
    return Assembly((blocks[0], *drums, *blocks[1:], far), column.joints[0], column.name, column.gravity, None)


def _box(name: str, width: float, low: float, high: float) -> Block:
    b = 0.5 * width
    return Block(((-b, low), (b, low), (b, high), (-b, high)), 0.0, name, fixed=True)


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
