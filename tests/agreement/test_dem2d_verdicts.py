"""Plane distinct elements: a run that goes on never takes a verdict back. Collapsed lies down; decided stands for good."""

import math

import numpy as np
import pytest

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.kernels.run_codes import CHUNK
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.engine import engine_for
from stylobate.motion import Motion
from stylobate.simulate import simulate_many

MONOLITH, TWELVE = preset("paper-monolithic"), preset("paper-12-drums")

# 8 s in steps of a power of two: a run of 8 s and one of 32 s have the same time step to the bit, hence the same motion.
DURATION, DT = 8.0, 2.0**-9
TIME = np.arange(round(DURATION / DT) + 1) * DT


def model_for(column: Column) -> DistinctElement2D:
    chunks = math.ceil(DURATION / (CHUNK * engine_for(DistinctElement2D(), column).step))
    return DistinctElement2D(time_step=DURATION / (CHUNK * chunks) * (1.0 + 1e-13))


def harmonics(frequencies, amplitudes):
    units = [Motion(DT, np.sin(2.0 * np.pi * f * TIME)) for f in frequencies]
    return [unit.scaled(a * g) for unit in units for a in amplitudes]


def pulses(frequencies, amplitudes):
    """One cosine or one rectangle and quiet after it, in turn."""
    units = [Motion(DT, np.where(f * TIME < 1.0, np.cos(2.0 * np.pi * f * TIME), 0.0)) for f in frequencies]
    units += [Motion(DT, np.where(f * TIME < 0.5, 1.0, 0.0)) for f in frequencies]
    return [unit.scaled(a * g) for unit in units for a in amplitudes]


def noise(count):
    """Bursts of three seconds with a vertical part between 0.2 and 1.4 g."""
    random = np.random.default_rng(2)
    bell = np.exp(-(((TIME - 2.5) / 1.5) ** 2))
    motions = []
    for _ in range(count):
        x, z = np.cumsum(random.standard_normal(len(TIME))), random.standard_normal(len(TIME))
        x = (x - np.convolve(x, np.ones(1000) / 1000.0, "same")) * bell
        z = np.convolve(z * bell, np.hanning(60), "same")
        x *= random.uniform(0.3, 0.9) / np.abs(x).max()
        z *= random.uniform(0.2, 1.4) / np.abs(z).max()
        motions.append(Motion(DT, x, vertical=z, factor=g))
    return motions


def lies(table):
    """Whether the column lies: the top beyond the base for good, or a drum turned over."""
    return (table["residual_top_displacement_m"].abs() > 1.0) | (table["peak_rotation_rad"] > 1.2)


DOMAINS = {
    "monolith": (MONOLITH, harmonics(np.geomspace(0.33, 4.0, 12), np.linspace(0.05, 0.8, 16))),
    "monolith, pulses": (MONOLITH, pulses(np.geomspace(0.3, 3.0, 6), np.linspace(0.1, 2.0, 16))),
    "monolith, vertical": (MONOLITH, noise(64)),
    "12 drums": (TWELVE, harmonics(np.geomspace(0.4, 1.7, 4), np.linspace(0.1, 0.7, 8))),
    "12 drums, vertical": (TWELVE, noise(16)),
}


@pytest.mark.parametrize("case", DOMAINS)
def test_what_was_declared_collapsed_lies_down(case):
    column, motions = DOMAINS[case]
    model = model_for(column)
    declared = simulate_many(column, motions, model, tail=8.0)
    followed = simulate_many(column, motions, model, tail=8.0, until_end=True)
    collapsed = declared["collapsed"]
    assert 0.1 < collapsed.mean() < 0.9
    assert (followed["collapsed"] == collapsed).all()
    assert (declared["collapse_time_s"][collapsed] == followed["collapse_time_s"][collapsed]).all()
    assert lies(followed)[collapsed].all()
    assert not lies(followed)[~collapsed].any()


def continued(column, motions):
    """Verdicts at the end of the motion, and of the same runs 24 s later."""
    model = model_for(column)
    now, later = (simulate_many(column, motions, model, tail=tail) for tail in (0.0, 24.0))
    assert set(now["time_step_s"]) == set(later["time_step_s"])
    return now, later


STANDING = {
    "monolith": (MONOLITH, harmonics(np.geomspace(0.3, 5.0, 24)[::2], np.linspace(0.15, 1.2, 64)[::2])),
    "monolith, pulses": DOMAINS["monolith, pulses"],
    "12 drums": (TWELVE, harmonics([0.817581], np.linspace(0.05, 0.8, 16))),
    "slippery lid": (
        Column.of_drums(
            [Drum(2.0, 2.0, 1.0, 2000.0), Drum(0.5, 1.0, 1.0, 2000.0)],
            Joint(5e10, 2.5e10, friction_coefficient=0.7),
            overrides={2: Joint(5e10, 2.5e10, friction_coefficient=0.02)},
        ),
        harmonics(np.geomspace(0.3, 3.0, 8)[4:7], np.linspace(0.02, 0.3, 12)[4:]),
    ),
}


@pytest.mark.parametrize("case", STANDING)
def test_a_decided_column_that_stands_goes_on_standing(case):
    now, later = continued(*STANDING[case])
    decided = now["decided"] & ~now["collapsed"]
    assert decided.mean() > 0.1
    fell = np.flatnonzero(decided & later["collapsed"])
    assert len(fell) == 0, now.iloc[fell][["outcome", "residual_top_displacement_m", "residual_joint_slip_m"]]


def test_most_runs_are_decided_a_while_after_the_motion():
    column, motions = DOMAINS["monolith"]
    later = simulate_many(column, motions, model_for(column), tail=24.0)
    assert later["decided"].mean() > 0.95
