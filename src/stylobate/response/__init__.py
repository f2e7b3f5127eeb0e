"""What happened: responses, their measures, energy and files."""

from pathlib import Path

from .assembly_response import AssemblyResponse
from .measures import Measures
from .response import ENERGY_TERMS, Histories, Response

__all__ = ["ENERGY_TERMS", "AssemblyResponse", "Histories", "Measures", "Response", "load_response"]


def load_response(path: str | Path) -> Response | AssemblyResponse:
    """Read a response of either kind.

    Raises
    ------
    InputError
        There is no such file, or it is not a response.
    """
    from . import assembly_store, netcdf, store

    kind = netcdf.read(path, store.FORMAT, assembly_store.FORMAT).attrs["format"]
    return store.load(path) if kind == store.FORMAT else assembly_store.load(path)
