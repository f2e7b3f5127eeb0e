"""Structure in a report: elevation, drums and joints in tables, properties, and what is as found."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import starmap
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
from stylobate.messages import digits, joined, say
from stylobate.plots import draw_elevation, draw_views
from stylobate.plots.drawing import joint_plans

from . import numbers as n
from .page import Exact, Facts, Item, Picture, Points, Rows, Section
from .pictures import picture

#: Most rows of a table of drums or blocks in a report; the column file holds them all.
MOST = 60


def structure_section(structure: Structure) -> Section:
    """The section on what stands."""
    column = structure.stack
    titles = {"column": say("The column"), "assembly": say("The assembly"), "specimen": say("The specimen")}
    titles["assembly in space"] = say("The assembly in space")
    return Section(titles[structure.kind], _blocks(structure) if column is None else _column(column))


def state_section(column: Column, label: str, first: Column, against: str) -> Section:
    """The section on a state of a column: what it differs by from the first one, and all of it where its stones differ."""
    same = column.replace(name=first.name, links=first.links, as_found=first.as_found) == first
    if not same:
        text = say("Its drums or joints are not those of “{against}”: all of it is listed.", against=against)
        return Section(say("The state “{label}”", label=label), [text, *_column(column)])
    changed = [
        (column.links != first.links, _links_of(column), str(len(first.links)) if first.links else say("none")),
        (
            column.as_found != first.as_found,
            *(say("as found") if variant.as_found else say("as built") for variant in (column, first)),
        ),
    ]
    differs = joined(
        "; ", (say("{mine} instead of {other}", mine=mine, other=other) for changes, mine, other in changed if changes)
    )
    text = say(
        "Drums and joints are those of “{against}”. What differs: {what}.",
        against=against,
        what=differs or say("nothing"),
    )
    return Section(say("The state “{label}”", label=label), [text, _elevation(column), *_found_and_links(column)])


def _links_of(column: Column) -> str:
    count = len(column.links)
    words = say("1 link") if count == 1 else say("{count} links", count=count)
    return words if count else say("no links")


def _column(column: Column) -> list[Item]:
    round_ = column.section == "circular"
    items: list[Item] = [Facts(_properties(column), say("Properties")), _drums(column, round_), _elevation(column)]
    items += _found_and_links(column)
    return [
        *items,
        *(say("Beyond what columns of stone are known to be: {doubt}", doubt=doubt) for doubt in unit_doubts(column)),
    ]


def _elevation(column: Column) -> Picture:
    words = say("diameters (⌀)") if column.section == "circular" else say("widths in the plane of motion")
    links = say(" with links") if column.links else ""
    caption = say(
        "Elevation of {column.name}{links}, seen along y with x to the right: heights and {words} in m.",
        column=column,
        links=links,
        words=words,
    )
    if column.links:
        caption = joined(" ", [caption, say("Blue: links.")])
    if column.as_found:
        caption = joined(" ", [caption, say("Filled red: drums that are not where they were built, over the column as built "
                                            "(dashed); red words: what was measured.")])  # fmt: skip
    return picture(draw_elevation(column), caption)


def _found_and_links(column: Column) -> list[Item]:
    items: list[Item] = [_as_found(column)] if column.as_found else []
    return [*items, _links(column), *_stone(column)] if column.links else items


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
        where = say("; the weaker side along x") if column.as_found else ""
    elif column.section == "circular" and not column.as_found:
        where = say("; in every direction")
    else:
        where = say("; pushed towards azimuth {towards:.0f}°, the weakest of all directions", towards=towards[joint])
    return least, say("{least} (joint {joint}{where})", least=n.acceleration(least), joint=joint + 1, where=where)


def _properties(column: Column) -> list[tuple[str, str]]:
    return [
        (say("section"), say(column.section)),
        (say("drums"), str(column.n) if column.n > 1 else say("1, a monolith")),
        (say("height"), say("{column.height:.3f} m", column=column)),
        (say("width of the base in contact"), say("{column.base_width:.3f} m", column=column)),
        (say("mass"), say("{column.mass:.0f} kg", column=column)),
        (say("centroid above the base"), say("{column.centroid_height:.3f} m", column=column)),
        (say("from the edge of the base to the centroid, R"), say("{column.radius:.3f} m", column=column)),
        (say("slenderness α, of R from the vertical"), n.angle(column.slenderness)),
        (
            say("frequency parameter p, as one rigid block"),
            say("{column.frequency_parameter:.3f} rad/s", column=column),
        ),
        (say("static acceleration that opens the first joint"), what_opens(column)[1]),
        (say("north"), column.north_words),
    ]


def _drums(column: Column, round_: bool) -> Rows:
    header = [say("drum"), say("height [m]"), say("⌀ below [m]") if round_ else say("width below [m]")]
    header += [say("⌀ above [m]") if round_ else say("width above [m]"), *([] if round_ else [say("depth [m]")])]
    header += [
        say("density [kg/m³]"),
        say("mass [kg]"),
        say("joint below: μ [–]"),
        "k_n [N/m³]",
        "k_s [N/m³]",
        say("opens at [g]"),
    ]
    cohesive = any(joint.cohesion for joint in column.joints)
    header += [say("cohesion [Pa]")] if cohesive else []
    body = []
    for i in reversed(range(min(column.n, MOST))):
        drum, joint = column.drums[i], column.joint_laws[i]
        depth = digits(drum.depth, ".3f") + (
            "" if drum.top_depth is None else say(" – {drum.upper_depth:.3f}", drum=drum)
        )
        row = [str(i + 1), digits(drum.height, ".3f"), digits(drum.bottom_width, ".3f"), digits(drum.top_width, ".3f")]
        row += [] if round_ else [depth]
        row += [digits(drum.density, ".0f"), digits(drum.mass, ".0f"), digits(column.friction[i], ".3f")]
        row += [digits(joint.normal_stiffness, ".3g"), digits(joint.shear_stiffness, ".3g")]
        row.append(digits(column.joint_uplift_accelerations[i] / g, ".3f"))
        body.append(row + ([digits(joint.cohesion, ".3g")] if cohesive else []))
    left_out = say("; of {all} drums the lowest {most}", all=column.n, most=MOST) if column.n > MOST else ""
    caption = say(
        "Drums and the joints under them, joint 1 under drum 1, from the top down{left_out}. μ is the friction "
        "coefficient, k_n and k_s the normal and shear stiffness per area; “opens at” is the horizontal "
        "acceleration that would open the joint if it acted steadily.",
        left_out=left_out,
    )
    return Rows(header, body, caption, numbers=True)


def _links(column: Column) -> Rows:
    body = []
    for link in column.links:
        values = link.to_dict()
        joint, low, high = (values.pop(key, None) for key in ("joint", "from_drum", "to_drum"))
        where = [
            say("joint {joint}", joint=joint) if joint is not None else "",
            say("from drum {drum}", drum=low) if low is not None else "",
            say("to drum {drum}", drum=high) if high is not None else "",
        ]
        at = joined(" / ", (digits(coordinate, "g") for coordinate in values.pop("at", (0.0, 0.0))))
        kind, name = values.pop("kind"), values.pop("name", "")
        kind, rest = say(kind), joined(", ", starmap(_property, values.items()))
        called = say("{name} ({kind})", name=Exact(name), kind=kind) if name else kind
        body.append([called, joined(", ", where) or n.NONE, at, rest or n.NONE])
    caption = say(
        "Links that strengthen the column; lengths in m, forces in N, stiffness in N/m. What is not given "
        "follows from the material."
    )
    return Rows([say("link"), say("where"), say("at x / y [m]"), say("properties")], body, caption, numbers=True)


def _property(key: str, value: Any) -> str:
    return say("{name} {value}", name=say(key.replace("_", " ")), value=n.plain(value))


def _chips(drum: FoundDrum, deep: bool) -> str:
    """Loss of the lower face [mm], and where the right of a round one is."""
    if not drum.chipped:
        return n.NONE
    text = joined(" / ", (digits(1000.0 * chip, ".0f") for chip in drum.chips[: 4 if deep else 2]))
    return text + (say(", right at {azimuth:g}°", azimuth=drum.chip_azimuth) if drum.chip_azimuth else "")


def _place(as_found: AsFound, drum: FoundDrum) -> str:
    """Where the offsets up to a drum leave it."""
    far, azimuth = as_found.place(drum.drum)
    if not far:
        return say("back in line") if drum.offset else n.NONE
    return say("{far:.1f} mm to {azimuth:.0f}°", far=1000.0 * far, azimuth=azimuth)


def _as_found(column: Column) -> Rows:
    as_found = column.as_found
    deep = any(drum.chip_front or drum.chip_back for drum in as_found.drums)
    body = [
        [
            str(drum.drum),
            digits(1000.0 * drum.offset, "+.1f") if drum.offset else n.NONE,
            digits(drum.offset_azimuth, "g") if drum.offset else n.NONE,
            _place(as_found, drum),
            digits(drum.tilt, "+.3g") if drum.tilt else n.NONE,
            digits(drum.tilt_azimuth, "g") if drum.tilt else n.NONE,
            digits(drum.turn, "+.3g") if drum.turn else n.NONE,
            _chips(drum, deep),
        ]
        for drum in as_found.drums
    ]
    header = [
        say("drum"),
        say("offset [mm]"),
        say("to azimuth [°]"),
        say("in all"),
        say("lean [°]"),
        say("azimuth [°]"),
        say("turned [°]"),
        say("chips left / right / front / back [mm]") if deep else say("chips left / right [mm]"),
    ]
    rises = say("The base rises by {f.base_tilt:g}°.", f=as_found)
    if as_found.base_azimuth:
        rises = say("The base rises by {f.base_tilt:g}° to azimuth {f.base_azimuth:g}°.", f=as_found)
    caption = say(
        "As found: each drum over the joint under it; what stands on it goes along. “In all” is where the "
        "offsets up to a drum leave it, from its place as built. Azimuths are from x towards y."
    )
    caption = joined(" ", [caption, rises if as_found.base_tilt else ""])
    return Rows(header, body, caption, numbers=True)


#: Caption of what is as found in an assembly.
FOUND_AT = say(
    "As found: round faces that do not lie in line, and what the upper one has lost. Azimuths are from x towards y."
)


def _found_at(structure: Structure) -> list[list[str]]:
    """Joints of an assembly in space where something is off or lost."""
    plans = zip(joint_plans(structure), structure.space_joints or ())
    names = [body.name for body in structure.bodies]
    return [
        [
            str(k),
            say("{names} – {names_2}", names=names[joint.lower], names_2=names[joint.upper]),
            plan.as_found,
        ]
        for k, (plan, joint) in enumerate(plans, 1)
        if plan.as_found
    ][:MOST]


#: Facts of a row on a link between blocks in cells of their own.
_IN_CELLS = ("kind", "between", "at", "to", "name")


def _blocks(structure: Structure) -> list[Item]:
    contacts = structure.space_joints
    joints_of: Sequence[Any] = structure.joined_faces
    caption = say("Elevation of {name}, with the size of all of it in m; supports that are held are grey.")
    if contacts is not None:
        caption = say(
            "Elevations, plan and view of {name}, with the size of all of it in m; supports that are held are grey."
        )
    caption = joined(" ", [caption.of(name=structure.name), say("Blue: links.") if structure.links else ""])
    bodies = structure.bodies[structure.first :]
    near = [block for block in bodies if np.ptp(block.corners, axis=0).max() <= FAR_AWAY]
    fixed_count = sum(block.fixed for block in near)
    facts = [
        (
            say("blocks"),
            say("{sum} that can move", sum=sum(not block.fixed for block in bodies))
            + (say(", {held} held", held=fixed_count) if fixed_count else ""),
        ),
        (say("joints"), str(len(joints_of))),
        (
            say("ground"),
            say("none")
            if structure.ground is None
            else say("level at z = {structure.ground:g} m", structure=structure),
        ),
        (say("north"), structure.north_words),
    ]
    body = []
    for block in near[:MOST]:
        size, depth = np.ptp(block.shape.outline, axis=0), np.ptp(block.shape.mesh().vertices[:, 1])
        kind = say("held") if block.fixed else digits(block.mass, ".0f")
        body.append([block.name, digits(size[0], ".3f"), digits(size[1], ".3f"), digits(depth, ".3f"), kind])
    rows = Rows(
        [say("block"), say("width [m]"), say("height [m]"), say("depth [m]"), say("mass [kg]")],
        body,
        say("Blocks, from edge to edge along their own axes."),
        numbers=True,
    )
    laws = [
        [
            say(
                "{name} – {name_2}", name=structure.bodies[joint.lower].name, name_2=structure.bodies[joint.upper].name
            ),
            digits(joint.law.tan_phi, ".3f"),
            digits(joint.law.normal_stiffness, ".3g"),
            digits(joint.law.shear_stiffness, ".3g"),
        ]
        for joint in joints_of[:MOST]
    ]
    joints = Rows(
        [say("joint"), "μ [–]", "k_n [N/m³]", "k_s [N/m³]"],
        laws,
        say("Joints. μ is the friction coefficient, k_n and k_s the normal and shear stiffness per area."),
        numbers=True,
    )
    drawn = draw_elevation(structure) if contacts is None else draw_views(structure)
    items: list[Item] = [picture(drawn, caption), Facts(facts), rows, *([joints] if laws else [])]
    if contacts is not None and (seen_at := _found_at(structure)):
        items.append(Rows([say("joint"), say("between"), say("as found")], seen_at, FOUND_AT, numbers=True))
    return [*items, _links_between_blocks(structure), *_stone(structure)] if structure.links else items


def _links_between_blocks(assembly: Structure) -> Rows:
    body = []
    axes = {"x": 0, "z": 2} if assembly.space_joints is None else {"x": 0, "y": 1, "z": 2}
    for link, placed in zip(assembly.links, assembly.placed_links, strict=True):
        given = link.to_dict()
        numbers = [_property(key, given[key]) for key in given if key not in _IN_CELLS]
        ends = [placed.low, placed.high] if placed.two_ended else [placed.low]
        at = joined(say(" to "), (joined(" / ", (digits(end[k], ".4g") for k in axes.values())) for end in ends))
        body.append([placed.name, joined(" – ", link.between or ()), at, joined(", ", numbers) or n.NONE])
    caption = say("Links between the blocks; lengths in m, forces in N, stiffness in N/m. “governs” names formulas.")
    return Rows(
        [say("link"), say("between"), say("at {axes} [m]", axes=" / ".join(axes)), say("properties")],
        body,
        caption,
        numbers=True,
    )
