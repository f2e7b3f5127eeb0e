"""Files of assemblies in space: every one is bodies with masses that statics take, or is refused in one sentence."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from pathlib import Path

import numpy as np

from stylobate.column.assembly_files import FROM_DICT, load_structure
from stylobate.errors import InputError
from stylobate.statics.limit import limit_directions

from . import odd
from .target import Fault, Target, sentence


def file(rng: random.Random) -> str:
    """Text of a file of stacked and scattered bodies, with odd values here and there."""
    strange = rng.choice((0.0, 0.02, 0.1))

    def value(low: float, high: float) -> str:
        return odd.number(rng, low, high, strange)

    lines = [f"density = {value(1000.0, 3000.0)}"]
    if rng.random() < 0.2:
        lines.append("settle = " + odd.choice(rng, ["true", "false"], strange, odd.OTHERS))
    if rng.random() < 0.1:
        lines.append("gravity = " + value(0.0, 20.0))
    lines += ["[joint]", f"normal_stiffness = {value(1e7, 1e12)}", f"shear_stiffness = {value(1e7, 1e12)}"]
    lines += [f"friction_angle = {value(3.0, 60.0)}"]
    level = 0.0
    for number in range(rng.randint(0 if strange else 1, 4)):
        lines += ["[[block]]", "name = " + odd.choice(rng, [f'"b{number}"'], strange, odd.NAMES)]
        height = rng.choice((0.5, 1.0))
        stacked = rng.random() < 0.7
        place = (value(-0.1, 0.1), value(-0.1, 0.1), f"{level}") if stacked else tuple(value(-3.0, 3.0) for _ in "xyz")
        level += height if stacked else 0.0
        shape = rng.randrange(4)
        if shape == 0:
            lines.append(f"box = [{value(0.2, 1.0)}, {value(0.2, 1.0)}, {height}]")
        elif shape == 1:
            sizes = f"bottom_diameter = {value(0.3, 1.0)}, top_diameter = {value(0.3, 1.0)}, height = {height}"
            lines.append(f"drum = {{ {sizes} }}")
        elif shape == 2:
            points = [f"[{', '.join(value(-1.0, 1.0) for _ in 'xyz')}]" for _ in range(rng.randint(3, 9))]
            lines.append(f"vertices = [{', '.join(points)}]")
        else:
            lines.append(
                f"parts = [{{ box = [0.5, 0.5, {height / 2}] }}, {{ box = [{value(0.2, 1.0)}, 0.4, {height / 2}] }}]"
            )
        lines.append(f"at = [{', '.join(place)}]")
        if rng.random() < 0.3:
            lines.append(f"turn = {value(-180.0, 180.0)}")
        if rng.random() < 0.1:
            lines += [f"tilt = {value(-90.0, 90.0)}", f"towards = {value(0.0, 360.0)}"]
        if rng.random() < 0.05:
            lines.append(f"orientation = [{', '.join(value(-1.0, 1.0) for _ in range(4))}]")
        if rng.random() < 0.1:
            lines.append("fixed = " + odd.choice(rng, ["true", "false"], strange, odd.OTHERS))
    for _ in range(rng.choice((0, 0, 1, 2))):
        lines += link(rng, value, strange)
    return "\n".join(lines) + "\n"


def link(rng: random.Random, value: Callable[[float, float], str], strange: float) -> list[str]:
    """Lines of a link between two of the bodies, or the ground."""
    kind = rng.choice(("dowel", "bar", "layer", "pad", "tie", "core", "clamp"))
    ends = [
        odd.choice(rng, [f'"{name}"'], strange, odd.NAMES)
        for name in rng.choice((("b0", "b1"), ("ground", "b0"), ("b1", "b2")))
    ]
    lines = ["[[link]]", f'kind = "{kind}"', f"between = [{', '.join(ends)}]"]
    if kind != "pad":
        lines.append(
            f"shear_stiffness = {value(1e5, 1e8)}"
            if kind in ("dowel", "layer")
            else f"axial_stiffness = {value(1e5, 1e8)}"
        )
    else:
        lines += ['material = "lead"', f"thickness = {value(1e-3, 1e-2)}"]
    if kind in ("bar", "clamp"):
        lines.append(f"shear_stiffness = {value(0.0, 1e8)}")
    if kind in ("tie", "core", "clamp"):
        near = [", ".join(value(-0.4, 0.4) for _ in "xyz") for _ in range(2)]
        lines += [f"at = [{near[0]}]", f"to = [{near[1]}]"]
    if kind in ("tie", "core", "bar", "clamp"):
        lines.append(f"axial_capacity = {value(10.0, 1e5)}")
    if kind in ("dowel", "bar", "clamp") and rng.random() < 0.7:
        lines.append(f"shear_capacity = {value(10.0, 1e5)}")
    return lines


def attempt(rng: random.Random, folder: Path) -> str:
    """One file."""
    path = odd.write(rng, folder, file(rng))
    try:
        structure = load_structure(path)
    except InputError as error:
        sentence(error)
        return "refused"
    if structure.space_joints is None:
        return "not in space"
    for body in structure.bodies:
        if not body.fixed and not (body.mass > 0.0 and np.isfinite(body.mass) and body.inertia > 0.0):
            raise Fault(f"mass {body.mass} and inertia {body.inertia} of {body.name!r}")
    if FROM_DICT[structure.kind](json.loads(json.dumps(structure.to_dict()))).digest != structure.digest:
        raise Fault("the assembly changed on its way through JSON")
    try:
        limit = limit_directions(structure, [rng.uniform(0.0, 360.0)]).limits[0]
    except InputError as error:
        sentence(error)
        return "read, and refused by statics"
    if not limit.multiplier > -1e-6:
        raise Fault(f"it stands and bears {limit.multiplier} g")
    return "read, with a multiplier"


TARGET = Target("assemblies in space", 3_000, 60, attempt, limit=60.0)
