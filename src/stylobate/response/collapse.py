"""Course of a fall, as values: the part that was lost, the way, the side, the time, and what it struck first."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

from ..messages import say

#: A part turned over the edge of its support; slid off it; or fell, where no joint can be named.
OVERTURNED, SLID_OFF, FELL = "overturned", "slid off", "fell"


@dataclass(frozen=True)
class Touch:
    """The first contact of bodies that are no neighbours, or of one with the ground.

    Parameters
    ----------
    time : float
        [s]
    bodies : (str, str), optional
        Their names; None where the record does not tell.
    """

    time: float
    bodies: tuple[str, str] | None = None


@dataclass(frozen=True)
class Collapse:
    """A collapse.

    Parameters
    ----------
    time : float
        When it became certain [s].
    joint : int or None
        Joint, from 1 at the base, at which the first part was lost; None where there is no such joint (assemblies).
    mechanism : str
        ``overturned``, ``slid off`` or ``fell``.
    azimuth : float or None
        Direction in which that part was lost, from x towards y [rad]: 0 is to the right, π to the left; None where it is
        not known.
    touched : Touch, optional
        What touched first, where the run was followed as far as that.
    """

    time: float
    joint: int | None
    mechanism: str
    azimuth: float | None
    touched: Touch | None = None

    @property
    def side(self) -> str | None:
        """``right`` (towards +x) or ``left``."""
        return None if self.azimuth is None else "right" if math.cos(self.azimuth) >= 0.0 else "left"

    def to_dict(self) -> dict[str, Any]:
        """As plain values."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> Collapse:
        """From what :meth:`to_dict` gives, after a way through JSON too."""
        touch, touched = values["touched"], None
        if touch is not None:
            bodies = touch["bodies"]
            touched = Touch(float(touch["time"]), None if bodies is None else (str(bodies[0]), str(bodies[1])))
        return cls(values["time"], values["joint"], values["mechanism"], values["azimuth"], touched)


def in_plane(time: float, joint: int, side: float, *, slid_off: bool = False) -> Collapse:
    """A collapse of a plane model.

    Parameters
    ----------
    time : float
        [s]
    joint : int
        From 1 at the base.
    side : float
        Positive: to the right.
    slid_off : bool
    """
    return Collapse(float(time), int(joint), SLID_OFF if slid_off else OVERTURNED, 0.0 if side > 0 else math.pi)


def part_on(joint: int, drums: int) -> str:
    """All that stands on a joint of a column of so many drums, in words."""
    if joint == 1:
        return say("the whole column")
    return say("drums {first} to {last}", first=joint, last=drums) if joint < drums else say("drum {drum}", drum=drums)


def what_is_lost(lost: Collapse, drums: int) -> str:
    """The part of a column of so many drums that is lost, and how, in words."""
    joint = lost.joint or 1
    part = part_on(joint, drums)
    if lost.mechanism == SLID_OFF:
        return say("{part} left the support at joint {joint}", part=part, joint=joint)
    return say("{part} overturned about joint {joint}", part=part, joint=joint)
