"""Bodies in space: moments of parts, the joints that geometry finds, and what cannot stand as it is written down."""

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.column.shapes import ConvexSolid, Placed
from stylobate.column.spatial.stone import box_shape, drum_shape, mesh_moments

LAW = st.Joint(5e9, 2.5e9, friction_coefficient=0.7)
RNG = np.random.default_rng(4)


def assembly(*stones, **others):
    return st.SpatialAssembly(stones, LAW, **others)


def box(sides=(1.0, 1.0, 1.0), at=(0.0, 0.0, 0.0), **others):
    return st.Stone.box(sides, at, 2000.0, **others)


def about_z(degrees):
    return math.cos(math.radians(degrees) / 2.0), 0.0, 0.0, math.sin(math.radians(degrees) / 2.0)


def turned(axis, degrees):
    half = math.radians(degrees) / 2.0
    return math.cos(half), *(math.sin(half) * np.array(axis, dtype=float) / np.linalg.norm(axis))


def test_a_box_and_the_hull_of_its_corners_are_the_same_body():
    """Mass and inertia of a box by hand; to rounding, as the sums differ."""
    stone = box((0.8, 0.6, 4.0), (1.0, 2.0, 0.0), orientation=turned((1, 2, 3), 40.0))
    other = st.Stone.hull(stone.vertices, 2000.0)
    mass = 2000.0 * 0.8 * 0.6 * 4.0
    assert stone.mass == pytest.approx(mass, rel=1e-12)
    assert np.diag(stone.inertia_tensor) == pytest.approx(mass / 12.0 * np.array([16.36, 16.64, 1.0]), rel=1e-12)
    assert other.mass == pytest.approx(mass, rel=1e-9)
    assert other.position == pytest.approx(stone.position, abs=1e-9)
    np.testing.assert_allclose(
        other.inertia_tensor, stone.axes @ stone.inertia_tensor @ stone.axes.T, rtol=1e-9, atol=1e-6
    )
    assert len(other.shape.mesh().faces) == 6


def test_moments_of_a_hull_are_those_of_the_points_within_it():
    """Against two million random points: 1/sqrt of those within, 0.3 % at four times it."""
    shape = ConvexSolid(RNG.uniform(-1.0, 1.0, (12, 3)))
    moments = mesh_moments(shape.mesh(), 1.0)
    points = RNG.uniform(-1.0, 1.0, (400_000, 3))
    inside = np.ones(len(points), dtype=bool)
    for face in shape.mesh().faces:
        a, b, c = shape.vertices[list(face[:3])]
        inside &= (points - a) @ np.cross(b - a, c - a) <= 0.0
    share = inside.mean()
    assert moments.mass == pytest.approx(8.0 * share, rel=0.02)
    assert moments.centroid == pytest.approx(points[inside].mean(axis=0), abs=0.01)
    away = points[inside] - moments.centroid
    tensor = 8.0 * share * np.mean((away**2).sum(axis=1)) * np.eye(3) - 8.0 * share * away.T @ away / len(away)
    np.testing.assert_allclose(moments.tensor, tensor, atol=0.02 * np.trace(tensor))


def test_a_capital_is_one_body():
    """An echinus and a square abacus glued: mass, centroid and inertia by the parallel axes."""
    echinus, abacus = drum_shape(0.8, 1.2, 0.25, "it"), box_shape((1.2, 1.2, 0.2), "it")
    parts = (Placed(echinus, (0.0, 0.0, echinus.centroid)), Placed(abacus, (0.0, 0.0, 0.35)))
    capital = st.Stone(parts, (0.0, 0.0, 2.0), 2500.0)
    masses = [2500.0 * math.pi * 0.25 * (0.64 + 0.96 + 1.44) / 12.0, 2500.0 * 1.44 * 0.2]
    assert capital.mass == pytest.approx(sum(masses), rel=1e-12)
    middle = (masses[0] * echinus.centroid + masses[1] * 0.35) / sum(masses)
    assert [piece.place[2] for piece in capital.pieces] == pytest.approx(
        [echinus.centroid - middle, 0.35 - middle], abs=1e-12
    )
    # along the axis inertias add: of a cone's frustum ρπh(R⁵−r⁵)/(10(R−r)), of a square m a²/6
    cone = 2500.0 * math.pi * 0.25 * (0.6**5 - 0.4**5) / (10.0 * 0.2)
    assert capital.inertia_tensor[2, 2] == pytest.approx(cone + masses[1] * 1.44 / 6.0, rel=1e-9)
    assert np.ptp(capital.vertices[:, 2]) == pytest.approx(0.45, abs=1e-12)


def test_joints_are_where_faces_lie_on_one_another():
    """Overlaps by hand: a square on a larger one turned by 45 degrees, an octagon; a disc half on a beam; the ground."""
    step = box((1.0, 1.0, 0.5), fixed=True, name="step")
    square = box(at=(0.0, 0.0, 0.5), name="square", orientation=about_z(45.0))
    (joint,) = assembly(step, square).space_joints
    assert joint.area == pytest.approx(2.0 * (math.sqrt(2.0) - 1.0), rel=1e-9)
    assert len(joint.corners) == 8
    assert joint.frame[:, 2] == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
    assert joint.origin == pytest.approx([0.0, 0.0, 0.5], abs=1e-12)
    drum = st.Stone.drum(0.8, 0.8, 1.0, (0.5, 0.0, 0.5), 2000.0, name="drum")
    (half,) = assembly(step, drum).space_joints
    assert half.area == pytest.approx(0.08 * math.pi, rel=1e-3)  # a polygon of 96 corners
    assert half.origin[0] == pytest.approx(0.5 - 4.0 * 0.4 / (3.0 * math.pi), abs=1e-3)
    (disc,) = assembly(st.Stone.drum(0.8, 0.7, 1.0, (3.0, 1.0, 0.0), 2000.0)).space_joints
    assert disc.area == pytest.approx(0.16 * math.pi, rel=1e-12)
    assert disc.round


def test_what_only_leans_has_no_joint():
    """A drum on its side on the ground and a box on its edge touch, and no faces lie on one another."""
    lying = st.Stone.drum(0.8, 0.8, 1.0, (0.0, 0.0, -0.1), 2000.0, orientation=turned((1, 0, 0), 90.0), name="lying")
    assert lying.vertices[:, 2].min() == pytest.approx(0.0, abs=1e-12)
    tilted = box(
        (0.5, 0.5, 0.5), (3.0, 0.0, 0.25 * (math.sqrt(2.0) - 1.0)), orientation=turned((0, 1, 0), 45.0), name="tilted"
    )
    assert assembly(lying, tilted).space_joints == ()


@pytest.mark.parametrize(
    ("stones", "says"),
    [
        ([box(name="a"), box(at=(0.9, 0.0, 0.0), name="b")], "block 'b' and block 'a' overlap by 100 mm; move one of them"),
        ([box(at=(0.0, 0.0, -0.02), name="a")], "block 'a' lies in the ground by 20 mm; move it"),
        ([box(name="a"), box(at=(0.0, 0.0, 1.2), name="b")],
         r"block 'b' hangs in the air, 200 mm from block 'a'; put it down, or let it fall with settle = false"),
        ([box(at=(0.0, 0.0, 1.0), name="a"), box(at=(0.0, 0.0, 2.0), name="b")],
         "block 'a' hangs in the air, 1 m from the ground, and 1 more with it"),
        ([box(name="a"), box(at=(3.0, 0.0, 0.0), name="a")], "two blocks are called 'a'; give each a name of its own"),
        ([box(name="ground")], "a block is called 'ground'"),
        ([box(fixed=True)], "nothing of 'assembly' can move"),
        ([st.Stone.drum(1.0, 1.0, 1.0, (0.0, 0.0, 0.0), 2000.0, name="a"),
          st.Stone.drum(1.0, 1.0, 1.0, (0.6, 0.7, 0.0), 2000.0, name="b")], "'b' and block 'a' overlap by 78 mm"),
        ([st.Stone.drum(1.0, 1.0, 1.0, (0.0, 0.0, 0.0), 2000.0, name="a"),
          box(at=(0.95, 0.3, 0.0), name="b", orientation=about_z(30.0))], "'b' and block 'a' overlap by"),
    ],
)  # fmt: skip
def test_what_cannot_begin_is_refused(stones, says):
    with pytest.raises(st.InputError, match=says):
        assembly(*stones)


def test_two_thousand_bodies_are_refused_with_what_they_would_take():
    stones = [box(at=(2.0 * i, 0.0, 0.0), name=f"b{i}") for i in range(2000)]
    with pytest.raises(st.InputError, match=r"2000 bodies would take about 7 minutes .* and 67 once .* up to 600"):
        assembly(*stones)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (
            lambda: box((1.0, 0.0, 1.0), name="a"),
            r"a length of the box of block 'a' is 0 m; allowed is \[0.0001, 1000\] m",
        ),
        (lambda: box((1.0, 1.0), name="a"), r"box of block 'a' is \(1.0, 1.0\); give 3 lengths"),
        (lambda: st.Stone.hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], 1e3, name="a"), "has no thickness"),
        (
            lambda: st.Stone.hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1e-6]], 1e3, name="a"),
            "has a thickness of .* m; allow",
        ),
        (
            lambda: box(orientation=(1.0, 1.0, 0.0, 0.0), name="a"),
            r"orientation of block 'a' is .*; give a unit quaternion",
        ),
        (lambda: box(velocity=(1.0, 0.0, 0.0), fixed=True, name="a"), "block 'a' is fixed and has a velocity"),
        (lambda: box(velocity=(math.nan, 0.0, 0.0), name="a"), "x of velocity of block 'a' is nan"),
    ],
)
def test_a_body_that_cannot_be_is_refused(make, says):
    with pytest.raises(st.InputError, match=says):
        make()


def test_rotating_everything_changes_no_joint():
    """The same areas and as many joints, turned about the vertical by any angle: a corner of boxes, drums and a beam."""

    def scene(angle):
        turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
        at = [turn @ place for place in ((0.0, 0.0), (2.0, 0.0), (0.0, 2.0))]
        stones = [st.Stone.drum(0.8, 0.7, 2.0, (*point, 0.0), 2000.0, name=f"d{i}") for i, point in enumerate(at)]
        way = about_z(math.degrees(angle))
        stones.append(box((2.4, 0.4, 0.5), (*(turn @ (1.0, 0.0)), 2.0), name="x", orientation=way))
        stones.append(box((0.4, 1.8, 0.5), (*(turn @ (0.0, 1.1)), 2.0), name="y", orientation=way))
        return assembly(*stones).space_joints

    level = scene(0.0)
    for angle in (0.3, 1.0, 2.5):
        other = scene(angle)
        assert [(joint.lower, joint.upper) for joint in other] == [(joint.lower, joint.upper) for joint in level]
        assert [joint.area for joint in other] == pytest.approx(
            [joint.area for joint in level], rel=2e-3
        )  # of 96 corners
