"""MuJoCo: Newton's method on its convex, regularised contact; elliptic friction cones, round primitives."""

import time

import mujoco
import numpy as np
from scenes import DENSITY, FRICTION, GRAVITY, Run, Scene

VERSION = mujoco.__version__

#: Time step [s], solref (time constant [s], damping ratio) and solimp of each variant.
VARIANTS = {
    "MuJoCo, default contact": (2e-3, "0.02 1", "0.9 0.95 0.001"),
    "MuJoCo, 1 ms": (1e-3, "0.004 1", "0.95 0.99 0.001"),
    "MuJoCo, stiff contact": (5e-4, "0.002 1", "0.95 0.99 0.001"),
    "MuJoCo, sharp contact": (1e-4, "0.0005 1", "0.95 0.99 0.001"),
    "MuJoCo, ringing contact": (1e-4, "0.001 0.1", "0.95 0.99 0.001"),
}

SETTINGS = (
    "elliptic cones, impratio 10, implicitfast, Newton to 1e-10, multiccd; no rolling or torsional friction; stiff: steps "
    "of 0.5 ms, solref 0.002 1, solimp 0.95 0.99 0.001; default: steps of 2 ms, solref 0.02 1, solimp 0.9 0.95 0.001; "
    "sharp and ringing, as experiments: steps of 0.1 ms, solref 0.0005 1 and 0.001 0.1, solimp as stiff"
)


def engine(variant: str):
    """A function that runs a scene."""
    step, solref, solimp = VARIANTS[variant]

    def run(scene: Scene) -> Run:
        model = mujoco.MjModel.from_xml_string(xml(scene, step, solref, solimp))
        data = mujoco.MjData(model)
        for k, (place, quaternion, velocity) in enumerate(scene.starts()):
            data.qpos[7 * k : 7 * k + 7] = [*place, *quaternion]
            turn = np.empty(9)
            mujoco.mju_quat2Mat(turn, quaternion)
            data.qvel[6 * k : 6 * k + 6] = [*velocity, *(turn.reshape(3, 3).T @ np.array(scene.omega))]
        mujoco.mj_forward(model, data)
        every, steps = max(1, round(scene.output / step)), round(scene.duration / step)
        ground = scene.acceleration(step * (np.arange(steps) + 0.5))
        places, turns, began = [data.xpos[1:].copy()], [data.xmat[1:].copy()], time.process_time()
        for k in range(steps):
            model.opt.gravity[:2] = -ground[:, k]
            mujoco.mj_step(model, data)
            if (k + 1) % every == 0:
                mujoco.mj_kinematics(model, data)
                places.append(data.xpos[1:].copy())
                turns.append(data.xmat[1:].copy())
                if scene.fallen(places[-1][-1, 2]):
                    break
        wall = time.process_time() - began
        n = len(scene.bodies)
        return Run(every * step * np.arange(len(places)), np.array(places), np.array(turns).reshape(-1, n, 3, 3), wall)

    return run


def xml(scene: Scene, step: float, solref: str, solimp: str) -> str:
    """The scene as MuJoCo's model: a plane for the ground, a free body for each block."""
    assets, bodies = [], []
    contact = f'friction="{FRICTION} 0 0" condim="3" solref="{solref}" solimp="{solimp}"'
    for k, body in enumerate(scene.bodies):
        if body.shape == "cylinder":
            geom = f'type="cylinder" size="{0.5 * body.size[0]} {0.5 * body.height}"'
        else:
            points = " ".join(repr(float(x)) for x in body.mesh()[0].ravel())
            assets.append(f'<mesh name="m{k}" vertex="{points}"/>')
            geom = f'type="mesh" mesh="m{k}"'
        bodies.append(f'<body><freejoint/><geom {geom} density="{DENSITY}" {contact}/></body>')
    return f"""<mujoco><option timestep="{step}" integrator="implicitfast" cone="elliptic" impratio="10" tolerance="1e-10"
    gravity="0 0 {-GRAVITY}"><flag multiccd="enable"/></option><asset>{"".join(assets)}</asset>
    <worldbody><geom type="plane" size="50 50 1" {contact}/>{"".join(bodies)}</worldbody></mujoco>"""
