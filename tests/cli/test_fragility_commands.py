"""``ida``, ``fragility``, ``risk`` and ``survival`` on the command line."""

import dataclasses
import json

import numpy as np
import pytest

import stylobate as st
from stylobate.atomic import digest
from stylobate.cli.main import call
from stylobate.column.files import write_column
from stylobate.motion import half_sine_pulse, write_csv
from stylobate.response.words import ROUND_IN_THE_PLANE
from stylobate.results import read_results
from stylobate.verdicts.rocking_spectrum import rocking_block

PROMISED = {"median", "median_low", "median_high", "beta", "beta_low", "beta_high", "im", "unit", "state", "records", "runs",
            "undecided", "failed"}  # fmt: skip


def run(capsys, *arguments, code=0):
    assert call([str(argument) for argument in arguments]) == code
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
    curve = run(capsys, "fragility", place / "runs.csv", "--im", "pgv", "--out", place / "f", "--json")
    assert set(curve) >= PROMISED
    assert (curve["unit"], curve["state"], curve["records"], curve["runs"], curve["undecided"]) == (
        "m/s",
        "collapse",
        12,
        96,
        1,
    )
    assert {file.rpartition("/")[2] for file in curve["files"]} == {
        "fragility.csv", "fragility.png", "fragility.svg", "fragility.json", "asked-fragility.json"}  # fmt: skip
    risk = run(capsys, "risk", place / "runs.csv", "--im", "pgv", "--hazard", place / "A.csv", "--json")
    assert risk["annual_rate"] * risk["return_period_y"] == pytest.approx(1.0)
    both = run(
        capsys, "survival", place / "runs.csv", "--im", "pgv", "--age", "2400y",
        "--hazard", place / "A.csv", "--hazard", place / "B.csv", "--out", place / "s", "--json",
    )  # fmt: skip
    assert both["survival_probability"]["A.csv"] == pytest.approx(np.exp(-2400.0 * risk["annual_rate"]))
    assert both["survival_probability"]["A.csv"] < both["survival_probability"]["B.csv"]
    for command in (("fragility",), ("risk", "--hazard", place / "A.csv")):
        text = run(capsys, command[0], place / "runs.csv", "--im", "pgv", *command[1:]).out
        assert "collapse" in text


def test_bad_input_is_one_sentence(place, capsys):
    sections_of = pytest.importorskip("stylobate_report.others").sections_of
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
        got = run(capsys, *arguments, code=2)
        assert got.out == ""
        assert why in got.err
        assert got.err.count("\n") == 1
    assert run(capsys, "fragility", few, "--records-are-one", "--json")["records"] == 20
    text = run(capsys, "fragility", few, "--records-are-one", "--out", place / "alone").out
    assert "half of the runs bring collapse" in text
    assert "20 runs, each taken for a record of its own" in text
    (result,) = read_results([place / "alone"])
    page = str(sections_of(result, set())[:1] + sections_of(result, set())[-4:])
    assert "half of the runs bring collapse" in page
    assert "says nothing about the next earthquake" in page
    assert "The interval is over runs" in page
    assert "half of the records" not in page


@pytest.mark.parametrize(
    ("header", "im", "why"),
    [
        (
            "record,im_m_s,collapsed",
            (),
            "Which intensity im_m_s is, is not said: call the column after it, such as pgv_m_s",
        ),
        ("record,im_m_s,collapsed", ("--im", "cav"), "such as cav_m_s"),
        ("record,im_m_s,collapsed", ("--im", "pga"), "such as pgv_m_s"),
        ("record,im_g,collapsed", ("--im", "pga"), "such as pga_g"),
        ("record,im,pgv,collapsed", ("--im", "pgv"), "which of them is pgv in m/s is not said; call that one pgv_m_s"),
        ("record,im,pgv_cm_s,collapsed", ("--im", "pgv"), "the columns im and pgv_cm_s"),
        ("record,im,im_m_s,collapsed", ("--im", "pgv"), "the columns im and im_m_s"),
    ],
)
def test_an_intensity_that_is_not_named_is_not_guessed(place, capsys, header, im, why):
    values = ",0.5" * (header.count(",") - 1)
    (place / "strange.csv").write_text(header + "\n" + "".join(f"r{k}{values},{k % 2}\n" for k in range(20)))
    got = run(capsys, "fragility", place / "strange.csv", *im, code=2)
    assert why in got.err
    assert got.err.count("\n") == 1


def test_a_hazard_curve_names_its_intensity_or_it_is_said_what_it_is_taken_for(place, capsys):
    text = (place / "A.csv").read_text()
    (place / "runs.csv").write_text((place / "runs.csv").read_text().replace(",\n", ",0\n"))
    for name in ("pgv_m_s", "cav_m_s", "pgv_cm_s"):
        (place / f"{name}.csv").write_text(text.replace("im_m_s", name))
    risk = ("risk", place / "runs.csv", "--hazard")
    taken = "its column im_m_s is; it is taken for {0}: name the column {0}_m_s if it is."
    for im in ("pgv", "cav"):
        *_, warning = run(capsys, *risk, place / "A.csv", "--im", im, "--json")["warnings"]
        assert warning.endswith(taken.format(im))
    named = run(capsys, *risk, place / "pgv_m_s.csv", "--im", "pgv", "--json")["warnings"]
    assert not any("is taken for" in sentence for sentence in named)
    assert "is of cav" in run(capsys, *risk, place / "cav_m_s.csv", "--im", "pgv", code=2).err
    assert "called after its measure" in run(capsys, *risk, place / "pgv_cm_s.csv", "--im", "pgv", code=2).err


def test_a_median_beyond_all_runs_is_none(place, capsys):
    """Ten of twelve records stand at the largest level, or all below it: the curve goes on, the runs do not."""
    sections_of = pytest.importorskip("stylobate_report.others").sections_of
    rows = [
        f"r{k},{x:.3f},{int(x > (0.1, 0.25, 1.0)[min(k, 2)])}" for k in range(12) for x in np.geomspace(0.05, 0.4, 5)
    ]
    (place / "weak.csv").write_text("\n".join(["record,im,collapsed", *rows]) + "\n")
    curve = run(capsys, "fragility", place / "weak.csv", "--im", "pgv", "--out", place / "f", "--json")
    assert curve["median"] > curve["levels"][1] == 0.4
    assert curve["outside"] in curve["sentence"]
    assert "lies above all runs (pgv = 0.05 to 0.4 m/s)" in curve["outside"]
    assert "not by runs" in curve["outside"]
    text = run(capsys, "fragility", place / "weak.csv", "--im", "pgv").out
    assert "median      > 0.4 m/s (95 %:" in text
    answer = run(
        capsys, "risk", place / "weak.csv", "--im", "pgv", "--hazard", place / "A.csv", "--out", place / "r", "--json"
    )
    assert f"{curve['outside']}." in answer["warnings"]
    for folder in ("f", "r"):
        result = sections_of(read_results([place / folder])[0], set())[0]
        assert any(curve["outside"] in note.texts[0] for note in result.items[1:])
        assert "> 0.4 m/s" in str(sections_of(read_results([place / folder])[0], set()))
    verdict = sections_of(read_results([place / "f"])[0], set())[0].items[0]
    assert ": the fitted median of collapse (pgv) lies above all runs (0.05 to 0.4 m/s); 95 %" in verdict.texts[0]


def test_what_is_undecided_is_told_of_a_median_beyond_all_runs(place, capsys):
    """Three of eighteen runs at the largest level collapse, which nine undecided ones could raise to two thirds."""
    ends = {0.2: "stands", 0.3: "stands", 0.4: "undecided"}
    rows = [
        f"r{k},{x},{'collapsed' if k < 3 and x > 0.3 else verdict}" for k in range(12) for x, verdict in ends.items()
    ]
    rows += [f"r{k},0.4,stands" for k in range(6)]
    (place / "open.csv").write_text("\n".join(["record,im,verdict", *rows]) + "\n")
    curve = run(capsys, "fragility", place / "open.csv", "--im", "pgv", "--json")
    assert curve["median"] > 0.4 > curve["if_open_exceed"]["median"]
    low = f"{curve['if_open_exceed']['median']:.3g}"
    assert f"median      {low} to > 0.4 m/s (95 %:" in run(capsys, "fragility", place / "open.csv", "--im", "pgv").out


@pytest.fixture
def records(tmp_path):
    folder = tmp_path / "records"
    folder.mkdir()
    for k, f in enumerate(np.linspace(0.6, 2.4, 10)):
        write_csv(half_sine_pulse(float(f), 0.4 * st.g, 8.0), folder / f"{k}.csv")
    write_column(rocking_block(2.0, 0.2), tmp_path / "block.toml")
    return folder


def test_an_ida_and_its_fragility(tmp_path, records, capsys):
    sections_of = pytest.importorskip("stylobate_report.others").sections_of
    out = tmp_path / "ida"
    answer = run(
        capsys, "ida", tmp_path / "block.toml", records, "--model", "housner", "--im", "pgv", "--runs", "8", "--out", out,
        "--threads", "1", "--json",
    )  # fmt: skip
    assert (answer["records"], answer["runs"], answer["unit"]) == (10, 80, "m/s")
    assert answer["measures"][0]["beta"] < answer["measures"][-1]["beta"]
    assert [path.name for path in out.glob("*.sqlite*")] == ["runs.sqlite"]
    for im in ((), ("--im", "pga")):
        curve = run(capsys, "fragility", out, *im, "--json")
        assert curve["method"] == "records"
        assert curve["im"] == (im[1] if im else "pgv")
        assert curve["median_low"] < curve["median"] < curve["median_high"]
    hazard = tmp_path / "hazard.csv"
    hazard.write_text(
        "pgv_m_s,annual_rate\n" + "".join(f"{x:.5g},{1e-3 * x**-2:.5g}\n" for x in np.geomspace(0.05, 9.0, 9))
    )
    run(capsys, "risk", out, "--hazard", hazard, "--out", tmp_path / "risk", "--json")
    (result,) = read_results([tmp_path / "risk"])
    own, ida = result.request, read_results([out])[0].request
    assert [column.digest for column in own.stood] == [ida.stood[0].digest]
    assert (own.models, own.motions) == (ida.models, ida.motions)
    (source,) = own.sources
    assert (source["table"], source["runs"], len(source["records"])) == ("runs.csv", 80, 10)
    assert source["command"] == list(ida.command)
    assert source["unchanged"] is True
    low, high, number = own.motions[0]["scales"]
    assert 0.0 < low < high
    assert number == 8
    sections = {section.title: section for section in sections_of(result, set())}
    assert {
        "What it was computed from",
        "The column",
        "The ground motions",
        "What the model assumes, and where it ends",
    } <= {*sections}
    table = sections["The ground motions"].items[0]
    assert table.body[0][:4] == ["0.csv", "x", "x\N{NO-BREAK SPACE}0.400", "1"]
    assert table.body[0][4] == f"{low:.3g} to {high:.3g} (8)"
    assert own.motions[0]["digest"].startswith(table.body[0][-1])
    (out / "runs.csv").write_text((out / "runs.csv").read_text() + "\n")
    run(capsys, "risk", out, "--hazard", hazard, "--out", tmp_path / "again", "--json")
    assert "is not as stylobate wrote it" in str(sections_of(read_results([tmp_path / "again"])[0], set()))
    for broken in ("{", '{"form": 1, "models": [3]}', '{"form": 99}'):  # what is known is told, and what is not
        (out / "asked-ida.json").write_text(broken)
        run(capsys, "fragility", out, "--out", tmp_path / "broken", "--json")
        (result,) = read_results([tmp_path / "broken"])
        basis = next(section for section in sections_of(result, set()) if section.title == "What it was computed from")
        assert dict(basis.items[0].pairs)["runs"] == "80 of 10 records"
        assert basis.items[1].texts[0].startswith("Not known: ")
        assert "asked-ida.json" in basis.items[1].texts[0]


def test_what_is_not_known_of_a_risk_is_said(place, capsys):
    sections_of = pytest.importorskip("stylobate_report.others").sections_of
    run(capsys, "risk", place / "runs.csv", "--im", "pgv", "--hazard", place / "A.csv", "--out", place / "r", "--json")
    (result,) = read_results([place / "r"])
    (basis,) = [section for section in sections_of(result, set()) if section.title == "What it was computed from"]
    assert "Which column stood, in which model with which parameters, and the motions" in basis.items[1].texts[0]
    pairs = dict(basis.items[0].pairs)
    assert pairs["runs"] == "96 of 12 records"
    assert pairs["column or state, as the table calls it"] == "not told"
    assert pairs["SHA-256 of runs.csv"] == digest(place / "runs.csv")
    older = dataclasses.replace(result, request=dataclasses.replace(result.request, sources=()))
    assert "does not keep what runs" in str(sections_of(older, set()))


def test_states_are_chosen_among_as_columns_are(tmp_path, records, capsys):
    """All states were silently one curve, and the folder of states was said to be none of stylobate."""
    for width in (0.4, 0.6):
        write_column(rocking_block(2.0, width / 4.0), tmp_path / f"w{width}.toml")
    out = tmp_path / "states"
    run(
        capsys, "states", records, "--as-built", tmp_path / "w0.4.toml", "--as-found", tmp_path / "w0.6.toml", "--model",
        "housner", "--im", "pgv", "--levels", "0.05m/s:1.2m/s:6", "--threads", "1", "--out", out, "--json",
    )  # fmt: skip
    both = run(capsys, "fragility", out, "--json")["curves"]
    assert [(curve["name"], curve["runs"]) for curve in both] == [("as built", 60), ("as found", 60)]
    hazard = tmp_path / "hazard.csv"
    hazard.write_text("pgv_m_s,annual_rate\n0.01,1\n9,1e-6\n")
    for source in (out, out / "states.csv"):
        why = run(capsys, "risk", source, "--hazard", hazard, code=2).err
        assert "2 columns or states (as built, as found); choose one with --of." in why
    answer = run(capsys, "risk", out, "--of", "as found", "--hazard", hazard, "--out", tmp_path / "risk", "--json")
    assert (answer["name"], answer["fragility"]["runs"]) == ("as found", 60)
    (result,) = read_results([tmp_path / "risk"])
    (origin,) = result.request.sources
    assert (origin["columns"], origin["not_told"], origin["command"][0]) == (["as found"], None, "states")
    assert [column.name for column in result.request.stood] == [rocking_block(2.0, 0.15).name]
    assert [structure["state"] for structure in result.request.structures] == ["as found"]
    assert "no runs of a column or state 'core'; it has as built" in run(capsys, "risk", out, "--of", "core", "--hazard",
                                                                        hazard, code=2).err  # fmt: skip


def test_what_a_plane_says_of_round_columns_is_doubted_wherever_its_runs_go(tmp_path, capsys):
    """An IDA did not say what it left out, and nothing that rests on one said that it was computed in a plane."""
    sections_of = pytest.importorskip("stylobate_report.others").sections_of
    (folder := tmp_path / "records").mkdir()
    for k, f in enumerate(np.linspace(0.6, 2.4, 10)):
        pulse = half_sine_pulse(float(f), 0.4 * st.g, 8.0)
        write_csv(pulse.replace(lateral=pulse.samples), folder / f"{k}.csv")
    block = rocking_block(2.0, 0.2)
    round_ = [dataclasses.replace(drum, section="circular") for drum in block.drums]
    write_column(block.replace(drums=round_), tmp_path / "round.toml")
    arguments = (
        folder,
        "--model",
        "housner",
        "--im",
        "pgv",
        "--runs",
        "6",
        "--threads",
        "1",
        "--out",
        tmp_path / "ida",
    )
    err = run(capsys, "ida", tmp_path / "round.toml", *arguments).err
    assert err.count(f"warning: {ROUND_IN_THE_PLANE}") == 1
    hazard = tmp_path / "hazard.csv"
    hazard.write_text("pgv_m_s,annual_rate\n0.01,1\n9,1e-6\n")
    doubt = ROUND_IN_THE_PLANE
    two = ("--hazard", hazard)
    for command, *more in (("fragility",), ("risk", *two), ("survival", *two, "--age", "100y")):
        assert run(capsys, command, tmp_path / "ida", *more, "--out", tmp_path / command).out.count(doubt) == 1
        (result,) = read_results([tmp_path / command])
        assert result.summary["warnings"].count(doubt) == 1
        assert doubt in str(sections_of(result, set())[0])


def test_how_the_columns_of_an_ida_vary_is_told(capsys):
    """Nothing said so, nor what the model leaves out."""
    arguments = ["ida", "paper-monolithic", "sample:el-centro-1940", "--model", "housner"]
    arguments += ["--im", "pga", "--levels", "0.2g:0.4g:2"]
    assert call([*arguments, "--replicates", "2", "--seed", "3"]) == 0
    assert "2 that vary by width 0.5 %" in (output := capsys.readouterr().out)
    assert "seed 3, without friction, joint stiffness, density, offset, which the model does not take" in output
    assert call([*arguments, "--replicates", "2", "--seed", "3", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert (answer["replicates"], answer["certainty"]["seed"], answer["certainty"]["left_out"][-1]) == (2, 3, "offset")
    assert answer["certainty"]["scatter"]["offset"] == 0.0
