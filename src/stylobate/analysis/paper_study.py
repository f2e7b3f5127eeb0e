"""The study of Baraldi, Sarhosis and Milani, recomputed: its columns, models, motions and grids, piece by piece.

Every finished piece is a file in the study's folder, so that a study that was stopped goes on where it was.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .. import __version__
from ..atomic import replacing
from ..campaign.runner import Progress
from ..column import Column, preset
from ..column.presets import PRESETS
from ..constants import g
from ..errors import InputError
from ..kernels import moment_law
from ..kernels.jit import source_digest
from ..models.base import Model
from ..models.distinct_element_2d import DistinctElement2D
from ..models.rigid_beam import RigidBeam
from ..models.rigid_block import RigidBlock
from ..motion import harmonic
from ..simulate import simulate, thread_count
from . import verdicts as v
from .domain import Domain, collapse_domain
from .limit import limit_analysis
from .pushover import PushoverResult, pushover

if TYPE_CHECKING:
    import xarray

#: The thirty harmonic cases. The paper prints the ranges, 0.66 to 4 Hz and 0.1 g to 0.5 g; the values are chosen here.
FREQUENCIES = np.array([0.66, 1.0, 1.5, 2.0, 3.0, 4.0])
AMPLITUDES = np.array([0.1, 0.2, 0.3, 0.4, 0.5]) * g

#: Length of every motion [s]; the paper prints none.
DURATION = 10.0

MONOLITH, DRUMS = PRESETS
BEAM, SLIDING, BLOCKS, DEM = "rigid beam (paper)", "rigid beam with sliding", "rigid block", "distinct elements"

MODELS: Mapping[str, Model] = {
    BEAM: RigidBeam.paper(),
    SLIDING: RigidBeam(sliding=True),
    BLOCKS: RigidBlock(),
    DEM: DistinctElement2D(),
}

#: Open parameters, one changed at a time: what is changed, the model, and the changes of column and duration.
VARIANTS: Mapping[str, tuple[str, Model, dict, float]] = {
    "beam, as the paper": (BEAM, RigidBeam.paper(), {}, DURATION),
    "beam, ξ = 0.9": (BEAM, RigidBeam.paper(moment_law="trilinear", xi=0.9), {}, DURATION),
    "beam, ξ = 0.8": (BEAM, RigidBeam.paper(moment_law="trilinear", xi=0.8), {}, DURATION),
    "beam, K_M / 10": (BEAM, RigidBeam.paper(), {"normal_stiffness": 5.0e9}, DURATION),
    "beam, law in relative rotations": (BEAM, RigidBeam.paper(rotation="relative"), {}, DURATION),
    "beam, α of the whole stack": (BEAM, RigidBeam.paper(rotation="relative", critical_angle="stack"), {}, DURATION),
    "beam, gravity in the equations": (
        BEAM,
        RigidBeam(moment_law="bilinear", idealisation="prism"),
        {},
        DURATION,
    ),
    "beam, true drums": (BEAM, RigidBeam(), {}, DURATION),
    "beam, β = 0.1 ms": (BEAM, RigidBeam.paper(stiffness_damping=1e-4), {}, DURATION),
    "beam, β = 0.5 ms": (BEAM, RigidBeam.paper(stiffness_damping=5e-4), {}, DURATION),
    "beam, 5 s": (BEAM, RigidBeam.paper(), {}, 5.0),
    "beam, 20 s": (BEAM, RigidBeam.paper(), {}, 20.0),
    "beam with sliding": (SLIDING, RigidBeam(sliding=True), {}, DURATION),
    "beam with sliding, tan φ = 10": (SLIDING, RigidBeam(sliding=True), {"friction_coefficient": 10.0}, DURATION),
    "rigid block": (BLOCKS, RigidBlock(), {}, DURATION),
    "DEM, two points": (DEM, DistinctElement2D(), {}, DURATION),
    "DEM, five points": (DEM, DistinctElement2D(points=5), {}, DURATION),
    "DEM, tan φ = 0.5": (DEM, DistinctElement2D(), {"friction_coefficient": 0.5}, DURATION),
    "DEM, tan φ = 10": (DEM, DistinctElement2D(), {"friction_coefficient": 10.0}, DURATION),
    "DEM, elastic blocks": (DEM, DistinctElement2D(block_modulus=2.5e9), {}, DURATION),
    "DEM, β = 0.1 ms": (DEM, DistinctElement2D(stiffness_damping=1e-4), {}, DURATION),
    "DEM, 5 s": (DEM, DistinctElement2D(), {}, 5.0),
    "DEM, 20 s": (DEM, DistinctElement2D(), {}, 20.0),
}

#: Left out of the coarse study: their loops are compiled for them alone.
SLOW_VARIANTS = ("DEM, five points", "DEM, β = 0.1 ms", "beam, β = 0.1 ms", "DEM, 20 s")

#: Says (what is being computed, finished, all).
Report = Callable[[str, int, int], None]


@dataclass(frozen=True)
class Grids:
    """How fine the study is.

    Parameters
    ----------
    frequencies, amplitudes : array
        Of the domains [Hz], [m/s²].
    tail : float
        Time after each motion of the domains [s].
    circular : tuple of str
        Models whose domains are computed for the circular columns as well.
    variants : tuple of str
        Names of :data:`VARIANTS` that are computed.
    variant_frequencies, variant_amplitudes : array
        Of the domains with one parameter changed.
    limit_amplitudes : array
        At 0.1 Hz, where a column overturns as if the forces were static [m/s²].
    """

    frequencies: np.ndarray
    amplitudes: np.ndarray
    tail: float
    circular: tuple[str, ...]
    variants: tuple[str, ...]
    variant_frequencies: np.ndarray
    variant_amplitudes: np.ndarray
    limit_amplitudes: np.ndarray

    @classmethod
    def of(cls, quick: bool) -> Grids:
        """The coarse or the fine study."""
        limit = np.arange(0.140, 0.2401, 0.002) * g
        if quick:
            some = tuple(name for name in VARIANTS if name not in SLOW_VARIANTS)
            return cls(
                np.linspace(0.25, 4.0, 16), np.linspace(0.1, 0.5, 17) * g, 0.0, (BEAM,), some,
                np.array([0.66, 1.0, 2.0]), np.linspace(0.12, 0.6, 13) * g, limit,
            )  # fmt: skip
        return cls(
            np.linspace(0.2, 4.0, 39), np.linspace(0.1, 0.6, 41) * g, 5.0, (BEAM, BLOCKS, DEM), tuple(VARIANTS),
            np.array([0.33, 0.66, 1.0, 1.5, 2.0]), np.linspace(0.12, 0.6, 25) * g, limit,
        )  # fmt: skip


@dataclass(eq=False)
class PaperResults:
    """Everything that the study has computed.

    Parameters
    ----------
    grids : Grids
    quick : bool
    domains : dict
        By (column, model, section), e.g. ("paper-12-drums", "rigid block", "rectangular").
    histories : dict
        By (column, model): data sets over frequency, amplitude and time.
    variants : dict
        By (column, variant).
    limits : dict
        By (column, model): domains of one very low frequency, finely stepped.
    paths : dict
        Pushover paths by (column, section).
    """

    grids: Grids
    quick: bool
    domains: dict[tuple[str, str, str], Domain] = field(default_factory=dict)
    histories: dict[tuple[str, str], xarray.Dataset] = field(default_factory=dict)
    variants: dict[tuple[str, str], Domain] = field(default_factory=dict)
    limits: dict[tuple[str, str], Domain] = field(default_factory=dict)
    paths: dict[tuple[str, str], PushoverResult] = field(default_factory=dict)


def paper_column(name: str, section: str = "rectangular") -> Column:
    """One of the paper's columns; ``circular`` turns its widths into diameters."""
    column = preset(name)
    if section == "rectangular":
        return column
    drums = tuple(dataclasses.replace(drum, section=section) for drum in column.drums)
    return column.replace(drums=drums, name=f"{name}, {section}")


def run_study(
    folder: Path, quick: bool, threads: int | None = None, report: Report | None = None, grids: Grids | None = None
) -> PaperResults:
    """Compute what the folder does not hold yet.

    Parameters
    ----------
    folder : path
        Holds the pieces, in ``data``; it must exist.
    quick : bool
        The coarse study.
    threads : int, optional
        All cores by default.
    report : callable, optional
        Called with (what is being computed, finished, all).
    grids : Grids, optional
        Other grids than those of ``quick``.

    Raises
    ------
    InputError
        The folder holds another study, or one of another version.
    KeyboardInterrupt
        It was stopped; what is finished is kept.
    """
    grids = Grids.of(quick) if grids is None else grids
    data = folder / "data"
    data.mkdir(exist_ok=True)
    _claim(data, grids)
    found, count = PaperResults(grids, quick), thread_count(threads)

    def advance(what: str) -> Progress | None:
        if report is None:
            return None
        tell = report
        return lambda done, total: tell(what, done, total)

    for name, label in product(PRESETS, (BEAM, DEM)):
        found.histories[name, label] = _histories(data, name, label, count, advance(f"histories, {name}, {label}"))
    for name in PRESETS:
        for label, section in [(one, "rectangular") for one in MODELS] + [(one, "circular") for one in grids.circular]:
            grid = (grids.frequencies, grids.amplitudes, DURATION)
            found.domains[name, label, section] = _domain(
                data / slug("domain", name, label, section), paper_column(name, section), MODELS[label], grid,
                grids.tail, count, advance(f"domain, {name}, {label}, {section}"),
            )  # fmt: skip
        for label in (BEAM, BLOCKS, DEM):
            grid = (np.array([0.1]), grids.limit_amplitudes, 20.0)
            found.limits[name, label] = _domain(
                data / slug("limit", name, label), preset(name), MODELS[label], grid, 0.0, count,
                advance(f"low frequency, {name}, {label}"),
            )  # fmt: skip
        for variant in grids.variants:
            _, model, change, duration = VARIANTS[variant]
            column = preset(name).with_joint(**change) if change else preset(name)
            grid = (grids.variant_frequencies, grids.variant_amplitudes, duration)
            found.variants[name, variant] = _domain(
                data / slug("variant", name, variant), column, model, grid, 0.0, count,
                advance(f"sensitivity, {name}, {variant}"),
            )  # fmt: skip
        for section in ("rectangular", "circular"):
            found.paths[name, section] = pushover(paper_column(name, section))
    return found


def static_values() -> dict[str, float]:
    """Numbers that need no campaign: multipliers of pushover and limit analysis [g]."""
    values = {"prism": limit_analysis(preset(MONOLITH).as_prism()).multiplier}
    for name, section in product(PRESETS, ("rectangular", "circular")):
        column = paper_column(name, section)
        values[f"limit, {name}, {section}"] = limit_analysis(column).multiplier
        values[f"pushover, {name}, {section}"] = pushover(column).collapse_multiplier
    return values


def joint_law(model: RigidBeam, column: Column, joint: int, rotation: np.ndarray) -> np.ndarray:
    """Moment of a joint (from 1) of the rigid beam for given rotations [N m], shape of ``rotation`` [rad]."""
    seen = model.idealised(column)
    if model.moment_law == "housner":
        half = 0.5 * seen.joint_widths[joint - 1] * seen.joint_weights[joint - 1]
        return np.sign(rotation) * half * (1.0 - np.abs(rotation) / model.critical_angles(seen)[joint - 1])
    numbers = np.repeat(model.joints(seen)[:, joint - 1 : joint], rotation.size, axis=1)
    out = np.empty(rotation.size)
    moment_law.moments(np.ascontiguousarray(rotation, dtype=float), 1.0, numbers, model.bed(seen), out)
    return out


def slug(*parts: str) -> str:
    """Name of a file for a piece."""
    plain = {"ξ": "xi", "β": "beta", "φ": "phi", "α": "alpha", "/": "over"}
    text = "-".join(parts).lower()
    for old, new in plain.items():
        text = text.replace(old, new)
    return "-".join("".join(c if (c.isalnum() and c.isascii()) or c == "." else " " for c in text).split())


# -- pieces -----------------------------------------------------------------------------------------------------------


def _claim(data: Path, grids: Grids) -> None:
    """Say in the folder which study it holds; refuse a folder that holds another one."""
    key = {
        "version": __version__,
        "kernels": source_digest(),
        "models": {label: [model.name, model.parameters()] for label, model in MODELS.items()},
        "variants": {name: [model.parameters(), change, time] for name, (_, model, change, time) in VARIANTS.items()},
        "columns": {name: preset(name).digest for name in PRESETS},
        "grids": {name: np.asarray(value).tolist() for name, value in dataclasses.asdict(grids).items()},
    }
    text, place = json.dumps(key, indent=1, sort_keys=True), data / "study.json"
    if place.exists():
        if place.read_text(encoding="utf-8") != text:
            raise InputError(
                f"{data.parent} holds another study (quick or full, or of another version); "
                "choose another folder, or delete it to compute anew."
            )
        return
    with replacing(place) as partial:
        partial.write_text(text, encoding="utf-8")


def _domain(
    folder: Path, column: Column, model: Model, grid: tuple, tail: float, threads: int, progress: Progress | None
) -> Domain:
    place = folder / "domain.nc"
    if place.exists():
        return Domain.load(place)
    folder.mkdir(exist_ok=True)
    found = collapse_domain(column, model, *grid, tail=tail, threads=threads, progress=progress, out=folder)
    if not found.complete:
        raise KeyboardInterrupt
    return found


def _histories(data: Path, name: str, label: str, threads: int, progress: Progress | None) -> xarray.Dataset:
    import xarray

    place = data / f"{slug('histories', name, label)}.nc"
    if place.exists():
        with xarray.open_dataset(place, engine="h5netcdf") as found:
            return found.load()
    column, model = preset(name), MODELS[label]
    time = np.linspace(0.0, DURATION, 501)
    cells = list(product(range(len(FREQUENCIES)), range(len(AMPLITUDES))))
    shape = (len(FREQUENCIES), len(AMPLITUDES))
    curves = {one: np.full((*shape, len(time)), np.nan, dtype=np.float32) for one in ("base", "top", "ground")}
    facts = {one: np.full(shape, np.nan) for one in ("collapse_time", "peak_top", "peak_base")}
    flags = np.zeros(shape, dtype=np.int8)

    def run(cell: tuple[int, int]) -> None:
        motion = harmonic(FREQUENCIES[cell[0]], AMPLITUDES[cell[1]], DURATION)
        response = simulate(column, motion, model, output_interval=0.02)
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
    variables = {one: ((*dims, "time"), values, {"units": "m"}) for one, values in curves.items()}
    variables |= {one: (dims, values, {"units": "s" if "time" in one else "m"}) for one, values in facts.items()}
    meanings = " ".join(one.replace(" ", "_") for one in v.VERDICTS)
    variables["verdict"] = (dims, flags, {"flag_values": np.arange(5, dtype=np.int8), "flag_meanings": meanings})
    coordinates = {
        "frequency": ("frequency", FREQUENCIES, {"units": "Hz"}),
        "amplitude": ("amplitude", AMPLITUDES, {"units": "m s-2"}),
        "time": ("time", time, {"units": "s"}),
    }
    note = "displacements of base and top relative to the ground, and of the ground"
    data_set = xarray.Dataset(
        variables, coordinates, {"column": name, "model": label, "version": __version__, "note": note}
    )
    with replacing(place) as partial:
        data_set.to_netcdf(partial, engine="h5netcdf")
    return data_set
