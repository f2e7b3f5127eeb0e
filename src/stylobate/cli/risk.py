"""``stylobate risk``: how often a year a column comes to a state at a site, and from which shaking."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from . import options as o
from .fragility import Curves

SITE = o.option("LON,LAT", "Of a hazard file of several sites, the nearest one.")


def risk(
    source: Path = o.argument(
        "SOURCE", "Folder of a study, an IDA, a suite or states, or a CSV file: record, im, collapsed."
    ),
    hazard: Path = o.option("FILE", "Hazard curve: annual_rate and pga_g, pgv_m_s …; or OpenQuake's.", ...),
    *,
    curves: Curves,
    site: str | None = SITE,
    execution: o.Plain,
) -> None:
    """Risk: mean annual rate and return period of a state under a hazard curve, and its deaggregation by intensity."""
    from ..probability.risk import read_hazard
    from ..probability.risk import risk as rate_of
    from ..results.command_request import kept_of
    from . import console

    curve = read_hazard(hazard, the_site(site))
    fragility, used = curves.single(source)
    estimate = rate_of(fragility, curve)
    result = estimate.summary()
    with execution.files("risk", "risk.csv", "risk.json", "risk") as files:
        if files.wanted:
            import pandas

            from .. import plots

            files.table(pandas.DataFrame(result["deaggregation"]), "risk.csv")
            files.picture(plots.draw_risk(estimate), "risk")
            files.write_request(**kept_of(used), **hazards_of([hazard], site), state=curves.state, im=curves.im)
            files.summary(result, "risk.json")
    if execution.emits(result):
        return
    most = max(result["deaggregation"], key=lambda row: row["annual_rate"])
    end = f"to {most['to']:.3g}" if math.isfinite(most["to"]) else "upwards,"
    console.say(
        estimate.sentence,
        {
            "annual rate": f"{estimate.rate:.3g} (95 %: {estimate.low:.3g} to {estimate.high:.3g})",
            "mostly from": f"{most['from']:.3g} {end} {result['unit']} ({result['im']})",
            "hazard": curve.called,
            **{f"note {k}": text for k, text in enumerate(estimate.warnings, 1)},
        },
        files,
    )


def hazards_of(files: Sequence[Path], site: str | None) -> dict[str, Any]:
    """Hazard curves with their digests, and the site, as they are kept beside what rests on them."""
    from ..atomic import digest

    return {"hazards": [f"{file} (SHA-256 {digest(file)})" for file in files], "site": site}


def the_site(text: str | None) -> tuple[float, float] | None:
    """Longitude and latitude as typed."""
    from ..errors import InputError

    if text is None:
        return None
    try:
        lon, lat = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"`site` is {text!r}; write it as longitude,latitude, such as 21.9,37.4.", "site") from None
    return lon, lat
