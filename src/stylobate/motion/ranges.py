"""Notation of several values of a quantity: ``0.33:4:24`` (first, last, number) or ``0.1g,0.2g``."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..errors import InputError, within
from .specs import parse_acceleration, parse_angle, parse_frequency

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
