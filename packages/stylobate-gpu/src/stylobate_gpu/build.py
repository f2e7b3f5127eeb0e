"""Builds the kernels for graphics cards as PTX, where numba-cuda and NVVM are installed: ``make ptx``. No card is needed."""

from __future__ import annotations

import multiprocessing
import sys
import time
from concurrent.futures import ProcessPoolExecutor

from stylobate.atomic import replacing

from .kinds import FOLDER, OLDEST, REGISTERS, kinds, missing, stamp


def build(*names: str) -> None:
    """Build kernels that are not there from these sources, all of them or those that are named, one on each core."""
    FOLDER.mkdir(exist_ok=True)
    with ProcessPoolExecutor(mp_context=multiprocessing.get_context("spawn")) as pool:
        for line in pool.map(build_one, [name for name in missing() if not names or name in names]):
            print(line, flush=True)


def build_one(name: str) -> str:
    """Build a kernel; says what it has become."""
    import numba.cuda.dispatcher as dispatcher

    from .column import compiled

    class Card:
        """The card that laws ask for when they are compiled into a kernel, whatever that is compiled for."""

        compute_capability = OLDEST

    dispatcher.get_current_device = Card
    started = time.monotonic()
    text = compiled(kinds()[name], REGISTERS.get(name, 0))
    with replacing(FOLDER / f"{name}.ptx") as partial:
        partial.write_text(f"{stamp()}\n{text}")
    return f"{name}: {len(text) // 1024} kB in {time.monotonic() - started:.0f} s"


if __name__ == "__main__":
    build(*sys.argv[1:])
