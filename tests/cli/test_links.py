"""``stylobate run`` on a column file with links: words, JSON, and what is refused."""

from __future__ import annotations

import json

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.files import write_column

COLUMN = st.Column.of_drums(
    [st.Drum(0.6, 0.5, 0.5, 2500.0)] * 2,
    st.Joint(normal_stiffness=5e9, shear_stiffness=2.5e9, friction_coefficient=0.2),
)
DOWELS = """
[[link]]
kind = "dowel"
joints = "all"
shear_stiffness = 1e7
shear_capacity = 100.0
failure = "brittle"
"""


def test_run_tells_which_links_broke_and_models_without_links_refuse(tmp_path, capsys) -> None:
    path = write_column(COLUMN, tmp_path / "column.toml")
    path.write_text(path.read_text() + DOWELS)
    line = ["run", str(path), "--harmonic", "2Hz,0.4g,0.5s", "--replicates", "1"]
    assert call([*line, "--model", "dem2d", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    broken = [link for link in answer["links"] if link["broken_s"] is not None]
    assert answer["links_broken"] == len(broken) == 2
    assert answer["first_link_broken_s"] == min(link["broken_s"] for link in broken) == min(answer["link_broken_s"])
    assert [link["joint"] for link in answer["links"]] == [1, 2]
    assert call([*line, "--model", "rigid-beam"]) == 2
    message = capsys.readouterr().err
    assert "knows no links" in message
    assert "Traceback" not in message


def test_a_run_until_rest_follows_a_column_with_links_to_the_ground(tmp_path, capsys) -> None:
    path = write_column(COLUMN.with_joint(friction_coefficient=0.7), tmp_path / "column.toml")
    path.write_text(path.read_text() + DOWELS)
    line = ["run", str(path), "--harmonic", "1Hz,1g,1.5s", "--replicates", "1", "--model", "dem2d", "--until-rest"]
    assert call([*line, "--json", "--out", str(tmp_path / "out")]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["outcome"] == "collapsed"
    assert answer["links_broken"] == 2
    assert max(answer["link_broken_s"]) < answer["collapse_time_s"]
    assert answer["energy_imbalance"] < 0.01
    assert call(line) == 0
    output = " ".join(capsys.readouterr().out.split())
    assert "2 of 2 dowels broke" in output
    assert "drums fell" in output
