"""Closed-form properties of drums and columns: printed values, and quadrature over the height."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import stylobate as st
from stylobate.column.catalogue import preset
from stylobate.column.scatter import Scatter, twins_of

JOINT = st.Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_angle=35.0)
SHAPES = [(0.82, 1.11, 1.08), (5.0, 0.96, 0.66), (0.3, 2.0, 0.4), (1.0, 0.5, 0.9), (1.0, 1.0, 1.0)]


def paper_column(drums=1, section="rectangular"):
    return st.Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=drums, density=1600.0, joint=JOINT, section=section
    )


@pytest.mark.parametrize("section", ["rectangular", "circular"])
@pytest.mark.parametrize("shape", SHAPES)
def test_mass_centroid_and_inertia_against_quadrature(shape, section):
    height, bottom, top = shape
    drum = st.Drum(height, bottom, top, density=2400.0, section=section, depth=0.7)

    def width(z):
        return bottom + (top - bottom) * z / height

    def area(z):
        return math.pi * width(z) ** 2 / 4 if section == "circular" else 0.7 * width(z)

    def own_second_moment(z):
        return math.pi * width(z) ** 4 / 64 if section == "circular" else 0.7 * width(z) ** 3 / 12

    volume = quad(area, 0, height, epsabs=0, epsrel=1e-13)[0]
    centroid = quad(lambda z: z * area(z), 0, height, epsabs=0, epsrel=1e-13)[0] / volume
    inertia = quad(lambda z: own_second_moment(z) + area(z) * (z - centroid) ** 2, 0, height, epsabs=0, epsrel=1e-13)[0]
    assert drum.mass == pytest.approx(2400.0 * volume, rel=1e-12)
    assert drum.centroid_height == pytest.approx(centroid, rel=1e-12)
    assert drum.inertia == pytest.approx(2400.0 * inertia, rel=1e-12)


@pytest.mark.parametrize("shape", SHAPES)
def test_inertia_of_the_trapezium_in_closed_form(shape):
    h, b, t = shape
    drum = st.Drum(h, b, t, density=1600.0, depth=2.0)
    closed = 1600.0 * 2.0 * (h**3 * (b**2 + 4 * b * t + t**2) / (36 * (b + t)) + h * (b + t) * (b**2 + t**2) / 48)
    assert drum.inertia == pytest.approx(closed, rel=1e-13)


@pytest.mark.parametrize("section", ["rectangular", "circular"])
def test_a_stack_of_drums_is_the_monolith(section):
    whole, stack = paper_column(1, section), paper_column(12, section)
    for name in ("height", "mass", "centroid_height", "slenderness", "radius", "corner_inertia", "restitution"):
        assert getattr(stack, name) == pytest.approx(getattr(whole, name), rel=1e-12), name
    assert stack.frequency_parameter == pytest.approx(whole.frequency_parameter, rel=1e-12)
    assert stack.uplift_acceleration == pytest.approx(whole.uplift_acceleration, rel=1e-12)
    assert stack.joint_weights[0] == pytest.approx(whole.mass * st.g, rel=1e-12)


def test_uplift_of_a_joint_is_that_of_the_part_above_it():
    column = paper_column(12)
    for i in range(12):
        above = st.Column(column.drums[i:], column.joints[i:])
        assert column.joint_uplift_accelerations[i] == pytest.approx(st.g * math.tan(above.slenderness), rel=1e-12)


def test_contact_section_is_the_smaller_of_two_faces():
    drums = [st.Drum(1.0, 1.0, 0.8, 2000.0, depth=2.0), st.Drum(1.0, 0.9, 0.5, 2000.0, depth=1.5)]
    column = st.Column.of_drums(drums, JOINT)
    np.testing.assert_allclose(column.joint_widths, [1.0, 0.8])
    np.testing.assert_allclose(column.joint_areas, [2.0, 1.2])
    np.testing.assert_allclose(column.joint_second_moments, [2.0 / 12, 1.5 * 0.8**3 / 12])
    round_column = st.Column.of_drums([st.Drum(1.0, 1.0, 0.8, 2000.0, section="circular")], JOINT)
    assert round_column.joint_areas[0] == pytest.approx(math.pi / 4)
    assert round_column.joint_second_moments[0] == pytest.approx(math.pi / 64)


def test_presets_are_the_columns_of_the_paper():
    for name, drums in (("paper-monolithic", 1), ("paper-12-drums", 12)):
        column = preset(name)
        assert column.n == drums
        assert column.mass == pytest.approx(1600.0 * 5.0 * 0.81, rel=1e-12)
        assert {joint.normal_stiffness for joint in column.joints} == {5e10}
        assert {joint.shear_stiffness for joint in column.joints} == {2.5e10}


def test_a_drum_that_widens_upward_is_said_and_computed():
    with pytest.warns(st.OutOfRangeWarning, match=r"drum 1 of .* widens upward"):
        column = st.Column.of_drums([st.Drum(1.0, 0.5, 0.9, 2000.0)], JOINT)
    assert column.base_width == 0.5


def column_of(*widths):
    return st.Column.of_drums([st.Drum(0.8, low, high, 2000.0) for low, high in widths], JOINT, name="c")


@pytest.mark.parametrize(
    "capital",
    [
        [(0.85, 1.15)],  # an echinus
        [(0.84, 0.84), (0.80, 1.15), (1.20, 1.20)],  # a necking, an echinus that springs from inside it, an abacus
        [(0.85, 1.2), (1.2, 1.3)],  # a capital in two, a block that flares on it
    ],
)
def test_a_capital_on_a_shaft_is_no_mistake(capital):
    assert column_of((1.0, 0.9), (0.9, 0.85), *capital).n == 2 + len(capital)  # a warning is an error here


@pytest.mark.parametrize(
    ("widths", "message"),
    [
        ([(1.0, 0.9), (0.8, 0.9), (0.8, 0.7)], "drum 2 of 'c' widens upward"),
        ([(1.0, 0.9), (0.8, 0.9)], "drum 2 of 'c' widens upward"),
        ([(0.7, 0.8), (0.8, 0.9), (0.9, 1.0)], "'c' widens upward from its base"),
    ],
)
def test_widths_that_fit_better_swapped_are_said(widths, message):
    with pytest.warns(st.OutOfRangeWarning, match=message) as seen:
        column_of(*widths)
    assert len(seen) == 1


def test_twins_are_not_warned_of_again():
    with pytest.warns(st.OutOfRangeWarning, match="widens upward"):
        column = column_of((1.0, 0.9), (0.8, 0.9))
    # warnings are errors here
    assert len(twins_of(column, Scatter(), 15, 1)) == 15
    assert column.replace(name="d").name == "d"
    with pytest.raises(TypeError, match="no field 'nme'"):
        column.replace(nme="d")
    with pytest.warns(st.OutOfRangeWarning, match="widens upward"):
        column_of((1.0, 0.9)).replace(drums=column.drums, joints=column.joints)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: st.Drum(-1.0, 1.0, 1.0, 2000.0), ["height", "-1 m", "[0.0001, 1000] m"]),
        (lambda: st.Drum(1.0, 1.0, 1.0, math.nan), ["density", "nan"]),
        (lambda: st.Drum(1.0, 1.0, 1.0, 2000.0, section="round"), ["'round'", "circular, rectangular"]),
        (lambda: st.Joint(0.0, 1e10, 35.0), ["normal_stiffness", "0 N/m³", "rigid joint"]),
        (lambda: st.Joint(1e10, 1e10, friction_angle=90.0), ["friction_angle", "90", "[0, 90) degrees"]),
        (lambda: st.Joint(1e10, 1e10, friction_angle=30.0, friction_coefficient=0.5), ["both given"]),
        (lambda: paper_column(0), ["drums is 0", "1 to 200"]),
        (lambda: paper_column(10**6), ["drums is 1000000", "1 to 200"]),
        (lambda: st.Column((), ()), ["0 drums"]),
    ],
)
def test_impossible_columns_are_refused_in_one_sentence(make, words):
    with pytest.raises(st.InputError) as error:
        make()
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize(
    "shape", [(0.82, 1.11, 1.08, 0.9, 0.7), (5.0, 0.96, 0.66, 0.96, 0.66), (0.5, 0.6, 1.0, 1.2, 0.3)]
)
@pytest.mark.filterwarnings("ignore::stylobate.OutOfRangeWarning")
def test_a_frustum_that_tapers_in_depth_against_quadrature(shape):
    """Volume, centroid and all three moments of inertia, over the height."""
    h, b, t, w, v = shape
    drum = st.Drum(h, b, t, 2400.0, depth=w, top_depth=v)

    def over_height(f):
        def integrand(z):
            return f(z, b + (t - b) * z / h, w + (v - w) * z / h)

        return 2400.0 * quad(integrand, 0, h, epsabs=0, epsrel=1e-13)[0]

    mass = over_height(lambda z, x, y: x * y)
    centroid = over_height(lambda z, x, y: x * y * z) / mass
    assert drum.mass == pytest.approx(mass, rel=1e-12)
    assert drum.centroid_height == pytest.approx(centroid, rel=1e-12)
    assert drum.inertia == pytest.approx(over_height(lambda z, x, y: x * y * (x * x / 12 + (z - centroid) ** 2)))
    assert drum.cross_inertia == pytest.approx(over_height(lambda z, x, y: x * y * (y * y / 12 + (z - centroid) ** 2)))
    assert drum.axial_inertia == pytest.approx(over_height(lambda z, x, y: x * y * (x * x + y * y) / 12))
    # a depth that is the same above and below is what it was
    assert st.Drum(h, b, t, 2400.0, depth=w, top_depth=w) == st.Drum(h, b, t, 2400.0, depth=w)


def test_eight_square_blocks_of_one_taper_are_the_pyramid():
    whole, stack = (
        st.Column.tapered(
            height=5.95,
            bottom_width=1.11,
            top_width=0.9,
            drums=n,
            density=2620.0,
            joint=JOINT,
            depth=1.11,
            top_depth=0.9,
        )
        for n in (1, 8)
    )
    assert whole.mass == pytest.approx(2620.0 * 5.95 / 3 * (1.11**2 + 1.11 * 0.9 + 0.9**2), rel=1e-12)
    for name in ("mass", "centroid_height", "corner_inertia", "uplift_acceleration"):
        assert getattr(stack, name) == pytest.approx(getattr(whole, name), rel=1e-12), name
    assert stack.joint_areas == pytest.approx(np.square(stack.joint_widths), rel=1e-12)
    assert [drum.inertia for drum in stack.drums] == [drum.cross_inertia for drum in stack.drums]
    with pytest.raises(st.InputError, match="circular section; leave it out"):
        st.Drum(1.0, 1.0, 1.0, 2000.0, "circular", top_depth=0.9)
