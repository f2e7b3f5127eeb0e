"""Where the stone around the links of a structure gives way before they do, in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

from .placed import PlacedLink


def stone_words(links: Sequence[PlacedLink]) -> str:
    """Where the stone gives way before links do, and where that was not looked at, in sentences; empty without anchors."""
    anchors = [link for link in links if link.law == "dowel" and link.mark != "sheet" and link.acts]
    known = [(link, link.stone) for link in anchors if link.stone is not None]
    weak = [
        (link, stone, way) for link, stone in known if (way := stone.before(link.shear_capacity, link.axial_capacity))
    ]
    said = []
    if weak:
        link, stone, (how, bears, holds) = min(weak, key=lambda one: one[2][1] / one[2][2])
        bar = f"the bar holds {1e-3 * holds:.4g} kN" if math.isfinite(holds) else "the bar is without a limit"
        said.append(
            f"The stone gives way before {len(weak)} of {len(anchors)} links do, first around {link.name}: at "
            f"{1e-3 * bears:.4g} kN in {how}, where {bar} ({stone.source}). Computations take what the bar holds: forces "
            "beyond what the stone bears are not to be relied on."
        )
    elif known:
        said.append(
            f"The stone around {len(known)} of {len(anchors)} links bears more than they hold, by EN 1992-4 carried over "
            "from concrete."
        )
    if len(known) < len(anchors):
        said.append(
            f"The stone around {len(anchors) - len(known)} of {len(anchors)} links was not checked, for want of an edge, a "
            "diameter or an embedment: stone_at_anchor tells what it bears."
        )
    return " ".join(said)
