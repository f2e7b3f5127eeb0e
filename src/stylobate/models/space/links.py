"""Links of bodies in space as the engine's records, and their part in the stable step."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...column.links.placed import PlacedLink
from ...column.turning import matrix_of
from ...kernels.shared.link_records import NUMBERS, OWN, SHARED
from ...kernels.space.records import types
from ..drums.links import LinkStiffness, law_fields, link_matrices
from ..shared.stable_step import highest_frequency


class Ties(NamedTuple):
    """Arrays of the links as the kernels want them, of as many rows each; see ``kernels/space/records.py``."""

    link: np.ndarray
    bond: np.ndarray
    seat: np.ndarray
    load: np.ndarray


def ties_of(links: tuple[PlacedLink, ...], turn: np.ndarray) -> Ties:
    """Records of links that have not begun.

    Parameters
    ----------
    links : tuple of PlacedLink
        That act.
    turn : array
        From the axes of each body to its principal ones, as columns, shape (N, 3, 3).
    """
    kinds = types()
    ties = Ties(*(np.zeros(len(links), kinds[name]) for name in Ties._fields))
    for name, values in (law_fields(links) if links else {}).items():
        if name in OWN.split():
            ties.link[name][:, 0] = values
        if name in (*NUMBERS.split(), *SHARED.split()):
            ties.bond[name] = values
    for link, k, b in zip(links, ties.link, ties.bond, strict=True):
        b["lower"], b["upper"] = link.lower, link.upper
        k["ft"] = link.pretension
        for end, body, arm in zip("ab", (link.lower, link.upper), link.arms, strict=True):
            for c, value in zip("xyz", turn[body].T @ arm, strict=True):
                k[end + c] = value
        own = turn[link.lower].T @ matrix_of(link.turns[0]).T
        for name, axis in zip("ijk", link.frame, strict=True):
            b[name] = own @ axis
    return ties


def stiffness_of(links: tuple[PlacedLink, ...], root: np.ndarray) -> LinkStiffness:
    """Stiffness of links against the bodies' masses.

    Parameters
    ----------
    links : tuple of PlacedLink
    root : array
        Of the inverse of the mass matrix of all bodies, three places and three turns each, the factor by Cholesky.
    """
    if not links:
        return LinkStiffness(0.0, 0.0)

    def row(link: PlacedLink, way: np.ndarray) -> np.ndarray:
        found, straight = np.zeros(len(root)), link.straight
        points: Any = (link.low, link.high) if straight else (link.middle, link.middle)
        for body, point, origin, sign in zip((link.lower, link.upper), points, link.origins, (-1.0, 1.0), strict=True):
            found[6 * body : 6 * body + 6] = sign * np.concatenate((way, np.cross(np.subtract(point, origin), way)))
        return found

    springs, dashpots = (root.T @ one @ root for one in link_matrices(links, row, len(root)))
    ones = np.ones(len(root))
    return LinkStiffness(highest_frequency(springs, ones), highest_frequency(dashpots, ones) ** 2)
