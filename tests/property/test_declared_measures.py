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
    for measure in measures_of(Measures):
        assert measure.key in column
        assert (measure.key in assembly) is (measure.of != TOP)
    assert {measure.key for measure in MEASURES} <= column.keys() | assembly.keys()


@pytest.mark.parametrize(
    "measure", [measure for measure in MEASURES if measure.unit in ("m", "rad")], ids=lambda measure: measure.key
)
def test_every_length_and_angle_is_a_limit_state(measure):
    state = parse_state(f"{measure.key}:0.05")
    assert parse_state(state.name) == state
    for value, answer in ((0.06, EXCEEDED), (0.04, NOT_EXCEEDED)):
        assert state.of({"verdict": "stands", measure.key: value}) == answer


def test_responses_and_files_have_every_measure(tmp_path):
    motion = st.harmonic(frequency=2.0, amplitude=0.5 * st.g, duration=0.5)
    column = st.Column.tapered(
        height=2.0, bottom_width=0.5, top_width=0.5, drums=1, density=2000.0, joint=st.Joint(1e9, 5e8, 35.0)
    )
    response = st.simulate(column, motion, st.HousnerBlock())
    again = st.Response.load(response.save(tmp_path / "run.nc"))
    attributes, row = response.to_xarray().attrs, response.measures.row()
    for measure in measures_of(Measures):
        value = getattr(response.measures, measure.field)
        assert getattr(response, measure.field) is value
        assert measure.meaning[1:] in getattr(type(response), measure.field).__doc__
        kept = [attributes[measure.key], getattr(again, measure.field)]
        assert np.array_equal(kept, [value, value], equal_nan=True)
        assert row[measure.key] == value or (math.isnan(value) and row[measure.key] is None)
    assert response.peak_tilt is None


def test_a_measure_that_an_engine_does_not_compute_is_not_known():
    fields = {field.name: field for field in dataclasses.fields(Measures)}
    assert all(
        math.isnan(fields[measure.field].default) for measure in measures_of(Measures) if measure.field != "steps"
    )
