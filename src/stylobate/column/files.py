"""Column files (TOML): read, written, and found by the name of a preset or a path."""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, Literal

from ..atomic import replacing
from ..errors import InputError, suggest, within
from ..text_tables import printable
from .as_found import AsFound, FoundDrum
from .catalogue import PRESETS, preset
from .column import Column
from .drum import Drum
from .joint import NAMED, Joint, Losses, stated_fields
from .links import link_from_dict
from .toml import Table, read_table, toml_text


def load_column(text: str | Path) -> Column:
    """The column preset of that name, or the column in the file of that path.

    Raises
    ------
    InputError
        There is neither, or the file cannot be used.
    """
    name = str(text)
    if name in PRESETS:
        return preset(name)
    if Path(name).exists() or name.endswith(".toml"):
        return read_column(name)
    raise InputError(
        f"there is no column preset or file {name!r}; {suggest(name, PRESETS)}presets are {', '.join(PRESETS)}; a "
        "column file is TOML."
    )


def read_column(path: str | Path) -> Column:
    """Read a column file.

    Raises
    ------
    InputError
        The file cannot be read or does not describe a column; the message names the file, the key and the remedy.
    """
    return Column.from_toml(path)


def write_column(column: Column, path: str | Path) -> Path:
    """Write a column file, drum by drum, that :func:`read_column` reads back as an equal column."""
    target = Path(path)
    with replacing(target) as partial:
        partial.write_text(toml_text(tables_of(column)), encoding="utf-8")
    return target


def tables_of(column: Column) -> dict[str, Any]:
    """Contents of a column file of this column, drum by drum, as TOML gives it."""
    first = column.drums[0]
    common = Counter(column.joints).most_common(1)[0][0]
    sizes = ("height", "bottom_width", "top_width", "density")
    table: dict[str, Any] = {"name": column.name, "section": first.section, "gravity": column.gravity}
    table |= {key: value for key in ("material", "north") if (value := getattr(column, key)) is not None}
    table["drum"] = [{key: getattr(drum, key) for key in (*sizes, *_depths(drum))} for drum in column.drums]
    table["joint"] = _joint_fields(common)
    others = [{"index": i, **_joint_fields(joint)} for i, joint in enumerate(column.joints, 1) if joint != common]
    if others:
        table["joint_override"] = others
    if column.as_found:
        table["as_found"] = _as_found_fields(column.as_found)
    if column.links:
        table["link"] = [link.to_dict() for link in column.links]
    return table


def _depths(drum: Drum) -> tuple[str, ...]:
    if drum.circular:
        return ()
    return ("depth",) if drum.top_depth is None else ("depth", "top_depth")


def column_from_dict(data: Mapping[str, Any]) -> Column:
    """The column that :meth:`Column.to_dict` described."""
    drums = tuple(Drum(**fields) for fields in data["drums"])
    joints = tuple(Joint(**fields) for fields in data["joints"])
    state = data.get("as_found", {"drums": (), "base_tilt": 0.0})
    as_found = AsFound(
        tuple(FoundDrum(**drum) for drum in state["drums"]), state["base_tilt"], state.get("base_azimuth", 0.0)
    )
    links = tuple(link_from_dict(fields) for fields in data.get("links", ()))
    who = {"name": data["name"], "gravity": data["gravity"]} | {key: data.get(key) for key in ("material", "north")}
    who["losses"] = Losses(**data["losses"]) if "losses" in data else None
    return Column.of_fields(drums=drums, joints=joints, as_found=as_found, links=links, **who)


def _joint_fields(joint: Joint) -> dict[str, float]:
    """Joint of a file: the form of its friction from which the other follows to the last bit."""
    fields = stated_fields(joint)
    without = {key: value for key, value in fields.items() if key != "friction_coefficient"}
    drop = "friction_coefficient" if Joint(**without) == joint else "friction_angle"
    return {key: value for key, value in fields.items() if key != drop}


def _as_found_fields(as_found: AsFound) -> dict[str, Any]:
    table: dict[str, Any] = {"base_tilt": as_found.base_tilt}
    if as_found.base_azimuth:
        table["base_azimuth"] = as_found.base_azimuth
    if as_found.drums:
        table["drum"] = [
            {"index": drum.drum}
            | {key: value for key, value in dataclasses.asdict(drum).items() if key != "drum" and value != 0.0}
            for drum in as_found.drums
        ]
    return table


# Files of losses (TOML): what a calibration has found, read, written, and taken in place of a name.

#: Number of the format that is written, and read.
FORMAT = 1


class IntervalTable(Table):
    """``[interval]``: between which values a loss lies with a confidence."""

    confidence: float
    stiffness_damping: list[float] | None = None
    rolling_resistance: list[float] | None = None


class LossFile(Table):
    """A file of losses."""

    called: ClassVar[str | None] = ""

    stylobate_losses: int
    stiffness_damping: float
    rolling_resistance: float | None = None
    law: Literal["rim", "bed"] | None = None
    interval: IntervalTable | None = None
    measured: dict[str, Any] | None = None


def losses_by(text: str) -> str | Losses:
    """Losses by their name, or those of the file of that path.

    Raises
    ------
    InputError
        There is neither, or the file cannot be used.
    """
    if text in NAMED:
        return text
    if text.endswith(".toml") or Path(text).is_file():
        return read_losses(text)
    raise InputError(
        f"losses is {text!r}; {suggest(text, NAMED)}allowed is {', '.join(NAMED)}, or a file of losses (TOML) as "
        "stylobate calibrate writes it.",
        "losses",
    )


def read_losses(path: str | Path) -> Losses:
    """Losses of a file, as ``stylobate calibrate`` writes it.

    Raises
    ------
    InputError
        The file cannot be read, or is no file of losses.
    """
    table = read_table(path, LossFile)
    with within(printable(path)):
        if table.stylobate_losses != FORMAT:
            raise InputError(
                f"stylobate_losses is {table.stylobate_losses}, a format that this version does not know; it reads {FORMAT}."
            )
        return Losses(table.stiffness_damping, table.rolling_resistance or 0.0, table.law)


def write_losses(
    losses: Losses,
    path: str | Path,
    interval: Mapping[str, Any] | None = None,
    measured: Mapping[str, Any] | None = None,
) -> Path:
    """Write a file of losses that :func:`read_losses` reads back as equal losses.

    Parameters
    ----------
    losses : Losses
    path : path
    interval : mapping, optional
        ``confidence`` and limits by the names of losses.
    measured : mapping, optional
        From what they come: plain values, told to people and not read.
    """
    import tomli_w

    table: dict[str, Any] = {"stylobate_losses": FORMAT, "stiffness_damping": losses.stiffness_damping}
    table |= {"rolling_resistance": losses.rolling_resistance} if losses.rolling_resistance else {}
    table |= {"law": losses.law} if losses.law is not None else {}
    for name, content in (("interval", interval), ("measured", measured)):
        table |= {name: dict(content)} if content else {}
    with replacing(path) as partial:
        partial.write_text(tomli_w.dumps(table), encoding="utf-8")
    return Path(path)
