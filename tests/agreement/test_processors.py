"""What another processor changes: single verdicts of undamped drums near the boundary, and not their populations.

A sum that is rounded otherwise in its last bit, because vectors are wider or a multiply-add is fused, is to twelve
undamped drums what another last bit of the input is: after some impacts the trajectories are strangers. Inputs that
differ in their last bits therefore stand in for processors here, and `make test-cpus` runs the same counts on each.
"""

import numpy as np
import pytest

from stylobate.column import preset
from stylobate.constants import g
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.motion import harmonic
from stylobate.simulate import simulate_many

pytestmark = pytest.mark.processor

EPS = np.finfo(float).eps

#: Frequency [Hz], amplitudes [g], and how many of the 100 collapse on the processor that this was written on (AVX-512).
POPULATIONS = [(0.5, (0.1, 0.3), 32), (0.7, (0.15, 0.4), 34)]


@pytest.mark.parametrize(("frequency", "amplitudes", "collapses"), POPULATIONS)
def test_last_bits_turn_single_verdicts_and_leave_the_population(frequency, amplitudes, collapses):
    unit, sizes = harmonic(frequency, 1.0, 6.0), np.linspace(*amplitudes, 100) * g
    rows = []
    for bits in (0, 3, -5):
        motions = [unit.scaled(size * (1.0 + bits * EPS)) for size in sizes]
        table = simulate_many(preset("paper-12-drums"), motions, DistinctElement2D())
        assert not (table["outcome"] == "failed").any()
        rows.append(table["collapsed"].to_numpy())
    verdicts = np.array(rows)
    # What can turn is a band of some 12 cells about the boundary, each at most a fair coin there: between two runs 6
    # differ in the mean, with a standard deviation below 2, and a count has one below √12 / 2. Four of them each.
    turned = [int((row != verdicts[0]).sum()) for row in verdicts[1:]]
    assert max(turned) <= 6 + 4 * 2
    assert (np.abs(verdicts.sum(axis=1) - collapses) <= 4.0 * np.sqrt(12) / 2.0).all()
    # Away from the boundary nothing turns.
    sure = np.ones(100, dtype=bool)
    for edge in np.flatnonzero(np.diff(verdicts[0].astype(int))):
        sure[max(0, edge - 12) : edge + 14] = False
    assert sure.sum() > 30
    assert (verdicts[:, sure] == verdicts[0, sure]).all()
