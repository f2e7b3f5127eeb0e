"""Motions, harmonic and pulse-like, recorded and simulated, and measures of them."""

from .condition_specs import conditioned
from .conditioning import (
    bandpass,
    baseline_piecewise,
    baseline_polynomial,
    demean,
    detrend,
    resample,
    scale_to_pgv,
    scale_to_sa,
    taper,
    trim,
)
from .integration import displacement
from .intensity import (
    arias_intensity,
    cumulative_absolute_velocity,
    motion_summary,
    peak_ground_displacement,
    peak_ground_velocity,
    rocking_measures,
    significant_duration,
)
from .motion import MAX_SAMPLES, Motion, integrate
from .orientation import along, beyond_axes, keep_axes, principal, rotated, strongest, turned
from .pulses import (
    PulseMatch,
    cosine_pulse,
    gabor,
    half_sine_pulse,
    harmonic,
    mavroeidis_papageorgiou,
    pulse_match,
    rectangular_pulse,
    ricker,
    sine_pulse,
)
from .readers import Suite, read_motion, read_suite, sample_motion, samples
from .request import MotionRequest
from .sequence import Span, in_sequence, spans_of
from .specs import parse_acceleration, parse_frequency, parse_harmonic, parse_pulse, parse_synthetic, parse_time
from .spectra import ResponseSpectrum, housner_intensity, response_spectrum, rotated_pga, rotated_spectrum
from .synthesis import REGIONS, Region, fourier_target, stochastic_motion, with_directivity_pulse
from .writing import write_csv

__all__ = [
    "MAX_SAMPLES",
    "REGIONS",
    "Motion",
    "MotionRequest",
    "PulseMatch",
    "Region",
    "ResponseSpectrum",
    "Span",
    "Suite",
    "along",
    "arias_intensity",
    "bandpass",
    "baseline_piecewise",
    "baseline_polynomial",
    "beyond_axes",
    "conditioned",
    "cosine_pulse",
    "cumulative_absolute_velocity",
    "demean",
    "detrend",
    "displacement",
    "fourier_target",
    "gabor",
    "half_sine_pulse",
    "harmonic",
    "housner_intensity",
    "in_sequence",
    "integrate",
    "keep_axes",
    "mavroeidis_papageorgiou",
    "motion_summary",
    "parse_acceleration",
    "parse_frequency",
    "parse_harmonic",
    "parse_pulse",
    "parse_synthetic",
    "parse_time",
    "peak_ground_displacement",
    "peak_ground_velocity",
    "principal",
    "pulse_match",
    "read_motion",
    "read_suite",
    "rectangular_pulse",
    "resample",
    "response_spectrum",
    "ricker",
    "rocking_measures",
    "rotated",
    "rotated_pga",
    "rotated_spectrum",
    "sample_motion",
    "samples",
    "scale_to_pgv",
    "scale_to_sa",
    "significant_duration",
    "sine_pulse",
    "spans_of",
    "stochastic_motion",
    "strongest",
    "taper",
    "trim",
    "turned",
    "with_directivity_pulse",
    "write_csv",
]
