"""``stylobate bench``: how fast this machine is, beside a native reference."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from stylobate.cli import options as o


def bench(
    full: bool = o.option(None, "Also time the domains of 768 cells, and Dask workers.", False),
    *,
    execution: Annotated[o.Execution, o.Without("dask", "mix_devices")],
) -> None:
    """Speed on this machine, beside the same step in native code."""
    from stylobate.cli import console

    from ..speed.benchmark import bench as measure

    with execution.files("bench", "bench.json") as files:
        reporter = (lambda _: None) if execution.as_json else partial(print, flush=True)
        measurements = measure(execution.count, full=full, device=execution.device, say=reporter)
        if files.wanted:
            files.json(measurements, "bench.json")
    if not execution.emits(measurements | {"files": files.names}):
        console.say(
            "Speed of the distinct elements.", {key: _text(value) for key, value in measurements.items()}, files
        )


def _text(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else "none" if value is None else str(value)
