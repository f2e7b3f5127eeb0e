"""What shakes: ground motions, harmonic and pulse-like, and recorded ones from files."""

from .harmonic import harmonic
from .motion import MAX_SAMPLES, Motion, integrate

__all__ = ["MAX_SAMPLES", "Motion", "harmonic", "integrate"]
