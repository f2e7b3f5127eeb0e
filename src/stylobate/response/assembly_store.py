"""Responses of assemblies as labelled data sets and netCDF files, and back without loss.

A file holds the poses of all bodies along ``time`` and ``body`` (by name), the energy ledger as ``energy_*``, the facts
of ``stylobate run --json`` as attributes, and the assembly and the provenance as JSON texts.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..column.assembly_files import assembly_from_dict
from ..errors import OutOfRangeWarning
from . import netcdf
from .assembly_response import AssemblyResponse

if TYPE_CHECKING:
    import xarray

#: Layout of the file; a reader refuses a number that it does not know.
FORMAT = "stylobate assembly response 1"

# name: dimensions, unit, meaning
_HISTORIES: dict[str, tuple[tuple[str, ...], str, str]] = {
    "x": (("time", "body"), "m", "horizontal place of the body's centroid relative to the base"),
    "z": (("time", "body"), "m", "height of the body's centroid relative to the base"),
    "rotation": (("time", "body"), "rad", "rotation of the body, counter-clockwise positive"),
    "ground_acceleration": (("time",), "m s-2", "horizontal acceleration of the base"),
    "ground_displacement": (("time",), "m", "horizontal displacement of the base"),
}

_FLAGS = ("at_rest", "failed")

_NUMBERS = {"energy_imbalance": "energy_imbalance", "time_step": "time_step_s", "wall_time": "wall_s"}


def to_dataset(response: AssemblyResponse) -> xarray.Dataset:
    """A response as a labelled data set.

    Returns
    -------
    xarray.Dataset
        Dimensions ``time`` [s] and ``body`` (names, the ground among them); each variable has its unit in ``units``;
        ``assembly`` and ``provenance`` are JSON texts.
    """
    import xarray

    variables: dict[str, Any] = {
        name: (dims, getattr(response, name), {"units": unit, "long_name": meaning})
        for name, (dims, unit, meaning) in _HISTORIES.items()
    }
    variables |= netcdf.energy_variables(response.energy)
    variables["assembly"] = ((), netcdf.as_json(response.assembly.to_dict()))
    variables["provenance"] = ((), netcdf.as_json(response.provenance))
    coordinates = {
        "time": ("time", response.time, {"units": "s", "long_name": "time"}),
        "body": ("body", [block.name for block in response.assembly.bodies], {"long_name": "name of the body"}),
    }
    attributes: dict[str, Any] = {"format": FORMAT, "model": response.model, "outcome": response.outcome.label}
    attributes |= {name: int(getattr(response, name)) for name in _FLAGS}
    attributes |= {name: float(getattr(response, field)) for field, name in _NUMBERS.items()}
    attributes["steps"] = int(response.steps)
    return xarray.Dataset(variables, coordinates, attributes)


def save(response: AssemblyResponse, path: str | Path) -> Path:
    """Write a response as netCDF; the file appears whole or not at all.

    Raises
    ------
    InputError
        The folder is missing or cannot be written to.
    """
    return netcdf.write(to_dataset(response), path)


def load(path: str | Path) -> AssemblyResponse:
    """Read a response that :func:`save` wrote.

    Raises
    ------
    InputError
        There is no such file, or it is not the response of an assembly.
    """
    data = netcdf.read(path, FORMAT)
    with warnings.catch_warnings():  # said when the assembly was made
        warnings.simplefilter("ignore", OutOfRangeWarning)
        assembly = assembly_from_dict(netcdf.from_json(data, "assembly"))
    facts: dict[str, Any] = {name: data[name].to_numpy() for name in _HISTORIES}
    facts |= {name: bool(data.attrs[name]) for name in _FLAGS}
    facts |= {field: float(data.attrs[name]) for field, name in _NUMBERS.items()}
    return AssemblyResponse(
        assembly=assembly,
        time=data["time"].to_numpy(),
        energy=netcdf.energy_of(data),
        steps=int(data.attrs["steps"]),
        provenance=netcdf.from_json(data, "provenance"),
        **facts,
    )
