"""A link holds the smaller of bar, anchor and stone, in every engine alike: capacities, runs and answers by hand."""

import dataclasses
import math

import numpy as np
import pytest

import stylobate as st
from stylobate.column.assembly_files import FROM_DICT, read_assembly
from stylobate.column.files import write_column
from stylobate.column.links import block_link
from stylobate.column.links.placed import BREAKS, CAPACITY_STATED, stone_at_limit, stone_words
from stylobate.statics.limit import limit_analysis
from stylobate.statics.pushover import pushover

SMOOTH = st.Joint(2e9, 1e9, friction_coefficient=0.1)
BLOCK = st.Column.of_drums([st.Drum(1.0, 1.0, 1.0, 2500.0)], SMOOTH, name="block")
MASS, G = BLOCK.mass, BLOCK.gravity

#: A dowel 7 cm from the edge of a soft stone, which gives way at V_EDGE; the bar alone bears several times as much.
SIZE = {"diameter": 0.03, "embedment": 0.12, "material": "titanium", "stone_strength": 1e7}
NEAR = st.Dowel(joint=1, at=(0.43, 0.0), **SIZE)

#: EN 1992-4, 7.2.2.5 with d = 30, l = 120, c = 70 mm and f = 10 MPa: α = 0.1 √(120/70), β = 0.1 (30/70)^0.2.
V_EDGE = 1.7 * 30.0 ** (0.1 * math.sqrt(12 / 7)) * 120.0 ** (0.1 * (3 / 7) ** 0.2) * math.sqrt(10.0) * 70.0**1.5
JOINT_OF_A_SCENE = (
    'name = "scene"\n[joint]\nnormal_stiffness = 2e9\nshear_stiffness = 1e9\nfriction_coefficient = 0.1\n'
)
DOWELLED = BLOCK.replace(links=(NEAR,), name="dowelled")
STATED = BLOCK.replace(links=(dataclasses.replace(NEAR, shear_capacity=8e4),), name="stated")


def push(acceleration: float, rise: float = 0.4, hold: float = 0.6) -> st.Motion:
    """A ground acceleration that rises evenly and stays."""
    time = np.arange(round((rise + hold) / 0.01) + 1) * 0.01
    return st.Motion(0.01, acceleration * np.minimum(time / rise, 1.0))


def test_the_smallest_of_bar_anchor_and_stone_by_hand():
    """20 mm of titanium, f_y = 275 and f_t = 345 MPa: sheared at A f_y/√3, held by bond at π d l τ; 50 mm deep a cone breaks
    out at 7.7 √60 50^1.5 N before a bond of 10 MPa does."""
    area = math.pi * 0.02**2 / 4.0
    bar = {"joint": 1, "diameter": 0.02, "material": "titanium"}
    each = st.Dowel(**bar, embedment=0.2), st.Bar(**bar, embedment=0.2), st.Bar(**bar, embedment=0.05, bond=1e7)
    sheared, bonded, coned = (BLOCK.replace(links=(link,)).placed_links[0] for link in each)
    assert sheared.shear_capacity == pytest.approx(275e6 / math.sqrt(3.0) * area, rel=1e-9)
    assert bonded.axial_capacity == pytest.approx(math.pi * 0.02 * 0.2 * 3e6, rel=1e-9)
    cone = 7.7 * math.sqrt(60.0) * 50.0**1.5
    assert coned.axial_capacity == pytest.approx(cone, rel=1e-9)
    assert coned.ultimate_elongation == pytest.approx(cone / coned.axial_stiffness, rel=1e-9)  # brittle: lost there
    (near,) = DOWELLED.placed_links
    assert near.shear_capacity == pytest.approx(V_EDGE, rel=1e-9)
    assert (sheared.failure, near.failure) == ("ductile", "brittle")
    limits = [
        (link.limited_by("shear_capacity"), link.limited_by("axial_capacity"))
        for link in (sheared, bonded, coned, near)
    ]
    assert limits == [("link", "link"), ("link", "link"), ("link", "stone"), ("stone", "link")]
    assert [link.governs.split("; ")[-1].split(" (")[0] for link in (sheared, bonded, coned, near)] == [
        "shear of the bar", "bond to the stone", "cone of the stone", "edge of the stone",
    ]  # fmt: skip


def test_a_capacity_that_is_given_stays_and_that_the_stone_bears_less_is_told():
    (link,) = STATED.placed_links
    assert (link.shear_capacity, link.failure, link.breaks_stone) == (8e4, "ductile", False)
    assert stone_words([link]).endswith(CAPACITY_STATED)
    (near,) = DOWELLED.placed_links
    assert stone_words([near]).endswith(BREAKS)
    assert "pushover" in stone_at_limit([near])
    assert "pushover" not in stone_at_limit([link])


def test_a_pretension_beyond_the_cone_is_refused():
    bar = st.Bar(joint=1, diameter=0.02, embedment=0.05, material="titanium", bond=1e7, pretension=2.5e4)
    with pytest.raises(st.InputError, match="cone of the stone"):
        _ = BLOCK.replace(links=(bar,)).placed_links


@pytest.mark.parametrize(
    "model", [st.DistinctElement2D(), st.DistinctElement3D(), st.RigidBlock()], ids=lambda model: model.name
)
def test_the_stone_breaks_at_its_capacity_and_the_dowel_then_holds_nothing(model):
    """4 % beyond μ m g + V: what slides off keeps a − μ g; a capacity of 80 kN, given, holds the same push."""
    limit = 0.1 * G + V_EDGE / MASS
    broke, whole = (st.simulate(column, push(1.04 * limit), model) for column in (DOWELLED, STATED))
    (link,), (other,) = broke.measures.links, whole.measures.links
    assert (link.broken, link.limited_by, other.broken, other.limited_by) == (True, "stone", False, "link")
    assert link.peak_shear == pytest.approx(V_EDGE, rel=1e-9)
    after = broke.time > link.broken_at + 0.01
    assert after.any()
    assert not broke.links.shear[after].any()
    slip = np.abs(broke.histories.slip[:, 0, 0])
    speed = np.diff(slip[after]) / np.diff(broke.time[after])
    gained = np.diff(speed[[0, -1]])[0] / (broke.time[after][-2] - broke.time[after][0])
    assert gained == pytest.approx(1.04 * limit - 0.1 * G, rel=0.05)
    assert np.abs(whole.histories.slip).max() < 1e-3


def test_a_cone_breaks_out_and_the_bar_then_holds_nothing():
    """A bar beside the edge that opens; its force is that of the cone within what one step adds."""
    tall = st.Column.of_drums([st.Drum(2.0, 0.5, 0.5, 2500.0)], st.Joint(2e9, 1e9, friction_coefficient=0.7))
    bar = st.Bar(joint=1, at=(0.15, 0.0), diameter=0.02, embedment=0.05, material="titanium", bond=1e7)
    column = tall.replace(links=(bar,))
    (placed,) = column.placed_links
    response = st.simulate(column, push(9.0, 0.3, 0.5), st.DistinctElement2D())
    (link,) = response.measures.links
    assert link.limited_by == "stone"
    assert link.broken
    assert 0.95 * placed.axial_capacity < link.peak_tension <= placed.axial_capacity
    assert not response.links.tension[response.time > link.broken_at + 0.01].any()


def test_statics_take_the_stone_too():
    """Sliding at μ + V/W; the path ends where the stone breaks."""
    multiplier = 0.1 + V_EDGE / (MASS * G)
    assert limit_analysis(DOWELLED).multiplier == pytest.approx(multiplier, rel=1e-6)
    path = pushover(DOWELLED, to=0.01)
    assert path.largest_multiplier == pytest.approx(multiplier, rel=1e-2)
    assert limit_analysis(STATED).multiplier > 2.0 * multiplier


def test_links_of_assemblies_are_in_their_stone_and_those_of_a_column_bring_it_along(tmp_path):
    """The same dowel between two blocks in the plane and in space, 7 cm from an edge; in a column in a scene; read again."""
    dowel = block_link("dowel", ("low", "high"), at=(0.43, 1.0), **SIZE)
    corners = (-0.5, 0.0), (0.5, 0.0), (0.5, 1.0), (-0.5, 1.0)
    levels = ("low", 0.0), ("high", 1.0)
    blocks = tuple(st.Block(tuple((x, z + up) for x, z in corners), 2500.0, name) for name, up in levels)
    aside = block_link("dowel", ("low", "high"), at=(0.0, 0.43, 1.0), **SIZE)
    stones = tuple(st.Stone.box((1.0, 1.0, 1.0), (0.0, 0.0, up), 2500.0, name=name) for name, up in levels)
    write_column(DOWELLED, tmp_path / "dowelled.toml")
    scene = tmp_path / "scene.toml"
    scene.write_text(JOINT_OF_A_SCENE + '[[column]]\nfile = "dowelled.toml"\nat = [[0.0, 0.0], [2.6, 0.0]]\n')
    flat = tmp_path / "flat.toml"
    flat.write_text(JOINT_OF_A_SCENE + '[[column]]\nfile = "dowelled.toml"\nnumber = 2\nspacing = 2.6\n')
    for structure in (
        st.Assembly(blocks, SMOOTH, "plane", links=[dowel]), st.SpatialAssembly(stones, SMOOTH, "space", links=(aside,)),
        read_assembly(scene), read_assembly(flat),
    ):  # fmt: skip
        for assembly in (structure, FROM_DICT[structure.kind](structure.to_dict())):
            for link in assembly.placed_links:
                assert link.shear_capacity == pytest.approx(V_EDGE, rel=1e-9)
                assert (link.failure, link.limited_by("shear_capacity")) == ("brittle", "stone")


def test_the_advice_on_a_dowel_is_that_of_its_stone():
    """Of three slow pulses the bar by itself holds all, the stone none: what was saved is not, and the advice says why."""
    motions = [st.ricker(frequency, 0.1 * G + 1.2 * V_EDGE / MASS) for frequency in (0.3, 0.4, 0.5)]
    states = {"as built": BLOCK, "dowelled": DOWELLED, "stated": STATED}
    comparison = st.compare_states(states, motions, st.DistinctElement2D(), state="top:0.01m", samples=200, threads=1)
    near, far = comparison.differences
    assert (near.saved, far.saved) == (0, 3)
    sentence = "The stone gives way before 1 of 1 links do: their capacity here is that of the stone."
    assert near.advice.endswith(sentence)
    assert sentence not in far.advice
    links = comparison.links.set_index("state")
    assert links.loc["dowelled", ["limited_by", "broken"]].tolist() == ["stone", 3]
    assert links.loc["stated", ["limited_by", "broken"]].tolist() == ["link", 0]
    values = st.design_values(comparison)
    force = values[values["quantity"] == "shear force"].set_index("state")
    assert force["limited_by"].to_dict() == {"dowelled": "stone", "stated": "link"}
    assert force.loc["dowelled", ["capacity", "use_value_84"]].tolist() == pytest.approx([V_EDGE, 1.0])
