"""``stylobate limit``: collapse multiplier of a column or an assembly by limit analysis."""

from __future__ import annotations

import math
from typing import Annotated, Any

from ..errors import InputError
from . import options as o
from .pushover import Loads

#: What is said where a mechanism slides or twists.
UPPER_BOUND = (
    "stones slide or round faces twist in this mechanism, so that the multiplier is an upper bound; in slow ramps such "
    "assemblies gave way at 0.8 to 0.93 of it"
)


def limit(
    column: str = o.STRUCTURE,
    flow: str = o.option("RULE", "Friction in the mechanism: non-associated or associated.", "non-associated"),
    directions: str | None = o.option(
        "A:A:N",
        "In space: where the forces push to, such as 0:345:24, from x towards y; all round, the weakest between them, too.",
    ),
    *,
    pushing: Loads,
    modelling: Annotated[o.Modelling, o.Without("settings", "losses")],
    execution: o.Plain,
) -> None:
    """Collapse multiplier and mechanism of rigid blocks.

    Under horizontal forces to the right, by a static and a kinematic linear programme. A column as found: in both
    directions, or all round in space, and the weakest of them; so any column with --directions, and assemblies in space.
    """
    from ..column.links.placed import stone_at_limit
    from ..motion.specs import azimuth_range
    from ..statics.limit import limit_analysis, limit_directions, listed
    from . import console

    stone: Any = modelling.structure(column)
    loads = pushing.arguments
    azimuths = None if directions is None else azimuth_range(directions, "directions").tolist()
    in_space = azimuths is not None or stone.stack is None
    around = in_space or bool(stone.as_found)
    if around and pushing.typed and (in_space or not stone.as_found.in_plane):
        raise InputError(
            "`pattern`, `tilt` and `compressive_strength` are for one direction in the plane; leave them out, or leave "
            "`directions` out for a column found in the plane.",
            "directions",
        )
    with execution.files("limit", "limit.json", "limit", "directions") as files:
        with console.progress("directions") as progress:
            all_round = limit_directions(stone, azimuths, progress=progress, **loads) if around else None
        plane = all_round is None or all_round.dims == "xz"
        weakest = 0.0 if all_round is None else all_round.weakest.azimuth
        plane_limit = limit_analysis(stone, flow=flow, direction=weakest, **loads) if plane else None
        summary = {} if plane_limit is None else plane_limit.summary()
        if all_round is not None:
            summary = all_round.summary() | summary
        if summary["links"]:
            summary["stone_around_links"] = stone_at_limit(stone.placed_links)
        if files.wanted:
            from .. import plots
            from ..statics.limit import towards

            files.json(summary, "limit.json")
            if plane_limit is not None:
                files.picture(plots.draw_mechanism(towards(stone, weakest), plane_limit), "limit")
            if all_round is not None:
                files.picture(plots.draw_limit_directions(all_round, stone.name), "directions")
            files.write_request(structures=[stone], **({"flow": flow} if stone.stack is not None else {}), **loads)
            summary["files"] = files.names
    if execution.emits(summary):
        return
    facts = {stone.kind: stone.name}
    sentence = f"The {stone.kind.partition(' ')[0]} becomes a mechanism at {summary['collapse_multiplier_g']:.4g} g"
    if all_round is not None:
        weak = all_round.weakest
        sentence += f", pushed towards {weak.azimuth:g} degrees"
        given = len(all_round.limits)
        if not plane and not all_round.all_round and given > 1:
            sentence += f", the weakest of the {given} directions given"
        where = f" (between {weak.between[0]} and {weak.between[1]})" if weak.between else ""
        facts["weakest direction"] = f"{weak.azimuth:g} degrees from x towards y: joint {weak.joint}{where} {weak.mode}"
        if weak.moving:
            free = sum(not body.fixed for body in stone.bodies)
            facts["moving"] = f"all {free} bodies" if len(weak.moving) == free > 1 else listed(weak.moving)
        if weak.upper_bound:
            facts["mind"] = UPPER_BOUND
        most = int(all_round.multipliers.argmax())
        if not plane and stone.section == "circular" and any(any(link.low[:2]) for link in stone.placed_links):
            facts["mind"] = (
                "a link beside the axis asks round joints for torsion, of which one on its edge bears little: such a column "
                "fell at up to a fifth less"
            )
        facts["strongest direction"] = f"{all_round.azimuths[most]:g} degrees: {all_round.multipliers[most]:.4g} g"
    if plane_limit is not None:
        facts |= {
            "static and kinematic bound": f"{plane_limit.lower:.6g} and {plane_limit.upper:.6g} g",
            "mechanism": "; ".join(f"joint {item.joint} {item.mode}" for item in plane_limit.active)
            + (", seen from behind" if weakest else ""),
            "joints at their strength": ", ".join(map(str, plane_limit.at_limit)),
        }
    names = [link["link"] for link in summary["links"]]
    for link in summary["links"]:
        facts[link["link"] if names.count(link["link"]) == 1 else f"{link['link']}, {link['action']}"] = link_words(
            link
        )
    if words := stone_at_limit(stone.placed_links):
        facts["stone around links"] = words
    console.say(f"{sentence}.", facts, files)


def link_words(row: dict) -> str:
    """Demand on a link, for people."""
    capacity = f"{row['capacity_n']:.4g} N" if math.isfinite(row["capacity_n"]) else "no limit"
    most = row["largest_force_n"]
    rest = "; no upper limit"
    if most is None or math.isfinite(most):
        rest = "" if most is None else f"; other answers have up to {most:.4g} N"
    if row["need_not_act"]:
        return f"need not act (capacity {capacity}){rest}"
    force = f"{abs(row['force_n']):.4g} N of {capacity}"
    if row["yields"]:
        return f"{force}, yields"
    return f"at least {force}" + ("" if row["force_n"] else ", where others act for it") + rest
