"""Rotation of a body with an axis: its exact free motion at constant angular momentum.

The axes i, j, k of a body (k the axis of symmetry) turn as exp(dt [L]x / A) · exp(dt (1/C − 1/A) (L·k) [k]x): about its
own axis first, then about its angular momentum. Angles of a step are small: series stand for sines and cosines.
"""

from ..jit import law


@law
def spun(ax, ay, az, bx, by, bz, angle):
    """The first of two axes a, b after a turn by a small angle about the third."""
    square = angle * angle
    c = 1.0 - square * (0.5 - square * (1.0 / 24.0))
    s = angle * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0)))
    return c * ax + s * bx, c * ay + s * by, c * az + s * bz


@law
def turned(ax, ay, az, ux, uy, uz):
    """A vector a after a turn by a small rotation vector u."""
    square = ux * ux + uy * uy + uz * uz
    first = 1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0))
    second = 0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0))
    px, py, pz = uy * az - uz * ay, uz * ax - ux * az, ux * ay - uy * ax
    return (
        ax + first * px + second * (uy * pz - uz * py),
        ay + first * py + second * (uz * px - ux * pz),
        az + first * pz + second * (ux * py - uy * px),
    )
