"""Pictures in one style, one file per picture. Every function returns a figure; ``save`` writes it as PNG and SVG."""

from .amplitudes import draw_amplitudes
from .calibration import draw_calibration
from .collapse_over_amplitude import draw_collapse_over_amplitude
from .debris import draw_debris
from .design_values import draw_design_values
from .directions import draw_directions
from .domain import draw_boundaries, draw_domain
from .elevation import draw_elevation
from .energy import draw_energy
from .filmstrip import draw_filmstrip
from .fragility import draw_fragility
from .histories import draw_comparison, draw_histories
from .ida import draw_efficiency, draw_ida
from .inference import draw_matches, draw_observations, draw_posterior
from .joint_plans import draw_sheet
from .joints import draw_joints
from .limit_directions import draw_limit_directions
from .motion import draw_motion
from .orbit import draw_orbit
from .paper import sheets_to_scale
from .probability import draw_probability
from .pushover import draw_mechanism, draw_pushover
from .record_selection import draw_record_selection
from .record_verdicts import draw_record_verdicts
from .residuals import draw_residuals
from .risk import draw_risk, draw_survival
from .rocking_spectrum import draw_rocking_spectrum
from .sequence import draw_ends, draw_sequence
from .spectra import draw_spectra
from .states import draw_states
from .style import save, save_as, save_sheets
from .suite import draw_suite
from .uplift import draw_uplift
from .views import draw_views
from .weighing import draw_weighing

__all__ = [
    "draw_amplitudes",
    "draw_boundaries",
    "draw_calibration",
    "draw_collapse_over_amplitude",
    "draw_comparison",
    "draw_debris",
    "draw_design_values",
    "draw_directions",
    "draw_domain",
    "draw_efficiency",
    "draw_elevation",
    "draw_ends",
    "draw_energy",
    "draw_filmstrip",
    "draw_fragility",
    "draw_histories",
    "draw_ida",
    "draw_joints",
    "draw_limit_directions",
    "draw_matches",
    "draw_mechanism",
    "draw_motion",
    "draw_observations",
    "draw_orbit",
    "draw_posterior",
    "draw_probability",
    "draw_pushover",
    "draw_record_selection",
    "draw_record_verdicts",
    "draw_residuals",
    "draw_risk",
    "draw_rocking_spectrum",
    "draw_sequence",
    "draw_sheet",
    "draw_spectra",
    "draw_states",
    "draw_suite",
    "draw_survival",
    "draw_uplift",
    "draw_views",
    "draw_weighing",
    "save",
    "save_as",
    "save_sheets",
    "sheets_to_scale",
]
