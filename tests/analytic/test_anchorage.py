"""What the stone at an anchor bears: the formulas in round numbers, their limits, and what is refused."""

import math

import pytest

import stylobate as st
from stylobate.cli.columns import _link, _resistance_words
from stylobate.column.links.placed import stone_words

GIVEN = {"diameter": 0.02, "embedment": 0.1, "edge": 0.1, "stone_strength": 25e6, "yield_strength": 4e8}


def test_cone_edge_and_bearing_in_round_numbers():
    """f = 25 MPa, h = 100 mm: 7.7·5·1000 N far from an edge; 20 mm at f_y = 400 MPa: 1.3·400·100 N; in digits of the sum."""
    far = st.stone_at_anchor(**GIVEN | {"edge": 0.3})
    assert far["cone"] == pytest.approx(38.5e3, rel=1e-12)
    assert st.stone_at_anchor(**GIVEN | {"edge": 0.3}, cracked=False)["cone"] == pytest.approx(55e3, rel=1e-12)
    assert far["bearing"] == pytest.approx(52e3, rel=1e-12)
    # in hard stone the bar is sheared off: 314.16 mm²·400/√3
    assert st.stone_at_anchor(**GIVEN | {"stone_strength": 1e8})["bearing"] == pytest.approx(72.55e3, rel=1e-3)
    near = st.stone_at_anchor(**GIVEN)
    # c = 100 mm of 150: (100 + 150)/300 of the area, 0.7 + 0.3·2/3 of the stress
    assert near["cone"] == pytest.approx(38.5e3 * 250.0 / 300.0 * 0.9, rel=1e-12)
    # α = 0.1, β = 0.1·0.2^0.2 = 0.07248: 1.7·1.3493·1.3963·5·1000, four digits by hand
    assert near["edge"] == pytest.approx(16.01e3, rel=1e-3)


def test_an_edge_twice_as_far_bears_more_and_a_longer_bar_than_twelve_diameters_no_more_at_the_edge():
    assert st.stone_at_anchor(**GIVEN | {"edge": 0.2})["edge"] > 2.0 * st.stone_at_anchor(**GIVEN)["edge"]
    long, longer = (st.stone_at_anchor(**GIVEN | {"embedment": embedment})["edge"] for embedment in (0.24, 0.5))
    assert long == longer


def test_a_thick_bar_counts_along_the_edge_for_eight_diameters_or_300_mm():
    """EN 1992-4, 7.2.2.5: 12·24 = 288 mm, from there 300 mm up to 37.5 mm, then 8 d: what is longer bears no more."""
    for diameter, length in ((0.024, 0.288), (0.03, 0.3), (0.05, 0.4)):
        bars = (GIVEN | {"diameter": diameter, "embedment": embedment} for embedment in (0.99 * length, length, 2.0))
        short, just, longer = (st.stone_at_anchor(**bar)["edge"] for bar in bars)
        assert short < just == longer


@pytest.mark.parametrize("strength", [20e6, 60e6])
@pytest.mark.parametrize("diameter", [0.012, 0.02, 0.04])
def test_another_code_comes_to_much_the_same(strength, diameter):
    """ACI 318-19, 17.6.2 and 17.7.2, cracked, post-installed, in lb, inch and psi: N = 17 √f h^1.5 (7.11 in SI, to 7.7) and
    V = min(7 (l/d)^0.2 √d, 9) √f c^1.5, l ≤ 8 d. Two fits to tests: 0.75 to 1.18 of it from 4 to 15 diameters of edge."""
    inch, pound = 25.4e-3, 4.448222
    root = math.sqrt(strength / (pound / inch**2))
    for edge in (4.0 * diameter, 8.0 * diameter, 15.0 * diameter):
        bar = {"diameter": diameter, "embedment": 8.0 * diameter, "edge": edge, "stone_strength": strength}
        other = min(7.0 * 8.0**0.2 * math.sqrt(diameter / inch), 9.0) * root * (edge / inch) ** 1.5 * pound
        assert st.stone_at_anchor(**bar, yield_strength=4e8)["edge"] == pytest.approx(other, rel=0.25)
    far = st.stone_at_anchor(**GIVEN | {"edge": 1.0, "stone_strength": strength})["cone"]
    assert 17.0 * root * (0.1 / inch) ** 1.5 * pound / far == pytest.approx(7.11 / 7.7, rel=2e-3)


def test_bearing_is_a_hinge_in_the_bar_against_five_times_the_strength():
    """V = √(2 q M) with q = 5.07 f d and M = d³ f_y/6 of the plastic section: 1.3 = √(5.07/3), three digits."""
    d, f, f_y = 0.02, 25e6, 4e8
    by_hinge = math.sqrt(2.0 * 5.07 * f * d * d**3 * f_y / 6.0)
    assert st.stone_at_anchor(**GIVEN)["bearing"] == pytest.approx(by_hinge, rel=1e-3)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"edge": None}, "needs edge; give it"),
        ({"edge": None, "stone_strength": None}, "needs edge and stone_strength; give them"),
        ({"stone_strength": 25.0}, "stone_strength"),
        ({"edge": 0.01, "diameter": 0.05}, "the anchor is not in the stone"),
    ],
)
def test_what_is_missing_or_no_anchor_is_refused(change, words):
    with pytest.raises(st.InputError, match=words):
        st.stone_at_anchor(**GIVEN | change)


def test_the_stone_that_gives_way_before_a_dowel_is_told():
    """Edge of a dowel at 0.36 m in a drum of 1 m across: 0.14 m below, 0.09 m above. Chips are not taken off."""
    drums = [st.Drum(1.0, 1.0, 1.0, 2500.0, "circular"), st.Drum(1.0, 0.9, 0.9, 2500.0, "circular")]
    dowel = st.Dowel(joint=2, at=(0.36, 0.0), diameter=0.03, embedment=0.12, material="titanium", stone_strength=40e6)
    thin = st.Dowel(joint=1, at=(0.0, 0.0), diameter=0.01, embedment=0.12, material="titanium")
    given = st.Dowel(joint=2, at=(-0.36, 0.0), shear_stiffness=1e8, shear_capacity=1e4)
    column = st.Column.of_drums(drums, st.Joint(5e10, 2.5e10, friction_angle=35.0)).replace(links=(dowel, thin, given))
    first, second, third = column.placed_links
    size = {"diameter": 0.03, "embedment": 0.12, "stone_strength": 40e6, "yield_strength": 275e6}
    assert first.stone.shear == pytest.approx(st.stone_at_anchor(**size, edge=0.09)["edge"], rel=1e-12)
    assert first.stone.shear == first.shear_capacity < first.alone.shear_capacity < math.inf
    assert first.stone.pull == math.inf  # a dowel lifts out
    assert second.stone.shear > second.shear_capacity
    assert third.stone is None
    words = stone_words(column.placed_links)
    assert f"before 1 of 3 links do, first around {first.name}: at {first.stone.shear / 1e3:.4g} kN in shear" in words
    assert "The stone around 1 of 3 links was not checked" in words
    assert "The stone around 2 of 2" not in words
    assert "bears more than they hold" in stone_words([second])
    assert not stone_words([])
    descriptions = [_resistance_words(_link(link)) for link in (first, second, third)]
    assert descriptions[0] == f"holds {first.stone.shear / 1e3:.4g} kN in shear; edge of the stone (EN 1992-4, 7.2.2.5)"
    assert f"where the bar holds {first.alone.shear_capacity / 1e3:.4g} kN" in words
    assert descriptions[1].startswith(f"holds {second.shear_capacity / 1e3:.4g} kN in shear;")
