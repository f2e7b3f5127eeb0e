from .amplitudes import draw_amplitudes as draw_amplitudes
from .calibration import draw_calibration as draw_calibration
from .collapse_over_amplitude import draw_collapse_over_amplitude as draw_collapse_over_amplitude
from .debris import draw_debris as draw_debris
from .design_values import draw_design_values as draw_design_values
from .directions import draw_directions as draw_directions
from .domain import draw_boundaries as draw_boundaries, draw_domain as draw_domain
from .elevation import draw_elevation as draw_elevation
from .energy import draw_energy as draw_energy
from .filmstrip import draw_filmstrip as draw_filmstrip
from .fragility import draw_fragility as draw_fragility
from .histories import draw_comparison as draw_comparison, draw_histories as draw_histories
from .ida import draw_efficiency as draw_efficiency, draw_ida as draw_ida
from .inference import draw_matches as draw_matches, draw_observations as draw_observations, draw_posterior as draw_posterior
from .joint_plans import draw_sheet as draw_sheet
from .joints import draw_joints as draw_joints
from .limit_directions import draw_limit_directions as draw_limit_directions
from .motion import draw_motion as draw_motion
from .orbit import draw_orbit as draw_orbit
from .paper import sheets_to_scale as sheets_to_scale
from .probability import draw_probability as draw_probability
from .pushover import draw_mechanism as draw_mechanism, draw_pushover as draw_pushover
from .record_selection import draw_record_selection as draw_record_selection
from .record_verdicts import draw_record_verdicts as draw_record_verdicts
from .residuals import draw_residuals as draw_residuals
from .risk import draw_risk as draw_risk, draw_survival as draw_survival
from .rocking_spectrum import draw_rocking_spectrum as draw_rocking_spectrum
from .sequence import draw_ends as draw_ends, draw_sequence as draw_sequence
from .spectra import draw_spectra as draw_spectra
from .states import draw_states as draw_states
from .style import save as save, save_as as save_as, save_sheets as save_sheets
from .suite import draw_suite as draw_suite
from .uplift import draw_uplift as draw_uplift
from .views import draw_views as draw_views
from .weighing import draw_weighing as draw_weighing
