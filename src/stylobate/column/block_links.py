"""The name under which scripts know :func:`stylobate.column.links.block_link`."""

from .links import block_link

__all__ = ["block_link"]
