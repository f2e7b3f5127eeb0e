"""Limit analysis and pushover with dowels, bars, ties and cores: multipliers by hand."""

import json
import math

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.files import write_column
from stylobate.statics.contacts import ContactProgramme
from stylobate.statics.limit import SpaceProgramme, limit_analysis, limit_directions, limit_in_space, weakest_direction
from stylobate.statics.pushover import pushover

ROUGH = st.Joint(5e10, 2.5e10, friction_coefficient=0.7)
SMOOTH = st.Joint(5e10, 2.5e10, friction_coefficient=0.1)
BLOCK = st.Column.of_drums([st.Drum(4.0, 1.0, 1.0, 2500.0)], ROUGH, name="block")
WEIGHT = BLOCK.mass * BLOCK.gravity


def with_links(column, *links):
    return column.replace(links=links)


@pytest.mark.parametrize("slack", [0.0, 0.002])
def test_a_dowelled_block_slides_at_friction_and_capacity_after_its_slack(slack):
    dowel = st.Dowel(joint=1, shear_stiffness=1e8, shear_capacity=5e3, clearance=slack)
    column = with_links(st.Column.of_drums(BLOCK.drums, SMOOTH), dowel)
    expected = 0.1 + 5e3 / WEIGHT
    result = limit_analysis(column)
    assert (result.lower, result.upper) == pytest.approx((expected, expected), rel=1e-9)
    assert [(link.force, link.yields) for link in result.links] == [(pytest.approx(5e3), True)]
    path = pushover(column, to=0.01)
    assert path.collapse_multiplier == pytest.approx(expected, rel=1e-6)
    # before the slack is used up friction holds alone
    within = (path.slip[:, 0] > 0.0) & (path.displacement < 0.9 * slack)
    assert np.allclose(path.multiplier[within], 0.1, rtol=1e-6)
    assert within.any() == (slack > 0.0)


@pytest.mark.parametrize(("at", "arm"), [((-0.55, 0.0), 1.05), ((0.55, 0.0), None)])
def test_a_tied_block_overturns_by_hand(at, arm):
    tie = st.Tie(at=at, axial_stiffness=1e8, axial_capacity=3e4, to_height=4.0)
    column = with_links(BLOCK, tie)
    # W b + T (b + x) about the right corner; a tie on the side towards which it turns goes slack
    expected = (WEIGHT * 0.5 + (3e4 * arm if arm else 0.0)) / (WEIGHT * 2.0)
    result = limit_analysis(column)
    assert result.multiplier == pytest.approx(expected, rel=1e-9)
    assert result.links[0].yields is bool(arm)
    path = pushover(column)
    assert path.collapse_multiplier == pytest.approx(expected, rel=2e-3)
    assert path.link_force[path.peak, 0] == pytest.approx(3e4 if arm else 0.0, abs=1.0)
    # pushed to the other side the two change places
    other = limit_analysis(column, direction=180.0)
    mirrored = limit_analysis(with_links(BLOCK, st.Tie(at=(-at[0], 0.0), axial_stiffness=1e8, axial_capacity=3e4)))
    assert other.multiplier == pytest.approx(mirrored.multiplier, rel=1e-9)


def test_an_elastic_tie_by_hand():
    # turned by θ about its right corner (rigid joint): λ W z = W (b c − z s) + T (2 b c …): first order in T = k 2 b θ
    tie = st.Tie(at=(-0.5, 0.0), axial_stiffness=1e6, to_height=4.0)
    path = pushover(with_links(BLOCK, tie), to=0.2)
    turn = -path.rotation[-1, 0]
    c, s = math.cos(turn), math.sin(turn)
    # corner at the origin: tie from (−1, 0) to R(−θ)(−1, 4) = (−c + 4 s, s + 4 c)
    end = np.array([-c + 4.0 * s, s + 4.0 * c])
    line = end - (-1.0, 0.0)
    length = float(np.hypot(*line))
    pull = 1e6 * (length - 4.0)
    # moment of the tie about the corner, against the push λ W at the centroid R(−θ)(−0.5, 2)
    moment = pull * abs(float(line[0] * end[1] - line[1] * end[0])) / length
    expected = (WEIGHT * (0.5 * c - 2.0 * s) + moment) / (WEIGHT * (0.5 * s + 2.0 * c))
    assert path.multiplier[-1] == pytest.approx(expected, rel=2e-3)
    assert path.link_force[-1, 0] == pytest.approx(pull, rel=2e-3)


def test_a_core_and_a_bar_hold_at_their_capacity_in_the_joint_that_gives_way():
    column = st.preset("paper-12-drums")
    weight = column.joint_weights[0]
    core = with_links(column, st.Core(axial_stiffness=1e8, axial_capacity=5e4, pretension=2e4))
    half, z = 0.5 * column.base_width, column.centroid_height
    expected = (weight * half + 5e4 * half) / (weight * z)
    result = limit_analysis(core)
    assert result.multiplier == pytest.approx(expected, rel=1e-9)  # pretension makes no difference to a plastic core
    # a bar in the base alone moves the hinge up to the next joint that is weaker
    barred = with_links(column, st.Bar(joint=1, shear_stiffness=1e9, axial_stiffness=1e9, axial_capacity=1e6))
    assert limit_analysis(barred).governing_joint == 2
    assert limit_analysis(barred).multiplier == pytest.approx(column.joint_uplift_accelerations[1] / column.gravity)


DOWEL = {"joint": 1, "shear_stiffness": 1e8}
#: Weight times what friction of 0.1 lacks of the rocking multiplier of the block, 1/4.
MISSING = 0.15 * WEIGHT


@pytest.mark.parametrize(
    ("joint", "capacities", "least", "yields", "idle"),
    [
        (ROUGH, [5.5e3], [0.0], [False], [True]),  # friction alone carries until it rocks
        (SMOOTH, [5.5e3], [5.5e3], [True], [False]),  # it slides
        (SMOOTH, [2e4], [MISSING], [False], [False]),  # it rocks while the dowel holds what friction does not
        (SMOOTH, [1e4, 1e4], [MISSING - 1e4] * 2, [False] * 2, [False] * 2),
        (SMOOTH, [2e4, 2e4], [0.0] * 2, [False] * 2, [False] * 2),  # one of the two is needed, no matter which
    ],
)
def test_what_a_dowel_must_hold_by_hand(joint, capacities, least, yields, idle):
    """Of a face of answers the least force, in the plane, in its mirror and in space; 1e-5: ten times what (L4) leaves."""
    places = [(-0.1, 0.0), (0.1, 0.0)]  # in a line with the push: nothing twists
    dowels = [
        st.Dowel(at=at, shear_capacity=capacity, **DOWEL) for at, capacity in zip(places, capacities, strict=False)
    ]
    column = with_links(st.Column.of_drums(BLOCK.drums, joint), *dowels)
    for result in (limit_analysis(column), limit_analysis(column, direction=180.0), limit_in_space(column, 0.0)):
        assert [abs(link.force) for link in result.links] == pytest.approx(least, rel=1e-5, abs=1e-9)
        assert [link.yields for link in result.links] == yields
        assert [link.idle for link in result.links] == idle


@pytest.mark.parametrize(
    ("joint", "capacities", "largest"),
    [
        (ROUGH, [5.5e3], [5.5e3]),  # friction carries alone, and may as well leave all the capacity to the dowel
        (ROUGH, [1e6], [0.95 * WEIGHT]),  # friction the other way adds to the push: (1/4 + 0.7) W
        (SMOOTH, [2e4], [2e4]),
        (SMOOTH, [1e6], [0.35 * WEIGHT]),  # (1/4 + 0.1) W
        (SMOOTH, [1e6, 1e4], [0.35 * WEIGHT + 1e4, 1e4]),  # and the other dowel holds the other way
    ],
)
def test_the_most_that_a_dowel_may_hold_by_hand(joint, capacities, largest):
    """Largest force at the multiplier, rocking at 1/4: push, friction and the other dowel against it; 1e-6 beside 1e-9."""
    dowels = [st.Dowel(shear_capacity=capacity, **DOWEL) for capacity in capacities]
    column = with_links(st.Column.of_drums(BLOCK.drums, joint), *dowels)
    for direction in (0.0, 180.0):
        result = limit_analysis(column, direction=direction)
        assert result.multiplier == pytest.approx(0.25, rel=1e-9)
        assert [link.largest for link in result.links] == pytest.approx(largest, rel=1e-6)
        assert all(abs(link.force) <= link.largest and not link.yields for link in result.links)


def test_a_column_that_friction_carries_is_not_said_to_use_its_dowels(tmp_path, capsys):
    """Twelve drums that overturn about the base: no dowel need act, in the plane and round in space."""
    column = st.preset("paper-12-drums")
    column = with_links(column, *(st.Dowel(joint=j, shear_stiffness=1e8, shear_capacity=5488.0) for j in range(2, 13)))
    assert all(link.idle and not link.yields and link.force == 0.0 for link in limit_analysis(column).links)
    file = write_column(column, tmp_path / "dowelled.toml")
    assert call(["limit", str(file)]) == 0
    output = capsys.readouterr().out
    assert output.count("need not act (capacity 5488 N)") == 11
    # what a joint can take back from a dowel is the push on what lies above, and friction the other way
    result = limit_analysis(column)
    load = (result.multiplier + np.array(column.friction)) * np.array(column.joint_weights)
    assert [link.largest for link in result.links] == pytest.approx(np.minimum(load[1:], 5488.0), rel=1e-6)
    assert output.count("other answers have up to 5488 N") == 10
    assert "yields" not in output


def test_a_bar_is_told_by_what_it_does(tmp_path, capsys):
    """Pushed to the right the bar in the axis holds W b + T b with b half the width; its shear is left to friction."""
    bar = st.Bar(joint=1, shear_stiffness=1e8, shear_capacity=1e4, axial_stiffness=1e8, axial_capacity=2e4)
    column = with_links(BLOCK, bar)
    assert limit_analysis(column).multiplier == pytest.approx((WEIGHT + 2e4) * 0.5 / (WEIGHT * 2.0), rel=1e-9)
    assert call(["limit", str(write_column(column, tmp_path / "bar.toml"))]) == 0
    output = capsys.readouterr().out
    assert "bar in joint 1, shear" in output
    assert "need not act (capacity 1e+04 N)" in output
    assert "2e+04 N of 2e+04 N, yields" in output


def test_a_layer_lowers_the_friction_and_a_spring_without_capacity_is_no_strength():
    layer = st.Layer(joint=1, friction_coefficient=0.08, shear_stiffness=1e5)
    assert limit_analysis(with_links(BLOCK, layer)).multiplier == pytest.approx(0.08, rel=1e-9)
    strong_layer = st.Layer(joint=1, friction_coefficient=0.08, shear_stiffness=1e5, shear_capacity=4e3)
    assert limit_analysis(with_links(BLOCK, strong_layer)).multiplier == pytest.approx(0.08 + 4e3 / WEIGHT, rel=1e-9)


def test_a_brittle_dowel_is_gone_after_its_capacity():
    dowel = st.Dowel(joint=1, shear_stiffness=1e8, shear_capacity=5e3, failure="brittle")
    path = pushover(with_links(st.Column.of_drums(BLOCK.drums, SMOOTH), dowel), to=0.01)
    assert path.largest_multiplier == pytest.approx(0.1 + 5e3 / WEIGHT, rel=1e-2)


def test_what_bears_any_push_is_refused_in_one_sentence(tmp_path, capsys):
    endless = with_links(BLOCK.with_joint(cohesion=1e6), st.Core(axial_stiffness=1e8))
    with pytest.raises(st.InputError, match="bears any push, because core from the base to drum 1 has no capacity"):
        limit_analysis(endless)
    tied = with_links(BLOCK, st.Tie(at=(-0.55, 0.0), axial_stiffness=1e8, axial_capacity=3e4))
    file = write_column(tied, tmp_path / "tied.toml")
    assert call(["limit", str(file), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["links"][0]["yields"] is True
    with pytest.raises(st.InputError, match="bears any push, because core from the base to drum 1 has no capacity"):
        limit_in_space(endless, 20.0)


@pytest.mark.parametrize("section", ["rectangular", "circular"])
def test_plane_and_space_are_the_same_along_x_with_links(section):
    """Three drums with a tie on one side, a core and dowels: both programmes, to rounding, on either side."""
    stack = st.Column.tapered(
        height=4.5, bottom_width=0.9, top_width=0.7, drums=3, density=2500.0, joint=ROUGH, section=section
    )
    dowels = [st.Dowel(joint=j, shear_stiffness=1e8, shear_capacity=4e3) for j in (2, 3)]
    ties = [st.Tie(at=(-0.55, 0.0), to_drum=2, axial_stiffness=1e8, axial_capacity=2e4)]
    column = with_links(stack, *dowels, *ties, st.Core(axial_stiffness=1e8, axial_capacity=1e4))
    for direction in (0.0, 180.0):
        plane = limit_analysis(column, direction=direction)
        space = limit_in_space(column, direction)
        assert space.multiplier == pytest.approx(plane.multiplier, rel=1e-6)
        assert (space.joint, space.mode) == (plane.governing_joint, "rocking")
        forces = {link.name: link.force for link in space.links if link.action == "line"}
        assert forces == pytest.approx(
            {link.name: link.force for link in plane.links if link.action == "line"}, rel=1e-4
        )


def test_a_round_block_tied_on_two_sides_by_hand():
    """Towards a tie the other one yields, at R + x from the edge; across both of them yield, each at R from it."""
    radius, pull, x = 0.5, 3e4, 0.55
    drum = st.Drum(4.0, 2 * radius, 2 * radius, 2500.0, "circular")
    ties = [
        st.Tie(at=(x * math.cos(a), x * math.sin(a)), axial_stiffness=1e8, axial_capacity=pull, to_height=4.0)
        for a in (math.radians(20.0), math.radians(200.0))
    ]
    column = with_links(st.Column.of_drums([drum], ROUGH), *ties)
    weight = column.mass * column.gravity
    towards = (weight * radius + pull * (radius + x)) / (weight * 2.0)
    across = (weight + 2.0 * pull) * radius / (weight * 2.0)
    result = limit_directions(column, [20.0, 200.0, 110.0, 290.0])
    assert result.multipliers[:4] == pytest.approx([towards, towards, across, across], rel=1e-6)
    assert [link.yields for link in result.limits[0].links] == [False, True]
    assert [link.yields for link in result.limits[2].links] == [True, True]
    # one tie: away from it as without it
    single = limit_directions(with_links(column, ties[0]), [20.0, 200.0])
    assert single.multipliers == pytest.approx([radius / 2.0, towards], rel=1e-6)


def test_the_weakest_direction_is_found_without_all_the_others(monkeypatch):
    """A dowel in joint 2 holds nothing of what joint 1 does: the direction that is weakest without it tells."""
    joint = st.Joint(5e10, 2.5e10, friction_coefficient=0.7)
    found_drums = (
        st.FoundDrum(1, chip_right=0.1, chip_azimuth=30.0),
        st.FoundDrum(2, offset=0.04, offset_azimuth=120.0),
    )
    drums = [st.Drum(1.0, 0.9, 0.8, 2500.0, "circular"), st.Drum(1.0, 0.8, 0.7, 2500.0, "circular")]
    column = st.Column.of_drums(drums, joint).replace(as_found=st.AsFound(drums=found_drums))
    solve, solved = SpaceProgramme.solve, []

    def counted(self, azimuth, largest=False):
        solved.append((azimuth, largest))
        return solve(self, azimuth, largest)

    linked = with_links(column, st.Dowel(joint=2, shear_stiffness=1e8, shear_capacity=5e3))
    with monkeypatch.context() as within:
        within.setattr(SpaceProgramme, "solve", counted)
        weak = weakest_direction(linked)
    assert 1 <= len(solved) <= 2
    assert not any(largest for _, largest in solved)
    around = [(weak.azimuth + turn) % 360.0 for turn in (0.0, 15.0, 90.0, 180.0, 345.0)]
    every = limit_directions(linked, around)
    # the tolerance of the programme; a column that is alike in two directions is weakest in either
    assert weak.multiplier == pytest.approx(every.weakest.multiplier, rel=2e-6)
    assert (weak.joint, weak.mode) == (every.weakest.joint, every.weakest.mode)


@pytest.mark.parametrize("links", [(), (st.Core(axial_stiffness=1.0, axial_capacity=1e-6),)])
def test_the_weakest_of_all_directions_lies_between_those_looked_at(links):
    """A round block on a base that rises by τ towards 37°: tan(α − τ) towards 217°; of a grid of 15 degrees 0.03 % more."""
    drum = st.Drum(2.0, 1.0, 1.0, 2500.0, "circular")
    column = st.Column.of_drums([drum], ROUGH).replace(as_found=st.AsFound((), 3.0, 37.0), links=links)
    exact = math.tan(math.atan(0.5) - math.radians(3.0))
    result = limit_directions(column)
    assert result.all_round
    assert result.weakest.multiplier == pytest.approx(exact, rel=1e-5)
    assert result.weakest.azimuth == pytest.approx(217.0, abs=0.5)
    assert result.multipliers[:24].min() > exact * (1.0 + 2e-4)
    assert weakest_direction(column).multiplier == pytest.approx(exact, rel=1e-5)
    given = limit_directions(column, [200.0, 230.0])  # less than half way round: these two only
    assert (len(given.limits), given.all_round) == (2, False)


def test_what_links_hold_at_most_takes_few_small_programmes(monkeypatch):
    """What was added in other directions and for other links is not solved along; each direction begins anew."""
    drums = [st.Drum(1.0, 1.0, 1.0, 2500.0, "circular")] * 3
    column = st.Column.of_drums(drums, ROUGH).replace(as_found=st.AsFound((), 1.0, 37.0))
    sizes, solve = [], ContactProgramme._solve

    def counted(self, *rest):
        sizes.append(len(self.owner))
        return solve(self, *rest)

    monkeypatch.setattr(ContactProgramme, "_solve", counted)
    dowels = [st.Dowel(joint=k, shear_stiffness=1e8, shear_capacity=1e6) for k in (1, 2, 3)]
    limit_directions(with_links(column, *dowels), [0.0, 40.0, 90.0, 130.0, 170.0])
    assert max(sizes) < 600
    assert len(sizes) < 700


def test_a_dowelled_block_slides_in_any_direction_at_friction_and_capacity():
    drum = st.Drum(4.0, 1.0, 1.0, 2500.0, "circular")
    slippery = st.Column.of_drums([drum], SMOOTH)
    weight, azimuths = slippery.mass * slippery.gravity, [0.0, 33.0, 121.0, 250.0]

    def dowels(*places):
        return with_links(
            slippery, *(st.Dowel(joint=1, at=(x, 0.0), shear_stiffness=1e8, shear_capacity=5e3) for x in places)
        )

    for places in ((0.0,), (-0.2, 0.2)):
        result = limit_directions(dowels(*places), azimuths)
        assert result.multipliers == pytest.approx(0.1 + len(places) * 5e3 / weight, rel=1e-6)
        assert {limit.mode for limit in result.limits} == {"sliding"}
    # one beside the middle twists the block where the push passes it by: along its own line it does not
    beside = limit_directions(dowels(0.3), [0.0, 90.0]).multipliers
    assert beside[0] == pytest.approx(0.1 + 5e3 / weight, rel=1e-6)
    assert 0.1 < beside[1] < 0.97 * beside[0]


def test_cohesion_and_what_is_found_stand_in_both_ways_of_limit_analysis_in_space():
    """A core that is too weak to matter makes the programme answer for what statics alone answers without it.

    To 1e-4: the programme puts cohesion where the weight acts, statics where the pressure does.
    """
    joint = st.Joint(5e10, 2.5e10, friction_coefficient=0.2, cohesion=5e3)
    found_drums = (st.FoundDrum(1, tilt=-0.6, tilt_azimuth=20.0), st.FoundDrum(2, offset=0.05, offset_azimuth=80.0))
    for section in ("circular", "rectangular"):
        drums = [st.Drum(1.0, 0.9, 0.8, 2500.0, section), st.Drum(1.0, 0.8, 0.7, 2500.0, section)]
        column = st.Column.of_drums(drums, joint).replace(as_found=st.AsFound(found_drums, 0.5, 130.0))
        idle = st.Core(axial_stiffness=1.0, axial_capacity=1e-6)
        for azimuth in (30.0, 200.0):
            bare = limit_in_space(column, azimuth)
            assert limit_in_space(with_links(column, idle), azimuth).multiplier == pytest.approx(
                bare.multiplier, rel=1e-4
            )


@pytest.mark.parametrize(
    ("joint", "capacities", "share", "azimuth"),
    [
        (ROUGH, [5.5e3], 0.0, 0.0),
        (ROUGH, [1e6], 0.95, 0.0),
        (SMOOTH, [1e6], 0.35, 90.0),
        (SMOOTH, [1e6, 1e4], 0.35, 0.0),
    ],
)
def test_the_most_that_a_dowel_may_hold_in_space(joint, capacities, share, azimuth):
    """As in the plane, by hand: push and friction against it, (1/4 + μ) W, and the other dowel; it holds against the push.

    It is looked for to 1e-3.
    """
    drum = st.Drum(4.0, 1.0, 1.0, 2500.0, "rectangular", 1.0)
    dowels = [st.Dowel(shear_capacity=capacity, **DOWEL) for capacity in capacities]
    (limit,) = limit_directions(with_links(st.Column.of_drums([drum], joint), *dowels), [azimuth]).limits
    assert limit.multiplier == pytest.approx(0.25, rel=1e-6)
    most = min(share * WEIGHT + sum(capacities[1:]), capacities[0]) if share else capacities[0]
    assert limit.links[0].largest == pytest.approx(most, rel=2e-3)
    if share:
        push = math.cos(math.radians(azimuth)), math.sin(math.radians(azimuth))
        assert np.dot(limit.links[0].towards[:2], push) == pytest.approx(-1.0, abs=1e-3)
    assert [link.largest for link in limit.links[1:]] == pytest.approx(capacities[1:], rel=2e-3)


def test_the_most_that_a_tie_in_space_may_hold():
    """At its capacity it pulls down along itself; pushed towards it, any tension would help to overturn: none, to 1e-5 W."""
    tied = with_links(BLOCK, st.Tie(at=(-0.55, 0.0), axial_stiffness=1e8, axial_capacity=3e4))
    (away,) = limit_directions(tied, [0.0]).limits
    assert away.links[0].largest == pytest.approx(3e4, rel=1e-3)
    assert away.links[0].towards == pytest.approx((0.0, 0.0, -1.0), abs=1e-9)
    (to,) = limit_directions(tied, [180.0]).limits
    assert to.links[0].largest < 1e-5 * WEIGHT


def test_the_command_goes_all_round_a_column_with_links(tmp_path, capsys):
    tied = with_links(BLOCK, st.Tie(at=(-0.55, 0.0), axial_stiffness=1e8, axial_capacity=3e4))
    file = write_column(tied, tmp_path / "tied.toml")
    out = tmp_path / "out"
    assert call(["limit", str(file), "--directions", "0:270:4", "--json", "--out", str(out)]) == 0
    output = json.loads(capsys.readouterr().out)
    assert [direction["links"][0]["yields"] for direction in output["directions"][:4]] == [True, True, False, True]
    assert output["all_round"]
    assert output["weakest_azimuth_deg"] == 180.0
    assert (out / "directions.png").is_file()
    assert call(["limit", str(file), "--directions", "0:270:4"]) == 0
    assert "torsion" not in capsys.readouterr().out
    drum = st.Drum(4.0, 1.0, 1.0, 2500.0, "circular")
    write_column(with_links(st.Column.of_drums([drum], ROUGH), *tied.links), file)
    assert call(["limit", str(file), "--directions", "0:90:2"]) == 0
    output = capsys.readouterr().out
    assert "torsion" in output
    assert "3e+04 N of 3e+04 N, yields" in output
