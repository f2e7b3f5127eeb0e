"""What a structure says of itself: a sentence or two, and what a notebook shows."""

from __future__ import annotations

from typing import Any

from .. import notebook
from ..constants import g


def described(structure: Any) -> str:
    """What a structure is, in a sentence or two: bodies, size and mass."""
    moving = [body for body in structure.bodies if not body.fixed]
    mass = sum(body.mass for body in moving)
    links = f" with {_number(len(structure.placed_links), ('link', 'links'))}" if structure.placed_links else ""
    found = ", as found" if structure.as_found else ""
    said = f"{structure.name}: {structure.described} of {_number(len(moving), structure.counted)}{links}{found}, "
    said += f"{structure.height:g} m high, {mass / 1e3:.4g} t."
    if structure.slenderness is not None and structure.frequency_parameter is not None:
        said += f" Slenderness {structure.slenderness:.3f} rad, p = {structure.frequency_parameter:.3f} rad/s."
    if structure.uplift_acceleration is not None:
        said += f" A steady {structure.uplift_acceleration / g:.3f} g opens the first joint."
    return said


def as_html(structure: Any) -> str:
    """The same with its silhouette, as HTML."""
    shapes = [(body.corners, False) for body in structure.bodies if not body.fixed]
    return notebook.page(structure.name, described(structure), {}, notebook.silhouettes([shapes], [""]))


def _number(count: int, of: tuple[str, str]) -> str:
    return f"{count} {of[count != 1]}"
