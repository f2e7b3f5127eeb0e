"""What films and film strips show of a response, whatever stood: outlines, where they are, the ground, and the words."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from ..column.as_found import geometry
from ..column.assembly import FAR_AWAY
from ..constants import DEGREE, g
from ..response import AnyResponse, AssemblyResponse, Response
from .style import BLACK, BROWN, GREY, SAND

#: A picture goes no farther beyond what stood at first than by these shares of its size, to the sides and down: what
#: flies off, or falls where there is no ground, is let go.
ASIDE, DOWN = 3.0, 0.75


@dataclass(frozen=True, eq=False)
class Scene:
    """Bodies at every recorded state, in metres.

    Parameters
    ----------
    name : str
        Of the column or the assembly.
    sentence : str
        What happened.
    time : array
        [s], shape (T,)
    shapes : tuple of array
        Corners of every body relative to its centroid, counter-clockwise [m], each of shape (k, 2).
    start : array
        Centroid of every body before it moves [m], shape (N, 2).
    moves : array
        Displacement along x and z and rotation of every body [m], [rad], shape (T, N, 3).
    fixed : tuple of bool
        Which bodies move with the ground.
    level : float or None
        Of the ground at x = 0 [m]; None for no ground.
    slope : float
        Rise of the ground to the right [-].
    ground : array
        Acceleration of the ground [g], shape (T,).
    """

    name: str
    sentence: str
    time: np.ndarray
    shapes: tuple[np.ndarray, ...]
    start: np.ndarray
    moves: np.ndarray
    fixed: tuple[bool, ...]
    level: float | None
    slope: float
    ground: np.ndarray

    def outlines(self, index: int, factor: float = 1.0) -> list[np.ndarray]:
        """Corners of every body at a recorded state, displacements times a factor [m], each of shape (k, 2)."""
        found = []
        for shape, start, (x, z, angle) in zip(self.shapes, self.start, factor * self.moves[index], strict=True):
            c, s = math.cos(angle), math.sin(angle)
            found.append(shape @ np.array([[c, s], [-s, c]]) + start + (x, z))
        return found

    @property
    def size(self) -> float:
        """Larger side of the box around everything that can move, as it stood [m]."""
        return float(np.ptp(np.concatenate(self._moving(0)), axis=0).max())

    def view(self, indices: np.ndarray, least: float = 0.0) -> tuple[float, float, float, float]:
        """Left, right, lower and upper end of a picture that holds all these states [m].

        Parameters
        ----------
        indices : array of int
        least : float
            Least width over height [-]; a picture that is narrower is made wider.
        """
        stood = np.concatenate(self._moving(0))
        low, high = stood.min(axis=0) - self.size * np.array([ASIDE, DOWN]), stood.max(axis=0) + ASIDE * self.size
        corners = np.concatenate([np.concatenate(self._moving(int(i))) for i in (0, *indices)])
        corners = corners[((corners >= low) & (corners <= high)).all(axis=1)]
        low, high = corners.min(axis=0), corners.max(axis=0)
        # as much of the supports as is near
        near = 0.25 * (high - low).max()
        supports = [shape for shape, fixed in zip(self.outlines(0), self.fixed, strict=True) if fixed]
        corners = np.concatenate([corners, *(np.clip(shape, low - near, high + near) for shape in supports)])
        low, high = corners.min(axis=0), corners.max(axis=0)
        if self.level is not None:
            low[1] = min(low[1], max(self.level, low[1] - near))
        margin = 0.05 * max(self.size, (high - low).max())
        low, high = low - margin, high + margin
        aside = max(0.0, 0.5 * (least * (high[1] - low[1]) - (high[0] - low[0])))
        return low[0] - aside, high[0] + aside, low[1], high[1]

    def _moving(self, index: int) -> list[np.ndarray]:
        return [shape for shape, fixed in zip(self.outlines(index), self.fixed, strict=True) if not fixed]


def scene_of(response: AnyResponse) -> Scene:
    """The scene of a column or of an assembly."""
    return _of_assembly(response) if isinstance(response, AssemblyResponse) else _of_column(response)


def describe(response: AnyResponse) -> str:
    """What stood, motion, model and outcome in one line."""
    what = response.assembly if isinstance(response, AssemblyResponse) else response.column
    undecided = "" if response.decided else ", undecided"
    motion = response.provenance.get("motion", "motion")
    return f"{what.name}, {motion}, {response.model}: {response.outcome.label.replace('_', ' ')}{undecided}"


def draw_bodies(axes: Axes, scene: Scene, outlines: list[np.ndarray], linewidth: float = 0.7) -> None:
    """The ground and all bodies, in true proportion."""
    if scene.level is not None:
        axes.axline((0.0, scene.level), slope=scene.slope, color=BLACK, linewidth=1.2)
    for i, (corners, fixed) in enumerate(zip(outlines, scene.fixed, strict=True)):
        face, edge = ("#dcdcdc", GREY) if fixed else (SAND, BROWN)
        axes.fill(corners[:, 0], corners[:, 1], facecolor=face, edgecolor=edge, linewidth=linewidth, zorder=2 + i)
    axes.set_aspect("equal")
    axes.set_axis_off()


def scale_bar(width: float) -> float:
    """A round length of at most a fifth of a picture's width [m]."""
    decade = 10.0 ** math.floor(math.log10(0.2 * width))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= 0.2 * width)


def _of_column(response: Response) -> Scene:
    h, column = response.histories, response.column
    tilt = column.as_found.base_tilt * DEGREE
    upright = np.array([[math.cos(tilt), math.sin(tilt)], [-math.sin(tilt), math.cos(tilt)]])
    start = geometry(column).centroid @ upright
    mechanism = response.provenance.get("mechanism") or {}
    return Scene(
        name=column.name,
        sentence=mechanism.get("sentence") or f"{response.outcome.sentence} {response.measures.reason}",
        time=h.time,
        shapes=tuple(response.outline(0, i, 0.0) - start[i] for i in range(column.n)),
        start=start,
        moves=np.dstack((np.dstack((h.drum_x, h.drum_z)) @ upright, h.drum_rotation)),
        fixed=(False,) * column.n,
        level=0.0,
        slope=math.tan(tilt),
        ground=h.ground_acceleration / g,
    )


def _of_assembly(response: AssemblyResponse) -> Scene:
    assembly, bodies = response.assembly, response.assembly.bodies
    shown = [i for i, block in enumerate(bodies) if not (block.fixed and block.size > FAR_AWAY)]
    start = np.array([bodies[i].origin for i in shown])
    poses = np.stack((response.x, response.z, response.rotation), axis=2)[:, shown]
    poses[..., :2] -= start
    return Scene(
        name=assembly.name,
        sentence=response.describe(),
        time=response.time,
        shapes=tuple(bodies[i].corners - bodies[i].origin for i in shown),
        start=start,
        moves=poses,
        fixed=tuple(bodies[i].fixed for i in shown),
        level=assembly.ground,
        slope=0.0,
        ground=response.ground_acceleration / g,
    )
