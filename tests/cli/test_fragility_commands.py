"""``ida``, ``fragility``, ``risk`` and ``survival`` on the command line."""

import json

import numpy as np
import pytest

import stylobate as st
from stylobate.analysis.rocking_spectrum import rocking_block
from stylobate.cli.main import call
from stylobate.column.files import write_column
from stylobate.motion import half_sine_pulse, write_csv

PROMISED = {"median", "median_low", "median_high", "beta", "beta_low", "beta_high", "im", "unit", "state", "records", "runs",
            "undecided", "failed"}  # fmt: skip


def said(capsys, *arguments, code=0):
    assert call([str(one) for one in arguments]) == code
    got = capsys.readouterr()
    return json.loads(got.out) if code == 0 and "--json" in arguments else got


@pytest.fixture
def place(tmp_path):
    rng = np.random.default_rng(5)
    lines = ["record,im,collapsed"]
    for k in range(12):
        capacity = rng.normal(-0.7, 0.4)
        lines += [f"r{k},{x:.4f},{int(np.log(x) > capacity)}" for x in np.geomspace(0.1, 2.0, 8)]
    lines[5] = lines[5][: lines[5].rindex(",") + 1]
    (tmp_path / "runs.csv").write_text("\n".join(lines) + "\n")
    for name, k0 in (("A", 1e-3), ("B", 1e-4)):
        x = np.geomspace(0.02, 3.0, 12)
        rows = [f"{a:.5g},{k0 * a**-2:.5g}" for a in x]
        (tmp_path / f"{name}.csv").write_text("\n".join(["im_m_s,annual_rate", *rows]) + "\n")
    return tmp_path


def test_fragility_risk_and_survival(place, capsys):
    one = said(capsys, "fragility", place / "runs.csv", "--im", "pgv", "--out", place / "f", "--json")
    assert set(one) >= PROMISED
    assert (one["unit"], one["state"], one["records"], one["runs"], one["undecided"]) == ("m/s", "collapse", 12, 96, 1)
    assert {file.rpartition("/")[2] for file in one["files"]} == {
        "fragility.csv", "fragility.png", "fragility.svg", "fragility.json", "asked-fragility.json"}  # fmt: skip
    risk = said(capsys, "risk", place / "runs.csv", "--im", "pgv", "--hazard", place / "A.csv", "--json")
    assert risk["annual_rate"] * risk["return_period_y"] == pytest.approx(1.0)
    both = said(
        capsys, "survival", place / "runs.csv", "--im", "pgv", "--age", "2400y",
        "--hazard", place / "A.csv", "--hazard", place / "B.csv", "--out", place / "s", "--json",
    )  # fmt: skip
    assert both["survival_probability"]["A.csv"] == pytest.approx(np.exp(-2400.0 * risk["annual_rate"]))
    assert both["survival_probability"]["A.csv"] < both["survival_probability"]["B.csv"]
    for command in (("fragility",), ("risk", "--hazard", place / "A.csv")):
        text = said(capsys, command[0], place / "runs.csv", "--im", "pgv", *command[1:]).out
        assert "collapse" in text


def test_bad_input_is_one_sentence(place, capsys):
    few = place / "few.csv"
    few.write_text("record,im,collapsed\n" + "a,0.1,0\na,0.2,1\n" * 10)
    rises = place / "rises.csv"
    rises.write_text("im_m_s,annual_rate\n0.1,0.01\n0.2,0.02\n")
    for arguments, why in (
        (("fragility", few), "--records-are-one"),
        (("fragility", place / "none.csv"), "no file"),
        (("fragility", place / "runs.csv", "--im", "pvg"), "did you mean pgv"),
        (("fragility", place / "runs.csv", "--state", "roof"), "state 'roof'"),
        (("fragility", place / "runs.csv", "--state", "top:0.35d"), "needs more"),
        (("fragility", place / "runs.csv", "--of", "x"), "no runs of a column"),
        (("fragility", place / "runs.csv", "--method", "guess"), "--method"),
        (("risk", place / "runs.csv", "--im", "pga", "--hazard", place / "A.csv"), "in m/s"),
        (("risk", place / "runs.csv", "--im", "pgv", "--hazard", rises), "rises"),
        (("risk", place / "runs.csv", "--hazard", place / "A.csv", "--site", "here"), "--site"),
        (("survival", place / "runs.csv", "--age", "old", "--hazard", place / "A.csv"), "age 'old'"),
        (
            ("survival", place / "runs.csv", "--age", "9y", "--hazard", place / "A.csv", "--hazard", place / "A.csv"),
            "name",
        ),
        (("ida", "paper-monolithic", place / "A.csv"), "no record that can be used"),
        (("ida", "paper-monolithic", "sample:el-centro-1940", "--im", "pgv@geomean"), "second horizontal"),
        (("ida", "paper-monolithic", "sample:el-centro-1940", "--levels", "0.1g"), "level '0.1g' of pgv"),
        (
            ("ida", "paper-monolithic", "sample:el-centro-1940", "--edp", "nothing"),
            "measures are peak_top_displacement_m",
        ),
    ):
        got = said(capsys, *arguments, code=2)
        assert got.out == ""
        assert why in got.err
        assert got.err.count("\n") == 1
    assert said(capsys, "fragility", few, "--records-are-one", "--json")["records"] == 20


@pytest.fixture
def records(tmp_path):
    folder = tmp_path / "records"
    folder.mkdir()
    for k, f in enumerate(np.linspace(0.6, 2.4, 10)):
        write_csv(half_sine_pulse(float(f), 0.4 * st.g, 8.0), folder / f"{k}.csv")
    write_column(rocking_block(2.0, 0.2), tmp_path / "block.toml")
    return folder


def test_an_ida_and_its_fragility(tmp_path, records, capsys):
    out = tmp_path / "ida"
    found = said(
        capsys, "ida", tmp_path / "block.toml", records, "--model", "housner", "--im", "pgv", "--runs", "8", "--out", out,
        "--threads", "1", "--json",
    )  # fmt: skip
    assert (found["records"], found["runs"], found["unit"]) == (10, 80, "m/s")
    assert found["measures"][0]["beta"] < found["measures"][-1]["beta"]
    assert [path.name for path in out.glob("*.sqlite*")] == ["runs.sqlite"]
    for im in ((), ("--im", "pga")):
        curve = said(capsys, "fragility", out, *im, "--json")
        assert curve["method"] == "records"
        assert curve["im"] == (im[1] if im else "pgv")
        assert curve["median_low"] < curve["median"] < curve["median_high"]
