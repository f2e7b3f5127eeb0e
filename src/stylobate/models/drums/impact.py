"""Stiffness damping by what an impact is to leave: from free rocking of the column as one body, in its own plane.

A block that rocks from one edge to the other lands on Kelvin–Voigt contacts of k_n A and β k_n A. Its weight does next to
nothing while that lasts, so that what it keeps hangs on β √(k_n A/m), its shape, its friction and k_s/k_n alone, not on how
fast it lands: one curve for a column, which ends at the plastic impact of rigid bodies (Housner) as β grows.
"""

from __future__ import annotations

import dataclasses
import math
from functools import lru_cache
from typing import Any

import numpy as np

from ...column import Column, Drum
from ...column.materials import IMPACT
from ...errors import InputError
from ...kernels.dem3d.records import BETA  # the row of a lane's damping, in the plane too
from ...motion import Motion
from ..base import Case, RunOptions
from ..start import Start
from .released import followed

#: Damping that is tried, one value per lane besides none [s].
TRIED = np.concatenate(([0.0], np.geomspace(1e-6, 3e-3, 15)))

#: Released at this share of the critical angle.
RELEASE = 0.5

#: An impact of stone leaves what it should to this share of the velocity: measured ones scatter by six times as much, and
#: β beyond that costs steps, as the curve ends there in an asymptote.
CLOSE = 0.008

#: Least damping of joints that are damped [s]: where springs alone lose more than is asked for, that does nothing.
LEAST = 1e-12


def one_body(column: Column) -> Column:
    """The column as a single drum of its outline and mass on the joint with the base."""
    first, last = column.drums[0], column.drums[-1]
    ends = first.depth, None if column.section == "circular" else last.upper_depth
    drum = Drum(column.height, first.bottom_width, last.top_width, first.density, column.section, *ends)
    drum = dataclasses.replace(drum, density=first.density * column.mass / drum.mass)
    who = {"name": f"{column.name} as one body", "gravity": column.gravity}
    return Column.of_fields(drums=(drum,), joints=column.joint_laws[:1], **who)


@lru_cache(maxsize=1024)
def restitutions(column: Column, model: Any) -> np.ndarray:
    """Velocity restitution of the first impact at each damping of ``TRIED``; the model has no restitution of its own."""
    body = one_body(column)
    alone = {"planar": True} if "y" in model.axes else {"start": "static"}
    damping = {"stiffness_damping": float(TRIED[-1]), "mass_damping": 0.0}
    twin = dataclasses.replace(model, **damping, **alone, time_step=None)
    tilt = RELEASE * body.slenderness
    block = twin.block_for(twin.kind(body), RunOptions(start=Start(tilt), until_end=True))
    duration = 10.0 / body.frequency_parameter
    for lane, beta in enumerate(TRIED):
        block.load(lane, Case(body, Motion(duration, np.zeros(2))))
        block.lane["damp"][0, BETA, lane] = beta
    other = np.array([block.lean()[: len(TRIED)] for _ in followed(block, 1, 1)])
    found = np.empty(len(TRIED))
    for lane in range(len(TRIED)):
        crossed = int(np.argmax(other[:, lane] < 0.0))
        back = other[crossed:, lane]
        until = int(np.argmax(back > 0.0)) or len(back)
        peak = -float(back[:until].min())
        found[lane] = math.sqrt(_energy(peak, body.slenderness) / _energy(tilt, body.slenderness))
    return found


def _energy(tilt: float, slenderness: float) -> float:
    """Rise of the centroid over the distance of the corner from it [-]."""
    return math.cos(slenderness - tilt) - math.cos(slenderness)


def damping_for(column: Column, model: Any, restitution: float) -> float:
    """Stiffness damping β at which the first impact of the column as one body has a velocity restitution [s].

    Raises
    ------
    InputError
        No damping that is tried gives it.
    """
    found = np.minimum.accumulate(restitutions(column, model))
    if not found[-1] <= restitution <= found[0]:
        raise InputError(
            f"restitution is {restitution:g}; the joints of {column.name!r} give {found[-1]:.3f} to {found[0]:.3f} "
            f"(damped by {TRIED[-1]:g} s and undamped): choose one of these, or give stiffness_damping."
        )
    return float(np.interp(-restitution, -found, TRIED))


def damping_of_stone(column: Column, model: Any) -> float:
    """β at which an impact of the column leaves what stone does, ``IMPACT`` times Housner's restitution [s].

    It is the least that comes within ``CLOSE``. Where joints lose as much without any damping there is next to none; where
    they give back more at the largest that is tried, it is that one.
    """
    found = np.minimum.accumulate(restitutions(column, model))
    wanted = (1.0 + CLOSE) * IMPACT.value * one_body(column).restitution
    return max(LEAST, float(np.interp(-wanted, -found, TRIED)))
