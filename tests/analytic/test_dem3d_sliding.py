"""Round drums in space that stand, slide and spin: uplift in any direction, Coulomb's cone, torsion, limit surface."""

import math

import numpy as np
import pytest
from validation.space import block_of, cylinder, put, put_axes, round_column

from stylobate.constants import g
from stylobate.models.base import Case
from stylobate.models.dem3d.pose import rotation
from stylobate.motion import Motion

#: Low discs: no rocking, even pressure.
FLAT = cylinder(1.0, 0.02, 5e8, 0.7)
LOW = cylinder(2.0, 0.1, 5e9, 0.3)


def resistance(column, tilts, law):
    """Largest ratio of the centroid's arm and height about the middle of pressure, over tilts and 16 directions.

    At each tilt the depth is such that the joint carries the weight; this is the acceleration (in g) that it takes.
    """
    block = block_of(column, law=law)
    block.lane["dt"][:] = 0.0
    height, weight = column.centroid_height, column.mass * column.gravity
    azimuth = np.arange(block.lanes) * (2.0 * math.pi / block.lanes) + 0.1
    h = np.stack([np.cos(azimuth), np.sin(azimuth), np.zeros(block.lanes)])
    best = np.zeros(block.lanes)
    for tilt in tilts:
        turns = [rotation(np.cross([0, 0, 1.0], h[:, lane]), tilt) for lane in range(block.lanes)]
        low, high = -0.5 * column.base_width * math.sin(tilt), 1e-3
        for _ in range(60):
            depth = 0.5 * (low + high)
            for lane, turn in enumerate(turns):
                put_axes(block, 1, lane, turn)
                put(block, 1, lane, "x y z", height * turn[:, 2] - (0.0, 0.0, depth))
            block.kernel.forces(block.drum, block.joint, block.lane)
            carried = block.joint["f"][0, 2]
            low, high = (depth, high) if carried.mean() < weight else (low, depth)
        moment = block.joint["up"][0, :, :] / carried
        # the force acts at P: moment about the centroid = (P − G) × N z
        px, py = -moment[1] + block.drum["x"][1], moment[0] + block.drum["y"][1]
        reach = (px - block.drum["x"][1]) * h[0] + (py - block.drum["y"][1]) * h[1]
        best = np.maximum(best, reach / block.drum["z"][1])
    return best


@pytest.mark.parametrize(
    ("law", "stiffness", "exact", "near"),
    [
        ("rim", 5e10, 0.215922, 1.06e-3),
        ("rim", 5e12, 0.218255, 1.8e-4),
        ("bed", 5e10, 0.206104, 3.45e-3),
        ("bed", 5e12, 0.215315, 8e-4),
    ],
)
def test_static_uplift_in_any_direction(law, stiffness, exact, near):
    """Largest static acceleration of the frustum on its own joint: rigid 0.218694 g, any direction to 1e-6."""
    found = resistance(round_column(stiffness=stiffness), near * np.linspace(0.7, 1.4, 29), law)
    assert found.mean() == pytest.approx(exact, abs=2e-6 if law == "rim" else 1e-5)  # eight strips
    assert np.ptp(found) < 1e-6 * exact


def test_first_decompression_is_at_half_the_radius_over_the_height():
    """The far end of the rim carries nothing any more at g R / (2 b)."""
    column = round_column()
    block = block_of(column)
    block.lane["dt"][:] = 0.0
    closure = column.mass * g / (5e10 * column.joint_areas[0])
    tilt = math.asin(closure / (0.5 * column.base_width))
    put_axes(block, 1, 0, rotation(np.array([0.0, 1.0, 0.0]), tilt))
    axis = block.drum["kx"][1, 0], 0.0, block.drum["kz"][1, 0]
    put(block, 1, 0, "x y z", column.centroid_height * np.array(axis) - (0.0, 0.0, closure))
    block.kernel.forces(block.drum, block.joint, block.lane)
    reach = -block.joint["up"][0, 1, 0] / block.joint["f"][0, 2, 0] + block.drum["x"][1, 0]
    assert reach / column.centroid_height == pytest.approx(0.109347, rel=2e-5)


# -- sliding on a plane ------------------------------------------------------------------------------------------


def slid(ax, ay, duration, dt=1e-4, column=LOW):
    """Slip of the drum over the base and the time at which it last moved, under accelerations given as functions."""
    time = np.arange(round(duration / dt) + 1) * dt
    block = block_of(column, stiffness_damping=1e-4)
    block.load(0, Case(column, Motion(dt, ax(time), ay(time))))
    still, last = np.zeros(2), 0.0
    while not block.is_over(0):
        block.advance(1)
        now = block.since_start(0)[0][0]
        if np.hypot(*(now - still)) > 2e-6:
            still, last = now, block.time(0)
    return now, last


def test_sliding_follows_the_cone_not_the_axes():
    """Constant 0.6 g at 45° for 0.2 s, tan φ = 0.3: (A t²/2)(A/(μ g) − 1) = 0.117720 m, at rest after 0.400 s.

    Limits along each axis of its own would give 0.049 m.
    """
    push = -0.6 * g * math.sqrt(0.5)
    now, last = slid(lambda t: np.where(t < 0.2 - 1e-9, push, 0.0), lambda t: np.where(t < 0.2 - 1e-9, push, 0.0), 0.5)
    assert np.hypot(*now) == pytest.approx(0.117720, rel=2e-3)
    assert abs(now[0] - now[1]) < 1e-6
    assert last == pytest.approx(0.400, abs=3e-3)


def test_sliding_along_a_curve():
    """0.8 g sin 2πt along x for 1 s, the same along y 0.25 s later: (0.0719977, −0.3834036) m."""

    def wave(start):
        return lambda t: 0.8 * g * np.where((t >= start) & (t <= start + 1.0), np.sin(2.0 * np.pi * (t - start)), 0.0)

    now, last = slid(wave(0.0), wave(0.25), 1.8)
    np.testing.assert_allclose(now, (0.0719977, -0.3834036), atol=1e-3)
    assert last == pytest.approx(1.590614, abs=5e-3)


# -- spinning on a plane -----------------------------------------------------------------------------------------


def stopped(speed, spin):
    """When a disc (R 0.5 m, tan φ 0.7) that slides and spins stops, how far it has gone and turned."""
    block = block_of(FLAT, 0.3, stiffness_damping=1e-4, time_step=1e-5)
    put(block, 1, 0, "vx lz wz", (speed, FLAT.drums[0].axial_inertia * spin, spin))
    time = 0.0
    while not block.is_over(0):
        block.advance(1)
        time = block.time(0) if block.drum["wz"][1, 0] > 0.01 * spin else time
    slip, twist = block.since_start(0)
    return time / 0.99, float(np.hypot(*slip[0])), float(twist[0])


def test_spin_alone_stops_as_under_even_pressure():
    """t = 3 R ω / (4 μ g) = 0.273045 s, after 0.682612 rad."""
    time, gone, turned = stopped(0.0, 5.0)
    assert time == pytest.approx(0.27304500, rel=5e-3)
    assert turned == pytest.approx(0.68261249, rel=5e-4)
    assert gone < 1e-6


@pytest.mark.parametrize(
    ("speed", "spin", "time", "distance", "angle"),
    [
        (1.0, 4.0, 0.277154, 0.143221, 0.544001),
        (0.5, 4.0, 0.236071, 0.064928, 0.464029),
        (1.0, 1.5, 0.178268, 0.083720, 0.153844),
    ],
)
def test_sliding_and_spinning_together(speed, spin, time, distance, angle):
    """Exact for a disc under even pressure; one resultant with its limit surface is within 3 % of it."""
    found = stopped(speed, spin)
    assert found == pytest.approx((time, distance, angle), rel=0.03)


def test_without_pivot_friction_a_disc_spins_for_ever():
    block = block_of(FLAT, 0.5, pivot_friction=0.0)
    put(block, 1, 0, "lz wz", (FLAT.drums[0].axial_inertia * 3.0, 3.0))
    while not block.is_over(0):
        block.advance()
    assert block.drum["wz"][1, 0] == pytest.approx(3.0, rel=1e-9)


# -- free flight -------------------------------------------------------------------------------------------------


def test_torque_free_motion_is_exact():
    """A frustum in flight turns about its own axis at (1/C − 1/A) L·k and about L at |L|/A, exactly."""
    column = round_column()
    drum = column.drums[0]
    a, c = drum.inertia, drum.axial_inertia
    block = block_of(column, 2.0, time_step=1e-4)
    block.joint["kn"][:] = block.joint["ks"][:] = 0.0
    momentum = np.array([a * 0.3, 0.0, c * 2.0])
    put(block, 1, 0, "lx ly lz", momentum)
    put(block, 1, 0, "wx wy wz", (0.3, 0.0, 2.0))
    start = 30.0
    put(block, 1, 0, "z", (start,))
    put(block, 1, 0, "vz", (0.5 * block.dt[0] * g,))
    while not block.is_over(0):
        block.advance()
        t = block.time(0)
        size = np.linalg.norm(momentum)
        own = rotation(np.array([0.0, 0.0, 1.0]), t * (1.0 / c - 1.0 / a) * momentum[2])
        exact = rotation(momentum / size, t * size / a) @ own
        np.testing.assert_allclose(block.axes(0)[0], exact, rtol=0, atol=1e-11)
        assert block.drum["z"][1, 0] - start == pytest.approx(-0.5 * g * t * t, abs=1e-10)
    np.testing.assert_allclose(block.axes(0)[0][:, 2], (0.0490528923, -0.5618948374, 0.8257529930), rtol=0, atol=1e-9)
    np.testing.assert_array_equal([block.drum["l" + n][1, 0] for n in "xyz"], momentum)
