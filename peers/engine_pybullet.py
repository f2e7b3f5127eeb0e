"""PyBullet: sequential impulses on Bullet's contact manifolds of up to four points."""

import math
import time
from importlib.metadata import version

import numpy as np
import pybullet as bullet
from scenes import FRICTION, GRAVITY, Run, Scene

VERSION = version("pybullet")
VARIANTS = {"PyBullet": 1e-3, "PyBullet, short steps": 2.5e-4}
SETTINGS = (
    "steps of 1 ms (short: 0.25 ms, as an experiment), 50 iterations, cone friction, restitution and damping 0, no rolling "
    "or spinning friction"
)


def engine(variant: str):
    """A function that runs a scene."""
    step = VARIANTS[variant]

    def run(scene: Scene) -> Run:
        client = bullet.connect(bullet.DIRECT)
        try:
            return simulated(scene, step)
        finally:
            bullet.disconnect(client)

    return run


def simulated(scene: Scene, step: float) -> Run:
    """One run in the world that is open."""
    bullet.setPhysicsEngineParameter(
        fixedTimeStep=step, numSolverIterations=50, enableConeFriction=1, solverResidualThreshold=0.0
    )
    rough = {
        "lateralFriction": math.sqrt(FRICTION),
        "restitution": 0.0,
        "rollingFriction": 0.0,
        "spinningFriction": 0.0,
    }
    ground = bullet.createMultiBody(0.0, bullet.createCollisionShape(bullet.GEOM_PLANE))
    bullet.changeDynamics(ground, -1, **rough)
    bodies = []
    for body, (place, quaternion, velocity) in zip(scene.bodies, scene.starts(), strict=True):
        if body.shape == "cylinder":
            shape = bullet.createCollisionShape(bullet.GEOM_CYLINDER, radius=0.5 * body.size[0], height=body.height)
        else:
            shape = bullet.createCollisionShape(bullet.GEOM_MESH, vertices=body.mesh()[0].tolist())
        mass, inertia = body.inertia  # Bullet would take the inertia of the box around it
        handle = bullet.createMultiBody(mass, shape, -1, place, np.roll(quaternion, -1))
        rough |= {"localInertiaDiagonal": inertia.tolist()}
        bullet.changeDynamics(handle, -1, linearDamping=0.0, angularDamping=0.0, activationState=4, **rough)
        bullet.resetBaseVelocity(handle, velocity.tolist(), scene.omega)
        bodies.append(handle)
    every, steps = max(1, round(scene.output / step)), round(scene.duration / step)
    pull = -scene.acceleration(step * (np.arange(steps) + 0.5))
    places, turns, began = [pose(bodies)], [], time.process_time()
    for k in range(steps):
        bullet.setGravity(pull[0, k], pull[1, k], -GRAVITY)
        bullet.stepSimulation()
        if (k + 1) % every == 0:
            places.append(pose(bodies))
            if scene.fallen(places[-1][-1][0][2]):
                break
    wall = time.process_time() - began
    position = np.array([[place for place, _ in row] for row in places])
    turns = np.array([[bullet.getMatrixFromQuaternion(q) for _, q in row] for row in places])
    return Run(every * step * np.arange(len(places)), position, turns.reshape(*position.shape[:2], 3, 3), wall)


def pose(bodies) -> list:
    """Place and quaternion of every body."""
    return [bullet.getBasePositionAndOrientation(body) for body in bodies]
