"""Quiet stretches of records that are not stepped: what must not change, and what is never left out."""

import warnings

import numpy as np
import pytest
from records import FOLDER, needs_folder

import stylobate as st
from stylobate.constants import g
from stylobate.errors import OutOfRangeWarning
from stylobate.models.base import Case
from stylobate.models.drums.runs import LaneRuns
from stylobate.models.shared.ground import LOOK, QUIET, QUIET_BEFORE, level, shaking, share_of
from stylobate.motion import harmonic
from stylobate.motion.motion import write_csv
from stylobate.probability.suite import suite_table
from stylobate.simulate import run_cases
from stylobate.verdicts.verdict import verdict

MODELS = [st.DistinctElement2D(), st.RigidBlock(), st.DistinctElement2D(stiffness_damping=1e-4), st.DistinctElement3D()]
SOFT = st.Joint(normal_stiffness=2e9, shear_stiffness=1e9, friction_coefficient=0.7)
COLUMN = st.Column.tapered(
    height=4.0, bottom_width=0.8, top_width=0.6, drums=3, density=2600.0, joint=SOFT, section="circular"
)


def shocks(*sizes, pause=8.0, last=None):
    """Pulses of one second [g], each after a pause; a record as far as its metadata say."""
    parts = [np.zeros(round(pause / 0.01))]
    for size in sizes:
        parts += [size * g * np.sin(2.0 * np.pi * np.arange(101) / 100.0), np.zeros(round(pause / 0.01))]
    return st.Motion(0.01, np.concatenate(parts), metadata={"format": "made for this test"})


def rows(motions, model, quiet, column=COLUMN, tail=0.0):
    cases = [Case(column, motion) for motion in motions]
    results = dict(run_cases(cases, model, tail=tail, quiet=quiet, threads=1))
    return [results[i].row() for i in range(len(cases))]


@pytest.mark.parametrize("model", MODELS, ids=["dem2d", "rigid-block", "damped", "dem3d"])
def test_a_run_in_pieces_has_the_bits_of_one_in_a_piece(model, monkeypatch):
    # A motion that is loud at once and whose column never counts as at rest is stepped as a whole, looked at in between.
    for block in (LaneRuns,):
        monkeypatch.setattr(block, "at_rest", lambda *_: False)
    motion = st.Motion(0.01, np.concatenate([shocks(0.5).samples[790:], np.zeros(300)]))
    whole, pieces = (rows([motion, motion.scaled(0.3)], model, quiet) for quiet in (0.0, QUIET))
    for whole_row, other in zip(whole, pieces, strict=True):
        assert other.pop("stepped_s") == other.pop("stepped_to_s") - other.pop("stepped_from_s")
        assert whole_row == other


@pytest.mark.parametrize("model", [st.DistinctElement2D(), st.DistinctElement3D()], ids=["dem2d", "dem3d"])
def test_shocks_with_quiet_between_them(model):
    # Zeros before, between and after the shocks: exactly nothing is left out, so peaks agree to what the quiet elastic
    # vibration of the joints changes, and a collapse is found at its time in the record.
    motions = [shocks(0.25, 0.1), shocks(0.1, 4.0)]
    whole, cut = (rows(motions, model, quiet) for quiet in (0.0, QUIET))
    assert [verdict(row) for row in whole] == [verdict(row) for row in cut] == ["stands", "collapsed"]
    assert cut[0]["peak_top_displacement_m"] == pytest.approx(whole[0]["peak_top_displacement_m"], rel=0.05)
    assert cut[1]["collapse_time_s"] == pytest.approx(whole[1]["collapse_time_s"], abs=0.1)
    assert cut[1]["collapse_time_s"] > 17.0
    for whole_row, other in zip(whole, cut, strict=True):
        assert other["stepped_from_s"] == pytest.approx(8.0 - QUIET_BEFORE, abs=0.1)
        assert other["steps"] * other["time_step_s"] == pytest.approx(other["stepped_s"], rel=1e-9)
        assert other["steps"] < (0.75 if whole_row["outcome"] != "collapsed" else 0.95) * whole_row["steps"]


def test_what_still_rocks_goes_on():
    # The pulse ends at 1 s and the column rocks on for seconds: it is stepped until it lies at rest, not to the pulse's end.
    motion = st.Motion(0.01, np.concatenate([shocks(0.27, pause=0.05).samples[:106], np.zeros(3000)]))
    [cut] = rows([motion], st.DistinctElement2D(), QUIET)
    [whole] = rows([motion], st.DistinctElement2D(), 0.0)
    assert 1.0 + 3.0 * LOOK < cut["stepped_to_s"] < 25.0
    assert cut["peak_top_displacement_m"] == whole["peak_top_displacement_m"]
    assert verdict(cut) == verdict(whole) == "stands"


def test_the_level_counts_every_component_and_sliding():
    a = np.array([0.0, 3.0, 0.0])
    flat = st.Motion(0.01, a)
    opens = COLUMN.uplift_acceleration
    assert level(flat, COLUMN)[1] == pytest.approx(3.0 / opens)
    assert level(flat.replace(ay=4.0 / 3.0 * a), COLUMN)[1] == pytest.approx(5.0 / opens)
    assert level(flat.replace(az=a, factor=-2.0), COLUMN)[1] == pytest.approx(6.0 / opens + 6.0 / 9.81)
    slippery = COLUMN.with_joint(friction_coefficient=0.05)
    assert slippery.moving_acceleration == pytest.approx(0.05 * 9.81)
    slab = st.Column.tapered(
        height=4.0, bottom_width=0.8, top_width=0.8, drums=1, density=2600.0, joint=SOFT, depth=0.2
    )
    assert slab.moving_acceleration == pytest.approx(0.25 * slab.uplift_acceleration)


def test_stretches_of_a_record():
    motion = shocks(0.3, 0.3, pause=10.0)
    stretches = shaking(motion, COLUMN, QUIET)
    assert stretches == pytest.approx(np.array([[10.0, 11.0], [21.0, 22.0]]), abs=0.05)
    faint = shaking(motion.scaled(1e-3), COLUMN, QUIET)  # below the share: its peak
    assert len(faint) >= 1
    assert 10.0 < faint[0][0] < faint[0][1] < 11.0


def test_only_records_are_cut(tmp_path):
    record, computed = shocks(0.3), harmonic(1.0, 0.3 * g, 10.0)
    assert share_of(record) == QUIET
    assert share_of(record, whole=True) == share_of(computed) == 0.0
    for motion in (record, computed):  # a file tells which it was
        assert share_of(st.read_motion(write_csv(motion, tmp_path / "motion.csv"))) == share_of(motion)


def test_python_and_batches_of_records_and_computed_motions_cut_each_as_a_run_of_it_alone():
    """The share was one for all motions of a call, and none in Python, where a command cut a record."""
    motions, model = [shocks(0.25), shocks(0.25).replace(metadata={})], st.DistinctElement2D()
    alone = [st.simulate(COLUMN, motion, model) for motion in motions]
    assert [response.measures.stepped is None for response in alone] == [False, True]
    tables = st.simulate_many(COLUMN, motions, model), suite_table(COLUMN, motions, model)
    for number, response in enumerate(alone):
        for table in tables:
            assert table["steps"][number] == response.measures.steps
            assert table["peak_top_displacement_m"][number] == response.measures.peak_top_displacement


@needs_folder
def test_the_verdicts_of_real_records_are_the_same():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutOfRangeWarning)
        motions = st.read_suite(FOLDER, "g").motions
        whole, cut = (suite_table(COLUMN, motions, st.DistinctElement2D(), whole=uncut) for uncut in (True, False))
    assert list(whole["verdict"]) == list(cut["verdict"])
    assert cut["steps"].sum() < whole["steps"].sum() / 1.6


def test_on_a_joint_without_friction_all_shaking_is_loud():
    """A layer of no friction slides under any push: the quiet there is where nothing shakes at all, and runs go on."""
    slippery = COLUMN.replace(links=[st.Layer(joint=1, friction_coefficient=0.0, shear_stiffness=1e6)])
    motion = shocks(0.001, 0.002)
    assert slippery.moving_acceleration == 0.0
    reached = level(motion, slippery)
    assert set(np.unique(reached)) == {0.0, np.inf}
    assert (np.isinf(reached) == (motion.samples != 0.0)).all()
    assert shaking(motion, slippery, QUIET) == pytest.approx(np.array([[8.0, 9.0], [17.01, 18.01]]), abs=0.02)
    assert not level(motion.scaled(0.0), slippery).any()


@pytest.mark.parametrize("model", [MODELS[0], MODELS[3]], ids=["dem2d", "dem3d"])
@pytest.mark.parametrize("size", [0.1, 4.0], ids=["stands", "collapses"])
def test_a_single_run_has_the_bits_of_the_batch_and_all_its_times(model, size, tmp_path):
    # Quiet before, between and behind two shocks: the column is recorded there too, as it lies. Two more ride along.
    motion = shocks(0.25, size)
    [batch] = rows([motion], model, QUIET)
    twins = (COLUMN, COLUMN.with_joint(friction_coefficient=0.6))
    single = st.simulate(COLUMN, motion, model, quiet=QUIET, twins=twins)
    row = single.measures.row()
    assert row == batch == single.twins[0].row()
    assert row["collapsed"] == (size == 4.0)
    assert row["stepped_s"] < 0.75 * single.time[-1]
    whole = st.simulate(COLUMN, motion, model, quiet=0.0)
    common = min(len(single.time), len(whole.time)) - 1  # a collapse ends a run between two recorded times
    assert (single.time[:common] == whole.time[:common]).all()
    if not single.collapsed:
        assert (single.time == whole.time).all()
    before = single.time < row["stepped_from_s"]
    behind = single.time > row["stepped_to_s"]
    assert single.time[before].max() > 6.9
    for stretch in (before, behind) if not single.collapsed else (before,):
        assert stretch.any()
        assert (np.diff(single.body_position[stretch], axis=0) == 0.0).all()
    assert (single.body_position[before] == whole.body_position[0]).all()
    single.save(tmp_path / "run.nc")
    again = st.Response.load(tmp_path / "run.nc")
    assert again.measures == single.measures
    assert again.provenance["quiet_share"] == QUIET


@pytest.mark.parametrize("model", [st.DistinctElement2D(), st.RigidBeam()], ids=["dem2d", "rigid-beam"])
def test_the_file_of_a_motion_is_the_motion_that_was_run(model, tmp_path):
    """To the last bit: the factor had been multiplied after the samples were interpolated, and columns are chaotic."""
    motion = shocks(0.27).scaled(1.0 / 0.7)
    again = st.read_motion(write_csv(motion, tmp_path / "motion.csv"))
    assert (again.factor, motion.factor) == (1.0, 1.0 / 0.7)
    original, other = (st.simulate(COLUMN, shaken, model) for shaken in (motion, again))
    assert original.measures == other.measures
    assert np.array_equal(original.body_position, other.body_position)
