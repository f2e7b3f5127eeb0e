"""Pictures of measured tests beside what is computed of them."""

from .boulders import draw_boulder_fragility, draw_reliability, draw_verdicts
from .tests import draw_tests
from .tosses import draw_toss_errors

__all__ = ["draw_boulder_fragility", "draw_reliability", "draw_tests", "draw_toss_errors", "draw_verdicts"]
