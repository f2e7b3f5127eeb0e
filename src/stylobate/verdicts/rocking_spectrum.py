"""Rocking spectrum of a motion: peak rotation of Housner's blocks of all sizes and slendernesses."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..column import Column, Drum, Joint
from ..constants import g
from ..errors import InputError, check_kind
from ..models.base import Case
from ..models.rocking.model import HousnerBlock
from ..motion import Motion, pulse_match
from ..notebook import NotebookSummary
from ..outcome import Outcome
from ..simulate import run_cases

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, eq=False)
class RockingSpectrum(NotebookSummary):
    """Peaks of rigid rocking blocks.

    Parameters
    ----------
    frequency_parameter : array
        p of the blocks [rad/s], shape (P,).
    slenderness : array
        α of the blocks [rad], shape (A,).
    peak_rotation : array
        Largest |θ| [rad], shape (P, A); α and more for blocks that fell.
    collapsed : array of bool
        Shape (P, A).
    decided : array of bool
        False where a block was still far from rest at the end, shape (P, A).
    motion : str
        Name of the motion.
    pga : float
        Its peak along x [m/s²].
    pulse_period : float
        Period of its strongest pulse [s]; NaN without one.
    failed : array of bool, optional
        Blocks that could not be computed, shape (P, A); none by default.
    """

    frequency_parameter: np.ndarray
    slenderness: np.ndarray
    peak_rotation: np.ndarray
    collapsed: np.ndarray
    decided: np.ndarray
    motion: str
    pga: float
    pulse_period: float
    failed: np.ndarray | None = None

    @property
    def frequency_ratio(self) -> np.ndarray:
        """ω_g/p, frequency of the motion's strongest pulse to that of the blocks, shape (P,)."""
        return 2.0 * np.pi / self.pulse_period / self.frequency_parameter

    @property
    def acceleration_ratio(self) -> np.ndarray:
        """PGA/(g tan α), peak of the motion to the uplift acceleration of the blocks, shape (A,)."""
        return self.pga / (g * np.tan(self.slenderness))

    @property
    def closed(self) -> np.ndarray:
        """Blocks that never lifted, of bool, shape (P, A)."""
        return self.peak_rotation == 0.0

    @property
    def table(self) -> pandas.DataFrame:
        """One row per block."""
        import pandas

        p, alpha = np.meshgrid(self.frequency_parameter, self.slenderness, indexing="ij")
        omega, peak = np.meshgrid(self.frequency_ratio, self.acceleration_ratio, indexing="ij")
        columns = {
            "frequency_parameter_rad_s": p,
            "slenderness_rad": alpha,
            "omega_g_over_p": omega,
            "pga_over_g_tan_alpha": peak,
            "peak_rotation_rad": self.peak_rotation,
            "peak_rotation_over_slenderness": self.ratio,
            "collapsed": self.collapsed,
            "decided": self.decided,
        }
        return pandas.DataFrame({name: values.ravel() for name, values in columns.items()})

    def summary(self) -> dict:
        """The JSON object of ``stylobate spectrum --kind rocking``."""
        period = self.pulse_period
        failed = 0 if self.failed is None else int(self.failed.sum())
        return {
            "pga_g": self.pga / g,
            "pulse_period_s": period,
            "frequency_parameter_rad_s": self.frequency_parameter.tolist(),
            "slenderness_rad": self.slenderness.tolist(),
            "peak_rotation_over_slenderness": self.ratio.tolist(),
            "collapsed": (self.collapsed & self.decided).tolist(),
            "decided": self.decided.tolist(),
            "cells": int(self.collapsed.size),
            "collapsed_cells": int((self.collapsed & self.decided).sum()),
            "closed_cells": int(self.closed.sum()),
            "undecided_cells": int((~self.decided).sum()) - failed,
            "failed_cells": failed,
        }

    @property
    def ratio(self) -> np.ndarray:
        """Peak rotation over slenderness, 1 and more for blocks that fell, shape (P, A)."""
        return self.peak_rotation / self.slenderness


def rocking_block(frequency_parameter: float, slenderness: float) -> Column:
    """The rectangular block of given p [rad/s] and α [rad]: R = 3g/(4p²)."""
    radius = 0.75 * g / frequency_parameter**2
    width = 2.0 * radius * math.sin(slenderness)
    # Friction enough that it rocks and does not slide; the stiffness does not matter for a rigid block.
    law = Joint(5e10, 2.5e10, friction_angle=math.degrees(math.atan(max(0.7, 2.0 * math.tan(slenderness)))))
    name = f"block p = {frequency_parameter:g} rad/s, α = {math.degrees(slenderness):g}°"
    drum = Drum(2.0 * radius * math.cos(slenderness), width, width, 2000.0)
    return Column.of_fields(drums=(drum,), joints=(law,), name=name)


def rocking_spectrum(
    motion: Motion,
    frequency_parameters: Sequence[float] | np.ndarray | None = None,
    slendernesses: Sequence[float] | np.ndarray | None = None,
    *,
    restitution: float | None = None,
    tail: float = 0.0,
    threads: int | None = None,
) -> RockingSpectrum:
    """Shake Housner's blocks of all given sizes and slendernesses.

    Parameters
    ----------
    motion : Motion
    frequency_parameters : sequence of float, optional
        p [rad/s], 0.2 to 20; by default 64 from 0.8 to 8, blocks of some 11 m down to 11 cm half diagonal.
    slendernesses : sequence of float, optional
        α [rad], 0.01 to 1; by default 64 from 0.05 to 0.4.
    restitution : float, optional
        e; by default Housner's value of each block, 1 − 1.5 sin²α.
    tail : float
        Time to go on after the motion [s].
    threads : int, optional
        All cores by default.

    Raises
    ------
    InputError
        Values outside the ranges above.

    References
    ----------
    Makris and Konstantinidis (2003).
    """
    check_kind("motion", motion, Motion)
    p = _values("frequency parameters p", frequency_parameters, np.geomspace(0.8, 8.0, 64), 0.2, 20.0)
    alpha = _values("slendernesses α", slendernesses, np.linspace(0.05, 0.4, 64), 0.01, 1.0)
    cases = [Case(rocking_block(parameter, angle), motion) for parameter in p for angle in alpha]
    peak = np.empty(len(cases))
    collapsed = np.zeros(len(cases), dtype=bool)
    decided, failed = np.zeros(len(cases), dtype=bool), np.zeros(len(cases), dtype=bool)
    for i, measures in run_cases(cases, HousnerBlock(restitution=restitution), tail=tail, threads=threads):
        peak[i], collapsed[i], decided[i] = measures.peak_rotation, measures.collapsed, measures.decided
        failed[i] = measures.outcome is Outcome.FAILED
    shape = len(p), len(alpha)
    return RockingSpectrum(
        p,
        alpha,
        peak.reshape(shape),
        collapsed.reshape(shape),
        decided.reshape(shape),
        motion.name,
        motion.pga,
        pulse_match(motion).period if motion.pga > 0.0 else math.nan,
        failed.reshape(shape),
    )


def _values(
    name: str, given: Sequence[float] | np.ndarray | None, otherwise: np.ndarray, low: float, high: float
) -> np.ndarray:
    values = np.array(otherwise if given is None else given, dtype=float)
    if (
        values.ndim != 1
        or not values.size
        or not np.isfinite(values).all()
        or values.min() < low
        or values.max() > high
    ):
        raise InputError(f"{name} are {values.tolist()[:3]} …; allowed is a row of numbers from {low:g} to {high:g}.")
    return values
