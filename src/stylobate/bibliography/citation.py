"""Citations: the package, the sources of a model, and where a motion comes from."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..version import __version__

# The bibliography file read: its entries by key, as BibTeX and as text.

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
    return MappingProxyType({reference.key: reference for reference in parse(FILE.read_text(encoding="utf-8"))})


def parse(text: str) -> list[Reference]:
    """Entries of a BibTeX text laid out as this package writes it: one field a line, the closing brace alone."""
    return [
        Reference(match["key"], match["kind"], MappingProxyType(dict(_FIELD.findall(match["fields"]))))
        for match in _ENTRY.finditer(text)
    ]


#: The package itself; the release is its date of publication, so there is no year.
PACKAGE = Reference(
    "stylobate",
    "software",
    MappingProxyType(
        {
            "author": "{The stylobate developers}",
            "title": "stylobate: seismic response of freestanding ancient columns",
            "version": __version__,
            "note": f"Version {__version__}",
        }
    ),
)

#: Facts on the source in a motion's metadata, in the order of a citation.
_SOURCE = ("station", "station_name", "network", "event", "start_time", "reference", "comments", "terms", "file")


@dataclass(frozen=True)
class Citation:
    """Citations.

    Parameters
    ----------
    about : str
        What it is for, in words.
    references : tuple of Reference
        Sources of the model and of a simulated motion.
    motion : mapping of str to str
        What is known of where the motion comes from; empty where it is a formula, or unknown.
    unknown : tuple of str
        Keys that this version's bibliography does not have.
    """

    about: str
    references: tuple[Reference, ...] = ()
    motion: Mapping[str, str] = field(default_factory=dict)
    unknown: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """A few paragraphs for people."""
        lines = ["Please cite the package:", "", f"  {PACKAGE.text}"]
        if self.references:
            lines += ["", f"and what it rests on ({self.about}):", ""]
            lines += [f"  {reference.text}" for reference in self.references]
        if self.motion:
            lines += ["", "and the source of the ground motion:", ""]
            lines += [f"  {name.replace('_', ' ')}: {value}" for name, value in self.motion.items()]
        if self.unknown:
            lines += ["", f"Not in the bibliography of version {__version__}: {', '.join(self.unknown)}."]
        return "\n".join(lines)

    @property
    def bibtex(self) -> str:
        """The package and the sources as BibTeX."""
        return "\n\n".join(reference.bibtex for reference in (PACKAGE, *self.references))

    def summary(self) -> dict:
        """The JSON object of ``stylobate cite``."""
        return {
            "about": self.about,
            "version": __version__,
            "references": [reference.summary() for reference in (PACKAGE, *self.references)],
            "motion": dict(self.motion),
            "unknown": list(self.unknown),
            "text": self.text,
            "bibtex": self.bibtex,
        }


def cite(keys: Iterable[str] = (), about: str = "") -> Citation:
    """Citations for sources given by their keys."""
    known, wanted = bibliography(), list(dict.fromkeys(keys))
    return Citation(
        about,
        tuple(known[key] for key in wanted if key in known),
        unknown=tuple(key for key in wanted if key not in known),
    )


def cite_run(provenance: Mapping[str, Any]) -> Citation:
    """Citations for a result, from its provenance.

    Parameters
    ----------
    provenance : mapping
        Of a response, a domain or a probability of collapse: ``model`` and ``references``, and of the motion
        ``motion``, ``motion_metadata``.
    """
    metadata = dict(provenance.get("motion_metadata") or {})
    about = [f"{kind} {provenance[kind]}" for kind in ("model", "motion") if kind in provenance]
    citation = cite(provenance.get("references", ()), ", ".join(about))
    source = {key: str(metadata[key]) for key in _SOURCE if metadata.get(key) not in (None, "", "None")}
    if set(source) <= {"reference"}:  # a formula or a simulation: its sources are in the references
        source = {}
    elif set(source) == {"file"}:
        source["file"] += " (it names no source: say who recorded or computed it, and where you have it from)"
    return Citation(citation.about, citation.references, source, citation.unknown)
