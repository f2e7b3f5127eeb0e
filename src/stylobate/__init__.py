"""stylobate: will this freestanding ancient column stand the shaking?

The public names are loaded when first used, so that importing the package is cheap.
"""

from __future__ import annotations

import sys
import types
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from .analysis.compare import compare_models
    from .analysis.critical import critical_amplitude
    from .analysis.domain import collapse_domain
    from .analysis.limit import limit_analysis
    from .analysis.pushover import pushover
    from .analysis.replicates import collapse_probability
    from .analysis.rocking_spectrum import rocking_spectrum
    from .analysis.suite import suite_table
    from .column import AsFound, Column, Drum, FoundDrum, Joint, preset
    from .column.assembly import Assembly, Block, read_assembly
    from .column.imperfections import Imperfection
    from .constants import g
    from .errors import InputError, OutOfRangeWarning, StylobateError
    from .models.dem2d.model import DistinctElement2D
    from .models.rigid_beam.model import RigidBeam
    from .models.rigid_block.model import RigidBlock
    from .models.rocking.model import HousnerBlock
    from .motion import Motion, harmonic, stochastic_motion
    from .motion.pulses import (
        cosine_pulse,
        gabor,
        half_sine_pulse,
        mavroeidis_papageorgiou,
        rectangular_pulse,
        ricker,
        sine_pulse,
    )
    from .motion.readers import read_motion, read_suite, sample_motion
    from .outcome import Outcome
    from .response import Response
    from .simulate import simulate, simulate_assembly, simulate_many

#: Where each public name lives.
_HOMES = {
    "AsFound": "column",
    "Assembly": "column.assembly",
    "Block": "column.assembly",
    "Column": "column",
    "DistinctElement2D": "models.dem2d.model",
    "Drum": "column",
    "FoundDrum": "column",
    "HousnerBlock": "models.rocking.model",
    "Imperfection": "column.imperfections",
    "InputError": "errors",
    "Joint": "column",
    "Motion": "motion",
    "OutOfRangeWarning": "errors",
    "Outcome": "outcome",
    "Response": "response",
    "RigidBeam": "models.rigid_beam.model",
    "RigidBlock": "models.rigid_block.model",
    "StylobateError": "errors",
    "collapse_domain": "analysis.domain",
    "collapse_probability": "analysis.replicates",
    "compare_models": "analysis.compare",
    "cosine_pulse": "motion.pulses",
    "critical_amplitude": "analysis.critical",
    "g": "constants",
    "gabor": "motion.pulses",
    "half_sine_pulse": "motion.pulses",
    "harmonic": "motion",
    "limit_analysis": "analysis.limit",
    "mavroeidis_papageorgiou": "motion.pulses",
    "preset": "column",
    "pushover": "analysis.pushover",
    "read_assembly": "column.assembly",
    "read_motion": "motion.readers",
    "read_suite": "motion.readers",
    "rectangular_pulse": "motion.pulses",
    "ricker": "motion.pulses",
    "rocking_spectrum": "analysis.rocking_spectrum",
    "sample_motion": "motion.readers",
    "simulate": "simulate",
    "simulate_assembly": "simulate",
    "simulate_many": "simulate",
    "sine_pulse": "motion.pulses",
    "stochastic_motion": "motion",
    "suite_table": "analysis.suite",
}

__all__ = [
    "AsFound",
    "Assembly",
    "Block",
    "Column",
    "DistinctElement2D",
    "Drum",
    "FoundDrum",
    "HousnerBlock",
    "Imperfection",
    "InputError",
    "Joint",
    "Motion",
    "OutOfRangeWarning",
    "Outcome",
    "Response",
    "RigidBeam",
    "RigidBlock",
    "StylobateError",
    "collapse_domain",
    "collapse_probability",
    "compare_models",
    "cosine_pulse",
    "critical_amplitude",
    "g",
    "gabor",
    "half_sine_pulse",
    "harmonic",
    "limit_analysis",
    "mavroeidis_papageorgiou",
    "preset",
    "pushover",
    "read_assembly",
    "read_motion",
    "read_suite",
    "rectangular_pulse",
    "ricker",
    "rocking_spectrum",
    "sample_motion",
    "simulate",
    "simulate_assembly",
    "simulate_many",
    "sine_pulse",
    "stochastic_motion",
    "suite_table",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'stylobate' has no attribute {name!r}")
    import importlib

    value = getattr(importlib.import_module(f".{_HOMES[name]}", __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])


class _Package(types.ModuleType):
    # ``simulate`` names a module and the verb in it; importing the module binds it to the package's attribute, where
    # everyone looks for the verb.
    def __setattr__(self, name: str, value: Any) -> None:
        if name == "simulate" and isinstance(value, types.ModuleType):
            value = value.simulate
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
