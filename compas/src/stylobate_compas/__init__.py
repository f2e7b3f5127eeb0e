"""Ground motion as a solver of compas_dem models: from a problem and a motion to a response, and back to the model."""

from .solver import assembly_of as assembly_of
from .solver import placed as placed
from .solver import results_of as results_of
from .solver import shake as shake
