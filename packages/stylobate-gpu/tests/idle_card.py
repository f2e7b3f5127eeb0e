"""A graphics card that computes nothing: runs go on there to their last step, and columns stay as they stood.

What is left is the work of the host: it is tried, and timed, without a card.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from stylobate.kernels.run_codes import CHUNK, ENDED, RUNNING
from stylobate_gpu import kinds


class IdleCard:
    """A card whose memory is that of this process; see :class:`stylobate_gpu.driver.Card`."""

    name, shared = "idle", 10**6

    def __init__(self, blocks: int = 512) -> None:
        self.blocks = blocks
        self.held: dict[int, np.ndarray] = {}

    def kernel(self, name: str, shared: int) -> tuple[Any, int]:
        del shared
        return kinds.kinds()[name], 1024

    def at_once(self, kernel: Any, threads: int, shared: int) -> int:
        del kernel, threads, shared
        return self.blocks

    def room(self, size: int) -> int:
        memory = np.zeros(size, np.uint8)
        self.held[memory.ctypes.data] = memory
        return memory.ctypes.data

    def free(self, address: int) -> None:
        del self.held[address]

    def queue(self) -> None:
        pass

    def end(self, queue: None) -> None:
        pass

    def bring(self, address: int, array: np.ndarray, queue: None) -> None:
        ctypes.memmove(address, array.ctypes.data, array.nbytes)

    def fetch(self, address: int, array: np.ndarray, queue: None) -> None:
        ctypes.memmove(array.ctypes.data, address, array.nbytes)

    def launch(self, kernel: Any, blocks: int, threads: int, shared: int, numbers: list[int], queue: None) -> None:
        """Runs go on by so many chunks of steps, or end."""
        del threads, shared, queue
        place, there = 9, {}
        for record in kinds.ARGUMENTS:
            if record in ("feed", "watch"):
                size = blocks * kernel[record].itemsize
                memory = (ctypes.c_uint8 * size).from_address(numbers[place + 4])
                there[record] = np.frombuffer(memory, kernel[record])
            place += 7
        feed, status = there["feed"], there["watch"]["status"]
        running = status == RUNNING
        feed["step"][running] = np.minimum(feed["step"] + numbers[-1] * CHUNK, feed["end"])[running]
        status[running & (feed["step"] >= feed["end"])] = ENDED
