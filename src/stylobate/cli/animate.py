"""``stylobate animate``: a film of a response."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

from ..errors import InputError, check_range
from . import options as o

FORMATS = ("gif", "mp4", "html")


def _number(text: str, name: str, high: float) -> float:
    return check_range(f"`{name}`", o.number(text, name, "such as 1"), 0.0, high, open_low=True)


def animate(
    response: Path = o.argument("RESPONSE", "File that 'stylobate run --out' wrote, or its folder."),
    to: str = o.option("gif|mp4|html", "mp4 needs the extra 'video'.", "gif", flag="--format"),
    rate: float = o.option("N", "Frames per second.", "20", flag="--fps", read=partial(_number, high=100.0)),
    speed: float = o.option("X", "1 is as it was, 0.5 half as fast.", "1", read=partial(_number, high=1000.0)),
    start: float | None = o.option("TIME", "Where the film begins, such as 2s.", flag="--from", read=o.time),
    stop: float | None = o.option("TIME", "Where the film ends, such as 8s.", flag="--to", read=o.time),
    view: str | None = o.option(
        "AZIMUTH,ELEVATION",
        "From where a response in space is seen, in degrees: azimuth from x towards y; -40,18 if not given.",
    ),
    *,
    execution: Annotated[o.Execution, o.Without(*o.CAMPAIGNS)],
) -> None:
    """Draw a recorded response as a film: GIF, MP4, or an HTML page with a scrubber.

    The film is written to --out, or beside the response.
    """
    from ..plots.film import write_gif, write_mp4, write_player
    from ..plots.scene import OBLIQUE, parse_view
    from ..response import load_response
    from ..response.words import doubt_of
    from . import console

    if to not in FORMATS:
        raise InputError(f"`format` is {to!r}; allowed are {', '.join(FORMATS)}.", "format")
    if response.is_dir():
        response = response / "response.nc"
    loaded = load_response(response)
    if view is not None and loaded.dims != "xyz":
        raise InputError(
            f"`view` is for responses in space, and that of {loaded.model} is in the plane; leave it out.", "view"
        )
    seen_from = OBLIQUE if view is None else parse_view(view)
    window = None
    if start is not None or stop is not None:
        first, last = float(loaded.time[0]), float(loaded.time[-1])
        window = (first if start is None else start, last if stop is None else stop)
    with console.folder(execution.out or response.parent, f"{response.stem}.{to}") as folder:
        target = (folder or response.parent) / f"{response.stem}.{to}"
        if to == "html":
            write_player(loaded, target, frames_per_second=rate, speed=speed, window=window, seen_from=seen_from)
        else:
            write = write_gif if to == "gif" else write_mp4
            with console.progress(f"{to} film") as progress:
                write(
                    loaded,
                    target,
                    frames_per_second=rate,
                    speed=speed,
                    window=window,
                    progress=progress,
                    seen_from=seen_from,
                )
    first, last = window or (float(loaded.time[0]), float(loaded.time[-1]))
    duration = (last - first) / speed
    doubt = doubt_of(loaded)
    summary = {"files": [str(target)], "duration_s": duration, "outcome": loaded.outcome.label, "doubt": doubt}
    if not execution.emits(summary):
        console.say(f"{loaded.sentence} {doubt}".rstrip(), {"film": f"{duration:.2f} s, {to}"}, [target])
