"""Links between the bodies of an assembly, as data: clamps between blocks side by side, dowels in joints, ties, layers."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..errors import InputError, suggest
from .link_kinds import KINDS
from .link_laws import across_numbers, clamp_numbers, line_numbers
from .links import LONGEST, Clamp, Layer, Link, Tie

#: Kinds of links of assemblies by their name in files.
BLOCK_KINDS: dict[str, type[Link]] = {**KINDS, Clamp.kind: Clamp}

#: What places a link in a column, and means nothing in an assembly.
OF_COLUMNS = ("joint", "from_drum", "to_drum", "from_height", "to_height")


@dataclass(frozen=True, kw_only=True)
class BlockLink:
    """A link between two bodies of an assembly, with what it holds in numbers; :func:`block_link` makes it from materials.

    Parameters
    ----------
    kind : str
        ``clamp``, ``dowel``, ``bar``, ``layer``, ``tie`` or ``core``.
    between : (str, str)
        Names of the bodies; ``ground`` is the ground.
    at, to : tuple of float, optional
        Its ends [m], x and z as drawn, or x, y and z: of a clamp, tie or core in the first and in the second body, of what
        is in a joint its place there, by default in the middle.
    name : str
        What results call it; its kind and its bodies if left out.
    diameter : float
        [m]; 0 if not known.
    axial_failure : str
        Of a clamp along itself, as ``failure`` across it.
    friction_coefficient : float, optional
        Of a layer, in place of the joint's [-].

    Others as for :class:`~stylobate.column.link_laws.LinkProperties`.
    """

    kind: str
    between: tuple[str, str]
    at: tuple[float, ...] | None = None
    to: tuple[float, ...] | None = None
    name: str = ""
    diameter: float = 0.0
    shear_stiffness: float = 0.0
    shear_capacity: float = math.inf
    clearance: float = 0.0
    ultimate_slip: float = math.inf
    failure: str = "ductile"
    lift: float = math.inf
    reach: float = 0.0
    damping: float = 0.0
    axial_stiffness: float = 0.0
    axial_capacity: float = math.inf
    ultimate_elongation: float = math.inf
    pretension: float = 0.0
    axial_failure: str = "ductile"
    friction_coefficient: float | None = None
    governs: str = ""

    def to_dict(self) -> dict[str, Any]:
        """All that differs from what is left out, as plain values."""
        fields = {one.name: one.default for one in dataclasses.fields(self)}
        values = {name: getattr(self, name) for name, default in fields.items() if getattr(self, name) != default}
        return {name: list(value) if isinstance(value, tuple) else value for name, value in values.items()}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> BlockLink:
        """The link that :meth:`to_dict` described."""
        values: dict[str, Any] = {
            one: tuple(value) if isinstance(value, list) else value for one, value in data.items()
        }
        return cls(**values)

    @property
    def called(self) -> str:
        """What results call it."""
        return self.name or f"{self.kind} between {self.between[0]} and {self.between[1]}"

    @property
    def straight(self) -> bool:
        """Whether it is a line between two points."""
        return self.kind in ("tie", "core")

    def moved(self, x: float, z: float, bodies: Mapping[str, str], name: str) -> BlockLink:
        """The same between bodies of other names, elsewhere in the plane [m]."""
        ends = {
            end: None if (place := getattr(self, end)) is None else (place[0] + x, *place[1:-1], place[-1] + z)
            for end in ("at", "to")
        }
        return dataclasses.replace(self, between=tuple(bodies[one] for one in self.between), name=name, **ends)


def block_link(
    kind: str,
    between: Sequence[str],
    at: Sequence[float] | None = None,
    to: Sequence[float] | None = None,
    name: str = "",
    **what: Any,
) -> BlockLink:
    """A link of an assembly from material and size, or from stiffness and capacity.

    Parameters
    ----------
    kind, between, at, to, name
        As for :class:`BlockLink`.
    **what
        As of the column's link of that kind, or of :class:`~stylobate.column.links.Clamp`; lengths in m, forces in N.

    Raises
    ------
    InputError
        The message names the value and what is allowed.
    """
    if kind not in BLOCK_KINDS:
        raise InputError(
            f"kind of a link is {kind!r}; {suggest(kind, BLOCK_KINDS)}allowed are {', '.join(BLOCK_KINDS)}."
        )
    if len(between) != 2:
        raise InputError(f"a {kind} is between {len(between)} bodies; name two, e.g. ['a', 'b'].")
    made: Any = BLOCK_KINDS[kind]
    known = sorted({one.name for one in dataclasses.fields(made)} - {*OF_COLUMNS, "at", "to", "name"})
    unknown = next((one for one in what if one not in known), None)
    if unknown is not None:
        raise InputError(f"a {kind} has no {unknown!r}; {suggest(unknown, known)}it has {', '.join(known)}.")
    values: dict[str, Any] = {one: tuple(value) if isinstance(value, list) else value for one, value in what.items()}
    placed: dict[str, Any] = {"kind": kind, "between": tuple(between), "name": name}
    placed |= {"at": _place(kind, "at", at), "to": _place(kind, "to", to)}
    if issubclass(made, Tie | Clamp):
        link: Any = made(**values)
        length = length_of(kind, placed["at"], placed["to"])
        numbers = clamp_numbers(link, length) if isinstance(link, Clamp) else line_numbers(link, length)
    else:
        link = made(joint=1, **values)
        numbers = across_numbers(link)
    if isinstance(link, Layer):
        placed["friction_coefficient"] = link.friction_coefficient
    elif isinstance(link, Clamp):
        numbers["lift"] = link.embedment if link.embedment is not None else math.inf
    return BlockLink(**placed, **numbers, diameter=getattr(link, "diameter", None) or 0.0)


def length_of(kind: str, at: tuple[float, ...] | None, to: tuple[float, ...] | None) -> float:
    """Length of a straight link [m]."""
    if at is None or to is None:
        raise InputError(
            f"a {kind} has two ends; give at = [x, z] in the first body and to = [x, z] in the second [m]."
        )
    low, high = in_space(at), in_space(to)
    length = math.dist(low, high)
    if length < 1e-3 or (kind == "clamp" and math.hypot(high[0] - low[0], high[2] - low[2]) < 1e-3):
        raise InputError(f"a {kind} has no length: both its ends are at {told(low)}; move one of them.")
    return length


def in_space(place: tuple[float, ...] | None) -> tuple[float, float, float]:
    """A place x, z or x, y, z as x, y, z [m]."""
    assert place is not None
    return (place[0], 0.0 if len(place) == 2 else place[1], place[-1])


def _place(kind: str, name: str, place: Sequence[float] | None) -> tuple[float, ...] | None:
    if place is None:
        return None
    if len(place) not in (2, 3) or not all(math.isfinite(one) and abs(one) <= 10.0 * LONGEST for one in place):
        raise InputError(
            f"{name} of a {kind} is {list(place)}; it must be a place, [x, z] or [x, y, z] within {10 * LONGEST:g} m."
        )
    return tuple(float(one) for one in place)


def told(place: tuple[float, ...]) -> str:
    """A place in space as messages tell it."""
    return f"[{place[0]:g}, {place[2]:g}] m"
