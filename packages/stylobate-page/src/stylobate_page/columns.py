"""Columns for the page: what a column file holds, checked, with properties and an elevation."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.column import Column
from stylobate.column.catalogue import PRESETS, preset
from stylobate.column.files import tables_of
from stylobate.column.found_geometry import base_axes, space_geometry
from stylobate.column.links.placed import strokes
from stylobate.column.shapes import hull
from stylobate.column.tables import made_of
from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.response.poses import PlanePoses, bodies_of
from stylobate_exchange.convert import SURVEYS, Reading, read_model

from .forms import doubted, warned

#: Name of a column in messages, at first; on the page that goes without saying.
SOURCE = "the column"

#: How the page calls what the path of a field begins with; rows by their number or index.
_PLACES = {
    "drum": "drum {}",
    "found": "drum {}",
    "override": "the joint under drum {}",
    "link": "link {}",
    "joint": "all joints",
    "base_tilt": "the base",
}


def column_of(table: Mapping[str, Any]) -> Column:
    """The column that the tables of a file describe.

    Raises
    ------
    InputError
        They describe none; the message names the key and the remedy.
    """
    try:
        return made_of(Column, dict(table), SOURCE)
    except InputError as error:
        for words in error.places:  # in a file, which its reader does not see
            error.without(words)
        group, _, rest = (error.field or "").partition(".")
        own = [str(override.get("index")) for override in table.get("joint_override") or ()]
        if group == "override" and rest.partition(".")[0] not in own:  # what is wrong there is that of all joints
            error.field = f"joint.{rest.partition('.')[2]}"
        if group in _PLACES and len(error.places) > 1:
            error.args = (f"{_PLACES[group].format(rest.partition('.')[0])}: {error}",)
        raise


def presets() -> dict[str, dict[str, Any]]:
    """Column files of the presets by their names."""
    return {name: tables_of(preset(name)) for name in PRESETS}


def tables_in(path: Path, material: str | None = None, names: str | None = None) -> dict[str, Any]:
    """Contents of a column file or a survey, drum by drum, whichever way it is written.

    Parameters
    ----------
    path : Path
    material, names : str, optional
        Of a survey that states none, and of its columns where they are not called as ours, as ``convert`` takes them.
    """
    if path.suffix.lower() in SURVEYS:
        column, *_ = read_model(path, Reading(material, columns=names))
        assert isinstance(column, Column)  # a survey is one
        return tables_of(column)
    return tables_of(Column.from_toml(path))


def describe(table: Mapping[str, Any]) -> dict[str, Any]:
    """Column on the page: properties, warnings and outlines.

    Raises
    ------
    InputError
        The tables describe no column.
    """
    with doubted() as doubts:
        column = column_of(table)
        facts = {
            "height": column.height,
            "mass": column.mass,
            "slenderness": column.slenderness,
            "frequency_parameter": column.frequency_parameter,
            "uplift_g": column.uplift_acceleration / g,
            "joint_uplift_g": (column.joint_uplift_accelerations / g).tolist(),
            "radius": column.radius,
            "drums": column.n,
            "name": column.name,
            "digest": column.digest,
        }
    in_space = not column.as_found.in_plane
    seen = {"xz": _outlines(column, 0), "yz": _outlines(column, 1)} if in_space else {"xz": _in_plane(column)}
    return {
        "facts": facts,
        "outlines": {name: [outline.round(4).tolist() for outline in outlines] for name, outlines in seen.items()},
        "in_space": in_space,
        "links": _links(column, in_space),
        "slope": float(np.tan(np.radians(column.as_found.base_tilt))) if not in_space else 0.0,
        "joints": [
            {"width": float(column.joint_widths[i]), "friction": joint.tan_phi} for i, joint in enumerate(column.joints)
        ],
        "warnings": warned(doubts),
    }


def _in_plane(column: Column) -> list[np.ndarray]:
    """Corners of the drums of a column as found, seen along y [m]."""
    shapes = bodies_of(column).shapes
    return [_turned(shape.outline, at) for shape, at in zip(shapes, _placed(column), strict=True)]


def _placed(column: Column) -> np.ndarray:
    """Places of the drums of a column found in the plane: x and z of their centroids [m], and their angles [rad]."""
    still = np.zeros((1, column.n))
    return bodies_of(column).reference.plane(PlanePoses(still, still, still))[0]


def _turned(points: np.ndarray, at: np.ndarray) -> np.ndarray:
    x, z, angle = at
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]]) + (x, z)


def _links(column: Column, in_space: bool) -> dict[str, list[Any]]:
    """Ends of the lines that stand for its links [m], by what is looked at as outlines are."""
    if not in_space:
        base = np.array([0.0, 0.0, np.radians(column.as_found.base_tilt)])
        at = [base, *_placed(column)]

        def plane(body: int, place: np.ndarray) -> list[float]:
            return _turned(place[None, [0, 2]], at[body])[0].round(4).tolist()

        return {"xz": [[plane(*stroke.lower[:2]), plane(*stroke.upper[:2])] for stroke in strokes(column.placed_links)]}
    space, upright = space_geometry(column), base_axes(column)

    def seen(body: int, place: np.ndarray, axis: int) -> list[float]:
        point = space.centroid[body - 1] + space.axes[body - 1] @ place if body else place
        return (upright @ point)[[axis, 2]].round(4).tolist()

    lines = strokes(column.placed_links)
    return {
        name: [[seen(*line.lower[:2], axis), seen(*line.upper[:2], axis)] for line in lines]
        for name, axis in (("xz", 0), ("yz", 1))
    }


def _outlines(column: Column, axis: int) -> list[np.ndarray]:
    """The same of a column that is found out of the plane, over x or over y."""
    at, upright = space_geometry(column), base_axes(column)
    outlines = []
    for i, shape in enumerate(bodies_of(column).shapes):
        points = (at.centroid[i] + shape.mesh().vertices @ at.axes[i].T) @ upright.T
        outlines.append(hull(points[:, [axis, 2]]))
    return outlines


def refuse_large(table: Mapping[str, Any]) -> None:
    """Refuse tables with more drums or overrides than a column can have, before they are looked at one by one."""
    for key in ("drum", "joint_override", "link"):
        rows = table.get(key)
        if isinstance(rows, list) and len(rows) > 1000:
            raise InputError(f"the column has {len(rows)} entries under {key}; allowed is up to 1000.")
