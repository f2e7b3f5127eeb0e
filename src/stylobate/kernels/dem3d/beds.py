"""The law of a joint of round faces on an elastic bed without tension: pressure spread over their overlap, or over rings."""

import math

from ..jit import law
from ..shared.friction import NOTHING
from .bed import settle, settle_askew, settle_ring
from .pose import cross
from .records import BETA
from .rim import overlap

#: Torsion over shear stiffness and polar moment of what touches, limit of torsion over that of shear and ρ: a disc under
#: even pressure has 1, 2R/3.
EVEN = (1.0, 2.0 * math.sqrt(2.0) / 3.0)


@law
def resultant(n, x, y, low, high, hx, hy, hz, tx, ty, tz, normal, other):
    """Force and moment of pressure n with moments x and y along h and t: shares along the lower and the upper normal."""
    ax, ay, az = x * hx + y * tx, x * hy + y * ty, x * hz + y * tz
    nx, ny, nz = (
        low * normal[0] + high * other[0],
        low * normal[1] + high * other[1],
        low * normal[2] + high * other[2],
    )
    mx, my, mz = cross(ax, ay, az, nx, ny, nz)
    return n * nx, n * ny, n * nz, mx, my, mz


@law
def on_bed(still, moving, limit, e, o, u, v, l, leaning, way, c, velocity, spin):
    """Pressure of a joint of round faces on the overlap of what carries of them.

    ``still`` and ``moving`` give the sums over that overlap, ``limit`` that of torsion.
    """
    nx, ny, nz, hx, hy, hz, tx, ty, tz, sine, cosine = leaning
    zx, zy, zz = v.kx[l], v.ky[l], v.kz[l]
    s, cos_g, sin_g, side = way
    cx, cy, cz = c
    along, across = s * cos_g, s * sin_g * side
    rl = v.rt[l]
    ra = u.rb[l] * cosine
    _, cos_u, _, _, cos_l, sin_l, _, _ = overlap(ra, rl, s)
    kn = e.kn[l]
    slope = sine / cosine
    d = -(cx * zx + cy * zy + cz * zz) - slope * along
    area, n, x, y, second, square, ax, ay, squares = still(
        e, l, cosine, d, slope, along, across, ra, rl, -cos_u, cos_l, sin_l
    )
    each = 1.0 / max(area, NOTHING)
    ax, ay = ax * each, ay * each
    centre = ax * hx + ay * tx, ax * hy + ay * ty, ax * hz + ay * tz
    touching = area, max(squares - area * (ax * ax + ay * ay), 0.0), centre
    # regions of the upper face push along the lower normal, regions of the lower face along the upper one
    share = min(max((cos_g + cos_u) / max(cos_l + cos_u, NOTHING), 0.0), 1.0)
    low, high = (1.0 - share) / cosine, share * cosine
    normal, other = (zx, zy, zz), (nx, ny, nz)
    e.en[l] = 0.5 * kn * square * (low + share * cosine * cosine)
    n, x, y, second = kn * n, kn * x, kn * y, kn * second
    elastic = resultant(n, x, y, low, high, hx, hy, hz, tx, ty, tz, normal, other)
    pressure = elastic
    if e.d.shape[0] > 1:
        # depth plus β × its rate, which is linear over the face as well: no contact pulls  # Eq. (E5)
        beta = o.damp[BETA, l]
        vx, vy, vz = velocity
        ox, oy, oz = spin
        ax, ay, az = cross(ox, oy, oz, zx, zy, zz)
        gx = beta * (ax * hx + ay * hy + az * hz)
        gy = beta * (ax * tx + ay * ty + az * tz)
        d -= beta * (vx * zx + vy * zy + vz * zz) + gx * along + gy * across
        _, n, x, y, second, _, _, _, _ = moving(
            e, l, cosine, d, slope + gx, gy, along, across, ra, rl, -cos_u, cos_l, sin_l
        )
        n, x, y, second = kn * n, kn * x, kn * y, kn * second
        pressure = resultant(n, x, y, low, high, hx, hy, hz, tx, ty, tz, normal, other)
    each = 1.0 / max(n, NOTHING)
    x, y = x * each, y * each
    spread = max(second * each - x * x - y * y, 0.0)
    middle = x * hx + y * tx, x * hy + y * ty, x * hz + y * tz
    return n * (low + high), spread, touching, (EVEN[0], limit(e, l)), middle, pressure, elastic


@law
def disc_still(e, l, cosine, d, slope, along, across, ra, rl, q_u, cos_l, sin_l):
    """Sums over the overlap of two discs for a depth that does not vary across the lean."""
    return settle(d, slope, along, across, ra, rl, q_u, cos_l, sin_l)


@law
def disc(e, l, cosine, d, slope, aside, along, across, ra, rl, q_u, cos_l, sin_l):
    """Sums over the overlap of two discs."""
    return settle_askew(d, slope, aside, along, across, ra, rl, q_u, cos_l, sin_l)


@law
def disc_limit(e, l):
    """Limit of torsion over that of shear and ρ of a disc."""
    return EVEN[1]


@law
def ring_still(e, l, cosine, d, slope, along, across, ra, rl, q_u, cos_l, sin_l):
    """Sums over the overlap of two rings for a depth that does not vary across the lean."""
    return settle_ring(d, slope, 0.0, along, across, ra, rl, e.ring[0, l] * cosine, e.ring[1, l])


@law
def ring(e, l, cosine, d, slope, aside, along, across, ra, rl, q_u, cos_l, sin_l):
    """Sums over the overlap of two rings."""
    return settle_ring(d, slope, aside, along, across, ra, rl, e.ring[0, l] * cosine, e.ring[1, l])


@law
def ring_limit(e, l):
    """Limit of torsion over that of shear and ρ of two rings."""
    return e.ring[2, l]


@law
def disc_beds(e, o, u, v, l, leaning, way, c, velocity, spin):
    """Pressure of a joint of whole faces."""
    return on_bed(disc_still, disc, disc_limit, e, o, u, v, l, leaning, way, c, velocity, spin)


@law
def ring_beds(e, o, u, v, l, leaning, way, c, velocity, spin):
    """Pressure of a joint of faces whose middles are sunk."""
    return on_bed(ring_still, ring, ring_limit, e, o, u, v, l, leaning, way, c, velocity, spin)
