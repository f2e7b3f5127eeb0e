"""Round columns in space: what tests and validation cases share, and exact motions to hold them against."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

from stylobate.column import Column, Drum, Joint
from stylobate.kernels.dem3d.standing import lowest_barrier
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.dem3d.packing import numbers_for
from stylobate.models.engine import engine_for
from stylobate.models.start import Start
from stylobate.motion import Motion


def joint(stiffness: float, friction: float = 0.7) -> Joint:
    """A joint whose shear stiffness is half its normal one."""
    return Joint(stiffness, 0.5 * stiffness, friction_coefficient=friction)


def round_column(drums: int = 1, stiffness: float = 5e10, friction: float = 0.7) -> Column:
    """The paper's column with circular sections."""
    return Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=drums, density=1600.0, joint=joint(stiffness, friction),
        section="circular",
    )  # fmt: skip


def cylinder(diameter: float, height: float, stiffness: float = 5e10, friction: float = 0.7) -> Column:
    """A single cylindrical drum, flatter than any column too."""
    drum = Drum(height, diameter, diameter, 1600.0, section="circular")
    return Column.of_fields(drums=(drum,), joints=(joint(stiffness, friction),), name="cylinder")


def released(column: Column, start: Start, duration: float, every: int = 1, **options) -> tuple[np.ndarray, np.ndarray]:
    """Free motion of a column from a pose: times, and the axes of its lowest drum as columns of matrices, (T, 3, 3)."""
    model = DistinctElement3D(**options)
    block = engine_for(model, column).block(RunOptions(start=start, until_end=True))
    block.load(0, Case(column, Motion(duration, np.zeros(2))))
    times, axes = [0.0], [block.records.axes(0)[0]]
    while not block.is_over(0):
        block.advance(every)
        times.append(block.time(0))
        axes.append(block.records.axes(0)[0])
    return np.array(times), np.array(axes)


def wobble(tilt: float, precession: float, spin: float = 0.0) -> Start:
    """A start leaning along x, with the lean turning about z at a rate and a spin about the own axis [rad/s]."""
    d = np.array([math.cos(tilt), 0.0, -math.sin(tilt)])
    return Start(tilt, 0.0, tuple(-precession * math.sin(tilt) * d + spin * axis_of(tilt, 0.0)))


def axis_of(tilt: float, azimuth: float) -> np.ndarray:
    """Unit vector of a body's axis."""
    return np.array([math.sin(tilt) * math.cos(azimuth), math.sin(tilt) * math.sin(azimuth), math.cos(tilt)])


@cache
def rolling(column: Column, tilt: float, precession: float, spin: float, duration: float):
    """Rigid rolling without slipping of one round body on the rim of its face: dense solution for (θ, φ, ψ, ω_d, ω_t, ω_3).

    In the frame of lean: d down the face, t across, k the axis. Momentum about the centroid, d(Aω_d, Aω_t, Cω_3)/dt +
    Ω × L = r × m (dv/dt + Ω × v + g z), with v = −ω × r, r from the centroid to the contact and Ω the rate of the frame.
    """
    drum = column.drums[0]
    m, b, a = drum.mass, drum.centroid_height, 0.5 * drum.bottom_width
    inertia = np.diag([drum.inertia, drum.inertia, drum.axial_inertia])
    arm = np.array([a, 0.0, -b])

    def rates(_, y):
        theta, _, _, *w = y
        w = np.array(w)
        phi_dot = -w[0] / math.sin(theta)
        frame = np.array([w[0], w[1], phi_dot * math.cos(theta)])
        up = np.array([-math.sin(theta), 0.0, math.cos(theta)])
        v = -np.cross(w, arm)

        def moment(turning):
            return inertia @ turning - np.cross(arm, -m * np.cross(turning, arm))

        matrix = np.stack([moment(axis) for axis in np.eye(3)], axis=1)
        given = np.cross(arm, m * (np.cross(frame, v) + column.gravity * up)) - np.cross(frame, inertia @ w)
        turning = np.linalg.solve(matrix, given)
        return [w[1], phi_dot, w[2] - phi_dot * math.cos(theta), *turning]

    first = [tilt, 0.0, 0.0, -precession * math.sin(tilt), 0.0, spin]
    return solve_ivp(rates, (0.0, duration), first, method="DOP853", rtol=1e-11, atol=1e-13, dense_output=True)


def block_of(column: Column, duration: float = 1.0, **options):
    """A block with the column at rest in every lane, for tests that set or read states themselves."""
    model = DistinctElement3D(**options)
    block = engine_for(model, column).block(RunOptions(until_end=True))
    for lane in range(block.lanes):
        block.load(lane, Case(column, Motion(duration, np.zeros(2))))
    return block


def flat_barrier(column: Column, slip, turns=None, toes=None, walks: bool = False) -> float:
    """Lowest barrier of a column put down flat with these slips [m] and turns of its bodies [rad], in [J]."""
    stand = numbers_for(column, np.zeros((2, column.n)) if toes is None else toes)
    turns = np.zeros(column.n + 1) if turns is None else turns
    return float(lowest_barrier(stand, slip, turns, column.section != "circular", column.gravity, walks))


def put_axes(block, drum: int, lane: int, matrix: np.ndarray) -> None:
    """Set the axes of a drum (0 is the base) to the columns of a matrix."""
    for a, axis in enumerate("ijk"):
        for c, name in enumerate("xyz"):
            block.records.body[axis + name][drum, lane] = matrix[c, a]


def put(block, drum: int, lane: int, names: str, vector) -> None:
    """Set a vector of a drum, e.g. ``put(block, 1, 0, "vx vy vz", (1.0, 0.0, 0.0))``."""
    for name, value in zip(names.split(), vector, strict=True):
        block.records.body[name][drum, lane] = value
