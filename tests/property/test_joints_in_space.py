"""Opening, slip and twist of joints in space from the poses of their bodies."""

import numpy as np
import pytest
from bodies_in_space import turn

import stylobate as st
from stylobate.response.assemblies import joint_histories_in_space as joint_histories

STONES = [
    st.Stone.box((0.8, 0.6, 1.0), (0.0, 0.0, 0.0), 2700.0, name="low"),
    st.Stone.box((0.8, 0.6, 1.0), (0.0, 0.0, 1.0), 2700.0, name="high"),
]
STACK = st.SpatialAssembly(tuple(STONES), st.Joint(1e9, 5e8, 35.0))


def poses(*moved):
    """Places and axes at the start, and with every body turned about the origin, and then moved and turned on its own."""
    first = np.stack([np.zeros(3), *(np.array(stone.position) for stone in STONES)])
    whole, places, axes = turn(0.2, 0.1, 0.3), first.copy(), np.stack([np.eye(3)] * 3)
    places, axes = places @ whole.T, whole @ axes
    for i, (way, own) in enumerate(moved, 1):
        places[i] += whole @ np.array(way)
        axes[i] = whole @ own
    return np.stack([first, places]), np.stack([np.stack([np.eye(3)] * 3), axes])


def test_bodies_that_turn_together():
    opening, slip, twist = joint_histories(STACK, *poses())
    assert np.abs(opening).max() < 1e-12
    assert np.abs(slip).max() < 1e-12
    assert np.abs(twist).max() < 1e-12


def test_a_joint_is_told_in_the_axes_of_the_body_below():
    """The upper body goes along and off the lower one, and turns on it."""
    still = (0.0, 0.0, 0.0), np.eye(3)
    opening, slip, twist = joint_histories(STACK, *poses(still, ((0.02, -0.01, 0.005), turn(0.0, 0.0, 0.1))))
    assert opening[1] == pytest.approx([0.0, 0.005], abs=1e-12)
    assert np.linalg.norm(slip[1], axis=1) == pytest.approx([0.0, np.hypot(0.02, 0.01)], abs=1e-12)
    assert np.abs(twist[1]) == pytest.approx([0.0, 0.1], abs=1e-12)


def test_a_joint_that_opens_by_a_tilt():
    still = (0.0, 0.0, 0.0), np.eye(3)
    tilt = turn(0.0, 0.01, 0.0)
    up = tilt @ np.array([0.4, 0.0, 0.5]) - np.array([0.4, 0.0, 0.5])  # about the edge at x = 0.4
    opening, _, twist = joint_histories(STACK, *poses(still, (-up * (1.0, 0.0, 1.0), tilt)))
    assert opening[1].max() == pytest.approx(0.8 * np.sin(0.01), rel=0.02)
    assert np.abs(twist).max() < 1e-4
