"""Kernels that the study needs later, compiled by a second process while the first one computes with others."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from stylobate.models.base import Model
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.motion import harmonic
from stylobate.simulate import simulate_many

from . import cases as c


def compile_ahead() -> None:
    """Run models for as short as can be, in the order of the study: their compiled code stays on disk.

    A line is printed when a law in space is compiled.
    """
    for label in (c.SLIDING, c.BLOCKS):
        _compile(c.MODELS[label], "rectangular")
    for law in ("rim", "bed"):
        _compile(DistinctElement3D(law=law), "circular")
        print(law, flush=True)


def _compile(model: Model, section: str) -> None:
    simulate_many(c.paper_column(c.MONOLITH, section), [harmonic(1.0, 0.1, 0.01)], model, threads=1)


@contextmanager
def compiled_meanwhile(needed: bool) -> Iterator[Callable[[], object]]:
    """While this lasts, another process compiles the kernels that come later, if they are needed.

    Gives what waits for the next law in space: once before the populations, once before those of the literature.

    The compiler uses one core, and what it has on disk it takes from there. Where the other process fails, nothing is lost:
    the kernels are compiled when they are needed.
    """
    if not needed:
        yield lambda: None
        return
    call = f"from {__name__} import compile_ahead; compile_ahead()"
    unheard = subprocess.DEVNULL
    other = subprocess.Popen([sys.executable, "-c", call], stdin=unheard, stdout=subprocess.PIPE, stderr=unheard)
    assert other.stdout is not None
    try:
        yield other.stdout.readline  # which is empty at once where the process has ended
    finally:
        other.kill()
        other.communicate()
