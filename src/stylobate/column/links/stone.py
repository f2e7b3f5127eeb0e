"""Where the stone around the links of a structure gives way before they do, in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ...messages import joined, say
from .placed import PlacedLink

#: What follows where the stone gives way first: of capacities that are computed, and of those that are given.
BREAKS = say("Computed is that the stone breaks there, and the link then holds nothing.")
GIVEN = say("That capacity is given, and taken as it is: it has to be known of the link in this stone.")


#: What limit analysis does not see of it.
LATE = say(
    "A limit analysis lets all links hold their capacity together: stone that breaks one by one bears less (pushover)."
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
            bar = say("the bar holds {force:.4g} kN", force=1e-3 * holds)
            bar = bar if math.isfinite(holds) else say("the bar is without a limit")
            said = say(
                "The stone gives way before {number} of {all} links do, first around {link}: at {force:.4g} kN in {how}, where "
                "{bar} ({source}).",
                number=len({one.name for _, one, *_ in weak}), all=len(anchors), link=link.name, force=1e-3 * bears,
                how=say(how), bar=bar, source=stone.source,
            )  # fmt: skip
            told += [said, words]
    if known and not told:
        more = say(
            "The stone around {number} of {all} links bears more than they hold, by EN 1992-4 carried over from concrete."
        )
        told.append(more.of(number=len(known), all=len(anchors)))
    if len(known) < len(anchors):
        unknown = say(
            "The stone around {number} of {all} links was not checked, for want of an edge, a diameter or an embedment: "
            "stone_at_anchor tells what it bears."
        )
        told.append(unknown.of(number=len(anchors) - len(known), all=len(anchors)))
    return joined(" ", told)


def stone_at_limit(links: Sequence[PlacedLink]) -> str:
    """The same beside a limit analysis, which takes all links as ductile."""
    late = any(link.breaks_stone for link in links)
    return joined(" ", [stone_words(links), LATE if late else ""])


def stone_that_breaks(links: Sequence[PlacedLink]) -> str:
    """Links whose capacity is what the stone around them bears, in a sentence beside an answer; empty without."""
    anchors = [link for link in links if link.acts and link.mark != "sheet"]
    weak = [link for link in anchors if link.breaks_stone]
    if not weak:
        return ""
    said = say("The stone gives way before {number} of {all} links do: their capacity here is that of the stone.")
    return said.of(number=len(weak), all=len(anchors))
