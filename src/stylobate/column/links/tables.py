"""Entries ``[[link]]`` of files, of columns and of assemblies, and the links that they make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

from pydantic import create_model

from ...errors import InputError, warn, within
from ...messages import say
from ..plausible import link_doubts
from ..toml import Table, words
from . import COLUMN_KINDS, KINDS, block_link, link_from_dict
from .link import Link


def _keys(kinds: Mapping[str, type[Link]]) -> dict[str, Any]:
    """Keys of what may be said of links of these kinds besides where they are, with the types that a file may give."""
    hints = {
        name: hint for kind in kinds.values() for name, hint in get_type_hints(kind).items() if name in kind.known()
    }
    return {name: (list[float] | None if "tuple" in str(hint) else hint | None, None) for name, hint in hints.items()}


if TYPE_CHECKING:
    LinkNumbers = BlockLinkNumbers = Table
else:
    LinkNumbers = create_model("LinkNumbers", __base__=Table, __module__=__name__, **_keys(COLUMN_KINDS))
    BlockLinkNumbers = create_model("BlockLinkNumbers", __base__=Table, __module__=__name__, **_keys(KINDS))


class LinkTable(LinkNumbers):
    """``[[link]]`` of a column: one, or one alike in several joints; lengths in m, forces in N, stiffness in N/m."""

    kind: Annotated[str, words(COLUMN_KINDS)]
    name: str | None = None
    joint: int | str | list[int] | None = None
    joints: str | list[int] | None = None
    at: list[float] | None = None
    to: list[float] | None = None
    from_drum: int | None = None
    to_drum: int | None = None
    from_height: float | None = None
    to_height: float | None = None


class BlockLinkTable(BlockLinkNumbers):
    """``[[link]]`` of an assembly: what links two bodies by name; ``at`` and ``to`` are its ends, x, z or x, y, z [m]."""

    kind: Annotated[str, words(KINDS)]
    between: list[str]
    name: str = ""
    at: list[float] | None = None
    to: list[float] | None = None


def links_of(tables: Sequence[LinkTable], joints: int) -> tuple[Link, ...]:
    """Links of a column with so many joints.

    Raises
    ------
    InputError
        The message names the table by its number.
    """
    links: list[Link] = []
    for number, table in enumerate(tables, 1):
        fields = table.model_dump(exclude={"joints"}, exclude_none=True)
        with within(f"[[link]] number {number}", "link", number):
            _warn_of(number, fields)
            if not isinstance(table.joint, int | None):
                raise InputError(
                    f"joint is {table.joint!r}; it must be the number of a joint; "
                    'for a link alike in several, write joints = "all", or a list of numbers.',
                    "joint",
                )
            if table.joints is None:
                links.append(link_from_dict(fields))
            else:
                links += [link_from_dict(fields | {"joint": joint}) for joint in _joints(table, joints)]
    return tuple(links)


def links_between(tables: Sequence[BlockLinkTable]) -> list[Link]:
    """Links of an assembly; errors as of :func:`links_of`."""
    links = []
    for number, table in enumerate(tables, 1):
        fields = table.model_dump(exclude_none=True)
        with within(f"[[link]] number {number}", "link", number):
            _warn_of(number, fields)
            links.append(block_link(**fields))
    return links


def _warn_of(number: int, fields: Mapping[str, Any]) -> None:
    for doubt in link_doubts(fields):
        warn(say("[[link]] number {number}: {doubt}", number=number, doubt=doubt))


def _joints(table: LinkTable, joints: int) -> Sequence[int]:
    if table.joint is not None:
        raise InputError(f"joint = {table.joint} and joints are both given; keep one of the two.", "joint")
    if table.kind in COLUMN_KINDS and COLUMN_KINDS[table.kind].lies != "joint":
        raise InputError(f"a {table.kind} has no joints; give from_drum and to_drum.", "joint")
    if isinstance(table.joints, list):
        return table.joints
    if table.joints != "all":
        raise InputError(f'joints is {table.joints!r}; it must be "all", or a list of numbers.', "joint")
    return range(1, joints + 1)
