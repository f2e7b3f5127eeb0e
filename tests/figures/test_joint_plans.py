"""Plans of joints: faces where they are, what chips leave of them, links; and the sheet that holds them."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

import stylobate as st
from stylobate import plots
from stylobate.column.files import write_column
from stylobate.column.links import Dowel
from stylobate.plots.drawing import joint_plans

FOLDER = Path(__file__).parents[2] / "gallery" / "assemblies"


def area(corners):
    x, y = corners.T
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))


@pytest.fixture
def column():
    """Three round drums of 1 m; the second offset by 30 mm to 120°, the third turned with a chip of 0.2 m at 30° of it."""
    drums = [st.Drum(0.8, 1.0, 1.0, 2700.0, "circular")] * 3
    state = st.AsFound(
        (
            st.FoundDrum(2, offset=0.03, offset_azimuth=120.0),
            st.FoundDrum(3, turn=15.0, chip_right=0.2, chip_azimuth=30.0),
        ),
        base_tilt=0.5,
        base_azimuth=37.0,
    )
    column = st.Column.of_drums(drums, st.Joint(1e9, 1e9, 35.0), name="north column")
    return column.replace(
        as_found=state, links=(Dowel(joint=3, at=(0.3, 0.0), shear_stiffness=1e8, shear_capacity=1e4),)
    )


def test_plans_of_a_column_as_found(column):
    first, second, third = joint_plans(column)
    assert first.below is None
    assert second.offset == pytest.approx((0.03 * math.cos(math.radians(120.0)), 0.03 * math.sin(math.radians(120.0))))
    assert second.above.mean(axis=0) == pytest.approx(np.array(second.offset))
    assert second.as_found == "offset +30 mm to 120°"
    # a segment of height h: r² (θ − sin θ cos θ), cos θ = 1 − h/r; 120 corners leave 0.05 % of a circle out
    half = math.acos(1.0 - 0.2 / 0.5)
    remaining_area = math.pi * 0.25 - 0.25 * (half - math.sin(half) * math.cos(half))
    assert area(third.above) == pytest.approx(remaining_area, rel=1e-3)
    way = np.array([math.cos(math.radians(45.0)), math.sin(math.radians(45.0))])  # 30° in axes turned by 15°
    assert float((third.above @ way).max()) == pytest.approx(0.3, abs=1e-9)
    assert third.links == (pytest.approx((0.3 * math.cos(math.radians(15.0)), 0.3 * math.sin(math.radians(15.0)))),)
    assert third.as_found == "turned +15°\nchip right 200 mm (right at 30°)"


def test_the_sheet_of_a_column(column):
    figure = plots.draw_sheet(column, column.name)
    words = {text.get_text() for axes in figure.subfigs[0].axes for text in axes.texts}
    assert {"0.800", "2.400 m", "drum 2"} <= words  # heights of drums and of all
    below = figure.subfigs[1]
    assert [axes.get_title(loc="left") for axes in below.axes[:3]] == ["joint 1", "joint 2", "joint 3"]
    assert "the base rises by 0.5° to 37°" in below.get_suptitle()
    scales = {float(np.ptp(axes.get_xlim()).round(9)) for axes in below.axes[:3]}
    assert len(scales) == 1


def test_the_two_elevations_of_a_sheet_have_one_scale():
    figure = plots.draw_sheet(st.read_assembly(FOLDER / "portal_in_space.toml"))
    figure.draw_without_rendering()
    front, side = figure.subfigs[0].axes[:2]
    scales = [np.ptp(axes.get_xlim()) / axes.bbox.width for axes in (front, side)]
    assert scales[0] == pytest.approx(scales[1], rel=1e-6)


def test_plans_of_an_assembly_overlap_as_its_joints_do():
    assembly = st.read_assembly(FOLDER / "temple_corner.toml")
    plans = joint_plans(assembly)
    assert len(plans) == len(assembly.space_joints)
    for plan, joint in zip(plans, assembly.space_joints):
        assert (plan.below is None) == (joint.lower == 0)
        assert joint.area <= area(plan.above) * 1.01
        assert (joint.corners <= plan.above.max(axis=0) + 1e-6).all()


def test_an_assembly_in_the_plane_has_views_only():
    assembly = st.read_assembly(FOLDER / "portal.toml")
    assert joint_plans(assembly) == []
    assert len(plots.draw_sheet(assembly).axes) == 4


def test_round_drums_of_an_assembly_are_told_with_diameters_offsets_and_chips(tmp_path):
    """As the column's own sheet tells them: an assembly keeps where its drums lie, not what a survey said."""
    drums = [st.Drum(1.0, 1.0, 0.9, 2500.0, "circular"), st.Drum(1.0, 0.9, 0.8, 2500.0, "circular")]
    as_found = st.AsFound((st.FoundDrum(2, offset=0.04, offset_azimuth=120.0, chip_right=0.06, chip_azimuth=30.0),))
    column = st.Column.of_drums(drums, st.Joint(5e9, 2.5e9, 35.0)).replace(as_found=as_found)
    write_column(column, tmp_path / "c.toml")
    (tmp_path / "a.toml").write_text('name = "pair"\n[[column]]\nfile = "c.toml"\nat = [[0.0, 0.0], [3.0, 0.0]]\n')
    pair = st.read_assembly(tmp_path / "a.toml")
    plans = [plan for plan in joint_plans(pair) if plan.as_found]
    assert [plan.as_found for plan in plans] == ["offset 40 mm to 120°\nchip 60 mm to 30°"] * 2
    assert all(plan.marked and plan.caption.endswith("⌀ 0.900 m") for plan in plans)
    labels = {text.get_text() for axes in plots.draw_views(pair).axes for text in axes.texts}
    assert {"3.000", "1.000", "2.000 m"} <= labels  # from axis to axis, each drum, and all of it


@pytest.mark.parametrize("scale", [None, 100])
def test_sheets_are_drawn_to_the_scale_that_they_name(column, scale):
    elevations, joints = plots.sheets_to_scale(column, paper="A4", scale=scale)
    # 2.4 m and room for dimensions on 297 mm: 1:20 needs 120 mm; the faces of 1 m lie three beside one another
    for sheet, denominator in ((elevations, scale or 20), (joints, 20)):
        sheet.draw_without_rendering()
        assert any(text.get_text().startswith(f"1:{denominator} on A4") for axes in sheet.axes for text in axes.texts)
        for axes in sheet.axes[1:]:
            ends = axes.transData.transform([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]) / sheet.dpi * 25.4
            assert ends[1] - ends[0] == pytest.approx((1000.0 / denominator, 0.0), abs=1e-6)
            assert ends[2] - ends[0] == pytest.approx((0.0, 1000.0 / denominator), abs=1e-6)
    assert (elevations.get_size_inches() * 25.4).tolist() == pytest.approx([210.0, 297.0])


def test_sheets_lie_across_where_that_shows_more_and_refuse_what_does_not_fit(tmp_path):
    scene = st.read_assembly(FOLDER / "colonnade.toml")
    sheets = plots.sheets_to_scale(scene, paper="A4")
    assert sheets[0].get_size_inches()[0] > sheets[0].get_size_inches()[1]
    with pytest.raises(st.InputError, match="scale is 1:1, at which the drawing does not fit on A4; the largest usual"):
        plots.sheets_to_scale(scene, paper="A4", scale=1)
    (file,) = plots.save_sheets(sheets, tmp_path / "colonnade.pdf")
    assert len(sheets) > 1
    assert len(re.findall(rb"/Type /Page\b", file.read_bytes())) == len(sheets)
