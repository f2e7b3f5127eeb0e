"""What it rests on: the bibliography, and what to cite for a run or a model."""

from .citation import Citation, cite, cite_run
from .references import Reference, bibliography

__all__ = ["Citation", "Reference", "bibliography", "cite", "cite_run"]
