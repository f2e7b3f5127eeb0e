"""Links of assemblies against hand calculations: clamps between blocks side by side, dowelled architraves, pretension."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.column.assembly import Assembly, Block
from stylobate.column.links import Clamp, Link, block_link
from stylobate.column.links.kinds import shear_limits, shear_stiffness
from stylobate.column.links.link import MATERIALS, Site
from stylobate.simulate import simulate

G = 9.80665
SMOOTH = st.Joint(1e9, 5e8, friction_coefficient=0.0)
ROUGH = st.Joint(1e9, 5e8, friction_coefficient=2.0)
DENSITY = 2000.0


def box(left: float, right: float, low: float, high: float, name: str, **fields) -> Block:
    return Block(((left, low), (right, low), (right, high), (left, high)), DENSITY, name, **fields)


def push(acceleration: float, rise: float, hold: float) -> st.Motion:
    """A ground acceleration that rises evenly and stays; what stands on it is pushed the other way."""
    time = np.arange(round((rise + hold) / 0.01) + 1) * 0.01
    return st.Motion(0.01, -acceleration * np.minimum(time / rise, 1.0))


def side_by_side(*links: Link, friction: st.Joint = SMOOTH) -> Assembly:
    """A block that stays and, to its right, one of 1 t that slides freely."""
    blocks = box(0.0, 1.0, 0.0, 0.5, "held", fixed=True), box(1.0, 2.0, 0.0, 0.5, "free", surface=friction)
    return Assembly(blocks, SMOOTH, "pair", gravity=G, links=links)


ENDS = {"between": ("held", "free"), "at": (0.85, 0.25), "to": (1.15, 0.25)}


def test_a_clamp_carries_to_its_capacity_and_is_lost() -> None:
    """The force m a rises by 4 kN in a second: T = m a to 2 kN, at 0.5 s, yields, and is gone at its elongation.

    The clamp and the block swing at 100 rad/s, which a steady rise of 4 kN/s excites by 4/100 kN. Afterwards the block is
    pushed by m a alone: its acceleration is that of the ground, to what a second difference over 10 ms makes of its bend.
    """
    clamp = block_link("clamp", **ENDS, axial_stiffness=1e7, axial_capacity=2e3, ultimate_elongation=1e-3,
                       shear_stiffness=0.0)  # fmt: skip
    response = simulate(side_by_side(clamp), push(4.0, 1.0, 0.2), st.DistinctElement2D())
    (measures,) = response.measures.links
    time, tension = response.time, response.links.tension[:, 0]
    early = (time > 0.1) & (time < 0.48)
    assert tension[early] == pytest.approx(4e3 * time[early], abs=1.2 * 4e3 / 100.0)
    assert measures.peak_tension == pytest.approx(2e3, rel=1e-9)
    # from 0.5 s on (t − 0.5)³ 4/6 more than the 0.2 mm at which it yields
    assert measures.broken_at == pytest.approx(0.5 + (6.0 / 4.0 * 0.8e-3) ** (1.0 / 3.0), rel=0.02)
    after = time > measures.broken_at + 0.02
    assert not tension[after].any()
    step = time[1] - time[0]
    acceleration = np.diff(response.x[after, 2], 2) / step**2
    expected = 4.0 * np.minimum(time[after][1:-1], 1.0)
    assert acceleration == pytest.approx(expected, rel=2e-3)
    assert response.energy_imbalance < 1e-3
    assert "The clamp broke at 0.6" in response.sentence


def test_a_clamp_holds_against_both_senses_behind_its_slack() -> None:
    """Pushed to and fro across a gap, the block comes to rest against the clamp at slack + m a/K on either side."""
    gap = Assembly(
        (box(-0.1, 0.95, 0.0, 0.5, "held", fixed=True), box(1.0, 2.0, 0.0, 0.5, "free")), SMOOTH, "gap", gravity=G,
        links=(block_link("clamp", ("held", "free"), (0.85, 0.25), (1.15, 0.25), axial_stiffness=1e6, clearance=2e-3,
                          shear_stiffness=0.0),),
    )  # fmt: skip
    model = st.DistinctElement2D(mass_damping=4.0)
    for sign in (1.0, -1.0):
        response = simulate(gap, push(sign * 1.0, 1.0, 3.0), model)
        assert response.links.elongation[-1, 0] == pytest.approx(sign * (2e-3 + 1e3 / 1e6), rel=0.02)
        assert response.links.tension[-1, 0] == pytest.approx(sign * 1e3, rel=0.05)
        assert response.measures.links[0].peak_elongation >= np.abs(response.links.elongation).max() > 2e-3


@pytest.mark.parametrize("share", [0.0, 0.5, 3.0], ids=["bare", "yielding", "as one block"])
def test_a_clamped_pair_turns_as_one_block_up_to_its_clamps_yield(share) -> None:
    """Two blocks b wide and h high that do not rub on each other: a = (b/h) (g + V/m), V their clamp's, at most m g.

    Each turns about its own toe, and the clamp slips by b times the angle; from V = m g on both turn about one toe, as one
    block twice as wide. The push rises within 1.2 s, several periods of the blocks on their joints: 4 % below they stand,
    4 % above they turn on.
    """
    b, h = 0.4, 2.0
    mass = DENSITY * b * h
    clamp = block_link("clamp", ("left", "right"), (-0.1, 1.0), (0.1, 1.0), axial_stiffness=0.0, shear_stiffness=2e8,
                       shear_capacity=max(share, 1e-9) * mass * G)  # fmt: skip
    blocks = box(-b, 0.0, 0.0, h, "left", surface=ROUGH), box(0.0, b, 0.0, h, "right", surface=ROUGH)
    pair = Assembly(blocks, ROUGH, "pair", G, overrides=(("left", "right", SMOOTH),), links=(clamp,) if share else ())
    limit = b / h * G * (1.0 + min(share, 1.0))
    below, above = (simulate(pair, push(factor * limit, 1.2, 0.5), st.DistinctElement2D()) for factor in (0.96, 1.04))
    assert below.peak_rotation < 1e-3
    assert above.peak_rotation > 5e-3
    if share == 0.5:
        assert above.measures.links[0].peak_shear == pytest.approx(0.5 * mass * G, rel=1e-9)
    if share == 3.0:
        assert above.measures.links[0].peak_shear < 1.3 * mass * G
        assert above.rotation[-1, 1] == pytest.approx(above.rotation[-1, 2], rel=0.05)


def test_a_dowelled_architrave_slides_at_friction_and_capacity_after_its_slack() -> None:
    """a = μ g + V/m: 4 % below it holds behind the slack, 4 % above it slides off with (a − a_c) t.

    Below, friction keeps some of the swing with which it came through the slack, but it never yields.
    """
    slack, stiffness, friction, mass = 2e-4, 2e7, 0.3, 1000.0
    capacity = 0.2 * mass * G
    joint = st.Joint(1e9, 5e8, friction_coefficient=friction)
    dowel = block_link(
        "dowel", ("architrave", "pier"), shear_stiffness=stiffness, shear_capacity=capacity, clearance=slack
    )
    blocks = box(0.0, 1.0, 0.0, 1.0, "pier", fixed=True), box(0.0, 1.0, 1.0, 1.5, "architrave", surface=joint)
    pier = Assembly(blocks, SMOOTH, "pier and architrave", gravity=G, links=(dowel,))
    limit = friction * G + capacity / mass
    below = simulate(pier, push(0.96 * limit, 2.0, 0.4), st.DistinctElement2D())
    above = simulate(pier, push(1.04 * limit, 0.4, 0.6), st.DistinctElement2D())
    slip = np.abs(below.links.slip[:, 0])
    assert slack + (0.96 * limit - friction * G) * mass / stiffness < 1.01 * slip[-1] < slack + capacity / stiffness
    assert np.ptp(slip[-20:]) < 1e-5
    slid = np.abs(above.links.slip[:, 0])
    speed = (slid[-1] - slid[-2]) / (above.time[-1] - above.time[-2])
    assert speed == pytest.approx(0.04 * limit * 0.6, rel=0.1)
    assert above.links.shear[-1, 0] == pytest.approx(capacity, rel=1e-9)


def test_a_pretension_is_there_when_all_has_settled() -> None:
    """A tie over the face that opens holds the heel down: m a H = m g b + T (b + x), as of a column."""
    b, height, pull, x = 0.5, 2.0, 2e4, 0.55
    tie = block_link("tie", ("ground", "block"), (-x, 0.0), (-x, height), axial_stiffness=1e5, pretension=pull)
    block = box(-b, b, 0.0, height, "block")
    tied = Assembly((block,), ROUGH, "tied", gravity=G, links=(tie,))
    mass = block.properties[0]
    expected = (mass * G * b + pull * (b + x)) / (mass * 0.5 * height)
    response = simulate(tied, push(1.15 * expected, 1.15 * expected / 5.0, 0.0), st.DistinctElement2D(start="settle"))
    assert response.links.tension[0, 0] == pull
    opened = int(np.argmax(response.joint_opening[:, 0] > 1e-7))
    assert abs(response.ground_acceleration[opened]) == pytest.approx(expected, rel=0.03)


def test_the_numbers_of_a_clamp_are_those_of_its_bar_and_of_two_dowels() -> None:
    """Titanium of 20 × 10 mm, 0.3 m between legs of 60 mm: E A/ℓ in series with the legs; the weakest of bar and legs."""
    clamp = Clamp(material="titanium", section=(0.02, 0.01), embedment=0.06)
    diameter = math.sqrt(4.0 * 0.02 * 0.01 / math.pi)
    assert clamp.diameter == pytest.approx(diameter)
    resistance = clamp.resistance(Site(0.3))
    made = MATERIALS["titanium"]
    legs = shear_stiffness("titanium", diameter, 0.06, 50e9)
    assert resistance.axial_stiffness == pytest.approx(1.0 / (0.3 / (made.modulus * 2e-4) + 1.0 / legs))
    weakest = min(275e6 * 2e-4, *shear_limits("titanium", diameter, 0.06, 60e6).values())
    assert resistance.axial_capacity == pytest.approx(weakest)
    assert resistance.shear_stiffness == pytest.approx(shear_stiffness("titanium", diameter, 0.15, 50e9))
    assert "legs: shear of the bar" in resistance.governs
