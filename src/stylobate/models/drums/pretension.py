"""What pretension holds at the start, in links and in the joints that they press, and what of it a run has set free."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...column import Column
from ...column.link_loads import is_pretensioned
from ...errors import InputError
from .links import acting


def pressed_joints(block: Any, lane: int, column: Column) -> float:
    """Energy at the start of joints that pretension presses, above that of joints under their weight alone [J].

    Their elastic energy is larger by more than this, because what stands on them has sunk. Where only the pretension holds
    the column up there is no weight alone, and all that the joints hold counts.

    Parameters
    ----------
    block : DrumBlock
        Which knows its energies at the start.
    lane : int
    column : Column
    """
    if not is_pretensioned(column):
        return 0.0
    try:
        bare = without_tension(column)
    except InputError:  # it cannot stand
        return float(block.start[lane, 3]) - held_at_start(column)
    drum, joint, state = block.drum.copy(), block.joint.copy(), block.lane.copy()
    for array, fields in zip((drum, joint, state), block.pack(bare).fields, strict=True):
        for name, values in fields.items():
            array[name][..., lane] = values
    state["mon"][1:, lane] = state["mft"][1:, lane] = 0.0
    alone = block.energies_of(lane, drum, joint, state)
    return float((block.start[lane] - alone)[2:4].sum()) - held_at_start(column)


def held_at_start(column: Column) -> float:
    """Elastic energy of pretensioned links [J]."""
    return sum(0.5 * one.pretension**2 / one.axial_stiffness for one in acting(column) if one.pretension)


def without_tension(column: Column) -> Column:
    """The column with those of its links alone that hold nothing at the start."""
    return column.replace(links=tuple(one for one in column.links if not getattr(one, "pretension", 0.0)))


def set_free(column: Column, tensions: np.ndarray, pressed: float) -> float:
    """Energy of pretension that links with these tensions [N], and the joints that they press, have given away [J].

    What the joints had, ``pressed`` [J], falls with the square of the tension; they are taken to have lost as much of it as
    the link that has lost most.
    """
    free = least = 0.0
    for m, one in enumerate(acting(column)):
        if one.pretension:
            left = min(float(tensions[m]) / one.pretension, 1.0) ** 2
            free += 0.5 * one.pretension**2 / one.axial_stiffness * (1.0 - left)
            least = max(least, 1.0 - left)
    return free + least * max(pressed, 0.0)
