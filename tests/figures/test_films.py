"""Films: frames that differ where the column moves, files that open, a page that needs no network."""

import json
import re

import numpy as np
import pytest

from stylobate.cli.main import call
from stylobate.column import Column, Joint
from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.models.distinct_element_2d import DistinctElement2D
from stylobate.motion import harmonic
from stylobate.plots.animation import draw_frame, frame_indices, write_gif
from stylobate.plots.player import write_player
from stylobate.plots.scene import scene_of
from stylobate.simulate import simulate


@pytest.fixture(scope="module")
def fall():
    joint = Joint(1e8, 5e7, friction_coefficient=0.7)
    column = Column.tapered(height=2.0, bottom_width=0.4, top_width=0.3, drums=2, density=2000.0, joint=joint)
    return simulate(column, harmonic(0.8, 0.5 * g, 2.0), DistinctElement2D(), until_rest=True, output_interval=0.02)


def test_outlines_keep_their_shape_and_lie_on_the_ground(fall):
    assert fall.collapsed
    for index in (0, len(fall.time) // 2, len(fall.time) - 1):
        for corners, drum in zip(scene_of(fall).outlines(index), fall.column.drums, strict=True):
            sides = np.hypot(*(np.roll(corners, -1, axis=0) - corners).T)
            assert sides[0] == pytest.approx(drum.bottom_width)
            assert sides[2] == pytest.approx(drum.top_width)
    lowest = [corners[:, 1].min() for corners in scene_of(fall).outlines(len(fall.time) - 1)]
    assert max(lowest) < 0.5
    assert min(lowest) > -2e-3


def test_a_gif_has_its_frames(fall, tmp_path):
    from PIL import Image

    path = write_gif(fall, tmp_path / "fall.gif", frames_per_second=4.0)
    with Image.open(path) as film:
        assert film.n_frames > 5
        assert film.n_frames <= len(frame_indices(fall.time, 4.0, 1.0))  # equal frames are shown for longer
        first = np.asarray(film.convert("RGB")).astype(int)
        film.seek(film.n_frames - 1)
        last = np.asarray(film.convert("RGB")).astype(int)
    assert (np.abs(first - last).sum(axis=2) > 30).mean() > 0.01


def test_a_frame_says_when(fall):
    index = len(fall.time) // 2
    title = draw_frame(scene_of(fall), index).axes[0].get_title(loc="left")
    assert f"{fall.time[index]:.2f} s" in title


def test_the_page_is_whole_and_alone(fall, tmp_path):
    page = write_player(fall, tmp_path / "fall.html").read_text()
    assert not re.search(r"https?://|src=|@import|fetch\(", page)
    assert fall.provenance["mechanism"]["sentence"] in page
    data = json.loads(re.search(r"const data = (.*);\n", page)[1])
    assert len(data["poses"]) == len(data["time"]) == len(data["ground"])
    assert data["poses"][-1][1] == pytest.approx(
        [fall.drum_x[-1, 1], fall.column.centroid_heights[1] + fall.drum_z[-1, 1], fall.drum_rotation[-1, 1]], abs=0.02
    )


def test_the_command_writes_a_film(fall, tmp_path, capsys):
    saved = fall.save(tmp_path / "response.nc")
    assert call(["animate", str(saved), "--format", "html", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["files"] == [str(tmp_path / "response.html")]
    assert (tmp_path / "response.html").exists()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [(["--format", "avi"], "allowed are gif, mp4, html"), (["--fps", "0"], "--fps"), (["--speed", "fast"], "--speed")],
)
def test_bad_input_of_the_command(fall, tmp_path, capsys, arguments, says):
    saved = fall.save(tmp_path / "response.nc")
    assert call(["animate", str(saved), *arguments]) == 2
    assert says in capsys.readouterr().err


def test_a_film_that_is_too_long_is_refused(fall):
    with pytest.raises(InputError, match="allowed are 5000"):
        frame_indices(fall.time, 100.0, 1e-3)
