"""Blocks, joints and laws of an assembly as its kernel wants them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...column.assembly import Assembly, Block, smallest_turn
from ...column.joint import Joint

#: Relative rotation from which a joint's faces are a bed like all others [rad].
LAST_ROTATION = math.radians(50.0)


def fill_body(record: Any, block: Block, assembly: Assembly) -> np.ndarray:
    """Fill the record of a body at rest; returns its corners from its centroid [m]."""
    mass, inertia = block.properties[:2]
    x, z = block.origin
    local = block.corners - (x, z)
    record["x"], record["z"], record["c"], record["depth"] = x, z, 1.0, block.depth
    if not block.fixed:
        record["m"], record["i"], record["im"], record["ii"] = mass, inertia, 1.0 / mass, 1.0 / inertia
    else:
        record["depth"] = 1e9  # a contact is as deep as the moving body
    record["r"] = float(np.hypot(local[:, 0], local[:, 1]).max())
    return local


def fill_joint(
    e: Any, bodies: tuple[Block, ...], body: np.ndarray, lower: int, upper: int, low_face: int, up_face: int, law: Joint
) -> None:
    """Fill the record of a joint between two faces, given by their bodies and the numbers of the faces."""
    # the lower body's face runs against its own direction, the upper one's along: both left to right, normal upward
    right, left = bodies[lower].corners[low_face], np.roll(bodies[lower].corners, -1, axis=0)[low_face]
    t = (right - left) / math.hypot(*(right - left))
    foot = left - (body["x"][lower], body["z"][lower])
    e["lower"], e["upper"], e["live"], e["weight"] = lower, upper, 1, 1.0
    e["lc"], e["ls"] = t
    e["ht"] = float(foot[1] * t[0] - foot[0] * t[1])
    e["wl"] = -float(foot @ t)
    e["wr"] = math.hypot(*(right - left)) - e["wl"]
    left, right = bodies[upper].corners[up_face], np.roll(bodies[upper].corners, -1, axis=0)[up_face]
    t = (right - left) / math.hypot(*(right - left))
    foot = left - (body["x"][upper], body["z"][upper])
    e["uc"], e["us"] = t
    e["hb"] = -float(foot[1] * t[0] - foot[0] * t[1])
    e["bl"] = -float(foot @ t)
    e["br"] = math.hypot(*(right - left)) - e["bl"]
    depth = min(body["depth"][lower], body["depth"][upper])
    e["kn"], e["ks"], e["co"] = law.normal_stiffness * depth, law.shear_stiffness * depth, law.cohesion * depth
    e["mu"] = law.tan_phi
    # the next faces come down on each other where the joint has turned as far as the outlines do at its ends
    last = min(LAST_ROTATION, 0.9 * smallest_turn(bodies[lower].corners, low_face, bodies[upper].corners, up_face))
    e["from_c"], e["to_c"] = math.cos(0.7 * last), math.cos(last)
    e["width"] = min(e["wl"] + e["wr"], e["bl"] + e["br"])


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


def no_column() -> tuple[np.ndarray, ...]:
    """Arrays of the lanes through which a column would be looked at: none."""
    from ...kernels.drums import lanes

    types = lanes.block_types(2, False)
    return tuple(np.zeros(0, types[k]) for k in (0, 1, 2, 4, 5))
