"""What happened: responses, their measures, energy and files."""

from pathlib import Path

from .assembly_response import AssemblyResponse
from .measures import Measures
from .response import ENERGY_TERMS, Histories, Response

AnyResponse = Response | AssemblyResponse

__all__ = ["ENERGY_TERMS", "AnyResponse", "AssemblyResponse", "Histories", "Measures", "Response", "load_response"]


def load_response(path: str | Path) -> AnyResponse:
    """Read a response of either kind.

    Raises
    ------
    InputError
        There is no such file, or it is not a response.
    """
    from . import assembly_store, netcdf, store

    kind = netcdf.read(path, store.FORMAT, assembly_store.FORMAT).attrs["format"]
    return store.load(path) if kind == store.FORMAT else assembly_store.load(path)
