"""Compiled kernels on disk: found by what they are compiled from and for, checked by digest.

The name of a file is a digest of the sources that a kernel is compiled from (``sources.py``), the types of its arguments,
the level of the processor, and the versions of the compiler and of Python. Neither its place nor its age matters, so that
files can be shipped with the package, and shared by copies of it and by machines. What is not there as it was written is
compiled.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import sys
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite
import numba
from numba.core import caching, compiler, sigutils

from stylobate.atomic import replacing
from stylobate.errors import DamagedFileWarning, StylobateError

from .levels import name_of
from .sources import module_digest

#: Folder of this package, and that of the kernels that are shipped with it, by levels.
PACKAGE = Path(__file__).parent
SHIPPED = PACKAGE / "built"

#: End of the names of files of compiled code.
ENDING = ".kernel"

#: Kernels that were read from disk in this process: module, name, and types of the arguments.
read: list[tuple[str, str, tuple[Any, ...]]] = []


def cache_folder() -> Path:
    """Folder for the kernels that are compiled on this machine."""
    root = (
        os.environ.get("STYLOBATE_CACHE")
        or Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "stylobate"
    )
    return Path(root) / "kernels"


@cache
def _compiler(magic: tuple[str, str, str]) -> tuple[str, ...]:
    """What of the compiler decides its code, besides the level."""
    config = numba.config
    switches = (config.OPT, config.LOOP_VECTORIZE, config.SLP_VECTORIZE, config.BOUNDSCHECK, config.DEBUGINFO_DEFAULT)
    return (*magic, numba.__version__, llvmlite.__version__, sys.implementation.cache_tag, repr(switches))


class KernelCache(caching._Cache):
    """The compiled code of one kernel on disk, in place of the compiler's own cache, which goes by path and age.

    Parameters
    ----------
    function : callable
        What is compiled. A kernel of another package is compiled in every process: what it is compiled from is not known
        here.
    """

    def __init__(self, function: Callable) -> None:
        self._function, self._enabled = function, False
        self.enable()

    @property
    def cache_path(self) -> str:
        """Folder of what is compiled here."""
        return str(cache_folder())

    def enable(self) -> None:
        """Look on disk, for a kernel of this package."""
        self._enabled = self._function.__module__.startswith(f"{__package__}.")

    def disable(self) -> None:
        """Compile without a look on disk."""
        self._enabled = False

    def flush(self) -> None:
        """Nothing is kept in memory."""

    def file_of(self, sig: Any, context: Any) -> tuple[str, str]:
        """Folder, named by the level, and name of the file of a variant."""
        magic = context.codegen().magic_tuple()
        module, name = self._function.__module__, self._function.__qualname__
        inside = module.removeprefix(f"{__package__}.")
        what = (module_digest(inside, PACKAGE), module, name, str(_types(sig)), *_compiler(magic))
        key = hashlib.sha256(repr(what).encode()).hexdigest()[:32]
        level = name_of(*magic[1:]) or hashlib.sha256(repr(magic).encode()).hexdigest()[:16]
        return level, f"{inside}.{name}-{key}{ENDING}"

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The compiled code of a variant; None where there is none as it was written."""
        target_context.refresh()
        if not self._enabled:
            return None
        place = self.file_of(sig, target_context)
        for folder in (SHIPPED, cache_folder()):
            data = _whole(folder.joinpath(*place))
            if data is not None:
                read.append((self._function.__module__, self._function.__qualname__, _types(sig)))
                return compiler.CompileResult._rebuild(target_context, *pickle.loads(data))
        return None

    def save_overload(self, sig: Any, cres: Any) -> None:
        """Keep the compiled code of a variant, if there is room for it."""
        if (
            not self._enabled or cres.lifted or cres.library.has_dynamic_globals
        ):  # it would hold addresses of this process
            return
        parts = list(cres._reduce())
        parts[6] = ""  # the source text with types, for people, and its path
        data = pickle.dumps(tuple(parts), protocol=pickle.HIGHEST_PROTOCOL)
        folder, name = self.file_of(sig, cres.target_context)
        path = cache_folder() / folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with replacing(path) as partial:
                partial.write_bytes(hashlib.sha256(data).digest() + data)
        except (OSError, StylobateError) as error:
            warnings.warn(f"compiled code cannot be kept in {path.parent}: {error}", DamagedFileWarning, stacklevel=2)


def _types(sig: Any) -> tuple[Any, ...]:
    """Types of the arguments of a variant."""
    return tuple(sigutils.normalize_signature(sig)[0])


def _whole(path: Path) -> bytes | None:
    """What was written to a file; None where there is none, or not all of it, which is warned of."""
    try:
        data = path.read_bytes()
    except OSError:
        return None
    if hashlib.sha256(data[32:]).digest() == data[:32]:
        return data[32:]
    warnings.warn(f"compiled code in {path.parent} was damaged and is compiled anew.", DamagedFileWarning, stacklevel=2)
    return None
