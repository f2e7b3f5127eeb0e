"""One component of a record as a reader finds it, before it becomes part of a motion."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...errors import InputError


class UnstatedError(InputError):
    """The file leaves its unit or its step open, which the caller can state."""


#: Departure from a right angle of two horizontal components of one record [degrees].
SQUARE = 5.0


def at_right_angles(one: float, other: float) -> bool:
    """Whether two azimuths are those of two horizontal components of one record [degrees]."""
    return abs((one - other) % 180.0 - 90.0) <= SQUARE


@dataclass
class Component:
    """One component of a record.

    Parameters
    ----------
    values : array
        Acceleration [m/s²], shape (steps,).
    dt : float
        Step [s]; NaN where ``time`` holds unequal steps, or where no step is known.
    label : str
        Direction as the file states it: ``90 DEG``, ``Up``, ``H1``.
    azimuth : float, optional
        Direction of positive acceleration, clockwise from north [degrees].
    vertical : bool
        Upward or downward; the sign is turned so that upward is positive.
    time : array, optional
        Times of irregular samples [s], shape (steps,).
    metadata : dict
        What this component's own header says.
    processing : list of str
        What the reader did to the values.
    history : list of str
        What was done to the whole record before, as its file says.
    file : str
        Name of the file it was read from.
    first : float, optional
        Time of the first sample on the file's own clock [s], where it states times.
    named : bool
        The label is the file's own; one that was given for its place in the file does not tell a direction.
    facts : dict
        What its file says of the whole record.
    proven : bool
        Step and samples are those that this package wrote, as their digest proves: the step may be any.
    """

    values: np.ndarray
    dt: float
    label: str = ""
    azimuth: float | None = None
    vertical: bool = False
    time: np.ndarray | None = None
    metadata: dict = field(default_factory=dict)
    processing: list[str] = field(default_factory=list)
    history: list[str] = field(default_factory=list)
    file: str = ""
    first: float | None = None
    named: bool = True
    facts: dict = field(default_factory=dict)
    proven: bool = False
