"""Every case of the validation page as a test."""

import math

import numpy as np
import pytest
from validation.case import AtMost, Between, Near, text, texts
from validation.cases import CASES
from validation.figures import FIGURES


@pytest.mark.parametrize("case", CASES, ids=[case.name for case in CASES])
def test_case(case):
    values = case.compute()
    assert np.all(np.isfinite(values))
    assert case.criterion.holds(values), (
        f"{case.quantity}: {texts(values)}, expected {case.criterion.expected} {case.criterion.tolerance}"
    )


def test_a_criterion_can_fail():
    assert Near((1.0, 2.0), rel=1e-3).holds([1.0009, 1.9981])
    for wrong in ([1.0011, 2.0], [1.0, math.nan], [1.0], 1.0):
        assert not Near((1.0, 2.0), rel=1e-3).holds(wrong)
    assert AtMost(0.1).holds([-0.1, 0.0])
    for wrong in (0.11, [-0.11, 0.0], math.nan):
        assert not AtMost(0.1).holds(wrong)
    assert Between(1.0, 2.0).holds(1.5)
    for wrong in (0.9, [1.5, 2.1], math.nan):
        assert not Between(1.0, 2.0).holds(wrong)


def test_names_and_words_of_the_cases():
    names = [case.name for case in CASES]
    assert len(set(names)) == len(names)
    assert set(FIGURES) == {case.kind for case in CASES}
    assert all(case.source and case.reason and "|" not in case.source + case.reason for case in CASES)


def test_numbers_for_people():
    assert [text(value) for value in (0.0, 0.20463, 1.0, 14.871, 5.1e-15, 1e-9)] == [
        "0", "0.20463", "1", "14.871", "5.1·10⁻¹⁵", "10⁻⁹",
    ]  # fmt: skip
    assert texts([0.5, 2]) == "0.5, 2"
