"""Distinct elements in space: what stands for good, with soft joints and from a pose; slip of a drum that leans."""

import dataclasses
import math

import numpy as np
import pytest
from validation.space import flat_barrier, round_column

from stylobate.column import AsFound, Column, Drum, FoundDrum, Joint
from stylobate.errors import InputError
from stylobate.kernels.plane import standing as plane
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.engine import engine_for
from stylobate.models.plane.packing import numbers_for
from stylobate.models.start import Start
from stylobate.motion import Motion
from stylobate.outcome import Outcome
from stylobate.simulate import simulate


def square_column(stiffness: float) -> Column:
    joint = Joint(stiffness, 0.5 * stiffness, friction_coefficient=0.7)
    return Column.tapered(
        height=5.0,
        bottom_width=0.9,
        top_width=0.7,
        drums=1,
        density=1600.0,
        joint=joint,
        section="rectangular",
        depth=0.9,
    )


@pytest.mark.parametrize(
    ("column", "law"),
    [(round_column(1, 1e9), "rim"), (round_column(1, 1e9), "bed"), (square_column(1e9), "rim")],
    ids=["rim", "bed", "corners"],
)
def test_soft_joints_overturn_with_less_energy(column, law):
    """The largest energy of a column that stands on its edge at rest, over all tilts, against what the verdict takes."""
    model = DistinctElement3D(law=law)
    alpha = math.atan(0.5 * column.drums[0].bottom_width / column.drums[0].centroid_height)
    energies = []
    for tilt in np.linspace(0.9, 1.0, 11) * alpha:
        block = engine_for(model, column).block(RunOptions(start=Start(float(tilt))))
        block.load(0, Case(column, Motion(1.0, np.zeros(2))))
        energies.append(block.rest[0])
    rigid = flat_barrier(column, np.zeros((1, 2)))
    stand = engine_for(model, column).pack(column).stand
    taken = flat_barrier(column, np.zeros((1, 2)), toes=np.stack((stand["toe"], stand["others"])))
    assert taken <= max(energies) < rigid
    assert taken > 0.98 * max(energies)


def in_the_plane(column, toes) -> float:
    """Lowest barrier of the law in the plane, of a column as built [J]."""
    stand = numbers_for(column)[0].copy()
    stand["toe"], stand["others"] = toes
    return float(plane.lowest_barrier(stand, column.gravity, 0.0))


@pytest.mark.parametrize(("points", "stiffness"), [(2, 1e9), (2, 1e8), (5, 1e9)])
def test_soft_joints_overturn_with_less_energy_in_the_plane_too(points, stiffness):
    """As above; undamped runs that stopped near their highest point were called decided, and went over."""
    column, model = square_column(stiffness), DistinctElement2D(points=points)
    alpha = math.atan(0.5 * column.drums[0].bottom_width / column.drums[0].centroid_height)
    energies = []
    for tilt in np.linspace(0.8, 1.0, 21) * alpha:
        block = engine_for(model, column).block(RunOptions(start=Start(float(tilt))))
        block.load(0, Case(column, Motion(1.0, np.zeros(2))))
        energies.append(block.rest[0])
    rigid = in_the_plane(column, np.zeros((2, 1)))
    taken = in_the_plane(column, engine_for(model, column).pack(column).stand)
    assert taken <= max(energies) < rigid
    assert taken > 0.93 * max(energies)


def test_a_drum_on_another_one_has_a_margin_to_walk():
    """Wobbling it walks at no cost, and comes nearer to its edge: the barrier of joints between drums is of a narrower
    support, in space; a column of one drum has its whole support."""
    monolith, two = round_column(1), round_column(2)
    still = np.zeros((2, 2))
    assert flat_barrier(monolith, still[:1], walks=True) == flat_barrier(monolith, still[:1])
    # on a foot so wide that the upper joint governs
    wide = two.replace(drums=(dataclasses.replace(two.drums[0], bottom_width=3.0), two.drums[1]))
    mass, half = wide.drums[1].mass, 0.5 * wide.drums[1].bottom_width
    height = wide.drums[1].centroid_height
    for walks, share in ((False, 1.0), (True, 0.6)):
        rise = math.hypot(share * half, height) - height
        assert flat_barrier(wide, still, walks=walks) == pytest.approx(mass * wide.gravity * rise, rel=1e-12)


def test_a_start_on_its_way_over_is_not_decided():
    still, column = Motion(0.05, np.zeros(2)), round_column()
    falls = simulate(column, still, DistinctElement3D(), start=Start(0.1, 0.5, (-math.sin(0.5), math.cos(0.5), 0.0)))
    assert falls.outcome is Outcome.ROCKED
    assert not falls.decided
    rocks = simulate(column, still, DistinctElement3D(), start=Start(0.1, 0.5))
    assert rocks.decided


@pytest.mark.parametrize("column", [round_column(), square_column(5e10)], ids=["round", "square"])
@pytest.mark.parametrize("azimuth", [0.0, 2.0])
def test_a_column_that_leans_has_not_slipped(column, azimuth):
    """The middle of its face has moved by 2.4 mm and more, and nothing has slipped."""
    response = simulate(column, Motion(0.02, np.zeros(2)), DistinctElement3D(), start=Start(0.1, azimuth))
    assert response.outcome is Outcome.ROCKED
    assert response.residual_joint_slip < 1e-4


def test_slip_of_a_joint_between_unequal_drums():
    """A drum that stands flat has the offset of its middles, whatever its twist; so does one that leans about it."""
    column = round_column(2)
    model = DistinctElement3D()
    block = engine_for(model, column).block(RunOptions())
    block.load(0, Case(column, Motion(1.0, np.zeros(2))))
    c, s = math.cos(0.7), math.sin(0.7)
    for name, value in {"ix": c, "iy": s, "jx": -s, "jy": c}.items():
        block.records.body[name][2, 0] = value
    block.records.body["x"][2, 0], block.records.body["y"][2, 0] = 0.03, -0.02
    _, slip, twist = block.records.joints(0)
    np.testing.assert_allclose(slip, [(0.0, 0.0), (0.03, -0.02)], atol=1e-12)
    assert twist[1] == pytest.approx(0.7, abs=1e-12)


def test_a_start_out_of_the_plane_of_a_planar_run_is_refused():
    still, model = Motion(0.02, np.zeros(2)), DistinctElement3D(planar=True)
    for start in (Start(0.05, 1.0), Start(0.05, 0.0, (0.1, 0.0, 0.0)), Start(0.05, 0.0, (0.0, 0.0, 0.1))):
        with pytest.raises(InputError, match="planar = True keeps to the plane"):
            simulate(round_column(), still, model, start=start)
    response = simulate(round_column(), still, model, start=Start(0.05, math.pi, (0.0, 0.1, 0.0)))
    assert response.energy_imbalance < 1e-3


def on_a_plate(height: float, stiffness: float) -> Column:
    """A column of one drum on a plate, both on soft joints."""
    drums = [Drum(height, 1.0, 1.0, 1600.0, section="circular"), Drum(3.0, 1.0, 1.0, 1600.0, section="circular")]
    return Column.of_drums(drums, Joint(stiffness, 0.5 * stiffness, friction_coefficient=0.7), name="on a plate")


def test_a_plate_that_has_sunk_below_its_middle_is_not_lying():
    """Its joint closes by 12 mm, 0.4 of its 30 mm; the base's surface is above its centroid once it is pressed further."""
    column = on_a_plate(0.03, 3.98e6)
    pressed = Motion(0.01, np.zeros(21), az=0.3 * 9.81 * np.sin(np.arange(21) * 0.2))
    model = DistinctElement3D()
    block = engine_for(model, column).block(RunOptions())
    block.load(0, Case(column, pressed))
    lowest = float(block.records.body["z"][1, 0])
    while not block.is_over(0):
        block.advance(1)
        lowest = min(lowest, float(block.records.body["z"][1, 0]))
    assert lowest < -1e-3
    assert block.collect(0).outcome is not Outcome.COLLAPSED


def test_a_plate_pressed_in_by_more_than_half_of_its_height_is_refused():
    with pytest.raises(InputError, match=r"drum 1 of 'on a plate' is 0\.02 m high and sinks by 0\.0119 m under"):
        simulate(on_a_plate(0.02, 3.98e6), Motion(0.1, np.zeros(3)), DistinctElement3D())


def test_twists_count_full_turns():
    """A disc that spins freely at 9 rad/s has turned by 9 rad after a second, in the state, the peak and the history."""
    column = Column.of_drums(
        [Drum(0.5, 1.0, 1.0, 1600.0, section="circular")], Joint(5e8, 2.5e8, friction_coefficient=0.7)
    )
    model = DistinctElement3D(pivot_friction=0.0)
    block = engine_for(model, column).block(RunOptions())
    block.load(0, Case(column, Motion(1.0, np.zeros(2))))
    for name, value in {"lz": column.drums[0].axial_inertia * 9.0, "wz": 9.0}.items():
        block.records.body[name][1, 0] = value
    while not block.is_over(0):
        block.advance()
    assert block.records.joints(0)[2] == pytest.approx([9.0], abs=1e-6)
    measures = block.collect(0)
    assert measures.space.peak_twist == pytest.approx(9.0, abs=1e-6)
    assert measures.residuals.twist == pytest.approx((9.0,), abs=1e-6)


def test_a_found_lean_is_not_a_rotation_of_the_run():
    lean = AsFound((FoundDrum(2, tilt=1.5, tilt_azimuth=30.0),))
    response = simulate(round_column(3).replace(as_found=lean), Motion(0.1, np.zeros(3)), DistinctElement3D())
    assert response.peak_rotation < 1e-6
    assert response.measures.space.peak_tilt == pytest.approx(math.radians(1.5), rel=1e-2)


@pytest.mark.parametrize("drums", [1, 3])
def test_peaks_of_a_column_that_falls_are_those_before_it_fell(drums):
    """A fall between drums is certain only late; what the top has done by then is the fall. At its edge the whole column
    leans by 0.215 rad and has gone 1.07 m."""
    push = np.concatenate((np.full(120, -0.5 * 9.81), np.zeros(800)))
    response = simulate(round_column(drums), Motion(5e-3, push), DistinctElement3D())
    assert response.outcome is Outcome.COLLAPSED
    when = np.searchsorted(response.time, response.measures.collapse_time) - 1
    seen = np.hypot(*response.top_displacement[: when + 1].T)
    assert response.peak_top_displacement < 0.999 * seen.max()
    # at the peak the column was not yet beyond its edge
    at = int(np.argmax(seen >= response.peak_top_displacement))
    part = response.body_position[at, :, 0] @ round_column(drums).masses / round_column(drums).masses.sum()
    assert abs(part) < 0.5


def test_what_turns_freely_with_its_slope_is_not_decided():
    """Sloping drums of six turned by a radian in ten seconds without torsional friction, called standing for good; the
    column came down."""
    still, column = Motion(0.02, np.zeros(2)), round_column(3, 1e8)
    sloping = column.replace(as_found=AsFound((FoundDrum(2, tilt=1.0), FoundDrum(3, tilt=-1.0))))
    for stands, pivot_friction, sure in ((column, 0.0, True), (sloping, 1.0, True), (sloping, 0.0, False)):
        assert simulate(stands, still, DistinctElement3D(pivot_friction=pivot_friction)).decided is sure
