"""Chipped drums in space: what opens a joint in every direction, the plane model's motion, mirrors, energy, pictures."""

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.column.found_geometry import inside_overlap, space_geometry
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.engine import engine_for
from stylobate.models.shared.toes import point_toes
from stylobate.motion import Motion
from stylobate.plots.scene import surface_of
from stylobate.response.poses import bodies_of

HALF, DEEP, HEIGHT = 0.3, 0.2, 3.0
JOINT = st.Joint(normal_stiffness=1e12, shear_stiffness=5e11, friction_coefficient=0.7)
CHIPS = {"chip_left": 0.02, "chip_right": 0.06, "chip_front": 0.03, "chip_back": 0.01}


def prism(drums=1, joint=JOINT, **chips):
    """A rectangular column whose lowest drum is chipped."""
    column = st.Column.tapered(
        height=HEIGHT, bottom_width=2 * HALF, top_width=2 * HALF, drums=drums, density=2000.0, joint=joint,
        depth=2 * DEEP, name="prism",
    )  # fmt: skip
    return column.replace(as_found=st.AsFound((st.FoundDrum(1, **chips),))) if chips else column


def pushed(column, azimuths, levels, **options):
    """How far the joints open [m] under a ground that slowly takes up each acceleration [g] towards each azimuth [°]."""
    rise = np.concatenate((np.linspace(0.0, 1.0, 100), np.ones(5))) * st.g
    motions = [
        Motion(0.01, level * rise * math.cos(math.radians(azimuth)), level * rise * math.sin(math.radians(azimuth)))
        for azimuth, level in zip(azimuths, levels, strict=True)
    ]
    model = DistinctElement3D(stiffness_damping=1e-5, **options)
    return st.simulate_many([column] * len(motions), motions, model)["peak_joint_opening_m"].to_numpy()


def places(column, motion, model):
    """Displacements of the drums' centroids along x, every 32 steps, shape (T, n)."""
    block = engine_for(model, column).block(RunOptions(until_end=True))
    block.load(0, Case(column, motion))
    bodies = block.records.body
    first, displacements = bodies["x"][1:, 0].copy(), []
    while not block.is_over(0):
        block.advance(1)
        displacements.append(bodies["x"][1:, 0] - first)
    return np.array(displacements)


def shaken(duration=0.5, turned=1.0, mirrored=1.0):
    """Two directions at once; the signs turn round x or y."""
    time = np.arange(round(duration * 1000) + 1) * 1e-3
    return Motion(1e-3, turned * 0.25 * st.g * np.sin(6.0 * time), mirrored * 0.15 * st.g * np.sin(9.0 * time))


def test_a_chip_moves_the_pivot_in_its_own_direction_only():
    """0.99 and 1.01 of g b / H open the joint, with b to the edge that is left on the side to which the prism turns."""
    column = prism(joint=st.Joint(2e11, 1e11, friction_coefficient=0.7), **CHIPS)
    edges = {0.0: HALF - 0.02, 180.0: HALF - 0.06, 90.0: DEEP - 0.03, 270.0: DEEP - 0.01}
    azimuths = [azimuth for azimuth in edges for _ in range(2)]
    levels = [share * edges[azimuth] / (0.5 * HEIGHT) for azimuth in edges for share in (0.99, 1.01)]
    opened = pushed(column, azimuths, levels).reshape(4, 2)
    assert (
        opened[:, 0] < 2e-7
    ).all()  # one corner of the two opens a little earlier, the face being loaded off its middle
    assert (opened[:, 1] > 2e-6).all()
    assert column.uplift_acceleration == pytest.approx(st.g * (DEEP - 0.03) / (0.5 * HEIGHT), rel=1e-9)


@pytest.mark.parametrize("drums", [1, 3])
def test_in_its_plane_a_chipped_prism_moves_as_the_plane_model(drums):
    joint = st.Joint(5e10, 2.5e10, friction_coefficient=0.7)
    column = prism(drums, joint, chip_left=0.02, chip_right=0.06)
    time = np.arange(501) * 1e-3
    motion = Motion(1e-3, 0.25 * st.g * np.sin(6.0 * time))
    step = engine_for(DistinctElement3D(), column).step
    flat = places(column, motion, st.DistinctElement2D(points=2, time_step=step))
    for planar in (True, False):
        spatial = places(column, motion, DistinctElement3D(planar=planar, time_step=step))
        assert np.abs(spatial - flat).max() < 1e-9
    assert np.abs(flat).max() > 0.01


def test_a_chipped_column_in_a_mirror():
    """Mirrored in the plane of x and z: front and back change places, and the response is that in the mirror."""
    histories = [
        places(
            prism(3, st.Joint(5e10, 2.5e10, friction_coefficient=0.7), **chips),
            shaken(0.4, 1.0, sign),
            DistinctElement3D(),
        )
        for chips, sign in (
            ({"chip_front": 0.05, "chip_left": 0.03}, 1.0),
            ({"chip_back": 0.05, "chip_left": 0.03}, -1.0),
        )
    ]
    assert np.abs(histories[0]).max() > 5e-3
    assert np.abs(histories[0] - histories[1]).max() < 1e-10


def test_the_ledger_of_a_chipped_column_closes():
    found_drums = (
        st.FoundDrum(1, chip_front=0.04, chip_left=0.1),
        st.FoundDrum(2, chip_back=0.05, offset=0.02, turn=3.0),
        st.FoundDrum(3, chip_right=0.05, tilt=0.5, tilt_azimuth=50.0),
    )
    column = prism(3, st.Joint(5e9, 2.5e9, friction_coefficient=0.7)).replace(
        as_found=st.AsFound(found_drums, 1.0, 30.0)
    )
    block = engine_for(DistinctElement3D(), column).block(RunOptions())
    block.load(0, Case(column, shaken()))
    assert block.residual_acceleration(0) < 5e-5
    response = st.simulate(column, shaken(), DistinctElement3D())
    assert response.measures.peak_joint_opening > 1e-4
    assert response.measures.energy_imbalance < 1e-4


def test_what_stands_for_good_knows_the_smaller_support():
    """The barrier of a rigid chipped prism is that of its nearest edge, m g (√(H² + b²) − H)."""
    from stylobate.kernels.dem3d.standing import lowest_found
    from stylobate.models.dem3d.packing import found_numbers, numbers_for

    column, height = prism(**CHIPS), 0.5 * HEIGHT
    drums, up, _ = found_numbers(column)
    still = np.zeros((1, 2)), np.zeros(2)
    rigid = lowest_found(drums, numbers_for(column, np.zeros((2, 1))), *still, up, True, column.gravity, False)[0]
    weight = column.mass * column.gravity
    assert rigid == pytest.approx(weight * (math.hypot(height, DEEP - 0.03) - height), rel=1e-9)
    at = space_geometry(column)
    for place, inside in (
        ((0.2, 0.0), HALF - 0.06 - 0.2),
        ((-0.2, 0.0), 0.08),
        ((0.0, -0.1), 0.07),
        ((0.0, 0.1), 0.09),
    ):
        assert inside_overlap(column, at, 0, np.array(place)) == pytest.approx(inside)


def test_chips_that_cannot_be_are_refused_in_one_sentence():
    with pytest.raises(st.InputError, match=r"joint 1 of 'prism' has no contact left"):
        prism(chip_front=0.2, chip_back=0.2)
    with pytest.raises(st.InputError, match=r"at joint 1 the weight above passes 20 mm beyond"):
        prism(chip_back=DEEP + 0.02)
    with pytest.raises(st.InputError, match=r"drum 1 of 'prism' is rectangular, and its chip_azimuth is 30°"):
        prism(chip_left=0.1, chip_azimuth=30.0)
    with pytest.raises(st.InputError, match=r"is round, and chip_front = 0.1"):
        st.preset("paper-monolithic").replace(
            drums=(st.Drum(2.0, 1.0, 1.0, 2000.0, "circular"),), as_found=st.AsFound((st.FoundDrum(1, chip_front=0.1),))
        )
    with pytest.raises(st.InputError, match=r"dem2d computes the plane of x and z, and 'prism' is found out of it"):
        st.simulate(prism(chip_front=0.01), shaken(0.1), st.DistinctElement2D())


def test_a_chip_azimuth_of_180_turns_left_and_right_round():
    drum = st.FoundDrum(1, chip_left=0.1, chip_right=0.2, chip_azimuth=180.0)
    assert drum == st.FoundDrum(1, chip_left=0.2, chip_right=0.1)
    assert drum.in_plane
    assert not st.FoundDrum(1, chip_left=0.1, chip_azimuth=90.0).in_plane
    assert st.FoundDrum(1, chip_azimuth=90.0) == st.FoundDrum(1)


@pytest.mark.parametrize("section", ["circular", "rectangular"])
def test_chips_are_drawn(section):
    """The lower face of what is drawn is the face that carries."""
    drum = st.Drum(1.0, 2 * HALF, 1.6 * HALF, 2000.0, section, 2 * DEEP)
    chips = CHIPS if section == "rectangular" else {"chip_right": 0.06, "chip_azimuth": 40.0}
    column = st.Column((drum,), (JOINT,), as_found=st.AsFound((st.FoundDrum(1, **chips),)))
    shape = bodies_of(column).shapes[0]
    at = shape.mesh(40).vertices
    low = at[at[:, 2] < at[:, 2].min() + 1e-9]
    if section == "rectangular":
        assert (*low.min(axis=0)[:2], *low.max(axis=0)[:2]) == pytest.approx((-0.28, -0.17, 0.24, 0.19))
    else:
        angle = math.radians(40.0)
        assert (low @ (math.cos(angle), math.sin(angle), 0.0)).max() == pytest.approx(HALF - 0.06)
    surface = surface_of(shape)
    assert len(surface.tones) == len(surface.faces)
    assert np.isfinite(surface.normals).all()


def test_what_a_chipped_joint_gives_is_bounded_by_what_its_smaller_face_gives():
    """Of a square face with nine tenths left in each direction: as a whole face of that size under the same moment."""

    def block(width: float, density: float) -> st.Column:
        return st.Column.of_drums([st.Drum(2.0, width, width, density, depth=width)], JOINT)

    stiffness = np.array([1e9])
    chips = dict.fromkeys(("chip_left", "chip_right", "chip_front", "chip_back"), 0.05)
    chipped = block(1.0, 2000.0).replace(as_found=st.AsFound((st.FoundDrum(1, **chips),)))
    small = point_toes(block(0.9, 2000.0 / 0.81), stiffness, 0.25)
    assert point_toes(chipped, stiffness, 0.25) == pytest.approx(small / 0.81, rel=1e-12)


def test_a_round_column_with_a_chipped_drum_is_computed_to_its_end():
    """What touches of a chipped face is a difference of arcs: where nothing does, it is rounded to less than nothing."""
    column = st.Column.tapered(
        height=2.4, bottom_width=0.5, top_width=0.4, drums=3, density=2600.0, section="circular",
        joint=st.Joint(2e9, 1e9, friction_coefficient=0.7),
    ).replace(as_found=st.AsFound((st.FoundDrum(2, chip_left=0.05),)))  # fmt: skip
    motion = st.harmonic(1.0, 0.4 * st.g, 1.5, across=(1.3, 0.24 * st.g, 0.5))
    response = st.simulate(column, motion, st.DistinctElement3D())
    assert not response.collapsed
    assert response.energy_imbalance < 5e-3
