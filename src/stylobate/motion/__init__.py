"""What shakes: ground motions, harmonic and pulse-like, and recorded ones from files."""

from .harmonic import harmonic
from .motion import MAX_SAMPLES, Motion, integrate
from .pulses import (
    cosine_pulse,
    gabor,
    half_sine_pulse,
    mavroeidis_papageorgiou,
    rectangular_pulse,
    ricker,
    sine_pulse,
)
from .readers import read_motion
from .specs import parse_acceleration, parse_frequency, parse_harmonic, parse_pulse, parse_time
from .writing import write_csv

__all__ = [
    "MAX_SAMPLES",
    "Motion",
    "cosine_pulse",
    "gabor",
    "half_sine_pulse",
    "harmonic",
    "integrate",
    "mavroeidis_papageorgiou",
    "parse_acceleration",
    "parse_frequency",
    "parse_harmonic",
    "parse_pulse",
    "parse_time",
    "read_motion",
    "rectangular_pulse",
    "ricker",
    "sine_pulse",
    "write_csv",
]
