"""Plane distinct elements: when a flat block slides, and what impacts take from a block that rocks.

Observed restitution of the undamped model, from the peaks of free rocking released at half the critical angle (median over
six impacts; independent of the step between 0.05 and 0.4 of the stable one, within ±0.003; k_s = k_n / 2, tan φ = 0.7):

===========================================  ========  ======  ======  ======  ======
block                                        Housner   2 pts   3 pts   5 pts   9 pts
===========================================  ========  ======  ======  ======  ======
prism 0.4 × 8 m (α = 0.05), k_n = 1e12       0.9963    0.998   0.9997  0.9996  0.9998
prism 0.4 × 4 m (α = 0.1), k_n = 1e12        0.9851    0.992   0.997   0.998   0.998
prism 0.4 × 2 m (α = 0.2), k_n = 1e12        0.9423    0.964   0.986   0.990   0.991
paper's monolith, k_n = 5e10                 0.9413    0.960   0.987   0.991   0.989
paper's monolith, two points, β = 1e-3 s     0.9413    0.9416
paper's monolith, β = 1e-3 s                 0.9413            0.962   0.973
===========================================  ========  ======  ======  ======  ======

An undamped joint therefore bounces more than Housner's block, and the more so the more points it has: the landing is
spread over the face and returns what it stored. The loss also depends on tan φ (0.945 at 0.3, 0.968 without slip) and
on k_s / k_n. Two points with stiffness damping are Housner's impact.
"""

import numpy as np
import pytest
from validation.rocking import dem_prism, ramp, restitutions

from stylobate.column import preset
from stylobate.constants import g
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.simulate import simulate

pytestmark = pytest.mark.processor


def test_flat_block_slides_at_the_friction_coefficient():
    friction = 0.35
    column = dem_prism(2.0, 0.5, 1e11, friction)
    response = simulate(column, ramp(0.5 * g, 4.0), DistinctElement2D(), output_interval=1e-3)
    first = int(np.argmax(np.abs(response.base_displacement) > 2e-7))  # elastic: 7e-8 m at the limit
    assert response.ground_acceleration[first] == pytest.approx(friction * g, rel=0.01)
    before = response.ground_acceleration < 0.995 * friction * g
    assert np.abs(response.base_displacement[before]).max() < 8e-8


@pytest.mark.parametrize(("points", "low", "high"), [(2, 0.955, 0.965), (3, 0.982, 0.991), (5, 0.986, 0.996)])
def test_restitution_without_damping_is_as_documented(points, low, high):
    observed = np.median(restitutions(preset("paper-monolithic"), DistinctElement2D(points=points)))
    assert low < observed < high


def test_undamped_decay_tends_to_a_limit_as_the_joint_stiffens():
    """Two points, slender prism (α = 0.1): between Housner's loss and none, and the same for the stiffest two joints."""
    values = [np.median(restitutions(dem_prism(0.4, 4.0, k), DistinctElement2D())) for k in (1e9, 1e11, 1e12)]
    housner = dem_prism(0.4, 4.0, 1e11).restitution
    assert abs(values[2] - values[1]) < 0.1 * (1.0 - housner)
    assert abs(values[2] - values[1]) < abs(values[1] - values[0])
    assert housner < values[2] < 1.0
