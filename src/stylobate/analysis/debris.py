"""Each body of an assembly over its twins: in how many it fell, and the regions in which it lay at the end."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..messages import joined, say
from . import verdicts as v

#: Shares of the twins whose places the regions hold.
REGIONS = (0.5, 0.9)

#: From fewer twins than this the larger region is only as large as what was seen.
FEW = 20

#: Of which runs places and regions are.
OVER_ALL = say("over all runs, those in which it stands too")


@dataclass(frozen=True, eq=False)
class BodyOverTwins:
    """One body over the twins of an assembly.

    Parameters
    ----------
    name : str
    fell : int
        Twins with a verdict in which it fell.
    stood : int
        Decided ones in which it did not.
    open : int
        Those in which it had not fallen when their runs ended, and not everything lay still.
    still : int
        Runs at whose end everything lay still.
    ends : array
        Ways of its centroid in plan from the start to the end of each run that did not fail [m], shape (k, 2).
    """

    name: str
    fell: int
    stood: int
    open: int
    still: int
    ends: np.ndarray

    @property
    def runs(self) -> int:
        """Twins that could be computed."""
        return self.fell + self.stood + self.open

    @property
    def share(self) -> float:
        """Share of the twins in which it fell; NaN without a verdict."""
        return float(v.share_collapsed(self.fell, self.stood, self.open))

    def interval(self, confidence: float) -> tuple[float, float]:
        """Confidence limits of the probability that it falls; undecided ones are counted both ways."""
        low, high = v.collapse_interval(self.fell, self.stood, self.open, confidence)
        return float(low), float(high)

    @property
    def middle(self) -> np.ndarray:
        """Median way in plan [m], shape (2,)."""
        return np.median(self.ends, axis=0) if len(self.ends) else np.full(2, math.nan)

    @property
    def radii(self) -> tuple[float, ...]:
        """Radii about :attr:`middle` of the circles that hold these shares of the ends (:data:`REGIONS`) [m]."""
        if not len(self.ends):
            return (math.nan,) * len(REGIONS)
        far = np.linalg.norm(self.ends - self.middle, axis=1)
        return tuple(float(one) for one in np.quantile(far, REGIONS, method="inverted_cdf"))

    def row(self, confidence: float) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate run`` and of ``bodies.csv``."""
        low, high = self.interval(confidence)
        radii = {f"region_{100 * share:.0f}_m": one for share, one in zip(REGIONS, self.radii, strict=True)}
        return {
            "fell": self.fell,
            "stood": self.stood,
            "undecided": self.open,
            "runs_at_rest": self.still,
            "probability": None if math.isnan(self.share) else self.share,
            "interval_low": low,
            "interval_high": high,
            "middle_x_m": float(self.middle[0]),
            "middle_y_m": float(self.middle[1]),
            **radii,
        }


def bodies_over_twins(rows: Sequence[Mapping[str, Any]]) -> tuple[BodyOverTwins, ...]:
    """Each body over twins; none where the rows do not tell of bodies.

    Parameters
    ----------
    rows : sequence of mapping
        One per twin, with the keys of ``Measures.row()``.
    """
    sound = [(row["at_rest"], row["bodies"]) for row in rows if row.get("bodies") and v.verdict(row) != v.FAILED]
    found = []
    for name in sound[0][1] if sound else ():
        mine = [(still, bodies[name]) for still, bodies in sound]
        fell = sum(one["fell_at_s"] is not None for _, one in mine)
        open_ = sum(one["fell_at_s"] is None and not still for still, one in mine)
        ends = np.array([one["displacement_at_end_m"][:2] for _, one in mine])
        still = sum(still for still, _ in mine)
        found.append(BodyOverTwins(name, fell, len(mine) - fell - open_, open_, still, ends))
    return tuple(found)


def not_yet_debris(bodies: Sequence[BodyOverTwins]) -> str:
    """That the regions are of bodies that still move, in a clause; empty where all lies still."""
    moving = len(bodies[0].ends) - bodies[0].still if bodies else 0
    if not moving:
        return ""
    return say("in {moving} of {all} runs not all lay still at the end", moving=moving, all=len(bodies[0].ends))


def only_as_seen(runs: int) -> str:
    """That a region from so few runs is only as large as what was seen, in a clause; empty where they are enough."""
    alone = say("from 1 run, fewer than {few}, the 90 % region is only that of what was seen")
    several = say("from {runs} runs, fewer than {few}, the 90 % region is only that of what was seen")
    return (alone if runs == 1 else several).of(runs=runs, few=FEW) * (0 < runs < FEW)


def not_safe(bodies: Sequence[BodyOverTwins]) -> list[BodyOverTwins]:
    """Bodies that fell in some twin or are undecided in some, those that fell most often first."""
    return sorted((one for one in bodies if one.fell or one.open), key=lambda one: (-one.fell, -one.open))


def words_of_bodies(bodies: Sequence[BodyOverTwins], most: int = 6) -> str:
    """In how many twins each body fell or is undecided, in up to two sentences; empty where all surely stand."""
    listed = not_safe(bodies)
    both = say("{body.name} in {body.fell} ({body.open} undecided)")
    fallen = [(both if one.open else say("{body.name} in {body.fell}")).of(body=one) for one in listed if one.fell]
    open_ = [say("{name} in {count}", name=one.name, count=one.open) for one in listed if not one.fell]
    told = ((say("What fell: {bodies}."), fallen), (say("Fell in none, but undecided: {bodies}."), open_))
    return joined(" ", (title.of(bodies=_first_of(some, most)) for title, some in told if some))


def _first_of(names: Sequence[str], most: int) -> str:
    more = len(names) - most
    return joined(", ", names[:most]) + (say(", and {count} more", count=more) if more > 0 else "")
