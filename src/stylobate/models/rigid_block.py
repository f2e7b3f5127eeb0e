"""Rigid block model: true drums, each joint one elastic–plastic interface on the N–V–M domain; stepped explicitly."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from ..column import Column
from ..errors import InputError, OutOfRangeWarning, check_range
from ..motion import Motion
from ..response import Measures, Response
from .base import Case, Model, RunOptions
from .drum_block import BASE_HALF_WIDTH, DrumBlock, PackedColumn, histories
from .lanes import run_lanes


@dataclass(frozen=True)
class RigidBlock(Model):
    """Rigid drums with three coordinates each, joined by interfaces with compression, shear and moment at one place.

    Parameters
    ----------
    compressive_strength : float, optional
        f_c of every joint [Pa]: |M| ≤ |N| d/2 (1 − |N|/(f_c A)), and a toe that has crushed stays crushed. None for
        unlimited strength.
    step_factor : float
        Time step as a share of the largest stable one.
    time_step : float, optional
        Time step [s], instead of ``step_factor``.
    stiffness_damping : float
        β: dashpots of β times the joint's stiffness at the point of contact, while it is pressed [s].
    mass_damping : float
        α: force −α m v on every drum, v relative to the base [1/s].

    Notes
    -----
    Compression and moment are holonomic (no tension, eccentricity inside the faces' overlap: rocking gives back what it
    takes), shear is plastic (Mohr–Coulomb without dilatancy): ``docs/theory/rigid_block.md``. Rotations may be large.

    Steps are explicit, as in the distinct element model, because a joint closes and opens within a millisecond: an
    implicit step that followed it would have to be as short, and would solve a system in each. *Collapsed* and
    *decided* mean what they mean there.

    References
    ----------
    Baraldi, Sarhosis and Milani, section 2.3.
    """

    name: ClassVar[str] = "rigid-block"
    title: ClassVar[str] = "rigid blocks with interfaces"
    references: ClassVar[tuple[str, ...]] = ("baraldi",)
    #: The columns start closed by their static weight.
    start: ClassVar[str] = "static"

    compressive_strength: float | None = None
    step_factor: float = 0.2
    time_step: float | None = None
    stiffness_damping: float = 0.0
    mass_damping: float = 0.0

    def __post_init__(self) -> None:
        if self.compressive_strength is not None:
            check_range("compressive_strength", self.compressive_strength, 0.0, 1e12, unit="Pa", open_low=True)
        check_range(
            "step_factor", self.step_factor, 0.0, 1.0, open_low=True, open_high=True, remedy="0.2 is the default"
        )
        if self.time_step is not None:
            check_range("time_step", self.time_step, 0.0, 1.0, unit="s", open_low=True)
        check_range("stiffness_damping", self.stiffness_damping, 0.0, 1.0, unit="s")
        check_range("mass_damping", self.mass_damping, 0.0, 1e3, unit="1/s")

    @property
    def damped(self) -> bool:
        """Whether any damping acts during the run."""
        return self.stiffness_damping > 0.0 or self.mass_damping > 0.0

    # -- before the run ------------------------------------------------------------------------------------------

    def check(self, column: Column, motion: Motion) -> None:
        """Refuse an unstable step and joints that crush under the weight; say what a plane model leaves out."""
        self.step_for(column)
        if self.compressive_strength is not None:
            stress = column.joint_weights / column.joint_areas
            worst = int(np.argmax(stress))
            if stress[worst] >= self.compressive_strength:
                raise InputError(
                    f"joint {worst + 1} crushes under the column's own weight: compressive_strength is "
                    f"{self.compressive_strength:g} Pa; allowed is above {stress[worst]:.4g} Pa."
                )
        if motion.lateral is not None:
            warnings.warn(
                f"the second horizontal component of {motion.name!r} is left out: rigid-block is a plane model.",
                OutOfRangeWarning,
                stacklevel=3,
            )

    def step_for(self, column: Column) -> float:
        """Time step for a column [s].

        Raises
        ------
        InputError
            The step asked for is above the largest stable one.
        """
        stable = stable_step(column, self.stiffness_damping)
        if self.time_step is None:
            return self.step_factor * stable
        if self.time_step >= stable:
            raise InputError(
                f"time_step is {self.time_step:g} s; the largest stable step for this column is {stable:.4g} s: "
                f"give at most {0.9 * stable:.3g} s, or leave it out."
            )
        return self.time_step

    # -- what a block of lanes needs -----------------------------------------------------------------------------

    def kernel(self) -> Any:
        """Module of kernels."""
        from ..kernels import rigid_block

        return rigid_block

    def record_types(self) -> tuple:
        """Record types of the kernel's arrays."""
        return self.kernel().block_types(self.compressive_strength is not None, self.damped)

    def pack(self, column: Column) -> PackedColumn:
        """A column as the kernel wants it."""
        return _pack(column, self)

    # -- runs ----------------------------------------------------------------------------------------------------

    def run(self, column: Column, motion: Motion, options: RunOptions) -> Response:
        """One run with histories, through the same kernel as a batch."""
        block = DrumBlock(self, column.n, options)
        block.load(0, Case(column, motion))
        chunks = math.ceil(block.steps[0] / block.chunk)
        stride = max(1, min(chunks, round(options.output_interval / (block.chunk * block.dt[0]))))
        states = [block.snapshot(0)]
        while not block.is_over(0):
            block.advance(stride)
            states.append(block.snapshot(0))
        measures = block.collect(0)
        provenance = {"time_step_s": block.dt[0]}
        return Response(column, histories(motion, states), measures, self.name, provenance)

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs through blocks of lanes; columns, joints and motions may differ from lane to lane."""
        by_drums: dict[int, list[int]] = {}
        for index, case in enumerate(cases):
            by_drums.setdefault(case.column.n, []).append(index)
        for drums, indices in by_drums.items():
            some = [cases[index] for index in indices]
            for k, measures in run_lanes(lambda drums=drums: DrumBlock(self, drums, options), some, threads):
                yield indices[k], measures


@lru_cache(maxsize=4096)
def _pack(column: Column, model: RigidBlock) -> PackedColumn:
    n, drums, area = column.n, column.drums, column.joint_areas
    kn, km, ks = joint_stiffness(column)

    def on_base(values: Sequence[float] | np.ndarray, base: float = 0.0) -> np.ndarray:
        return np.concatenate(([base], values))

    def under_air(values: Sequence[float] | np.ndarray) -> np.ndarray:
        return np.concatenate((values, [0.0]))

    centroid = np.array([drum.centroid_height for drum in drums])
    half = np.array([min(low, high) for low, high in zip(*_half_widths(column), strict=True)])
    limits = np.broadcast_to(under_air(half)[:, None], (n + 1, 2 if model.compressive_strength is not None else 1))
    drum_fields = {
        "x": np.zeros(n + 1),
        "z": on_base(column.centroid_heights - np.cumsum(column.joint_weights / kn)),
        "th": np.zeros(n + 1),
        "c": np.ones(n + 1),
        "s": np.zeros(n + 1),
        "vx": np.zeros(n + 1),
        "vz": np.zeros(n + 1),
        "w": np.zeros(n + 1),
        "m": on_base(column.masses),
        "i": on_base(column.inertias),
        "im": on_base(1.0 / column.masses),
        "ii": on_base(1.0 / column.inertias),
        "hb": on_base(centroid),
        "ht": on_base(column.heights - centroid),
        "b": on_base([drum.bottom_width / 2 for drum in drums]),
        "t": on_base([drum.top_width / 2 for drum in drums], BASE_HALF_WIDTH),
    }
    strength = model.compressive_strength
    joint_fields = {
        "kn": under_air(kn),
        "km": under_air(km),
        "ks": under_air(ks),
        "co": under_air([joint.cohesion for joint in column.joints] * area),
        "mu": under_air([joint.tan_phi for joint in column.joints]),
        "crush": np.zeros(n + 1) if strength is None else under_air(1.0 / (strength * area)),
        "tau": np.zeros(n + 1),
        "chi": np.ones(n + 1),
        "sp": np.zeros(n + 1),
        "gap": np.zeros(n + 1),
        "fs": np.zeros(n + 1),
        "lim": limits,
    }
    lane_fields = {
        "g": column.gravity,
        "beta": model.stiffness_damping,
        "alpha": model.mass_damping,
        "local": 0.0,
        "work": 0.0,
        "shear": 0.0,
        "visc": 0.0,
    }
    return PackedColumn((drum_fields, joint_fields, lane_fields), model.step_for(column))


def _half_widths(column: Column) -> tuple[np.ndarray, np.ndarray]:
    """Half widths of the upper and of the lower face of each joint [m]."""
    upper = np.array([drum.bottom_width / 2 for drum in column.drums])
    lower = np.array([BASE_HALF_WIDTH] + [drum.top_width / 2 for drum in column.drums[:-1]])
    return upper, lower


def joint_stiffness(column: Column) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """k_n A [N/m], k_n J [N m] and k_s A [N/m] of each joint (Baraldi et al., Eq. 8), each of shape (n,)."""
    kn = np.array([joint.normal_stiffness for joint in column.joints])
    ks = np.array([joint.shear_stiffness for joint in column.joints])
    return kn * column.joint_areas, kn * column.joint_second_moments, ks * column.joint_areas


@lru_cache(maxsize=4096)
def stable_step(column: Column, stiffness_damping: float = 0.0) -> float:
    """Largest stable step of central differences for the closed column [s].

    2/ω (√(1 + ζ²) − ζ), ζ = β ω / 2, from the highest frequency of the column on its elastic joints.
    """
    from .block_stack import BlockStack

    kn, km, ks = joint_stiffness(column)
    strain = BlockStack.of_column(column).compatibility()
    stiffness = strain.T @ (np.stack((kn, ks, km), axis=1).ravel()[:, None] * strain)
    root = 1.0 / np.sqrt(np.stack((column.masses, column.masses, column.inertias), axis=1).ravel())
    omega = math.sqrt(float(np.linalg.eigvalsh(stiffness * np.outer(root, root))[-1]))
    zeta = 0.5 * stiffness_damping * omega
    return 2.0 / omega * (math.sqrt(1.0 + zeta * zeta) - zeta)
