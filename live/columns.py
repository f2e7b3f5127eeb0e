"""Columns and fifteen like each as the page takes them: the memory of the module, packed when the page is built."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from stylobate.kernels.plane.standing import STAND_TYPE
from stylobate.kernels.run_codes import FREE, LANES
from stylobate.kernels.shared.records import STATE
from stylobate.models.engine import engine_for
from stylobate.models.plane.packing import point_law

from .kernel import KEPT_TYPE

#: Contact points of a joint, as of ``DistinctElement2D()``.
POINTS = 2

#: Arrays start at multiples of this [bytes].
LINE = 64


@dataclass
class Room:
    """All arrays that the functions of the module work on, for a column of so many drums.

    Parameters
    ----------
    state : tuple
        Records of the engine.
    kept, copies, words, base, dt, lanes, out, stand, flat, offset, width, stood, opening, slip
        As in ``kernel.py``.
    """

    state: tuple[Any, ...]
    kept: np.ndarray
    copies: tuple[np.ndarray, np.ndarray]
    words: tuple[np.ndarray, ...]
    base: np.ndarray
    dt: np.ndarray
    lanes: np.ndarray
    out: np.ndarray
    stand: np.ndarray
    flat: np.ndarray
    offset: np.ndarray
    width: np.ndarray
    stood: np.ndarray
    opening: np.ndarray
    slip: np.ndarray

    @classmethod
    def of(cls, state: tuple[Any, ...], drums: int) -> Room:
        """Room beside the records of a column."""
        joint, lane = (state[STATE.index(name)] for name in ("joint", "lane"))
        copies = np.zeros_like(joint), np.zeros_like(lane)
        return cls(
            state, np.zeros(1, KEPT_TYPE), copies, tuple(item.view(np.int64) for item in (joint, lane, *copies)),
            np.zeros((LANES, 2)), np.zeros(LANES), np.zeros(LANES, np.int64), np.zeros((LANES, 6)),
            np.zeros((LANES, drums), STAND_TYPE), np.zeros((LANES, drums), STAND_TYPE), np.zeros((LANES + 1, drums)),
            np.zeros((LANES, drums)), np.zeros((LANES, drums)), np.zeros(drums), np.zeros(drums),
        )  # fmt: skip

    @classmethod
    def blank(cls) -> Room:
        """Room of the right types, for the compiler."""
        types = point_law(POINTS, False, LANES, False)
        return cls.of((*(np.zeros(1, types[name]) for name in STATE[:-1]), 1), 1)

    def arguments(self, name: str) -> tuple[Any, ...]:
        """What a function is called with; motions, lanes and numbers of chunks are written in later."""
        shared = self.state, self.kept, self.copies, self.words, self.base, self.dt, self.lanes, self.out
        judged = self.stand, self.flat, self.offset, self.width, self.stood, self.opening, self.slip
        return {
            "advance": (self.state, 1),
            "begin": (*shared, 0, 0, 0, 1, 1.0, 1.0, 1.0),
            "judge": (*shared, *judged),
        }[name]


def arguments(name: str) -> tuple[Any, ...]:
    """Arguments of the right types, for the compiler."""
    return Room.blank().arguments(name)


def lanes_of(columns: Sequence[Any], model: Any) -> Room:
    """A block of lanes in which columns stand at rest, the first one in the first lane, and the others in its time step."""
    from stylobate.models.base import Case, RunOptions
    from stylobate.models.plane.packing import numbers_for
    from stylobate.motion import Motion

    paced = engine_for(model, columns[0]).paced
    block = engine_for(paced, columns[0]).block(RunOptions())
    for lane, column in enumerate(columns):
        block.load(lane, Case(column, Motion(1.0, np.zeros(2))))
    room = Room.of(block.records.state, columns[0].n)
    block.watch["status"], block.feed["x"] = FREE, 0  # until a run begins
    kept = room.kept[0]
    for lane, column in enumerate(columns):
        packed = block.packed[lane]
        stand, result = numbers_for(column)
        kept["step"][lane], kept["barrier"][lane] = packed.step, packed.barrier
        kept["narrow"][lane], kept["gravity"][lane] = packed.widths.min(), column.gravity
        room.stand[lane] = stand
        room.stand["toe"][lane], room.stand["others"][lane] = packed.stand
        room.offset[lane], room.width[lane], room.stood[lane] = result, packed.widths, block.slip[lane]
    return room


def flat(arguments: Any) -> Iterator[Any]:
    """Arrays and numbers, one after the other, of arguments that may be tuples of them."""
    for item in arguments:
        if isinstance(item, tuple):
            yield from flat(item)
        else:
            yield item


class Memory:
    """The module's memory for a block of lanes: its arrays one behind the other from an address on."""

    def __init__(self, room: Room, start: int) -> None:
        self.start, self.bytes, self.places = start, bytearray(), {}
        for item in flat([value for name in ("begin", "judge") for value in room.arguments(name)]):
            if isinstance(item, np.ndarray):
                self.place_of(item)
        self.room, self.results = room, self.put(bytes(LINE))
        self.calls = {name: self.put(self.words(room.arguments(name))) for name in ("begin", "advance", "judge")}

    def put(self, data: bytes) -> int:
        """Append bytes on a line of their own; their address."""
        self.bytes += bytes(-(self.start + len(self.bytes)) % LINE)
        place = self.start + len(self.bytes)
        self.bytes += data
        return place

    def place_of(self, array: np.ndarray) -> int:
        """Address of an array, which is put there if it is new; views of one array have its address."""
        if not array.size:
            return self.start
        key = array.__array_interface__["data"][0]
        if key not in self.places:
            self.places[key] = self.put(array.tobytes())
        return self.places[key]

    def words(self, arguments: tuple[Any, ...]) -> bytes:
        """Arguments as the compiled function is given them: behind its two results, an array as seven words or more.

        Of an array: two that nobody reads, its size, that of an element, its address, its shape, its strides.
        """
        result = bytearray(np.array([self.results, self.results + LINE // 2], np.int64).tobytes())
        for item in flat(arguments):
            if isinstance(item, np.ndarray):
                layout = [0, 0, item.size, item.itemsize, self.place_of(item), *item.shape, *item.strides]
                result += np.array(layout, np.int64).tobytes()
            else:
                result += np.array([item], np.int64 if isinstance(item, int) else np.float64).tobytes()
        return bytes(result)

    def last_words(self, name: str, count: int) -> int:
        """Where the last arguments of a call are, which the page writes, in bytes from where the memory begins."""
        return self.calls[name] - self.start + len(self.words(self.room.arguments(name))) - 8 * count

    def layout(self) -> dict[str, Any]:
        """Where the page finds what it shows, writes and copies: addresses, in bytes from where the memory begins."""
        records = dict(zip(STATE, self.room.state)) | {"kept": self.room.kept}
        striped = {name: records[name] for name in ("body", "joint", "lane", "feed", "watch", "kept")}

        def fields(name: str) -> dict[str, int]:
            offsets: Any = records[name].dtype.fields
            return {item: self.place_of(records[name]) - self.start + offsets[item][1] for item in WANTED[name]}

        rows = [
            [self.place_of(item) - self.start, item.nbytes // len(item)]
            for item in (self.room.stand, self.room.offset, self.room.width, self.room.stood)
        ]
        return {
            "calls": {name: place - self.start for name, place in self.calls.items()},
            "lane": self.last_words("begin", 7),  # and what else of a motion `begin` is given
            "chunks": self.last_words("advance", 1),
            **{name: fields(name) for name in WANTED},
            "size": records["body"].itemsize,
            "striped": [[self.place_of(item) - self.start, item.nbytes // (8 * LANES)] for item in striped.values()],
            "rows": rows,
        }


#: Fields that the page reads or writes.
WANTED = {
    "body": ("x", "z", "c", "s"),
    "feed": ("x", "z", "step", "end"),
    "watch": ("status", "when", "which", "side"),
    "kept": ("dt", "shown", "outcome", "decided"),
}
