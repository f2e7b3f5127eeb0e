"""Course of a column's fall, in plain words: what fell, about which joint, to which side, when, and what still stands."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..column import Column
from ..messages import joined, say
from .histories import Histories
from .measures import Measures

#: A drum has fallen when its centroid is lower than at the start by this share of its height …
DROP = 0.5

#: … or when it has turned by more than this [rad].
TURNED = math.radians(45.0)

#: Drums move as one body while their rotations differ by less than this share of the lost joint's rotation.
AS_ONE = 0.1


@dataclass(frozen=True)
class Mechanism:
    """Course of a column's fall, or its state where it stands.

    Parameters
    ----------
    fallen : tuple of int
        Numbers of the drums that have fallen, from 1 at the base.
    fell_at : tuple of float
        When each of them had [s].
    fell_to : tuple of str
        ``left`` or ``right`` for each of them: where its centroid is at the end, relative to where it stood.
    joint : int
        Joint about which the part that was lost first turned, or at which it left its support; 0 without a collapse.
    slid_off : bool
        Whether that part left its support by sliding, without overturning.
    as_one_body : bool
        Whether the part above that joint still moved as one body when the collapse became certain.
    standing : tuple of int
        Drums that have not fallen.
    offsets : tuple of float
        Residual offset of each standing drum relative to the ground [m].
    rotations : tuple of float
        Residual rotation of each standing drum [rad].
    at_rest : bool, optional
        Whether everything lies still at the end; None if the run cannot tell.
    """

    fallen: tuple[int, ...]
    fell_at: tuple[float, ...]
    fell_to: tuple[str, ...]
    joint: int
    slid_off: bool
    as_one_body: bool
    standing: tuple[int, ...]
    offsets: tuple[float, ...]
    rotations: tuple[float, ...]
    at_rest: bool | None = None

    def describe(self) -> str:
        """The mechanism in one or two sentences."""
        n = len(self.fallen) + len(self.standing)
        far = _length(max((abs(offset) for offset in self.offsets), default=0.0))
        if not self.fallen and not self.joint:
            if n > 1:
                return say("All {count} drums stand; the largest residual offset is {length}.", count=n, length=far)
            return say("The column stands; the largest residual offset is {length}.", length=far)
        words = []
        if self.joint:
            what = say("The column") if self.joint == 1 else say("The part above joint {joint}", joint=self.joint)
            how = say("as one body") if self.as_one_body else say("and broke up")
            turned = say("{part} overturned {how} about joint {joint}.", part=what, how=how, joint=self.joint)
            words.append(say("{part} slid off its support.", part=what) if self.slid_off else turned)
        if self.fallen and n == 1:
            left = self.fell_to[0] == "left"
            side = say("It fell to the left at {time:.2f} s.") if left else say("It fell to the right at {time:.2f} s.")
            words.append(side.of(time=self.fell_at[0]))
        elif self.fallen:
            left, right = (self.fell_to.count(side) for side in ("left", "right"))
            sides = [
                say("{count} to the left", count=left) * bool(left),
                say("{count} to the right", count=right) * bool(right),
            ]
            when = say("at {time:.2f} s", time=self.fell_at[0])
            if len(self.fallen) > 1:
                first, last = min(self.fell_at), max(self.fell_at)
                when = say("the first at {first:.2f} s, the last at {last:.2f} s", first=first, last=last)
            values = {"fallen": len(self.fallen), "all": n, "sides": joined(", ", sides), "when": when}
            words.append(say("{fallen} of {all} drums fell ({sides}), {when}.", **values))
        if len(self.standing) == 1:
            words.append(say("1 stands, offset by up to {length}.", length=far))
        elif self.standing:
            words.append(say("{count} stand, offset by up to {length}.", count=len(self.standing), length=far))
        if self.at_rest is False:
            words.append(say("Not all lies still yet."))
        return joined(" ", words)


def find_mechanism(
    column: Column,
    histories: Histories,
    measures: Measures,
    joint: int,
    *,
    slid_off: bool = False,
    at_rest: bool | None = None,
) -> Mechanism:
    """Read the mechanism from the histories of a run.

    Parameters
    ----------
    column : Column
    histories : Histories
    measures : Measures
    joint : int
        Joint, from 1 at the base, at which the first part was lost; 0 without a collapse.
    slid_off : bool
        Whether it had slid off its support there.
    at_rest : bool, optional
    """
    h, n = histories, column.n
    down = (h.drum_z < -DROP * column.heights) | (np.abs(h.drum_rotation) > TURNED)
    fallen = np.flatnonzero(down[-1])
    # fallen for good: the first state after the last one in which it was up
    when = [float(h.time[int(np.flatnonzero(~down[:, i])[-1]) + 1]) for i in fallen]
    standing = [i for i in range(n) if i not in set(fallen.tolist())]
    whole = False
    if joint:
        k = int(np.searchsorted(h.time, measures.collapse_time))
        turn = h.drum_rotation[min(k, len(h.time) - 1)]
        relative = abs(turn[joint - 1] - (turn[joint - 2] if joint > 1 else 0.0))
        above = turn[joint - 1 :]
        whole = bool(float(np.ptp(above)) < AS_ONE * relative)
    return Mechanism(
        fallen=tuple(int(i) + 1 for i in fallen),
        fell_at=tuple(when),
        fell_to=tuple("right" if h.drum_x[-1, i] > 0.0 else "left" for i in fallen),
        joint=joint,
        slid_off=slid_off,
        as_one_body=whole,
        standing=tuple(i + 1 for i in standing),
        offsets=tuple(float(h.drum_x[-1, i]) for i in standing),
        rotations=tuple(float(h.drum_rotation[-1, i]) for i in standing),
        at_rest=at_rest,
    )


def _length(value: float) -> str:
    return say("{value:.2f} m", value=value) if value >= 1.0 else say("{value:.3g} mm", value=1000.0 * value)
