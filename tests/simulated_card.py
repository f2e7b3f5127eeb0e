"""Batches of columns in the plane by the kernel for graphics cards, in the compiler's simulator, beside the loop over lanes.

Run by ``agreement/test_graphics_card.py`` with ``NUMBA_ENABLE_CUDASIM=1``; prints what came of every batch, as JSON.
"""

from __future__ import annotations

import dataclasses
import json
import sys

import numpy as np
from numba.core.dispatcher import Dispatcher
from numba.cuda.simulator import kernel as simulator
from numba.cuda.simulator.cudadrv.devicearray import FakeCUDAArray

import stylobate as st
from stylobate.column.twins import twins_of
from stylobate.kernels.gpu import card as cards
from stylobate.kernels.gpu import column as kernel
from stylobate.models.base import Case, RunOptions
from stylobate.models.plane import card as lanes
from stylobate.models.start import Start

# laws take records as they are, not in the simulator's wrapping; it knows no addresses
simulator.FakeWithinKernelCUDAArray = lambda fake: fake._ary
FakeCUDAArray.__cuda_array_interface__ = property(lambda self: self._ary.__array_interface__)
sys.setswitchinterval(1e-5)  # its threads wait for one another in loops
cards.LANES_OF_BLOCK = (2,)  # two of them, so that a block is half empty, and others are all
for law in vars(kernel).values():
    if isinstance(law, Dispatcher) and law.targetoptions.get("inline") == "always":
        law.enable_caching()  # called alone here, where kernels have them written into them

JOINT = st.Joint(5e8, 2.5e8, friction_angle=30.0)
SIZE = {"height": 3.0, "top_width": 0.5, "density": 2400.0, "joint": JOINT}


def shaken(amplitude: float, seconds: float) -> st.Motion:
    """A push to one side that swings, with a vertical component."""
    t = np.arange(0.0, seconds, 0.005)
    return st.Motion(0.005, amplitude * (3.0 + np.sin(40.0 * t)), vertical=2.0 * np.cos(55.0 * t))


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
    columns = [dataclasses.replace(one, as_found=st.AsFound(base_tilt=2.0)) for one in columns]
    return columns, [shaken(2.0, 0.3), shaken(1.0, 0.2)], st.DistinctElement2D(), RunOptions(tail=0.05)


def told(measures) -> dict:
    """All numbers of a run, as text where bits count."""
    left = {
        f.name: np.asarray(getattr(measures.residuals, f.name)).tolist() for f in dataclasses.fields(measures.residuals)
    }
    return {"steps": measures.steps, "bits": repr((measures.row() | {"energy_imbalance": 0.0}, left)),
            "outcome": str(measures.outcome), "energy_imbalance": measures.energy_imbalance}  # fmt: skip


def main() -> None:
    """Run every batch by the loop, by the card, and by the card in shorter launches."""
    found = {}
    for batch in (one_drum, three_drums, sliding):
        columns, motions, model, options = batch()
        cases = [Case(*one) for one in zip(columns, motions, strict=True)]
        ways = {"loop": model.run_many(cases, options, 1)}
        for name, chunks in (("card", 500), ("cut", 3)):
            lanes.CHUNKS_PER_LAUNCH = chunks
            ways[name] = list(model.run_on_card(cases, options))
        found[batch.__name__] = {
            "drums": columns[0].n,
            **{name: [told(one) for _, one in sorted(way)] for name, way in ways.items()},
        }
    json.dump(found, sys.stdout)


if __name__ == "__main__":
    main()
