"""``stylobate export``: a response for other tools."""

from __future__ import annotations

from pathlib import Path

from stylobate.cli import options as o


def export(
    response: Path = o.argument("RESULT", "Folder that 'stylobate run --out' wrote, or its response.nc."),
    to: Path = o.option("FILE", "What to write: .glb, .pvd, .vtu, .obj or .csv; nothing may be there.", ...),
    at: str | None = o.option("TIME", "One instant, such as 3.2s; .vtu and .obj need it."),
    rate: str | None = o.option("N", "Instants a second; 30 if not given, of .csv all.", flag="--fps"),
    *,
    execution: o.Plain,
) -> None:
    """Write a response for other tools.

    .glb is glTF that moves (Blender, Windows, web viewers), .pvd and .vtu are VTK's (ParaView), .obj is one instant, .csv
    holds time histories.
    """
    from stylobate.cli import console
    from stylobate.motion.specs import parse_number, parse_time
    from stylobate.response import load_response
    from stylobate.response.words import doubt_of

    from ..export import export_response

    instant = None if at is None else parse_time(at, "at")
    frames = None if rate is None else parse_number("`fps`", rate, "such as 30")
    loaded = load_response(response / "response.nc" if response.is_dir() else response)
    files = export_response(loaded, execution.place(to), at=instant, rate=frames)
    doubt = doubt_of(loaded)
    result = {"name": loaded.structure.name, "outcome": loaded.outcome.label, "doubt": doubt}
    if execution.emits(result | {"files": [str(file) for file in files]}):
        return
    more = f" and {len(files) - 1} files with it" if len(files) > 1 else ""
    console.say(f"{loaded.sentence} {doubt}".rstrip(), {"written": f"{files[0]}{more}"})
