"""Domains over frequency and amplitude of a harmonic base motion: verdicts, and probabilities of collapse."""

from __future__ import annotations

import dataclasses
import json
import time
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import store
from ..campaign.campaign import RUNS, Campaign, Progress
from ..campaign.digests import Hasher
from ..campaign.grid import MAX_CELLS, HarmonicGrid, grid_axis
from ..campaign.runs import Request, Runs, Stopped
from ..campaign.twins import groups_of, the_twins
from ..column import Column
from ..column.scatter import Scatter
from ..constants import g
from ..errors import InputError, check_range
from ..models.base import Case, Model
from ..motion.pulses import MotionScatter, ScatteredSines
from ..notebook import NotebookSummary
from ..outcome import Outcome
from ..response.measures import STEPS, Measures, measures_of
from ..response.rows import Rows
from ..version import __version__
from . import verdict as v
from .verdict import share_limits

if TYPE_CHECKING:
    import pandas
    import xarray


#: Measures that the file of a domain has as grids: all but what says how a run was computed.
_GRIDS = [measure for measure in measures_of(Measures) if measure.of != STEPS]


@dataclass(frozen=True, eq=False)
class Domain(NotebookSummary):
    """Verdicts over frequency and amplitude.

    Parameters
    ----------
    column : Column
    model : str
        Name of the model.
    frequencies : array
        [Hz], shape (F,), rising.
    amplitudes : array
        [m/s²], shape (A,), rising.
    rows : Rows, or a list of dict or None
        One per cell, frequency by frequency, with the keys of ``Measures.row()``; None where the cell was not run.
    wall_time : float
        [s]
    provenance : dict
        Versions, parameters and digests that reproduce the domain; plain values.
    """

    column: Column
    model: str
    frequencies: np.ndarray
    amplitudes: np.ndarray
    rows: Rows
    wall_time: float
    provenance: dict

    def __post_init__(self) -> None:
        object.__setattr__(self, "rows", Rows.of(self.rows))

    @property
    def shape(self) -> tuple[int, int]:
        """(number of frequencies, number of amplitudes)."""
        return len(self.frequencies), len(self.amplitudes)

    @property
    def complete(self) -> bool:
        """Whether every cell was run; False after an interrupt."""
        return bool(self.rows.made.all())

    @property
    def verdicts(self) -> np.ndarray:
        """Verdict of each cell: stands, collapsed, undecided, failed or not run; shape (F, A)."""
        return v.verdicts_of(self.rows).reshape(self.shape)

    @property
    def counts(self) -> dict[str, int]:
        """Number of cells by verdict."""
        return v.count(self.verdicts)

    @property
    def first_collapse(self) -> np.ndarray:
        """Smallest amplitude that collapses the column at each frequency [m/s²], NaN where none does, shape (F,)."""
        return _boundary(v.first_collapse, self)

    @property
    def all_collapse_above(self) -> np.ndarray:
        """Smallest amplitude from which on all collapse at each frequency [m/s²], NaN where there is none, (F,)."""
        return _boundary(v.all_collapse_above, self)

    @property
    def table(self) -> pandas.DataFrame:
        """One row per cell that was run: ``frequency_hz``, ``amplitude_g``, ``verdict`` and the measures."""
        made = self.rows.made
        table = self.rows.table()
        table.insert(0, "frequency_hz", np.repeat(self.frequencies, self.shape[1])[made])
        table.insert(1, "amplitude_g", np.tile(self.amplitudes / g, self.shape[0])[made])
        table.insert(2, "verdict", self.verdicts.ravel()[made].astype(object))
        return table

    def grid(self, name: str) -> np.ndarray:
        """One of the measures as an array of shape (F, A); NaN where there is no value."""
        return self.rows.floats(name).reshape(self.shape)

    def summary(self) -> dict:
        """The JSON object of ``stylobate domain``."""
        counts = self.counts
        return {
            "cells": len(self.rows),
            **{verdict: counts[verdict] for verdict in v.COMPUTED},
            "not_run": counts[v.NOT_RUN],
            "runs": len(self.rows) - counts[v.NOT_RUN],
            "uplift_g": self.column.uplift_acceleration / g,
            "wall_s": self.wall_time,
            "model": self.model,
            "version": __version__,
        }

    def to_xarray(self) -> xarray.Dataset:
        """The domain as a labelled data set.

        Returns
        -------
        xarray.Dataset
            Dimensions ``frequency`` [Hz] and ``amplitude`` [m/s²]; ``verdict`` as flags with their meanings, and the
            measures, each with its unit in ``units``.
        """
        import xarray

        dims = ("frequency", "amplitude")
        verdicts = self.verdicts
        flags = np.zeros(self.shape, dtype=np.int8)
        for flag, verdict in enumerate(v.VERDICTS):
            flags[verdicts == verdict] = flag
        variables: dict[str, Any] = {"verdict": (dims, flags, v.FLAGS)}
        outcomes = np.full(len(self.rows), -1, dtype=np.int8)
        for member in Outcome:
            outcomes[self.rows.are("outcome", member.label)] = int(member)
        variables["outcome"] = (
            dims,
            outcomes.reshape(self.shape),
            {
                "long_name": "outcome of the run, -1 where it was not made",
                "flag_values": np.array([int(outcome) for outcome in Outcome], dtype=np.int8),
                "flag_meanings": " ".join(outcome.label for outcome in Outcome),
            },
        )
        for member in _GRIDS:
            variables[member.key] = (
                dims,
                self.grid(member.key),
                {"units": member.unit or "1", "long_name": member.meaning},
            )
        variables["column"] = ((), json.dumps(self.column.to_dict()))
        variables["provenance"] = ((), json.dumps(self.provenance, default=str))
        attributes = {
            "model": self.model,
            "version": __version__,
            "wall_s": self.wall_time,
            "uplift_acceleration_m_s2": self.column.uplift_acceleration,
        }
        return xarray.Dataset(variables, grid_coordinates(self.frequencies, self.amplitudes), attributes)

    def save(self, path: str | Path) -> Path:
        """Write the domain, ``.nc`` or ``.csv``: see :func:`stylobate.store.save`."""
        return store.save(self, "domain", path)

    @classmethod
    def load(cls, path: str | Path) -> Domain:
        """Read a domain written by :meth:`save` as netCDF; steps, time steps and reasons of the runs are not in it.

        Raises
        ------
        InputError
            The file cannot be read, or holds no domain.
        """
        from ..column.files import column_from_dict

        data = store.read(path, "domain")
        try:
            verdicts = np.array(v.VERDICTS, dtype=object)[data["verdict"].values.ravel()]
            outcomes = data["outcome"].values.ravel()
            grids = [(measure, data[measure.key].values.ravel()) for measure in _GRIDS if measure.key in data]
            column = column_from_dict(json.loads(str(data["column"].values)))
            provenance = json.loads(str(data["provenance"].values))
            axes = data["frequency"].values, data["amplitude"].values
            model, wall = str(data.attrs["model"]), float(data.attrs["wall_s"])
            rows = Rows.of(
                None
                if verdict == v.NOT_RUN
                else {
                    "outcome": Outcome(int(outcome)).label,
                    "collapsed": Outcome(int(outcome)) is Outcome.COLLAPSED,
                    "decided": verdict in (v.STANDS, v.COLLAPSED),
                    **{measure.key: measure.plain(grid[i]) for measure, grid in grids},
                }
                for i, (verdict, outcome) in enumerate(zip(verdicts, outcomes, strict=True))
            )
            return cls(column, model, *axes, rows, wall, provenance)
        except Exception as error:
            raise store.unreadable(path, error) from None


def grid_coordinates(frequencies: np.ndarray, amplitudes: np.ndarray) -> dict[str, tuple]:
    """Coordinates of a labelled array over frequencies [Hz] and amplitudes [m/s²]."""
    return {
        "frequency": ("frequency", frequencies, {"units": "Hz", "long_name": "frequency of the base motion"}),
        "amplitude": ("amplitude", amplitudes, {"units": "m s-2", "long_name": "amplitude of acceleration"}),
        "amplitude_g": ("amplitude", amplitudes / g, {"units": "g", "long_name": "amplitude in g"}),
    }


def collapse_domain(
    column: Column,
    model: Model,
    frequencies: Sequence[float] | np.ndarray,
    amplitudes: Sequence[float] | np.ndarray,
    duration: float = 10.0,
    *,
    out: str | Path | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> Domain:
    """Run a column under harmonic base motions of all frequencies and amplitudes.

    Parameters
    ----------
    column : Column
    model : Model
    frequencies : array
        [Hz], shape (F,)
    amplitudes : array
        [m/s²], shape (A,)
    duration : float
        Length of each motion [s].
    out : path, optional
        Folder that keeps finished runs (``runs.sqlite``), unless the campaign has another ledger. When the domain is
        complete, ``domain.nc`` and ``domain.csv`` are written there.
    campaign, **settings : Campaign, optional
        How the runs are made.

    Returns
    -------
    Domain
        After an interrupt (Ctrl-C) it holds the cells that are finished, and ``complete`` is False.

    Raises
    ------
    InputError
        An impossible grid, a folder that cannot be used, or input that the model refuses.
    """
    campaign = Campaign.of("collapse_domain", campaign, settings, RUNS)
    axes: tuple[Any, Any] = frequencies, amplitudes  # checked there
    grid = HarmonicGrid(column, model, *axes, duration, campaign.tail)
    with closing(Runs(campaign.kept_in(out))) as runs:
        domain = run_grid(grid, grid.request(), runs)
    if out is not None and domain.complete:
        domain.save(Path(out) / "domain.nc")
        domain.save(Path(out) / "domain.csv")
    return domain


def run_grid(grid: HarmonicGrid, request: Request, runs: Runs, progress: Progress | None = None) -> Domain:
    """The domain of a grid, by its request; after an interrupt with the cells that are finished."""
    started = time.perf_counter()
    try:
        rows = runs.rows(request, progress)
    except Stopped as stopped:
        rows = stopped.rows
    column, model, f, a = grid.column, grid.model, grid.frequencies, grid.amplitudes
    provenance = {
        "column": column.to_dict(),
        "frequencies": f.tolist(),
        "amplitudes": a.tolist(),
        "duration": float(grid.duration),
        "column_digest": column.digest,
        "model": model.name,
        "parameters": model.parameters(),
        "references": list(model.references),
        "tail": grid.tail,
        "version": __version__,
    }
    return Domain(column, model.name, f, a, rows, time.perf_counter() - started, provenance)


def cell_edges(centres: np.ndarray) -> np.ndarray:
    """Edges of the cells around the given values: half-way between neighbours."""
    if len(centres) == 1:
        half = 0.1 * abs(centres[0]) or 0.5
        return np.array([centres[0] - half, centres[0] + half])
    middle = 0.5 * (centres[1:] + centres[:-1])
    return np.array([2.0 * centres[0] - middle[0], *middle, 2.0 * centres[-1] - middle[-1]])


def _boundary(find: Any, domain: Domain) -> np.ndarray:
    boundary = [find(domain.amplitudes, line) for line in domain.verdicts]
    return np.array([np.nan if amplitude is None else amplitude for amplitude in boundary])


#: Kinds of cells, from the verdicts of their runs.
SAFE, UNCERTAIN, UNSAFE, UNKNOWN = "all stand", "some collapse", "all collapse", "no verdict"

KINDS = (SAFE, UNCERTAIN, UNSAFE, UNKNOWN)


@dataclass(frozen=True, eq=False)
class CollapseProbability(NotebookSummary):
    """Verdicts of all columns alike in all cells.

    Parameters
    ----------
    column : Column
        The one that the others are like.
    model : str
    frequencies : array
        [Hz], shape (F,).
    amplitudes : array
        [m/s²], shape (A,).
    codes : array of int8
        Index into ``verdicts.VERDICTS`` of each run, shape (F, A, replicates).
    peaks : array of float32
        Peak top displacement relative to the base of each run [m], same shape; NaN where there is none.
    scatter : Scatter
        Of the columns.
    motion_scatter : MotionScatter
        Of the motions of each cell.
    seed : int
    confidence : float
        Level of the intervals, e.g. 0.95.
    wall_time : float
        [s]
    provenance : dict
        What reproduces it; plain values.
    """

    column: Column
    model: str
    frequencies: np.ndarray
    amplitudes: np.ndarray
    codes: np.ndarray
    peaks: np.ndarray
    scatter: Scatter
    motion_scatter: MotionScatter
    seed: int
    confidence: float
    wall_time: float
    provenance: dict

    @property
    def replicates(self) -> int:
        """Number of columns."""
        return self.codes.shape[2]

    @property
    def complete(self) -> bool:
        """Whether every run was made; False after an interrupt."""
        return not (self.codes == v.VERDICTS.index(v.NOT_RUN)).any()

    def count(self, verdict: str) -> np.ndarray:
        """Runs with that verdict in each cell, shape (F, A)."""
        return (self.codes == v.VERDICTS.index(verdict)).sum(axis=2)

    @property
    def frequency(self) -> np.ndarray:
        """Share of the runs that collapse, shape (F, A): see :func:`stylobate.verdicts.verdict.share_collapsed`."""
        return v.share_collapsed(*self._counts)

    @property
    def mean(self) -> float:
        """Mean share that collapses, of the cells in which some runs have a verdict."""
        return float(np.nanmean(self.frequency))

    @property
    def interval(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper confidence limit of the probability of collapse, each of shape (F, A).

        See :func:`stylobate.verdicts.verdict.share_limits`.
        """
        return share_limits(np.array(v.VERDICTS)[self.codes], groups_of(self.scatter, self.replicates), self.confidence)

    @property
    def kinds(self) -> np.ndarray:
        """Kind of each cell, shape (F, A); runs that failed are left out.

        All stand; all collapse; some collapse (and others stand or are undecided); no verdict: none collapses and some
        are undecided, or more than half are undecided and not both verdicts occur, or all failed.
        """
        collapsed, stands, others = (self.count(verdict) for verdict in (v.COLLAPSED, v.STANDS, v.UNDECIDED))
        return np.select(
            [
                (collapsed > 0) & (stands > 0),
                2 * others > collapsed + stands + others,
                (stands + others == 0) & (collapsed > 0),
                collapsed > 0,
                (others == 0) & (stands > 0),
            ],
            [UNCERTAIN, UNKNOWN, UNSAFE, UNCERTAIN, SAFE],
            default=UNKNOWN,
        )

    @property
    def band(self) -> tuple[np.ndarray, np.ndarray]:
        """The uncertain band: lowest amplitude at which any collapses, highest at which any does not [m/s²], each (F,).

        NaN in the first where none collapses, in the second where all do. Where the second is the largest amplitude of
        the grid, the band goes on beyond it. First above second: no uncertain cell.
        """
        low, high = np.full(len(self.frequencies), np.nan), np.full(len(self.frequencies), np.nan)
        others = self.count(v.STANDS) + self.count(v.UNDECIDED) > 0
        for i, (falls, stays) in enumerate(zip(self.count(v.COLLAPSED) > 0, others)):
            if falls.any():
                low[i] = self.amplitudes[np.argmax(falls)]
            if stays.any():
                high[i] = self.amplitudes[::-1][np.argmax(stays[::-1])]
        return low, high

    @property
    def band_width(self) -> np.ndarray:
        """Width of the uncertain band [m/s²], shape (F,): 0 without one, NaN where none collapses or its top is not seen.

        Each end lies half-way to the next amplitude, so that one uncertain cell is one step of the grid wide.
        """
        low, high = self.band
        edges = cell_edges(self.amplitudes)
        lower, upper = edges[:-1], edges[1:]
        width = np.full(len(low), np.nan)
        for i in np.flatnonzero(~np.isnan(low) & ~self.band_is_open):
            first = lower[np.searchsorted(self.amplitudes, low[i])]
            last = -np.inf if np.isnan(high[i]) else upper[np.searchsorted(self.amplitudes, high[i])]
            width[i] = max(0.0, last - first)
        return width

    @property
    def band_is_open(self) -> np.ndarray:
        """Whether some collapse, and some do not even at the largest amplitude, shape (F,)."""
        low, high = self.band
        return ~np.isnan(low) & (high >= self.amplitudes[-1])

    @property
    def table(self) -> pandas.DataFrame:
        """One row per cell: counts by verdict, frequency of collapse and its confidence limits."""
        import pandas

        low, high = self.interval
        f, a = np.meshgrid(self.frequencies, self.amplitudes / g, indexing="ij")
        data = {"frequency_hz": f, "amplitude_g": a}
        data |= {verdict.replace(" ", "_"): self.count(verdict) for verdict in v.VERDICTS}
        data |= {"collapse_frequency": self.frequency, "confidence_low": low, "confidence_high": high}
        return pandas.DataFrame({name: values.ravel() for name, values in data.items()})

    def summary(self) -> dict:
        """The JSON object of ``stylobate domain --replicates N``."""
        runs = v.count(np.array(v.VERDICTS, dtype=object)[self.codes])
        kinds = self.kinds
        width = self.band_width / g
        seen = width[np.isfinite(width)]
        return {
            "cells": int(kinds.size),
            "replicates": self.replicates,
            "scatter": dataclasses.asdict(self.scatter),
            "motion_scatter": dataclasses.asdict(self.motion_scatter),
            "left_out": list(self.provenance.get("left_out", ())),
            "seed": self.seed,
            "confidence": self.confidence,
            "all_stand": int((kinds == SAFE).sum()),
            "some_collapse": int((kinds == UNCERTAIN).sum()),
            "all_collapse": int((kinds == UNSAFE).sum()),
            "no_verdict": int((kinds == UNKNOWN).sum()),
            "band_width_median_g": float(np.median(seen)) if seen.size else None,
            "band_width_largest_g": float(seen.max()) if seen.size else None,
            "band_open_frequencies": int(self.band_is_open.sum()),
            "amplitude_step_g": float(np.diff(self.amplitudes).max() / g) if len(self.amplitudes) > 1 else None,
            "runs": int(self.codes.size - runs[v.NOT_RUN]),
            **{verdict: runs[verdict] for verdict in v.COMPUTED},
            "not_run": runs[v.NOT_RUN],
            "uplift_g": self.column.uplift_acceleration / g,
            "wall_s": self.wall_time,
            "model": self.model,
            "version": __version__,
        }

    def to_xarray(self) -> xarray.Dataset:
        """Verdict and peak of every run, frequency of collapse and confidence limits, with units."""
        import xarray

        cells, runs = ("frequency", "amplitude"), ("frequency", "amplitude", "replicate")
        low, high = self.interval
        level = f"{100.0 * self.confidence:g} % confidence limit (Wilson)"
        peak = {"units": "m", "long_name": "largest top displacement relative to the base"}
        share = {"units": "1", "long_name": "share of the runs that collapse; undecided ones do not count as collapsed"}
        return xarray.Dataset(
            {
                "verdict": (runs, self.codes, v.FLAGS),
                "peak_top_displacement_m": (runs, self.peaks, peak),
                "collapse_frequency": (cells, self.frequency, share),
                "confidence_low": (cells, low, {"units": "1", "long_name": f"lower {level}"}),
                "confidence_high": (cells, high, {"units": "1", "long_name": f"upper {level}"}),
                "column": ((), json.dumps(self.column.to_dict())),
                "provenance": ((), json.dumps(self.provenance, default=str)),
            },
            grid_coordinates(self.frequencies, self.amplitudes),
            {
                "model": self.model,
                "version": __version__,
                "seed": self.seed,
                "confidence": self.confidence,
                "wall_s": self.wall_time,
            },
        )

    def save(self, path: str | Path) -> Path:
        """Write every run (``.nc``) or a table of the cells (``.csv``): see :func:`stylobate.store.save`."""
        return store.save(self, "probability", path)

    @classmethod
    def load(cls, path: str | Path) -> CollapseProbability:
        """Read what :meth:`save` wrote as netCDF.

        Raises
        ------
        InputError
            The file cannot be read, or holds something else.
        """
        from ..column.files import column_from_dict

        data = store.read(path, "probability")
        try:
            provenance = json.loads(str(data["provenance"].values))
            if "imperfection" in provenance:
                raise InputError(
                    f"{store.printable(path)} was written by an earlier version; run it again with this one."
                )
            return cls(
                column_from_dict(json.loads(str(data["column"].values))),
                str(data.attrs["model"]),
                data["frequency"].values,
                data["amplitude"].values,
                data["verdict"].values.astype(np.int8),
                data["peak_top_displacement_m"].values.astype(np.float32),
                Scatter(**provenance["scatter"]),
                MotionScatter(**provenance["motion_scatter"]),
                int(data.attrs["seed"]),
                float(data.attrs["confidence"]),
                float(data.attrs["wall_s"]),
                provenance,
            )
        except InputError:
            raise
        except Exception as error:
            raise store.unreadable(path, error) from None

    @property
    def _counts(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.count(v.COLLAPSED), self.count(v.STANDS), self.count(v.UNDECIDED)


#: Largest number of runs in all.
MAX_RUNS = 20_000_000


def collapse_probability(
    column: Column,
    model: Model,
    frequencies: Sequence[float] | np.ndarray,
    amplitudes: Sequence[float] | np.ndarray,
    duration: float = 10.0,
    *,
    motion_scatter: MotionScatter | None = None,
    confidence: float = 0.95,
    out: str | Path | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> CollapseProbability:
    """Run many slightly different columns under harmonic base motions of all frequencies and amplitudes.

    Parameters
    ----------
    column, model, frequencies, amplitudes, duration
        As in :func:`stylobate.collapse_domain`.
    motion_scatter : MotionScatter, optional
        How the motions of a cell differ; by default they do not. Models in the plane leave ``across`` out.
    confidence : float
        Level of the intervals.
    out : path, optional
        Folder that keeps finished runs (``runs.sqlite``), unless the campaign has another ledger, and when all are there
        holds ``probability.nc`` and ``probability.csv``.
    campaign, **settings : Campaign, optional
        Each of the replicates goes through every cell; the same seed gives the same columns and motions.

    Returns
    -------
    CollapseProbability
        After an interrupt (Ctrl-C) it holds the runs that are finished, and ``complete`` is False.

    Raises
    ------
    InputError
        An impossible grid, number, folder, or input that the model refuses.

    Notes
    -----
    Runs that failed or are undecided are counted apart. Failed ones are left out; undecided ones are never a collapse,
    and the upper confidence limit allows for all of them having become one. The interval is for the probability over the
    stated population, and has nothing to say about the model being right.
    """
    campaign = Campaign.of("collapse_probability", campaign, settings, ("whole",), replicates=20)
    started = time.perf_counter()
    f = grid_axis("frequencies", frequencies, 1e-3, 1e3, "Hz")
    a = grid_axis("amplitudes", amplitudes, 0.0, 1e4, "m/s²")
    check_range("confidence", confidence, 0.0, 1.0, open_low=True, open_high=True, remedy="0.95 is the default")
    shaking, beyond = MotionScatter() if motion_scatter is None else motion_scatter, ()
    if shaking.across and model.is_plane(model.parameters()):
        shaking, beyond = dataclasses.replace(shaking, across=0.0), ("across",)
    twins = the_twins(column, model, campaign, alone=not shaking.given)
    number, seed = campaign.replicates, campaign.seed
    if len(f) * len(a) > MAX_CELLS or len(f) * len(a) * number > MAX_RUNS:
        raise InputError(
            f"{len(f)} × {len(a)} cells with {number} replicates are {len(f) * len(a) * number} runs; allowed is up to "
            f"{MAX_CELLS} cells and {MAX_RUNS} runs: give fewer."
        )
    cases = _Cases(twins.columns, f, a, ScatteredSines(f, float(duration), shaking, number, seed))
    key = {
        "column": column.digest,
        "frequencies": f.tolist(),
        "amplitudes": a.tolist(),
        "duration": float(duration),
        "replicates": number,
        "scatter": dataclasses.asdict(twins.scatter),
        "motion_scatter": dataclasses.asdict(shaking),
        "left_out": [*twins.left_out, *beyond],
        "seed": seed,
    }
    campaign = campaign.kept_in(out)
    codes = np.full(len(cases), v.VERDICTS.index(v.NOT_RUN), dtype=np.int8)
    peaks = np.full(len(cases), np.nan, dtype=np.float32)
    done = 0
    try:
        request = Request.of(cases, Hasher(model, campaign.options))
        with closing(Runs(campaign)) as runs, closing(runs.run(request)) as finished:
            for index, row in finished:
                codes[index] = v.VERDICTS.index(v.verdict(row))
                peak = row["peak_top_displacement_m"]
                peaks[index] = peak if np.isfinite(peak) else np.nan
                done += 1
                if campaign.progress:
                    campaign.progress(done, len(cases))
    except KeyboardInterrupt:
        pass
    provenance = {
        **key,
        "column": column.to_dict(),
        "column_digest": column.digest,
        "model": model.name,
        "parameters": model.parameters(),
        "references": [*model.references, "wilson1927"],
        "tail": campaign.tail,
        "version": __version__,
    }
    shape = (len(f), len(a), number)
    probability = CollapseProbability(
        column, model.name, f, a, codes.reshape(shape), peaks.reshape(shape), twins.scatter, shaking, seed, confidence,
        time.perf_counter() - started, provenance,
    )  # fmt: skip
    if out is not None and probability.complete:
        probability.save(Path(out) / "probability.nc")
        probability.save(Path(out) / "probability.csv")
    return probability


class _Cases(Sequence):
    """Cases in the order (frequency, amplitude, replicate), made when asked for: columns and samples are shared."""

    def __init__(self, columns: Sequence[Column], f: np.ndarray, a: np.ndarray, motions: ScatteredSines) -> None:
        self.shape = (len(f), len(a), len(columns))
        self.amplitudes, self.columns, self.motions = a, columns, motions

    def __len__(self) -> int:
        return int(np.prod(self.shape))

    def __getitem__(self, index: Any) -> Case:
        if not 0 <= index < len(self):
            raise IndexError(index)
        i, j, k = (int(position) for position in np.unravel_index(index, self.shape))
        return Case(self.columns[k], self.motions.motion(i, self.amplitudes[j], k))
