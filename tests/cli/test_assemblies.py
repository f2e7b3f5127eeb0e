"""Assembly files on the command line: one JSON object, files, films; bad ones refused in a sentence that names the block."""

import json

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.assembly_files import read_assembly
from stylobate.response import Response

PORTAL = """\
name = "portal"
density = 2400.0
[joint]
normal_stiffness = 1e9
shear_stiffness = 5e8
friction_angle = 35.0
[[block]]
name = "left"
vertices = [[-1.5, 0.0], [-0.9, 0.0], [-0.9, 3.0], [-1.5, 3.0]]
[[block]]
name = "right"
vertices = [[0.9, 0.0], [1.5, 0.0], [1.5, 3.0], [0.9, 3.0]]
[[block]]
name = "beam"
density = 2000.0
vertices = [[-1.5, 3.0], [1.5, 3.0], [1.5, 3.5], [-1.5, 3.5]]
[[joint_override]]
between = ["left", "beam"]
normal_stiffness = 2e9
shear_stiffness = 1e9
friction_angle = 20.0
"""
MODEL = ["--model", "dem2d"]
SHAKEN = [*MODEL, "--harmonic", "1Hz,0.02g,1s"]
KEYS = {
    "replicates", "displaced", "bodies", "mechanism", "doubt", "struck_at_s", "peak_opening_per_joint_m",
    "outcome", "collapsed", "decided", "collapse_time_s", "fallen", "at_rest", "in_equilibrium_as_drawn",
    "peak_displacement_m", "residual_displacement_m", "peak_rotation_rad", "peak_joint_opening_m",
    "residual_joint_slip_m", "energy_imbalance", "time_step_s", "steps", "wall_s", "model", "version", "motion",
    "residual_slip_x_m", "residual_displacement_x_m", "residual_displacement_z_m", "residual_tilt_x_rad", "vertical",
    "left_out", "processing", "azimuth_deg", "reversed", "factor", "losses", "losses_acting", "moving_at_end_m_s",
}  # fmt: skip
RIGHT = "[[0.9, 0.0], [1.5, 0.0], [1.5, 3.0], [0.9, 3.0]]"


@pytest.fixture
def portal(tmp_path):
    path = tmp_path / "portal.toml"
    path.write_text(PORTAL)
    return path


@pytest.fixture
def command(capsys):
    """Runs a command line that must succeed; returns its JSON object or text, and what it said on standard error."""

    def run(*arguments):
        code = call([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert code == 0, err
        return (json.loads(out) if "--json" in arguments else out), err.splitlines()

    return run


def test_run_prints_one_json_object(command, portal):
    result, warnings = command("run", portal, *SHAKEN, "--json")
    assert set(result) == KEYS
    assert warnings == []
    assert (result["outcome"], result["collapsed"], result["decided"]) == ("at_rest", False, True)
    assert result["in_equilibrium_as_drawn"] is True
    assert result["collapse_time_s"] is None
    # the same in Python
    response = st.simulate(read_assembly(portal), st.harmonic(1.0, 0.02 * st.g, 1.0), st.DistinctElement2D())
    assert result["peak_displacement_m"] == response.summary()["peak_displacement_m"] > 0.0


def test_options_of_the_model_and_of_the_motion(command, portal):
    arguments = ["run", portal, *MODEL, "--harmonic", "1Hz,0.05g,1s", "--scale", "2", "--json"]
    coarse, _ = command(*arguments, "--tail", "1s")
    fine, _ = command(*arguments, "--set", "step_factor=0.2")
    assert coarse["peak_displacement_m"] == pytest.approx(fine["peak_displacement_m"], rel=0.05)
    assert fine["time_step_s"] < 0.6 * coarse["time_step_s"]
    # 20/p after the pulse: R = √(3² + 3.5²)/2
    pulse, _ = command("run", portal, *MODEL, "--pulse", "half-sine,1Hz,0.1g", "--json")
    p = (0.75 * st.g / (0.5 * 21.25**0.5)) ** 0.5
    assert pulse["steps"] * pulse["time_step_s"] == pytest.approx(0.5 + 20.0 / p, rel=1e-3)


def test_a_folder_of_records(command, portal, tmp_path):
    folder = tmp_path / "records"
    folder.mkdir()
    for i in (1, 2):
        rows = "\n".join(f"{0.01 * k:.2f},{0.05 * i * np.sin(0.0628 * k):.6f}" for k in range(101))
        (folder / f"r{i}.csv").write_text(f"time_s,ax_g\n{rows}\n")
    result, _ = command("run", portal, *MODEL, "--motion", folder, "--json")
    peaks = [run["peak_displacement_m"] for run in result["runs"]]
    assert 0.0 < peaks[0] < peaks[1]


@pytest.fixture(scope="module")
def fallen(tmp_path_factory):
    """Folder of a run in which the portal falls."""
    folder = tmp_path_factory.mktemp("fallen")
    (folder / "portal.toml").write_text(PORTAL)
    arguments = [*MODEL, "--harmonic", "0.7Hz,0.6g,4s", "--until-rest", "--output-interval", "0.05s"]
    assert call(["run", str(folder / "portal.toml"), *arguments, "--out", str(folder / "out")]) == 0
    return folder / "out"


def test_run_writes_its_files(fallen):
    names = {path.name for path in fallen.glob("[!.]*") if not path.name.startswith("response.")}
    pictures = {f"{name}.{end}" for name in ("histories", "filmstrip", "energy", "motion") for end in ("png", "svg")}
    assert names == pictures | {"run.json", "asked-run.json", "motion.csv"}
    written = json.loads((fallen / "run.json").read_text())
    assert written["outcome"] == "collapsed"
    assert written["fallen"]
    assert 0.0 < written["collapse_time_s"] < 10.0
    response = Response.load(fallen / "response.nc")
    assert response.summary().items() <= written.items()
    assert np.diff(response.time)[0] == pytest.approx(0.05, rel=0.25)  # whole chunks of steps


@pytest.mark.parametrize("kind", ["gif", "mp4", "html"])
def test_films(command, fallen, tmp_path, kind):
    result, _ = command(
        "animate", fallen / "response.nc", "--format", kind, "--fps", "5", "--out", tmp_path / "film", "--json"
    )
    assert result["files"] == [str(tmp_path / "film" / f"response.{kind}")]
    assert result["outcome"] == "collapsed"
    assert (tmp_path / "film" / f"response.{kind}").stat().st_size > 5000


def test_a_person_is_told(command, portal):
    text, _ = command("run", portal, *SHAKEN)
    assert text.startswith("All 3 blocks stand: no joint opened. Everything lies still.")
    for words in ("assembly", "portal, 3 blocks, 4 joints", "harmonic 1 Hz, 0.02 g", "dem2d", "peak displacement"):
        assert words in text
    still_moving, _ = command("run", portal, *MODEL, "--harmonic", "1Hz,0.4g,1s")
    assert "Not everything lies still; go on with --until-rest." in still_moving
    waited, _ = command("run", portal, *MODEL, "--harmonic", "1Hz,0.4g,1s", "--until-rest", "--set", "restitution=1")
    assert "Not everything lies still; damp it with --set mass_damping=0.5." in waited


def test_clockwise_blocks_are_turned_and_said(command, portal):
    plain, _ = command("run", portal, *SHAKEN, "--json")
    portal.write_text(PORTAL.replace(RIGHT, "[[0.9, 3.0], [1.5, 3.0], [1.5, 0.0], [0.9, 0.0]]"))
    turned, warnings = command("run", portal, *SHAKEN, "--json")
    assert warnings == ["stylobate: warning: the vertices of block 'right' run clockwise; they are turned round."]
    assert turned["peak_displacement_m"] == pytest.approx(plain["peak_displacement_m"], rel=1e-9)


def test_blocks_in_the_air_fall_and_it_is_said(command, portal):
    portal.write_text(PORTAL.replace(RIGHT, "[[4.0, 1.0], [5.0, 1.0], [5.0, 2.0], [4.0, 2.0]]"))
    result, warnings = command("run", portal, *SHAKEN, "--until-rest", "--json")
    assert warnings[0] == "stylobate: warning: block 'right' touches nothing: it will fall."
    assert "'portal' is not in equilibrium as drawn; it moves from the start." in warnings[1]
    assert len(warnings) == 2
    assert result["in_equilibrium_as_drawn"] is False
    assert "right" in result["fallen"]


@pytest.fixture
def refused(capsys, tmp_path):
    """Runs a command line that must be refused; returns its sentence."""

    def run(*arguments):
        seen = {path.name for path in tmp_path.iterdir()}
        code = call([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert code == 2, err
        assert out == ""
        (line,) = err.splitlines()
        assert line.startswith("stylobate: ")
        assert line.endswith((".", "?"))
        assert {path.name for path in tmp_path.iterdir()} == seen
        return line

    return run


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ((RIGHT, "[[0.9, 0.0], [1.5, 0.0], [1.5, 3.1], [0.9, 3.1]]"), ["'beam'", "'right'", "overlap by 100 mm"]),
        ((RIGHT, "[[0.9, -0.01], [1.5, -0.01], [1.5, 3.0], [0.9, 3.0]]"), ["'right' lies in the ground by 10 mm"]),
        ((RIGHT, "[[0.9, 0.0], [1.5, 0.0], [1.1, 1.0], [0.9, 3.0]]"), ["'right' is not convex at vertex (1.1, 1)"]),
        ((RIGHT, "[[0.9, 0.0], [1.5, 3.0], [1.5, 0.0], [0.9, 3.0]]"), ["'right'"]),
        ((RIGHT, "[[0.9, 0.0], [1.0, 0.0], [1.5, 0.0]]"), ["'right' has no area"]),
        ((RIGHT, "[[0.9, 0.0], [0.9, 0.0], [1.5, 0.0], [1.5, 3.0]]"), ["'right' has vertex 1 twice in succession"]),
        ((RIGHT, "[[0.9, 0.0], [1.5, 3.0]]"), ["'right' needs 3 to 24 vertices"]),
        ((RIGHT, "[[0.9, 0.0], [1.5, 3.0, 1.0], [0.9, 3.0]]"), ["'right' needs 3 to 24 vertices"]),
        ((RIGHT, "[[0.9, 0.0], [nan, 0.0], [1.5, 3.0]]"), ["'right' has a vertex that is not finite"]),
        (
            (RIGHT, '[["a", 0.0], [1.5, 0.0], [1.5, 3.0]]'),
            ["number 1 of number 1 of 'vertices' in [[block]] number 2 is 'a'"],
        ),
        ((RIGHT, "3"), ["'vertices' in [[block]] number 2 is 3; it must be a list"]),
        (("density = 2000.0", "densty = 2000.0"), ["'densty'", "[[block]] number 3", "did you mean density?"]),
        (("density = 2000.0", "density = -1.0"), ["density of block 'beam' is -1 kg/m³"]),
        (("density = 2000.0", "depth = 0.0"), ["depth of block 'beam' is 0 m"]),
        (("density = 2400.0\n", ""), ["block 'left' has no density"]),
        (('name = "right"', 'name = "left"'), ["two blocks are called 'left'"]),
        (('["left", "beam"]', '["left", "bean"]'), ["'bean', which does not exist"]),
        (('["left", "beam"]', '["beam"]'), ["between 1 blocks"]),
        (('["left", "beam"]', '["beam", "beam"]'), ["'beam'", "twice"]),
        (("[joint]", "[jiont]"), ["'jiont'", "did you mean joint?"]),
        (("friction_angle = 35.0", "friction_angle = 95.0"), ["friction_angle", "95"]),
        (("friction_angle = 20.0\n", "friction_angle = 20.0\nindex = 3\n"), ["'index'", "[[joint_override]] number 1"]),
        (('name = "portal"', "name = 3"), ["'name' is 3", "a text"]),
        (('name = "portal"', "ground = true"), ["ground is true", "level in m"]),
        (('name = "portal"', "gravity = -9.81"), ["gravity is -9.81 m/s²"]),
    ],
)
def test_bad_files(change, words, refused, portal, tmp_path):
    assert change[0] in PORTAL
    portal.write_text(PORTAL.replace(*change, 1))
    message = refused("run", portal, *SHAKEN, "--json", "--out", tmp_path / "never")
    for word in [str(portal), *words]:
        assert word in message, message


def test_a_law_with_a_ground_that_is_not_there(refused, portal):
    portal.write_text("ground = false\n" + PORTAL.replace('["left", "beam"]', '["left", "ground"]'))
    assert "names block 'ground', which does not exist" in refused("run", portal, *SHAKEN)


def test_nothing_that_can_move(refused, portal):
    portal.write_text(PORTAL.replace("[[block]]\n", "[[block]]\nfixed = true\n"))
    assert "no block of 'portal' can move" in refused("run", portal, *SHAKEN)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            ["--model", "housner", "--harmonic", "1Hz,0.1g,1s"],
            ["housner cannot shake", "is an assembly; dem2d"],
        ),
        (["--model", "rigid-block", "--harmonic", "1Hz,0.1g,1s"], ["rigid-block cannot shake", "is an assembly"]),
        ([*SHAKEN, "--set", "block_modulus=1e10"], ["block_modulus is 1e+10 Pa", "rigid"]),
        ([*SHAKEN, "--set", "time_step=0.1"], ["time_step is 0.1 s", "'portal'"]),
        ([*MODEL], ["no motion is given"]),
    ],
)
def test_bad_options(arguments, words, refused, portal, tmp_path):
    message = refused("run", portal, *arguments, "--out", tmp_path / "never")
    for word in words:
        assert word in message, message


def test_what_does_not_stand_cannot_settle(portal, capsys, tmp_path):
    portal.write_text(PORTAL.replace(RIGHT, "[[4.0, 1.0], [5.0, 1.0], [5.0, 2.0], [4.0, 2.0]]"))
    assert call(["run", str(portal), *SHAKEN, "--set", "start=settle", "--out", str(tmp_path / "never")]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert "'portal' is not in equilibrium as drawn; support its blocks, or leave start=settle out" in err
    assert not (tmp_path / "never").exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ["domain", "PORTAL", *MODEL, "--frequencies", "1:2:2", "--amplitudes", "0.1g:0.2g:2"],
        ["pushover", "PORTAL"],
        ["compare", "PORTAL", "--models", "dem2d", "--frequencies", "1:2:2", "--amplitudes", "0.1g:0.2g:2"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_commands_for_columns_refuse_assemblies(arguments, refused, portal):
    message = refused(*(portal if argument == "PORTAL" else argument for argument in arguments))
    assert "describes an assembly of blocks, and this is for columns; give a preset" in message


def test_settings_of_the_model_side_by_side(command, refused, portal, tmp_path):
    """What moves farthest stands for the top of a column."""
    arguments = [
        "compare",
        portal,
        "--models",
        "dem2d,dem2d:points=3",
        "--harmonic",
        "1Hz,0.25g,1s",
        "--out",
        tmp_path / "out",
    ]
    answer, _ = command(*arguments, "--json")
    assert [run["peak_displacement_m"] > 0.01 for run in answer["runs"]] == [True, True]
    text, _ = command(*arguments)
    assert "peak_tilt_rad" not in text  # bodies of their own are in the files
    command("report", tmp_path / "out", "--out", tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Displacement of the body that has moved farthest of each model" in page
    assert "dem3d cannot shake 'portal', which is an assembly; dem2d" in refused(
        "compare", portal, "--models", "dem3d", "--harmonic", "1Hz,0.1g,1s"
    )


def test_animate_refuses_what_is_no_response(refused, portal):
    assert "cannot be read as netCDF" in refused("animate", portal)
