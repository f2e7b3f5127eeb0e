"""Structure in a report: elevation, drums and joints in tables, properties, and what is as found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from stylobate.column import Column
from stylobate.column.as_found import AsFound, FoundDrum
from stylobate.column.block import FAR_AWAY
from stylobate.column.found_geometry import weakest_uplift
from stylobate.column.links.placed import stone_words
from stylobate.column.plausible import unit_doubts
from stylobate.column.structure import Structure
from stylobate.constants import g
from stylobate.plots import draw_elevation, draw_views
from stylobate.plots.drawing import joint_plans

from . import numbers as n
from .page import Facts, Item, Picture, Points, Rows, Section
from .pictures import picture

#: Most rows of a table of drums or blocks in a report; the column file holds them all.
MOST = 60


def structure_section(structure: Structure) -> Section:
    """The section on what stands."""
    column = structure.stack
    return Section(f"The {structure.kind}", _blocks(structure) if column is None else _column(column))


def state_section(column: Column, label: str, first: Column, against: str) -> Section:
    """The section on a state of a column: what it differs by from the first one, and all of it where its stones differ."""
    same = column.replace(name=first.name, links=first.links, as_found=first.as_found) == first
    if not same:
        text = f"Its drums or joints are not those of “{against}”: all of it is listed."
        return Section(f"The state “{label}”", [text, *_column(column)])
    changed = [
        (column.links != first.links, _number(len(column.links), "link"), str(len(first.links) or "none")),
        (column.as_found != first.as_found, *("as found" if one.as_found else "as built" for one in (column, first))),
    ]
    differs = "; ".join(f"{mine} instead of {other}" for changes, mine, other in changed if changes)
    text = f"Drums and joints are those of “{against}”. What differs: {differs or 'nothing'}."
    return Section(f"The state “{label}”", [text, _elevation(column), *_found_and_links(column)])


def _number(count: int, what: str) -> str:
    return f"{count or 'no'} {what}{'' if count == 1 else 's'}"


def _column(column: Column) -> list[Item]:
    round_ = column.section == "circular"
    found: list[Item] = [Facts(_properties(column), "Properties"), _drums(column, round_), _elevation(column)]
    found += _found_and_links(column)
    return [*found, *(f"Beyond what columns of stone are known to be: {doubt}" for doubt in unit_doubts(column))]


def _elevation(column: Column) -> Picture:
    words = "diameters (⌀)" if column.section == "circular" else "widths in the plane of motion"
    links = " with links" if column.links else ""
    caption = f"Elevation of {column.name}{links}, seen along y with x to the right: heights and {words} in m."
    if column.links:
        caption += " Blue: links."
    if column.as_found:
        caption += " Filled red: drums that are not where they were built, over the column as built (dashed); "
        caption += "red words: what was measured."
    return picture(draw_elevation(column), caption)


def _found_and_links(column: Column) -> list[Item]:
    found: list[Item] = [_as_found(column)] if column.as_found else []
    return [*found, _links(column), *_stone(column)] if column.links else found


def _stone(structure: Structure) -> list[Item]:
    """Where the stone gives way before links do; nothing without anchors."""
    words = stone_words(structure.placed_links)
    return [Points([words])] if words else []


def what_opens(column: Column, in_space: bool = False) -> tuple[float, str]:
    """The least steady horizontal acceleration that opens a joint [m/s²], and the same in words, with its direction.

    Parameters
    ----------
    column : Column
    in_space : bool
        Whether it may come from any side though the column is found in the plane.
    """
    every, towards = column.joint_uplift_accelerations, None
    if in_space or not column.as_found.in_plane:
        every, towards = weakest_uplift(column)
    joint = int(every.argmin())
    least = float(every[joint])
    if towards is None:
        where = "; the weaker side along x" if column.as_found else ""
    elif column.section == "circular" and not column.as_found:
        where = "; in every direction"
    else:
        where = f"; pushed towards {towards[joint]:.0f}°, the weakest of all directions"
    return least, f"{n.acceleration(least)} (joint {joint + 1}{where})"


def _properties(column: Column) -> list[tuple[str, str]]:
    return [
        ("section", column.section),
        ("drums", str(column.n) if column.n > 1 else "1, a monolith"),
        ("height", f"{column.height:.3f} m"),
        ("width of the base in contact", f"{column.base_width:.3f} m"),
        ("mass", f"{column.mass:.0f} kg"),
        ("centroid above the base", f"{column.centroid_height:.3f} m"),
        ("from the edge of the base to the centroid, R", f"{column.radius:.3f} m"),
        ("slenderness α, of R from the vertical", n.angle(column.slenderness)),
        ("frequency parameter p, as one rigid block", f"{column.frequency_parameter:.3f} rad/s"),
        ("static acceleration that opens the first joint", what_opens(column)[1]),
        ("north", column.north_words),
    ]


def _drums(column: Column, round_: bool) -> Rows:
    header = ["drum", "height [m]", "⌀ below [m]" if round_ else "width below [m]"]
    header += ["⌀ above [m]" if round_ else "width above [m]", *([] if round_ else ["depth [m]"])]
    header += ["density [kg/m³]", "mass [kg]", "joint below: μ [–]", "k_n [N/m³]", "k_s [N/m³]", "opens at [g]"]
    cohesive = any(joint.cohesion for joint in column.joints)
    header += ["cohesion [Pa]"] if cohesive else []
    body = []
    for i in reversed(range(min(column.n, MOST))):
        drum, joint = column.drums[i], column.joint_laws[i]
        depth = f"{drum.depth:.3f}" + ("" if drum.top_depth is None else f" – {drum.upper_depth:.3f}")
        row = [str(i + 1), f"{drum.height:.3f}", f"{drum.bottom_width:.3f}", f"{drum.top_width:.3f}"]
        row += [] if round_ else [depth]
        row += [f"{drum.density:.0f}", f"{drum.mass:.0f}", f"{column.friction[i]:.3f}"]
        row += [f"{joint.normal_stiffness:.3g}", f"{joint.shear_stiffness:.3g}"]
        row.append(f"{column.joint_uplift_accelerations[i] / g:.3f}")
        body.append(row + ([f"{joint.cohesion:.3g}"] if cohesive else []))
    left_out = f"; of {column.n} drums the lowest {MOST}" if column.n > MOST else ""
    caption = (
        "Drums and the joints under them, joint 1 under drum 1, from the top down"
        f"{left_out}. μ is the friction coefficient, k_n and k_s the normal and shear stiffness per "
        "area; “opens at” is the horizontal acceleration that would open the joint if it acted steadily."
    )
    return Rows(header, body, caption, numbers=True)


def _links(column: Column) -> Rows:
    body = []
    for link in column.links:
        values = link.to_dict()
        where = [f"joint {values.pop('joint')}"] if "joint" in values else []
        where += [f"{end} drum {values.pop(f'{end}_drum')}" for end in ("from", "to") if f"{end}_drum" in values]
        at = " / ".join(f"{one:g}" for one in values.pop("at", (0.0, 0.0)))
        kind, name = values.pop("kind"), values.pop("name", "")
        rest = ", ".join(f"{key.replace('_', ' ')} {n.plain(value)}" for key, value in values.items())
        body.append([f"{name} ({kind})" if name else kind, ", ".join(where) or n.NONE, at, rest or n.NONE])
    caption = (
        "Links that strengthen the column; lengths in m, forces in N, stiffness in N/m. What is not given follows from the "
        "material."
    )
    return Rows(["link", "where", "at x / y [m]", "properties"], body, caption, numbers=True)


def _chips(drum: FoundDrum, deep: bool) -> str:
    """Loss of the lower face [mm], and where the right of a round one is."""
    if not drum.chipped:
        return n.NONE
    said = " / ".join(f"{1000.0 * chip:.0f}" for chip in drum.chips[: 4 if deep else 2])
    return said + (f", right at {drum.chip_azimuth:g}°" if drum.chip_azimuth else "")


def _place(found: AsFound, drum: FoundDrum) -> str:
    """Where the offsets up to a drum leave it."""
    far, azimuth = found.place(drum.drum)
    if not far:
        return "back in line" if drum.offset else n.NONE
    return f"{1000.0 * far:.1f} mm to {azimuth:.0f}°"


def _as_found(column: Column) -> Rows:
    found = column.as_found
    deep = any(drum.chip_front or drum.chip_back for drum in found.drums)
    body = [
        [
            str(drum.drum),
            f"{1000.0 * drum.offset:+.1f}" if drum.offset else n.NONE,
            f"{drum.offset_azimuth:g}" if drum.offset else n.NONE,
            _place(found, drum),
            f"{drum.tilt:+.3g}" if drum.tilt else n.NONE,
            f"{drum.tilt_azimuth:g}" if drum.tilt else n.NONE,
            f"{drum.turn:+.3g}" if drum.turn else n.NONE,
            _chips(drum, deep),
        ]
        for drum in found.drums
    ]
    header = [
        "drum",
        "offset [mm]",
        "to azimuth [°]",
        "in all",
        "lean [°]",
        "azimuth [°]",
        "turned [°]",
        f"chips left / right{' / front / back' if deep else ''} [mm]",
    ]
    base = f" The base rises by {found.base_tilt:g}°" + (
        f" to azimuth {found.base_azimuth:g}°." if found.base_azimuth else "."
    )
    caption = (
        "As found: each drum over the joint under it; what stands on it goes along. “In all” is where the offsets up to "
        "a drum leave it, from its place as built. Azimuths are from x towards y." + (base if found.base_tilt else "")
    )
    return Rows(header, body, caption, numbers=True)


#: Caption of what is as found in an assembly.
FOUND_AT = (
    "As found: round faces that do not lie in line, and what the upper one has lost. Azimuths are from x towards y."
)


def _found_at(structure: Structure) -> list[list[str]]:
    """Joints of an assembly in space where something is off or lost."""
    plans = zip(joint_plans(structure), structure.space_joints or ())
    names = [one.name for one in structure.bodies]
    return [
        [str(k), f"{names[joint.lower]} – {names[joint.upper]}", plan.found.replace("\n", ", ")]
        for k, (plan, joint) in enumerate(plans, 1)
        if plan.found
    ][:MOST]


#: Facts of a row on a link between blocks in cells of their own.
_TOLD = ("kind", "between", "at", "to", "name")


def _blocks(structure: Structure) -> list[Item]:
    contacts = structure.space_joints
    joints_of: Sequence[Any] = structure.face_pairs if contacts is None else contacts
    seen = "Elevation" if contacts is None else "Elevations, plan and view"
    caption = f"{seen} of {structure.name}, with the size of all of it in m; supports that are held are grey."
    caption += " Blue: links." if structure.links else ""
    bodies = structure.bodies[structure.first :]
    near = [one for one in bodies if np.ptp(one.corners, axis=0).max() <= FAR_AWAY]
    held = sum(one.fixed for one in near)
    facts = [
        ("blocks", f"{sum(not one.fixed for one in bodies)} that can move" + (f", {held} held" if held else "")),
        ("joints", str(len(joints_of))),
        ("ground", "none" if structure.ground is None else f"level at z = {structure.ground:g} m"),
        ("north", structure.north_words),
    ]
    body = []
    for one in near[:MOST]:
        size, depth = np.ptp(one.shape.outline, axis=0), np.ptp(one.shape.mesh().vertices[:, 1])
        kind = "held" if one.fixed else f"{one.mass:.0f}"
        body.append([one.name, f"{size[0]:.3f}", f"{size[1]:.3f}", f"{depth:.3f}", kind])
    rows = Rows(
        ["block", "width [m]", "height [m]", "depth [m]", "mass [kg]"],
        body,
        "Blocks, from edge to edge along their own axes.",
        numbers=True,
    )
    laws = [
        [
            f"{structure.bodies[joint.lower].name} – {structure.bodies[joint.upper].name}",
            f"{joint.law.tan_phi:.3f}",
            f"{joint.law.normal_stiffness:.3g}",
            f"{joint.law.shear_stiffness:.3g}",
        ]
        for joint in joints_of[:MOST]
    ]
    joints = Rows(
        ["joint", "μ [–]", "k_n [N/m³]", "k_s [N/m³]"],
        laws,
        "Joints. μ is the friction coefficient, k_n and k_s the normal and shear stiffness per area.",
        numbers=True,
    )
    drawn = draw_elevation(structure) if contacts is None else draw_views(structure)
    found: list[Item] = [picture(drawn, caption), Facts(facts), rows, *([joints] if laws else [])]
    if contacts is not None and (seen_at := _found_at(structure)):
        found.append(Rows(["joint", "between", "as found"], seen_at, FOUND_AT, numbers=True))
    return [*found, _links_between_blocks(structure), *_stone(structure)] if structure.links else found


def _links_between_blocks(assembly: Structure) -> Rows:
    body = []
    axes = {"x": 0, "z": 2} if assembly.space_joints is None else {"x": 0, "y": 1, "z": 2}
    for link, placed in zip(assembly.links, assembly.placed_links, strict=True):
        given = link.to_dict()
        numbers = [f"{key.replace('_', ' ')} {n.plain(given[key])}" for key in given if key not in _TOLD]
        ends = [placed.low, placed.high] if placed.two_ended else [placed.low]
        at = " to ".join(" / ".join(f"{end[k]:.4g}" for k in axes.values()) for end in ends)
        body.append([placed.name, " – ".join(link.between or ()), at, ", ".join(numbers) or n.NONE])
    caption = "Links between the blocks; lengths in m, forces in N, stiffness in N/m. “governs” names formulas."
    return Rows(["link", "between", f"at {' / '.join(axes)} [m]", "properties"], body, caption, numbers=True)
