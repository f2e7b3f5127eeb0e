"""Curves of analyses as the page draws them: plateaus where records fall, shares, and the lognormal curve."""

import json
import math

import pytest

from stylobate.app.curves import curves


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
    found = curves(tmp_path)["ida"]
    assert found["right"] == pytest.approx(1.25 * 0.4)
    fell, stood = found["records"]
    assert fell == {"name": "a <b>", "x": [0.0, 0.2, 0.2, 0.5], "y": [0.0, 0.2, 0.4, 0.4]}
    assert stood == {"name": "c", "x": [0.0, 0.4], "y": [0.0, 0.4]}
    assert found["shares"]["16"] == {"x": [0.0, 0.1], "y": [0.0, 0.1]}
    assert found["shares"]["84"] == {"x": [0.0, 0.5], "y": [0.0, 0.1]}  # up to the plateau
    assert found["words"] == "peak ground velocity [m/s]"


def test_the_curve_is_a_half_at_its_median(tmp_path):
    place = tmp_path / "fragility"
    place.mkdir()
    said = {"median": 0.6, "beta": 0.5, "median_low": 0.4, "median_high": math.inf, "state": "collapse", "im": "pga"}
    said["points"] = [{"im": 0.5, "share": 0.3, "low": 0.1, "high": None}]
    (place / "fragility.json").write_text(json.dumps(said).replace("Infinity", "null"))
    found = curves(tmp_path)["fragility"]
    below = [y for x, y in zip(found["x"], found["y"]) if x < 0.6]
    assert max(below) < 0.5 < min(y for x, y in zip(found["x"], found["y"]) if x > 0.6)
    assert found["y"] == sorted(found["y"])
    assert (found["median"], found["points"]) == ([0.4, None], [[0.5, 0.3, 0.1, None]])
    (place / "fragility.json").write_text(json.dumps(said | {"median": None, "median_high": None}))
    assert curves(tmp_path)["fragility"]["x"] == []
