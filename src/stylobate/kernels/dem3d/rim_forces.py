"""Forces of all joints between round faces under the rim law, and the step that goes with them."""

import math

from ..drums.lanes import CHUNK, COLLAPSED, ENDED, FAILED, FREE, LANES, RUNNING, running_lanes
from ..jit import apart, kernel, law
from .friction import NOTHING, kept, returned
from .ground import fill_ground
from .look import close_chunk, joint_state
from .move import ledger, move
from .pose import cross, faces, in_body, in_space, lean
from .records import block_types
from .rim import CENTRED, angle_to, overlap, press, press_askew

#: The models read these here.
__all__ = [
    "CHUNK", "COLLAPSED", "ENDED", "FAILED", "FREE", "LANES", "RUNNING", "advance", "block_types", "forces", "joint_state",
    "ledger",
]  # fmt: skip


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
            dt = o.dt[l]
            zx, zy, zz = v.kx[l], v.ky[l], v.kz[l]
            nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
            rx, ry, rz, cx, cy, cz = faces(u, v, l)
            hx, hy, hz, tx, ty, tz, sine, cosine = lean(nx, ny, nz, zx, zy, zz, v.ix[l], v.iy[l], v.iz[l])
            # steepest descent in the upper face
            dx, dy, dz = cosine * hx - sine * zx, cosine * hy - sine * zy, cosine * hz - sine * zz
            # velocity of the upper face's middle as seen from the lower drum, and the relative angular velocity
            ax, ay, az = cross(u.wx[l], u.wy[l], u.wz[l], rx, ry, rz)
            ht = v.ht[l]
            bx, by, bz = cross(v.wx[l], v.wy[l], v.wz[l], cx + ht * zx, cy + ht * zy, cz + ht * zz)
            vx = u.vx[l] + ax - v.vx[l] - bx
            vy = u.vy[l] + ay - v.vy[l] - by
            vz = u.vz[l] + az - v.vz[l] - bz
            ox, oy, oz = u.wx[l] - v.wx[l], u.wy[l] - v.wy[l], u.wz[l] - v.wz[l]
            # where the discs overlap
            above = cx * zx + cy * zy + cz * zz
            along = cx * hx + cy * hy + cz * hz
            across = cx * tx + cy * ty + cz * tz
            apart_ = math.sqrt(along * along + across * across)
            side = -1.0 if across < 0.0 else 1.0
            each = 1.0 / max(apart_, NOTHING)
            near = apart_ < CENTRED
            cos_g = 1.0 if near else along * each
            sin_g = 0.0 if near else side * across * each
            ru, rl = u.rb[l], v.rt[l]
            ra = ru * cosine
            psi_u, cos_u, sin_u, psi_l, cos_l, sin_l, area, rim = overlap(ra, rl, apart_)
            rho = area / max(rim, NOTHING)
            kn = e.kn[l] * rho
            ku, kl = kn * ru, kn * rl
            # depths along the two rims and their pressure  # Eq. (E4)
            gamma = angle_to(cos_g, sin_g)
            du, dl = -above, -(cx * nx + cy * ny + cz * nz)
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
            # the tangent plane of friction
            nx, ny, nz = fx + NOTHING * zx, fy + NOTHING * zy, fz + NOTHING * zz
            each = 1.0 / math.sqrt(nx * nx + ny * ny + nz * nz)
            nx, ny, nz = nx * each, ny * each, nz * each
            # slip and spin of the upper drum over the lower one at P
            ax, ay, az = cross(ox, oy, oz, px - cx, py - cy, pz - cz)
            ax, ay, az = vx + ax, vy + ay, vz + az
            slip = ax * nx + ay * ny + az * nz
            ax, ay, az = ax - slip * nx, ay - slip * ny, az - slip * nz
            spin = ox * nx + oy * ny + oz * nz
            # friction: stiffness of what is closed, common limit  # Eq. (E6)
            closed = ra * lu + rl * ll
            kf = e.ks[l] * rho * closed
            kt = 0.5 * kf * spread * o.pivot[l]
            sx, sy, sz = in_space(v, l, e.s[0, l], e.s[1, l], e.s[2, l])
            old = e.t[l]
            keep = kept(kf, e.kf[l])
            out = sx * nx + sy * ny + sz * nz
            qx = keep * (sx - out * nx) - kf * dt * ax
            qy = keep * (sy - out * ny) - kf * dt * ay
            qz = keep * (sz - out * nz) - kf * dt * az
            twist = kept(kt, e.kt[l]) * old - kt * dt * spin
            limit = e.mu[l] * press_ + e.co[l] * rho * closed
            arm = math.sqrt(spread) * (2.0 / 3.0)
            keep, less = returned(qx * qx + qy * qy + qz * qz, twist * twist, limit, limit * arm * o.pivot[l], kf, kt)
            qx, qy, qz, twist = qx * keep, qy * keep, qz * keep, twist * less
            o.shear[l] -= 0.5 * dt * ((sx + qx) * ax + (sy + qy) * ay + (sz + qz) * az + (old + twist) * spin)
            e.s[0, l], e.s[1, l], e.s[2, l] = in_body(v, l, qx, qy, qz)
            e.t[l] = twist
            e.kf[l] = kf
            e.kt[l] = kt
            if damped:
                # dashpots parallel to the springs; friction in sum stays within Coulomb's
                drag = o.beta[l] * kf
                gx, gy, gz = qx - drag * ax, qy - drag * ay, qz - drag * az
                turn = twist - o.beta[l] * kt * spin
                keep, less = returned(gx * gx + gy * gy + gz * gz, turn * turn, limit, limit * arm * o.pivot[l], kf, kt)
                gx, gy, gz, turn = gx * keep - qx, gy * keep - qy, gz * keep - qz, turn * less - twist
                ex, ey, ez = fx - ex + gx, fy - ey + gy, fz - ez + gz
                ax, ay, az = cross(px, py, pz, gx, gy, gz)
                ix, iy, iz = mx - ix + ax + turn * nx, my - iy + ay + turn * ny, mz - iz + az + turn * nz
                qx, qy, qz, twist = qx + gx, qy + gy, qz + gz, twist + turn
                ax, ay, az = cross(ox, oy, oz, cx, cy, cz)
                o.visc[l] -= (
                    0.5
                    * dt
                    * (
                        (ex + e.d[0, l]) * (vx - ax)
                        + (ey + e.d[1, l]) * (vy - ay)
                        + (ez + e.d[2, l]) * (vz - az)
                        + (ix + e.d[3, l]) * ox
                        + (iy + e.d[4, l]) * oy
                        + (iz + e.d[5, l]) * oz
                    )
                )
                e.d[0, l], e.d[1, l], e.d[2, l] = ex, ey, ez
                e.d[3, l], e.d[4, l], e.d[5, l] = ix, iy, iz
            # all of it on the two drums
            fx, fy, fz = fx + qx, fy + qy, fz + qz
            ax, ay, az = cross(px, py, pz, qx, qy, qz)
            mx, my, mz = mx + ax + twist * nx, my + ay + twist * ny, mz + az + twist * nz
            ax, ay, az = cross(cx - rx, cy - ry, cz - rz, fx, fy, fz)
            e.f[0, l], e.f[1, l], e.f[2, l] = fx, fy, fz
            e.up[0, l], e.up[1, l], e.up[2, l] = mx - ax, my - ay, mz - az
            ax, ay, az = cross(-ht * zx, -ht * zy, -ht * zz, fx, fy, fz)
            e.lo[0, l], e.lo[1, l], e.lo[2, l] = ax - mx, ay - my, az - mz


@kernel
def advance(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes by up to ``chunks`` × CHUNK steps; returns as soon as the run in some lane is over."""
    before = running_lanes(watch)
    for _ in range(chunks):
        if before == 0 or running_lanes(watch) < before:
            break
        fill_ground(ground, feed, watch)
        for k in range(CHUNK):
            forces(drum, joint, lane)
            move(drum, joint, lane, ground, k)
        close_chunk(drum, joint, lane, feed, watch)
