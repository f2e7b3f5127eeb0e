"""Motions as typed on a command line: numbers with units, ranges, harmonics, pulses, synthetic motions."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from itertools import zip_longest
from typing import Literal, overload

import numpy as np

from ..constants import g
from ..errors import InputError, check_choice, within
from . import pulses
from .motion import STRONGEST, Motion
from .pulses import harmonic
from .synthesis import stochastic_motion

#: Units of acceleration that a person may type or a file may name, in m/s².
ACCELERATION_UNITS = {
    "g": g,
    "m/s2": 1.0,
    "cm/s2": 0.01,
    "gal": 0.01,
    "mm/s2": 0.001,
    "g/10": g / 10.0,
    "mg": g / 1000.0,
    "in/s2": 0.0254,
    "ft/s2": 0.3048,
}
_SPELLINGS = {
    "m/s/s": "m/s2",
    "m/sec2": "m/s2",
    "m/sec/sec": "m/s2",
    "m/s**2": "m/s2",
    "m/s^2": "m/s2",
    "ms-2": "m/s2",
    "m s-2": "m/s2",
    "m_s2": "m/s2",
    "cm/s/s": "cm/s2",
    "cm/sec2": "cm/s2",
    "cm/sec/sec": "cm/s2",
    "cm/sec^2": "cm/s2",
    "cm/sec**2": "cm/s2",
    "cm/s**2": "cm/s2",
    "cm/s^2": "cm/s2",
    "cm_s2": "cm/s2",
    "gals": "gal",
    "mm/s/s": "mm/s2",
    "mm/sec2": "mm/s2",
    "mm/sec/sec": "mm/s2",
    "mm/s^2": "mm/s2",
    "mm/s**2": "mm/s2",
    "mm_s2": "mm/s2",
    "g10": "g/10",
    "0.1g": "g/10",
    "milli-g": "mg",
    "in/sec2": "in/s2",
    "in/sec/sec": "in/s2",
    "in/s/s": "in/s2",
    "ft/sec2": "ft/s2",
}
#: Units of time in s, of frequency in Hz and of angle in degrees.
TIME_UNITS = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "min": 60.0}
FREQUENCY_UNITS = {"hz": 1.0, "khz": 1e3}
ANGLE_UNITS = {"deg": 1.0, "°": 1.0, "degrees": 1.0, "rad": 180.0 / math.pi}
#: Units of velocity in m/s.
VELOCITY_UNITS = {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001}
#: Units of pressure in Pa.
PRESSURE_UNITS = {"pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "n/m2": 1.0, "n/mm2": 1e6, "bar": 1e5}

#: Pulses by the name they have on the command line.
PULSES: dict[str, Callable[..., Motion]] = {
    "rectangular": pulses.rectangular_pulse,
    "half-sine": pulses.half_sine_pulse,
    "sine": pulses.sine_pulse,
    "cosine": pulses.cosine_pulse,
    "ricker": pulses.ricker,
    "antisymmetric-ricker": lambda f, a, d=None: pulses.ricker(f, a, d, antisymmetric=True),
    "gabor": pulses.gabor,
    "mavroeidis-papageorgiou": pulses.mavroeidis_papageorgiou,
}

_QUANTITY = re.compile(r"\s*(\?|[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([^\s\d].*?)?\s*", re.DOTALL)


def acceleration_unit(text: str) -> tuple[str, float]:
    """The usual spelling of a unit of acceleration, and its size in m/s².

    Raises
    ------
    InputError
        The unit is not one of :data:`ACCELERATION_UNITS`.
    """
    key = text.strip().lower().replace("²", "2").replace(" ", "" if "s-2" not in text else " ")
    key = _SPELLINGS.get(key, key)
    if key not in ACCELERATION_UNITS:
        check_choice("unit of acceleration", text, ACCELERATION_UNITS, field="unit")
    return key, ACCELERATION_UNITS[key]


def parse_number(name: str, text: str, example: str = "such as 1.5") -> float:
    """A number without a unit, as typed for the parameter of that name, as a message calls it."""
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{name} is {text!r}; allowed is a number, {example}.", name.strip("`-"), value=text) from None


def parse_acceleration(text: str, name: str | None = None) -> float:
    """An acceleration such as ``0.3g``, ``2.9m/s2`` or ``300gal`` in m/s²; ``name`` of the parameter, for messages."""
    return _quantity(text, "acceleration", "0.3g", name)


def parse_velocity(text: str) -> float:
    """A velocity such as ``0.2m/s`` or ``20cm/s`` in m/s."""
    return _in_units(text, "velocity", VELOCITY_UNITS, "", "'0.2m/s' (m/s, cm/s, mm/s)")


def parse_time(text: str, name: str | None = None) -> float:
    """A time such as ``5s`` or ``20ms`` in s; ``name`` of the parameter, for messages."""
    return _quantity(text, "time", "5s", name)


def parse_pressure(text: str, name: str | None = None) -> float:
    """A pressure or strength such as ``2MPa`` in Pa; a number alone is in Pa; ``name`` of the parameter, for errors."""
    with within("", *([name] if name else [])):
        return _in_units(text, "pressure", PRESSURE_UNITS, "Pa", "'2MPa' (Pa, kPa, MPa, GPa)")


def parse_frequency(text: str, name: str | None = None) -> float:
    """A frequency such as ``1.0Hz`` in Hz; ``name`` of the parameter, for messages."""
    return _quantity(text, "frequency", "1.0Hz", name)


def parse_angle(text: str, name: str | None = None) -> float:
    """An angle such as ``30deg`` or ``0.5rad`` in degrees; ``name`` of the parameter, for messages."""
    return _quantity(text, "angle", "30deg", name)


@overload
def parse_harmonic(text: str, across: str | None = None) -> Motion: ...
@overload
def parse_harmonic(text: str, across: str | None = None, *, allow_unknown: Literal[True]) -> tuple[Motion, bool]: ...
def parse_harmonic(
    text: str, across: str | None = None, *, allow_unknown: bool = False
) -> Motion | tuple[Motion, bool]:
    """A harmonic motion as typed: ``1.0Hz,0.3g,10s`` (frequency, amplitude, length).

    Parameters
    ----------
    text : str
        The amplitude may be ``?g`` when it is what is looked for. Without a time the motion lasts 10 s.
    across : str, optional
        The sine along y, ``1.0Hz,0.15g,90deg`` (frequency, amplitude, phase; without a phase they start together). Its
        amplitude is ``?g`` where the other one is, and then both are the same.
    allow_unknown : bool
        Accept ``?g``, and return whether it was met as well.

    Returns
    -------
    Motion or (Motion, bool)
        With ``?g`` the amplitude is 1 m/s²: scale it.

    Raises
    ------
    InputError
        The text cannot be understood; the message shows how to write it.
    """
    example = "1.0Hz,0.3g,10s"
    quantities = _parts(text.split(","), text, "harmonic", example)
    _only(quantities, ("frequency", "acceleration", "time"), text, "harmonic", example)
    amplitude = _amplitude(quantities, text, "harmonic", example, allow_unknown)
    unknown = math.isnan(quantities["acceleration"])
    other = None if across is None else _across(across, unknown, allow_unknown)
    motion = harmonic(quantities["frequency"], amplitude, quantities.get("time", 10.0), across=other)
    return (motion, unknown) if allow_unknown else motion


def _across(text: str, unknown: bool, allow_unknown: bool) -> tuple[float, float, float]:
    example = "1.0Hz,0.15g,90deg"
    quantities = _parts(text.split(","), text, "across", example)
    _only(quantities, ("frequency", "acceleration", "angle"), text, "across", example)
    if allow_unknown and unknown != math.isnan(quantities["acceleration"]):
        raise InputError(
            "`harmonic` and `across`: the amplitude of one is stated and that of the other looked for; write ?g for both, "
            "which are then the same.",
            "across.amplitude",
        )
    amplitude = _amplitude(quantities, text, "across", example, allow_unknown)
    return quantities["frequency"], amplitude, math.radians(quantities.get("angle", 0.0))


@overload
def parse_pulse(text: str, default_length: float | None = None) -> Motion: ...
@overload
def parse_pulse(
    text: str, default_length: float | None = None, *, allow_unknown: Literal[True]
) -> tuple[Motion, bool]: ...
def parse_pulse(
    text: str, default_length: float | None = None, *, allow_unknown: bool = False
) -> Motion | tuple[Motion, bool]:
    """A pulse as typed: ``ricker,1.0Hz,0.3g`` or ``sine,1.0Hz,0.3g,10s`` (kind, frequency, amplitude, whole length).

    Parameters
    ----------
    text : str
        Kinds are the keys of :data:`PULSES`.
    default_length : float, optional
        Length of the whole motion where the text states none [s]; a pulse that takes longer is not cut.
        By default ten seconds follow the pulse.
    allow_unknown : bool
        As for :func:`parse_harmonic`.

    Raises
    ------
    InputError
        The text cannot be understood; the message shows how to write it.
    """
    example = "half-sine,1.0Hz,0.3g"
    kind, *parts = text.split(",")
    key = kind.strip().lower()
    check_choice("kind of pulse", key, PULSES, field="pulse", remedy=f"write it as {example!r}")
    example = f"{key},1.0Hz,0.3g"
    quantities = _parts(parts, text, "pulse", example)
    _only(quantities, ("frequency", "acceleration", "time"), text, "pulse", example)
    amplitude = _amplitude(quantities, text, "pulse", example, allow_unknown)
    length = quantities.get("time")
    if length is None and default_length is not None:
        alone = PULSES[key](quantities["frequency"], amplitude).metadata["pulse_length"]
        length = max(default_length, alone)
    motion = PULSES[key](quantities["frequency"], amplitude, length)
    return (motion, math.isnan(quantities["acceleration"])) if allow_unknown else motion


def parse_synthetic(text: str) -> Motion:
    """A simulated motion as typed: ``greece,6.5Mw,20km`` or ``greece,6.5Mw,20km,seed=3`` (region, magnitude, distance).

    Raises
    ------
    InputError
        The text cannot be understood; the message shows how to write it.
    """
    example = "greece,6.5Mw,20km,seed=3"
    region, *parts = [part.strip() for part in text.split(",")]
    values: dict[str, float] = {}
    for part in parts:
        match = re.fullmatch(
            r"(?P<seed>seed)\s*=\s*(?P<number>\d{1,18})|(?P<value>\d+\.?\d*|\.\d+)\s*(?P<unit>mw|km)", part.lower()
        )
        if match is None:
            raise InputError(f"`synthetic` {text!r}: {part!r} is not understood; write it as {example!r}.", "synthetic")
        key = match["seed"] or match["unit"]
        if key in values:
            raise InputError(f"`synthetic` {text!r} holds two values of {key}; write it as {example!r}.", "synthetic")
        values[key] = int(match["number"]) if match["seed"] else float(match["value"])
    for key, word in (("mw", "magnitude such as 6.5Mw"), ("km", "distance such as 20km")):
        if key not in values:
            raise InputError(f"`synthetic` {text!r} holds no {word}; write it as {example!r}.", "synthetic")
    return stochastic_motion(values["mw"], values["km"] * 1e3, region.lower(), seed=int(values.get("seed", 0)))


#: Fields of what is typed for a motion, in their usual order.
_FIELDS = {
    "harmonic": ("frequency", "amplitude", "duration"),
    "across": ("across.frequency", "across.amplitude", "across.phase"),
    "pulse": ("frequency", "amplitude", "duration"),
}


def _parts(parts: list[str], text: str, name: str, example: str) -> dict[str, float]:
    """Quantities by kind; the units say which is which. An acceleration that is looked for is NaN."""
    quantities: dict[str, float] = {}
    for part, place in zip_longest(parts, _FIELDS[name][: len(parts)], fillvalue=name):
        with within("", place):
            kind, value = _measure(part, f"`{name}` {text!r}", example)
            if kind in quantities:
                raise InputError(f"`{name}` {text!r} holds two values of {kind}; write it as {example!r}.")
        quantities[kind] = value
    for kind, sample, place in zip(("frequency", "acceleration"), ("1.0Hz", "0.3g"), _FIELDS[name]):
        if kind not in quantities:
            message = f"`{name}` {text!r} holds no {kind} such as {sample}; write it as {example!r}."
            raise InputError(message, place)
    return quantities


def _only(quantities: dict[str, float], kinds: tuple[str, ...], text: str, name: str, example: str) -> None:
    for kind in quantities:
        if kind not in kinds:
            word = "an" if kind[0] in "aeiou" else "a"
            message = f"`{name}` {text!r} holds {word} {kind}, which it has none of; write it as {example!r}."
            raise InputError(message, name)


def _amplitude(quantities: dict[str, float], text: str, name: str, example: str, allow_unknown: bool) -> float:
    value = quantities["acceleration"]
    if not math.isnan(value):
        return value
    if not allow_unknown:
        message = f"`{name}` {text!r} leaves the amplitude open; state it here, as in {example!r}."
        raise InputError(message, _FIELDS[name][1])
    return 1.0


def _quantity(text: str, kind: str, example: str, name: str | None) -> float:
    with within("", *([name] if name else [])):
        actual_kind, value = _measure(text, f"`{name}`" if name else f"{kind} {text!r}", example)
        if actual_kind != kind or math.isnan(value):
            what = f"`{name}`: {text!r}" if name else repr(text)
            raise InputError(f"{what} is not a value of {kind}; write it with its unit, as in {example!r}.")
    return value


def _usual_unit(example: str) -> str:
    """Unit of the only number of an example; empty where it has more than one."""
    sample = None if "," in example else _QUANTITY.fullmatch(example)
    return "" if sample is None else sample.group(2) or ""


def _measure(text: str, where: str, example: str) -> tuple[str, float]:
    match = _QUANTITY.fullmatch(text)
    if match is None:
        raise InputError(f"{where}: {text.strip()!r} is not a number with a unit; write it as {example!r}.", value=text)
    number, unit = match.group(1), match.group(2)
    if unit is None:
        usual = _usual_unit(example)
        as_meant = f"with one, such as {number}{usual}" if usual else f"as {example!r}"
        if usual == "g" and number != "?" and abs(float(number)) > STRONGEST:
            as_meant = f"as {float(number) / 100.0:g}g if % of g is meant, and as {number}m/s2 if m/s² is"
        raise InputError(f"{where}: {text.strip()!r} has no unit; write it {as_meant}.", value=text)
    name = unit.lower()
    for kind, units in (("frequency", FREQUENCY_UNITS), ("time", TIME_UNITS), ("angle", ANGLE_UNITS)):
        if name in units and number != "?":
            return kind, _number(number, where) * units[name]
    try:
        _, size = acceleration_unit(unit)
    except InputError:
        if re.match(r",\d", unit):
            raise InputError(
                f"{where}: {text.strip()!r} has a decimal comma; write it as {number}.{unit[1:]}."
            ) from None
        if unit == "%" and number != "?":
            meant = f"; of g it is {float(number) / 100.0:g}g" if _usual_unit(example) == "g" else ""
            raise InputError(f"{where}: {text.strip()!r} does not say of what it is a share{meant}.") from None
        raise InputError(f"{where}: unit {unit!r} is unknown here; write it as {example!r}.") from None
    return "acceleration", math.nan if number == "?" else _number(number, where) * size


def _in_units(text: str, kind: str, units: dict[str, float], usual: str, example: str) -> float:
    """A quantity in one of some units; ``usual`` is that of a number alone."""
    match = _QUANTITY.fullmatch(text)
    size = None if match is None or match.group(1) == "?" else units.get((match.group(2) or usual).lower())
    if match is None or size is None:
        raise InputError(f"{kind} {text!r} is not understood; write it with its unit, as in {example}.")
    return _number(match.group(1), f"{kind} {text!r}") * size


def _number(text: str, where: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise InputError(f"{where}: {text} is not a finite number.")
    return value


# -- Notation of several values of a quantity -------------------------------------------------------------------------


#: Largest number of values of a range.
MAX_VALUES = 100_000


def frequency_range(text: str) -> np.ndarray:
    """Frequencies as typed, ``0.33:4:24`` (first, last, number) or ``0.5,1,2`` [Hz]."""
    return values_of("frequencies", text, _plain_or(parse_frequency), "0.33:4:24")


def amplitude_range(text: str) -> np.ndarray:
    """Amplitudes as typed, ``0.05g:0.6g:32`` (first, last, number) or ``0.1g,0.2g`` [m/s²]."""
    return values_of("amplitudes", text, parse_acceleration, "0.05g:0.6g:32")


def azimuth_range(text: str, name: str = "azimuths") -> np.ndarray:
    """Azimuths as typed, ``0:330:12`` (first, last, number) or ``0,30deg,60deg`` [degrees], the smallest first."""
    return np.sort(values_of(name, text, _plain_or(parse_angle), "0:330:12"))


def _plain_or(parse: Callable[[str], float]) -> Callable[[str], float]:
    """Reads a number alone, or else a quantity with its unit."""

    def either(part: str) -> float:
        try:
            return float(part)
        except ValueError:
            return parse(part)

    return either


def values_of(name: str, text: str, parse: Callable[[str], float], example: str) -> np.ndarray:
    """Values as typed: first, last and number, or one after the other; ``parse`` reads one of them."""

    def wrong(why: str, part: str = "") -> InputError:
        return InputError(f"`{name}` are {text!r}{why}.", f"{name}{part}", value=text)

    parts = text.split(":")
    if len(parts) == 1:
        with within("", name):
            return np.array([parse(part.strip()) for part in text.split(",")])
    if len(parts) != 3:
        raise wrong(f"; write them as first:last:number, e.g. {example!r}")
    with within("", name):
        low, high = parse(parts[0].strip()), parse(parts[1].strip())
    if not parts[2].strip().isdecimal():
        raise wrong(f", where {parts[2]!r} is no number of values; write e.g. {example!r}", ".number")
    number = int(parts[2])
    if not 1 <= number <= MAX_VALUES:
        raise wrong(f", with {number} values; allowed is 1 to {MAX_VALUES}", ".number")
    if number > 1 and not low < high:
        raise wrong(f"; the first value must be below the last one, e.g. {example!r}")
    return np.linspace(low, high, number)
