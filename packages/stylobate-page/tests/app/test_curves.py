"""Curves of analyses as the page draws them: plateaus where records fall, shares, and the lognormal curve."""

import json

import numpy as np
import pytest

from stylobate import HousnerBlock, evidence, fragility, harmonic, ida, preset
from stylobate_page.curves import curves
from stylobate_page.worker import growing


def test_what_is_not_computed_is_left_out(tmp_path):
    assert curves(tmp_path) == {}


def test_a_record_ends_in_a_plateau_where_it_falls(tmp_path):
    """Between the last level that it stands and the first that brings it down, in proportion; in base widths."""
    place = tmp_path / "result"
    place.mkdir()
    head = "record,realisation,level,base_width_m,peak_top_displacement_m,verdict"
    rows = ["a <b>,0,0.2,0.5,0.1,stands", "a <b>,0,0.8,0.5,3.0,collapsed", "c,0,0.4,0.5,-0.2,stands"]
    (place / "runs.csv").write_text("\n".join([head, *rows]))
    (place / "capacities.csv").write_text("record,realisation,stands_until,collapses_from\na <b>,0,0.2,0.8\nc,0,0.4,\n")
    (place / "fractiles.csv").write_text("im,edp_16,edp_50,edp_84\n0.1,0.05,0.1,inf\n0.2,,0.2,inf\n")
    (place / "ida.json").write_text(json.dumps({"im": "pgv", "unit": "m/s"}))
    ida_plot = curves(tmp_path)["ida"]
    assert ida_plot["right"] == pytest.approx(1.25 * 0.4)
    fell, stood = ida_plot["records"]
    assert fell == {"name": "a <b>", "x": [0.0, 0.2, 0.2, 0.5], "y": [0.0, 0.2, 0.4, 0.4]}
    assert stood == {"name": "c", "x": [0.0, 0.4], "y": [0.0, 0.4]}
    assert ida_plot["shares"]["16"] == {"x": [0.0, 0.1], "y": [0.0, 0.1]}
    assert ida_plot["shares"]["84"] == {"x": [0.0, 0.5], "y": [0.0, 0.1]}  # up to the plateau
    assert ida_plot["words"] == "peak ground velocity [m/s]"


def test_points_grow_while_an_analysis_runs_and_end_as_a_curve_in_its_band(tmp_path, monkeypatch):
    """As the process of jobs does it: the last points, of all runs, are those of the fragility."""
    monkeypatch.setattr("stylobate_page.worker.LOOK", 0.0)
    column, updates = preset("paper-monolithic"), []
    motions = [harmonic(0.5 + 0.1 * k, 4.0, 2.0) for k in range(10)]
    watch = growing(
        "job", "top:0.35d", lambda **message: updates.append((message, curves(tmp_path)["growing"]["points"]))
    )
    monkeypatch.chdir(tmp_path)
    analysis = ida(column, motions, HousnerBlock(), runs=4, watch=watch)
    assert [message for message, _ in updates] == 40 * [{"id": "job", "grown": True}]
    known = [max((point[4] for point in points), default=0) for _, points in updates]
    assert known[0] < known[-1] == 10
    fitted = fragility(evidence(analysis, state="top:0.35d"), samples=50)
    (tmp_path / "fragility").mkdir()
    (tmp_path / "fragility" / "fragility.json").write_text(json.dumps(fitted.summary()))
    shown = curves(tmp_path)
    assert "growing" not in shown
    shown = shown["fragility"]
    assert shown["points"] == updates[-1][1]
    assert (shown["state"], shown["words"]) == ("top:0.35d", "peak ground velocity [m/s]")
    im, at, low, high = (np.array(shown["curve"][name]) for name in ("im", "probability", "low", "high"))
    assert ((low <= at) & (at <= high)).all()
    assert np.interp(fitted.median, im, at) == pytest.approx(0.5, abs=0.02)  # straight between eighty points
