"""Films of columns and assemblies: frames that differ where things move, files that open, a page that needs no network."""

import json
import re
import shutil
import subprocess

import numpy as np
import pytest

import stylobate as st
from stylobate import plots
from stylobate.cli.main import call
from stylobate.column import Column, Joint
from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.motion import harmonic
from stylobate.plots.film import draw_frame, frame_indices, write_gif, write_mp4, write_player
from stylobate.plots.scene import Scene, scale_bar
from stylobate.response.poses import rotation_matrices
from stylobate.simulate import simulate


@pytest.fixture(scope="module")
def fall():
    joint = Joint(1e8, 5e7, friction_coefficient=0.7)
    column = Column.tapered(height=2.0, bottom_width=0.4, top_width=0.3, drums=2, density=2000.0, joint=joint)
    return simulate(column, harmonic(0.8, 0.5 * g, 2.0), DistinctElement2D(), until_rest=True, output_interval=0.02)


@pytest.fixture(scope="module")
def knocked():
    """A leaning block that falls on a second one, beside a support, on a ground below 0."""
    lean = ((0.0, -0.5), (0.4, -0.3), (-0.2, 0.9), (-0.6, 0.7))
    blocks = (
        st.Block(tuple((x - 0.2, z) for x, z in lean), 2000.0, "leaning"),
        st.Block(((-1.7, -0.5), (-1.4, -0.5), (-1.4, 0.6), (-1.7, 0.6)), 2000.0, "upright"),
        st.Block(((1.0, -0.5), (9.0, -0.5), (9.0, -0.2), (1.0, -0.2)), 0.0, "step", fixed=True),
    )
    assembly = st.Assembly(blocks, Joint(1e8, 5e7, friction_coefficient=0.7), "two blocks", ground=-0.5)
    with pytest.warns(UserWarning, match="not in equilibrium"):
        return simulate(
            assembly, st.Motion(0.01, np.zeros(101)), DistinctElement2D(), until_rest=True, output_interval=0.02
        )


@pytest.mark.parametrize("name", ["fall", "knocked"])
def test_the_scene_is_the_response(name, request):
    response = request.getfixturevalue(name)
    scene = Scene(response)
    bodies = range(response.column.n) if name == "fall" else (1, 2, 3)
    for index in (0, len(response.time) // 2, len(response.time) - 1):
        for corners, body in zip(scene.outlines(index), bodies, strict=True):
            np.testing.assert_allclose(corners, response.outline(index, body), atol=1e-12)


def test_the_scene_of_a_column_as_found():
    joint = Joint(1e8, 5e7, friction_coefficient=0.7)
    column = Column.tapered(height=2.0, bottom_width=0.4, top_width=0.3, drums=2, density=2000.0, joint=joint)
    as_found = st.AsFound((st.FoundDrum(2, offset=0.05, chip_left=0.03),), base_tilt=2.0)
    response = simulate(column.replace(as_found=as_found), harmonic(0.8, 0.2 * g, 1.0), DistinctElement2D())
    scene = Scene(response)
    assert scene.slope == pytest.approx(np.tan(np.radians(2.0)))
    for index in (0, len(response.time) // 2):
        for factor in (1.0, 20.0):
            for i, corners in enumerate(scene.outlines(index, factor)):
                np.testing.assert_allclose(corners, response.outline(index, i, factor), atol=1e-12)


def test_a_picture_holds_what_moves_and_its_ground(knocked):
    assert set(knocked.fallen) == {"leaning", "upright"}
    scene = Scene(knocked)
    left, right, bottom, top = scene.view(np.arange(len(knocked.time)))
    for index in range(len(knocked.time)):
        for corners in scene.outlines(index)[:2]:
            assert left < corners[:, 0].min()
            assert corners[:, 0].max() < right
            assert corners[:, 1].max() < top
    assert bottom < -0.5
    assert 1.0 < right < 5.0  # the support is seen, but not all of its 8 m
    drawn = draw_frame(scene, 0).axes[0]
    assert len(drawn.patches) == 3


def test_a_narrow_column_does_not_fill_the_picture():
    joint = Joint(1e8, 5e7, friction_coefficient=0.7)
    column = Column.tapered(height=6.0, bottom_width=0.6, top_width=0.5, drums=3, density=2000.0, joint=joint)
    response = simulate(column, harmonic(2.0, 0.01 * g, 0.5), DistinctElement2D())
    left, right, bottom, top = Scene(response).view(np.array([0]), 1.6)
    assert right - left == pytest.approx(1.6 * (top - bottom))
    assert left == pytest.approx(-right)
    low, high, _, _ = Scene(response).view(np.array([0]))
    assert high - low < 1.5


@pytest.mark.parametrize(("width", "length"), [(4.9, 0.5), (5.1, 1.0), (26.0, 5.0), (0.3, 0.05)])
def test_the_scale_is_a_round_length(width, length):
    assert scale_bar(width) == pytest.approx(length)


def test_pictures_of_an_assembly(knocked):
    strip = plots.draw_filmstrip(knocked)
    shown = [axes for axes in strip.axes if axes.patches]
    assert 4 <= len(shown) <= 8
    times = [float(axes.get_title().split(" s")[0]) for axes in shown]
    assert times[0] == 0.0
    assert times[-1] == pytest.approx(knocked.time[-1], abs=0.005)
    assert times == sorted(set(times))
    across, down, ground = plots.draw_histories(knocked).axes
    assert {line.get_label() for line in across.lines if line.get_label()[0] != "_"} == {"leaning", "upright"}
    assert "[m]" in across.get_ylabel()
    assert "[m]" in down.get_ylabel()
    assert "[g]" in ground.get_ylabel()
    upper, lower = plots.draw_energy(knocked).axes
    assert "energy" in upper.get_ylabel()
    assert "/ released" in lower.get_ylabel()


def test_outlines_keep_their_shape_and_lie_on_the_ground(fall):
    assert fall.collapsed
    for index in (0, len(fall.time) // 2, len(fall.time) - 1):
        for corners, drum in zip(Scene(fall).outlines(index), fall.column.drums, strict=True):
            sides = np.hypot(*(np.roll(corners, -1, axis=0) - corners).T)
            assert sides[0] == pytest.approx(drum.bottom_width)
            assert sides[2] == pytest.approx(drum.top_width)
    lowest = [corners[:, 1].min() for corners in Scene(fall).outlines(len(fall.time) - 1)]
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


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # the reader leaves its pipes open
@pytest.mark.parametrize("name", ["fall", "knocked"])
def test_an_mp4_plays(name, request, tmp_path):
    reader = pytest.importorskip("imageio_ffmpeg")
    response = request.getfixturevalue(name)
    path = write_mp4(response, tmp_path / "film.mp4", frames_per_second=5.0, speed=0.5)
    film = reader.read_frames(str(path))
    facts = next(film)
    frames = [np.frombuffer(frame, dtype=np.uint8).astype(int) for frame in film]
    assert facts["fps"] == 5.0
    assert facts["codec"] == "h264"
    assert facts["size"] == (640, 480)
    # as many frames as were asked for, whatever was recorded between them: it lasts twice as long as it took
    assert len(frames) == pytest.approx(2.0 * 5.0 * response.time[-1], abs=1.5)
    assert (np.abs(frames[0] - frames[-1]) > 30).mean() > 0.01


def test_a_film_is_as_long_as_it_took(fall, tmp_path):
    from PIL import Image

    begin, end = fall.time[-1] - 1.2, fall.time[-1]  # at more frames than were recorded
    path = write_gif(fall, tmp_path / "fall.gif", frames_per_second=80.0, window=(begin, end))
    with Image.open(path) as film:
        shown = 0.0
        for k in range(film.n_frames):
            film.seek(k)
            shown += film.info["duration"] / 1000.0
    assert shown == pytest.approx(end - begin, abs=0.1)


def test_a_frame_says_when(fall):
    index = len(fall.time) // 2
    title = draw_frame(Scene(fall), index).axes[0].get_title(loc="left")
    assert f"{fall.time[index]:.2f} s" in title


def test_the_page_is_whole_and_alone(fall, tmp_path):
    page = write_player(fall, tmp_path / "fall.html").read_text()
    assert not re.search(r"https?://|src=|@import|fetch\(", page)
    assert fall.mechanism.describe() in page
    data = json.loads(re.search(r"const data = (.*);\n", page)[1])
    assert len(data["poses"]) == len(data["time"]) == len(data["ground"])
    x, _, z, w, _, j, _ = data["poses"][-1][1]
    assert [x, z, -2.0 * np.arctan2(j, w)] == pytest.approx(
        [fall.drum_x[-1, 1], fall.column.centroid_heights[1] + fall.drum_z[-1, 1], fall.drum_rotation[-1, 1]], abs=0.02
    )


def test_the_page_of_an_assembly(knocked, tmp_path):
    page = write_player(knocked, tmp_path / "knocked.html", frames_per_second=10.0).read_text()
    data = json.loads(re.search(r"const data = (.*);\n", page)[1])
    assert knocked.describe() in page
    assert data["level"] == -0.5
    assert data["fixed"] == [False, False, True]
    for shape, pose, body in zip(data["shapes"], data["poses"][-1], (1, 2, 3), strict=True):
        drawn = np.array(shape) @ rotation_matrices(np.array(pose[3:])).T + pose[:3]
        corners = knocked.outline(-1, body)
        np.testing.assert_allclose(drawn[: len(corners), [0, 2]], corners, atol=2e-3)


def test_names_do_not_break_the_page(knocked, tmp_path):
    """Words of the template and of HTML may be names."""
    import dataclasses

    blocks = [
        dataclasses.replace(block, name=name) for block, name in zip(knocked.assembly.blocks, ("DATA", "<b>", "TITLE"))
    ]
    assembly = dataclasses.replace(knocked.assembly, blocks=tuple(blocks), name="SENTENCE & DATA")
    fell = tuple((name, time) for name, (_, time) in zip(("DATA", "<b>"), knocked.measures.blocks.fell_at))
    measures = dataclasses.replace(knocked.measures, blocks=dataclasses.replace(knocked.measures.blocks, fell_at=fell))
    renamed = dataclasses.replace(knocked, structure=assembly, measures=measures)
    page = write_player(renamed, tmp_path / "names.html").read_text()
    assert "<title>SENTENCE &amp; DATA, " in page
    assert "&lt;b&gt;" in page
    assert len(re.findall(r"const data = \{", page)) == 1


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


def test_a_window_of_time(fall, tmp_path):
    """Histories, joints, energy, films and the page show what is asked for, and no more."""
    window = (0.5, 1.5)
    for draw in (plots.draw_histories, plots.draw_joints, plots.draw_energy):
        for axes in draw(fall, window=window).axes:
            assert axes.get_xlim() == window
    shown = fall.time[frame_indices(fall.time, 10.0, 1.0, window)]
    assert shown[0] == pytest.approx(0.5, abs=0.06)
    assert shown[-1] == pytest.approx(1.5, abs=0.06)
    page = write_player(fall, tmp_path / "fall.html", window=window).read_text()
    times = json.loads(re.search(r"const data = (.*);\n", page)[1])["time"]
    assert [times[0], times[-1]] == pytest.approx(window, abs=0.06)
    with pytest.raises(InputError, match="the window from 9 to 7 s holds nothing"):
        plots.draw_histories(fall, window=(9.0, 7.0))


def test_a_film_says_how_far_it_is(fall, tmp_path):
    calls = []
    write_gif(
        fall, tmp_path / "a.gif", frames_per_second=5.0, window=(0.0, 1.0), progress=lambda *how: calls.append(how)
    )
    assert calls == [(i + 1, len(calls)) for i in range(len(calls))]
    assert len(calls) == 6


def test_the_command_takes_a_window(fall, tmp_path, capsys):
    saved = fall.save(tmp_path / "response.nc")
    assert call(["animate", str(saved), "--format", "html", "--from", "0.5s", "--to", "1s"]) == 0
    assert call(["animate", str(saved), "--format", "html", "--from", "2s", "--to", "1s"]) == 2
    assert "the window from 2 to 1 s holds nothing" in capsys.readouterr().err


def test_pictures_are_drawn_in_a_figure_that_is_given(fall):
    from matplotlib.figure import Figure

    for draw in (plots.draw_histories, plots.draw_joints, plots.draw_energy, plots.draw_filmstrip):
        whole = Figure(figsize=(12, 5))
        left, right = whole.subfigures(1, 2)
        assert draw(fall, figure=left) is left
        assert left.axes
        assert not right.axes
        whole.draw_without_rendering()


def test_the_strip_of_a_fallen_column_has_a_usable_scale(fall):
    """Debris that lies far apart takes a row of its own instead of making everything small."""
    strip = plots.draw_filmstrip(fall)
    strip.draw_without_rendering()
    scales = []
    for axes in strip.axes:
        low, high = axes.get_xlim()
        scales.append(axes.get_window_extent().width / strip.dpi / (high - low))
    assert max(scales) == pytest.approx(min(scales), rel=0.1)  # one scale
    standing = fall.column.height * min(scales)
    assert standing > 1.2  # inch


@pytest.mark.skipif(shutil.which("node") is None, reason="needs node")
def test_the_page_draws_the_outlines(knocked, tmp_path):
    """The script's own way from shapes and poses to what is drawn gives the outlines of the response."""
    page = write_player(knocked, tmp_path / "knocked.html", frames_per_second=10.0).read_text()
    data = re.search(r"const data = .*;\n", page)[0]
    laws = page[page.index("function placed(") : page.index("// Canvases have")]
    last = "JSON.stringify(data.shapes.map((s, i) => outline(s.map(c => placed(c, data.poses.at(-1)[i])))))"
    script = tmp_path / "page.js"
    script.write_text(f"{data}{laws}console.log({last});")
    drawn = json.loads(subprocess.run(["node", script], capture_output=True, text=True, check=True).stdout)
    for corners, body in zip(drawn, (1, 2, 3), strict=True):
        wanted = knocked.outline(-1, body)
        for corner in wanted:
            assert min(np.hypot(*(np.array(corners) - corner).T)) < 2e-3
