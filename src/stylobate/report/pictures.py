"""Figures as pictures of a report: drawn when it is written, or taken from the folder as they are."""

from __future__ import annotations

import io
from pathlib import Path

from matplotlib.figure import Figure

from ..plots.style import DOTS_PER_INCH
from .page import Picture


def picture(figure: Figure, caption: str) -> Picture:
    """A figure as a picture of the page."""
    content = io.BytesIO()
    figure.savefig(content, format="png", dpi=DOTS_PER_INCH, facecolor="white", metadata={"Software": None})
    return Picture(content.getvalue(), caption, DOTS_PER_INCH)


def kept(pictures: dict[str, Path], name: str, caption: str) -> list[Picture]:
    """A picture of the folder, where it is there and as stylobate wrote it."""
    return [Picture(pictures[name], caption, DOTS_PER_INCH)] if name in pictures else []
