"""Attributes of a response that come in pairs say what they are, and which other one they are like."""

import re

import pytest

import stylobate as st

PAIRS = [("slip", "joint_slip"), ("opening", "joint_opening"), ("rotation", "drum_rotation")]


@pytest.mark.parametrize("pair", [*PAIRS, *((second, first) for first, second in PAIRS)])
def test_each_of_a_pair_names_the_other_with_unit_and_shape(pair):
    words = getattr(st.Response, pair[0]).__doc__
    assert f"``{pair[1]}``" in words
    assert re.search(r"\[(m|rad)\], shape \(T", words)


def test_no_measure_is_explained_by_the_one_before_it():
    words = [member.__doc__ or "" for member in vars(st.Response.__mro__[1]).values() if isinstance(member, property)]
    words.append(st.Response.residual_top_displacement.__doc__)
    assert not [text for text in words if text.startswith("The same")]
