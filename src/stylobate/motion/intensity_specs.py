"""Intensity measures by the names that a person types: ``pga``, ``pgv@geomean``, ``sa:1.0s``, ``avgsa:0.5s-3s``."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..constants import g
from ..errors import InputError, suggest, within
from .intensity import (
    arias_intensity,
    cumulative_absolute_velocity,
    rocking_measures,
    significant_duration,
    warn_of_velocity,
)
from .motion import Motion
from .pulses import pulse_match
from .specs import ACCELERATION_UNITS, parse_time
from .specs import values_of as _values
from .spectra import pseudo_acceleration

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
    def of(motion: Motion, _: tuple[float, ...], column: tuple[float, float] | None) -> float:
        assert column is not None
        value = rocking_measures(motion, *column)[key]
        return math.nan if value is None else float(value)

    return of


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
TOLD_OF_TWO = ("pga@geomean", "pgv@geomean")

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
    found = _SPEC.fullmatch(text.strip().lower())
    if found is None or found["kind"] not in KINDS:
        word = text if found is None else found["kind"]
        raise InputError(
            f"intensity measure {text!r} is not known; {suggest(word, KINDS)}allowed is {', '.join(KINDS)}, "
            "such as pgv, sa:1.0s or pga@geomean."
        )
    kind, component = found["kind"], found["component"] or "x"
    if component not in COMPONENTS:
        raise InputError(f"intensity measure {text!r} is of no component known; allowed is {', '.join(COMPONENTS)}.")
    if component.startswith("rotd") and kind not in ("pga", "pgv", "sa", "avgsa"):
        raise InputError(f"{text!r} is not defined over directions; use {kind}@geomean or {kind}@larger.")
    typed = found["periods"].split("-") if found["periods"] else []
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
        kind = next((one for one in ("sa_", "avgsa_") if name.startswith(one)), "")
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
    names = TABLE_MEASURES if motion.y_samples is None else (*TABLE_MEASURES, *TOLD_OF_TWO)
    measures = [parse_measure(name) for name in names]
    if motion.pga == 0.0:
        return [dict.fromkeys((measure.key for measure in measures), math.nan) for _ in columns]
    own = {measure.key: measure.of(motion) for measure in measures if not KINDS[measure.kind].column}
    found = []
    for column in columns:
        rocking = rocking_measures(motion, *column)
        related = {measure.key: rocking[measure.kind] for measure in measures if KINDS[measure.kind].column}
        found.append(own | {key: math.nan if value is None else float(value) for key, value in related.items()})
    return found


def powers_by_column() -> dict[str, int]:
    """Powers of the factor of a motion with which these measures grow, by their columns."""
    return {one.key: one.power for one in map(parse_measure, (*TABLE_MEASURES, *TOLD_OF_TWO))}


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
    found, units = _LEVEL.fullmatch(text), LEVEL_UNITS[measure.unit]
    if found is None or found[2].lower() not in units or not float(found[1]) > 0.0:
        example = {"g": "0.3g", "m/s": "0.2m/s", "s": "1s", "-": "1.5"}[measure.unit]
        if found is not None and not found[2] and float(found[1]) > 0.0:
            example = found[1] + example.lstrip("0123456789.")
            raise InputError(
                f"level {text.strip()!r} of {measure.name} has no unit; write it with one, such as {example}."
            )
        raise InputError(f"level {text.strip()!r} of {measure.name} cannot be read; write it such as {example}.")
    return float(found[1]) * units[found[2].lower()]


def parse_levels(texts: str | Sequence[str], measure: IntensityMeasure) -> np.ndarray:
    """Levels of a measure as typed: ``0.1m/s:1.0m/s:10`` (first, last, number), ``0.1m/s,0.2m/s``, or a list of such.

    Raises
    ------
    InputError
        A level without the unit of the measure, or one that is not positive.
    """

    def one(text: str) -> float:
        return parse_level(text, measure)

    parts = [texts] if isinstance(texts, str) else list(texts)
    return np.unique(np.concatenate([_values("levels", text, one, "0.1m/s:1.0m/s:10") for text in parts]))
