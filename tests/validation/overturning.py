"""Closed forms of the pulses that just overturn a block."""

import math
from functools import cache

import numpy as np
from scipy.optimize import brentq

from stylobate.column import Column, Drum, Joint
from stylobate.constants import g
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import Motion
from stylobate.simulate import simulate_many

from .case import Case, Near, collected
from .rocking import HOUSNER, dem_prism

CASES: list[Case] = []
case = collected("closed forms", CASES)

LINEAR = "equation of motion linearised, by hand"

PT = (0.25, 0.5, 1.0, 2.0, 3.0)
HALF_SINE = (1.0, 2.0, 4.0, 8.0)
ONE_COSINE = (0.5, 1.0, 2.0)


def constant(pt: float) -> float:
    """Smallest A/(α g) of a constant pulse of length t that overturns (Housner 1963)."""
    return 1.0 / (1.0 - math.exp(-pt))


def half_sine(w: float) -> float:
    """The same of half a sine, w = ω/p: √(a²−1) + a exp[−(π − asin 1/a)/w] = w."""
    return brentq(lambda a: math.sqrt(a * a - 1) + a * math.exp(-(math.pi - math.asin(1 / a)) / w) - w, 1.0, 50.0)


def one_sine(w: float) -> float:
    """The same of one sine without impact: √(a²−1) − a exp[−(2π − asin 1/a)/w] = w."""
    return brentq(
        lambda a: math.sqrt(a * a - 1) - a * math.exp(-(2 * math.pi - math.asin(1 / a)) / w) - w, 1.0001, 100.0
    )


def one_cosine(w: float) -> float:
    """The same of one cosine without impact: [1 + w²] / [1 − exp(−2π/w)]."""
    return (1 + w * w) / (1 - math.exp(-2 * math.pi / w))


def pulse(kind: str, size: float, p: float, quiet: float = 0.0) -> Motion:
    """Unit samples of a pulse whose size is p t or ω/p, and quiet after it; its last sample is the middle of a jump."""
    length = size / p if kind == "constant" else (math.pi if kind == "half sine" else 2.0 * math.pi) / (size * p)
    time = np.linspace(0.0, length, 2001)
    shape = {"constant": np.ones_like, "one cosine": lambda t: np.cos(size * p * t)}.get(
        kind, lambda t: np.sin(size * p * t)
    )
    if not quiet:
        return Motion(time[1], shape(time))
    samples = np.zeros(2001 + math.ceil(quiet / time[1]))
    samples[:2001] = shape(time)
    samples[2000] *= 0.5
    return Motion(time[1], samples)


def edge(fell: np.ndarray, ratios: np.ndarray) -> float:
    """Ratio at which the verdict changes once from standing to fallen; NaN where it does not, or more than once."""
    k = int(np.argmax(fell))
    return float(0.5 * (ratios[k - 1] + ratios[k])) if k and fell[k:].all() else math.nan


def fallen_left(column: Column, motions: list[Motion], model, tail: float) -> np.ndarray:
    """Which motions overturn the column away from the push, so without an impact before."""
    table = simulate_many(column, motions, model, tail=tail)
    assert table["decided"].all()
    return (table["collapsed"] & (table["residual_top_displacement_m"] < 0.0)).to_numpy()


@cache
def overturning(model_name: str, kind: str, sizes: tuple[float, ...]) -> list[float]:
    """Smallest A/(α g) that overturns without impact, found on a grid around the closed form."""
    closed = {"constant": constant, "half sine": half_sine, "one sine": one_sine, "one cosine": one_cosine}[kind]
    dem = model_name == "dem2d"
    if dem:
        column, model, spread, tail, quiet = dem_prism(0.4, 8.0, 1e13), DistinctElement2D(), 0.01, 0.0, 15.0
        unit = math.tan(column.slenderness) * g
    else:
        width = 5.0 * math.tan(0.16)
        column = Column.of_drums([Drum(5.0, width, width, 1600.0)], Joint(5e10, 2.5e10, friction_coefficient=5.0))
        model, spread, tail, quiet = HousnerBlock(linear=True, restitution=0.0), 2e-3, 8.0, 0.0
        unit = column.slenderness * g
    ratios = 1.0 + spread * np.linspace(-1.0, 1.0, 16)
    motions = []
    for size in sizes:
        unit_pulse = pulse(kind, size, column.frequency_parameter, quiet)
        motions += [unit_pulse.scaled(closed(size) * ratio * unit) for ratio in ratios]
    fell = fallen_left(column, motions, model, tail).reshape(len(sizes), -1)
    return [closed(size) * edge(row, ratios) for size, row in zip(sizes, fell, strict=True)]


GRID = "the grid of amplitudes is 0.03 %"
STIFF = "the grid is 0.13 %; the joint is elastic ($10^{13}$ N/m³)"


@case(
    "housner",
    "constant pulse, $p t$ = 0.25, 0.5, 1, 2, 3: smallest $A/\\alpha g$ that overturns, linear",
    Near((4.52081, 2.54149, 1.58198, 1.15652, 1.05240), rel=5e-4),
    source=f"{HOUSNER}: $1/(1 - e^{{-pt}})$",
    reason=GRID,
)
def constant_pulse():
    return overturning("housner", "constant", PT)


@case(
    "housner",
    "half a sine, $\\omega/p$ = 1, 2, 4, 8: smallest $A/\\alpha g$",
    Near((1.3224, 1.8007, 2.7908, 4.7871), rel=5e-4),
    source=LINEAR,
    reason=GRID,
)
def half_sine_pulse():
    return overturning("housner", "half sine", HALF_SINE)


@case(
    "housner",
    "one sine without impact, $\\omega/p$ = 1, 2, 4, 8: smallest $A/\\alpha g$",
    Near((1.4183, 2.3499, 5.2390, 14.871), rel=5e-4),
    source=LINEAR,
    reason=GRID,
)
def one_sine_pulse():
    return overturning("housner", "one sine", HALF_SINE)


@case(
    "housner",
    "one cosine without impact, $\\omega/p$ = 0.5, 1, 2: smallest $A/\\alpha g$",
    Near((1.2500, 2.0037, 5.2258), rel=5e-4),
    source=LINEAR,
    reason=GRID,
)
def one_cosine_pulse():
    return overturning("housner", "one cosine", ONE_COSINE)


@case(
    "housner",
    "one sine, α = 0.25, e = 0.9, $\\omega/p$ = 2, nonlinear: overturns from, safe again from, without impact "
    "from [$g\\tan\\alpha$]",
    Near((1.225, 2.325, 2.358), abs=0.01),
    source="independent integration",
    reason="the values are known to 0.005, the grid is 0.0025",
)
def one_sine_nonlinear():
    width = 5.0 * math.tan(0.25)
    column = Column.of_drums([Drum(5.0, width, width, 1600.0)], Joint(5e10, 2.5e10, friction_coefficient=5.0))
    ratios = np.arange(1.150, 2.450, 0.0025)
    unit_pulse = pulse("one sine", 2.0, column.frequency_parameter)
    motions = [unit_pulse.scaled(ratio * g * math.tan(0.25)) for ratio in ratios]
    table = simulate_many(column, motions, HousnerBlock(restitution=0.9), tail=12.0)
    assert table["decided"].all()
    fell = table["collapsed"].to_numpy()
    return 0.5 * (ratios[1:] + ratios[:-1])[fell[1:] != fell[:-1]]


@case(
    "rigid-beam",
    "constant pulse, $p t$ = 0.5, 1, 2, with the beam's own p: smallest $A/\\alpha g$",
    Near(tuple(constant(pt) for pt in (0.5, 1.0, 2.0)), rel=2e-3),
    source=HOUSNER,
    reason="the joint is elastic ($10^{13}$ N/m³); the grid is 0.07 %",
)
def constant_pulse_beam():
    joint = Joint(normal_stiffness=1e13, shear_stiffness=1e13, friction_coefficient=0.7)
    column = Column.of_drums([Drum(5.0, 0.5, 0.5, 1600.0)], joint)
    p = math.sqrt(column.mass * g * 2.5 / (column.mass * 6.25 + column.inertias[0]))  # about the middle of the joint
    ratios = 1.0 + 5e-3 * np.linspace(-1.0, 1.0, 16)
    amplitudes = []
    for pt in (0.5, 1.0, 2.0):
        unit_pulse = Motion(pt / p / 1000, np.ones(1001))
        motions = [unit_pulse.scaled(constant(pt) * ratio * 0.1 * g) for ratio in ratios]
        fell = simulate_many(column, motions, RigidBeam(moment_law="bilinear"), tail=4.0)["collapsed"].to_numpy()
        amplitudes.append(constant(pt) * edge(fell, ratios))
    return amplitudes


@case(
    "dem2d",
    "constant pulse, $p t$ = 0.25, 0.5, 1, 2, 3, α = 0.05, no slip: smallest $A/(g\\tan\\alpha)$",
    Near(tuple(constant(pt) for pt in PT), rel=5e-3),
    source=HOUSNER,
    reason=STIFF,
)
def constant_pulse_dem():
    return overturning("dem2d", "constant", PT)


@case(
    "dem2d",
    "half a sine, $\\omega/p$ = 1, 2, 4, 8: smallest $A/\\alpha g$",
    Near(tuple(half_sine(w) for w in HALF_SINE), rel=5e-3),
    source=LINEAR,
    reason=STIFF,
)
def half_sine_pulse_dem():
    return overturning("dem2d", "half sine", HALF_SINE)


@case(
    "dem2d",
    "one sine without impact, $\\omega/p$ = 1, 2, 4, 8: smallest $A/\\alpha g$",
    Near(tuple(one_sine(w) for w in HALF_SINE), rel=5e-3),
    source=LINEAR,
    reason=STIFF,
)
def one_sine_pulse_dem():
    return overturning("dem2d", "one sine", HALF_SINE)
