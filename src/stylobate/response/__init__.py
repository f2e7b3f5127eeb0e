"""Responses: bodies in space, joints, energy, verdict, measures and files of one run."""

from pathlib import Path

from .collapse import Collapse, Touch
from .histories import ENERGY_TERMS, Histories
from .links import LinkHistories, LinkMeasures
from .measures import BlockMeasures, Measures, SpaceMeasures
from .residuals import Residuals
from .response import Response

__all__ = [
    "ENERGY_TERMS",
    "BlockMeasures",
    "Collapse",
    "Histories",
    "LinkHistories",
    "LinkMeasures",
    "Measures",
    "Residuals",
    "Response",
    "SpaceMeasures",
    "Touch",
    "load_response",
]


def load_response(path: str | Path) -> Response:
    """Read the response of a column or an assembly.

    Raises
    ------
    InputError
        There is no such file, it is damaged, or it is not a response.
    """
    return Response.load(path)
