"""Limit analysis of assemblies in space: what horizontal forces in a direction they bear, and who moves at more."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ..column.structure import Structure
from ..constants import DEGREE
from ..errors import InputError
from ..messages import joined, say
from ..models.rigid_block.block_stack import LINE, Hold, holds
from .contact_programme import ContactProgramme
from .contact_rims import Holder, Rim
from .limit import DirectionLimit
from .limit_with_links import demand, held_along
from .programme_choices import gentlest

#: What moves with more than this share of the fastest takes part in the mechanism [-].
MOVES = 1e-3

#: Most joints, and what the programme of so many takes in one direction [s]; it grows with their number to this power.
MOST_JOINTS, TAKES, GROWS = 800, 180.0, 2.5

#: Most bodies that a sentence names.
NAMED = 4


class AssemblyProgramme:
    """The programme of an assembly: what has been added for one direction stays for the next.

    Parameters
    ----------
    structure : SpatialAssembly

    Raises
    ------
    InputError
        It does not stand under its own weight, or only rests on edges and corners.
    """

    def __init__(self, structure: Structure) -> None:
        joints = structure.space_joints or ()
        if len(joints) > MOST_JOINTS:
            minutes = TAKES / 60.0 * (len(joints) / MOST_JOINTS) ** GROWS
            raise InputError(
                f"{structure.name!r} has {len(joints)} joints, whose limit analysis would take about {minutes:.0f} minutes "
                f"a direction; allowed are up to {MOST_JOINTS}: take a part of it."
            )
        if not structure.gravity:
            raise InputError(
                f"{structure.name!r} has no gravity, in parts of which forces are told; give it one [m/s²]."
            )
        bodies = structure.bodies
        self.structure = structure
        self.moving = [i for i, one in enumerate(bodies) if not one.fixed]
        number = {body: k for k, body in enumerate(self.moving)}
        stones = [bodies[i] for i in self.moving]
        rims = [
            Rim(
                number.get(joint.upper, -1), number.get(joint.lower, -1), joint.frame, joint.origin, joint.edges,
                np.zeros(2), 0.5 * joint.width, joint.law.tan_phi, joint.law.cohesion * joint.area,
            )
            for joint in joints
        ]  # fmt: skip
        holders = [_holder(one, number) for one in holds(structure.placed_links) if one.strength]
        self.points = [stone.vertices for stone in stones]  # pyright: ignore[reportAttributeAccessIssue]
        every = np.concatenate(self.points)
        centroids = np.array([stone.position for stone in stones])  # pyright: ignore[reportAttributeAccessIssue]
        masses = np.array([stone.mass for stone in stones])
        length = float(np.ptp(every, axis=0).max())
        self.programme = ContactProgramme(
            masses, centroids, structure.gravity, rims, holders, length, repr(structure.name), cut=True
        )
        self.dead = self.programme.body_force(np.array([0.0, 0.0, -1.0]))
        self.programme.begin(np.array([1.0, 0.0, 0.0]))
        self._must_stand()

    def _must_stand(self) -> None:
        held = (*(self.structure.space_joints or ()), *self.structure.placed_links)
        resting = {body for one in held for body in (one.lower, one.upper)}
        loose = next((i for i in self.moving if i not in resting), None)
        if loose is not None:
            raise InputError(
                f"block {self.structure.bodies[loose].name!r} rests on no face, only on edges or corners; limit "
                "analysis takes what lies on faces: lay it on one."
            )
        missing, rates = self.programme.unbalanced(self.dead)
        if missing:
            names = self._who(rates)
            raise InputError(
                f"{self.structure.name!r} does not stand under its own weight: {listed(names)} "
                f"{'begins' if len(names) == 1 else 'begin'} to move; correct its geometry or its friction."
            )

    def solve(self, azimuth: float, largest: bool = False) -> DirectionLimit:
        """The limit of horizontal forces in proportion to mass towards an azimuth [degrees].

        With ``largest`` also the most that every link holds then.
        """
        angle, programme = azimuth * DEGREE, self.programme
        push = np.array([math.cos(angle), math.sin(angle), 0.0])
        live = programme.body_force(push)
        found = programme.converged(self.dead, live, programme.capacities)
        rates = gentlest(programme, self.dead, live, found)
        sizes = programme.movements(rates)
        active = np.flatnonzero(sizes.max(axis=1) > MOVES * sizes.max())
        joint = int(min(active, key=lambda k: (round(float(programme.rims[k].origin[2]), 6), k)))
        mode = ("rocking", "sliding", "twisting")[int(np.argmax(sizes[joint]))]
        joints = self.structure.space_joints or ()
        slides = bool((sizes[:, 1] > MOVES * sizes.max()).any())
        twists = any(one.round and size > MOVES * sizes.max() for one, size in zip(joints, sizes[:, 2], strict=True))
        between = joints[joint].lower, joints[joint].upper
        return DirectionLimit(
            azimuth,
            found.multiplier + 0.0,
            joint + 1,
            mode,
            demand(programme, self.dead, live, found, largest),
            between=tuple(self.structure.bodies[i].name for i in between),
            moving=tuple(self._who(rates)),
            upper_bound=slides or twists,
        )

    def _who(self, rates: np.ndarray) -> list[str]:
        """Bodies that move, in their order."""
        fastest = [
            max(float(np.linalg.norm(self.programme.velocity(k, point, rates))) for point in corners)
            for k, corners in enumerate(self.points)
        ]
        most = max(fastest)
        return [self.structure.bodies[i].name for i, one in zip(self.moving, fastest) if one > MOVES * most]


def _holder(hold: Hold, number: Mapping[int, int]) -> Holder:
    """What a link holds, by the numbers of the bodies in the programme."""
    link = hold.link
    bodies = number.get(link.upper, -1), number.get(link.lower, -1)
    if hold.action == LINE:
        low, high = np.array(link.low), np.array(link.high)
        return Holder(hold.name, LINE, *bodies, high, low, ((low - high) / link.length)[:, None], hold.capacity)
    middle = np.array(link.middle)
    axes = held_along(hold, np.array(link.frame).T)
    return Holder(hold.name, hold.action, *bodies, middle, middle, axes, hold.capacity)


def listed(names: Sequence[str]) -> str:
    """Names in a sentence, not too many of them; drums of one column together."""
    groups: dict[str, list[str]] = {}
    for name in names:
        column, _, drum = name.rpartition(", ")
        groups.setdefault(column if column and drum.startswith("drum ") else name, []).append(name)
    alone = [some[0] if len(some) == 1 else "" for some in groups.values()]
    several = [say("{column} ({count} drums)", column=name, count=len(some)) for name, some in groups.items()]
    said = [one or many for one, many in zip(alone, several, strict=True)]
    if len(said) > NAMED:
        return say("{names} and {count} more", names=joined(", ", said[:NAMED]), count=len(said) - NAMED)
    return joined(say(" and "), [joined(", ", said[:-1]), said[-1]])
