"""Linear oscillators under an acceleration that is linear between samples, without approximation of the step.

Symbols: a ground acceleration, h step, w circular frequency, z damping, u relative displacement, v relative velocity.
"""

from __future__ import annotations

import math

from .jit import kernel, law


@law
def transition(w, z, h):
    """Coefficients of u and v over one step of free vibration."""
    wd = w * math.sqrt(1.0 - z * z)
    e = math.exp(-z * w * h)
    c = e * math.cos(wd * h)
    s = e * math.sin(wd * h) / wd
    return c + z * w * s, s, -w * w * s, c - z * w * s


@law
def advance(u, v, p, q, h, w, z, c11, c12, c21, c22):
    """One step under −a = p + q τ: the particular solution is b + d τ."""
    d = q / (w * w)
    b = (p - 2.0 * z * w * d) / (w * w)
    u0 = u - b
    v0 = v - d
    return c11 * u0 + c12 * v0 + b + d * h, c21 * u0 + c22 * v0 + d


@kernel
def peaks(a, dt, periods, z, per_period, parts, out):
    """Largest |u|, |v| and |absolute acceleration| of each period; ``out`` of shape (periods, 3).

    Each step is divided so that ``per_period`` states fall on a period, and into so many ``parts`` at least, because the
    velocity follows the input within a step; one more period of free vibration follows.
    """
    n = a.shape[0]
    for j in range(periods.shape[0]):
        w = 2.0 * math.pi / periods[j]
        k = max(parts, math.ceil(per_period * dt / periods[j]))
        h = dt / k
        c11, c12, c21, c22 = transition(w, z, h)
        u = v = 0.0
        mu = mv = 0.0
        ma = 0.0
        for i in range(n - 1):
            q = -(a[i + 1] - a[i]) / dt
            for r in range(k):
                u, v = advance(u, v, -a[i] + q * (r * h), q, h, w, z, c11, c12, c21, c22)
                mu = max(mu, abs(u))
                mv = max(mv, abs(v))
                ma = max(ma, abs(w * w * u + 2.0 * z * w * v))
        for _ in range(math.ceil(periods[j] / h)):
            u, v = c11 * u + c12 * v, c21 * u + c22 * v
            mu = max(mu, abs(u))
            mv = max(mv, abs(v))
            ma = max(ma, abs(w * w * u + 2.0 * z * w * v))
        out[j, 0] = mu
        out[j, 1] = mv
        out[j, 2] = ma


@kernel
def rotated_peaks(ax, ay, dt, periods, z, per_period, cosine, sine, out):
    """Largest |u_x cos θ + u_y sin θ| of each period and angle; ``out`` of shape (periods, angles), zero at first."""
    n = ax.shape[0]
    angles = cosine.shape[0]
    for j in range(periods.shape[0]):
        w = 2.0 * math.pi / periods[j]
        k = max(1, math.ceil(per_period * dt / periods[j]))  # for displacements
        h = dt / k
        c11, c12, c21, c22 = transition(w, z, h)
        row = out[j]
        least = 0.0
        ux = vx = uy = vy = 0.0
        for i in range(n - 1 + math.ceil(periods[j] / dt)):
            px = py = qx = qy = 0.0
            if i < n - 1:
                px, py = -ax[i], -ay[i]
                qx, qy = -(ax[i + 1] - ax[i]) / dt, -(ay[i + 1] - ay[i]) / dt
            for r in range(k):
                ux, vx = advance(ux, vx, px + qx * (r * h), qx, h, w, z, c11, c12, c21, c22)
                uy, vy = advance(uy, vy, py + qy * (r * h), qy, h, w, z, c11, c12, c21, c22)
                if ux * ux + uy * uy > least * least:  # else no direction's peak can grow
                    least = math.inf
                    for m in range(angles):
                        row[m] = max(row[m], abs(ux * cosine[m] + uy * sine[m]))
                        least = min(least, row[m])
