"""``stylobate limit``: collapse multiplier of a column by limit analysis, from below and from above."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from . import options as o
from .pushover import Pattern, Strength, Tilt, mechanism_rows, the_loads

if TYPE_CHECKING:
    from ..analysis.limit import LimitResult


def limit(
    column: o.ColumnName,
    flow: Annotated[
        str, typer.Option("--flow", metavar="RULE", help="Friction in the mechanism: non-associated or associated.")
    ] = "non-associated",
    pattern: Pattern = None,
    tilt: Tilt = "0",
    compressive_strength: Strength = None,
    threads: o.Threads = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Collapse multiplier and mechanism of rigid blocks.

    Under horizontal forces to the right, by a static and a kinematic linear programme.
    """
    from ..analysis.limit import limit_analysis
    from ..column.files import load_column
    from . import console

    o.the_threads(threads)
    stone = load_column(column)
    loads = the_loads(pattern, tilt, compressive_strength)
    with console.folder(out, "limit.json", "limit") as folder:
        found = limit_analysis(stone, flow=flow, **loads)
        summary, files = summarize(found), []
        if folder is not None:
            from .. import plots
            from ..models.rigid_block.block_stack import BlockStack

            files = [
                console.write_json(folder / "limit.json", summary),
                *plots.save(plots.draw_mechanism(BlockStack.of_column(stone), found), folder / "limit"),
            ]
            summary["files"] = [str(file) for file in files]
    if as_json:
        console.emit(summary)
        return
    modes = "; ".join(f"joint {item.joint} {item.mode}" for item in found.active)
    facts = {
        "column": stone.name,
        "static and kinematic bound": f"{found.lower:.6g} and {found.upper:.6g} g",
        "mechanism": modes,
        "joints at their strength": ", ".join(map(str, found.at_limit)),
    }
    console.say(f"The column becomes a mechanism at {found.multiplier:.4g} g.", facts, files)


def summarize(found: LimitResult) -> dict:
    """The JSON object of ``stylobate limit``."""
    return {
        "collapse_multiplier_g": found.multiplier,
        "lower_bound_g": found.lower,
        "upper_bound_g": found.upper,
        "flow": found.flow,
        "active_joints": [{"joint": item.joint, "mode": item.mode, "rate": item.rate} for item in found.active],
        "joints_at_strength": list(found.at_limit),
        "mechanism": mechanism_rows(found.mechanism),
    }
