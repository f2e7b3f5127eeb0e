"""Plane distinct elements against what the paper says of its own (Baraldi et al., section 3), and real records."""

import numpy as np
import pytest
from records import record

from stylobate.column import preset
from stylobate.constants import g
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.motion import harmonic
from stylobate.simulate import simulate_many

pytestmark = pytest.mark.processor

FREQUENCIES = np.array([0.5, 0.66, 1.0, 1.5, 2.0])
AMPLITUDES = np.linspace(0.10, 0.60, 16) * g


@pytest.fixture(scope="module")
def domains():
    """Collapsed cells of both columns, shape (frequencies, amplitudes); two points, tan φ = 0.70, no damping."""
    cells = {}
    for name in ("paper-monolithic", "paper-12-drums"):
        units = [harmonic(frequency, 1.0, 10.0) for frequency in FREQUENCIES]
        motions = [unit.scaled(amplitude) for unit in units for amplitude in AMPLITUDES]
        table = simulate_many(preset(name), motions, DistinctElement2D())
        assert not (table["outcome"] == "failed").any()
        cells[name] = table["collapsed"].to_numpy().reshape(len(FREQUENCIES), len(AMPLITUDES))
    return cells


@pytest.mark.parametrize("name", ["paper-monolithic", "paper-12-drums"])
def test_collapse_acceleration_grows_with_frequency(domains, name):
    """Section 3.1: 'a collapse acceleration that increases for increasing input frequency' (here in counts)."""
    counts = domains[name].sum(axis=1)
    assert counts[0] > counts[2] >= counts[3] >= counts[4]
    assert counts[1] > counts[2]


@pytest.mark.parametrize("file", ["twocol_ElCentro1940_NS.dat", "csmip_v1_Ridgecrest2019_ChinaLake_CLC.v1"])
@pytest.mark.filterwarnings("ignore::stylobate.errors.OutOfRangeWarning")
def test_real_records_as_they_are_and_scaled_until_collapse(file):
    """Both columns survive the records as recorded; the unsafe scale is far above the static uplift acceleration."""
    from stylobate.motion import read_motion

    motion = read_motion(record(file))
    peak = int(np.abs(motion.samples).argmax())
    strong = slice(max(0, peak - int(20.0 / motion.dt)), peak + int(20.0 / motion.dt))
    motion = motion.replace(
        acceleration=motion.samples[strong],
        lateral=None,
        vertical=None if motion.z_samples is None else motion.z_samples[strong],
    )
    for name in ("paper-monolithic", "paper-12-drums"):
        column = preset(name)
        scales = np.array([1.0, 2.0, 4.0, 8.0])
        table = simulate_many(column, [motion.scaled(s) for s in scales], DistinctElement2D())
        assert not table["collapsed"][0]
        assert table["outcome"][0] in ("rocked", "displaced")
        assert table["collapsed"].to_numpy()[-1]
