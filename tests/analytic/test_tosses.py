"""A specimen that is tossed: free flight, impacts of one vertex against the laws of rigid bodies, bad input."""

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.models.base import Case, RunOptions
from stylobate.models.engine import engine_for

HALF, MASS, MOMENT = 0.05, 0.4, 7e-4
CORNERS = HALF * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])


def cube(restitution=0.5, friction=0.3):
    joint = st.Joint(3e10, 1.5e10, friction_coefficient=friction)
    return st.Specimen(MASS, np.full(3, MOMENT), CORNERS, "cube", joint, restitution)


def turned(angle, axis):
    axis = np.array(axis) / np.linalg.norm(axis)
    return (math.cos(0.5 * angle), *(math.sin(0.5 * angle) * axis))


def matrix(q):
    w, v = q[0], np.array(q[1:])
    skew = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2 * w * skew + 2 * skew @ skew


def flown(body, toss, duration, step=1.5e-6):
    """Once the body is off the base again: velocity, angular momentum, most energy in the normal springs, energy lost."""
    model = st.DistinctElement3D(time_step=step)
    block = engine_for(model, body).block(RunOptions(until_end=True, start=toss))
    block.load(0, Case(body, st.Motion(duration, np.zeros(2))))
    deepest = 0.0
    while not block.is_over(0):
        block.advance(1)
        block.records.net(0)
        elastic = float(block.lane["en"][0, 0])
        if deepest > 0.0 and elastic == 0.0:
            break
        deepest = max(deepest, elastic)
    drum = block.records.body
    velocity, momentum = (np.array([drum[prefix + c][1, 0] for c in "xyz"]) for prefix in "vl")
    return velocity, momentum, deepest, float(block.lane["visc"][0, 0])


def test_it_flies_as_a_free_body():
    toss = st.Toss((0.1, 0.2, 5.0), turned(0.7, (1, 2, 3)), (1.0, -2.0, 3.0), (4.0, 5.0, -6.0))
    box = st.Specimen(1.0, (0.01, 0.02, 0.025), CORNERS * (2.0, 1.5, 1.0), "box", cube().joint)
    response = st.simulate(box, st.Motion(0.6, np.zeros(2)), st.DistinctElement3D(), start=toss, until_end=True)
    t = response.time[:, None]
    path = np.array(toss.position) + np.array(toss.velocity) * t - 0.5 * st.g * t**2 * (0.0, 0.0, 1.0)
    # half a step of gravity is what a leapfrog leaves
    assert np.abs(response.body_position[:, 0] - path).max() < 1e-8
    assert np.abs(response.body_orientation[0, 0]) == pytest.approx(np.abs(toss.orientation), abs=1e-12)
    turns = [matrix(q) for q in response.body_orientation[:, 0]]
    spin = np.array(toss.angular_velocity)
    momentum = turns[0] @ np.diag((0.01, 0.02, 0.025)) @ turns[0].T @ spin
    dt = response.time[1] - response.time[0]
    middle = len(turns) // 2
    step = turns[middle + 1] @ turns[middle - 1].T
    rate = np.array([step[2, 1] - step[1, 2], step[0, 2] - step[2, 0], step[1, 0] - step[0, 1]]) / (4.0 * dt)
    body = turns[middle] @ np.diag((0.01, 0.02, 0.025)) @ turns[middle].T
    assert body @ rate == pytest.approx(momentum, rel=0.02)  # second order in an interval of 0.01 s


@pytest.mark.parametrize("restitution", [0.125, 0.5, 0.9])
def test_a_vertex_that_strikes_straight_gives_back_its_restitution(restitution):
    """A cube on its corner, straight down: every law of impact gives back e times the velocity."""
    q = turned(math.acos(1.0 / math.sqrt(3.0)), (-1.0, 1.0, 0.0))
    height = HALF * math.sqrt(3.0)
    velocity, *_ = flown(cube(restitution), st.Toss((0, 0, height + 1e-6), q, (0, 0, -1.0)), 0.2)
    assert velocity[2] == pytest.approx(restitution, abs=0.02)  # the weight acts meanwhile
    assert np.abs(velocity[:2]).max() < 1e-6


@pytest.mark.parametrize("restitution", [0.2, 0.7])
def test_an_impact_off_centre_without_friction_is_that_of_rigid_bodies(restitution):
    """Newton's, Poisson's and Stronge's restitution are one law there: impulse m_n (1 + e) v_n."""
    q = turned(0.5, (1.0, 0.3, 0.0))
    arms = CORNERS @ matrix(q).T
    low = arms[np.argmin(arms[:, 2])]
    spin, fall = np.array([1.0, -2.0, 3.0]), np.array([0.3, 0.2, -1.0])
    toss = st.Toss((0, 0, -low[2] + 1e-7), q, fall, spin)
    velocity, momentum, *_ = flown(cube(restitution, friction=0.0), toss, 0.2)
    lever = np.cross(low, (0.0, 0.0, 1.0))
    normal = fall[2] + np.cross(spin, low)[2]
    impulse = -(1.0 + restitution) * normal / (1.0 / MASS + lever @ lever / MOMENT)
    assert velocity - fall == pytest.approx([0.0, 0.0, impulse / MASS], abs=0.02)
    assert (momentum - MOMENT * spin) / MOMENT == pytest.approx(lever * impulse / MOMENT, abs=0.4)


def test_with_friction_the_normal_force_gives_back_the_share_of_its_work_that_was_asked_for():
    """Stronge's law: work of restitution over work of compression is e², whatever friction does meanwhile."""
    q = turned(0.6, (1.0, 0.4, 0.0))
    arms = CORNERS @ matrix(q).T
    toss = st.Toss((0, 0, -arms[:, 2].min() + 1e-6), q, (0.8, -0.3, -1.2), (3.0, 1.0, -2.0))
    _, _, deepest, lost = flown(cube(0.4, friction=0.5), toss, 0.05, 2e-7)
    assert lost == pytest.approx((1.0 - 0.4**2) * deepest, rel=0.02)  # seen every 6 µs of 70


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"position": (0.0, 0.0)}, "position of a toss has 2 components"),
        ({"velocity": (0.0, math.nan, 0.0)}, "velocity of a toss"),
        ({"orientation": (0.0, 0.0, 0.0, 0.0)}, "quaternion of zeros"),
    ],
)
def test_bad_input_is_one_sentence(change, message):
    with pytest.raises(st.InputError, match=message):
        st.Toss(**{"position": (0.0, 0.0, 1.0)} | change)


def test_a_toss_is_for_specimens():
    column = st.Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=1, density=1600.0, joint=cube().joint
    )
    with pytest.raises(st.InputError, match="a toss is for a specimen"):
        st.simulate(column, st.Motion(0.1, np.zeros(2)), st.DistinctElement3D(), start=st.Toss((0.0, 0.0, 1.0)))
    with pytest.raises(st.InputError, match="restitution of a specimen"):
        cube(1.5)
