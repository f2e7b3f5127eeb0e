"""Meshes of stones (Wavefront OBJ): one closed, convex part of plausible size, or a sentence that says what is not."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np

from ...errors import InputError
from ...reading import read_bytes, shown
from ..plausible import COLUMN

#: Units that a mesh may be in [m].
UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048}

#: Largest file [bytes]; how far a vertex may stand out of a face as a share of the size [-].
LARGEST, BULGE = 20_000_000, 1e-4


def read_mesh(path: Path, unit: str = "m") -> np.ndarray:
    """Vertices of a convex stone from an OBJ file [m], shape (m, 3).

    Raises
    ------
    InputError
        No OBJ file; a mesh of several parts, with holes, that is not convex, or of a size that no stone has.
    """
    name = shown(path)
    if unit not in UNITS:
        raise InputError(f"the unit of {name} is {unit!r}; allowed are {', '.join(UNITS)}.")
    points, faces, objects = _parsed(path, name)
    if len(objects) > 1:
        raise InputError(
            f"{name} holds {len(objects)} parts ({', '.join(objects[:3])}{', …' if len(objects) > 3 else ''}); give each in "
            "a file of its own."
        )
    size = float(np.ptp(points, axis=0).max()) * UNITS[unit]
    doubt = COLUMN.doubt(f"the size of {name}", size, "stones have")
    if doubt:
        known = ", ".join(f'"{one}"' for one in UNITS)
        raise InputError(f"{doubt[0]} Say it with unit = {known}.")
    _check_closed(faces, name)
    _check_convex(points, faces, name)
    return points * UNITS[unit]


def _parsed(path: Path, name: str) -> tuple[np.ndarray, list[tuple[int, list[int]]], list[str]]:
    """Vertices, faces with their lines, and names of objects."""
    text = read_bytes(path, LARGEST, "thin the mesh out").decode("utf-8", "replace")
    points: list[list[float]] = []
    faces: list[tuple[int, list[int]]] = []
    objects: list[str] = []
    for number, line in enumerate(text.splitlines(), 1):
        word, *rest = line.split() or [""]
        try:
            if word == "v":
                x, y, z = (float(one) for one in rest[:3])
                points.append([x, y, z])
            elif word == "f":
                corners = [int(one.split("/")[0]) for one in rest]
                corners = [corner - 1 if corner > 0 else len(points) + corner for corner in corners]
                if len(corners) < 3 or not all(0 <= corner < len(points) for corner in corners):
                    raise ValueError
                faces.append((number, corners))
            elif word in ("o", "g"):
                objects.append(" ".join(rest))
        except ValueError:
            raise InputError(
                f"line {number} of {name} is {line.strip()[:60]!r}, which is no line of an OBJ file."
            ) from None
    if len(points) < 4 or len(faces) < 4:
        raise InputError(
            f"{name} holds {len(points)} vertices and {len(faces)} faces; a solid has four of each at least."
        )
    found = np.array(points)
    if not np.isfinite(found).all():
        raise InputError(f"{name} has a vertex that is not finite; mend the mesh.")
    return found, faces, list(dict.fromkeys(objects))


def _check_closed(faces: list[tuple[int, list[int]]], name: str) -> None:
    """Every edge belongs to two faces, which pass it in opposite directions."""
    passed: Counter[tuple[int, int]] = Counter()
    lines: dict[tuple[int, int], int] = {}
    for line, face in faces:
        for edge in zip(face, (*face[1:], face[0]), strict=True):
            passed[edge] += 1
            lines[edge] = line
    for (a, b), times in passed.items():
        if times > 1 or passed[b, a] != 1:
            what = "has a hole" if times == 1 and not passed[b, a] else "has faces of opposite directions"
            raise InputError(
                f"{name} {what} at the edge of vertices {a + 1} and {b + 1} (face on line {lines[a, b]}); close the mesh, "
                "its faces counter-clockwise from outside."
            )


def _check_convex(points: np.ndarray, faces: list[tuple[int, list[int]]], name: str) -> None:
    """No vertex stands out of a face."""
    used = np.array(sorted({i for _, face in faces for i in face}))
    size = float(np.ptp(points[used], axis=0).max())
    middle = points[used].mean(axis=0)
    for line, face in faces:
        corners = points[face]
        normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
        length = np.linalg.norm(normal)
        if length <= 1e-12 * size * size:
            raise InputError(f"the face on line {line} of {name} has no area; mend the mesh.")
        normal = normal / length
        if normal @ (middle - corners[0]) > 0.0:
            normal = -normal
        out = (points[used] - corners.mean(axis=0)) @ normal
        if out.max() > BULGE * size:
            raise InputError(
                f"{name} is not convex at the face on line {line}: vertex {used[int(out.argmax())] + 1} stands "
                f"{float(out.max()):.3g} out of it; split the stone into convex parts, each a part of one block."
            )
