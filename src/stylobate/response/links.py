"""Action of the links of a column: their forces, slips and elongations over time, and when which of them broke."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..messages import joined, percent, say

#: Names of the histories of links, in the order in which models record them.
NAMES = ("shear", "tension", "slip", "elongation")

#: A link that bears this share of its capacity bears all of it, but for rounding.
AT_CAPACITY = 1.0 - 1e-9

#: What the columns of the table count as given way, in a sentence beside it.
YIELDS = say("A link at its capacity yields or slips, and stays so.")


@dataclass(frozen=True, eq=False)
class LinkHistories:
    """Histories of all links that act, in the column's order.

    Parameters
    ----------
    shear, tension : array
        Force across the joint, and along a line or against opening [N], shape (T, m).
    slip : array
        Of the joint at the link's place since the start [m], shape (T, m); 0 of ties and cores.
    elongation : array
        Of a line, or lift of the joint at the link's place, since the start [m], shape (T, m).
    angle : array, optional
        Direction of the shear force on the body above [rad], shape (T, m): from the first towards the second direction in
        which the link slips, which turn with the body below. Older files have none.
    reached : array of int, optional
        Number of the first recorded state that comes after the largest shear force, and after the largest tension, of all
        steps, shape (2, m); known of a run just made.
    """

    shear: np.ndarray
    tension: np.ndarray
    slip: np.ndarray
    elongation: np.ndarray
    angle: np.ndarray | None = None
    reached: np.ndarray | None = None


@dataclass(frozen=True)
class LinkMeasures:
    """Results of a run for one link.

    Parameters
    ----------
    name, kind : str
    joint : int
        That it crosses, from 1; 0 of a tie or core.
    broken_at : float
        When it broke [s]; NaN if it did not.
    peak_shear, peak_tension : float
        [N]
    peak_slip, peak_elongation : float
        [m]
    shear_capacity, axial_capacity : float
        [N], infinite without limit.
    limited_by : str
        Whether the ``link`` or the ``stone`` around it limits them.
    """

    name: str
    kind: str
    joint: int
    broken_at: float
    peak_shear: float
    peak_tension: float
    peak_slip: float
    peak_elongation: float
    shear_capacity: float
    axial_capacity: float
    limited_by: str = "link"

    @property
    def broken(self) -> bool:
        """Whether it broke."""
        return not math.isnan(self.broken_at)

    @property
    def utilisation(self) -> float:
        """Largest force over capacity, the larger one of shear and tension [-]."""
        return max(self.peak_shear / self.shear_capacity, self.peak_tension / self.axial_capacity)

    def row(self) -> dict[str, Any]:
        """Plain values under the names that scripts rely on; None for what has no limit or did not happen."""
        return {
            "name": self.name,
            "kind": self.kind,
            "joint": self.joint or None,
            "broken_s": self.broken_at if self.broken else None,
            "peak_shear_n": self.peak_shear,
            "peak_tension_n": self.peak_tension,
            "peak_slip_m": self.peak_slip,
            "peak_elongation_m": self.peak_elongation,
            "shear_capacity_n": self.shear_capacity if math.isfinite(self.shear_capacity) else None,
            "axial_capacity_n": self.axial_capacity if math.isfinite(self.axial_capacity) else None,
            "limited_by": self.limited_by,
        }

    @classmethod
    def from_row(cls, row: dict[str, Any]) -> LinkMeasures:
        """The measures that :meth:`row` described."""

        def number(name: str, missing: float) -> float:
            return missing if row[name] is None else float(row[name])

        return cls(
            row["name"], row["kind"], row["joint"] or 0, number("broken_s", math.nan),
            *(number(name, 0.0) for name in ("peak_shear_n", "peak_tension_n", "peak_slip_m", "peak_elongation_m")),
            shear_capacity=number("shear_capacity_n", math.inf), axial_capacity=number("axial_capacity_n", math.inf),
            limited_by=row.get("limited_by", "link"),
        )  # fmt: skip


def row_of(links: Sequence[LinkMeasures]) -> dict[str, Any]:
    """Links in a row of a run: the number that broke, the time of the first, and each in their order."""
    times = [link.broken_at for link in links if link.broken]
    return {
        "links_broken": len(times),
        "first_link_broken_s": min(times, default=None),
        "link_broken_s": [link.broken_at if link.broken else None for link in links],
        "link_utilisation": [float(link.utilisation) for link in links],
        **{
            f"link_{name}": [float(getattr(link, name.rpartition("_")[0])) for link in links]
            for name in ("peak_shear_n", "peak_tension_n", "peak_slip_m", "peak_elongation_m")
        },
    }


def sentence_of(links: Sequence[LinkMeasures]) -> str:
    """Number of links that broke, the first of them, and the number that came to their capacity; empty without links."""
    kinds = {link.kind for link in links if link.kind != "layer" or link.broken}
    if not kinds:
        return ""
    counted = [link for link in links if link.kind in kinds]
    broken = sorted((link for link in counted if link.broken), key=lambda link: link.broken_at)
    full = [link for link in counted if not link.broken and link.utilisation >= AT_CAPACITY]
    known = {
        "kind": say(counted[0].kind), "kinds": say(kinds.pop() + "s") if len(kinds) == 1 else say("links"),
        "count": len(counted), "broken": len(broken), "full": _at_capacity(full) if full else "",
    }  # fmt: skip
    if not broken and full:
        wordings = {1: say("The {kind} did not break, but was at its capacity."),
                2: say("Neither of both {kinds} broke, but {full}.")}  # fmt: skip
        return joined(
            " ", [wordings.get(len(counted), say("None of {count} {kinds} broke, but {full}.")).of(**known), YIELDS]
        )
    if not broken:
        most = max(counted, key=lambda link: link.utilisation)
        wordings = {1: say("The {kind} is whole"), 2: say("Both {kinds} are whole")}
        bore = say("; the {link} bore {share} of what it can", link=most.name, share=percent(most.utilisation))
        whole = wordings.get(len(counted), say("All {count} {kinds} are whole")).of(**known)
        return joined("", [whole, bore if most.utilisation else "", "."])
    first, alone = broken[0], len(counted) == 1
    which = (
        say("The {kind} broke at {time:.2f} s")
        if alone
        else say("{broken} of {count} {kinds} broke, the first at {time:.2f} s")
    )
    where = say(" in joint {joint}.", joint=first.joint) if first.joint else say(", the {link}.", link=first.name)
    words = [which.of(time=first.broken_at, **known) + where]
    if stone := sum(link.limited_by == "stone" for link in broken):
        words.append(say("The stone around {count} of those broke first.", count=stone))
    return joined(" ", [*words, *([say("Of those that did not break, {full}.", **known), YIELDS] if full else [])])


def _at_capacity(full: Sequence[LinkMeasures]) -> str:
    """Which links were at their capacity: how many, and one of them by name."""
    if len(full) == 1:
        return say("the {link} was at its capacity", link=full[0].name)
    return say("{count} were at their capacity, such as the {link}", count=len(full), link=full[0].name)
