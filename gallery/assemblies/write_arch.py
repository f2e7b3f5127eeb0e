"""Writes arch.toml: a semicircular arch of equal stones on two blocks that move with the ground.

``python gallery/assemblies/write_arch.py`` writes the file that lies here; other numbers are a change of the values below.
"""

import math
from pathlib import Path

RADIUS = 2.5  # of the middle of the arch [m]
THICKNESS = 0.15 * RADIUS  # it stands of itself from 0.1075 of the radius on (Milankovitch)
STONES = 21
SPRINGING = 1.5  # height of the springing over the ground [m]

HEAD = """\
# A semicircular arch of {stones} stones, thickness {share:g} of its radius, on fixed blocks; written by write_arch.py.
#
#   stylobate run gallery/assemblies/arch.toml --model dem2d --harmonic "2Hz,0.5g,4s" --until-rest --out arch

name = "arch"
density = 2500.0
ground = 0.0                   # level of the ground, m: what falls lies there

[joint]
normal_stiffness = 5.0e9
shear_stiffness = 2.5e9
friction_coefficient = 0.7
"""


def block(name, corners, more=""):
    text = ", ".join(f"[{x:.4f}, {z:.4f}]" for x, z in corners).replace("-0.0000", "0.0000")
    return f'\n[[block]]\nname = "{name}"\n{more}vertices = [{text}]\n'


def arch():
    """The text of the file; stones from the right springing to the left one, joints radial."""
    inner, outer = RADIUS - 0.5 * THICKNESS, RADIUS + 0.5 * THICKNESS
    parts = [HEAD.format(stones=STONES, share=THICKNESS / RADIUS)]
    for side in (-1.0, 1.0):
        left = side * RADIUS - THICKNESS
        right = left + 2.0 * THICKNESS
        corners = [(left, 0.0), (right, 0.0), (right, SPRINGING), (left, SPRINGING)]
        parts.append(block("left pier" if side < 0 else "right pier", corners, "fixed = true\n"))
    for k in range(STONES):
        a, b = math.pi * k / STONES, math.pi * (k + 1) / STONES
        corners = [
            (r * math.cos(angle), SPRINGING + r * math.sin(angle))
            for r, angle in ((inner, a), (outer, a), (outer, b), (inner, b))
        ]
        parts.append(block(f"stone {k + 1}", corners))
    return "".join(parts)


if __name__ == "__main__":
    Path(__file__).with_name("arch.toml").write_text(arch(), encoding="utf-8")
