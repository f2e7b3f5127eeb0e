"""Batches of columns by the kernels for graphics cards, in the compiler's simulator, beside the loops over lanes.

Run by ``agreement/test_graphics_card.py`` with ``NUMBA_ENABLE_CUDASIM=1`` and the names of batches; prints what came of
them, as JSON.
"""

from __future__ import annotations

import ctypes
import dataclasses
import json
import sys
from typing import Any

import numpy as np
from numba.core.dispatcher import Dispatcher
from numba.cuda.simulator import kernel as simulator
from numba.cuda.simulator import kernelapi
from numba.np.numpy_support import as_dtype

import stylobate as st
from stylobate.column.scatter import twins_of
from stylobate.kernels.run_codes import LANES
from stylobate.models.base import Case, RunOptions
from stylobate.models.engine import engine_for
from stylobate.models.start import Start
from stylobate_gpu import card_check, column, kinds, laws
from stylobate_gpu import lanes as lanes
from stylobate_gpu.device import GraphicsCard

simulator.FakeWithinKernelCUDAArray = lambda fake: fake._ary  # laws take records as they are, not in its wrapping
memory_asked = kernelapi.FakeCUDAShared.array


def memory_of_a_block(self: Any, shape: Any, dtype: Any) -> np.ndarray:
    """Shared memory of a block: the simulator gives threads that ask for it at the same moment one each."""
    if shape == 0:
        return memory_asked(self, shape, dtype)
    return self._allocations.setdefault(str(dtype), np.zeros(shape, as_dtype(dtype)))


kernelapi.FakeCUDAShared.array = memory_of_a_block
lanes.THREADS = 1  # the simulator has one card, which does one thing at a time
lanes.WIDE = LANES  # spares the compiler the wide blocks
sys.setswitchinterval(1e-5)  # its threads wait for one another in loops
kinds.BLOCK_LANES = 2  # so that a block is half empty, and others are all
for module in (column, laws):
    for law in vars(module).values():
        if isinstance(law, Dispatcher) and law.targetoptions.get("inline") == "always":
            law.enable_caching()  # called alone here, where kernels have them written into them


class Simulated:
    """A card whose memory is that of this process; see :class:`stylobate_gpu.driver.Card`."""

    name, shared = "simulated", 10**6

    def __init__(self) -> None:
        self.held: dict[int, np.ndarray] = {}

    def kernel(self, name: str, shared: int) -> tuple[Any, int]:
        del shared
        return kinds.kinds()[name], 1024

    def at_once(self, kernel: Any, threads: int, shared: int) -> int:
        del kernel, threads, shared
        return 512

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
        """Takes the numbers apart as the compiled kernel does: they stand for arrays by their layout alone."""
        assert len(numbers) == kinds.NUMBERS
        *rest, chunks = numbers
        arrays = []
        for record in ("site", *kinds.ARGUMENTS):
            dtype = kinds.site_type(kernel) if record == "site" else kernel[record]
            axes = 2 if record == "site" else 1
            (_, _, size, item, address, *shape), rest = rest[: 5 + 2 * axes], rest[5 + 2 * axes :]
            shape, strides = tuple(shape[:axes]), tuple(shape[axes:])
            assert (item, size) == (dtype.itemsize, np.prod(shape)), record
            if not size:
                arrays.append(np.zeros(shape, dtype))
                continue
            whole = (ctypes.c_uint8 * (size * item)).from_address(address)
            arrays.append(np.frombuffer(whole, dtype).reshape(shape))
            assert arrays[-1].strides == strides, record
        column.kernel_for(kernel)[blocks, threads, 0, shared](*arrays, chunks)


JOINT = st.Joint(5e8, 2.5e8, friction_angle=30.0)
SIZE = {"height": 3.0, "top_width": 0.5, "density": 2400.0, "joint": JOINT}
ROUND = SIZE | {"section": "circular"}


def shaken(amplitude: float, seconds: float, across: float = 0.0) -> st.Motion:
    """A push to one side that swings, with a vertical component, and in space another one across."""
    t = np.arange(0.0, seconds, 0.005)
    along, up = amplitude * (3.0 + np.sin(40.0 * t)), 2.0 * np.cos(55.0 * t)
    return st.Motion(0.005, along, across * np.sin(30.0 * t), up) if across else st.Motion(0.005, along, vertical=up)


def one_drum() -> tuple:
    """A monolith that falls from its pose, and stouter ones that do not; more of them than there are lanes."""
    columns = [st.Column.tapered(**SIZE | {"top_width": 0.25}, bottom_width=0.25, drums=1)]
    columns += [st.Column.tapered(**SIZE, bottom_width=0.6 + 0.01 * i, drums=1) for i in range(17)]
    motions = [shaken(0.04, 1.0), *(shaken(0.5 + 0.1 * i, 0.1 + 0.02 * (i % 3)) for i in range(17))]
    return columns, motions, st.DistinctElement2D(), RunOptions(start=Start(0.1))


def three_drums() -> tuple:
    """Columns with scatter and the losses of stone; the last one's motion ends early."""
    column = st.Column.tapered(**SIZE, bottom_width=0.6, drums=3)
    columns = [column, *twins_of(column, st.Scatter(density=0.05, friction=0.1, offset=0.005), 2, seed=1)]
    motions = [shaken(1.0, 0.3), shaken(2.0, 0.3), shaken(3.0, 0.15)]
    return columns, motions, st.DistinctElement2D(losses="stone"), RunOptions()


def sliding() -> tuple:
    """Columns of three drums without losses that slide, on a base that slopes."""
    columns = [
        st.Column.tapered(**SIZE | {"joint": st.Joint(5e8, 2.5e8, friction_angle=angle)}, bottom_width=0.6, drums=3)
        for angle in (15.0, 25.0)
    ]
    columns = [dataclasses.replace(column, as_found=st.AsFound(base_tilt=2.0)) for column in columns]
    return columns, [shaken(2.0, 0.3), shaken(1.0, 0.2)], st.DistinctElement2D(), RunOptions(tail=0.05)


def round_monolith() -> tuple:
    """A slender round monolith that falls from its pose, and stouter ones that wobble."""
    columns = [st.Column.tapered(**ROUND | {"top_width": 0.25}, bottom_width=0.25, drums=1)]
    columns += [st.Column.tapered(**ROUND, bottom_width=0.6 + 0.01 * i, drums=1) for i in range(3)]
    motions = [shaken(0.04, 1.0, 0.1), *(shaken(0.5 + 0.1 * i, 0.1 + 0.02 * i, 1.0) for i in range(3))]
    return columns, motions, st.DistinctElement3D(), RunOptions(start=Start(0.1))


def round_drums() -> tuple:
    """Round columns of three drums, twins of one, without losses; the last one's motion ends early."""
    column = st.Column.tapered(**ROUND, bottom_width=0.6, drums=3)
    columns = [column, *twins_of(column, st.Scatter(density=0.05, friction=0.1, offset=0.005), 2, seed=1, space=True)]
    motions = [shaken(1.0, 0.2, 1.0), shaken(2.0, 0.2, 2.0), shaken(3.0, 0.1, 1.0)]
    return columns, motions, st.DistinctElement3D(), RunOptions()


def drums_of_stone() -> tuple:
    """Round columns with the losses of stone, which roll."""
    columns, motions, _, options = round_drums()
    return columns, motions, st.DistinctElement3D(losses="stone"), options


def with_corners() -> tuple:
    """Rectangular columns in space."""
    columns = [st.Column.tapered(**SIZE, bottom_width=0.6, depth=0.5, drums=2)] * 2
    return columns, [shaken(1.0, 0.1, 1.0), shaken(2.0, 0.08, 2.0)], st.DistinctElement3D(), RunOptions()


BATCHES = {
    batch.__name__: batch
    for batch in (one_drum, three_drums, sliding, round_monolith, round_drums, drums_of_stone, with_corners)
}


def numbers_of(measures: Any) -> dict:
    """All numbers of a run, as text where bits count."""
    residuals = {
        f.name: np.asarray(getattr(measures.residuals, f.name)).tolist() for f in dataclasses.fields(measures.residuals)
    }
    row = measures.row() | {"energy_imbalance": 0.0, "computed_by": ""}
    return {"steps": measures.steps, "bits": repr((row, residuals)), "by": measures.computed_by,
            "outcome": str(measures.outcome), "energy_imbalance": measures.energy_imbalance}  # fmt: skip


def main(names: list[str]) -> None:
    """Run every batch by the loop, by the card, and by the card in shorter launches."""
    results, device = {}, Simulated()
    card_check.check = lambda *_: None  # it is tried with a card that computes wrongly, elsewhere
    for name in names:
        columns, motions, model, options = BATCHES[name]()
        cases = [Case(*pair) for pair in zip(columns, motions, strict=True)]
        engine = engine_for(model, columns[0])
        ways = {"loop": engine.run_many(cases, options, 1)}
        for way, chunks in (("card", 500), ("cut", 3)):
            lanes.CHUNKS_PER_LAUNCH = chunks
            ways[way] = list(engine.run_on_card(GraphicsCard(device), cases, options, 1))
        results[name] = {
            "drums": columns[0].n,
            **{way: [numbers_of(measures) for _, measures in sorted(runs)] for way, runs in ways.items()},
        }
    json.dump(results, sys.stdout)


if __name__ == "__main__":
    main(sys.argv[1:])
