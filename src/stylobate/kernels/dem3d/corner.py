"""The law of a point of contact in space: where a corner touches the face below, and spring, dashpot and friction there.

The plane model's law with one direction more: a no-tension spring along the normal, an incremental shear force that is a
vector within Coulomb's cone, dashpots that stay within both in sum. All in the axes of the body below.
"""

import math

from ..jit import law

#: Keeps quotients of nothing by nothing at nothing.
NOTHING = 1e-300

#: A point that leaves faster than this comes back with the lower stiffness in full [m/s].
SLOW = 2e-3


@law
def corner(u, w, p, l):
    """Corner p of a drum's lower face in the frame of the face below [m]; ``w`` is the joint's scratch."""
    a, b, c = u.px[p, l], u.py[p, l], u.pz[p, l]
    return (
        w[12, l] + a * w[0, l] + b * w[3, l] + c * w[6, l],
        w[13, l] + a * w[1, l] + b * w[4, l] + c * w[7, l],
        w[14, l] + a * w[2, l] + b * w[5, l] + c * w[8, l],
    )


@law
def clamped(x, half):
    """The nearest place within the half width of a face."""
    return min(max(x, -half), half)


@law
def contact(x, y, z, tx, ty, nx, ny, nz, cx, cy, cz):
    """Contact of a corner at x, y, z with a face of half widths tx, ty: place, gap, normal.  # Eq. (E21)

    Above the face the corner touches it, along its normal. Beyond an edge the nearest place on the edge touches the upper
    face, of normal n through c, along n.
    """
    inside = (abs(x) < tx) & (abs(y) < ty)
    x, y = clamped(x, tx), clamped(y, ty)
    beyond = nx * (cx - x) + ny * (cy - y) + nz * cz
    return (
        x,
        y,
        z if inside else 0.0,
        z if inside else beyond,
        0.0 if inside else nx,
        0.0 if inside else ny,
        1.0 if inside else nz,
    )


@law
def within(x, y, z, limit):
    """Factor that brings a vector within a length: 1 if it is."""
    square = x * x + y * y + z * z
    return math.sqrt(min(limit * limit / max(square, NOTHING), 1.0))


@law
def touch(gap, nx, ny, nz, vx, vy, vz, sx, sy, sz, kn, ks, beta, lost, mu, co, dt):
    """Forces at a point of contact.  # Eqs. (E22), (E25)

    Parameters: gap [m], normal, velocity of the upper body relative to the lower one, shear force until now [N], stiffnesses
    [N/m], dashpots over stiffness [s], share of the normal force that is missing while the point leaves, friction, cohesion
    [N], step [s]. Returns normal force of the spring, of what dissipates beside it, shear force of the spring (3), of the
    dashpot (3), and the work of the shear spring on its surroundings.
    """
    normal = max(-kn * gap, 0.0)
    closed = normal > 0.0
    speed = vx * nx + vy * ny + vz * nz
    leaving = min(max(speed * (1.0 / SLOW), 0.0), 1.0)
    push = max(-beta * kn * speed - lost * leaving * normal, -normal) if closed else 0.0
    limit = mu * (normal + push) + (co if closed else 0.0)
    vx, vy, vz = vx - speed * nx, vy - speed * ny, vz - speed * nz
    out = sx * nx + sy * ny + sz * nz
    qx = sx - out * nx - ks * dt * vx
    qy = sy - out * ny - ks * dt * vy
    qz = sz - out * nz - ks * dt * vz
    less = within(qx, qy, qz, limit)
    qx, qy, qz = qx * less, qy * less, qz * less
    work = 0.5 * dt * ((sx + qx) * vx + (sy + qy) * vy + (sz + qz) * vz)
    gx, gy, gz = qx - beta * ks * vx, qy - beta * ks * vy, qz - beta * ks * vz
    less = within(gx, gy, gz, limit)
    return normal, push, qx, qy, qz, gx * less - qx, gy * less - qy, gz * less - qz, work
