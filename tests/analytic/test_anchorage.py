"""What the stone at an anchor bears: the formulas in round numbers, their limits, and what is refused."""

import pytest

import stylobate as st

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
    long, longer = (st.stone_at_anchor(**GIVEN | {"embedment": one})["edge"] for one in (0.24, 0.5))
    assert long == longer


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
