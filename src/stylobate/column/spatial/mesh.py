"""Meshes of stones: OBJ by its lines, PLY, STL and glTF by trimesh; closed, of plausible size, one convex part."""

from __future__ import annotations

import io
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...reading import read_bytes, shown
from ..plausible import bulk_doubts

#: Endings of files that hold meshes, and those that trimesh reads.
OBJ, OTHERS = ".obj", (".ply", ".stl", ".glb", ".gltf")
MESHES = (OBJ, *OTHERS)

#: Axes that can be upward; that of glTF is y.
UPWARD, GLTF = ("y", "z"), (".glb", ".gltf")

#: Largest file [bytes].
LARGEST = 20_000_000


@dataclass(frozen=True, eq=False)
class MeshPart:
    """One surface of a file: its faces hang together.

    Parameters
    ----------
    name : str
    points : array
        Vertices, of which faces may use some [the file's unit], shape (m, 3).
    faces : tuple of tuple of int
        Numbers of their vertices.
    lines : tuple of int
        Line of the file that each face is on; empty where a format has none.
    rounding : float
        Half a unit of the last place of numbers in single precision [the file's unit]; 0 of other numbers.
    """

    name: str
    points: np.ndarray
    faces: tuple[tuple[int, ...], ...]
    lines: tuple[int, ...] = ()
    rounding: float = 0.0

    def in_metres(self, factor: float, up: str) -> MeshPart:
        """The surface in m with z upward, from a unit [m] and the axis that is upward, ``y`` or ``z``."""
        x, y, z = factor * self.points.T
        points = np.stack((x, -z, y) if up == "y" else (x, y, z), axis=1)
        return replace(self, points=points, rounding=factor * self.rounding)

    @property
    def used(self) -> np.ndarray:
        """Numbers of the vertices that its faces use, shape (k,)."""
        return np.unique(np.concatenate([np.array(face) for face in self.faces]))

    def face(self, number: int) -> str:
        """Name of a face in sentences."""
        return f"face on line {self.lines[number]}" if self.lines else f"face {number + 1}"


def parsed_parts(path: Path) -> list[MeshPart]:
    """Objects of a file that have faces.

    Raises
    ------
    InputError
        The ending is unknown, the file is none of its format, or trimesh, which reads it, is not installed.
    """
    name, suffix = shown(path), path.suffix.lower()
    if suffix not in MESHES:
        raise InputError(f"{name} ends in {suffix!r}; meshes are files that end in {', '.join(MESHES)}.")
    data = read_bytes(path, LARGEST, "thin the mesh out")
    found = _obj(data, name, path.stem) if suffix == OBJ else _by_trimesh(data, suffix, path, name)
    if not all(np.isfinite(part.points[part.used]).all() for part in found):
        raise InputError(f"{name} has a vertex that is not finite; mend the mesh.")
    return found


def pieces_of(part: MeshPart) -> list[MeshPart]:
    """The same surface in pieces that hang together, under its name with a number where there are several.

    Faces hang together by the numbers of their vertices if that closes them, else by where their vertices are.
    """
    pieces = _pieces(part)
    if all(not _odd_edges(piece) for piece in pieces):
        return pieces
    return _pieces(_merged(part))


def edges_of(part: MeshPart) -> Counter[tuple[int, int]]:
    """How many faces pass from one vertex to another, by their numbers."""
    return Counter(edge for face in part.faces for edge in zip(face, (*face[1:], face[0]), strict=True))


def _odd_edges(part: MeshPart) -> bool:
    passed = edges_of(part)
    return any(times > 1 or passed[b, a] != 1 for (a, b), times in passed.items())


def _pieces(part: MeshPart) -> list[MeshPart]:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    one, other = np.array([(face[0], corner) for face in part.faces for corner in face[1:]]).T
    size = len(part.points)
    _, group = connected_components(coo_array((np.ones(len(one)), (one, other)), shape=(size, size)), directed=False)
    of_face = group[[face[0] for face in part.faces]]
    kinds = dict.fromkeys(of_face.tolist())
    if len(kinds) == 1:
        return [part]
    found = []
    for number, kind in enumerate(kinds, 1):
        own = np.flatnonzero(of_face == kind).tolist()
        lines = tuple(part.lines[i] for i in own) if part.lines else ()
        faces = tuple(part.faces[i] for i in own)
        found.append(replace(part, name=f"{part.name} {number}", faces=faces, lines=lines))
    return found


def _merged(part: MeshPart) -> MeshPart:
    """Vertices at the same place are the first of them; faces that lose their area by it are left out."""
    _, first, group = np.unique(part.points + 0.0, axis=0, return_index=True, return_inverse=True)
    same = first[group.ravel()].tolist()
    faces = [tuple(dict.fromkeys(same[i] for i in face)) for face in part.faces]
    kept = [i for i, face in enumerate(faces) if len(face) >= 3]
    lines = tuple(part.lines[i] for i in kept) if part.lines else ()
    return replace(part, faces=tuple(faces[i] for i in kept), lines=lines)


def _obj(data: bytes, name: str, stem: str) -> list[MeshPart]:
    """Objects of a Wavefront OBJ file."""
    points: list[list[float]] = []
    objects: dict[str, list[tuple[int, tuple[int, ...]]]] = {}
    current, text = stem, data.decode("utf-8", "replace").splitlines()
    names = ("o",) if any(line.split()[:1] == ["o"] for line in text) else ("g",)  # groups may be parts of a surface
    for number, line in enumerate(text, 1):
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
                objects.setdefault(current, []).append((number, tuple(corners)))
            elif word in names:
                current = " ".join(rest) or current
        except ValueError:
            raise InputError(
                f"line {number} of {name} is {line.strip()[:60]!r}, which is no line of an OBJ file."
            ) from None
    faces = sum(map(len, objects.values()))
    if len(points) < 4 or faces < 4:
        raise InputError(f"{name} holds {len(points)} vertices and {faces} faces; a solid has four of each at least.")
    found = np.array(points)
    return [
        MeshPart(one, found, tuple(face for _, face in some), tuple(line for line, _ in some))
        for one, some in objects.items()
    ]


def _by_trimesh(data: bytes, suffix: str, path: Path, name: str) -> list[MeshPart]:
    """Meshes of a scene where they stand."""
    try:
        import trimesh
        from trimesh.resolvers import FilePathResolver
    except ImportError:
        raise InputError(f"{name} is read by trimesh; install stylobate[exchange], or give an OBJ file.") from None
    resolver = FilePathResolver(str(path)) if suffix == ".gltf" else None
    try:
        scene: Any = trimesh.load_scene(
            io.BytesIO(data), file_type=suffix[1:], resolver=resolver, process=False, maintain_order=True
        )
        order = {str(key): i for i, key in enumerate(scene.geometry)}
        placed = [(order[str(scene.graph[node][1])], str(node), node) for node in scene.graph.nodes_geometry]
        scenes = [(name, *scene.graph[node]) for _, name, node in sorted(placed)]
        meshes = [(name, turn, scene.geometry[key]) for name, turn, key in scenes]
        surfaces = [(node, turn, mesh.vertices, mesh.faces) for node, turn, mesh in meshes if hasattr(mesh, "faces")]
    except Exception as error:  # whatever a damaged file makes of the reader
        why = " ".join(str(error).split())[:120] or type(error).__name__
        raise InputError(f"{name} is no {suffix[1:].upper()} file that can be read ({why}); write it again.") from None
    found = []
    for node, turn, vertices, faces in surfaces:
        points = np.asarray(vertices, dtype=float) @ turn[:3, :3].T + turn[:3, 3]
        if len(faces):
            order = 1 if np.linalg.det(turn[:3, :3]) > 0.0 else -1  # mirrored, faces run the other way
            called = path.stem if suffix in (".ply", ".stl") and node.startswith("geometry_") else node
            single = points.astype("f4")
            rounding = 0.5 * float(np.spacing(np.abs(single).max())) if np.array_equal(single, points) else 0.0
            every = tuple(tuple(face[::order].tolist()) for face in np.asarray(faces))
            found.append(MeshPart(called, points, every, rounding=rounding))
    vertices, faces = (sum(len(getattr(one, key)) for one in found) for key in ("points", "faces"))
    if vertices < 4 or faces < 4:
        raise InputError(f"{name} holds {vertices} vertices and {faces} faces; a solid has four of each at least.")
    return found


# -- Meshes of stones -------------------------------------------------------------------------------------------------


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
