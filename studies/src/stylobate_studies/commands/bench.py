"""``stylobate bench``: how fast this machine is, beside a native reference."""

from __future__ import annotations

from typing import Annotated

import typer

from stylobate.cli import options as o


def bench(
    full: Annotated[bool, typer.Option("--full", help="Also time the domains of 768 cells, and Dask workers.")] = False,
    threads: o.Threads = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Speed on this machine, beside the same step in native code."""
    from stylobate.cli import console

    from ..speed.benchmark import bench as measure

    with console.folder(out, "bench.json") as folder:
        found = measure(
            o.the_threads(threads), full=full, say=lambda text: None if as_json else print(text, flush=True)
        )
        files = [] if folder is None else [console.write_json(folder / "bench.json", found)]
    if as_json:
        console.emit(found | {"files": [str(file) for file in files]})
    else:
        console.say("Speed of the distinct elements.", {key: _text(value) for key, value in found.items()}, files)


def _text(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else "none" if value is None else str(value)
