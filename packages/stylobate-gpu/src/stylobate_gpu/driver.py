"""The graphics card of this machine, by the driver's own interface (``cuda-bindings``): memory, kernels, launches."""

from __future__ import annotations

import ctypes
from functools import cache
from typing import Any

import numpy as np

from stylobate.errors import InputError, StylobateError

#: What to do where there is no card.
INSTEAD = "use a machine with an NVIDIA card made for computing (A100, H100 and the like), or leave `device` out"


class Card:
    """A graphics card.

    Attributes
    ----------
    name : str
        The card and the interface of its driver, in words.
    shared : int
        Memory that the threads of a block may share [bytes].

    Raises
    ------
    InputError
        There is no card, or it is too old.
    """

    def __init__(self) -> None:
        from .kinds import OLDEST

        try:
            from cuda.bindings import driver
        except ImportError as error:
            raise InputError(
                f"`device` is gpu, and cuda-bindings, by which cards are reached, cannot be loaded ({error}); install "
                "stylobate-gpu with what it needs, or leave `device` out.",
                "device",
            ) from None
        self._cuda = driver
        try:
            self._ask(driver.cuInit(0))
            (count,) = self._ask(driver.cuDeviceGetCount())
        except (RuntimeError, StylobateError) as error:  # the first where the driver is not there at all
            raise InputError(
                f"`device` is gpu, and the driver of NVIDIA cards does not answer ({error}); {INSTEAD}.", "device"
            ) from None
        if not count:
            raise InputError(f"`device` is gpu, and no NVIDIA card is found; {INSTEAD}.", "device")
        (device,) = self._ask(driver.cuDeviceGet(0))
        attributes = driver.CUdevice_attribute
        capability = tuple(
            self._ask(driver.cuDeviceGetAttribute(attribute, device))[0]
            for attribute in (
                attributes.CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR,
                attributes.CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR,
            )
        )
        (name,) = self._ask(driver.cuDeviceGetName(128, device))
        (version,) = self._ask(driver.cuDriverGetVersion())
        words = bytes(name).split(b"\0")[0].decode()
        if capability < OLDEST:
            raise InputError(
                f"`device` is gpu, and {words} has compute capability {capability[0]}.{capability[1]}; allowed is "
                f"{OLDEST[0]}.{OLDEST[1]} or newer: {INSTEAD}.",
                "device",
            )
        (self._processors,) = self._ask(
            driver.cuDeviceGetAttribute(attributes.CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT, device)
        )
        self.name = f"{words}, sm_{capability[0]}{capability[1]}, CUDA {version // 1000}.{version % 1000 // 10}"
        optin = attributes.CU_DEVICE_ATTRIBUTE_MAX_SHARED_MEMORY_PER_BLOCK_OPTIN
        (self.shared,) = self._ask(driver.cuDeviceGetAttribute(optin, device))
        (self._context,) = self._ask(driver.cuDevicePrimaryCtxRetain(device))
        self._kernels: dict[str, tuple[Any, int]] = {}  # with the shared memory for which they are ready

    def kernel(self, name: str, shared: int) -> tuple[Any, int]:
        """A kernel by its name, for blocks that share so much memory [bytes], and the most threads of a block."""
        from .kinds import ENTRY, text_of

        driver = self._current()
        function, ready = self._kernels.get(name, (None, 0))
        if function is None:
            text = text_of(name).encode() + b"\0"
            try:
                (module,) = self._ask(driver.cuModuleLoadData(text))
            except StylobateError as error:
                raise InputError(
                    f"`device` is gpu, and the driver of {self.name} does not take the kernel {name!r} ({error}); take a "
                    "newer driver, or leave `device` out.",
                    "device",
                ) from None
            (function,) = self._ask(driver.cuModuleGetFunction(module, ENTRY.encode()))
        attributes, ready = driver.CUfunction_attribute, max(shared, ready)  # never less than records in use have
        self._ask(
            driver.cuFuncSetAttribute(function, attributes.CU_FUNC_ATTRIBUTE_MAX_DYNAMIC_SHARED_SIZE_BYTES, ready)
        )
        # all that a processor of the card has is for shared memory: by itself the driver leaves room for a single block
        whole = driver.CUshared_carveout.CU_SHAREDMEM_CARVEOUT_MAX_SHARED
        self._ask(
            driver.cuFuncSetAttribute(
                function, attributes.CU_FUNC_ATTRIBUTE_PREFERRED_SHARED_MEMORY_CARVEOUT, int(whole)
            )
        )
        self._kernels[name] = function, ready
        (most,) = self._ask(driver.cuFuncGetAttribute(attributes.CU_FUNC_ATTRIBUTE_MAX_THREADS_PER_BLOCK, function))
        return function, most

    def at_once(self, kernel: Any, threads: int, shared: int) -> int:
        """Blocks of so many threads, with so much shared memory [bytes], that the card runs at a time."""
        driver = self._current()
        (each,) = self._ask(driver.cuOccupancyMaxActiveBlocksPerMultiprocessor(kernel, threads, shared))
        return int(each) * self._processors

    def room(self, size: int) -> int:
        """Address of new memory [bytes] on the card."""
        (address,) = self._ask(self._current().cuMemAlloc(max(size, 1)))
        return int(address)

    def free(self, address: int) -> None:
        """Give memory back."""
        self._ask(self._current().cuMemFree(address))

    def queue(self) -> Any:
        """A queue of what the card is asked for, one after the other; others go on beside it."""
        driver = self._current()
        (stream,) = self._ask(driver.cuStreamCreate(driver.CUstream_flags.CU_STREAM_NON_BLOCKING))
        return stream

    def end(self, queue: Any) -> None:
        """Give a queue back."""
        self._ask(self._current().cuStreamDestroy(queue))

    def bring(self, address: int, array: np.ndarray, queue: Any) -> None:
        """Copy an array, which is one piece of memory, to an address on the card."""
        driver = self._current()
        self._ask(driver.cuMemcpyHtoDAsync(address, array.ctypes.data, array.nbytes, queue))
        self._ask(driver.cuStreamSynchronize(queue))

    def fetch(self, address: int, array: np.ndarray, queue: Any) -> None:
        """Copy from an address on the card into an array, which is one piece of memory."""
        driver = self._current()
        self._ask(driver.cuMemcpyDtoHAsync(array.ctypes.data, address, array.nbytes, queue))
        self._ask(driver.cuStreamSynchronize(queue))

    def launch(self, kernel: Any, blocks: int, threads: int, shared: int, numbers: list[int], queue: Any) -> None:
        """Run a kernel with numbers of 64 bits as its arguments, and wait for its end."""
        driver = self._current()
        types = tuple(ctypes.c_int64 for _ in numbers)
        self._ask(driver.cuLaunchKernel(kernel, blocks, 1, 1, threads, 1, 1, shared, queue, (tuple(numbers), types), 0))
        self._ask(driver.cuStreamSynchronize(queue))

    def _current(self) -> Any:
        """The driver, with this card as that of the calling thread."""
        self._ask(self._cuda.cuCtxSetCurrent(self._context))
        return self._cuda

    def _ask(self, answer: tuple[Any, ...]) -> tuple[Any, ...]:
        """What the driver has answered behind its code for success.

        Raises
        ------
        StylobateError
            It has not succeeded.
        """
        code, *rest = answer
        if int(code) != 0:
            raise StylobateError(f"the graphics card has failed: {getattr(code, 'name', code)}")
        return tuple(rest)


@cache
def the_card() -> Card:
    """The card of this machine.

    Raises
    ------
    InputError
        cuda-bindings is not installed, there is no card, or there are no kernels for it.
    """
    from .kinds import kinds, missing, text_of

    card, names = Card(), set(kinds())
    if names == set(missing()):
        text_of(min(names))  # says so, before anything is made
    return card
