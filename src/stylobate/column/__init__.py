"""What stands: drums, joints, columns, presets and column files."""

from .as_found import AsFound, FoundDrum
from .column import MAX_DRUMS, Column
from .drum import Drum
from .joint import Joint
from .links import Bar, Core, Dowel, Layer, Link, Tie
from .presets import PAPER_BLOCK_MODULUS, PRESETS, preset

__all__ = [
    "MAX_DRUMS", "PAPER_BLOCK_MODULUS", "PRESETS", "AsFound", "Bar", "Column", "Core", "Dowel", "Drum", "FoundDrum", "Joint",
    "Layer", "Link", "Tie", "preset",
]  # fmt: skip
