"""A response as other tools take it: bodies, joints and links at instants, in axes whose z is upward."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from stylobate.column.found_geometry import base_axes, space_geometry
from stylobate.column.links.placed import strokes
from stylobate.column.shapes import Glued, Mesh, Placed
from stylobate.errors import InputError, check_range
from stylobate.response import Response
from stylobate.response.poses import quaternions, rotation_matrices

#: Corners of circles in what is written.
AROUND = 48

#: Most instants that one file or folder of them holds.
MOST = 5000


class Piece(NamedTuple):
    """A convex part of a body: the body's number among those that a run records, and its surface in the body's axes."""

    body: int
    mesh: Mesh


@dataclass(frozen=True, eq=False)
class Recording:
    """A response at some of its recorded instants, relative to the moving base.

    Parameters
    ----------
    response : Response
    instants : array
        Numbers of the recorded states, shape (k,).
    """

    response: Response
    instants: np.ndarray

    @classmethod
    def frames(cls, response: Response, rate: float) -> Recording:
        """So many instants a second, of those before anything is not finite.

        Raises
        ------
        InputError
            Too many of them, or none.
        """
        check_range("`fps`", rate, 0.0, 1000.0, unit="1/s", open_low=True, field="fps")
        time = response.time[: _finite(response)]
        if (time[-1] - time[0]) * rate >= MOST:
            raise InputError(
                f"{time[-1] - time[0]:.4g} s at {rate:g} a second are more than {MOST} instants; give fewer a second.",
                "fps",
            )
        wanted = np.arange(time[0], time[-1] + 0.5 / rate, 1.0 / rate)
        return cls(response, np.unique(np.abs(time[:, None] - wanted[None]).argmin(axis=0)))

    @classmethod
    def instant(cls, response: Response, at: float) -> Recording:
        """The recorded state that is nearest to a time [s].

        Raises
        ------
        InputError
            The time is outside of what is recorded.
        """
        time = response.time[: _finite(response)]
        if not time[0] <= at <= time[-1]:
            raise InputError(f"`at` is {at:g} s; the run is recorded from {time[0]:g} to {time[-1]:.6g} s.", "at")
        return cls(response, np.array([int(np.abs(time - at).argmin())]))

    @property
    def time(self) -> np.ndarray:
        """[s], shape (k,)"""
        return self.response.time[self.instants]

    # -- bodies ------------------------------------------------------------------------------------------------------

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Convex parts of all bodies but a ground without ends."""
        pieces = []
        for body in self.response.bodies.shown:
            shape = self.response.bodies.shapes[body]
            parts = shape.parts if isinstance(shape, Glued) else (Placed(shape),)
            pieces += [Piece(body, part.mesh(AROUND)) for part in parts]
        return tuple(pieces)

    @cached_property
    def _upright(self) -> np.ndarray:
        """From the axes that poses are recorded in to those whose z is upward [-], shape (3, 3)."""
        return base_axes(self.response.structure) if self.response.dims == "xyz" else np.eye(3)

    @cached_property
    def position(self) -> np.ndarray:
        """Centroids at every recorded state [m], shape (T, n, 3)."""
        return self.response.poses.position @ self._upright.T

    @cached_property
    def axes(self) -> np.ndarray:
        """Axes of the bodies as columns at every recorded state [-], shape (T, n, 3, 3)."""
        return self._upright @ rotation_matrices(self.response.poses.orientation)

    @cached_property
    def turn(self) -> np.ndarray:
        """The same at the instants as quaternions x, y, z, w that never jump to their opposite [-], shape (k, n, 4)."""
        orientation = quaternions(self.axes[self.instants])
        steps = np.sign((orientation[1:] * orientation[:-1]).sum(axis=-1, keepdims=True))
        signs = np.cumprod(np.where(steps < 0.0, -1.0, 1.0), axis=0)
        orientation[1:] *= signs
        return np.roll(orientation, -1, axis=-1)

    @cached_property
    def velocity(self) -> np.ndarray:
        """Of the centroids [m/s], shape (T, n, 3): as recorded of assemblies, else by differences of the places."""
        recorded = self.response.histories.velocity
        if recorded is not None:
            return recorded @ self._upright.T
        time = self.response.time
        if len(time) < 2:
            return np.zeros_like(self.position)
        return np.gradient(self.position, time, axis=0)

    # -- joints and links --------------------------------------------------------------------------------------------

    @cached_property
    def joints(self) -> tuple[tuple[int, np.ndarray], ...]:
        """Of every joint the body above it, by its number among those recorded, and its middle in that body's axes [m]."""
        structure = self.response.structure
        if structure.space_joints is not None:
            places = [(joint.upper, joint.origin) for joint in structure.space_joints]
        elif structure.stack is not None:
            base, at = base_axes(structure), space_geometry(structure.stack)
            places = [(i + 1, base @ origin) for i, origin in enumerate(at.origin)]
        else:
            places = [(pair.upper, _middle(structure.bodies[pair.upper], pair.above)) for pair in structure.face_pairs]
        joints = []
        for number, place in places:
            body = number - structure.first
            joints.append((body, self.axes[0, body].T @ (place - self.position[0, body])))
        return tuple(joints)

    def joint_places(self, index: int) -> np.ndarray:
        """Middles of the joints at a recorded state [m], shape (J, 3)."""
        return np.array([self._stands(index, body, arm) for body, arm in self.joints]).reshape(-1, 3)

    def link_ends(self, index: int) -> list[tuple[int, np.ndarray]]:
        """Links that are drawn as a line: their number among the histories and their ends [m], shape (2, 3)."""
        structure, known = self.response.structure, [link.name for link in self.response.measures.links]
        if self.response.histories.links is None:
            return []
        base, lines = base_axes(structure), []
        for stroke in strokes(structure.placed_links):
            if stroke.link.name in known:
                ends = [
                    base @ arm if number < structure.first else self._stands(index, number - structure.first, arm)
                    for number, arm, _ in stroke[1:]
                ]
                lines.append((known.index(stroke.link.name), np.array(ends)))
        return lines

    def _stands(self, index: int, body: int, arm: np.ndarray) -> np.ndarray:
        return self.position[index, body] + self.axes[index, body] @ arm


def _middle(body, face) -> np.ndarray:
    """Middle of a lower face of a body as it stands, in space [m], shape (3,)."""
    (c, s), (x, z) = face.direction, body.place
    along, down = 0.5 * (face.right - face.left), -face.height
    lean_c, lean_s = math.cos(body.lean), math.sin(body.lean)
    u, w = along * c - down * s, along * s + down * c
    return np.array([x + lean_c * u - lean_s * w, 0.0, z + lean_s * u + lean_c * w])


def _finite(response: Response) -> int:
    """Number of the recorded states before one that is not finite, as a run that failed may end in."""
    poses = response.poses
    both = np.concatenate((poses.position, poses.orientation), axis=2)
    good: np.ndarray = np.array(np.isfinite(both.reshape(len(both), -1)).all(axis=1))
    if not good[0]:
        raise InputError(f"the run of {response.structure.name!r} holds no state that is finite; run it again.")
    return len(good) if good.all() else int(good.argmin())
