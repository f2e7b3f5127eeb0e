"""Links of a column in the plane as the engine's records."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from ...column import Column
from ...column.assembly import Assembly
from ...column.found_geometry import geometry
from ...column.links.placed import PlacedLink
from ...kernels.shared.link_records import BOND_TYPE, NUMBERS, OWN, SHARED, link_types
from ..drums.links import LinkStiffness, acting, hold_of, law_fields, slip_at
from ..shared.stable_step import highest_frequency

NO_LINKS = np.zeros(0, link_types(0)[0])


def bonds(column: Column) -> np.ndarray:
    """What the links of a column are in all lanes."""
    links = acting(column)
    records = np.zeros(len(links), BOND_TYPE)
    if links:
        for name, values in law_fields(links).items():
            if name[1:] in (*NUMBERS.split(), *SHARED.split()):
                records[name[1:]] = values
    return records


def links_at_rest(column: Column, drums: Mapping[str, np.ndarray]) -> np.ndarray:
    """Links of a column whose drums stand as these numbers say, whole and free of force but for their pretension."""
    links = acting(column)
    if not links:
        return NO_LINKS
    records = np.zeros(len(links), link_types(1)[0])
    laws = law_fields(links)
    foot = geometry(column).foot if column.as_found else np.zeros(column.n)
    x, z, c, s = (drums[name] for name in ("x", "z", "c", "s"))
    for name in ("ka", "fa", "ua", "gap"):
        records[name][:, 0] = laws["m" + name]
    for m, link in enumerate(links):
        low, up, k = link.lower, link.upper, records[m]
        (k["tc"], k["ts"]), k["on"], k["when"], k["ft"] = column.upper_faces[low].direction, 1.0, -1, link.pretension
        k["whole"] = hold_of(column, link)
        if link.straight:
            for end, body, place in zip("ab", (low, up), link.arms, strict=True):
                # places are given along the upper face
                cf, sf = column.upper_faces[body].direction
                k[end + "x"], k[end + "z"] = cf * place[0] - sf * place[2], sf * place[0] + cf * place[2]
                k[end + "y"] = place[1]
            start = _length(k, low, up, x, z, c, s)
        else:
            k["bx"], k["bz"] = link.high[0] - foot[up - 1], -column.face_pairs[up - 1].above.height
            tc, ts = c[low] * k["tc"] - s[low] * k["ts"], s[low] * k["tc"] + c[low] * k["ts"]
            ax = x[up] + c[up] * k["bx"] - s[up] * k["bz"] - x[low]
            az = z[up] + s[up] * k["bx"] + c[up] * k["bz"] - z[low]
            k["sx"] = k["px"] = tc * ax + ts * az
            start = tc * az - ts * ax
        k["h"] = start
        k["l0"] = start - (link.pretension / link.axial_stiffness if link.pretension else 0.0)
    return records


def _length(k: np.void, low: int, up: int, x: np.ndarray, z: np.ndarray, c: np.ndarray, s: np.ndarray) -> float:
    places = []
    for end, body in (("a", low), ("b", up)):
        px, pz = k[end + "x"][0], k[end + "z"][0]
        places.append((x[body] + c[body] * px - s[body] * pz, k[end + "y"][0], z[body] + s[body] * px + c[body] * pz))
    return math.dist(*places)


def acting_between(assembly: Assembly) -> tuple[PlacedLink, ...]:
    """Links of an assembly that do anything besides lowering friction."""
    return tuple(one for one in assembly.placed_links if one.acts)


def links_between(assembly: Assembly) -> tuple[np.ndarray, np.ndarray]:
    """Bonds and links of an assembly with its bodies as drawn; they begin once the engine lets them."""
    links = acting_between(assembly)
    bond, records = np.zeros(len(links), BOND_TYPE), np.zeros(len(links), link_types(1 if links else 0)[0])
    if not links:
        return bond, records
    laws = {name[1:]: values for name, values in law_fields(links).items()}
    axial = laws["ka"]
    clamps = np.array([link.lies == "side" for link in links])
    laws |= {
        "both": clamps & (axial > 0.0),
        "ya": slip_at(laws["fa"], axial),
        "cra": np.array([float(link.axial_failure == "crushing") for link in links]),
        "bra": np.array([float(link.axial_failure == "brittle") for link in links]),
    }
    for name, values in laws.items():
        if name in (*NUMBERS.split(), *SHARED.split()):
            bond[name] = values
        elif name in OWN.split():
            records[name][:, 0] = values
    records["back"] = records["gap"]
    records["ft"][:, 0] = [link.pretension for link in links]
    records["tc"][:, 0], records["ts"][:, 0] = np.array([link.along for link in links]).T
    for m, link in enumerate(links):
        for end, arm in zip("ab", link.arms, strict=True):
            for axis, value in zip("xyz", arm, strict=True):
                records[end + axis][m, 0] = value
    return bond, records


def stiffness_between(assembly: Assembly, inverse: np.ndarray) -> LinkStiffness:
    """How stiff the links are against the bodies' masses.

    Parameters
    ----------
    assembly : Assembly
    inverse : array
        1/m, 1/m and 1/I of every body, 0 where it is held, shape (3N,).
    """
    links, count = acting_between(assembly), len(inverse)
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
