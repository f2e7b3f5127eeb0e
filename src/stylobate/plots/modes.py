"""Shapes of natural vibrations, drawn beside what stands."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure

from ..vibrations.modes import Mode, Modes
from .style import BLUE, BROWN, GREY, RED, SAND, WIDTH, styled

#: Most shapes in a picture; the largest displacement in it over the height of what stands.
SHAPES, SWAY = 6, 0.12

#: Height of the picture [inch].
TALL = 4.6


@styled
def draw_modes(modes: Modes, title: str | None = None, *, figure: Figure | None = None) -> Figure:
    """Lowest modes of every kind: bodies displaced, joints coloured by their share in the elastic energy.

    Bending is seen across the direction in which the top moves. Torsion is drawn as the turn of each body, over its height.

    Parameters
    ----------
    modes : Modes
    figure : Figure, optional
        To be drawn on.
    """
    chosen = _chosen(modes)
    figure = figure or Figure(figsize=(WIDTH, TALL))
    axes = np.atleast_1d(figure.subplots(1, len(chosen), sharey=True))
    for ax, mode in zip(axes, chosen, strict=True):
        (_draw_turns if mode.kind == "torsion" else _draw_shape)(ax, modes, mode)
        towards = "" if mode.azimuth is None or modes.structure.section == "circular" else f", {mode.azimuth:.0f}°"
        ax.set_title(f"{mode.kind} {mode.number}{towards}\n{mode.frequency:.4g} Hz", fontsize=8.5)
        ax.tick_params(bottom=False, labelbottom=mode.kind == "torsion")
        ax.spines["bottom"].set_visible(False)
    axes[0].set_ylabel("height [m]")
    if title:
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)
    return figure


def _chosen(modes: Modes) -> list[Mode]:
    """Three of bending, two of torsion, one axial; more of bending where the others are missing."""
    torsion, axial = list(modes.of("torsion")[:2]), list(modes.of("axial")[:1])
    return [*modes.of("bending")[: SHAPES - len(torsion) - len(axial)], *torsion, *axial]


def _draw_shape(ax, modes: Modes, mode: Mode) -> None:
    """Outlines at rest and displaced, seen across the motion."""
    standing, structure = modes.standing, modes.structure
    angle = math.radians(mode.azimuth or 0.0)
    way = np.array([math.cos(angle), math.sin(angle), 0.0])
    meshes = _corners(modes)
    points = np.concatenate([corners for i, corners in meshes.items() if standing.free[i]])
    size = float(np.ptp(points[:, 2]))
    largest = max(
        float(np.abs(_moved(standing, mode, i, corners) - corners).max())
        for i, corners in meshes.items()
        if standing.free[i]
    )
    scale = SWAY * size / max(largest, 1e-300)
    for i, corners in meshes.items():
        if not standing.free[i] and structure.stack is not None:
            continue
        rest = _outline(corners, way)
        ax.fill(*rest.T, facecolor="none", edgecolor=GREY, linewidth=0.5, linestyle=(0, (3, 2)))
        now = _outline(corners + scale * (_moved(standing, mode, i, corners) - corners), way)
        ax.fill(*now.T, facecolor=SAND, edgecolor=BROWN, linewidth=0.7)
    most = float(mode.joint_shares.max())
    for joint, share in zip(standing.joints, mode.joint_shares, strict=True):
        if share > 0.05 * most:
            place = _moved(standing, mode, joint.upper, joint.edge) - joint.edge
            line = (joint.edge + scale * place) @ np.column_stack((way, (0.0, 0.0, 1.0)))
            ends = line[[int(line[:, 0].argmin()), int(line[:, 0].argmax())]]
            ax.plot(*ends.T, color=RED, linewidth=0.6 + 2.4 * share / most, solid_capstyle="butt")
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xticks([])


def _draw_turns(ax, modes: Modes, mode: Mode) -> None:
    """Turn of every body over its height, as a share of the largest."""
    standing = modes.standing
    free = np.flatnonzero(standing.free)
    turn = mode.shape[free, 5] / max(float(np.abs(mode.shape[free, 5]).max()), 1e-300)
    height = standing.centroids[free, 2]
    order = np.argsort(height)
    ax.axvline(0.0, color=GREY, linewidth=0.6)
    ax.plot(turn[order], height[order], color=BLUE, marker="o", markersize=3)
    ax.set_xlim(-1.15, 1.15)
    ax.set_xlabel("turn [-]")


def _corners(modes: Modes) -> dict[int, np.ndarray]:
    """Corners of every body as it stands [m]."""
    corners = {}
    for i, body in enumerate(modes.structure.bodies):
        if body.fixed and getattr(body, "pieces", None) is None and modes.structure.stack is not None:
            continue
        if modes.structure.space_joints is None and modes.structure.stack is None:
            flat = body.corners
            if np.abs(flat).max() < 1e4:
                corners[i] = np.column_stack((flat[:, 0], np.zeros(len(flat)), flat[:, 1]))
            continue
        if body.fixed and getattr(body, "pieces", None) is None:
            continue
        corners[i] = np.concatenate([part.mesh(24).vertices for part in body.placed])
    return corners


def _moved(standing, mode: Mode, body: int, points: np.ndarray) -> np.ndarray:
    """Points of a body after the motion of a mode."""
    q = mode.shape[body]
    return points + q[:3] + np.cross(q[3:], points - standing.centroids[body])


def _outline(points: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Hull of points seen across a direction."""
    from ..column.shapes import hull

    return hull(points @ np.column_stack((way, (0.0, 0.0, 1.0))))
