"""Response files: what is saved is loaded back without loss, and appears whole or not at all."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings, strategies

import stylobate as st
from stylobate.atomic import replacing
from stylobate.column.catalogue import preset
from stylobate.column.files import column_from_dict
from stylobate.response import ENERGY_TERMS, Histories, Measures

RECORDED = (
    "time", "drum_x", "drum_z", "drum_rotation", "joint_opening", "joint_slip", "joint_twist", "base_displacement",
    "top_displacement", "ground_acceleration", "ground_displacement",
)  # fmt: skip
NUMBERS = strategies.floats(allow_nan=True, allow_infinity=True)


@strategies.composite
def responses(draw):
    column = draw(
        strategies.sampled_from([preset("paper-monolithic"), preset("paper-12-drums").with_joint(friction_angle=31.0)])
    )
    steps = draw(strategies.integers(1, 4))
    random = np.random.default_rng(draw(strategies.integers(0, 2**32)))
    special = draw(NUMBERS)

    def array(*shape):
        values = random.standard_normal(shape) * 10.0 ** random.integers(-300, 300)
        values.flat[0] = special
        return values

    histories = Histories.of_drums(
        time=np.arange(steps) * 0.01,
        **{
            name: array(steps, column.n)
            for name in ("drum_x", "drum_z", "drum_rotation", "joint_opening", "joint_slip")
        },
        **{
            name: array(steps)
            for name in ("base_displacement", "top_displacement", "ground_acceleration", "ground_displacement")
        },
        energy={
            term: array(steps) for term in draw(strategies.sets(strategies.sampled_from(ENERGY_TERMS), min_size=1))
        },
    )
    measures = Measures(
        outcome=draw(strategies.sampled_from(st.Outcome)),
        decided=draw(strategies.booleans()),
        **{field.name: draw(NUMBERS) for field in dataclasses.fields(Measures) if field.type == "float"},
        steps=draw(strategies.integers(0, 2**60)),
        reason=draw(strategies.sampled_from(["", "overturned about joint 3", "θ̈ is not finite"])),
    )
    provenance = {
        "version": "0.1.0",
        "parameters": {"points": 2, "block_modulus": None},
        "share": draw(strategies.floats(0, 1)),
    }
    return st.Response(column, histories, measures, "dem2d", provenance, draw(strategies.floats(0, 1e6)))


def same(a, b):
    return a == b or (isinstance(a, float) and math.isnan(a) and math.isnan(b))


@settings(max_examples=10, deadline=None)
@given(response=responses())
def test_a_saved_response_is_loaded_without_loss(response, tmp_path_factory):
    path = response.save(tmp_path_factory.getbasetemp() / "round.nc")
    loaded = st.Response.load(path)
    assert loaded.column == response.column
    assert loaded.model == response.model
    assert loaded.provenance == response.provenance
    assert loaded.wall_time == response.wall_time
    for field in dataclasses.fields(Measures):
        assert same(getattr(loaded.measures, field.name), getattr(response.measures, field.name)), field.name
    assert isinstance(loaded.measures.decided, bool)
    for name in RECORDED:
        np.testing.assert_array_equal(getattr(loaded, name), getattr(response, name), err_msg=name)
    assert set(loaded.histories.energy) == set(response.histories.energy)
    for term, values in response.histories.energy.items():
        np.testing.assert_array_equal(loaded.histories.energy[term], values, err_msg=term)


def one_response(column=None):
    column, zero = column or preset("paper-12-drums"), np.zeros(3)
    wide = np.zeros((3, column.n))
    histories = Histories.of_drums(
        zero, wide, wide, wide, wide, wide, zero, zero, zero, zero, dict.fromkeys(ENERGY_TERMS, zero)
    )
    measures = Measures(st.Outcome.ROCKED, True, math.nan, 0.1, 0.0, 0.1, 0.1, 0.0, 1e-3, 1e-4, 3)
    return st.Response(column, histories, measures, "dem2d", {"version": "0.1.0"})


def test_the_data_set_is_labelled_and_has_units():
    data = one_response().to_xarray()
    assert data.sizes == {"time": 3, "drum": 12, "joint": 12, "axis": 3}
    assert data["drum"].values.tolist() == list(range(1, 13))
    units = {"time": "s", "drum_x": "m", "drum_rotation": "rad", "ground_acceleration": "m s-2", "energy_input": "J"}
    for name, unit in units.items():
        assert data[name].attrs["units"] == unit
    assert {f"energy_{term}" for term in ENERGY_TERMS} <= set(data.data_vars)
    assert data.attrs["outcome"] == "rocked"
    assert data.attrs["peak_top_displacement_m"] == 0.1


def test_two_hundred_drums_fit_in_a_file(tmp_path):
    joint = st.Joint(5e10, 2.5e10, 35.0)
    column = st.Column.tapered(height=20.0, bottom_width=3.0, top_width=1.0, drums=200, density=2000.0, joint=joint)
    response = dataclasses.replace(one_response(column), provenance={"column": column.to_dict()})
    assert st.Response.load(response.save(tmp_path / "tall.nc")).column == column


def test_a_run_keeps_its_provenance(tmp_path):
    response = st.simulate(preset("paper-monolithic"), st.harmonic(1.0, 0.25 * st.g, 1.0), st.HousnerBlock())
    loaded = st.Response.load(response.save(tmp_path / "run.nc"))
    assert loaded.provenance == response.provenance
    assert loaded.measures.row() == response.measures.row()
    assert loaded.column == column_from_dict(response.provenance["column"]) == response.column
    assert loaded.summary() == response.summary()


def test_files_that_are_no_responses(tmp_path):
    with pytest.raises(st.InputError, match="there is no file"):
        st.Response.load(tmp_path / "none.nc")
    (tmp_path / "text.nc").write_text("no netCDF")
    with pytest.raises(st.InputError, match="cannot be read as netCDF"):
        st.Response.load(tmp_path / "text.nc")
    data = one_response().to_xarray()
    data.to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    with pytest.raises(st.InputError, match="is no result of this package"):
        st.Response.load(tmp_path / "other.nc")
    with pytest.raises(st.InputError, match="does not exist"):
        one_response().save(tmp_path / "none" / "response.nc")


def test_a_file_appears_whole_or_not_at_all(tmp_path):
    target = tmp_path / "file.txt"
    target.write_text("old")

    def break_off():
        with replacing(target) as partial:
            partial.write_text("half")
            raise RuntimeError("full disk")

    with pytest.raises(RuntimeError, match="full disk"):
        break_off()
    assert target.read_text() == "old"
    with replacing(target) as partial:
        partial.write_text("new")
    assert target.read_text() == "new"
    assert [path.name for path in tmp_path.iterdir()] == ["file.txt"]
