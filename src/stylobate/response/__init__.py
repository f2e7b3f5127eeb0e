"""What happened: responses, their measures, energy and files."""

from .measures import Measures
from .response import ENERGY_TERMS, Histories, Response

__all__ = ["ENERGY_TERMS", "Histories", "Measures", "Response"]
