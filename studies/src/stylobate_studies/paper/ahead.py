"""Kernels that the study needs later, compiled by a second process while the first one computes with others."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from stylobate.motion import harmonic
from stylobate.simulate import simulate_many

from . import cases as c


def compile_ahead() -> None:
    """Run the models in space for as short as can be: their compiled code stays on disk."""
    for label in (c.TWIN, c.SPACE):
        simulate_many(
            c.paper_column(c.MONOLITH, "circular"), [harmonic(1.0, 0.1, 0.01)], c.POPULATIONS[label], threads=1
        )


@contextmanager
def compiled_meanwhile(needed: bool) -> Iterator[Callable[[], object]]:
    """While this lasts, another process compiles the kernels in space if they are needed; gives what waits for it.

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
