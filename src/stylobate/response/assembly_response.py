"""What happened to an assembly: histories of all its bodies, energy, and how it lies at the end."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..bibliography import cite_run
from ..column.assembly import Assembly
from ..outcome import Outcome
from .assembly_measures import classify_assembly, fallen_since, joint_histories

if TYPE_CHECKING:
    import xarray


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
    def model(self) -> str:
        """Name of the model, as on the command line."""
        return self.provenance.get("model", "dem2d")

    @cached_property
    def joint_opening(self) -> np.ndarray:
        """Largest gap between the faces of every joint of ``assembly.joints``, from the start [m], shape (T, J)."""
        return self._joints[0]

    @cached_property
    def joint_slip(self) -> np.ndarray:
        """Offset along every joint, from the start [m], shape (T, J)."""
        return self._joints[1]

    @cached_property
    def _joints(self) -> tuple[np.ndarray, np.ndarray]:
        return joint_histories(self.assembly, self.x, self.z, self.rotation)

    @cached_property
    def displacement(self) -> np.ndarray:
        """Distance of every centroid from where it was at the start [m], shape (T, N)."""
        return np.hypot(self.x - self.x[0], self.z - self.z[0])

    @cached_property
    def fell_at(self) -> dict[str, float]:
        """When each block had fallen that has at the end [s].

        Fallen is what lies lower by more than half of the smaller side of its box, or has turned by over 45°.
        """
        since = fallen_since(self.assembly, self.z, self.rotation)
        return {self.assembly.bodies[i].name: float(self.time[k]) for i, k in since.items()}

    @property
    def fallen(self) -> tuple[str, ...]:
        """Blocks that have fallen."""
        return tuple(self.fell_at)

    @property
    def collapsed(self) -> bool:
        """Whether a block has fallen; never of a run that failed."""
        return bool(self.fell_at) and not self.failed

    @property
    def decided(self) -> bool:
        """Whether everything lies still, or something has fallen: otherwise the verdict could change."""
        return not self.failed and (self.at_rest or self.collapsed)

    @cached_property
    def outcome(self) -> Outcome:
        """How the run ended: as for columns, from the recorded states."""
        if self.failed:
            return Outcome.FAILED
        return classify_assembly(self.assembly, self.displacement, self.joint_opening, self.joint_slip, self.collapsed)

    def describe(self) -> str:
        """The outcome in one or two sentences."""
        bodies, fell = self.assembly.bodies, self.fell_at
        moving = [i for i, block in enumerate(bodies) if not block.fixed]
        all_of_them = {1: "The block is", 2: "Both blocks are"}.get(len(moving), f"All {len(moving)} blocks are")
        in_place = f"{all_of_them} in place"
        if self.outcome is Outcome.FAILED:
            return "The computation could not be completed; this is no verdict on the assembly."
        if self.outcome is Outcome.COLLAPSED:
            order = sorted(fell, key=lambda name: fell[name])
            names = ", ".join(order[:6]) + (f" and {len(order) - 6} more" if len(order) > 6 else "")
            return f"{len(order)} of {len(moving)} blocks fell, the first at {fell[order[0]]:.2f} s: {names}."
        if self.outcome is Outcome.DISPLACED:
            far = max(moving, key=lambda i: self.displacement[-1, i])
            by = 1000.0 * float(self.displacement[-1, far])
            return f"{in_place}, but shifted: {bodies[far].name} by {by:.3g} mm, the others by less."
        if self.outcome is Outcome.ROCKED:
            return f"{in_place}: joints opened and closed, none is shifted."
        return f"{in_place}: no joint opened."

    def outline(self, index: int, body: int) -> np.ndarray:
        """Corners of a body at a recorded state [m], shape (k, 2)."""
        block = self.assembly.bodies[body]
        angle = self.rotation[index, body]
        c, s = np.cos(angle), np.sin(angle)
        return (block.corners - block.origin) @ np.array([[c, s], [-s, c]]) + (self.x[index, body], self.z[index, body])

    def summary(self) -> dict:
        """The JSON object of ``stylobate run`` for an assembly; peaks end when the first block has fallen."""
        first = min(self.fell_at.values(), default=None) if self.collapsed else None
        until = slice(None) if first is None else self.time <= first
        return {
            "outcome": self.outcome.label,
            "collapsed": self.collapsed,
            "decided": self.decided,
            "collapse_time_s": first,
            "fallen": list(self.fallen),
            "at_rest": self.at_rest,
            "in_equilibrium_as_drawn": self.provenance.get("in_equilibrium_as_drawn"),
            "peak_displacement_m": float(self.displacement[until].max()),
            "residual_displacement_m": float(self.displacement[-1].max()),
            "peak_rotation_rad": float(np.abs(self.rotation - self.rotation[0])[until].max()),
            "peak_joint_opening_m": float(self.joint_opening[until].max(initial=0.0)),
            "residual_joint_slip_m": float(np.abs(self.joint_slip[-1]).max(initial=0.0)),
            "energy_imbalance": self.energy_imbalance,
            "time_step_s": self.time_step,
            "steps": self.steps,
            "wall_s": self.wall_time,
            "model": self.model,
            "version": self.provenance.get("version", ""),
        }

    def citation(self) -> str:
        """What to cite for this run: the package, the sources of its model, and where its motion comes from."""
        return cite_run(self.provenance).text

    def to_xarray(self) -> xarray.Dataset:
        """Histories as a labelled data set with units."""
        from .assembly_store import to_dataset

        return to_dataset(self)

    def save(self, path: str | Path) -> Path:
        """Write netCDF; the file appears whole or not at all."""
        from .assembly_store import save

        return save(self, path)

    @classmethod
    def load(cls, path: str | Path) -> AssemblyResponse:
        """Read a response written by :meth:`save`."""
        from .assembly_store import load

        return load(path)
