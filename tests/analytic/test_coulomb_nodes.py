"""The oracle of friction node by node, held against closed forms before anything is held against it."""

import math

import numpy as np
import pytest
from oracles import coulomb_nodes as nodes

import stylobate as st

G, R = 9.81, 0.25
LOW = nodes.drum(nodes.disc(2 * R), 2 * R, 0.02)


def test_a_low_drum_slides_down_a_slope_beyond_its_friction():
    """g (sin α − μ cos α), in any direction; counted from when the springs of shear have given way."""
    gravity = nodes.slope(37.0, 0.7)
    seen = nodes.run(LOW, 0.5, gravity=gravity)
    speed = (seen.velocity[-1] - seen.velocity[10])[:2] / (seen.time[-1] - seen.time[10])
    expected = math.hypot(*gravity[:2]) + 0.7 * gravity[2]
    assert speed @ (math.cos(0.7), math.sin(0.7)) == pytest.approx(expected, rel=1e-3)
    assert speed @ (-math.sin(0.7), math.cos(0.7)) == pytest.approx(0.0, abs=1e-3 * expected)


def test_below_its_friction_it_stands():
    """Where the load is put on at once, it springs to and fro between nothing and twice the load over k_s A."""
    gravity = nodes.slope(18.0)
    seen = nodes.run(LOW, 1.0, gravity=gravity)
    spring = LOW.mass * gravity[0] / (2.5e9 * math.pi * R**2)
    assert seen.place[:, 0].max() == pytest.approx(2.0 * spring, rel=0.05)
    assert seen.heat[-1] < 0.01 * LOW.mass * gravity[0] * spring  # of nodes that rocking relieves


@pytest.mark.parametrize(("lean", "falls"), [(0.97, False), (1.02, True)])
def test_a_block_overturns_at_its_slenderness(lean, falls):
    """b/h of a slope that is tilted slowly: the joint gives way by its elastic toe a little before."""
    body = nodes.block(nodes.box(0.5, 0.5), 0.5, 0.5, 1.0)
    time = np.arange(0.0, 12.0, 0.01)
    tilt = np.minimum(time / 6.0, 1.0) * math.atan(lean * 0.5)
    push = 9.81 * np.stack((-np.sin(tilt), 0.0 * tilt, np.cos(tilt) - 1.0), axis=1)
    assert nodes.run(body, 12.0, push=push, step=0.01).fell is falls


@pytest.mark.parametrize(
    ("base", "arm"),
    [(nodes.disc(2 * R), R), (nodes.ring(2 * R, 0.0, 24), 2 * R / 3), (nodes.ring(2 * R, R, 24), 7 * R / 9)],
    ids=["rim", "disc", "ring"],
)
def test_a_spinning_drum_stops(base, arm):
    """C ω / (μ m g times the mean distance of pressure from the axis): R on a rim, 2R/3 on a disc, 7R/9 on a ring of R/2."""
    body = nodes.drum(base, 2 * R, 0.02)
    seen = nodes.run(body, 0.3, spin=(0.0, 0.0, 5.0), every=1e-3)
    stop = body.inertia[2] * 5.0 / (0.7 * body.mass * G * arm)
    stopped = seen.time[np.argmax(seen.spin[:, 2] < 0.0)]
    assert stopped == pytest.approx(stop, rel=0.03)  # the spring first turns back a little later
    assert seen.heat[-1] == pytest.approx(0.5 * body.inertia[2] * 25.0, rel=0.01)


def test_a_chipped_disc_has_its_area_and_stands_on_its_chord():
    base = nodes.chipped(2 * R, 0.1, 512)
    grid = (np.arange(2000) + 0.5) / 2000 * 2 * R - R
    x, y = np.meshgrid(grid, grid)
    area = ((x * x + y * y < R * R) & (x < R - 0.1)).mean() * (2 * R) ** 2
    assert base.area.sum() == pytest.approx(area, rel=1e-3)
    assert base.place[:, 0].max() == pytest.approx(R - 0.1)


@pytest.mark.parametrize("softer", [2.0, 0.5])
def test_a_drum_that_wobbles_twists_by_the_force_that_it_rolls_with(softer):
    """Steady wobbling: per radian of precession a twist of 1 − cos θ + (T/N) (k_n/k_s) θ, whatever the length of the toe.

    A rolling toe bears a force T across its way by turning on itself: shear of a stone at s is ω (a² − s²) / 2v, and has no
    moment (strips, as of Kalker's simplified theory). 0.0137 and 0.0043; 0.0012 without the second term.
    """
    body, theta, a, b = nodes.drum(nodes.disc(0.55, 256), 0.55, 2.5), 0.05, 0.275, 1.25
    sine, cosine, mass = math.sin(theta), math.cos(theta), body.mass
    arm = a * cosine - b * sine
    rate = math.sqrt(mass * G * arm / (sine * (body.inertia[0] * cosine + mass * b * (b * cosine + a * sine))))
    down, axis = np.array([cosine, 0.0, -sine]), np.array([sine, 0.0, cosine])
    spin = -rate * sine * down
    toe = (3.0 * mass * G / (5e9 * a**3 * theta)) ** (1.0 / 3.0)
    place = b * axis + (0.0, 0.0, a * sine * math.cos(toe))
    seen = nodes.run(
        body, 4.0, 1e-4, ks=5e9 / softer, place=place, axes=np.stack([down, [0.0, 1.0, 0.0], axis], axis=1), spin=spin,
        velocity=-np.cross(spin, a * down - b * axis),
    )  # fmt: skip
    later = seen.time > 1.0  # what touches at the start holds nothing yet
    azimuth = np.unwrap(np.arctan2(seen.axes[later, 1, 2], seen.axes[later, 0, 2]))
    twist = abs(np.ptp(seen.twist[later][[0, -1]]) / np.ptp(azimuth[[0, -1]]))
    across = rate**2 * b * sine / G
    assert twist == pytest.approx(1.0 - cosine + across * softer * theta, rel=0.04)


@pytest.mark.parametrize(("softer", "share"), [(2.0, (0.72, 0.82)), (0.5, (0.78, 0.88))])
def test_a_column_that_wobbles_twists_by_four_fifths_of_that(softer, share):
    """The engine's rim beside the same theory: a tenth and a fourth of it, while the shear went along with what touches."""
    a, b, theta = 0.275, 1.25, 0.05
    drum = st.Drum(2.0 * b, 2.0 * a, 2.0 * a, 2400.0, section="circular")
    column = st.Column.of_drums([drum], st.Joint(5e9, 5e9 / softer, friction_coefficient=0.7))
    sine, cosine, mass = math.sin(theta), math.cos(theta), column.masses[0]
    across, arm = mass * (0.25 * a * a + b * b / 3.0), a * cosine - b * sine
    rate = math.sqrt(mass * G * arm / (sine * (across * cosine + mass * b * (b * cosine + a * sine))))
    start = st.Start(tilt=theta, angular_velocity=(-rate * sine * cosine, 0.0, rate * sine * sine))
    response = st.simulate(column, st.Motion(0.01, np.zeros(301)), st.DistinctElement3D(), start=start, until_end=True)
    later = response.time > 1.0
    w, x, y, z = response.body_orientation[later, 0].T
    azimuth = np.unwrap(np.arctan2(y * z - w * x, x * z + w * y))
    twist = np.unwrap(2.0 * np.arctan2(z, w))
    ratio = abs(np.ptp(twist[[0, -1]]) / np.ptp(azimuth[[0, -1]]))
    theory = 1.0 - cosine + rate**2 * b * sine / G * softer * theta
    assert share[0] < ratio / theory < share[1]
