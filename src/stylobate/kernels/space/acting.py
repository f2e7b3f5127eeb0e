"""What acts between two bodies in space at a point: how they move there, how easily, and what it does to both."""

from ..dem3d.move import omega
from ..jit import long_law
from ..shared.vectors import along, cross, dot, minus, of, put
from .friction import relax, tell


@long_law
def mobility(u, r, n):
    """Acceleration of the point of a body at r along n by a unit force along n there [1/kg]."""
    if u.fixed != 0:
        return 0.0
    c = cross(r, n)
    return u.im[0] + dot(c, omega(u, 0, c[0], c[1], c[2]))


@long_law
def velocity_then(u, r):
    """Velocity of the point of a body at r from its centroid as the last force left it."""
    w = cross(of(u.past), r)
    return u.vx[0] + w[0], u.vy[0] + w[1], u.vz[0] + w[2]


@long_law
def motion_then(q, u, v):
    """Velocity of the second body over the first one where the last force acted, and spin about its normal, after it."""
    spin = dot(minus(of(v.past), of(u.past)), of(q.n))
    return minus(velocity_then(v, of(q.rb)), velocity_then(u, of(q.ra))), spin


@long_law
def let_go(q, u, v, now):
    """Nothing rubs any more: what the last force has done is told, what its springs held is heat."""
    past, past_spin = motion_then(q, u, v)
    tell(q, past, past_spin, now)
    relax(q)


@long_law
def act_at(q, n, ru, rv):
    """Note the normal, and where the force of a step acts on either body."""
    put(q.n, n)
    put(q.ra, ru)
    put(q.rb, rv)


@long_law
def add(u, r, f, m):
    """Add a force at r and a moment to what acts on a body."""
    m = along(m, 1.0, cross(r, f))
    for c in range(3):
        u.f[c] += f[c]
        u.mo[c] += m[c]
