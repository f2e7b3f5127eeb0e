"""Figures as pictures of a report: drawn when it is written, or taken from the folder as they are."""

from __future__ import annotations

import io
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.text import Text

from ..plots.style import DOTS_PER_INCH
from .language import SPOKEN
from .page import Picture


def picture(figure: Figure, caption: str) -> Picture:
    """A figure as a picture of the page, its texts in the language of the report."""
    english = False
    if (language := SPOKEN.get()) is not None and language.foreign:
        for text in figure.findobj(Text):
            assert isinstance(text, Text)
            text.set_text("\n".join(map(language.say, text.get_text().split("\n"))))
            english |= language.is_english(text.get_text(), 1)
    content = io.BytesIO()
    figure.savefig(content, format="png", dpi=DOTS_PER_INCH, facecolor="white", metadata={"Software": None})
    return Picture(content.getvalue(), caption, DOTS_PER_INCH, english)


def kept(pictures: dict[str, Path], name: str, caption: str) -> list[Picture]:
    """A picture of the folder, where it is there and as stylobate wrote it."""
    return [Picture(pictures[name], caption, DOTS_PER_INCH, english=True)] if name in pictures else []
