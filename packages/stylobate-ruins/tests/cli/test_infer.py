"""``stylobate infer``: a ruin file in, a posterior out; what is no ruin is refused in a sentence."""

import json

import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate_ruins.ruin_files import read_ruin

COLUMN = """
name = "{name}"
section = "circular"
density = 2600.0
[tapered]
height = {height}
bottom_width = 0.8
top_width = 0.7
drums = 2
[joint]
normal_stiffness = 2e8
shear_stiffness = 2e8
friction_coefficient = 0.67
"""

RUIN = """
columns = ["low.toml", "high.toml"]
simulations = 300
seed = 1
{more}
[[observed]]
column = "low.toml"
state = "stands"
{low}
[[observed]]
column = "high"
state = "{high}"
{fell}
[prior]
pgv = {pgv}
period = [0.4, "1.5s"]
law = ["rim"]
stiffness_damping = [1e-4]
"""


@pytest.fixture
def ruin(tmp_path):
    def written(low="", high="stands", fell="", pgv="[0.1, 2.0]", more=""):
        for name, height in (("low", 3.0), ("high", 6.0)):
            (tmp_path / f"{name}.toml").write_text(COLUMN.format(name=name, height=height))
        file = tmp_path / "ruin.toml"
        file.write_text(RUIN.format(low=low, high=high, fell=fell, pgv=pgv, more=more))
        return file

    return written


def test_answer_and_its_files(ruin, tmp_path, capsys):
    out = tmp_path / "out"
    assert call(["infer", str(ruin(low="offsets = [[1, 0.002, 0.001, 0.003]]")), "--out", str(out), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert set(answer["posterior"]) == {"pgv_m_s", "pga_g", "period_s", "azimuth_deg"}
    for posterior in answer["posterior"].values():
        assert posterior["low"] <= posterior["median"] <= posterior["high"]
    assert answer["simulations"] + answer["failed"] == 300
    assert 100 <= answer["accepted"] <= answer["matching"]
    assert answer["informative"] is True
    assert (
        answer["posterior"]["pgv_m_s"]["high"] < 1.9
    )  # what stands with 2 mm was not shaken by the largest of the prior
    for name in (
        "infer.json",
        "infer.png",
        "matches.png",
        "observations.csv",
        "draws.csv",
        "simulations.npz",
        "runs.sqlite",
    ):
        assert (out / name).is_file(), name
    # another question to the same table: no run is made
    before = (out / "runs.sqlite").stat().st_mtime_ns
    assert call(["infer", str(ruin(low="no_slip_above = 0.02")), "--out", str(out), "--no-pictures"]) == 0
    assert "peak ground velocity" in capsys.readouterr().out
    assert (out / "runs.sqlite").stat().st_mtime_ns == before
    assert call(["report", str(out), "--out", str(tmp_path / "report.html")]) == 0


def test_survival_is_one_more_observation(ruin, tmp_path, capsys):
    # The earthquake is one of a hazard that falls steeply: weaker ones are more likely than the even prior says.
    (tmp_path / "hazard.csv").write_text("pgv_m_s,annual_rate\n0.02,0.2\n0.2,0.002\n2.0,2e-5\n")
    out, file = tmp_path / "out", ruin()
    medians = []
    for more in ("", '[survival]\nhazard = "hazard.csv"\nsince = -300\nearthquake = [200, 700]\nuntil = 2020\n'):
        file.write_text(file.read_text() + more)
        assert call(["infer", str(file), "--out", str(out), "--json"]) == 0
        answer = json.loads(capsys.readouterr().out)
        medians.append(answer["posterior"]["pgv_m_s"]["median"])
    assert medians[1] < medians[0]
    survival = answer["survival"]
    assert 200 <= survival["earthquake"]["low"] <= survival["earthquake"]["high"] <= 700
    assert 0.0 < survival["chance"] < 1.0
    assert answer["observations"][-1]["observation"] == answer["checks"][-1]["observation"] == "survival since -300"
    assert "outlasts all other shaking from -300 to 2020" in answer["sentence"]
    assert call(["report", str(out), "--out", str(tmp_path / "report.html")]) == 0
    assert "Year of the earthquake" in (tmp_path / "report.html").read_text()


def test_joints_in_their_places_are_not_odd(ruin, capsys):
    # 0 ± 3 mm of each joint: less than errors alone would mostly make of it, and what a survey writes that saw nothing move.
    offsets = "offsets = [[1, 0.0, 0.0, 0.003], [2, 0.0, 0.0, 0.003]]"
    assert call(["infer", str(ruin(low=offsets, pgv="[0.05, 1.0]")), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["consistent"], answer["checks"]


@pytest.mark.parametrize(
    ("given", "varies"), [("friction = 0.1\noffset = 0.01", {"friction": 0.1, "offset": 0.01}), ("", {})]
)
def test_a_scatter_of_the_prior_is_all_that_varies_of_the_columns(ruin, given, varies):
    file = ruin()
    file.write_text(file.read_text() + f"[prior.scatter]\n{given}\n")
    with pytest.warns(st.OutOfRangeWarning, match="closure of joint"):  # of the soft joints of these columns
        prior = read_ruin(file).prior
    assert prior.scatter.given == varies


def test_laws_are_drawn_by_the_prior_and_not_by_its_scatter(ruin, capsys):
    file = ruin()
    file.write_text(file.read_text() + "[prior.scatter]\nlaw = 0.5\n")
    assert call(["infer", str(file)]) == 2
    assert "unknown key 'law' in [prior.scatter]" in capsys.readouterr().err
    with pytest.raises(st.InputError, match="varies law, which a prior draws itself"):
        st.Prior(pgv=(0.1, 1.0), period=(0.4, 1.5), scatter=st.Scatter(law=0.5))


def test_nothing_seen_leaves_the_prior(ruin, capsys):
    file = ruin(high="unknown")
    file.write_text(file.read_text().replace('state = "stands"', 'state = "fell before"'))
    assert call(["infer", str(file), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["informative"] is False
    assert answer["accepted"] == answer["simulations"] == 300
    assert "do not tell PGV" in answer["sentence"]


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"high": "fell", "fell": "offsets = [[1, 0.01, 0.0, 0.002]]"}, "what fell has none"),
        ({"fell": "fell_towards = 30"}, "leave it out, or give state"),
        (
            {"high": "fell", "fell": "fell_towards = 30"},
            "without towards_sd; give both, such as fell_towards = 200 and",
        ),
        ({"high": "fell", "fell": "towards_sd = 15"}, "without fell_towards; give both, such as"),
        ({"low": "offsets = [[3, 0.01, 0.0, 0.002]]"}, "'low' has 2 joints"),
        ({"low": "offsets = [[1, 0.01, 0.0]]"}, "joint, x, y and sd"),
        ({"low": "offsets = [[1, 0.01, 0.0, 0.0]]"}, "allowed is \\(0"),
        ({"low": "offsets = [[1, 20, 3, 1]]"}, "offsets are in metres"),
        ({"low": "offsets = [[1, 0.05, 0.0, 0.001]]\nno_slip_above = 0.01"}, "one of the two is wrong"),
        ({"low": "largest_slip = [0.01, 0.002]\noffsets = [[1, 0.05, 0.0, 0.001]]"}, "largest_slip is 10 mm; one of"),
        (
            {"low": "largest_slip = [0.03, 0.002]\nno_slip_above = 0.01"},
            "no_slip_above is 10 mm; one of the two is wrong",
        ),
        ({"low": "largest_slip = [0.03]"}, "a length and its sd"),
        ({"low": "largest_slip = [30, 1]"}, "offsets are in metres"),
        ({"high": "fell", "fell": "largest_slip = [0.01, 0.002]"}, "what fell has none"),
        ({"high": "fell", "fell": "no_slip_above = 0.0"}, "what fell has none"),
        ({"low": "twist = [[1, 2.0, 1.0]]"}, "unknown key 'twist'"),
        ({"high": "leans"}, "allowed are stands, fell"),
        ({"more": "[survival]\nhazard = 'none.csv'\nsince = 1200\nuntil = 2020"}, "none.csv"),
        ({"more": "[survival]\nhazard = 'none.csv'\nuntil = 2020"}, "neither since nor earthquake"),
        ({"more": 'model = "dem2d"'}, "ruins have directions"),
        ({"more": "set = {law = 'bed'}"}, "is drawn with the motions"),
        ({"more": "set = {losses = 'stone'}"}, "losses is drawn with the motions"),
        (
            {"high": "fell", "pgv": "[0.01, 0.02]"},
            "none of 300 simulations leaves all that is seen.*'high fell'.*nearest are",
        ),
        ({"low": "no_slip_above = 0.000001", "pgv": "[0.3, 2.0]"}, "and 100 are needed; raise simulations to about"),
    ],
)
def test_what_is_no_ruin_is_refused(ruin, tmp_path, capsys, fields, message):
    import re

    out = tmp_path / "out"
    assert call(["infer", str(ruin(**fields)), "--out", str(out)]) == 2
    stderr = capsys.readouterr().err
    assert re.search(message, stderr), stderr
    assert not (out / "infer.json").exists()
