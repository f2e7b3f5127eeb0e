"""Meshes of bodies for other tools: OBJ, PLY and STL as text, which keeps every digit, and glTF in its binary form."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from stylobate.column.shapes import Mesh
from stylobate.version import __version__

#: Colours of what can move, of what moves with the ground, and of the ground: red, green, blue, from 0 to 1.
STONE, FIXED, GROUND = (0.86, 0.80, 0.68), (0.62, 0.62, 0.62), (0.45, 0.43, 0.40)

#: The turn that brings z upward to y upward, as glTF has it: x, y, z, w.
Z_TO_Y = (-(0.5**0.5), 0.0, 0.0, 0.5**0.5)


class Named(NamedTuple):
    """A surface under a name, with its colour."""

    name: str
    mesh: Mesh
    colour: tuple[float, float, float] = STONE


def triangles_of(mesh: Mesh) -> np.ndarray:
    """Corners of the triangles of a mesh of convex faces [m], shape (k, 3, 3)."""
    numbers = [(face[0], face[i], face[i + 1]) for face in mesh.faces for i in range(1, len(face) - 1)]
    return mesh.vertices[np.array(numbers)]


def normals_of(triangles: np.ndarray) -> np.ndarray:
    """Unit normals [-], shape (k, 3); upward of a triangle without area."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(length > 0.0, normals / np.where(length > 0.0, length, 1.0), (0.0, 0.0, 1.0))


def obj_text(surfaces: Sequence[Named]) -> str:
    """Wavefront OBJ, an object for each surface."""
    lines, first = [f"# stylobate {__version__}, lengths in m, z upward"], 1
    for name, mesh, _ in surfaces:
        lines.append(f"o {_one_line(name)}")
        lines += [f"v {x:.12g} {y:.12g} {z:.12g}" for x, y, z in mesh.vertices.tolist()]
        lines += ["f " + " ".join(str(first + i) for i in face) for face in mesh.faces]
        first += len(mesh.vertices)
    return "\n".join(lines) + "\n"


def ply_text(surfaces: Sequence[Named]) -> str:
    """PLY as text: surfaces one after another, told apart by what hangs together; the format has no names."""
    points = np.concatenate([mesh.vertices for _, mesh, _ in surfaces])
    faces, first = [], 0
    for _, mesh, _ in surfaces:
        faces += [[first + i for i in face] for face in mesh.faces]
        first += len(mesh.vertices)
    head = [
        "ply", "format ascii 1.0", f"comment stylobate {__version__}, lengths in m, z upward",
        f"element vertex {len(points)}", *(f"property double {axis}" for axis in "xyz"),
        f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header",
    ]  # fmt: skip
    lines = [f"{x:.12g} {y:.12g} {z:.12g}" for x, y, z in points.tolist()]
    return "\n".join([*head, *lines, *(f"{len(face)} {' '.join(map(str, face))}" for face in faces)]) + "\n"


def stl_text(surfaces: Sequence[Named]) -> str:
    """STL as text, a solid for each surface."""
    lines = []
    for name, mesh, _ in surfaces:
        triangles = triangles_of(mesh)
        lines.append(f"solid {_one_line(name)}")
        for normal, corners in zip(normals_of(triangles).tolist(), triangles.tolist()):
            lines += ["facet normal {:.6g} {:.6g} {:.6g}".format(*normal), "outer loop"]
            lines += ["vertex {:.12g} {:.12g} {:.12g}".format(*corner) for corner in corners]
            lines += ["endloop", "endfacet"]
        lines.append(f"endsolid {_one_line(name)}")
    return "\n".join(lines) + "\n"


#: Writers by ending.
TEXTS: dict[str, Callable[[Sequence[Named]], str]] = {".obj": obj_text, ".ply": ply_text, ".stl": stl_text}


def _one_line(name: str) -> str:
    return " ".join(name.split())


class Glb:
    """A binary glTF 2.0 file: nodes with surfaces under one root that stands upright, and how they move.

    Parameters
    ----------
    name : str
        Of the root.
    """

    def __init__(self, name: str) -> None:
        self.bytes = bytearray()
        self.tree: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": f"stylobate {__version__}"},
            "scene": 0,
            "scenes": [{"name": name, "nodes": [0]}],
            "nodes": [{"name": name, "rotation": list(Z_TO_Y), "children": []}],
            "meshes": [],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
        }
        self._materials: dict[tuple[float, float, float], int] = {}

    def add(self, surface: Named, place: Sequence[float] = (0.0, 0.0, 0.0), turn: Sequence[float] | None = None) -> int:
        """A node with a surface at a place [m], turned by a quaternion x, y, z, w; its number."""
        triangles = triangles_of(surface.mesh)
        normals = np.repeat(normals_of(triangles)[:, None], 3, axis=1)
        corners, order = np.unique(
            np.concatenate((triangles, normals), axis=2).reshape(-1, 6).astype("<f4"), axis=0, return_inverse=True
        )
        attributes = {"POSITION": self._accessor(corners[:, :3], 34962, bounded=True)}
        attributes["NORMAL"] = self._accessor(corners[:, 3:], 34962)
        faces = self._accessor(order.ravel().astype("<u4"), 34963)
        material = self._material(surface.colour)
        primitive = {"attributes": attributes, "indices": faces, "material": material}
        self.tree["meshes"].append({"name": surface.name, "primitives": [primitive]})
        node = {
            "name": surface.name,
            "mesh": len(self.tree["meshes"]) - 1,
            "translation": [float(coordinate) for coordinate in place],
        }
        if turn is not None:
            node["rotation"] = [float(component) for component in turn]
        self.tree["nodes"].append(node)
        self.tree["nodes"][0]["children"].append(len(self.tree["nodes"]) - 1)
        return len(self.tree["nodes"]) - 1

    def move(self, node: int, time: int, places: np.ndarray, turns: np.ndarray) -> None:
        """Let a node move: places [m], shape (T, 3), and quaternions x, y, z, w, shape (T, 4), at :meth:`times`."""
        (animation,) = self.tree.setdefault("animations", [{"name": "response", "samplers": [], "channels": []}])
        for path, values in (("translation", places), ("rotation", turns)):
            sampler = {"input": time, "output": self._accessor(values.astype("<f4")), "interpolation": "LINEAR"}
            animation["samplers"].append(sampler)
            target = {"node": node, "path": path}
            animation["channels"].append({"sampler": len(animation["samplers"]) - 1, "target": target})

    def times(self, time: np.ndarray) -> int:
        """Times at which nodes move [s], shape (T,)."""
        return self._accessor(time.astype("<f4"), bounded=True)

    def content(self) -> bytes:
        """The file."""
        root, *others = self.tree["nodes"]
        if any(node["name"] == root["name"] for node in others):
            root["name"] += ", all"  # readers that find nodes by their names would find this one
        tree = {**self.tree, "buffers": [{"byteLength": len(self.bytes)}]}
        text = json.dumps(tree, ensure_ascii=False, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(self.bytes), b"BIN\0") + self.bytes
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def _material(self, colour: tuple[float, float, float]) -> int:
        if colour not in self._materials:
            self._materials[colour] = len(self._materials)
            look = {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9}
            self.tree["materials"].append({"pbrMetallicRoughness": look, "doubleSided": True})
        return self._materials[colour]

    def _accessor(self, values: np.ndarray, target: int | None = None, *, bounded: bool = False) -> int:
        values = np.ascontiguousarray(values)
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": values.nbytes}
        self.tree["bufferViews"].append(view if target is None else view | {"target": target})
        self.bytes += values.tobytes()  # of numbers of four bytes each, so that the next ones are aligned
        kind = {1: "SCALAR", 2: f"VEC{values.shape[-1]}"}[values.ndim]
        accessor: dict[str, Any] = {
            "bufferView": len(self.tree["bufferViews"]) - 1,
            "componentType": 5126 if values.dtype.kind == "f" else 5125,
            "count": len(values),
            "type": kind,
        }
        if bounded:
            flat = values.reshape(len(values), -1)
            accessor |= {"min": flat.min(axis=0).astype(float).tolist(), "max": flat.max(axis=0).astype(float).tolist()}
        self.tree["accessors"].append(accessor)
        return len(self.tree["accessors"]) - 1
