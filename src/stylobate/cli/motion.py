"""``stylobate motion``: what a file of a ground motion holds."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import InputError
from . import options as o


def motion(
    context: typer.Context,
    files: Annotated[
        list[Path] | None,
        typer.Argument(metavar="FILE...", help="Record, or the files of its components; sample:NAME for a sample."),
    ] = None,
    samples: Annotated[bool, typer.Option("--samples", help="List the sample motions that come with it.")] = False,
    unit: o.Unit = None,
    dt: o.Step = None,
    component: o.ComponentName = None,
    azimuth: o.Azimuth = None,
    condition: o.Condition = None,
    scale: o.Scale = None,
    pga: o.Pga = None,
    threads: o.Threads = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """What the record of a ground motion holds, and which records come with the package.

    Format, unit as found, step, duration, and the peaks of each component; with --out, pictures, and the motion as
    columns of text.
    """
    from ..motion.intensity import motion_summary, warn_of_drift
    from . import console

    if samples == bool(files):
        raise InputError("give the file of a record, sample:NAME, or --samples for the list of samples, one of them.")
    if samples:
        return _list_samples(as_json)
    o.the_threads(threads)  # reading has one thread
    found = o.the_request(context, motion=files).motion()
    summary, written = motion_summary(found), []
    warn_of_drift(found)
    with console.folder(out, "motion.json", "motion.csv", "motion", "spectra") as folder:
        if folder is not None:
            from .. import plots
            from ..motion.writing import write_csv

            written = [
                console.write_json(folder / "motion.json", summary),
                write_csv(found, folder / "motion.csv"),
                *plots.save(plots.draw_motion(found), folder / "motion"),
                *plots.save(plots.draw_spectra(found), folder / "spectra"),
            ]
            summary = summary | {"files": [str(one) for one in written]}
    if as_json:
        console.emit(summary)
    else:
        console.say(found.describe(), _facts(summary), written)


def _list_samples(as_json: bool) -> None:
    from ..motion.readers.samples import PREFIX, samples
    from . import console

    if as_json:
        listed = [{"name": PREFIX + one.name, "about": one.about, "format": one.format, "terms": one.terms}
                  for one in samples().values()]  # fmt: skip
        console.emit({"samples": listed})
    else:
        facts = {PREFIX + one.name: f"{one.about} ({one.format}); {one.terms}" for one in samples().values()}
        console.say("Sample motions, for --motion and wherever a record is asked for", facts, [])


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
