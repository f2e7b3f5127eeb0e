"""Structures: drums, joints, columns, presets and column files."""

from .as_found import AsFound, FoundDrum
from .catalogue import PAPER_BLOCK_MODULUS, PRESETS, preset
from .column import MAX_DRUMS, Column
from .drum import Drum
from .joint import Joint

__all__ = [
    "MAX_DRUMS", "PAPER_BLOCK_MODULUS", "PRESETS", "AsFound", "Column", "Drum", "FoundDrum", "Joint", "preset",
]  # fmt: skip
