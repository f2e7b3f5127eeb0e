"""Records of blocks of lanes on a graphics card: what is brought there, what is fetched, launches of the kernel."""

from __future__ import annotations

import weakref
from typing import Any, Protocol

import numpy as np

from stylobate.kernels.run_codes import FREE, RUNNING

from .kinds import AHEAD, ARGUMENTS, Types, kinds, lanes_of, site_type

#: Records of lanes that the kernel changes; those of sites come first among its arguments.
OF_LANES = ("lane", "feed", "watch")


class Device(Protocol):
    """A card, or what stands for one: see :class:`stylobate_gpu.driver.Card`."""

    name: str
    shared: int

    def kernel(self, name: str, shared: int) -> tuple[Any, int]:
        """A kernel, and its most threads of a block."""
        ...

    def at_once(self, kernel: Any, threads: int, shared: int) -> int:
        """Blocks of so many threads, with so much shared memory [bytes], that the card runs at a time."""
        ...

    def room(self, size: int) -> int:
        """Address of new memory."""
        ...

    def free(self, address: int) -> None:
        """Give memory back."""
        ...

    def queue(self) -> Any:
        """A queue of what the card is asked for, one after the other; others go on beside it."""
        ...

    def end(self, queue: Any) -> None:
        """Give a queue back."""
        ...

    def bring(self, address: int, array: np.ndarray, queue: Any) -> None:
        """Copy an array to the card."""
        ...

    def fetch(self, address: int, array: np.ndarray, queue: Any) -> None:
        """Copy from the card into an array."""
        ...

    def launch(self, kernel: Any, blocks: int, threads: int, shared: int, numbers: list[int], queue: Any) -> None:
        """Run a kernel, and wait for its end."""
        ...


def shared_memory(types: Types, drums: int) -> int:
    """Memory that a block of columns of so many drums takes beside that of the ground [bytes]."""
    return site_type(types).itemsize * (drums + 1)


def fits(device: Device, name: str, drums: int) -> bool:
    """Whether columns of so many drums fit on a card, with the kernel of a name."""
    types = kinds()[name]
    threads = types["watch"]["status"].shape[0] * drums
    room = shared_memory(types, drums) + types["ground"].itemsize * (AHEAD + 1)
    return room <= device.shared and threads <= device.kernel(name, shared_memory(types, drums))[1]


def lanes_at_once(device: Device, name: str, drums: int) -> int:
    """Lanes of columns of so many drums that a card advances at a time, by the kernel of a name."""
    lanes, shared = lanes_of(name), shared_memory(kinds()[name], drums)
    return lanes * device.at_once(device.kernel(name, shared)[0], lanes * drums, shared)


class CardRecords:
    """Records of blocks of lanes of columns on a graphics card, and copies of them here.

    Parameters
    ----------
    device : Device
    name : str
        Of the kernel.
    drums : int
    blocks : int
    """

    def __init__(self, device: Device, name: str, drums: int, blocks: int) -> None:
        types = kinds()[name]
        self.device, self.drums, self.blocks = device, drums, blocks
        self.lanes = types["watch"]["status"].shape[0]
        self.here = {"site": np.zeros((blocks, drums + 1), site_type(types))}
        self.here |= {record: np.zeros(blocks, types[record]) for record in OF_LANES}
        self.here["watch"]["status"] = FREE
        self.there = {record: device.room(array.nbytes) for record, array in self.here.items()}
        self.queue = device.queue()
        self.shared = shared_memory(types, drums)
        self.kernel, _ = device.kernel(name, self.shared)
        nothing = np.zeros(0, types["hold"])
        self.numbers = [
            number
            for record in ("site", *ARGUMENTS)
            for number in _described(self.here.get(record, nothing), self.there.get(record, 0))
        ]
        self.samples: dict[int, tuple[np.ndarray, int]] = {}
        self.changed = True
        weakref.finalize(self, _give_back, device, self.queue, self.there, self.samples).atexit = False

    def address(self, samples: np.ndarray | None) -> int:
        """Address on the card of the samples of a motion, which are brought there once; 0 for none."""
        if samples is None:
            return 0
        key = samples.ctypes.data  # of no other samples as long as these are held
        if key not in self.samples:
            place = self.device.room(samples.nbytes)
            self.device.bring(place, np.ascontiguousarray(samples), self.queue)
            self.samples[key] = samples, place
        return self.samples[key][1]

    def forget_samples(self, but: set[int]) -> None:
        """Clear away samples of motions, but those that start here at some addresses."""
        for key in [key for key in self.samples if key not in but]:
            self.device.free(self.samples.pop(key)[1])

    def views(self) -> dict[str, np.ndarray]:
        """Numbers of bodies, joints and lanes here, as bits; each of shape (rows, fields, blocks, lanes)."""
        arrays = {}
        for record in ("body", "joint", *OF_LANES):
            array = self.here["site" if record in ("body", "joint") else record]
            bits = array.view(np.int64).reshape(self.blocks, -1, array.dtype.itemsize // 8)
            if record in ("body", "joint"):
                kind, first = (array.dtype.fields or {})[record][:2]
                rows = self.drums + (record == "body")
                bits = bits[:, :rows, first // 8 : (first + kind.itemsize) // 8]
            fields = bits.reshape(self.blocks, bits.shape[1], -1, self.lanes)
            assert np.shares_memory(fields, array)
            arrays[record] = fields.transpose(1, 2, 0, 3)
        return arrays

    def advance(self, chunks: int) -> None:
        """Advance all lanes by so many chunks of steps, or to the end of their runs.

        What has been changed here since the last launch is brought before, and what the card has made of it is fetched once
        the run in some lane has ended.
        """
        device, queue = self.device, self.queue
        if self.changed:
            for record, array in self.here.items():
                device.bring(self.there[record], array, queue)
            self.changed = False
        running = self.here["watch"]["status"] == RUNNING
        device.launch(self.kernel, self.blocks, self.lanes * self.drums, self.shared, [*self.numbers, chunks], queue)
        device.fetch(self.there["watch"], self.here["watch"], queue)
        if (self.here["watch"]["status"] == RUNNING)[running].all():
            return
        for record in ("site", "lane", "feed"):
            device.fetch(self.there[record], self.here[record], queue)


def _described(array: np.ndarray, address: int) -> list[int]:
    """What a kernel is handed of an array: nobody who counts its holders, nor its parent; size, address, shape, strides."""
    return [0, 0, array.size, array.dtype.itemsize, address, *array.shape, *array.strides]


def _give_back(device: Device, queue: Any, there: dict[str, int], samples: dict[int, tuple[np.ndarray, int]]) -> None:
    """Give the memory of the card, and a queue, back."""
    device.end(queue)
    for address in (*there.values(), *(place for _, place in samples.values())):
        device.free(address)
