"""Bodies in space: shapes are closed, poses are rigid, and those of plane models are the plane ones."""

import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest

import stylobate as st
from stylobate.column.catalogue import preset
from stylobate.column.shapes import Chipped, CircularFrustum, ConvexSolid, Prism, RectangularFrustum
from stylobate.response import Collapse, Histories, Measures, Residuals, Response, SpaceMeasures, Touch
from stylobate.response.poses import SpacePoses, exaggerated, quaternions, rotation_matrices

CORNERS = np.array([[-0.5, -0.4], [0.6, -0.4], [0.2, 0.8], [-0.4, 0.5]])
CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
AREA = 0.5 * float(np.sum(CORNERS[:, 0] * np.roll(CORNERS[:, 1], -1) - np.roll(CORNERS[:, 0], -1) * CORNERS[:, 1]))
SHAPES = {
    "cone": (CircularFrustum(1.0, 0.6, 2.0, 0.9), math.pi * 2.0 * (1.0 + 0.6 + 0.36) / 12.0),
    "frustum": (RectangularFrustum((1.0, 2.0), (0.5, 1.0), 3.0, 1.2), 3.0 * (2.0 + 0.5 + 1.0) / 3.0),
    # a wedge 0.3 m wide and 0.4 m high is off the lower edge of a box
    "chipped": (
        Chipped(RectangularFrustum((1.0, 0.8), (1.0, 0.8), 1.0, 0.5), np.array([(0.8, 0.0, -0.6, 0.46)])),
        0.752,
    ),
    "prism": (Prism(CORNERS, 0.7), 0.7 * AREA),
    "solid": (ConvexSolid(CUBE), 8.0),
}


@pytest.mark.parametrize("name", SHAPES)
def test_meshes_are_closed_and_look_outward(name):
    """The volume under all faces, each seen counter-clockwise from outside, is that of the body (Gauss)."""
    shape, volume = SHAPES[name]
    mesh = shape.mesh(400)
    total, edges = 0.0, []
    for face in mesh.faces:
        a, *rest = (mesh.vertices[i] for i in face)
        total += sum(float(a @ np.cross(b, c)) for b, c in pairwise(rest)) / 6.0
        edges += list(zip(face, (*face[1:], face[0])))
    assert total == pytest.approx(volume, rel=1e-4)
    assert sorted(edges) == sorted((b, a) for a, b in edges)  # every edge twice, once each way
    outline = shape.outline
    for seen, solid in zip(np.ptp(outline, axis=0), np.ptp(mesh.vertices[:, [0, 2]], axis=0), strict=True):
        assert seen == pytest.approx(solid, rel=1e-3)


def spatial():
    """A column whose drums lean towards 30° by 0.1 rad and turn about their axes."""
    column, n, steps = preset("paper-12-drums"), 12, 5
    tilt, azimuth, turn = np.linspace(0.0, 0.1, steps), math.radians(30.0), np.linspace(0.0, 0.3, steps)
    across = np.array([-math.sin(azimuth), math.cos(azimuth), 0.0])

    def about(axis, angle):
        return np.concatenate((np.cos(0.5 * angle)[:, None], np.sin(0.5 * angle)[:, None] * axis), axis=1)

    lean, spin = rotation_matrices(about(across, tilt)), rotation_matrices(about(np.array([0.0, 0.0, 1.0]), turn))
    orientation = np.repeat(quaternions(lean @ spin)[:, None], n, axis=1)
    up = column.centroid_heights
    position = lean[:, None, :, 2] * up[:, None]
    zero, two = np.zeros((steps, n)), np.zeros((steps, 2))
    top = column.height * np.sin(tilt)[:, None] * [math.cos(azimuth), math.sin(azimuth)]
    ground = np.arange(3.0 * steps).reshape(steps, 3)
    time = np.arange(steps) * 0.1
    histories = Histories.in_space(
        time, position, orientation, zero, np.zeros((steps, n, 2)), zero, two, top, ground, ground, {"input": time}
    )
    measures = Measures(
        st.Outcome.COLLAPSED, True, 0.3, 0.5, 0.5, 0.1, 0.0, 0.0, 0.0, 1e-4, 4000, "overturned",
        Collapse(0.3, 3, "overturned", azimuth, Touch(0.35, ("drum 12", "ground"))),
        SpaceMeasures(0.4, 0.25, 0.1, 0.3),
        residuals=Residuals(*((each,) * n for each in (0.006, 0.008, 0.02)), *((0.1,) * n for _ in range(5))),
    )  # fmt: skip
    return Response(column, histories, measures, "dem3d", {"motion": "made up", "version": "0"})


def test_a_response_in_space():
    response = spatial()
    assert response.dims == "xyz"
    assert response.top_displacement.shape == (5, 2)
    assert response.ground_acceleration.shape == (5, 3)
    np.testing.assert_allclose(response.tilt[:, 0], np.linspace(0.0, 0.1, 5), atol=1e-12)
    np.testing.assert_allclose(response.tilt_azimuth[1:], math.radians(30.0), atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(response.body_axis, axis=-1), 1.0)
    row = response.measures.row()
    assert row["collapse_azimuth_deg"] == pytest.approx(30.0)
    assert row["peak_tilt_rad"] == response.peak_tilt == 0.1
    assert response.summary()["residual_slip_per_joint_m"] == pytest.approx([0.01, 0.01] + [None] * 10)
    assert response.summary()["residual_tilt_y_rad"] == [0.1, 0.1] + [None] * 10
    assert response.collapse.side == "right"


def test_a_response_in_space_is_read_back(tmp_path):
    response = spatial()
    loaded = Response.load(response.save(tmp_path / "space.nc"))
    for name in (
        "body_position",
        "body_orientation",
        "slip",
        "twist",
        "top_displacement",
        "ground_acceleration",
        "opening",
    ):
        np.testing.assert_array_equal(getattr(loaded, name), getattr(response, name))
    assert loaded.measures == response.measures
    data = response.to_xarray()
    assert data["body_position"].dims == ("time", "drum", "axis")
    assert data["axis"].values.tolist() == ["x", "y", "z"]
    assert data["joint_slip"].dims == ("time", "joint", "direction")


def test_a_response_in_space_is_drawn(tmp_path):
    from stylobate import plots
    from stylobate.plots.film import write_player

    response = spatial()
    for draw in (plots.draw_filmstrip, plots.draw_histories, plots.draw_joints, plots.draw_energy):
        draw(response).draw_without_rendering()
    assert write_player(response, tmp_path / "page.html").stat().st_size > 5000
    assert "<svg" in response._repr_html_()


def test_poses_of_a_plane_model_in_space():
    as_found = st.AsFound(
        (st.FoundDrum(2, offset=0.02, tilt=0.4, chip_left=0.05), st.FoundDrum(5, tilt=-0.3)), base_tilt=2.0
    )
    column = preset("paper-12-drums").replace(as_found=as_found)
    response = st.simulate(column, st.harmonic(2.0, 0.2 * st.g, 0.5), st.DistinctElement2D())
    assert response.dims == "xz"
    matrices = rotation_matrices(response.body_orientation)
    for body in range(column.n):
        shape = response.bodies.shapes[body]
        for index in (0, len(response.time) - 1):
            seen = (
                shape.outline @ matrices[index, body][[0, 2]][:, [0, 2]].T + response.body_position[index, body][[0, 2]]
            )
            np.testing.assert_allclose(seen, response.outline(index, body), atol=1e-12)
    assert not response.body_position[..., 1].any()
    # the lowest drum stands on the sloping base, its foot in the origin
    foot = response.bodies.shapes[0].outline[:2].mean(axis=0) @ matrices[0, 0][[0, 2]][:, [0, 2]].T
    np.testing.assert_allclose(foot + response.body_position[0, 0][[0, 2]], 0.0, atol=1e-12)
    # a positive rotation takes the top to −x
    turned = response.histories.drum_rotation[-1, -1] + response.bodies.reference.angle[-1] + math.radians(2.0)
    assert response.body_axis[-1, -1, 0] == pytest.approx(-math.sin(turned))


def test_what_is_drawn_larger_turns_further():
    half = 0.5 * np.array([0.3, 0.3 + 0.02])
    orientation = np.stack((np.cos(half), 0 * half, -np.sin(half), 0 * half), axis=-1)[:, None]
    poses = SpacePoses(np.array([[[0.0, 0.0, 1.0]], [[0.01, 0.02, 1.0]]]), orientation)
    larger = exaggerated(poses, 1, 10.0)
    np.testing.assert_allclose(larger.position[0], [0.1, 0.2, 1.0])
    np.testing.assert_allclose(larger.orientation[0], [math.cos(0.25), 0.0, -math.sin(0.25), 0.0], atol=1e-12)


def test_responses_and_motions_show_themselves():
    motion = st.harmonic(1.0, 0.25 * st.g, 1.0)
    response = st.simulate(preset("paper-monolithic"), motion, st.HousnerBlock())
    assert "\n" not in repr(response)
    for word in ("paper-monolithic", "harmonic 1 Hz", "housner", "energy imbalance", response.outcome.sentence_of(1)):
        assert word in repr(response)
    assert len(repr(response)) < 600
    assert "\n" not in repr(motion)
    assert len(repr(motion)) < 200
    page = response._repr_html_()
    assert response.outcome.sentence_of(1) in page
    assert page.count("<polygon") >= 2
    assert "peak_top_displacement_m" in page
    assert "peak_top_displacement" in dir(response)


def test_a_collapse_has_one_story():
    """The story of a column that is followed to the ground: nothing has fallen before the collapse is certain."""
    response = st.simulate(
        preset("paper-12-drums"), st.harmonic(0.66, 0.5 * st.g, 3.0), st.DistinctElement2D(), until_rest=True,
        output_interval=0.05,
    )  # fmt: skip
    collapse, summary = response.collapse, response.summary()
    assert collapse.time == response.collapse_time <= min(response.fell_at.values())
    assert collapse.joint == response.mechanism.joint
    assert f"joint {collapse.joint}" in response.reason
    assert collapse.side in response.reason
    assert collapse.touched.bodies is not None
    assert summary["residual_top_displacement_m"] is None
    assert summary["residual_joint_slip_m"] is None
    before = response.time <= collapse.time
    assert summary["peak_opening_per_joint_m"] == np.abs(response.joint_opening[before]).max(axis=0).tolist()
    for words in (f"certain at {collapse.time:.2f} s", "First to touch were", response.mechanism.describe()):
        assert words in response.sentence


def test_measures_without_a_collapse_are_equal_on_every_python():
    """A time of collapse that is no number is like another one, whichever objects they are; other numbers are not."""
    column, motion = preset("paper-monolithic"), st.harmonic(1.0, 0.05 * st.g, 0.2)
    measures = st.simulate(column, motion, st.HousnerBlock()).measures
    again = dataclasses.replace(measures, collapse_time=float("nan"))
    assert math.isnan(measures.collapse_time)
    assert measures == again
    assert measures != dataclasses.replace(measures, peak_rotation=1.0)
    assert measures != "measures"
