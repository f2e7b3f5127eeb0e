"""Pictures in one style, one file per picture. Every function returns a figure; ``save`` writes it as PNG and SVG."""

from .amplitudes import draw_amplitudes
from .domain import draw_boundaries, draw_domain
from .energy import draw_energy
from .filmstrip import draw_filmstrip
from .histories import draw_comparison, draw_histories
from .joints import draw_joints
from .motion import draw_motion
from .pushover import draw_mechanism, draw_pushover
from .spectra import draw_spectra
from .style import save

__all__ = [
    "draw_amplitudes",
    "draw_boundaries",
    "draw_comparison",
    "draw_domain",
    "draw_energy",
    "draw_filmstrip",
    "draw_histories",
    "draw_joints",
    "draw_mechanism",
    "draw_motion",
    "draw_pushover",
    "draw_spectra",
    "save",
]
