"""Links of columns by the name of their kind, and what makes them of plain values."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

from ..errors import InputError, suggest
from .links import Bar, Core, Dowel, Layer, Link, Tie

#: Kinds of links of columns by their name in files.
KINDS: dict[str, type[Link]] = {one.kind: one for one in (Dowel, Bar, Tie, Core, Layer)}


def link_from_dict(fields: Mapping[str, Any]) -> Link:
    """The link that :meth:`Link.to_dict` described.

    Raises
    ------
    InputError
        A kind that is not known, a value that the kind does not have, or one outside its range.
    """
    kind = str(fields.get("kind", ""))
    if kind not in KINDS:
        raise InputError(f"kind of a link is {kind!r}; {suggest(kind, KINDS)}allowed are {', '.join(KINDS)}.")
    made: Any = KINDS[kind]
    known = {one.name for one in dataclasses.fields(made)}
    values: dict[str, Any] = {name: value for name, value in fields.items() if name != "kind" and value is not None}
    for name in values:
        if name not in known:
            allowed = sorted(known)
            raise InputError(f"a {kind} has no {name!r}; {suggest(name, allowed)}it has {', '.join(allowed)}.")
    if "joint" in known and "joint" not in values:
        raise InputError(f"a {kind} has no joint; give its number, 1 at the base.")
    return made(**{name: tuple(value) if isinstance(value, list) else value for name, value in values.items()})
