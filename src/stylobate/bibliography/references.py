"""The bibliography file read: its entries by key, as BibTeX and as text."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import MappingProxyType

#: The one bibliography file.
FILE = Path(__file__).with_name("references.bib")

_ENTRY = re.compile(r"^@(?P<kind>\w+)\{(?P<key>\w+),\n(?P<fields>.*?)^\}$", re.MULTILINE | re.DOTALL)
_FIELD = re.compile(r"^  (\w+) = \{(.*)\},$", re.MULTILINE)


@dataclass(frozen=True)
class Reference:
    """One source.

    Parameters
    ----------
    key : str
        Its name in the bibliography, such as ``housner1963``.
    kind : str
        BibTeX's type of entry.
    fields : mapping of str to str
        As in the file.
    """

    key: str
    kind: str
    fields: Mapping[str, str]

    @property
    def authors(self) -> tuple[str, ...]:
        """Family name first; an institution as it is."""
        whole = self.fields["author"]
        return (whole[1:-1],) if whole.startswith("{") else tuple(whole.split(" and "))

    @property
    def year(self) -> int | None:
        """Of publication; None where it is not known."""
        return int(self.fields["year"]) if "year" in self.fields else None

    @property
    def cited(self) -> str:
        """Author and year, as in a text."""
        name = self.fields.get("shorttitle")
        if name is not None:
            return name if str(self.year) in name else f"{name} {self.year}"
        families = [author.split(",")[0] for author in self.authors]
        named = families[0] + (" et al." if len(families) > 2 else f" and {families[1]}" if len(families) > 1 else "")
        return f"{named} {self.year}" if self.year else named

    @property
    def bibtex(self) -> str:
        """The entry as in the file."""
        lines = [f"  {name} = {{{value}}},\n" for name, value in self.fields.items()]
        return f"@{self.kind}{{{self.key},\n{''.join(lines)}}}"

    @property
    def text(self) -> str:
        """The source in one line: authors (year). Title. Where it stands. DOI."""
        f = self.fields
        *first, last = self.authors
        authors = f"{', '.join(first)} and {last}" if first else last
        volume = f.get("volume", "") + (f"({f['number']})" if "journal" in f and "number" in f else "")
        where = " ".join(part for part in (f.get("journal"), volume) if part) if "journal" in f else ""
        book = f"In: {f['booktitle']}" if "booktitle" in f else ""
        editor = f"{f['editor']} (ed.)" if "editor" in f else ""
        place = f.get("publisher") or f.get("institution") or f.get("address") or ""
        number = f.get("number", "") if "journal" not in f else ""
        parts = (where, book, editor, f.get("howpublished", ""), place, f.get("type", ""), number, f.get("pages", ""))
        year = f" ({self.year})" if self.year else ""
        title = re.sub("[{}]", "", f["title"])  # braces keep capitals in BibTeX
        sentences = [f"{authors}{year}", title, ", ".join(part for part in parts if part), f.get("note", "")]
        doi = f" doi:{f['doi']}" if "doi" in f else ""
        return " ".join(f"{sentence.rstrip('.')}." for sentence in sentences if sentence).replace("--", "–") + doi

    def summary(self) -> dict:
        """Plain values for JSON."""
        return {"key": self.key, "type": self.kind, **self.fields, "text": self.text}


@cache
def bibliography() -> Mapping[str, Reference]:
    """All entries of the bibliography file, by key, in the order of the file."""
    return MappingProxyType({one.key: one for one in parse(FILE.read_text(encoding="utf-8"))})


def parse(text: str) -> list[Reference]:
    """Entries of a BibTeX text laid out as this package writes it: one field a line, the closing brace alone."""
    return [
        Reference(found["key"], found["kind"], MappingProxyType(dict(_FIELD.findall(found["fields"]))))
        for found in _ENTRY.finditer(text)
    ]
