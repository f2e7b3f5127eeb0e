"""Marks of links in pictures: dowels and bars as short strokes through their joints, ties, cores and clamps as lines."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes

from ..column.links.placed import Stroke, strokes
from ..response.poses import exaggerated, rotation_matrices
from .scene import Scene
from .style import BLUE, RED


class Mark(NamedTuple):
    """The mark of a link: a body by its number and a place in its axes for either end, or no body and a place in space [m].

    ``broken`` is when it broke [s], infinite if it is whole.
    """

    lower: tuple[int | None, np.ndarray]
    upper: tuple[int | None, np.ndarray]
    broken: float


def marks_of(scene: Scene) -> list[Mark]:
    """Marks of every link but layers."""
    structure = scene.response.structure
    broken = {link.name: link.broken_at for link in scene.response.measures.links if link.broken}

    def body(number: int, place: np.ndarray) -> tuple[int | None, np.ndarray]:
        recorded = number - structure.first
        return (recorded, place) if recorded >= 0 else (None, scene.base @ place)

    def mark(one: Stroke) -> Mark:
        return Mark(body(*one.lower[:2]), body(*one.upper[:2]), broken.get(one.link.name, math.inf))

    return [mark(stroke) for stroke in strokes(structure.placed_links)]


def link_marks(scene: Scene, index: int, factor: float = 1.0) -> list[tuple[np.ndarray, bool]]:
    """Ends of every link but layers as seen at a recorded state [m], shape (2, 2), and whether it is broken."""
    marks = marks_of(scene)
    if not marks:
        return []
    poses = exaggerated(scene.response.poses, index, factor)
    turns, places = scene.upright @ rotation_matrices(poses.orientation), poses.position @ scene.upright.T

    def seen(body: int | None, place: np.ndarray) -> np.ndarray:
        point = place if body is None else places[body] + turns[body] @ place
        return point[[0, 2]] if scene.seen_from is None else scene.seen_from.across(point)

    now = scene.response.time[index]
    return [(np.array([seen(*mark.lower), seen(*mark.upper)]), now >= mark.broken) for mark in marks]


def draw_links(axes: Axes, scene: Scene, index: int, factor: float = 1.0) -> None:
    """Mark the links of a state, over the bodies: whole ones in blue, broken ones in red and dotted."""
    for line in [one for one in axes.lines if one.get_gid() == "link"]:
        line.remove()
    for ends, broken in link_marks(scene, index, factor):
        (line,) = axes.plot(
            ends[:, 0], ends[:, 1], color=RED if broken else BLUE, linestyle=":" if broken else "-", linewidth=1.1,
            zorder=900, scalex=False, scaley=False,
        )  # fmt: skip
        line.set_gid("link")
