"""Columns as found against statics: what is in equilibrium, what opens a joint, and a slope as a steady push."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hyp

import stylobate as st
from stylobate.column import preset
from stylobate.column.found_geometry import geometry, uplift_accelerations

JOINT = st.Joint(normal_stiffness=1e11, shear_stiffness=5e10, friction_angle=35.0)
STILL = st.Motion(0.5, np.zeros(3))
HALF, HEIGHT = 0.3, 3.0


def column(drums=1, **condition):
    made = st.Column.tapered(
        height=HEIGHT, bottom_width=2 * HALF, top_width=2 * HALF, drums=drums, density=2000.0, joint=JOINT, name="prism"
    )
    return made.replace(as_found=as_found(**condition))


def as_found(base_tilt=0.0, **drums):
    numbers = {int(name.split("_")[-1]) for name in drums}
    return st.AsFound(
        tuple(
            st.FoundDrum(
                i, **{name.rpartition("_")[0]: value for name, value in drums.items() if name.endswith(f"_{i}")}
            )
            for i in numbers
        ),
        base_tilt,
    )


# -- equilibrium -------------------------------------------------------------------------------------------------------


def test_offset_beyond_the_edge_is_refused_with_the_missing_moment():
    column(3, offset_2=0.29)
    # drums 2 and 3 weigh 2 × 0.6 × 2000 × 9.81 N and stand 0.31 m off an edge at 0.30 m
    with pytest.raises(st.InputError, match="at joint 2 the weight above passes 10 mm beyond") as error:
        column(3, offset_2=0.31)
    assert f"{2 * 0.6 * 2000.0 * 9.81 * 0.01:.4g} N m are missing" in str(error.value)


@pytest.mark.parametrize(("how", "limit"), [("base_tilt", math.atan(0.2)), ("tilt_1", math.asin(0.2))])
def test_limits_of_a_slope_and_of_a_lean(how, limit):
    # the centroid is 1.5 m up: over the end of a face on a slope, or beside its middle by that much of the lean's sine
    limit = math.degrees(limit)
    column(1, **{how: 0.999 * limit})
    column(1, **{how: -0.999 * limit})
    with pytest.raises(st.InputError, match="at joint 1 the weight above passes"):
        column(1, **{how: 1.001 * limit})


def test_a_slope_steeper_than_friction_is_refused_with_the_missing_force():
    slippery = column(3).with_joint(friction_angle=5.0)
    slippery.replace(as_found=st.AsFound(base_tilt=4.99))
    weight, slope = slippery.mass * slippery.gravity, math.radians(6.0)
    missing = weight * (math.sin(slope) - math.cos(slope) * math.tan(math.radians(5.0)))
    with pytest.raises(st.InputError, match="joint 1 slides down its slope") as error:
        slippery.replace(as_found=st.AsFound(base_tilt=6.0))
    assert f"{missing:.4g} N of friction are missing" in str(error.value)
    # a leaning drum makes the joint above it slope as much
    with pytest.raises(st.InputError, match="joint 2 slides down its slope"):
        slippery.replace(as_found=as_found(tilt_1=-6.0))


def test_leans_and_a_slope_may_cancel():
    with pytest.raises(st.InputError, match="not in equilibrium"):
        column(3, base_tilt=12.0)
    assert column(3, base_tilt=12.0, tilt_1=-12.0).uplift_acceleration > 0.0


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: column(3, offset_4=0.1), "is given drum 4 as found; it has drums 1 to 3"),
        (lambda: column(3, chip_left_2=0.7), "joint 2 of 'prism' has no contact left"),
        (lambda: column(3, offset_2=math.nan), "offset of drum 2"),
        (lambda: st.FoundDrum(0), "allowed is a whole number from 1"),
        (lambda: st.FoundDrum(1, chip_left=-0.1), "chip_left of drum 1"),
        (lambda: st.AsFound((st.FoundDrum(1), st.FoundDrum(1))), "drum 1 is given twice"),
        (lambda: st.AsFound(base_tilt=50.0), "base_tilt is 50"),
    ],
)
def test_bad_descriptions(make, says):
    with pytest.raises(st.InputError, match=re.escape(says)):
        make()


def test_contacts_of_offsets_and_chips():
    at = geometry(column(3, chip_left_2=0.1, chip_right_3=0.2, offset_3=0.05))
    assert at.low == pytest.approx([-0.3, -0.2, -0.25])
    assert at.high == pytest.approx([0.3, 0.3, 0.15])


# -- what opens a joint ------------------------------------------------------------------------------------------------

SLOPE = math.radians(3.0)
ALPHA = math.atan(HALF / (0.5 * HEIGHT))

#: Acceleration of the ground to the right and to the left that opens a joint of the prism [g], by hand.
UPLIFT = {
    "as built": ({}, 1, math.tan(ALPHA), math.tan(ALPHA)),
    "slope": ({"base_tilt": 3.0}, 1, math.tan(ALPHA - SLOPE), math.tan(ALPHA + SLOPE)),
    "chip left": ({"chip_left_1": 0.06}, 1, (HALF - 0.06) / 1.5, HALF / 1.5),
    "lean": (
        {"tilt_1": 3.0}, 1,
        (HALF - 1.5 * math.sin(SLOPE)) / (1.5 * math.cos(SLOPE)), (HALF + 1.5 * math.sin(SLOPE)) / (1.5 * math.cos(SLOPE)),
    ),
    "lean on its slope": ({"tilt_1": -3.0, "base_tilt": 3.0}, 1, None, None),
    "offset of the upper half": ({"offset_2": -0.1}, 2, (HALF - 0.05) / 1.5, (HALF + 0.05) / 1.5),
}  # fmt: skip
#: It stands plumb: the weight is 1.5 m sin 3° out of the middle of its face, along the base.
_plumb = [(HALF + sign * 1.5 * math.sin(SLOPE), 1.5 * math.cos(SLOPE)) for sign in (1, -1)]
UPLIFT["lean on its slope"] = (
    {"tilt_1": -3.0, "base_tilt": 3.0}, 1,
    math.tan(math.atan2(*_plumb[0]) - SLOPE), math.tan(math.atan2(*_plumb[1]) + SLOPE),
)  # fmt: skip


@pytest.mark.parametrize("name", UPLIFT)
def test_uplift_accelerations_by_hand(name):
    condition, drums, right, left = UPLIFT[name]
    got = uplift_accelerations(column(drums, **condition))[0] / st.g
    assert got == pytest.approx([-left, right], rel=1e-12)


@pytest.mark.parametrize("name", UPLIFT)
@pytest.mark.parametrize("side", [1, -1])
def test_distinct_elements_open_the_joint_at_its_closed_form(name, side):
    condition, drums, right, left = UPLIFT[name]
    limit = right if side > 0 else left
    stone = column(drums, **condition).with_joint(normal_stiffness=1e12, shear_stiffness=5e11)
    for share, opens in ((0.99, False), (1.01, True)):
        ramp = side * share * limit * st.g * np.concatenate((np.linspace(0.0, 1.0, 100), np.ones(5)))
        response = st.simulate(stone, st.Motion(0.01, ramp), st.DistinctElement2D(stiffness_damping=1e-5))
        assert (response.measures.peak_joint_opening > 0.0) is opens
        # the part above turns away from where the ground goes: counter-clockwise for an acceleration to the right
        if opens:
            assert side * response.drum_rotation[-1, -1] > 1e-5


# -- standing ----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("points", [2, 5])
@given(
    offsets=hyp.lists(hyp.floats(-0.03, 0.03), min_size=12, max_size=12),
    tilts=hyp.lists(hyp.floats(-0.5, 0.5), min_size=12, max_size=12),
    chips=hyp.lists(hyp.floats(0.0, 0.05), min_size=12, max_size=12),
    slope=hyp.floats(-1.0, 1.0),
)
@settings(max_examples=15, deadline=None)
def test_whatever_is_in_equilibrium_stands_where_it_is(points, offsets, tilts, chips, slope):
    drums = tuple(
        st.FoundDrum(i + 1, offset=o, tilt=t, chip_left=c if i % 2 else 0.0, chip_right=0.0 if i % 2 else c)
        for i, (o, t, c) in enumerate(zip(offsets, tilts, chips, strict=True))
    )
    try:
        stone = preset("paper-12-drums").replace(as_found=st.AsFound(drums, slope))
    except st.InputError:
        return
    response = st.simulate(stone, STILL, st.DistinctElement2D(points=points))
    assert response.provenance["residual_acceleration_at_start_m_s2"] < 1e-3
    assert np.abs(response.drum_x).max() < 1e-7
    assert np.abs(response.joint_slip).max() < 1e-9


def test_what_stands_for_good_knows_how_it_is_found():
    """The same small push: enough for a column on the verge, nothing for one as built; both verdicts are certain."""
    push = st.ricker(1.0, 0.03 * st.g)
    limit = math.degrees(ALPHA)
    verge = st.simulate(column(base_tilt=0.995 * limit), push, st.DistinctElement2D())
    built = st.simulate(column(), push, st.DistinctElement2D())
    assert verge.collapsed
    assert verge.measures.reason == "the whole column overturned about joint 1, to the left"
    assert built.outcome is st.Outcome.AT_REST
    assert built.measures.decided


def test_a_slope_is_a_steady_push():
    """On a slope β: gravity g cos β, and a ground that accelerates by a cos β + g sin β along the base, −a sin β off it."""
    slope = 2.0
    stone = column(base_tilt=slope)
    time = np.arange(0.0, 6.0, 0.01)
    shaking = 0.3 * st.g * np.sin(2.0 * np.pi * 1.5 * time) * np.minimum(time, 1.0)
    model = st.DistinctElement2D(stiffness_damping=1e-4, step_factor=0.2)
    on_slope = st.simulate(stone, st.Motion(0.01, shaking), model)
    c, s = math.cos(math.radians(slope)), math.sin(math.radians(slope))
    # the push grows before the shaking begins
    lead = np.concatenate((np.linspace(0.0, 1.0, 200), np.ones(len(time))))
    along = np.concatenate((np.zeros(200), shaking * c)) + st.g * s * lead
    off = -np.concatenate((np.zeros(200), shaking * s))
    level = column().replace(gravity=st.g * c)
    pushed = st.simulate(level, st.Motion(0.01, along, vertical=off), model)
    later = np.interp(on_slope.time + 2.0, pushed.time, pushed.drum_rotation[:, 0])
    assert on_slope.measures.peak_rotation > 0.3 * ALPHA
    assert np.abs(on_slope.drum_rotation[:, 0] - later).max() < 0.01 * on_slope.measures.peak_rotation
