"""Small vibrations of rigid bodies on closed joints, about the state at rest: masses, stiffness, and gravity's second order.

Every joint is a set of normal springs at points of its contact, a shear spring in its middle and a torsion spring.
Bodies have six degrees of freedom each: displacement of the centroid and rotation vector, in space axes, z upward
(normal to the base).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..errors import InputError

#: Contact points around a whole round face; a multiple of 4, so that both axes pass through points.
AROUND = 72


@dataclass(frozen=True, eq=False, kw_only=True)
class ClosedJoint:
    """A joint of two bodies about rest, as springs.

    Parameters
    ----------
    name : str
    lower, upper : int
        Bodies by number.
    frame : array
        Two directions along the joint and its normal from the lower into the upper body, as columns [-], shape (3, 3).
    points, springs : array
        Contact points [m], shape (m, 3), and their normal stiffness [N/m], shape (m,).
    edge : array
        Points at which the joint opens first [m], shape (k, 3).
    shear, torsion : float
        Stiffness against slip [N/m] and against twist [N m].
    middle : array
        Where the shear spring acts [m], shape (3,).
    force : array
        Force on the upper body at rest [N], shape (3,).
    place : array
        Where it acts [m], shape (3,).
    closure : array
        Depth of the edge at rest [m], shape (k,).
    follows_lower : float
        Share of the force whose direction turns with the lower body; the rest turns with the upper one [-].
    friction, lever : float
        Largest shear force [N], and the distance at which it acts against twist [m].
    second_moment : float
        J of the contact area, where it is that of a column [m⁴]; NaN otherwise.
    area : float
        [m²]
    """

    name: str
    lower: int
    upper: int
    frame: np.ndarray
    points: np.ndarray
    springs: np.ndarray
    edge: np.ndarray
    shear: float
    torsion: float
    middle: np.ndarray
    force: np.ndarray
    place: np.ndarray
    closure: np.ndarray
    follows_lower: float
    friction: float
    lever: float
    area: float
    second_moment: float = math.nan

    @property
    def normal(self) -> np.ndarray:
        """Unit normal, from the lower into the upper body."""
        return self.frame[:, 2]

    @property
    def bending(self) -> float:
        """k_b: stiffness against rotation about the second direction of the frame, through the middle of the springs
        [N m].
        """
        along = self.points @ self.frame[:, 0]
        along = along - self.springs @ along / self.springs.sum()
        return float(self.springs @ along**2)

    def softened(self, share: float) -> ClosedJoint:
        """The same with a share of all its stiffness left."""
        return replace(self, springs=share * self.springs, shear=share * self.shear, torsion=share * self.torsion)


@dataclass(frozen=True, eq=False)
class Spring:
    """A link about rest: a spring between two points of two bodies along some directions.

    Parameters
    ----------
    name : str
    bodies : (int, int)
    ends : (array, array)
        Where it holds them [m], each of shape (3,).
    ways : array
        Directions [-], shape (k, 3).
    stiffness : array
        Along each [N/m], shape (k,).
    tension : float
        At rest, along the line between both ends or, of what crosses a joint, along ``axis`` [N].
    axis : array
        [-], shape (3,).
    """

    name: str
    bodies: tuple[int, int]
    ends: tuple[np.ndarray, np.ndarray]
    ways: np.ndarray
    stiffness: np.ndarray
    tension: float
    axis: np.ndarray


def cross(vector: np.ndarray) -> np.ndarray:
    """Matrix of the cross product with a vector."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


@dataclass(frozen=True, eq=False)
class Vibrating:
    """Bodies on closed joints, linear about rest.

    Parameters
    ----------
    names : tuple of str
        Of the bodies.
    centroids, masses, inertias : array
        [m], shape (N, 3); [kg], shape (N,); about the centroids in space axes [kg m²], shape (N, 3, 3).
    free : array of bool
        Shape (N,).
    joints : tuple of ClosedJoint
    springs : tuple of Spring
    top : array
        The point whose motion measures a mode [m], shape (3,), of the body ``top_body``; None for the largest of all
        centroids.
    left_out : tuple of str
        What does not act at rest, in sentences.
    """

    names: tuple[str, ...]
    centroids: np.ndarray
    masses: np.ndarray
    inertias: np.ndarray
    free: np.ndarray
    joints: tuple[ClosedJoint, ...]
    springs: tuple[Spring, ...] = ()
    top: np.ndarray | None = None
    top_body: int = 0
    left_out: tuple[str, ...] = ()

    @property
    def coordinates(self) -> np.ndarray:
        """Numbers of the coordinates of the bodies that can move, six a body."""
        return (6 * np.flatnonzero(self.free)[:, None] + np.arange(6)).ravel()

    @cached_property
    def mass_matrix(self) -> np.ndarray:
        """[kg], [kg m²], shape (6 N, 6 N); nothing of bodies that are fixed."""
        n = len(self.masses)
        matrix = np.zeros((6 * n, 6 * n))
        for i in np.flatnonzero(self.free):
            matrix[6 * i : 6 * i + 3, 6 * i : 6 * i + 3] = self.masses[i] * np.eye(3)
            matrix[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] = self.inertias[i]
        return matrix

    def joint_matrix(self, joint: ClosedJoint) -> np.ndarray:
        """Elastic stiffness of a joint against the twelve coordinates of its two bodies, the upper first, shape (12, 12).

        # Eq. (M2)
        """
        normal = self._rises(joint, joint.points)
        matrix = normal.T @ (joint.springs[:, None] * normal)
        slip = joint.frame[:, :2].T @ self._passing(joint, joint.middle)
        twist = np.concatenate((np.zeros(3), joint.normal, np.zeros(3), -joint.normal))
        return matrix + joint.shear * slip.T @ slip + joint.torsion * np.outer(twist, twist)

    @cached_property
    def joint_matrices(self) -> tuple[np.ndarray, ...]:
        """:meth:`joint_matrix` of every joint."""
        return tuple(self.joint_matrix(joint) for joint in self.joints)

    def _rises(self, joint: ClosedJoint, points: np.ndarray) -> np.ndarray:
        """How far points of a joint open per coordinate of its upper and its lower body, shape (k, 12)."""
        arms = [np.cross(points - self.centroids[body], joint.normal) for body in (joint.upper, joint.lower)]
        along = np.broadcast_to(joint.normal, points.shape)
        return np.hstack((along, arms[0], -along, -arms[1]))

    def _passing(self, joint: ClosedJoint, point: np.ndarray) -> np.ndarray:
        """How far a point of the upper body passes that of the lower one per coordinate, shape (3, 12)."""
        return np.hstack((self._reach(joint.upper, point), -self._reach(joint.lower, point)))

    def _reach(self, body: int, point: np.ndarray) -> np.ndarray:
        """Displacement of a point of a body per its coordinates, shape (3, 6)."""
        return np.hstack((np.eye(3), -cross(point - self.centroids[body])))

    def geometric_matrix(
        self, force: np.ndarray, upper: int, lower: int, at: tuple[np.ndarray, np.ndarray], follows_lower: float
    ) -> np.ndarray:
        """Second order of a force that two bodies exert on one another, as :meth:`joint_matrix`.  # Eq. (M3)

        Parameters
        ----------
        force : array
            On the upper body [N], shape (3,).
        upper, lower : int
        at : (array, array)
            Where it acts on the upper and on the lower body [m].
        follows_lower : float
            Share of it that turns with the lower body; the rest turns with the upper one.
        """
        passing = np.hstack((self._reach(upper, at[0]), -self._reach(lower, at[1])))
        matrix = np.zeros((12, 12))
        for arm, place, sign in ((at[0] - self.centroids[upper], 3, -1.0), (at[1] - self.centroids[lower], 9, 1.0)):
            matrix[place : place + 3, place : place + 3] = sign * _turned(force, arm)
        turning = np.zeros((12, 12))
        turning[3:6] = (1.0 - follows_lower) * cross(force) @ passing
        turning[9:] = follows_lower * cross(force) @ passing
        return matrix - turning - turning.T

    def spring_matrix(self, spring: Spring) -> np.ndarray:
        """Stiffness of a link, as :meth:`joint_matrix`, with the second order of its tension."""
        lower, upper = spring.bodies
        passing = np.hstack((self._reach(upper, spring.ends[1]), -self._reach(lower, spring.ends[0])))
        rows = spring.ways @ passing
        matrix = rows.T @ (spring.stiffness[:, None] * rows)
        if spring.tension:
            force = -spring.tension * spring.axis  # it pulls the upper body back
            line = spring.ends[1] - spring.ends[0]
            length = float(np.linalg.norm(line))
            if length > 0.0:  # of a fixed length its ends move on circles: T/L across it, and no direction that turns
                aside = passing - np.outer(spring.axis, spring.axis @ passing)
                matrix += spring.tension / length * aside.T @ aside
                for body, end, place in ((upper, spring.ends[1], 0), (lower, spring.ends[0], 6)):
                    arm, pull = end - self.centroids[body], force if place == 0 else -force
                    matrix[place + 3 : place + 6, place + 3 : place + 6] -= _turned(pull, arm)
            else:
                matrix += self.geometric_matrix(force, upper, lower, (spring.ends[1], spring.ends[0]), 0.5)
        return matrix

    @cached_property
    def stiffness_matrix(self) -> np.ndarray:
        """Of joints and links with the second order of the forces at rest, shape (6 N, 6 N).  # Eqs. (M2), (M3)"""
        matrix = np.zeros((6 * len(self.masses),) * 2)
        for joint, elastic in zip(self.joints, self.joint_matrices, strict=True):
            at = joint.place, joint.place
            own = elastic + self.geometric_matrix(joint.force, joint.upper, joint.lower, at, joint.follows_lower)
            _add(matrix, own, joint.upper, joint.lower)
        for spring in self.springs:
            _add(matrix, self.spring_matrix(spring), spring.bodies[1], spring.bodies[0])
        return matrix

    def with_joints(self, joints: Sequence[ClosedJoint]) -> Vibrating:
        """The same on other joints."""
        return replace(self, joints=tuple(joints))

    def solve(self, coordinates: np.ndarray, most: int | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies and shapes of the motions in which only some coordinates take part.

        Parameters
        ----------
        coordinates : array of int
        most : int, optional
            Only so many, from the lowest.

        Returns
        -------
        frequencies, shapes : array
            [Hz], shape (k,), rising; displacements [m] and rotations [rad] of all bodies, shape (k, N, 6).

        Raises
        ------
        InputError
            What stands is not stable at rest: some small motion needs no work.
        """
        from scipy.linalg import eigh

        pick = np.ix_(coordinates, coordinates)
        mass, stiffness = self.mass_matrix[pick], self.stiffness_matrix[pick]
        count = len(coordinates)
        kept = None if most is None or most >= count else [0, most - 1]
        squares, vectors = eigh(stiffness, mass, subset_by_index=kept)
        if squares[0] <= 0.0:
            raise InputError(self._unstable(coordinates, vectors[:, 0]))
        shapes = np.zeros((len(squares), 6 * len(self.masses)))
        shapes[:, coordinates] = vectors.T
        return np.sqrt(squares) / (2.0 * math.pi), shapes.reshape(len(squares), -1, 6)

    def _unstable(self, coordinates: np.ndarray, vector: np.ndarray) -> str:
        shape = np.zeros(6 * len(self.masses))
        shape[coordinates] = vector
        moving = int(np.abs(shape.reshape(-1, 6)[:, :3]).max(axis=1).argmax())
        return (
            f"no small vibration about rest: on its joints {self.names[moving]!r} is not held against a small "
            f"motion, or they "
            "are too soft for the weight on them; make their normal_stiffness larger, or rest it on joints that are closed."
        )

    def shares(self, shape: np.ndarray) -> np.ndarray:
        """Share of each joint in the elastic energy of a shape (N, 6), that of links left out, shape (J,)."""
        both = [np.concatenate((shape[joint.upper], shape[joint.lower])) for joint in self.joints]
        energy = np.array([q @ matrix @ q for matrix, q in zip(self.joint_matrices, both, strict=True)])
        return energy / max(float(energy.sum()), 1e-300)

    def top_motion(self, shape: np.ndarray) -> np.ndarray:
        """Displacement of the top [m] and rotation of its body [rad], shape (6,); of assemblies those that are largest."""
        if self.top is not None:
            own = shape[self.top_body]
            return np.concatenate((self._reach(self.top_body, self.top) @ own, own[3:]))
        flat = np.hypot(shape[:, 0], shape[:, 1])
        place = int(np.maximum(flat, np.abs(shape[:, 2])).argmax())
        return np.concatenate((shape[place, :3], shape[np.abs(shape[:, 5]).argmax(), 3:]))

    def limit_of(self, shape: np.ndarray) -> tuple[float, int, str]:
        """By how much a shape may be multiplied until a joint opens or slides; which, from 0, and what it does.

        A joint opens where its edge rises by as much as it is closed at rest; it slides where what friction leaves
        beside the shear at rest is used up.
        """
        best = (math.inf, 0, "opens")
        for number, joint in enumerate(self.joints):
            both = np.concatenate((shape[joint.upper], shape[joint.lower]))
            rise = self._rises(joint, joint.edge) @ both
            slip = float(np.hypot(*(joint.frame[:, :2].T @ self._passing(joint, joint.middle) @ both)))
            turn = joint.torsion * abs(float((both[3:6] - both[9:]) @ joint.normal))
            reserve = max(joint.friction - float(np.hypot(*(joint.frame[:, :2].T @ joint.force))), 0.0)
            reserve = reserve if reserve > 0.0 else math.inf  # slid at rest: that is told beside
            opens = _quotient(np.maximum(joint.closure, 0.0), np.abs(rise))
            slides = _quotient(np.array([reserve]), np.array([joint.shear * slip]))
            twists = _quotient(np.array([reserve * joint.lever]), np.array([turn]))
            event = min((opens, number, "opens"), (slides, number, "slides"), (twists, number, "twists"))
            best = min(best, event)
        return best


def _quotient(most: np.ndarray, now: np.ndarray) -> float:
    """The least of some quotients, of what is above rounding."""
    mask = now > 1e-12 * now.max(initial=1e-300)
    return float((most[mask] / now[mask]).min(initial=math.inf))


def _turned(force: np.ndarray, arm: np.ndarray) -> np.ndarray:
    """Second derivatives of F · ½ φ×(φ×r) by the rotation φ [N m], shape (3, 3)."""
    return 0.5 * (np.outer(force, arm) + np.outer(arm, force)) - (force @ arm) * np.eye(3)


def _add(matrix: np.ndarray, own: np.ndarray, upper: int, lower: int) -> None:
    """Add a matrix of the twelve coordinates of two bodies to that of all."""
    at = np.concatenate((6 * upper + np.arange(6), 6 * lower + np.arange(6)))
    matrix[np.ix_(at, at)] += own


def pressed(points: np.ndarray, springs: np.ndarray, edge: np.ndarray, load: float, place: np.ndarray) -> np.ndarray:
    """Depth of the edge of a joint that carries a load at a place, all points in contact [m], shape (k,).

    Parameters
    ----------
    points, edge, place : array
        In axes along the joint [m], shapes (m, 2), (k, 2) and (2,).
    springs : array
        [N/m], shape (m,).
    load : float
        [N]
    """
    rows = np.column_stack((np.ones(len(points)), points))
    matrix = rows.T @ (springs[:, None] * rows)
    line, *_ = np.linalg.lstsq(matrix, load * np.array([1.0, *place]), rcond=1e-12)
    return np.column_stack((np.ones(len(edge)), edge)) @ line
