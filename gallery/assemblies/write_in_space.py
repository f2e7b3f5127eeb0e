"""Writes arch_in_space.toml and wall_corner.toml: many stones of few measures.

``python gallery/assemblies/write_in_space.py`` writes the files that lie here; other numbers are arguments of its functions.
"""

import math
from pathlib import Path

HEAD = """\
# {title}; written by write_in_space.py.
#
#   stylobate limit gallery/assemblies/{name}.toml --directions {directions}
#   stylobate run gallery/assemblies/{name}.toml --model dem3d --pulse ricker,1Hz,0.3g --tail 2s

name = "{name}"
density = 2700.0

[joint]
normal_stiffness = 5.0e9
shear_stiffness = 2.5e9
friction_coefficient = 0.7
"""


def arch(radius=3.0, thickness=0.6, width=0.8, stones=15):
    """A semicircular arch of equal voussoirs on the ground; it stands from a thickness of 0.1075 radii on (Milankovitch)."""
    title = f"A semicircular arch of {stones} voussoirs, {thickness / radius:g} of its radius thick"
    parts = [HEAD.format(title=title, name="arch_in_space", directions="0:90:2")]
    for k in range(stones):
        corners = [
            f"[{q * math.cos(a):.6f}, {y:.6f}, {q * math.sin(a):.6f}]"
            for q in (radius - 0.5 * thickness, radius + 0.5 * thickness)
            for a in (math.pi * k / stones, math.pi * (k + 1) / stones)
            for y in (-0.5 * width, 0.5 * width)
        ]
        text = ",\n    ".join(", ".join(corners[i : i + 2]) for i in range(0, 8, 2)).replace("-0.000000", "0.000000")
        parts.append(f'\n[[block]]\nname = "stone {k + 1}"\nvertices = [\n    {text},\n]\n')
    return "".join(parts)


def wall_corner(courses=6, stones=3, length=0.6, height=0.3):
    """Two wings of a drystone wall in running bond, half as thick as the stones are long, courses of one height."""
    title = "The corner of a drystone wall in courses of one height (isodomic, Vitruvius II, 8)"
    parts = [HEAD.format(title=title, name="wall_corner", directions="0:315:8")]
    thick, end = 0.5 * length, stones * length
    for course in range(courses):
        for wing, first in (("x", 0.0 if course % 2 == 0 else thick), ("y", thick if course % 2 == 0 else 0.0)):
            start, number = first, 1
            while start < end - 1e-9:
                long = min(length, end - start)
                sides, along = [long, thick, height], [start + 0.5 * long, 0.5 * thick]
                if wing == "y":
                    sides, along = [thick, long, height], along[::-1]
                box, at = (
                    ", ".join(f"{coordinate:.6g}" for coordinate in each) for each in (sides, [*along, course * height])
                )
                parts.append(f'\n[[block]]\nname = "{wing} {course + 1}.{number}"\nbox = [{box}]\nat = [{at}]\n')
                start, number = start + long, number + 1
    return "".join(parts)


if __name__ == "__main__":
    for name, text in (("arch_in_space", arch()), ("wall_corner", wall_corner())):
        Path(__file__).with_name(f"{name}.toml").write_text(text, encoding="utf-8")
