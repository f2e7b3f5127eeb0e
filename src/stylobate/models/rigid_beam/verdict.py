"""Does a rigid beam stand when no input is left? What it takes to overturn it as it has slid, and on which side it is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...column import Column
from ...kernels.rigid_beam import moment_law
from .equations import BeamMatrices

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

    def verdict(self, found: dict) -> tuple[bool, bool, str, int]:
        """Whether the column is lost when no input is left, whether that is decided, why, and the joint it slid off or 0.

        ``found``: theta, omega, slip, energy, unaccounted of ``measures_of``.
        """
        theta, slip = found["theta"], found["slip"]
        if not self.has_potential:
            return False, self.stays_closed(theta, found["omega"]), "", 0
        reach = found["energy"] + found["unaccounted"]
        if self.sliding:
            left = room(self.column, slip)
            hanging = np.flatnonzero(left <= 0.0)
            if hanging.size:
                # To come back it must slide back, at the loosest joint of the part.
                work = -(self.column.joint_weights * self.friction * left)[hanging]
                joint = int(hanging[int(np.argmax(work))]) + 1
                gone = bool(reach < work.max())
                why = f"the centroid of {self.part(joint)} has slid beyond the edge of joint {joint}"
                return gone, gone, why if gone else "", joint if gone else 0
        if reach >= (self.lowest(slip) if self.sliding else self.lowest_unslid):
            return False, False, "", 0
        lost = not self.inside(theta, slip)
        return lost, True, "beyond the lowest barrier when the input ends" if lost else "", 0

    def part(self, joint: int) -> str:
        """Name of all that stands on a joint, counted from 1."""
        n = self.column.n
        return "the whole column" if joint == 1 else f"drums {joint} to {n}" if joint < n else f"drum {n}"
