"""Responses as labelled data sets and netCDF files, and back without loss.

A file holds the histories along ``time``, ``drum`` and ``joint`` (both numbered from 1 at the base), the energy ledger
as ``energy_*``, the measures as attributes under the names of ``stylobate run --json``, and the column and the
provenance as JSON texts.
"""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..column.files import column_from_dict
from ..errors import InputError, OutOfRangeWarning
from ..outcome import Outcome
from . import netcdf
from .measures import Measures
from .response import Histories, Response

if TYPE_CHECKING:
    import xarray

#: Layout of the file; a reader refuses a number that it does not know.
FORMAT = "stylobate response 1"

# name: dimensions, unit, meaning
_HISTORIES: dict[str, tuple[tuple[str, ...], str, str]] = {
    "drum_x": (("time", "drum"), "m", "horizontal displacement of the drum's centroid relative to the base"),
    "drum_z": (("time", "drum"), "m", "vertical displacement of the drum's centroid relative to the base"),
    "drum_rotation": (("time", "drum"), "rad", "rotation of the drum, counter-clockwise positive"),
    "joint_opening": (("time", "joint"), "m", "largest gap between the faces of the joint"),
    "joint_slip": (("time", "joint"), "m", "offset along the joint of the drum above it"),
    "base_displacement": (("time",), "m", "horizontal displacement of the lowest face relative to the base"),
    "top_displacement": (("time",), "m", "horizontal displacement of the topmost face relative to the base"),
    "ground_acceleration": (("time",), "m s-2", "horizontal acceleration of the base"),
    "ground_displacement": (("time",), "m", "horizontal displacement of the base"),
}

# field of Measures: attribute in the file, the same as in tables and JSON
_MEASURES = {
    "decided": "decided",
    "collapse_time": "collapse_time_s",
    "peak_top_displacement": "peak_top_displacement_m",
    "residual_top_displacement": "residual_top_displacement_m",
    "peak_rotation": "peak_rotation_rad",
    "peak_joint_opening": "peak_joint_opening_m",
    "residual_joint_slip": "residual_joint_slip_m",
    "energy_imbalance": "energy_imbalance",
    "time_step": "time_step_s",
    "steps": "steps",
    "reason": "reason",
}


def to_dataset(response: Response) -> xarray.Dataset:
    """A response as a labelled data set.

    Returns
    -------
    xarray.Dataset
        Dimensions ``time`` [s], ``drum`` and ``joint`` (numbers from 1 at the base); each variable has its unit in
        ``units``; measures are attributes; ``column`` and ``provenance`` are JSON texts.
    """
    import xarray

    h, n = response.histories, response.column.n
    variables: dict[str, Any] = {
        name: (dims, getattr(h, name), {"units": unit, "long_name": meaning})
        for name, (dims, unit, meaning) in _HISTORIES.items()
    }
    variables |= netcdf.energy_variables(h.energy)
    variables["column"] = ((), netcdf.as_json(response.column.to_dict()))
    variables["provenance"] = ((), netcdf.as_json(response.provenance))
    numbers = np.arange(1, n + 1)
    coordinates = {
        "time": ("time", h.time, {"units": "s", "long_name": "time"}),
        "drum": ("drum", numbers, {"long_name": "drum, numbered from the bottom"}),
        "joint": ("joint", numbers, {"long_name": "joint under the drum of that number"}),
    }
    m = response.measures
    attributes: dict[str, Any] = {"format": FORMAT, "model": response.model, "wall_s": float(response.wall_time)}
    attributes |= {"outcome": m.outcome.label}
    for field, name in _MEASURES.items():
        value = getattr(m, field)
        attributes[name] = int(value) if isinstance(value, (bool, np.bool_, np.integer)) else value
    return xarray.Dataset(variables, coordinates, attributes)


def save(response: Response, path: str | Path) -> Path:
    """Write a response as netCDF; the file appears whole or not at all.

    Raises
    ------
    InputError
        The folder is missing or cannot be written to.
    """
    return netcdf.write(to_dataset(response), path)


def load(path: str | Path) -> Response:
    """Read a response that :func:`save` wrote.

    Raises
    ------
    InputError
        There is no such file, or it is not a response.
    """
    data = netcdf.read(path, FORMAT)
    histories = Histories(
        time=data["time"].to_numpy(),
        energy=netcdf.energy_of(data),
        **{name: data[name].to_numpy() for name in _HISTORIES},
    )
    with warnings.catch_warnings():  # said when the column was made
        warnings.simplefilter("ignore", OutOfRangeWarning)
        column = column_from_dict(netcdf.from_json(data, "column"))
    return Response(
        column=column,
        histories=histories,
        measures=_measures(data.attrs),
        model=data.attrs["model"],
        provenance=netcdf.from_json(data, "provenance"),
        wall_time=float(data.attrs["wall_s"]),
    )


def read_provenance(path: str | Path) -> dict[str, Any]:
    """Provenance of any netCDF file of this package: a response of a column or an assembly, a domain, probabilities.

    Raises
    ------
    InputError
        There is no such file, or it holds no provenance.
    """
    import xarray

    try:
        with xarray.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
            text = data.attrs["provenance"] if "provenance" in data.attrs else data["provenance"].item()
        return dict(json.loads(str(text)))
    except FileNotFoundError:
        raise InputError(f"there is no file {path}.") from None
    except (OSError, KeyError, ValueError) as error:
        raise InputError(
            f"{path} holds no provenance that can be read ({error}); give a netCDF file of this package, such as "
            "response.nc."
        ) from None


def _measures(attributes: dict[str, Any]) -> Measures:
    values: dict[str, Any] = {field: attributes[name] for field, name in _MEASURES.items()}
    for field, value in values.items():
        if isinstance(value, np.generic):
            values[field] = value.item()
    values["decided"] = bool(values["decided"])
    return Measures(outcome=Outcome[attributes["outcome"].upper()], **values)
