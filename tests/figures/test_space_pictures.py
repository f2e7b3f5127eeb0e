"""Pictures and films of columns in space: what stands on their axes are the numbers of the response."""

import json
import math
import re
import shutil
import subprocess
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from validation.space import round_column

import stylobate as st
from stylobate import plots
from stylobate.cli.main import call
from stylobate.column import Column, Joint
from stylobate.column.shapes import CircularFrustum, Glued, Placed, RectangularFrustum
from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.plots.film import draw_frame, film_of, write_gif, write_player
from stylobate.plots.histories import rim_radius, rim_uplift, round_factor
from stylobate.plots.scene import (
    ALONG_X,
    ALONG_Y,
    FLUTE,
    MARK,
    OBLIQUE,
    STONE,
    Scene,
    Solid,
    View,
    painted,
    painting_order,
    parse_view,
    surface_of,
    surfaces_of,
)
from stylobate.response.poses import SpacePoses, exaggerated, quaternions, rotation_matrices
from stylobate.simulate import simulate


@pytest.fixture(scope="module")
def shaken():
    joint = Joint(5e8, 2.5e8, friction_coefficient=0.7)
    column = Column.tapered(
        height=8.0, bottom_width=1.2, top_width=0.95, drums=12, density=2400.0, joint=joint, section="circular"
    )
    time = np.arange(0.0, 2.0, 0.01)
    motion = st.Motion(0.01, 0.2 * g * np.sin(5.0 * time), 0.1 * g * np.sin(6.0 * time + 1.0))
    response = simulate(column, motion, DistinctElement3D(), output_interval=0.02)
    assert not response.collapsed
    assert np.abs(response.twist[-1]).max() > 1e-5
    return response


def _posed(response, position, orientation):
    histories = replace(response.histories, poses=SpacePoses(position, orientation))
    return replace(response, histories=histories)


def _about(axis, angle):
    return np.array([math.cos(0.5 * angle), *(math.sin(0.5 * angle) * np.array(axis, dtype=float))])


def test_the_orbit_is_the_way_of_the_top(shaken):
    axes = plots.draw_orbit(shaken).axes[0]
    way = next(line for line in axes.lines if len(line.get_xdata()) == len(shaken.time))
    peak = np.hypot(*shaken.top_displacement.T).max()
    factor, unit = (1.0, "[m]") if peak >= 0.1 else (1000.0, "[mm]")
    np.testing.assert_allclose(np.stack(way.get_data(), axis=1), factor * shaken.top_displacement)
    assert unit in axes.get_xlabel()
    assert axes.get_aspect() == 1.0
    assert axes.patches[0].width == pytest.approx(1.2 * factor)


def test_histories_have_a_panel_for_each_direction(shaken):
    along, across, ground = plots.draw_histories(shaken).axes
    for k, axes in enumerate((along, across)):
        top, base = (next(line for line in axes.lines if line.get_label() == name) for name in ("top", "base"))
        np.testing.assert_array_equal(top.get_ydata(), shaken.top_displacement[:, k])
        np.testing.assert_array_equal(base.get_ydata(), shaken.base_displacement[:, k])
        assert axes.get_ylabel().startswith("xy"[k])
    assert along.get_ylim() == across.get_ylim()
    for k, line in enumerate(curve for curve in ground.lines if curve.get_label() in ("x", "y")):
        np.testing.assert_array_equal(line.get_ydata(), shaken.ground_acceleration[:, k] / g)


def test_a_strip_shows_both_elevations(shaken):
    instants = [0.0, 0.9, 1.5]
    panels = [axes for axes in plots.draw_filmstrip(shaken, instants, magnification=1.0).axes if axes.patches]
    assert len(panels) == 6
    for number, axes in enumerate(panels):
        direction, index = divmod(number, 3)
        state = int(np.abs(shaken.time - instants[index]).argmin())
        assert axes.get_title().split("\n")[1].startswith("xy"[direction])
        turns = rotation_matrices(shaken.body_orientation[state])
        for drum, patch in enumerate(axes.patches):
            vertices = shaken.bodies.shapes[drum].mesh(40).vertices @ turns[drum].T + shaken.body_position[state, drum]
            drawn = patch.get_xy()
            np.testing.assert_allclose(drawn.max(axis=0), vertices[:, [direction, 2]].max(axis=0), atol=1e-12)
            np.testing.assert_allclose(drawn.min(axis=0), vertices[:, [direction, 2]].min(axis=0), atol=1e-12)


@pytest.mark.parametrize(("toward", "twist"), [(0.0, 0.0), (2.2, 0.7)])
def test_uplift_of_a_drum_tilted_over_its_edge(shaken, toward, twist):
    """A drum that leans on one point of its rim opens by r sin(tilt) (1 − cos(azimuth from there))."""
    tilt, joint = 0.05, 3
    position, orientation = (
        np.repeat(history[:1], 2, axis=0) for history in (shaken.body_position, shaken.body_orientation)
    )
    shape, lower = shaken.bodies.shapes[joint], shaken.bodies.shapes[joint - 1]
    orientation[:] = [1.0, 0.0, 0.0, 0.0]
    position[:, joint] = position[:, joint - 1] + [0.0, 0.0, lower.height - lower.centroid + shape.centroid]
    away = np.array([math.cos(toward), math.sin(toward), 0.0])
    lean = _about((-away[1], away[0], 0.0), tilt)
    own = _about((0.0, 0.0, 1.0), twist)
    w, x, y, _ = lean
    orientation[1, joint] = [w * own[0], x * own[0] + y * own[3], y * own[0] - x * own[3], w * own[3]]
    radius = 0.5 * shape.bottom
    edge = position[0, joint] + radius * away - [0.0, 0.0, shape.centroid]
    turned = rotation_matrices(orientation[1, joint])
    position[1, joint] = edge - rotation_matrices(lean) @ (radius * away - np.array([0.0, 0.0, shape.centroid]))
    np.testing.assert_allclose(turned[:, 2], rotation_matrices(lean)[:, 2], atol=1e-12)
    azimuth = np.arange(24) * (math.pi / 12)
    uplift = rim_uplift(_posed(shaken, position, orientation), joint, azimuth)[1]
    np.testing.assert_allclose(uplift, radius * math.sin(tilt) * (1.0 - np.cos(azimuth - toward)), atol=1e-9)


def test_uplift_by_direction_is_drawn_in_millimetres(shaken):
    azimuth = np.arange(72) * (2.0 * math.pi / 72)
    panels = plots.draw_uplift(shaken).axes
    assert len(panels) == 12
    for joint, axes in enumerate(panels):
        wanted = 1000.0 * rim_uplift(shaken, joint, azimuth).max(axis=0).clip(0.0)
        np.testing.assert_allclose(axes.patches[0].get_xy()[:72, 1], wanted, atol=1e-12)
        assert f"joint {joint + 1}\n" in axes.get_title()


def test_the_rim_of_a_rectangle():
    shape = RectangularFrustum((2.0, 1.0), (1.0, 0.5), 1.0, 0.4)
    azimuth = np.array([0.0, math.atan2(0.5, 1.0), 0.5 * math.pi, -math.pi])
    np.testing.assert_allclose(rim_radius(shape, False, azimuth), [1.0, math.hypot(1.0, 0.5), 0.5, 1.0])
    np.testing.assert_allclose(rim_radius(shape, True, azimuth), [0.5, math.hypot(0.5, 0.25), 0.25, 0.5])


def test_residuals_are_those_of_the_response(shaken):
    panels = plots.draw_residuals(shaken).axes
    slip, twist = shaken.slip[-1], shaken.twist[-1]
    largest = 0.5 * shaken.column.drums[0].bottom_width
    far, turned = round_factor(0.3 * largest / np.hypot(*slip.T).max()), round_factor(0.5 / np.abs(twist).max())
    for drum, axes in enumerate(panels):
        mark = next(line for line in axes.lines if line.get_linewidth() == 1.6)
        (x, end), (y, high) = mark.get_data()
        np.testing.assert_allclose((x, y), far * slip[drum], atol=1e-12)
        assert math.atan2(high - y, end - x) == pytest.approx(turned * twist[drum], abs=1e-9)
        title = axes.get_title().replace("−", "-")
        assert float(re.search(r"([\d.]+) mm", title)[1]) == pytest.approx(1000.0 * np.hypot(*slip[drum]), abs=0.0501)
        assert float(re.search(r"twist (\S+)°", title)[1]) == pytest.approx(math.degrees(twist[drum]), abs=0.00501)
    assert [round_factor(wanted) for wanted in (0.3, 1.9, 2.0, 49.0, 700.0)] == [1.0, 1.0, 2.0, 20.0, 500.0]


def _thrown(random, count=7):
    """Bodies that do not touch: each in a cell of its own."""
    cells = random.permutation([(i, j, k) for i in range(2) for j in range(2) for k in range(2)])[:count]
    solids = []
    for number, cell in enumerate(cells):
        size = random.uniform(0.3, 0.6, 2)
        shape = (
            CircularFrustum(size[0], size[1], 0.5, 0.25)
            if number % 2
            else RectangularFrustum((size[0], size[1]), (size[0], size[1]), 0.5, 0.25)
        )
        turn = random.normal(size=4)
        solids.append(Solid(surface_of(shape), np.asarray(cell, float), rotation_matrices(turn / np.linalg.norm(turn))))
    return solids


def test_what_is_nearer_is_painted_later():
    """Along many lines of sight, the body that is painted last is the one that the eye meets first."""
    random, hidden = np.random.default_rng(0), 0
    for _ in range(6):
        solids, view = _thrown(random), View(random.uniform(-3.0, 3.0), random.uniform(0.0, 1.5))
        rank = {number: place for place, number in enumerate(painting_order(solids, view))}
        for x, y in random.uniform(-1.2, 1.2, (300, 2)):
            eye = np.full(3, 0.5) + x * view.right + y * view.up
            met = {}
            for number, solid in enumerate(solids):
                slope, height = solid.normals @ view.toward, solid.levels - solid.normals @ eye
                leaves = (height[slope > 1e-12] / slope[slope > 1e-12]).min()
                enters = (height[slope < -1e-12] / slope[slope < -1e-12]).max()
                if enters < leaves and (height[np.abs(slope) <= 1e-12] >= 0.0).all():
                    met[number] = leaves
            if len(met) > 1:
                hidden += 1
                assert max(met, key=met.__getitem__) == max(met, key=rank.__getitem__)
    assert hidden > 60


def test_a_small_block_before_a_tall_one_is_painted_after_it():
    """By the distance of its middle the tall one, seen from above, would come last."""
    tall = Solid(surface_of(RectangularFrustum((0.5, 0.5), (0.5, 0.5), 8.0, 4.0)), np.array([0.0, 0.0, 4.0]), np.eye(3))
    small = Solid(
        surface_of(RectangularFrustum((0.5, 0.5), (0.5, 0.5), 0.5, 0.25)), np.array([1.0, 0.0, 0.25]), np.eye(3)
    )
    assert tall.place @ View(0.0, 0.5).toward > small.place @ View(0.0, 0.5).toward
    assert painting_order([small, tall], View(0.0, 0.5)) == [1, 0]
    assert painting_order([small, tall], View(math.pi, 0.5)) == [0, 1]


def test_parts_of_one_body_are_painted_one_by_one():
    """A neck under a wide slab: its outline is its own, and from above the slab hides it, in whichever order."""
    neck = Placed(RectangularFrustum((0.4, 0.4), (0.4, 0.4), 1.0, 0.5), (0.0, 0.0, -0.5))
    slab = Placed(RectangularFrustum((2.0, 2.0), (2.0, 2.0), 0.2, 0.1), (0.0, 0.0, 0.1))
    for parts, place in (((neck, slab), 0), ((slab, neck), 1)):
        surfaces = surfaces_of(Glued(parts))
        solids = [Solid(surface, np.zeros(3), np.eye(3)) for surface in surfaces]
        assert np.ptp(surfaces[place].vertices, axis=0) == pytest.approx([0.4, 0.4, 1.0])
        assert painting_order(solids, View(-0.5, 0.9)) == [place, 1 - place]
    assert len(surfaces_of(neck.shape)) == 1


@pytest.mark.parametrize(
    "shape", [CircularFrustum(1.0, 0.8, 0.5, 0.25), RectangularFrustum((1.0, 0.8), (1.0, 0.8), 0.5, 0.25)]
)
def test_the_mark_turns_with_the_drum(shape):
    surface = surface_of(shape)
    marked = [tone == MARK for tone in surface.tones]
    assert 1 <= sum(marked) <= 2
    for angle in (0.0, 0.5, 2.0):
        solid = Solid(surface, np.zeros(3), rotation_matrices(_about((0.0, 0.0, 1.0), angle)))
        toward = solid.normals[marked].mean(axis=0)
        assert math.atan2(toward[1], toward[0]) == pytest.approx(angle)
        for view, seen in ((View(angle, 0.3), True), (View(angle + math.pi, 0.3), False)):
            _, colours, outlines = painted([solid], view)
            blue = [colour[2] > colour[0] for colour, outline in zip(colours, outlines, strict=True) if not outline]
            assert any(blue) == seen


def test_round_drums_are_fluted():
    tones = surface_of(CircularFrustum(1.0, 0.8, 0.5, 0.25)).tones[2:]
    assert tones.count(FLUTE) == 19
    assert tones.count(STONE) == 19
    assert tones[0] == tones[-1] == MARK


def test_views():
    points = np.array([[1.0, 2.0, 3.0]])
    np.testing.assert_allclose(ALONG_X.across(points), [[1.0, 3.0]], atol=1e-12)
    np.testing.assert_allclose(ALONG_Y.across(points), [[2.0, 3.0]], atol=1e-12)
    view = parse_view("-40, 18")
    assert (view.azimuth, view.elevation) == pytest.approx((OBLIQUE.azimuth, OBLIQUE.elevation))
    np.testing.assert_allclose(np.cross(view.right, view.up), view.toward, atol=1e-12)
    for wrong in ("40", "a,b", "10,100", "nan,3", "1,2,3"):
        with pytest.raises(InputError, match="view"):
            parse_view(wrong)


def test_a_frame_holds_every_drum(shaken):
    scene = film_of(shaken, OBLIQUE)
    left, right, bottom, top = scene.view(np.arange(0, len(shaken.time), 10), 1.6)
    for outline in scene.outlines(50):
        assert left < outline[:, 0].min() < outline[:, 0].max() < right
        assert bottom < outline[:, 1].min() < outline[:, 1].max() < top
    above, below = draw_frame(scene, 50).axes
    (faces,) = [collection for collection in above.collections if hasattr(collection, "get_facecolor")]
    assert len(faces.get_facecolor()) == len(painted(scene.solids(50), OBLIQUE)[0])
    assert [line.get_label() for line in below.lines[:2]] == ["x", "y"]


def test_the_ground_in_a_picture_is_that_around_what_stands():
    """A podium of 30 m by 16 m far from the origin, with columns of 8 m: the ground goes on by a quarter of the size."""
    podium = np.stack(np.meshgrid((100.0, 130.0), (0.0, 16.0), (0.0, 4.0)), axis=-1).reshape(-1, 3)

    class Temple(Scene):
        size, level, base = 30.0, 0.0, np.eye(3)

        def solids(self, index, factor=1.0):
            return [SimpleNamespace(vertices=podium)]

    plate = Temple(None).plate
    np.testing.assert_allclose(plate.mean(axis=0), [115.0, 8.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(plate - plate.mean(axis=0), axis=1), 17.0 + 7.5)


def test_a_film_and_a_page(shaken, tmp_path):
    from PIL import Image

    path = shaken.save(tmp_path / "response.nc")
    gif = write_gif(shaken, tmp_path / "one.gif", frames_per_second=2.0)
    with Image.open(gif) as film:
        assert film.n_frames > 2
    assert call(["animate", str(path), "--format", "html", "--fps", "5", "--view", "30,45"]) == 0
    page = path.with_suffix(".html").read_text()
    data = json.loads(re.search(r"const data = (.*);\n", page)[1])
    assert data["space"]["view"] == pytest.approx([math.radians(30.0), math.radians(45.0)])
    assert len(data["shapes"]) == 12
    states = np.searchsorted(shaken.time, np.array(data["time"]) - 1e-4)
    np.testing.assert_allclose(np.array(data["poses"])[..., :3], shaken.body_position[states], atol=1e-5)
    assert not re.search(r"(src|href)=|https?://|import ", page)
    assert call(["animate", str(path), "--view", "30,120"]) == 2


def test_a_run_that_failed_is_drawn_as_far_as_it_goes(shaken):
    position, orientation = shaken.body_position.copy(), shaken.body_orientation.copy()
    matrices = rotation_matrices(orientation)
    matrices[-5:, 3:] = position[-5:, 3:] = np.nan
    failed = _posed(shaken, position, quaternions(matrices))
    np.testing.assert_allclose(rotation_matrices(failed.body_orientation[:-5]), matrices[:-5], atol=1e-12)
    assert np.isnan(failed.body_orientation[-5:, 3:]).all()
    for draw in (plots.draw_orbit, plots.draw_uplift, plots.draw_residuals, plots.draw_filmstrip):
        draw(failed).draw_without_rendering()
    scene = film_of(failed, OBLIQUE)
    draw_frame(
        scene, len(failed.time) - 1, scene.view(np.arange(0, len(failed.time), 10), 1.6)
    ).draw_without_rendering()


def test_a_run_writes_the_pictures_in_space(shaken, tmp_path, monkeypatch):
    from stylobate.cli.run import SPACE_PICTURES, write

    names = []
    monkeypatch.setattr(plots, "save", lambda figure, stem: names.append(stem.name) or [stem])
    write(shaken, st.Motion(0.01, np.zeros(200)), tmp_path)
    assert names == ["histories", "filmstrip", "joints", *SPACE_PICTURES, "energy", "motion"]


@pytest.mark.skipif(shutil.which("node") is None, reason="needs node")
def test_the_page_magnifies_and_orders_as_films_do(shaken, tmp_path):
    page = write_player(shaken, tmp_path / "page.html", frames_per_second=10.0).read_text()
    data = re.search(r"const data = .*;\n", page)[0]
    laws = page[page.index("function placed(") : page.index("// Canvases have")]
    script = page[page.index("const dot =") : page.index("// Seen from anywhere")]
    query = """
      const last = data.poses.at(-1), space = data.space, c = Math.cos, s = Math.sin, [a, e] = space.view;
      const axes = [[-s(a), c(a), 0], [-c(a) * s(e), -s(a) * s(e), c(e)], [c(a) * c(e), s(a) * c(e), s(e)]];
      console.log(JSON.stringify({ larger: last.map((pose, i) => magnified(pose, data.start[i], 7)),
        order: ordered(last.map((pose, i) =>
          formed(i, data.shapes[i], space.faces[i], pose, axes))).map(body => body.i) }));"""
    (tmp_path / "page.js").write_text(data + laws + script + query)
    answer = json.loads(
        subprocess.run(["node", tmp_path / "page.js"], capture_output=True, text=True, check=True).stdout
    )
    state = int(np.abs(shaken.time - json.loads(data[len("const data = ") : -2])["time"][-1]).argmin())
    wanted = exaggerated(shaken.poses, state, 7.0)
    np.testing.assert_allclose(np.array(answer["larger"])[:, :3], wanted.position, atol=2e-4)
    np.testing.assert_allclose(np.array(answer["larger"])[:, 3:], wanted.orientation, atol=2e-4)
    assert answer["order"] == list(range(12))  # from the base upward, as seen from above
    assert painting_order(film_of(shaken, OBLIQUE).solids(state), OBLIQUE) == answer["order"]


def test_a_base_out_of_level_is_drawn_as_it_leans(tmp_path):
    """Towards 90° it rises: seen against x the ground rises to the right, its plate with it, and the column leans back."""
    column = round_column(2).replace(as_found=st.AsFound((), 5.0, 90.0))
    response = st.simulate(column, st.Motion(0.02, np.zeros(3)), st.DistinctElement3D())
    beside, along = (Scene(response, view) for view in (ALONG_Y, ALONG_X))
    assert beside.slope == pytest.approx(np.tan(np.radians(5.0)))
    assert along.slope == pytest.approx(0.0, abs=1e-12)
    rise = np.ptp(beside.plate[:, 2]) / np.ptp(beside.plate[:, 1])
    assert rise == pytest.approx(np.tan(np.radians(5.0)), rel=1e-3)
    middles = np.array([solid.vertices.mean(axis=0) for solid in beside.solids(0)])
    lean = np.arctan2(middles[1, 1] - middles[0, 1], middles[1, 2] - middles[0, 2])
    assert lean == pytest.approx(np.radians(-5.0), abs=1e-3)
    page = write_player(response, tmp_path / "page.html").read_text(encoding="utf-8")
    plate = np.array(json.loads(re.search(r'"plate": (\[\[.*?\]\])', page)[1]))
    assert np.ptp(plate[:, 2]) > 0.05
