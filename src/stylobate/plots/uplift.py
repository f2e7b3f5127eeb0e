"""Uplift along the rims of a column's joints: how far each opened, in which direction."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure, SubFigure

from ..column.shapes import CircularFrustum, Shape, hull
from ..messages import say
from ..response import Response
from ..response.poses import rotation_matrices
from ..response.words import title_of
from .panels import most, panels_for, put_title, until_collapse
from .style import BROWN, GREY, SAND, styled

#: Directions around a rim.
AROUND = 72


def face_outline(shape: Shape, upper: bool) -> np.ndarray:
    """Corners of a body's upper or lower face, counter-clockwise, along its own axes [m], shape (k, 2)."""
    at = shape.mesh(AROUND).vertices
    level = at[:, 2].max() if upper else at[:, 2].min()
    return hull(at[np.abs(at[:, 2] - level) < 1e-9 * np.ptp(at[:, 2])][:, :2])


def rim_radius(shape: Shape, upper: bool, azimuth: np.ndarray) -> np.ndarray:
    """Distance of the rim of a body's upper or lower face from its axis [m], shape of the azimuths.

    Parameters
    ----------
    shape : Shape
    upper : bool
        Which face.
    azimuth : array
        From the body's x axis towards its y axis [rad].
    """
    if isinstance(shape, CircularFrustum):
        return np.full(np.shape(azimuth), 0.5 * (shape.top if upper else shape.bottom))
    face = face_outline(shape, upper)
    side = np.roll(face, -1, axis=0) - face
    outward = np.stack((side[:, 1], -side[:, 0]), axis=1)
    reach = (outward * face).sum(axis=1)
    toward = np.stack((np.cos(azimuth), np.sin(azimuth)), axis=-1) @ outward.T
    with np.errstate(divide="ignore"):
        return np.where(toward > 0.0, reach / np.where(toward > 0.0, toward, 1.0), np.inf).min(axis=-1)


def rim_uplift(response: Response, joint: int, azimuth: np.ndarray) -> np.ndarray:
    """Height of the rim above a joint over the face below it, since the start [m], shape (T, number of azimuths).

    Parameters
    ----------
    response : Response
        Of a column in space.
    joint : int
        From 0, at the base.
    azimuth : array
        Directions in space, from x towards y [rad].
    """
    turn = rotation_matrices(response.body_orientation[:, joint])
    own = np.arctan2(turn[:, 1, 0] - turn[:, 0, 1], turn[:, 0, 0] + turn[:, 1, 1])  # turn about its axis
    angle = azimuth - own[:, None]
    shape = response.bodies.shapes[joint]
    radius = rim_radius(shape, False, angle)
    low = shape.mesh().vertices[:, 2].min()
    rim = np.stack((radius * np.cos(angle), radius * np.sin(angle), np.full(angle.shape, low)), axis=-1)
    rim = rim @ np.swapaxes(turn, 1, 2) + response.body_position[:, joint, None]
    if joint == 0:
        height = rim[..., 2]
    else:
        below, up = response.bodies.shapes[joint - 1], response.body_axis[:, joint - 1]
        face = response.body_position[:, joint - 1] + below.mesh().vertices[:, 2].max() * up
        height = ((rim - face[:, None]) * up[:, None]).sum(axis=-1)
    return height - height[0]


@styled
def draw_uplift(response: Response, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Largest uplift along the rim of each joint, by direction, until the collapse if there is one.

    Each joint is drawn to its own peak, which stands over it with its direction.

    Parameters
    ----------
    response : Response
        Of a column in space.
    title : str, optional
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    kept = until_collapse(response)
    azimuth = np.arange(AROUND) * (2.0 * np.pi / AROUND)
    joints = range(response.opening.shape[1])
    peaks = np.array([rim_uplift(response, i, azimuth)[kept].max(axis=0) for i in joints]).clip(0.0)
    shown = most(peaks.max(axis=1))
    figure, panels = panels_for(len(shown), figure, projection="polar")
    around = np.append(azimuth, azimuth[0])
    for axes, i in zip(panels, shown):
        values = 1000.0 * np.append(peaks[i], peaks[i][0])
        largest = float(values.max())
        axes.fill(around, values, facecolor=SAND, edgecolor=BROWN, linewidth=1.0)
        axes.set_ylim(0.0, 1.08 * largest if largest > 0.0 else 1.0)
        axes.set_yticks([])
        axes.set_xticks(np.arange(8) * 0.25 * np.pi, ["x", "", "y", "", "", "", "", ""], fontsize=7.0)
        axes.tick_params(pad=-3)
        axes.grid(color="#dddddd", linewidth=0.5)
        axes.spines["polar"].set(color=GREY, linewidth=0.6)
        toward = math.degrees(azimuth[int(peaks[i].argmax())])
        said = say("{far:.3g} mm, {azimuth:.0f}°", far=largest, azimuth=toward) if largest > 5e-3 else say("closed")
        axes.set_title(say("joint {number}\n{said}", number=i + 1, said=said), fontsize=7.0, loc="center", pad=4.0)
    put_title(figure, title or f"Largest uplift by direction: {title_of(response)}", len(peaks) - len(shown))
    return figure
