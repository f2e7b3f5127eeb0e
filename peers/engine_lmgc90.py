"""LMGC90 (the wheel ``compas_lmgc90``): non-smooth contact dynamics of polyhedra, implicit, without restitution."""

import math
import time
from importlib.metadata import version

import numpy as np
from compas_lmgc90 import _lmgc90
from scenes import DENSITY, FRICTION, Body, Run, Scene

VERSION = version("compas_lmgc90")
VARIANTS = {"LMGC90": 1e-3}
SETTINGS = (
    "polyhedra in space (the wheel has no plane bodies and no round ones), law IQS_CLB, theta 0.5, steps of 1 ms "
    "(2 ms for drums), detection and solver as the wheel sets them, alert distance 5 mm"
)
ALERT = 5e-3


def engine(variant: str):
    """A function that runs a scene."""

    def run(scene: Scene) -> Run:
        step = VARIANTS[variant] * (2.0 if len(scene.bodies) > 1 else 1.0)
        solver = _lmgc90.LMGC90Solver()
        solver.initialize(step, 0.5, False)
        try:
            return simulated(solver, scene, step)
        finally:
            solver.finalize()

    return run


def simulated(solver, scene: Scene, step: float) -> Run:
    """One run: a base that is driven by velocity, and the blocks on it."""
    solver.add_one_tact_behav("iqsc0", "IQS_CLB", [FRICTION])
    solver.set_materials([DENSITY])
    solver.set_see_tables(ALERT)
    solver.set_nb_bodies(1 + len(scene.bodies))
    steps = round(scene.duration / step)
    times = step * np.arange(steps + 2)
    middle = scene.acceleration(times[:-1] + 0.5 * step) * step
    speed = np.concatenate((np.zeros((2, 1)), np.cumsum(middle, axis=1)), axis=1)
    add(solver, Body("block", (8.0, 8.0, 8.0, 0.5)), np.array([0.0, 0.0, -0.25]), np.eye(3), 6, 0)
    for k in range(6):
        if k < 2:
            solver.set_drvdof(1, k + 1, np.concatenate((times, speed[k])).tolist(), True, True)
        else:
            solver.set_drvdof(1, k + 1, [0.0] * 6, True, False)
    kicked = any(scene.omega)
    for body, (place, q, velocity) in zip(scene.bodies, scene.starts(), strict=True):
        turn = turned(q)
        number = add(solver, body, place, turn, 0, 6 if kicked else 0)
        if kicked:  # no velocity can be set: forces and moments of one step give it
            kick(solver, number, body, turn, velocity, np.array(scene.omega), step)
    solver.close_before_computing()
    first = solver.get_initial_state()
    frames = [np.array(frame).reshape(3, 3) for frame in first.init_body_frames]
    at_start = [turned(q) for _, q, _ in scene.starts()]
    every = max(1, round(scene.output / step))
    states, began = [(first.init_bodies, first.init_body_frames)], time.process_time()
    for k in range(steps):
        state = solver.compute_one_step()
        if (k + 1) % every == 0:
            states.append((state.bodies, state.body_frames))
            if scene.fallen(state.bodies[-1][2]):
                break
    wall = time.process_time() - began
    position = np.array([row for row, _ in states])
    rotation = np.array(
        [
            [np.array(now).reshape(3, 3).T @ then @ start for now, then, start in zip(row[1:], frames[1:], at_start)]
            for _, row in states
        ]
    )
    base = position[:, :1] * (1.0, 1.0, 0.0)
    return Run(every * step * np.arange(len(states)), position[:, 1:] - base, rotation, wall)


def turned(q) -> np.ndarray:
    """Matrix of a rotation about y."""
    angle = 2.0 * math.atan2(q[2], q[0])
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def add(solver, body: Body, place, turn, velocities: int, forces: int) -> int:
    """Add a block; returns its number, counted from 1."""
    points, faces = body.mesh()
    connectivity = [corner + 1 for face in faces for corner in face]
    solver.set_one_polyr("s0001", place.tolist(), connectivity, (points @ turn.T).ravel().tolist(), velocities, forces)
    add.count = 1 if velocities else add.count + 1
    return add.count


def kick(solver, number: int, body: Body, turn, velocity, omega, step: float) -> None:
    """Impulses within the first step that leave a body with a velocity and an angular velocity."""
    mass, inertia = body.inertia
    moment = turn @ (inertia * (turn.T @ omega))
    for k, impulse in enumerate((*(mass * velocity), *moment)):
        force = float(impulse) / step
        # a step takes the mean of the forces at its ends
        solver.set_drvdof(number, k + 1, [0.0, step, 1e6, 2.0 * force, 0.0, 0.0], False, True)
