"""Closed forms of one block that rocks: size and shape, periods, impacts, uplift."""

import math
from itertools import pairwise

import numpy as np
from scipy.integrate import quad

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.models.base import Case as Run
from stylobate.models.base import RunOptions
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.drums.records import contact_points
from stylobate.models.engine import engine_for
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import Motion
from stylobate.simulate import simulate

from .case import AtMost, Case, Near, collected

CASES: list[Case] = []
case = collected("closed forms", CASES)

HOUSNER = "Housner 1963"
LINEAR = "equation of motion linearised, by hand"

# -- the columns ---------------------------------------------------------------------------------------------------


def shapes() -> list[Column]:
    """The paper's monolith as a prism of mean width, as a trapezium and as a cone."""
    joint = Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_coefficient=5.0)
    cone = Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=1, density=1600.0, joint=joint, section="circular"
    )
    return [preset("paper-monolithic").as_prism(), preset("paper-monolithic"), cone]


@case(
    "column",
    "tan α of the paper's column: prism, trapezium, cone",
    Near((0.1620, 0.2046, 0.2187), abs=5e-5),
    source="geometry; the paper's 0.16 g and 0.205 g",
    reason="four decimals",
)
def slenderness():
    return [math.tan(column.slenderness) for column in shapes()]


@case(
    "column",
    "frequency parameter p of the three [rad/s]",
    Near((1.7044, 1.7299, 1.7619), abs=5e-5),
    source="$p^2 = m g R / I_0$",
    reason="four decimals",
)
def frequency_parameter():
    return [column.frequency_parameter for column in shapes()]


@case(
    "column",
    "restitution e of the three",
    Near((0.9616, 0.9413, 0.9351), abs=5e-5),
    source=f"{HOUSNER}: $e = 1 - 2 m b^2 / I_0$",
    reason="four decimals",
)
def restitution():
    return [column.restitution for column in shapes()]


# -- free rocking --------------------------------------------------------------------------------------------------

SHARES = (0.1, 0.25, 0.5, 0.75, 0.9)
QUARTERS = (0.46715, 0.79537, 1.31696, 2.06344, 2.99322)  # Housner 1963: arccosh 1/(1 − θ₀/α)


def first_zero(time: np.ndarray, rotation: np.ndarray) -> float:
    """Time of the first passage through zero [s]."""
    k = int(np.argmax(rotation < 0.0))
    return float(time[k - 1] + (time[k] - time[k - 1]) * rotation[k - 1] / (rotation[k - 1] - rotation[k]))


def released(share: float, linear: bool) -> float:
    """p T/4 of Housner's block let go from a share of α."""
    column = preset("paper-monolithic").as_prism()
    p = column.frequency_parameter
    start = share * column.slenderness
    model = HousnerBlock(linear=linear, restitution=1.0, initial_rotation=start, time_step=1e-4)
    response = simulate(column, Motion(0.4 / p, np.zeros(11)), model, output_interval=1e-4)
    return p * first_zero(response.time, response.drum_rotation[:, 0])


@case(
    "housner",
    "quarter period $p\\,T/4$ of free rocking from $\\theta_0/\\alpha$ = 0.1, 0.25, 0.5, 0.75, 0.9, linear",
    Near(QUARTERS, abs=1e-5),
    source=f"{HOUSNER}: arccosh $1/(1-\\theta_0/\\alpha)$",
    reason="five decimals; located on the recording's grid",
)
def quarter_period():
    return [released(share, linear=True) for share in SHARES]


def nonlinear_quarter(share: float) -> float:
    """p T/4 by quadrature of dθ/√(2 (U(θ₀) − U(θ))), with θ = θ₀ − q², which takes the singularity away."""
    alpha = preset("paper-monolithic").as_prism().slenderness
    start = share * alpha

    def integrand(q: float) -> float:
        if q == 0.0:
            return 2.0 / math.sqrt(2.0 * math.sin(alpha - start))
        return 2.0 * q / math.sqrt(2.0 * (math.cos(alpha - start) - math.cos(alpha - start + q * q)))

    return quad(integrand, 0.0, math.sqrt(start))[0]


@case(
    "housner",
    "quarter period, nonlinear: largest relative error",
    AtMost(1e-5),
    source="quadrature of the energy integral",
    reason="located on the recording's grid",
)
def quarter_period_nonlinear():
    return max(abs(released(share, linear=False) / nonlinear_quarter(share) - 1.0) for share in SHARES)


def dem_prism(width: float, height: float, stiffness: float, friction: float = 5.0) -> Column:
    """A monolithic prism for distinct elements; without slip at the default friction."""
    joint = Joint(stiffness, 0.5 * stiffness, friction_coefficient=friction)
    return Column.of_fields(drums=(Drum(height, width, width, 2000.0),), joints=(joint,), name="prism")


def release(column: Column, tilt: float, model: DistinctElement2D, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Rotation of a monolith let go from a tilt on its left corner, that corner closed by the weight: time, rotation."""
    quiet = Motion(1.0, np.zeros(2))
    block = engine_for(model, column).block(RunOptions(tail=duration - quiet.duration))
    block.load(0, Run(column, quiet))
    half, height, weight = 0.5 * column.base_width, column.centroid_height, column.mass * column.gravity
    c, s = math.cos(tilt), math.sin(tilt)
    share = contact_points(column.section, model.points)[1][0]
    closure = weight / (block.records.joint["kn"][0, 0] * 2.0 * half * c * share)
    place = {"x": half * (c - 1.0) - height * s, "z": half * s + height * c - closure, "th": tilt, "c": c, "s": s}
    for name, value in place.items():
        block.records.body[name][1, 0] = value
    time, rotation = [], []
    while not block.is_over(0):
        time.append(block.time(0))
        rotation.append(block.records.body["th"][1, 0])
        block.advance(1)
    return np.array(time), np.array(rotation)


@case(
    "dem2d",
    "quarter period from $\\theta_0/\\alpha$ = 0.25, 0.5, 0.75, 0.9 of a slender prism, α = 0.05, $k_n = 10^{11}$ N/m³",
    Near(QUARTERS[1:], rel=5e-4),
    source=HOUSNER,
    reason="the joint's own tilt, and α²/6 of the linearisation",
)
def quarter_period_dem():
    column = dem_prism(0.4, 8.0, 1e11)
    p, alpha = column.frequency_parameter, column.slenderness
    return [p * first_zero(*release(column, share * alpha, DistinctElement2D(), 4.0)) for share in SHARES[1:]]


# -- impacts -------------------------------------------------------------------------------------------------------


@case(
    "housner",
    "share of the kinetic energy lost at an impact, e = 0, 0.5, 0.9",
    Near((1.0, 0.75, 0.19), rel=1e-7),
    source=f"{HOUSNER}: $1 - e^2$",
    reason="the impact is located within its step",
)
def loss_at_an_impact():
    column = preset("paper-monolithic")
    losses = []
    for e in (0.0, 0.5, 0.9):
        model = HousnerBlock(restitution=e, initial_rotation=0.5 * column.slenderness)
        response = simulate(column, Motion(0.12, np.zeros(11)), model, output_interval=0.01)
        block = model.block(column)
        losses.append(response.energy["impact"][-1] / (block.inertia * block.potential(0.5 * column.slenderness)))
    return losses


def restitutions(column: Column, model: DistinctElement2D, count: int = 6) -> np.ndarray:
    """Velocity ratio at each impact from the peaks around it: velocity² ∝ lift of the centroid at the peak."""
    alpha = column.slenderness
    _, rotation = release(column, 0.5 * alpha, model, 14.0)
    crossings = np.flatnonzero(np.diff(np.sign(rotation)))[: count + 1]
    peaks = [0.5 * alpha] + [np.abs(rotation[i:j]).max() for i, j in pairwise(crossings)]
    lift = np.cos(alpha - np.array(peaks)) - math.cos(alpha)
    return np.sqrt(lift[1:] / lift[:-1])


@case(
    "dem2d",
    "loss of velocity $1 - e$ at impacts, two points with β = 1 ms, over Housner's: monolith, α = 0.2, α = 0.1",
    Near((1.0, 1.0, 1.0), rel=0.03),
    source=HOUSNER,
    reason="soft joints take 0.1 s to close; median over six impacts",
)
def damped_restitution():
    model = DistinctElement2D(stiffness_damping=1e-3)
    columns = [preset("paper-monolithic"), dem_prism(0.4, 2.0, 5e10), dem_prism(0.4, 4.0, 5e10)]
    return [(1.0 - np.median(restitutions(column, model))) / (1.0 - column.restitution) for column in columns]


# -- uplift --------------------------------------------------------------------------------------------------------


def ramp(peak: float, length: float, steps: int = 2000) -> Motion:
    """Acceleration growing with the square of time: no jump in its first derivative, hence hardly any vibration."""
    return Motion(length / steps, np.linspace(0.0, 1.0, steps + 1) ** 2, factor=peak)


def opens(section: str, stiffness: float) -> tuple[Column, DistinctElement2D]:
    """The paper's monolith on joints of a given stiffness; steps so short that an opening is seen within 0.01 %."""
    joint = Joint(stiffness, 0.5 * stiffness, friction_coefficient=0.7)
    column = Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=1, density=1600.0, section=section, joint=joint
    )
    return column, DistinctElement2D(step_factor=0.02 * math.sqrt(stiffness / 1e9), mass_damping=0.5)


def by_statics(section: str, stiffness: float) -> float:
    """Eq. D4 in g."""
    column, _ = opens(section, stiffness)
    tilt = 2.0 * column.joint_weights[0] / (stiffness * column.joint_areas[0] * column.base_width)
    return math.tan(column.slenderness - tilt)


OPENINGS = tuple((section, stiffness) for section in ("rectangular", "circular") for stiffness in (1e8, 1e10))


@case(
    "dem2d",
    "acceleration that opens the base joint [g]: trapezium with $k_n$ = 10⁸ and 10¹⁰ N/m³, cone with the same",
    Near(tuple(by_statics(*opening) for opening in OPENINGS), rel=1e-3),
    source="statics, [Eq. D4](../theory/distinct_element_2d.md); rigid: $B_1 / 2 z_C$ = 0.2046 g, 0.2187 g",
    reason="vibration that the ramp leaves in the soft joint",
)
def uplift():
    accelerations = []
    for section, stiffness in OPENINGS:
        column, model = opens(section, stiffness)
        response = simulate(column, ramp(0.25 * g, 12.0), model, output_interval=1e-4)
        first = int(np.argmax(response.joint_opening[:, 0] > 1e-9))
        accelerations.append(response.ground_acceleration[first] / g)
    return accelerations
