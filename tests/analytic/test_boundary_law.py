"""The boundary law of a joint: sums over the edge of the overlap of two faces, against brute force and closed forms."""

import math

import numpy as np
import pytest
from bodies_in_space import turn

from stylobate.kernels.dem3d import rim
from stylobate.kernels.space.boundary import AREA, EDGE, FIRST, LOWER, PRESS, SECOND, SQUARE, boundary
from stylobate.kernels.space.records import LESS, workspace_of_joints

NONE = np.zeros((0, 2))


def rectangle(a, b):
    return 0.5 * np.array([[-a, -b], [a, -b], [a, b], [-a, b]])


def hexagon(radius):
    angle = np.arange(6) * math.pi / 3.0 + 0.2
    return radius * np.stack((np.cos(angle), np.sin(angle)), axis=1)


def sums_of(low, up, place, rotation):
    """Sums over the edge; a face is its corners, or a radius."""
    _, arcs, sums = workspace_of_joints()
    corners = [np.zeros((1, 2)) if np.isscalar(face) else face for face in (low, up)]
    many = [0 if np.isscalar(face) else len(face) for face in (low, up)]
    radii = [float(face) if np.isscalar(face) else 0.0 for face in (low, up)]
    place = np.array(place, dtype=float)
    above = place + corners[1] @ rotation[:, :2].T
    still = 0.0, 0.0, 0.0
    boundary(
        tuple(rotation[:, 2]),
        tuple(place),
        still,
        still,
        LESS * corners[0],
        many[0],
        radii[0],
        above,
        many[1],
        radii[1],
        arcs,
        sums,
    )
    return sums


def edge_of(face, count=40_000):
    """Points on the edge of a face, and the length of edge that each stands for."""
    if np.isscalar(face):
        angle = (np.arange(count) + 0.5) * (2.0 * math.pi / count)
        points = face * np.stack((np.cos(angle), np.sin(angle)), axis=1)
        return points, np.full(count, 2.0 * math.pi * face / count)
    share = ((np.arange(count // 4) + 0.5) / (count // 4))[:, None]
    pieces = list(zip(face, np.roll(face, -1, axis=0), strict=True))
    points = np.concatenate([a + (b - a) * share for a, b in pieces])
    return points, np.concatenate([np.full(len(share), np.linalg.norm(b - a) / len(share)) for a, b in pieces])


def over(points, face):
    if np.isscalar(face):
        return np.hypot(*points.T) < face
    inside = np.ones(len(points), dtype=bool)
    for a, b in zip(face, np.roll(face, -1, axis=0), strict=True):
        (ex, ey), (x, y) = b - a, (points - a).T
        inside &= ex * y - ey * x > 0.0
    return inside


def brute(low, up, place, rotation):
    """The same sums over many points of both edges; faces lean little."""
    out = np.zeros(16)
    for at, points, lengths in ((0, *edge_of(up)), (LOWER, *edge_of(low))):
        if at == 0:
            there = place + points @ rotation[:, :2].T
            depth, inside = -there[:, 2], over(there[:, :2], low)
        else:
            there = np.column_stack((points, np.zeros(len(points))))
            depth = (there - place) @ rotation[:, 2]
            inside = over(((there - place) @ rotation)[:, :2], up)
        weight = lengths * np.where(inside, np.maximum(depth, 0.0), 0.0)
        out[at + PRESS] = weight.sum()
        out[at + FIRST : at + FIRST + 3] = weight @ there
        out[at + SECOND] = weight @ (there**2).sum(axis=1)
        out[at + SQUARE] = weight @ np.maximum(depth, 0.0)
        out[EDGE] += lengths[inside].sum()
    return out


FACES = {
    "disc on disc": (0.5, 0.45),
    "disc on square": (rectangle(0.9, 0.8), 0.45),
    "square on disc": (0.5, rectangle(0.9, 0.6)),
    "square on square": (rectangle(1.0, 0.7), rectangle(0.8, 1.1)),
    "hexagon on square": (rectangle(1.0, 0.7), hexagon(0.5)),
}


@pytest.mark.parametrize(("low", "up"), FACES.values(), ids=FACES)
def test_sums_over_the_edge_of_the_overlap(low, up):
    """Random offsets, twists and tilts, half open too; the quadrature's own error is 2e-4."""
    rng = np.random.default_rng(1)
    for _ in range(12):
        rotation = turn(*rng.normal(size=2) * 1e-3, 0.0) @ turn(0.0, 0.0, rng.uniform(0.0, 6.0))
        place = np.array([*rng.normal(size=2) * 0.25, -3e-4 * rng.uniform()])
        sums, exact = sums_of(low, up, place, rotation), brute(low, up, place, rotation)
        total = exact[PRESS] + exact[LOWER + PRESS]
        assert sums[EDGE] == pytest.approx(exact[EDGE], rel=1e-3)
        for at in (0, LOWER):
            assert sums[at : at + 5] == pytest.approx(exact[at : at + 5], abs=1e-3 * total + 1e-12)
            assert sums[at + SQUARE] == pytest.approx(exact[at + SQUARE], abs=1e-3 * total * 1e-3)


def test_disc_on_disc_is_the_rim_law():
    """The rim law's own integrals, to the last bits."""
    ru, rl, tilt, azimuth = 0.45, 0.5, 2e-3, 0.7
    rotation = turn(-tilt * math.sin(azimuth), tilt * math.cos(azimuth), 0.0)
    place = np.array([0.12, -0.07, -2e-4])
    sums = sums_of(rl, ru, place, rotation)
    n = rotation[:, 2]
    lean = n[:2] / np.hypot(*n[:2])
    s = math.hypot(*place[:2])
    along, across = place[:2] @ lean / s, (place[1] * lean[0] - place[0] * lean[1]) / s
    arcs = rim.overlap(ru * n[2], rl, s)
    sine = math.hypot(*n[:2])
    _, upper, *_ = rim.press_askew(-place[2], ru * sine, 0.0, -along, -across, *arcs[:3])
    _, lower, *_ = rim.press_askew(-place @ n, rl * sine, 0.0, along, across, *arcs[3:6])
    assert sums[PRESS] == pytest.approx(ru * upper, rel=1e-13)
    assert sums[LOWER + PRESS] == pytest.approx(rl * lower, rel=1e-13)
    assert [0.5 * sums[AREA], sums[EDGE]] == pytest.approx(arcs[6:], rel=1e-13)


def bending(low, up, angle=1e-5, twist=0.0):
    """Moment over k_n at a tilt about x of faces that are closed all over, over the tilt, and the force over the depth."""
    rotation = turn(angle, 0.0, 0.0) @ turn(0.0, 0.0, twist)
    sums = sums_of(low, up, (0.0, 0.0, -1e-3), rotation)
    rho = 0.5 * sums[AREA] / sums[EDGE]
    z, n = np.array([0.0, 0.0, 1.0]), rotation[:, 2]
    first = sums[FIRST : FIRST + 3], sums[LOWER + FIRST : LOWER + FIRST + 3]
    moment = rho * (np.cross(first[0], z) + np.cross(first[1], n))
    return -moment[0] / angle, rho * (sums[PRESS] + sums[LOWER + PRESS]) / 1e-3


def test_bending_stiffness():
    """2 k_n J of discs and squares, (3 b + a)/(a + b) of a rectangle bent along its side a; the force is k_n A depth."""
    assert bending(0.5, 0.5) == pytest.approx((2.0 * math.pi * 0.5**4 / 4.0, math.pi * 0.25), rel=1e-6)
    for a, b in ((1.0, 1.0), (1.3, 0.7), (0.2, 4.0)):
        face = rectangle(b, a)
        exact = (3.0 * b + a) / (a + b) * b * a**3 / 12.0, a * b
        assert bending(face, face) == pytest.approx(exact, rel=1e-6)


def test_no_jump_with_the_twist():
    """Corners of the overlap come and go; the moment does not jump by 1e-6 of itself."""
    face = rectangle(0.8, 0.8)
    flush = bending(face, face)[0]
    assert [bending(face, face, twist=twist)[0] for twist in (1e-12, 1e-9, 1e-6)] == pytest.approx(
        [flush] * 3, rel=3e-6
    )
    assert bending(face, face, twist=0.1)[0] == pytest.approx(0.6152117 / 0.6826667 * flush, rel=1e-5)


@pytest.mark.parametrize("twist", [0.0, 1e-9])
def test_of_edges_that_lie_on_one_another_it_does_not_matter_which_is_inside(twist):
    """One face is moved by 1e-9 of its size to either side: the pressure turned by an eighth of the tilt between both.

    Half of such an edge presses along either normal. What is left is the way, over 1e-5 of the edge's length.
    """
    angle, depth, face, sums = 3e-5, 5e-5, rectangle(1.0, 0.8), []
    rotation = turn(angle, 0.0, 0.0) @ turn(0.0, 0.0, twist)
    for way in (-1.0, 1.0):
        place = np.array([1e-9 * way, 1e-9 * way, -depth])
        sums.append(sums_of(face, face, place, rotation))
    z, n = np.array([0.0, 0.0, 1.0]), rotation[:, 2]
    force, other = (integrals[PRESS] * z + integrals[LOWER + PRESS] * n for integrals in sums)
    assert np.abs(force - other).max() < 1e-3 * angle * force[2]
    assert force[2] == pytest.approx(3.6 * depth, rel=1e-6)


def test_a_small_face_inside_a_large_one():
    """Its whole edge carries, whichever of both is below."""
    small, large = rectangle(0.6, 0.4), rectangle(3.0, 2.0)
    for low, up in ((small, large), (large, small), (0.3, large), (large, 0.3)):
        area = 0.24 if low is small or up is small else math.pi * 0.09
        sums = sums_of(low, up, (0.0, 0.0, -1e-3), np.eye(3))
        assert 0.5 * sums[AREA] == pytest.approx(area, rel=1e-9)
        assert sums[PRESS] + sums[LOWER + PRESS] == pytest.approx(1e-3 * sums[EDGE], rel=1e-9)
