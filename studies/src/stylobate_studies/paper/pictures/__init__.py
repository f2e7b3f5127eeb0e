"""Pictures of the paper's study that stylobate itself does not draw."""

from .company import draw_shares
from .curves import draw_history_grid, draw_moment_laws, draw_pushover_paths, draw_sensitivity
from .domain_panels import draw_domain_panels, draw_doubt
from .probability_panels import draw_probability_panels

__all__ = [
    "draw_domain_panels",
    "draw_doubt",
    "draw_history_grid",
    "draw_moment_laws",
    "draw_probability_panels",
    "draw_pushover_paths",
    "draw_sensitivity",
    "draw_shares",
]
