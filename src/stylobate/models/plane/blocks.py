"""Blocks of an assembly in the numbers of the engine in the plane: bodies, joints, the bed, how joints hand over to it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...column.assembly import Assembly, Block, smallest_turn
from ...column.joint import Joint
from .links import acting_between
from .packing import Topology

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


def fill_joints(records: Any, hands: Any, assembly: Assembly, depths: np.ndarray) -> None:
    """Fill records of one lane of all joints, and how each hands over; ``depths`` are those of the bodies [m]."""
    for e, h, (lower, upper, low_face, up_face, law) in zip(records, hands, assembly.joints, strict=True):
        _fill_joint(e, h, assembly.bodies, lower, upper, low_face, up_face, law, min(depths[lower], depths[upper]))


def _fill_joint(
    e: Any, h: Any, bodies: tuple[Block, ...], lower: int, upper: int, low_face: int, up_face: int, law: Joint,
    depth: float,
) -> None:  # fmt: skip
    # the lower body's face runs against its own direction, the upper one's along: both left to right, normal upward
    right, left = bodies[lower].corners[low_face], np.roll(bodies[lower].corners, -1, axis=0)[low_face]
    t = (right - left) / math.hypot(*(right - left))
    foot = left - bodies[lower].origin
    e["lc"], e["ls"] = t
    e["ht"] = float(foot[1] * t[0] - foot[0] * t[1])
    e["wl"] = -float(foot @ t)
    e["wr"] = math.hypot(*(right - left)) - e["wl"]
    left, right = bodies[upper].corners[up_face], np.roll(bodies[upper].corners, -1, axis=0)[up_face]
    t = (right - left) / math.hypot(*(right - left))
    foot = left - bodies[upper].origin
    e["uc"], e["us"] = t
    e["hb"] = -float(foot[1] * t[0] - foot[0] * t[1])
    e["bl"] = -float(foot @ t)
    e["br"] = math.hypot(*(right - left)) - e["bl"]
    e["kn"], e["ks"], e["co"] = law.normal_stiffness * depth, law.shear_stiffness * depth, law.cohesion * depth
    e["mu"] = law.tan_phi
    # the next faces come down on each other where the joint has turned as far as the outlines do at its ends
    last = min(LAST_ROTATION, 0.9 * smallest_turn(bodies[lower].corners, low_face, bodies[upper].corners, up_face))
    h["live"], h["weight"] = 1, 1.0
    h["from_c"], h["to_c"] = math.cos(0.7 * last), math.cos(last)
    h["width"] = min(e["wl"][0] + e["wr"][0], e["bl"][0] + e["br"][0])


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
