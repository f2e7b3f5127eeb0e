"""Plane distinct elements: verdicts under smaller steps, contact points as a rule of quadrature, the stable step."""

import numpy as np
import pytest
from validation.convergence import refined_verdicts

from stylobate.column import preset
from stylobate.errors import InputError
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.drums.records import contact_points
from stylobate.models.engine import engine_for
from stylobate.motion import Motion
from stylobate.simulate import simulate

pytestmark = pytest.mark.processor


def test_net_change_of_verdicts_stays_within_its_scatter():
    """Cells near the boundary flip either way like coins: the net change stays within two standard deviations."""
    cells = refined_verdicts()
    net = int(cells[2].sum()) - int(cells[1].sum())
    assert abs(net) <= 2.0 * np.sqrt((cells[2] != cells[1]).sum())


@pytest.mark.parametrize("points", [2, 3, 4, 5, 9, 20])
def test_contact_points_integrate_the_section(points):
    for section, second in (("rectangular", 1.0 / 3.0), ("circular", 1.0 / 4.0)):
        xi, share = contact_points(section, points)
        assert share.min() > 0.0
        assert share.sum() == pytest.approx(1.0, rel=1e-12)
        assert list(xi[[0, -1]]) == [-1.0, 1.0]
        if points > 2:
            assert share @ xi**2 == pytest.approx(second, rel=1e-12)


def test_largest_stable_step_is_sharp():
    """Just below the limit a closed column stays at rest under a tiny push; just above, it would not."""
    column = preset("paper-12-drums").with_joint(friction_coefficient=1e3)
    model = DistinctElement2D(step_factor=0.999)
    push = Motion(0.001, np.array([0.0, 1e-6, 0.0] + [0.0] * 198))
    response = simulate(column, push, model)
    assert np.abs(response.top_displacement).max() < 1e-8
    stable = engine_for(model, column).step / 0.999
    with pytest.raises(InputError, match="largest stable"):
        _ = engine_for(DistinctElement2D(time_step=1.01 * stable), column).step
    # the limit is taken away by hand: beyond it the same push grows without bound
    from stylobate.models.base import Case, RunOptions

    block = engine_for(model, column).block(RunOptions())
    block.load(0, Case(column, push))
    records = block.records
    records.lane["dt"][0, 0] = block.dt[0] = 1.02 * stable
    records.feed["x"] = 0
    records.body["vx"][-1, 0] = 1e-9
    block.advance(1)
    early = np.abs(records.body["vx"][:, 0]).max()
    block.advance(19)
    assert np.abs(records.body["vx"][:, 0]).max() > 100.0 * early
