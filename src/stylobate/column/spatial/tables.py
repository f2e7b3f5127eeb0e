"""What a file of an assembly in space (TOML) holds: its tables, and whether a file is one."""

from __future__ import annotations

from typing import Any

from ...constants import g as STANDARD_GRAVITY
from ...errors import InputError
from ..links.tables import BlockLinkTable
from ..tables import JointTable
from ..toml import Table

#: Keys of a block that only bodies in space have.
IN_SPACE = (
    *("box", "drum", "mesh", "unit", "parts", "at", "turn", "tilt", "towards", "orientation"),
    *("velocity", "angular_velocity"),
)


class RoundTable(Table):
    """``drum = { … }``: two diameters and a height [m]."""

    bottom_diameter: float
    top_diameter: float
    height: float


class PartTable(Table):
    """One convex shape: a box, a drum, the hull of vertices, or a mesh; ``at`` the middle of its lower face [m]."""

    box: list[float] | None = None
    drum: RoundTable | None = None
    vertices: list[list[float]] | None = None
    mesh: str | None = None
    unit: str | None = None
    at: list[float] | None = None


class SpaceBlockTable(PartTable):
    """``[[block]]``: a shape, or several ``parts`` that are one body; lengths in m, angles in degrees."""

    name: str | None = None
    parts: list[PartTable] | None = None
    turn: float = 0.0
    tilt: float = 0.0
    towards: float | None = None
    orientation: list[float] | None = None
    velocity: list[float] | None = None
    angular_velocity: list[float] | None = None
    density: float | None = None
    fixed: bool = False
    surface: JointTable | None = None


class SpaceColumnsTable(Table):
    """``[[column]]``: columns alike, from a file; ``at`` are x and y of their axes [m]."""

    file: str
    name: str | None = None
    at: list[list[float]] | None = None
    number: int | None = None
    spacing: float | None = None
    turn: float = 0.0


class SpaceBeamTable(Table):
    """``[[beam]]``: a box from axis to axis of two columns; ``section`` is its width across and its height [m]."""

    between: list[str]
    section: list[float]
    overhang: float | list[float] = 0.0
    name: str | None = None
    density: float | None = None
    surface: JointTable | None = None


class SpaceBetweenTable(JointTable):
    """``[[joint_override]]``: the law between two bodies by name; ``ground`` is the ground."""

    between: list[str]


class SpatialTable(Table):
    """A file of an assembly in space."""

    name: str | None = None
    density: float | None = None
    material: str | None = None
    gravity: float = STANDARD_GRAVITY
    north: float | None = None
    ground: float | bool = 0.0
    settle: bool = True
    joint: JointTable | None = None
    block: list[SpaceBlockTable] | None = None
    column: list[SpaceColumnsTable] | None = None
    beam: list[SpaceBeamTable] | None = None
    joint_override: list[SpaceBetweenTable] | None = None
    link: list[BlockLinkTable] | None = None


def describes_space(data: dict[str, Any]) -> bool:
    """Whether the content of a TOML file is that of an assembly in space: any of its entries is in space."""
    return "settle" in data or any(_in_space(entry, kind) for kind, entry in _entries(data))


def refuse_mixed(data: dict[str, Any]) -> None:
    """Refuse entries of the plane beside those in space: what they mean there would be guessed.

    Raises
    ------
    InputError
    """
    if "depth" in data:
        raise InputError(
            "depth is of assemblies in the plane, and this one is in space; leave it out, a box has three sides."
        )
    for kind, entry in _entries(data):
        name = repr(entry["name"]) if isinstance(entry.get("name"), str) else "without a name"
        if kind == "block" and "depth" in entry:
            raise InputError(f"block {name} has a depth, as in the plane, among bodies in space; give it as a box.")
        if kind == "block" and 2 in _sizes(entry.get("vertices")):
            raise InputError(
                f"block {name} has vertices of two numbers, a polygon in the plane, among bodies in space; give x, y and z, "
                "or a box."
            )
        if kind == "column" and isinstance(entry.get("at"), list) and not all(isinstance(p, list) for p in entry["at"]):
            raise InputError(
                "at of a [[column]] holds numbers, as in the plane, among bodies in space; give pairs, at = [[x, y], …]."
            )
        if kind == "beam" and "section" not in entry:
            raise InputError(
                f"beam {name} has no section, as in the plane, among bodies in space; give section = [across, height] and "
                "between."
            )


def _entries(data: dict[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    return [
        (kind, entry)
        for kind in ("block", "column", "beam")
        for entry in (data[kind] if isinstance(data.get(kind), list) else [])
        if isinstance(entry, dict)
    ]


def _in_space(entry: dict[str, Any], kind: str) -> bool:
    if kind == "block":
        return any(key in entry for key in IN_SPACE) or _sizes(entry.get("vertices")) == {3}
    if kind == "column":
        places = entry.get("at")
        return "turn" in entry or (isinstance(places, list) and any(isinstance(place, list) for place in places))
    return "section" in entry


def _sizes(vertices: Any) -> set[int]:
    """How many numbers the corners of a block have."""
    points = vertices if isinstance(vertices, list) else []
    return {len(point) if isinstance(point, list) else 0 for point in points}
