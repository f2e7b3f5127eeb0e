"""Links that strengthen what stands, a file a kind: the kinds by their name, and what makes them of plain values."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

from ...errors import InputError, check_choice, suggest
from .kinds import Bar, Clamp, Core, Dowel, Layer, Line, Pad, Tie
from .link import Link, Numbers, point

#: Kinds of links by their name in files.
KINDS: dict[str, type[Link]] = {kind.kind: kind for kind in (Dowel, Bar, Tie, Core, Layer, Pad, Clamp)}

#: Those of them that a column may have.
COLUMN_KINDS = {name: kind for name, kind in KINDS.items() if kind.lies != "side"}

__all__ = [
    "COLUMN_KINDS", "KINDS", "Bar", "Clamp", "Core", "Dowel", "Layer", "Line", "Link", "Numbers", "Pad", "Tie", "block_link",
    "link_from_dict", "point",
]  # fmt: skip


def link_from_dict(fields: Mapping[str, Any]) -> Link:
    """The link that :meth:`Link.to_dict` described, of a column or of an assembly.

    Raises
    ------
    InputError
        A kind that is not known, a value that the kind does not have, or one outside its range.
    """
    values: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in fields.items()
    }
    kind = str(values.pop("kind", ""))
    if "between" in values:
        place = {name: values.pop(name) for name in ("between", "at", "to", "name") if name in values}
        return _link_kind(kind, KINDS)(**place, numbers=Numbers(**values))
    made = _link_kind(kind, COLUMN_KINDS)
    values = {name: value for name, value in values.items() if value is not None}
    known = {field.name for field in dataclasses.fields(made)} - {"between", "numbers", "made"}
    _refuse_unknown(kind, values, known)
    return made(**values)


def block_link(
    kind: str,
    between: Sequence[str],
    at: Sequence[float] | None = None,
    to: Sequence[float] | None = None,
    name: str = "",
    **what: Any,
) -> Link:
    """A link of an assembly from material and size, or from stiffness and capacity.

    Parameters
    ----------
    kind : str
        ``clamp``, ``dowel``, ``bar``, ``layer``, ``pad``, ``tie`` or ``core``.
    between : (str, str)
        Names of the bodies; ``ground`` is the ground.
    at, to : sequence of float, optional
        Its ends [m], x and z as drawn, or x, y and z: of a clamp, tie or core in the first and in the second body, of what
        is in a joint its place there, by default in the middle.
    name : str
        What results call it; its kind and its bodies if left out.
    **what
        As of the link of that kind; lengths in m, forces in N.

    Raises
    ------
    InputError
        The message names the value and what is allowed.
    """
    made = _link_kind(kind, KINDS)
    _refuse_unknown(kind, what, made.known())
    if to is not None and made.lies == "joint":
        raise InputError(f"a {kind} has one place, at; leave to out, or make it a clamp or a tie.", "to")
    values = {key: tuple(value) if isinstance(value, list) else value for key, value in what.items()}
    place: dict[str, Any] = {"between": between, "at": at, "name": name} | ({} if to is None else {"to": to})
    return made(**place, **values).in_numbers()


def _link_kind(kind: str, kinds: Mapping[str, type[Link]]) -> Any:
    if kind in KINDS and kind not in kinds:
        raise InputError(
            f"kind of a link is {kind!r}, which holds blocks side by side: give it in an assembly; a column takes "
            f"{', '.join(kinds)}.",
            "kind",
        )
    check_choice("kind", kind, kinds, of="a link")
    return kinds[kind]


def _refuse_unknown(kind: str, values: Mapping[str, Any], known: set[str]) -> None:
    for name in values:
        if name not in known:
            allowed = sorted(known)
            raise InputError(f"a {kind} has no {name!r}; {suggest(name, allowed)}it has {', '.join(allowed)}.", name)
