"""``stylobate calibrate``: a measured free motion of a column to the losses of its joints."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from stylobate.cli import options as o
from stylobate.messages import whole_percent

if TYPE_CHECKING:
    from ..calibration.calibration import Calibration


def calibrate(
    history: Path = o.argument(
        "HISTORY", "Tilt or displacement over time (CSV), under time_s,tilt_deg or time_s,tilt_x_deg,tilt_y_deg."
    ),
    column: str = o.option("COLUMN", "What moved: name of a preset, or a column file (TOML).", ...),
    model: str = o.model("dem3d"),
    *,
    unit: str | None = o.option(None, "Unit of values where the header names none: deg, rad, mrad, m, cm, mm."),
    dt: str | None = o.option("TIME", "Step of a history without times, such as 0.005s."),
    height: str | None = o.option("H", "Height at which a displacement is measured [m]; the top by default."),
    noise: str | None = o.option("SD", "Noise of the values, in their unit; estimated by default."),
    confidence: str = o.option("SHARE", "Of intervals.", "0.9"),
    modelling: Annotated[o.Modelling, o.Without("losses", "project")],
    pictures: bool = o.option(None, "Whether --out has figures too.", True, flag="--pictures/--no-pictures"),
    execution: o.Plain,
) -> None:
    """What joints lose, from a measured free rocking or wobbling of a column.

    Computes the motion with many losses and tells which of them let it die away as it did: β, for round columns in space
    resistance to rolling and where faces carry too, with intervals. With --out, writes losses.toml, which --losses takes in
    other commands, and a picture of both histories.
    """
    from stylobate.cli import console
    from stylobate.motion.specs import parse_number, parse_time

    from ..calibration.calibrate import calibrate as calibrated
    from ..calibration.free_history import read_free_history

    numbers = {
        name: None if text is None else parse_number(f"`{name}`", text)
        for name, text in (("height", height), ("noise", noise), ("confidence", confidence))
    }
    measured = read_free_history(history, unit, None if dt is None else parse_time(dt, "dt"))
    if numbers["noise"] is not None:
        numbers["noise"] *= measured.unit
    stone, how = modelling.column(column), modelling.model(model)
    with execution.files("calibrate", "losses.toml", "calibrate.json", "calibration") as files:
        with console.progress("motions") as progress:
            calibration = calibrated(measured, stone, how, progress=progress, **numbers)  # type: ignore[arg-type]
        summary = calibration.summary() | {"files": []}
        if files.wanted:
            if calibration.after.reached:
                files.append(calibration.save(files / "losses.toml"))
            if pictures:
                from ..calibration.pictures.calibration import draw_calibration

                files.picture(draw_calibration(calibration), "calibration")
            files.write_request(structures=[stone], models=[how], motions=[], history=str(history))
            files.summary(summary, "calibrate.json")
    if not execution.emits(summary):
        console.say(calibration.sentence, facts(calibration), files)


def facts(calibration: Calibration) -> dict[str, str]:
    """What else the history tells, for people."""
    begin, summary = calibration.beginning, calibration.summary()
    lines = {
        "history": f"{calibration.history.name}, from {math.degrees(begin.tilt):.3g}° on, "
        f"noise {math.degrees(calibration.noise):.2g}°"
    }
    if calibration.restitution is not None:
        restitution, rigid = calibration.restitution, summary["restitution"]["housner"]
        lines["restitution"] = (
            f"{restitution.value:.3f} ({restitution.low:.3f} to {restitution.high:.3f}) by successive extremes alone; "
            f"{rigid:.3f} of a rigid block"
        )
    lines["decrements"] = f"{summary['decrements']}, which differ from computed ones by {summary['discrepancy']:.1%}"
    lines["scatter"] = "--scatter " + ",".join(
        f"{name}={whole_percent(size)}%" for name, size in calibration.scatter().items()
    )
    lines["joint"] = f"normal_stiffness {summary['normal_stiffness']:.3g} N/m³, to which stiffness_damping belongs"
    return lines
