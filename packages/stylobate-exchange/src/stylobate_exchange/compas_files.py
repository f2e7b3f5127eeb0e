"""COMPAS JSON: block models of compas_dem and assemblies of compas_assembly, read and written without COMPAS.

What COMPAS 2 writes is ``{"dtype": "package/Class", "data": …}`` all the way down; blocks are meshes with their vertices
and faces by key.
"""

from __future__ import annotations

import json
import uuid
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from stylobate.column.shapes import Mesh
from stylobate.column.spatial.stone import LARGEST, MeshPart, check_closed
from stylobate.errors import InputError
from stylobate.text_tables import printable, read_bytes

#: The kinds of files, by what their ``dtype`` ends in.
MODELS = "compas_dem.models/BlockModel", "compas_model.models/Model"
ASSEMBLIES = "compas_assembly.datastructures/Assembly", "compas_cra.datastructures/CRA_Assembly"
MESHES = "compas.datastructures/Mesh", "compas_assembly.datastructures/Block"

#: Layouts that can be written.
LAYOUTS = ("dem", "assembly")


class Block(NamedTuple):
    """A block of a model: its surface where it stands [m], whether it is a support, and its density [kg/m³] if told.

    ``key`` is what the model calls it by: the guid of an element, the node of an assembly.
    """

    part: MeshPart
    fixed: bool
    density: float | None
    key: str


def read_compas(path: Path) -> tuple[str, list[Block]]:
    """Name and blocks of a model in a file.

    Raises
    ------
    InputError
        No JSON, another kind of object, or a block whose geometry is no mesh.
    """
    name = printable(path)
    try:
        document = json.loads(read_bytes(path, LARGEST).decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        why = "" if isinstance(error, UnicodeDecodeError) else f" ({str(error)[:80]})"
        raise InputError(f"{name} is no JSON{why}; give what COMPAS writes with json_dump.") from None
    return compas_blocks(document, name, path.stem)


def compas_blocks(document: Any, name: str, default: str) -> tuple[str, list[Block]]:
    """Name and blocks of a model.

    Parameters
    ----------
    document : object
        What the JSON of COMPAS holds.
    name, default : str
        What messages call the model, and its name if it has none.

    Raises
    ------
    InputError
        Another kind of object, or a block whose geometry is no mesh.
    """
    dtype = document.get("dtype") if isinstance(document, dict) else None
    meshes = document if dtype is None else [document]
    try:
        if dtype in MODELS:
            blocks = list(_of_model(document["data"], name))
        elif dtype in ASSEMBLIES:
            blocks = list(_of_assembly(document["data"], name))
        elif meshes and all(isinstance(mesh, dict) and mesh.get("dtype") in MESHES for mesh in meshes):
            blocks = [
                Block(
                    _mesh(mesh, np.eye(4), str(mesh.get("name") or f"block {number}"), name), False, None, str(number)
                )
                for number, mesh in enumerate(meshes, 1)
            ]
        else:
            raise InputError(
                f"{name} holds {_content(document)}; allowed are objects of COMPAS 2 of type "
                f"{', '.join((*MODELS, *ASSEMBLIES))}, and meshes: write its blocks as closed meshes, in OBJ for one."
            )
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        if isinstance(error, InputError):
            raise
        missing = f"; {error} is missing" if isinstance(error, KeyError) else ""
        raise InputError(
            f"{name} is not laid out as COMPAS 2 writes it{missing}: write its blocks as closed meshes, in OBJ for one."
        ) from None
    if not blocks:
        raise InputError(f"{name} holds no blocks; give a model of one at least.")
    attributes = document["data"].get("attributes") if dtype in ASSEMBLIES else None
    called = (
        (document.get("name") if dtype in MODELS + ASSEMBLIES else None) or (attributes or {}).get("name") or default
    )
    return str(called), _named(blocks)


def _content(document: Any) -> str:
    """What JSON holds, in words."""
    if isinstance(document, list):
        kinds = ", ".join(sorted({_content(entry) for entry in document})[:3])
        return f"a list of {len(document)}{f' ({kinds})' if kinds else ''}"
    if not isinstance(document, dict):
        return "no object"
    if "datatype" in document:
        return f"an object of COMPAS 1 ({str(document['datatype'])[:60]})"
    return str(document["dtype"])[:60] if "dtype" in document else "JSON of another program"


def _named(blocks: Sequence[Block]) -> list[Block]:
    """Blocks under names of their own, a number after those that several have."""
    names = [block.part.name for block in blocks]
    named_blocks = []
    for i, block in enumerate(blocks):
        name = names[i] if names.count(names[i]) == 1 else f"{names[i]} {names[: i + 1].count(names[i])}"
        named_blocks.append(block._replace(part=replace(block.part, name=name)))
    return named_blocks


def _of_assembly(data: Mapping[str, Any], name: str) -> Iterator[Block]:
    for key, node in sorted(data["graph"]["data"]["node"].items(), key=lambda entry: int(entry[0])):
        block = node.get("block")
        if block is not None:
            called = str(block.get("name") or f"block {key}")
            yield Block(_mesh(block, np.eye(4), called, name), bool(node.get("is_support")), None, key)


def _of_model(data: Mapping[str, Any], name: str) -> Iterator[Block]:
    elements, materials = data["elements"], data.get("materials") or {}
    if isinstance(elements, list):  # before compas_model 0.5
        elements = {element["guid"]: element for element in elements}
    edges = [edge for ends in data["graph"]["edge"].values() for edge in ends.values()]
    if any(element["data"].get("features") for element in elements.values()) or any(
        edge.get("modifiers") for edge in edges
    ):
        raise InputError(f"{name} has features or modifiers, which change its blocks; give their meshes as they are.")

    def below(node: Mapping[str, Any], turn: np.ndarray) -> Iterator[Block]:
        for child in node.get("children") or ():
            element = elements[child["element"]]
            fields = element["data"]
            own = turn @ _matrix(fields.get("transformation"))
            called = str(fields.get("name") or element.get("name") or "block")
            if fields.get("geometry") is not None:
                stone = materials.get(fields.get("material")) or {}
                density = stone.get("data", {}).get("density")
                part = _mesh(fields["geometry"], own, called, name)
                density = None if density is None else float(density)
                yield Block(part, bool(fields.get("is_support")), density, str(child["element"]))
            yield from below(child, own)

    yield from below(data["tree"]["root"], _matrix(data.get("transformation")))


def _matrix(transformation: Mapping[str, Any] | None) -> np.ndarray:
    if transformation is None:
        return np.eye(4)
    matrix = np.array(transformation["data"]["matrix"], dtype=float)
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
        raise ValueError("matrix")
    return matrix


def _mesh(mesh: Mapping[str, Any], turn: np.ndarray, called: str, name: str) -> MeshPart:
    data = mesh["data"]
    if "vertex" not in data or "face" not in data:
        raise InputError(f"block {called!r} of {name} is a {mesh.get('dtype')}; give blocks whose geometry is a mesh.")
    usual = data.get("default_vertex_attributes") or {}
    numbers = {str(key): i for i, key in enumerate(data["vertex"])}
    points = np.array(
        [[float(vertex.get(axis, usual.get(axis, 0.0))) for axis in "xyz"] for vertex in data["vertex"].values()]
    ).reshape(-1, 3)
    faces = tuple(tuple(numbers[str(corner)] for corner in face) for face in data["face"].values())
    if len(points) < 4 or len(faces) < 4 or not np.isfinite(points).all():
        raise InputError(f"block {called!r} of {name} is no solid: {len(points)} vertices, {len(faces)} faces.")
    part = MeshPart(called, points @ turn[:3, :3].T + turn[:3, 3], faces)
    check_closed(part, f"block {called!r} of {name}")
    return part


# -- written -------------------------------------------------------------------------------------------------------------


def compas_json(name: str, blocks: Sequence[tuple[str, Mesh, bool, float]], layout: str = "dem") -> str:
    """A model as COMPAS 2 reads it.

    Parameters
    ----------
    name : str
    blocks : sequence of (str, Mesh, bool, float)
        Name, surface where it stands [m], whether it is a support, and density [kg/m³].
    layout : str
        ``dem``, a BlockModel of compas_dem, or ``assembly``, an Assembly of compas_assembly.
    """
    make = _model if layout == "dem" else _assembly
    return json.dumps(make(name, blocks), ensure_ascii=False)


def _guid(*words: object) -> str:
    return str(uuid.uuid5(uuid.NAMESPACE_OID, "stylobate " + " ".join(map(str, words))))


def _model(name: str, blocks: Sequence[tuple[str, Mesh, bool, float]]) -> dict[str, Any]:
    stones: dict[float, str] = {}
    elements, nodes = {}, {}
    for number, (called, mesh, fixed, density) in enumerate(blocks):
        guid = _guid(name, number, called)
        stone = stones.setdefault(density, _guid(name, "stone", density)) if density else None
        fields = {
            "geometry": _plain(mesh, called, "compas.datastructures/Mesh", _guid(guid)),
            "transformation": None,
            "features": [],
            "material": stone,
            "is_support": fixed,
            "name": called,
        }
        elements[guid] = {"dtype": "compas_dem.elements/Block", "data": fields, "name": called, "guid": guid}
        nodes[str(number)] = {"element": guid}
    materials = {
        guid: {
            "dtype": "compas_dem.material/Stone",
            "data": {"name": "stone", "fck": None, "ft": None, "Ecm": None, "density": density, "poisson": 0.2},
            "name": "stone",
            "guid": guid,
        }
        for density, guid in stones.items()
    }
    children = [{"name": "ElementNode", "element": guid} for guid in elements]
    graph = {
        "attributes": {},
        "default_node_attributes": {"x": 0.0, "y": 0.0, "z": 0.0, "element": None},
        "default_edge_attributes": {"modifiers": None, "contacts": None},
        "node": nodes,
        "edge": {key: {} for key in nodes},
        "max_node": len(nodes) - 1,
    }
    data = {
        "transformation": None,
        "elements": elements,
        "materials": materials,
        "tree": {"attributes": {}, "root": {"name": "root", "children": children}},
        "graph": graph,
    }
    return {"dtype": MODELS[0], "data": data, "name": name, "guid": _guid(name), "inheritance": [MODELS[1]]}


def _assembly(name: str, blocks: Sequence[tuple[str, Mesh, bool, float]]) -> dict[str, Any]:
    usual = {"x": 0.0, "y": 0.0, "z": 0.0, "block": None, "is_support": False, "section": None, "mesh_size": None}
    nodes = {}
    for number, (called, mesh, fixed, _) in enumerate(blocks):
        plain = _plain(mesh, called, "compas_assembly.datastructures/Block", _guid(name, number, called))
        x, y, z = mesh.vertices.mean(axis=0).tolist()
        nodes[str(number)] = {"block": plain, "is_support": fixed, "x": x, "y": y, "z": z}
    graph = {
        "attributes": {},
        "default_node_attributes": usual | {"displacement": [0] * 6},
        "default_edge_attributes": {"interfaces": None},
        "node": nodes,
        "edge": {key: {} for key in nodes},
        "max_node": len(nodes) - 1,
    }
    graph_object = {
        "dtype": "compas.datastructures/Graph",
        "data": graph,
        "name": "Graph",
        "guid": _guid(name, "graph"),
    }
    return {
        "dtype": ASSEMBLIES[0],
        "data": {"attributes": {"name": name}, "graph": graph_object},
        "name": name,
        "guid": _guid(name),
    }


def _plain(mesh: Mesh, name: str, dtype: str, guid: str) -> dict[str, Any]:
    data = {
        "attributes": {},
        "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
        "default_edge_attributes": {},
        "default_face_attributes": {},
        "vertex": {str(i): dict(zip("xyz", point)) for i, point in enumerate(mesh.vertices.tolist())},
        "face": {str(i): list(map(int, face)) for i, face in enumerate(mesh.faces)},
        "facedata": {},
        "edgedata": {},
        "max_vertex": len(mesh.vertices) - 1,
        "max_face": len(mesh.faces) - 1,
    }
    return {"dtype": dtype, "data": data, "name": name, "guid": guid}
