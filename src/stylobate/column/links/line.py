"""Straight links between two points, and their ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from ...errors import InputError
from .link import LONGEST, Lies, Link, Mark


@dataclass(frozen=True, kw_only=True)
class Line(Link):
    """Base of links that are straight between a point of one drum (or the base) and one of a drum above it.

    Parameters
    ----------
    at : tuple of float
        Place of both ends in plan, from the column's axis [m]; between two bodies its end in the first.
    to : tuple of float, optional
        Place of the upper end, where it differs; between two bodies its end in the second.
    from_drum, to_drum : int
        Drums that it links; 0 is the base, the upper one is the topmost if left out.
    from_height, to_height : float, optional
        Height of its ends above the base [m], of the column as built; where its kind holds a drum if left out, and 0 at the
        base.
    """

    lies: ClassVar[Lies] = "line"
    mark: ClassVar[Mark] = "line"
    #: Ends of a tie on a drum of which no height is given, as a share of the height: at the far end of all, and here.
    holds_at: ClassVar[tuple[float, float]] = (0.5, 0.5)
    #: Whether it runs in a hole through the stone, rather than beside it.
    through_stone: ClassVar[bool] = False

    to: tuple[float, ...] | None = None
    from_drum: int = 0
    to_drum: int | None = None
    from_height: float | None = None
    to_height: float | None = None

    @property
    def in_plan(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Places of its lower and its upper end in a column, from the axis [m]."""
        low, high = self.ends
        assert low is not None
        high = low if high is None else high
        return (low[0], low[1]), (high[0], high[1])

    def _check(self) -> None:
        super()._check()
        if self.to is not None and self.between is None:
            self._pair("to")
        self._number("from_drum", 0)
        if self.to_drum is not None:
            self._number("to_drum")
            if self.to_drum <= self.from_drum:
                raise InputError(
                    f"a {self.kind} goes from drum {self.from_drum} to drum {self.to_drum}; the second must be the higher "
                    "one.",
                    "to_drum",
                )
        for name in ("from_height", "to_height"):
            self._range(name, -LONGEST, 1e3, "m")
