"""Self-contained HTML pages of text, tables and figures, rendered by templates with everything escaped, and their print."""

from __future__ import annotations

import base64
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from markupsafe import Markup, escape

from stylobate.atomic import replacing
from stylobate.errors import StylobateError

if TYPE_CHECKING:
    from jinja2 import Environment


class Exact(str):
    """Words that are nobody's to translate: of the project file, names of files, what is cited."""

    __slots__ = ()


@dataclass(frozen=True)
class Picture:
    """A figure on the page.

    Parameters
    ----------
    file : path or bytes
        PNG; it is copied into the page.
    caption : str
    dots_per_inch : int
        Resolution of the PNG, from which its width on paper follows; 0 for as wide as it is on a screen.
    english : bool
        Whether a text in it is English in a report of another language.
    """

    file: Path | bytes
    caption: str
    dots_per_inch: int = 0
    english: bool = False

    @property
    def content(self) -> bytes:
        """The PNG."""
        return self.file if isinstance(self.file, bytes) else self.file.read_bytes()

    @property
    def width(self) -> int:
        """Width on paper, in the 96 parts of an inch of HTML; 0 where it does not matter."""
        if not self.dots_per_inch:
            return 0
        return round(96 * int.from_bytes(self.content[16:20], "big") / self.dots_per_inch)  # the PNG's own width


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


@dataclass(frozen=True)
class Facts:
    """Names and values, a line for each."""

    pairs: Sequence[tuple[str, str]]
    caption: str = ""


@dataclass(frozen=True)
class Note:
    """Paragraphs that stand out: a verdict, a warning.

    Parameters
    ----------
    texts : sequence of str
    look : str
        ``verdict``, ``fair`` (a warning), ``bad``; several in one text. Plain if left out.
    first : int
        How many of the texts of a verdict stand on the first page of a report of several results as well.
    """

    texts: Sequence[str]
    look: str = ""
    first: int = 1


@dataclass(frozen=True)
class Code:
    """Typed text."""

    text: str


#: Parts of a page; a text is a paragraph.
Item = str | Picture | Rows | Points | Facts | Note | Code


@dataclass(frozen=True)
class Section:
    """A headed part of the page."""

    title: str
    items: Sequence[Item]


#: Style of a marked cell, and the sign before its text.
_SIGNS = {"good": "✓ ", "fair": "! ", "bad": "✗ ", "": ""}

_KINDS = {
    Points: "points",
    Picture: "picture",
    Rows: "rows",
    Facts: "facts",
    Note: "note",
    Code: "code",
}


def write_html(path: Path, template: Path, **values: Any) -> Path:
    """Render a template, which may include those of this room, and write the page, whole or not at all."""
    text = _pages(template.parent).get_template(template.name).render(**values)
    with replacing(path) as partial_file:
        # what is no text (bytes of a file's name) is shown as such
        partial_file.write_bytes(text.encode("utf-8", "backslashreplace"))
    return path


def part(section: Section) -> dict[str, Any]:
    """A section as the templates take it."""
    return {"title": section.title, "entries": kinds(section.items)}


def kinds(items: Sequence[Item]) -> list[dict[str, Any]]:
    """Items as the templates take them, each with its kind."""
    return [{"kind": "text" if isinstance(item, str) else _KINDS[type(item)], "value": item} for item in items]


def _pages(folder: Path) -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    pages = Environment(
        loader=FileSystemLoader([folder, Path(__file__).parent]),
        autoescape=True,
        undefined=StrictUndefined,
        keep_trailing_newline=True,
    )
    pages.filters |= {"prose": _prose, "base64": lambda content: base64.b64encode(content).decode()}
    pages.globals |= {"zip": partial(zip, strict=True), "signs": _SIGNS}
    return pages


def _prose(text: str) -> Markup:
    """Escaped; no line break between a number and its unit, and indices as such."""
    kept = re.sub(r"(?<=\d) (?=(?:%|g|Hz|m|mm|s|ms|kg|t|rad|kN)(?!\w))", "\N{NO-BREAK SPACE}", str(escape(text)))
    return Markup(re.sub(r"\b([A-Za-z])_([A-Za-z])\b", r"\1<sub>\2</sub>", kept))


# Prints a page to PDF with a Chromium that is found on this machine.

#: Names under which a Chromium is looked for, the first that is found.
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge")

#: Longest time that printing may take [s].
PATIENCE = 120.0


def find_browser() -> str | None:
    """Path of a Chromium; None where there is none."""
    return next((path for name in BROWSERS if (path := shutil.which(name))), None)


def needs_browser() -> str:
    """Path of a Chromium.

    Raises
    ------
    StylobateError
        There is none.
    """
    browser = find_browser()
    if browser is None:
        raise StylobateError(
            f"no Chromium is found to print with (looked for {', '.join(BROWSERS[:3])}); install one, or open the HTML file "
            "in any browser and print it from there."
        )
    return browser


def print_pdf(page: Path, target: Path) -> Path:
    """Print a page of this package; the PDF appears whole or not at all.

    Notes
    -----
    Chromium refuses its sandbox to root. As root it is run without: what it is given is a page that this package has just
    written, in which all text is escaped and whose own policy allows no script and no request, and names of other machines
    lead nowhere: nothing strange reaches the browser. As anybody else the sandbox stays on.

    Raises
    ------
    StylobateError
        There is no Chromium, or it fails.
    """
    browser = needs_browser()
    with tempfile.TemporaryDirectory(prefix="stylobate-print-") as place, replacing(target) as partial:
        printed = Path(place) / "page.pdf"
        command = [
            browser,
            "--headless=new",
            *(["--no-sandbox"] if is_root() else []),
            "--disable-gpu",
            "--disable-extensions",
            "--disable-dev-shm-usage",
            "--no-first-run",
            "--host-resolver-rules=MAP * ~NOTFOUND",
            f"--user-data-dir={place}/profile",
            "--no-pdf-header-footer",
            f"--print-to-pdf={printed}",
            page.resolve().as_uri(),
        ]
        try:
            done = subprocess.run(command, capture_output=True, timeout=PATIENCE, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            raise StylobateError(
                f"{browser} did not print {page} in {PATIENCE:.0f} s; open the HTML file in a browser and print it there."
            ) from None
        if done.returncode or not printed.is_file() or printed.read_bytes()[:5] != b"%PDF-":
            lines = done.stderr.decode("utf-8", "replace").strip().splitlines()
            why = lines[-1][:200] if lines else f"it ended with code {done.returncode}"
            raise StylobateError(
                f"{browser} could not print {page}: {why}; open the HTML file in a browser and print it from there."
            )
        shutil.copyfile(printed, partial)
    return target


def is_root() -> bool:
    """Whether this process is root's, to which Chromium refuses its sandbox."""
    return hasattr(os, "geteuid") and os.geteuid() == 0
