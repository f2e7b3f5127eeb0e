"""Round drums in space that stand and spin: first decompression, and spin without friction. Uplift, sliding, spin and flight
against closed forms are validation cases (``tests/validation/round_contact.py``)."""

import math

import numpy as np
import pytest
from validation.space import block_of, cylinder, put, put_axes, round_column

from stylobate.constants import g
from stylobate.models.dem3d.packing import rotation

#: A low disc: no rocking, even pressure.
FLAT = cylinder(1.0, 0.02, 5e8, 0.7)


def test_first_decompression_is_at_half_the_radius_over_the_height():
    """The far end of the rim carries nothing any more at g R / (2 b)."""
    column = round_column()
    block = block_of(column)
    block.lane["dt"][:] = 0.0
    closure = column.mass * g / (5e10 * column.joint_areas[0])
    tilt = math.asin(closure / (0.5 * column.base_width))
    put_axes(block, 1, 0, rotation(np.array([0.0, 1.0, 0.0]), tilt))
    axis = block.records.body["kx"][1, 0], 0.0, block.records.body["kz"][1, 0]
    put(block, 1, 0, "x y z", column.centroid_height * np.array(axis) - (0.0, 0.0, closure))
    block.records.kernel.forces(block.records.state)
    load = block.records.load
    reach = -load["up"][0, 1, 0] / load["f"][0, 2, 0] + block.records.body["x"][1, 0]
    assert reach / column.centroid_height == pytest.approx(0.109347, rel=2e-5)


# -- spinning on a plane -----------------------------------------------------------------------------------------


def test_without_pivot_friction_a_disc_spins_for_ever():
    block = block_of(FLAT, 0.5, pivot_friction=0.0)
    put(block, 1, 0, "lz wz", (FLAT.drums[0].axial_inertia * 3.0, 3.0))
    while not block.is_over(0):
        block.advance()
    assert block.records.body["wz"][1, 0] == pytest.approx(3.0, rel=1e-9)
