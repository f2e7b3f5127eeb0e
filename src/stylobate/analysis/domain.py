"""The safe-unsafe domain of a column: its verdicts over frequency and amplitude of a harmonic base motion."""

from __future__ import annotations

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
from ..campaign.grid import HarmonicGrid
from ..campaign.runs import Request, Runs, Stopped
from ..column import Column
from ..constants import g
from ..models.base import Model
from ..notebook import Shown
from ..outcome import Outcome
from ..response.measures import STEPS, Measures, measures_of
from ..response.rows import Rows
from ..version import __version__
from . import verdicts as v

if TYPE_CHECKING:
    import pandas
    import xarray

#: Measures that the file of a domain has as grids: all but what says how a run was computed.
_GRIDS = [one for one in measures_of(Measures) if one.of != STEPS]


@dataclass(frozen=True, eq=False)
class Domain(Shown):
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
            **{one: counts[one] for one in v.MADE},
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
        for one in Outcome:
            outcomes[self.rows.are("outcome", one.label)] = int(one)
        variables["outcome"] = (
            dims,
            outcomes.reshape(self.shape),
            {
                "long_name": "outcome of the run, -1 where it was not made",
                "flag_values": np.array([int(one) for one in Outcome], dtype=np.int8),
                "flag_meanings": " ".join(one.label for one in Outcome),
            },
        )
        for one in _GRIDS:
            variables[one.key] = (dims, self.grid(one.key), {"units": one.unit or "1", "long_name": one.meaning})
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
            grids = [(one, data[one.key].values.ravel()) for one in _GRIDS if one.key in data]
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
                    **{one.key: one.plain(grid[i]) for one, grid in grids},
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
    found = [find(domain.amplitudes, line) for line in domain.verdicts]
    return np.array([np.nan if one is None else one for one in found])
