"""Rigid beam by SciPy's adaptive Runge–Kutta method of order 8, with full matrices: what the fixed step is held against."""

from __future__ import annotations

import math

import numpy as np

from stylobate.column import Column
from stylobate.kernels.rigid_beam import moment_law
from stylobate.kernels.run_codes import SUPPORT_MARGIN
from stylobate.models.base import RunOptions
from stylobate.models.engine import engine_for
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rigid_beam.state import PackedBeam, energy_at_loss, faces, histories_of, measures_of
from stylobate.models.rocking.block import lightest_weight, off_the_ground
from stylobate.models.shared import ledger
from stylobate.motion import Motion
from stylobate.response import Response
from stylobate.simulate import simulate

from .adaptive_block import Ground

#: Of the solver; the absolute one in radians, and in metres for slips.
RELATIVE_TOLERANCE = 1e-7
ABSOLUTE_TOLERANCE = 1e-10


class BeamRates:
    """Right-hand side of the rigid beam: rotations, slips, their velocities, then input, viscous and joint work.

    The plastic slips are held while a step is taken, and brought up to date behind it.
    """

    def __init__(self, beam: PackedBeam, ground: Ground) -> None:
        self.beam, self.ground = beam, ground
        column = beam.column
        self.n = n = column.n
        self.sliding = beam.sliding
        self.inverse = np.linalg.inv(beam.matrices.sliding_mass if self.sliding else beam.matrices.mass)
        self.difference = np.eye(n) - np.eye(n, k=-1)
        self.below = np.eye(n, k=-1)
        self.weight = column.gravity * beam.matrices.load if beam.geometric else np.zeros(n)
        self.carried = column.joint_weights if beam.geometric else np.zeros(n)
        above = np.cumsum(column.masses[::-1])[::-1]
        self.load = np.concatenate((beam.matrices.load, above)) if self.sliding else beam.matrices.load
        self.friction = np.array([joint.tan_phi for joint in column.joints]) * column.joint_weights
        self.cohesion = np.array([joint.cohesion for joint in column.joints]) * column.joint_areas
        self.lower, self.upper = faces(column)
        self.plastic = np.zeros(n)
        self.gravity = column.gravity
        self.beta = beam.stiffness_damping
        self.absolute = not beam.relative

    def split(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """θ, θ̇, slips and their velocities."""
        n = self.n
        if self.sliding:
            return y[:n], y[2 * n : 3 * n], y[n : 2 * n], y[3 * n : 4 * n]
        zero = np.zeros(n)
        return y[:n], y[n : 2 * n], zero, zero

    def moments(self, theta: np.ndarray, gamma: float) -> np.ndarray:
        """Joint moments [N m]."""
        out = np.empty(self.n)
        phi = theta if self.absolute else self.difference @ theta
        moment_law.moments(np.ascontiguousarray(phi), gamma, self.beam.joints, self.beam.bed, out)
        return out

    def shear(self, slip: np.ndarray, gamma: float) -> tuple[np.ndarray, np.ndarray]:
        """Elastic trial and shear of every joint [N].  # Eq. (R6)"""
        limit = max(gamma, 0.0) * self.friction + self.cohesion
        trial = self.beam.shear * (slip - self.plastic)
        return trial, np.clip(trial, -limit, limit)

    def __call__(self, t: float, y: np.ndarray) -> np.ndarray:
        """Rates of the state."""
        theta, omega, slip, rate = self.split(y)
        a, gamma = self.ground(t)
        a *= self.gravity
        spin = self.difference @ omega
        moment = self.moments(theta, gamma)
        still = moment if gamma == 1.0 else self.moments(theta, 1.0)
        joint = still @ spin
        vertical = (gamma - 1.0) * (self.weight * theta) @ omega - (moment - still) @ spin
        viscous = 0.0
        if self.beta > 0.0:
            phi = theta if self.absolute else self.difference @ theta
            speed = omega if self.absolute else spin
            shut = moment_law.closed(phi, gamma, self.beam.joints, self.beam.bed)
            dash = self.beta * self.beam.joints[0] * speed * shut
            moment = moment + dash
            viscous = dash @ spin
        torque = gamma * self.weight * theta - self.difference.T @ moment
        if not self.sliding:
            force = torque - a * self.load
            input_ = -a * self.load @ omega + vertical
            return np.concatenate((omega, self.inverse @ force, np.array([input_, viscous, joint])))
        _, shear = self.shear(slip, gamma)
        if self.beta > 0.0:
            drag = self.shear(slip + self.beta * rate, gamma)[1] - shear
            shear = shear + drag
            viscous += drag @ rate
        lower = self.below @ theta
        torque = torque + self.below.T @ (gamma * self.carried * slip)
        force = np.concatenate((torque, gamma * self.carried * lower - shear)) - a * self.load
        vertical += (gamma - 1.0) * self.carried @ (lower * rate + slip * (self.below @ omega))
        input_ = -a * self.load @ np.concatenate((omega, rate)) + vertical
        return np.concatenate((omega, rate, self.inverse @ force, np.array([input_, viscous, joint])))

    def lost(self, t: float, y: np.ndarray, remaining: float, lightest: float) -> tuple[int, int]:
        """Joint (from 1) above which a part is lost and to which side; 0 if none.  # Eq. (R8)"""
        beam, column = self.beam, self.beam.column
        theta, omega, slip, rate = self.split(y)
        phi, spin = (theta, omega) if self.absolute else (self.difference @ theta, self.difference @ omega)
        for i in range(self.n):
            reserve = remaining + (SUPPORT_MARGIN if i else 0.0)
            lever, m = beam.matrices.lever[i:, i:], column.masses[i:]
            slid = m @ np.append(0.0, np.cumsum(slip[i + 1 :]))
            right, left = min(self.lower[i], self.upper[i] - slip[i]), min(self.lower[i], self.upper[i] + slip[i])
            if beam.geometric:
                first = m @ (lever @ theta[i:]) + slid
                away = 1.0 if first >= 0.5 * m.sum() * (right - left) else -1.0
                edge = right if away > 0.0 else left
                driving = column.gravity * (away * first - m.sum() * edge)
                speed = m @ (lever @ omega[i:] + np.append(0.0, np.cumsum(rate[i + 1 :])))
            else:
                away = math.copysign(1.0, phi[i])
                edge = right if away > 0.0 else left
                driving = beam.ultimate[i] * (abs(phi[i]) / beam.alpha[i] - 1.0)
                driving += column.gravity * (away * slid - m.sum() * (edge - 0.5 * column.joint_widths[i]))
                speed = spin[i]
            # where the end of the contact is the lower drum's, it slides as well
            outward = away * (speed + (m.sum() * rate[i] if edge < self.lower[i] else 0.0)) > 0.0
            beaten = lightest * driving > reserve * beam.matrices.overturning[i]
            if right + left <= 0.0:
                return i + 1, int(math.copysign(1.0, slip[i]))
            if (outward and beaten) or abs(theta[i]) > 0.5 * math.pi:
                return i + 1, int(away)
        return 0, 0


def run_as(solver: str, column: Column, motion: Motion, model: RigidBeam, **options) -> Response:
    """One run of the model by its own fixed step ("fixed"), or by this solver ("adaptive")."""
    if solver == "fixed":
        return simulate(column, motion, model, **options)
    engine_for(model, column).check(motion)
    return run_adaptive(column, motion, model, **options)


def run_adaptive(column: Column, motion: Motion, model: RigidBeam, **chosen) -> Response:
    """One run with histories; keywords as in ``simulate``."""
    from scipy.integrate import DOP853

    options = RunOptions(**chosen)
    beam = model.pack(column)
    rates = BeamRates(beam, Ground(motion, column.gravity))
    n, end = column.n, motion.duration + options.tail
    y = np.zeros((4 if model.sliding else 2) * n + 3)
    y[:n] = -model.initial_rotation
    lightest = lightest_weight(motion, column.gravity)
    start = beam.energies(*rates.split(y), rates.plastic)
    # a plastic slip is held during a step: keep the steps short enough to follow the joints' vibration
    largest = beam.step_for(motion) * 2.0 if model.sliding else min(0.02 / beam.column.frequency_parameter, end)
    solver = DOP853(rates, 0.0, y, end, rtol=RELATIVE_TOLERANCE, atol=ABSOLUTE_TOLERANCE, max_step=largest)
    times = np.append(np.arange(max(1, round(end / options.output_interval))) * options.output_interval, end)
    friction, written, steps, smallest, failure, worst = 0.0, 1, 0, math.inf, "", 0.0
    facts = {"lost": 0, "side": 0, "time": math.nan}
    t, inside = 0.0, True  # when the motion ends
    top = turn = opening = 0.0

    def row(t: float, state: np.ndarray) -> tuple:
        theta, omega, slip, rate = rates.split(state)
        change = beam.energies(theta, omega, slip, rate, rates.plastic) - start
        if rates.absolute:
            change[2] = state[-1]
        return t, theta.copy(), slip.copy(), np.array([state[-3], *change, friction, state[-2]])

    rows = [row(0.0, y)]
    while solver.status == "running":
        message = solver.step()
        if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
            failure = f"the solver could not go on at t = {solver.t:.4f} s: {message or 'the state is not finite'}"
            break
        steps += 1
        before, t, y = t, float(solver.t), solver.y
        smallest = min(smallest, solver.step_size or math.inf)
        if written < len(times) and times[written] <= t:
            upto = int(np.searchsorted(times, t, side="right"))
            dense = solver.dense_output()
            rows.extend(row(float(at), dense(at)) for at in times[written:upto])
            written = upto
        theta, _, slip, _ = rates.split(y)
        if model.sliding:
            trial, shear = rates.shear(slip, rates.ground(t)[1])
            more = (trial - shear) / beam.shear
            rates.plastic = rates.plastic + more
            friction += float(shear @ more)
        top = max(top, abs(float((theta + model.initial_rotation) @ beam.column.heights + slip.sum())))
        turn = max(turn, float(np.abs(theta).max()))
        opening = max(opening, float(beam.lift(beam.joint_rotations(theta)).max()))
        worst = max(worst, abs(float(y[-3])))
        inside = beam.inside(theta, slip) if before < motion.duration else inside
        if not facts["lost"]:
            joint, side = rates.lost(t, y, motion.pga if t < motion.duration else 0.0, lightest)
            if joint:
                facts = {"lost": joint, "side": side, "time": t}
        if facts["lost"] and (not options.until_end or turn > 0.5 * math.pi):
            break
    t = float(solver.t)
    if t > rows[-1][0] and not failure:
        rows.append(row(t, solver.y))
    time, angles, slips, energy = (np.array(part) for part in zip(*rows, strict=True))
    theta, slip = angles[-1], slips[-1]
    measures = measures_of(
        beam,
        facts | {
            "theta": theta, "omega": rates.split(solver.y)[1], "slip": slip,
            "energy": float(energy[-1, 1:4].sum() + start.sum()), "start": float(start.sum()), "work": worst,
            "given": energy_at_loss(energy[-1], worst, facts["time"] > motion.duration and inside),
            "unaccounted": ledger.unaccounted(energy[-1]), "released": ledger.released(energy[-1]),
            "end": t, "failure": off_the_ground(motion, column.gravity, facts["time"]) or failure,
            "top": top, "turn": turn, "opening": opening,
            "residual": float((theta + model.initial_rotation) @ beam.column.heights + slip.sum()),
            "step": smallest, "steps": steps,
        },
    )  # fmt: skip
    return Response(column, histories_of(beam, motion, time, angles, slips, energy), measures, model.name, {})
