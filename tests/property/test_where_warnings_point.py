"""A warning points to the line that called the package, not to one inside it."""

import warnings

import numpy as np
import pytest

import stylobate as st

BLOCK = st.preset("paper-monolithic")
SHAKEN_ACROSS = st.Motion(0.01, np.full(20, 0.1), np.full(20, 0.1))
WEAK = st.harmonic(1.0, 0.01, 0.5)

WARNING = {
    "constructor": lambda: st.Column.of_drums([st.Drum(1.0, 0.5, 0.8, 2500.0)], st.Joint(5e9, 5e9, 35.0)),
    "request": lambda: st.MotionRequest(synthetic="greece,6Mw,10km", azimuths=(0.0, 180.0), signs="both"),
    "run": lambda: st.simulate(BLOCK, SHAKEN_ACROSS, st.HousnerBlock()),
    "many runs": lambda: st.simulate_many(BLOCK, [SHAKEN_ACROSS], st.HousnerBlock()),
    "suite": lambda: st.suite_table(BLOCK, [SHAKEN_ACROSS], st.HousnerBlock()),
}  # fmt: skip


@pytest.mark.parametrize("call", WARNING.values(), ids=WARNING)
def test_warnings_point_to_the_line_that_called(call):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    assert caught
    assert {warning.filename for warning in caught} == {__file__}
