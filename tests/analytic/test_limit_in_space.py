"""Limit analysis of assemblies in space against closed forms: overturning, sliding, frames, arches, overhangs."""

import dataclasses
import math

import numpy as np
import pytest

import stylobate as st
from stylobate.statics import limit
from stylobate.statics.contacts import ContactProgramme, gentlest
from stylobate.statics.limit import AssemblyProgramme

LAW = st.Joint(5e9, 2.5e9, friction_coefficient=0.7)
CORNERS = ((-1.2, -1.2), (1.2, -1.2), (1.2, 1.2), (-1.2, 1.2))

#: Closed forms in a programme of polygons: rounding of the solver; of a disc cut into 48 corners 1 − cos 3.75° at most.
ROUNDING, DISC = 1e-6, 2.2e-3


def box(sides, at, name, **others):
    return st.Stone.box(sides, at, 2700.0, name=name, **others)


def column(x, y, name, kind="box", at=0.0, height=4.0):
    if kind == "box":
        return box((0.8, 0.8, height), (x, y, at), name)
    return st.Stone.drum(0.8, 0.8, height, (x, y, at), 2700.0, name=name)


def limits(stones, azimuths, joint=LAW, **others):
    analysis = st.limit_directions(st.SpatialAssembly(stones, joint, **others), azimuths)
    return analysis.limits


def portal(kind="box"):
    return [column(-1.2, 0, "left", kind), column(1.2, 0, "right", kind), box((3.2, 0.8, 0.6), (0, 0, 4), "beam")]


def podium(kind):
    stones = [column(x, y, f"c{i}", kind) for i, (x, y) in enumerate(CORNERS)]
    return [*stones, box((3.4, 3.4, 0.3), (0, 0, 4), "slab")]


@pytest.mark.parametrize("stones", [[column(0, 0, "one")], podium("box")], ids=["block", "podium"])
def test_square_blocks_overturn_at_width_over_height_over_the_larger_cosine(stones):
    """(b/h)/max(|cos|, |sin|): 0.2, 0.2309 and 0.2828; four under a slab that translates alike, whatever it weighs."""
    azimuths = [0.0, 30.0, 45.0, 120.0]
    for direction_limit, azimuth in zip(limits(stones, azimuths), azimuths, strict=True):
        angle = math.radians(azimuth)
        expected = 0.2 / max(abs(math.cos(angle)), abs(math.sin(angle)))
        assert direction_limit.multiplier == pytest.approx(expected, rel=ROUNDING)
        assert (direction_limit.mode, direction_limit.upper_bound) == ("rocking", False)
        assert set(direction_limit.moving) == {stone.name for stone in stones}


@pytest.mark.parametrize("stones", [[column(0, 0, "one", "drum")], podium("drum")], ids=["drum", "podium"])
def test_round_columns_overturn_alike_in_every_direction(stones):
    for direction_limit in limits(stones, [0.0, 30.0, 50.0]):
        assert direction_limit.multiplier == pytest.approx(0.2, rel=DISC)
        assert not direction_limit.upper_bound


def test_a_drum_falls_towards_the_push():
    """Its centroid goes along the push in the mechanism, to half a side of the 48 that its rim has."""
    programme = AssemblyProgramme(st.SpatialAssembly([column(0, 0, "one", "drum")], LAW))
    angle = math.radians(30.0)
    live = programme.programme.body_force(np.array([math.cos(angle), math.sin(angle), 0.0]))
    solution = programme.programme.converged(programme.dead, live, programme.programme.capacities)
    x, y = gentlest(programme.programme, programme.dead, live, solution)[0, :2]
    assert math.degrees(math.atan2(y, x)) == pytest.approx(30.0, abs=3.76)


def test_a_portal_rocks_along_its_beam_and_overturns_as_one_across():
    """b/h along (Makris and Vassiliou 2013); across half the width over the height of the centroid of all, 0.15805."""
    masses, heights = np.array([2.56, 2.56, 1.536]), np.array([2.0, 2.0, 4.3])
    along, across = limits(portal(), [0.0, 90.0])
    assert along.multiplier == pytest.approx(0.2, rel=ROUNDING)
    assert across.multiplier == pytest.approx(0.4 * masses.sum() / (masses @ heights), rel=ROUNDING)
    assert across.multiplier == pytest.approx(0.15805471, abs=1e-8)


def test_round_columns_pushed_askew_are_an_upper_bound():
    """Joints of a round portal twist at 60 degrees, not along it; cut into polygons it bears 0.1 % less than by growing."""
    along, askew = limits(portal("drum"), [0.0, 60.0])
    assert not along.upper_bound
    assert askew.upper_bound
    assert askew.multiplier < along.multiplier
    known = AssemblyProgramme(st.SpatialAssembly(portal("drum"), LAW))
    cut = known.programme
    exact = ContactProgramme(np.array([2.0, 2.0, 1.0]), cut.centroids, 9.81, cut.rims, (), cut.length)
    exact.shares, exact.weight = cut.shares, cut.weight
    push = np.array([0.5, math.sqrt(0.75), 0.0])
    exact.begin(push)
    grown = exact.converged(known.dead, exact.body_force(push), exact.capacities).multiplier
    assert askew.multiplier < grown < 1.005 * askew.multiplier


def test_a_wall_pushed_across_overturns_at_thickness_over_height():
    """t/h 0.125, whatever its bond."""
    stones = []
    for course in range(4):
        for k, (x, long) in enumerate([(0.15, 0.3), (0.6, 0.6)] if course % 2 else [(0.3, 0.6), (0.75, 0.3)]):
            stones.append(box((long, 0.15, 0.3), (x, 0.0, 0.3 * course), f"{course}.{k}"))
    (direction_limit,) = limits(stones, [90.0])
    assert direction_limit.multiplier == pytest.approx(0.125, rel=ROUNDING)


@pytest.mark.parametrize(("azimuth", "share"), [(0.0, 1.0), (22.5, 1.0), (11.25, math.cos(math.pi / 16.0))])
def test_a_flat_block_slides_at_its_friction(azimuth, share):
    """μ along the sixteen sides of the cone, between them less by cos(π/16) at most; with cohesion c A/W more."""
    stones = [box((2.0, 2.0, 0.4), (0, 0, 0), "slab")]
    (direction_limit,) = limits(stones, [azimuth], st.Joint(5e9, 2.5e9, friction_coefficient=0.3))
    assert direction_limit.multiplier == pytest.approx(0.3 * share, rel=ROUNDING)
    assert (direction_limit.mode, direction_limit.upper_bound) == ("sliding", True)
    (glued,) = limits(stones, [0.0], st.Joint(5e9, 2.5e9, friction_coefficient=0.3, cohesion=1e3))
    assert glued.multiplier == pytest.approx(0.3 + 1e3 * 4.0 / (2700.0 * 1.6 * st.g), rel=1e-5)


def slabs(share, diagonal):
    """Five slabs on a fixed edge, each shifted by a share of L/(2k), k from the top."""
    stones, place = [box((1, 1, 0.2), (0, 0, 0), "edge", fixed=True)], 0.0
    for i, k in enumerate(range(5, 0, -1), 1):
        place += share / (2.0 * k)
        stones.append(box((1, 1, 0.2), (place, place if diagonal else 0.0, 0.2 * i), f"slab {i}"))
    return st.SpatialAssembly(stones, LAW)


@pytest.mark.parametrize("diagonal", [False, True], ids=["along", "diagonal"])
def test_slabs_overhang_by_the_harmonic_series(diagonal):
    AssemblyProgramme(slabs(0.999, diagonal))
    with pytest.raises(st.InputError, match=r"does not stand under its own weight: slab 1.* begin to move; correct"):
        AssemblyProgramme(slabs(1.001, diagonal))


def arch(share, stones=31, radius=3.0):
    """A semicircular arch of voussoirs, a share of its radius thick."""
    voussoirs = []
    for k in range(stones):
        corners = [
            (q * math.cos(a), y, q * math.sin(a))
            for q in (radius * (1.0 - 0.5 * share), radius * (1.0 + 0.5 * share))
            for a in (math.pi * k / stones, math.pi * (k + 1) / stones)
            for y in (-0.4, 0.4)
        ]
        voussoirs.append(st.Stone.hull(corners, 2700.0, name=f"stone {k + 1}"))
    return voussoirs


def test_an_arch_stands_from_milankovitchs_thickness_on():
    """0.1075 of its radius for very many stones (Milankovitch 1907); a few per cent of it with 31."""
    AssemblyProgramme(st.SpatialAssembly(arch(0.1075 * 1.02), LAW))
    with pytest.raises(st.InputError, match="'assembly' does not stand under its own weight"):
        AssemblyProgramme(st.SpatialAssembly(arch(0.1075 * 0.98), LAW))


def test_an_arch_pushed_across_overturns_as_one_body():
    """Half its width over the height of its centroid; voussoirs are trapezia between chords, so that it is their own."""
    stones = arch(0.2, stones=15)
    masses, heights = np.array([stone.mass for stone in stones]), np.array([stone.position[2] for stone in stones])
    (direction_limit,) = limits(stones, [90.0])
    assert direction_limit.multiplier == pytest.approx(0.4 * masses.sum() / (masses @ heights), rel=ROUNDING)


def test_a_wall_held_at_its_top_is_pushed_out_at_mid_height():
    """F/W = 2 t/h of two halves that hinge (closed form); a load over the height does half the work of one in its middle."""
    thick, high, wide, stop = 0.11, 1.5, 0.95, 1e-4
    stones = [
        st.Stone.box((thick, wide, 0.5 * high), (0, 0, 0), 1800.0, name="lower"),
        st.Stone.box((thick, wide, 0.5 * high), (0, 0, 0.5 * high), 1800.0, name="upper"),
        st.Stone.box((0.2, wide, stop), (0.5 * thick + 0.1, 0, high - stop), name="stop", fixed=True),
    ]
    smooth = ("upper", "stop", st.Joint(5e9, 2.5e9, friction_coefficient=0.0))
    (direction_limit,) = limits(stones, [0.0], overrides=[smooth])
    assert 0.5 * direction_limit.multiplier == pytest.approx(2.0 * thick / high, rel=2e-4)  # stop/high of it


def test_the_numbers_of_bodies_and_the_direction_of_the_scene_change_nothing():
    """A portal renumbered, and turned by 90 degrees with its push: the last bits may differ, the multiplier not."""
    stones = portal("drum")
    (level,) = limits(stones, [35.0])
    (other,) = limits(stones[::-1], [35.0])
    turn = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
    turned = [column(0, -1.2, "left", "drum"), column(0, 1.2, "right", "drum")]
    (across,) = limits([*turned, box((3.2, 0.8, 0.6), (0, 0, 4), "beam", orientation=turn)], [125.0])
    assert other.multiplier == pytest.approx(level.multiplier, rel=1e-5)
    assert across.multiplier == pytest.approx(level.multiplier, rel=1e-5)
    assert set(other.moving) == set(across.moving) == set(level.moving)


@pytest.mark.parametrize(
    ("stones", "joint", "says"),
    [
        ([box((1, 1, 1), (0, 0, 0), "a"), box((1, 1, 1), (0.7, 0, 1), "b")], LAW,
         "'assembly' does not stand under its own weight: b begins to move; correct its geometry or its friction"),
        ([st.Stone.drum(0.8, 0.8, 1.0, (0, 0, -0.1), 2700.0, name="lying",
                        orientation=(math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0))], LAW,
         "block 'lying' rests on no face, only on edges or corners; limit analysis takes what lies on faces"),
        ([box((1, 1, 1), (0, 0, 0), "a"), box((1, 1, 1), (1, 0, 0), "b", fixed=True)], LAW, None),
    ],
)  # fmt: skip
def test_what_has_no_multiplier_is_said(stones, joint, says):
    if says is None:
        with pytest.raises(st.InputError, match="'assembly' bears any push in this direction: fixed bodies hold it"):
            limits([*stones, box((1, 1, 1), (2, 0, 0), "c", fixed=True)], [0.0], joint)
        return
    with pytest.raises(st.InputError, match=says):
        limits(stones, [0.0], joint)


def test_what_would_take_too_long_or_has_no_weight_is_refused(monkeypatch):
    monkeypatch.setattr(limit, "MOST_JOINTS", 3)
    with pytest.raises(st.InputError, match=r"has 4 joints, .* about 6 minutes a direction; allowed are up to 3"):
        limits(portal(), [0.0])
    with pytest.raises(st.InputError, match="'assembly' has no gravity"):
        limits([column(0, 0, "one")], [0.0], gravity=0.0)


def trapezium(level, top, low=1.0, high=0.7, name="block"):
    return st.Block(((-0.5 * low, level), (0.5 * low, level), (0.5 * high, top), (-0.5 * high, top)), 2500.0, name)


def test_polygons_of_the_plane_overturn_about_their_corners():
    """A trapezium b wide below and t above: half of the base over the height of its centroid, h (b + 2 t) / 3 (b + t)."""
    multiplier = 1.5 * 1.0 * 1.7 / (3.0 * 2.4)
    for blocks in (
        (trapezium(0.0, 3.0),),
        tuple(trapezium(i, i + 1.0, 1.0 - 0.1 * i, 0.9 - 0.1 * i, f"block {i}") for i in range(3)),
    ):
        analysis = st.limit_directions(st.Assembly(blocks, LAW))
        assert analysis.azimuths.tolist() == [0.0, 180.0]
        np.testing.assert_allclose(analysis.multipliers, multiplier, rtol=1e-7)


def test_what_is_no_prism_of_the_plane_and_limit_analysis_in_the_plane_are_refused():
    round_one = dataclasses.replace(trapezium(0.0, 3.0), solid=(1e3, 1e3, 0.0, 1.4))
    with pytest.raises(st.InputError, match="is no prism of its outline"):
        st.limit_directions(st.Assembly((round_one,), LAW))
    with pytest.raises(st.InputError, match="is an assembly in space; use limit_directions"):
        st.limit_analysis(st.SpatialAssembly(portal(), LAW))


def test_names_in_a_sentence():
    names = ["column 1, drum 1", "column 1, drum 2", "beam", "column 2, drum 1"]
    assert limit.listed(names) == "column 1 (2 drums), beam and column 2, drum 1"
    assert limit.listed([f"v{i}" for i in range(9)]) == "v0, v1, v2, v3 and 5 more"
    assert limit.listed(["v0"]) == "v0"
