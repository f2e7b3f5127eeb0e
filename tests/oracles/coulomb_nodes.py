"""A rigid body on a rigid plane with Coulomb friction node by node; it shares nothing with the package.

The base of the body carries on nodes: each presses with k_n w times its depth, holds by a spring of k_s w from where it came
to touch, and slides at μ times its own pressure. Nodes on the edge of the base are the boundary law, nodes all over it an
elastic bed. What friction does as one force, one torsion moment and a limit of both is what a node does alone.

Leapfrog: forces at t_n, velocities at t_{n+1/2}; angular momentum in space, and a rotation by the angular velocity in the
middle of the step.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

#: Height of a body that has fallen, over its height at the start [-].
FALLEN = 0.6


class Base(NamedTuple):
    """Nodes of the base of a body.

    Parameters
    ----------
    place : array
        In the plane of the base, from under the centroid [m], shape (n, 2).
    area : array
        That each node stands for [m²], shape (n,).
    """

    place: np.ndarray
    area: np.ndarray


def _spread(edge: np.ndarray, lengths: np.ndarray, area: float) -> Base:
    """Nodes on an edge, each with its share of an area by the length that it stands for."""
    return Base(edge, area * lengths / lengths.sum())


def box(width: float, depth: float, nodes: int = 160) -> Base:
    """The edge of a rectangle."""
    step = 2.0 * (width + depth) / nodes
    places = []
    for x, y, along, length in ((-1, -1, 0, width), (1, -1, 1, depth), (1, 1, 0, -width), (-1, 1, 1, -depth)):
        count = round(abs(length) / step)
        s = (np.arange(count) + 0.5) / count * length
        corner = np.array([0.5 * x * width, 0.5 * y * depth])
        places.append(corner + np.outer(s, np.eye(2)[along]))
    edge = np.concatenate(places)
    return _spread(edge, np.ones(len(edge)), width * depth)


def disc(diameter: float, nodes: int = 128) -> Base:
    """The edge of a disc."""
    angle = (np.arange(nodes) + 0.5) * 2.0 * np.pi / nodes
    edge = 0.5 * diameter * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    return _spread(edge, np.ones(nodes), 0.25 * math.pi * diameter**2)


def chipped(diameter: float, chip: float, nodes: int = 128) -> Base:
    """The edge of a disc without the segment beyond a chord, which is ``chip`` deep and lies towards +x."""
    radius = 0.5 * diameter
    half = math.acos(1.0 - chip / radius)
    arc, chord = 2.0 * (math.pi - half) * radius, 2.0 * radius * math.sin(half)
    on_chord = max(round(nodes * chord / (arc + chord)), 2)
    angle = half + (np.arange(nodes - on_chord) + 0.5) * 2.0 * (math.pi - half) / (nodes - on_chord)
    y = chord * ((np.arange(on_chord) + 0.5) / on_chord - 0.5)
    edge = np.concatenate(
        (radius * np.stack((np.cos(angle), np.sin(angle)), axis=1), np.stack((0.0 * y + radius - chip, y), axis=1))
    )
    lengths = np.concatenate((np.full(len(angle), arc / len(angle)), np.full(on_chord, chord / on_chord)))
    return _spread(edge, lengths, radius**2 * (math.pi - half + math.sin(half) * math.cos(half)))


def ring(outer: float, inner: float, circles: int = 6, nodes: int = 96) -> Base:
    """All of a ring between two diameters; of a disc where the inner one is 0."""
    bounds = 0.5 * np.sqrt(np.linspace(inner**2, outer**2, circles + 1))  # circles of the same area
    angle = (np.arange(nodes) + 0.5) * 2.0 * np.pi / nodes
    directions = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    middle = np.sqrt(0.5 * (bounds[1:] ** 2 + bounds[:-1] ** 2))
    place = (middle[:, None, None] * directions).reshape(-1, 2)
    return _spread(place, np.ones(len(place)), 0.25 * math.pi * (outer**2 - inner**2))


class Body(NamedTuple):
    """A body on its base.

    Parameters
    ----------
    base : Base
    height : float
        Of the centroid over the base [m].
    mass : float
        [kg]
    inertia : array
        Principal moments about the centroid, about x, y and the axis z [kg m²], shape (3,).
    """

    base: Base
    height: float
    mass: float
    inertia: np.ndarray


def block(base: Base, width: float, depth: float, height: float, density: float = 2400.0) -> Body:
    """A prism of a rectangle."""
    mass = density * width * depth * height
    inertia = mass / 12.0 * np.array([depth**2 + height**2, width**2 + height**2, width**2 + depth**2])
    return Body(base, 0.5 * height, mass, inertia)


def drum(base: Base, diameter: float, height: float, density: float = 2400.0) -> Body:
    """A cylinder."""
    radius = 0.5 * diameter
    mass = density * math.pi * radius**2 * height
    across = mass * (0.25 * radius**2 + height**2 / 12.0)
    return Body(base, 0.5 * height, mass, np.array([across, across, 0.5 * mass * radius**2]))


@njit(cache=True)
def _turn(w, dt):
    """Rotation matrix of an angular velocity over a time."""
    angle = math.sqrt(w[0] ** 2 + w[1] ** 2 + w[2] ** 2) * dt
    k = np.zeros((3, 3))
    k[0, 1], k[0, 2], k[1, 2] = -w[2] * dt, w[1] * dt, -w[0] * dt
    k -= k.T.copy()
    sinc = math.sin(angle) / angle if angle > 1e-9 else 1.0
    half = math.sin(0.5 * angle) / (0.5 * angle) if angle > 1e-9 else 1.0
    return np.eye(3) + sinc * k + 0.5 * half * half * (k @ k)


@njit(cache=True)
def _run(place, area, height, mass, inertia, kn, ks, mu, beta, gravity, push, step, x, r, v, w, dt, steps, every, seen):
    """Steps of a body; ``seen`` takes place, the three axes, velocity, momentum and heat after every so many."""
    n = len(area)
    was = np.zeros((n, 2))
    hold = np.zeros((n, 2))
    touched = np.zeros(n, dtype=np.bool_)
    momentum = r @ (inertia * (r.T @ w))
    heat, kept = 0.0, 0
    for k in range(steps + 1):
        force, moment = np.zeros(3), np.zeros(3)
        for q in range(n):
            ax = r[0, 0] * place[q, 0] + r[0, 1] * place[q, 1] - r[0, 2] * height
            ay = r[1, 0] * place[q, 0] + r[1, 1] * place[q, 1] - r[1, 2] * height
            az = r[2, 0] * place[q, 0] + r[2, 1] * place[q, 1] - r[2, 2] * height
            depth = -(x[2] + az)
            sx, sy = v[0] + w[1] * az - w[2] * ay, v[1] + w[2] * ax - w[0] * az
            press = kn * area[q] * (depth - beta * (v[2] + w[0] * ay - w[1] * ax))
            if depth <= 0.0:
                if touched[q]:
                    heat += 0.5 * (hold[q, 0] ** 2 + hold[q, 1] ** 2) / (ks * area[q])
                    touched[q] = False
                    hold[q] = 0.0
                if beta == 0.0 or press <= 0.0:
                    continue
            else:
                press = max(press, 0.0)
                if touched[q]:
                    hold[q, 0] -= ks * area[q] * (x[0] + ax - was[q, 0])
                    hold[q, 1] -= ks * area[q] * (x[1] + ay - was[q, 1])
                touched[q] = True
                was[q, 0], was[q, 1] = x[0] + ax, x[1] + ay
            size = math.sqrt(hold[q, 0] ** 2 + hold[q, 1] ** 2)
            if size > mu * press:
                heat += mu * press * (size - mu * press) / (ks * area[q])
                hold[q, 0] *= mu * press / size
                hold[q, 1] *= mu * press / size
            fx, fy = hold[q, 0] - beta * ks * area[q] * sx, hold[q, 1] - beta * ks * area[q] * sy
            size = math.sqrt(fx * fx + fy * fy)
            if beta > 0.0 and size > mu * press:
                fx, fy = fx * mu * press / size, fy * mu * press / size
            force[0] += fx
            force[1] += fy
            force[2] += press
            moment[0] += ay * press - az * fy
            moment[1] += az * fx - ax * press
            moment[2] += ax * fy - ay * fx
        if k % every == 0:
            seen[kept, :3], seen[kept, 3:12] = x, r.copy().reshape(9)
            seen[kept, 12:15], seen[kept, 15:18], seen[kept, 18] = v, w, heat
            kept += 1
            if x[2] < FALLEN * height:
                break
        at = k * dt / step
        i = min(int(at), len(push) - 2)
        shove = push[i] + min(at - i, 1.0) * (push[i + 1] - push[i])
        v = v + dt * (force / mass + gravity - shove)
        x = x + dt * v
        momentum = momentum + dt * moment
        w = r @ ((r.T @ momentum) / inertia)
        half = _turn(w, 0.5 * dt) @ r
        w = half @ ((half.T @ momentum) / inertia)
        r = _turn(w, dt) @ r
    return kept


class Seen(NamedTuple):
    """A run: time [s], place of the centroid [m], axes as columns, velocity [m/s], spin [rad/s], heat of friction [J]."""

    time: np.ndarray
    place: np.ndarray
    axes: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray
    heat: np.ndarray
    fell: bool

    @property
    def tilt(self) -> np.ndarray:
        """Of the axis [rad]."""
        return np.arccos(np.clip(self.axes[:, 2, 2], -1.0, 1.0))

    @property
    def twist(self) -> np.ndarray:
        """About the vertical [rad]."""
        return np.unwrap(np.arctan2(self.axes[:, 1, 0] - self.axes[:, 0, 1], self.axes[:, 0, 0] + self.axes[:, 1, 1]))

    def base(self, body: Body) -> np.ndarray:
        """Place of the middle of the base [m]."""
        return self.place - body.height * self.axes[:, :, 2]


def run(
    body: Body, duration: float, dt: float = 5e-5, *, mu: float = 0.7, kn: float = 5e9, ks: float | None = None, beta=0.0,
    gravity=(0.0, 0.0, -9.81), push=None, step: float = 0.005, velocity=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0),
    axes=None, place=None, every: float = 0.01,
) -> Seen:  # fmt: skip
    """A body from rest on its base, pressed down by its weight, or from a pose.

    ``beta`` is dashpot over stiffness of a node [s], in normal and in shear; no node pulls, and friction in sum stays within
    Coulomb's. ``push`` is the acceleration of the base, shape (T, 3), in steps of ``step`` [s]; what is seen is kept every
    so often.
    """
    gravity = np.array(gravity, dtype=float)
    sunk = -body.mass * gravity[2] / (kn * body.base.area.sum())
    x = np.array([0.0, 0.0, body.height - sunk]) if place is None else np.array(place, dtype=float)
    r = np.eye(3) if axes is None else np.ascontiguousarray(axes, dtype=float)
    push = np.zeros((2, 3)) if push is None else np.ascontiguousarray(push, dtype=float)
    steps, kept = round(duration / dt), round(every / dt)
    seen = np.zeros((steps // kept + 1, 19))
    count = _run(
        body.base.place, body.base.area, body.height, body.mass, body.inertia, kn, 0.5 * kn if ks is None else ks, mu,
        beta, gravity, push, step, x, r, np.array(velocity, dtype=float), np.array(spin, dtype=float), dt, steps, kept, seen,
    )  # fmt: skip
    got = seen[:count]
    return Seen(
        np.arange(count) * kept * dt, got[:, :3], got[:, 3:12].reshape(-1, 3, 3), got[:, 12:15], got[:, 15:18],
        got[:, 18], count < len(seen),
    )  # fmt: skip


def slope(degrees: float, towards: float = 0.0) -> tuple[float, float, float]:
    """Gravity on a plane that falls by an angle towards an azimuth [rad]."""
    a = math.radians(degrees)
    return 9.81 * math.sin(a) * math.cos(towards), 9.81 * math.sin(a) * math.sin(towards), -9.81 * math.cos(a)
