"""Pieces of the study as files: each is computed once, and a study that was stopped goes on with the next.

A piece is written whole when it is finished. Domains and populations keep their finished runs besides.
"""

from __future__ import annotations

import dataclasses
import json
import shutil
import time
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..analysis import verdicts as v
from ..analysis.domain import Domain, collapse_domain
from ..analysis.probability import CollapseProbability
from ..analysis.replicates import collapse_probability
from ..atomic import replacing
from ..campaign.ledger import PROGRESS_FILE, discard
from ..campaign.runner import Progress
from ..column import Column, preset
from ..column.presets import PRESETS
from ..constants import g
from ..errors import InputError
from ..kernels.jit import source_digest
from ..models.base import Model
from ..motion import harmonic
from ..simulate import simulate, simulate_many
from ..version import __version__
from . import cases as c

if TYPE_CHECKING:
    import xarray


def claim(data: Path, grids: c.Grids) -> None:
    """Say in the folder which study it holds.

    Pieces of another version of the code are of no use to this one: they are removed, and computed anew.

    Raises
    ------
    InputError
        The folder holds a study on other grids.
    """
    grid = {name: np.asarray(value).tolist() for name, value in dataclasses.asdict(grids).items()}
    code = {
        "version": __version__,
        "kernels": source_digest(),
        "models": {label: [model.name, model.parameters()] for label, model in c.MODELS.items()},
        "variants": {name: [model.parameters(), change, time] for name, (_, model, change, time) in c.VARIANTS.items()},
        "columns": {name: preset(name).digest for name in PRESETS},
        "cases": [c.FREQUENCIES.tolist(), c.AMPLITUDES.tolist(), c.DURATION],
    }
    place = data / "study.json"
    for one in (data, *data.iterdir()):
        sweep(one)
    if place.exists():
        found = json.loads(place.read_text(encoding="utf-8"))
        if found.get("grids") != grid:
            raise InputError(
                f"{data.parent} holds another study (quick or full); choose another folder, or delete it to compute "
                "anew."
            )
        if found.get("code") == json.loads(json.dumps(code)):
            return
        shutil.rmtree(data)
        data.mkdir()
    with replacing(place) as partial:
        partial.write_text(json.dumps({"grids": grid, "code": code}, indent=1, sort_keys=True), encoding="utf-8")


def sweep(folder: Path) -> None:
    """Remove files that a killed run left half-written; their names start with a dot."""
    for left in folder.glob(".*-*.*"):
        left.unlink()


def domain_piece(
    folder: Path, column: Column, model: Model, grid: tuple, tail: float, threads: int, progress: Progress | None
) -> Domain:
    """A domain; ``grid`` is (frequencies, amplitudes, duration)."""
    place = folder / "domain.nc"
    if place.exists():
        discard(folder / PROGRESS_FILE)  # left over where it was killed between the two
        return Domain.load(place)
    folder.mkdir(exist_ok=True)
    found = collapse_domain(column, model, *grid, tail=tail, threads=threads, progress=progress, out=folder)
    if not found.complete:
        raise KeyboardInterrupt
    return found


def population_piece(
    folder: Path, column: Column, model: Model, grid: tuple, replicates: int, tail: float, threads: int,
    progress: Progress | None,
) -> CollapseProbability:  # fmt: skip
    """The same domain for slightly different columns, 1 % in geometry, friction and stiffness."""
    place = folder / "probability.nc"
    if place.exists():
        discard(folder / PROGRESS_FILE)
        return CollapseProbability.load(place)
    folder.mkdir(exist_ok=True)
    found = collapse_probability(
        column, model, *grid, replicates=replicates, tail=tail, threads=threads, progress=progress, out=folder
    )
    if not found.complete:
        raise KeyboardInterrupt
    return found


def histories_piece(
    data: Path, name: str, label: str, tail: float, threads: int, progress: Progress | None
) -> xarray.Dataset:
    """Histories and verdicts of the thirty cases."""
    import xarray

    place = data / f"{slug('histories', name, label)}.nc"
    if place.exists():
        with xarray.open_dataset(place, engine="h5netcdf") as found:
            return found.load()
    column, model = preset(name), c.MODELS[label]
    end = c.DURATION + tail
    time = np.linspace(0.0, end, 1 + round(50 * end))
    cells = list(product(range(len(c.FREQUENCIES)), range(len(c.AMPLITUDES))))
    shape = (len(c.FREQUENCIES), len(c.AMPLITUDES))
    curves = {one: np.full((*shape, len(time)), np.nan, dtype=np.float32) for one in ("base", "top", "ground")}
    facts = {one: np.full(shape, np.nan) for one in ("collapse_time", "peak_top", "peak_base")}
    flags = np.zeros(shape, dtype=np.int8)

    def run(cell: tuple[int, int]) -> None:
        motion = harmonic(c.FREQUENCIES[cell[0]], c.AMPLITUDES[cell[1]], c.DURATION)
        response = simulate(column, motion, model, tail=tail, output_interval=0.02)
        h, m = response.histories, response.measures
        for key, values in (
            ("base", h.base_displacement),
            ("top", h.top_displacement),
            ("ground", h.ground_displacement),
        ):
            curves[key][cell] = np.interp(time, h.time, values, right=np.nan)
        facts["collapse_time"][cell] = m.collapse_time
        facts["peak_top"][cell] = m.peak_top_displacement
        facts["peak_base"][cell] = np.abs(h.base_displacement).max()
        flags[cell] = v.VERDICTS.index(v.verdict(m.row()))

    run(cells[0])  # compiles what all of them share
    with ThreadPoolExecutor(threads) as pool:
        for done, _ in enumerate(pool.map(run, cells[1:]), 2):
            if progress:
                progress(done, len(cells))
    dims = ("frequency", "amplitude")
    variables: dict[str, Any] = {one: ((*dims, "time"), values, {"units": "m"}) for one, values in curves.items()}
    variables |= {one: (dims, values, {"units": "s" if "time" in one else "m"}) for one, values in facts.items()}
    meanings = " ".join(one.replace(" ", "_") for one in v.VERDICTS)
    variables["verdict"] = (dims, flags, {"flag_values": np.arange(5, dtype=np.int8), "flag_meanings": meanings})
    coordinates = {
        "frequency": ("frequency", c.FREQUENCIES, {"units": "Hz"}),
        "amplitude": ("amplitude", c.AMPLITUDES, {"units": "m s-2"}),
        "time": ("time", time, {"units": "s"}),
    }
    note = "displacements of base and top relative to the ground, and of the ground"
    attributes = {"column": name, "model": label, "version": __version__, "note": note, "duration_s": c.DURATION}
    data_set = xarray.Dataset(variables, coordinates, attributes)
    with replacing(place) as partial:
        data_set.to_netcdf(partial, engine="h5netcdf")
    return data_set


def cost_piece(data: Path) -> dict[str, float]:
    """What two seconds of a shaken column of drums cost each model in a batch on one core [s]."""
    place = data / "cost.json"
    if not place.exists():
        shaking = [harmonic(1.5, amplitude, 2.0) for amplitude in np.linspace(0.25, 0.3, 16) * g]
        found = {label: min(_seconds(shaking, c.MODELS[label]) for _ in range(3)) for label in (c.BEAM, c.DEM)}
        with replacing(place) as partial:
            partial.write_text(json.dumps(found), encoding="utf-8")
    return json.loads(place.read_text(encoding="utf-8"))


def _seconds(shaking: list, model: Model) -> float:
    started = time.perf_counter()
    simulate_many(preset(c.DRUMS), shaking, model, threads=1)
    return (time.perf_counter() - started) / len(shaking)


def slug(*parts: str) -> str:
    """Name of a file for a piece."""
    plain = {"ξ": "xi", "β": "beta", "φ": "phi", "α": "alpha", "/": "over"}
    text = "-".join(parts).lower()
    for old, new in plain.items():
        text = text.replace(old, new)
    return "-".join("".join(c if (c.isalnum() and c.isascii()) or c == "." else " " for c in text).split())
