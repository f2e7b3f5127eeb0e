"""Kernels that the study needs later, compiled by a second process while the first one computes with others."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.motion import harmonic
from stylobate.simulate import simulate_many

from . import cases as c


def compile_ahead() -> None:
    """Run models for as short as can be, in the order of the study: their compiled code stays on disk."""
    in_the_plane = [(c.MODELS[label], "rectangular") for label in (c.SLIDING, c.BLOCKS)]
    in_space = [(DistinctElement3D(law=law), "circular") for law in ("rim", "bed")]
    for model, section in (*in_the_plane, *in_space):
        simulate_many(c.paper_column(c.MONOLITH, section), [harmonic(1.0, 0.1, 0.01)], model, threads=1)


@contextmanager
def compiled_meanwhile(needed: bool) -> Iterator[Callable[[], object]]:
    """While this lasts, another process compiles the kernels that come later, if they are needed; gives what waits for it.

    The compiler uses one core, and what it has on disk it takes from there. Where the other process fails, nothing is lost:
    the kernels are compiled when they are needed.
    """
    if not needed:
        yield lambda: None
        return
    call = f"from {__name__} import compile_ahead; compile_ahead()"
    unheard = subprocess.DEVNULL
    other = subprocess.Popen([sys.executable, "-c", call], stdin=unheard, stdout=unheard, stderr=unheard)
    try:
        yield other.wait
    finally:
        other.kill()
        other.wait()
