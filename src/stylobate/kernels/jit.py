"""The compiler: how every kernel is compiled and where the compiled code is kept.

The cache of compiled code lives in a folder named by a digest of all kernel sources, because the compiler notices an
edit only in the file of the loop itself, not in the law that the loop calls. The full width of the vector registers is
asked for before the compiler is loaded. Compiling that takes long enough to be noticed is told to the log of the package.
"""

from __future__ import annotations

import functools
import glob
import hashlib
import logging
import os
import pickle
import threading
import time
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from stylobate.errors import DamagedFileWarning


def source_digest(folder: Path | None = None) -> str:
    """Digest of all files of the kernels' folder and the rooms in it."""
    root = folder or Path(__file__).parent
    found = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        found.update(path.relative_to(root).as_posix().encode())
        found.update(path.read_bytes())
    return found.hexdigest()[:16]


def cache_folder(folder: Path | None = None) -> Path:
    """Folder for compiled kernels, keyed by their sources."""
    root = (
        os.environ.get("STYLOBATE_CACHE")
        or Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "stylobate"
    )
    return Path(root) / "kernels" / source_digest(folder)


def _prepare() -> None:
    os.environ["NUMBA_CACHE_DIR"] = str(cache_folder())
    if "NUMBA_CPU_FEATURES" not in os.environ and "NUMBA_CPU_NAME" not in os.environ:
        import llvmlite.binding as llvm

        features = llvm.get_host_cpu_features()
        if features.get("avx512f"):
            os.environ["NUMBA_CPU_NAME"] = llvm.get_host_cpu_name()
            os.environ["NUMBA_CPU_FEATURES"] = features.flatten() + ",-prefer-256-bit"


_prepare()

import llvmlite.binding as llvm  # noqa: E402
import numba  # noqa: E402
from numba.core import caching, codegen, cpu, event, options, types  # noqa: E402
from numba.extending import overload  # noqa: E402

numba.config.reload_config()
# The compiler can be told that the arrays of a loop do not overlap, but numba gives this flag no name of its own.
cpu.CPUTargetOptions.noalias = options.TargetOptions.Mapping("noalias")
# A law is compiled for each type of record that it is given, whatever was compiled before: the compiler would take what it
# has for a record that begins with the same fields, with a warning.
types.Record.can_convert_to = lambda *_: None


def _called(record: Any) -> tuple[str, tuple[str]]:
    # The name of a record in that of compiled code is of what it holds. The compiler would number records in each process,
    # so that code for two of them, kept on disk by two processes, could bear one name, and the one be run for the other.
    return "Record", (hashlib.sha256(record.name.encode()).hexdigest()[:32],)


types.Record.mangling_args = property(_called)


class _OwnCode(codegen.JITCodeLibrary):
    """The code of a kernel, which calls the copies of other kernels that were compiled into it.

    By themselves copies of one name are one to the linker, which takes whichever the process has loaded first: code that was
    compiled twice may contract other products and sums, so that last bits would hang on what had been compiled or loaded.
    """

    def _finalize_final_module(self) -> None:
        if self._shared_module is None:  # not read from disk
            self._shared_module = self._final_module.clone()  # what other kernels copy
            for functions, before, after in (
                (self._shared_module.functions, llvm.Linkage.external, llvm.Linkage.linkonce_odr),
                (self._final_module.functions, llvm.Linkage.linkonce_odr, llvm.Linkage.internal),
            ):
                for function in functions:
                    if not function.is_declaration and function.linkage == before:
                        function.linkage = after
        super()._finalize_final_module()


codegen.JITCPUCodegen._library_class = _OwnCode

#: Multiply-add contraction, and sums whose sign of zero does not matter; no reordering, so that results keep their bits.
FAST = {"contract", "nsz", "arcp", "nnan"}


#: Age of a half-written file of compiled code that nobody is writing any more [s].
ABANDONED = 3600.0


class _CacheFiles(caching.IndexDataCacheFile):
    """Files of compiled code behind their checksum: what a power cut left of one is compiled anew, never run."""

    def _dump(self, obj: Any) -> bytes:
        data = super()._dump(obj)
        return hashlib.sha256(data).digest() + data

    def _load_index(self) -> dict:
        try:
            with open(self._index_path, "rb") as file:
                version = pickle.load(file)
                if isinstance(version, str) and version != self._version:
                    return {}
                stamp, overloads = self._whole(file.read())
        except FileNotFoundError:
            return {}
        except Exception:  # whatever unpickling makes of it
            return self._damaged(self._index_path) or {}
        return overloads if stamp == self._source_stamp else {}

    def _load_data(self, name: str) -> Any:
        path = self._data_path(name)
        with open(path, "rb") as file:
            data = file.read()
        try:
            return self._whole(data)
        except Exception:
            self._damaged(path)
            raise FileNotFoundError(path) from None  # as if it were not there: compiled and written again

    def save(self, key: Any, data: Any) -> None:
        """Keep compiled code, if there is room for it."""
        try:
            super().save(key, data)
            for left in Path(self._cache_path).glob(f"{glob.escape(Path(self._index_path).stem)}.*.tmp.*"):
                with suppress(FileNotFoundError):  # another process has just finished writing it
                    if time.time() - left.stat().st_mtime > ABANDONED:
                        left.unlink()  # of a process that was killed while it wrote
        except OSError as error:
            warnings.warn(
                f"compiled code cannot be kept in {self._cache_path}: {error}.", DamagedFileWarning, stacklevel=2
            )

    def _whole(self, data: bytes) -> Any:
        if hashlib.sha256(data[32:]).digest() != data[:32]:
            raise ValueError("checksum")
        return pickle.loads(data[32:])

    def _damaged(self, path: str) -> None:
        warnings.warn(
            f"compiled code in {Path(path).parent} was damaged and is compiled anew.", DamagedFileWarning, stacklevel=2
        )


#: Time of compiling after which it is told, and until it is told again [s].
TOLD_AFTER, TOLD_EVERY = 2.0, 30.0


class _Wait(event.Listener):
    """Tells the log that the compiler is at work; it is asked of what is not found on disk only.

    The compiler has one lock: one thread at a time compiles a kernel, and within it the kernels that it calls.
    """

    def __init__(self) -> None:
        self.depth, self.spent, self.began, self.due = 0, 0.0, 0.0, TOLD_AFTER
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
        if self.due == TOLD_AFTER:
            logging.getLogger("stylobate").info(
                "compiling, which these settings need once on this machine: up to a minute, several where it is busy."
            )
        else:
            logging.getLogger("stylobate").info("still compiling, for %.0f s so far.", self.due)
        self.due += TOLD_EVERY
        self._wind()


event.register("numba:compile", _Wait())


def _compiler(owner: bool = False, **how: Any) -> Callable:
    """A decorator; ``owner`` for what makes arrays of its own.

    All else borrows its arrays, and does not count who holds them: that would be some 60 atomic operations in every step,
    0.2 µs of its 0.4 µs for a column of three drums in sixteen lanes.
    """

    def compiled(function: Callable) -> Any:
        made = numba.njit(cache=True, nogil=True, error_model="numpy", _nrt=owner, **how)(function)
        files = getattr(getattr(made, "_cache", None), "_cache_file", None)
        if files is not None:  # there is none where the compiler is turned off
            files.__class__ = _CacheFiles
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
law = numba.njit(inline="always", fastmath=FAST, error_model="numpy", _nrt=False)

#: For laws that are made of many others, or take some as arguments: compiled once, and only then written into the loop, with
#: the same bits in little more than half of the compiler's time. Not for what is strict: it keeps its own flags.
long_law = numba.njit(forceinline=True, fastmath=FAST, error_model="numpy", _nrt=False)


def chosen(choose: Callable) -> Callable:
    """For what depends on the types of its arguments: asked where a kernel that calls it is compiled, it gives what is
    compiled there."""

    def stands_for_it(*arguments: Any) -> Any:
        raise NotImplementedError(f"{choose.__name__} is for compiled code")

    overload(stands_for_it, strict=False)(choose)
    return functools.wraps(choose)(stands_for_it)
