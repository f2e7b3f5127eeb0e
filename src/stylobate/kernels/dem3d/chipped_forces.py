"""Forces of all joints between round faces with chips under the rim law, and the step that goes with them."""

from ..drums.frame import run_chunks
from ..jit import apart, kernel
from ..run_codes import LANES
from .chipped import chord, extent, left_of, press_left, press_upper
from .friction import NOTHING
from .ground import fill_ground
from .look import check_finite, joint_state, observe
from .move import ledger, move
from .pose import cross, faces, in_space, lean, middles, passing
from .records import block_types
from .rim import angle_of, overlap
from .rim_forces import ON_RIM, first_moment, moments
from .rubbing import carry

#: The models read these here.
__all__ = ["advance", "block_types", "forces", "joint_state", "ledger"]


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
            # where the discs overlap, and where the chip cuts them  # Eqs. (E2), (E26)
            s, cos_g, sin_g, side = middles(cx, cy, cz, hx, hy, hz, tx, ty, tz)
            sin_g *= side
            ru, rl = u.rb[l], v.rt[l]
            ra = ru * cosine
            psi_u, cos_u, sin_u, psi_l, cos_l, sin_l, _, _ = overlap(ra, rl, s)
            half_u, half_l = (psi_u, cos_u, sin_u), (psi_l, cos_l, sin_l)
            ax, ay, az = in_space(u, l, e.lost[0, l], e.lost[1, l], e.lost[2, l])
            ex, ey = ax * dx + ay * dy + az * dz, ax * tx + ay * ty + az * tz
            chip = (e.lost[3, l], e.lost[4, l], e.lost[5, l])
            reach = s * (sin_g * ex - cos_g * ey)
            tau = ra * chip[1] + s * (cos_g * ex + sin_g * ey)
            kept_u, side_u = left_of(-cos_g, -sin_g, half_u, ex, ey, chip)
            kept_l, side_l = left_of(cos_g, sin_g, half_l, ex, ey, angle_of((rl - tau) / rl))
            low, high = chord(ru, rl, cosine, reach, chip[2], tau)
            # area of what is left of the overlap, by Green's theorem round its rim
            lu, cu, su = extent(-cos_g, -sin_g, kept_u, side_u)
            ll, _, _ = extent(cos_g, sin_g, kept_l, side_l)
            lc = cosine * (high - low)
            area = 0.5 * (ra * (ra * lu + s * (cos_g * cu + sin_g * su)) + rl * rl * ll + tau * lc)
            rho = max(area, 0.0) / max(ra * lu + rl * ll + lc, NOTHING)
            kn = e.kn[l] * rho
            kl = kn * rl
            # depths along the rims and their pressure  # Eq. (E4)
            du, dl = -(cx * zx + cy * zy + cz * zz), -(cx * nx + cy * ny + cz * nz)
            pu, cu, su, qu, eu, lu, lc = press_upper(
                du, ru * sine, 0.0, ru, -cos_g, -sin_g, kept_u, side_u, ex, ey, chip[1], low, high
            )
            ll, nl, cl, sl = press_left(dl, rl * sine, 0.0, cos_g, sin_g, kept_l, side_l)
            e.en[l] = 0.5 * (kn * eu + kl * (dl * nl + rl * sine * cl))
            # first moments of pressure about the middle of the face below; force and moment there
            pu, cu, su, qu = kn * pu, kn * cu, kn * su, kn * qu
            pl, cl, sl = kl * nl, kl * rl * cl, kl * rl * sl
            ux, uy, uz = first_moment(pu, cx, cy, cz, cu, dx, dy, dz, su, tx, ty, tz)
            wx, wy, wz = first_moment(0.0, cx, cy, cz, cl, hx, hy, hz, sl, tx, ty, tz)
            fx, fy, fz = pu * zx + pl * nx, pu * zy + pl * ny, pu * zz + pl * nz
            mx, my, mz = moments(ux, uy, uz, zx, zy, zz, wx, wy, wz, nx, ny, nz)
            bx, by, bz, ix, iy, iz = fx, fy, fz, mx, my, mz
            if damped:
                # depth plus β × its rate, which is linear along a rim as well: no contact pulls  # Eq. (E5)
                beta = o.beta[l]
                ax, ay, az = cross(ox, oy, oz, zx, zy, zz)
                along = ru * (sine + beta * (ax * dx + ay * dy + az * dz))
                across = ru * beta * (ax * tx + ay * ty + az * tz)
                du -= beta * (vx * zx + vy * zy + vz * zz)
                pu, cu, su, qu, _, _, _ = press_upper(
                    du, along, across, ru, -cos_g, -sin_g, kept_u, side_u, ex, ey, chip[1], low, high
                )
                ax, ay, az = cross(ox, oy, oz, nx, ny, nz)
                along = rl * (sine + beta * (ax * hx + ay * hy + az * hz))
                across = rl * beta * (ax * tx + ay * ty + az * tz)
                ax, ay, az = cross(ox, oy, oz, cx, cy, cz)
                dl -= beta * ((vx - ax) * nx + (vy - ay) * ny + (vz - az) * nz)
                _, nl, cl, sl = press_left(dl, along, across, cos_g, sin_g, kept_l, side_l)
                pu, cu, su, qu = kn * pu, kn * cu, kn * su, kn * qu
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
                qu
                - (cu * cu + su * su) * eu
                + pl * rl * rl
                - (cl * cl + sl * sl) * el
                + pu * pl * each * (gx * gx + gy * gy + gz * gz)
            ) * each
            spread = max(spread, 0.0)
            closed = rho * (ra * lu + rl * ll + cosine * lc)
            stiffness, cohesion = e.ks[l] * closed, e.co[l] * closed
            face, middle = (rx, ry, rz, cx, cy, cz), (px, py, pz)
            velocity, spin = (vx, vy, vz), (ox, oy, oz)
            pressure, elastic = (fx, fy, fz, mx, my, mz), (bx, by, bz, ix, iy, iz)
            carry(
                e, o, u, v, l, damped, press_, spread, stiffness, cohesion, ON_RIM,
                face, middle, velocity, spin, pressure, elastic,
            )  # fmt: skip


@kernel
def advance(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, None, forces, move, check_finite, observe, state, chunks)
