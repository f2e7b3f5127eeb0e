"""Bodies in space on the bed and on joints, against closed forms: rolling, skidding, spinning, leaning, falling, rocking."""

import dataclasses
import math

import numpy as np
import pytest
from bodies_in_space import (
    RADIUS,
    G,
    Lane,
    after_impact,
    box,
    cylinder,
    disc_face,
    faces_joined,
    ground,
    lying,
    portal,
    quarter,
    square_face,
    turn,
)
from scipy.integrate import solve_ivp

import stylobate as st


def test_a_drum_rolls_down_a_slope():
    """2/3 g sin: 1e-4 (facets of a fixed 24-gon lose 15 %). It begins to press all at once: what rings then has to fade."""
    slope = math.radians(10.0)
    lane = Lane(ground(), lying(), gravity=(-G * math.sin(slope), 0.0, G * math.cos(slope)), restitution=0.5)
    times, _ = lane.run(1.5, lambda: None)
    speed = 2.0 / 3.0 * G * math.sin(slope) * times[-1]
    assert lane.velocity(1)[0] == pytest.approx(speed, rel=3e-4)
    assert lane.spin(1)[1] == pytest.approx(speed / RADIUS, rel=3e-4)


def test_a_drum_coasts():
    """It keeps its speed on the level; the prism of another drum, or of a block, would do as well."""
    floor = box((12.0, 3.0, 1.0), (5.0, 0.0, -0.5), fixed=True)
    for below in (ground(), floor):
        lane = Lane(below, lying(velocity=(1.0, 0.0, 0.0), spin=(0.0, 1.0 / RADIUS, 0.0)))
        lane.run(2.0)
        assert lane.velocity(1) == pytest.approx([1.0, 0.0, 0.0], abs=4e-3)  # it rings upright by 3 mm/s
        assert lane.velocity(1)[0] == pytest.approx(1.0, abs=2e-5)


def test_what_rolls_on_has_no_residual_and_the_sentence_says_so():
    """Nothing resists rolling here: 1 m/s is kept, and what it has come by the end says when the run was ended."""
    lain = {"orientation": (math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0)}
    stones = [
        st.Stone.drum(1.0, 1.0, 0.8, (0.0, 0.0, 0.1), 2500.0, name="drum", velocity=(0.0, 1.0, 0.0), **lain),
        st.Stone.box((1.0, 1.0, 1.0), (5.0, 0.0, 0.0), 2500.0, name="box"),
    ]
    scene = st.SpatialAssembly(stones, st.Joint(5e9, 2.5e9, 35.0), settle=False)
    response = st.simulate(scene, st.Motion(0.1, np.zeros(4)), st.DistinctElement3D())
    summary = response.summary()
    assert list(summary["moving_at_end_m_s"]) == ["drum"]
    assert summary["residual_displacement_m"] is None
    rows = summary["bodies"]
    assert rows["drum"]["residual_displacement_m"] is None
    assert (
        rows["drum"]["displacement_at_end_m"][1] > 0.15
    )  # it slid and rolled for 0.3 s, from 1 m/s to 2/3 m/s at least
    assert rows["box"]["residual_displacement_m"] < 1e-3
    waited = dataclasses.replace(response, provenance=dict(response.provenance) | {"until_rest": True})
    assert "Still moving at the end: drum (0." in waited.sentence
    assert "Still moving" not in response.sentence


def test_a_drum_skids_until_it_rolls():
    """After v/(3 μ g), with 2/3 of its speed."""
    lane = Lane(ground(), lying(velocity=(2.0, 0.0, 0.0)), mu=0.3)
    times, seen = lane.run(0.3, lambda: (lane.velocity(1)[0], RADIUS * lane.spin(1)[1]))
    forward, rolling = np.array(seen).T
    assert times[np.argmax(rolling > 0.9999 * forward)] == pytest.approx(2.0 / (0.9 * G), rel=0.01)
    assert forward[-1] == pytest.approx(4.0 / 3.0, rel=1e-4)


def test_a_lying_drum_spins_until_it_stops():
    """A line load: torque μ m g L/4."""
    lane = Lane(ground(), lying(spin=(0.0, 0.0, 5.0)), restitution=0.5)
    times, seen = lane.run(0.42, lambda: lane.spin(1)[2])
    exact = 5.0 * (RADIUS**2 / 4.0 + 1.0 / 12.0) / (0.7 * G / 4.0)
    assert times[np.argmax(np.array(seen) < 0.05)] == pytest.approx(exact, rel=0.03)
    assert math.atan2(lane.axes(1)[1, 0], lane.axes(1)[0, 0]) == pytest.approx(2.5 * exact, rel=0.03)


def test_a_drum_rolls_over_an_edge():
    """It leaves the edge at 53.19°, with 1.533 m/s, and lands 0.7795 m out."""
    block = box((2.0, 3.0, 2.0), (-1.0, 0.0, 1.0), fixed=True)
    drum = lying((-0.01, 0.0, 2.0 + RADIUS), velocity=(0.3, 0.0, 0.0), spin=(0.0, 0.75, 0.0))
    lane = Lane(ground(), block, drum, step=8e-6, kn=5e12, restitution=0.5)
    _, seen = lane.run(1.4, lambda: (lane.contact(1, 2), *lane.place(2), *lane.velocity(2)))
    area, x, _, z, *v = np.array(seen).T
    departure = np.argmax((area == 0.0) & (x > 0.05))
    assert math.degrees(math.atan2(x[departure], z[departure] - 2.0)) == pytest.approx(53.193, abs=0.5)
    assert math.hypot(v[0][departure], v[2][departure]) == pytest.approx(1.5333, rel=0.01)
    assert x[np.argmax(z < RADIUS + 1e-3)] == pytest.approx(0.7795, rel=0.01)


@pytest.mark.parametrize(("mu", "stands"), [(0.25, False), (0.29, True)])
def test_three_lying_drums(mu, stands):
    """Friction tan 15° between the drums holds the third one on two."""
    law = np.empty((4, 4, 3))
    law[...] = 5e10, 2.5e10, mu
    law[0, :, 2] = 0.7
    height = RADIUS + 2.0 * RADIUS * math.sin(math.pi / 3.0)
    lane = Lane(
        ground(),
        lying((-RADIUS, 0, RADIUS)),
        lying((RADIUS, 0, RADIUS)),
        lying((0, 0, height)),
        law=law,
        restitution=0.3,
    )
    lane.run(0.6)
    assert (lane.place(3)[2] > height - 1e-3) == stands


@pytest.mark.parametrize(("degrees", "holds"), [(37.6, False), (40.6, True)])
def test_a_beam_leans_on_a_wall(degrees, holds):
    """tan = (1 − μ μ) L/(2 μ L + t (1 + μ μ)): 39.14° for 4 × 0.8 m and 0.4."""
    turned = turn(0.0, -math.radians(degrees), 0.0)
    reach = np.abs(turned) @ np.array([2.0, 0.0, 0.4])
    wall = box((2.0, 4.0, 8.0), (1.0, 0.0, 4.0), fixed=True)
    lane = Lane(ground(), wall, box((4.0, 0.8, 0.8), (-reach[0], 0.0, reach[2]), turned), mu=0.4, restitution=0.3)
    lane.run(0.8)
    assert (lane.place(2)[2] > reach[2] - 0.02) == holds


@pytest.mark.parametrize(("share", "stands"), [(0.97, True), (1.03, False)])
def test_overhang_of_five_slabs(share, stands):
    """The harmonic series."""
    slabs, x = [], -0.5
    for k in range(5, 0, -1):
        x += share / (2.0 * k)
        slabs.append(box((1.0, 1.0, 0.2), (x, 0.0, 0.1 + 0.2 * (5 - k))))
    lane = Lane(box((4.0, 4.0, 1.0), (-2.0, 0.0, -0.5), fixed=True), *slabs, kn=5e12, step=1e-5, restitution=0.3)
    lane.run(0.5)
    assert (lane.place(5)[2] > 0.899) == stands


def test_a_drum_falls_flat_and_bounces():
    """Half of the speed comes back; then a dashpot takes over."""
    lane = Lane(ground(), cylinder(RADIUS, 0.5, (0.0, 0.0, 0.45)), restitution=0.5)
    times, seen = lane.run(0.7, lambda: (lane.place(1)[2] - 0.25, lane.velocity(1)[2]))
    z, v = np.array(seen).T
    first = np.argmax(v > 0.5)
    assert z[first : first + 200].max() == pytest.approx(0.05, rel=0.02)
    assert times[np.nonzero(np.abs(v) > 0.02)[0][-1]] == pytest.approx(0.6058, rel=0.05)


def test_a_drum_falls_on_its_rim():
    """Rigid impulse: 6.0535 rad/s and −1.1136 m/s after it; 2 % of what it had."""
    turned = turn(0.0, math.radians(20.0), 0.0)
    low = (turned @ [0.5, 0.0, -0.25])[2]
    drum = cylinder(0.5, 0.5, (0.0, 0.0, 0.02 - low), turned, velocity=(0.0, 0.0, -math.sqrt(2.0 * G * 0.28)))
    lane = Lane(ground(), drum, kn=5e12, mu=1e-9, restitution=0.5, step=4e-6)
    spin, up = after_impact(lane, lambda: (lane.spin(1), lane.velocity(1)[2]))
    assert np.abs(spin) == pytest.approx([0.0, 6.0535, 0.0], abs=0.02 * 6.05)
    assert up == pytest.approx(-1.1136, abs=0.02 * 2.43)


def test_a_beam_falls_on_its_corner():
    """Rigid impulse on a corner, in three dimensions."""
    turned = turn(0.0, math.radians(12.0), 0.0) @ turn(math.radians(10.0), 0.0, 0.0)
    low = -(np.abs(turned) @ [1.6, 0.4, 0.3])[2]
    beam = box((3.2, 0.8, 0.6), (0.0, 0.0, 0.02 - low), turned, velocity=(0.0, 0.0, -math.sqrt(2.0 * G * 0.48)))
    lane = Lane(ground(), beam, kn=5e12, mu=1e-9, restitution=0.4, step=4e-6)
    spin, up = after_impact(lane, lambda: (lane.spin(1), lane.velocity(1)[2]))
    assert np.linalg.norm(spin - [-3.559479, -1.521214, 0.677332]) < 0.02 * 3.93
    assert up == pytest.approx(-2.2292, abs=0.02 * 3.13)


@pytest.mark.parametrize("shape", ["square", "round"])
@pytest.mark.parametrize("joined", [True, False], ids=["joint", "bed"])
def test_a_monolith_rocks(shape, joined):
    """Quarter period of θ̈ = −p² sin(α − θ): to 1e-4 on the joint; the bed's toe moves in, 0.2 % at this stiffness."""
    half, tilt, kn = 0.4, 0.5 * math.atan(0.2), 5e12
    turned = turn(0.0, tilt, 0.0)
    place = np.array([half, 0.0, 0.0]) + turned @ [-half, 0.0, 2.0]
    body = box((0.8, 0.8, 4.0), place, turned) if shape == "square" else cylinder(half, 4.0, place, turned)
    face = square_face(half, -2.0, up=False) if shape == "square" else disc_face(half, -2.0, up=False)
    joints = [faces_joined(0, 1, square_face(2.0, 0.5), face, kn, mu=5.0)] if joined else []
    lane = Lane(box((4.0, 4.0, 1.0), (0.0, 0.0, -0.5), fixed=True), body, kn=kn, mu=5.0, joints=joints, step=1e-5)
    times, lean = lane.run(0.75, lambda: lane.axes(1)[0, 2])
    arm = math.hypot(half, 2.0)
    about = (0.8**2 + 16.0) / 12.0 if shape == "square" else half**2 / 4.0 + 16.0 / 12.0
    p2 = G * arm / (about + arm**2)
    crossed = lambda _, y: y[0]  # noqa: E731
    solution = solve_ivp(
        lambda _, y: [y[1], -p2 * math.sin(math.atan(0.2) - y[0])],
        [0, 2],
        [tilt, 0.0],
        events=crossed,
        rtol=1e-10,
        atol=1e-12,
    )
    assert quarter(times, lean) == pytest.approx(solution.t_events[0][0], rel=1e-4 if joined else 2e-3)


@pytest.mark.parametrize(("share", "exact"), [(0.25, 0.45727829), (0.5, 0.75647293)])
def test_a_portal_rocks(share, exact):
    """Equivalent block of Makris and Vassiliou (2013)."""
    lane = portal(share * math.atan(0.2), 5e11, 2e-5)
    times, lean = lane.run(1.05 * exact, lambda: lane.axes(1)[0, 2])
    assert quarter(times, lean) == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize("degrees", [0.0, 30.0])
def test_push_of_a_monolith(degrees):
    """A square one tips at (b/h)/max(|cos|, |sin|) of gravity, a round one at b/h, and in the direction of the push."""
    way = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees)), 0.0])
    for body, face, limit in (
        (box((0.8, 0.8, 4.0), (0.0, 0.0, 2.0)), square_face(0.4, -2.0, up=False), 0.2 / max(np.abs(way))),
        (cylinder(0.4, 4.0, (0.0, 0.0, 2.0)), disc_face(0.4, -2.0, up=False), 0.2),
    ):
        for share, stands in ((0.97, True), (1.03, False)):
            push = -share * limit * G * way
            base = box((4.0, 4.0, 1.0), (0.0, 0.0, -0.5), fixed=True)
            joints = [faces_joined(0, 1, square_face(2.0, 0.5), face, 5e11)]
            lane = Lane(base, body, kn=5e11, joints=joints, step=4e-5, gravity=(push[0], push[1], G))
            lane.local_damping = 0.8
            lane.run(0.4)
            lane.local_damping = 0.0
            lane.run(1.6)
            lean = lane.axes(1)[:, 2]
            assert (math.hypot(*lean[:2]) < 0.005) == stands
            if not stands and face.radius:
                assert math.degrees(math.atan2(lean[1], lean[0])) == pytest.approx(degrees, abs=0.5)


@pytest.mark.parametrize(("restitution", "kept"), [(0.0, 0.5), (0.5, 0.75)])
def test_a_monolith_hits_its_twin(restitution, kept):
    """An impulse at the same lever about both edges: the twin turns with (1 + e)/2 of what comes, to 3 %.

    That takes bases that hold the edges during the blow: where these are as soft as the contact, they give way, and the
    twin has up to a fifth more (0) or a seventh less (0.5), at any stiffness.
    """
    stiff, soft, near, turning = 5e12, 5e9, 1.0, 1.0
    lean = turn(0.0, math.asin(near / 4.0) - 0.004, 0.0)
    place = lean @ np.array([-0.4, 0.0, 2.0])
    law = np.full((3, 3, 3), 50.0)
    law[:, :, :2] = stiff, 0.5 * stiff
    law[1, 2] = soft, 0.5 * soft, 0.0
    lane = Lane(
        box((30.0, 10.0, 1.0), (0.0, 0.0, -0.5), fixed=True),
        box((0.8, 0.8, 4.0), place, lean, np.cross([0.0, turning, 0.0], place), (0.0, turning, 0.0)),
        box((0.8, 0.8, 4.0), (near + 0.4, 0.0, 2.0)),
        joints=[faces_joined(0, 2, square_face(0.4, 0.5, x=near + 0.4), square_face(0.4, -2.0), stiff, mu=50.0)],
        law=law, restitution=restitution, step=4e-6,
    )  # fmt: skip
    _, seen = lane.run(0.034, lambda: (lane.spin(2)[1], lane.contact(1, 2)))
    assert max(area for _, area in seen) > 0.0
    assert seen[-1][0] == pytest.approx(kept * turning, rel=0.03)
