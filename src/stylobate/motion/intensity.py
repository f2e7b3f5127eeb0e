"""Measures of a motion: how strong, how long, how fast for a given column; and the names by which a person types them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..constants import g
from ..errors import InputError, OutOfRangeWarning, check_range, suggest, warn, within
from ..messages import say
from .conditioning import cure_of, cure_request, cured, drift_of
from .motion import Motion, absolute_integral, arias, displacement, peak_velocity, square_integral, time_above
from .pulses import pulse_match
from .specs import ACCELERATION_UNITS, parse_time
from .specs import values_of as _values
from .spectra import housner_intensity, pseudo_acceleration, rotated_pga

#: Of a peak velocity, in warnings that results keep and that what rests on them says again.
DRIFTS = say("is that of a baseline which drifts")


def peak_ground_velocity(motion: Motion, component: str = "x") -> float:
    """Largest absolute velocity from rest, also between samples [m/s]."""
    return peak_velocity(motion.components[component], motion.dt)


def peak_ground_displacement(motion: Motion, component: str = "x") -> float:
    """Largest absolute displacement from rest [m]; where :func:`displacement_drift` is not zero, it is the drift's."""
    return float(np.abs(displacement(motion.components[component], motion.dt)).max())


def displacement_drift(motion: Motion, component: str = "x") -> float:
    """Displacement at the end, where it makes most of the peak and more than 0.1 m; else 0 [m].

    An offset of the baseline grows with the square of time under double integration; a ground that shook comes back, or
    stops within metres of a fault.
    """
    return drift_of(motion.components[component], motion.dt)


def warn_of_drift(motion: Motion) -> None:
    """Warn of peak displacements of a record that double integration has made; computed motions have no baseline."""
    for axis in motion.components if "file" in motion.metadata else ():
        if drift := displacement_drift(motion, axis):
            peak, cure = peak_ground_displacement(motion, axis), cure_of(motion)
            remedy = say("take no displacement from it, as no conditioning that is known here mends it")
            if cure is not None:
                words = say("correct it before a displacement is taken from it ({as_asked})")
                remedy = words.of(as_asked=cure_request(cure))
            warn(
                say(
                    "{motion.name}: the peak displacement of component {axis}, {peak:.3g} m, is what double integration "
                    "leaves: {drift:.3g} m stand at the end, drift of the baseline unless the ground moved for good; "
                    "{remedy}.",
                    motion=motion,
                    axis=axis,
                    peak=peak,
                    drift=drift,
                    remedy=remedy,
                ),
                OutOfRangeWarning,
            )


def warn_of_velocity(motion: Motion, axes: str = "x") -> None:
    """Warn of a peak velocity that holds drift, where it is what says how strong a record is; with what it is without."""
    for axis in axes if "file" in motion.metadata else ():
        if axis not in motion.components or not (drift := displacement_drift(motion, axis)):
            continue
        own, cure = peak_ground_velocity(motion, axis), cure_of(motion)
        remedy = say(
            "take its strength from another measure, such as sa:1s, as no conditioning that is known here mends it"
        )
        if cure is not None:
            velocity = peak_ground_velocity(cured(motion, cure), axis)
            remedy = say(
                "correct it first ({as_asked}), which leaves {left:.3g} m/s",
                as_asked=cure_request(cure),
                left=velocity,
            )
        warn(
            say(
                "{motion.name}: the peak velocity of component {axis}, {own:.3g} m/s, {DRIFTS}: integrated twice, "
                "{drift:.3g} m stand at the end; {remedy}.",
                motion=motion,
                axis=axis,
                own=own,
                DRIFTS=DRIFTS,
                drift=abs(drift),
                remedy=remedy,
            ),
            OutOfRangeWarning,
        )


def arias_intensity(motion: Motion, component: str = "x") -> float:
    """Arias intensity π/(2g) ∫a² dt, exact for the linear interpolation [m/s].

    References
    ----------
    Arias (1970).
    """
    return arias(motion.components[component], motion.dt)


def cumulative_absolute_velocity(motion: Motion, component: str = "x") -> float:
    """CAV, ∫|a| dt, exact for the linear interpolation [m/s].

    References
    ----------
    EPRI (1988), without a threshold.
    """
    return absolute_integral(motion.components[component], motion.dt)


def significant_duration(motion: Motion, low: float = 0.05, high: float = 0.95, component: str = "x") -> float:
    """Time in which the Arias intensity grows from ``low`` to ``high`` of its end value [s].

    References
    ----------
    Trifunac and Brady (1975).
    """
    growth = square_integral(motion.components[component], motion.dt)
    if growth[-1] == 0.0:
        return 0.0
    start, end = np.interp([low, high], growth / growth[-1], motion.time)
    return float(end - start)


def rocking_measures(motion: Motion, tangent: float, frequency_parameter: float, component: str = "x") -> dict:
    """Measures of a motion for a block of given slenderness and size.

    Parameters
    ----------
    motion : Motion
    tangent : float
        tan α of the column [-].
    frequency_parameter : float
        p of the column [rad/s].
    component : str

    Returns
    -------
    dict
        ``pga_over_g_tan_alpha``: below 1 a rigid column stays closed; ``omega_g_over_p``: frequency of the strongest
        pulse to that of the column; ``uniform_duration_s``: time during which |a| exceeds g tan α;
        ``pgv_p_over_g_tan_alpha``: dimensionless velocity.
    """
    alpha = check_range("tan α", tangent, 0.0, 10.0, open_low=True)
    p = check_range("p", frequency_parameter, 0.0, 100.0, unit="rad/s", open_low=True)
    values = motion.components[component]
    peak = float(np.abs(values).max())
    period = pulse_match(motion, component=component).period if peak > 0.0 else math.nan
    return {
        "pga_over_g_tan_alpha": peak / (g * alpha),
        "omega_g_over_p": 2.0 * math.pi / period / p if period > 0.0 else None,
        "uniform_duration_s": time_above(values, motion.dt, g * alpha),
        "pgv_p_over_g_tan_alpha": peak_velocity(values, motion.dt) * p / (g * alpha),
    }


def motion_summary(motion: Motion, *, spectrum: bool = True) -> dict[str, Any]:
    """Contents of a motion, as plain values for JSON.

    Parameters
    ----------
    motion : Motion
    spectrum : bool
        Spectral measures too; they need the compiled kernels.

    Returns
    -------
    dict
        Units are in the keys; measures of components by axis.
    """
    facts = motion.metadata
    azimuths = facts.get("azimuths") or {}
    axes = motion.components
    dt = motion.dt
    summary: dict[str, Any] = {"name": motion.name}
    for key in (
        "format",
        "stage",
        "unit",
        "station",
        "station_name",
        "network",
        "event",
        "start_time",
        "terms",
        "file",
    ):
        if key in facts:
            summary[key] = None if facts[key] is None else str(facts[key])
    summary |= {
        "components": list(axes),
        "azimuths_deg": {axis: azimuths.get(axis) for axis in axes if axis != "z"},
        "labels": {axis: str(label) for axis, label in (facts.get("labels") or {}).items()},
        "dt_s": dt,
        "steps": motion.steps,
        "duration_s": motion.duration,
        "pga_g": {axis: float(np.abs(a).max()) / g for axis, a in axes.items()},
        "pgv_m_s": {axis: peak_velocity(a, dt) for axis, a in axes.items()},
        "pgd_m": {axis: float(np.abs(displacement(a, dt)).max()) for axis, a in axes.items()},
        "pgd_drift_m": {axis: displacement_drift(motion, axis) for axis in axes},
        "final_velocity_m_s": {axis: float(dt * (a.sum() - 0.5 * (a[0] + a[-1]))) for axis, a in axes.items()},
        "arias_m_s": {axis: arias(a, dt) for axis, a in axes.items()},
        "cav_m_s": {axis: absolute_integral(a, dt) for axis, a in axes.items()},
        "duration_5_75_s": {axis: significant_duration(motion, 0.05, 0.75, axis) for axis in axes},
        "duration_5_95_s": {axis: significant_duration(motion, 0.05, 0.95, axis) for axis in axes},
    }
    if motion.lateral is not None:
        rotated = rotated_pga(motion)
        summary |= {"pga_rotd50_g": rotated[50.0] / g, "pga_rotd100_g": rotated[100.0] / g}
    shaken = motion.pga > 0.0
    if shaken:
        pulse = pulse_match(motion)
        summary |= {
            "pgv_over_pga_s": peak_velocity(axes["x"], dt) / motion.pga,
            "pulse_period_s": pulse.period,
            "pulse_amplitude_g": pulse.amplitude / g,
            "pulse_energy_share": pulse.energy_share,
        }
    if spectrum and shaken:
        periods = [0.1, 0.2, 0.5, 1.0, 2.0, 4.0]
        psa = pseudo_acceleration(motion, periods) / g
        summary["psa_5_percent_g"] = {f"{period:g} s": float(value) for period, value in zip(periods, psa)}
        summary["housner_intensity_m"] = housner_intensity(motion)
    return summary | {"processing": list(motion.processing)}


# Intensity measures by the names that a person types: ``pga``, ``pgv@geomean``, ``sa:1.0s``, ``avgsa:0.5s-3s``.

#: Periods of an average spectral acceleration by default [s], and how many of them, evenly spaced in their logarithm: a
#: rocking column has no period of its own, and answers to long ones.
AVERAGED, PERIODS = (0.5, 3.0), 10

#: Directions in which an orientation-independent measure looks, one degree apart (Boore 2010).
DIRECTIONS = np.radians(np.arange(180.0))


@dataclass(frozen=True)
class Kind:
    """A kind of measure.

    Parameters
    ----------
    words, unit : str
    power : int
        Of the factor of a motion that the measure grows with [-]; 0 where scaling does not change it.
    of : callable
        Value of one component (x) of a motion, given periods [s] and (tan α, p) of a column.
    column : bool
        Whether it relates the motion to a column.
    """

    words: str
    unit: str
    power: int
    of: Callable[[Motion, tuple[float, ...], tuple[float, float] | None], float]
    column: bool = False


def _rocking(key: str) -> Callable[[Motion, tuple[float, ...], tuple[float, float] | None], float]:
    def value_for(motion: Motion, _: tuple[float, ...], column: tuple[float, float] | None) -> float:
        assert column is not None
        value = rocking_measures(motion, *column)[key]
        return math.nan if value is None else float(value)

    return value_for


def _average(motion: Motion, periods: tuple[float, ...], _: object) -> float:
    t = np.geomspace(periods[0], periods[1], PERIODS)
    return float(np.exp(np.log(pseudo_acceleration(motion, t)).mean())) / g


#: Kinds by name. Sources: docs/theory/fragility.md.
KINDS: dict[str, Kind] = {
    "pga": Kind("peak ground acceleration", "g", 1, lambda m, *_: m.pga / g),
    "pgv": Kind("peak ground velocity", "m/s", 1, lambda m, *_: m.pgv),
    "pgv_over_pga": Kind("PGV/PGA", "s", 0, lambda m, *_: m.pgv / m.pga if m.pga else math.nan),
    "sa": Kind("Sa, 5 % damping", "g", 1, lambda m, t, _: float(pseudo_acceleration(m, t)[0]) / g),
    "avgsa": Kind("average Sa", "g", 1, _average),
    "cav": Kind("cumulative absolute velocity", "m/s", 1, lambda m, *_: cumulative_absolute_velocity(m)),
    "arias": Kind("Arias intensity", "m/s", 2, lambda m, *_: arias_intensity(m)),
    "d5_95": Kind("significant duration 5–95 %", "s", 0, lambda m, *_: significant_duration(m)),
    "d5_75": Kind("significant duration 5–75 %", "s", 0, lambda m, *_: significant_duration(m, 0.05, 0.75)),
    "pulse_period": Kind("period of the strongest pulse", "s", 0, lambda m, *_: pulse_match(m).period),
    "pulse_share": Kind(
        "share of the strongest pulse in the energy", "-", 0, lambda m, *_: pulse_match(m).energy_share
    ),
    "pga_over_g_tan_alpha": Kind("PGA/(g tan α)", "-", 1, _rocking("pga_over_g_tan_alpha"), True),
    "pgv_p_over_g_tan_alpha": Kind("p PGV/(g tan α)", "-", 1, _rocking("pgv_p_over_g_tan_alpha"), True),
    "omega_g_over_p": Kind("ω_g/p", "-", 0, _rocking("omega_g_over_p"), True),
}

#: Measures of every run's motion that tables hold, those of both components where a motion has two.
TABLE_MEASURES = (
    *("pga", "pgv", "pgv_over_pga", "sa:0.5s", "sa:1s", "sa:2s", "avgsa", "cav", "arias", "d5_95"),
    *("pga_over_g_tan_alpha", "pgv_p_over_g_tan_alpha", "omega_g_over_p"),
)
TWO_COMPONENT_MEASURES = ("pga@geomean", "pgv@geomean")

#: Ends of the columns of tables, by unit.
ENDS = {"g": "_g", "m/s": "_m_s", "s": "_s", "-": ""}

#: Uses of the two horizontal components.
COMPONENTS = ("x", "y", "z", "geomean", "larger", "rotd50", "rotd100")

_SPEC = re.compile(r"(?P<kind>[a-z0-9_]+)(?::(?P<periods>[^@]+))?(?:@(?P<component>[a-z0-9]+))?")


@dataclass(frozen=True)
class IntensityMeasure:
    """One number for how strong a motion is.

    Parameters
    ----------
    kind : str
        Of :data:`KINDS`.
    periods : tuple of float
        One for ``sa``, first and last for ``avgsa`` [s].
    component : str
        ``x`` (the plane of the plane models), ``y``, ``z``, or of both horizontal components their geometric mean, the
        larger one, or the median or largest over all directions (RotD50, RotD100: of ``pga``, ``pgv``, ``sa``, ``avgsa``).
    """

    wanted: ClassVar[str] = "an intensity measure (parse_measure)"

    kind: str
    periods: tuple[float, ...] = ()
    component: str = "x"

    @property
    def name(self) -> str:
        """As it is typed."""
        periods = "-".join(f"{t:g}s" for t in self.periods)
        at = "" if self.component == "x" else f"@{self.component}"
        return f"{self.kind}{':' if periods else ''}{periods}{at}"

    @property
    def unit(self) -> str:
        """``g``, ``m/s``, ``s`` or ``-``."""
        return KINDS[self.kind].unit

    @property
    def power(self) -> int:
        """Of the factor of a motion that it grows with; 0: scaling does not change it."""
        return KINDS[self.kind].power

    @property
    def words(self) -> str:
        """For the axis of a picture, with its unit."""
        periods = " to ".join(f"{t:g}" for t in self.periods)
        at = "" if self.component == "x" else f", {self.component}"
        return f"{KINDS[self.kind].words}{f' at {periods} s' if periods else ''}{at} [{self.unit}]"

    @property
    def key(self) -> str:
        """Its column in a table."""
        return self.name.replace(":", "_").replace("@", "_") + ENDS[self.unit]

    def of(self, motion: Motion, column: tuple[float, float] | None = None) -> float:
        """Value for a motion, in :attr:`unit`.

        Parameters
        ----------
        motion : Motion
        column : (float, float), optional
            tan α [-] and p [rad/s] of the column, for the measures of rocking.

        Raises
        ------
        InputError
            A component that the motion lacks, or a measure of rocking without a column.
        """
        kind = KINDS[self.kind]
        if kind.column and column is None:
            raise InputError(f"{self.name} relates a motion to a column, and none is given here; use another measure.")
        needed = {"x": "x", "y": "y", "z": "z"}.get(self.component, "y")
        if needed not in motion.components:
            word = {"y": "a second horizontal", "z": "a vertical"}[needed]
            raise InputError(
                f"{self.name} needs {word} component, which {motion.name!r} has not; use {self.kind} along x, or leave "
                "the record out."
            )
        if self.component.startswith("rotd"):
            return self._over_directions(motion)
        values = [kind.of(_along(motion, axis), self.periods, column) for axis in _AXES.get(self.component, "xy")]
        if self.component == "geomean":
            return math.sqrt(values[0] * values[1])
        return max(values)

    def warn_of_drift(self, motions: Iterable[Motion]) -> None:
        """Warn of each record whose value is a peak velocity that a drifting baseline has made."""
        if "pgv" in self.kind:
            for motion in motions:
                warn_of_velocity(motion, _AXES.get(self.component, "xy"))

    def _over_directions(self, motion: Motion) -> float:
        x, y = motion.acceleration, motion.components["y"]
        kind, step = KINDS[self.kind], 1 if self.kind in ("pga", "pgv") else 10
        values = [
            kind.of(Motion(motion.dt, x * math.cos(a) + y * math.sin(a)), self.periods, None)
            for a in DIRECTIONS[::step]
        ]
        return float(np.percentile(values, 50.0 if self.component == "rotd50" else 100.0))


_AXES = {"x": "x", "y": "y", "z": "z"}


def _along(motion: Motion, axis: str) -> Motion:
    if axis == "x":
        return motion
    return Motion(motion.dt, motion.components[axis], name=motion.name, metadata=motion.metadata)


def parse_measure(text: str) -> IntensityMeasure:
    """An intensity measure as typed: a kind, periods behind a colon, a component behind an @.

    Raises
    ------
    InputError
        No such measure; the message names those that are.
    """
    with within("", "im"):
        return _measure(text)


def _measure(text: str) -> IntensityMeasure:
    match = _SPEC.fullmatch(text.strip().lower())
    if match is None or match["kind"] not in KINDS:
        word = text if match is None else match["kind"]
        raise InputError(
            f"intensity measure {text!r} is not known; {suggest(word, KINDS)}allowed is {', '.join(KINDS)}, "
            "such as pgv, sa:1.0s or pga@geomean."
        )
    kind, component = match["kind"], match["component"] or "x"
    if component not in COMPONENTS:
        raise InputError(f"intensity measure {text!r} is of no component known; allowed is {', '.join(COMPONENTS)}.")
    if component.startswith("rotd") and kind not in ("pga", "pgv", "sa", "avgsa"):
        raise InputError(f"{text!r} is not defined over directions; use {kind}@geomean or {kind}@larger.")
    typed = match["periods"].split("-") if match["periods"] else []
    if not all(typed):
        raise InputError(f"a period of intensity measure {text!r} is negative, or missing; write it as sa:1.0s.")
    with within(f"intensity measure {text!r}"):
        periods = tuple(map(parse_time, typed))
    if kind == "avgsa" and not periods:
        periods = AVERAGED
    wanted = {"sa": 1, "avgsa": 2}.get(kind, 0)
    if (
        len(periods) != wanted
        or not all(0.001 <= period <= 1000.0 for period in periods)
        or sorted(set(periods)) != list(periods)
    ):
        example = {"sa": "sa:1.0s", "avgsa": "avgsa:0.5s-3s"}.get(kind, kind)
        raise InputError(f"intensity measure {text!r} has the wrong periods; write it as {example}.")
    return IntensityMeasure(kind, periods, component)


def measure_of_column(name: str) -> IntensityMeasure | None:
    """The measure whose column in a table has this name; None where it is that of none."""
    for end in ENDS.values():
        stem, _, component = name.removesuffix(end).rpartition("_")
        kind = next((prefix for prefix in ("sa_", "avgsa_") if name.startswith(prefix)), "")
        for text in (name.removesuffix(end), f"{stem}@{component}"):
            try:
                measure = parse_measure(f"{kind[:-1]}:{text.removeprefix(kind)}" if kind else text)
            except InputError:
                continue
            if measure.key == name:
                return measure
    return None


def measures_by_column(motion: Motion, columns: Sequence[tuple[float, float]]) -> list[dict[str, float]]:
    """The measures that tables hold, by their names there, for a motion and (tan α, p) of each column."""
    names = TABLE_MEASURES if motion.y_samples is None else (*TABLE_MEASURES, *TWO_COMPONENT_MEASURES)
    measures = [parse_measure(name) for name in names]
    if motion.pga == 0.0:
        return [dict.fromkeys((measure.key for measure in measures), math.nan) for _ in columns]
    own = {measure.key: measure.of(motion) for measure in measures if not KINDS[measure.kind].column}
    rows = []
    for column in columns:
        rocking = rocking_measures(motion, *column)
        related = {measure.key: rocking[measure.kind] for measure in measures if KINDS[measure.kind].column}
        rows.append(own | {key: math.nan if value is None else float(value) for key, value in related.items()})
    return rows


def powers_by_column() -> dict[str, int]:
    """Powers of the factor of a motion with which these measures grow, by their columns."""
    return {measure.key: measure.power for measure in map(parse_measure, (*TABLE_MEASURES, *TWO_COMPONENT_MEASURES))}


#: Units in which a level may be typed, by the unit of the measure.
LEVEL_UNITS: dict[str, dict[str, float]] = {
    "g": {unit: size / g for unit, size in ACCELERATION_UNITS.items()},
    "m/s": {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001},
    "s": {"s": 1.0},
    "-": {"": 1.0},
}

_LEVEL = re.compile(r"\s*([0-9.]+(?:[eE][+-]?\d+)?)\s*(\S*)\s*")


def parse_level(text: str, measure: IntensityMeasure) -> float:
    """A level of a measure as typed, ``0.3m/s``, in the measure's unit; positive.

    Raises
    ------
    InputError
        It has not the unit of the measure, or is not positive.
    """
    match, units = _LEVEL.fullmatch(text), LEVEL_UNITS[measure.unit]
    if match is None or match[2].lower() not in units or not float(match[1]) > 0.0:
        example = {"g": "0.3g", "m/s": "0.2m/s", "s": "1s", "-": "1.5"}[measure.unit]
        if match is not None and not match[2] and float(match[1]) > 0.0:
            example = match[1] + example.lstrip("0123456789.")
            raise InputError(
                f"level {text.strip()!r} of {measure.name} has no unit; write it with one, such as {example}."
            )
        raise InputError(f"level {text.strip()!r} of {measure.name} cannot be read; write it such as {example}.")
    return float(match[1]) * units[match[2].lower()]


def parse_levels(texts: str | Sequence[str], measure: IntensityMeasure) -> np.ndarray:
    """Levels of a measure as typed: ``0.1m/s:1.0m/s:10`` (first, last, number), ``0.1m/s,0.2m/s``, or a list of such.

    Raises
    ------
    InputError
        A level without the unit of the measure, or one that is not positive.
    """

    def level(text: str) -> float:
        return parse_level(text, measure)

    parts = [texts] if isinstance(texts, str) else list(texts)
    return np.unique(np.concatenate([_values("levels", text, level, "0.1m/s:1.0m/s:10") for text in parts]))
