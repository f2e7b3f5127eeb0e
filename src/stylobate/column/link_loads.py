"""Where links are, and what pretensioned ones exert on the part of a column above a joint, as it stands."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .link_laws import LinkProperties, properties

if TYPE_CHECKING:
    from .column import Column


def is_pretensioned(column: Column) -> bool:
    """Whether some link pulls before anything moves."""
    return any(getattr(link, "pretension", 0.0) > 0.0 for link in column.links)


def pulls_in_plane(column: Column) -> bool:
    """Whether what pretensioned links pull has no part across the plane of x and z."""
    return not any(link.low[1] or link.high[1] for link in properties(column) if link.pretension)


def crosses(link: LinkProperties, joint: int) -> bool:
    """Whether a link crosses joint 0 … n−1."""
    return link.lower <= joint < link.upper


def own_places(column: Column, link: LinkProperties) -> tuple[np.ndarray, np.ndarray]:
    """Ends of a link from the centroids of the bodies that it links, in their own axes [m], each of shape (3,).

    The base has its centroid in the middle of its face.
    """
    places = []
    for body, end in ((link.lower, link.low), (link.upper, link.high)):
        height = float(column.centroid_heights[body - 1]) if body else 0.0
        places.append(np.array([end[0], end[1], end[2] - height]))
    return places[0], places[1]


#: Half of the stroke of a dowel whose embedment is not known, over the height of its drum [-].
STROKE = 0.15


class Stroke(NamedTuple):
    """A line that stands for a link: bodies (0 is the base) and places in their own axes of its two ends [m]."""

    link: LinkProperties
    lower: tuple[int, np.ndarray]
    upper: tuple[int, np.ndarray]


def strokes(column: Column) -> list[Stroke]:
    """Every dowel, bar, tie and core as it is drawn: short through its joint, or from end to end; layers have none."""
    found = []
    for link in properties(column):
        if link.kind == "layer":
            continue
        low, high = own_places(column, link)
        if link.straight:
            found.append(Stroke(link, (link.lower, low), (link.upper, high)))
            continue
        half = link.lift if np.isfinite(link.lift) else STROKE * float(column.heights[link.upper - 1])
        up = np.array([0.0, 0.0, half])
        found.append(Stroke(link, (link.lower, low - up), (link.lower, low + up)))
    return found


def pull_on_part(column: Column, centroids: np.ndarray, axes: np.ndarray, joint: int) -> tuple[np.ndarray, np.ndarray]:
    """Force [N] of pretensioned links on the part above a joint, and its moment about the origin of the axes [N m].

    Parameters
    ----------
    column : Column
    centroids : array
        Of the drums [m], shape (n, 3).
    axes : array
        Of the drums, as columns, shape (n, 3, 3).
    joint : int
        0 … n−1.

    Returns
    -------
    force, moment : array
        Each of shape (3,).
    """
    force, moment = np.zeros(3), np.zeros(3)
    for link in properties(column):
        if not link.pretension or not crosses(link, joint):
            continue
        low, high = own_places(column, link)
        upper = centroids[link.upper - 1] + axes[link.upper - 1] @ high
        if link.straight:
            lower = low if link.lower == 0 else centroids[link.lower - 1] + axes[link.lower - 1] @ low
            way = (lower - upper) / np.linalg.norm(lower - upper)
        else:
            way = -(np.eye(3) if link.lower == 0 else axes[link.lower - 1])[:, 2]
        force += link.pretension * way
        moment += np.cross(upper, link.pretension * way)
    return force, moment
