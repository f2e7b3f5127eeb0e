"""A record as its files hold it: every component with its direction, in SI units, and where all of it comes from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.errors import InputError, check_all
from stylobate.motion.readers.record import Component
from stylobate.motion.readers.registry import components_of
from stylobate.motion.readers.source import Source


@dataclass(frozen=True, eq=False)
class Channel:
    """One component of a record.

    Parameters
    ----------
    acceleration : array
        Samples [m/s²], shape (n,); of a vertical component upward positive.
    dt : float
        Step [s]; NaN where ``time`` holds unequal steps, or where the file states none.
    label : str
        Direction as the file states it: ``90 DEG``, ``Up``, ``H1``.
    azimuth : float, optional
        Direction of positive acceleration, clockwise from north [degrees]; None where it is vertical or not known.
    vertical : bool
    time : array, optional
        Times of unequal steps [s], shape (n,).
    processing : tuple of str
        What was done to the samples: before, as the file says, and by the reader.
    provenance : dict
        What the file says: format, stage, unit as found, station, network, event, start time.
    """

    acceleration: np.ndarray
    dt: float
    label: str
    azimuth: float | None
    vertical: bool
    time: np.ndarray | None
    processing: tuple[str, ...]
    provenance: dict[str, Any]


@dataclass(frozen=True, eq=False)
class Record:
    """A record.

    Parameters
    ----------
    components : tuple of Channel
        In the order of the files.
    files : tuple of str
        Their names.
    """

    components: tuple[Channel, ...]
    files: tuple[str, ...]

    @property
    def provenance(self) -> dict[str, Any]:
        """What the file of the first component says of the whole record."""
        return dict(self.components[0].provenance)


def read(
    path: str | Path | Sequence[str | Path],
    unit: str | None = None,
    dt: float | None = None,
    *,
    columns: str | None = None,
) -> Record:
    """Read the files of one record, of any format that is known here.

    Parameters
    ----------
    path : path, or sequence of paths
        One file, or the files of the components of a record, and the StationXML that belongs to miniSEED.
    unit : str, optional
        Unit of columns of text whose header states none: ``g``, ``m/s2``, ``gal``.
    dt : float, optional
        Step of columns of text without times [s].
    columns : str, optional
        What each column of a text file holds: ``t [s], x [g], -, z [g]``.

    Returns
    -------
    Record
        Every component that the files hold. :func:`stylobate.read_motion` makes of them the two horizontal components and
        the vertical one of one motion, on a common clock.

    Raises
    ------
    InputError
        A file cannot be read with certainty: one sentence that names the line, what was expected and what to do.
    """
    paths = check_all("path", path, (str, Path))
    if not paths:
        raise InputError("no file is given; give the path of a record.", "path")
    components, files = components_of([Source.open(file_path) for file_path in paths], unit, dt, columns)
    return Record(tuple(map(channel, components)), tuple(file.name for file in files))


def channel(component: Component) -> Channel:
    """A component as it is given to the reader's caller."""
    return Channel(
        component.values,
        component.dt,
        component.label,
        component.azimuth,
        component.vertical,
        component.time,
        (*component.history, *component.processing),
        dict(component.facts),
    )
