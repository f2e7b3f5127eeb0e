"""Round columns in space that rock and roll on their rim, against the motion of the rigid body.

The joint's flexibility is the difference: 2e-4 of the axis at k_n = 5e10 N/m³, 1e-5 at 5e12.
"""

import math

import numpy as np
import pytest
from validation.space import axis_of, cylinder, released, rolling, round_column, wobble

from stylobate.models.start import Start

pytestmark = pytest.mark.processor

COLUMN_QUARTERS = {0.10: 0.26600432, 0.25: 0.45253133, 0.50: 0.74849162, 0.75: 1.17190153, 0.90: 1.69947762}
CYLINDER_QUARTERS = {0.10: 0.24786404, 0.25: 0.42156898, 0.50: 0.69705830, 0.75: 1.09113964, 0.90: 1.58222506}


def time_to_upright(column, tilt, azimuth, law="rim"):
    times, axes = released(column, Start(tilt, azimuth), 1.9, law=law)
    lean = axes[:, 0, 2] * math.cos(azimuth) + axes[:, 1, 2] * math.sin(azimuth)
    i = int(np.argmax(lean < 0.0))
    return times[i - 1] + (times[i] - times[i - 1]) * lean[i - 1] / (lean[i - 1] - lean[i])


@pytest.mark.parametrize(
    ("column", "quarters"),
    [(round_column(stiffness=5e12), COLUMN_QUARTERS), (cylinder(1.0, 4.0, 5e12), CYLINDER_QUARTERS)],
    ids=["column", "cylinder"],
)
def test_time_from_release_to_upright(column, quarters):
    """θ̈ = −p² sin(α − θ), integrated to 1e-8 s; the joint's flexibility adds up to 1.5e-4 of it for the smallest tilt."""
    for share, exact in quarters.items():
        duration = time_to_upright(column, share * column.slenderness, 0.6)
        assert duration == pytest.approx(exact, rel=1.5e-4)


def test_a_stiffer_joint_comes_nearer_to_the_rigid_quarter_period():
    errors = [
        time_to_upright(round_column(stiffness=k), 0.5 * round_column().slenderness, 0.0) / COLUMN_QUARTERS[0.5] - 1.0
        for k in (5e10, 5e11, 5e12)
    ]
    assert all(0.0 < errors[i + 1] < 0.5 * errors[i] < 4e-4 for i in range(2))


def test_on_an_elastic_bed_the_quarter_period_falls_behind():
    """The pivot moves in from the rim as k_n^−0.4: 9.2e-3, 3.6e-3 and 1.4e-3 longer at 5e10, 5e11 and 5e12."""
    errors = [
        time_to_upright(round_column(stiffness=k), 0.5 * round_column().slenderness, 0.3, law="bed")
        / COLUMN_QUARTERS[0.5]
        - 1.0
        for k in (5e10, 5e11, 5e12)
    ]
    assert errors == pytest.approx([9.2e-3, 3.62e-3, 1.43e-3], rel=0.02)


# -- steady rolling: tilt, precession and spin that keep the lean as it is ------------------------------------------

STEADY = [
    # column, tilt, precession, spin about the axis (None: base centre fixed), from the balance of moments about the contact
    ("column", 0.02, 5.5717365396, 0.0),
    ("column", 0.05, 3.2397259208, 0.0),
    ("column", 0.10, 1.9129969655, 0.0),
    ("column", 0.02, 10.22908078, 0.93540680),
    ("column", 0.05, 5.97884598, 1.36637301),
    ("column", 0.10, 3.56138472, 1.62576474),
    ("column", 0.02, 1.88981015, 1.88981015 * (math.cos(0.02) - 2.0)),
    ("column", 0.05, 1.60100510, 1.60100510 * (math.cos(0.05) - 2.0)),
    ("column", 0.10, 1.19414861, 1.19414861 * (math.cos(0.10) - 2.0)),
    ("stubby", 0.2, 11.3849648571, 0.0),
    ("stubby", 0.8, 3.4761821488, 0.0),
]


def body(name, stiffness=5e12):
    """The frustum, or a stubby drum that is as wide as two of its heights."""
    return round_column(stiffness=stiffness) if name == "column" else cylinder(1.0, 0.5, stiffness)


@pytest.mark.parametrize(("name", "tilt", "precession", "spin"), STEADY)
def test_steady_rolling(name, tilt, precession, spin):
    """Tilt and azimuth over 5 s of rolling without pivot friction, k_n = 5e12 N/m³.

    A rim that rolls over ever new points of a soft ground goes ahead by up to 1.8e-3 of the azimuth (fast precession).
    """
    column = body(name)
    start = wobble(tilt, precession, spin)
    times, axes = released(column, start, 5.0, pivot_friction=0.0)
    lean = np.arccos(axes[:, 2, 2])
    azimuth = np.unwrap(np.arctan2(axes[:, 1, 2], axes[:, 0, 2]))
    assert np.abs(lean - tilt).max() < 3e-3 * tilt
    assert azimuth[-1] == pytest.approx(precession * 5.0, rel=2e-3)
    assert times[-1] == pytest.approx(5.0)


@pytest.mark.parametrize(("name", "tilt", "precession", "spin"), STEADY)
def test_steady_rolling_is_one_of_the_rigid_body(name, tilt, precession, spin):
    """The numbers of the table keep their lean in the rigid body's equations of motion."""
    states = rolling(body(name), tilt, precession, spin, 1.0).sol(np.linspace(0.0, 1.0, 11))
    np.testing.assert_allclose(states[0], tilt, rtol=0, atol=2e-6)
    np.testing.assert_allclose(states[1], precession * np.linspace(0.0, 1.0, 11), rtol=0, atol=1e-4)


def test_rigid_rolling_meets_the_independent_solution():
    """Tilt, azimuth, rates and twist of the wobbling column, from another integration of the same equations."""
    rows = {
        0.5: (0.06817910, 0.65230760, -0.12080960, -0.00169216),
        1.0: (0.05514065, 2.97067796, 0.12589589, -0.00262988),
        2.0: (0.07976696, 4.36140743, -0.10064494, -0.00099876),
        3.0: (0.09438431, 7.58293254, 0.05396506, -0.00025539),
        5.0: (0.09541420, 11.89271856, -0.04878047, -0.00020744),
    }
    exact = rolling(round_column(), 0.1, 1.0, 0.0, 5.0).sol
    for time, (tilt, azimuth, rate, spin) in rows.items():
        y = exact(time)
        assert (y[0], y[1], y[4], y[5]) == pytest.approx((tilt, azimuth, rate, spin), abs=2e-8)
    assert exact(5.0)[1] + exact(5.0)[2] == pytest.approx(0.01783533, abs=2e-8)


def test_wobbling_of_a_stubby_drum():
    """Tilt 0.4, precession 5 rad/s: the axis after 3 s."""
    times, axes = released(body("stubby"), wobble(0.4, 5.0), 3.0, pivot_friction=0.0)
    assert np.abs(axes[-1][:, 2] - axis_of(0.28428738, 23.41653298)).max() < 6e-4
    assert times[-1] == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("precession", "azimuth", "time"),
    [(0.3, 3.533031, 1.428353), (0.1, 3.349944, 1.409044), (0.03, 3.255045, 1.406272), (0.01, 3.218624, 1.405973)],
)
def test_released_almost_in_a_plane_a_round_column_rolls_round_its_rim(precession, azimuth, time):
    """No impact: it comes back to the same tilt past the other side; towards 3.193840 rad as the lateral rate goes to 0."""
    times, axes = released(round_column(stiffness=5e12), wobble(0.1, precession), 1.6, pivot_friction=0.0)
    lean = np.hypot(axes[:, 0, 2], axes[:, 1, 2])
    lean_azimuths = np.unwrap(np.arctan2(axes[:, 1, 2], axes[:, 0, 2]))
    i = int(np.argmax(np.where(times > 1.0, lean, 0.0)))
    near = slice(i - 40, i + 41)
    peak = np.polyfit(times[near] - time, lean[near], 2)
    when = time - peak[1] / (2.0 * peak[0])
    assert when == pytest.approx(time, abs=5e-4)
    assert np.interp(when, times, lean_azimuths) == pytest.approx(azimuth, abs=1e-3)
    assert lean[i] == pytest.approx(math.sin(0.1), rel=1e-4)
