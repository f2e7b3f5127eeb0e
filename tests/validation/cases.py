"""All validation cases, in the order of the page."""

from . import (
    agreement,
    conservation,
    convergence,
    overturning,
    paper,
    rocking,
    round_columns,
    round_contact,
    sliding,
    statics,
)
from . import tapered_column as tapered
from .case import KINDS, Case

CASES: list[Case] = [
    case
    for kind in KINDS
    for module in (
        *(rocking, overturning, round_columns, round_contact, sliding, statics),
        *(conservation, convergence, agreement, paper, tapered),
    )
    for case in module.CASES
    if case.kind == kind
]
