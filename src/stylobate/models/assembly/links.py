"""Links of an assembly as its kernel wants them, and their part in the stable step."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...column.assembly import Assembly
from ...column.links.placed import PlacedLink
from ..drums.links import LinkStiffness, law_fields, slip_at
from ..shared.stable_step import highest_frequency


def acting(assembly: Assembly) -> tuple[PlacedLink, ...]:
    """Links that do anything besides lowering friction."""
    return tuple(one for one in assembly.placed_links if one.acts)


def link_records(assembly: Assembly, kernel: Any) -> Any:
    """Records of all links that act, whole and free of force but for their pretension once they begin.

    Parameters
    ----------
    assembly : Assembly
    kernel : module
        ``kernels.assembly.links``.
    """
    links = acting(assembly)
    records: Any = np.zeros(len(links), kernel.link_type())
    if not links:
        return records
    field: dict[str, Any] = {name: records[name].reshape(len(links), -1)[:, 0] for name in records.dtype.names}
    for name, values in law_fields(links).items():
        field[name][:] = values
    clamps = np.array([link.lies == "side" for link in links])
    field["mboth"][:] = clamps & (field["mka"] > 0.0)
    field["mpre"][:] = [link.pretension for link in links]
    field["mtc"][:], field["mts"][:] = np.array([link.along for link in links]).T
    field["mya"][:] = slip_at(field["mfa"], field["mka"])
    field["mcra"][:] = [link.axial_failure == "crushing" for link in links]
    field["mbra"][:] = [link.axial_failure == "brittle" for link in links]
    for m, link in enumerate(links):
        for end, arm in zip("ab", link.arms, strict=True):
            for axis, value in zip("xyz", arm, strict=True):
                field[f"m{end}{axis}"][m] = value
    return records


def link_stiffness(assembly: Assembly, inverse: np.ndarray) -> LinkStiffness:
    """How stiff the links are against the bodies' masses.

    Parameters
    ----------
    assembly : Assembly
    inverse : array
        1/m, 1/m and 1/I of every body, 0 where it is held, shape (3N,).
    """
    links, count = acting(assembly), len(inverse)
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
