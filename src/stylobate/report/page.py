"""One self-contained HTML page: text, tables and figures, readable on a desk and on a phone, without any network."""

from __future__ import annotations

import base64
import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

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
    numbers : bool
        Numbers to compare: on a phone the table scrolls sideways, where others are folded, a card for each row.
    """

    header: Sequence[str]
    body: Sequence[Sequence[str]]
    caption: str = ""
    mark: int | None = None
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


_SIGNS = {"holds": "✓", "holds under stated choices": "≈", "does not hold": "✗"}

_STYLE = """
:root { color-scheme: light; --ink: #1a1a1a; --line: #d8d2c4; --sand: #f6f1e6; --red: #8c1c13; }
* { box-sizing: border-box; }
body { margin: 0; font: 16px/1.55 system-ui, sans-serif; color: var(--ink); background: #fff; }
main { max-width: 62rem; margin: 0 auto; padding: 1rem 1.2rem 4rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 1.2rem 0 .4rem; }
h2 { font-size: 1.25rem; margin: 2.4rem 0 .6rem; padding-top: .6rem; border-top: 1px solid var(--line); }
nav { columns: 16rem; margin: 1.2rem 0; } nav a { display: block; padding: .15rem 0; }
li { margin: .3rem 0; }
a { color: #1d4f8a; }
figure { margin: 1.4rem 0; }
figure img { display: block; width: auto; max-width: 100%; height: auto; margin: 0 auto; }
.wide { overflow-x: auto; }
figcaption, caption { font-size: .9rem; color: #444; text-align: left; caption-side: top; padding: .3rem 0; }
table { border-collapse: collapse; width: 100%; font-size: .86rem; line-height: 1.4; margin: 1rem 0; }
th, td { text-align: left; vertical-align: top; padding: .4rem .5rem; border-bottom: 1px solid var(--line); }
th { background: var(--sand); }
td p { margin: 0 0 .5rem; } td p:last-child { margin: 0; }
table.numbers td { font-variant-numeric: tabular-nums; }
td.holds, td.choices, td.fails { font-weight: 600; }
td.choices { background: #fff5d6; } td.fails { background: #f8e0da; color: var(--red); }
@media (max-width: 46rem) {
  body { font-size: 15px; }
  main { padding: .5rem .8rem 3rem; }
  table.cards thead { display: none; }
  table.cards tr { display: block; border: 1px solid var(--line); margin: 0 0 .8rem; }
  table.cards td { display: block; border: 0; padding: .25rem .6rem; }
  table.cards td::before { content: attr(data-name); display: block; font-size: .72rem; color: #666; font-weight: 400; }
  table.cards td:empty { display: none; }
  table.numbers { font-size: .78rem; } table.numbers th, table.numbers td { padding: .3rem .35rem; }
  .wide img { width: 42rem; max-width: none; }
  .wide + figcaption::before { content: "↔ scrolls sideways. "; color: #666; }
}
@media print { nav { display: none; } h2 { break-after: avoid; } figure, tr { break-inside: avoid; } }
"""


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
    links = "".join(f'<a href="#s{i}">{escape(one.title)}</a> ' for i, one in enumerate(sections))
    body = [f"<h1>{escape(title)}</h1>", *map(_item, lead), f"<nav>{links}</nav>"]
    for i, section in enumerate(sections):
        body.append(f'<section id="s{i}"><h2>{escape(section.title)}</h2>')
        body += [_item(item) for item in section.items]
        body.append("</section>")
    text = (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{_STYLE}</style></head>\n<body><main>\n" + "\n".join(body)
    )
    with replacing(path) as partial:
        partial.write_text(text + "\n</main></body></html>\n", encoding="utf-8")
    return path


def _item(item: Item) -> str:
    if isinstance(item, str):
        return _paragraph(item)
    if isinstance(item, Points):
        return f"<ul>{''.join(f'<li>{_text(text)}</li>' for text in item.texts)}</ul>"
    if isinstance(item, Picture):
        data = base64.b64encode(item.file.read_bytes()).decode()
        image = f'<img alt="{escape(item.caption)}" src="data:image/png;base64,{data}">'
        return f'<figure><div class="wide">{image}</div><figcaption>{_text(item.caption)}</figcaption></figure>'
    return _table(item)


def _paragraph(text: str) -> str:
    return f"<p>{_text(text)}</p>"


def _text(text: str) -> str:
    """Escaped; no line break between a number and its unit, and indices as such."""
    kept = re.sub(r"(?<=\d) (?=(?:%|g|Hz|m|mm|s|ms)(?!\w))", "\N{NO-BREAK SPACE}", escape(text))
    return re.sub(r"\b([A-Za-z])_([A-Za-z])\b", r"\1<sub>\2</sub>", kept)


def _table(rows: Rows) -> str:
    head = "".join(f"<th>{escape(name)}</th>" for name in rows.header)
    lines = []
    for row in rows.body:
        cells = []
        for k, (name, value) in enumerate(zip(rows.header, row, strict=True)):
            mark = ""
            if k == rows.mark:
                mark = {"holds": "holds", "does not hold": "fails"}.get(value, "choices")
                value = f"{_SIGNS.get(value, '')} {value}".strip()
            text = "".join(map(_paragraph, value.split("\n"))) if "\n" in value else _text(value)
            cells.append(f'<td class="{mark}" data-name="{escape(name)}">{text}</td>')
        lines.append(f"<tr>{''.join(cells)}</tr>")
    caption = f"<caption>{_text(rows.caption)}</caption>" if rows.caption else ""
    inside = f"{caption}<thead><tr>{head}</tr></thead><tbody>{''.join(lines)}</tbody></table>"
    return (
        f'<div class="wide"><table class="numbers">{inside}</div>' if rows.numbers else f'<table class="cards">{inside}'
    )
