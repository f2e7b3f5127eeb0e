"""Forces of all joints between round faces on an elastic bed without tension, and the step that goes with them."""

import math

from ..drums.frame import run_chunks
from ..jit import apart, kernel, law
from ..run_codes import LANES
from .bed import settle, settle_askew, settle_ring
from .friction import NOTHING
from .ground import fill_ground
from .look import check_finite, joint_state, observe
from .move import ledger, move
from .pose import cross, faces, in_space, lean, middles, passing
from .records import block_types
from .rim import overlap
from .rubbing import carry

#: The models read these here.
__all__ = ["advance", "block_types", "forces", "joint_state", "ledger"]


#: Torsion over shear stiffness and ρ², limit of torsion over that of shear and ρ: a disc under even pressure has 1, 2R/3.
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


@apart
def forces(drum, joint, lane):
    """Forces of all joints at t_n; brings the contact memory from t_{n−1} to t_n."""
    o = lane[0]
    for q in range(drum.shape[0] - 1):
        u = drum[q + 1]
        v = drum[q]
        e = joint[q]
        damped = e.d.shape[0] > 1
        for l in range(LANES):
            zx, zy, zz = v.kx[l], v.ky[l], v.kz[l]
            nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
            rx, ry, rz, cx, cy, cz = faces(u, v, l)
            hx, hy, hz, tx, ty, tz, sine, cosine = lean(nx, ny, nz, zx, zy, zz, v.ix[l], v.iy[l], v.iz[l])
            vx, vy, vz, ox, oy, oz = passing(u, v, l, rx, ry, rz, cx, cy, cz)
            s, cos_g, sin_g, side = middles(cx, cy, cz, hx, hy, hz, tx, ty, tz)
            along, across = s * cos_g, s * sin_g * side
            rl = v.rt[l]
            ra = u.rb[l] * cosine
            _, cos_u, _, _, cos_l, sin_l, _, _ = overlap(ra, rl, s)
            kn = e.kn[l]
            slope = sine / cosine
            d = -(cx * zx + cy * zy + cz * zz) - slope * along
            limit = EVEN[1]
            iu = il = 0.0
            if e.lost.shape[0] > 1:
                iu, il, limit = e.lost[0, l] * cosine, e.lost[1, l], e.lost[2, l]
                sums = settle_ring(d, slope, 0.0, along, across, ra, rl, iu, il)
            else:
                sums = settle(d, slope, along, across, ra, rl, -cos_u, cos_l, sin_l)
            # regions of the upper face push along the lower normal, regions of the lower face along the upper one
            share = min(max((cos_g + cos_u) / max(cos_l + cos_u, NOTHING), 0.0), 1.0)
            low, high = (1.0 - share) / cosine, share * cosine
            normal, other = (zx, zy, zz), (nx, ny, nz)
            e.en[l] = 0.5 * kn * sums[5] * (low + share * cosine * cosine)
            n, x, y = kn * sums[1], kn * sums[2], kn * sums[3]
            elastic = resultant(n, x, y, low, high, hx, hy, hz, tx, ty, tz, normal, other)
            second = kn * sums[4]
            pressure = elastic
            if damped:
                # depth plus β × its rate, which is linear over the face as well: no contact pulls  # Eq. (E5)
                beta = o.beta[l]
                ax, ay, az = cross(ox, oy, oz, zx, zy, zz)
                gx = beta * (ax * hx + ay * hy + az * hz)
                gy = beta * (ax * tx + ay * ty + az * tz)
                d -= beta * (vx * zx + vy * zy + vz * zz) + gx * along + gy * across
                if e.lost.shape[0] > 1:
                    more = settle_ring(d, slope + gx, gy, along, across, ra, rl, iu, il)
                else:
                    more = settle_askew(d, slope + gx, gy, along, across, ra, rl, -cos_u, cos_l, sin_l)
                n, x, y, second = kn * more[1], kn * more[2], kn * more[3], kn * more[4]
                pressure = resultant(n, x, y, low, high, hx, hy, hz, tx, ty, tz, normal, other)
            each = 1.0 / max(n, NOTHING)
            x, y = x * each, y * each
            spread = max(second * each - x * x - y * y, 0.0)
            px, py, pz = x * hx + y * tx, x * hy + y * ty, x * hz + y * tz
            stiffness, cohesion = e.ks[l] * sums[0], e.co[l] * sums[0]
            face, middle = (rx, ry, rz, cx, cy, cz), (px, py, pz)
            velocity, spin = (vx, vy, vz), (ox, oy, oz)
            pressing = n * (low + high)
            carry(
                e, o, u, v, l, damped, pressing, spread, stiffness, cohesion, (EVEN[0], limit),
                face, middle, velocity, spin, pressure, elastic,
            )  # fmt: skip


@kernel
def advance(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, None, forces, move, check_finite, observe, state, chunks)
