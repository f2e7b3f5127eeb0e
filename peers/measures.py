"""The cases, and what is measured of each run: one dictionary of plain numbers for an engine."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scenes import BOTTOM, DIAMETER, GRAVITY, TALL, Run, Scene, column, round_body, round_drums
from scipy.integrate import quad

Engine = Callable[[Scene], Run]

(BLOCK,) = column(1)
MASS, (_, INERTIA, _) = BLOCK.inertia
#: Slenderness of the monolith, distance of its centroid from the edge [m], p² as one rigid block [1/s²] (Housner 1963).
ALPHA, RADIUS = math.atan2(0.5 * BOTTOM, BLOCK.below), math.hypot(0.5 * BOTTOM, BLOCK.below)
P_SQUARED = MASS * GRAVITY * RADIUS / (INERTIA + MASS * RADIUS**2)
#: What a rigid impact without bouncing leaves of the energy.
HOUSNER = (1.0 - 2.0 * MASS * (0.5 * BOTTOM) ** 2 / (INERTIA + MASS * RADIUS**2)) ** 2

FREQUENCIES, AMPLITUDES = (0.5, 1.0, 1.5), (0.2, 0.25, 0.3, 0.4, 0.5, 0.6)
#: Fewer cells, for the drums in other engines.
FEW = [(f, a) for f in (0.5, 1.0) for a in (0.25, 0.4, 0.6)]
#: Relative differences in width of one and the same monolith.
IMPERFECTIONS = (0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)

#: Tilt at which the round column rolls, and at which its depth is taken while it is pushed over [rad].
ROLLING_TILT, SINKING_TILTS = 0.1, np.radians((17.0, 30.0))

#: Shares of the motion across, for one and the same round column.
ACROSS = (0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)

#: Precession of the round column that is set free almost in a plane at ``ROLLING_TILT`` [rad/s].
PRECESSIONS = (0.1, 0.03, 0.01, 0.003, 1e-3, 1e-4)

#: Shares of the motion across of a population of runs, to either side.
POPULATION = [side * share for side in (1.0, -1.0) for share in np.geomspace(3e-4, 3e-2, 12)]

#: How far the monolith rocks out when it is set free, as a share of α.
SHARE = 0.5


def quarter_exact() -> float:
    """Time from upright to the farthest tilt, rigid body, by quadrature [s]."""

    def slowness(u: float) -> float:  # θ = θ₀ (1 − u²) takes the end off the integrand
        theta = SHARE * ALPHA * (1.0 - u * u)
        return 2.0 * SHARE * ALPHA * u / rate_at(theta)

    return quad(slowness, 0.0, 1.0, epsabs=1e-12)[0]


def rate_at(theta: float) -> float:
    """Angular velocity at a tilt on the way to the farthest [rad/s]."""
    return math.sqrt(2.0 * P_SQUARED * (math.cos(ALPHA - SHARE * ALPHA) - math.cos(ALPHA - theta)))


def rolling_exact(tilt: float = ROLLING_TILT) -> float:
    """Precession of the round column that rolls at a constant tilt without spin about its axis [rad/s]."""
    m, (across, _, _) = round_body().inertia
    a, b = 0.5 * DIAMETER, 0.5 * TALL
    c, s = math.cos(tilt), math.sin(tilt)
    return math.sqrt(m * GRAVITY * (a * c - b * s) / (s * (across * c + m * b * (b * c + a * s))))


def static_threshold(run: Engine, bodies, exact: float, azimuth: float = 0.0) -> float:
    """Constant acceleration that just lifts the column, over the closed form [-]; NaN where it is not within 20 %."""
    low, high = 0.8, 1.2

    def lifts(share: float) -> bool:
        seen = run(Scene(bodies, 4.0, push=share * exact * GRAVITY, azimuth=azimuth, output=0.05))
        return bool(np.max(tilts(seen)[-10:]) > 0.005)

    if lifts(low) or not lifts(high):
        return math.nan
    while high - low > 5e-4:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if lifts(middle) else (middle, high)
    return 0.5 * (low + high)


def tilts(seen: Run) -> np.ndarray:
    """Largest tilt of any body [rad], (T,)."""
    return np.arccos(np.clip(seen.axis[..., 2], -1.0, 1.0)).max(axis=1)


def top(seen: Run, bodies) -> np.ndarray:
    """Displacement of the top's centre along x [m], (T,)."""
    return seen.position[:, -1, 0] + (bodies[-1].height - bodies[-1].below) * seen.axis[:, -1, 0]


def collapsed(seen: Run, bodies) -> bool:
    """Whether the top has come down by a tenth of the height."""
    high = seen.position[-1, -1, 2] + (bodies[-1].height - bodies[-1].below) * seen.axis[-1, -1, 2]
    return seen.lost or not high > 0.9 * sum(body.height for body in bodies)


def swings(x: np.ndarray, number: int = 8) -> list[float]:
    """Largest displacement between changes of sign [m], the first so many; swings below 2 mm are no swings."""
    out: list[float] = []
    for value in x:
        if out and value * out[-1] > 0.0:
            out[-1] = max(out[-1], value, key=abs)
        elif abs(value) > 2e-3:
            out.append(float(value))
    return out[:number]


def released(run: Engine) -> dict:
    """Free rocking from upright with the velocity that carries it to half of the slenderness.

    Time until it is upright again over the exact one, and what its first impact leaves of the energy.
    """
    seen = run(Scene(column(1), 3.5, omega=(0.0, rate_at(0.0), 0.0), output=0.001))
    lean = np.arctan2(seen.axis[:, 0, 0], seen.axis[:, 0, 2])
    i = int(np.argmax(lean)) + int(np.argmax(lean[int(np.argmax(lean)) :] < 0.0))
    back = seen.time[i - 1] + (seen.time[i] - seen.time[i - 1]) * lean[i - 1] / (lean[i - 1] - lean[i])
    after = lean[i:]
    end = i + int(np.argmax(after > 0.0)) if (after > 0.0).any() else len(lean)

    def energy(theta: float) -> float:
        return math.cos(ALPHA - theta) - math.cos(ALPHA)

    return {"quarter": back / (2.0 * quarter_exact()), "kept": energy(-lean[i:end].min()) / energy(lean.max())}


def rolling(run: Engine, facets: int) -> dict:
    """Two seconds of steady rolling: tilt at the end, azimuth less the exact one [rad], share of the energy that is lost."""
    body, rate = round_body(facets), rolling_exact()
    d = np.array([math.cos(ROLLING_TILT), 0.0, -math.sin(ROLLING_TILT)])
    omega = tuple(-rate * math.sin(ROLLING_TILT) * d)
    seen = run(Scene((body,), 2.0, tilt=ROLLING_TILT, omega=omega, output=0.001))
    if seen.position[-1, 0, 2] < 0.4 * TALL:
        return {"fell": True}
    axis = seen.axis[:, 0]
    azimuth = np.unwrap(np.arctan2(axis[:, 1], axis[:, 0]))
    speed, turning = (np.gradient(samples, seen.time, axis=0) for samples in (seen.position[:, 0], axis))
    across = (0.75 * DIAMETER**2 + TALL**2) / 12.0
    energy = GRAVITY * seen.position[:, 0, 2] + 0.5 * (speed**2).sum(1) + 0.5 * across * (turning**2).sum(1)
    first, last = energy[2:32].mean(), energy[-32:-2].mean()
    upright = 0.5 * GRAVITY * TALL
    return {
        "tilt": float(np.arccos(axis[-200:, 2]).mean()),
        "azimuth": float(azimuth[-1] - rate * seen.time[-1]),
        "lost": float((first - last) / (first - upright)),
    }


def sinking(run: Engine, facets: int) -> list[float]:
    """How deep the lowest point of the lower rim is when a round column that is pushed over passes 17° and 30° [m].

    The largest of five directions: a polygon meets the ground with a corner, an edge, or something between.
    """
    body = round_body(facets)
    deepest = np.zeros(len(SINKING_TILTS))
    for azimuth in (0.0, 0.05, 0.1, 0.15, 0.2) if facets else (0.0,):
        seen = run(Scene((body,), 2.5, push=0.35 * GRAVITY, azimuth=azimuth))
        points = seen.position[:, 0, None, :] + np.einsum("tij,kj->tki", seen.rotation[:, 0], body.face())
        lean = tilts(seen)
        end = int(np.argmax(lean > math.radians(45.0))) or len(lean)
        depth = np.interp(SINKING_TILTS, lean[:end], -points[:end, :, 2].min(axis=1), right=math.nan)
        deepest = np.fmax(deepest, depth)
    return deepest.tolist()


def shaken(run: Engine, bodies, frequency: float, amplitude: float, across: float = 0.0, rest: float = 5.0) -> Run:
    """Ten seconds of a sine, and a rest [s]."""
    return run(Scene(bodies, 10.0 + rest, ground=(frequency, amplitude * GRAVITY, across)))


def verdicts(run: Engine, bodies, cells) -> dict[str, bool]:
    """Collapse or not by cell of frequency [Hz] and amplitude [g]."""
    return {cell(f, a): collapsed(shaken(run, bodies, f, a), bodies) for f, a in cells}


def plane(run: Engine, few: bool = False, free: bool = True) -> dict:
    """All plane cases; few cells with drums where asked for, none that is set free where an engine only shakes."""
    cells = [(f, a) for f in FREQUENCIES for a in AMPLITUDES]
    static = {"static": static_threshold(run, column(1), 0.5 * BOTTOM / BLOCK.below)}
    out: dict = static | (released(run) if free else {})
    for name, bodies in (("monolith", column(1)), ("drums", column(12))):
        seen = shaken(run, bodies, 1.0, 0.3, rest=0.0)
        chosen = FEW if few and name == "drums" else cells
        out[name] = {"swings": swings(top(seen, bodies)), "wall": seen.wall, "verdicts": verdicts(run, bodies, chosen)}
    wide = [column(1, size) for size in IMPERFECTIONS]
    out["peaks"] = [float(np.abs(top(shaken(run, body, 1.0, 0.3, rest=0.0), body)).max()) for body in wide]
    return out


def space(run: Engine, facets: int, whole: bool) -> dict:
    """All cases of one round column, or of a polygon's prism where ``facets`` is not zero; shaken too if ``whole``."""
    bodies, exact = (round_body(facets),), DIAMETER / TALL
    azimuths = (0.0, math.pi / facets) if facets else (0.0,)
    out: dict = {"static": [static_threshold(run, bodies, exact, azimuth) for azimuth in azimuths]}
    out |= {"rolling": rolling(run, facets), "sinking": sinking(run, facets)}
    if whole:
        cells = [(f, a) for f in FREQUENCIES for a in (0.25, 0.3, 0.4, 0.5)]
        out["verdicts"] = {cell(f, a): collapsed(shaken(run, bodies, f, a, 0.01), bodies) for f, a in cells}
        out["peaks"] = [horizontal_peak(shaken(run, bodies, 1.0, 0.3, across, 0.0), bodies) for across in ACROSS]
    return out


def one_pass(run: Engine, precession: float) -> dict:
    """Half a turn of the round column that is set free almost in a plane: what it keeps, and how far to the side it goes.

    ``kept`` is its energy at the farthest tilt on the other side over that at the start, ``aside`` the direction of that
    tilt less half a turn [rad], ``growth`` its precession then over that at the start.
    """
    slope = np.array([math.cos(ROLLING_TILT), 0.0, -math.sin(ROLLING_TILT)])
    omega = tuple(-precession * math.sin(ROLLING_TILT) * slope)
    seen = run(Scene((round_body(),), 1.9, tilt=ROLLING_TILT, omega=omega, output=0.002))
    axis = seen.axis[:, 0]
    lean, azimuth = np.hypot(axis[:, 0], axis[:, 1]), np.unwrap(np.arctan2(axis[:, 1], axis[:, 0]))
    upright = int(np.argmin(lean[seen.time < 1.2]))
    far = upright + int(np.argmax(lean[upright:]))
    near = slice(max(far - 15, 0), far + 16)
    rate, direction = np.polyfit(seen.time[near] - seen.time[far], azimuth[near], 1)
    alpha = math.atan2(0.5 * DIAMETER, 0.5 * TALL)

    def energy(tilt: float) -> float:
        return math.cos(alpha - tilt) - math.cos(alpha)

    return {
        "kept": energy(math.asin(lean[far])) / energy(ROLLING_TILT),
        "aside": direction - math.copysign(math.pi, direction),
        "growth": rate / precession,
    }


def passes(run: Engine) -> dict:
    """One pass of the round column at several precessions; a population of runs at 1 Hz and 0.3 g: collapses, peaks [m]."""
    results = [one_pass(run, rate) for rate in PRECESSIONS]
    bodies = (round_body(),)
    peaks = [horizontal_peak(shaken(run, bodies, 1.0, 0.3, share, 0.0), bodies) for share in POPULATION]
    return {key: [result[key] for result in results] for key in results[0]} | {"population": sorted(peaks)}


def horizontal_peak(seen: Run, bodies) -> float:
    """Largest horizontal displacement of the top's centre [m]; infinite after a collapse."""
    place = seen.position[:, -1] + (bodies[-1].height - bodies[-1].below) * seen.axis[:, -1]
    return math.inf if collapsed(seen, bodies) else float(np.hypot(place[:, 0], place[:, 1]).max())


def round_stack(run: Engine) -> dict:
    """Twelve round drums at 1 Hz, with a hundredth of the motion across: verdicts, and the seconds of the run at 0.3 g."""
    bodies, collapses, wall = round_drums(), {}, math.nan
    for a in (0.2, 0.3, 0.4, 0.5):
        seen = shaken(run, bodies, 1.0, a, across=0.01)
        collapses[cell(1.0, a)] = collapsed(seen, bodies)
        wall = seen.wall if a == 0.3 else wall
    return {"verdicts": collapses, "wall": wall}


def cell(frequency: float, amplitude: float) -> str:
    """Name of a cell."""
    return f"{frequency:g} Hz {amplitude:g} g"
