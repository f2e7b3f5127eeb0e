"""What the host does for a graphics card, with a card that computes nothing; and the command that measures one."""

import importlib.util
from pathlib import Path
from threading import Lock

import numpy as np
import pytest
from idle_card import IdleCard

import stylobate as st
from stylobate.column.scatter import twins_of
from stylobate.models.base import Case, RunOptions
from stylobate.models.engine import engine_for
from stylobate.models.shared.lanes import run_lanes
from stylobate_gpu import card_check, driver
from stylobate_gpu import lanes as lanes

COLUMN = st.Column.tapered(
    height=3.0, bottom_width=0.6, top_width=0.5, drums=3, density=2400.0,
    joint=st.Joint(normal_stiffness=5e8, shear_stiffness=2.5e8, friction_angle=30.0),
)  # fmt: skip


def test_every_lane_of_wide_blocks_has_the_run_that_was_put_there(monkeypatch):
    # more runs than lanes, of columns with steps of their own, and of motions of different lengths
    monkeypatch.setattr(lanes, "WIDE", 48)
    model, options = st.DistinctElement2D(), RunOptions()
    columns = twins_of(COLUMN, st.Scatter(density=0.1), 150, seed=1)
    cases = [
        Case(column, st.harmonic(frequency=2.0, amplitude=0.1, duration=0.2 + 0.1 * (k % 3)))
        for k, column in enumerate(columns)
    ]

    def block(*width):
        return engine_for(model, COLUMN).block(options, *width)

    measures = dict(run_lanes(lambda: lanes.CardLanes(IdleCard(8), "plane", block, len(cases), Lock()), cases, 1))
    assert sorted(measures) == list(range(len(cases)))
    for number, case in enumerate(cases):
        assert measures[number].steps * measures[number].time_step == pytest.approx(case.motion.duration, rel=1e-9)
        assert measures[number].time_step <= engine_for(model, case.column).step
        assert measures[number].computed_by == "gpu (idle)"
        assert measures[number].residual_top_displacement == pytest.approx(0.0, abs=1e-12)  # rounding of a place of 3 m


def test_the_figures_of_a_card_are_measured_without_one(monkeypatch, tmp_path):
    place = Path(__file__).parents[4] / "benchmarks" / "card.py"
    spec = importlib.util.spec_from_file_location("figures_of_a_card", place)
    assert spec is not None
    assert spec.loader is not None
    figures = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(figures)
    idle = IdleCard(2)
    monkeypatch.setattr(driver, "the_card", lambda: idle)
    monkeypatch.setattr(card_check, "check", lambda *_: None)
    results: dict = {}
    figures.measure("plane", 60.0, 0, True, results.update, tmp_path)
    (first, *_) = results.values()
    assert first["by"] == ["gpu (idle)"]
    assert np.isfinite(first["runs_per_s"])
