"""Column files: every one is a sound column that is what the file says, or is refused in one sentence."""

from __future__ import annotations

import json
import math
import random
import tomllib
from pathlib import Path

from stylobate.column.column import Column
from stylobate.column.files import column_from_dict, read_column, write_column
from stylobate.errors import InputError
from stylobate.motion import harmonic
from stylobate.simulate import simulate

from . import odd
from .target import Fault, Target, sentence

#: Closed-form properties that must be positive numbers.
POSITIVE = (
    "height",
    "mass",
    "centroid_height",
    "base_width",
    "radius",
    "slenderness",
    "corner_inertia",
    "frequency_parameter",
)


def file(rng: random.Random) -> str:
    """Text of a column file, with odd values here and there."""
    strange = rng.choice((0.0, 0.02, 0.1))

    def value(low: float, high: float) -> str:
        return odd.number(rng, low, high, strange)

    lines = []
    if rng.random() < 0.5:
        lines.append("name = " + odd.choice(rng, ['"column"'], 0.5, odd.NAMES))
    if rng.random() < 0.5:
        lines.append("section = " + odd.choice(rng, ['"circular"', '"rectangular"'], strange, odd.NAMES))
    if rng.random() < 0.2:
        lines.append(f"depth = {value(0.5, 2.0)}")
    if rng.random() < 0.9:
        lines.append(f"density = {value(1000.0, 3000.0)}")
    if rng.random() < 0.1:
        lines.append(f"gravity = {value(1.0, 20.0)}")
    if rng.random() < strange:
        lines.append(f"{rng.choice(['widht', 'drums', 'a.b', 'x'])} = {value(0.0, 1.0)}")
    if rng.random() < 0.5:
        lines += ["[tapered]", f"height = {value(0.5, 15.0)}", f"bottom_width = {value(0.3, 2.0)}"]
        lines += [f"top_width = {value(0.3, 2.0)}"]
        lines.append(f"drums = {odd.number(rng, 1, 2, strange) if rng.random() < strange else rng.randint(1, 14)}")
    else:
        for _ in range(rng.randint(0 if strange else 1, 6)):
            lines += ["[[drum]]", f"height = {value(0.2, 2.0)}", f"bottom_width = {value(0.3, 2.0)}"]
            lines.append(f"top_width = {value(0.3, 2.0)}")
            if rng.random() < 0.1:
                lines.append(f"density = {value(1000.0, 3000.0)}")
    if rng.random() > 0.3 * strange:
        lines += ["[joint]", f"normal_stiffness = {value(1e7, 1e13)}", f"shear_stiffness = {value(1e7, 1e13)}"]
        if rng.random() < 0.8:
            lines.append(f"friction_angle = {value(5.0, 60.0)}")
        elif rng.random() < 0.5:
            lines.append(f"friction_coefficient = {value(0.1, 2.0)}")
        if rng.random() < 0.1:
            lines.append(f"cohesion = {value(0.0, 1e6)}")
    if rng.random() < 0.1:
        lines += ["[[joint_override]]", f"index = {odd.choice(rng, ['1', '2'], strange, odd.NUMBERS)}"]
        lines.append(f"friction_angle = {value(5.0, 60.0)}")
    if rng.random() < 0.1:
        lines += ["[as_found]", f"base_tilt = {value(-2.0, 2.0)}"]
        lines += ["[[as_found.drum]]", f"index = {odd.choice(rng, ['1', '2'], strange, odd.NUMBERS)}"]
        lines += [f"{key} = {value(0.0, 0.1)}" for key in ("offset", "tilt", "chip_left") if rng.random() < 0.5]
    return "\n".join(lines) + "\n"


def attempt(rng: random.Random, folder: Path) -> str:
    """One file."""
    path = odd.write(rng, folder, file(rng))
    try:
        column = read_column(path)
    except InputError as error:
        sentence(error)
        return "refused"
    is_what_the_file_says(column, tomllib.loads(path.read_text(encoding="utf-8")))
    for name in POSITIVE:
        if not 0.0 < getattr(column, name) < math.inf:
            raise Fault(f"{name} is {getattr(column, name)!r} of {column.to_dict()!r:.2000}")
    if column_from_dict(json.loads(json.dumps(column.to_dict()))) != column:
        raise Fault("the column changed on its way through JSON")
    if read_column(write_column(column, folder / "again.toml")) != column:
        raise Fault("the column changed on its way through its own file")
    if rng.random() < 0.05:
        return computed(rng, column)
    return "read"


def is_what_the_file_says(column: Column, content: dict) -> None:
    """Raise a fault where heights, widths, densities or stiffnesses are others than the file's."""
    if "tapered" in content:
        table = content["tapered"]
        wanted = (table["height"], table["bottom_width"], table["top_width"], table["drums"])
        got = (column.height, column.drums[0].bottom_width, column.drums[-1].top_width, column.n)
    else:
        keys = ("height", "bottom_width", "top_width")
        wanted = [drum[key] for drum in content["drum"] for key in keys]
        got = [getattr(drum, key) for drum in column.drums for key in keys]
    wanted = (*wanted, content["joint"]["shear_stiffness"] if not content.get("joint_override") else 1.0)
    got = (*got, column.joints[0].shear_stiffness if not content.get("joint_override") else 1.0)
    if len(got) != len(wanted) or any(abs(a - b) > 1e-9 * abs(b) for a, b in zip(got, wanted)):
        raise Fault(f"the file says {wanted!r:.500}, the column is {got!r:.500}")


def computed(rng: random.Random, column: Column) -> str:
    """A short run of the column ends with a verdict, or is refused in one sentence."""
    from stylobate.models.registry import make_model

    model = make_model(rng.choice(("dem2d", "housner", "rigid-beam", "rigid-block")), {})
    motion = harmonic(rng.uniform(0.5, 4.0), rng.uniform(0.5, 8.0), rng.uniform(0.05, 0.5))
    try:
        response = simulate(column, motion, model)
    except InputError as error:
        sentence(error)
        return "refused to compute"
    measures = response.measures
    if not math.isfinite(measures.peak_top_displacement) and measures.outcome.label != "failed":
        raise Fault(f"{measures.outcome} with a peak of {measures.peak_top_displacement}")
    return f"computed: {measures.outcome.label}"


TARGET = Target("columns", 10_000, 150, attempt, limit=60.0)
