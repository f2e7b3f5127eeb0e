"""The rigid beam: its equations, the ways over its joints and the verdict, and a packed column with its results."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...column import Column
from ...errors import InputError
from ...kernels.rigid_beam import moment_law
from ...messages import say
from ...motion import Motion
from ...outcome import Outcome, classify
from ...response import Collapse, Histories, Measures
from ...response.collapse import OVERTURNED, in_plane, part_on
from ...response.residuals import Residuals
from ..shared import ledger
from ..shared.ground import ground_histories
from ..shared.lanes import MOST_SAMPLES


@dataclass(frozen=True, eq=False)
class BeamMatrices:
    """Mass, gravity and load of the rigid beam in the drums' rotations (and joint slips).

    Parameters
    ----------
    column : Column
        As the model sees it: idealised already.
    """

    column: Column

    @cached_property
    def lever(self) -> np.ndarray:
        """c_ji: horizontal displacement of drum j's centroid for a unit rotation of drum i [m], shape (n, n)."""
        n = self.column.n
        own = self.column.centroid_heights - self.column.joint_heights
        return np.tril(np.broadcast_to(self.column.heights, (n, n)), -1) + np.diag(own)

    @cached_property
    def mass(self) -> np.ndarray:
        """Σ_j m_j c_ji c_jk + I_i δ_ik [kg m²], shape (n, n).  # Eq. (F3)"""
        c = self.lever
        return c.T @ (self.column.masses[:, None] * c) + np.diag(self.column.inertias)

    @cached_property
    def load(self) -> np.ndarray:
        """S_i = Σ_j m_j c_ji [kg m], shape (n,).  # Eq. (F2)"""
        return self.lever.T @ self.column.masses

    @cached_property
    def overturning(self) -> np.ndarray:
        """Σ_j≥i m_j (z_j − z_i): moment about joint i of a unit acceleration of everything above it [kg m], shape (n,)."""
        return np.cumsum(self.load[::-1])[::-1]

    @cached_property
    def sliding_mass(self) -> np.ndarray:
        """Mass matrix for rotations and slips, shape (2n, 2n).  # Eq. (R5)"""
        n = self.column.n
        full = np.hstack((self.lever, np.tril(np.ones((n, n)))))
        out = full.T @ (self.column.masses[:, None] * full)
        out[:n, :n] += np.diag(self.column.inertias)
        return out

    # -- closed joints ---------------------------------------------------------------------------------------------

    def highest_frequency(self, stiffness, gravity: float, relative: bool, shear_stiffness=None) -> float:
        """Largest ω of the column with all joints closed [rad/s].

        Parameters
        ----------
        stiffness : array, shape (n,)
            K_M [N m].
        gravity : float
            As above.
        relative : bool
            Whether the law is in the relative rotation.
        shear_stiffness : array, optional
            k_s A [N/m], with sliding.
        """
        from scipy.linalg import eigvals, eigvalsh

        n = self.column.n
        difference = np.eye(n) - np.eye(n, k=-1)
        if shear_stiffness is not None:
            # The diagonal of D gives a bound in closed form, but the eigenvalues are the sharp one.
            stiff = np.zeros((2 * n, 2 * n))
            stiff[:n, :n] = difference.T @ (stiffness[:, None] * difference)
            stiff[n:, n:] = np.diag(shear_stiffness)
            return float(np.sqrt(eigvalsh(stiff, self.sliding_mass)[-1]))
        if relative:
            stiff = difference.T @ (stiffness[:, None] * difference) - gravity * np.diag(self.load)
            return float(np.sqrt(eigvalsh(stiff, self.mass)[-1]))
        values = eigvals(difference.T @ np.diag(stiffness) - gravity * np.diag(self.load), self.mass)
        return float(np.sqrt(np.abs(values).max()))


def tridiagonal(column: Column) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mass matrix of the nodal displacements, M = U D Uᵀ: 1/D_i, U_{i−1,i} (0 for i = 1), and the nodes' masses [kg].

    Each of shape (n,). The mass of a node is the one on which the ground acceleration acts.
    """
    n = column.n
    share = (column.centroid_heights - column.joint_heights) / column.heights
    m, turn = column.masses, column.inertias / column.heights**2
    own, next_ = m * share**2 + turn, m * (1.0 - share) ** 2 + turn
    diagonal = own + np.append(next_[1:], 0.0)
    beside = m * share * (1.0 - share) - turn  # between node i − 1 and node i
    nodes = m * share + np.append((m * (1.0 - share))[1:], 0.0)
    pivot, upper = np.empty(n), np.zeros(n)
    for i in range(n - 1, -1, -1):
        pivot[i] = diagonal[i] - (upper[i + 1] * beside[i + 1] if i + 1 < n else 0.0)
        upper[i] = beside[i] / pivot[i] if i else 0.0
    if not np.all(pivot > 0.0):
        raise InputError(f"the mass matrix of {column.name!r} is not positive; check the drums' heights and widths.")
    return 1.0 / pivot, upper, nodes


#: Rotations at which the way over a joint is looked at.
POINTS = 401

#: A share p by which a barrier was found to be lower counts as p (1.1 + 25 p): single exchanges find too little where
#: joints are soft.
RESERVE = (1.1, 25.0)


def faces(column: Column) -> tuple[np.ndarray, np.ndarray]:
    """Half widths of the lower face of each drum and of the face under it, without end for the base [m], shape (n,)."""
    lower = 0.5 * np.array([drum.bottom_width for drum in column.drums])
    upper = 0.5 * np.array([drum.top_width for drum in column.drums])
    return lower, np.concatenate(([np.inf], upper[:-1]))


def room(column: Column, slip: np.ndarray) -> np.ndarray:
    """Distance from the centroid of all above each joint to the nearer end of its contact [m], shape (n,).

    Of the drums put flat on one another with their slips; negative where the centroid is beyond the end. Sliding on the
    base takes no contact away.
    """
    lower, upper = faces(column)
    masses = column.masses
    above = np.cumsum(masses[::-1])[::-1]
    # centroid of the part over the middle of its lowest face: what the joints higher up have slid
    higher = np.append(np.cumsum((above * slip)[::-1])[::-1][1:], 0.0) / above
    right = np.minimum(lower, upper - slip) - higher
    left = np.minimum(lower, upper + slip) + higher
    return np.minimum(left, right)


@dataclass(frozen=True, eq=False)
class Passes:
    """The ways over the joints of a column; see Eq. (R9).

    Parameters
    ----------
    column : Column
        As the model sees it.
    joints : array, shape (5, n)
    bed : tuple of float, True or None
        The law, see ``kernels/rigid_beam/moment_law.py``.
    alpha : array, shape (n,)
        Critical angles of the law [rad].
    opening : array, shape (n,)
        Rotation at which each joint opens [rad].
    geometric, relative, sliding : bool
        Gravity stands in the equations of motion; the law is in relative rotations; joints slip.
    """

    column: Column
    joints: np.ndarray
    bed: tuple[float, ...] | bool | None
    alpha: np.ndarray
    opening: np.ndarray
    geometric: bool
    relative: bool
    sliding: bool

    @cached_property
    def has_potential(self) -> bool:
        """Whether the joints' moments have a potential: not in the rotations of single drums."""
        return self.column.n == 1 or self.relative

    @cached_property
    def gravity(self) -> tuple[np.ndarray, np.ndarray]:
        """g S_i and g Σ_j≥i m_j (z_j − z_i) [N m], shape (n,); zero where the law holds the second-order effect."""
        weight = self.column.gravity if self.geometric else 0.0
        return weight * self.matrices.load, weight * self.matrices.overturning

    @cached_property
    def matrices(self) -> BeamMatrices:
        """Of the equations of motion."""
        return BeamMatrices(self.column)

    @cached_property
    def angles(self) -> np.ndarray:
        """Rotations of each joint up to its balance point [rad], shape (POINTS, n)."""
        ultimate = 0.5 * self.column.joint_weights * self.column.joint_widths
        summit = ultimate / self.gravity[1] if self.geometric else self.alpha
        return np.linspace(0.0, 1.0, POINTS)[:, None] * summit

    @cached_property
    def heights(self) -> np.ndarray:
        """Energy of the part above each joint turned about it as one body [J], shape (POINTS, n)."""
        stored = moment_law.stored(self.angles, self.joints[:, None, :], self.bed)
        return stored - 0.5 * self.gravity[1] * self.angles**2

    @cached_property
    def give(self) -> np.ndarray:
        """By how much the way over each joint is lower because the other joints give way [J], shape (n,).

        Every way out crosses the plane through the summits of all joints. On it the lowest place near a joint's summit is
        looked for by turning each of the other joints a share of its own summit in exchange. Where that leads on to the
        other joint's summit this one's is no pass; it is given the largest share of the others.
        """
        n = self.column.n
        height, top = self.heights.max(axis=0), self.heights.argmax(axis=0)
        if n == 1 or not self.geometric or not self.stands:
            return np.zeros(n)
        summit = self.angles[top, np.arange(n)]
        share = np.geomspace(1e-9, 0.5, 80)
        rest = 1.0 - share
        of = [moment_law.stored(part[:, None] * summit, self.joints[:, None, :], self.bed) for part in (share, rest)]
        tilt = np.outer(summit, summit) * self.gravity[1][np.maximum.outer(np.arange(n), np.arange(n))]
        own = np.diag(tilt)
        both = of[1][:, :, None] + of[0][:, None, :] - np.multiply.outer(share * rest, tilt)  # shape (share, n, n)
        both -= 0.5 * (np.multiply.outer(rest**2, own)[:, :, None] + np.multiply.outer(share**2, own)[:, None, :])
        less = np.maximum(height[:, None] - both.min(axis=0), 0.0)
        np.fill_diagonal(less, 0.0)
        part = less.sum(axis=1) / height
        part *= RESERVE[0] + RESERVE[1] * part
        ridge = np.any((both.argmin(axis=0) == len(share) - 1) & (less > 0.0), axis=1)
        ridge[np.argmin(height)] = False
        return height * np.where(ridge, part[~ridge].max(), part)

    @cached_property
    def friction(self) -> np.ndarray:
        """Least shear over weight at which some joint in the part above each joint slides [-], shape (n,).

        Sliding on the base takes no support away: joints between drums count.
        """
        column = self.column
        ratio = np.array([joint.tan_phi for joint in column.joints])
        ratio += np.array([joint.cohesion for joint in column.joints]) * column.joint_areas / column.joint_weights
        if not self.sliding:
            ratio[:] = np.inf
        ratio[0] = np.inf
        return np.minimum.accumulate(ratio[::-1])[::-1]

    @cached_property
    def stands(self) -> bool:
        """Whether the column stands upright under its own weight: every way out goes up, and so does every small sway."""
        if not self.geometric:
            return True
        uphill = bool(self.heights.max(axis=0).min() > 0.0)
        return uphill and (not self.has_potential or bool(np.real(self.modes[0]).min() > 0.0))

    @cached_property
    def lowest_rigid(self) -> float:
        """Lowest barrier over one joint alone, of the column as built [J]; what the ledger is measured with."""
        return float(self.heights.max(axis=0).min())

    @cached_property
    def lowest_unslid(self) -> float:
        """Lowest barrier of the column as built [J]."""
        return self.lowest(np.zeros(self.column.n))

    def lowest(self, slip: np.ndarray) -> float:
        """Energy under which the column with these slips cannot overturn [J]; −∞ if it does not stand.  # Eq. (R9)

        The way over joint i goes up to the rotation at which a joint above begins to slide down its tilted face: from
        there sliding and lifting together cost nothing more, which is also the least that sliding first and overturning
        then would take.
        """
        lost = 0.5 * self.column.joint_widths - room(self.column, slip)
        ways = self.heights - self.column.joint_weights * lost * self.angles
        ways = np.where(self.angles <= self.friction, ways, 0.0)
        barrier = float((ways.max(axis=0) - self.give).min())
        return barrier if barrier > 0.0 else -np.inf

    def inside(self, theta: np.ndarray, slip: np.ndarray) -> bool:
        """Whether a state whose energy is below the lowest barrier lies on the near side of it.

        The moments of the laws bend downward with the rotation. So on the way outward along the present rotations the
        potential falls for good where it falls from here on, and else has its barrier still before it.
        """
        phi = np.diff(theta, prepend=0.0)
        out = np.empty_like(phi)
        moment_law.moments(phi, 1.0, self.joints, self.bed, out)
        if not self.geometric:
            return bool(np.all(out * phi >= 0.0))
        tilt = float(self.gravity[0] @ theta**2)
        below = np.append(0.0, theta[:-1])
        tip = float(self.column.joint_weights @ (slip * below)) if self.sliding else 0.0  # weight off the middle
        if out @ phi >= tilt + tip or tilt <= 0.0:
            return True
        if tip == 0.0:
            return False
        ultimate = 0.5 * self.column.joint_weights * self.column.joint_widths
        furthest = float(ultimate @ np.abs(phi) + abs(tip)) / tilt
        for share in np.geomspace(1.0, max(1.0, furthest), 100):
            moment_law.moments(share * phi, 1.0, self.joints, self.bed, out)
            if out @ phi >= share * tilt + tip:
                return True
        return False

    @cached_property
    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Circular frequencies squared [1/s²], shape (n,), and shapes, in columns, of the column with all joints closed.

        Where the laws are in the rotations of single drums they may be complex; some versions of numpy return complex
        arrays always, so that only the values tell.
        """
        n = self.column.n
        difference = np.eye(n) - np.eye(n, k=-1)
        law = difference if self.relative else np.eye(n)
        stiffness = difference.T @ (self.joints[0][:, None] * law) - np.diag(self.gravity[0])
        squares, shapes = np.linalg.eig(np.linalg.solve(self.matrices.mass, stiffness))
        return squares, shapes

    @cached_property
    def flutters(self) -> bool:
        """Whether the closed column has complex frequencies, so that the smallest vibration grows without end.

        Rounding ε can part a double ω² into a complex pair, some √ε of it apart. A mode that is no further from the real
        axis grows by less than √ε ω t / 2: by 1.5 % in 200 s at ω = 1e4 rad/s.
        """
        squares = self.modes[0]
        return bool((np.abs(np.imag(squares)) > math.sqrt(np.finfo(float).eps) * np.abs(squares)).any())

    def stays_closed(self, theta: np.ndarray, omega: np.ndarray) -> bool:
        """Whether a column without sliding that no input shakes opens no joint any more, by the sum of its modes."""
        squares, shapes = self.modes
        if self.flutters or np.real(squares).min() <= 0.0:
            return False
        place, speed = np.abs(np.linalg.solve(shapes, np.column_stack((theta, omega)))).T
        size = np.hypot(place, speed / np.sqrt(np.real(squares)))
        return bool(np.all(np.abs(shapes) @ size <= self.opening))

    def reached(self, energy: float, rotation: float) -> bool:
        """Whether a column let go at a rotation, and given at most this energy, could overturn at all."""
        if not self.has_potential or self.sliding or energy >= self.lowest_unslid:
            return True
        n = self.column.n
        return not self.inside(np.full(n, -rotation), np.zeros(n))

    def verdict(self, facts: dict) -> tuple[bool, bool, str, int]:
        """Whether the column is lost when no input is left, whether that is decided, why, and the joint it slid off or 0.

        ``facts``: theta, omega, slip, energy, unaccounted of ``measures_of``.
        """
        theta, slip = facts["theta"], facts["slip"]
        if not self.has_potential:
            return False, self.stays_closed(theta, facts["omega"]), "", 0
        reach = facts["energy"] + facts["unaccounted"]
        if self.sliding:
            margin = room(self.column, slip)
            hanging = np.flatnonzero(margin <= 0.0)
            if hanging.size:
                # To come back it must slide back, at the loosest joint of the part.
                work = -(self.column.joint_weights * self.friction * margin)[hanging]
                joint = int(hanging[int(np.argmax(work))]) + 1
                gone = bool(reach < work.max())
                why = say(
                    "the centroid of {part} has slid beyond the edge of joint {joint}",
                    part=part_on(joint, self.column.n),
                    joint=joint,
                )
                return gone, gone, why if gone else "", joint if gone else 0
        if reach >= (self.lowest(slip) if self.sliding else self.lowest_unslid):
            return False, False, "", 0
        lost = not self.inside(theta, slip)
        return lost, True, say("beyond the lowest barrier when the input ends") if lost else "", 0


#: Why a column that falls by itself has no verdict: the motion has no part in it.
TOO_SOFT = say("the joints are too soft to hold the column upright under its own weight; raise normal_stiffness")


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


def measures_of(beam: PackedBeam, facts: dict) -> Measures:
    """Measures from the facts of a run.

    ``facts``: theta, omega, slip at the end, shape (n,); energy (mechanical, upright at rest zero), start (the same at the
    start), work (largest of the input), given (see :func:`given`), unaccounted and released (by the ledger) [J]; lost
    (joint from 1, 0: none), side, time of collapse, end, failure, top, residual, turn, opening, step, steps.
    """
    column = beam.column
    failure = facts["failure"] or ("" if beam.stands else TOO_SOFT)
    imbalance = ledger.imbalance(
        facts["unaccounted"], work=facts["work"], start=facts["start"], barrier=beam.lowest_rigid,
        released=facts["released"],
    )  # fmt: skip
    state = (*facts["theta"], *facts["slip"], facts["energy"], imbalance)
    if not failure and not all(map(math.isfinite, state)):
        failure = say("the state is not finite at {time:.4g} s; shorten the time_step", time=facts["end"])
    failure = failure or ledger.out_of_balance(imbalance)
    collapsed, decided, reason, joint = False, False, failure, 0
    if not failure and facts["lost"]:
        collapsed, decided = True, True
        right, left = (
            say("{part} overturns to the right over joint {joint}"),
            say("{part} overturns to the left over joint {joint}"),
        )
        reason = (right if facts["side"] > 0 else left).of(
            part=part_on(facts["lost"], beam.column.n), joint=facts["lost"]
        )
    elif not failure:
        collapsed, decided, reason, joint = beam.verdict(facts)
    if collapsed and not beam.reached(facts["start"] + facts["given"], beam.initial_rotation):
        failure = reason = ledger.MADE_ENERGY
        collapsed, decided = False, False
    widths = column.joint_widths
    outcome = classify(
        collapsed, bool(failure), facts["opening"] / float(widths.min()), float((np.abs(facts["slip"]) / widths).max())
    )
    time = facts["time"] if facts["lost"] else facts["end"]
    return Measures(
        outcome=outcome,
        decided=decided,
        collapse_time=time if outcome is Outcome.COLLAPSED else math.nan,
        peak_top_displacement=facts["top"],
        residual_top_displacement=facts["residual"],
        peak_rotation=facts["turn"],
        peak_joint_opening=facts["opening"],
        residual_joint_slip=float(np.abs(facts["slip"]).max()),
        residuals=_residuals(beam, facts["theta"], facts["slip"]),
        energy_imbalance=imbalance,
        time_step=facts["step"],
        steps=facts["steps"],
        reason=reason,
        collapse=_collapse(facts, time, joint) if outcome is Outcome.COLLAPSED else None,
    )


def _collapse(facts: dict, time: float, slid: int) -> Collapse:
    """The collapse: about the joint that is lost, off the joint ``slid``, or beyond the lowest barrier, wherever that is."""
    if facts["lost"]:
        return in_plane(time, facts["lost"], facts["side"])
    if slid:
        return in_plane(time, slid, facts["slip"][slid - 1], slid_off=True)
    towards = 0.0 if facts["theta"].sum() > 0.0 else math.pi
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


def energy_at_loss(row: np.ndarray, largest: float, after: bool) -> float:
    """Most energy that a column can have had from the input when it was lost [J].

    ``row``: the ledger at the end; ``largest`` input work; ``after``: it was lost after the
    motion, at whose end it stood on the near side of every barrier.
    """
    return float(row[0] - row[4] - row[5]) if after else largest
