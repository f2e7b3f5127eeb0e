"""The compiler: how every kernel is compiled and where the compiled code is kept.

The cache of compiled code lives in a folder named by a digest of all kernel sources, because the compiler notices an
edit only in the file of the loop itself, not in the law that the loop calls. The full width of the vector registers is
asked for before the compiler is loaded.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path


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

import numba  # noqa: E402
from numba.core import cpu, options  # noqa: E402

numba.config.reload_config()
# The compiler can be told that the arrays of a loop do not overlap, but numba gives this flag no name of its own.
cpu.CPUTargetOptions.noalias = options.TargetOptions.Mapping("noalias")

#: Multiply-add contraction, and sums whose sign of zero does not matter; no reordering, so that results keep their bits.
FAST = {"contract", "nsz", "arcp", "nnan"}

#: For loops over lanes; releases the interpreter's lock.
kernel = numba.njit(cache=True, nogil=True, fastmath=FAST, error_model="numpy")

#: For loops over lanes whose array arguments never overlap: spares the checks before every loop.
apart = numba.njit(cache=True, nogil=True, fastmath=FAST, error_model="numpy", noalias=True)

#: For the scalar laws that several kernels share.
law = numba.njit(inline="always", fastmath=FAST, error_model="numpy")

#: For what looks at non-finite values: no assumption about them. Said outright, or the first fast caller would pass its own.
strict = numba.njit(cache=True, nogil=True, fastmath=False, error_model="numpy")
