"""Bodies, starts and motions of the grounds that every engine is given: plain numbers, no engine.

Everything is told in the frame of the ground, which accelerates: its acceleration acts on every body with the opposite sign.
Engines that cannot do that move a base instead and take its place off what they return.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

GRAVITY, DENSITY, FRICTION = 9.81, 1600.0, 0.7

#: The paper's column: height, width at the bottom and at the top, depth [m]; diameter and height of the round one [m].
HEIGHT, BOTTOM, TOP, DEPTH = 5.0, 0.96, 0.66, 1.0
DIAMETER, TALL = 1.0, 4.0


@dataclass(frozen=True)
class Body:
    """One block, of the same density everywhere.

    ``block`` (width below, width above, depth, height) is a trapezium seen along y, ``cylinder`` (diameter, height) round,
    and ``prism`` the same with so many facets, one corner along x. The frame of a body has its origin in the centroid.
    """

    shape: str
    size: tuple[float, ...]
    facets: int = 0

    @property
    def height(self) -> float:
        return self.size[-1]

    @property
    def below(self) -> float:
        """Height of the centroid above the lower face."""
        if self.shape != "block":
            return 0.5 * self.height
        b, t = self.size[:2]
        return self.height * (b + 2.0 * t) / (3.0 * (b + t))

    def face(self, upper: bool = False, number: int = 720) -> np.ndarray:
        """Corners of a face, (k, 3); so many points of a round one."""
        if self.shape == "block":
            w, d = self.size[1 if upper else 0], self.size[2]
            flat = 0.5 * np.array([[-w, -d], [w, -d], [w, d], [-w, d]])
        else:
            count = self.facets or number
            angle = 2.0 * math.pi * np.arange(count) / count
            flat = 0.5 * self.size[0] * np.stack((np.cos(angle), np.sin(angle)), axis=1)
        return np.column_stack((flat, np.full(len(flat), -self.below + (self.height if upper else 0.0))))

    def mesh(self) -> tuple[np.ndarray, list[list[int]]]:
        """Vertices and triangles that look outwards."""
        low, high = self.face(), self.face(upper=True)
        n = len(low)
        faces = [[0, i + 1, i] for i in range(1, n - 1)] + [[n, n + i, n + i + 1] for i in range(1, n - 1)]
        for i in range(n):
            j = (i + 1) % n
            faces += [[i, j, n + j], [i, n + j, n + i]]
        return np.concatenate((low, high)), faces

    @property
    def inertia(self) -> tuple[float, np.ndarray]:
        """Mass [kg] and moments of inertia about x, y and z [kg m²], by a rule that is exact for slices of linear width."""
        mass, moments = 0.0, np.zeros(3)
        for place, weight in zip(*np.polynomial.legendre.leggauss(3), strict=True):
            z = 0.5 * self.height * (1.0 + place)
            if self.shape == "block":
                w, d = self.size[0] + (self.size[1] - self.size[0]) * z / self.height, self.size[2]
                area, xx, yy = w * d, w * w / 12.0, d * d / 12.0
            else:
                a, n = 0.5 * self.size[0], self.facets
                area = 0.5 * n * a * a * math.sin(2.0 * math.pi / n) if n else math.pi * a * a
                xx = yy = a * a * (2.0 + math.cos(2.0 * math.pi / n)) / 12.0 if n else 0.25 * a * a
            slab = 0.5 * self.height * weight * DENSITY * area
            zz = (z - self.below) ** 2
            mass += slab
            moments += slab * np.array([yy + zz, xx + zz, xx + yy])
        return mass, moments


@dataclass(frozen=True)
class Scene:
    """A stack of bodies, how it starts and how it is shaken.

    ``tilt`` leans the whole stack about its rim towards x [rad], ``omega`` is its angular velocity about that point
    [rad/s], ``ground`` gives (frequency [Hz], amplitude [m/s²], share across) of a sine of ten seconds, ``push`` a constant
    acceleration that is reached within a second [m/s²], at ``azimuth`` from x.
    """

    bodies: tuple[Body, ...]
    duration: float
    tilt: float = 0.0
    omega: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ground: tuple[float, float, float] | None = None
    push: float = 0.0
    azimuth: float = 0.0
    output: float = 0.005

    def acceleration(self, time) -> np.ndarray:
        """Acceleration of the ground along x and y at some times [m/s²], (2, …)."""
        t = np.asarray(time, float)
        if self.ground is not None:
            f, size, across = self.ground
            on, w = t < 10.0, 2.0 * math.pi * f
            return np.stack((np.sin(w * t), across * np.cos(w * t))) * (size * on)
        level = self.push * np.minimum(t, 1.0)
        return np.stack((level * math.cos(self.azimuth), level * math.sin(self.azimuth)))

    def fallen(self, height: float) -> bool:
        """Whether the centroid of the upper body is so low that the rest of the fall need not be computed."""
        return height < 0.6 * (sum(body.height for body in self.bodies[:-1]) + self.bodies[-1].below)

    @property
    def pivot(self) -> np.ndarray:
        return np.array([0.5 * self.bodies[0].size[0], 0.0, 0.0])

    def starts(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Centroid, rotation about y as (w, x, y, z) and velocity of each body."""
        c, s = math.cos(self.tilt), math.sin(self.tilt)
        turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
        quaternion = np.array([math.cos(0.5 * self.tilt), 0.0, math.sin(0.5 * self.tilt), 0.0])
        out, level = [], 0.0
        for body in self.bodies:
            arm = turn @ (np.array([0.0, 0.0, level + body.below]) - self.pivot)
            out.append((self.pivot + arm, quaternion, np.cross(self.omega, arm)))
            level += body.height
        return out


@dataclass(frozen=True)
class Run:
    """What an engine returns: times (T,), centroids (T, n, 3), rotation matrices (T, n, 3, 3), and the seconds it took.

    ``lost`` says that it ended because the collapse was certain, before the column had come down.
    """

    time: np.ndarray
    position: np.ndarray
    rotation: np.ndarray
    wall: float
    lost: bool = False

    @property
    def axis(self) -> np.ndarray:
        return self.rotation[..., 2]


def column(drums: int, wider: float = 0.0) -> tuple[Body, ...]:
    """The paper's column of so many drums, wider by a share."""
    widths = [(1.0 + wider) * (BOTTOM + (TOP - BOTTOM) * i / drums) for i in range(drums + 1)]
    return tuple(Body("block", (low, up, DEPTH, HEIGHT / drums)) for low, up in pairwise(widths))


def round_body(facets: int = 0) -> Body:
    """A round column in one piece, or a polygon's prism in its place with corners on the circle."""
    return Body("prism" if facets else "cylinder", (DIAMETER, TALL), facets)


def round_drums() -> tuple[Body, ...]:
    """Twelve round drums of one diameter, as high and on average as wide as the paper's column."""
    return (Body("cylinder", (0.5 * (BOTTOM + TOP), HEIGHT / 12)),) * 12
