"""Twins: columns, or assemblies in space, that could as well stand there; drawn by the kind of what stands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .column import Column
from .scatter import Scatter, drawn_column
from .spatial.assembly import SpatialAssembly
from .spatial.scatter import drawn_assembly
from .structure import Structure

#: Makers of twin number k and the share of its offsets that is left, from what stands, a scatter and its stream, in space or
#: not, by the kind of what stands.
TWIN_OF: dict[str, Callable[..., tuple[Structure, float]]] = {
    Column.kind: drawn_column,
    SpatialAssembly.kind: drawn_assembly,
}


def twins_of(structure: Structure, scatter: Scatter, number: int, seed: int, *, space: bool = False) -> Sequence[Any]:
    """What could as well stand there.

    Twin k of a seed is the same for any ``number`` above k; where one part does not scatter, the others stay the same.

    Parameters
    ----------
    structure : Column or SpatialAssembly
    scatter : Scatter
    number, seed : int
    space : bool
        Offsets in any direction, for a model in space; along x otherwise.
    """
    return [one for one, _ in drawn_twins(structure, scatter, number, seed, space=space)]


def drawn_twins(
    structure: Structure,
    scatter: Scatter,
    number: int,
    seed: int,
    *,
    space: bool = False,
    stiffness: np.ndarray | None = None,
) -> list[tuple[Any, float]]:
    """The same, each with the share of its offsets that is left: below 1 where its stones would have overlapped.

    ``stiffness`` are draws of what the joints of each column have in common, where columns share them.
    """
    shared = [()] * number if stiffness is None else [(float(one),) for one in stiffness]
    return [drawn_twin(structure, scatter, k, seed, *shared[k], space=space) for k in range(number)]


def drawn_twin(
    structure: Structure, scatter: Scatter, k: int, seed: int, *shared: float, space: bool = False
) -> tuple[Any, float]:
    """Twin k of a seed alone, as :func:`drawn_twins` gives it: where there are many, each is made when it is asked for.

    ``shared`` is the draw of what its joints have in common, where columns share it.
    """
    stream = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(k,)))
    return TWIN_OF[structure.kind](structure, scatter, stream, k, space, *shared)
