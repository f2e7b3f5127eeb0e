"""Records of blocks of lanes on a graphics card: what is brought there, what is fetched, and why there may be no card.

The only file beside the kernels of this room that knows the compiler for graphics cards.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping
from typing import Any

import numpy as np
from numba import config, cuda

from .column import kernel_for, site_type

#: Most threads of a block, and the shared memory that every card has for one [bytes].
THREADS, SHARED = 1024, 48 * 1024

#: Lanes of a block on the card, most first: as many as fit.
LANES_OF_BLOCK = (8, 4, 2, 1)


def without_card() -> str:
    """Why no graphics card computes here, in words; empty if one does."""
    if not config.ENABLE_CUDASIM and importlib.util.find_spec("numba_cuda") is None:
        return "numba-cuda, which compiles for them, is not installed"
    return "" if cuda.is_available() else "no NVIDIA card with its driver is found"


def card_name() -> str:
    """The card that computes, in words."""
    device = cuda.get_current_device()
    name = device.name.decode() if isinstance(device.name, bytes) else str(device.name)
    return f"{name} (sm_{device.compute_capability[0]}{device.compute_capability[1]})"


def fits(types: Mapping[str, np.dtype], drums: int) -> bool:
    """Whether a block of columns of so many drums, of these types of records, fits on any card."""
    lanes = types["watch"]["status"].shape[0]
    ground = (types["ground"].itemsize) * 64  # more than a chunk of steps has
    return lanes * drums <= THREADS and site_type(types).itemsize * (drums + 1) + ground <= SHARED


class CardRecords:
    """Records of blocks of lanes of columns on a graphics card, and copies of them here.

    Parameters
    ----------
    types : mapping of str to dtype
        Of the records by their names, with the lanes of a block on the card.
    drums : int
    blocks : int
    """

    def __init__(self, types: Mapping[str, np.dtype], drums: int, blocks: int) -> None:
        site = site_type(types)
        self.lanes, self.drums, self.blocks = types["watch"]["status"].shape[0], drums, blocks
        self.here = {name: np.zeros(blocks, types[name]) for name in ("lane", "feed", "watch")}
        self.here = {"site": np.zeros((blocks, drums + 1), site)} | self.here
        self.here["watch"]["status"] = -1  # not running
        self.there = {name: cuda.to_device(array) for name, array in self.here.items()}
        self.kernel = kernel_for(types)
        self.shared = site.itemsize * (drums + 1)
        self.samples: dict[int, tuple[np.ndarray, Any]] = {}

    def address(self, samples: np.ndarray | None) -> int:
        """Address on the card of the samples of a motion, which are brought there once; 0 for none."""
        if samples is None:
            return 0
        key = samples.ctypes.data  # of no other samples as long as these are held
        if key not in self.samples:
            self.samples[key] = samples, cuda.to_device(samples)
        return int(self.samples[key][1].__cuda_array_interface__["data"][0])

    def forget_samples(self, but: set[int]) -> None:
        """Clear away samples of motions, but those that start here at some addresses."""
        self.samples = {key: kept for key, kept in self.samples.items() if key in but}

    def fields(self, record: str, blocks: slice, part: str = "") -> np.ndarray:
        """Numbers of some blocks here, a view of shape (blocks, rows, fields × lanes); of sites those of one part."""
        array = self.here[record][blocks]
        bits = array.view(np.int64).reshape(len(array), -1, array.dtype.itemsize // 8)
        if not part:
            return bits
        kind, first = array.dtype.fields[part][:2]
        rows = bits[:, : self.drums] if part == "joint" else bits
        return rows[..., first // 8 : (first + kind.itemsize) // 8]

    def bring(self, blocks: slice) -> None:
        """Bring some blocks to the card as they are here."""
        for name, array in self.there.items():
            array[blocks].copy_to_device(self.here[name][blocks])

    def fetch(self, blocks: slice, *records: str) -> None:
        """Fetch some records of some blocks as they are on the card."""
        for name in records:
            self.here[name][blocks] = self.there[name][blocks].copy_to_host()

    def advance(self, chunks: int) -> None:
        """Advance all lanes by so many chunks of steps, or to the end of their runs."""
        self.kernel[self.blocks, self.lanes * self.drums, 0, self.shared](*self.there.values(), chunks)
