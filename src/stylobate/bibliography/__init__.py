"""Sources: the bibliography, and citations for a run or a model."""

from .citation import Citation, cite, cite_run
from .references import Reference, bibliography

__all__ = ["Citation", "Reference", "bibliography", "cite", "cite_run"]
