"""Where two convex bodies in space overlap: volume, middle and vector area against hulls of half-spaces; what is culled."""

import math

import numpy as np
import pytest
from bodies_in_space import LYING, box, box_mesh, cylinder, ground, turn
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, HalfspaceIntersection

from stylobate.column.shapes import Mesh
from stylobate.kernels.space import bed, nearest
from stylobate.kernels.space.overlap import MIDDLE, MOMENT, NORMAL, REF, SHADOW, VOLUME
from stylobate.kernels.space.records import types, workspace
from stylobate.models.space.packing import Drum, Solid, pack


class Pair:
    """Two solids, and what their overlap adds up to."""

    def __init__(self, solid, other, direction=None):
        self.packed = packed = pack([solid, other])
        self.work, self.simplex = workspace(), np.zeros((4, 3))
        self.pair = np.zeros(1, types()["pair"])[0]
        way = other.place - solid.place
        self.pair["n"] = way / np.linalg.norm(way) if direction is None else direction
        self.arguments = (packed.shape[0], packed.body[0], packed.shape[1], packed.body[1])

    def touches(self):
        p = self.packed
        return bed.touching(
            self.pair, *self.arguments, p.vertex, p.plane, p.loop, p.corner, 4.0, self.work, self.simplex
        )

    @property
    def total(self):
        return self.work[-1]

    @property
    def middle(self):
        return self.total[REF : REF + 3] + self.total[MOMENT : MOMENT + 3] / self.total[VOLUME]


def half_spaces(solid):
    """Planes of a solid of one mesh in space."""
    hull = ConvexHull(np.asarray(solid.parts[0].vertices) @ solid.axes.T + solid.place)
    return hull.equations


def reference(solid, other):
    """Volume and middle of the overlap; 0 if there is none to speak of."""
    planes = np.concatenate([half_spaces(solid), half_spaces(other)])
    solution = linprog(
        [0, 0, 0, -1], A_ub=np.c_[planes[:, :3], np.ones(len(planes))], b_ub=-planes[:, 3], bounds=(None, None)
    )
    if solution.x[3] < 1e-9:
        return 0.0, None
    corners = HalfspaceIntersection(planes, solution.x[:3]).intersections
    hull = ConvexHull(corners)
    inside = corners.mean(axis=0)
    volume, moment = 0.0, np.zeros(3)
    for triangle in corners[hull.simplices]:
        part = abs(np.linalg.det(triangle - inside)) / 6.0
        volume += part
        moment += part * (triangle.sum(axis=0) + inside) / 4.0
    return volume, moment / volume


def prism(sides, radius, height):
    angle = np.arange(sides) * 2.0 * math.pi / sides
    ring = radius * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    vertices = np.concatenate([np.column_stack((ring, np.full(sides, z))) for z in (-0.5 * height, 0.5 * height)])
    faces = [(k, (k + 1) % sides, sides + (k + 1) % sides, sides + k) for k in range(sides)]
    return Mesh(vertices, (*faces, tuple(range(sides))[::-1], tuple(range(sides, 2 * sides))))


def solid(mesh, place, axes):
    return Solid([mesh], np.array(place, dtype=float), axes, 1.0)


def direction(rng):
    vector = rng.normal(size=3)
    return vector / np.linalg.norm(vector)


def poses(seed, count):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        meshes = [
            box_mesh(rng.uniform(0.3, 1.2, 3)),
            prism(rng.integers(3, 12), rng.uniform(0.2, 0.6), rng.uniform(0.3, 1.0)),
        ]
        turns = [turn(*rng.normal(size=3)) for _ in range(2)]
        yield solid(meshes[0], (0, 0, 0), turns[0]), solid(meshes[1], direction(rng) * rng.uniform(0.35, 0.9), turns[1])


def test_volume_and_middle_of_random_bodies():
    """Met to 1e-9 m³ in 60 poses; where the hull of half-spaces is empty, nothing is in contact."""
    overlaps = 0
    for solid, other in poses(1, 60):
        volume, middle = reference(solid, other)
        pair = Pair(solid, other)
        touches = pair.touches()
        if volume < 1e-9:
            assert not touches or pair.total[VOLUME] < 1e-8
            continue
        overlaps += 1
        assert touches
        assert pair.total[VOLUME] == pytest.approx(volume, abs=1e-9)
        assert pair.middle == pytest.approx(middle, abs=1e-6)
    assert overlaps > 30


def test_the_direction_changes_only_what_is_left_out():
    """Faces outside the slab along any direction do not bound the overlap."""
    rng = np.random.default_rng(2)
    for solid, other in poses(3, 12):
        if reference(solid, other)[0] < 1e-9:
            continue
        results = []
        for _ in range(4):
            pair = Pair(solid, other, direction(rng))
            assert pair.touches()
            results.append([pair.total[VOLUME], *pair.middle, *pair.total[NORMAL : NORMAL + 3]])
        assert np.ptp(results, axis=0) == pytest.approx(np.zeros(7), abs=1e-12)


def test_boxes_apart_and_how_far():
    """The certified distance of a box from another one's face, edge and corner."""
    for place, gap in (((0, 0, 1.3), 0.3), ((0, 1.3, 1.4), 0.5), ((1.2, 1.1, 1.2), 0.3)):
        pair = Pair(box((1, 1, 1), (0, 0, 0)), box((1, 1, 1), place))
        separation = nearest.parting(*pair.arguments, 1.0, pair.packed.vertex, 0.6, 0.0, 0.8, pair.simplex)
        assert separation[0] == pytest.approx(gap, rel=1e-6)
        assert not pair.touches()


@pytest.mark.parametrize("depth", [1e-3, 1e-6, 1e-9])
def test_box_flat_on_a_box_of_its_width(depth):
    """Sides that are flush count once: volume, middle, and normal as of a slab so deep."""
    pair = Pair(box((1, 0.6, 0.4), (0, 0, 0)), box((1, 0.6, 0.8), (0, 0, 0.6 - depth)), (0.0, 0.0, 1.0))
    assert pair.touches()
    assert pair.total[VOLUME] == pytest.approx(0.6 * depth, rel=1e-6, abs=1e-10)
    assert pair.total[NORMAL : NORMAL + 3] == pytest.approx([0.0, 0.0, 0.6], abs=1e-8)
    assert pair.middle == pytest.approx([0.0, 0.0, 0.2 - 0.5 * depth], abs=1e-8)


def test_second_moments_of_the_contact():
    """A rectangle of 1.0 × 0.6 m."""
    pair = Pair(ground(), box((1.0, 0.6, 0.4), (3.0, 1.0, 0.1999)), (0.0, 0.0, 1.0))
    assert pair.touches()
    total = pair.total
    g = total[MIDDLE : MIDDLE + 3] / total[SHADOW]
    xx, yy, xy = bed.in_plane(total, (0.0, 0.0, 1.0), tuple(g), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    assert [xx, yy, xy] == pytest.approx([1.0 / 12.0, 0.36 / 12.0, 0.0], abs=1e-10)


@pytest.mark.parametrize("ratio", [1.0, 0.5, 0.2, 0.05])
def test_lever_of_rectangles(ratio):
    """Mean distance from the middle, against the sum over a fine grid."""
    x, y = np.meshgrid((np.arange(400) + 0.5) / 400 - 0.5, ratio * ((np.arange(400) + 0.5) / 400 - 0.5))
    exact = np.hypot(x, y).mean()
    square, mean = bed.lever(1.0 / 12.0, ratio**2 / 12.0, 0.0)
    assert square == pytest.approx((1.0 + ratio**2) / 12.0)
    assert math.sqrt(mean) == pytest.approx(exact, rel=1e-2)


@pytest.mark.parametrize("tilt", [0.0, 0.05])
@pytest.mark.parametrize("radii", [(0.4, 0.4), (0.4, 0.3)])
def test_a_drum_turns_a_facet_to_where_it_is_touched(tilt, radii):
    """Lying, whichever way it has rolled: the line of its cone that is lowest is in the facet."""
    depth, low, high = 1e-4, *radii
    slope = math.atan((low - high) / 1.0)
    for rolled in (0.0, 0.1, 0.2, 1.0):
        drum = Drum(np.array([0.0, 0.0, -0.5]), np.array([0.0, 0.0, 1.0]), 1.0, low, high)
        axes = turn(0.0, 0.0, tilt) @ turn(0.5 * math.pi + slope, 0.0, 0.0) @ turn(0.0, 0.0, rolled)
        height = 0.5 * (low + high) * math.cos(slope) - depth
        pair = Pair(ground(), Solid([drum], np.array([0.0, 0.0, height]), axes, 1.0), (0.0, 0.0, 1.0))
        assert pair.touches()
        deep = pair.total[VOLUME] / np.linalg.norm(pair.total[NORMAL : NORMAL + 3])
        assert deep == pytest.approx(depth, rel=3e-3)  # the next facets begin 15° aside
        assert pair.middle @ (math.cos(tilt), math.sin(tilt), 0.0) == pytest.approx(0.0, abs=1e-9)


def test_two_lying_drums_turn_to_one_another():
    """After one step whatever they were turned to, along the shortest way between their axes."""
    way = np.array([0.6, 0.0, 0.8])
    pair = Pair(cylinder(0.4, 1.0, (0, 0, 0), LYING), cylinder(0.4, 1.0, 0.7999 * way, LYING), way)
    assert pair.touches()
    p, shape, body = pair.pair, pair.packed.shape, pair.packed.body
    bed.face_contact(
        p, (0.6, 0.0, 0.8), shape[0], body[0], shape[1], body[1], pair.packed.vertex, pair.total, pair.simplex
    )
    assert p["ta"] / np.linalg.norm(p["ta"]) == pytest.approx(way, abs=1e-12)
    assert p["tb"] / np.linalg.norm(p["tb"]) == pytest.approx(-way, abs=1e-12)
