"""Twins of an assembly in space: contacts, densities and places that could as well be those of its stones."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from ...errors import InputError
from ..joint import Joint
from ..links.link import Link
from ..scatter import Scatter, factors_of, normal
from .assembly import SpatialAssembly

#: A joint whose normal is inclined to the vertical by less than this slides without pushing its bodies apart [rad].
LEVEL = 1e-3

#: Offsets are halved so many times where moved stones would overlap; then the twin has none.
HALVED = 4


def drawn_assembly(
    assembly: SpatialAssembly, size: Scatter, stream: np.random.Generator, k: int, space: bool
) -> tuple[SpatialAssembly, float]:
    """Assembly number k that could as well stand there; its stones fit one another, so that none is wider or higher.

    A stone's deviations are those of its name, so that it has the same ones in every state of what stands. Beside it the
    share of its offsets that is left: 1 where its stones fit as drawn.
    """
    del space
    common, seed = normal(stream, 3), int(stream.integers(2**62))
    own = [normal(np.random.default_rng([seed, *stone.name.encode()]), 7) for stone in assembly.stones]
    rough, stiff, dense, _, _, shifts = factors_of(size, common, np.stack(own, axis=1))
    return varied(assembly, rough, stiff, dense, size.offset * shifts.T, f"{assembly.name}, twin {k + 1}")


def varied(
    assembly: SpatialAssembly, rough: np.ndarray, stiff: np.ndarray, dense: np.ndarray, shifts: np.ndarray, name: str
) -> tuple[SpatialAssembly, float]:
    """The assembly with every stone's contacts and density multiplied by factors of its own, and groups of stones shifted.

    Stones that touch otherwise than on level faces move together, and with what is fixed not at all. Where shifted stones
    would overlap all shifts are halved, in the end left out; what share of them is left stands beside it.

    Parameters
    ----------
    assembly : SpatialAssembly
    rough, stiff, dense : array
        Of the friction coefficient and both stiffnesses of each stone's contacts with those before it, and of its density
        [-], shape (n,).
    shifts : array
        Of each stone in plan, over the side of a square as large as the smallest joint of its group [-], shape (n, 2); of a
        group the first counts.
    name : str
        Of the new assembly.
    """
    first = len(assembly.bodies) - len(assembly.stones)
    stones = tuple(
        dataclasses.replace(
            stone, density=stone.density * dense[i], surface=_law(stone.surface or assembly.joint, rough[i], stiff[i])
        )
        for i, stone in enumerate(assembly.stones)
    )
    numbers = {body.name: i - first for i, body in enumerate(assembly.bodies)}
    overrides = []
    for one, other, law in assembly.overrides:
        later = max(numbers[one], numbers[other])
        overrides.append((one, other, _law(law, rough[later], stiff[later])))
    moved = _shifts(assembly, shifts, first)
    changes: dict[str, Any] = {"overrides": tuple(overrides), "name": name}
    for halved in range(HALVED + 1):
        share = 0.0 if halved == HALVED else 0.5**halved
        placed = tuple(_placed(stone, share * way) for stone, way in zip(stones, moved, strict=True))
        ways = {stone.name: share * way for stone, way in zip(stones, moved, strict=True)}
        links = tuple(_carried(link, ways) for link in assembly.links)
        try:
            return dataclasses.replace(assembly, stones=placed, links=links, **changes), share
        except InputError:
            if not share or not moved.any():
                raise
    raise AssertionError  # the last share is 0: the assembly as it is


def _law(law: Joint, rough: float, stiff: float) -> Joint:
    return law.changed(
        normal_stiffness=law.normal_stiffness * stiff,
        shear_stiffness=law.shear_stiffness * stiff,
        friction_coefficient=law.tan_phi * rough,
    )


def _placed(stone: Any, way: np.ndarray) -> Any:
    if not way.any():
        return stone
    x, y, z = stone.position
    return dataclasses.replace(stone, position=(x + float(way[0]), y + float(way[1]), z))


def _carried(link: Link, ways: Mapping[str, np.ndarray]) -> Link:
    """A link whose ends move with their stones in plan; what lies in a joint, with the first of both."""
    ends = {
        name: (float(place[0] + way[0]), float(place[1] + way[1]), place[2])
        for name, place, body in zip(("at", "to"), link.ends, link.between or (), strict=False)
        if place is not None and (way := ways.get(body, np.zeros(2))).any()
    }
    return dataclasses.replace(link, **ends) if ends else link


def _shifts(assembly: SpatialAssembly, shifts: np.ndarray, first: int) -> np.ndarray:
    """Shift of each stone in plan [m], shape (n, 2)."""
    group = _groups(assembly, first)
    narrowest: dict[int, float] = {}
    for joint in assembly.space_joints:
        for i in (joint.lower - first, joint.upper - first):
            if i >= 0:
                narrowest[group[i]] = min(narrowest.get(group[i], np.inf), float(np.sqrt(joint.area)))
    held = {group[i] for i, stone in enumerate(assembly.stones) if stone.fixed} | {-1}
    return np.array(
        [
            np.zeros(2) if one in held else narrowest.get(one, 0.0) * shifts[one]
            for one in group
        ]
    )  # fmt: skip


def _groups(assembly: SpatialAssembly, first: int) -> list[int]:
    """Of each stone the first of its group, by number; −1 of those that move with the ground."""
    group = list(range(len(assembly.stones)))
    level = {}
    for joint in assembly.space_joints:
        pair = joint.lower - first, joint.upper - first
        flat = bool(abs(joint.frame[2, 2]) > np.cos(LEVEL))
        level[pair] = flat and level.get(pair, True)
    for lower, upper in assembly.touching:
        pair = lower - first, upper - first
        if level.get(pair, False):
            continue
        one, other = (-1 if i < 0 else group[i] for i in pair)
        group = [min(one, other) if mine in (one, other) else mine for mine in group]
    return group
