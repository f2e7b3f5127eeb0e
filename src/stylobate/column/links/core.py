"""Cores, bars in holes through the drums: ties that run in the stone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .tie import Tie


@dataclass(frozen=True, kw_only=True)
class Core(Tie):
    """A bar in a hole through the drums, anchored at its two ends only; parameters as for :class:`Tie`.

    From the base to the top of the topmost drum, unless said otherwise; a drum's own end is its far face.
    """

    kind: ClassVar[str] = "core"
    law: ClassVar[str] = "tie"
    holds_at: ClassVar[tuple[float, float]] = (0.0, 1.0)
    through_stone: ClassVar[bool] = True
