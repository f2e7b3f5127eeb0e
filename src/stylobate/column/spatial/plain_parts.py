"""Parts of a body in space as plain values, as files of results keep them, and back."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..shapes import Chipped, CircularFrustum, ConvexSolid, Placed, RectangularFrustum


def plain_of(part: Placed) -> dict:
    """A part as plain values."""
    shape, cuts = part.shape, None
    if isinstance(shape, Chipped):
        shape, cuts = shape.whole, shape.cuts
    if isinstance(shape, CircularFrustum):
        plain: dict[str, Any] = {"drum": [shape.bottom, shape.top, shape.height, shape.centroid]}
    elif isinstance(shape, RectangularFrustum):
        plain = {"frustum": [list(shape.bottom), list(shape.top), shape.height, shape.centroid]}
    else:
        assert isinstance(shape, ConvexSolid)
        plain = {"hull": np.asarray(shape.vertices).tolist()}
    if cuts is not None:
        plain["cuts"] = np.asarray(cuts).tolist()
    return plain | {"place": list(part.place), "orientation": list(part.orientation)}


def part_of(plain: dict) -> Placed:
    """The part that plain values stand for."""
    shape: Any
    if "drum" in plain:
        shape = CircularFrustum(*plain["drum"])
    elif "frustum" in plain:
        low, high, height, centroid = plain["frustum"]
        shape = RectangularFrustum(tuple(low), tuple(high), height, centroid)
    else:
        shape = ConvexSolid(np.array(plain["hull"]))
    if "cuts" in plain:
        shape = Chipped(shape, np.array(plain["cuts"]))
    return Placed(shape, tuple(plain["place"]), tuple(plain["orientation"]))
