"""The rigid beam between its equations and its results: a column packed once, energies, verdict, measures, histories."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...kernels.rigid_beam import moment_law
from ...motion import Motion
from ...outcome import Outcome, classify
from ...response import Collapse, Histories, Measures
from ...response.collapse import OVERTURNED, in_plane
from ...response.residuals import Residuals
from ..shared import ledger
from ..shared.ground import ground_histories
from ..shared.lanes import MOST_SAMPLES
from .verdict import Passes

#: Why a column that falls by itself has no verdict: the motion has no part in it.
TOO_SOFT = "the joints are too soft to hold the column upright under its own weight; raise normal_stiffness"


@dataclass(frozen=True, eq=False)
class PackedBeam(Passes):
    """A column as the lanes need it, computed once: the ways over its joints, and how it is stepped.

    Parameters
    ----------
    shear : array, shape (n,)
        k_s A [N/m].
    longest_step, fixed_step : float, float or None
        Time step where the motion allows it, and the one asked for instead [s].
    stiffness_damping, initial_rotation : float
        [s], [rad]

    Others as for :class:`Passes`.
    """

    shear: np.ndarray
    longest_step: float
    fixed_step: float | None
    stiffness_damping: float
    initial_rotation: float

    def step_for(self, motion: Motion) -> float:
        """Time step under a motion [s]."""
        return self.fixed_step or min(self.longest_step, MOST_SAMPLES * motion.dt)

    @property
    def ultimate(self) -> np.ndarray:
        """M_u of each joint [N m], shape (n,)."""
        return self.column.joint_weights * 0.5 * self.column.joint_widths

    def joint_rotations(self, theta: np.ndarray) -> np.ndarray:
        """φ_i = θ_i − θ_{i−1} along the last axis."""
        return np.diff(theta, axis=-1, prepend=0.0)

    def energies(self, theta, omega, slip, slip_rate, plastic) -> np.ndarray:
        """Kinetic, gravitational and elastic energy of one state, upright at rest zero [J].

        Parameters
        ----------
        theta, omega, slip, slip_rate, plastic : array, shape (n,)
            Rotations towards +x, their velocities, slips, their velocities and plastic parts.
        """
        weight = self.column.gravity * self.matrices.load
        if self.sliding:
            q = np.concatenate((omega, slip_rate))
            kinetic = 0.5 * q @ self.matrices.sliding_mass @ q
        else:
            kinetic = 0.5 * omega @ self.matrices.mass @ omega
        gravitational = 0.0
        if self.geometric:
            below = np.concatenate(([0.0], theta[:-1]))
            gravitational = -0.5 * weight @ theta**2 - self.column.joint_weights @ (slip * below)
        elastic = moment_law.stored(self.joint_rotations(theta), self.joints, self.bed).sum()
        elastic += 0.5 * self.shear @ (slip - plastic) ** 2
        return np.array([kinetic, gravitational, elastic])

    def lift(self, phi: np.ndarray) -> np.ndarray:
        """Gap of each joint at the edge that opens [m]."""
        size = np.abs(phi)
        return np.where(size > self.opening, self.column.joint_widths * (size - np.sqrt(size * self.opening)), 0.0)


def measures_of(beam: PackedBeam, found: dict) -> Measures:
    """Measures from the facts of a run.

    ``found``: theta, omega, slip at the end, shape (n,); energy (mechanical, upright at rest zero), start (the same at the
    start), work (largest of the input), given (see :func:`given`), unaccounted and released (by the ledger) [J]; lost
    (joint from 1, 0: none), side, time of collapse, end, failure, top, residual, turn, opening, step, steps.
    """
    column = beam.column
    failure = found["failure"] or ("" if beam.stands else TOO_SOFT)
    imbalance = ledger.imbalance(
        found["unaccounted"], work=found["work"], start=found["start"], barrier=beam.lowest_rigid,
        released=found["released"],
    )  # fmt: skip
    state = (*found["theta"], *found["slip"], found["energy"], imbalance)
    if not failure and not all(map(math.isfinite, state)):
        failure = f"the state is not finite at {found['end']:.4g} s; shorten the time_step"
    failure = failure or ledger.out_of_balance(imbalance)
    collapsed, decided, reason, joint = False, False, failure, 0
    if not failure and found["lost"]:
        collapsed, decided = True, True
        side = "right" if found["side"] > 0 else "left"
        reason = f"{beam.part(found['lost'])} overturns to the {side} over joint {found['lost']}"
    elif not failure:
        collapsed, decided, reason, joint = beam.verdict(found)
    if collapsed and not beam.reached(found["start"] + found["given"], beam.initial_rotation):
        failure = reason = ledger.MADE_ENERGY
        collapsed, decided = False, False
    widths = column.joint_widths
    outcome = classify(
        collapsed, bool(failure), found["opening"] / float(widths.min()), float((np.abs(found["slip"]) / widths).max())
    )
    time = found["time"] if found["lost"] else found["end"]
    return Measures(
        outcome=outcome,
        decided=decided,
        collapse_time=time if outcome is Outcome.COLLAPSED else math.nan,
        peak_top_displacement=found["top"],
        residual_top_displacement=found["residual"],
        peak_rotation=found["turn"],
        peak_joint_opening=found["opening"],
        residual_joint_slip=float(np.abs(found["slip"]).max()),
        residuals=_residuals(beam, found["theta"], found["slip"]),
        energy_imbalance=imbalance,
        time_step=found["step"],
        steps=found["steps"],
        reason=reason,
        collapse=_collapse(found, time, joint) if outcome is Outcome.COLLAPSED else None,
    )


def _collapse(found: dict, time: float, slid: int) -> Collapse:
    """The collapse: about the joint that is lost, off the joint ``slid``, or beyond the lowest barrier, wherever that is."""
    if found["lost"]:
        return in_plane(time, found["lost"], found["side"])
    if slid:
        return in_plane(time, slid, found["slip"][slid - 1], slid_off=True)
    towards = 0.0 if found["theta"].sum() > 0.0 else math.pi
    return Collapse(time, None, OVERTURNED, towards)


def _residuals(beam: PackedBeam, theta: np.ndarray, slip: np.ndarray) -> Residuals:
    x, z = _places(beam, theta, slip)
    if beam.initial_rotation:
        first = _places(beam, np.full_like(theta, -beam.initial_rotation), np.zeros_like(slip))
        x, z = x - first[0], z - first[1]
    return Residuals.in_plane(slip, x, z, -theta)


def _places(beam: PackedBeam, theta: np.ndarray, slip: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Displacement of the centroids from upright, along x and z [m], shape (…, n) as rotations and slips are."""
    lever = beam.matrices.lever
    # Seconds of small angles: the drums sink as they tilt and rise as their joints open.
    rise = 0.5 * beam.lift(beam.joint_rotations(theta))
    return theta @ lever.T + np.cumsum(slip, axis=-1), np.cumsum(rise, axis=-1) - 0.5 * theta**2 @ lever.T


def histories_of(beam: PackedBeam, motion: Motion, time, theta, slip, energy) -> Histories:
    """Histories from the recorded states.

    Parameters
    ----------
    time : array, shape (T,)
    theta, slip : array, shape (T, n)
        Rotations towards +x [rad] and slips [m].
    energy : array, shape (T, 6)
        Input, kinetic, gravitational, elastic, friction, viscous [J].
    """
    column = beam.column
    phi = beam.joint_rotations(theta)
    base = np.cumsum(slip, axis=1)
    x, z = _places(beam, theta, slip)
    a_g, u_g = ground_histories(motion, time)
    return Histories.of_drums(
        time=time,
        drum_x=x - x[0],
        drum_z=z - z[0],
        drum_rotation=-theta,
        joint_opening=beam.lift(phi),
        joint_slip=slip,
        base_displacement=slip[:, 0],
        top_displacement=base[:, -1] + (theta - theta[0]) @ column.heights,
        ground_acceleration=a_g,
        ground_displacement=u_g,
        energy={name: energy[:, k] for k, name in enumerate(ledger.TERMS)},
    )


def given(row: np.ndarray, largest: float, after: bool) -> float:
    """Most energy that a column can have had from the input when it was lost [J].

    ``row``: the ledger at the end; ``largest`` input work; ``after``: it was lost after the
    motion, at whose end it stood on the near side of every barrier.
    """
    return float(row[0] - row[4] - row[5]) if after else largest
