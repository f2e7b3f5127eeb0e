"""Overlap of two convex polygons: the kernel against a brute-force search over all crossings and contained corners."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stylobate.kernels.plane import clip as near


def kernel_overlap(a, b):
    """Area, centroid and chord as the kernel finds them; the chord is of the part of a's outline in b."""
    work = [np.zeros(near.MOST) for _ in range(4)]
    marks = [np.zeros(near.MOST, dtype=np.int64) for _ in range(2)]
    px, pz, qx, qz = work
    n = near.clip(*a.T.copy(), len(a), *b.T.copy(), len(b), px, pz, marks[0], qx, qz, marks[1])
    if n == 0:
        return 0.0, np.zeros(2), np.zeros(2), np.zeros((0, 2))
    area, cx, cz, gx, gz = near.measure(px, pz, marks[0], n)
    return area, np.array([cx, cz]), np.array([gx, gz]), np.stack((px[:n], pz[:n]), axis=1)


def polygon_area(p):
    q = np.roll(p, -1, axis=0)
    return 0.5 * (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum()


def inside(p, polygon):
    side = np.roll(polygon, -1, axis=0) - polygon
    rel = p - polygon
    return (side[:, 0] * rel[:, 1] - side[:, 1] * rel[:, 0] >= 0.0).all()


def crossings(a, b):
    for p, r in zip(a, np.roll(a, -1, axis=0) - a, strict=True):
        for q, s in zip(b, np.roll(b, -1, axis=0) - b, strict=True):
            det = r[0] * s[1] - r[1] * s[0]
            if det == 0.0:
                continue
            w = q - p
            t, u = (w[0] * s[1] - w[1] * s[0]) / det, (w[0] * r[1] - w[1] * r[0]) / det
            if 0.0 <= t <= 1.0 and 0.0 <= u <= 1.0:
                yield p + t * r


def brute_overlap(a, b):
    """The same from all corners of one polygon in the other and all crossings of their sides, sorted round their mean."""
    points = [p for p in a if inside(p, b)] + [p for p in b if inside(p, a)] + list(crossings(a, b))
    if len(points) < 3:
        return 0.0, None
    points = np.array(points)
    rel = points - points.mean(axis=0)
    points = points[np.argsort(np.arctan2(rel[:, 1], rel[:, 0]))]
    p = points - points[0]
    q = np.roll(p, -1, axis=0)
    cross = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    area = 0.5 * cross.sum()
    if area <= 0.0:
        return 0.0, None
    return area, points[0] + ((p + q) * cross[:, None]).sum(axis=0) / (6.0 * area)


def turned(p, angle):
    c, s = math.cos(angle), math.sin(angle)
    return p @ np.array([[c, s], [-s, c]])


def polygon(rng):
    """Corners on an ellipse, counter-clockwise: convex."""
    steps = np.cumsum(rng.uniform(0.2, 1.0, rng.integers(3, 9)))
    turns = 2.0 * math.pi * steps / steps[-1]
    return np.stack((rng.uniform(0.2, 2.0) * np.cos(turns), rng.uniform(0.2, 2.0) * np.sin(turns)), axis=1)


def a_pair(rng, kind, tilt, depth):
    """Two polygons anywhere; or face to face, parallel but for ``tilt``; or corner to corner; ``depth`` deep."""
    a, b = polygon(rng), polygon(rng)
    if kind == "anywhere":
        return a, turned(b, rng.uniform(-math.pi, math.pi)) + rng.uniform(-2.0, 2.0, 2)
    i, k = rng.integers(len(a)), rng.integers(len(b))
    if kind == "faces":
        fa, fb = a[(i + 1) % len(a)] - a[i], b[(k + 1) % len(b)] - b[k]
        b = turned(b, math.atan2(-fa[1], -fa[0]) - math.atan2(fb[1], fb[0]) + tilt)
        b = b - b[k] + a[i] + rng.uniform(0.05, 1.0) * fa
        inward = np.array([-fa[1], fa[0]]) / math.hypot(*fa)
    else:
        b = turned(b, rng.uniform(-math.pi, math.pi))
        b, inward = b - b[k] + a[i], -a[i] / math.hypot(*a[i])
    return a, b + depth * inward


@settings(max_examples=250, deadline=None)
@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from(["anywhere", "faces", "corners"]),
    st.integers(-9, -1),
    st.integers(-8, -1),
)
def test_overlap_is_that_of_a_brute_force_search(seed, kind, tilt, depth):
    rng = np.random.default_rng(seed)
    for _ in range(40):  # 10 000 pairs in all
        angle = rng.uniform(-1.0, 1.0) * 10.0**tilt
        a, b = a_pair(rng, kind, angle, 10.0**depth)
        area, centre, chord, outline = kernel_overlap(a, b)
        expected, expected_centre = brute_overlap(a, b)
        assert area == pytest.approx(expected, rel=1e-6, abs=1e-13)
        if expected > 1e-9:
            width = np.ptp(outline, axis=0).max()
            assert centre == pytest.approx(expected_centre, abs=1e-6 * width + 1e-12 * width / expected)
        # the other polygon's part of the outline closes the loop: equal and opposite chords
        other, _, opposite, _ = kernel_overlap(b, a)
        assert other == pytest.approx(area, rel=1e-6, abs=1e-13)
        if area < 0.1 * min(polygon_area(a), polygon_area(b)):  # the outlines cross, none lies in the other
            # where faces cross at a small angle, rounding moves the crossing by itself over the angle
            sharp = 1.0 if kind != "faces" else max(abs(angle), 1e-10)
            assert chord == pytest.approx(-opposite, abs=1e-9 + 4e-15 / sharp)


def test_the_oracle_sees_overlaps_and_gaps():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    assert brute_overlap(square, square + np.array([0.75, 0.5])) == (pytest.approx(0.125), pytest.approx([0.875, 0.75]))
    assert brute_overlap(square, square + np.array([1.5, 0.0]))[0] == 0.0


@pytest.mark.parametrize("angle", [0.0, 0.1, 0.7])
def test_depth_square_is_the_integral_over_the_chord(angle):
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    floor = np.array([[-5.0, -5.0], [5.0, -5.0], [5.0, 0.0], [-5.0, 0.0]])
    block = turned(square, angle) - (0.0, 0.05)
    _, _, chord, outline = kernel_overlap(block, floor)
    along = chord / math.hypot(*chord)
    integral = near.depth_square(*outline.T.copy(), len(outline), *along)
    s = np.linspace(-1.0, 2.0, 400_001)
    sides = np.stack([block, np.roll(block, -1, axis=0)], axis=1)
    depth = np.zeros_like(s)
    for p, q in sides:
        if p[0] != q[0]:
            t = (s - p[0]) / (q[0] - p[0])
            z = p[1] + t * (q[1] - p[1])
            depth = np.where((t >= 0.0) & (t <= 1.0), np.maximum(depth, -z), depth)
    assert integral == pytest.approx(np.trapezoid(depth**2, s), rel=1e-4)
