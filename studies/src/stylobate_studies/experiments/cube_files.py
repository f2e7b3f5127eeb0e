"""Tosses of a cube as a file: poses and velocities by motion capture; what cannot be used is said and left out."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from stylobate.column.joint import Joint
from stylobate.column.specimen import Specimen
from stylobate.errors import InputError

from . import choices as c
from .granite_files import arrays

#: Half width [m], mass [kg] and moment of inertia [kg m²] of the cube.
HALF, MASS, MOMENT = 0.0524, 0.37, 0.295 * 0.0524**2

#: The length of a quaternion may differ by this much from 1, velocities by this factor from those of the positions.
UNIT, SAME = 1e-3, 1.1


@dataclass(frozen=True, eq=False)
class Recorded:
    """One toss: time step [s], positions [m], shape (T, 3), and unit quaternions, real part first, shape (T, 4)."""

    name: str
    dt: float
    position: np.ndarray
    orientation: np.ndarray


@dataclass
class Tosses:
    """Usable and refused parts of a file."""

    tosses: list[Recorded] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)


def cube(friction: float, restitution: float) -> Specimen:
    """The cube as a specimen, with its published mass, size and inertia."""
    corners = HALF * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    joint = Joint(c.CUBE_STIFFNESS, 0.5 * c.CUBE_STIFFNESS, friction_coefficient=friction)
    return Specimen(MASS, np.full(3, MOMENT), corners, "cube", joint, restitution)


def read_tosses(folder: Path) -> Tosses:
    """Read ``tosses.npz`` of a folder.

    Raises
    ------
    InputError
        The file cannot be read or has no time step. Single tosses that cannot be used are refused in the result.
    """
    archive = arrays(folder / "tosses.npz")
    dt = float(archive["dt"]) if "dt" in archive and np.ndim(archive["dt"]) == 0 else math.nan
    if not 0.0 < dt <= 0.1:
        raise InputError(f"{folder / 'tosses.npz'} has no time step dt between 0 and 0.1 s; the tosses cannot be used.")
    out = Tosses()
    for name in sorted(key for key in archive if key[:1] == "t" and key[1:].isdecimal()):
        states = np.asarray(archive[name])
        why = _unusable(states, dt)
        if why:
            out.refused.append(f"toss {name} {why}")
        else:
            out.tosses.append(Recorded(name, dt, states[:, :3].astype(float), states[:, 3:7].astype(float)))
    return out


def _unusable(states: np.ndarray, dt: float) -> str:
    if states.ndim != 2 or states.shape[1] != 13 or len(states) < 20 or not np.issubdtype(states.dtype, np.floating):
        return f"has the shape {states.shape}; (20 or more, 13) is expected"
    if not np.isfinite(states).all():
        return "holds numbers that are not finite"
    if np.abs(np.linalg.norm(states[:, 3:7], axis=1) - 1.0).max() > UNIT:
        return "has quaternions that are not of length 1"
    moved, stated = np.diff(states[:, :3], axis=0) / dt, states[1:, 7:10]
    ratio = float(np.sqrt((moved**2).sum() / max(float((stated**2).sum()), 1e-300)))
    if not 1.0 / SAME <= ratio <= SAME:
        return f"has velocities {1.0 / ratio:.3g} times those of its positions: another time step or unit"
    return ""
