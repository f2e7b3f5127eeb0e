"""The same assembly by other engines, where ``make peers`` has installed them beside this checkout."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from pathlib import Path

from stylobate.column.shapes import CircularFrustum, RectangularFrustum
from stylobate.column.spatial.assembly import SpatialAssembly
from stylobate.column.spatial.stone import Stone
from stylobate.errors import StylobateError
from stylobate.motion import Motion

#: Beside this checkout: their scripts, and the Python that has them.
CHECKOUT = Path(__file__).resolve().parents[4]
SCRIPT, PYTHON = CHECKOUT / "peers" / "speed.py", CHECKOUT / ".venv-peers" / "bin" / "python"

#: Engines and the variant of each, in steps of 1 ms.
VARIANTS = {"mujoco": "MuJoCo, 1 ms", "pybullet": "PyBullet"}

MISSING = "MuJoCo and PyBullet: left out, they are not installed here (make peers installs them)"


def others(structure: SpatialAssembly, motion: Motion) -> dict[str, float | None]:
    """Processor time of each engine for a motion [s]; None without it. Round bodies have one diameter there."""
    if not PYTHON.exists() or not SCRIPT.exists():
        return dict.fromkeys(VARIANTS)
    scene = {
        "bodies": [body(stone) for stone in structure.stones],
        "dt": motion.dt,
        "x": motion.acceleration.tolist(),
        "y": [0.0] * motion.steps if motion.lateral is None else motion.lateral.tolist(),
        "duration": motion.duration,
    }
    alone = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": str(SCRIPT.parent)}
    seconds: dict[str, float | None] = {}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.json"
        file.write_text(json.dumps(scene), encoding="utf-8")
        for name, variant in VARIANTS.items():
            command = [str(PYTHON), str(SCRIPT), name, variant, str(file)]
            done = subprocess.run(command, capture_output=True, text=True, check=False, env=alone)
            if done.returncode:
                raise StylobateError(f"{name} ended with: {(done.stderr.strip().splitlines() or ['nothing said'])[-1]}")
            seconds[name] = float(json.loads(done.stdout.splitlines()[-1])["seconds"])
    return seconds


def body(stone: Stone) -> tuple[str, list[float], list[float]]:
    """Shape, size and centroid."""
    shape = stone.parts[0].shape
    if isinstance(shape, CircularFrustum):
        size = [0.5 * (shape.bottom + shape.top), shape.height]
        return "cylinder", size, list(stone.position)
    assert isinstance(shape, RectangularFrustum)
    (wide, deep), high = shape.bottom, shape.height
    return "block", [wide, wide, deep, high], list(stone.position)
