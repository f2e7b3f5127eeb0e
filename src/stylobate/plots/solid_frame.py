"""Bodies in space in a frame of a film: the ground under them with its axes, and shaded solids that are painted anew."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from .scene import Scene
from .solids import painted
from .style import BLACK, BROWN, GREY


def draw_solids(axes: Axes, scene: Scene, index: int) -> None:
    """The ground, the directions of x and y on it, and all bodies at a recorded state, in true proportion."""
    view = scene.seen_from
    assert view is not None
    axes.fill(*view.across(scene.plate).T, facecolor="#f4f4f4", edgecolor=GREY, linewidth=0.7, zorder=1)
    for name, (start, end) in zip("xy", scene.directions, strict=True):
        axes.annotate(
            "",
            tuple(view.across(end)),
            xytext=tuple(view.across(start)),
            arrowprops={"arrowstyle": "-|>", "color": BLACK, "linewidth": 0.9},
            zorder=2,
        )
        right, up = 1.08 * view.across(end)
        axes.text(float(right), float(up), name, fontsize=8.5, ha="center", va="center", zorder=2)
    axes.add_collection(PolyCollection([], zorder=3), autolim=False)
    axes.set_aspect("equal")
    axes.set_axis_off()
    paint(axes, scene, index)


def paint(axes: Axes, scene: Scene, index: int) -> None:
    """Paint the bodies as they are at another recorded state."""
    assert scene.seen_from is not None
    polygons, colours, outlines = painted(scene.solids(index), scene.seen_from)
    faces = next(collection for collection in axes.collections if isinstance(collection, PolyCollection))
    faces.set_verts(polygons)
    faces.set_facecolor([tuple(colour) for colour in colours])
    faces.set_edgecolor([BROWN if outline else tuple(colour) for outline, colour in zip(outlines, colours)])
    faces.set_linewidth([1.4 if outline else 0.3 for outline in outlines])
