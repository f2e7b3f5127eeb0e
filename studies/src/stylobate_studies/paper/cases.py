"""Computations of the study: columns, models, motions, grids, and the parameters that the paper leaves open."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from stylobate.column import Column, preset
from stylobate.column.catalogue import PAPER
from stylobate.column.scatter import WITHIN, Scatter
from stylobate.constants import g
from stylobate.models.base import Model
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rigid_block.model import RigidBlock
from stylobate.motion.pulses import MotionScatter

#: The thirty harmonic cases. The paper prints the ranges, 0.66 to 4 Hz and 0.1 g to 0.5 g; the values are chosen here.
FREQUENCIES = np.array([0.66, 1.0, 1.5, 2.0, 3.0, 4.0])
AMPLITUDES = np.array([0.1, 0.2, 0.3, 0.4, 0.5]) * g

#: Length of every motion, and the time after it in which most columns come to a verdict [s]; the paper prints neither.
DURATION, TAIL = 10.0, 5.0

MONOLITH, DRUMS = PAPER

#: The columns, for people.
SHORT = {MONOLITH: "monolith", DRUMS: "drums"}
BEAM, SLIDING, BLOCKS, DEM = "rigid beam (paper)", "rigid beam with sliding", "rigid block", "distinct elements"

MODELS: Mapping[str, Model] = {
    BEAM: RigidBeam.paper(),
    SLIDING: RigidBeam(sliding=True),
    BLOCKS: RigidBlock(),
    DEM: DistinctElement2D(),
}

#: Open parameters, one changed at a time but where two are named: the model, and the changes of column and duration.
VARIANTS: Mapping[str, tuple[str, Model, dict, float]] = {
    "beam, as the paper": (BEAM, RigidBeam.paper(), {}, DURATION),
    "beam, ξ = 0.9": (BEAM, RigidBeam.paper(moment_law="trilinear", xi=0.9), {}, DURATION),
    "beam, ξ = 0.8": (BEAM, RigidBeam.paper(moment_law="trilinear", xi=0.8), {}, DURATION),
    "beam, K_M / 10": (BEAM, RigidBeam.paper(), {"normal_stiffness": 5.0e9}, DURATION),
    "beam, law in relative rotations": (BEAM, RigidBeam.paper(rotation="relative"), {}, DURATION),
    "beam, α of the whole stack": (BEAM, RigidBeam.paper(rotation="relative", critical_angle="stack"), {}, DURATION),
    "beam, gravity in the equations": (BEAM, RigidBeam(moment_law="bilinear", idealisation="prism"), {}, DURATION),
    "beam, true drums": (BEAM, RigidBeam(), {}, DURATION),
    "beam, β = 0.1 ms": (BEAM, RigidBeam.paper(stiffness_damping=1e-4), {}, DURATION),
    "beam, β = 0.5 ms": (BEAM, RigidBeam.paper(stiffness_damping=5e-4), {}, DURATION),
    "beam, gravity and β = 0.01 ms": (
        BEAM,
        RigidBeam(moment_law="bilinear", idealisation="prism", stiffness_damping=1e-5),
        {},
        DURATION,
    ),
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

PLANE, TWIN, SPACE = "plane", "planar twin", "space"

#: The same round columns three times: the plane model, the model in space held in its plane, and in space.
POPULATIONS: Mapping[str, Model] = {
    PLANE: DistinctElement2D(),
    TWIN: DistinctElement3D(planar=True),
    SPACE: DistinctElement3D(),
}


def alike(within: float) -> Scatter:
    """Drums, friction and stiffness that differ by this much at most [-]: draws end at 2.5 standard deviations."""
    size = within / WITHIN
    return Scatter(friction=size, joint_stiffness=size, density=0.0, width=size, height=size, offset=0.0)


#: Columns of a population.
ALIKE = alike(0.01)

#: Up to 1 % of the shaking across, which alone takes a round column out of the plane: every model sees the same columns and
#: motions, and the plane ones leave the component across out.
ACROSS = MotionScatter(across=0.01)

#: Plane computations that are held against the columns in space: (model, section).
RIVALS = ((BEAM, "circular"), (BLOCKS, "circular"), (DEM, "circular"), (DEM, "rectangular"))

#: The distinct elements that the variants are compared with.
REFERENCE = "DEM, two points"

#: Left out of the coarse study: their loops are compiled for them alone.
SLOW_VARIANTS = ("DEM, five points", "DEM, β = 0.1 ms", "beam, β = 0.1 ms", "DEM, 20 s")


@dataclass(frozen=True)
class Grids:
    """Fineness of the study.

    Parameters
    ----------
    frequencies, amplitudes : array
        Of the domains [Hz], [m/s²].
    tail : float
        Time after each motion [s].
    circular : tuple of str
        Models whose domains are computed for the circular columns as well.
    variants : tuple of str
        Names of :data:`VARIANTS` that are computed.
    variant_frequencies, variant_amplitudes : array
        Of the domains with one parameter changed.
    limit_amplitudes : array
        At 0.1 Hz, where a column overturns as if the forces were static [m/s²].
    doubt_frequencies, doubt_amplitudes : array
        Where verdicts are asked for again: with half of the step, and of slightly different columns.
    replicates : int
        Number of slightly different columns.
    space_frequencies, space_amplitudes : array
        Of the populations of round columns in space [Hz], [m/s²].
    space_replicates : int
        Number of slightly different round columns.
    """

    frequencies: np.ndarray
    amplitudes: np.ndarray
    tail: float
    circular: tuple[str, ...]
    variants: tuple[str, ...]
    variant_frequencies: np.ndarray
    variant_amplitudes: np.ndarray
    limit_amplitudes: np.ndarray
    doubt_frequencies: np.ndarray
    doubt_amplitudes: np.ndarray
    replicates: int
    space_frequencies: np.ndarray
    space_amplitudes: np.ndarray
    space_replicates: int

    @classmethod
    def of(cls, quick: bool) -> Grids:
        """The coarse or the fine study."""
        limit = np.arange(0.140, 0.2401, 0.002) * g
        if quick:
            fast_variants = tuple(name for name in VARIANTS if name not in SLOW_VARIANTS)
            return cls(
                np.linspace(0.25, 4.0, 16), np.linspace(0.1, 0.5, 13) * g, TAIL, (BEAM, DEM), fast_variants,
                np.array([0.66, 1.0, 2.0]), np.linspace(0.12, 0.6, 13) * g, limit,
                np.linspace(0.3, 1.7, 8), np.linspace(0.2, 0.6, 9) * g, 6,
                np.array([0.66, 1.0, 1.5]), np.linspace(0.2, 0.6, 5) * g, 6,
            )  # fmt: skip
        return cls(
            np.linspace(0.2, 4.0, 39), np.linspace(0.1, 0.6, 41) * g, TAIL, (BEAM, BLOCKS, DEM), tuple(VARIANTS),
            np.array([0.33, 0.66, 1.0, 1.5, 2.0]), np.linspace(0.12, 0.6, 25) * g, limit,
            np.linspace(0.3, 1.7, 15), np.linspace(0.2, 0.6, 33) * g, 30,
            np.array([0.33, 0.5, 0.66, 1.0, 1.5, 2.0]), np.linspace(0.15, 0.6, 10) * g, 16,
        )  # fmt: skip


def paper_column(name: str, section: str = "rectangular") -> Column:
    """One of the paper's columns; ``circular`` turns its widths into diameters."""
    column = preset(name)
    if section == "rectangular":
        return column
    drums = tuple(dataclasses.replace(drum, section=section) for drum in column.drums)
    return column.replace(drums=drums, name=f"{name}, {section}")
