"""Marks of links in pictures: dowels and bars as short strokes through their joints, ties and cores as lines."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from ..column import Column
from ..column.link_loads import strokes
from ..response.poses import exaggerated, rotation_matrices
from .scene import Scene
from .style import BLUE, RED


def link_marks(scene: Scene, index: int, factor: float = 1.0) -> list[tuple[np.ndarray, bool]]:
    """Ends of every dowel, bar, tie and core as seen at a recorded state [m], shape (2, 2), and whether it is broken."""
    response, column = scene.response, scene.response.structure
    if not isinstance(column, Column) or not column.links:
        return []
    poses = exaggerated(response.poses, index, factor)
    turns, places = scene.upright @ rotation_matrices(poses.orientation), poses.position @ scene.upright.T
    broken = {one.name: one.broken_at for one in response.measures.links}

    def seen(body: int, place: np.ndarray) -> np.ndarray:
        point = scene.base @ place if body == 0 else places[body - 1] + turns[body - 1] @ place
        return point[[0, 2]] if scene.seen_from is None else scene.seen_from.across(point)

    marks = []
    for link, lower, upper in strokes(column):
        ends = np.array([seen(*lower), seen(*upper)])
        marks.append((ends, response.time[index] >= broken.get(link.name, np.inf)))
    return marks


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
