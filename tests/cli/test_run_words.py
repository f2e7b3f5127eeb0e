"""What ``stylobate run`` says: one story of a fall, a remedy that was not tried, a table of several runs."""

import dataclasses
import json
import sys
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.cli.run import write_population
from stylobate.motion import half_sine_pulse, write_csv
from stylobate.probability.studies import StudyResult
from stylobate.response import SpaceMeasures
from stylobate.response.words import doubt_of, longer_tail, sentence_of, to_decide
from stylobate.results import read_results

BLOCK = ("run", "paper-monolithic", "--model", "housner")


def output_of(capsys, *arguments):
    assert call([*map(str, arguments)]) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize(("given", "longer"), [(0.0, "5 s"), (2.0, "5 s"), (5.0, "10 s"), (10.0, "20 s")])
def test_an_undecided_run_is_to_go_on_for_longer_than_it_did(given, longer):
    assert longer_tail(given) == f"a tail of {longer}"
    response = st.simulate(st.preset("paper-monolithic"), st.harmonic(1.0, 0.1, 0.1), st.HousnerBlock())
    open_ = dataclasses.replace(
        response,
        measures=dataclasses.replace(response.measures, decided=False),
        provenance={**response.provenance, "tail_s": given},
    )
    assert sentence_of(open_).endswith(f"go on with a tail of {longer}.")


def test_no_tail_is_advised_to_drums_that_pivot_freely_as_found():
    """Nothing bounds where such drums come to (docs/theory/distinct_element_3d.md, Walking): all of them stay open."""
    column = st.preset("paper-12-drums")
    drums = [dataclasses.replace(drum, section="circular") for drum in column.drums]
    round_ = column.replace(drums=drums, as_found=st.AsFound((st.FoundDrum(2, offset=0.01),)))
    free = {"pivot_friction": 0.0}
    assert to_decide(round_, free, 5.0).startswith("no tail decides it")
    for structure, parameters in (
        (round_, {"pivot_friction": 1.0}),
        (round_, {}),
        (round_, free | {"planar": True}),
        (round_.replace(as_found=st.AsFound()), free),
        (column.replace(as_found=round_.as_found), free),
    ):
        assert to_decide(structure, parameters, 5.0) == "go on with a tail of 10 s"


def test_no_tail_is_advised_to_a_round_column_whose_wobble_nothing_damps():
    """Two columns that had wobbled for 60 s were as undecided after 180 s; damped as stone they are decided."""
    column = st.preset("parthenon")
    undamped, damped = (st.DistinctElement3D(losses=losses).parameters() for losses in ("none", "stone"))
    for parameters, square, waited in (
        (damped, False, True),  # by what loses something
        (undamped, False, False),  # which has not waited at all
        (undamped | {"planar": True}, False, True),
        (undamped, True, True),
        (st.DistinctElement2D().parameters(), False, True),
    ):
        stands = st.preset("paper-12-drums") if square else column
        assert to_decide(stands, parameters, 0.0, waited).startswith("go on with a tail of")
    cure = to_decide(column, undamped, 0.0)
    assert cure.startswith("no tail decides it, as nothing damps its wobble")
    assert "losses = stone" in cure


def test_peaks_and_films_of_a_fall_tell_one_story(capsys):
    text = output_of(capsys, *BLOCK, "--harmonic", "1Hz,0.9g,3s")
    (collapse,) = [line for line in text.splitlines() if line.startswith("  collapse")]
    assert "histories and films show the fall, to " in collapse
    peaks = [line for line in text.splitlines() if line.startswith("  peak")]
    assert len(peaks) == 3
    assert all(", before the fall" in line for line in peaks)
    assert "until" not in text


def test_several_directions_are_a_table(capsys, tmp_path):
    time = 0.02 * np.arange(50)
    parts = 3.0 * np.sin(6.0 * time), 2.0 * np.sin(5.0 * time)
    record = write_csv(st.Motion(0.02, *parts, metadata={"azimuths": {"x": 0.0, "y": 90.0}}), tmp_path / "r.csv")
    text = output_of(capsys, *BLOCK, "--motion", record, "--azimuths", "0:90:2", "--out", tmp_path / "out")
    header, *rows = text.splitlines()
    assert header.split()[:2] == ["motion", "outcome"]
    assert ["r.csv at 0°" in rows[0], "r.csv at 90°" in rows[1]] == [True, True]
    assert text.count("left out of r.csv at") == 2
    assert f"2 folders with a run each in {tmp_path / 'out'}" in text
    assert "Most harm: turned to " in text
    assert "step" not in text


def test_an_assembly_is_no_column(capsys, tmp_path):
    (tmp_path / "blocks.toml").write_text(
        'name = "two"\ndensity = 2500.0\n[[block]]\nname = "a"\nvertices = [[0, 0], [1, 0], [1, 1], [0, 1]]\n'
        "[joint]\nnormal_stiffness = 1e8\nshear_stiffness = 5e7\nfriction_angle = 35.0\n"
    )
    grid = ("--from", "0.05g", "--to", "0.1g", "--step", "0.05g")
    text = output_of(capsys, "critical", tmp_path / "blocks.toml", "--harmonic", "2Hz,?g,0.3s", *grid)
    assert "No amplitude looked at, 0.05 to 0.1 g, collapses the assembly; larger ones were not looked at." in text
    assert "column" not in text


@pytest.mark.parametrize(
    ("parameters", "tilt", "doubted"),
    [
        ({"stiffness_damping": 0.0}, 0.05, True),
        ({"stiffness_damping": 1e-4}, 0.05, False),
        ({"stiffness_damping": 0.0, "restitution": 0.9}, 0.05, False),
        ({"stiffness_damping": 0.0, "planar": True}, 0.05, False),
        ({"stiffness_damping": 0.0}, 1e-4, False),  # its joints hardly opened
    ],
)
def test_a_verdict_on_undamped_wobble_is_doubted(parameters, tilt, doubted):
    space = SpaceMeasures(0.1, 0.1, tilt, 0.0)
    run = SimpleNamespace(
        measures=SimpleNamespace(space=space),
        structure=SimpleNamespace(slenderness=0.15),
        provenance={"parameters": parameters},
    )
    assert doubt_of(cast(Any, run)).startswith("Wobbling was not damped" if doubted else "")
    assert bool(doubt_of(cast(Any, run))) is doubted


DOUBT = "Round columns, computed in the plane: in space they can fall under much weaker motions, those of several drums"


@pytest.fixture
def column(tmp_path):
    """The file of a column of two round drums."""
    path = tmp_path / "two.toml"
    path.write_text(
        'name = "two"\nsection = "circular"\ndensity = 2600.0\n[tapered]\nheight = 2.0\nbottom_width = 0.4\n'
        "top_width = 0.4\ndrums = 2\n[joint]\nnormal_stiffness = 2.0e9\nshear_stiffness = 1.0e9\n"
        "friction_coefficient = 0.7\n"
    )
    return path


@pytest.mark.parametrize(
    ("command", "arguments"),
    [
        ("critical", ["--harmonic", "1Hz,?g,0.2s", "--from", "0.1g", "--to", "0.2g", "--step", "0.1g"]),
        (
            "critical",
            ["--harmonic", "1Hz,?g,0.2s", "--signs", "both", "--from", "0.1g", "--to", "0.2g", "--step", "0.1g"],
        ),
        ("domain", ["--frequencies", "1:2:2", "--amplitudes", "0.1g:0.2g:2", "--duration", "0.2s"]),
        ("domain", ["--frequencies", "1", "--amplitudes", "0.1g", "--duration", "0.2s", "--replicates", "2"]),
        ("compare", ["--models", "dem2d", "--harmonic", "1Hz,0.1g,0.2s"]),
        ("study", []),
    ],
)
def test_what_a_plane_says_of_round_drums_is_doubted_before_it(command, arguments, column, capsys, tmp_path):
    sections_of = pytest.importorskip("stylobate_report.others").sections_of
    words = [command, column, *arguments]
    if command == "study":
        file = tmp_path / "study.toml"
        write_csv(half_sine_pulse(1.0, 0.1 * st.g, 0.5), tmp_path / "one.csv")
        file.write_text('model = "dem2d"\ncolumns = ["two.toml"]\n[motions]\nfiles = ["one.csv"]\n')
        words = ["study", "run", file]
    text = output_of(capsys, *words, "--out", tmp_path / "out")
    assert " ".join(text.split()).startswith(DOUBT)
    if command != "compare":
        (result,) = read_results([tmp_path / "out"])
        assert DOUBT in result.summary["doubt"]
        assert DOUBT in str(sections_of(result, set())[0])


def test_what_a_study_and_a_film_show_is_doubted(column, capsys, tmp_path):
    write_csv(half_sine_pulse(1.0, 0.3 * st.g, 2.0), tmp_path / "one.csv")
    (tmp_path / "study.toml").write_text('model = "dem2d"\ncolumns = ["two.toml"]\n[motions]\nfiles = ["one.csv"]\n')
    out = tmp_path / "out"
    output_of(capsys, "study", "run", tmp_path / "study.toml", "--out", out)
    assert " ".join(output_of(capsys, "study", "status", out).split()).startswith(DOUBT)
    assert DOUBT in json.loads(output_of(capsys, "study", "status", out, "--json"))["doubt"]
    (out / "study.json").unlink()  # of a study that was stopped
    assert DOUBT in json.loads(output_of(capsys, "study", "status", out, "--json"))["doubt"]
    assert DOUBT in json.loads(output_of(capsys, "study", "export", out, "--to", tmp_path / "a.csv", "--json"))["doubt"]
    assert " ".join(output_of(capsys, "study", "export", out, "--to", tmp_path / "b.csv").split()).startswith(DOUBT)
    result = StudyResult.in_folder(out)
    assert DOUBT in result.summary()["doubt"]
    assert DOUBT in result.table.attrs["doubt"]
    (film,) = (out / "histories").glob("*.nc")
    shown = ("--format", "html", "--fps", "2", "--out", tmp_path / "film")
    assert DOUBT in output_of(capsys, "animate", film, *shown)
    assert DOUBT in json.loads(output_of(capsys, "animate", film, *shown, "--json"))["doubt"]


def test_runs_in_several_directions_say_their_doubt_once(column, capsys, tmp_path):
    several_sections = pytest.importorskip("stylobate_report.runs").several_sections
    options = ("--harmonic", "1Hz,0.3g,0.5s", "--signs", "both", "--replicates", "0", "--no-pictures")
    text = output_of(capsys, "run", column, *options, "--out", tmp_path / "out")
    assert " ".join(text.split()).count(DOUBT) == 1
    (result,) = read_results([tmp_path / "out"])
    (lead, *_) = several_sections(cast(Any, result))
    assert str(lead).count(DOUBT) == 1


def test_the_strip_of_the_median_is_followed_as_its_run_was(monkeypatch):
    """To rest where nothing was carried; what rode along was not."""
    run_options = {}
    module = sys.modules["stylobate.simulate"]
    monkeypatch.setattr(module, "simulate", lambda *_, **options: run_options.update(options))
    monkeypatch.setattr("stylobate.plots.draw_filmstrip", lambda response: None)
    files = SimpleNamespace(table=lambda *_: None, picture=lambda *_: None)
    population = SimpleNamespace(table=None, bodies=(), median=0, drawn=SimpleNamespace(columns=[None]))
    known = {"tail_s": 1.0, "output_interval_s": 0.01, "quiet_share": 0.0, "until_rest": True}
    response = SimpleNamespace(provenance=known, structure=None)
    for carried, rest in ((0, True), (15, False)):
        engine = SimpleNamespace(computes_for=lambda *_: True, paced=None, twins=carried)
        chosen = type("Chosen", (), {"computes_for": engine.computes_for, "__new__": lambda *_, engine=engine: engine})
        model = SimpleNamespace(engines=[chosen])
        write_population(*cast(Any, (population, None, model, response, files)), strip=True)
        assert run_options["until_rest"] is rest


def test_a_run_says_its_doubt(column, capsys, tmp_path):
    sections_of = pytest.importorskip("stylobate_report.others").sections_of
    plane = output_of(capsys, "run", column, "--harmonic", "1Hz,0.3g,0.5s", "--replicates", "0")
    assert plane.count(DOUBT) == 1
    assert "Round columns" not in output_of(capsys, "run", column, "--harmonic", "1Hz,0.01g,0.5s", "--replicates", "0")
    pulse = write_csv(half_sine_pulse(1.0, 0.3 * st.g, 2.0), tmp_path / "one.csv")
    for command in (("suite", column, pulse), ("ida", column, pulse, "--im", "pga", "--levels", "0.1g:0.2g:2")):
        assert " ".join(output_of(capsys, *command, "--out", tmp_path / command[0]).split()).count(DOUBT) == 1
        (result,) = read_results([tmp_path / command[0]])
        assert DOUBT in result.summary["doubt"]
        assert DOUBT in str(sections_of(result, set())[0])
    text = output_of(capsys, "run", column, "--model", "dem3d", "--harmonic", "1Hz,0.3g,1s", "--replicates", "0")
    assert "Wobbling was not damped, and in space a verdict can hang on that, either way" in text
    assert "with a stiffness damping of 1e-4 s" in text
