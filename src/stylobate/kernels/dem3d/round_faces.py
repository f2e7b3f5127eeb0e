"""Joints of round faces: how two faces stand to each other, the pressure of a law there, friction, forces on both drums.

A law of pressure, of faces that carry on their rims (``rim.py``) or on a bed (``bed.py``), is handed in. From the joint,
the lane, both drums, and how the faces stand to each other it gives::

    pressing, spread      normal force [N], mean square distance of pressure from its middle [m²]
    touching              area of what touches [m²], its polar moment about its centroid [m⁴], and that centroid [m]
    torsion               κ and λ of K_T = κ k_s J and of the limit λ ρ μ N
    middle                of pressure [m]
    pressure, elastic     its force and moment about the middle of the face below; the same without dashpots
"""

import math

from ..jit import law
from ..shared.friction import NOTHING, dragged, friction
from ..shared.vectors import along, dot, length, minus, scaled
from ..shared.vectors import cross as vector
from .pose import faces, in_body, in_space, lean, middles, passing
from .records import BETA

#: Share of a relative rolling velocity that its resistance may take in one step.
STOPPING = 0.5


@law
def resistance(rolling, pressing, dx, dy, dz, ox, oy, oz, u, v, l, dt):
    """Moment that resists rolling, c N r against the part of the angular velocity along r.  # Eq. (E12)

    r = (dx, dy, dz) goes from the middle of the face to that of pressure; no step takes more than a share of the velocity,
    by the inertia that both drums have about r: a drum that lies on its side turns about its own axis there.
    """
    square = dx * dx + dy * dy + dz * dz
    each = 1.0 / math.sqrt(max(square, 1e-24))
    rate = (ox * dx + oy * dy + oz * dz) * each
    below = (u.kx[l] * dx + u.ky[l] * dy + u.kz[l] * dz) * each
    above = (v.kx[l] * dx + v.ky[l] * dy + v.kz[l] * dz) * each
    mobility = u.ia[l] + u.ic[l] * below * below + v.ia[l] + v.ic[l] * above * above
    most = STOPPING * abs(rate) / max(mobility * dt, NOTHING)
    size = min(rolling * pressing * square * each, most) * each
    size = -size if rate > 0.0 else size
    return size * dx, size * dy, size * dz


@law
def on_face(pressure_of, e, f, o, sums, u, v, l):
    """Forces at t_n of a joint of round faces under a law of pressure; brings its memory from t_{n−1} to t_n.

    ``sums`` takes the work of its springs and dashpots: the lane's own record, or one in which each joint adds for itself.
    """
    zx, zy, zz = v.kx[l], v.ky[l], v.kz[l]
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    rx, ry, rz, cx, cy, cz = faces(u, v, l)
    hx, hy, hz, tx, ty, tz, sine, cosine = lean(nx, ny, nz, zx, zy, zz, v.ix[l], v.iy[l], v.iz[l])
    vx, vy, vz, ox, oy, oz = passing(u, v, l, rx, ry, rz, cx, cy, cz)
    leaning = (nx, ny, nz, hx, hy, hz, tx, ty, tz, sine, cosine)
    way = middles(cx, cy, cz, hx, hy, hz, tx, ty, tz)
    face, velocity, spin = (rx, ry, rz, cx, cy, cz), (vx, vy, vz), (ox, oy, oz)
    pressing, spread, touching, torsion, middle, pressure, elastic = pressure_of(
        e, o, u, v, l, leaning, way, (cx, cy, cz), velocity, spin
    )
    rub(e, f, o, sums, u, v, l, pressing, spread, touching, torsion, face, middle, velocity, spin, pressure, elastic)


@law
def rub(e, f, o, sums, u, v, l, pressing, spread, touching, torsion, face, middle, velocity, spin, pressure, elastic):
    """Adds friction to the pressure of a joint and puts the sum on the two drums.

    Vectors, beside those of a law of pressure: ``face`` from the upper centroid to the middle of its face, and that middle
    from the one below; ``velocity`` of the upper face's middle and ``spin`` as seen from the drum below.
    """
    area, squares, centre = touching
    rx, ry, rz, cx, cy, cz = face
    c = (cx, cy, cz)
    fx, fy, fz, mx, my, mz = pressure
    ex, ey, ez, ix, iy, iz = elastic
    dt = o.dt[l]
    z = (v.kx[l], v.ky[l], v.kz[l])
    # the tangent plane of friction
    n = along((fx, fy, fz), NOTHING, z)
    n = scaled(1.0 / length(n), n)
    # slip and spin of the upper drum over the lower one at the centroid of what touches, beside the middle of pressure
    centre = along(centre, dot(minus(middle, centre), n), n)
    at = along(velocity, 1.0, vector(spin, minus(centre, c)))
    slip, turning = along(at, -dot(at, n), n), dot(spin, n)
    # friction with one limit for both  # Eq. (E6)
    limits = e.mu[l] * pressing + e.co[l] * area, torsion[1] * torsion[1] * spread
    pivot = o.pivot[l]
    compact = max(area, 0.0) / max(squares, NOTHING)
    own = e.ks[l] * area, torsion[0] * e.ks[l] * squares, centre, middle, compact
    turning = turning if pivot > 0.0 else 0.0
    core, fresh = layers(e, v, l, pivot, centre)
    before = along(core[0], 1.0, fresh[0])
    core, fresh, q, twist = friction(core, fresh, own, n, slip, turning, dt, limits)
    remember(e, v, l, core, fresh)
    # work of the forces a step ago and now, with their moments about the middle of the face below
    about = along(vector(centre, q), pivot * twist, n)
    work = dot(along(before, 1.0, q), minus(velocity, vector(spin, c)))
    work += dot(along((e.tm[0, l], e.tm[1, l], e.tm[2, l]), 1.0, about), spin)
    sums.shear[l] -= 0.5 * dt * work
    e.tm[0, l], e.tm[1, l], e.tm[2, l] = about
    if e.d.shape[0] > 1:
        # dashpots parallel to the springs; friction in sum stays within Coulomb's
        g, turn = dragged(q, twist, own, n, slip, turning, o.damp[BETA, l], limits)
        drag = along((fx - ex, fy - ey, fz - ez), 1.0, g)
        m = along(along((mx - ix, my - iy, mz - iz), 1.0, vector(centre, g)), pivot * turn, n)
        if o.roll.shape[0] > 1:
            # towards the middle of elastic pressure: that of all pressure is a quotient of velocities in a flat impact
            a = minus(scaled(1.0 / max(dot((ex, ey, ez), n), NOTHING), vector(n, (ix, iy, iz))), c)
            a = along(a, -dot(a, n), n)
            a = resistance(o.roll[0, l], pressing, a[0], a[1], a[2], spin[0], spin[1], spin[2], u, v, l, dt)
            mx, my, mz = mx + a[0], my + a[1], mz + a[2]
            m = along(m, 1.0, a)
        q, twist = along(q, 1.0, g), twist + turn
        before = (e.d[0, l], e.d[1, l], e.d[2, l])
        power = dot(along(drag, 1.0, before), minus(velocity, vector(spin, c)))
        before = (e.d[3, l], e.d[4, l], e.d[5, l])
        power += dot(along(m, 1.0, before), spin)
        sums.visc[l] -= 0.5 * dt * power
        e.d[0, l], e.d[1, l], e.d[2, l] = drag
        e.d[3, l], e.d[4, l], e.d[5, l] = m
    # all of it on the two drums
    force = along((fx, fy, fz), 1.0, q)
    m = along(along((mx, my, mz), 1.0, vector(centre, q)), pivot * twist, n)
    f.f[0, l], f.f[1, l], f.f[2, l] = force
    f.up[0, l], f.up[1, l], f.up[2, l] = minus(m, vector((cx - rx, cy - ry, cz - rz), force))
    f.lo[0, l], f.lo[1, l], f.lo[2, l] = minus(scaled(-v.ht[l], vector(z, force)), m)


@law
def layers(e, v, l, pivot, centre):
    """Both layers of shear of a joint a step ago, in space: see ``shared/friction.py``.

    A face that pivots freely does not turn on what touches: its core goes along with it, and it rolls without creeping.
    """
    at = in_space(v, l, e.at[0, l], e.at[1, l], e.at[2, l])
    at = at if pivot > 0.0 else centre
    return (
        (
            in_space(v, l, e.s[0, l], e.s[1, l], e.s[2, l]),
            e.t[l],
            e.kc[l],
            e.jc[l],
            at,
        ),
        (in_space(v, l, e.fs[0, l], e.fs[1, l], e.fs[2, l]), e.ft[l], e.kf[l], e.jf[l]),
    )


@law
def remember(e, v, l, core, fresh):
    """Write both layers into the record of a joint, in the axes of the drum below."""
    s, e.t[l], e.kc[l], e.jc[l], at = core
    e.at[0, l], e.at[1, l], e.at[2, l] = in_body(v, l, at[0], at[1], at[2])
    e.s[0, l], e.s[1, l], e.s[2, l] = in_body(v, l, s[0], s[1], s[2])
    s, e.ft[l], e.kf[l], e.jf[l] = fresh
    e.fs[0, l], e.fs[1, l], e.fs[2, l] = in_body(v, l, s[0], s[1], s[2])
