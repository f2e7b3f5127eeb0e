"""From a sentence about bad input to the field of the page that it is about."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from ..column.joint import Joint
from ..column.links import KINDS

#: Fields of a drum and of a drum as found; each has a row of its own on the page.
DRUM = ("height", "bottom_width", "top_width", "density", "depth", "top_depth")
FOUND = (
    *("offset_azimuth", "tilt_azimuth", "offset", "tilt", "turn"),
    *("chip_left", "chip_right", "chip_front", "chip_back", "chip_azimuth"),
)
JOINT = tuple(one.name for one in fields(Joint))
#: Fields of what is typed for a motion, from comma to comma.
PARTS = {"harmonic": ("frequency", "amplitude", "duration"), "pulse": ("shape", "frequency", "amplitude")}

_NUMBERED = {
    "drum": re.compile(r"\[\[drum\]\] number (\d+)"),
    "found": re.compile(r"\[\[as_found\.drum\]\] number (\d+)"),
    "override": re.compile(r"\[\[joint_override\]\] with index (\d+)|joint_override index (\d+)"),
    "listed": re.compile(r"\[\[joint_override\]\] number (\d+)"),
    "of": re.compile(r"of drum (\d+)\b|^drum (\d+)\b"),
    "joint": re.compile(r"\bjoint (\d+)\b"),
    "link": re.compile(r"\[\[link\]\] number (\d+)|\blink (\d+)\b"),
}

#: The field of a link that a sentence is about.
_LINK = re.compile(
    rf"\b(\w+) of a (?:{'|'.join(KINDS)})\b|'(\w+)' in \[\[link\]\]|has no (\w+);|has neither (\w+)|(kind) of a link"
    r"|there is no (joint)|: a \w+ (at) \[|: (joint)s is"
)


def column_field(sentence: str, table: Mapping[str, Any]) -> str | None:
    """The field that a sentence about a column file is about, such as ``drum.3.height``; None if it is about none.

    Parameters
    ----------
    sentence : str
    table : mapping
        What the sentence is about, as a column file holds it.
    """
    numbers = {kind: _number(pattern, sentence) for kind, pattern in _NUMBERED.items()}
    name = _named(sentence, (*FOUND, *DRUM, *JOINT, "base_tilt", "base_azimuth", "gravity", "section"))
    if numbers["link"] is not None:
        of = _LINK.search(sentence)
        return f"link.{numbers['link']}" + (f".{next(filter(None, of.groups()))}" if of else "")
    if name in FOUND:
        number = numbers["of"]
        if number is None and (place := numbers["found"] or numbers["drum"]) is not None:
            number = _index((table.get("as_found") or {}).get("drum"), place)
        return None if number is None else f"found.{number}.{name}"
    if name in JOINT:
        number = (
            numbers["override"]
            or _index(table.get("joint_override"), numbers["listed"])
            or (numbers["joint"] if name == "ring_width" else None)
        )
        overridden = {one.get("index") for one in table.get("joint_override") or []}
        return f"override.{number}.{name}" if number in overridden else f"joint.{name}"
    if name in DRUM:
        number = numbers["drum"] or numbers["of"]
        return f"drum.{number}.{name}" if number is not None else name
    if name is None and numbers["joint"] is not None and "offsets" in sentence:
        return f"found.{numbers['joint']}.offset"
    number = numbers["of"]
    return f"drum.{number}.height" if name is None and number is not None else name


def motion_field(sentence: str, kind: str = "", text: str = "") -> str | None:
    """The field that a sentence about a motion is about; None if it is about none.

    Parameters
    ----------
    sentence : str
    kind, text : str
        What was asked for, such as ``harmonic`` and ``1.0Hz,0.3g,10s``.
    """
    parts = dict(zip(text.split(","), PARTS.get(kind, ())))
    quoted = next((parts[one] for one in re.findall(r"'([^']*)' is", sentence) if one in parts), None)
    if quoted is not None:
        return quoted
    if "turning needs" in sentence:
        return "azimuth"
    option = re.search(r"--(unit|dt|azimuth|scale|pga|component|across)\b", sentence)
    words = "frequency|amplitude|duration|phase|unit|azimuth|component|pga|scale|step"
    found = option or re.search(rf"\b({words})\b", sentence.lower())
    return {"step": "dt"}.get(found[1], found[1]) if found else None


def domain_field(sentence: str) -> str | None:
    """The field that a sentence about the grid of a domain is about; None if it is about none."""
    names = {"cells": "fn", "frequenc": "f0", "amplitude": "a0", "acceleration": "a0", "Hz": "f0", "time": "duration"}
    return next((field for word, field in names.items() if word in sentence), None)


def _index(rows: Any, place: int | None) -> Any:
    """The index that a row of a list states; None where there is no such row."""
    return rows[place - 1].get("index") if place is not None and rows and place <= len(rows) else None


def _number(pattern: re.Pattern[str], sentence: str) -> int | None:
    found = pattern.search(sentence)
    return None if found is None else int(next(one for one in found.groups() if one is not None))


def _named(sentence: str, names: tuple[str, ...]) -> str | None:
    """The first of the names in a sentence."""
    places = {name: found.start() for name in names if (found := re.search(rf"\b{name}\b", sentence))}
    return min(places, key=places.__getitem__, default=None)
