"""Whatever shows, keeps or asks for measures has those that are declared, and no list of its own."""

import dataclasses
import math

import numpy as np
import pytest

import stylobate as st
from stylobate.response.measures import MEASURES, TOP, Measures, blank_row, measures_of
from stylobate.verdicts.limit_states import EXCEEDED, NOT_EXCEEDED, parse_state


def test_blank_rows_have_every_measure_of_their_kind():
    column, assembly = blank_row(space=True), blank_row(blocks=True)
    for one in measures_of(Measures):
        assert one.key in column
        assert (one.key in assembly) is (one.of != TOP)
    assert {one.key for one in MEASURES} <= column.keys() | assembly.keys()


@pytest.mark.parametrize("one", [one for one in MEASURES if one.unit in ("m", "rad")], ids=lambda one: one.key)
def test_every_length_and_angle_is_a_limit_state(one):
    state = parse_state(f"{one.key}:0.05")
    assert parse_state(state.name) == state
    for value, answer in ((0.06, EXCEEDED), (0.04, NOT_EXCEEDED)):
        assert state.of({"verdict": "stands", one.key: value}) == answer


def test_responses_and_files_have_every_measure(tmp_path):
    motion = st.harmonic(frequency=2.0, amplitude=0.5 * st.g, duration=0.5)
    column = st.Column.tapered(
        height=2.0, bottom_width=0.5, top_width=0.5, drums=1, density=2000.0, joint=st.Joint(1e9, 5e8, 35.0)
    )
    response = st.simulate(column, motion, st.HousnerBlock())
    again = st.Response.load(response.save(tmp_path / "run.nc"))
    attributes, row = response.to_xarray().attrs, response.measures.row()
    for one in measures_of(Measures):
        value = getattr(response.measures, one.field)
        assert getattr(response, one.field) is value
        assert one.meaning[1:] in getattr(type(response), one.field).__doc__
        kept = [attributes[one.key], getattr(again, one.field)]
        assert np.array_equal(kept, [value, value], equal_nan=True)
        assert row[one.key] == value or (math.isnan(value) and row[one.key] is None)
    assert response.peak_tilt is None


def test_a_measure_that_an_engine_does_not_compute_is_not_known():
    fields = {field.name: field for field in dataclasses.fields(Measures)}
    assert all(math.isnan(fields[one.field].default) for one in measures_of(Measures) if one.field != "steps")
