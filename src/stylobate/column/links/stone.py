"""Where the stone around the links of a structure gives way before they do, in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

from .placed import PlacedLink

#: What follows where the stone gives way first: of capacities that are computed, and of those that are given.
BREAKS = "Computed is that the stone breaks there, and the link then holds nothing."
GIVEN = "That capacity is given, and taken as it is: it has to be known of the link in this stone."


#: What limit analysis does not see of it.
LATE = (
    " A limit analysis lets all links hold their capacity together: stone that breaks one by one bears less (pushover)."
)


def stone_words(links: Sequence[PlacedLink]) -> str:
    """Where the stone gives way before links do, and where that was not looked at, in sentences; empty without anchors."""
    anchors = [link for link in links if link.law in ("dowel", "clamp") and link.mark != "sheet" and link.acts]
    known = [(link, link.alone, link.stone) for link in anchors if link.alone and link.stone]
    ways = [
        (bears / holds, link, how, bears, holds, stone, f"{name}_capacity" in alone.stated)
        for link, alone, stone in known
        for how, name, bears, holds in (
            ("shear", "shear", stone.shear, alone.shear_capacity),
            ("tension", "axial", stone.pull, alone.axial_capacity),
        )
        if bears < holds
    ]
    told = []
    for given, words in ((False, BREAKS), (True, GIVEN)):
        weak = [way for way in ways if way[-1] == given]
        if weak:
            _, link, how, bears, holds, stone, _ = min(weak, key=lambda way: way[0])
            bar = f"the bar holds {1e-3 * holds:.4g} kN" if math.isfinite(holds) else "the bar is without a limit"
            told.append(
                f"The stone gives way before {len({one.name for _, one, *_ in weak})} of {len(anchors)} links do, first "
                f"around {link.name}: at {1e-3 * bears:.4g} kN in {how}, where {bar} ({stone.source}). {words}"
            )
    if known and not told:
        told.append(
            f"The stone around {len(known)} of {len(anchors)} links bears more than they hold, by EN 1992-4 carried over "
            "from concrete."
        )
    if len(known) < len(anchors):
        told.append(
            f"The stone around {len(anchors) - len(known)} of {len(anchors)} links was not checked, for want of an edge, a "
            "diameter or an embedment: stone_at_anchor tells what it bears."
        )
    return " ".join(told)


def stone_at_limit(links: Sequence[PlacedLink]) -> str:
    """The same beside a limit analysis, which takes all links as ductile."""
    late = any(link.breaks_stone for link in links)
    return stone_words(links) + LATE * late


def stone_that_breaks(links: Sequence[PlacedLink]) -> str:
    """Links whose capacity is what the stone around them bears, in a sentence beside an answer; empty without."""
    anchors = [link for link in links if link.acts and link.mark != "sheet"]
    weak = [link for link in anchors if link.breaks_stone]
    if not weak:
        return ""
    return (
        f"The stone gives way before {len(weak)} of {len(anchors)} links do: their capacity here is that of the stone."
    )
