"""The boundary law in lanes has the sums of the boundary law, wherever faces are."""

import numpy as np
import pytest
from bodies_in_space import turn

from stylobate.kernels.run_codes import LANES
from stylobate.kernels.space import edges, lane_records
from stylobate.kernels.space.boundary import AREA, EDGE, LOWER, PRESS, boundary
from stylobate.kernels.space.records import LESS, workspace_of_joints
from stylobate.models.shared.lanes import aligned_zeros

TYPES = lane_records.types()


def rectangle(a, b):
    return 0.5 * np.array([[-a, -b], [a, -b], [a, b], [-a, b]])


def hexagon(radius):
    angle = np.arange(6) * np.pi / 3.0 + 0.2
    return radius * np.stack((np.cos(angle), np.sin(angle)), axis=1)


def corners_of(face):
    return (np.zeros((1, 2)), 0, float(face)) if np.isscalar(face) else (face, len(face), 0.0)


def sums_in_lanes(low, up, places, rotations, passing, turning):
    below, many_l, rl = corners_of(low)
    above, many_u, ru = corners_of(up)
    joint, work = aligned_zeros(1, TYPES["joint"]), aligned_zeros(1, TYPES["work"])
    corner, spot = (aligned_zeros(8, TYPES["corner"]) for _ in range(2))
    joint["many_l"], joint["many_u"], joint["rl"], joint["ru"] = many_l, many_u, rl, ru
    corner["x"][: len(below)], corner["y"][: len(below)] = (LESS * below).T[:, :, None]
    for l in range(LANES):
        work["n"][0, :, l], work["c"][0, :, l] = rotations[l][:, 2], places[l]
        work["v"][0, :, l], work["w"][0, :, l] = passing[l], turning[l]
        seen = places[l] + above @ rotations[l][:, :2].T
        for name, values in zip("xyz", seen.T, strict=True):
            spot[name][: len(above), l] = values
    edges.sum_up(work[0], joint[0], corner, spot)
    return work["sums"][0]


def sums_alone(low, up, place, rotation, passing, turning):
    _, arcs, sums = workspace_of_joints()
    below, many_l, rl = corners_of(low)
    above, many_u, ru = corners_of(up)
    seen = place + above @ rotation[:, :2].T
    vectors = (tuple(float(x) for x in a) for a in (rotation[:, 2], place, passing, turning))
    boundary(*vectors, LESS * below, many_l, rl, seen, many_u, ru, arcs, sums)
    return sums


FACES = {
    "disc on disc": (0.5, 0.45),
    "disc on square": (rectangle(0.9, 0.8), 0.45),
    "square on disc": (0.5, rectangle(0.9, 0.6)),
    "square on square": (rectangle(1.0, 0.7), rectangle(0.8, 1.1)),
    "hexagon on square": (rectangle(1.0, 0.7), hexagon(0.5)),
    "small disc on hexagon": (hexagon(0.6), 0.2),
}


@pytest.mark.parametrize(("low", "up"), FACES.values(), ids=FACES)
def test_sums_in_lanes(low, up):
    """At any place, twist and tilt, level too; closed and half open, with rates of depth."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        tilts = rng.normal(size=(LANES, 2)) * rng.choice([1e-2, 1e-4, 0.0], size=(LANES, 1))
        twists = rng.uniform(0.0, 6.0, LANES) * rng.choice([0.0, 1.0], LANES)
        rotations = [turn(*tilt, 0.0) @ turn(0.0, 0.0, twist) for tilt, twist in zip(tilts, twists, strict=True)]
        places = np.column_stack((rng.normal(size=(LANES, 2)) * 0.25, -3e-4 * rng.uniform(-0.3, 1.0, LANES)))
        rates = rng.normal(size=(2, LANES, 3)) * 1e-4 * rng.choice([0.0, 1.0])
        together = sums_in_lanes(low, up, places, rotations, *rates)
        for l in range(LANES):
            alone = sums_alone(low, up, places[l], rotations[l], rates[0, l], rates[1, l])
            assert together[:, l] == pytest.approx(alone, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("half", [0.0, 1.0])
def test_faces_that_touch_in_a_corner_or_along_a_line(half):
    """A disc whose middle is on an edge or a corner of a square, and one inscribed: a half, a quarter, all of it."""
    place = np.array([0.45, 0.45 * half, -1e-4])
    level = [np.eye(3)] * LANES, np.zeros((LANES, 3)), np.zeros((LANES, 3))
    sums = sums_in_lanes(rectangle(0.9, 0.9), 0.3, [place] * LANES, *level)[:, 0]
    share = 0.25 if half else 0.5
    assert 0.5 * sums[AREA] == pytest.approx(share * np.pi * 0.09, rel=1e-7)
    assert sums[EDGE] == pytest.approx(share * np.pi * 0.6 + 0.6, rel=1e-7)
    inscribed = sums_in_lanes(rectangle(0.9, 0.9), 0.45, [np.array([0.0, 0.0, -1e-4])] * LANES, *level)[:, 0]
    assert inscribed[[AREA, EDGE]] == pytest.approx([2.0 * np.pi * 0.2025, np.pi * 0.9], rel=1e-4)
    assert inscribed[[PRESS, LOWER + PRESS]].sum() == pytest.approx(1e-4 * inscribed[EDGE], rel=1e-9)
