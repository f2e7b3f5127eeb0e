"""The sample motions on the command line."""

import json
from importlib import resources

import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.errors import InputError
from stylobate.motion import samples


def test_a_sample_is_a_motion_wherever_a_record_is_asked_for(capsys, tmp_path):
    command = ["run", "paper-monolithic", "--motion", "sample:el-centro-1940", "--model", "housner", "--json"]
    assert call(command) == 0
    answer = json.loads(capsys.readouterr().out)
    assert "el-centro-1940" in json.dumps(answer)
    assert call(["motion", "sample:waipukurau-2018", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["network"]
    suite = ["suite", "paper-monolithic", "sample:el-centro-1940", "sample:san-francisco-1989"]
    assert call([*suite, "--model", "housner", "--out", str(tmp_path / "suite")]) == 0
    assert "san-francisco-1989" in (tmp_path / "suite" / "suite.csv").read_text()


def test_samples_are_listed(capsys):
    assert call(["motion", "--samples", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)["samples"]
    assert [sample["name"] for sample in listed] == [f"sample:{name}" for name in samples()]
    assert all(sample["terms"] for sample in listed)
    assert call(["motion", "--samples"]) == 0
    assert "sample:el-centro-1940" in capsys.readouterr().out


@pytest.mark.parametrize("arguments", [["motion"], ["motion", "--samples", "sample:el-centro-1940"]])
def test_the_list_or_a_record(arguments, capsys):
    assert call(arguments) == 2
    assert "--samples" in capsys.readouterr().err


def test_an_unknown_sample_is_refused_with_the_nearest_name():
    with pytest.raises(InputError, match="did you mean sample:el-centro-1940"):
        st.sample_motion("el-centro-1941")


def test_every_sample_is_attributed_and_all_together_are_small():
    folder = resources.files("stylobate.motion") / "samples"
    attribution = (folder / "ATTRIBUTION.md").read_text(encoding="utf-8")
    assert all(f"`{name}`" in attribution for name in samples())
    files = [path for path in folder.iterdir() if path.is_file()]
    assert sorted(path.name for path in files if path.name.endswith(".gz")) == sorted(
        f"{name}.gz" for name in samples()
    )
    assert sum(len(path.read_bytes()) for path in files) < 1_000_000
