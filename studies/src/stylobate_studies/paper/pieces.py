"""Pieces of the study as files: each is computed once, and a study that was stopped goes on with the next.

A piece is written whole when it is finished; the runs of all pieces are kept in one ledger beside them.
"""

from __future__ import annotations

import base64
import json
import time
from contextlib import closing
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate import store
from stylobate.atomic import replacing
from stylobate.campaign.campaign import Campaign, Progress
from stylobate.campaign.digests import Digests, Hasher
from stylobate.campaign.ledger import RUNS_FILE
from stylobate.campaign.runs import Request, Runs
from stylobate.column import Column, preset
from stylobate.constants import g
from stylobate.models.base import Case, Model
from stylobate.motion import harmonic
from stylobate.motion.pulses import MotionScatter
from stylobate.simulate import run_options, simulate, simulate_many
from stylobate.verdicts import verdict as v
from stylobate.verdicts.domain import (
    CollapseProbability,
    Domain,
    collapse_domain,
    collapse_probability,
    grid_coordinates,
)
from stylobate.version import __version__

from . import cases as c
from .folder import is_ready

if TYPE_CHECKING:
    import xarray


#: File of a population in the folder of its piece.
POPULATION = "probability.nc"


def domain_piece(
    folder: Path, column: Column, model: Model, grid: tuple, tail: float, threads: int, progress: Progress | None
) -> Domain:
    """A domain; ``grid`` is (frequencies, amplitudes, duration)."""
    place = folder / "domain.nc"
    if is_ready(place):
        return Domain.load(place)
    folder.mkdir(exist_ok=True)
    keeping = {"out": folder, "ledger": folder.parent / RUNS_FILE}
    domain = collapse_domain(column, model, *grid, tail=tail, threads=threads, progress=progress, **keeping)
    if not domain.complete:
        raise KeyboardInterrupt
    return domain


def population_piece(
    folder: Path, column: Column, model: Model, grid: tuple, replicates: int, tail: float, threads: int,
    progress: Progress | None, motion_scatter: MotionScatter | None = None,
) -> CollapseProbability:  # fmt: skip
    """The same domain for slightly different columns, within 1 % in geometry, friction and stiffness."""
    place = folder / POPULATION
    if is_ready(place):
        return CollapseProbability.load(place)
    folder.mkdir(exist_ok=True)
    keeping = {"out": folder, "ledger": folder.parent / RUNS_FILE}
    population = collapse_probability(
        column, model, *grid, replicates=replicates, scatter=c.ALIKE, motion_scatter=motion_scatter, tail=tail,
        threads=threads, progress=progress, **keeping,
    )  # fmt: skip
    if not population.complete:
        raise KeyboardInterrupt
    return population


def histories_piece(
    data: Path, name: str, label: str, tail: float, threads: int, progress: Progress | None
) -> xarray.Dataset:
    """Histories and verdicts of the thirty cases."""
    import xarray

    place = data / f"{slug('histories', name, label)}.nc"
    if is_ready(place):
        return store.read(place, "study histories")
    column, model = preset(name), c.MODELS[label]
    end = c.DURATION + tail
    time = np.linspace(0.0, end, 1 + round(50 * end))
    cells = list(product(range(len(c.FREQUENCIES)), range(len(c.AMPLITUDES))))
    shape = (len(c.FREQUENCIES), len(c.AMPLITUDES))
    curves = {
        quantity: np.full((*shape, len(time)), np.nan, dtype=np.float32) for quantity in ("base", "top", "ground")
    }
    facts = {quantity: np.full(shape, np.nan) for quantity in ("collapse_time", "peak_top", "peak_base")}
    flags = np.zeros(shape, dtype=np.int8)

    motions = [harmonic(c.FREQUENCIES[i], c.AMPLITUDES[j], c.DURATION) for i, j in cells]

    def make(number: int) -> dict[str, Any]:
        response = simulate(column, motions[number], model, tail=tail, output_interval=0.02)
        h, m = response.histories, response.measures
        given = {"base": h.base_displacement, "top": h.top_displacement, "ground": h.ground_displacement}
        drawn = {key: np.interp(time, h.time, values, right=np.nan) for key, values in given.items()}
        return {
            **{key: base64.b64encode(values.astype("<f4").tobytes()).decode() for key, values in drawn.items()},
            "collapse_time": float(m.collapse_time),
            "peak_top": float(m.peak_top_displacement),
            "peak_base": float(np.abs(h.base_displacement).max()),
            "verdict": v.VERDICTS.index(v.verdict(m.row())),
        }

    def keep(number: int, row: dict) -> None:
        for key, values in curves.items():
            values[cells[number]] = np.frombuffer(base64.b64decode(row[key]), dtype="<f4")
        for key, values in facts.items():
            values[cells[number]] = row[key]
        flags[cells[number]] = row["verdict"]

    options = run_options(tail, 0.02)
    hasher, cases = Hasher(model, options), [Case(column, motion) for motion in motions]
    each = Digests.of([hasher.of_product([column.digest, motion.digest], __file__) for motion in motions])
    request = Request(cases, each, [(np.arange(len(cases)), model, options)])
    with (
        closing(Runs(Campaign(ledger=data / RUNS_FILE))) as runs,
        closing(runs.products(request, make, threads)) as finished,
    ):
        for done, (number, row) in enumerate(finished, 1):
            keep(number, row)
            if progress:
                progress(done, len(cells))
    dims = ("frequency", "amplitude")
    variables: dict[str, Any] = {
        quantity: ((*dims, "time"), values, {"units": "m"}) for quantity, values in curves.items()
    }
    variables |= {
        quantity: (dims, values, {"units": "s" if "time" in quantity else "m"}) for quantity, values in facts.items()
    }
    variables["verdict"] = (dims, flags, v.FLAGS)
    coordinates = grid_coordinates(c.FREQUENCIES, c.AMPLITUDES) | {"time": ("time", time, {"units": "s"})}
    note = "displacements of base and top relative to the ground, and of the ground"
    attributes = {"column": name, "model": label, "version": __version__, "note": note, "duration_s": c.DURATION}
    data_set = xarray.Dataset(variables, coordinates, attributes)
    store.write(data_set, "study histories", place)
    return data_set


def cost_piece(data: Path) -> dict[str, float]:
    """Time of each model for two seconds of a shaken column of drums in a batch on one core [s]."""
    place = data / "cost.json"
    if not is_ready(place):
        shaking = [harmonic(1.5, amplitude, 2.0) for amplitude in np.linspace(0.25, 0.3, 16) * g]
        seconds = {
            label: min(_seconds(shaking, c.MODELS[label]) for _ in range(3)) for label in (c.BEAM, c.BLOCKS, c.DEM)
        }
        seconds[c.SPACE] = min(_seconds(shaking, c.POPULATIONS[c.SPACE], "circular") for _ in range(3))
        with replacing(place) as partial:
            partial.write_text(json.dumps(seconds), encoding="utf-8")
    return json.loads(place.read_text(encoding="utf-8"))


def _seconds(shaking: list, model: Model, section: str = "rectangular") -> float:
    started = time.perf_counter()
    simulate_many(c.paper_column(c.DRUMS, section), shaking, model, threads=1)
    return (time.perf_counter() - started) / len(shaking)


def slug(*parts: str) -> str:
    """Name of a file for a piece."""
    plain = {"ξ": "xi", "β": "beta", "φ": "phi", "α": "alpha", "/": "over"}
    text = "-".join(parts).lower()
    for old, new in plain.items():
        text = text.replace(old, new)
    return "-".join("".join(c if (c.isalnum() and c.isascii()) or c == "." else " " for c in text).split())
