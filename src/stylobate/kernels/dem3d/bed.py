"""The bed law: two round faces on an elastic bed without tension, by strips across the direction of lean.

Within the overlap of the two faces the depth is linear along the direction of lean and even across it. The touching part
is cut into strips across; their places follow Gauss's rule in the angle f of x = −cos f, which is analytic at both ends (the
rim's square root, and the line up to which the joint touches).

Pressure is spread over the overlap of two discs, or over that of two rings.
"""

import math

from ..jit import law
from ..shared.friction import NOTHING
from .pose import CENTRED, cross
from .records import BETA
from .rim import overlap

#: Places (−1 … 1) and weights of the strips: with eight of them a disc is met to 1e-6, a lens to 5e-3 at worst.
STRIPS = (
    (-0.9980552138505068, 0.009912027615086657),
    (-0.9494253842988188, 0.10968247133521512),
    (-0.7348899387554324, 0.33418939614548837),
    (-0.2841679239019288, 0.5462161049042066),
    (0.28416792390192847, 0.5462161049042067),
    (0.7348899387554323, 0.3341893961454884),
    (0.9494253842988187, 0.10968247133521522),
    (0.9980552138505068, 0.00991202761508666),
)


@law
def support(along, cos_g, sin_g, ra, rl, q_u, cos_l, sin_l):
    """Reach of the overlap of two discs in a direction; cos_g and sin_g (≥ 0) are that of the upper one's middle."""
    corner = (cos_g > q_u) & (cos_g < cos_l)
    return rl * (cos_g * cos_l + sin_g * sin_l) if corner else min(along + ra, rl)


@law
def strip(sums, node, middle, half, d, g, along, across, ra, rl):
    """Adds a strip: area, depth, its moments along and across, of second order, and its square, each times the area; and
    moments of the area along and across, and of second order."""
    x = middle + half * node[0]
    depth = max(d + g * x, 0.0)
    upper = math.sqrt(max(ra * ra - (x - along) * (x - along), 0.0))
    lower = math.sqrt(max(rl * rl - x * x, 0.0))
    top, bottom = min(across + upper, lower), max(across - upper, -lower)
    chord = max(top - bottom, 0.0)
    y = 0.5 * (top + bottom)
    area = half * node[1] * chord
    n = area * depth
    square = x * x + y * y + chord * chord * (1.0 / 12.0)
    return (
        sums[0] + area,
        sums[1] + n,
        sums[2] + n * x,
        sums[3] + n * y,
        sums[4] + n * square,
        sums[5] + n * depth,
        sums[6] + area * x,
        sums[7] + area * y,
        sums[8] + area * square,
    )


@law
def settle(d, g, along, across, ra, rl, q_u, cos_l, sin_l):
    """Sums of all strips for the depth d + g x, x from the middle of the lower face along the direction of lean."""
    s = math.sqrt(along * along + across * across)
    each = 1.0 / max(s, CENTRED)
    near = s < CENTRED
    cos_g = 1.0 if near else along * each
    sin_g = 0.0 if near else abs(across) * each
    high = support(along, cos_g, sin_g, ra, rl, q_u, cos_l, sin_l)
    low = -support(-along, -cos_g, sin_g, ra, rl, q_u, cos_l, sin_l)
    low = max(low, -d / max(g, 1e-18))
    half = max(0.5 * (high - low), 0.0)
    middle = 0.5 * (high + low)
    sums = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    sums = strip(sums, STRIPS[0], middle, half, d, g, along, across, ra, rl)
    sums = strip(sums, STRIPS[1], middle, half, d, g, along, across, ra, rl)
    sums = strip(sums, STRIPS[2], middle, half, d, g, along, across, ra, rl)
    sums = strip(sums, STRIPS[3], middle, half, d, g, along, across, ra, rl)
    sums = strip(sums, STRIPS[4], middle, half, d, g, along, across, ra, rl)
    sums = strip(sums, STRIPS[5], middle, half, d, g, along, across, ra, rl)
    sums = strip(sums, STRIPS[6], middle, half, d, g, along, across, ra, rl)
    return strip(sums, STRIPS[7], middle, half, d, g, along, across, ra, rl)


@law
def settle_askew(d, gx, gy, along, across, ra, rl, q_u, cos_l, sin_l):
    """As :func:`settle` for the depth d + gx x + gy y; moments along and across the original directions."""
    g = math.sqrt(gx * gx + gy * gy)
    flat = g < 1e-18
    each = 1.0 / max(g, 1e-18)
    c = 1.0 if flat else gx * each
    s = 0.0 if flat else gy * each
    sums = settle(d, g, along * c + across * s, across * c - along * s, ra, rl, q_u, cos_l, sin_l)
    return (
        sums[0],
        sums[1],
        sums[2] * c - sums[3] * s,
        sums[2] * s + sums[3] * c,
        sums[4],
        sums[5],
        sums[6] * c - sums[7] * s,
        sums[6] * s + sums[7] * c,
        sums[8],
    )


@law
def settle_ring(d, gx, gy, along, across, ra, rl, ia, il):
    """As :func:`settle_askew` for two rings, of radii ra and rl, whose middles are sunk within ia and il.

    The overlap of the discs, less what of it lies over either sunken middle.  # Eq. (E11)
    """
    s = math.sqrt(along * along + across * across)
    _, cos_u, _, _, cos_l, sin_l, _, _ = overlap(ra, rl, s)
    a = settle_askew(d, gx, gy, along, across, ra, rl, -cos_u, cos_l, sin_l)
    _, cos_u, _, _, cos_l, sin_l, _, _ = overlap(ia, rl, s)
    b = settle_askew(d, gx, gy, along, across, ia, rl, -cos_u, cos_l, sin_l)
    _, cos_u, _, _, cos_l, sin_l, _, _ = overlap(ra, il, s)
    c = settle_askew(d, gx, gy, along, across, ra, il, -cos_u, cos_l, sin_l)
    _, cos_u, _, _, cos_l, sin_l, _, _ = overlap(ia, il, s)
    e = settle_askew(d, gx, gy, along, across, ia, il, -cos_u, cos_l, sin_l)
    n = a[1] - b[1] - c[1] + e[1]
    contact = 1.0 if n > 0.0 else 0.0
    return (
        max(a[0] - b[0] - c[0] + e[0], 0.0) * contact,
        n * contact,
        (a[2] - b[2] - c[2] + e[2]) * contact,
        (a[3] - b[3] - c[3] + e[3]) * contact,
        max(a[4] - b[4] - c[4] + e[4], 0.0) * contact,
        max(a[5] - b[5] - c[5] + e[5], 0.0) * contact,
        (a[6] - b[6] - c[6] + e[6]) * contact,
        (a[7] - b[7] - c[7] + e[7]) * contact,
        max(a[8] - b[8] - c[8] + e[8], 0.0) * contact,
    )


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
