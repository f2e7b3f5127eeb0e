"""Motions written as CSV that reads back to the same bits."""

from __future__ import annotations

from pathlib import Path

from ..atomic import replacing
from ..errors import as_typed
from .motion import Motion


def write_csv(motion: Motion, path: str | Path) -> Path:
    """Write a motion as CSV in m/s², with a header that names the units.

    Parameters
    ----------
    motion : Motion
    path : path

    Returns
    -------
    Path
        The file. It appears whole or not at all.

    Raises
    ------
    InputError
        The place cannot be written.
    """
    place = Path(path)
    azimuths = motion.metadata.get("azimuths") or {}
    notes = [f"# dt_s: {as_typed(motion.dt)}", f"# name: {_one_line(motion.name)}"]
    notes += [f"# azimuth_{axis}_deg: {as_typed(angle)}" for axis, angle in azimuths.items() if angle is not None]
    for key in ("station", "network", "event", "event_id", "start_time", "stage", "terms"):
        value = motion.metadata.get(key) or ("computed" if key == "stage" and "format" not in motion.metadata else None)
        if value:
            notes.append(f"# {key}: {_one_line(str(value))}")
    notes.append(f"# sha256: {motion.multiplied.digest}")
    notes += [f"# processing {i}: {_one_line(step)}" for i, step in enumerate(motion.processing, 1)]
    components = motion.components
    header = ",".join(["time_s", *(f"a{axis}_m_s2" for axis in components)])
    rows = zip(motion.time.tolist(), *(values.tolist() for values in components.values()))
    text = "\n".join([*notes, header, *(",".join(map(repr, row)) for row in rows), ""])
    with replacing(place) as partial:
        partial.write_text(text, encoding="utf-8")
    return place


def _one_line(text: str) -> str:
    return " ".join(text.split())
