"""Displacement histories of an assembly: the blocks that move most by name, all others in grey."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..response import AssemblyResponse
from .histories import draw_ground
from .scene import describe
from .style import CYCLE, WIDTH, styled, zero_line

#: Blocks that are drawn by name.
NAMED = 5


@styled
def draw_block_histories(response: AssemblyResponse, title: str | None = None) -> Figure:
    """Horizontal and vertical displacement of every block, over the acceleration of the ground.

    Parameters
    ----------
    response : AssemblyResponse
    title : str, optional
        Assembly, motion and outcome by default.
    """
    bodies = response.assembly.bodies
    moving = [i for i, block in enumerate(bodies) if not block.fixed]
    farthest = np.nan_to_num(response.displacement).max(axis=0)
    named = sorted(moving, key=lambda i: -farthest[i])[:NAMED]
    figure = Figure(figsize=(WIDTH, 5.4))
    panels = figure.subplots(3, 1, sharex=True, height_ratios=(2.4, 2.4, 1.0))
    unit, factor = ("m", 1.0) if farthest.max() >= 0.1 else ("mm", 1000.0)
    for axes, values, word in zip(panels, (response.x, response.z), ("horizontal", "vertical")):
        zero_line(axes)
        for i in moving:
            if i not in named:
                axes.plot(response.time, factor * (values[:, i] - values[0, i]), color="#c8c8c8", linewidth=0.6)
        for i, line in zip(named, CYCLE):
            axes.plot(response.time, factor * (values[:, i] - values[0, i]), label=bodies[i].name, **line)
        axes.set_ylabel(f"{word}\ndisplacement [{unit}]")
    others = len(moving) - len(named)
    handles, labels = panels[0].get_legend_handles_labels()
    panels[0].legend(handles, labels, loc="best", ncols=min(3, len(labels)))
    if response.collapsed:
        first = min(response.fell_at.values())
        for axes in panels[:2]:
            axes.axvline(first, color="#1a1a1a", linewidth=0.8, linestyle=(0, (1, 2)))
    said = f"; in grey the other {others} blocks" if others > 0 else ""
    panels[1].set_title(f"relative to the ground{said}", loc="right", fontsize=8.0)
    panels[0].set_title(title or describe(response))
    draw_ground(panels[2], response)
    figure.align_ylabels()
    return figure
