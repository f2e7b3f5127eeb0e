"""The compiler: how every kernel is compiled.

Kernels are compiled for a level of processors (``levels.py``), which is chosen before the compiler is loaded, without what
the types of records rule out (``known_branches.py``), and kept on disk by what they are made of (``cache.py``). What is
replaced inside the compiler is in ``numba_patches.py``. Compiling that takes long enough to be noticed is told to the log of
the package.
"""

from __future__ import annotations

import functools
import logging
import threading
import time
from collections.abc import Callable
from typing import Any

from . import levels

levels.choose()

import numba  # noqa: E402
from numba.core import event  # noqa: E402
from numba.extending import overload  # noqa: E402

numba.config.reload_config()

from . import numba_patches as numba_patches  # noqa: E402
from .cache import KernelCache  # noqa: E402
from .known_branches import KernelCompiler  # noqa: E402

#: Multiply-add contraction, and sums whose sign of zero does not matter; no reordering, so that results keep their bits.
FAST = {"contract", "nsz", "arcp", "nnan"}


#: Time of compiling after which it is told, and until it is told again [s].
REPORT_AFTER, REPORT_EVERY = 2.0, 30.0


class _Wait(event.Listener):
    """Tells the log that the compiler is at work; it is asked of what is not found on disk only.

    The compiler has one lock: one thread at a time compiles a kernel, and within it the kernels that it calls.
    """

    def __init__(self) -> None:
        self.depth, self.spent, self.began, self.due = 0, 0.0, 0.0, REPORT_AFTER
        self.bell: threading.Timer | None = None

    def on_start(self, event: event.Event) -> None:
        """A kernel is being compiled from now on."""
        self.depth += 1
        if self.depth == 1:
            self.began = time.monotonic()
            self._wind()

    def on_end(self, event: event.Event) -> None:
        """It is compiled."""
        self.depth -= 1
        if self.depth == 0:
            self.spent += time.monotonic() - self.began
            if self.bell is not None:
                self.bell.cancel()

    def _wind(self) -> None:
        self.bell = threading.Timer(max(0.0, self.due - self.spent - (time.monotonic() - self.began)), self._tell)
        self.bell.daemon = True
        self.bell.start()

    def _tell(self) -> None:
        if self.depth == 0:
            return
        if self.due == REPORT_AFTER:
            logging.getLogger("stylobate").info(
                "compiling, which these settings need once on this machine: up to a minute, several where it is busy."
            )
        else:
            logging.getLogger("stylobate").info("still compiling, for %.0f s so far.", self.due)
        self.due += REPORT_EVERY
        self._wind()


event.register("numba:compile", _Wait())


_njit = functools.partial(numba.njit, error_model="numpy", pipeline_class=KernelCompiler)


def _compiler(owner: bool = False, **how: Any) -> Callable:
    """A decorator; ``owner`` for what makes arrays of its own.

    All else borrows its arrays, and does not count who holds them: that would be some 60 atomic operations in every step,
    0.2 µs of its 0.4 µs for a column of three drums in sixteen lanes.
    """

    def compiled(function: Callable) -> Any:
        made = _njit(nogil=True, no_cfunc_wrapper=True, _nrt=owner, **how)(function)
        if hasattr(made, "_cache"):  # there is none where the compiler is turned off
            made._cache = KernelCache(function)
        return made

    return compiled


#: For loops over lanes; releases the interpreter's lock.
kernel = _compiler(fastmath=FAST)

#: For loops over lanes whose array arguments never overlap: spares the checks before every loop.
apart = _compiler(fastmath=FAST, noalias=True)

#: For what looks at non-finite values: no assumption about them. Said outright, or the first fast caller would pass its own.
strict = _compiler(fastmath=False)

#: As ``kernel`` and ``strict``, for what makes arrays of its own, or calls what hands its own over.
kernel_of_arrays = _compiler(owner=True, fastmath=FAST)
strict_of_arrays = _compiler(owner=True, fastmath=False)

#: For the scalar laws that several kernels share.
law = _njit(inline="always", fastmath=FAST, _nrt=False)

#: For laws that are made of many others, or take some as arguments: compiled once, and only then written into the loop, with
#: the same bits in little more than half of the compiler's time. Not for what is strict: it keeps its own flags.
long_law = _njit(forceinline=True, fastmath=FAST, _nrt=False)


def chosen(choose: Callable) -> Callable:
    """For what depends on the types of its arguments: asked where a kernel that calls it is compiled, it gives what is
    compiled there."""

    def stands_for_it(*arguments: Any) -> Any:
        raise NotImplementedError(f"{choose.__name__} is for compiled code")

    overload(stands_for_it, strict=False)(choose)
    return functools.wraps(choose)(stands_for_it)
