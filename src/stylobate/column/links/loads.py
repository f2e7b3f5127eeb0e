"""Force of pretensioned links on the part of a column above a joint, as it stands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .placed import PlacedLink


def pulls_in_plane(links: Sequence[PlacedLink]) -> bool:
    """Whether what pretensioned links pull has no part across the plane of x and z."""
    return not any(link.low[1] or link.high[1] for link in links if link.pretension)


def pull_on_part(
    links: Sequence[PlacedLink], centroids: np.ndarray, axes: np.ndarray, joint: int
) -> tuple[np.ndarray, np.ndarray]:
    """Force [N] of pretensioned links on the part above a joint, and its moment about the origin of the axes [N m].

    Parameters
    ----------
    links : sequence of PlacedLink
        Of a column.
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
    for link in links:
        if not link.pretension or not link.crosses(joint):
            continue
        low, high = link.arms
        upper = centroids[link.upper - 1] + axes[link.upper - 1] @ high
        if link.straight:
            lower = low if link.lower == 0 else centroids[link.lower - 1] + axes[link.lower - 1] @ low
            way = (lower - upper) / np.linalg.norm(lower - upper)
        else:
            way = -(np.eye(3) if link.lower == 0 else axes[link.lower - 1])[:, 2]
        force += link.pretension * way
        moment += np.cross(upper, link.pretension * way)
    return force, moment
