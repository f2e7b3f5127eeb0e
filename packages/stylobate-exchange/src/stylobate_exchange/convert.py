"""Models converted: meshes, COMPAS JSON and surveys to column and assembly files, and these to all of them."""

from __future__ import annotations

import math
import warnings
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from stylobate.atomic import refuse_existing, replacing
from stylobate.column import Column
from stylobate.column.assembly_files import load_structure
from stylobate.column.block import FAR_AWAY, length_of
from stylobate.column.drum import Drum
from stylobate.column.files import tables_of
from stylobate.column.found_geometry import space_geometry
from stylobate.column.materials import material
from stylobate.column.shapes import Mesh, about
from stylobate.column.spatial.files import spatial_assembly
from stylobate.column.spatial.stone import MESHES, UPWARD, MeshPart, check_closed, read_stones, unit_of, upward
from stylobate.column.spatial.tables import SpatialTable
from stylobate.column.structure import Structure
from stylobate.column.tables import made_of
from stylobate.column.toml import checked, toml_text
from stylobate.constants import DEGREE
from stylobate.errors import InputError, check_range, within
from stylobate.text_tables import printable

from .compas_files import LAYOUTS, Block, compas_json, read_compas
from .fitting import ROUGH, SMOOTH, Closed, Frustum, Hull, brought_together, hull_of, in_use, within_tolerance
from .mesh_writers import FIXED, STONE, TEXTS, Glb, Named
from .recording import AROUND
from .survey import WORKBOOKS, survey_tables, survey_text
from .three_dec import SAME, read_three_dec

# What a model of another tool becomes here: an assembly in space of its stones, or a column of its drums, as tables.

#: A drum that leans less than this out of the one under it stands straight on it [degrees].
STRAIGHT = 0.05


#: What is nearer than this is where it was told [m]; decimals of corners in files; share of a volume that is told.
ROUNDING, DIGITS, REPORTED_SHARE = 1e-6, 10, 1e-4

#: Share of a drum's radius from which on what a mesh lacks of it is priced.
PRICED = 0.01


def near(distance: float) -> str:
    """A distance between what was told and what stands for it, in words [m]."""
    return length_of(distance) if distance > ROUNDING else "rounding"


class Fitted(NamedTuple):
    """A stone of a model: its name, what fits it, whether it is a support, and its density [kg/m³] if the model tells."""

    name: str
    shape: Frustum | Hull
    fixed: bool
    density: float | None

    @property
    def words(self) -> str:
        """What it became, and how far the mesh is from that."""
        shape, far = self.shape, near(self.shape.residual)
        more = 1.0 / shape.filled - 1.0
        off = f"; its volume is {100.0 * more:+.2g} % off the mesh" if abs(more) > REPORTED_SHARE else ""
        off += ", whose mass it keeps" if off and self.density is not None and isinstance(shape, Hull) else ""
        if isinstance(shape, Hull):
            drum = "" if shape.drum is None else f" (no round drum within {near(shape.drum.residual)})"
            return f"block of {len(shape.corners)} corners, within {far}{drum}{off}"
        flat = f", {near(shape.flat)} more between corners" if shape.flat > ROUNDING else ""
        lost, radius = shape.residual + shape.flat, 0.5 * min(shape.bottom, shape.top)
        price = f": if an edge lacks that much, limit analysis tells up to {100.0 * lost / radius:.2g} % too much"
        taken = f"{far}{flat}{off}{price if shape.residual > PRICED * radius else ''}"
        return f"drum ⌀ {shape.bottom:.4g} to {shape.top:.4g} m, {shape.height:.4g} m high, within {taken}"


def fit_all(
    parts: Sequence[tuple[MeshPart, bool, float | None]], hulls: Sequence[Hull], tolerance: float
) -> list[Fitted]:
    """What fits each part of a model within a tolerance [m]; parts ``NAME, part 1`` … are convex parts of one block.

    A hull has the mass of its part where the model tells a density: its own is less by what the hull adds.

    Raises
    ------
    InputError
        A part that is not convex, by its name.
    """
    stones = []
    for (part, fixed, density), hull in zip(parts, hulls, strict=True):
        shape = within_tolerance(hull, tolerance, f"part {part.name!r}")
        shape = hull._replace(drum=None) if ", part " in part.name else shape
        if density is not None and isinstance(shape, Hull) and abs(shape.filled - 1.0) > REPORTED_SHARE:
            density = round(density * shape.filled, 3)
        stones.append(Fitted(part.name, shape, fixed, density))
    return stones


def body_of(part: str) -> str:
    """Name of the body that a part belongs to."""
    return part.partition(", part ")[0]


def assembly_tables(name: str, stones: Sequence[Fitted], stone: str | None, ground: float | None) -> dict[str, Any]:
    """Content of a file of an assembly in space.

    Parameters
    ----------
    name : str
    stones : sequence of Fitted
    stone : str or None
        Name of a material; None where all is stated otherwise.
    ground : float or None
        Level of the ground [m]; None for none.
    """
    blocks: dict[str, dict[str, Any]] = {}
    for piece in stones:
        called, part = body_of(piece.name), ", part " in piece.name
        entry: dict[str, Any] = {}
        if isinstance(piece.shape, Frustum):
            entry = _drum(piece.shape)
        else:
            entry["vertices"] = (piece.shape.corners.round(DIGITS) + 0.0).tolist()
        facts: dict[str, Any] = {"name": called} | ({"fixed": True} if piece.fixed else {})
        facts |= {} if piece.density is None else {"density": piece.density}
        if part:
            blocks.setdefault(called, facts | {"at": [0.0, 0.0, 0.0], "parts": []})["parts"].append(entry)
        else:
            blocks[called] = facts | entry
    return {
        "name": name,
        **({} if stone is None else {"material": material(stone).name}),
        "ground": False if ground is None else ground,
        "block": list(blocks.values()),
    }


def _drum(frustum: Frustum) -> dict[str, Any]:
    """``at`` is the middle of the lower face before the drum is turned about its centroid."""
    high = Drum(frustum.height, frustum.bottom, frustum.top, 1.0e3, "circular").centroid_height
    at = frustum.foot + high * frustum.axis - (0.0, 0.0, high)
    table: dict[str, Any] = {
        "drum": {"bottom_diameter": frustum.bottom, "top_diameter": frustum.top, "height": frustum.height},
        "at": at.tolist(),
    }
    lean = math.hypot(*frustum.axis[:2])
    if lean > 0.0:
        across = (-float(frustum.axis[1]) / lean, float(frustum.axis[0]) / lean, 0.0)
        table["orientation"] = list(about(across, math.atan2(lean, float(frustum.axis[2]))))
    return table


def column_tables(
    name: str, stones: Sequence[Fitted], stone: str | None, tolerance: float
) -> tuple[dict[str, Any], list[str]]:
    """Content of a column file of drums that stand on one another, and what is said of them.

    Drums are as high and as wide as they fit; how they are offset and lean is what is found.

    Raises
    ------
    InputError
        A part that is no drum, or drums farther apart, or deeper in one another, than the tolerance [m].
    """
    other = next((piece for piece in stones if isinstance(piece.shape, Hull)), None)
    if other is not None:
        drum = other.shape.drum if isinstance(other.shape, Hull) else None
        off = "" if drum is None else f" within {length_of(drum.residual)}"
        raise InputError(
            f"part {other.name!r} is no round drum{off}; a column is made of such, write an assembly.", "as"
        )
    order = sorted(stones, key=lambda piece: float(piece.shape.foot[2]) if isinstance(piece.shape, Frustum) else 0.0)
    drums = [piece.shape for piece in order if isinstance(piece.shape, Frustum)]
    rows, deviations, gaps = [], [], []
    axis, frame = np.array([0.0, 0.0, 1.0]), np.eye(3)
    for number, (frustum, named) in enumerate(zip(drums, order, strict=True), 1):
        rows.append({"height": frustum.height, "bottom_width": frustum.bottom, "top_width": frustum.top})
        if named.density is not None:
            rows[-1]["density"] = named.density
        facts: dict[str, Any] = {"index": number}
        if number > 1:
            below = drums[number - 2]
            way = frustum.foot - below.foot - below.height * below.axis
            gap = float(way @ axis)
            if abs(gap) > tolerance:
                what = "apart" if gap > 0.0 else "deep in one another"
                raise InputError(
                    f"{order[number - 2].name!r} and {named.name!r} are {length_of(abs(gap))} {what}; allowed are "
                    f"{length_of(tolerance)}: mend the mesh.",
                    "tolerance",
                )
            gaps.append(gap)
            x, y = (float(coordinate) for coordinate in frame[:, :2].T @ way)
            if math.hypot(x, y) > 1e-9:
                facts |= {"offset": math.hypot(x, y), "offset_azimuth": math.atan2(y, x) / DEGREE}
        x, y, z = (float(coordinate) for coordinate in frame.T @ frustum.axis)
        lean = math.atan2(math.hypot(x, y), z) / DEGREE
        if lean > STRAIGHT:
            facts |= {"tilt": -lean, "tilt_azimuth": math.atan2(y, x) / DEGREE}
            across = np.array([-y, x, 0.0]) / math.hypot(x, y)
            skew = np.array([[0.0, 0.0, across[1]], [0.0, 0.0, -across[0]], [-across[1], across[0], 0.0]])
            angle = lean * DEGREE
            frame = frame @ (np.eye(3) + math.sin(angle) * skew + (1.0 - math.cos(angle)) * skew @ skew)
            axis = frame[:, 2]
        if len(facts) > 1:
            deviations.append(facts)
    table: dict[str, Any] = {"name": name, "section": "circular", "drum": rows}
    table |= {} if stone is None else {"material": material(stone).name}
    if deviations:
        table["as_found"] = {"drum": deviations}
    apart = [f"drums fit on one another within {near(max(map(abs, gaps)))}"] if gaps else []
    return table, apart


def distance_of(column: Column, stones: Sequence[Fitted]) -> float:
    """Largest distance of the middle of a drum's lower face from where a mesh has it, from the lowest one's [m]."""
    drums = sorted(
        (stone.shape for stone in stones if isinstance(stone.shape, Frustum)), key=lambda drum: float(drum.foot[2])
    )
    at = space_geometry(column)
    feet = [at.centroid[i] - at.axes[i][:, 2] * drum.centroid_height for i, drum in enumerate(column.drums)]
    return max(
        float(np.linalg.norm((foot - feet[0]) - (drum.foot - drums[0].foot)))
        for foot, drum in zip(feet, drums, strict=True)
    )


#: Endings of what is written; of what is read besides column and assembly files.
WRITTEN = (".toml", ".json", ".csv", ".obj", ".ply", ".stl", ".glb")
SURVEYS = (".csv", *WORKBOOKS)
READ = (*MESHES, ".json", ".dat", *SURVEYS)

#: Largest distance of a mesh from what stands for it unless told otherwise [m].
TOLERANCE = 0.001

#: A closed part of a model, whether it is fixed, and its density [kg/m³] if the model tells.
Part: TypeAlias = tuple[MeshPart, bool, float | None]

#: Tolerances that are tried for an advice [m], up to this share of the smallest stone.
TOLERANCES, LOOSEST = (0.002, 0.005, 0.01, 0.02, 0.05, 0.1), 0.1

#: Kinds that stones of a mesh can become.
KINDS = ("assembly", "column")


class Reading:
    """How a model of another tool is read.

    Parameters
    ----------
    material : str, optional
        Stone and joints by name; of a mesh needed.
    becomes : str
        ``assembly`` or ``column``.
    unit : str
        Of a mesh.
    tolerance : float
        Largest distance of a mesh from what stands for it [m].
    closing : float, optional
        Largest gap between faces that is closed [m]; the tolerance unless given, of polyhedra, whose hulls leave no gap that
        is not theirs, 1 mm.
    ground : float, None or False
        Level of the ground [m]; None for the lowest point, False for none.
    fixed : sequence of str
        Names of stones that move with the ground.
    glued : sequence of str
        Parts that are one stone, by their names with + between them; faces that they share vanish.
    columns : str, optional
        Of a survey whose row of names is not ours, such as ``drum, height [cm], bottom_width [cm], top_width [cm], -``.
    north : float, optional
        Bearing of the x axis of a survey, clockwise from north [degrees].
    up : str, optional
        Axis of the file that is upward, ``y`` or ``z``; y of glTF and z of others unless given.
    """

    def __init__(
        self,
        material: str | None = None,
        becomes: str = "assembly",
        unit: str = "m",
        tolerance: float = TOLERANCE,
        ground: float | bool | None = None,
        fixed: tuple[str, ...] = (),
        columns: str | None = None,
        north: float | None = None,
        up: str | None = None,
        closing: float | None = None,
        glued: tuple[str, ...] = (),
    ) -> None:
        if becomes not in KINDS:
            raise InputError(f"`as` is {becomes!r}; allowed are {', '.join(KINDS)}.", "as")
        if up not in (None, *UPWARD):
            raise InputError(f"`up` is {up!r}; allowed are {', '.join(UPWARD)}.", "up")
        check_range("`tolerance`", tolerance, 0.0, 1.0, unit="m", field="tolerance")
        if closing is not None:
            check_range("`closing`", closing, 0.0, 1.0, unit="m", field="closing")
        if isinstance(ground, float):
            check_range("level of the ground", ground, -FAR_AWAY, FAR_AWAY, unit="m", field="ground")
        self.material, self.becomes, self.unit = material, becomes, unit
        self.tolerance, self.ground, self.fixed = tolerance, ground, fixed
        self.columns, self.north, self.up, self.closing, self.glued = columns, north, up, closing, glued


def convert(model: str, path: Path, reading: Reading, layout: str = "dem") -> tuple[Structure, list[str], list[Path]]:
    """Read a model and write it to a file, of the kind that its ending tells.

    Parameters
    ----------
    model : str
        A preset, a file of a column or of an assembly, a mesh, COMPAS JSON or a survey (CSV or a workbook).
    path : Path
        Nothing may be there.
    reading : Reading
    layout : str
        Of COMPAS JSON that is written: ``dem`` or ``assembly``.

    Returns
    -------
    structure : Structure
    words : list of str
        What became of each stone.
    files : list of Path

    Raises
    ------
    InputError
        What cannot be, in one sentence; nothing is written then.
    """
    suffix = path.suffix.lower()
    if suffix not in WRITTEN:
        raise InputError(f"a model cannot be written to {str(path)!r}; endings are {', '.join(WRITTEN)}.", "to")
    if layout not in LAYOUTS:
        raise InputError(f"`compas` is {layout!r}; allowed are {', '.join(LAYOUTS)}.", "compas")
    refuse_existing(path)
    read_from = Path(model).suffix.lower()
    foreign = read_from in READ
    if reading.columns is not None and read_from not in SURVEYS:
        raise InputError("`columns` are those of a survey, and none is given; leave them out.", "columns")
    structure, tables, words = read_model(Path(model), reading) if foreign else (load_structure(model), None, [])
    if suffix == ".toml":
        comments = [" ".join(line.split()) for line in words]
        content = _file_of(structure) if tables is None else toml_text(tables, comments).encode()
    elif suffix == ".csv":
        column = structure.stack
        if column is None:
            raise InputError(
                f"a survey holds the drums of a column, and {structure.name!r} is {structure.described}.", "to"
            )
        content = survey_text(column).encode()
    elif suffix == ".json":
        blocks = [(name, mesh, fixed, density) for name, mesh, fixed, density in surfaces_of(structure)]
        content = compas_json(structure.name, blocks, layout).encode()
    else:
        named = [Named(name, mesh, FIXED if fixed else STONE) for name, mesh, fixed, _ in surfaces_of(structure)]
        content = _glb(structure.name, named) if suffix == ".glb" else TEXTS[suffix](named).encode()
        words += _lost(structure, suffix)
    with replacing(path) as partial:
        partial.write_bytes(content)
    return structure, words, [path]


def read_model(path: Path, reading: Reading) -> tuple[Structure, dict[str, Any], list[str]]:
    """A model of another tool: what stands, the content of its file, and what became of each stone.

    Raises
    ------
    InputError
    """
    if path.suffix.lower() in SURVEYS:
        tables, notes = survey_tables(path, reading.material, reading.columns, reading.north)
        tables.setdefault("name", path.stem)
        column = made_of(Column, tables, printable(path))
        return column, tables, [f"{column.n} {'drum' if column.n == 1 else 'drums'}, {column.height:g} m high", *notes]
    stated: dict[str, Any] | None = None
    if path.suffix.lower() == ".dat":
        name, up = path.stem, reading.up or "z"
        for option, value, read in (("unit", reading.unit, "m"), ("up", up, "z")):
            if value != read:
                raise InputError(
                    f"`{option}` is {value!r}; allowed for {printable(path)}, a data file of 3DEC, is {read!r}: its "
                    "densities, stiffnesses and gravity are read in kg/m³, N/m³ and m/s², gravity along z. Write the file "
                    "in these units, or its polyhedra as closed meshes, in OBJ for one.",
                    option,
                )
        parts, stated = read_three_dec(path)
    elif path.suffix.lower() == ".json":
        name, blocks = read_compas(path)
        up, factor = reading.up or "z", unit_of(reading.unit, printable(path))
        parts = [(part.in_metres(factor, up), fixed, density) for part, fixed, density in parts_of(blocks)]
    else:
        name, up = path.stem, reading.up or upward(path)
        parts = [(part, False, None) for part in read_stones(path, reading.unit, up)]
    structure, tables, words = stand_up(name, parts, reading, printable(path), path.parent, stated)
    words.insert(-1, f"{up} is taken as upward" + ("" if reading.up or stated is not None else "; `up` says otherwise"))
    return structure, tables, words


def parts_of(blocks: Sequence[Block]) -> list[Part]:
    """Blocks of a model of COMPAS as parts of a model."""
    return [(block.part, block.fixed, block.density) for block in blocks]


def stand_up(
    name: str, parts: Sequence[Part], reading: Reading, where: str, folder: Path, stated: dict[str, Any] | None = None
) -> tuple[Structure, dict[str, Any], list[str]]:
    """What stands of the parts of a model; returns and errors as of :func:`read_model`.

    Parameters
    ----------
    name : str
    parts : sequence of Part
    reading : Reading
    where : str
        What messages call the model.
    folder : Path
        That paths of meshes start from.
    stated : dict, optional
        Tables that a model of polyhedra, of which none is round, gives of its joints and its gravity.
    """
    material = reading.material
    if material is None and "joint" not in (stated or {}):
        raise InputError(
            f"{where} says nothing of stone and joints; name a material, such as `material='marble'`.", "material"
        )
    parts, notes = _near_the_origin(_one_stone(parts, reading.glued, where))
    rounding = max(part.rounding for part, *_ in parts)
    notes += [f"its numbers are rounded by up to {near(rounding)} (single precision)"] if rounding > ROUNDING else []
    level, parts = _without_ground(parts)
    if not parts:
        raise InputError(f"{where} holds a ground and no stones; give those that stand on it.")
    names = [part.name for part, *_ in parts]
    unknown = next((part_name for part_name in reading.fixed if part_name not in names), None)
    if unknown is not None:
        raise InputError(f"`fixed` names {unknown!r}, which {where} does not hold; it holds {_some(names)}.", "fixed")
    parts = [(part, fixed or part.name in reading.fixed, density) for part, fixed, density in parts]
    hulls = [hull_of(part, f"{where}: part {part.name!r}", stated is None) for part, *_ in parts]

    def stood(tolerance: float) -> tuple[Structure, dict[str, Any], list[str]]:
        with within(where):
            if rounding > tolerance:
                raise InputError(
                    f"its numbers, of single precision, are rounded by up to {length_of(rounding)} so far from the origin; "
                    f"allowed are {length_of(tolerance)}: write it from an origin nearby, or in double precision.",
                    "tolerance",
                )
            stones = fit_all(parts, hulls, tolerance)
            words = [f"{stone.name}: {stone.words}" for stone in stones] + notes
            if reading.becomes == "column":
                tables, remarks = column_tables(name, stones, material, tolerance)
                column = made_of(Column, tables)
                remarks.append(f"its drums stand where the mesh has them within {near(distance_of(column, stones))}")
                return column, tables, words + remarks
            ground = float(reading.ground) if reading.ground is not None and reading.ground is not False else None
            if reading.ground is None and (level is not None or not any(stone.fixed for stone in stones)):
                ground = round(min(stone.shape.lowest for stone in stones) if level is None else level, 7) + 0.0

            def level_at(facing: float) -> tuple[Structure, dict[str, Any], float, list[Closed]]:
                shapes, closing = [stone.shape for stone in stones], TOLERANCE if stated is not None else tolerance
                closing = closing if reading.closing is None else reading.closing
                shapes, shift, closed = brought_together(shapes, ground, tolerance, closing, facing)
                level_stones = [stone._replace(shape=shape) for stone, shape in zip(stones, shapes, strict=True)]
                tables = assembly_tables(name, level_stones, material, ground) | (stated or {})
                return (
                    spatial_assembly(checked(tables, SpatialTable, "the assembly"), name, folder),
                    tables,
                    shift,
                    closed,
                )

            try:
                structure, tables, shift, closed = level_at(SMOOTH)
            except InputError:
                structure, tables, shift, closed = level_at(ROUGH)
            if shift > ROUNDING:
                words.append(f"faces that touch were brought into common planes: corners moved by up to {near(shift)}")
            words += _largest(closed, [*names, "the ground"])
            words.append(
                "no ground: the supports carry it" if ground is None else f"the ground lies at z = {ground:.6g} m"
            )
            return structure, tables, words

    try:
        return stood(reading.tolerance)
    except InputError as error:
        most = LOOSEST * min(float(np.ptp(hull.corners, axis=0).max()) for hull in hulls)
        enough = next(
            (
                candidate
                for candidate in TOLERANCES
                if reading.tolerance < candidate <= most and _is_read(stood, candidate)
            ),
            None,
        )
        if enough is None:
            raise
        more = f"{str(error).rstrip('.')}, or allow more with `tolerance={enough:g}`."
        raise InputError(more, error.field) from None


def _is_read(stood: Callable[[float], object], tolerance: float) -> bool:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            stood(tolerance)
        except InputError:
            return False
    return True


def _near_the_origin(parts: Sequence[Part]) -> tuple[list[Part], list[str]]:
    """Parts without the place on a map that their coordinates begin from, and what was taken off."""
    points = np.concatenate([part.points[part.used] for part, *_ in parts])
    place = np.where(np.abs(points).max(axis=0) > FAR_AWAY, np.floor(points.min(axis=0)), 0.0)
    off = ", ".join(f"{axis} = {value:.0f} m" for axis, value in zip("xyz", place.tolist(), strict=True) if value)
    words = [f"its place was taken off: coordinates count from {off}"] if off else []
    return [(replace(part, points=part.points - place), fixed, density) for part, fixed, density in parts], words


def _without_ground(parts: Sequence[Part]) -> tuple[float | None, list[Part]]:
    """Level of a part called ``ground`` [m], as exports have it, and the others."""
    level = next((float(part.points[part.used, 2].max()) for part, *_ in parts if part.name == "ground"), None)
    return level, [part for part in parts if part[0].name != "ground"]


def _one_stone(parts: Sequence[Part], glued: Sequence[str], where: str) -> list[Part]:
    """Parts with those that are glued joined to one surface, without the faces that they share, by the name of the first.

    Raises
    ------
    InputError
        A name that is not there or twice, a stone of one part, parts of two densities, or one part of it fixed.
    """
    rest = {part.name: (part, fixed, density) for part, fixed, density in parts}
    for text in glued:
        names = [name.strip() for name in text.split("+")]
        unknown = next((name for name in names if name not in rest), None)
        if unknown is not None:
            raise InputError(
                f"`glued` names {unknown!r}, which {where} does not hold; it holds {_some([*rest])}.", "glued"
            )
        glued_parts = [rest[name] for name in names]
        if len({*names}) < max(len(names), 2) or len({tuple(facts) for _, *facts in glued_parts}) > 1:
            raise InputError(
                f"`glued` is {text!r}; allowed are two or more different parts of one density, all of them fixed or none.",
                "glued",
            )
        whole = _joined([part for part, *_ in glued_parts])
        check_closed(whole, f"{text!r} of {where}")
        rest = {name: part for name, part in rest.items() if name not in names[1:]} | {
            names[0]: (whole, *glued_parts[0][1:])
        }
    return [*rest.values()]


def _joined(parts: Sequence[MeshPart]) -> MeshPart:
    """One surface of several, without the faces that two of them share; vertices nearer than ``SAME`` are one."""
    from scipy.spatial import KDTree

    points = np.concatenate([part.points for part in parts])
    own = [min(near) for near in KDTree(points).query_ball_point(points, SAME)]
    starts = np.cumsum([0, *(len(part.points) for part in parts)]).tolist()
    faces = [
        tuple(own[start + i] for i in face) for part, start in zip(parts, starts, strict=False) for face in part.faces
    ]
    lines = [line for part in parts for line in part.lines or (0,) * len(part.faces)]
    times = Counter(map(frozenset, faces))
    kept = [k for k, face in enumerate(faces) if times[frozenset(face)] == 1]
    return replace(parts[0], points=points, faces=tuple(faces[k] for k in kept), lines=tuple(lines[k] for k in kept))


def _largest(closed: Sequence[Closed], names: Sequence[str]) -> list[str]:
    """How many gaps and overlaps were closed, and the largest of each."""
    words = []
    for kind in ("gap", "overlap"):
        closures = sorted(
            (getattr(closure, kind), closure.first, closure.other)
            for closure in closed
            if getattr(closure, kind) > ROUNDING
        )
        if closures:
            size, first, other = closures[-1]
            many = f"{len(closures)} {kind}s, the largest" if len(closures) > 1 else f"the {kind}"
            words.append(f"{many} of {near(size)} between {names[first]!r} and {names[other]!r}, closed")
    return words


def _some(names: list[str]) -> str:
    return ", ".join(map(repr, names[:6])) + (f" and {len(names) - 6} more" if len(names) > 6 else "")


def surfaces_of(structure: Structure) -> list[tuple[str, Mesh, bool, float]]:
    """Convex parts of the bodies of a structure where they stand: names, surfaces [m], whether fixed, densities [kg/m³]."""
    surfaces = []
    densities = (
        {f"drum {i}": drum.density for i, drum in enumerate(structure.stack.drums, 1)} if structure.stack else {}
    )
    for body in structure.bodies:
        if body.fixed and body.size > FAR_AWAY:
            continue
        density = float(getattr(body, "density", densities.get(body.name, 0.0)))
        parts = body.placed
        for number, part in enumerate(parts, 1):
            name = body.name if len(parts) == 1 else f"{body.name}, part {number}"
            surfaces.append((name, in_use(part.mesh(AROUND)), body.fixed, density))
    return surfaces


def _lost(structure: Structure, suffix: str) -> list[str]:
    """What a mesh does not hold of a structure."""
    glued = [body.name for body in structure.bodies if len(body.placed) > 1 and not body.size > FAR_AWAY]
    fixed = [body.name for body in structure.bodies if body.fixed and not body.size > FAR_AWAY]
    words = [
        f"{suffix} holds shapes{' without names' if suffix == '.ply' else ' and names'} alone, no densities and joints"
    ]
    words += [f"supports are not kept: {_some(fixed)}, to be named in `fixed`"] if fixed else []
    loose = suffix == ".ply" and glued
    return words + (
        [f"glue is not kept: the parts of {_some(glued)} come loose; other formats keep it"] if loose else []
    )


def _glb(name: str, surfaces: list[Named]) -> bytes:
    file = Glb(name)
    for surface in surfaces:
        middle = surface.mesh.vertices.mean(axis=0)
        file.add(surface._replace(mesh=Mesh(surface.mesh.vertices - middle, surface.mesh.faces)), middle.tolist())
    return file.content()


def _file_of(structure: Structure) -> bytes:
    column = structure.stack
    if column is None:
        raise InputError(f"{structure.name!r} is an assembly file already; write another kind of file.", "to")
    return toml_text(tables_of(column)).encode()
