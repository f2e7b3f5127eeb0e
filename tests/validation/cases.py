"""All validation cases, in the order of the page."""

from . import agreement, conservation, convergence, overturning, paper, rocking, round_columns, sliding, statics
from .case import KINDS, Case

CASES: list[Case] = [
    one
    for kind in KINDS
    for module in (rocking, overturning, round_columns, sliding, statics, conservation, convergence, agreement, paper)
    for one in module.CASES
    if one.kind == kind
]
