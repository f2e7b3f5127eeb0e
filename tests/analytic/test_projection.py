"""A column found out of the plane, projected onto one: closed forms, and the statics in space along that plane."""

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.as_found import AsFound, FoundDrum
from stylobate.column.files import write_column
from stylobate.column.projection import project, projected
from stylobate.statics.limit import limit_analysis, limit_in_space

LAW = st.Joint(5e10, 2.5e10, friction_coefficient=0.7)
BLOCK = st.Column.of_drums([st.Drum(4.0, 1.0, 1.0, 2500.0, "circular")], LAW, name="block")
STACK = st.Column.tapered(
    height=6.0, bottom_width=1.1, top_width=0.9, drums=4, density=2600.0, joint=LAW, section="circular", name="stack"
)
#: Something of everything, at small angles.
FOUND = AsFound(
    (
        FoundDrum(1, chip_right=0.10, chip_left=0.02, chip_azimuth=20.0),
        FoundDrum(3, offset=0.05, offset_azimuth=120.0, tilt=-0.4, tilt_azimuth=60.0, turn=15.0),
        FoundDrum(4, offset=0.02, offset_azimuth=-70.0, chip_right=0.05, chip_azimuth=100.0),
    ),
    0.5,
    37.0,
)


@pytest.mark.parametrize("azimuth", [0.0, 15.0, 45.0, 70.0, 90.0, 200.0, 290.0])
def test_a_chipped_round_face_is_cut_by_the_plane(azimuth):
    """A chord at 0.4 m from the middle of a disc of 0.5 m, towards 30°: 0.4/cos(α − 30°) where that is less than 0.5."""
    column = BLOCK.replace(as_found=AsFound((FoundDrum(1, chip_right=0.1, chip_azimuth=30.0),)))
    projection = project(column, azimuth)
    drum = projection.column.as_found.of(1)
    reach = {1.0: 0.5, -1.0: 0.5}
    toward = math.cos(math.radians(azimuth - 30.0))
    reach[math.copysign(1.0, toward)] = min(0.5, 0.4 / abs(toward))
    assert (drum.chip_left, drum.chip_right) == pytest.approx((0.5 - reach[-1.0], 0.5 - reach[1.0]), abs=1e-12)
    assert bool(projection.lost) == (azimuth != 30.0)
    # it overturns where the plane leaves the face: λ = reach over the height of the centroid
    assert limit_analysis(projection.column).multiplier == pytest.approx(reach[1.0] / 2.0, rel=1e-9)
    assert limit_analysis(projection.column, direction=180.0).multiplier == pytest.approx(reach[-1.0] / 2.0, rel=1e-9)


def test_offsets_leans_and_the_slope_keep_their_parts_along_the_plane():
    projection = project(STACK.replace(as_found=FOUND), 30.0)
    third = projection.column.as_found.of(3)
    assert third.offset == pytest.approx(0.05 * math.cos(math.radians(90.0)), abs=1e-15)
    assert math.tan(math.radians(third.tilt)) == pytest.approx(
        math.tan(math.radians(-0.4)) * math.cos(math.radians(30.0)), rel=1e-12
    )
    slope = math.tan(math.radians(0.5)) * math.cos(math.radians(7.0))
    assert math.tan(math.radians(projection.column.as_found.base_tilt)) == pytest.approx(slope, rel=1e-12)
    assert projection.column.as_found.in_plane
    text = "; ".join(projection.lost)
    for words in (
        "offsets across of up to 50 mm (drum 3)",
        "leans across of up to 0.2° (drum 3)",
        "turns of up to 15° (drum 3)",
        "slope of the base across, 0.0609°",
        "of the chips of drum 1, 20 mm and 100 mm deep, the plane shows ",
    ):
        assert words in text


@pytest.mark.parametrize("azimuth", np.arange(0.0, 360.0, 40.0))
def test_the_multiplier_in_the_plane_is_that_in_space_along_it(azimuth):
    """Both ways along the plane. What differs is of second order in the angles, 0.5° of 10°: 1e-3."""
    column = STACK.replace(as_found=FOUND)
    plane = project(column, azimuth).column
    for direction in (0.0, 180.0):
        space = limit_in_space(column, azimuth + direction)
        assert limit_analysis(plane, direction=direction).multiplier == pytest.approx(space.multiplier, rel=1e-3)


def test_links_keep_their_places_along_the_plane_and_beside_it():
    links = (
        st.Tie(at=(0.0, 0.65), axial_stiffness=1e8, axial_capacity=3e4, to_height=5.9),
        st.Dowel(joint=2, at=(0.1, 0.2), shear_stiffness=1e8, shear_capacity=5e3),
    )
    column = STACK.replace(as_found=AsFound((FoundDrum(2, turn=10.0),)), links=links)
    tie, dowel = project(column, 90.0).column.links
    # the tie's end at the base lies in the plane; its upper one and the dowel are turned with their drums
    c, s = math.cos(math.radians(10.0)), math.sin(math.radians(10.0))
    assert tie.at == pytest.approx((0.65, 0.0), abs=1e-12)
    assert tie.to == pytest.approx((0.65 * c, 0.65 * s), abs=1e-12)
    x, y = 0.1 * c - 0.2 * s, 0.1 * s + 0.2 * c
    assert dowel.at == pytest.approx((y, -x), abs=1e-12)
    tied = STACK.replace(links=links[:1])
    along = limit_in_space(tied, 270.0).multiplier
    assert limit_analysis(project(tied, 90.0).column, direction=180.0).multiplier == pytest.approx(along, rel=1e-5)


def test_a_column_in_the_plane_stays_and_the_other_way_round_is_its_mirror():
    as_found = AsFound((FoundDrum(2, offset=0.03, tilt=0.3), FoundDrum(1, chip_right=0.08)), 0.4)
    column = STACK.replace(as_found=as_found)
    with pytest.warns(st.OutOfRangeWarning, match="nothing of it lies across"):
        same = projected(column, 0.0)
    for number in (1, 2):
        kept, built = same.as_found.of(number), as_found.of(number)
        assert (kept.offset, kept.tilt) == pytest.approx((built.offset, built.tilt), rel=1e-12)
        assert (kept.chip_left, kept.chip_right) == pytest.approx((built.chip_left, built.chip_right), abs=1e-9)
    mirror = project(column, 180.0).column
    assert limit_analysis(mirror).multiplier == pytest.approx(
        limit_analysis(column, direction=180.0).multiplier, rel=1e-9
    )


def test_rectangular_drums_are_seen_from_their_other_side():
    drum = st.Drum(2.0, 1.0, 0.9, 2500.0, depth=0.6, top_depth=0.5)
    column = st.Column.of_drums([drum] * 2, LAW, name="pillar")
    seen = project(column, 90.0).column.drums[0]
    assert (seen.bottom_width, seen.top_width, seen.depth, seen.upper_depth) == (0.6, 0.5, 1.0, 0.9)
    assert (seen.mass, seen.inertia) == pytest.approx((drum.mass, drum.cross_inertia), rel=1e-12)
    with pytest.raises(st.InputError, match="rectangular, and a plane across their edges"):
        project(column, 30.0)
    chipped = column.replace(as_found=AsFound((FoundDrum(1, chip_back=0.05),)))
    assert project(chipped, 90.0).column.as_found.of(1).chip_right == pytest.approx(0.05, rel=1e-9)


COMMANDS = {
    "run": ["--pulse", "ricker,1Hz,0.1g"],
    "critical": ["--pulse", "ricker,1Hz,?g", "--from", "0.1g", "--to", "0.2g"],
    "suite": ["sample:el-centro-1940"],
    "ida": ["sample:el-centro-1940"],
    "domain": ["--frequencies", "1:2:2", "--amplitudes", "0.1g:0.2g:2"],
    "compare": ["--models", "dem2d,rigid-block", "--pulse", "ricker,1Hz,0.1g"],
    "pushover": [],
    "limit": [],
}


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_with_a_plane_model_takes_a_projection(command, tmp_path, capsys):
    file = str(write_column(STACK.replace(as_found=FOUND), tmp_path / "found.toml"))
    assert call([command, file, *COMMANDS[command], "--project", "30"]) == 2
    assert "--project is '30'; write it with its unit, such as 30deg" in capsys.readouterr().err
    pillar = str(write_column(st.preset("paper-12-drums"), tmp_path / "pillar.toml"))
    assert call([command, pillar, *COMMANDS[command], "--project", "30deg"]) == 2
    assert "project it onto 0, 90, 180 or 270 degrees" in capsys.readouterr().err


def test_what_is_lost_is_said_once(tmp_path, capsys):
    file = str(write_column(STACK.replace(as_found=FOUND), tmp_path / "found.toml"))
    assert call(["limit", file, "--project", "30deg"]) == 0
    out, err = capsys.readouterr()
    assert "stack, projected onto 30°" in out
    assert (
        err.count("projected onto the vertical plane of azimuth 30°, along which x of the motion acts; left out is")
        == 1
    )
    assert call(["pushover", file]) == 2
    assert "project it onto a plane (--project AZIMUTH)" in capsys.readouterr().err
