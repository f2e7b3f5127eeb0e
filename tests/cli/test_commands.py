"""Commands on real input: exit codes, the one JSON object, and the files."""

import json
import math
import warnings

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call, commands
from stylobate.column.catalogue import PRESETS, preset
from stylobate.column.files import read_column, write_column

RUN = ["run", "paper-monolithic", "--model", "housner", "--harmonic", "1Hz,0.3g,4s"]
RUN_KEYS = {
    "outcome", "collapsed", "decided", "collapse_time_s", "peak_top_displacement_m", "residual_top_displacement_m",
    "peak_rotation_rad", "energy_imbalance", "time_step_s", "steps", "wall_s", "model", "version",
}  # fmt: skip


@pytest.fixture
def command(capsys):
    """Runs a command line that must succeed; returns its JSON object, or its text without ``--json``."""

    def run(*arguments, warned=""):
        code = call([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert code == 0, err
        assert warned in err if warned else err == ""
        return json.loads(out) if "--json" in arguments else out

    return run


def test_run_prints_one_json_object_with_the_promised_keys(command):
    result = command(*RUN, "--json")
    assert set(result) >= RUN_KEYS
    assert result["outcome"] == "rocked"
    assert result["collapsed"] is False
    assert result["collapse_time_s"] is None
    assert result["model"] == "housner"
    assert result["version"] == st.__version__
    # The same run in Python.
    response = st.simulate(preset("paper-monolithic"), st.harmonic(1.0, 0.3 * st.g, 4.0), st.HousnerBlock())
    assert result["peak_top_displacement_m"] == response.peak_top_displacement


def test_a_collapse_is_a_result(command):
    result = command("run", "paper-monolithic", "--model", "housner", "--harmonic", "0.5Hz,0.5g,10s", "--json")
    assert (result["outcome"], result["collapsed"], result["decided"]) == ("collapsed", True, True)
    assert 0.0 < result["collapse_time_s"] < 10.0


def test_run_writes_its_files_and_says_which(command, tmp_path):
    folder = tmp_path / "new" / "folder"
    result = command(*RUN, "--json", "--out", folder)
    assert sorted(result["files"]) == sorted(str(path) for path in folder.glob("[!.]*"))
    names = {path.name for path in folder.glob("[!.]*")}
    pictures = {
        f"{name}.{ending}"
        for name in ("histories", "filmstrip", "joints", "energy", "motion")
        for ending in ("png", "svg")
    }
    assert names == pictures | {"response.nc", "run.json", "motion.csv", "asked-run.json"}
    assert json.loads((folder / "run.json").read_text()) == result
    response = st.Response.load(folder / "response.nc")
    assert response.peak_top_displacement == result["peak_top_displacement_m"]
    assert response.column == preset("paper-monolithic")
    assert response.provenance["parameters"] == st.HousnerBlock().parameters()


def test_run_tells_a_person_the_verdict(command):
    text = command(*RUN)
    assert text.startswith(st.Outcome.ROCKED.sentence_of(1))
    for words in ("paper-monolithic", "harmonic 1 Hz, 0.3 g", "housner", "peak top displacement", "base widths"):
        assert words in text


def test_options_of_the_model_and_of_the_motion(command, tmp_path):
    restituted = command(*RUN, "--set", "restitution=0.9", "--json")
    response = st.simulate(
        preset("paper-monolithic"), st.harmonic(1.0, 0.3 * st.g, 4.0), st.HousnerBlock(restitution=0.9)
    )
    assert restituted["peak_top_displacement_m"] == response.peak_top_displacement
    base = ["run", "paper-monolithic", "--model", "housner", "--harmonic"]
    plain = command(*base, "1Hz,0.3g,4s", "--json")
    for arguments in (["1Hz,0.15g,4s", "--scale", "2"], ["1Hz,0.1g,4s", "--pga", "0.3g"]):
        scaled = command(*base, *arguments, "--json")
        assert scaled["peak_top_displacement_m"] == pytest.approx(plain["peak_top_displacement_m"], rel=1e-6)
    command(*RUN, "--out", tmp_path, "--output-interval", "0.1s", "--tail", "2s", "--threads", "1")
    time = st.Response.load(tmp_path / "response.nc").time
    assert time[-1] == pytest.approx(6.0, abs=0.1)
    assert np.diff(time)[0] == pytest.approx(0.1, rel=0.01)


def test_a_pulse_is_followed_until_the_verdict(command, tmp_path):
    command("run", "paper-monolithic", "--model", "housner", "--pulse", "half-sine,1Hz,0.5g", "--out", tmp_path)
    response = st.Response.load(tmp_path / "response.nc")
    assert response.time[-1] == pytest.approx(0.5 + 20.0 / preset("paper-monolithic").frequency_parameter, abs=0.02)
    assert response.measures.decided


def test_a_record_from_a_file(command, tmp_path):
    time = np.arange(401) * 0.01
    rows = "\n".join(f"{t:.2f},{0.3 * math.sin(2 * math.pi * t):.9f},{0.1 * math.sin(9 * t):.9f}" for t in time)
    path = tmp_path / "record.csv"
    path.write_text(f"time_s,ax_g,az_g\n{rows}\n")
    record = ["run", "paper-monolithic", "--model", "housner", "--motion", path, "--json"]
    both, horizontal = command(*record), command(*record, "--vertical", "off")
    assert both["peak_top_displacement_m"] != horizontal["peak_top_displacement_m"]
    assert horizontal["peak_top_displacement_m"] == pytest.approx(
        command(*RUN, "--json")["peak_top_displacement_m"], rel=0.01
    )


def test_critical_states_its_grid_and_how_verdicts_alternate(command, tmp_path):
    arguments = ["critical", "paper-monolithic", "--model", "housner", "--harmonic", "0.5Hz,?g,8s", "--from", "0.15g",
                 "--to", "0.4g", "--step", "0.05g", "--out", tmp_path]  # fmt: skip
    result = command(*arguments, "--json")
    assert {"critical_g", "first_collapse_g", "all_collapse_above_g", "runs", "wall_s"} <= set(result)
    assert result["runs"] == 6
    assert result["critical_g"] == result["first_collapse_g"] == pytest.approx(0.25)
    assert sum(stretch["runs"] for stretch in result["alternation"]) == 6
    assert {path.name for path in tmp_path.glob("[!.]*")} == {
        "critical.csv",
        "critical.json",
        "asked-critical.json",
        "critical.png",
        "critical.svg",
        "runs.sqlite",
    }
    # The critical run, alone, collapses; the one below it does not.
    for amplitude, collapsed in ((0.25, True), (0.2, False)):
        alone = command(
            "run", "paper-monolithic", "--model", "housner", "--harmonic", f"0.5Hz,{amplitude}g,8s", "--json"
        )
        assert alone["collapsed"] is collapsed
    assert (
        "The column collapses at 0.25 g (the next below that was looked at is 0.2 g), and at all larger ones up to"
        in command(*arguments)
    )


def test_critical_is_null_when_nothing_collapses(command):
    result = command("critical", "paper-monolithic", "--model", "housner", "--harmonic", "1Hz,?g,3s", "--from", "0.05g",
                     "--to", "0.1g", "--step", "0.05g", "--json")  # fmt: skip
    assert result["critical_g"] is None
    assert result["runs"] == 2


DOMAIN = ["--model", "housner", "--frequencies", "0.5:2:3", "--amplitudes", "0.1g:0.5g:4", "--duration", "5s"]


def test_domain_counts_cells_and_writes_table_file_and_figure(command, tmp_path):
    result = command("domain", "paper-monolithic", *DOMAIN, "--out", tmp_path, "--json")
    assert {"cells", "collapsed", "runs", "wall_s", "files"} <= set(result)
    assert (result["cells"], result["runs"]) == (12, 12)
    assert result["collapsed"] + result["stands"] + result["undecided"] + result["failed"] == 12
    names = {path.name for path in tmp_path.glob("[!.]*")}
    results = {"domain.nc", "domain.csv", "domain.png", "domain.svg", "domain.json", "asked-domain.json"}
    assert names == results | {"runs.sqlite"}
    assert sorted(result["files"]) == sorted(str(tmp_path / name) for name in results)
    text = command("domain", "paper-monolithic", *DOMAIN)
    assert f"{result['collapsed']} of 12 cells collapse" in text


def test_a_study_file_is_the_domain_it_describes(command, tmp_path):
    (tmp_path / "stone.toml").write_text(
        "density = 1600.0\n[tapered]\nheight = 5.0\nbottom_width = 0.96\ntop_width = 0.66\ndrums = 1\n"
        "[joint]\nnormal_stiffness = 5e10\nshear_stiffness = 2.5e10\nfriction_coefficient = 0.7\n"
    )
    study = tmp_path / "study.toml"
    study.write_text(
        'column = "stone.toml"\nmodel = "housner"\nfrequencies = [0.5, "1.25Hz", 2]\namplitudes = "0.1g:0.5g:4"\n'
        "duration = 5.0\n[set]\nrestitution = 0.9\n"
    )
    from_study = command("domain", study, "--json")
    from_options = command("domain", "paper-monolithic", *DOMAIN, "--set", "restitution=0.9", "--json")
    for key in ("cells", "collapsed", "stands", "undecided"):
        assert from_study[key] == from_options[key]


def test_compare_models_under_one_motion_and_over_a_domain(command, tmp_path):
    result = command("compare", "paper-monolithic", "--models", "housner,dem2d", "--harmonic", "1Hz,0.3g,3s", "--json",
                     "--out", tmp_path / "motion")  # fmt: skip
    assert [run["model"] for run in result["runs"]] == ["housner", "dem2d"]
    peaks = [run["peak_top_displacement_m"] for run in result["runs"]]
    assert peaks[1] == pytest.approx(peaks[0], rel=0.03)
    names = {path.name for path in (tmp_path / "motion").glob("[!.]*")}
    histories = {"response-housner.nc", "response-dem2d.nc"}
    results = {"comparison.csv", "comparison.png", "comparison.svg", "asked-compare.json"}
    assert names == histories | results | {"runs.sqlite"}
    grid = ["--frequencies", "0.5:2:2", "--amplitudes", "0.1g:0.5g:3", "--duration", "4s"]
    result = command(
        "compare", "paper-monolithic", "--models", "housner,dem2d", *grid, "--json", "--set", "housner.restitution=0.9"
    )
    assert [domain["cells"] for domain in result["domains"]] == [6, 6]
    (pair,) = result["differences"]
    assert (pair["first"], pair["second"]) == ("housner", "dem2d")
    assert pair["differing"] == pair["only_first_collapses"] + pair["only_second_collapses"]


@pytest.mark.parametrize("columns", [80, 100])
def test_models_side_by_side_fit_a_terminal(columns, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(columns))
    # A column in space has lists of one number per joint and more measures than one in the plane.
    call(["compare", "paper-12-drums", "--models", "dem2d,dem3d,rigid-block", "--harmonic", "1Hz,0.05g,0.1s"])
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= columns
    assert lines[0].startswith("Wobbling was not damped")
    rows = lines[next(k for k, line in enumerate(lines) if line.startswith("model ")) :]
    names = [line.split()[0] for line in rows if not line.startswith(" ")]
    assert names[:3] == ["model", "outcome", "collapsed"]
    assert "residual_twist_per_joint_rad" in names


def test_a_model_is_compared_with_itself_under_other_options(command, tmp_path):
    """The same law in the plane, held in its plane, and in space, each under the name that was typed."""
    models = ["dem2d", "dem3d:planar=true", "dem3d"]
    (tmp_path / "round.toml").write_text(
        'name = "round"\nsection = "circular"\ndensity = 1600.0\n[tapered]\nheight = 5.0\nbottom_width = 0.96\n'
        "top_width = 0.66\ndrums = 1\n[joint]\nnormal_stiffness = 5.0e10\nshear_stiffness = 2.5e10\nfriction_angle = 35.0\n"
    )
    shaking = ["--harmonic", "1Hz,0.25g,2s", "--across", "1Hz,0.1g,90deg"]
    result = command("compare", tmp_path / "round.toml", "--models", ",".join(models), *shaking, "--json", "--out",
                     tmp_path / "out", warned="Round columns, computed in the plane")  # fmt: skip
    assert result["models"] == models
    plane, twin, free = result["runs"]
    assert "peak_top_y_m" not in plane
    assert twin["peak_top_y_m"] == 0.0 < free["peak_top_y_m"]
    table = (tmp_path / "out" / "comparison.csv").read_text().splitlines()
    assert [line.split(",")[0] for line in table[1:]] == models
    assert (tmp_path / "out" / "response-dem3d-planar-true.nc").exists()


def test_motion_tells_what_a_file_holds(command, tmp_path):
    path = tmp_path / "record.txt"
    path.write_text("\n".join(f"{0.4 * math.cos(2 * math.pi * i * 0.01):.9f}" for i in range(501)))
    result = command("motion", path, "--unit", "g", "--dt", "10ms", "--out", tmp_path / "out", "--json")
    assert {"format", "unit", "dt_s", "duration_s", "pga_g", "pgv_m_s"} <= set(result)
    assert result["dt_s"] == 0.01
    assert result["duration_s"] == pytest.approx(5.0)
    assert result["pga_g"]["x"] == pytest.approx(0.4)
    # The velocity is V sin 2πt with V = a/2π, and the displacement does not drift.
    assert result["pgv_m_s"]["x"] == pytest.approx(0.4 * st.g / (2 * math.pi), rel=1e-3)
    names = {file.name for file in (tmp_path / "out").glob("[!.]*")}
    assert names == {"motion.json", "motion.csv", "motion.png", "motion.svg", "spectra.png", "spectra.svg"}
    text = command("motion", path, "--unit", "g", "--dt", "10ms")
    assert "pga [g]" in text
    assert "x 0.4" in text


def test_columns_lists_presets_and_writes_files_to_start_from(command, tmp_path):
    result = command("columns", "--json", "--out", tmp_path)
    assert [column["name"] for column in result["columns"]] == list(PRESETS)
    assert result["columns"][0]["uplift_g"] == pytest.approx(0.2046, abs=5e-5)
    for name in PRESETS:
        assert read_column(tmp_path / f"{name}.toml") == preset(name)
    assert "static uplift" in command("columns", tmp_path / "paper-12-drums.toml")


def test_columns_tell_what_is_measured_and_what_is_assumed(command, tmp_path, capsys):
    catalogue = command("columns", "--catalogue", "--json")["catalogue"]
    assert [column["name"] for column in catalogue] == list(PRESETS)
    (entry,) = command("columns", "sounion", "--catalogue", "--json")["catalogue"]
    assert entry["measured"] == ["height", "bottom_width", "top_width"]
    assert entry["assumed"] == ["drums", "density"]
    assert entry["figures"]["top_width"]["value"] == 0.79
    table = command("columns", "--catalogue")
    assert "12*" in next(line for line in table.splitlines() if line.split()[0] == "sounion")
    shown = command("columns", "sounion")
    assert "0.79 m (measured, Williams 2021)" in shown
    assert "12 (assumed)" in shown
    assert call(["columns", "sunion", "--catalogue"]) == 2
    assert "did you mean sounion?" in capsys.readouterr().err
    (tmp_path / "own.toml").write_text("")
    assert call(["columns", str(tmp_path / "own.toml"), "--catalogue"]) == 2
    assert "there is no column preset" in capsys.readouterr().err


def test_columns_tell_what_their_links_hold(command, tmp_path):
    core = st.Core(axial_stiffness=1e7, axial_capacity=2e5, pretension=5e4)
    file = write_column(preset("paper-12-drums").replace(links=[core]), tmp_path / "core.toml")
    assert "holds 200 kN in tension, pretensioned with 50 kN" in command("columns", file)
    (link,) = command("columns", file, "--json")["columns"][0]["links"]
    assert (link["shear_capacity_n"], link["axial_capacity_n"], link["pretension_n"]) == (None, 2e5, 5e4)


def test_a_warning_is_one_line_on_standard_error(capsys, tmp_path):
    path = tmp_path / "wide.toml"
    path.write_text(
        "density = 2000.0\n[tapered]\nheight = 1.0\nbottom_width = 0.5\ntop_width = 0.6\ndrums = 1\n"
        "[joint]\nnormal_stiffness = 5e10\nshear_stiffness = 2.5e10\nfriction_angle = 35.0\n"
    )
    before = warnings.showwarning
    assert call(["columns", str(path), str(path), "--json"]) == 0
    out, err = capsys.readouterr()
    json.loads(out)
    (line,) = err.splitlines()
    assert line.startswith("stylobate: warning: drum 1 of 'wide' widens upward")
    assert warnings.showwarning is before


def test_version_and_help(capsys):
    assert call(["--version"]) == 0
    assert capsys.readouterr().out == f"stylobate {st.__version__}\n"
    assert call([]) == 0
    out = capsys.readouterr().out
    assert call(["--help"]) == 0
    assert capsys.readouterr().out == out
    for name in ("run", "critical", "domain", "compare", "motion", "columns"):
        assert f"\n  {name} " in out


@pytest.mark.parametrize("name", sorted(set(commands().commands) - {"study"}))
def test_help_is_one_screen_and_names_every_option(name, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    assert call([name, "--help"]) == 0
    short = capsys.readouterr().out
    assert len(short.splitlines()) <= 40
    assert max(map(len, short.splitlines())) <= 100
    assert call([name, "--help-all"]) == 0
    long = capsys.readouterr().out
    for option in commands().commands[name].params:
        if not option.hidden and option.opts[0].startswith("--"):
            assert option.opts[0] in short
            assert f"\n  {option.opts[0]}" in long
