"""Contents of a column file (TOML): its tables, and the column that they make."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, ClassVar

from ..constants import g as STANDARD_GRAVITY
from ..errors import InputError, check_choice, check_kind, check_range, warn, within
from ..messages import say
from ..text_tables import printable
from .as_found import AsFound, FoundDrum
from .drum import DENSITIES, LENGTHS, SECTIONS, Drum
from .joint import FRICTION, Joint, stated_fields
from .links.tables import LinkTable, links_of
from .materials import JOINT_VALUES, Material, material
from .plausible import found_doubts, law_doubts
from .toml import Table, checked, parse_toml, words


class JointTable(Table):
    """``[joint]``: stiffness [N/m³], one form of friction (angle in degrees), cohesion [Pa], width of the ring [m].

    What is left out is that of the material.
    """

    material: str | None = None
    normal_stiffness: float | None = None
    shear_stiffness: float | None = None
    friction_angle: float | None = None
    friction_coefficient: float | None = None
    cohesion: float | None = None
    ring_width: float | None = None


class OverrideTable(JointTable):
    """``[[joint_override]]``: what differs at one joint; joint 1 is the one with the base."""

    called: ClassVar[str | None] = "override"

    index: int


class DrumTable(Table):
    """``[[drum]]``: one drum, bottom to top; lengths in m, density in kg/m³."""

    height: float
    bottom_width: float
    top_width: float
    density: float | None = None
    depth: float | None = None
    top_depth: float | None = None


class TaperedTable(Table):
    """``[tapered]``: equal drums between two widths; lengths in m."""

    height: float
    bottom_width: float
    top_width: float
    drums: int
    top_depth: float | None = None


class FoundDrumTable(Table):
    """``[[as_found.drum]]``: offset and chips in m, angles in degrees, of the drum with that index (1 at the base)."""

    called: ClassVar[str | None] = "found"

    index: int
    offset: float = 0.0
    tilt: float = 0.0
    chip_left: float = 0.0
    chip_right: float = 0.0
    offset_azimuth: float = 0.0
    tilt_azimuth: float = 0.0
    turn: float = 0.0
    chip_front: float = 0.0
    chip_back: float = 0.0
    chip_azimuth: float = 0.0


class AsFoundTable(Table):
    """``[as_found]``: slope of the base in degrees, and what is not as built at single drums."""

    called: ClassVar[str | None] = ""

    base_tilt: float = 0.0
    base_azimuth: float = 0.0
    drum: list[FoundDrumTable] | None = None


class ColumnTable(Table):
    """A column file."""

    name: str | None = None
    section: Annotated[str, words(SECTIONS)] = "rectangular"
    depth: float | None = None
    density: float | None = None
    material: str | None = None
    gravity: float = STANDARD_GRAVITY
    north: float | None = None
    tapered: TaperedTable | None = None
    drum: list[DrumTable] | None = None
    joint: JointTable | None = None
    joint_override: list[OverrideTable] | None = None
    as_found: AsFoundTable | None = None
    link: list[LinkTable] | None = None


def read_as(kind: Any, path: str | Path) -> Any:
    """Read a column file.

    Parameters
    ----------
    kind : type
        What is made of it, :class:`stylobate.Column`, with its ways of being made.
    path : str or Path

    Raises
    ------
    InputError
        The file cannot be read or does not describe a column; the message names the file, the key and the remedy.
    """
    data = parse_toml(check_kind("path", path, (str, Path)))
    if describes_assembly(data):
        raise InputError(
            f"{printable(path)} describes an assembly of blocks, and this is for columns; give a preset, or a file with "
            "[tapered] or [[drum]]."
        )
    return made_of(kind, data, printable(path), printable(Path(path).stem))


def made_of(kind: Any, data: dict[str, Any], source: str = "the column", name: str = "column") -> Any:
    """Make a column of what a column file holds.

    Parameters
    ----------
    kind : type
        As in :func:`read_as`.
    data : dict
        Tables as TOML gives them.
    source : str
        What messages call the file.
    name : str
        Of a column that states none.

    Raises
    ------
    InputError
        As in :func:`read_as`.
    """
    table = checked(data, ColumnTable, source)
    with within(source):
        return _column(kind, table, default_name=name)


def density_of(entry: str, *stated: float | None) -> float:
    """The first density that is stated, of those that an entry of an assembly may have [kg/m³].

    Raises
    ------
    InputError
        None is stated.
    """
    density = next((value for value in stated if value is not None), None)
    if density is None:
        raise InputError(f"{entry} has no density; add one to it, or a common one at the top [kg/m³].")
    return density


def describes_assembly(data: dict[str, Any]) -> bool:
    """Whether the content of a TOML file is that of an assembly: it has blocks, beams, columns from files, or settles."""
    return any(key in data for key in ("block", "beam", "settle")) or isinstance(data.get("column"), list)


def _column(kind: Any, table: ColumnTable, default_name: str) -> Any:
    column = _as_built(kind, table, default_name)
    for doubt in law_doubts(column):
        warn(say("{column.name!r}: {doubt}", column=column, doubt=doubt))
    changes: dict[str, Any] = {}
    if table.as_found is not None:
        found_drums = tuple(
            FoundDrum(row.index, **row.model_dump(exclude={"index"})) for row in table.as_found.drum or ()
        )
        changes["as_found"] = AsFound(found_drums, table.as_found.base_tilt, table.as_found.base_azimuth)
    if table.link:
        changes["links"] = links_of(table.link, column.n)
    if not changes:
        return column
    changed = column.replace(**changes)
    for doubt in found_doubts(changed):
        warn(say("{column.name!r}: {doubt}", column=column, doubt=doubt))
    return changed


def joint_fields(given: dict[str, Any], stone: Material | None, where: str = "[joint]") -> dict[str, Any]:
    """Fields of a :class:`Joint` that a table gives, by hand or by the name of a material.

    Parameters
    ----------
    given : dict
        The table.
    stone : Material, optional
        Of what the table leaves out, unless it names another.
    where : str
        What messages call the table.

    Raises
    ------
    InputError
        A material that does not exist, or a stiffness that is neither given nor published.
    """
    fields = {name: value for name, value in given.items() if value is not None}
    named = fields.pop("material", None)
    stone = stone if named is None else material(named)
    if stone is not None:
        return stone.joint_values(fields, where)
    for name in ("normal_stiffness", "shear_stiffness"):
        if name not in fields:
            raise InputError(f"key {name!r} is missing in {where}; add it [N/m³], or name a material.", name)
    return fields


def _as_built(kind: Any, table: ColumnTable, default_name: str) -> Any:
    stone = None if table.material is None else material(table.material)
    if table.joint is None and stone is None:
        raise InputError(
            "there is no [joint] table; add one with normal_stiffness and shear_stiffness [N/m³] "
            "and friction_angle [degrees], or name a material."
        )
    with within("", "joint"):
        joint = Joint(**joint_fields({} if table.joint is None else table.joint.model_dump(), stone))
    density = table.density if table.density is not None or stone is None else stone.density.value
    if table.tapered is not None and table.drum is not None:
        raise InputError("both [tapered] and [[drum]] are given; keep one of the two.")
    check_choice("section", table.section, SECTIONS)  # what all drums share is told of at its own place
    for key, limits, unit in (("density", DENSITIES, "kg/m³"), ("depth", LENGTHS, "m")):
        if getattr(table, key) is not None:
            check_range(key, getattr(table, key), *limits, unit=unit, remedy="use SI units")
    if table.section == "circular" and table.depth is not None:
        raise InputError(f"depth is {table.depth:g} m for a circular section; leave it out.", "depth")
    name = default_name if table.name is None else table.name
    overrides: dict[int, Joint] = {}
    for override in table.joint_override or ():
        if override.index in overrides:
            raise InputError(f"joint_override index {override.index} is given twice; keep one of the two.")
        overrides[override.index] = _overridden(joint, override)
    if table.tapered is not None:
        if density is None:
            raise InputError("key 'density' [kg/m³] is missing; add it above [tapered], or name a material.", "density")
        column = kind.tapered(
            **table.tapered.model_dump(),
            density=density,
            joint=joint,
            section=table.section,
            depth=1.0 if table.depth is None else table.depth,
            overrides=overrides,
            name=name,
            gravity=table.gravity,
        )
    elif table.drum:
        drums = [_drum(i, row, table, density) for i, row in enumerate(table.drum)]
        column = kind.of_drums(drums, joint, overrides=overrides, name=name, gravity=table.gravity)
    else:
        raise InputError("there is neither [tapered] nor [[drum]]; add one of the two.")
    more = {"material": None if stone is None else stone.name, "north": table.north}
    more = {key: value for key, value in more.items() if value is not None}
    return column.replace(**more) if more else column


def _drum(i: int, row: DrumTable, table: ColumnTable, common: float | None) -> Drum:
    density, path = common if row.density is None else row.density, f"drum.{i + 1}"
    if density is None:
        raise InputError(
            f"[[drum]] number {i + 1} has no density; add one to it, or a common one at the top [kg/m³].",
            f"{path}.density",
        )
    if table.section == "circular" and row.depth is not None:
        raise InputError(
            f"[[drum]] number {i + 1} has a depth but a circular section; leave the depth out.", f"{path}.depth"
        )
    depth = row.depth if row.depth is not None else table.depth if table.depth is not None else 1.0
    with within(f"[[drum]] number {i + 1}", path):
        return Drum(row.height, row.bottom_width, row.top_width, density, table.section, depth, row.top_depth)


def _overridden(common: Joint, override: OverrideTable) -> Joint:
    changes = override.model_dump(exclude={"index"}, exclude_none=True)
    with within(f"[[joint_override]] with index {override.index}", "override", override.index):
        if override.material is None:
            return common.changed(**changes)
        shape = {name: value for name, value in stated_fields(common).items() if name not in (*JOINT_VALUES, *FRICTION)}
        return Joint(**joint_fields(shape | changes, None, "it"))
