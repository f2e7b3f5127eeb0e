"""Blocks of an assembly in the numbers of the engine in the plane: bodies, joints, the bed, how joints hand over to it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...column.assembly import Assembly, smallest_turn
from ...column.joint import Joint
from .links import acting_between
from .packing import Topology, joint_fields

#: Relative rotation from which a joint's faces are a bed like all others [rad].
LAST_ROTATION = math.radians(50.0)


def topology_of(assembly: Assembly, stack: int = 0) -> Topology:
    """Which contacts an assembly has; with a column of so many drums that is looked at."""
    fixed = tuple(i for i, block in enumerate(assembly.bodies) if block.fixed)
    joints = tuple((one.lower, one.upper) for one in assembly.joints)
    links = tuple((one.lower, one.upper) for one in acting_between(assembly))
    return Topology(len(assembly.bodies), joints, links, fixed, stack, acting_between(assembly))


def fill_bodies(records: Any, assembly: Assembly) -> None:
    """Fill records of one lane with the bodies at rest."""
    for record, block in zip(records, assembly.bodies, strict=True):
        mass, inertia = block.properties[:2]
        record["x"], record["z"] = block.origin
        record["c"] = 1.0
        if not block.fixed:
            record["m"], record["i"], record["im"], record["ii"] = mass, inertia, 1.0 / mass, 1.0 / inertia


def fill_shapes(records: Any, assembly: Assembly) -> np.ndarray:
    """Fill records of shapes; returns the corners of all bodies, one after another, each from its centroid [m]."""
    corners = [block.corners - block.origin for block in assembly.bodies]
    counts = [len(one) for one in corners]
    records["first"], records["count"] = np.cumsum([0, *counts])[:-1], counts
    # a contact with what moves with the ground is as deep as the moving body
    records["depth"] = [1e9 if block.fixed else block.depth for block in assembly.bodies]
    records["r"] = [float(np.hypot(one[:, 0], one[:, 1]).max()) for one in corners]
    return np.concatenate(corners)


def fill_joints(records: Any, hands: Any, assembly: Assembly) -> None:
    """Fill records of one lane of all joints, and how each hands over."""
    pairs, bodies = assembly.face_pairs, assembly.bodies
    kn, ks = (np.array([getattr(one.law, name) for one in pairs]) for name in ("normal_stiffness", "shear_stiffness"))
    for name, values in joint_fields(assembly, kn, ks).items():
        records[name][:, 0] = values
    for h, pair, (lower, upper, below, above, _) in zip(hands, pairs, assembly.joints, strict=True):
        # the next faces come down on each other where the joint has turned as far as the outlines do at its ends
        last = min(LAST_ROTATION, 0.9 * smallest_turn(bodies[lower].corners, below, bodies[upper].corners, above))
        h["live"], h["weight"] = 1, 1.0
        h["from_c"], h["to_c"] = math.cos(0.7 * last), math.cos(last)
        h["width"] = min(pair.below.width, pair.above.width)


def bed_laws(assembly: Assembly) -> np.ndarray:
    """k_n, k_s [N/m³] and tan φ of the bed between any two bodies, shape (N, N, 3); the pair's lower number first."""
    bodies = assembly.bodies
    names = {block.name: i for i, block in enumerate(bodies)}
    laws = np.empty((len(bodies), len(bodies), 3))

    def numbers(law: Joint) -> tuple[float, float, float]:
        return law.normal_stiffness, law.shear_stiffness, law.tan_phi

    for i, block in enumerate(bodies):
        laws[:, i] = numbers(block.surface or assembly.joint)
    for one, other, law in assembly.overrides:
        if one in names and other in names:
            i, h = sorted((names[one], names[other]))
            laws[i, h] = numbers(law)
    for one in assembly.placed_links:
        i, h = sorted((one.lower, one.upper))
        laws[i, h] = numbers(assembly.law_between(bodies[i], bodies[h]))
    return laws
