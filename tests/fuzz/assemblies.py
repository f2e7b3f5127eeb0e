"""Assembly files: every one is an assembly that is what the file says, or is refused in one sentence."""

from __future__ import annotations

import json
import math
import random
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np

from stylobate.column.assembly import Assembly
from stylobate.column.assembly_files import assembly_from_dict, load_structure
from stylobate.column.column import Column
from stylobate.column.links import KINDS
from stylobate.errors import InputError
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.motion import harmonic
from stylobate.simulate import simulate

from . import odd
from .target import Fault, Target, sentence


def file(rng: random.Random) -> str:
    """Text of an assembly file, with odd values here and there."""
    strange = rng.choice((0.0, 0.02, 0.1))

    def value(low: float, high: float) -> str:
        return odd.number(rng, low, high, strange)

    lines = []
    if rng.random() < 0.5:
        lines.append("name = " + odd.choice(rng, ['"portal"'], 0.5, odd.NAMES))
    if rng.random() < 0.9:
        lines.append(f"density = {value(1000.0, 3000.0)}")
    for key, low, high in (("depth", 0.5, 2.0), ("gravity", 1.0, 20.0)):
        if rng.random() < 0.1:
            lines.append(f"{key} = {value(low, high)}")
    if rng.random() < 0.3:
        lines.append("ground = " + odd.choice(rng, ["0.0", "0.0", "false", "-1.0"], strange, odd.NUMBERS + odd.OTHERS))
    if rng.random() > 0.3 * strange:
        lines += ["[joint]", f"normal_stiffness = {value(1e7, 1e12)}", f"shear_stiffness = {value(1e7, 1e12)}"]
        lines.append(f"friction_angle = {value(5.0, 60.0)}")
    names = []
    for number in range(rng.randint(0 if strange else 1, 5)):
        lines.append("[[block]]")
        names.append(odd.choice(rng, [f'"b{number}"'], strange, odd.NAMES))
        if rng.random() < 0.8:
            lines.append(f"name = {names[-1]}")
        corners = polygon(rng, number, strange)
        lines.append("vertices = [" + ", ".join(f"[{x}, {z}]" for x, z in corners) + "]")
        if rng.random() < 0.1:
            lines.append(f"density = {value(1000.0, 3000.0)}")
        if rng.random() < 0.1:
            lines.append("fixed = " + odd.choice(rng, ["true", "false"], strange, odd.OTHERS))
    if len(names) > 1 and rng.random() < 0.1:
        lines += ["[[joint_override]]", f"between = [{', '.join(rng.sample(names, 2))}]"]
        lines += [f"normal_stiffness = {value(1e7, 1e12)}", f"shear_stiffness = {value(1e7, 1e12)}"]
    if names and rng.random() < 0.3:
        lines += link(rng, names, value)
    return "\n".join(lines) + "\n"


def link(rng: random.Random, names: list[str], value: Callable[[float, float], str]) -> list[str]:
    """A link between two bodies, now and then one that cannot be."""
    kind = rng.choice((*KINDS, "clmp"))
    first, second = rng.choice(names), rng.choice([*names, '"ground"'])
    lines = ["[[link]]", f'kind = "{kind}"', f"between = [{first}, {second}]"]
    if (kind in KINDS and KINDS[kind].lies != "joint") or rng.random() < 0.1:
        lines += [f"{end} = [{value(-1.0, 1.0)}, {value(0.0, 2.0)}]" for end in ("at", "to")]
    if rng.random() < 0.3 and kind != "layer":
        lines += ['material = "titanium"', f"diameter = {value(0.01, 0.05)}", f"embedment = {value(0.05, 0.2)}"]
    else:
        lines += [
            f"{name} = {value(1e5, 1e8)}"
            for name in ("axial_stiffness", "shear_stiffness", "normal_stiffness")
            if rng.random() < (0.8 if kind not in KINDS or name in KINDS[kind].known() else 0.1)
        ]
    if rng.random() < 0.3:
        lines.append(
            f"{rng.choice(('axial_capacity', 'shear_capacity', 'pretension', 'clearance'))} = {value(0.0, 1e4)}"
        )
    return lines


def polygon(rng: random.Random, number: int, strange: float) -> list[tuple[str, str]]:
    """Corners of a block: boxes on each other, or any polygon, now and then with an odd number."""
    if rng.random() < 0.7:
        half, height = rng.uniform(0.2, 1.0), rng.choice((0.5, 1.0))
        low = height * number
        corners = [(-half, low), (half, low), (half, low + height), (-half, low + height)]
    else:
        centre, size, count = (rng.uniform(-4.0, 4.0), rng.uniform(1.0, 4.0)), rng.uniform(0.1, 1.0), rng.randint(3, 9)
        angles = sorted(rng.uniform(0.0, 2.0 * math.pi) for _ in range(count))
        corners = [(centre[0] + size * math.cos(a), centre[1] + size * math.sin(a)) for a in angles]
    if rng.random() < strange:
        rng.shuffle(corners)
    return [
        (
            odd.number(rng, x, x, 0.0) if rng.random() > 0.3 * strange else rng.choice(odd.NUMBERS + odd.OTHERS),
            odd.number(rng, z, z, 0.0),
        )
        for x, z in corners
    ]


def attempt(rng: random.Random, folder: Path) -> str:
    """One file."""
    path = odd.write(rng, folder, file(rng))
    try:
        structure = load_structure(path)
    except InputError as error:
        sentence(error)
        return "refused"
    if isinstance(structure, Column):
        return "a column"
    if structure.space_joints is not None:
        return "in space"
    is_what_the_file_says(structure, tomllib.loads(path.read_text(encoding="utf-8")))
    for block in structure.blocks:
        if not block.fixed and not (np.isfinite(block.properties).all() and min(block.properties[:2]) > 0.0):
            raise Fault(f"mass and inertia are {block.properties} of {block!r:.1000}")
    if assembly_from_dict(json.loads(json.dumps(structure.to_dict()))) != structure:
        raise Fault("the assembly changed on its way through JSON")
    return computed(rng, structure) if rng.random() < 0.1 else "read"


def is_what_the_file_says(assembly: Assembly, content: dict) -> None:
    """Raise a fault where blocks have other extents or densities than the file's."""
    wanted = [(np.min(fields["vertices"], 0), np.max(fields["vertices"], 0)) for fields in content["block"]]
    got = [(block.corners.min(0), block.corners.max(0)) for block in assembly.blocks]
    if len(wanted) != len(got) or not np.allclose(np.array(wanted, float), np.array(got), rtol=1e-9, atol=1e-9):
        raise Fault(f"the file says {wanted!r:.500}, the assembly is {got!r:.500}")
    for entry, block in zip(content["block"], assembly.blocks):
        if not block.fixed and block.density != entry.get("density", content.get("density")):
            raise Fault(f"{block.name!r} has density {block.density}")


def computed(rng: random.Random, assembly: Assembly) -> str:
    """A short run ends with a result, or is refused in one sentence."""
    motion = harmonic(rng.uniform(0.5, 4.0), rng.uniform(0.5, 8.0), 0.05)
    try:
        response = simulate(assembly, motion, DistinctElement2D())
    except InputError as error:
        sentence(error)
        return "refused to compute"
    outcome = response.outcome.label
    if outcome != "failed" and not np.isfinite(response.body_position).all():
        raise Fault("not failed, and yet somewhere not finite")
    return f"computed: {outcome}"


TARGET = Target("assemblies", 5_000, 60, attempt, limit=60.0)
