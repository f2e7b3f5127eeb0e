"""Probability of collapse over frequency and amplitude: counts of verdicts, their confidence, and the uncertain band."""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .. import store
from ..campaign.twins import groups_of
from ..column import Column
from ..column.scatter import Scatter
from ..constants import g
from ..errors import InputError
from ..motion.scatter import MotionScatter
from ..notebook import Shown
from ..version import __version__
from . import verdicts as v
from .domain import cell_edges, grid_coordinates
from .unknown_law import share_limits

if TYPE_CHECKING:
    import pandas
    import xarray

#: Kinds of cells, from the verdicts of their runs.
SAFE, UNCERTAIN, UNSAFE, UNKNOWN = "all stand", "some collapse", "all collapse", "no verdict"
KINDS = (SAFE, UNCERTAIN, UNSAFE, UNKNOWN)


@dataclass(frozen=True, eq=False)
class CollapseProbability(Shown):
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
        """Share of the runs that collapse, shape (F, A): see :func:`stylobate.analysis.verdicts.share_collapsed`."""
        return v.share_collapsed(*self._counts)

    @property
    def mean(self) -> float:
        """Mean share that collapses, of the cells in which some runs have a verdict."""
        return float(np.nanmean(self.frequency))

    @property
    def interval(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper confidence limit of the probability of collapse, each of shape (F, A).

        See :func:`stylobate.analysis.unknown_law.share_limits`.
        """
        return share_limits(np.array(v.VERDICTS)[self.codes], groups_of(self.scatter, self.replicates), self.confidence)

    @property
    def kinds(self) -> np.ndarray:
        """Kind of each cell, shape (F, A); runs that failed are left out.

        All stand; all collapse; some collapse (and others stand or are undecided); no verdict: none collapses and some
        are undecided, or more than half are undecided and not both verdicts occur, or all failed.
        """
        collapsed, stands, others = (self.count(one) for one in (v.COLLAPSED, v.STANDS, v.UNDECIDED))
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
            **{one: runs[one] for one in v.MADE},
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
                raise InputError(f"{store.shown(path)} was written by an earlier version; run it again with this one.")
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
