"""``stylobate motion``: what a file of a ground motion holds."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from . import options as o


def motion(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Record of a ground motion.")],
    unit: o.Unit = None,
    dt: o.Step = None,
    threads: o.Threads = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """What the record of a ground motion holds.

    Format, unit as found, step, duration, and the peaks of each component.
    """
    from ..motion.intensity import motion_summary
    from . import console

    o.the_threads(threads)  # reading has one thread
    found = o.the_record(file, unit, dt)
    summary, files = motion_summary(found), []
    with console.folder(out) as folder:
        if folder is not None:
            from .. import plots

            files = [
                console.write_json(folder / "motion.json", summary),
                *plots.save(plots.draw_motion(found), folder / "motion"),
            ]
            summary = summary | {"files": [str(one) for one in files]}
    if as_json:
        console.emit(summary)
    else:
        console.say(found.describe(), _facts(summary), files)


def _facts(summary: dict) -> dict[str, str]:
    facts: dict[str, str] = {}
    for key, value in summary.items():
        if isinstance(value, dict):
            for inner, one in value.items():
                facts[f"{key} {inner}"] = _text(one)
        elif key != "files":
            facts[key.replace("_", " ")] = _text(value)
    return facts


def _text(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {_text(one)}" for key, one in value.items())
    return f"{value:.4g}" if isinstance(value, float) else str(value)
