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
                *plots.save(plots.draw_spectra(found), folder / "spectra"),
            ]
            summary = summary | {"files": [str(one) for one in files]}
    if as_json:
        console.emit(summary)
    else:
        console.say(found.describe(), _facts(summary), files)


_UNITS = {"_deg": " [degrees]", "_m_s": " [m/s]", "_g": " [g]", "_m": " [m]", "_s": " [s]"}


def _facts(summary: dict) -> dict[str, str]:
    facts = {}
    for key, value in summary.items():
        if key in ("name", "files") or value in (None, [], {}):
            continue
        ending = next((one for one in _UNITS if key.endswith(one)), "")
        name = key.removesuffix(ending).replace("_", " ") + _UNITS.get(ending, "")
        facts[name] = _text(value)
    return facts


def _text(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {_text(one)}" for key, one in value.items() if one is not None)
    if isinstance(value, list):
        return ", ".join(_text(one) for one in value)
    return f"{value:.4g}" if isinstance(value, float) else str(value)
