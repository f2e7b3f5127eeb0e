"""The models here: ``dem2d`` for blocks that are shaken in the plane, ``dem3d`` for what is released or round."""

import time

import numpy as np
from scenes import DENSITY, FRICTION, Run, Scene

import stylobate as st

VERSION = st.__version__
STIFFNESS = 5e10
VARIANTS = {
    "stylobate": {},
    "stylobate, β = 10⁻⁴ s": {"stiffness_damping": 1e-4},
    "stylobate, β = 10⁻³ s": {"stiffness_damping": 1e-3},
    "stylobate, losses of stone": {"losses": "stone"},
    "stylobate, rigid beam": {},
}
SETTINGS = (
    "dem2d (plane) and dem3d (released or round, pivot friction 0), k_n 5e10 and k_s 2.5e10 N/m³, steps of 0.4 of the "
    "largest stable one; no damping, dashpots of 0.1 or 1 ms, or "
    "losses = stone; rigid-beam with true drums and joints as stiff"
)


def engine(variant: str):
    """A function that runs a scene."""
    beam, losses = variant.endswith("beam"), VARIANTS[variant]

    def run(scene: Scene) -> Run:
        column = st.Column.of_drums(
            [drum(body) for body in scene.bodies], st.Joint(STIFFNESS, 0.5 * STIFFNESS, friction_coefficient=FRICTION)
        )
        flat = scene.bodies[0].shape == "block" and not any(scene.omega)
        if beam:
            model = st.RigidBeam()
        else:
            model = st.DistinctElement2D(**losses) if flat else st.DistinctElement3D(pivot_friction=0.0, **losses)
        samples = 0.002 * np.arange(round(scene.duration / 0.002) + 1)
        x, y = scene.acceleration(samples)
        motion = st.Motion(0.002, x, None if flat or not y.any() else y)
        start = st.Start(scene.tilt, 0.0, scene.omega) if any(scene.omega) or scene.tilt else None
        began = time.process_time()
        seen = st.simulate(
            column, motion, model, output_interval=scene.output, start=start, until_end=start is not None
        )
        wall = time.process_time() - began
        return Run(
            seen.histories.time, seen.body_position, matrices(seen.body_orientation), wall, seen.measures.collapsed
        )

    return run


def drum(body) -> st.Drum:
    """A body as a drum."""
    if body.shape == "block":
        return st.Drum(body.height, body.size[0], body.size[1], DENSITY, depth=body.size[2])
    return st.Drum(body.height, body.size[0], body.size[0], DENSITY, section="circular")


def matrices(q: np.ndarray) -> np.ndarray:
    """Rotation matrices of unit quaternions (…, 4), real part first."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))
