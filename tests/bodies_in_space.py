"""Bodies in space for tests: boxes and cylinders as plain numbers, lanes of them, and what is read off."""

import math

import numpy as np

from stylobate.column.shapes import Mesh
from stylobate.models.space.loose import Loose
from stylobate.models.space.packing import Drum, Face, FacesJoined, HalfSpace, Solid

G, DENSITY = 9.81, 2700.0

#: Of a drum of 0.8 m and 1 m that lies on its side [m].
RADIUS = 0.4

#: Turns the axis of a cylinder from z to y: it lies.
SIDES = ((3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def turn(*vector):
    """Rotation matrix of a rotation vector [rad]."""
    angle = float(np.linalg.norm(vector))
    if angle == 0.0:
        return np.eye(3)
    x, y, z = np.array(vector) / angle
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * k + (1.0 - math.cos(angle)) * k @ k


LYING = turn(0.5 * math.pi, 0.0, 0.0)


def box_mesh(sides):
    around = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return Mesh(np.array([[x, y, z] for z in (-1, 1) for x, y in around]) * 0.5 * np.array(sides), SIDES)


def box(sides, place, axes=None, velocity=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0), fixed=False):
    x, y, z = sides
    mass = 0.0 if fixed else DENSITY * x * y * z
    inertia = mass / 12.0 * np.diag([y * y + z * z, x * x + z * z, x * x + y * y])
    return Solid([box_mesh(sides)], *_pose(place, axes), mass, inertia, np.array(velocity), np.array(spin))


def cylinder(radius, height, place, axes=None, velocity=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0)):
    mass = DENSITY * math.pi * radius**2 * height
    inertia = mass * np.diag([(3.0 * radius**2 + height**2) / 12.0] * 2 + [0.5 * radius**2])
    drum = Drum(np.array([0.0, 0.0, -0.5 * height]), np.array([0.0, 0.0, 1.0]), height, radius, radius)
    return Solid([drum], *_pose(place, axes), mass, inertia, np.array(velocity), np.array(spin))


def ground(place=(0.0, 0.0, 0.0), axes=None):
    return Solid([HalfSpace()], *_pose(place, axes))


def _pose(place, axes):
    return np.array(place, dtype=float), np.eye(3) if axes is None else axes


class Lane(Loose):
    """Bodies with one law of contact, under gravity, in steps of ``step``."""

    def __init__(
        self, *solids, kn=5e10, mu=0.7, restitution=1.0, step=4e-5, gravity=(0.0, 0.0, G), law=None, joints=()
    ):
        if law is None:
            law = np.empty((len(solids), len(solids), 3))
            law[...] = kn, 0.5 * kn, mu
        super().__init__(solids, law, gravity, restitution, joints=joints)
        self.step = step
        self.start(step)

    def run(self, duration, look=None, chunks=1):
        """Advance; what ``look`` gives after every so many chunks, and the times [s]."""
        times, seen = [], []
        for _ in range(round(duration / self.step / 32 / chunks)):
            self.advance(chunks)
            if look is not None:
                times.append(self.time)
                seen.append(look())
        assert not self.failed
        return np.array(times), seen

    @property
    def time(self):
        return self.feed["step"][0, 0] * self.step

    def _vector(self, i, names):
        return np.array([self.body[name][i, 0] for name in names.split()])

    def place(self, i):
        return self._vector(i, "x y z")

    def velocity(self, i):
        return self._vector(i, "vx vy vz")

    def spin(self, i):
        return self._vector(i, "wx wy wz")

    def axes(self, i):
        """Axes of the body as it was given, as columns."""
        mine = np.array([[self.body[axis + c][i, 0] for axis in "ijk"] for c in "xyz"])
        return mine @ self.packed.turn[i].T

    def contact(self, a, b):
        """Area of the contact of two shapes [m²]."""
        pairs = self.pair[: self.now["pairs"][0]]
        return float(pairs["area"][(pairs["a"] == a) & (pairs["b"] == b)].sum())

    @property
    def local_damping(self):
        return float(self.body["local"].max())

    @local_damping.setter
    def local_damping(self, share):
        self.body["local"] = share


def _frame(up):
    return np.eye(3) if up else np.diag([1.0, -1.0, -1.0])


def square_face(half, height, up=True, x=0.0):
    """A square face of a body across its axis z."""
    corners = half * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return Face(np.array([x, 0.0, height]), _frame(up), corners)


def disc_face(radius, height, up=True):
    return Face(np.array([0.0, 0.0, height]), _frame(up), np.zeros((0, 2)), radius)


def faces_joined(lower, upper, below, above, kn, mu=0.7):
    return FacesJoined(lower, upper, below, above, kn, 0.5 * kn, mu, 0.0, math.radians(50.0))


def lying(place=(0.0, 0.0, RADIUS), **motion):
    return cylinder(RADIUS, 1.0, place, LYING, **motion)


def after_impact(lane, look):
    """What is seen when the first contact with the ground has opened again."""
    while lane.contact(0, 1) == 0.0:
        lane.advance(1)
    while lane.contact(0, 1) > 0.0:
        lane.advance(1)
    return look()


def quarter(times, lean):
    k = np.argmax(np.array(lean) < 0.0)
    return times[k - 1] + (times[k] - times[k - 1]) * lean[k - 1] / (lean[k - 1] - lean[k])


def portal(tilt, kn, step, **others):
    """Two monoliths under a beam, leaning along it; joints everywhere."""
    turned, half = turn(0.0, tilt, 0.0), 0.4

    def column(x):
        return box((0.8, 0.8, 4.0), np.array([x + half, 0.0, 0.0]) + turned @ [-half, 0.0, 2.0], turned)

    top = turned @ [-2.0 * half, 0.0, 4.0] + [2.0 * half, 0.0, 0.0]
    beam = box((3.2, 0.8, 0.6), (top[0], 0.0, top[2] + 0.3))
    joints = []
    for i, x in ((1, -1.2), (2, 1.2)):
        floor, under = square_face(3.0, 0.5), square_face(half, -0.3, up=False, x=x)
        joints.append(faces_joined(0, i, floor, square_face(half, -2.0, up=False), kn))
        joints.append(faces_joined(i, 3, square_face(half, 2.0), under, kn))
    base = box((30.0, 30.0, 1.0), (0.0, 0.0, -0.5), fixed=True)
    return Lane(base, column(-1.2), column(1.2), beam, kn=kn, joints=joints, step=step, **others)
