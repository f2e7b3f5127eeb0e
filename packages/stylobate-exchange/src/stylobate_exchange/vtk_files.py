"""VTK's XML files of unstructured grids, and collections of them over time (``.pvd``), as ParaView opens them."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from stylobate.version import __version__

from .recording import Recording

#: Numbers of VTK's cells: a point, a line, a polyhedron.
VERTEX, LINE, POLYHEDRON = 1, 3, 42

_TYPES = {"f": ("Float64", "<f8"), "i": ("Int64", "<i8"), "u": ("UInt8", "|u1")}

_HEAD = '<?xml version="1.0"?>\n<VTKFile type="{}" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'


def bodies_grid(recording: Recording, index: int) -> str:
    """Bodies at a recorded state, each convex part a polyhedron where it stands.

    Of cells: ``body`` (its number, from 0), ``fixed``, ``displacement`` [m] and ``velocity`` [m/s] of its centroid,
    ``tilt`` [rad]. Of points: ``displacement`` [m].
    """
    pieces, response = recording.pieces, recording.response
    points, moved, cells, faces, ends = [], [], [], [], []
    first = 0
    for body, mesh in pieces:
        now, start = (mesh.vertices @ recording.axes[i, body].T + recording.position[i, body] for i in (index, 0))
        points.append(now)
        moved.append(now - start)
        cells.append(np.arange(first, first + len(now)))
        faces.append([len(mesh.faces), *(n for face in mesh.faces for n in (len(face), *(first + i for i in face)))])
        ends.append(len(faces[-1]))
        first += len(now)
    of_cell = [body for body, _ in pieces]
    data = {
        "body": np.array(of_cell),
        "fixed": np.array([response.bodies.fixed[body] for body in of_cell], dtype=np.uint8),
        "displacement": (recording.position[index] - recording.position[0])[of_cell],
        "velocity": recording.velocity[index][of_cell],
        "tilt": response.tilt[index][of_cell],
    }
    polyhedra = {"faces": np.concatenate([np.array(one) for one in faces]), "faceoffsets": np.cumsum(ends)}
    return _grid(np.concatenate(points), cells, POLYHEDRON, data, {"displacement": np.concatenate(moved)}, polyhedra)


def joints_grid(recording: Recording, index: int) -> str:
    """Joints at a recorded state, each a point: ``joint`` (from 1), ``opening`` [m], ``slip`` [m] and ``twist`` [rad]."""
    h = recording.response.histories
    places = recording.joint_places(index)
    slip = np.column_stack((h.slip[index], np.zeros(len(places))))
    data = {
        "joint": np.arange(1, len(places) + 1),
        "opening": h.opening[index],
        "slip": slip,
        "twist": h.twist[index],
    }
    return _grid(places, [np.array([i]) for i in range(len(places))], VERTEX, data, {}, {})


def links_grid(recording: Recording, index: int) -> str:
    """Links at a recorded state as lines: ``link`` (from 1), ``shear``, ``tension`` [N], ``slip``, ``elongation`` [m]."""
    h = recording.response.histories.links
    assert h is not None
    ends = recording.link_ends(index)
    numbers = [number for number, _ in ends]
    data = {"link": np.array(numbers) + 1}
    data |= {name: getattr(h, name)[index, numbers] for name in ("shear", "tension", "slip", "elongation")}
    points = np.concatenate([both for _, both in ends])
    return _grid(points, [np.array([2 * i, 2 * i + 1]) for i in range(len(ends))], LINE, data, {}, {})


def grids(recording: Recording, index: int) -> dict[str, str]:
    """Everything that there is at a recorded state: ``bodies``, and ``joints`` and ``links`` where there are some."""
    found = {"bodies": bodies_grid(recording, index)}
    if recording.joints:
        found["joints"] = joints_grid(recording, index)
    if recording.link_ends(index):
        found["links"] = links_grid(recording, index)
    return found


def collection(files: Sequence[tuple[float, int, str]]) -> str:
    """A ``.pvd`` of files by their times [s] and parts."""
    lines = [
        f'<DataSet timestep="{time:.9g}" group="" part="{part}" file={quoteattr(name)}/>' for time, part, name in files
    ]
    return _HEAD.format("Collection") + "<Collection>\n" + "\n".join(lines) + "\n</Collection>\n</VTKFile>\n"


def _grid(
    points: np.ndarray,
    cells: Sequence[np.ndarray],
    kind: int,
    of_cells: Mapping[str, Any],
    of_points: Mapping[str, Any],
    polyhedra: Mapping[str, np.ndarray],
) -> str:
    types = np.full(len(cells), kind, dtype=np.uint8)
    shape = {
        "connectivity": np.concatenate(cells),
        "offsets": np.cumsum([len(cell) for cell in cells]),
        "types": types,
        **polyhedra,
    }
    parts = [
        ("PointData", "".join(_array(name, values) for name, values in of_points.items())),
        ("CellData", "".join(_array(name, values) for name, values in of_cells.items())),
        ("Points", _array("Points", points)),
        ("Cells", "".join(_array(name, values) for name, values in shape.items())),
    ]
    inner = "".join(f"<{name}>\n{text}</{name}>\n" for name, text in parts)
    piece = f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">\n{inner}</Piece>\n'
    said = f"<!-- stylobate {__version__}, SI units -->\n"
    return _HEAD.format("UnstructuredGrid") + said + f"<UnstructuredGrid>\n{piece}</UnstructuredGrid>\n</VTKFile>\n"


def _array(name: str, values: Any) -> str:
    """An array in base 64 behind its length in bytes."""
    values = np.asarray(values)
    kind, layout = _TYPES[values.dtype.kind]
    data = np.ascontiguousarray(values, dtype=layout).tobytes()
    text = base64.b64encode(np.array(len(data), dtype="<u8").tobytes()).decode() + base64.b64encode(data).decode()
    parts = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    return f'<DataArray type="{kind}" Name={quoteattr(name)}{parts} format="binary">{text}</DataArray>\n'
