"""Closed forms of a round face on a plane: uplift in any direction, Coulomb's cone, spin, slide, wobbling and flight."""

import math

import numpy as np

from stylobate.constants import g
from stylobate.models.base import Case as Run
from stylobate.models.dem3d.packing import rotation
from stylobate.motion import Motion

from .case import AtMost, Case, Near, collected
from .space import axis_of, block_of, cylinder, put, put_axes, released, rolling, round_column, wobble

CASES: list[Case] = []
case = collected("closed forms", CASES)

#: Low discs: no rocking, even pressure.
FLAT = cylinder(1.0, 0.02, 5e8, 0.7)
LOW = cylinder(2.0, 0.1, 5e9, 0.3)

#: Tilts over the one of the largest resistance.
TILTS = np.linspace(0.7, 1.4, 29)

#: What uplift is held against.
RIGID_UPLIFT = "on its joint by hand; rigid 0.218694 g"


def resistance(column, tilts, law):
    """Largest ratio of the centroid's arm and height about the middle of pressure, over tilts and 16 directions.

    At each tilt the depth is such that the joint carries the weight; this is the acceleration (in g) that it takes.
    """
    block = block_of(column, law=law)
    block.lane["dt"][:] = 0.0
    height, weight = column.centroid_height, column.mass * column.gravity
    azimuth = np.arange(block.lanes) * (2.0 * math.pi / block.lanes) + 0.1
    h = np.stack([np.cos(azimuth), np.sin(azimuth), np.zeros(block.lanes)])
    best = carried = np.zeros(block.lanes)
    for tilt in tilts:
        turns = [rotation(np.cross([0, 0, 1.0], h[:, lane]), tilt) for lane in range(block.lanes)]
        low, high = -0.5 * column.base_width * math.sin(tilt), 1e-3
        for _ in range(60):
            depth = 0.5 * (low + high)
            for lane, turn in enumerate(turns):
                put_axes(block, 1, lane, turn)
                put(block, 1, lane, "x y z", height * turn[:, 2] - (0.0, 0.0, depth))
            block.records.kernel.forces(block.records.state)
            carried = block.records.load["f"][0, 2]
            low, high = (depth, high) if carried.mean() < weight else (low, depth)
        moment = block.records.load["up"][0, :, :] / carried
        # the force acts at P: moment about the centroid = (P − G) × N z
        px, py = -moment[1] + block.records.body["x"][1], moment[0] + block.records.body["y"][1]
        reach = (px - block.records.body["x"][1]) * h[0] + (py - block.records.body["y"][1]) * h[1]
        best = np.maximum(best, reach / block.records.body["z"][1])
    return best


@case(
    "dem3d",
    "static uplift of the paper's column with circular section, rim law, $k_n$ = 5e10 and 5e12, over 16 directions [g]",
    Near((0.215922, 0.218255), abs=2e-6),
    source=RIGID_UPLIFT,
    reason="found on a grid of tilts",
)
def uplift_on_the_rim():
    return [
        resistance(round_column(stiffness=k), near * TILTS, "rim").mean()
        for k, near in ((5e10, 1.06e-3), (5e12, 1.8e-4))
    ]


@case(
    "dem3d",
    "the same on the elastic bed [g]",
    Near((0.206104, 0.215315), abs=1e-5),
    source=RIGID_UPLIFT,
    reason="eight strips of the bed",
)
def uplift_on_the_bed():
    return [
        resistance(round_column(stiffness=k), near * TILTS, "bed").mean() for k, near in ((5e10, 3.45e-3), (5e12, 8e-4))
    ]


@case(
    "dem3d",
    "largest difference of the uplift between 16 directions, over its value: rim and bed",
    AtMost(1e-6),
    source="a round face has no direction",
    reason="rounding and bisection",
)
def uplift_in_any_direction():
    resistances = [resistance(round_column(), near * TILTS, law) for law, near in (("rim", 1.06e-3), ("bed", 3.45e-3))]
    return [float(np.ptp(values) / values.mean()) for values in resistances]


# -- sliding and spinning ------------------------------------------------------------------------------------------


def slid(ax, ay, duration, dt=1e-4, column=LOW):
    """Slip of the drum over the base and the time at which it last moved, under accelerations given as functions."""
    time = np.arange(round(duration / dt) + 1) * dt
    block = block_of(column, stiffness_damping=1e-4)
    block.load(0, Run(column, Motion(dt, ax(time), ay(time))))
    now, still, last = np.zeros(2), np.zeros(2), 0.0
    while not block.is_over(0):
        block.advance(1)
        now = block.records.joints(0)[1][0]
        if np.hypot(*(now - still)) > 2e-6:
            still, last = now, block.time(0)
    return now, last


@case(
    "dem3d",
    "a drum pushed by 0.6 g at 45° for 0.2 s, μ = 0.3: slip [m] and time at rest [s]",
    Near((0.117720, 0.400), abs=3e-3),
    source=r"$\frac12 a t^2 (a/\mu g - 1)$ along the push; limits along each axis would give 0.049 m",
    reason="the joint is elastic in shear; states every 3 ms",
)
def friction_is_a_cone():
    push = -0.6 * g * math.sqrt(0.5)
    now, last = slid(lambda t: np.where(t < 0.2 - 1e-9, push, 0.0), lambda t: np.where(t < 0.2 - 1e-9, push, 0.0), 0.5)
    return float(np.linalg.norm(now)), last


@case(
    "dem3d",
    "a drum that slides along a curve, 0.8 g sin 2πt along x and 0.25 s later along y, μ = 0.3: slip along x and y [m]",
    Near((0.0719977, -0.3834036), abs=1e-3),
    source="Coulomb's law in the plane, integrated",
    reason="the joint is elastic in shear",
)
def sliding_along_a_curve():
    def wave(start: float):
        return lambda t: np.where((t >= start) & (t <= start + 1.0), 0.8 * g * np.sin(2 * np.pi * (t - start)), 0.0)

    return slid(wave(0.0), wave(0.25), 1.8)[0]


def stopped(speed, spin):
    """When a disc (R 0.5 m, tan φ 0.7) that slides and spins stops, how far it has gone and turned."""
    block = block_of(FLAT, 0.3, stiffness_damping=1e-4, time_step=1e-5)
    put(block, 1, 0, "vx lz wz", (speed, FLAT.drums[0].axial_inertia * spin, spin))
    time = 0.0
    while not block.is_over(0):
        block.advance(1)
        time = block.time(0) if block.records.body["wz"][1, 0] > 0.01 * spin else time
    _, slip, twist = block.records.joints(0)
    return time / 0.99, float(np.hypot(*slip[0])), float(twist[0])


EVEN = (
    "Coulomb's law over the disc under even pressure, by quadrature (slide and spin stop together: Farkas et al. 2003)"
)


@case(
    "dem3d",
    "a disc that spins at 5 rad/s on its face, R 0.5 m, μ = 0.7: time [s] and angle [rad] to rest",
    Near((0.27304500, 0.68261249), rel=5e-3),
    source=r"$t = 3R\omega_0/(4\mu g)$",
    reason="read when 1 % of the spin is left",
)
def torsion_stop():
    time, _, turned = stopped(0.0, 5.0)
    return time, turned


@case(
    "dem3d",
    "discs that slide and spin, at 1 m/s and 4 rad/s, 0.5 and 4, 1 and 1.5: time [s], distance [m] and angle [rad] to rest",
    Near((0.277154, 0.143221, 0.544001, 0.236071, 0.064928, 0.464029, 0.178268, 0.083720, 0.153844), rel=0.03),
    source=EVEN,
    reason="one resultant with a limit surface that fits the exact one to 1 %",
)
def slide_and_spin():
    return np.ravel([stopped(*start) for start in ((1.0, 4.0), (0.5, 4.0), (1.0, 1.5))])


# -- wobbling and flight -------------------------------------------------------------------------------------------


def wobbling_error(stiffness: float) -> float:
    """Largest component of the error of the axis after 3 s of wobbling without pivot friction [-]."""
    times, axes = released(round_column(stiffness=stiffness), wobble(0.1, 1.0), 3.0, pivot_friction=0.0)
    exact = rolling(round_column(), 0.1, 1.0, 0.0, 3.0).sol(times)
    error = [float(np.abs(axes[i, :, 2] - axis_of(*exact[:2, i])).max()) for i in range(len(times))]
    assert max(error) < 1.5 * WOBBLING[stiffness]  # where the tilt is smallest
    return error[-1]


WOBBLING = {5e10: 2e-4, 5e12: 2e-5}
TRANSIENT = "axis after 3 s of transient wobbling, tilt 0.1 and precession 1 rad/s, $k_n$ = {}: error"
ROLLS = "rigid rolling on the rim, integrated"


@case("dem3d", TRANSIENT.format("5e10"), AtMost(WOBBLING[5e10]), source=ROLLS, reason="what the joint gives")
def transient_wobbling():
    return wobbling_error(5e10)


@case("dem3d", TRANSIENT.format("5e12"), AtMost(WOBBLING[5e12]), source=ROLLS, reason="what the joint gives")
def transient_wobbling_on_stiff_joints():
    return wobbling_error(5e12)


@case(
    "dem3d",
    "a frustum in flight for 2 s, 0.3 rad/s across and 2 rad/s about its axis: largest error of its axes",
    AtMost(1e-11),
    source=r"turns about itself at $(1/C - 1/A)\,L\cdot k$ and about $L$ at $\Vert L \Vert/A$",
    reason="rounding over 20,000 steps",
)
def torque_free_motion():
    column = round_column()
    a, c = column.drums[0].inertia, column.drums[0].axial_inertia
    block = block_of(column, 2.0, time_step=1e-4)
    block.records.joint["kn"][:] = block.records.joint["ks"][:] = 0.0
    momentum = np.array([a * 0.3, 0.0, c * 2.0])
    put(block, 1, 0, "lx ly lz", momentum)
    put(block, 1, 0, "wx wy wz", (0.3, 0.0, 2.0))
    put(block, 1, 0, "z vz", (30.0, 0.5 * block.dt[0] * g))
    worst = 0.0
    while not block.is_over(0):
        block.advance()
        t, size = block.time(0), float(np.linalg.norm(momentum))
        own = rotation(np.array([0.0, 0.0, 1.0]), t * (1.0 / c - 1.0 / a) * momentum[2])
        exact = rotation(momentum / size, t * size / a) @ own
        worst = max(worst, float(np.abs(block.records.axes(0)[0] - exact).max()))
    assert np.array_equal([block.records.body["l" + n][1, 0] for n in "xyz"], momentum)
    return worst
