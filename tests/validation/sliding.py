"""Closed forms of sliding and of a joint's moment: Newmark's block, the elastic bed without tension, two derivations."""

import math

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.kernels.rigid_beam import moment_law
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rigid_beam.state import BeamMatrices
from stylobate.models.rigid_block.model import RigidBlock
from stylobate.motion import Motion
from stylobate.simulate import simulate_many
from stylobate_studies.paper.nodal_beam import nodal_accelerations, rotation_rates

from .case import AtMost, Case, Near, collected

CASES: list[Case] = []
case = collected("closed forms", CASES)

# -- a block that slides -------------------------------------------------------------------------------------------

#: Friction, length of the pulse [s] and its accelerations over g.
FRICTION, LENGTH = 0.3, 0.5
AMPLITUDES = (0.2, 0.29, 0.32, 0.4, 0.6, 0.9, 1.5)


def newmark(amplitude: float) -> float:
    """Slip under a rectangular pulse [m]: ½ a t² (a/μg − 1), and nothing for a ≤ μg (Newmark 1965).

    Relative to the ground the block gains (a − μg) t during the pulse and loses it at μg afterwards.
    """
    return max(0.0, 0.5 * amplitude * g * LENGTH**2 * (amplitude / FRICTION - 1.0))


def slips(model, joint: Joint) -> list[float]:
    """Residual slip of a flat block under the pulses [m]."""
    samples = np.zeros(25_001)
    samples[:5000] = 1.0
    samples[5000] = 0.5  # the middle of the jump
    shape = Motion(LENGTH / 5000, samples)
    column = Column.of_drums([Drum(0.5, 2.0, 2.0, 2000.0)], joint)
    table = simulate_many(column, [shape.scaled(-a * g) for a in AMPLITUDES], model)
    return table["residual_joint_slip_m"].tolist()


NEWMARK = "Newmark 1965: $\\frac12 a t^2 (a/\\mu g - 1)$"
SLIDE = "slip under a pulse of 0.5 s and 0.2 to 1.5 g, μ = 0.3: largest error over the largest slip"


def slip_error(model, joint: Joint) -> float:
    """Largest error over the largest slip."""
    exact = np.array([newmark(a) for a in AMPLITUDES])
    return float(np.abs(np.array(slips(model, joint)) - exact).max() / exact.max())


@case("dem2d", SLIDE, AtMost(1e-3), source=NEWMARK, reason="the joint is elastic in shear")
def newmark_dem():
    return slip_error(DistinctElement2D(), Joint(1e11, 5e10, friction_coefficient=FRICTION))


@case("rigid-block", SLIDE, AtMost(1e-3), source=NEWMARK, reason="the joint is elastic in shear")
def newmark_block():
    return slip_error(RigidBlock(), Joint(1e11, 5e10, friction_coefficient=FRICTION))


@case("rigid-beam", SLIDE, AtMost(1e-3), source=NEWMARK, reason="the joint is elastic in shear")
def newmark_beam():
    return slip_error(RigidBeam(sliding=True), Joint(1e10, 5e9, friction_coefficient=FRICTION))


# -- the moment of a joint -----------------------------------------------------------------------------------------


def pressed(width_at, half: float, load: float, phi: float) -> float:
    """Moment of an elastic bed (1 N/m³) without tension under a load, by quadrature and root finding [N m]."""

    def force(neutral: float, power: int) -> float:
        return quad(lambda x: phi * (x - neutral) * x**power * width_at(x), max(neutral, -half), half, limit=200)[0]

    neutral = brentq(lambda x0: force(x0, 0) - load, -200.0 * half / phi, half * (1 - 1e-12))
    return force(neutral, 1)


@case(
    "rigid-beam",
    "moment of the elastic bed without tension, rectangle and circle, up to 400 times the rotation that "
    "opens it: largest error over $M_u$",
    AtMost(2e-5),
    source="quadrature over the section",
    reason="the circle is a fitted polynomial ([Eq. R3](../theory/rigid_beam.md))",
)
def elastic_bed():
    half, load, worst = 0.6, 2.0e-2, 0.0
    sections = (
        (2.0 * half * 1.3, 1.3 * (2 * half) ** 3 / 12.0, True, lambda x: 1.3),
        (math.pi * half**2, math.pi * half**4 / 4.0, moment_law.circle(),
         lambda x: 2.0 * math.sqrt(max(0.0, half**2 - x * x))),
    )  # fmt: skip
    for area, second, bed, width_at in sections:
        opening = load / (area * half)
        for ratio in (0.3, 0.99, 1.5, 4.0, 30.0, 400.0):
            moment = np.empty(1)
            law = np.array([[second], [load * half], [opening], [0.0], [0.0]])
            moment_law.moments(np.array([ratio * opening]), 1.0, law, bed, moment)
            worst = max(worst, abs(moment[0] - pressed(width_at, half, load, ratio * opening)) / (load * half))
    return worst


@case(
    "rigid-beam",
    "law of three lines, ξ = 0.8, on its elastic branch, its plateau and its falling branch beyond α: $M/M_u$",
    Near((0.4, 0.8, 0.7, -0.4, -0.2), rel=1e-12),
    source="Baraldi et al., Eq. 6 and Fig. 3",
    reason="rounding",
)
def laws_of_lines():
    column = preset("paper-monolithic").as_prism()
    ultimate, alpha = column.joint_weights[0] * 0.405, math.atan2(0.405, 2.5)
    stiffness = 5e10 * column.joint_second_moments[0]
    model = RigidBeam(moment_law="trilinear", xi=0.8, second_order="law")
    ratios = []
    for phi in (0.4 * ultimate / stiffness, 0.1 * alpha, 0.3 * alpha, -0.6 * alpha, 1.2 * alpha):
        out = np.empty(1)
        moment_law.moments(np.array([phi]), 1.0, model.joints(column), None, out)
        ratios.append(out[0] / ultimate)
    return ratios


@case(
    "rigid-beam",
    "accelerations from the drums' rotations ([Eq. F3](../theory/rigid_beam.md)) and from the paper's nodal "
    "form, 1, 2 and 12 drums: largest relative difference",
    AtMost(1e-12),
    source="Baraldi et al., Eq. 2 to 5, put right",
    reason="rounding",
)
def two_derivations():
    joint, worst = Joint(5e10, 2.5e10, friction_coefficient=0.7), 0.0
    for drums in (1, 2, 12):
        for section in ("rectangular", "circular"):
            column = Column.tapered(
                height=5.0, bottom_width=0.96, top_width=0.66, drums=drums, density=1600.0, joint=joint, section=section
            )
            matrices = BeamMatrices(column)
            random = np.random.default_rng(drums)
            for gravity in (0.0, g, 0.7 * g):
                theta, a_g = 0.05 * random.standard_normal(drums), 3.0 * random.standard_normal()
                moments = 2e4 * random.standard_normal(drums)
                turn = rotation_rates(matrices, moments, theta, a_g, gravity)
                absolute = a_g + np.cumsum(column.heights * turn)
                nodes = nodal_accelerations(matrices, moments, theta, a_g, gravity)
                worst = max(worst, float(np.abs(nodes - absolute).max() / np.abs(absolute).max()))
    return worst
