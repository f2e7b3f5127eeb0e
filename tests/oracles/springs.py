"""A rigid body on spring contacts by scipy's adaptive integrator, which shares nothing with the package.

Quaternions and Euler's equations; penalty springs at the vertices over a flat ground that accelerates, a share of the normal
force missing while a vertex leaves, shear springs with Coulomb's limit, whose memory is part of the state.
"""

import numpy as np
from scipy.integrate import solve_ivp

G = 9.80665


def matrix(q):
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


class Body:
    """Mass, inertia in body axes, vertices from the centroid, stiffnesses of a vertex [N/m], friction, restitution."""

    def __init__(self, mass, inertia, vertices, normal, shear, friction, restitution, slow=2e-3):
        self.mass, self.inertia, self.vertices = mass, np.asarray(inertia, float), np.asarray(vertices, float)
        self.inverse = np.linalg.inv(self.inertia)
        self.kn, self.ks, self.mu, self.lost, self.slow = normal, shear, friction, 1.0 - restitution**2, slow

    def rates(self, t, y, ground):
        x, q, v, w = y[:3], y[3:7], y[7:10], y[10:13]  # w in body axes
        memory = y[13:].reshape(-1, 2)
        q = q / np.linalg.norm(q)
        turn = matrix(q)
        arms = self.vertices @ turn.T
        speeds = v + np.cross(turn @ w, arms)
        depth = -(x[2] + arms[:, 2])
        touching = depth > 0.0
        leaving = np.clip(speeds[:, 2] / self.slow, 0.0, 1.0)
        normal = np.where(touching, self.kn * depth * (1.0 - self.lost * leaving), 0.0)
        shear = -self.ks * memory
        size = np.linalg.norm(shear, axis=1)
        limit = self.mu * normal
        factor = np.where(size > limit, limit / np.maximum(size, 1e-300), 1.0)
        shear = shear * factor[:, None]
        # the spring's stretch follows the slip; what is over the limit relaxes fast
        stretch = np.where(touching[:, None], speeds[:, :2], 0.0)
        stretch = stretch - (memory * (1.0 - factor)[:, None]) * 2e4
        forces = np.column_stack((shear, normal))
        force = forces.sum(axis=0) + self.mass * np.array([-ground(t), 0.0, -G])
        moment = turn.T @ np.cross(arms, forces).sum(axis=0)
        spin = self.inverse @ (moment - np.cross(w, self.inertia @ w))
        dq = 0.5 * np.array(
            [
                -q[1] * w[0] - q[2] * w[1] - q[3] * w[2],
                q[0] * w[0] + q[2] * w[2] - q[3] * w[1],
                q[0] * w[1] + q[3] * w[0] - q[1] * w[2],
                q[0] * w[2] + q[1] * w[1] - q[2] * w[0],
            ]
        )
        return np.concatenate((v, dq, force / self.mass, spin, stretch.ravel()))

    def move(self, state, times, ground=lambda t: 0.0, step=2e-4, tolerance=1e-6, stop=None, method="LSODA"):
        """States at times; positions and quaternions first."""
        start = np.concatenate((state, np.zeros(2 * len(self.vertices))))
        return solve_ivp(
            self.rates, (times[0], times[-1]), start, method, times, events=stop, args=(ground,), rtol=tolerance,
            atol=1e-9, max_step=step,
        )  # fmt: skip
