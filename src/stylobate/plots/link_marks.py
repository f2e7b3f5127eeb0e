"""Marks of links in pictures: dowels and bars as short strokes through their joints, ties, cores and clamps as lines."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from ..column import Column
from ..column.assembly import Assembly
from ..column.link_loads import strokes
from ..column.placed_links import strokes_between
from ..response import Response
from ..response.poses import exaggerated, rotation_matrices
from .scene import Scene
from .style import BLUE, RED


def link_marks(scene: Scene, index: int, factor: float = 1.0) -> list[tuple[np.ndarray, bool]]:
    """Ends of every link but layers as seen at a recorded state [m], shape (2, 2), and whether it is broken."""
    response, column = scene.response, scene.response.structure
    if isinstance(column, Assembly):
        return _between_blocks(response, column, index, factor)
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


def _between_blocks(response: Response, assembly: Assembly, index: int, factor: float) -> list[tuple[np.ndarray, bool]]:
    if not assembly.links:
        return []
    poses = exaggerated(response.poses, index, factor)
    turns = rotation_matrices(poses.orientation)
    broken = {one.name: one.broken_at for one in response.measures.links}

    def seen(body: int, place: np.ndarray) -> np.ndarray:
        x, z = assembly.bodies[body].origin
        return (poses.position[body] + turns[body] @ (np.array([place[0] - x, 0.0, place[1] - z])))[[0, 2]]

    marks = []
    for link, lower, upper in strokes_between(assembly):
        marks.append((np.array([seen(*lower), seen(*upper)]), response.time[index] >= broken.get(link.name, np.inf)))
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
