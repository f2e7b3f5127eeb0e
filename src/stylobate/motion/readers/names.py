"""Columns of numbers by their names, and whether these make sense of one place's record together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from .component import at_right_angles
from .record import direction
from .vocabulary import unit_kind

#: Names of columns, for messages.
EXAMPLE = "name the columns as in time_s,ax_g,ay_g,az_g (z is vertical)"


@dataclass(frozen=True)
class Name:
    """Header of one column.

    Parameters
    ----------
    kind : str
        ``time``, ``acceleration``, ``velocity`` or ``displacement``.
    direction : str
        Label, such as ``N`` or ``V``; empty where only the quantity is named.
    sign : float
        -1 where the numbers count against the direction.
    unit : str, optional
        As written.
    """

    kind: str
    direction: str = ""
    sign: float = 1.0
    unit: str | None = None

    @property
    def vertical(self) -> bool:
        """Whether it is upward or downward."""
        return direction(self.direction)[1]

    @property
    def family(self) -> str:
        """Names of directions that belong together: axes, compass, of the structure, numbered."""
        label = self.direction or "X"
        if label in ("X", "Y"):
            return "XY"
        return "compass" if direction(label)[0] is not None else "H" if label.startswith("H") else "LRT"


class Doubt(Exception):
    """Why a reading of a line makes no sense."""


class Unlikely(Doubt):
    """The words were hardly meant so: another reading says better what is wrong."""


def checked(reading: tuple[Name, ...], keyed: bool) -> tuple[Name, ...]:
    """A reading that makes sense: one time, one to three accelerations of one place, no direction twice.

    Parameters
    ----------
    reading : tuple of Name
    keyed : bool
        A word before a colon says that a direction follows.
    """
    other = next((i for i, one in enumerate(reading) if one.kind in ("velocity", "displacement")), None)
    parts = [one for one in reading if one.kind != "time"]
    if len(reading) - len(parts) > 1:
        raise Doubt("names two columns as times; name each column once")
    bare = [part for part in parts if not part.direction]
    if len({one.kind for one in bare}) < len(bare):
        raise Doubt(f"names {len(bare)} columns as {bare[0].kind} without a direction; say which is which, {EXAMPLE}")
    if bare and any(part.direction and part.kind == "acceleration" for part in parts):
        raise Unlikely(f"names some columns with a direction and one without; {EXAMPLE}")
    if other is not None:
        raise Doubt(
            f"names column {other + 1} as a {reading[other].kind}; only accelerations are read: take that column out, with "
            "its name"
        )
    if not parts:
        raise Doubt(f"names no column of acceleration; {EXAMPLE}")
    up = [part for part in parts if part.vertical]
    flat = [part for part in parts if not part.vertical]
    labels = [part.direction or "x" for part in parts]
    kinds = [one[0] if one in ("LONG", "TRAN") else one for one in labels]
    for label in kinds:
        if kinds.count(label) > 1:
            raise Doubt(f"is wrong: {kinds.count(label)} columns are named as {label}; name each column once")
    if len(up) > 1 or len(flat) > 2:
        raise Doubt(
            f"names {len(flat)} horizontal and {len(up)} vertical columns ({', '.join(labels)}), more than one place's two "
            "and one; take the others out"
        )
    families = {one.family for one in flat}
    if len(families) > 1:
        raise Doubt(f"names the directions {' and '.join(one.direction for one in flat)}, which do not belong together")
    if any(one.direction in ("U", "V") for one in up) and families == {"XY"} and not _measured(up[0]):
        raise Doubt(f"may mean a displacement or a velocity by {up[0].direction!r}; {EXAMPLE}")
    if "D" in labels:
        raise Doubt(f"may mean a displacement or down by 'D'; {EXAMPLE}")
    if len(parts) == 1 and len(labels[0]) == 1 and labels[0] not in "xXZ" and not (keyed or _measured(parts[0])):
        raise Doubt(f"may mean something else than a direction by {labels[0]!r}; {EXAMPLE}")
    if families == {"XY"} and not any(one.direction in ("", "X") for one in flat):
        raise Doubt("is not enough: no column holds the horizontal acceleration ax_…; name it ax_g or ax_m_s2")
    angles = [angle for one in flat if (angle := direction(one.direction)[0]) is not None]
    if len(angles) == 2 and not at_right_angles(*angles):
        raise Doubt(
            f"names the directions {' and '.join(one.direction for one in flat)}, which are not at right angles"
        )
    return reading


def _measured(name: Name) -> bool:
    return name.unit is not None and unit_kind(name.unit) == "acceleration"


def with_units(names: tuple[Name, ...], units: Sequence[str]) -> tuple[Name, ...]:
    """Names with the units of the line below them."""
    found = []
    for name, unit in zip(names, units):
        kind = unit_kind(unit)
        if len(names) != len(units) or name.unit not in (None, unit) or (kind == "time") != (name.kind == "time"):
            raise Doubt(f"does not go with the units below it ({', '.join(units)}); {EXAMPLE}")
        found.append(replace(name, unit=unit, kind=name.kind if kind == "acceleration" else kind))
    return tuple(found)
