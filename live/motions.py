"""What shakes the columns of the page: unit shapes and earthquakes, sampled by the package when the page is built."""

from __future__ import annotations

from stylobate.motion import Motion, harmonic, sine_pulse
from stylobate.motion.request import MotionRequest

#: Lengths of a sine and of the whole run of a pulse [s].
SINE, PULSE = 10.0, 12.0

#: Earthquakes of the page: samples of the package, of each its strong part.
EARTHQUAKES = {
    "el-centro-1940": "El Centro, California, 1940",
    "san-francisco-1989": "Loma Prieta in San Francisco, 1989",
    "hanmer-springs-2016": "Kaikōura, New Zealand, 2016",
    "ridgecrest-2019": "Ridgecrest, California, 2019",
}

#: How much of an earthquake is taken: from where a twentieth of its energy has come to where a twentieth is left.
STRONG_PART = "trim"


def sine(frequency: float, amplitude: float) -> Motion:
    """The motion that the page makes of the unit sine [Hz], [m/s²]."""
    return harmonic(frequency, amplitude, SINE)


def pulse(frequency: float, amplitude: float) -> Motion:
    """The motion that the page makes of the unit pulse [Hz], [m/s²]."""
    return sine_pulse(frequency, amplitude, PULSE)


def earthquake(name: str, pga: float | None = None) -> Motion:
    """An earthquake of the page, scaled to a peak [m/s²] if one is given."""
    request = MotionRequest(files=(f"sample:{name}",), condition=(STRONG_PART,), pga=pga)
    (result,) = request.expand().motions
    return result
