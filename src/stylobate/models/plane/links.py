"""Links in the plane as the engine's records."""

from __future__ import annotations

import numpy as np

from ...column.links.placed import PlacedLink
from ...column.structure import Structure
from ...kernels.shared.link_records import OWN, link_types
from ...kernels.shared.records import PAIR_TYPE
from ..drums.links import LinkStiffness, acting, bonds, hold_of, law_fields
from ..shared.stable_step import highest_frequency

NO_LINKS = np.zeros(0, link_types(0)[0])


def links_at_rest(structure: Structure, body: np.ndarray) -> np.ndarray:
    """Links of a structure whose bodies stand as these records of one lane say: whole, and free of force but for their
    pretension."""
    from ...kernels.plane.links import begin

    links = acting(structure)
    if not links:
        return NO_LINKS
    records = np.zeros(len(links), link_types(1)[0])
    for name, values in law_fields(links).items():
        if name in OWN.split():
            records[name][:, 0] = values
    for k, link in zip(records, links, strict=True):
        *ends, (k["tc"], k["ts"]) = structure.link_ends(link)
        for end, place in zip("ab", ends, strict=True):
            for axis, value in zip("xyz", place, strict=True):
                k[end + axis] = value
        k["ft"] = link.pretension
        k["whole"] = 0.0 if structure.stack is None else hold_of(structure.stack, link)
    pair = np.array([(one.lower, one.upper) for one in links], PAIR_TYPE)
    begin(body, pair[:0], records, bonds(structure), pair)
    return records


def stiffness_between(structure: Structure, inverse: np.ndarray) -> LinkStiffness:
    """How stiff the links are against the bodies' masses.

    Parameters
    ----------
    structure : Structure
    inverse : array
        1/m, 1/m and 1/I of every body, 0 where it is held, shape (3N,).
    """
    links, count = acting(structure), len(inverse)
    if not links:
        return LinkStiffness(0.0, 0.0)
    springs, dashpots = np.zeros((count, count)), np.zeros((count, count))
    for link in links:
        if link.straight:
            way = np.array([link.high[0] - link.low[0], link.high[2] - link.low[2]]) / link.length
            springs += link.axial_stiffness * _square(link, way, count)
            continue
        t = np.array(link.along)
        square = _square(link, t, count)
        springs += link.shear_stiffness * square
        dashpots += link.damping * square
        springs += link.axial_stiffness * _square(link, np.array([-t[1], t[0]]), count)
    return LinkStiffness(highest_frequency(springs, inverse), highest_frequency(dashpots, inverse) ** 2)


def _square(link: PlacedLink, way: np.ndarray, count: int) -> np.ndarray:
    """What a unit of stiffness along a direction adds to the stiffness of the bodies."""
    row = np.zeros(count)
    low, high = link.arms
    for body, arm, sign in ((link.upper, high, 1.0), (link.lower, low, -1.0)):
        row[3 * body : 3 * body + 3] = sign * np.array([*way, arm[0] * way[1] - arm[2] * way[0]])
    return np.outer(row, row)
