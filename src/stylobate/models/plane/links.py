"""Links in the plane as the engine's records."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np

from ...column.links.placed import PlacedLink
from ...column.structure import Structure
from ...kernels.shared.link_records import NO_LINK, OWN, link_types
from ..drums.links import LinkStiffness, acting, hold_of, law_fields, link_matrices
from ..shared.stable_step import highest_frequency


def links_at_rest(structure: Structure, body: Any) -> np.ndarray:
    """Links of a structure whose bodies stand as these records of one lane say: whole, and free of force but for their
    pretension."""
    links = acting(structure)
    if not links:
        return np.zeros(0, NO_LINK)
    records = np.zeros(len(links), link_types(1)[0])
    for name, values in law_fields(links).items():
        if name in OWN.split():
            records[name][:, 0] = values
    x, z, c, s = (body[name][:, 0] for name in ("x", "z", "c", "s"))
    for k, link in zip(records, links, strict=True):
        low, up, (tc, ts) = structure.link_ends(link)
        k["tc"], k["ts"], k["on"], k["when"], k["ft"] = tc, ts, 1.0, -1, link.pretension
        k["whole"] = 0.0 if structure.stack is None else hold_of(structure.stack, link)
        places = []
        for end, i, (px, py, pz) in (("a", link.lower, low), ("b", link.upper, up)):
            k[end + "x"], k[end + "y"], k[end + "z"] = px, py, pz
            places.append((x[i] + c[i] * px - s[i] * pz, py, z[i] + s[i] * px + c[i] * pz))
        start = math.dist(*places)
        if not link.straight:
            i = link.lower
            tc, ts = c[i] * tc - s[i] * ts, s[i] * tc + c[i] * ts
            ax, az = places[1][0] - x[i], places[1][2] - z[i]
            k["sx"] = k["px"] = tc * ax + ts * az
            start = tc * az - ts * ax
        k["h"] = start
        k["l0"] = start - (link.pretension / link.axial_stiffness if link.pretension else 0.0)
    return records


def stiffness_between(structure: Structure, inverse: np.ndarray) -> LinkStiffness:
    """Stiffness of the links against the bodies' masses.

    Parameters
    ----------
    structure : Structure
    inverse : array
        1/m, 1/m and 1/I of every body, 0 where it is held, shape (3N,).
    """
    links, count = acting(structure), len(inverse)
    if not links:
        return LinkStiffness(0.0, 0.0)
    springs, dashpots = link_matrices(links, partial(_row, count), count, 1)
    return LinkStiffness(highest_frequency(springs, inverse), highest_frequency(dashpots, inverse) ** 2)


def _row(count: int, link: PlacedLink, way: np.ndarray) -> np.ndarray:
    """Of the bodies in the plane, two places and a turn each."""
    row, (x, _, z) = np.zeros(count), way
    low, high = link.arms
    for body, arm, sign in ((link.upper, high, 1.0), (link.lower, low, -1.0)):
        row[3 * body : 3 * body + 3] = sign * np.array([x, z, arm[0] * z - arm[2] * x])
    return row
