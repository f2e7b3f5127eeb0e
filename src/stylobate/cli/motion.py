"""``stylobate motion``: what a file of a ground motion holds."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from ..errors import InputError
from . import options as o


def motion(
    files: list[Path] | None = o.argument(
        "FILE...", "Record, or the files of its components; sample:NAME for a sample.", None
    ),
    samples: bool = o.option(None, "List the sample motions that come with it.", False),
    *,
    motions: Annotated[o.Motions, o.Without(*o.FILES_NAMED, *o.SEVERAL, "vertical")],
    execution: o.Plain,
) -> None:
    """Contents of records of ground motion, and the records that come with the package.

    Format, unit as found, step, duration, and the peaks of each component; with --out, pictures, and the motion as
    columns of text.
    """
    from ..motion.intensity import motion_summary, warn_of_drift
    from . import console

    if samples == bool(files):
        raise InputError(
            "give the file of a record, sample:NAME, or `samples` for the list of samples, one of them.", "files"
        )
    if samples:
        return _list_samples(execution)
    record = motions.request(motion=files).motion()
    summary = motion_summary(record)
    warn_of_drift(record)
    with execution.files("motion", "motion.json", "motion.csv", "motion", "spectra") as written:
        if written.wanted:
            from .. import plots
            from ..motion.motion import write_csv

            written.json(summary, "motion.json")
            written.append(write_csv(record, written / "motion.csv"))
            written.picture(plots.draw_motion(record), "motion")
            written.picture(plots.draw_spectra(record), "spectra")
            summary = summary | {"files": written.names}
    if not execution.emits(summary):
        console.say(record.describe(), _facts(summary), written)


def _list_samples(execution: o.Execution) -> None:
    from ..motion.readers.source import PREFIX, samples
    from . import console

    names = "name", "about", "format", "terms"
    listed = [
        {name: getattr(sample, name) for name in names} | {"name": PREFIX + sample.name}
        for sample in samples().values()
    ]
    if not execution.emits({"samples": listed}):
        facts = {
            PREFIX + sample.name: f"{sample.about} ({sample.format}); {sample.terms}" for sample in samples().values()
        }
        console.say("Sample motions, for --motion and wherever a record is asked for", facts, [])


_UNITS = {"_deg": " [degrees]", "_m_s": " [m/s]", "_g": " [g]", "_m": " [m]", "_s": " [s]"}


def _facts(summary: dict) -> dict[str, str]:
    facts = {}
    for key, value in summary.items():
        if isinstance(value, dict):  # an azimuth that is not known, and a label that is the axis, tell nothing
            value = {axis: entry for axis, entry in value.items() if entry is not None and entry != axis}
        if key in ("name", "files") or value in (None, [], {}):
            continue
        ending = next((unit for unit in _UNITS if key.endswith(unit)), "")
        name = key.removesuffix(ending).replace("_", " ") + _UNITS.get(ending, "")
        facts[name] = _text(value)
    return facts


def _text(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {_text(entry)}" for key, entry in value.items() if entry is not None)
    if isinstance(value, list):
        return ", ".join(_text(entry) for entry in value)
    return f"{value:.4g}" if isinstance(value, float) else str(value)
