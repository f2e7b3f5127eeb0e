"""Links as the kernels want them, their part in the stable step, what they hold at the start and do in a run."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...column import Column
from ...column.links.placed import PlacedLink
from ...column.structure import Structure
from ...kernels.shared.records import BOND_TYPE, NUMBERS, SHARED
from ...response import Histories, LinkHistories, LinkMeasures
from ..shared.stable_step import highest_frequency


def acting(structure: Structure) -> tuple[PlacedLink, ...]:
    """Links that do anything besides lowering friction."""
    return tuple(link for link in structure.placed_links if link.acts)


def law_fields(links: Sequence[PlacedLink]) -> dict[str, np.ndarray]:
    """By which numbers each link holds, as the fields of ``bond`` and ``link``, each of shape (m,)."""

    def of(name: str) -> np.ndarray:
        return np.array([getattr(link, name) for link in links], dtype=float)

    straight, stiffness, axial = (
        np.array([link.straight for link in links]),
        of("shear_stiffness"),
        of("axial_stiffness"),
    )
    failure, across = [link.failure for link in links], [link.axial_failure for link in links]
    clamps = np.array([link.lies == "side" for link in links])
    return {
        "line": straight.astype(int),
        "ten": ((axial > 0.0) & ~straight).astype(int),
        "both": (clamps & (axial > 0.0)).astype(int),
        "near": np.ones(len(links), dtype=int),
        "ks": stiffness,
        "y": slip_at(of("shear_capacity"), stiffness),
        "cr": np.array([float(mode == "crushing") for mode in failure]),
        "br": np.array([float(mode == "brittle") for mode in failure]),
        "deep": of("lift"),
        "reach": of("reach"),
        "us": of("ultimate_slip"),
        "c": of("damping"),
        "ya": slip_at(of("axial_capacity"), axial),
        "cra": np.array([float(mode == "crushing") for mode in across]),
        "bra": np.array([float(mode == "brittle") for mode in across]),
        "ka": axial,
        "fa": of("axial_capacity"),
        "ua": of("ultimate_elongation"),
        "gap": of("clearance"),
        "back": of("clearance"),
    }


def bonds(structure: Structure) -> np.ndarray:
    """Constants of the links of a structure in all lanes."""
    links = acting(structure)
    records = np.zeros(len(links), BOND_TYPE)
    if links:
        laws = law_fields(links)
        for name in (*NUMBERS.split(), *SHARED.split()):
            records[name] = laws[name]
    return records


def slip_at(capacity: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Slip at which springs of these stiffnesses [N/m] reach these capacities [N]; infinite of those without stiffness."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(stiffness > 0.0, capacity / stiffness, math.inf)


def hold_of(column: Column, link: PlacedLink) -> float:
    """Largest moment that a link can set against overturning about a joint that it crosses [N m].

    One across a joint in tension at its distance from the farthest edge; one in shear over the lift at which it is in its
    hole. Faces part before they have slipped by twice their width, or lifted by as much.
    """
    lever = widest = 0.0
    for j in range(link.lower, link.upper):
        above, below = column.drums[j], column.drums[j - 1] if j else column.drums[j]
        half = 0.5 * max(above.bottom_width, below.top_width if j else 0.0)
        if not above.circular:
            half = math.hypot(half, 0.5 * max(above.depth, below.upper_depth))
        widest = max(widest, 2.0 * half)
        height = float(column.joint_heights[j])
        ends = (math.hypot(math.hypot(*end[:2]) + half, end[2] - height) for end in (link.low, link.high))
        lever = max(lever, min(ends))
    shear = 0.0
    if link.shear_stiffness:
        shear = min(link.shear_capacity, link.shear_stiffness * 2.0 * widest) * min(link.lift, widest)
    return shear + (link.axial_capacity * lever if link.axial_stiffness else 0.0)


def with_beds_alone(column: Column) -> Column:
    """The column with those of its links alone that make its joints softer."""
    pairs = zip(column.links, column.placed_links, strict=True)
    return column.replace(links=tuple(link for link, placed in pairs if placed.bed_stiffness < math.inf))


class LinkStiffness(NamedTuple):
    """Highest circular frequency of the links alone [rad/s], and the largest rate of their dashpots [1/s]."""

    frequency: float
    rate: float


def link_stiffness(column: Column) -> LinkStiffness:
    """Stiffness of the links against the drums' masses: an upper bound of what they add to any state of the joints."""
    links, n = acting(column), column.n
    if not links:
        return LinkStiffness(0.0, 0.0)
    cross = np.array([drum.cross_inertia for drum in column.drums])
    axial = np.array([drum.axial_inertia for drum in column.drums])
    mass = column.masses
    inverse = 1.0 / np.stack((mass, mass, mass, cross, column.inertias, axial), axis=1).ravel()
    springs, dashpots = link_matrices(links, partial(_row, column), 6 * n)
    return LinkStiffness(highest_frequency(springs, inverse), highest_frequency(dashpots, inverse) ** 2)


def link_matrices(
    links: Sequence[PlacedLink], row: Callable[[PlacedLink, np.ndarray], np.ndarray], count: int, across: int = 2
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness [N/m] and dashpots [N s/m] of links against all coordinates of bodies, shape (count, count) each.

    Parameters
    ----------
    links : sequence of PlacedLink
    row : callable
        How far the ends of a link come apart along a direction in space for each of the coordinates, shape (count,).
    count : int
    across : int
        In how many directions they slip: 2, or 1 in a plane.
    """
    springs, dashpots = np.zeros((count, count)), np.zeros((count, count))
    for link in links:
        ways = np.array(link.frame)
        axis = np.subtract(link.high, link.low) / link.length if link.straight else ways[2]
        springs += link.axial_stiffness * _square(row(link, axis))
        for way in ways[:across] if not link.straight else ():
            square = _square(row(link, way))
            springs += link.shear_stiffness * square
            dashpots += link.damping * square
    return springs, dashpots


def _square(row: np.ndarray) -> np.ndarray:
    return np.outer(row, row)


def _row(column: Column, link: PlacedLink, way: np.ndarray) -> np.ndarray:
    """Of the drums in space, three places and three turns each."""
    row = np.zeros(6 * column.n)
    low, high = link.arms
    for body, arm, sign in ((link.upper, high, 1.0), (link.lower, low, -1.0)):
        if body:
            row[6 * body - 6 : 6 * body] = sign * np.concatenate((way, np.cross(arm, way)))
    return row


def with_links(added: LinkStiffness, omega: float, stiffness_damping: float) -> tuple[float, float]:
    """Highest circular frequency [rad/s] and stiffness damping [s] of closed joints and links together, at most."""
    if added == LinkStiffness(0.0, 0.0):
        return omega, stiffness_damping
    whole = math.hypot(omega, added.frequency)
    return whole, (stiffness_damping * omega**2 + added.rate) / whole**2


def link_snapshot(records: np.ndarray, lane: int) -> np.ndarray:
    """Forces, slips, elongations and directions of all links of a lane now, in the order of histories, and their largest
    shear and tension so far, shape (7, m)."""
    fx, fy, *rest = (records[name][:, lane] for name in ("fx", "fy", "ft", "slip", "long", "peak", "pull"))
    return np.stack((np.hypot(fx, fy), *rest[:3], np.arctan2(fy, fx), *rest[3:]))


def link_measures(links: Sequence[PlacedLink], records: Any, lane: int, step: float) -> tuple[LinkMeasures, ...]:
    """Results of a run for each of the links, whose records these are; ``step`` is that of time [s]."""
    measures = []
    for m, link in enumerate(links):
        when = int(records["when"][m, lane])
        shear, pull, far, most = (float(records[name][m, lane]) for name in ("peak", "pull", "far", "most"))
        measures.append(
            LinkMeasures(
                link.name, link.kind, link.joint, math.nan if when < 0 else when * step, shear, pull, far, most,
                link.shear_capacity, link.axial_capacity, "stone" if link.breaks_stone else "link",
            )
        )  # fmt: skip
    return tuple(measures)


def link_histories(states: Sequence[dict[str, Any]]) -> LinkHistories | None:
    """Histories of the links, where the states of a run hold them."""
    if "links" not in states[0]:
        return None
    *series, peak, pull = np.array([state["links"] for state in states]).transpose(1, 0, 2)
    reached = np.array([np.argmax(history >= history[-1], axis=0) for history in (peak, pull)])
    return LinkHistories(*series, reached=reached)


def with_link_histories(histories: Histories, states: Sequence[dict[str, Any]]) -> Histories:
    """Histories with those of the links, where the states of a run hold them."""
    links = link_histories(states)
    return histories if links is None else replace(histories, links=links)


def pretension_energy(column: Column) -> float:
    """Elastic energy of pretensioned links [J]."""
    return sum(0.5 * link.pretension**2 / link.axial_stiffness for link in acting(column) if link.pretension)


def without_tension(column: Column) -> Column:
    """The column with those of its links alone that hold nothing at the start."""
    pairs = zip(column.links, column.placed_links, strict=True)
    return column.replace(links=tuple(link for link, placed in pairs if not placed.pretension))


def set_free(column: Column, tensions: np.ndarray, pressed: float) -> float:
    """Energy that pretensioned links and the joints that they press have given away since the start [J].

    ``tensions`` are those of the links now [N], shape (m,). What the joints had, ``pressed`` [J], falls with the square of
    the tension; they are taken to have lost as much of it as the link that has lost most.
    """
    free = least = 0.0
    for m, link in enumerate(acting(column)):
        if link.pretension:
            remaining = min(float(tensions[m]) / link.pretension, 1.0) ** 2
            free += 0.5 * link.pretension**2 / link.axial_stiffness * (1.0 - remaining)
            least = max(least, 1.0 - remaining)
    return free + least * max(pressed, 0.0)
