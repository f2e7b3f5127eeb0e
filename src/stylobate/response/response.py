"""What happened: histories, outcome, measures, energy and provenance of one run."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..bibliography import cite_run
from ..column import Column
from ..column.as_found import drum_outline, geometry
from ..constants import DEGREE
from ..outcome import Outcome
from .measures import Measures

if TYPE_CHECKING:
    import xarray

#: Terms of the energy ledger, in order: input = kinetic + gravitational + elastic + friction + viscous + impact + imbalance.
ENERGY_TERMS = ("input", "kinetic", "gravitational", "elastic", "friction", "viscous", "impact")


@dataclass(frozen=True, eq=False)
class Histories:
    """Recorded histories of a run; displacements relative to the moving base and from the start.

    Parameters
    ----------
    time : array
        [s], shape (T,)
    drum_x, drum_z : array
        Displacement of each drum's centroid [m], shape (T, n).
    drum_rotation : array
        Rotation of each drum, counter-clockwise positive (the top goes to −x) [rad], shape (T, n).
    joint_opening : array
        Largest gap between the two faces of each joint, 0 when fully closed [m], shape (T, n).
    joint_slip : array
        Offset along each joint of the drum above to the one below, from the start [m], shape (T, n).
    base_displacement, top_displacement : array
        Horizontal displacement of the middle of the lowest and of the topmost face [m], shape (T,).
    ground_acceleration, ground_displacement : array
        Of the base along x [m/s²], [m], shape (T,). Absolute displacement = relative + ground.
    energy : dict of str to array
        Ledger by :data:`ENERGY_TERMS` [J], each of shape (T,); terms that a model lacks are zero.
        ``input``, ``friction``, ``viscous`` and ``impact`` are sums since the start, the others changes since the start.
    """

    time: np.ndarray
    drum_x: np.ndarray
    drum_z: np.ndarray
    drum_rotation: np.ndarray
    joint_opening: np.ndarray
    joint_slip: np.ndarray
    base_displacement: np.ndarray
    top_displacement: np.ndarray
    ground_acceleration: np.ndarray
    ground_displacement: np.ndarray
    energy: dict[str, np.ndarray]

    @property
    def imbalance(self) -> np.ndarray:
        """Input minus everything that the ledger accounts for [J], shape (T,)."""
        zero = np.zeros_like(self.time)
        terms = [self.energy.get(term, zero) for term in ENERGY_TERMS]
        return terms[0] - sum(terms[1:], zero)


@dataclass(frozen=True, eq=False)
class Response:
    """Result of :func:`stylobate.simulate`.

    Parameters
    ----------
    column : Column
    histories : Histories
    measures : Measures
    model : str
        Name of the model, as on the command line.
    provenance : dict
        Versions, parameters and digests that reproduce the run; plain values.
    wall_time : float
        Time the run took [s].
    """

    column: Column
    histories: Histories
    measures: Measures
    model: str
    provenance: dict
    wall_time: float = 0.0

    def __getattr__(self, name: str):
        # Histories and measures are read as attributes of the response: response.time, response.outcome …
        if not name.startswith("__"):
            for part in ("histories", "measures"):
                if part in self.__dict__ and hasattr(self.__dict__[part], name):
                    return getattr(self.__dict__[part], name)
        raise AttributeError(f"Response has no attribute {name!r}")

    @property
    def outcome(self) -> Outcome:
        """How the run ended."""
        return self.measures.outcome

    @property
    def collapsed(self) -> bool:
        """Whether the column collapsed."""
        return self.measures.collapsed

    def summary(self) -> dict:
        """The JSON object of ``stylobate run``."""
        row = self.measures.row()
        joints = {
            "peak_opening_per_joint_m": _finite(np.abs(self.histories.joint_opening).max(axis=0)),
            "residual_slip_per_joint_m": _finite(self.histories.joint_slip[-1]),
        }
        mechanism = self.provenance.get("mechanism")
        if mechanism is not None:
            joints["mechanism"] = mechanism
        version = self.provenance.get("version", "")
        return row | joints | {"wall_s": self.wall_time, "model": self.model, "version": version}

    def citation(self) -> str:
        """What to cite for this run: the package, the sources of its model, and where its motion comes from."""
        return cite_run(self.provenance).text

    def outline(self, index: int, drum: int, factor: float = 1.0) -> np.ndarray:
        """Corners of drum 0 … n−1 at a recorded state, horizontally and upward from the base's middle [m], shape (k, 2).

        Parameters
        ----------
        index, drum : int
        factor : float
            By which displacement and rotation are drawn larger.
        """
        h, start = self.histories, geometry(self.column)
        angle = start.lean[drum] + factor * h.drum_rotation[index, drum]
        c, s = np.cos(angle), np.sin(angle)
        moved = factor * np.array([h.drum_x[index, drum], h.drum_z[index, drum]])
        along_base = drum_outline(self.column, drum) @ np.array([[c, s], [-s, c]]) + start.centroid[drum] + moved
        slope = self.column.as_found.base_tilt * DEGREE
        return along_base @ np.array([[np.cos(slope), np.sin(slope)], [-np.sin(slope), np.cos(slope)]])

    def with_provenance(self, provenance: dict, wall_time: float) -> Response:
        """A copy with provenance and wall time filled in (done once, by ``simulate``)."""
        return replace(self, provenance=self.provenance | provenance, wall_time=wall_time)

    def to_xarray(self) -> xarray.Dataset:
        """Histories as a labelled data set with units; measures and provenance as attributes."""
        from .store import to_dataset

        return to_dataset(self)

    def save(self, path: str | Path) -> Path:
        """Write netCDF atomically: to a temporary name, then renamed."""
        from .store import save

        return save(self, path)

    @classmethod
    def load(cls, path: str | Path) -> Response:
        """Read a response written by :meth:`save`."""
        from .store import load

        return load(path)


def _finite(values: np.ndarray) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]
