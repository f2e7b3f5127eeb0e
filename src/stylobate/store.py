"""Results as netCDF files: one numbered format, a digest of every byte, written whole or not at all.

A file is a netCDF 4 file that any program reads, and behind it one line of :data:`LINE` bytes that holds the SHA-256 of
all bytes before it. The digest is checked before the netCDF library sees a byte: what is damaged is refused, and cannot
hang or crash the process.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from .atomic import replacing
from .errors import InputError, check_kind
from .text_tables import printable, read_bytes

if TYPE_CHECKING:
    import pandas
    import xarray

#: Number of the format that is written, and read.
FORMAT = 2

#: Largest file that is read [bytes].
MOST = 8_000_000_000

_NAME = "stylobate result"
_NUMBER = re.compile(rb"stylobate result (\d{1,4})")
_LINE = re.compile(rb"\nstylobate result (\d{4}) sha256 ([0-9a-f]{64})\n")

#: Length of the last line of a file [bytes].
LINE = len(f"\n{_NAME} {FORMAT:04d} sha256 {'0' * 64}\n")


class Tabled(Protocol):
    """A result that is a labelled data set, and a table as well."""

    @property
    def table(self) -> pandas.DataFrame:
        """One row per cell."""
        ...

    def to_xarray(self) -> xarray.Dataset:
        """All of it."""
        ...


def write(data: xarray.Dataset, kind: str, path: str | Path) -> Path:
    """Write a data set, its arrays compressed; the file appears whole or not at all.

    Parameters
    ----------
    data : xarray.Dataset
    kind : str
        What it is: ``response``, ``domain``, ``probability`` …; the reader asks for it.
    path : str or Path

    Raises
    ------
    InputError
        The folder is missing or cannot be written to.
    StylobateError
        The disk is full.
    """
    target = Path(check_kind("path", path, (str, os.PathLike)))
    with replacing(target) as partial:
        # The library writes to memory: one that cannot finish a file on a full disk crashes when the process ends.
        image = _image(data, {"format": f"{_NAME} {FORMAT}", "kind": kind})
        line = f"\n{_NAME} {FORMAT:04d} sha256 {hashlib.sha256(image).hexdigest()}\n"
        with partial.open("wb") as file:
            file.write(image)
            file.write(line.encode())
            file.flush()
            os.fsync(file.fileno())
    return target


def save(result: Tabled, kind: str, path: str | Path) -> Path:
    """Write a result by the ending of the name: netCDF for ``.nc``, its table for ``.csv``; whole or not at all.

    Raises
    ------
    InputError
        Another ending, or a folder that cannot be written to.
    """
    target = Path(check_kind("path", path, (str, os.PathLike)))
    if target.suffix == ".nc":
        return write(result.to_xarray(), kind, target)
    if target.suffix != ".csv":
        raise InputError(f"{target} ends in {target.suffix!r}; a {kind} is saved as .nc (netCDF) or .csv (table).")
    with replacing(target) as partial:
        result.table.to_csv(partial, index=False)
    return target


def read(path: str | Path, *kinds: str) -> xarray.Dataset:
    """Read a data set of one of these kinds; of any if none is given. Its attribute ``kind`` says which.

    Raises
    ------
    InputError
        There is no such file, it is none of these, is damaged, or of a format that this version does not know.
    """
    content = read_bytes(path, MOST)
    name, wanted = printable(path), " or ".join(f"a {kind}" for kind in kinds)
    data = _open(content, name)
    kind = data.attrs.get("kind")
    if kind is None or (kinds and kind not in kinds):
        raise InputError(
            f"{name} is a {kind}, not {wanted or 'a result'} of this package; give a file that this package wrote as such."
        )
    return data


def unreadable(path: str | Path, error: Exception) -> InputError:
    """The error for a file that was opened, but does not hold what it must."""
    why = f"{type(error).__name__}: {error}".split("\n")[0][:200]
    return InputError(f"{printable(path)} is damaged: {why}; take a copy of it, or run again.")


def as_json(value: Any) -> str:
    """Plain values as a JSON text."""
    return json.dumps(value, default=_plain)


def from_json(data: xarray.Dataset, name: str) -> Any:
    """The plain values in a JSON text of a data set."""
    return json.loads(str(data[name].item()))


def read_provenance(path: str | Path) -> dict[str, Any]:
    """Provenance of any result: a response of a column or an assembly, a domain, probabilities.

    Raises
    ------
    InputError
        There is no such file, it is damaged, or it holds no provenance.
    """
    data = read(path)
    try:
        return dict(json.loads(str(data["provenance"].item())))
    except (KeyError, TypeError, ValueError, RecursionError) as error:
        raise InputError(
            f"{printable(path)} holds no provenance that can be read ({error}); give a netCDF file of this package, such as "
            "response.nc."
        ) from None


def _image(data: xarray.Dataset, attributes: dict[str, Any]) -> bytes:
    """The bytes of a netCDF file."""
    import h5netcdf

    memory = io.BytesIO()
    with h5netcdf.File(memory, "w") as file:
        file.dimensions = {str(name): size for name, size in data.sizes.items()}
        for name, variable in data.variables.items():
            values = np.asarray(variable.values)
            if values.dtype.kind in "OU":
                import h5py

                values = values.astype(object)
                put = file.create_variable(str(name), variable.dims, dtype=h5py.string_dtype(), data=values)
            elif variable.ndim and values.size:
                put = file.create_variable(
                    str(name), variable.dims, data=values, compression="gzip", compression_opts=4, dtype=values.dtype
                )
            else:
                put = file.create_variable(str(name), variable.dims, data=values, dtype=values.dtype)
            for key, value in variable.attrs.items():
                put.attrs[str(key)] = value
        for key, value in (data.attrs | attributes).items():
            file.attrs[str(key)] = value
    return memory.getvalue()


def _open(content: bytes, name: str) -> xarray.Dataset:
    """The data set in the bytes of a file, after everything that can be known of them without the library."""
    import xarray

    line = _LINE.fullmatch(content[-LINE:])
    if line is None:
        raise _without_digest(content, name)
    content = content[:-LINE]
    if hashlib.sha256(content).hexdigest() != line[2].decode():
        raise InputError(
            f"{name} is damaged: it is not what was written (its digest differs); take a copy of it, or run again."
        )
    if int(line[1]) != FORMAT:
        raise _unknown(name, int(line[1]))
    import h5py

    try:
        # What h5netcdf does first is tried without it: where that fails, its half-made file prints a traceback at its end.
        with h5py.File(io.BytesIO(content), "r") as bare:
            bare.attrs.get("_nc3_strict")
        with xarray.open_dataset(io.BytesIO(content), engine="h5netcdf", decode_times=False) as data:
            data.load()
    except Exception as error:  # libraries raise many kinds of errors for damaged files
        raise unreadable(name, error) from None
    return data


def _without_digest(content: bytes, name: str) -> InputError:
    """The error for a file that does not end as results do."""
    if content[:8] != b"\x89HDF\r\n\x1a\n":
        return InputError(f"{name} cannot be read as netCDF: it does not begin like one; give a file of this package.")
    number = _NUMBER.search(content)
    if number is None:
        return InputError(f"{name} is no result of this package, or damaged; give a file that this package wrote.")
    if int(number[1]) != FORMAT:
        return _unknown(name, int(number[1]))
    return InputError(f"{name} is damaged: its end is missing; take a copy of it, or run again.")


def _unknown(name: str, number: int) -> InputError:
    return InputError(
        f"{name} is of format {number}; this version of stylobate reads {FORMAT}: update it, or run again."
    )


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    return str(value)
