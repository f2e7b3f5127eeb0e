"""The one style of all pictures: legible in print, in grey, and to the colour-blind."""

from __future__ import annotations

import inspect
import re
import textwrap
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

import matplotlib
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure, SubFigure
from matplotlib.patheffects import AbstractPathEffect, Normal, Stroke
from matplotlib.text import Text

from ..atomic import replacing
from ..errors import check_all, check_choice, check_kind
from ..messages import digits

P = ParamSpec("P")
FigureOrFigures = TypeVar("FigureOrFigures", Figure, tuple[Figure, ...])

#: Width of a picture across the text of a page [inch].
WIDTH = 7.0

#: Longest text in a picture [characters].
LONGEST_TEXT = 140

#: Resolution of the PNG files.
DOTS_PER_INCH = 200

RED = "#b2182b"  # the base, as the paper draws it; collapse
BLACK = "#1a1a1a"  # the top
BLUE = "#2166ac"
GREY = "#767676"
SAND = "#efe6d2"  # stone; what stands
BROWN = "#8c6d3f"

#: Curves of several models or terms: dark to light in grey as well, each with its own dashes.
CYCLE: tuple[dict[str, Any], ...] = (
    {"color": BLACK, "linestyle": "-"},
    {"color": RED, "linestyle": "--"},
    {"color": BLUE, "linestyle": "-."},
    {"color": "#e08214", "linestyle": (0, (1.2, 1.2))},
    {"color": "#5aae61", "linestyle": (0, (6, 1.5, 1, 1.5, 1, 1.5))},
    {"color": GREY, "linestyle": (0, (8, 2))},
)

#: A white edge around a line, which lifts it off dark cells.
HALO: list[AbstractPathEffect] = [Stroke(linewidth=2.6, foreground="white"), Normal()]

_STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.1,
    "hatch.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "svg.fonttype": "none",
    "svg.hashsalt": "stylobate",
    "figure.constrained_layout.use": True,
}


#: Endings of pictures, and what keeps the day on which they were made out of them.
UNDATED: dict[str, Any] = {".png": None, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}


def styled(draw: Callable[P, FigureOrFigures]) -> Callable[P, FigureOrFigures]:
    """Draw in the style of this package, whatever the settings around it; titles and legends are plain text.

    What is drawn is checked first, where it is declared as an object of a class, or as several of one.
    """
    drawn = next(iter(inspect.signature(draw).parameters.values()), None)
    declared = drawn and re.fullmatch(r"(\w+)|(?:(\w+) \| )?Sequence\[(\w+)\]", str(drawn.annotation))
    alone, _, several = declared.groups() if declared else (None, None, None)
    kind = getattr(draw, "__globals__", {}).get(alone or several)

    @wraps(draw)
    def wrapped(*args: P.args, **kwargs: P.kwargs) -> FigureOrFigures:
        if drawn and isinstance(kind, type) and kind is not Any and (args or drawn.name in kwargs):
            given: Any = args[0] if args else kwargs[drawn.name]
            (check_kind if alone else check_all)(drawn.name, given, kind)
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(_STYLE)
            made = draw(*args, **kwargs)
            ax = kwargs.get("ax")  # the other axes of its figure are left alone
            for figure in (ax,) if isinstance(ax, Axes) else made if isinstance(made, tuple) else (made,):
                _make_plain(figure)
            return made

    return wrapped


def save(figure: Figure, stem: str | Path) -> list[Path]:
    """Write ``stem.png`` and ``stem.svg``; each appears whole or not at all.

    Parameters
    ----------
    figure : Figure
    stem : path
        One that ends in ``.png``, ``.svg`` or ``.pdf`` is the one file that is written.

    Returns
    -------
    list of Path
        The files.
    """
    if Path(stem).suffix.lower() in UNDATED:
        return save_as(figure, Path(stem))
    return save_as(figure, Path(f"{stem}.png"), Path(f"{stem}.svg"))


def save_as(figure: Figure, *files: Path) -> list[Path]:
    """Write files of the kinds that their names end in, ``.png``, ``.svg`` or ``.pdf``; as :func:`save`."""
    for file in files:
        check_choice("the ending of a picture", file.suffix.lower(), UNDATED)
    with _settled(figure):
        for file in files:
            kind = file.suffix.lower()
            dots = DOTS_PER_INCH if kind == ".png" else "figure"
            with replacing(file) as partial:  # same picture, same bytes
                figure.savefig(partial, format=kind[1:], dpi=dots, facecolor="white", metadata=UNDATED[kind])
    return list(files)


def save_sheets(figures: Sequence[Figure], file: Path) -> list[Path]:
    """Write figures as the pages of one file that ends in ``.pdf``, each of its own size; as :func:`save`."""
    from matplotlib.backends.backend_pdf import PdfPages

    check_choice("the ending of a file of several sheets", file.suffix.lower(), (".pdf",))
    with replacing(file) as partial, PdfPages(partial, metadata=UNDATED[".pdf"]) as pages:
        for figure in figures:
            with _settled(figure):
                pages.savefig(figure, facecolor="white")
    return [file]


@contextmanager
def _settled(figure: Figure) -> Iterator[None]:
    """The layout of a figure is settled once, for all files, at the resolution of the PNG file.

    Letters are wider at some resolutions than at others, and what fits at another one may be cut off in the file.
    """
    layout, dots = figure.get_layout_engine(), figure.dpi
    settled: dict[Any, Any] = {"figure.constrained_layout.use": False}
    with matplotlib.rc_context(_STYLE | settled):
        figure.set_dpi(DOTS_PER_INCH)
        figure.draw_without_rendering()
        figure.set_layout_engine(None)
        figure.set_dpi(dots)
        try:
            yield
        finally:
            figure.set_layout_engine(layout)


def page(given: Figure | SubFigure | None, size: tuple[float, float]) -> Figure:
    """The figure, or part of one, that a picture is asked to be drawn in; a new one of that size [inch] by default."""
    return Figure(figsize=size) if given is None else cast(Figure, given)


def panel(given: Axes | None, size: tuple[float, float]) -> tuple[Figure, Axes]:
    """The axes that a picture is asked to be drawn in and their figure; those of a new figure of that size by default."""
    if given is not None:
        return cast(Figure, given.figure), given
    figure = Figure(figsize=size)
    return figure, figure.subplots()


def only_panel(ax: Axes | None, figure: Figure | SubFigure | None, size: tuple[float, float]) -> tuple[Figure, Axes]:
    """As :func:`panel`, for pictures that may be given a figure, or part of one, instead of axes."""
    if ax is not None:
        return panel(ax, size)
    given = page(figure, size)
    return given, given.subplots()


def in_lines(title: str) -> str:
    """A title in as many lines as the width of a page needs."""
    return textwrap.fill(title, 82)


def legend_below(axes: Axes, own: bool, **options: Any) -> None:
    """The legend under a picture; inside its axes where they stand in a figure that is not its own."""
    if own:
        cast(Figure, axes.figure).legend(loc="outside lower center", **options)
    else:
        axes.legend(**options | {"ncols": 1})


def plain(text: object) -> str:
    """A text with names by other people as a picture can show it: no mathematics after a dollar, no control characters."""
    shown = "".join(
        character if character.isprintable() or character == "\n" else "\N{REPLACEMENT CHARACTER}"
        for character in str(text)
    )
    shown = shown if len(shown) <= LONGEST_TEXT else shown[: LONGEST_TEXT - 1] + "…"
    return shown.replace(r"\$", "$").replace("$", r"\$")


def _make_plain(drawn: Artist) -> None:
    ticks = {
        text for axis in drawn.findobj(Axis) for text in axis.findobj(Text)
    }  # their formatters write mathematics, which stays
    for text in drawn.findobj(Text):
        if text not in ticks and text.get_text() != plain(text.get_text()):
            text.set_text(plain(text.get_text()))


def zero_line(axes: Axes) -> None:
    """A thin line at zero."""
    axes.axhline(0.0, color=GREY, linewidth=0.6, zorder=0)


def signed(value: float, form: str) -> str:
    """A number with its sign, the true minus."""
    return ("−" if value < 0.0 else "+") + digits(abs(value), form)
