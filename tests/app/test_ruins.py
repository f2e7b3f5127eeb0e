"""Ruins on the page: what may be asked, what is refused, and the job that infers."""

import tomllib

import pytest
from page_server import ended

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
    drums = [{name: value for name, value in one.items() if name != "depth"} for one in table["drum"]]
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
    assert "what shaking left the ruin" in job["title"]


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
    assert refused.json()["field"] == "ruin"
    assert "/tmp" not in refused.json()["error"]
