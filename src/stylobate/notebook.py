"""What a notebook shows of a value: a title, a sentence, a table, a silhouette, as HTML without scripts or network."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

#: Height of a silhouette [px].
HEIGHT = 180

#: Most rows of a table.
ROWS = 40


class NotebookSummary:
    """Results with a ``summary()``, and a ``sentence`` where they have one, as a notebook shows them."""

    def summary(self) -> dict[str, Any]:
        """Plain values by name."""
        raise NotImplementedError

    def __init_subclass__(cls) -> None:
        cls.__repr__ = NotebookSummary.__repr__  # a dataclass would write its arrays out

    def __repr__(self) -> str:
        sentence = getattr(self, "sentence", "") or ", ".join(
            f"{key} {_words(value)}" for key, value in self._facts().items()
        )
        return f"<{type(self).__name__}: {sentence}>"

    def _repr_html_(self) -> str:
        return page(type(self).__name__, str(getattr(self, "sentence", "")), self._facts())

    def _facts(self) -> dict[str, Any]:
        return _plain({key: value for key, value in self.summary().items() if key != "sentence"})


def page(title: str, sentence: str, facts: Mapping[str, Any], picture: str = "") -> str:
    """A title, a sentence, a picture, and a table of what is a single value.

    Parameters
    ----------
    title, sentence : str
    facts : dict
        Lists and tables in it are left out.
    picture : str
        SVG.
    """
    rows = "".join(
        f"<tr><td>{html.escape(str(key))}</td><td>{html.escape(_words(value))}</td></tr>"
        for key, value in _plain(facts).items()
    )
    paragraph = f"<p>{html.escape(sentence)}</p>" if sentence else ""
    return f"<p><b>{html.escape(title)}</b></p>{paragraph}{picture}<table>{rows}</table>"


def _plain(facts: Mapping[str, Any]) -> dict[str, Any]:
    plain = [fact for fact in facts.items() if not (fact[1] is None or isinstance(fact[1], (list, tuple, dict)))]
    return dict(plain[:ROWS])


def _words(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def silhouettes(panels: Sequence[Sequence[tuple[np.ndarray, bool]]], labels: Sequence[str], far: float = 0.0) -> str:
    """Outlines of bodies beside one another, in one scale, as SVG.

    Parameters
    ----------
    panels : sequence of sequence of (array, bool)
        Of every picture the outlines, horizontally and upward [m], shape (k, 2), and whether each is fixed.
    labels : sequence of str
        Under each picture.
    far : float
        How far from the first picture a body is drawn at most [m].
    """
    moving = [[shape for shape, fixed in panel if not fixed] for panel in panels]
    first = np.concatenate(moving[0])
    low, high = first.min(axis=0) - far, first.max(axis=0) + far
    corners = [np.clip(np.nan_to_num(np.concatenate(panel), nan=0.0), low, high) for panel in moving]
    top = max(float(corner[:, 1].max()) for corner in corners)
    bottom = min(float(corner[:, 1].min()) for corner in corners)
    gap = 0.15 * (top - bottom)
    parts, place = [], gap
    for corner, panel, label in zip(corners, panels, labels, strict=True):
        left, right = float(corner[:, 0].min()), float(corner[:, 0].max())
        for shape, fixed in panel:
            if not np.isfinite(shape).all():
                continue
            seen = np.clip(shape, [left - gap, bottom - gap], [right + gap, top + gap])
            points = " ".join(f"{place + x - left:.4g},{top - z:.4g}" for x, z in seen)
            parts.append(f'<polygon points="{points}" fill="{"#dcdcdc" if fixed else "#efe6d2"}"/>')
        middle, size = place + 0.5 * (right - left), 0.5 * gap
        place_of = f'x="{middle:.4g}" y="{top - bottom + 1.2 * gap:.4g}" font-size="{size:.3g}"'
        parts.append(f'<text {place_of} text-anchor="middle" stroke="none">{html.escape(label)}</text>')
        place += max(right - left, 2.0 * gap) + gap
    line = f'stroke="#8c6d3f" stroke-width="{0.01 * (top - bottom):.3g}"'
    return _svg(place, top - bottom + 2.6 * gap, -gap, line, "".join(parts))


def history(values: np.ndarray, label: str) -> str:
    """A history as a line that fills its picture, as SVG; the largest of each 600th part of it is kept.

    Parameters
    ----------
    values : array
        Shape (n,).
    label : str
        Above it.
    """
    pieces = np.array_split(values, min(600, len(values)))
    ends = np.array([(piece.min(), piece.max()) for piece in pieces]).ravel()
    peak = float(np.abs(values).max()) or 1.0
    points = " ".join(f"{0.5 * k:g},{-80.0 * y / peak:.4g}" for k, y in enumerate(ends))
    title = f'<text x="0" y="-88" font-size="14" stroke="none">{html.escape(label)}</text>'
    line = f'<polyline points="{points}" fill="none"/>{title}'
    return _svg(0.5 * len(ends), 190.0, -105.0, 'stroke="#1f77b4" stroke-width="1"', line)


def _svg(width: float, height: float, top: float, style: str, inside: str) -> str:
    view = f"0 {top:.4g} {width:.4g} {height:.4g}"
    return f'<svg height="{HEIGHT}" viewBox="{view}" {style} style="max-width:100%">{inside}</svg>'
