"""VTK's XML files of unstructured grids, and collections of them over time (``.pvd``), as ParaView opens them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np

from .recording import Recording

if TYPE_CHECKING:
    from meshio import Mesh


def bodies_grid(recording: Recording, index: int) -> Mesh:
    """Bodies at a recorded state, each convex part a polyhedron where it stands.

    Of cells: ``body`` (its number, from 0), ``fixed``, ``displacement`` [m] and ``velocity`` [m/s] of its centroid,
    ``tilt`` [rad]. Of points: ``displacement`` [m].
    """
    import meshio

    response = recording.response
    points, moved, first = [], [], 0
    cells: list[Any] = []
    for body, mesh in recording.pieces:
        now, start = (mesh.vertices @ recording.axes[i, body].T + recording.position[i, body] for i in (index, 0))
        points.append(now)
        moved.append(now - start)
        cells.append((f"polyhedron{len(now)}", [[np.array(face) + first for face in mesh.faces]]))
        first += len(now)
    of_cell = [body for body, _ in recording.pieces]
    data = {
        "body": np.array(of_cell),
        "fixed": np.array([response.bodies.fixed[body] for body in of_cell], dtype=np.uint8),
        "displacement": (recording.position[index] - recording.position[0])[of_cell],
        "velocity": recording.velocity[index][of_cell],
        "tilt": response.tilt[index][of_cell],
    }
    of_cells: dict[str, Any] = {name: np.split(values, len(cells)) for name, values in data.items()}
    return meshio.Mesh(np.concatenate(points), cells, {"displacement": np.concatenate(moved)}, of_cells)


def joints_grid(recording: Recording, index: int) -> Mesh:
    """Joints at a recorded state, each a point: ``joint`` (from 1), ``opening`` [m], ``slip`` [m] and ``twist`` [rad]."""
    import meshio

    h, places = recording.response.histories, recording.joint_places(index)
    data = {
        "joint": np.arange(1, len(places) + 1),
        "opening": h.opening[index],
        "slip": np.column_stack((h.slip[index], np.zeros(len(places)))),
        "twist": h.twist[index],
    }
    cells: list[Any] = [("vertex", np.arange(len(places))[:, None])]
    return meshio.Mesh(places, cells, cell_data={name: [values] for name, values in data.items()})


def links_grid(recording: Recording, index: int) -> Mesh:
    """Links at a recorded state as lines: ``link`` (from 1), ``shear``, ``tension`` [N], ``slip``, ``elongation`` [m]."""
    import meshio

    h = recording.response.histories.links
    assert h is not None
    ends = recording.link_ends(index)
    numbers = [number for number, _ in ends]
    data = {"link": np.array(numbers) + 1}
    data |= {name: getattr(h, name)[index, numbers] for name in ("shear", "tension", "slip", "elongation")}
    points = np.concatenate([both for _, both in ends])
    cells: list[Any] = [("line", np.arange(len(points)).reshape(-1, 2))]
    return meshio.Mesh(points, cells, cell_data={name: [values] for name, values in data.items()})


def grids(recording: Recording, index: int) -> dict[str, Mesh]:
    """Everything that there is at a recorded state: ``bodies``, and ``joints`` and ``links`` where there are some."""
    meshes = {"bodies": bodies_grid(recording, index)}
    if recording.joints:
        meshes["joints"] = joints_grid(recording, index)
    if recording.link_ends(index):
        meshes["links"] = links_grid(recording, index)
    return meshes


def collection(files: Sequence[tuple[float, int, str]]) -> str:
    """A ``.pvd`` of files by their times [s] and parts."""
    lines = [
        f'<DataSet timestep="{time:.9g}" group="" part="{part}" file={quoteattr(name)}/>' for time, part, name in files
    ]
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0" byte_order="LittleEndian">\n'
    return head + "<Collection>\n" + "\n".join(lines) + "\n</Collection>\n</VTKFile>\n"
