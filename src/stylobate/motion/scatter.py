"""Scatter of a harmonic motion: what of the shaking nobody knows to the last digit."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from ..errors import check_range
from .motion import Motion
from .pulses import harmonic

#: Largest half width of each part.
LARGEST_OF_MOTION = {"amplitude": 0.5, "phase": 0.5, "across": 1.0}

#: Starts of a motion, and sizes of its component across, that are told apart, so that all draws share these samples.
PHASES, ASIDES = 9, 8


@dataclass(frozen=True)
class MotionScatter:
    """Half widths of the intervals from which harmonic motions are drawn, all even and independent; nothing by default.

    Parameters
    ----------
    amplitude : float
        Of the amplitude, relative [-].
    phase : float
        Of the instant in its cycle at which the motion starts [cycles].
    across : float
        Of a second component along y, a quarter of a cycle late, relative to the amplitude along x [-]. No shaking is
        plane; models in the plane leave this component out.

    Raises
    ------
    InputError
        A value outside its range.
    """

    amplitude: float = 0.0
    phase: float = 0.0
    across: float = 0.0

    def __post_init__(self) -> None:
        for name, high in LARGEST_OF_MOTION.items():
            check_range(
                f"{name} of the motion's scatter", getattr(self, name), 0.0, high, remedy="0.01 is one per cent"
            )

    @property
    def given(self) -> dict[str, float]:
        """Scattered parts, by name."""
        return {name: value for name, value in dataclasses.asdict(self).items() if value}

    def describe(self) -> str:
        """The sizes in words."""
        units = {"phase": lambda value: f"{value:.3g} cycles"}
        words = (
            f"{name} ±{units.get(name, lambda size: f'{100.0 * size:.3g} %')(value)}"
            for name, value in self.given.items()
        )
        return ", ".join(words) or "nothing"


class ScatteredSines:
    """Harmonic motions that are drawn around one of each frequency and amplitude: draw k is alike for all of them.

    Draw k of a seed is the same for any ``number`` above k.

    Parameters
    ----------
    frequencies : array
        [Hz]
    duration : float
        [s]
    size : MotionScatter
    number, seed : int
        The same seed gives the same motions.
    """

    def __init__(self, frequencies: np.ndarray, duration: float, size: MotionScatter, number: int, seed: int) -> None:
        starts = size.phase * np.linspace(-1.0, 1.0, PHASES) if size.phase else np.zeros(1)
        aside = size.across * np.linspace(-1.0, 1.0, ASIDES) if size.across else np.zeros(1)
        # Each part has a stream of its own, so that draw k does not depend on how many there are, nor on the other parts.
        factors, first, across = (np.random.default_rng([seed, part]) for part in (1, 3, 2))
        self._factors = 1.0 + size.amplitude * factors.uniform(-1.0, 1.0, number)
        self._start = first.integers(0, len(starts), number)
        self._aside = across.integers(0, len(aside), number)
        self._units = [
            [[_sine(float(f), duration, float(start), float(share)) for share in aside] for start in starts]
            for f in frequencies
        ]

    def motion(self, i: int, amplitude: float, k: int) -> Motion:
        """Draw k of the motion of frequency number i and of an amplitude [m/s²]; samples are shared."""
        return self._units[i][self._start[k]][self._aside[k]].scaled(float(amplitude * self._factors[k]))


def _sine(frequency: float, duration: float, start: float, aside: float) -> Motion:
    """A unit sine that starts so many cycles late, with a component across of that share, a quarter of a cycle later."""
    unit = harmonic(frequency, 1.0, duration)
    if not start and not aside:
        return unit
    angle = 2.0 * np.pi * (np.arange(unit.steps) * unit.dt * frequency + start)
    lateral = -aside * np.cos(angle) if aside else None
    return unit.replace(acceleration=np.sin(angle), lateral=lateral)
