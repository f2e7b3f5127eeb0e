"""Residuals with their directions: by hand, of every model, of a row as of its histories, and of files from before."""

import json
import math

import numpy as np
import pytest

import stylobate as st
from stylobate import store
from stylobate.response.recorded import to_dataset
from stylobate.response.residuals import NAMES, Residuals, residuals_of
from stylobate.response.rows import Rows

SLIPPERY = st.Joint(5e8, 2.5e8, 20.0)
COLUMN = st.Column.tapered(height=3.0, bottom_width=0.8, top_width=0.6, drums=2, density=2000.0, joint=SLIPPERY)
BLOCK = st.Column.tapered(height=2.0, bottom_width=0.5, top_width=0.5, drums=1, density=2000.0, joint=SLIPPERY)
ALONG = st.harmonic(1.5, 0.35 * st.g, 1.0)


def test_in_space_by_hand():
    """One joint slid 0.5 m; bodies lean 0.1 rad towards y, stand on their heads, and not at all."""
    up = np.array([[0.0, math.sin(0.1), math.cos(0.1)], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
    residuals = Residuals.in_space(np.array([[0.3, -0.4]]), np.array([0.2]), np.eye(3), up)
    row = residuals.row()
    assert row["residual_slip_per_joint_m"] == pytest.approx([0.5])
    assert (row["residual_slip_x_m"], row["residual_slip_y_m"], row["residual_twist_rad"]) == ([0.3], [-0.4], [0.2])
    assert row["residual_displacement_z_m"] == [0.0, 0.0, 1.0]
    assert row["residual_tilt_x_rad"] == pytest.approx([0.0, math.pi, 0.0])
    assert row["residual_tilt_y_rad"] == pytest.approx([0.1, 0.0, 0.0])
    json.dumps(row, allow_nan=False)


def test_in_the_plane_by_hand():
    """A turn to the left, towards -x, of a quarter beyond half a turn is one to the right; nothing is told across."""
    residuals = Residuals.in_plane(np.array([-0.1]), np.array([0.2]), np.array([0.0]), np.array([1.25 * math.pi]))
    assert residuals.tilt_x == pytest.approx((0.75 * math.pi,))
    assert residuals.slips == (0.1,)
    assert set(residuals.row()) == {NAMES[name] for name in ("slip_x", "moved_x", "moved_z", "tilt_x")}


@pytest.mark.parametrize(
    ("column", "model"),
    [
        (COLUMN, st.DistinctElement2D()),
        (COLUMN, st.RigidBlock()),
        (COLUMN, st.RigidBeam()),
        (BLOCK, st.HousnerBlock()),
        (COLUMN, st.DistinctElement3D()),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_the_row_of_every_model_tells_what_its_histories_end_with(column, model):
    response = st.simulate(column, ALONG, model)
    measures, seen = response.measures.row(), residuals_of(column, response.histories).row()
    assert seen.keys() == {name for name in measures if name in seen}
    for name, values in seen.items():
        np.testing.assert_allclose(measures[name], values, atol=1e-12)
        assert response.summary()[name] == measures[name] or response.collapsed
    assert "collapse_azimuth_deg" in measures
    row = st.simulate_many(column, [ALONG], model).iloc[0]
    exact = 0.0 if model.name != "housner" else 1e-4  # whose single runs choose their steps
    for name in seen:
        np.testing.assert_allclose(row[name], measures[name], atol=exact)


def test_a_drum_pushed_aside_slips_and_leans_where_it_is_pushed():
    """Ground that goes to the left and stops leaves what slides on it to the right; in space along the same azimuth."""
    motion = st.Motion(0.01, np.r_[np.full(30, -6.0), np.full(90, 2.0)])
    low = st.Column.tapered(height=0.3, bottom_width=0.8, top_width=0.8, drums=1, density=2000.0, joint=SLIPPERY)
    plane = st.simulate(low, motion, st.DistinctElement2D()).measures.row()
    assert plane["residual_slip_x_m"][0] > 0.02
    assert plane["residual_slip_x_m"] == pytest.approx(plane["residual_displacement_x_m"], abs=1e-5)
    turned = st.motion.rotated(st.Motion(motion.dt, motion.samples, np.zeros(motion.steps)), -40.0)
    space = st.simulate(low, turned, st.DistinctElement3D()).measures.row()
    azimuth = math.atan2(space["residual_slip_y_m"][0], space["residual_slip_x_m"][0])
    pushed = math.atan2(-turned.lateral[5], -turned.acceleration[5])
    assert azimuth == pytest.approx(pushed, abs=1e-3)
    assert space["residual_slip_per_joint_m"] == pytest.approx(plane["residual_slip_x_m"], rel=0.05)


def test_assemblies_tell_joints_and_bodies_that_can_move():
    ground = st.Block([[-2.0, -0.5], [2.0, -0.5], [2.0, 0.0], [-2.0, 0.0]], 2000.0, name="rock", fixed=True)
    stone = st.Block([[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]], 2000.0, name="stone")
    response = st.simulate(st.Assembly((ground, stone), SLIPPERY), ALONG, st.DistinctElement2D())
    row, summary = response.measures.row(), response.summary()
    assert len(row["residual_slip_x_m"]) == response.slip.shape[1] == 2
    assert row["residual_displacement_x_m"] == [row["bodies"]["stone"]["displacement_at_end_m"][0]]
    assert row["residual_slip_x_m"] == pytest.approx([0.0, *row["residual_displacement_x_m"]], abs=1e-2)
    assert summary["residual_tilt_x_rad"] == row["residual_tilt_x_rad"]
    assert residuals_of(response.structure, response.histories) == response.residuals


def test_a_file_of_before_has_its_residuals_from_its_histories(tmp_path):
    """As the version before wrote it: no residuals of their own, those of joints among the measures in space."""
    response = st.simulate(COLUMN, ALONG, st.DistinctElement3D())
    data = to_dataset(response, derived=False)
    facts = store.from_json(data, "facts")
    residuals = facts.pop("residuals")
    facts["space"] |= {"residual_slip_x": residuals["slip_x"], "residual_slip_y": residuals["slip_y"]}
    facts["space"] |= {"residual_slip_per_joint": [0.0, 0.0], "residual_twist_per_joint": residuals["twist"]}
    data["facts"] = ((), store.as_json(facts))
    path = tmp_path / "old.nc"
    store.write(data, "response", path)
    loaded = st.load_response(path)
    assert loaded.residuals.slip_x == response.residuals.slip_x
    np.testing.assert_allclose(loaded.residuals.tilt_x, response.residuals.tilt_x, atol=1e-12)
    assert loaded.peak_twist == response.peak_twist


def test_rows_of_before_and_of_now_are_one_table():
    """A ledger that was begun without these names is read; what it does not hold is empty."""
    now = st.simulate(COLUMN, ALONG, st.DistinctElement2D()).measures.row()
    before = {name: value for name, value in now.items() if name not in set(NAMES.values()) | {"collapse_azimuth_deg"}}
    table = Rows.of([before, now]).table()
    assert table["residual_slip_x_m"].tolist() == [None, now["residual_slip_x_m"]]
    assert table["peak_rotation_rad"].nunique() == 1


@pytest.mark.parametrize("model", [st.HousnerBlock(initial_rotation=0.05), st.RigidBeam(initial_rotation=0.05)])
def test_residuals_of_what_was_let_go_tilted_are_from_there(model):
    """A pose at the start is how it stood: what falls back upright has moved by what it leaned."""
    rest = st.Motion(0.01, np.zeros(3001))
    column = BLOCK if model.name == "housner" else COLUMN
    response = st.simulate(column, rest, model)
    assert response.residuals.moved_x[-1] == pytest.approx(response.histories.drum_x[-1, -1], abs=1e-12)
    if column is BLOCK:  # drums may lean to either side of one another
        assert response.histories.top_displacement[-1] * response.residuals.moved_x[-1] > 0.0
