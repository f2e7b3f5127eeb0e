"""Forces of all joints between round faces under the rim law, and the step that goes with them."""

import math

from ..drums.frame import run_chunks
from ..jit import apart, kernel, law
from ..run_codes import LANES
from .friction import NOTHING
from .ground import fill_ground
from .look import check_finite, joint_state, observe
from .move import ledger, move
from .pose import cross, faces, in_space, lean, middles, passing
from .records import block_types
from .rim import angle_to, overlap, press, press_askew
from .rubbing import carry

#: The models read these here.
__all__ = ["advance", "block_types", "forces", "joint_state", "ledger"]


#: Torsion over shear stiffness and ρ², limit of torsion over that of shear and ρ: a closed disc has K_s R²/2 and 2R/3.
ON_RIM = (0.5, 2.0 / 3.0)


@law
def first_moment(p, cx, cy, cz, a, ax, ay, az, b, bx, by, bz):
    """p c + a e + b f: the first moment of a rim's pressure, from its middle c and its axes e and f."""
    return p * cx + a * ax + b * bx, p * cy + a * ay + b * by, p * cz + a * az + b * bz


@law
def moments(ux, uy, uz, zx, zy, zz, wx, wy, wz, nx, ny, nz):
    """u × z + w × n: moment of both rims' pressures along their normals."""
    ax, ay, az = cross(ux, uy, uz, zx, zy, zz)
    bx, by, bz = cross(wx, wy, wz, nx, ny, nz)
    return ax + bx, ay + by, az + bz


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
            # steepest descent in the upper face
            dx, dy, dz = cosine * hx - sine * zx, cosine * hy - sine * zy, cosine * hz - sine * zz
            vx, vy, vz, ox, oy, oz = passing(u, v, l, rx, ry, rz, cx, cy, cz)
            # where the discs overlap  # Eq. (E2)
            s, cos_g, sin_g, side = middles(cx, cy, cz, hx, hy, hz, tx, ty, tz)
            ru, rl = u.rb[l], v.rt[l]
            ra = ru * cosine
            psi_u, cos_u, sin_u, psi_l, cos_l, sin_l, area, rim = overlap(ra, rl, s)
            rho = area / max(rim, NOTHING)
            kn = e.kn[l] * rho
            ku, kl = kn * ru, kn * rl
            # depths along the two rims and their pressure  # Eq. (E4)
            gamma = angle_to(cos_g, sin_g)
            du, dl = -(cx * zx + cy * zy + cz * zz), -(cx * nx + cy * ny + cz * nz)
            lu, nu, cu, su = press(du, ru * sine, math.pi - gamma, -cos_g, sin_g, psi_u, cos_u, sin_u)
            ll, nl, cl, sl = press(dl, rl * sine, gamma, cos_g, sin_g, psi_l, cos_l, sin_l)
            e.en[l] = 0.5 * (ku * (du * nu + ru * sine * cu) + kl * (dl * nl + rl * sine * cl))
            su *= -side
            sl *= side
            # first moments of pressure about the middle of the face below; force and moment there
            pu, cu, su = ku * nu, ku * ru * cu, ku * ru * su
            pl, cl, sl = kl * nl, kl * rl * cl, kl * rl * sl
            ux, uy, uz = first_moment(pu, cx, cy, cz, cu, dx, dy, dz, su, tx, ty, tz)
            wx, wy, wz = first_moment(0.0, cx, cy, cz, cl, hx, hy, hz, sl, tx, ty, tz)
            fx, fy, fz = pu * zx + pl * nx, pu * zy + pl * ny, pu * zz + pl * nz
            mx, my, mz = moments(ux, uy, uz, zx, zy, zz, wx, wy, wz, nx, ny, nz)
            ex, ey, ez, ix, iy, iz = fx, fy, fz, mx, my, mz
            if damped:
                # depth plus β × its rate, which is linear along a rim as well: no contact pulls  # Eq. (E5)
                beta = o.beta[l]
                ax, ay, az = cross(ox, oy, oz, zx, zy, zz)
                along = ru * (sine + beta * (ax * dx + ay * dy + az * dz))
                across = ru * beta * (ax * tx + ay * ty + az * tz)
                du -= beta * (vx * zx + vy * zy + vz * zz)
                _, nu, cu, su = press_askew(du, along, across, -cos_g, -side * sin_g, psi_u, cos_u, sin_u)
                ax, ay, az = cross(ox, oy, oz, nx, ny, nz)
                along = rl * (sine + beta * (ax * hx + ay * hy + az * hz))
                across = rl * beta * (ax * tx + ay * ty + az * tz)
                ax, ay, az = cross(ox, oy, oz, cx, cy, cz)
                dl -= beta * ((vx - ax) * nx + (vy - ay) * ny + (vz - az) * nz)
                _, nl, cl, sl = press_askew(dl, along, across, cos_g, side * sin_g, psi_l, cos_l, sin_l)
                pu, cu, su = ku * nu, ku * ru * cu, ku * ru * su
                pl, cl, sl = kl * nl, kl * rl * cl, kl * rl * sl
                ux, uy, uz = first_moment(pu, cx, cy, cz, cu, dx, dy, dz, su, tx, ty, tz)
                wx, wy, wz = first_moment(0.0, cx, cy, cz, cl, hx, hy, hz, sl, tx, ty, tz)
                fx, fy, fz = pu * zx + pl * nx, pu * zy + pl * ny, pu * zz + pl * nz
                mx, my, mz = moments(ux, uy, uz, zx, zy, zz, wx, wy, wz, nx, ny, nz)
            # normal resultant, its middle P and its spread about P
            press_ = pu + pl
            each = 1.0 / max(press_, NOTHING)
            px, py, pz = (ux + wx) * each, (uy + wy) * each, (uz + wz) * each
            eu, el = 1.0 / max(pu, NOTHING), 1.0 / max(pl, NOTHING)
            gx, gy, gz = ux * eu - wx * el, uy * eu - wy * el, uz * eu - wz * el
            spread = (
                pu * ru * ru
                - (cu * cu + su * su) * eu
                + pl * rl * rl
                - (cl * cl + sl * sl) * el
                + pu * pl * each * (gx * gx + gy * gy + gz * gz)
            ) * each
            spread = max(spread, 0.0)
            closed = rho * (ra * lu + rl * ll)
            stiffness, cohesion = e.ks[l] * closed, e.co[l] * closed
            face, middle = (rx, ry, rz, cx, cy, cz), (px, py, pz)
            velocity, spin = (vx, vy, vz), (ox, oy, oz)
            pressure, elastic = (fx, fy, fz, mx, my, mz), (ex, ey, ez, ix, iy, iz)
            carry(
                e, o, u, v, l, damped, press_, spread, stiffness, cohesion, ON_RIM,
                face, middle, velocity, spin, pressure, elastic,
            )  # fmt: skip


@kernel
def advance(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, None, forces, move, check_finite, observe, state, chunks)
