"""Sources: the bibliography, and citations for a run or a model."""

from .citation import Citation, Reference, bibliography, cite, cite_run

__all__ = ["Citation", "Reference", "bibliography", "cite", "cite_run"]
