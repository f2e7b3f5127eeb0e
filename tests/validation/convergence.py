"""What must settle as steps get shorter and contact points more: orders, the elastic bed, verdicts."""

from functools import cache
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from stylobate.column import Column, Joint, preset
from stylobate.constants import g
from stylobate.kernels.rigid_beam import moment_law
from stylobate.models.base import Case as Run
from stylobate.models.base import RunOptions
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.engine import engine_for
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import Motion, harmonic
from stylobate.simulate import simulate, simulate_many

from .case import AtMost, Case, Near, collected
from .space import round_column

CASES: list[Case] = []
case = collected("convergence", CASES)

MONOLITH = preset("paper-monolithic")

# -- order of the step ---------------------------------------------------------------------------------------------

#: Steps over the longest one.
REFINED = np.array([1.0, 0.5, 0.25])


def order(errors: np.ndarray) -> float:
    """Observed order from the errors at halved steps."""
    return float(np.log2(errors[0] / errors[-1]) / (len(errors) - 1))


@cache
def housner_errors(impacts: bool) -> np.ndarray:
    """Error of the last displacement of free rocking at halved steps [m]: before the first impact, or after three."""
    p = MONOLITH.frequency_parameter
    first = (0.1 if impacts else 0.2) / p
    motion = Motion(first, np.zeros(62 if impacts else 9))
    start = (0.5 if impacts else 0.8) * MONOLITH.slenderness

    def last(step: float) -> float:
        model = HousnerBlock(initial_rotation=start, time_step=step, restitution=0.9)
        return simulate_many(MONOLITH, [motion], model).residual_top_displacement_m[0]

    exact = last(first / 64)
    return np.array([abs(last(first * share) - exact) for share in REFINED])


@cache
def beam_errors(sliding: bool) -> np.ndarray:
    """The same of three drums on joints so soft and tough that they stay closed; the kinks of the motion fall on steps."""
    joint = Joint(normal_stiffness=1e8, shear_stiffness=5e7, friction_coefficient=1.0)
    column = Column.tapered(height=2.0, bottom_width=1.5, top_width=1.2, drums=3, density=2000.0, joint=joint)
    motion = Motion(0.16, np.array([0.0, 1.0, 0.5]), factor=0.3 * g)
    stable = RigidBeam(sliding=sliding).stable_step(column)
    first = 2.0 ** np.floor(np.log2(stable * 0.2 / 0.32)) * 0.32

    def last(step: float) -> float:
        model = RigidBeam(time_step=step * (1 + 1e-12), sliding=sliding)
        return simulate(column, motion, model).residual_top_displacement

    exact = last(first / 32)
    return np.array([abs(last(first * share) - exact) for share in REFINED])


@cache
def dem_errors() -> np.ndarray:
    """The same of the monolith on a soft joint before it opens: a linear oscillator."""
    column = MONOLITH.with_joint(normal_stiffness=1e9, shear_stiffness=5e8, friction_coefficient=50.0)
    motion = harmonic(5.0, 0.02 * g, 0.4)

    def last(factor: float) -> float:
        return simulate(column, motion, DistinctElement2D(step_factor=factor)).top_displacement[-1]

    exact = last(0.1 / 40)
    return np.array([abs(last(0.1 * share) - exact) for share in REFINED])


@case(
    "housner",
    "order of the batch's step between impacts",
    Near(4.0, abs=0.25),
    source="Nyström's method",
    reason="observed from two halvings",
)
def order_of_housner():
    return order(housner_errors(False))


@case(
    "housner",
    "order through three impacts",
    Near(4.0, abs=0.6),
    source="impacts are located to the order of the step",
    reason="impacts fall anywhere in a step",
)
def order_of_housner_through_impacts():
    return order(housner_errors(True))


@case(
    "rigid-beam",
    "order of the fixed step, without and with sliding joints, closed",
    Near((4.0, 4.0), abs=0.35),
    source="classical Runge–Kutta method",
    reason="observed from two halvings",
)
def order_of_the_beam():
    return [order(beam_errors(False)), order(beam_errors(True))]


@case(
    "dem2d",
    "order of the step before a joint opens",
    Near(2.0, abs=0.2),
    source="central differences",
    reason="observed from two halvings",
)
def order_of_dem():
    return order(dem_errors())


# -- contact points ------------------------------------------------------------------------------------------------

RATIOS = (0.3, 0.9, 1.5, 3.0, 8.0, 25.0)


def bed_column(section: str) -> Column:
    """The paper's monolith on a soft joint."""
    joint = Joint(normal_stiffness=1e8, shear_stiffness=5e7, friction_angle=35.0)
    return Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=1, density=1600.0, joint=joint, section=section
    )


def bed_moment(column: Column, phi: float) -> float:
    """Moment of the elastic bed without tension [N m] (Eqs. R2 and R3)."""
    beam, out = RigidBeam().pack(column), np.empty(1)
    moment_law.moments(np.array([phi]), 1.0, beam.joints, beam.bed, out)
    return float(out[0])


def dem_moment(column: Column, points: int, phi: float) -> float:
    """Moment about the middle of the base of a drum turned by φ, lowered until it is pressed by its weight [N m]."""
    model = DistinctElement2D(points=points)
    block = engine_for(model, column).block(RunOptions())
    block.load(0, Run(column, Motion(0.1, np.zeros(2))))
    height, weight = column.centroid_height, float(column.joint_weights[0])
    records = block.records
    drum = records.body
    records.joint["ks"] = 0.0

    def forces(sunk: float) -> np.ndarray:
        drum["th"][1, 0], drum["c"][1, 0], drum["s"][1, 0] = phi, np.cos(phi), np.sin(phi)
        drum["x"][1, 0], drum["z"][1, 0] = -height * np.sin(phi), height * np.cos(phi) - sunk
        records.joint["fs"] = 0.0
        return np.array([component[1] for component in records.forces(0)])

    width = column.base_width
    sunk = brentq(lambda s: forces(s)[1] - weight, -width * phi, width * phi + 1e-3, xtol=1e-16)
    fx, fz, moment = forces(sunk)  # on the drum, about its centroid, counter-clockwise
    return -(moment + drum["x"][1, 0] * fz - drum["z"][1, 0] * fx)


@case(
    "dem2d",
    "moment–rotation curve of 32 contact points, rectangle and circle, closed and open: largest relative "
    "difference to the elastic bed",
    AtMost(0.01),
    source="[Eqs. R2 and R3](../theory/rigid_beam.md)",
    reason="the bed has infinitely many",
)
def many_points_are_a_bed():
    worst = 0.0
    for section in ("rectangular", "circular"):
        column = bed_column(section)
        opening = RigidBeam().pack(column).opening[0]
        for ratio in RATIOS:
            exact = bed_moment(column, ratio * opening)
            worst = max(worst, abs(dem_moment(column, 32, ratio * opening) / exact - 1.0))
    return worst


@case(
    "dem2d",
    "closed rotational stiffness over $k_n J$: 2 and 3 contact points, rectangle",
    Near((3.0, 1.0), rel=1e-3),
    source="two corners: $k_n A d^2/4$; Simpson's rule",
    reason="small rotation",
)
def stiffness_of_few_points():
    column = bed_column("rectangular")
    phi = 0.05 * RigidBeam().pack(column).opening[0]
    return [dem_moment(column, points, phi) / (1e8 * column.joint_second_moments[0] * phi) for points in (2, 3)]


# -- verdicts ------------------------------------------------------------------------------------------------------


@case(
    "housner",
    "verdicts of 576 cells that change as the step is halved, twice, share",
    AtMost(0.01),
    source="located impacts; without them 10 to 20 %",
    reason="cells at the boundary",
)
def verdicts_of_housner():
    frequencies, amplitudes = np.linspace(0.4, 2.0, 24), np.linspace(0.2, 0.6, 24) * g
    motions = [harmonic(float(f), float(a), 10.0) for f in frequencies for a in amplitudes]
    fell = [
        simulate_many(MONOLITH, motions, HousnerBlock(time_step=share / MONOLITH.frequency_parameter))["collapsed"]
        for share in (0.01, 0.005, 0.0025)
    ]
    assert 0.1 < fell[2].mean() < 0.9
    return [float((a != b).mean()) for a, b in pairwise(fell)]


@case(
    "dem2d",
    "verdicts of 144 cells of the monolith that change as the step is halved, twice, share",
    AtMost(0.06),
    source="single runs at the boundary are chaotic",
    reason="cells at the boundary, which flip either way",
)
def verdicts_of_dem():
    return [float((a != b).mean()) for a, b in pairwise(refined_verdicts())]


@cache
def refined_verdicts() -> list[np.ndarray]:
    """Collapsed cells of a domain of the monolith at 0.4, 0.2 and 0.1 of the largest stable step, each of shape (144,)."""
    units = [harmonic(frequency, 1.0, 10.0) for frequency in np.linspace(0.4, 1.6, 9)]
    motions = [unit.scaled(amplitude) for unit in units for amplitude in np.linspace(0.05, 0.6, 16) * g]
    fell = [
        simulate_many(MONOLITH, motions, DistinctElement2D(step_factor=factor))["collapsed"].to_numpy()
        for factor in (0.4, 0.2, 0.1)
    ]
    assert min(verdicts.sum() for verdicts in fell) > 30
    return fell


@case(
    "dem3d",
    "share of 160 round monoliths in space that collapse: change as the step is halved, twice",
    AtMost(0.05),
    source="verdicts of a population settle, single ones at the boundary do not",
    reason="a few cells at the boundary of 160",
)
def population_in_space():
    time = np.arange(2001) * 5e-3
    motions = [
        Motion(5e-3, a * g * np.sin(2.0 * np.pi * f * time), 0.1 * a * g * np.cos(2.0 * np.pi * f * time))
        for f in np.linspace(0.5, 1.4, 10)
        for a in np.linspace(0.15, 0.55, 16)
    ]
    column = round_column()
    shares = [
        simulate_many(column, motions, DistinctElement3D(step_factor=factor))["collapsed"].mean()
        for factor in (0.4, 0.2, 0.1)
    ]
    assert 0.2 < shares[0] < 0.8
    return np.abs(np.diff(shares))
