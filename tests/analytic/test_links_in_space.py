"""Links between bodies in space against hand calculations, whichever way they are turned: clamp, dowel, tie, bar."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.column.links import Link, block_link
from stylobate.column.shapes import about

G = 9.80665
DENSITY = 2000.0
SMOOTH = st.Joint(1e9, 5e8, friction_coefficient=0.0)
ROUGH = st.Joint(1e9, 5e8, friction_coefficient=2.0)
AZIMUTH = math.radians(37.0)


def turned(point: tuple[float, float, float]) -> tuple[float, float, float]:
    """A place in the axes of the scene, which is turned about the vertical [m]."""
    x, y, z = point
    c, s = math.cos(AZIMUTH), math.sin(AZIMUTH)
    return c * x - s * y, s * x + c * y, z


def box(sides: tuple[float, float, float], at: tuple[float, float, float], name: str, **others) -> st.Stone:
    return st.Stone.box(sides, turned(at), DENSITY, name=name, orientation=about((0.0, 0.0, 1.0), AZIMUTH), **others)


def push(acceleration: float, rise: float, hold: float) -> st.Motion:
    """A ground acceleration against the scene's x that rises evenly and stays; what stands on it is pushed along x."""
    time = np.arange(round((rise + hold) / 0.01) + 1) * 0.01
    size = -acceleration * np.minimum(time / rise, 1.0)
    return st.Motion(0.01, size * math.cos(AZIMUTH), lateral=size * math.sin(AZIMUTH))


def side_by_side(*links: Link) -> st.SpatialAssembly:
    """A box that stays and, beside it along x, one of 1 t that slides freely; both 0.5 m high and 1 m wide."""
    fixed_box = box((1.0, 1.0, 0.5), (0.5, 0.0, 0.0), "held", fixed=True)
    free = box((1.0, 1.0, 0.5), (1.5, 0.0, 0.0), "free", surface=SMOOTH)
    return st.SpatialAssembly((fixed_box, free), SMOOTH, "pair", gravity=G, links=links)


def clamp(**what: float | str) -> Link:
    ends = {"between": ("held", "free"), "at": turned((0.85, 0.0, 0.25)), "to": turned((1.15, 0.0, 0.25))}
    return block_link("clamp", **ends, **what)


@pytest.mark.parametrize("azimuth", [0.0, 90.0, 37.0])
def test_a_bar_is_drawn_as_long_as_its_upper_stone_reaches_along_it(azimuth) -> None:
    """0.15 of that, whichever way the scene is turned; what is seen along y is 0.5 m high and, turned, 1 m wide."""
    about_z, turn = about((0.0, 0.0, 1.0), math.radians(azimuth)), math.radians(azimuth)
    places = [(r * math.cos(turn), r * math.sin(turn), 0.0) for r in (0.0, 2.0)]
    stones = [
        st.Stone.box((2.0, 1.0, 0.5), place, DENSITY, name=name, orientation=about_z)
        for place, name in zip(places, "ab", strict=True)
    ]
    bar = block_link("bar", ("a", "b"), shear_stiffness=1e6, axial_stiffness=1e6, axial_capacity=1e4)
    (placed,) = st.SpatialAssembly(stones, SMOOTH, links=(bar,)).placed_links
    assert placed.stroke == pytest.approx(0.15 * 2.0)


def test_a_clamp_in_pull_snaps_at_its_capacity() -> None:
    """The force m a rises by 4 kN in a second: T = m a to 2 kN, at 0.5 s, where it snaps; then the box slides by itself.

    Clamp and box swing at 100 rad/s, which a steady rise of 4 kN/s excites by 4/100 kN.
    """
    brittle = clamp(axial_stiffness=1e7, axial_capacity=2e3, shear_stiffness=0.0, failure="brittle")
    response = st.simulate(side_by_side(brittle), push(4.0, 1.0, 0.1), st.DistinctElement3D())
    (measures,) = response.measures.links
    time, tension = response.time, response.links.tension[:, 0]
    early = (time > 0.1) & (time < 0.48)
    assert tension[early] == pytest.approx(4e3 * time[early], abs=1.2 * 4e3 / 100.0)
    assert measures.peak_tension == pytest.approx(2e3, rel=1e-9)
    assert measures.broken_at == pytest.approx(0.5, abs=0.012)
    assert not tension[time > 0.52].any()
    way = np.linalg.norm(response.body_position[:, 2] - response.body_position[0, 2], axis=1)
    after = (time > measures.broken_at + 0.02) & (time < 0.98)
    step = time[1] - time[0]
    assert np.diff(way[after], 2) / step**2 == pytest.approx(4.0 * time[after][1:-1], rel=2e-3)
    assert response.energy_imbalance < 1e-3
    assert "The clamp broke at 0.5" in response.sentence
    assert response.summary()["links"][0]["broken_s"] == measures.broken_at


def test_a_clamp_holds_against_both_senses_behind_its_slack() -> None:
    """Pushed to and fro across a gap, the box swings about slack + m a/K on either side of where it was.

    It comes out of its slack with some speed: the mean of a spring that holds it, over several of its periods of 0.2 s, is
    that of the push as long as it does not fall back into the slack.
    """
    fixed_box, _ = side_by_side().stones
    apart = fixed_box, box((1.0, 1.0, 0.5), (1.55, 0.0, 0.0), "free", surface=SMOOTH)
    ends = {"between": ("held", "free"), "at": turned((0.85, 0.0, 0.25)), "to": turned((1.2, 0.0, 0.25))}
    link = block_link("clamp", **ends, axial_stiffness=1e6, shear_stiffness=0.0, clearance=1e-4)
    scene = st.SpatialAssembly(apart, SMOOTH, "gap", gravity=G, links=(link,))
    for sign in (1.0, -1.0):
        response = st.simulate(scene, push(sign, 2.0, 1.0), st.DistinctElement3D())
        last = response.time > 2.0
        assert response.links.tension[last, 0].mean() == pytest.approx(sign * 1e3, rel=0.05)
        assert response.links.elongation[last, 0].mean() == pytest.approx(sign * 1.1e-3, rel=0.05)


def test_a_dowel_in_shear_holds_to_friction_and_capacity_in_any_direction() -> None:
    """a = μ g + V/m: 4 % below it holds behind its slack, 4 % above it slides off with the capacity on it."""
    slack, stiffness, friction, mass = 2e-4, 2e7, 0.3, 1000.0
    capacity = 0.2 * mass * G
    joint = st.Joint(1e9, 5e8, friction_coefficient=friction)
    dowel = block_link("dowel", ("slab", "pier"), shear_stiffness=stiffness, shear_capacity=capacity, clearance=slack)
    stones = box((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), "pier", fixed=True), box((1.0, 1.0, 0.5), (0.0, 0.0, 1.0), "slab")
    pier = st.SpatialAssembly(stones, joint, "pier and slab", gravity=G, links=(dowel,))
    limit = friction * G + capacity / mass
    below = st.simulate(pier, push(0.96 * limit, 2.0, 0.4), st.DistinctElement3D())
    above = st.simulate(pier, push(1.04 * limit, 0.4, 0.6), st.DistinctElement3D())
    slip = below.links.slip[:, 0]  # friction may go on holding what the swing behind the slack has brought it to bear
    assert slip[-1] == pytest.approx(slack + (0.96 * limit - friction * G) * mass / stiffness, rel=0.05)
    assert np.ptp(slip[-20:]) < 1e-5
    assert below.measures.links[0].peak_shear < capacity
    last = int(np.searchsorted(above.time, 1.0)) - 1  # afterwards nothing pushes any more
    slid = above.links.slip[:, 0]
    speed = (slid[last] - slid[last - 1]) / (above.time[last] - above.time[last - 1])
    assert speed == pytest.approx(0.04 * limit * 0.6, rel=0.1)
    assert above.links.shear[last, 0] == pytest.approx(capacity, rel=1e-9)


def test_a_pretension_is_there_when_all_has_settled_and_holds_the_heel_down() -> None:
    """m a H/2 = m g b + T (b + x), as of a column: 4 % below the box stays on its face, 4 % above it turns about its toe."""
    b, height, pull, x = 0.5, 2.0, 2e4, 0.55
    tie = block_link(
        "tie",
        ("ground", "box"),
        turned((-x, 0.0, 0.0)),
        turned((-x, 0.0, height)),
        axial_stiffness=1e5,
        pretension=pull,
    )
    stone = box((2.0 * b, 1.0, height), (0.0, 0.0, 0.0), "box")
    tied = st.SpatialAssembly((stone,), ROUGH, "tied", gravity=G, links=(tie,))
    mass = stone.mass
    expected = (mass * G * b + pull * (b + x)) / (mass * 0.5 * height)
    below, above = (
        st.simulate(tied, push(share * expected, 1.0, 0.4), st.DistinctElement3D()) for share in (0.96, 1.04)
    )
    assert below.links.tension[0, 0] == pytest.approx(pull, rel=1e-9)
    assert below.measures.blocks is not None
    assert below.measures.blocks.in_equilibrium
    assert below.measures.peak_rotation < 1e-3
    assert above.measures.peak_rotation > 5e-3


def test_a_bar_carries_a_box_under_a_ceiling() -> None:
    """Pulled down by its weight from a fixed box above, a bar lengthens by m g/K; a dowel lets it fall."""
    ceiling = box((1.0, 1.0, 0.5), (0.0, 0.0, 2.0), "ceiling", fixed=True)
    hung = box((1.0, 1.0, 0.5), (0.0, 0.0, 1.5), "hung")
    made = {"axial_stiffness": 1e6, "shear_stiffness": 1e6}
    bar = block_link("bar", ("hung", "ceiling"), **made)
    dowel = block_link("dowel", ("hung", "ceiling"), shear_stiffness=1e6, embedment=0.05)
    motion = st.Motion(0.01, np.zeros(51))
    for link, falls in ((bar, False), (dowel, True)):
        scene = st.SpatialAssembly((ceiling, hung), SMOOTH, "hung", gravity=G, settle=False, links=(link,))
        response = st.simulate(scene, motion, st.DistinctElement3D())
        way = response.body_position[0, 2, 2] - response.body_position[:, 2, 2]
        if falls:
            assert way[-1] == pytest.approx(0.5 * G * response.time[-1] ** 2, rel=0.01)
        else:
            assert way.max() == pytest.approx(2.0 * 1e3 * G / 1e6, rel=0.01)
            assert response.links.tension.max() == pytest.approx(2.0 * 1e3 * G, rel=0.01)


def limit(scene: st.SpatialAssembly, azimuth: float = 0.0):
    """Limit towards an azimuth from the scene's x [degrees]."""
    return st.limit_directions(scene, [math.degrees(AZIMUTH) + azimuth]).limits[0]


def test_the_limit_of_a_dowelled_slab_is_friction_and_capacity_over_weight() -> None:
    """λ = μ + V/W in any direction, to the 16 sides of what is cut for a circle: at most 2 % less; its dowel yields."""
    joint = st.Joint(1e9, 5e8, friction_coefficient=0.2)
    dowel = block_link("dowel", ("slab", "pier"), shear_stiffness=1e7, shear_capacity=2e3)
    stones = box((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), "pier", fixed=True), box((1.0, 1.0, 0.3), (0.0, 0.0, 1.0), "slab")
    scene = st.SpatialAssembly(stones, joint, "slab", gravity=G, links=(dowel,))
    exact = 0.2 + 2e3 / (stones[1].mass * G)
    for azimuth in (0.0, 13.0, 90.0):
        result = limit(scene, azimuth)
        assert 0.98 * exact < result.multiplier < 1.0001 * exact
        assert (result.mode, result.links[0].action, result.links[0].yields) == ("sliding", "shear", True)


def test_the_limit_of_a_tied_box_is_weight_and_tie_about_its_toe() -> None:
    """λ W h/2 = W b + T (b + x)."""
    b, height, most, x = 0.5, 2.0, 2e4, 0.55
    ends = turned((-x, 0.0, 0.0)), turned((-x, 0.0, height))
    tie = block_link("tie", ("ground", "box"), *ends, axial_stiffness=1e5, axial_capacity=most)
    stone = box((2.0 * b, 1.0, height), (0.0, 0.0, 0.0), "box")
    scene = st.SpatialAssembly((stone,), ROUGH, "tied", gravity=G, links=(tie,))
    weight = stone.mass * G
    assert limit(scene).multiplier == pytest.approx((weight * b + most * (b + x)) / (0.5 * weight * height), rel=1e-6)
    assert limit(scene, 180.0).multiplier == pytest.approx(b / (0.5 * height), rel=1e-6)
    assert limit(scene, 180.0).links[0].idle


@pytest.mark.parametrize("share", [0.5, 3.0], ids=["yielding", "as one block"])
def test_the_limit_of_a_clamped_pair_is_that_of_its_clamp_up_to_one_block(share) -> None:
    """λ = (b/h) (1 + V/W), V at most W: two boxes that do not rub on each other, a clamp across their joint."""
    b, h = 0.4, 2.0
    left, right = (
        box((b, 1.0, h), (sign * 0.5 * b, 0.0, 0.0), name, surface=ROUGH)
        for name, sign in (("left", -1.0), ("right", 1.0))
    )
    weight = left.mass * G
    ends = turned((-0.1, 0.0, 1.0)), turned((0.1, 0.0, 1.0))
    across = block_link(
        "clamp", ("left", "right"), *ends, axial_stiffness=0.0, shear_stiffness=2e8, shear_capacity=share * weight
    )
    pair = st.SpatialAssembly((left, right), ROUGH, "pair", G, overrides=(("left", "right", SMOOTH),), links=(across,))
    assert limit(pair).multiplier == pytest.approx(b / h * (1.0 + min(share, 1.0)), rel=1e-6)


def test_a_clamp_pulls_what_slides_and_holds_apart_what_is_pressed() -> None:
    """λ W = T_c in both senses, of a box without friction beside a wall, which it does not touch."""
    fixed_box, _ = side_by_side().stones
    free = box((1.0, 1.0, 0.5), (1.55, 0.0, 0.0), "free", surface=SMOOTH)
    ends = {"between": ("held", "free"), "at": turned((0.85, 0.0, 0.25)), "to": turned((1.2, 0.0, 0.25))}
    link = block_link("clamp", **ends, axial_stiffness=1e6, axial_capacity=2e3, shear_stiffness=0.0)
    scene = st.SpatialAssembly((fixed_box, free), SMOOTH, "pair", gravity=G, links=(link,))
    for azimuth, action in ((0.0, "closing"), (180.0, "apart")):
        result = limit(scene, azimuth)
        assert result.multiplier == pytest.approx(2e3 / (free.mass * G), rel=1e-6)
        assert [link.action for link in result.links if link.yields] == [action]


def test_the_limit_of_a_box_that_hangs_tells_what_its_bar_must_hold() -> None:
    """λ W = V, and T = W (1 + λ (h/2)/b): without the bar nothing stands, and what is pressed is the rim of the joint."""
    ceiling = box((1.0, 1.0, 0.5), (0.0, 0.0, 2.0), "ceiling", fixed=True)
    hung = box((1.0, 1.0, 0.5), (0.0, 0.0, 1.5), "hung")
    weight = hung.mass * G
    made = {
        "axial_stiffness": 1e7,
        "shear_stiffness": 1e7,
        "axial_capacity": 3.0 * weight,
        "shear_capacity": 0.5 * weight,
    }
    bar = block_link("bar", ("hung", "ceiling"), **made)
    result = limit(st.SpatialAssembly((ceiling, hung), SMOOTH, "hung", gravity=G, links=(bar,)))
    assert result.multiplier == pytest.approx(0.5, rel=0.02)
    shear, closing = result.links
    assert shear.yields
    assert not closing.idle
    assert closing.force == pytest.approx(weight * (1.0 + result.multiplier * 0.25 / 0.5), rel=5e-3)
