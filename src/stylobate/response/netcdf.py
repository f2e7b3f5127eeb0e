"""Files of responses as netCDF: written whole or not at all, read with one sentence about what is wrong."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..atomic import replacing
from ..errors import InputError

if TYPE_CHECKING:
    import xarray

#: Terms of the energy ledger have this before their names.
ENERGY = "energy_"


def write(data: xarray.Dataset, path: str | Path) -> Path:
    """Write a data set, its arrays compressed; the file appears whole or not at all."""
    target = Path(path)
    encoding = {name: {"zlib": True, "complevel": 4} for name, values in data.data_vars.items() if values.ndim}
    with replacing(target) as partial:
        data.to_netcdf(partial, engine="h5netcdf", encoding=encoding)
    return target


def read(path: str | Path, *formats: str) -> xarray.Dataset:
    """Read a data set of one of these formats.

    Raises
    ------
    InputError
        There is no such file, or it is none of these.
    """
    import xarray

    try:
        with xarray.open_dataset(path, engine="h5netcdf", decode_times=False) as opened:
            data = opened.load()
    except FileNotFoundError:
        raise InputError(f"there is no file {path}.") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{path} cannot be read as netCDF: {error}.") from None
    found = data.attrs.get("format")
    if found not in formats:
        wanted = " or ".join(repr(one) for one in formats)
        raise InputError(
            f"{path} has the format {found!r}, not {wanted}; give a file of that kind, as 'stylobate run --out' writes it."
        )
    return data


def energy_variables(energy: dict[str, np.ndarray]) -> dict[str, Any]:
    """The ledger as variables along ``time``."""
    return {
        ENERGY + term: (("time",), values, {"units": "J", "long_name": f"energy ledger: {term}"})
        for term, values in energy.items()
    }


def energy_of(data: xarray.Dataset) -> dict[str, np.ndarray]:
    """The ledger of a data set."""
    return {
        str(name).removeprefix(ENERGY): values.to_numpy()
        for name, values in data.data_vars.items()
        if str(name).startswith(ENERGY)
    }


def as_json(value: Any) -> str:
    """Plain values as a JSON text."""
    return json.dumps(value, default=_plain)


def from_json(data: xarray.Dataset, name: str) -> Any:
    """The plain values in a JSON text of a data set."""
    return json.loads(str(data[name].item()))


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    return str(value)
