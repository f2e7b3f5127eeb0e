"""Damaged results: they are refused in one sentence, or are what was written; nothing hangs or crashes."""

from __future__ import annotations

import random
from functools import cache
from pathlib import Path

import numpy as np

import stylobate as st
from stylobate.column.catalogue import preset
from stylobate.errors import InputError
from stylobate.response import Response
from stylobate.response.assemblies import recorded_blocks
from stylobate.verdicts.domain import CollapseProbability, Domain

from .target import Fault, Target, sentence

KINDS = {"response": Response, "assembly": Response, "domain": Domain, "probability": CollapseProbability}


@cache
def written(name: str) -> bytes:
    """The bytes of a result."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        return _result(name).save(Path(folder) / "result.nc").read_bytes()


def _result(name: str):
    column = preset("paper-monolithic")
    if name == "response":
        return st.simulate(column, st.harmonic(1.0, 0.25 * st.g, 2.0), st.HousnerBlock())
    if name == "assembly":
        stone = st.Block(((0, 0), (1, 0), (1, 1), (0, 1)), 2000.0, "stone")
        assembly = st.Assembly((stone,), st.Joint(1e9, 5e8, friction_angle=30.0))
        time, places = np.linspace(0.0, 1.0, 50), np.random.default_rng(1).normal(size=(3, 50, 2))
        return Response.of(recorded_blocks(
            assembly, time, *places, {"input": time}, time, time, at_rest=True, failed=False, in_equilibrium=True,
            energy_imbalance=0.0, time_step=1e-3, steps=50, model="dem2d", provenance={"version": "0"},
        ))  # fmt: skip
    grid = (column, st.HousnerBlock(), (0.5, 1.0, 2.0), (1.0, 3.0, 5.0), 2.0)
    return st.collapse_domain(*grid) if name == "domain" else st.collapse_probability(*grid, replicates=3)


def damaged(rng: random.Random, content: bytes) -> bytes:
    """A file after an accident."""
    data = bytearray(content)
    for _ in range(rng.choice((1, 1, 1, 3, 30))):
        place, size = rng.randrange(max(1, len(data))), rng.choice((1, 4, 64, 512, 4096))
        kind = rng.choice(("bit", "bytes", "zeros", "cut", "missing", "twice", "moved"))
        if not data:
            break
        if kind == "bit":
            data[place] ^= 1 << rng.randrange(8)
        elif kind == "bytes":
            data[place : place + size] = rng.randbytes(len(data[place : place + size]))
        elif kind == "zeros":
            data[place : place + size] = bytes(len(data[place : place + size]))
        elif kind == "cut":
            del data[place:]
        elif kind == "missing":
            del data[place : place + size]
        elif kind == "twice":
            data[place:place] = data[place : place + size]
        else:
            other = rng.randrange(len(data))
            data[other : other + size] = data[place : place + len(data[other : other + size])]
    return bytes(data)


def attempt(rng: random.Random, folder: Path) -> str:
    """One damaged file."""
    name = rng.choice(sorted(KINDS))
    whole = written(name)
    content, path = damaged(rng, whole), folder / "result.nc"
    path.write_bytes(content)
    try:
        KINDS[name].load(path)
    except InputError as error:
        sentence(error)
        return "refused"
    if content != whole:
        raise Fault(f"{name}: a damaged file was read")
    return "read"


TARGET = Target("results", 2500, 40, attempt, limit=60.0)
