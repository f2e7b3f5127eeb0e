"""``stylobate calibrate``: a history in, losses out that other commands take; what tells nothing is refused."""

import json

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.files import losses_by, write_column, write_losses
from stylobate.models.drums.impact import released
from stylobate.models.registry import make_model


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """A block's file and its history, tilted by 0.15 rad and let go, in degrees."""
    folder = tmp_path_factory.mktemp("measured")
    size = {"height": 1.5, "bottom_width": 0.5, "top_width": 0.5, "density": 2700.0, "depth": 0.5}
    column = st.Column.tapered(**size, drums=1, joint=st.Joint(1e9, 5e8, friction_coefficient=0.7), name="block")
    free = released(column, st.DistinctElement2D(), [st.Losses(1e-3)], [st.Start(0.15)], 5.0, 0.002)[0]
    time = np.arange(0.0, 5.0, 0.005)
    tilt = np.degrees(
        np.interp(time, free.time, free.lean[:, 0]) + 3e-4 * np.random.default_rng(0).standard_normal(1000)
    )
    table = np.column_stack((time, tilt))
    np.savetxt(folder / "tilt.csv", table, "%.5f", ",", header="time_s,tilt_deg", comments="")
    write_column(column, folder / "block.toml")
    return folder


def test_a_history_becomes_losses_that_other_commands_take(measured, tmp_path, capsys):
    out, block = tmp_path / "found", str(measured / "block.toml")
    assert call(["calibrate", str(measured / "tilt.csv"), "--column", block, "--out", str(out), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    loss = answer["stiffness_damping"]
    assert loss["low"] < 1e-3 < loss["high"]
    assert answer["restitution"]["low"] < answer["restitution"]["value"] < answer["restitution"]["high"]
    names = {"losses.toml", "calibrate.json", "calibration.png", "calibration.svg", "asked-calibrate.json"}
    assert {path.name for path in out.iterdir()} == names | {".stylobate-files"}
    assert call(["run", block, "--harmonic", "1.0Hz,0.3g,2s", "--model", "dem3d", "--losses", str(out / "losses.toml"),
                 "--replicates", "0", "--json"]) == 0  # fmt: skip
    ran = json.loads(capsys.readouterr().out)
    assert ran["losses_acting"]["stiffness_damping"] == pytest.approx(loss["value"], rel=1e-12)
    assert call(["report", str(out), "--out", str(tmp_path / "r.html")]) == 0
    text = (tmp_path / "r.html").read_text(encoding="utf-8").replace("\N{NO-BREAK SPACE}", " ")
    assert answer["sentence"] in text
    assert f"{loss['value']:.4g}" in text
    assert "restitution by successive extremes" in text


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        ("time_s,tilt_deg\n" + "".join(f"{i / 100},{100 + i % 7}\n" for i in range(50)), [], "allowed is up to 90°"),
        ("time_s,wind_m\n" + "".join(f"{i / 100},{i % 7}\n" for i in range(50)), [], "unknown column 'wind_m'"),
        ("time_s,tilt\n" + "".join(f"{i / 100},{i % 7}\n" for i in range(50)), [], "states no unit"),
        ("time_s,tilt_mm\n" + "".join(f"{i / 100},{i % 7}\n" for i in range(50)), [], "unit of a tilt is 'mm'"),
        ("time_s,tilt_deg\n0.0,1\n0.01,1\n", [], "2 samples"),
        ("time_s,tilt_deg\n" + "".join(f"{i / 100 + (i > 30)},{i % 7}\n" for i in range(50)), [], "unlike the other steps"),
        ("1.0\n" * 50, ["--unit", "deg"], "state the step"),
        ("time_s,tilt_deg\n" + "".join(f"{i / 100},0.0\n" for i in range(50)), [], "swings"),
        ("nothing\n", [], "holds no columns"),
    ],
)  # fmt: skip
def test_what_tells_nothing_ends_in_one_sentence(measured, tmp_path, capsys, text, options, words):
    file, out = tmp_path / "history.csv", tmp_path / "out"
    file.write_text(text)
    arguments = ["calibrate", str(file), "--column", str(measured / "block.toml"), "--out", str(out), *options]
    assert call(arguments) == 2
    message = capsys.readouterr().err
    assert words in message
    assert message.count("\n") == 1
    assert not out.exists()


def test_a_file_of_losses_is_read_as_it_was_written(tmp_path):
    losses = st.Losses(3.2e-4, 0.004, "bed")
    file = write_losses(losses, tmp_path / "losses.toml", {"confidence": 0.9, "stiffness_damping": [1e-4, 1e-3]})
    assert st.read_losses(file) == losses
    assert make_model("dem3d", losses=str(file)) == st.DistinctElement3D(losses=losses)
    with pytest.raises(st.InputError, match="losses"):  # settings come from strangers, and name no files
        make_model("dem3d", {"losses": str(file)})
    with pytest.raises(st.InputError, match="rigid-block has no parameter"):
        make_model("rigid-block", losses=str(file))
    assert losses_by("stone") == "stone"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("stylobate_losses = 2\nstiffness_damping = 1e-4\n", "a format that this version does not know"),
        ("stylobate_losses = 1\n", "'stiffness_damping' is missing"),
        ("stylobate_losses = 1\nstiffness_damping = -1.0\n", "stiffness_damping of losses"),
        ("stylobate_losses = 1\nstiffness_damping = 1e-4\nlaw = 'ring'\n", "'rim' or 'bed'"),
        ("stylobate_losses = 1\nstiffness_damping = 1e-4\nfriction = 0.5\n", "unknown key 'friction'"),
    ],
)
def test_what_is_no_file_of_losses_is_refused(tmp_path, text, words):
    (tmp_path / "losses.toml").write_text(text)
    with pytest.raises(st.InputError, match=words):
        losses_by(str(tmp_path / "losses.toml"))
    with pytest.raises(st.InputError, match="or a file of losses"):
        losses_by("marble")


def test_losses_beside_what_they_decide_are_refused():
    with pytest.raises(st.InputError, match="both given"):
        st.DistinctElement3D(losses=st.Losses(1e-4), stiffness_damping=1e-4)
    with pytest.raises(st.InputError, match="law"):
        st.DistinctElement3D(losses=st.Losses(1e-4, law="rim"), law="bed")
