"""Pretension at the start, in links and in the joints that they press, and what of it a run has set free."""

from __future__ import annotations

import numpy as np

from ...column import Column
from .links import acting


def held_at_start(column: Column) -> float:
    """Elastic energy of pretensioned links [J]."""
    return sum(0.5 * one.pretension**2 / one.axial_stiffness for one in acting(column) if one.pretension)


def without_tension(column: Column) -> Column:
    """The column with those of its links alone that hold nothing at the start."""
    pairs = zip(column.links, column.placed_links, strict=True)
    return column.replace(links=tuple(link for link, one in pairs if not one.pretension))


def set_free(column: Column, tensions: np.ndarray, pressed: float) -> float:
    """Energy that pretensioned links and the joints that they press have given away since the start [J].

    ``tensions`` are those of the links now [N], shape (m,). What the joints had, ``pressed`` [J], falls with the square of
    the tension; they are taken to have lost as much of it as the link that has lost most.
    """
    free = least = 0.0
    for m, one in enumerate(acting(column)):
        if one.pretension:
            left = min(float(tensions[m]) / one.pretension, 1.0) ** 2
            free += 0.5 * one.pretension**2 / one.axial_stiffness * (1.0 - left)
            least = max(least, 1.0 - left)
    return free + least * max(pressed, 0.0)
