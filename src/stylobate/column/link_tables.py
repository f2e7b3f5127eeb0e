"""What ``[[link]]`` of a column file holds, and the links that it makes."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import InputError
from .link_kinds import link_from_dict
from .links import Link, Tie
from .toml import Table


class LinkNumbers(Table):
    """What ``[[link]]`` says of a link itself, in the files of columns and of assemblies."""

    diameter: float | None = None
    embedment: float | None = None
    material: str | None = None
    hole: float | None = None
    shear_stiffness: float | None = None
    shear_capacity: float | None = None
    clearance: float | None = None
    failure: str | None = None
    axial_stiffness: float | None = None
    axial_capacity: float | None = None
    bond: float | None = None
    ultimate_slip: float | None = None
    ultimate_elongation: float | None = None
    pretension: float | None = None
    friction_coefficient: float | None = None
    damping: float | None = None
    stone_modulus: float | None = None
    stone_strength: float | None = None


class LinkTable(LinkNumbers):
    """``[[link]]``: a link, or one alike in several joints; lengths in m, forces in N, stiffness in N/m."""

    kind: str
    name: str | None = None
    joint: int | None = None
    joints: str | list[int] | None = None
    at: list[float] | None = None
    to: list[float] | None = None
    from_drum: int | None = None
    to_drum: int | None = None
    from_height: float | None = None
    to_height: float | None = None


def links_of(tables: Sequence[LinkTable], joints: int) -> tuple[Link, ...]:
    """Links of a column with so many joints.

    Raises
    ------
    InputError
        The message names the table by its number.
    """
    found: list[Link] = []
    for number, table in enumerate(tables, 1):
        fields = table.model_dump(exclude={"joints"}, exclude_none=True)
        try:
            if table.joints is None:
                found.append(link_from_dict(fields))
            else:
                found += [link_from_dict(fields | {"joint": joint}) for joint in _joints(table, joints)]
        except InputError as error:
            raise InputError(f"[[link]] number {number}: {error}") from None
    return tuple(found)


def _joints(table: LinkTable, joints: int) -> Sequence[int]:
    if table.joint is not None:
        raise InputError(f"joint = {table.joint} and joints are both given; keep one of the two.")
    if table.kind in (Tie.kind, "core"):
        raise InputError(f"a {table.kind} has no joints; give from_drum and to_drum.")
    if isinstance(table.joints, list):
        return table.joints
    if table.joints != "all":
        raise InputError(f'joints is {table.joints!r}; it must be "all", or a list of numbers.')
    return range(1, joints + 1)
