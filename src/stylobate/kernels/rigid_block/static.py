"""Equilibrium of a stack of rigid blocks: forces of the joints on the blocks, and their exact tangent.

Legend: q (x, z, θ) movement of each centroid and rotation, shape (n, 3). Joint frame: t along and ν across the face
below; (τ, ν) place of the upper face's joint centre in it. δ = −ν closure, ψ and χ sine and cosine of the relative
rotation. T shear on the part below along t; n, e, T and the limits as in interface_law.py.

Columns of ``geometry``, one row per joint: GEOMETRY. Columns of ``memory``: MEMORY, that is shear, τ, χ and slip at
the last converged step.
"""

from __future__ import annotations

import math

import numpy as np

from ..jit import kernel, kernel_of_arrays
from ..plane.interface_law import ELASTIC, OPEN, ROCKING, SLIDING, compression, compression_with_strength, shear

GEOMETRY = (
    "above_x above_z below_x below_z angle upper_left upper_right lower_left lower_right kn km ks friction cohesion "
    "crushing"
).split()
MEMORY = "shear tau chi slip".split()


@kernel_of_arrays
def assemble(q, geometry, memory, nonlinear, soft, force, stiffness, after, report):
    """Add all joints' forces on the blocks, and their tangent in band storage.

    Parameters
    ----------
    q : array
        (n, 3)
    geometry, memory : array
        (n, 15), (n, 4)
    nonlinear : bool
        Large rotations, forces in the displaced state.
    soft : float
        Share of the elastic stiffness that the tangent keeps in directions without stiffness (the forces stay exact).
    force : array
        Out: forces on the blocks, (n, 3).
    stiffness : array
        Out: −∂force/∂q, (3 n, 3 n).
    after : array
        Out: the memory if this state is accepted, (n, 4).
    report : array
        Out: n, e, T, state, opening at the wider edge, relative rotation, (n, 6).
    """
    joints = q.shape[0]
    force[:] = 0.0
    stiffness[:] = 0.0
    b_tau = np.zeros(6)
    b_nu = np.zeros(6)
    b_phi = np.zeros(6)
    d_n = np.zeros(6)
    d_m = np.zeros(6)
    d_e = np.zeros(6)
    d_t = np.zeros(6)
    hessian = np.zeros((6, 6))
    b_phi[2], b_phi[5] = -1.0, 1.0
    for i in range(joints):
        ux, uz = geometry[i, 0], geometry[i, 1]  # from the upper centroid to the joint
        lx, lz = geometry[i, 2], geometry[i, 3]  # from the lower centroid to the joint
        angle = geometry[i, 4]
        kn, km, ks = geometry[i, 9], geometry[i, 10], geometry[i, 11]
        below_x, below_z, below = 0.0, 0.0, 0.0
        if i > 0:
            below_x, below_z, below = q[i - 1, 0], q[i - 1, 1], q[i - 1, 2]
        # -- kinematics: place of the upper joint centre in the frame of the face below  # Eq. (B1)
        turn_u = q[i, 2] if nonlinear else 0.0
        turn_l = below if nonlinear else 0.0
        cu, su = math.cos(turn_u), math.sin(turn_u)
        rho_x, rho_z = cu * ux - su * uz, su * ux + cu * uz
        tx, tz = math.cos(angle + turn_l), math.sin(angle + turn_l)
        # w: from the lower centroid to the upper face's joint centre.
        w_x = q[i, 0] - below_x + (rho_x - ux) + lx
        w_z = q[i, 1] - below_z + (rho_z - uz) + lz
        if not nonlinear:
            w_x, w_z = lx, lz
        across_x, across_z = -rho_z, rho_x  # ρ turned by a right angle
        b_tau[0], b_tau[1], b_tau[2] = -tx, -tz, -tz * w_x + tx * w_z
        b_tau[3], b_tau[4], b_tau[5] = tx, tz, tx * across_x + tz * across_z
        b_nu[0], b_nu[1], b_nu[2] = tz, -tx, -tx * w_x - tz * w_z
        b_nu[3], b_nu[4], b_nu[5] = -tz, tx, -tz * across_x + tx * across_z
        phi = q[i, 2] - below
        if nonlinear:
            tau = tx * w_x + tz * w_z - (math.cos(angle) * lx + math.sin(angle) * lz)
            nu = -tz * w_x + tx * w_z - (-math.sin(angle) * lx + math.cos(angle) * lz)
            psi, chi = math.sin(phi), math.cos(phi)
        else:
            tau = b_tau[0] * below_x + b_tau[1] * below_z + b_tau[2] * below
            tau += b_tau[3] * q[i, 0] + b_tau[4] * q[i, 1] + b_tau[5] * q[i, 2]
            nu = b_nu[0] * below_x + b_nu[1] * below_z + b_nu[2] * below
            nu += b_nu[3] * q[i, 0] + b_nu[4] * q[i, 1] + b_nu[5] * q[i, 2]
            psi, chi = phi, 1.0
        # -- law
        slip = memory[i, 3]
        r_right = min(geometry[i, 6], geometry[i, 8] - slip)
        r_left = max(geometry[i, 5], geometry[i, 7] - slip)
        crushing = geometry[i, 14]
        narrowing = 0.5 * (r_right - r_left) * crushing
        if crushing > 0.0:
            n, e = compression_with_strength(-nu, psi, r_left, r_right, kn, km, crushing)
        else:
            n, e = compression(-nu, psi, r_left, r_right, kn, km)
        trial = memory[i, 0] + ks * (tau - memory[i, 1] + e * (chi - memory[i, 2]))
        friction = shear(trial, n, geometry[i, 12], geometry[i, 13])
        # A joint at its limit goes on sliding, as far as the tangent is concerned.
        slides = n <= 0.0 or abs(trial) >= (1.0 - 1.0e-9) * (geometry[i, 12] * n + geometry[i, 13])
        after[i, 0], after[i, 1], after[i, 2] = friction, tau, chi
        after[i, 3] = slip + (trial - friction) / ks
        # -- tangent of the law: dn, dm, de, dT by the six coordinates
        rocks = n > 0.0 and (e <= r_left + narrowing * n or e >= r_right - narrowing * n)
        # On the limit of the moment, dm = arm dn, and the limit bends by 2 narrowing.
        arm = e - narrowing * n if e >= r_right - narrowing * n else e + narrowing * n
        bend = 2.0 * narrowing * abs(psi + n * e / km)
        for a in range(6):
            d_delta, d_psi = -b_nu[a], chi * b_phi[a]
            if n <= 0.0:
                d_n[a], d_m[a] = soft * kn * d_delta, -soft * km * d_psi
            elif n * crushing >= 1.0:
                d_n[a], d_m[a] = soft * kn * d_delta, -soft * km * d_psi
            elif rocks:
                d_n[a] = (d_delta - arm * d_psi) / (1.0 / kn + arm * arm / km + bend)
                d_m[a] = arm * d_n[a] - soft * km * d_psi
            else:
                d_n[a], d_m[a] = kn * d_delta, -km * d_psi
            d_e[a] = 0.0
            if n > 0.0:
                d_e[a] = (arm - e) * d_n[a] / n if rocks else (d_m[a] - e * d_n[a]) / n
            d_t[a] = ks * b_tau[a]
            if nonlinear:
                d_t[a] += ks * ((chi - memory[i, 2]) * d_e[a] - e * psi * b_phi[a])
            if slides:
                d_t[a] = soft * d_t[a] + (geometry[i, 12] * d_n[a] if friction > 0.0 else -geometry[i, 12] * d_n[a])
        # -- second derivatives of  n ν + m ψ − T (τ + e χ)  with n, e, T held  # Eq. (B3)
        hessian[:] = 0.0
        if nonlinear:
            nx, nz = -tz, tx
            hessian[0, 2], hessian[1, 2] = n * tx + friction * nx, n * tz + friction * nz
            hessian[3, 2], hessian[4, 2] = -hessian[0, 2], -hessian[1, 2]
            turn = n * e * psi - friction * e * chi
            hessian[2, 2] = -n * (nx * w_x + nz * w_z) + friction * (tx * w_x + tz * w_z) - turn
            hessian[5, 5] = -n * (nx * rho_x + nz * rho_z) + friction * (tx * rho_x + tz * rho_z) - turn
            hessian[2, 5] = turn - n * (tx * across_x + tz * across_z) - friction * (nx * across_x + nz * across_z)
            for b in (0, 1, 3, 4):
                hessian[2, b] = hessian[b, 2]
            hessian[5, 2] = hessian[2, 5]
        slope = -friction * e * psi if nonlinear else 0.0
        for a in range(6):
            block_a = i - 1 if a < 3 else i
            if block_a < 0:
                continue
            # Force = ∂/∂q of  −W:  −(n ∂δ − m ∂ψ) − T ∂(τ + e χ)  # Eq. (B2)
            force[block_a, a % 3] += n * b_nu[a] + n * e * chi * b_phi[a] - friction * b_tau[a] - slope * b_phi[a]
            row = 3 * block_a + a % 3
            for b in range(6):
                block_b = i - 1 if b < 3 else i
                if block_b < 0:
                    continue
                change = -d_n[b] * b_nu[a] - d_m[b] * chi * b_phi[a] + d_t[b] * b_tau[a] - hessian[a, b]
                if nonlinear:
                    change -= (d_t[b] * e + friction * d_e[b]) * psi * b_phi[a]
                stiffness[row, 3 * block_b + b % 3] += change
        # -- what the joint does
        state = ELASTIC
        if n <= 0.0:
            state = OPEN
        elif rocks:
            state = ROCKING
        elif slides:
            state = SLIDING
        report[i, 0], report[i, 1], report[i, 2], report[i, 3] = n, e, -friction, state
        report[i, 4] = max(0.0, max(nu + r_left * psi, nu + r_right * psi))
        report[i, 5] = phi


@kernel
def carried(q, change, eccentricity, geometry, out):
    """Apply a finite change of the coordinates the way joints move, about their contact points.

    The change is turned into turns of the blocks and movements of each joint's contact point along and across the face
    below; the blocks are then placed anew on each other from the base upward. In a large rotation x, z and θ cannot be
    added: the joints would be torn open, or pressed with forces that have nothing to do with the path.

    Parameters
    ----------
    q, change : array
        (n, 3)
    eccentricity : array
        Place of the contact point on each upper face [m], (n,).
    geometry : array
        (n, 15)
    out : array
        Out: the coordinates, (n, 3).
    """
    for i in range(q.shape[0]):
        ux, uz, lx, lz, angle = geometry[i, 0], geometry[i, 1], geometry[i, 2], geometry[i, 3], geometry[i, 4]
        e = eccentricity[i]
        below_x, below_z, below, new_x, new_z, new = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        slide_x, slide_z, turned = 0.0, 0.0, 0.0
        if i > 0:
            below_x, below_z, below = q[i - 1, 0], q[i - 1, 1], q[i - 1, 2]
            new_x, new_z, new = out[i - 1, 0], out[i - 1, 1], out[i - 1, 2]
            slide_x, slide_z, turned = change[i - 1, 0], change[i - 1, 1], change[i - 1, 2]
        out[i, 2] = q[i, 2] + change[i, 2]
        # Contact point from the upper and from the lower centroid, and its movement relative to the lower block.
        cu, su = math.cos(q[i, 2]), math.sin(q[i, 2])
        px, pz = ux + e * math.cos(angle), uz + e * math.sin(angle)
        arm_x, arm_z = cu * px - su * pz, su * px + cu * pz
        w_x, w_z = q[i, 0] - below_x + arm_x - ux + lx, q[i, 1] - below_z + arm_z - uz + lz
        rate_x = change[i, 0] - slide_x - arm_z * change[i, 2] + w_z * turned
        rate_z = change[i, 1] - slide_z + arm_x * change[i, 2] - w_x * turned
        # The same place in the frame of the lower block, moved, and put back into its new frame.
        w_x, w_z = w_x + rate_x, w_z + rate_z
        cl, sl = math.cos(new - below), math.sin(new - below)
        w_x, w_z = cl * w_x - sl * w_z, sl * w_x + cl * w_z
        cu, su = math.cos(out[i, 2]), math.sin(out[i, 2])
        out[i, 0] = new_x + w_x - (cu * px - su * pz) + ux - lx
        out[i, 1] = new_z + w_z - (su * px + cu * pz) + uz - lz
