"""Kernels for graphics cards by their names: what columns each is for, and the files in which they are delivered.

A file holds a kernel as PTX, which the driver of a card compiles for it; its first line tells the sources of the kernels
from which it was built (``build.py``). One of other sources is not used: there is one law.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
from numpy.lib.recfunctions import repack_fields

from stylobate.errors import InputError
from stylobate.kernels.dem3d import records as in_space
from stylobate.kernels.plane import records as in_plane
from stylobate.kernels.run_codes import CHUNK
from stylobate.kernels.sources import source_digest

from .laws import laws_for

#: Compute capability of the oldest cards for which kernels are built.
OLDEST = (8, 0)

#: Name of a kernel within its file; records that it takes after those of sites, in its order, and how many numbers it is
#: handed in all: two addresses, the size, that of an element and where it starts of each array, its shape and its strides;
#: and the number of chunks.
ENTRY = "advance"
ARGUMENTS = ("lane", "feed", "watch", "hold")
NUMBERS = 9 + 7 * len(ARGUMENTS) + 1

#: Lanes of a block: with a dozen drums whole groups of threads, of 32 each, and memory for several blocks on a processor.
BLOCK_LANES = 8

#: Contact points of a joint in the plane, and faces of drums in space, for which there are kernels.
POINTS, FACES = 2, ("rim", "corner")

#: Most registers of a thread, by the kernel: each quarter of a processor shares out 16,384 among its groups of 32 threads,
#: so that it has four of them at a time in the plane, three with dashpots and in space. Other kernels have what the compiler
#: of the driver gives them.
REGISTERS = {"plane": 128, "plane-damped": 168, "rim": 168}

#: Steps for which a block holds the motion of its base at a time, of a chunk: its memory is short.
AHEAD = CHUNK // 2

#: Last fields of a body in the plane and in space, which the loads under and over it tell.
IN_LOADS, IN_LOADS_IN_SPACE = ("fx", "fz", "mo"), ("f", "mo")

#: Folder of the files.
FOLDER = Path(__file__).parent / "built"

#: Record types of an engine by their names.
Types = Mapping[str, np.dtype]


def plane_kernel(damped: bool) -> str:
    """Name of the kernel for columns in the plane."""
    return "plane-damped" if damped else "plane"


def space_kernel(face: str, damped: bool, rolling: bool) -> str:
    """Name of the kernel for drums in space on faces of a kind (:func:`stylobate.kernels.dem3d.records.types`)."""
    return face + ("-rolling" if rolling else "-damped" if damped else "")


@cache
def kinds() -> dict[str, Types]:
    """Record types of every kernel that is built, by its name."""
    record_types: dict[str, Types] = {}
    for damped in (False, True):
        joint = in_plane.point_joint(POINTS, damped, BLOCK_LANES)
        own = in_plane.types(joint, damped, POINTS, BLOCK_LANES, False)
        record_types[plane_kernel(damped)] = own | {"body": _without(own["body"], IN_LOADS)}
    for face, damped, rolling in (*product(FACES, (False, True), (False,)), ("rim", True, True)):
        own = in_space.types(face, damped, rolling, lanes=BLOCK_LANES)
        record_types[space_kernel(face, damped, rolling)] = own | {"body": _without(own["body"], IN_LOADS_IN_SPACE)}
    return record_types


def lanes_of(name: str) -> int:
    """Lanes of a block of the kernel of a name."""
    return kinds()[name]["watch"]["status"].shape[0]


def _without(record: np.dtype, last: tuple[str, ...]) -> np.dtype:
    """A record without its last fields."""
    names = record.names or ()
    assert names[-len(last) :] == last
    return repack_fields(record[list(names[: -len(last)])])


def sums_type(types: Types) -> np.dtype:
    """Record of what a joint and the drum on it sum up, from the types of an engine's records."""
    lanes = types["watch"]["status"].shape
    sums = [(name, np.float64, lanes) for name in ("work", "shear", "visc")]
    return np.dtype([*sums, *((name, np.float64, (*rows, *lanes)) for name, rows in laws_for(types).momentum)])


def site_type(types: Types) -> np.dtype:
    """Record of a body, with the joint and the load over it and what they sum up, from the types of an engine's records.

    Of an odd number of rows of lanes: threads of neighbouring joints then reach for different banks of the shared memory, of
    which there are a power of two of such rows.
    """
    lanes = types["watch"]["status"].shape
    own = [*((name, types[name]) for name in ("body", "joint", "load")), ("sums", sums_type(types))]
    row = np.dtype((np.float64, lanes)).itemsize
    even = np.dtype(own).itemsize // row % 2 == 0
    return np.dtype([*own, ("idle", np.float64, lanes)] if even else own)


def stamp() -> str:
    """First line of a file that was built from these sources."""
    return f"// kernels of stylobate, built from sources {source_digest()}-{source_digest(FOLDER.parent)}"


def missing() -> Iterator[str]:
    """Names of kernels of which there is no file from these sources."""
    for name in kinds():
        place = FOLDER / f"{name}.ptx"
        if not place.is_file() or place.read_text().partition("\n")[0] != stamp():
            yield name


def text_of(name: str) -> str:
    """A kernel as PTX.

    Raises
    ------
    InputError
        It was not built, or from other sources.
    """
    if name in missing():
        raise InputError(
            f"`device` is gpu, and the kernel {name!r} for graphics cards was not built from the sources of this "
            "installation; take a wheel, or run `make ptx` in the source tree, or leave `device` out.",
            "device",
        )
    return (FOLDER / f"{name}.ptx").read_text()
