"""Files of assembly responses: what is saved is loaded back without loss."""

import dataclasses
import warnings

import numpy as np
import pytest
from hypothesis import given, settings, strategies

import stylobate as st
from stylobate.column.catalogue import preset
from stylobate.column.standing import of_column
from stylobate.response import Measures, Response, load_response
from stylobate.response.assemblies import recorded_blocks

RECORDED = ("time", "x", "z", "rotation", "joint_opening", "joint_slip", "ground_acceleration", "ground_displacement")
NUMBERS = strategies.floats(allow_nan=True, allow_infinity=True)


@strategies.composite
def joints(draw):
    form = draw(strategies.sampled_from(["friction_angle", "friction_coefficient"]))
    value = draw(strategies.floats(0.01, 1.5)) * (50.0 if form == "friction_angle" else 1.0)
    return st.Joint(draw(strategies.floats(1e6, 1e12)), draw(strategies.floats(1e6, 1e12)), **{form: value})


@strategies.composite
def assemblies(draw):
    """A stack of convex blocks, some with a law of their own, on a ground or on a fixed block."""
    if draw(strategies.integers(0, 4)) == 0:
        return of_column(preset("paper-12-drums"))
    blocks, z = [], 0.0
    for i in range(draw(strategies.integers(1, 4))):
        height, width, lean = (draw(strategies.floats(0.1, 3.0)) for _ in range(3))
        corners = [(-width, z), (width, z), (width + 0.1 * lean, z + height), (-width, z + height)]
        blocks.append(
            st.Block(
                tuple(corners),
                draw(strategies.floats(1.0, 5000.0)),
                draw(strategies.sampled_from(["stone", "Säule ⌀", "a'\"b", "null"])) + f" {i}",
                draw(strategies.floats(0.1, 2.0)),
                fixed=i == 0 and draw(strategies.booleans()) and len(blocks) > 0,
                surface=draw(strategies.none() | joints()),
            )
        )
        z += height
    overrides = [("ground", blocks[0].name, draw(joints()))] if draw(strategies.booleans()) else []
    return st.Assembly(
        tuple(blocks),
        draw(joints()),
        draw(strategies.text("abcδ №1", min_size=1, max_size=8).filter(str.strip)),
        draw(strategies.just(0.0) | strategies.floats(0.01, 20.0)),
        0.0,
        tuple(overrides),
    )


@strategies.composite
def responses(draw):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assembly = draw(assemblies())
    steps, n = draw(strategies.integers(1, 4)), len(assembly.bodies)
    random = np.random.default_rng(draw(strategies.integers(0, 2**32)))
    special = draw(NUMBERS)

    def array(*shape):
        values = random.standard_normal(shape) * 10.0 ** random.integers(-300, 300)
        values.flat[0] = special
        return values

    terms = draw(strategies.sets(strategies.sampled_from(["input", "kinetic", "gravitational", "elastic"]), min_size=1))
    response = Response.of(recorded_blocks(
        assembly=assembly,
        time=np.arange(steps) * 0.01,
        **{name: array(steps, n) for name in ("x", "z", "rotation")},
        energy={term: array(steps) for term in terms},
        **{name: array(steps) for name in ("ground_acceleration", "ground_displacement")},
        at_rest=draw(strategies.booleans()),
        failed=draw(strategies.booleans()),
        energy_imbalance=draw(NUMBERS),
        time_step=draw(strategies.floats(1e-9, 1.0)),
        steps=draw(strategies.integers(0, 2**60)),
        in_equilibrium=draw(strategies.none() | strategies.booleans()),
        model="dem2d",
        provenance={"version": "0.1.0", "parameters": {"points": 2, "restitution": None},
                    "share": draw(strategies.floats(0, 1))},
    ))  # fmt: skip
    return dataclasses.replace(response, wall_time=draw(strategies.floats(0, 1e6)))


@settings(max_examples=25, deadline=None)
@given(response=responses())
@pytest.mark.filterwarnings("ignore:invalid value encountered", "ignore:overflow encountered")
def test_a_saved_response_is_loaded_without_loss(response, tmp_path_factory):
    path = response.save(tmp_path_factory.getbasetemp() / "assembly.nc")
    loaded = load_response(path)
    assert loaded.assembly == response.assembly
    assert loaded.assembly.digest == response.assembly.digest
    for name in RECORDED:
        np.testing.assert_array_equal(getattr(loaded, name), getattr(response, name), err_msg=name)
    assert set(loaded.energy) == set(response.energy)
    for term, values in response.energy.items():
        np.testing.assert_array_equal(loaded.energy[term], values, err_msg=term)
    for field in dataclasses.fields(Measures):
        got, put = getattr(loaded.measures, field.name), getattr(response.measures, field.name)
        assert repr(got) == repr(put), field.name  # NaN is NaN
    assert loaded.provenance == response.provenance
    assert (loaded.model, loaded.wall_time, loaded.followed) == (response.model, response.wall_time, True)


def test_a_run_is_read_back_and_tells_the_same(tmp_path):
    square = st.Block(((0, 0), (1, 0), (1, 1), (0, 1)), 2000.0, "stone")
    assembly = st.Assembly((square,), st.Joint(1e9, 5e8, friction_angle=30.0))
    response = st.simulate(assembly, st.harmonic(2.0, 0.7 * st.g, 0.5), st.DistinctElement2D(), until_rest=True)
    loaded = Response.load(response.save(tmp_path / "run.nc"))
    assert loaded.provenance == response.provenance
    assert loaded.summary() == response.summary()
    assert loaded.describe() == response.describe()
    np.testing.assert_array_equal(loaded.outline(-1, 1), response.outline(-1, 1))


def test_four_hundred_blocks_fit_in_a_file(tmp_path):
    corners = [(1.5 * i, 0.0) for i in range(400)]
    blocks = tuple(
        st.Block(((x, z), (x + 1, z), (x + 1, z + 1), (x, z + 1)), 2e3, f"b{i}") for i, (x, z) in enumerate(corners)
    )
    assembly = st.Assembly(blocks, st.Joint(1e9, 5e8, 35.0))
    n, zero = len(assembly.bodies), np.zeros(1)
    x, z, rotation = np.zeros((3, 1, n))
    still = Response.of(recorded_blocks(
        assembly, zero, x, z, rotation, {"input": zero}, zero, zero, at_rest=True, failed=False, in_equilibrium=True,
        energy_imbalance=0.0, time_step=1e-3, steps=1, model="dem2d", provenance={},
    ))  # fmt: skip
    assert Response.load(still.save(tmp_path / "many.nc")).assembly == assembly
