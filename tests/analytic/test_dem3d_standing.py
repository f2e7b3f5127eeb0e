"""Distinct elements in space: what stands for good, with soft joints and from a pose; slip of a drum that leans."""

import math

import numpy as np
import pytest
from validation.space import round_column

from stylobate.column import Column, Joint
from stylobate.errors import InputError
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.dem3d.verdict import flat_barrier
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
        block = model.make_block(1, RunOptions(start=Start(float(tilt))), column.section)
        block.load(0, Case(column, Motion(1.0, np.zeros(2))))
        energies.append(block.rest[0])
    rigid = flat_barrier(column, np.zeros((1, 2)))
    taken = flat_barrier(column, np.zeros((1, 2)), toes=block.toes(column))
    assert taken <= max(energies) < rigid
    assert taken > 0.98 * max(energies)


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
    block = DistinctElement3D().make_block(2, RunOptions())
    block.load(0, Case(column, Motion(1.0, np.zeros(2))))
    c, s = math.cos(0.7), math.sin(0.7)
    for name, value in {"ix": c, "iy": s, "jx": -s, "jy": c}.items():
        block.drum[name][2, 0] = value
    block.drum["x"][2, 0], block.drum["y"][2, 0] = 0.03, -0.02
    _, slip, twist = block.joints(0)
    np.testing.assert_allclose(slip, [(0.0, 0.0), (0.03, -0.02)], atol=1e-12)
    assert twist[1] == pytest.approx(0.7, abs=1e-12)


def test_a_start_out_of_the_plane_of_a_planar_run_is_refused():
    still, model = Motion(0.02, np.zeros(2)), DistinctElement3D(planar=True)
    for start in (Start(0.05, 1.0), Start(0.05, 0.0, (0.1, 0.0, 0.0)), Start(0.05, 0.0, (0.0, 0.0, 0.1))):
        with pytest.raises(InputError, match="planar is on"):
            simulate(round_column(), still, model, start=start)
    response = simulate(round_column(), still, model, start=Start(0.05, math.pi, (0.0, 0.1, 0.0)))
    assert response.energy_imbalance < 1e-3
