"""A response as a notebook shows it: the sentence, the measures, and a strip of what stood."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any

import numpy as np

from .instants import ASIDE, size_of, telling_states
from .summary import summary_of
from .words import sentence_of, title_of

if TYPE_CHECKING:
    from .recorded import Recorded

#: Height of the strip [px].
HEIGHT = 180

_LEFT_OUT = ("outcome", "reason", "wall_s", "model", "version", "mechanism", "collapse")


def as_html(response: Recorded) -> str:
    """HTML without scripts and without anything from the network."""
    facts = {key: value for key, value in summary_of(response).items() if key not in _LEFT_OUT and _plain(value)}
    rows = "".join(
        f"<tr><td>{html.escape(key)}</td><td>{html.escape(_number_words(value))}</td></tr>"
        for key, value in facts.items()
    )
    return (
        f"<p><b>{html.escape(title_of(response))}</b></p><p>{html.escape(sentence_of(response))}</p>"
        f"{_strip(response)}<table>{rows}</table>"
    )


def _strip(response: Recorded) -> str:
    """The telling states beside one another, in one scale, as a picture."""
    shown, bodies = response.bodies.shown, response.bodies
    states = telling_states(response)
    panels = [[response.outline(k, i) for i in shown] for k in states]
    moving = [n for n, i in enumerate(shown) if not bodies.fixed[i]]
    first, far = np.concatenate([panels[0][n] for n in moving]), ASIDE * size_of(response)
    low, high = first.min(axis=0) - far, first.max(axis=0) + far
    corners = [np.concatenate([panel[n] for n in moving]) for panel in panels]
    corners = [np.clip(np.nan_to_num(corner, nan=0.0), low, high) for corner in corners]
    top = max(float(corner[:, 1].max()) for corner in corners)
    bottom = min(float(corner[:, 1].min()) for corner in corners)
    gap = 0.15 * (top - bottom)
    parts, place = [], gap
    for corner, panel, k in zip(corners, panels, states, strict=True):
        left, right = float(corner[:, 0].min()), float(corner[:, 0].max())
        for shape, i in zip(panel, shown, strict=True):
            if not np.isfinite(shape).all():
                continue
            seen = np.clip(shape, [left - gap, bottom - gap], [right + gap, top + gap])
            points = " ".join(f"{place + x - left:.4g},{top - z:.4g}" for x, z in seen)
            parts.append(f'<polygon points="{points}" fill="{"#dcdcdc" if bodies.fixed[i] else "#efe6d2"}"/>')
        middle, size = place + 0.5 * (right - left), 0.5 * gap
        label = f'<text x="{middle:.4g}" y="{top - bottom + 1.2 * gap:.4g}" font-size="{size:.3g}"'
        parts.append(f'{label} text-anchor="middle" stroke="none">{response.time[k]:.2f} s</text>')
        place += max(right - left, 2.0 * gap) + gap
    view = f"0 {-gap:.4g} {place:.4g} {top - bottom + 2.6 * gap:.4g}"
    line = f'stroke="#8c6d3f" stroke-width="{0.01 * (top - bottom):.3g}"'
    return f'<svg height="{HEIGHT}" viewBox="{view}" {line} style="max-width:100%">{"".join(parts)}</svg>'


def _plain(value: Any) -> bool:
    return value is not None and not isinstance(value, (list, dict))


def _number_words(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
