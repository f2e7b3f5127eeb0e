"""Figures as pictures of a report: drawn when it is written, or taken from the folder as they are."""

from __future__ import annotations

import io
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.text import Text

from stylobate.plots.style import DOTS_PER_INCH

from .language import SPOKEN, WORD, Language
from .page import Picture


def picture(figure: Figure, caption: str) -> Picture:
    """A figure as a picture of the page, its texts and numbers in the language of the report."""
    if (language := SPOKEN.get()) is not None and language.foreign:
        for text in figure.findobj(Text):
            assert isinstance(text, Text)
            text.set_text(language.say(text.get_text()))
        axes: list[Any] = figure.findobj(Axis)
        for ticks in {
            id(formatter): formatter for axis in axes for formatter in [axis.get_major_formatter()]
        }.values():  # some are shared
            ticks.format_ticks = partial(_ticks, language, ticks.format_ticks)
    content = io.BytesIO()
    figure.savefig(content, format="png", dpi=DOTS_PER_INCH, facecolor="white", metadata={"Software": None})
    return Picture(content.getvalue(), caption, DOTS_PER_INCH)


def _ticks(language: Language, made: Callable[[Any], list[str]], places: Any) -> list[str]:
    """Numbers of an axis, as readers of a language write them, and names along it."""
    return [language.say(label) if WORD.search(label) else language.numbers(label) for label in made(places)]


def kept(pictures: dict[str, Path], name: str, caption: str) -> list[Picture]:
    """A picture of the folder, where it is there and as stylobate wrote it."""
    return [Picture(pictures[name], caption, DOTS_PER_INCH, english=True)] if name in pictures else []
