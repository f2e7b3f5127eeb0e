"""What happened to an assembly: histories of all its bodies, energy, and how it lies at the end."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..atomic import replacing
from ..bibliography import cite_run
from ..column.assembly import Assembly

if TYPE_CHECKING:
    import xarray

#: Layout of the file.
FORMAT = "stylobate assembly response 1"


@dataclass(frozen=True, eq=False)
class AssemblyResponse:
    """Result of :func:`stylobate.simulate.simulate_assembly`; everything relative to the moving base.

    Parameters
    ----------
    assembly : Assembly
    time : array
        [s], shape (T,)
    x, z : array
        Centroid of every body of ``assembly.bodies`` [m], shape (T, N).
    rotation : array
        [rad], shape (T, N)
    energy : dict of str to array
        Ledger as for columns [J], each of shape (T,).
    ground_acceleration, ground_displacement : array
        Of the base along x [m/s²], [m], shape (T,).
    at_rest : bool
        Whether everything lies still at the end.
    failed : bool
        Whether the computation could not go on, or its energy is out of balance.
    energy_imbalance : float
        What the ledger misses, relative to the largest of input work, released potential energy and energy at rest [-].
    time_step : float
        [s]
    steps : int
    provenance : dict
    wall_time : float
        [s]
    """

    assembly: Assembly
    time: np.ndarray
    x: np.ndarray
    z: np.ndarray
    rotation: np.ndarray
    energy: dict[str, np.ndarray]
    ground_acceleration: np.ndarray
    ground_displacement: np.ndarray
    at_rest: bool
    failed: bool
    energy_imbalance: float
    time_step: float
    steps: int
    provenance: dict
    wall_time: float = 0.0

    @property
    def imbalance(self) -> np.ndarray:
        """Input minus everything that the ledger accounts for [J], shape (T,)."""
        terms = ("kinetic", "gravitational", "elastic", "friction", "viscous")
        return self.energy["input"] - sum((self.energy[term] for term in terms), np.zeros_like(self.time))

    @property
    def fallen(self) -> tuple[str, ...]:
        """Blocks that lie lower at the end by more than half of the smaller side of their box, or turned by over 45°."""
        found = []
        for i, block in enumerate(self.assembly.bodies):
            drop = 0.5 * float(np.ptp(block.corners, axis=0).min())
            turned = abs(self.rotation[-1, i] - self.rotation[0, i]) > 0.25 * np.pi
            if self.z[-1, i] < self.z[0, i] - drop or turned:
                found.append(block.name)
        return tuple(found)

    def outline(self, index: int, body: int) -> np.ndarray:
        """Corners of a body at a recorded state [m], shape (k, 2)."""
        block = self.assembly.bodies[body]
        start = np.array([self.x[0, body], self.z[0, body]])
        angle = self.rotation[index, body]
        c, s = np.cos(angle), np.sin(angle)
        return (block.corners - start) @ np.array([[c, s], [-s, c]]) + (self.x[index, body], self.z[index, body])

    def summary(self) -> dict:
        """The JSON object of ``stylobate run`` for an assembly."""
        return {
            "outcome": "failed" if self.failed else "fallen" if self.fallen else "standing",
            "fallen": list(self.fallen),
            "at_rest": self.at_rest,
            "peak_displacement_m": float(np.hypot(self.x - self.x[0], self.z - self.z[0]).max()),
            "energy_imbalance": self.energy_imbalance,
            "time_step_s": self.time_step,
            "steps": self.steps,
            "wall_s": self.wall_time,
            "model": "dem2d",
            "version": self.provenance.get("version", ""),
        }

    def citation(self) -> str:
        """What to cite for this run: the package, the sources of its model, and where its motion comes from."""
        return cite_run(self.provenance).text

    def to_xarray(self) -> xarray.Dataset:
        """Histories as a labelled data set with units."""
        import xarray

        both = ("time", "body")
        data = {
            "x": (both, self.x, {"units": "m"}),
            "z": (both, self.z, {"units": "m"}),
            "rotation": (both, self.rotation, {"units": "rad"}),
            "ground_acceleration": (("time",), self.ground_acceleration, {"units": "m s-2"}),
            "ground_displacement": (("time",), self.ground_displacement, {"units": "m"}),
        }
        data |= {f"energy_{name}": (("time",), values, {"units": "J"}) for name, values in self.energy.items()}
        names = [block.name for block in self.assembly.bodies]
        plain = {key: value for key, value in self.summary().items() if isinstance(value, (str, float, int))}
        plain = {key: int(value) if isinstance(value, bool) else value for key, value in plain.items()}
        texts = {
            "assembly": json.dumps(self.assembly.to_dict()),
            "provenance": json.dumps(self.provenance, default=str),
        }
        return xarray.Dataset(data, {"time": self.time, "body": names}, {"format": FORMAT} | plain | texts)

    def save(self, path: str | Path) -> Path:
        """Write netCDF; the file appears whole or not at all."""
        target = Path(path)
        with replacing(target) as partial:
            self.to_xarray().to_netcdf(partial, engine="h5netcdf")
        return target
