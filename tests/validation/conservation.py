"""What must be kept: the energy ledger, mirror symmetry, similarity, and a column that nobody shakes."""

from functools import cache

import numpy as np

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.models.base import Model
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.engine import engine_for
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rigid_block.model import RigidBlock
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import Motion, harmonic
from stylobate.simulate import simulate, simulate_many

from .case import AtMost, Between, Case, collected

CASES: list[Case] = []
case = collected("conservation", CASES)

MONOLITH, TWELVE = preset("paper-monolithic"), preset("paper-12-drums")

# -- the ledger ----------------------------------------------------------------------------------------------------

#: Shares of the largest stable step.
FACTORS = (0.4, 0.2, 0.1)

LEDGER = "energy imbalance, 1 Hz, median of 32 amplitudes from {} g, {}: at 0.4 of the stable step"
QUARTERED = "fall of the missed energy as the step is quartered, {}"


@cache
def imbalances(model: type[Model], drums: int, low: float, high: float, duration: float) -> tuple[float, ...]:
    """Median imbalance at each of the steps [-]."""
    column = MONOLITH if drums == 1 else TWELVE
    unit = harmonic(1.0, 1.0, duration)
    motions = [unit.scaled(a) for a in np.linspace(low, high, 32) * g]
    medians = []
    for factor in FACTORS:
        table = simulate_many(column, motions, model(step_factor=factor))
        assert (table["peak_joint_opening_m"] > 1e-3).all()
        medians.append(float(table["energy_imbalance"].median()))
    return tuple(medians)


def monolith_dem() -> tuple[float, ...]:
    """Median imbalances of the monolith by distinct elements."""
    return imbalances(DistinctElement2D, 1, 0.28, 0.32, 10.0)


def drums_dem() -> tuple[float, ...]:
    """Median imbalances of twelve drums by distinct elements."""
    return imbalances(DistinctElement2D, 12, 0.28, 0.32, 10.0)


def drums_block() -> tuple[float, ...]:
    """Median imbalances of twelve drums by rigid blocks."""
    return imbalances(RigidBlock, 12, 0.25, 0.32, 10.0)


def case_of_ledger(model: str, what: str, drums: str, compute, limit: float) -> None:
    """Two lines for a model and a column: the size of what is missed, and how it falls with the step."""
    source = "$\\frac12 k a b$ at every closing contact ([theory](../theory/distinct_element_2d.md))"

    def size() -> float:
        return compute()[0]

    def fall() -> float:
        return compute()[0] / compute()[2]

    size.__name__, fall.__name__ = f"ledger_{what}", f"ledger_order_{what}"
    case(model, LEDGER.format("0.25 to 0.32" if model == "rigid-block" else "0.28 to 0.32", drums), AtMost(limit),
         source=source, reason="what closing contacts cost at this step")(size)  # fmt: skip
    case(
        model,
        QUARTERED.format(drums),
        Between(4.0, 40.0),
        source=source,
        reason="16 is second order; medians of chaotic runs",
    )(fall)


case_of_ledger("dem2d", "monolith", "monolith", monolith_dem, 2e-2)
case_of_ledger("dem2d", "drums", "12 drums", drums_dem, 3e-3)
case_of_ledger("rigid-block", "drums_block", "12 drums", drums_block, 1e-2)


@case(
    "housner",
    "energy missed over the input work: one run of 6 s at 0.28 g, with and without vertical input, largest",
    AtMost(1e-7),
    source="energy balance of each arc and impact",
    reason="steps of order four, with impacts located",
)
def ledger_housner():
    time = np.arange(6001) * 1e-3
    worst = 0.0
    for vertical in (0.0, 0.3 * g):
        motion = Motion(1e-3, 0.28 * g * np.sin(2 * np.pi * time), vertical=vertical * np.sin(2 * np.pi * 3.1 * time))
        response = simulate(MONOLITH, motion, HousnerBlock())
        worst = max(worst, float(np.abs(response.imbalance).max() / response.energy["input"].max()))
    return worst


def soft_stack(size: float = 1.0) -> Column:
    """Three drums of the paper's column on soft joints."""
    joint = Joint(normal_stiffness=1e9, shear_stiffness=5e8, friction_coefficient=0.7)
    return Column.tapered(
        height=5.0 * size, bottom_width=0.96 * size, top_width=0.66 * size, drums=3, density=1600.0, joint=joint
    )


def shaken(amplitude: float, duration: float = 1.0) -> Motion:
    """A sine of 1 Hz."""
    time = np.linspace(0.0, duration, 751)
    return Motion(time[1], amplitude * np.sin(2 * np.pi * time))


@case(
    "rigid-beam",
    "energy missed over the input work: three drums in 1 s at 0.25 g, undamped, damped, sliding, the paper's, largest",
    AtMost(2e-3),
    source="energy balance",
    reason="step of 0.1 ms",
)
def ledger_beam():
    models = (
        RigidBeam(time_step=1e-4),
        RigidBeam(time_step=1e-4, stiffness_damping=2e-4),
        RigidBeam(time_step=1e-4, sliding=True),
        RigidBeam.paper(time_step=1e-4),
    )
    imbalances = []
    for model in models:
        column = soft_stack().with_joint(friction_coefficient=0.16) if model.sliding else soft_stack()
        response = simulate(column, shaken(0.25 * g), model)
        assert response.peak_rotation > 1e-3
        imbalances.append(float(np.abs(response.imbalance).max() / response.energy["input"].max()))
    return imbalances


# -- symmetry and similarity ---------------------------------------------------------------------------------------


@case(
    "housner, rigid-beam",
    "mirrored input: largest difference of the mirrored rotations [rad]",
    AtMost(0.0),
    source="symmetry",
    reason="to the bit",
)
def mirror_to_the_bit():
    worst = 0.0
    for column, model in (
        (MONOLITH, HousnerBlock()),
        (soft_stack(), RigidBeam()),
        (soft_stack(), RigidBeam(sliding=True)),
        (soft_stack(), RigidBeam.paper()),
    ):
        motion = shaken(0.28 * g)
        left, right = (simulate(column, motion.scaled(sign), model) for sign in (1.0, -1.0))
        worst = max(worst, float(np.abs(left.drum_rotation + right.drum_rotation).max()))
    return worst


def first_impact(response) -> int:
    """Row at which a joint that had opened is closed again, or open on its other side."""
    turn = np.diff(response.drum_rotation, axis=1, prepend=0.0)
    rows = len(turn)
    for j in range(turn.shape[1]):
        opened = np.flatnonzero(response.joint_opening[:, j] > 1e-5)
        if len(opened):
            side = np.sign(turn[opened[0], j])
            again = (response.joint_opening[opened[0] :, j] < 1e-6) | (np.sign(turn[opened[0] :, j]) != side)
            rows = min(rows, opened[0] + int(np.argmax(again))) if again.any() else rows
    return rows


def rounding_shows(response, column: Column, motion, model) -> int:
    """Row from which one of two runs whose input differs in its last bit is more than 1e-12 away [m, rad]."""
    rows = len(response.time)
    for last_bit in (2.0**-52, -(2.0**-53)):
        beside = simulate(column, motion.scaled(1.0 + last_bit), model)
        both = min(len(response.time), len(beside.time))  # a run ends where its collapse is certain
        for name in ("drum_x", "drum_z", "drum_rotation", "joint_opening"):
            apart = np.abs(getattr(beside, name)[:both] - getattr(response, name)[:both]).max(axis=1) > 1e-12
            rows = min(rows, int(np.argmax(apart))) if apart.any() else rows
    return rows


@case(
    "dem2d",
    "mirrored input, 1 and 12 drums at 0.4 g: largest difference of the mirrored displacements until the first "
    "impact, as long as the last bit of the input makes less than 1e-12 [m]",
    AtMost(1e-11),
    source="symmetry",
    reason="opening joints and impacts make rounding grow, from run to run by a few times more or less",
)
def mirror_dem():
    worst = 0.0
    for column in (MONOLITH, TWELVE):
        motion = harmonic(1.0, 0.4 * g, 2.0)
        right, left = (simulate(column, motion.scaled(sign), DistinctElement2D()) for sign in (1.0, -1.0))
        before = slice(0, min(first_impact(right) - 2, rounding_shows(right, column, motion, DistinctElement2D())))
        assert right.joint_opening[before].max() > 1e-3
        worst = max(worst, float(np.abs(right.drum_x[before] + left.drum_x[before]).max()))
    return worst


def scaled(column: Column, k: float) -> Column:
    """All lengths × k, times × √k, density and gravity kept; k_n and k_s stay, because k³ = k_n k² k."""
    drums = [
        Drum(d.height * k, d.bottom_width * k, d.top_width * k, d.density, d.section, d.depth * k) for d in column.drums
    ]
    return Column(tuple(drums), column.joints)


@case(
    "dem2d",
    "four times the size, twice the time, 12 drums, 4 s at 0.35 g with damping: largest difference of the scaled "
    "displacements [m]",
    AtMost(0.0),
    source="similarity",
    reason="every number differs by a power of two: to the bit",
)
def similarity_dem():
    step = engine_for(DistinctElement2D(), TWELVE).step
    small = DistinctElement2D(time_step=step, stiffness_damping=2.0**-15, mass_damping=0.25)
    large = DistinctElement2D(time_step=2.0 * step, stiffness_damping=2.0**-14, mass_damping=0.125)
    motion = harmonic(1.0, 0.35 * g, 4.0)
    original = simulate(TWELVE, motion, small)
    four = simulate(scaled(TWELVE, 4.0), motion.replace(dt=2.0 * motion.dt), large, output_interval=0.02)
    assert original.peak_top_displacement > 0.02
    return float(np.abs(four.drum_x - 4.0 * original.drum_x).max())


@case(
    "dem2d",
    "columns of 1 and 12 drums left alone for 60 s: largest displacement [m] or rotation",
    AtMost(1e-8),
    source="equilibrium",
    reason="rounding",
)
def left_alone():
    deviations = []
    for column in (MONOLITH, TWELVE):
        response = simulate(column, Motion(30.0, np.zeros(3)), DistinctElement2D(), output_interval=0.5)
        assert str(response.outcome) == "at_rest"
        assert response.decided
        names = ("drum_x", "drum_z", "drum_rotation", "joint_opening", "joint_slip")
        deviations.append(max(float(np.abs(getattr(response, name)).max()) for name in names))
    return max(deviations)
