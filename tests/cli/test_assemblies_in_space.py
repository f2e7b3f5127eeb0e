"""Assemblies in space on the command line: what stands, statics, picture, report; how they are shaken, and who cannot."""

import json
from pathlib import Path

import pytest

from stylobate.cli.main import call

FOLDER = Path(__file__).parents[2] / "gallery" / "assemblies"
STATUE = str(FOLDER / "statue.toml")
PORTAL = str(FOLDER / "portal_in_space.toml")


@pytest.fixture
def answered(capsys):
    """What a command prints, and its JSON object where one is asked for."""

    def command(*arguments):
        assert call([str(argument) for argument in arguments]) == 0
        out, err = capsys.readouterr()
        assert err == ""
        return json.loads(out) if "--json" in arguments else out

    return command


@pytest.fixture
def refused(capsys):
    def command(*arguments):
        assert call([str(argument) for argument in arguments]) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert err.count("\n") == 1
        return err

    return command


def test_what_stands(answered):
    """Masses by hand: 2700 kg/m³ of 0.8 × 0.7 × 1.0 m of pedestal; the extent is that of what can move."""
    (description,) = answered("columns", STATUE, "--json")["columns"]
    assert description["fixed"] == ["ground", "step"]
    assert [body["name"] for body in description["bodies"]] == ["pedestal", "statue"]
    assert (description["heaviest"], description["heaviest_mass_kg"]) == ("pedestal", pytest.approx(1512.0))
    assert (description["joints"], description["height_m"]) == (2, pytest.approx(3.37))
    assert description["extent_m"] == pytest.approx([0.8, 0.7, 3.12])
    text = answered("columns", STATUE, FOLDER / "portal.toml", "paper-monolithic")
    assert "2 that can move, 1 fixed" in text
    assert text.count("heaviest") == 2


def test_limit_all_round_with_its_pictures_and_its_report(answered, tmp_path):
    answer = answered("limit", PORTAL, "--directions", "0:90:3", "--out", tmp_path / "out", "--json")
    assert answer["weakest_azimuth_deg"] == 90.0
    assert answer["collapse_multiplier_g"] == pytest.approx(0.15805, abs=1e-5)
    assert [direction["multiplier_g"] for direction in answer["directions"]] == pytest.approx(
        [0.2, 0.2235, 0.15805], abs=1e-4
    )
    assert (answer["between"], answer["moving"]) == (["ground", "left"], ["left", "right", "beam"])
    assert (answer["dims"], answer["flow"], answer["upper_bound"]) == ("xyz", "associated", False)
    assert {Path(path).name for path in answer["files"]} == {
        "limit.json", "directions.png", "directions.svg", "asked-limit.json"
    }  # fmt: skip
    answered("report", tmp_path / "out", "--out", tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    for words in ("the assembly becomes a mechanism at 0.1581", "left, right and beam", "The assembly in space"):
        assert words in page
    assert "flow rule of friction" in page


def test_limit_in_words(answered):
    text = answered("limit", PORTAL, "--directions", "90:90:1")
    assert "The assembly becomes a mechanism at 0.1581 g, pushed towards 90 degrees." in text
    assert "joint 1 (between ground and left) rocking" in text
    assert "all 3 bodies" in text
    assert "upper bound" not in text
    askew = answered("limit", FOLDER / "wall_corner.toml", "--directions", "45:45:1")
    assert "stones slide or round faces twist in this mechanism, so that the multiplier is an upper bound" in askew


@pytest.mark.parametrize("kind", [".png", ".svg", ".pdf"])
def test_draw(answered, tmp_path, kind):
    file = tmp_path / f"statue{kind}"
    assert answered("draw", STATUE, "--out", file, "--json") == {"name": "statue", "bodies": 2, "files": [str(file)]}
    first = file.read_bytes()
    assert first[:5] in (b"\x89PNG\r", b"<?xml", b"%PDF-")
    answered("draw", STATUE, "--out", file)
    assert file.read_bytes() == first


def test_draw_refuses_other_files(refused, tmp_path):
    assert "allowed are files that end in .png, .svg, .pdf" in refused("draw", STATUE, "--out", tmp_path / "a.jpg")
    assert "which is no folder; name a file in a folder" in refused("draw", STATUE, "--out", tmp_path / "no" / "a.png")
    (tmp_path / "a.png").mkdir()
    assert "is a folder; name a file" in refused("draw", STATUE, "--out", tmp_path / "a.png")
    assert not list((tmp_path / "a.png").iterdir())


def test_draw_on_paper(answered, refused, tmp_path):
    sheets = tmp_path / "sheets.pdf"
    assert answered("draw", STATUE, "--out", sheets, "--paper", "a4", "--json")["files"] == [str(sheets)]
    assert "allowed is 1:N" in refused("draw", STATUE, "--out", sheets, "--paper", "A4", "--scale", "50")
    assert "say which with --paper" in refused("draw", STATUE, "--out", sheets, "--scale", "1:50")
    assert "name a .pdf" in refused("draw", STATUE, "--out", tmp_path / "b.png", "--paper", "A4")
    assert "allowed are A4, A3" in refused("draw", STATUE, "--out", sheets, "--paper", "B5")


SHAKEN = ["--pulse", "ricker,1Hz,0.2g"]


def test_it_is_shaken_by_dem3d(answered):
    """Which the screen of help names."""
    assert "in space dem3d" in answered("run", "--help")
    run = ("run", STATUE, "--model", "dem3d", "--pulse", "ricker,2Hz,0.3g,1.5s", "--json")
    answer = answered(*run)
    assert answer["outcome"] == "rocked"
    both = answered(
        *run, "--set", "restitution=0.5", "--set", "stiffness_damping=1e-3"
    )  # of the bed, and of the joints
    assert both["peak_displacement_m"] < answer["peak_displacement_m"]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["run", STATUE, *SHAKEN], "dem2d cannot shake 'statue', which is an assembly in space; dem3d can, and its"),
        (["run", STATUE, "--model", "housner", *SHAKEN], "housner cannot shake 'statue'"),
        (["critical", STATUE, "--pulse", "ricker,1Hz,?g", "--from", "0.1g", "--to", "0.2g"], "dem2d cannot shake"),
        (["compare", STATUE, "--models", "dem3d,dem2d", *SHAKEN], "dem2d cannot shake 'statue'"),
        (
            ["compare", STATUE, "--models", "dem3d", "--frequencies", "1:2:2", "--amplitudes", "0.1g:0.2g:2"],
            "describes an assembly of blocks, and this is for columns",
        ),
        (["pushover", STATUE], "describes an assembly of blocks, and this is for columns"),
        (["limit", STATUE, "--project", "30deg"], "--project is for columns, and 'statue' is an assembly in space."),
        (["limit", STATUE, "--tilt", "3"], "--pattern, --tilt and --compressive-strength are for"),
        (["columns", STATUE, "--out", "never"], "--out writes column files, and 'statue' is an assembly in space"),
    ],
)  # fmt: skip
def test_what_is_not_known_of_it_is_said(refused, arguments, says):
    assert says in refused(*arguments)


def test_a_run_without_twins_says_that_it_is_one(answered, tmp_path):
    """Nothing rides along with an assembly: no certainty is made up, and what asks for it is told."""
    pulse = ("--model", "dem3d", "--pulse", "sine,2Hz,0.05g,0.5s")
    answer = answered("run", STATUE, *pulse, "--json")
    assert answer["replicates"] == 0
    assert "certainty" not in answer
    assert list(answer["bodies"]) == ["pedestal", "statue"]
    assert (answer["fallen"], answer["doubt"], answer["struck_at_s"]) == ([], "", None)
    assert len(answer["residual_slip_x_m"]) == len(answer["residual_twist_rad"]) == 2
    text = answered("run", STATUE, *pulse)
    assert "one run, of exactly these stones; --replicates 15 runs assemblies like it as well" in text


def test_twins_of_an_assembly_and_their_report(answered, tmp_path):
    arguments = ("--model", "dem3d", "--pulse", "sine,2Hz,0.05g,0.5s", "--replicates", "2", "--seed", "1")
    answer = answered("run", STATUE, *arguments, "--out", tmp_path / "out", "--json")
    assert answer["replicates"] == 2
    assert "assemblies like this" in answer["certainty"]["sentence"]
    assert set(answer["certainty"]["bodies"]) == {"pedestal", "statue"}
    assert {"bodies.csv", "debris.png", "replicates.csv"} <= {Path(path).name for path in answer["files"]}
    answered("report", tmp_path / "out", "--out", tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    for words in (
        "Of 2 assemblies like this one, none collapse",
        "Nobody knows an assembly to the last digit",
        "density of each stone",
        "peak tilt",
    ):
        assert words in page


def test_many_runs_carry_the_caution_once(answered, tmp_path):
    text = answered(
        "critical", STATUE, "--model", "dem3d", "--pulse", "sine,2Hz,?g,0.5s", "--from", "0.02g", "--to", "0.04g",
        "--step", "0.02g", "--replicates", "1",
    )  # fmt: skip
    assert text.count("Assemblies in space are new: where bodies strike one another") == 1
    assert "assemblies like this" in text
    record = tmp_path / "weak.csv"
    record.write_text("time_s,ax_g\n" + "\n".join(f"{0.01 * k:.2f},{0.02 * (-1) ** k:g}" for k in range(20)))
    answer = answered("ida", STATUE, record, "--model", "dem3d", "--im", "pga", "--levels", "0.02g:0.03g:2", "--json")
    assert answer["edp"] == "peak_displacement_m"
    assert answer["doubt"].startswith("Assemblies in space are new")
    states = ("states", record, "--as-built", STATUE, "--with", PORTAL, "--model", "dem3d", "--out", tmp_path / "out")
    answer = answered(*states, "--json")
    assert answer["doubt"].startswith("Assemblies in space are new")
    assert [state["runs"] for state in answer["states"]] == [1, 1]
    answered("report", tmp_path / "out", "--out", tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count("The state “") == 2
    assert "pedestal" in page


def test_states_and_settings_side_by_side(answered, tmp_path):
    """A portal, with a tie between its columns, and without its beam, run by run; then two steps of time."""
    whole = Path(PORTAL).read_text(encoding="utf-8")
    tie = 'kind = "tie"\nbetween = ["left", "right"]\nat = [-0.75, 0.0, 3.0]\nto = [0.75, 0.0, 3.0]\ndiameter = 0.03\n'
    (tmp_path / "tied.toml").write_text(f'{whole}\n[[link]]\n{tie}material = "stainless steel"\n')
    (tmp_path / "columns.toml").write_text(whole[: whole.rindex("[[block]]")])
    arguments = ["states", "--as-built", PORTAL, "--with", tmp_path / "tied.toml", "--with", tmp_path / "columns.toml"]
    arguments += ["--model", "dem3d", "--pulse", "sine,2Hz,0.25g,0.6s", "--state", "peak_displacement_m:0.02m"]
    answer = answered(*arguments, "--replicates", "2", "--out", tmp_path / "out", "--json")
    assert [(state["label"], state["runs"]) for state in answer["states"]] == [
        ("as built", 2),
        ("tied", 2),
        ("columns", 2),
    ]
    assert [
        (difference["against"], difference["pairs"] + difference["undecided"]) for difference in answer["differences"]
    ] == [("as built", 2)] * 2
    assert [link["link"] for link in answer["links"]] == ["tie between left and right"]
    answered("report", tmp_path / "out", "--out", tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "the same slightly different columns or assemblies" in page
    two = ["compare", PORTAL, "--models", "dem3d,dem3d:step_factor=0.2", "--pulse", "sine,2Hz,0.25g,0.6s"]
    peaks = [run["peak_displacement_m"] for run in answered(*two, "--json")["runs"]]
    assert peaks[0] == pytest.approx(peaks[1], rel=0.02)
    assert peaks[0] != peaks[1]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            ["--replicates", "2", "--scatter", "width=1%"],
            "the scatter has width, by which twins of an assembly in space",
        ),
        (["--project", "30deg"], "--project is for columns, and 'statue' is an assembly in space."),
        (["--set", "restitution=1.5", "--set", "stiffness_damping=1e-4"], "restitution is 1.5; allowed is [0, 1]"),
        (["--set", "planar=true"], "planar is True, which assemblies in space such as 'statue' do not know"),
    ],
)
def test_what_a_run_refuses(arguments, words, refused):
    assert words in refused("run", STATUE, "--model", "dem3d", "--pulse", "sine,2Hz,0.05g,0.5s", *arguments)


def test_measures_that_need_a_column_are_refused(refused, tmp_path):
    record = tmp_path / "weak.csv"
    record.write_text("time_s,ax_g\n" + "\n".join(f"{0.01 * k:.2f},{0.02 * (-1) ** k:g}" for k in range(20)))
    message = refused("ida", STATUE, record, "--model", "dem3d", "--im", "pga", "--edp", "peak_top_displacement_m")
    assert "the runs have no measure 'peak_top_displacement_m'" in message


@pytest.mark.parametrize("model", ["housner", "rigid-beam", "rigid-block", "dem2d"])
@pytest.mark.parametrize("more", [(), ("--signs=both",), ("--scale=2", "--signs=both")])
def test_a_model_of_the_plane_is_refused_before_anything_is_forecast(refused, model, more):
    """Of one run and of several alike: their number is nothing that decides who can shake what."""
    message = refused("run", STATUE, "--model", model, "--harmonic=1Hz,0.1g,1s", *more)
    assert f"{model} cannot shake 'statue', which is an assembly in space; dem3d can" in message
