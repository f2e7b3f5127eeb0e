"""Kinds of structures by their word: how each is made again from the plain values that it has given."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .assembly import Assembly
from .assembly_files import assembly_from_dict
from .column import Column
from .files import column_from_dict
from .spatial.assembly import SpatialAssembly
from .specimen import Specimen
from .structure import Structure

#: Makers of a structure from what its ``to_dict`` gives, by its kind.
FROM_DICT: dict[str, Callable[[Any], Structure]] = {
    Column.kind: column_from_dict,
    Assembly.kind: assembly_from_dict,
    Specimen.kind: Specimen.from_dict,
    SpatialAssembly.kind: SpatialAssembly.from_dict,
}
