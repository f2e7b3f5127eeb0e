"""Citations: the package, the sources of a model, and where a motion comes from."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from ..version import __version__
from .references import Reference, bibliography

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
        return "\n\n".join(one.bibtex for one in (PACKAGE, *self.references))

    def summary(self) -> dict:
        """The JSON object of ``stylobate cite``."""
        return {
            "about": self.about,
            "version": __version__,
            "references": [one.summary() for one in (PACKAGE, *self.references)],
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
    found = cite(provenance.get("references", ()), ", ".join(about))
    source = {key: str(metadata[key]) for key in _SOURCE if metadata.get(key) not in (None, "", "None")}
    if set(source) <= {"reference"}:  # a formula or a simulation: its sources are in the references
        source = {}
    elif set(source) == {"file"}:
        source["file"] += " (it names no source: say who recorded or computed it, and where you have it from)"
    return Citation(found.about, found.references, source, found.unknown)
