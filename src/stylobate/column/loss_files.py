"""Files of losses (TOML): what a calibration has found, read, written, and taken in place of a name."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, Literal

from ..atomic import replacing
from ..errors import InputError, suggest, within
from ..text_tables import printable
from .joint import NAMED, Losses
from .toml import Table, read_table

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
    found = read_table(path, LossFile)
    with within(printable(path)):
        if found.stylobate_losses != FORMAT:
            raise InputError(
                f"stylobate_losses is {found.stylobate_losses}, a format that this version does not know; it reads {FORMAT}."
            )
        return Losses(found.stiffness_damping, found.rolling_resistance or 0.0, found.law)


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
    for name, one in (("interval", interval), ("measured", measured)):
        table |= {name: dict(one)} if one else {}
    with replacing(path) as partial:
        partial.write_text(tomli_w.dumps(table), encoding="utf-8")
    return Path(path)
