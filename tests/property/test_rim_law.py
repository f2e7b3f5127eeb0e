"""The rim law against brute force: forces and moments of random poses by summing over the points of both rims."""

import math

import numpy as np
from hypothesis import given, settings, strategies
from validation.space import block_of, joint, put, put_axes, round_column

from stylobate.column import Column, Drum
from stylobate.models.dem3d.packing import rotation

POINTS = 60_000
PHI = (np.arange(POINTS) + 0.5) * (2.0 * math.pi / POINTS)


def pair(ratio: float) -> Column:
    """Two drums; the upper face of the lower one is ``ratio`` times as wide as the lower face of the upper one."""
    drums = [Drum(0.7, 2.0, 0.9 * ratio, 2000.0, "circular"), Drum(0.6, 0.9, 0.8, 2000.0, "circular")]
    return Column.of_drums(drums, joint(5e10, 0.0))


def summed(ru, rl, c, n, stiffness):
    """Force on the upper drum and its moment about the middle of the face below, in the frame of that face."""
    cosine = n[2]
    ra = ru * cosine
    # area and rim of the overlap, from polygons of the two arcs
    ring = np.stack([np.cos(PHI), np.sin(PHI)])
    upper_in = np.hypot(*(c[:2, None] + ra * ring)) < rl
    lower_in = np.hypot(*(rl * ring - c[:2, None])) < ra
    rim = (ra * upper_in.mean() + rl * lower_in.mean()) * 2.0 * math.pi
    outline = np.concatenate(((c[:2, None] + ra * ring)[:, upper_in], (rl * ring)[:, lower_in]), axis=1)
    if outline.shape[1] == 0:
        return np.zeros(3), np.zeros(3)
    middle = outline.mean(axis=1, keepdims=True)
    order = np.argsort(np.arctan2(*(outline - middle)[::-1]))
    x, y = outline[:, order]
    area = 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    # points of both rims; which of them belong to the overlap is told in the plane of the lower face
    sine = math.hypot(n[0], n[1])
    h = np.array([n[0], n[1], 0.0]) / sine
    t = np.cross([0.0, 0.0, 1.0], h)
    d = cosine * h - sine * np.array([0.0, 0.0, 1.0])
    along = np.arctan2(h[1], h[0])
    weight = stiffness * area / rim * 2.0 * math.pi / POINTS
    force, moment = np.zeros(3), np.zeros(3)
    at = c[:, None] + ru * (np.outer(d, np.cos(PHI - along)) + np.outer(t, np.sin(PHI - along)))
    push = weight * ru * np.maximum(-at[2], 0.0) * upper_in
    force[2] += push.sum()
    moment += np.cross(at.T, np.outer(push, [0.0, 0.0, 1.0])).sum(axis=0)
    at = rl * np.stack([*ring, np.zeros(POINTS)])
    push = weight * rl * np.maximum((at - c[:, None]).T @ n, 0.0) * lower_in
    force += push.sum() * n
    moment += np.cross(at.T, np.outer(push, n)).sum(axis=0)
    return force, moment


@settings(max_examples=25, deadline=None)
@given(
    ratio=strategies.sampled_from((0.92, 1.0, 1.08, 2.0)),
    slip=strategies.floats(-4.0, -0.4),
    towards=strategies.floats(-math.pi, math.pi),
    tilt=strategies.floats(-5.0, -0.7),
    depth=strategies.floats(-0.95, 2.5),
    base=strategies.floats(0.0, 0.3),
    turn=strategies.floats(-3.0, 3.0),
)
def test_force_and_moment_of_random_poses(ratio, slip, towards, tilt, depth, base, turn):
    """Any slip, tilt and depth, on a drum that itself leans and is turned. The sum over the rims errs by 1e-4."""
    column = pair(ratio)
    block = block_of(column)
    theta, s = 10.0**tilt, 10.0**slip
    frame = rotation(np.array([0.6, 0.8, 0.0]), base) @ rotation(np.array([0.0, 0.0, 1.0]), turn)
    own = rotation(np.array([math.cos(turn), math.sin(turn), 0.0]), theta)
    ru, rl = 0.45, 0.45 * ratio
    c = np.array([s * math.cos(towards), s * math.sin(towards), -depth * ru * math.sin(theta)])
    if c[2] - ru * math.sin(theta) > 0.0:
        c[2] = 0.0
    lower, upper = column.drums
    put_axes(block, 1, 0, frame)
    put_axes(block, 2, 0, frame @ own)
    place = np.array([0.3, -0.2, 0.4])
    face = place + (lower.height - lower.centroid_height) * frame[:, 2]
    put(block, 1, 0, "x y z", place)
    put(block, 2, 0, "x y z", face + frame @ c + upper.centroid_height * (frame @ own)[:, 2])
    block.lane["dt"][0, 0] = 0.0
    block.records.kernel.forces(block.records.state)
    force, moment = summed(ru, rl, c, own[:, 2], 5e10)
    force, moment = frame @ force, frame @ moment
    actual_force = block.records.load["f"][1, :, 0]
    size = max(np.linalg.norm(force), 1e-9 * 5e10)
    np.testing.assert_allclose(actual_force, force, rtol=0, atol=3e-4 * size)
    about_lower = np.cross(face - place, force) + moment
    about_upper = moment - np.cross(frame @ c + upper.centroid_height * (frame @ own)[:, 2], force)
    np.testing.assert_allclose(-block.records.load["lo"][1, :, 0], about_lower, rtol=0, atol=5e-4 * size)
    np.testing.assert_allclose(block.records.load["up"][1, :, 0], about_upper, rtol=0, atol=5e-4 * size)


def test_faces_that_have_parted_carry_nothing():
    column = pair(1.0)
    block = block_of(column)
    for slip in (0.9, 0.95, 3.0):
        put(block, 2, 0, "x", (slip,))
        put(block, 2, 0, "z", (1.0,))
        block.records.kernel.forces(block.records.state)
        assert np.abs(block.records.load["f"][1, :, 0]).max() < 1e-6
        assert np.isfinite(block.records.load["up"][1, :, 0]).all()


def test_closed_joint_has_its_area_and_twice_its_second_moment():
    """k_n A in closure, 2 k_n J in bending, in any direction and for a slip of nothing or next to nothing."""
    column = round_column(2)
    second = column.joint_second_moments[1]
    for slip in (0.0, 1e-13, 1e-10, 1e-7, 1e-5):
        block = block_of(column)
        block.lane["dt"][:] = 0.0
        weight = column.joint_weights[1]
        z = block.records.body["z"][2, 0]
        for lane in range(block.lanes):
            azimuth = lane * 0.7
            turn = rotation(np.array([math.cos(azimuth), math.sin(azimuth), 0.0]), 1e-7)
            put_axes(block, 2, lane, turn)
            arm = column.drums[1].centroid_height
            put(block, 2, lane, "x y z", arm * (turn[:, 2] - (0, 0, 1)) + (slip, 0.0, z))
        block.records.kernel.forces(block.records.state)
        np.testing.assert_allclose(block.records.load["f"][1, 2], weight, rtol=1e-4)
        bending = [block.records.load["up"][1, c] for c in (0, 1)]
        azimuth = 0.7 * np.arange(block.lanes)
        along = bending[0] * np.cos(azimuth) + bending[1] * np.sin(azimuth)
        np.testing.assert_allclose(along, -2.0 * 5e10 * second * 1e-7, rtol=2e-3)


@settings(max_examples=60, deadline=None)
@given(strategies.floats(-1.0, 1.0))
def test_arc_cosine(x):
    """Polynomial of degree 14 times √(1 − x)."""
    from stylobate.kernels.dem3d.rim import angle_of

    assert abs(angle_of(1.0 - x)[0] - math.acos(1.0 - (1.0 - x))) < 2e-13 + 1e-8 * (abs(x) > 1.0 - 1e-12)
