"""How far a single run is, told while it is computed."""

import pytest

import stylobate as st


def test_a_run_says_how_far_it_is():
    calls = []
    motion = st.harmonic(2.0, 0.5, 0.3)
    heard = st.simulate(
        st.preset("paper-monolithic"), motion, st.DistinctElement2D(), progress=lambda *call: calls.append(call)
    )
    times, wholes = zip(*calls)
    assert sorted(set(times)) == heard.time.tolist()
    assert set(wholes) == {wholes[0]}
    assert wholes[0] == pytest.approx(times[-1]) == pytest.approx(0.3, abs=1e-3)
