"""A wall held at its top and pushed at mid-height: Griffith, Lam, Wilson and Doherty 2004, specimen 12.

The wall is 1.5 m high, 0.11 m thick and 0.95 m wide, 1800 kg/m³, without load on top. Measured are the largest push over
the weight F/W and where it was, the deflection d at mid-height over the thickness t: 0.1378 at 0.075 on a smooth curve,
0.1252 at 0.107 on a noisy one (numbers as stored in thlgrs/HybriDFEM-3.1, Legacy/Examples/Giacomo/Griffith_Wall_12, which
does not say which of the two is the test).
"""

import math
from functools import cache

import numpy as np
import pytest

import stylobate as st
from stylobate.statics.limit import limit_analysis
from stylobate.statics.pushover import pushover

THICK, HIGH, WIDE = 0.11, 1.5, 0.95

#: What is pushed, a slice between two halves [m], and how its three drums are [m].
SLICE = 6e-3
HEIGHTS = (0.5 * (HIGH - SLICE), SLICE, 0.5 * (HIGH - SLICE))

#: Largest F/W and where, d/t.
MEASURED = ((0.1378, 0.075), (0.1252, 0.107))


def wall(stiffness):
    """Two halves and the slice, held at the top of a face by a tie so long that it stays level: a hundredth and a half."""
    drums = [st.Drum(height, THICK, THICK, 1800.0, depth=WIDE) for height in HEIGHTS]
    joints = [st.Joint(stiffness, 0.5 * stiffness, friction_coefficient=0.7)] * 3
    tie = st.Tie(axial_stiffness=1e7, axial_capacity=1e6, at=(-100.0, 0.0), to=(-0.5 * THICK, 0.0), to_height=HIGH)
    return st.Column(drums, joints=joints, name="wall", links=[tie])


@cache
def path(stiffness):
    """The equilibrium path of the wall, told by the slice."""
    return pushover(wall(stiffness), pattern=[0.0, 1.0, 0.0], at=2, to=0.98 * THICK)


def rigid(push_out):
    """F/W of the rigid mechanism whose lower part, up to the top of the slice, leans by an angle: dV/dx over W.

    The lower part turns about its toe, the upper one about the corner on the other side where they meet, and the held point
    of the top stays on its vertical line.
    """
    low, high = HEIGHTS[0] + SLICE, HEIGHTS[2]

    def state(angle):
        c, s = math.cos(angle), math.sin(angle)
        corner = 0.5 * THICK - THICK * c + low * s, THICK * s + low * c
        back = math.asin((corner[0] + 0.5 * THICK) / high)  # the held point is over the corner, on the same face
        middle = 0.5 * THICK * (1.0 - c) + 0.5 * HIGH * s
        lower = 0.5 * (THICK * s + low * c)
        upper = corner[1] + 0.5 * (THICK * math.sin(back) + high * math.cos(back))
        return middle, (low * lower + high * upper) / HIGH

    angles = np.linspace(0.0, 0.16, 4001)
    places, heights = np.array([state(angle) for angle in angles]).T
    return np.interp(push_out, places, np.gradient(heights, places))


def test_the_multiplier_of_the_limit_analysis_is_that_of_the_mechanism():
    """2 t/h for a hinge anywhere above the push; the tie, which leans by 0.015, adds 0.06 %."""
    assert limit_analysis(wall(5e10), pattern=[0, 1, 0]).multiplier == pytest.approx(2.0 * THICK / HIGH, rel=1e-3)
    assert rigid(0.0) == pytest.approx(2.0 * THICK / HIGH, rel=1e-3)


def test_the_path_follows_the_mechanism_down_to_nothing():
    """On stiff joints; 1e-4 g is the leaning tie's and the joints' part."""
    pushover = path(5e10)
    out = np.array([0.1, 0.3, 0.5, 0.7, 0.9]) * THICK
    assert np.interp(out, pushover.displacement, pushover.multiplier) == pytest.approx(rigid(out), abs=1e-4)


@pytest.mark.parametrize(("push", "place", "stiffness"), [(*MEASURED[0], 1.3e8), (*MEASURED[1], 9.4e7)])
def test_joints_that_give_way_where_the_wall_did_bear_what_it_bore(push, place, stiffness):
    """One number is taken from each curve, the stiffness whose path has its peak where it was; the height is found.

    0.1355 and 0.1312: 1.7 % less and 4.8 % more than measured, which has no spread; each of the two measured peaks is 4.8 %
    from their mean, and that, rounded up, is the tolerance.
    """
    pushover = path(stiffness)
    assert pushover.peak_displacement / THICK == pytest.approx(place, abs=5e-3)
    assert pushover.collapse_multiplier == pytest.approx(push, rel=0.05)
