"""Responses written for other tools: glTF that moves, VTK over time, OBJ of one instant, and histories as a table."""

from __future__ import annotations

import csv
import io
import shutil
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stylobate.atomic import refuse_existing, replacing
from stylobate.column.found_geometry import base_axes
from stylobate.column.shapes import Mesh
from stylobate.errors import InputError
from stylobate.response import Response
from stylobate.response.links import NAMES as LINKS

from .mesh_writers import FIXED, GROUND, STONE, Glb, Named, obj_text
from .recording import Recording
from .vtk_files import collection, grids

if TYPE_CHECKING:
    from meshio import Mesh as Grid

#: Endings of files that a response is written to, and those of one instant only.
ENDINGS, ONE_INSTANT = (".glb", ".pvd", ".vtu", ".obj", ".csv"), (".vtu", ".obj")

#: Instants a second unless told otherwise [1/s].
RATE = 30.0

#: Radius of the ground that is shown, over that of what stands on it.
PLATE = 2.6


def export_response(
    response: Response, path: Path, *, at: float | None = None, rate: float | None = None
) -> list[Path]:
    """Write a response to a file, of the kind that its ending tells.

    Parameters
    ----------
    response : Response
    path : Path
        ``.glb``, ``.pvd``, ``.vtu``, ``.obj`` or ``.csv``; nothing may be there.
    at : float, optional
        The instant [s]; needed by ``.vtu`` and ``.obj``, of use for ``.glb`` as well.
    rate : float, optional
        Instants a second of what goes over time; of a table all that are recorded if left out, else 30 [1/s].

    Returns
    -------
    list of Path
        The files, the one that is named first.

    Raises
    ------
    InputError
        The ending is unknown, an instant is missing or outside of the run, or something is there already.
    """
    suffix = path.suffix.lower()
    if suffix not in ENDINGS:
        raise InputError(f"a response cannot be written to {str(path)!r}; endings are {', '.join(ENDINGS)}.", "to")
    if at is None and suffix in ONE_INSTANT:
        raise InputError(f"{suffix} holds one instant; say which with `at=3.2s`.", "at")
    if at is not None and suffix in (".pvd", ".csv"):
        raise InputError(f"{suffix} holds all instants; leave `at` out, or write .vtu, .obj or .glb.", "at")
    if at is not None and rate is not None:
        raise InputError("`at` and `fps` are both given; give one of the two.", "fps")
    if at is not None:
        recording = Recording.instant(response, at)
    elif rate is None and suffix == ".csv":
        recording = Recording(response, np.arange(len(response.time)))
    else:
        recording = Recording.frames(response, RATE if rate is None else rate)
    refuse_existing(path)
    if suffix == ".pvd":
        return _series(recording, path)
    if suffix == ".vtu":
        made = grids(recording, int(recording.instants[0]))
        paths = [path, *(path.with_name(f"{path.stem}-{kind}.vtu") for kind in list(made)[1:])]
        for target in paths[1:]:
            refuse_existing(target)
        for target, grid in zip(paths, made.values(), strict=True):
            _write_grid(target, grid)
        return paths
    content = {".glb": _glb, ".obj": _obj, ".csv": _table}[suffix](recording)
    return [_write(path, content)]


def _write(path: Path, content: bytes) -> Path:
    with replacing(path) as partial:
        partial.write_bytes(content)
    return path


def _write_grid(path: Path, grid: Grid) -> Path:
    with replacing(path) as partial:
        grid.write(partial, "vtu")
    return path


# -- glTF ----------------------------------------------------------------------------------------------------------------


def _glb(recording: Recording) -> bytes:
    """Bodies by name, the ground under them, and how they move, from the first instant on."""
    response = recording.response
    bodies, instants = response.bodies, recording.instants
    file = Glb(response.structure.name)
    time = file.times(recording.time - recording.time[0]) if len(instants) > 1 else None
    for body in bodies.shown:
        mesh = _joined([piece.mesh for piece in recording.pieces if piece.body == body])
        named = Named(bodies.names[body], mesh, FIXED if bodies.fixed[body] else STONE)
        places, turns = recording.position[instants, body], recording.turn[:, body]
        node = file.add(named, places[0], turns[0])
        if time is not None and not bodies.fixed[body]:
            file.move(node, time, places, turns)
    plate = _plate(recording)
    if plate is not None:
        file.add(Named("ground", plate, GROUND))
    return file.content()


def _joined(meshes: list[Mesh]) -> Mesh:
    """Surfaces as one, one after another."""
    faces, first = [], 0
    for mesh in meshes:
        faces += [tuple(first + i for i in face) for face in mesh.faces]
        first += len(mesh.vertices)
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), tuple(faces))


def _plate(recording: Recording) -> Mesh | None:
    """A thin round piece of the ground under what stands at first; none where there is no ground."""
    structure = recording.response.structure
    if structure.ground is None:
        return None
    position, axes = recording.position[0], recording.axes[0]
    feet = np.concatenate([mesh.vertices @ axes[body].T + position[body] for body, mesh in recording.pieces])
    middle = 0.5 * (feet.min(axis=0) + feet.max(axis=0))[:2]
    radius = PLATE * 0.5 * float(np.hypot(*np.ptp(feet[:, :2], axis=0)))
    angle = np.arange(64) * (2.0 * np.pi / 64)
    ring = middle + radius * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    low, high = (np.column_stack((ring, np.full(64, z))) for z in (structure.ground - 0.01 * radius, structure.ground))
    sides = [(i, (i + 1) % 64, 64 + (i + 1) % 64, 64 + i) for i in range(64)]
    faces = (tuple(range(63, -1, -1)), tuple(range(64, 128)), *sides)
    return Mesh(np.concatenate((low, high)) @ base_axes(structure).T, faces)


# -- VTK -----------------------------------------------------------------------------------------------------------------


def _series(recording: Recording, path: Path) -> list[Path]:
    """A collection, and beside it a folder of its name with the grids and the names of bodies."""
    folder = path.with_suffix("")
    refuse_existing(folder)
    try:
        folder.mkdir()
    except OSError as error:
        raise InputError(f"{folder} cannot be made: {error.strerror}; choose another folder.", "to") from None
    try:
        files, made = [], []
        for number, (index, time) in enumerate(zip(recording.instants.tolist(), recording.time.tolist())):
            for part, (kind, grid) in enumerate(grids(recording, index).items()):
                made.append(_write_grid(folder / f"{kind}-{number:04d}.vtu", grid))
                files.append((time, part, f"{folder.name}/{made[-1].name}"))
        names = "".join(f"{i},{_quoted(name)}\r\n" for i, name in enumerate(recording.response.bodies.names))
        made.append(_write(folder / "bodies.csv", f"body,name\r\n{names}".encode()))
        _write(path, collection(files).encode())
    except BaseException:
        with suppress(OSError):
            shutil.rmtree(folder)
        raise
    return [path, *made]


# -- OBJ and CSV -----------------------------------------------------------------------------------------------------------


def _obj(recording: Recording) -> bytes:
    """Bodies by name as they stand at the instant; parts of one body are objects of their own."""
    index, names = int(recording.instants[0]), recording.response.bodies.names
    objects = []
    bodies = [piece.body for piece in recording.pieces]
    for number, (body, mesh) in enumerate(recording.pieces):
        parts = bodies.count(body)
        name = names[body] if parts == 1 else f"{names[body]}, part {bodies[: number + 1].count(body)}"
        points = mesh.vertices @ recording.axes[index, body].T + recording.position[index, body]
        objects.append(Named(name, Mesh(points, mesh.faces)))
    return obj_text(objects).encode()


def _table(recording: Recording) -> bytes:
    """Time histories, a row an instant, units in the names of the columns."""
    response, instants = recording.response, recording.instants
    h, bodies = response.histories, response.bodies
    columns: dict[str, np.ndarray] = {"time_s": recording.time}
    for k, axis in enumerate("xyz"):
        columns[f"ground_acceleration_{axis}_m_s2"] = h.acceleration[instants, k]
        columns[f"ground_displacement_{axis}_m"] = h.displacement[instants, k]
    moved, tilt = recording.position - recording.position[0], response.tilt
    for body, name in enumerate(bodies.names):
        if not bodies.fixed[body]:
            for k, axis in enumerate("xyz"):
                columns[f"{name}: displacement_{axis}_m"] = moved[instants, body, k]
            for k, axis in enumerate("xyz"):
                columns[f"{name}: velocity_{axis}_m_s"] = recording.velocity[instants, body, k]
            columns[f"{name}: tilt_rad"] = tilt[instants, body]
    for joint in range(h.opening.shape[1]):
        columns[f"joint {joint + 1}: opening_m"] = h.opening[instants, joint]
        for k, axis in enumerate("xy"):
            columns[f"joint {joint + 1}: slip_{axis}_m"] = h.slip[instants, joint, k]
        columns[f"joint {joint + 1}: twist_rad"] = h.twist[instants, joint]
    units = dict(zip(LINKS, ("n", "n", "m", "m"), strict=True))
    for number, link in enumerate(response.measures.links if h.links is not None else ()):
        for key in LINKS:
            columns[f"{link.name}: {key}_{units[key]}"] = getattr(h.links, key)[instants, number]
    columns |= {f"energy_{term}_j": values[instants] for term, values in h.energy.items()}
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(columns)
    writer.writerows([f"{value:.9g}" for value in row] for row in np.column_stack(list(columns.values())))
    return text.getvalue().encode()


def _quoted(name: str) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="").writerow([name])
    return text.getvalue()
