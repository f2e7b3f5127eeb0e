"""A ground motion: acceleration of the base, sampled at equal steps and linear between the samples."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from .. import notebook
from ..atomic import replacing
from ..constants import g
from ..errors import InputError, as_typed, check_range

MAX_SAMPLES = 20_000_000

#: Peak acceleration that no record has reached, the strongest have some 4 g [g]: beyond it the unit is wrong.
STRONGEST = 5.0

#: What a motion may be multiplied by [-].
FACTORS = (-1e6, 1e6)


@dataclass(frozen=True, eq=False, init=False)
class Motion:
    """Acceleration of the base in one to three components.

    Starts at t = 0 with its first sample, is linear between samples, and zero after its last one.

    Parameters
    ----------
    dt : float
        Step [s].
    ax : array
        Horizontal acceleration along x, the plane of the plane models, before ``factor`` [m/s²], shape (steps,).
    ay, az : array, optional
        Second horizontal (y) and vertical (z, upward positive) acceleration before ``factor`` [m/s²], shape (steps,).
    acceleration, lateral, vertical : array, optional
        Other names of ``ax``, ``ay`` and ``az``.
    factor : float
        Multiplies every component; scaled motions share their samples, so that a domain of ten thousand
        amplitudes keeps one array. The attributes ``acceleration``, ``lateral`` and ``vertical`` include it.
    name : str
    metadata : mapping
        What a file said: format, unit as found, station, event, azimuths, licence …
    processing : tuple of str
        Every step that changed the samples, in order.

    Raises
    ------
    InputError
        A step that is not positive, samples that are not finite, components of unequal length.
    """

    wanted: ClassVar[str] = "a Motion, as read_motion, harmonic and MotionRequest(…).motion() make it"

    dt: float
    samples: np.ndarray
    y_samples: np.ndarray | None
    z_samples: np.ndarray | None
    factor: float
    name: str
    metadata: Mapping
    processing: tuple[str, ...]

    def __init__(
        self,
        dt: float,
        ax: np.ndarray | None = None,
        ay: np.ndarray | None = None,
        az: np.ndarray | None = None,
        *,
        acceleration: np.ndarray | None = None,
        lateral: np.ndarray | None = None,
        vertical: np.ndarray | None = None,
        factor: float = 1.0,
        name: str = "motion",
        metadata: Mapping | None = None,
        processing: tuple[str, ...] = (),
    ) -> None:
        def put(key: str, value: object) -> None:
            object.__setattr__(self, key, value)

        put("dt", check_range("dt", dt, 0.0, 1e3, unit="s", open_low=True, remedy="state the step", of="a motion"))
        for key, value in {"factor": factor, "name": name, "metadata": metadata, "processing": processing}.items():
            put(key, _FACTS[key](value))
        length = None
        for label, key, first, second in (
            ("x", "samples", ax, acceleration),
            ("y", "y_samples", ay, lateral),
            ("z", "z_samples", az, vertical),
        ):
            if first is not None and second is not None:
                raise InputError(f"component {label} of {name!r} is given under both of its names; give it once.")
            value = second if first is None else first
            if value is None:
                if key == "samples":
                    raise InputError(f"motion {self.name!r} has no horizontal component; give one.")
                put(key, None)
                continue
            array = _checked(value, label, name)
            if length is not None and len(array) != length:
                raise InputError(
                    f"component {label} of {name!r} has {len(array)} samples, the first one {length}; "
                    "cut or pad them to equal length."
                )
            length = len(array)
            put(key, array)

    # -- components ----------------------------------------------------------------------------------------------

    @property
    def acceleration(self) -> np.ndarray:
        """Horizontal acceleration along x [m/s²], shape (steps,)."""
        return self.samples * self.factor

    @property
    def lateral(self) -> np.ndarray | None:
        """Horizontal acceleration along y [m/s²], shape (steps,), or None."""
        return None if self.y_samples is None else self.y_samples * self.factor

    @property
    def vertical(self) -> np.ndarray | None:
        """Vertical acceleration, upward positive [m/s²], shape (steps,), or None."""
        return None if self.z_samples is None else self.z_samples * self.factor

    @property
    def components(self) -> dict[str, np.ndarray]:
        """Components that are present, by axis name x, y, z [m/s²]."""
        by_axis = {"x": self.acceleration, "y": self.lateral, "z": self.vertical}
        return {axis: values for axis, values in by_axis.items() if values is not None}

    @property
    def steps(self) -> int:
        """Number of samples."""
        return len(self.samples)

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return (self.steps - 1) * self.dt

    @property
    def time(self) -> np.ndarray:
        """Sample times [s], shape (steps,)."""
        return np.arange(self.steps) * self.dt

    @property
    def pga(self) -> float:
        """Largest absolute horizontal acceleration along x [m/s²]."""
        return self._peaks["x"] * abs(self.factor)

    @property
    def peaks(self) -> dict[str, float]:
        """Largest absolute acceleration of every component that is present, by axis name [m/s²]."""
        return {axis: peak * abs(self.factor) for axis, peak in self._peaks.items()}

    @property
    def plan_peak(self) -> float:
        """Largest horizontal acceleration in any direction [m/s²]."""
        return self._plan_peak * abs(self.factor)

    @cached_property
    def _plan_peak(self) -> float:
        x, y = self.samples, self.y_samples
        return self._peaks["x"] if y is None else math.sqrt(float((x**2 + y**2).max()))

    @cached_property
    def _peaks(self) -> dict[str, float]:
        every = {"x": self.samples, "y": self.y_samples, "z": self.z_samples}
        return {axis: float(np.abs(samples).max()) for axis, samples in every.items() if samples is not None}

    @property
    def horizontal_peak(self) -> tuple[float, str]:
        """Largest absolute acceleration of a horizontal component [m/s²], and its axis: the peak as given, of no turn."""
        across = self.peaks.get("y", 0.0)
        return (across, "y") if across > self.pga else (self.pga, "x")

    @property
    def pgv(self) -> float:
        """Largest absolute velocity along x from rest, also between samples [m/s]."""
        return peak_velocity(self.acceleration, self.dt)

    @property
    def record(self) -> str:
        """Name of the record that this motion is of: the same for all directions, signs, components and scaled copies."""
        turned = self.metadata.get("direction") or {}
        return str(turned.get("record") or self.metadata.get("record") or self.name)

    # -- changed copies ------------------------------------------------------------------------------------------

    def replace(self, **changes) -> Motion:
        """A copy with some constructor arguments changed (``ax`` … without the factor).

        Where no samples change they are shared, and not checked again: a domain has one record at thousands of levels.
        """
        if set(changes) <= _FACTS.keys():
            changed = object.__new__(Motion)
            vars(changed).update({key: vars(self)[key] for key in (*_SAMPLED, *_FACTS)})
            vars(changed).update(_peaks=self._peaks, _plan_peak=self._plan_peak)
            vars(changed).update({key: _FACTS[key](value) for key, value in changes.items()})
            return changed
        fields: dict = {
            "dt": self.dt,
            "ax": self.samples,
            "ay": self.y_samples,
            "az": self.z_samples,
            "factor": self.factor,
            "name": self.name,
            "metadata": self.metadata,
            "processing": self.processing,
        }
        other = {"acceleration": "ax", "lateral": "ay", "vertical": "az"}
        return Motion(**fields | {other.get(key, key): value for key, value in changes.items()})

    @property
    def multiplied(self) -> Motion:
        """The same motion with its factor in its samples, as it is stepped and as files hold it: equal to the last bit."""
        parts = {"ax": self.acceleration, "ay": self.lateral, "az": self.vertical}
        return self if self.factor == 1.0 else self.replace(**parts, factor=1.0)

    def scaled(self, factor: float) -> Motion:
        """A copy with every component multiplied by ``factor`` [-], which its name says; the samples are shared.

        It stays the same record: copies of one record are no independent evidence, however they are named.
        """
        times = check_range("factor", factor, *FACTORS)
        return self.replace(
            factor=self.factor * times,
            name=f"{self.name} × {times:g}",
            metadata={**self.metadata, "record": self.record},
        )

    def scaled_to_pga(self, pga: float) -> Motion:
        """A copy whose horizontal peak along x is ``pga`` [m/s²]; every component is multiplied alike.

        With two horizontal components the peak is still that along x: what shakes along y keeps its ratio to it. For the
        largest peak of all directions, turn the motion there first (``stylobate.motion.strongest``).

        Raises
        ------
        InputError
            The motion has (next to) nothing along x.
        """
        value = check_range("`pga`", pga, 0.0, 1e4, unit="m/s²")
        across = self.peaks.get("y", 0.0)
        if self.pga <= 1e-9 * across:
            raise InputError(
                f"motion {self.name!r} is zero along x and cannot be scaled to a peak there; turn it, or multiply it by a "
                "factor.",
                "pga",
            )
        return self.scaled(value / self.pga).replace(name=f"{self.name}, scaled to {value / g:g} g")

    def without_vertical(self) -> Motion:
        """A copy without its vertical component."""
        return self.replace(vertical=None)

    @cached_property
    def digest(self) -> str:
        """SHA-256 of step, factor and samples."""
        hasher = hashlib.sha256(np.array([self.dt, self.factor]).tobytes())
        for label, values in (("x", self.samples), ("y", self.y_samples), ("z", self.z_samples)):
            if values is not None:
                hasher.update(label.encode())
                hasher.update(values.tobytes())
        return hasher.hexdigest()

    def __repr__(self) -> str:
        return f"<Motion {self.describe()}>"

    def _repr_html_(self) -> str:
        pictures = [notebook.history(values / g, f"a{axis} [g]") for axis, values in self.components.items()]
        facts = {f"peak along {axis} [g]": peak / g for axis, peak in self.peaks.items()}
        facts |= {"PGV [m/s]": self.pgv, "step [s]": self.dt, "steps": self.steps}
        return notebook.page(self.name, self.describe(), facts, "".join(pictures))

    def describe(self) -> str:
        """One line for people."""
        peak, axis = self.horizontal_peak
        along = "" if self.lateral is None else f" along {axis}"
        return f"{self.name}: {self.duration:g} s, dt {self.dt:g} s, PGA {peak / g:.3g} g{along}"


#: What a motion holds of its samples; its other facts, and the check of a value given for each.
_SAMPLED = ("dt", "samples", "y_samples", "z_samples")
_FACTS: Mapping[str, Callable[[Any], Any]] = {
    "factor": lambda value: check_range("factor", value, -1e9, 1e9, of="a motion"),
    "name": lambda value: value,
    "metadata": lambda value: MappingProxyType(dict(value or {})),
    "processing": tuple,
}


def _checked(value: np.ndarray, label: str, name: str) -> np.ndarray:
    # Read-only contiguous arrays are shared between motions; anything else is copied.
    if isinstance(value, np.ndarray) and value.dtype == np.float64 and not value.flags.writeable and value.ndim == 1:
        array = value if value.flags.c_contiguous and value.flags.owndata else value.copy()
    else:
        array = _copied(value, label, name)
    if array.ndim != 1 or array.size < 2:
        raise InputError(f"component {label} of {name!r} has shape {array.shape}; give at least 2 samples in one row.")
    if array.size > MAX_SAMPLES:
        raise InputError(f"component {label} of {name!r} has {array.size} samples; allowed is up to {MAX_SAMPLES}.")
    bad = np.flatnonzero(~np.isfinite(array))
    if bad.size:
        raise InputError(
            f"component {label} of {name!r} has {bad.size} values that are not finite, the first at sample {bad[0]}; "
            "mend the record before use."
        )
    array.flags.writeable = False
    return array


def _copied(value: np.ndarray, label: str, name: str) -> np.ndarray:
    try:
        return np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"component {label} of {name!r} is not an array of numbers.") from None


def integrate(values: np.ndarray, dt: float) -> np.ndarray:
    """Running integral from zero by the trapezoidal rule, same shape as ``values``."""
    out = np.zeros_like(values)
    np.cumsum(0.5 * dt * (values[1:] + values[:-1]), out=out[1:])
    return out


def peak_velocity(acceleration: np.ndarray, dt: float) -> float:
    """Largest absolute velocity from rest, also between samples, where the acceleration passes zero [m/s]."""
    v = integrate(acceleration, dt)
    a, b = acceleration[:-1], acceleration[1:]
    crossing = a * b < 0.0
    between = v[:-1][crossing] + 0.5 * dt * a[crossing] ** 2 / (a[crossing] - b[crossing])
    return float(max(np.abs(v).max(), np.abs(between).max(initial=0.0)))


# Velocity, displacement and intensity of a motion that is linear between its samples, without approximation.


def displacement(acceleration: np.ndarray, dt: float) -> np.ndarray:
    """Displacement from rest: the double integral of an acceleration that is linear between samples [m], same shape."""
    v = integrate(acceleration, dt)
    steps = dt * v[:-1] + dt * dt / 6.0 * (2.0 * acceleration[:-1] + acceleration[1:])
    out = np.zeros_like(v)
    np.cumsum(steps, out=out[1:])
    return out


def square_integral(acceleration: np.ndarray, dt: float) -> np.ndarray:
    """Running integral of the square, from zero, same shape."""
    a, b = acceleration[:-1], acceleration[1:]
    out = np.zeros_like(acceleration)
    np.cumsum(dt / 3.0 * (a * a + a * b + b * b), out=out[1:])
    return out


def absolute_integral(acceleration: np.ndarray, dt: float) -> float:
    """Integral of the absolute value."""
    a, b = acceleration[:-1], acceleration[1:]
    size = np.abs(a) + np.abs(b)
    crossing = a * b < 0.0
    area = 0.5 * size
    area[crossing] = 0.5 * (a[crossing] ** 2 + b[crossing] ** 2) / size[crossing]
    return float(dt * area.sum())


def time_above(acceleration: np.ndarray, dt: float, level: float) -> float:
    """Time during which the absolute value exceeds ``level`` [s]."""
    total = 0.0
    for sign in (1.0, -1.0):
        a = sign * acceleration[:-1] - level
        b = sign * acceleration[1:] - level
        both = (a > 0.0) & (b > 0.0)
        crossing = (a > 0.0) != (b > 0.0)
        share = np.maximum(a[crossing], b[crossing]) / np.abs(a[crossing] - b[crossing])
        total += dt * (both.sum() + share.sum())
    return float(total)


def arias_growth(motion: Motion) -> np.ndarray:
    """Share of the Arias intensity of all components together that is reached at each sample, shape (steps,)."""
    total = np.zeros(motion.steps)
    for values in motion.components.values():
        total += square_integral(values, motion.dt)
    return total / total[-1] if total[-1] > 0.0 else np.linspace(0.0, 1.0, motion.steps)


def arias(acceleration: np.ndarray, dt: float) -> float:
    """Arias intensity π/(2g) ∫a² dt [m/s]."""
    return float(np.pi / (2.0 * g) * square_integral(acceleration, dt)[-1])


# Motions written as CSV that reads back to the same bits.


def write_csv(motion: Motion, path: str | Path) -> Path:
    """Write a motion as CSV in m/s², with a header that names the units.

    Returns
    -------
    Path
        The file. It appears whole or not at all.

    Raises
    ------
    InputError
        The place cannot be written.
    """
    place = Path(path)
    azimuths = motion.metadata.get("azimuths") or {}
    notes = [f"# dt_s: {as_typed(motion.dt)}", f"# name: {_one_line(motion.name)}"]
    notes += [f"# azimuth_{axis}_deg: {as_typed(angle)}" for axis, angle in azimuths.items() if angle is not None]
    for key in ("station", "network", "event", "event_id", "start_time", "stage", "terms"):
        value = motion.metadata.get(key) or ("computed" if key == "stage" and "format" not in motion.metadata else None)
        if value:
            notes.append(f"# {key}: {_one_line(str(value))}")
    notes.append(f"# sha256: {motion.multiplied.digest}")
    notes += [f"# processing {i}: {_one_line(step)}" for i, step in enumerate(motion.processing, 1)]
    components = motion.components
    header = ",".join(["time_s", *(f"a{axis}_m_s2" for axis in components)])
    rows = zip(motion.time.tolist(), *(values.tolist() for values in components.values()))
    text = "\n".join([*notes, header, *(",".join(map(repr, row)) for row in rows), ""])
    with replacing(place) as partial:
        partial.write_text(text, encoding="utf-8")
    return place


def _one_line(text: str) -> str:
    return " ".join(text.split())
