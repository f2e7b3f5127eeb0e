"""Links of a column in space as the engine's records."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column
from ...column.found_geometry import space_geometry
from ..drums.links import acting, hold_of, law_fields


def link_fields(column: Column, drum: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Fields of the links of a column in space that are not 0, whose drums stand as these fields of the records say."""
    links = acting(column)
    if not links:
        return {}
    joint, line, ends = np.zeros((len(links), 3)), np.zeros(len(links)), np.zeros((2, len(links), 3))
    axes = np.stack([np.stack([drum[a + c] for c in "xyz"], axis=-1) for a in "ijk"], axis=-1)
    centroids, foot = (np.stack([drum[a + c] for c in "xyz"], axis=-1) for a in ("", "f"))
    beds = space_geometry(column).bed if column.as_found else np.repeat(np.eye(3)[None], column.n, axis=0)
    for m, link in enumerate(links):
        low, up = link.lower, link.upper
        if link.straight:
            ends[:, m] = link.arms
            one, other = (centroids[body] + axes[body] @ end for body, end in ((low, ends[0, m]), (up, ends[1, m])))
            line[m] = math.dist(one, other)
            continue
        ends[1, m] = foot[up] + beds[up - 1] @ (*link.high[:2], 0.0)
        joint[m] = axes[low].T @ (centroids[up] + axes[up] @ ends[1, m] - centroids[low]) - (0.0, 0.0, drum["ht"][low])
    laws = law_fields(links)
    pretension = np.array([one.pretension for one in links])
    start = np.where(laws["line"] > 0, line, joint[:, 2])
    stretch = np.where(laws["ka"] > 0.0, pretension / np.where(laws["ka"] > 0.0, laws["ka"], 1.0), 0.0)
    own = {
        **{name: laws[name] for name in ("ka", "fa", "ua", "gap")},
        "h": start,
        "l0": start - stretch,
        "on": np.ones(len(links)),
        "ft": pretension,
        "sx": joint[:, 0],
        "sy": joint[:, 1],
        "px": joint[:, 0],
        "py": joint[:, 1],
        "when": np.full(len(links), -1),
        "whole": np.array([hold_of(column, one) for one in links]),
    }
    return own | {f"{end}{c}": ends[e][:, i] for e, end in enumerate("ab") for i, c in enumerate("xyz")}
