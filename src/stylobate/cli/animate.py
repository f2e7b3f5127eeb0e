"""``stylobate animate``: a film of a response."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import InputError, check_range
from . import options as o

FORMATS = ("gif", "mp4", "html")


def animate(
    response: Annotated[
        Path, typer.Argument(metavar="RESPONSE", help="File that 'stylobate run --out' wrote, or its folder.")
    ],
    to: Annotated[str, typer.Option("--format", metavar="gif|mp4|html", help="mp4 needs the extra 'video'.")] = "gif",
    rate: Annotated[str, typer.Option("--fps", metavar="N", help="Frames per second.")] = "20",
    speed: Annotated[str, typer.Option("--speed", metavar="X", help="1 is as it was, 0.5 half as fast.")] = "1",
    start: Annotated[
        str | None, typer.Option("--from", metavar="TIME", help="Where the film begins, such as 2s.")
    ] = None,
    stop: Annotated[str | None, typer.Option("--to", metavar="TIME", help="Where the film ends, such as 8s.")] = None,
    view: Annotated[
        str | None,
        typer.Option(
            "--view",
            metavar="AZIMUTH,ELEVATION",
            help="From where a response in space is seen, in degrees: azimuth from x towards y; -40,18 if not given.",
        ),
    ] = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Draw a recorded response as a film: GIF, MP4, or an HTML page with a scrubber.

    The film is written to --out, or beside the response.
    """
    from ..motion.specs import parse_time
    from ..plots.animation import write_gif, write_mp4
    from ..plots.player import write_player
    from ..plots.view import OBLIQUE, parse_view
    from ..response import load_response
    from . import console

    if to not in FORMATS:
        raise InputError(f"--format is {to!r}; allowed are {', '.join(FORMATS)}.")
    frames, pace = _number("--fps", rate, 100.0), _number("--speed", speed, 1000.0)
    if response.is_dir():
        response = response / "response.nc"
    loaded = load_response(response)
    if view is not None and loaded.dims != "xyz":
        raise InputError(f"--view is for responses in space, and that of {loaded.model} is in the plane; leave it out.")
    seen_from = OBLIQUE if view is None else parse_view(view)
    window = None
    if start is not None or stop is not None:
        first, last = float(loaded.time[0]), float(loaded.time[-1])
        window = (parse_time(start) if start else first, parse_time(stop) if stop else last)
    with console.folder(out or response.parent, f"{response.stem}.{to}") as folder:
        target = (folder or response.parent) / f"{response.stem}.{to}"
        if to == "html":
            write_player(loaded, target, frames_per_second=frames, speed=pace, window=window, seen_from=seen_from)
        else:
            write = write_gif if to == "gif" else write_mp4
            with console.progress(f"{to} film") as progress:
                write(
                    loaded,
                    target,
                    frames_per_second=frames,
                    speed=pace,
                    window=window,
                    progress=progress,
                    seen_from=seen_from,
                )
    duration = float(loaded.time[-1])
    if as_json:
        console.emit({"files": [str(target)], "duration_s": duration, "outcome": loaded.outcome.label})
    else:
        console.say(loaded.sentence, {"film": f"{duration:.2f} s, {to}"}, [target])


def _number(option: str, text: str, high: float) -> float:
    from ..motion.specs import parse_number

    return check_range(option, parse_number(option, text, "such as 1"), 0.0, high, open_low=True)
