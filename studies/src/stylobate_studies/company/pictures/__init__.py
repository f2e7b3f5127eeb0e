"""Pictures of columns in company."""

from .shares import draw_shares

__all__ = ["draw_shares"]
