"""Assemblies in space like one: what varies, which stones move together, and what is told of each body over them."""

import dataclasses
import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

import stylobate as st
from stylobate.campaign.twins import the_twins
from stylobate.column.scatter import drawn_twins, twins_of
from stylobate.outcome import Outcome
from stylobate.response.words import STRUCK_IN_SPACE, UNDAMPED_WOBBLE, doubt_of, each_doubt
from stylobate.verdicts.population import bodies_over_twins, not_safe, only_as_seen, words_of_bodies
from stylobate.verdicts.verdict import caveat

JOINT = st.Joint(5e9, 2.5e9, 35.0)
OFFSETS = st.Scatter(0.0, 0.0, 0.0, 0.0, 0.0, 0.01)


def box(name, sides, at, **others):
    return st.Stone.box(sides, at, 2700.0, name=name, **others)


def scene(*stones, **others):
    return st.SpatialAssembly(stones, JOINT, name="scene", **others)


PORTAL = scene(
    box("left", (0.8, 0.8, 4.0), (-1.2, 0.0, 0.0)),
    box("right", (0.8, 0.8, 4.0), (1.2, 0.0, 0.0)),
    box("beam", (3.2, 0.8, 0.6), (0.0, 0.0, 4.0)),
)


def moved(twin, other):
    return np.array([np.subtract(a.position, b.position) for a, b in zip(twin.stones, other.stones)])


def test_a_twin_is_the_same_for_any_number_of_them():
    few, many = (twins_of(PORTAL, st.Scatter(width=0.0, height=0.0), number, 3, space=True) for number in (2, 4))
    assert [twin.digest for twin in few] == [twin.digest for twin in many[:2]]
    assert len({twin.digest for twin in many}) == 4
    assert [len(twin.space_joints) for twin in many] == [4, 4, 4, 4]


def test_a_stone_has_the_same_deviations_in_every_state_of_what_stands():
    """Without its beam, and numbered otherwise, so that states are compared pair by pair."""
    alone = scene(PORTAL.stones[1], PORTAL.stones[0])
    for whole, other in zip(*(twins_of(assembly, st.Scatter(), 3, 0, space=True) for assembly in (PORTAL, alone))):
        kept = {stone.name: stone.to_dict() for stone in whole.stones}
        assert all(kept[stone.name] == stone.to_dict() for stone in other.stones)
        assert kept["left"]["density"] != kept["right"]["density"]


def test_each_part_varies_alone_and_as_much_as_it_says():
    """Coefficients of variation of 400 draws of three stones, half of whose variance is common: to 15 %, four deviations."""
    for part, read in (
        ("friction", lambda stone: stone.surface.tan_phi),
        ("joint_stiffness", lambda stone: stone.surface.normal_stiffness),
        ("density", lambda stone: stone.density),
    ):
        size = dataclasses.replace(OFFSETS, offset=0.0, **{part: 0.1})
        twins = twins_of(PORTAL, size, 400, 0, space=True)
        values = np.log([[read(stone) for stone in twin.stones] for twin in twins])
        assert values.std(axis=0) == pytest.approx(0.1, rel=0.15)
        assert np.corrcoef(values.T)[0, 1] == pytest.approx(0.5, abs=0.15)
        assert not moved(twins[0], PORTAL).any()


def test_stones_slide_on_level_faces_and_otherwise_move_together():
    """Two architraves end to end move as one; what is fixed, and what leans on it, does not."""
    stones = (
        box("left", (0.8, 0.8, 4.0), (-2.0, 0.0, 0.0)),
        box("right", (0.8, 0.8, 4.0), (2.0, 0.0, 0.0)),
        box("one", (2.4, 0.8, 0.6), (-1.2, 0.0, 4.0)),
        box("other", (2.4, 0.8, 0.6), (1.2, 0.0, 4.0)),
        box("wall", (0.5, 4.0, 3.0), (-2.65, 0.0, 0.0), fixed=True),
        box("middle", (0.8, 0.8, 4.0), (0.0, 0.0, 0.0)),
    )
    way = moved(twins_of(scene(*stones), OFFSETS, 1, 1, space=True)[0], scene(*stones))
    assert not way[0].any()
    assert not way[4].any()
    assert way[1].any()
    assert np.array_equal(way[2], way[3])
    assert not np.array_equal(way[1], way[2])
    assert np.abs(way[:, :2]).max() <= 0.025 * 0.8 + 1e-9  # 2.5 deviations of 0.01, faces of 0.8 m and less
    assert not way[:, 2].any()


def test_offsets_that_do_not_fit_are_halved():
    """Two boxes 1 mm apart, moved by some 40 mm: no twin overlaps, and some had to be halved."""
    close = scene(box("a", (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)), box("b", (1.0, 1.0, 1.0), (1.001, 0.0, 0.0)))
    size = dataclasses.replace(OFFSETS, offset=0.04)
    free = scene(box("a", (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)), box("b", (1.0, 1.0, 1.0), (3.0, 0.0, 0.0)))
    drawn = [share for _, share in drawn_twins(close, size, 12, 0, space=True)]
    near, far = (
        np.array([moved(twin, assembly) for twin in twins_of(assembly, size, 12, 0, space=True)])
        for assembly in (close, free)
    )
    share = np.abs(near).max(axis=(1, 2)) / np.abs(far).max(axis=(1, 2))
    assert set(np.round(share, 12)) > {1.0}
    assert drawn == pytest.approx(share)
    twins = the_twins(close, st.DistinctElement3D(), st.Campaign(replicates=12, seed=0, scatter=size))
    assert twins.facts["offsets_reduced"] == twins.reduced == sum(share < 1.0) > 0
    assert f"in {twins.reduced} the offsets are halved or left out" in twins.words
    assert (
        "offsets_reduced"
        not in the_twins(st.preset("paper-monolithic"), st.DistinctElement3D(), st.Campaign(replicates=2)).facts
    )
    assert all(math.isclose(ratio, 2.0 ** round(math.log2(ratio))) for ratio in share if ratio)


def row(fell=(), still=True, outcome="collapsed"):
    bodies = {
        name: {"fell_at_s": 1.0 if name in fell else None, "displacement_at_end_m": [x, 0.0, 0.0]}
        for name, x in (("a", 1.0 + len(fell)), ("b", 0.0))
    }
    return {
        "outcome": outcome, "decided": bool(fell) or still, "collapsed": bool(fell), "at_rest": still, "bodies": bodies,
    }  # fmt: skip


def test_bodies_over_twins():
    """By hand: of four runs with a verdict "a" fell in three, and in one that did not lie still "b" may yet fall."""
    rows = [row("a"), row("ab"), row("a", still=False), row(outcome="rocked"), row("ab", outcome="failed")]
    a, b = bodies_over_twins(rows)
    assert (a.fell, a.stood, a.open, a.still) == (3, 1, 0, 3)
    assert (b.fell, b.stood, b.open) == (1, 2, 1)
    assert a.share == 0.75
    assert a.middle[0] == 2.0  # median of 1, 2, 2, 3
    assert a.radii == (0.0, 1.0)
    assert b.interval(0.95)[1] > a.share > b.interval(0.95)[0]
    assert words_of_bodies((a, b)) == "What fell: a in 3, b in 1 (1 undecided)."
    assert words_of_bodies(bodies_over_twins([row(outcome="rocked")])) == ""
    hanging = bodies_over_twins([row(outcome="rocked", still=False), row("a", still=False)])
    assert words_of_bodies(hanging) == "What fell: a in 1 (1 undecided). Fell in none, but undecided: b in 2."
    assert [body.name for body in not_safe(hanging)] == ["a", "b"]
    assert only_as_seen(hanging[0].runs).startswith("from 2 runs, fewer than 20, the 90 % region is only that of")
    assert only_as_seen(0) == only_as_seen(20) == ""
    assert bodies_over_twins([{"outcome": "rocked", "decided": True, "collapsed": False}]) == ()


def test_what_does_not_vary_is_refused():
    still = st.Motion(0.01, np.zeros(11))
    with pytest.raises(st.InputError, match=r"the scatter has width, by which twins of an assembly in space such as"):
        st.certainty(PORTAL, still, st.DistinctElement3D(), replicates=2, scatter=st.Scatter(0.1, 0, 0, 0.01, 0, 0))


def test_links_move_with_their_stones():
    """A clamp on the sides of two cubes: all twins have their offsets, and its ends stay on the stones."""
    stones = box("lower", (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)), box("upper", (1.0, 1.0, 1.0), (0.0, 0.0, 1.0))
    clamp = st.Clamp(
        at=(0.5, 0.0, 0.8), to=(0.5, 0.0, 1.2), between=("lower", "upper"), section=(0.04, 0.01), embedment=0.05,
        material="titanium",
    )  # fmt: skip
    clamped = scene(*stones, links=(clamp,))
    for twin in twins_of(clamped, OFFSETS, 12, 0, space=True):
        way = moved(twin, clamped)
        assert np.abs(way[:, :2]).min() > 0.0
        link = twin.links[0]
        assert np.subtract(link.at, clamp.at) == pytest.approx(way[0], abs=1e-12)
        assert np.subtract(link.to, clamp.to) == pytest.approx(way[1], abs=1e-12)


def test_a_push_of_one_box_onto_another():
    """A box shoves its neighbour: what fell is told of each body, with a caution as they struck, and over twins."""
    stones = (
        box("pushed", (0.3, 0.6, 1.2), (0.0, 0.0, 0.0)),
        box("hurled", (0.3, 0.3, 0.3), (-0.8, 0.0, 0.85), velocity=(6.0, 0.0, 0.0)),
    )
    certainty = st.certainty(
        scene(*stones, settle=False), st.Motion(0.01, np.zeros(101)), st.DistinctElement3D(), replicates=2, threads=1
    )
    summary = certainty.summary()
    assert set(summary["fallen"]) == {"pushed", "hurled"}
    assert summary["fallen"] == sorted(summary["fallen"], key=lambda name: summary["bodies"][name]["fell_at_s"])
    assert 0.05 < summary["struck_at_s"] < 0.12  # 0.5 m at 6 m/s
    assert summary["bodies"]["pushed"]["fall_azimuth_deg"] == pytest.approx(0.0, abs=15.0)
    assert summary["bodies"]["pushed"]["residual_displacement_m"] is None
    assert certainty.sentence.count(STRUCK_IN_SPACE) == 1
    assert "Collapses in 2 of 2 assemblies like this" in certainty.sentence
    assert summary["certainty"]["bodies"]["pushed"]["fell"] == 2
    response = certainty.response
    assert response.body_velocity[0, 2] == pytest.approx([6.0, 0.0, 0.0])
    assert response.body_angular_velocity.shape == response.body_position.shape
    assert response.dims == "xyz"


def test_twins_that_struck_are_cautioned_of_where_the_run_itself_did_not():
    """Nothing moves here, but what is told of a population holds for all of it; slips have their lengths, too."""
    still = st.Motion(0.01, np.zeros(6))
    certainty = st.certainty(PORTAL, still, st.DistinctElement3D(), replicates=1, threads=1)
    summary = certainty.response.summary()
    assert summary["doubt"] == ""
    assert certainty.sentence.endswith(STRUCK_IN_SPACE)
    assert certainty.summary()["doubt"] == STRUCK_IN_SPACE
    slips = np.hypot(summary["residual_slip_x_m"], summary["residual_slip_y_m"])
    assert summary["residual_slip_per_joint_m"] == pytest.approx(slips)
    assert len(slips) == 4


def test_round_joints_of_assemblies_that_nothing_damps_are_cautioned_of():
    """A restitution is that of bodies that no joint holds: it damps no wobble."""
    drum = st.Stone.drum(0.6, 0.6, 1.0, (0.0, 0.0, 0.0), 2500.0, name="drum")
    round_ = scene(drum)
    both = f"{STRUCK_IN_SPACE} {UNDAMPED_WOBBLE}"
    assert caveat([round_], st.DistinctElement3D()) == both
    assert caveat([PORTAL, round_], st.DistinctElement3D(restitution=0.5)) == both
    assert caveat([PORTAL], st.DistinctElement3D()) == STRUCK_IN_SPACE
    damped = st.DistinctElement3D(stiffness_damping=1e-4)
    assert caveat([round_], damped) == STRUCK_IN_SPACE
    assert caveat([round_], damped, st.DistinctElement3D()) == both
    for outcome, struck, words in (("ROCKED", False, UNDAMPED_WOBBLE), ("COLLAPSED", True, both), ("AT_REST", False, ""),
                                   ("FAILED", True, "")):  # fmt: skip
        blocks = SimpleNamespace(hangs_on_strikes=struck)
        run = SimpleNamespace(
            measures=SimpleNamespace(space=None, blocks=blocks), outcome=Outcome[outcome], structure=round_,
            provenance={"parameters": st.DistinctElement3D().parameters()},
        )  # fmt: skip
        assert doubt_of(cast(Any, run)) == words
    assert each_doubt(["", UNDAMPED_WOBBLE, both, both]) == [both]
