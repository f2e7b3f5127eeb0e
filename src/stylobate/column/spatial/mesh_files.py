"""Meshes of stones: closed parts of plausible size, one convex part, or a sentence that says what is not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...errors import InputError
from ...reading import shown
from ..plausible import bulk_doubts
from .mesh_formats import GLTF, MeshPart, edges_of, parsed_parts, pieces_of

#: Units that a mesh may be in [m].
UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048}

#: How far a vertex may stand out of a face as a share of the size [-].
BULGE = 1e-4


def read_mesh(path: Path, unit: str = "m") -> np.ndarray:
    """Vertices of a convex stone from a mesh [m], shape (m, 3).

    Raises
    ------
    InputError
        No mesh; one of several parts, with holes, that is not convex, or of a size that no stone has.
    """
    name, factor = shown(path), unit_of(unit, shown(path))
    objects = parsed_parts(path)
    parts = objects if len(objects) > 1 else pieces_of(objects[0])
    if len(parts) > 1:
        some = ", ".join(part.name for part in parts[:3])
        more = ", …" if len(parts) > 3 else ""
        raise InputError(f"{name} holds {len(parts)} parts ({some}{more}); give each in a file of its own.")
    (part,) = parts
    _check_sizes([part], factor, name, "unit = " + ", ".join(f'"{one}"' for one in UNITS))
    check_closed(part, name)
    _check_convex(part, name)
    return part.in_metres(factor, upward(path)).points[part.used]


def upward(path: Path) -> str:
    """The axis that is upward in a format unless told otherwise, ``y`` or ``z``."""
    return "y" if path.suffix.lower() in GLTF else "z"


def read_stones(path: Path, unit: str = "m", up: str | None = None) -> list[MeshPart]:
    """Every closed surface of a mesh [m], z upward, each under a name of its own; ``up`` is the file's axis upward.

    Raises
    ------
    InputError
        No mesh; a part with holes; or sizes all of which no stone has.
    """
    name, factor = shown(path), unit_of(unit, shown(path))
    parts = [piece for part in parsed_parts(path) for piece in pieces_of(part)]
    _check_sizes(parts, factor, name, "`unit` " + ", ".join(UNITS))
    names = [part.name for part in parts]
    found = []
    for number, part in enumerate(parts):
        own = part.name if names.count(part.name) == 1 else f"{part.name}, {names[: number + 1].count(part.name)}"
        check_closed(part, f"part {own!r} of {name}")
        found.append(replace(part.in_metres(factor, up or upward(path)), name=own))
    return found


def unit_of(unit: str, name: str) -> float:
    """A unit of a file [m]."""
    if unit not in UNITS:
        raise InputError(f"the unit of {name} is {unit!r}; allowed are {', '.join(UNITS)}.", "unit")
    return UNITS[unit]


def _check_sizes(parts: Sequence[MeshPart], factor: float, name: str, known: str) -> None:
    """Refuse a mesh of which no part has the size of a stone."""
    doubts = [
        bulk_doubts(f"the size of {name}", (factor * np.ptp(part.points[part.used], axis=0)).tolist()) for part in parts
    ]
    if all(doubts):
        raise InputError(f"{doubts[0][0]} Say it with {known}.", "unit")


def check_closed(part: MeshPart, name: str) -> None:
    """Refuse a surface of which an edge does not belong to two faces, which pass it in opposite directions.

    Raises
    ------
    InputError
    """
    passed = edges_of(part)
    for number, face in enumerate(part.faces):
        for a, b in zip(face, (*face[1:], face[0]), strict=True):
            times, back = passed[a, b], passed[b, a]
            if times == back == 1:
                continue
            where = f"at the edge of vertices {a + 1} and {b + 1} ({part.face(number)})"
            if times == back:
                raise InputError(
                    f"{name} has {times + back} faces {where}, as stones have that share corners; write each as an "
                    "object of its own."
                )
            what = "has a hole" if times == 1 and not back else "has faces of opposite directions"
            raise InputError(f"{name} {what} {where}; close the mesh, its faces counter-clockwise from outside.")


def _check_convex(part: MeshPart, name: str) -> None:
    """No vertex stands out of a face."""
    used, points = part.used, part.points
    size = float(np.ptp(points[used], axis=0).max())
    middle = points[used].mean(axis=0)
    for number, face in enumerate(part.faces):
        corners = points[list(face)]
        normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
        length = np.linalg.norm(normal)
        if length <= 1e-12 * size * size:
            raise InputError(f"the {part.face(number)} of {name} has no area; mend the mesh.")
        normal = normal / length
        if normal @ (middle - corners[0]) > 0.0:
            normal = -normal
        out = (points[used] - corners.mean(axis=0)) @ normal
        if out.max() > BULGE * size:
            raise InputError(
                f"{name} is not convex at the {part.face(number)}: vertex {used[int(out.argmax())] + 1} stands "
                f"{float(out.max()):.3g} out of it; split the stone into convex parts, each a part of one block."
            )
