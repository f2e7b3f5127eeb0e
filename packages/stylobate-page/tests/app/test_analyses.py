"""Analyses on the page: the command line and the files of each, and what is refused; ruins among them."""

import json
import tomllib

import pytest
from page_server import HAZARD, RUNS, ended

from stylobate.cli.main import call, parameters
from stylobate.response.measures import BlockMeasures, SpaceMeasures, measures_of
from stylobate_page.forms import FORMS

RUIN = """
columns = ["column.toml"]
simulations = 200
[[observed]]
column = "column.toml"
state = "stands"
[prior]
pgv = [0.1, 1.0]
period = [0.4, 1.4]
"""


@pytest.fixture
def wanted(table):
    drums = [{name: value for name, value in drum.items() if name != "depth"} for drum in table["drum"]]
    return {
        "kind": "infer",
        "column": table | {"section": "circular", "drum": drums},
        "ruin": RUIN,
        "page": {"ruin": RUIN},
    }


def test_a_ruin_is_a_job_with_its_files(fresh, wanted, tmp_path):
    made = fresh.post("/api/jobs", json=wanted)
    assert made.status_code == 201, made.text
    job = ended(fresh, made.json()["id"])
    assert job["commands"] == ["stylobate infer ruin.toml --out=result"]
    assert {"column.toml", "ruin.toml"} <= set(job["files"])
    kept = (tmp_path / "jobs" / job["id"] / "ruin.toml").read_text()
    assert tomllib.loads(kept) == tomllib.loads(RUIN)
    assert job["title"].endswith(" · ruin")


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ('columns = ["column.toml"]', 'columns = ["/etc/hosts"]', "the page has column.toml"),
        ("[prior]", '[prior]\nrecords = "/etc"', "names records"),
        ("[prior]", '[survival]\nhazard = "/etc/hosts"\nuntil = 2020\nsince = 1000\n[prior]', "names a hazard curve"),
        ("simulations = 200", "simulations = 50000", "takes up to 20000"),
        ('"stands"', '"leans"', "leans"),
        ("columns", "colums", "did you mean"),
        (RUIN, "", "0 characters"),
    ],
)
def test_what_is_no_ruin_is_said_at_its_field(fresh, wanted, old, new, why):
    refused = fresh.post("/api/jobs", json=wanted | {"ruin": RUIN.replace(old, new)})
    assert refused.status_code == 422
    assert why in refused.json()["error"]
    assert refused.json()["field"].partition(".")[0] == "ruin"
    assert "/tmp" not in refused.json()["error"]


#: The motion of a job, and hazard curves by the names of their files.
SINE = "--harmonic=1Hz,0.3g,2s"
HAZARDS = {"site A.csv": HAZARD}


@pytest.mark.parametrize(
    ("kind", "more", "line"),
    [
        (
            "directions",
            {"options": {"azimuths": "0:330:12", "model": "dem3d"}},
            f"run column.toml --model=dem3d {SINE} --azimuths=0:330:12 --no-pictures --tail=1s",
        ),
        (
            "compare",
            {"options": {"models": "dem2d,housner"}},
            f"compare column.toml {SINE} --models=dem2d,housner --tail=1s",
        ),
        (
            "sequence",
            {"options": {"repeat": "2", "rest": "5", "unit": "g"}},
            f"sequence column.toml --model=dem2d --set=points=2 {SINE} --repeat=2 --rest=5s",
        ),
        (
            "sequence",
            {"options": {"unit": "g"}, "records": ["sample:el-centro-1940", "sample:waipukurau-2018"]},
            "sequence column.toml --model=dem2d --set=points=2 --motion=sample:el-centro-1940 "
            "--motion=sample:waipukurau-2018 --repeat=2 --rest=30s --unit=g",
        ),
        (
            "risk",
            {"table": RUNS, "hazards": HAZARDS, "options": {"im": " pgv ", "state": "top:1d"}},
            "risk opened-table.csv '--hazard=hazards/site A.csv' --state=top:1d --im=pgv",
        ),
        (
            "survival",
            {"table": RUNS, "hazards": {"../../a.csv": "", ".b": ""}, "options": {"age": "2400"}},
            "survival opened-table.csv --hazard=hazards/_.._a.csv --hazard=hazards/b --age=2400y --state=collapse",
        ),
        (
            "modes",
            {"options": {"measured": "12Hz±3%", "ground": "rigid", "model": "dem2d"}},
            "modes column.toml --model=dem2d --set=points=2 --number=3 '--measured=12Hz±3%' --ground=rigid",
        ),
    ],
)
def test_an_analysis_is_a_command_line(fresh, run_request, kind, more, line):
    run_request = run_request | {"kind": kind, "settings": {"points": "2"}, "tail": "1s"} | more
    run_request["motion"] = run_request["motion"] | ({"azimuth": "45deg"} if kind == "directions" else {})
    made = fresh.post("/api/jobs", json=run_request)
    assert made.status_code == 201, made.text
    job = ended(fresh, made.json()["id"])
    assert job["commands"] == [f"stylobate {line} --out=result"]
    assert all((file in job["files"]) == (file in line) for file in ("column.toml", "opened-table.csv"))
    assert all(file in line for file in job["files"] if file.startswith("hazards/"))


@pytest.mark.parametrize(
    ("change", "why", "field"),
    [
        ({"options": {"out": "/tmp/x"}}, "has no field 'out'", None),
        (
            {"kind": "directions", "options": {"azimuths": " "}},
            "“Directions [°]” is empty; give it, such as 0:330",
            "azimuths",
        ),
        ({"hazards": {}}, "0 hazard curves are open; risk takes one", "hazard"),
        ({"hazards": {"a.csv": "", "b.csv": ""}}, "2 hazard curves are open", "hazard"),
        (
            {"kind": "survival", "hazards": {"a/b.csv": "", "a_b.csv": ""}},
            "two hazard curves are called 'a_b.csv'",
            "hazard",
        ),
        ({"table": None}, "no fragility is chosen", "source"),
        ({"table": None, "source": "../x"}, "no fragility is chosen", "source"),
        ({"kind": "compare", "motion": None}, "there is no motion", None),
    ],
    ids=str,
)
def test_an_analysis_that_lacks_something_is_refused(fresh, run_request, change, why, field):
    refused = fresh.post("/api/jobs", json=run_request | {"kind": "risk", "table": RUNS, "hazards": HAZARDS} | change)
    assert refused.status_code == 422
    assert why in refused.json()["error"]
    assert refused.json()["field"] == field


@pytest.mark.slow
def test_every_field_and_answer_of_a_form_is_one_of_its_command(tmp_path, capsys, monkeypatch):
    """Options that the commands know; keys that their JSON objects have, and pictures that they write."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hazard.csv").write_text(HAZARDS["site A.csv"])
    (tmp_path / "runs.csv").write_text(RUNS)
    (tmp_path / "ruin.toml").write_text(RUIN.replace("column.toml", "pompeys-pillar").replace("200", "100"))
    column, motion = ["paper-monolithic"], ["--harmonic=1Hz,0.3g,1s"]
    lines = {
        "directions": [*column, *motion, "--model=housner", "--replicates=2", "--azimuths=0:90:2", "--no-pictures"],
        "compare": [*column, *motion, "--models=housner,rigid-beam"],
        "sequence": [*column, *motion, "--model=housner", "--replicates=2", "--repeat=2", "--rest=1s"],
        "risk": ["runs.csv", "--hazard=hazard.csv", "--im=pgv", "--state=collapse"],
        "survival": ["runs.csv", "--hazard=hazard.csv", "--im=pgv", "--state=collapse", "--age=2400y"],
        "infer": ["ruin.toml"],
        "modes": [*column, "--model=dem2d", "--number=2", "--measured=4Hz±3%", "--ground=rigid"],
    }
    for kind, form in FORMS.items():
        assert call([form.command, "--help-all"]) == 0
        known = capsys.readouterr().out
        assert all(f"--{box.option}" in known for box in form.boxes), kind
        assert call([form.command, *lines[kind], f"--out={kind}", "--json"]) == 0, capsys.readouterr().err
        answer = json.loads(capsys.readouterr().out)
        rows = answer.get(form.rows, [])
        rows = rows if isinstance(rows, list) else [*rows.values()]
        measured = {key.partition(".")[0] for row in rows for key in row}
        elsewhere = measures_of(BlockMeasures) + measures_of(SpaceMeasures)  # of assemblies, in space
        optional = {"collapse_probability", *(measure.key for measure in elsewhere)}
        assert {key.partition(".")[0] for key in form.columns} - measured <= optional, kind
        assert set(form.facts) <= set(answer), kind
        drawn = {path.stem for path in (tmp_path / kind).glob("*.png")}
        assert set(form.pictures) - drawn <= {"design", "matches", "observations"}, kind  # of links, and of some ruins


def test_fields_are_marked_by_the_names_of_parameters():
    for form in FORMS.values():
        assert {box.option for box in form.boxes} | {*form.fixed} <= {*parameters(form.command)}
