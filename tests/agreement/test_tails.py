"""A tail changes nothing of what was before it."""

import numpy as np
import pytest

from stylobate.column import preset
from stylobate.constants import g
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.rigid_block.model import RigidBlock
from stylobate.motion import harmonic
from stylobate.simulate import simulate


@pytest.mark.parametrize("model", [DistinctElement2D(), RigidBlock()], ids=["dem2d", "rigid-block"])
@pytest.mark.parametrize("name", ["paper-12-drums", "paper-monolithic"])
def test_a_tail_adds_to_a_run(name, model):
    column, motion = preset(name), harmonic(1.3, 0.3 * g, 3.0)
    alone = simulate(column, motion, model)
    assert not alone.collapsed
    assert alone.time[-1] == pytest.approx(3.0)
    for tail in (0.1, 2.0):
        longer = simulate(column, motion, model, tail=tail)
        both = min(len(alone.time) - 1, len(longer.time))  # the last row of a run may come early
        assert longer.time_step == alone.time_step
        assert np.array_equal(longer.drum_x[:both], alone.drum_x[:both])
        assert 3.0 + tail - 1e-9 <= longer.time[-1] < 3.0 + tail + 33 * longer.time_step
