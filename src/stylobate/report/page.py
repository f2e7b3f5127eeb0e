"""One self-contained HTML page: text, tables and figures, readable on a desk and on a phone, without any network."""

from __future__ import annotations

import base64
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from markupsafe import Markup, escape

from ..atomic import replacing


@dataclass(frozen=True)
class Picture:
    """A figure on the page.

    Parameters
    ----------
    file : path
        PNG; it is copied into the page.
    caption : str
    """

    file: Path
    caption: str


@dataclass(frozen=True)
class Rows:
    """A table on the page.

    Parameters
    ----------
    header : sequence of str
    body : sequence of sequence of str
        A line break in a cell starts a paragraph.
    caption : str
    mark : int, optional
        Column whose text is a verdict; its cells are marked by it.
    looks : mapping
        How a verdict is marked, ``good`` or ``bad``; others ``fair``.
    numbers : bool
        Numbers to compare: on a phone the table scrolls sideways, where others are folded, a card for each row.
    """

    header: Sequence[str]
    body: Sequence[Sequence[str]]
    caption: str = ""
    mark: int | None = None
    looks: Mapping[str, str] = field(default_factory=dict)
    numbers: bool = False


@dataclass(frozen=True)
class Points:
    """A list of short texts on the page."""

    texts: Sequence[str]


#: What a page is made of; a text is a paragraph.
Item = str | Picture | Rows | Points


@dataclass(frozen=True)
class Section:
    """A headed part of the page."""

    title: str
    items: Sequence[Item]


#: How a marked cell looks, and the sign before its text.
_SIGNS = {"good": "✓ ", "fair": "≈ ", "bad": "✗ ", "": ""}


def write_page(path: Path, title: str, lead: Sequence[Item], sections: Sequence[Section]) -> Path:
    """Write the page, whole or not at all.

    Parameters
    ----------
    path : path
        The HTML file.
    title : str
    lead : sequence of Item
        At the top.
    sections : sequence of Section
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    pages = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=StrictUndefined,
        keep_trailing_newline=True,
    )
    pages.filters |= {"prose": _prose, "base64": lambda file: base64.b64encode(file.read_bytes()).decode()}
    pages.globals |= {"zip": partial(zip, strict=True), "signs": _SIGNS}
    parts = [{"title": one.title, "entries": _kinds(one.items)} for one in sections]
    text = pages.get_template("page.html").render(title=title, lead=_kinds(lead), sections=parts)
    with replacing(path) as partial_file:
        partial_file.write_text(text, encoding="utf-8")
    return path


def _kinds(items: Sequence[Item]) -> list[dict[str, Any]]:
    names = {str: "text", Points: "points", Picture: "picture", Rows: "rows"}
    return [{"kind": names[type(one)], "value": one} for one in items]


def _prose(text: str) -> Markup:
    """Escaped; no line break between a number and its unit, and indices as such."""
    kept = re.sub(r"(?<=\d) (?=(?:%|g|Hz|m|mm|s|ms)(?!\w))", "\N{NO-BREAK SPACE}", str(escape(text)))
    return Markup(re.sub(r"\b([A-Za-z])_([A-Za-z])\b", r"\1<sub>\2</sub>", kept))
