"""Where models, solvers and ways of running must coincide."""

import math
from functools import cache

import numpy as np
from oracles.adaptive_beam import run_adaptive, run_as

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rigid_block.model import RigidBlock
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import Motion, harmonic
from stylobate.motion.pulses import half_sine_pulse, sine_pulse
from stylobate.response import Response
from stylobate.simulate import simulate, simulate_many
from stylobate.statics.limit import limit_analysis
from stylobate.statics.pushover import pushover

from .case import AtMost, Case, Near, collected
from .conservation import shaken, soft_stack

CASES: list[Case] = []
case = collected("agreement", CASES)

# -- models --------------------------------------------------------------------------------------------------------

#: The monolith with friction enough not to slip, under one cycle.
STONE = preset("paper-monolithic").with_joint(friction_coefficient=2.0)


@cache
def histories() -> dict[str, Response]:
    """Housner's block, rigid block and distinct elements under one sine of 0.8 Hz and 0.26 g."""
    motion = sine_pulse(0.8, 0.26 * g, 5.0)
    models = (HousnerBlock(), RigidBlock(), DistinctElement2D())
    return {model.name: simulate(STONE, motion, model, output_interval=0.005) for model in models}


def rotations() -> tuple[np.ndarray, dict[str, np.ndarray], float, float]:
    """Times, rotations by model, time of Housner's first impact, and of the second one of the other two."""
    time = np.linspace(0.0, 5.0, 1001)
    turns = {
        name: np.interp(time, response.histories.time, response.histories.drum_rotation[:, 0])
        for name, response in histories().items()
    }

    def impacts(turn: np.ndarray) -> np.ndarray:
        """Times of the changes of sign, the two of a run that has fewer being never."""
        big = np.abs(turn) > 2e-4
        at, sign = time[big], np.sign(turn[big])
        return np.append(at[1:][sign[1:] != sign[:-1]], [math.inf, math.inf])

    second = min(impacts(turns[name])[1] for name in ("rigid-block", "dem2d"))
    return time, turns, float(impacts(turns["housner"])[0]), float(second)


@case(
    "rigid-block",
    "rotation of the monolith until the first impact, against Housner's block and distinct elements: "
    "largest difference over the peak",
    AtMost(0.02),
    source="the same rigid motion",
    reason="the joint is elastic",
)
def until_the_first_impact():
    time, turns, first, _ = rotations()
    until = time < first
    size = np.abs(turns["housner"][until]).max()
    return [float(np.abs(turns["rigid-block"] - turns[other])[until].max() / size) for other in ("housner", "dem2d")]


@case(
    "rigid-block",
    "rotation until the second impact, against distinct elements: largest difference over the peak",
    AtMost(0.25),
    source="the same drums, other joints",
    reason="the joints lose different amounts at the first impact",
)
def until_the_second_impact():
    time, turns, _, second = rotations()
    until = time < second
    return float(np.abs(turns["rigid-block"] - turns["dem2d"])[until].max() / np.abs(turns["dem2d"][until]).max())


@case(
    "rigid-block",
    "half a sine, $\\omega/p$ = 4: smallest amplitude that overturns the monolith, over Housner's block's",
    Near(1.0, rel=0.03),
    source="one impact-free arc",
    reason="the joint is elastic; the grid is 0.3 %",
)
def half_sine_of_the_monolith():
    frequency = 4.0 * STONE.frequency_parameter / (2.0 * math.pi)
    grid = np.linspace(0.45, 0.75, 151) * g
    motions = [half_sine_pulse(frequency, a, 6.0) for a in grid]
    first = [
        grid[simulate_many(STONE, motions, model, tail=6.0)["collapsed"].to_numpy()][0]
        for model in (RigidBlock(), HousnerBlock())
    ]
    return float(first[0] / first[1])


@case(
    "rigid-block",
    "12 drums, 1 Hz, 32 amplitudes from 0.25 to 0.45 g: median peak top displacement over that of distinct elements",
    Near(1.0, rel=0.15),
    source="the same drums, other joints",
    reason="joint laws lose different amounts at impacts",
)
def median_peak_of_drums():
    motions = [harmonic(1.0, a * g, 6.0) for a in np.linspace(0.25, 0.45, 32)]
    medians = [
        simulate_many(preset("paper-12-drums"), motions, model)["peak_top_displacement_m"].median()
        for model in (RigidBlock(), DistinctElement2D())
    ]
    return float(medians[0] / medians[1])


@case(
    "rigid-beam",
    "one stiff drum: second-order effect in the law or in the equations of motion, difference of the peaks at "
    "half the slenderness over that at the whole",
    AtMost(0.35),
    source="both agree to first order in α: a quarter",
    reason="higher orders",
)
def geometric_and_law():
    differences = []
    for width in (1.0, 0.5):
        joint = Joint(normal_stiffness=1e12, shear_stiffness=1e12, friction_coefficient=0.7)
        column = Column.of_drums([Drum(5.0, width, width, 1600.0)], joint)
        time = np.linspace(0.0, 2.0, 401)
        motion = Motion(time[1], np.sin(np.pi * time), factor=1.25 * g * width / 5.0)
        models = [RigidBeam(moment_law="bilinear", second_order=kind) for kind in ("geometric", "law")]
        peaks = [run_adaptive(column, motion, model).peak_rotation for model in models]
        differences.append(abs(peaks[0] - peaks[1]) / peaks[0])
    assert differences[0] < 0.05
    return differences[1] / differences[0]


@case(
    "pushover, limit",
    "three unequal drums that rock about a narrow neck: relative difference of the multipliers",
    AtMost(1e-3),
    source="path and linear programme",
    reason="the joints' elasticity",
)
def narrow_neck():
    joint = Joint(5e10, 2.5e10, friction_angle=35.0)
    drums = [Drum(1.0, 1.2, 1.0, 2000.0), Drum(0.7, 0.5, 0.5, 2200.0), Drum(2.0, 0.8, 0.7, 1800.0)]
    column = Column.of_drums(drums, joint)
    return pushover(column, to=0.1).collapse_multiplier / limit_analysis(column).multiplier - 1.0


# -- solvers, batches and threads ----------------------------------------------------------------------------------


@case(
    "rigid-beam",
    "fixed step of 0.1 ms and adaptive solver, three drums in 1 s at 0.24 g, undamped, in law, sliding: "
    "relative difference of the peaks",
    AtMost(2e-3),
    source="two solvers, two forms of the equations",
    reason="the fixed step",
)
def fixed_and_adaptive():
    differences = []
    for settings in ({}, {"moment_law": "bilinear", "second_order": "law"}, {"sliding": True, "time_step": 5e-4}):
        column = soft_stack().with_joint(friction_coefficient=0.17) if "sliding" in settings else soft_stack()
        fixed, adaptive = (
            run_as(solver, column, shaken(0.24 * g), RigidBeam(**({"time_step": 1e-4} | settings)))
            for solver in ("fixed", "adaptive")
        )
        differences.append(fixed.peak_top_displacement / adaptive.peak_top_displacement - 1.0)
    return differences


@case(
    "all models",
    "measures of 12 runs that differ between a batch on one thread, a batch on two threads and single runs",
    AtMost(0),
    source="one path through the code",
    reason="to the bit",
)
def batch_and_single():
    column, differing = preset("paper-monolithic"), 0
    motions = [harmonic(0.5 + 0.1 * k, 0.25 * g, 3.0) for k in range(12)]
    for model in (DistinctElement2D(), RigidBlock(), RigidBeam(), HousnerBlock()):
        serial, parallel = (simulate_many(column, motions, model, threads=n).drop(columns="wall_s") for n in (1, 2))
        differing += int(not serial.equals(parallel))
        for k in (0, 5, 11):
            row = simulate(column, motions[k], model).measures.row()
            same = [row[name] == serial[name][k] or row[name] is None for name in row]
            differing += len(same) - sum(same)
    return differing
