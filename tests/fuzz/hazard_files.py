"""Hazard files of all layouts, statistics, units and sites: the curve is that of the file, or one sentence refuses it."""

from __future__ import annotations

import math
import random
from pathlib import Path

import numpy as np

from stylobate.errors import InputError
from stylobate.probability.risk import read_hazard

from .target import Fault, Target, sentence

#: Statistics of a logic tree: as files call them, and as answers do.
CURVES = (
    ("mean", "mean"),
    ("median", "median"),
    ("max", "maximum of all realisations"),
    ("quantile-0.5", "quantile 0.5"),
    ("quantile-0.15", "quantile 0.15"),
    ("quantile-.84", "quantile 0.84"),
    ("rlz-0", "realisation 0"),
    ("rlz-012", "realisation 12"),
)

#: What is no curve of exceedance.
SPREADS = ("std", "stddev", "cov", "variance", "sigma", "beta", "STD", "iqr", "range")

#: Measures: as OpenQuake calls them, our own column, its unit, and that unit in the unit of OpenQuake.
MEASURES = (
    ("PGA", "pga_g", "g", 1.0),
    ("PGV", "pgv_m_s", "m/s", 0.01),
    ("SA(1.0)", "sa_1s_g", "g", 1.0),
    ("SA(0.2)", "sa_0.2s_g", "g", 1.0),
)


def number(rng: random.Random, value: float) -> str:
    """A number as programs write it."""
    return rng.choice(("{:.5E}", "{:.7f}", "{!r}")).format(value)


def openquake(rng: random.Random, kind: str, imt: str, im: list[float], sites: list[list[float]]) -> str:
    """The export of OpenQuake as CSV, with one row for each site [lon, lat, probabilities]."""
    quote = rng.choice(("'", ""))
    what = [f"kind={quote}{kind}{quote}", "investigation_time=50.0", f"imt='{imt}'"]
    rng.shuffle(what)
    head = ["lon", "lat", "depth", *(f"poe-{x:.7f}" for x in im)]
    rows = [",".join((f"{lon:.5f}", f"{lat:.5f}", "0.0", *(number(rng, p) for p in poe))) for lon, lat, *poe in sites]
    comment = f"#,,,,,\"generated_by='OpenQuake engine 3.16.0', {', '.join(what)}\""
    return rng.choice(("\n", "\r\n")).join([comment, ",".join(head), *rows, ""])


def nrml(rng: random.Random, kind: str, imt: str, im: list[float], sites: list[list[float]]) -> str:
    """The same as NRML."""
    name, _, value = kind.partition("-")
    stated = f'statistics="{name}"'
    if name == "quantile":
        stated += f' quantileValue="{value}"'
    elif name == "rlz":
        stated = f'statistics="{kind}"'
    measure, _, period = imt.rstrip(")").partition("(")
    stated += f' IMT="{measure}"' + (f' saPeriod="{period}" saDamping="5.0"' if period else "")
    curves = ""
    for lon, lat, *poe in sites:
        chances = " ".join(number(rng, p) for p in poe)
        curves += f"<hazardCurve><Point><pos>{lon} {lat}</pos></Point><poEs>{chances}</poEs></hazardCurve>"
    levels = " ".join(f"{x!r}" for x in im)
    return f'<nrml><hazardCurves investigationTime="50.0" {stated}><IMLs>{levels}</IMLs>{curves}</hazardCurves></nrml>'


def own(rng: random.Random, kind: str, column: str, im: list[float], rate: list[float]) -> str:
    """Our own columns, in an order and with a separator of their own."""
    separator, turned = rng.choice(",;\t"), rng.random() < 0.5
    rows = [[column, "annual_rate"], *([repr(x), repr(y)] for x, y in zip(im, rate, strict=True))]
    stated = [f"# kind='{kind}'"] if kind else []
    mark = [f"sep={separator}"] if rng.random() < 0.2 else []
    return "\n".join([*mark, *stated, *(separator.join(row[::-1] if turned else row) for row in rows)]) + "\n"


def attempt(rng: random.Random, folder: Path) -> str:
    """One file of a curve that falls by a power of the intensity."""
    spread = rng.random() < 0.3
    kind, words = (rng.choice(SPREADS), "") if spread else rng.choice((*CURVES, ("", "")))
    imt, column, unit, factor = rng.choice(MEASURES)
    si = np.geomspace(0.02, rng.uniform(0.5, 3.0), rng.randint(2, 20)).tolist()
    im = [float(f"{x / factor:.7f}") for x in si]
    power = rng.uniform(1.6, 3.0)
    rate = [1e-4 * (x / 0.2) ** -power for x in si]
    layout = rng.choice(("openquake", "nrml", "own"))
    if layout == "own":
        path, site = folder / "h.csv", None
        path.write_text(own(rng, kind, column, si, rate))
        wanted = np.array(si)
    else:
        places = [(rng.uniform(-5.0, 25.0), rng.uniform(35.0, 45.0)) for _ in range(rng.choice((1, 1, 3)))]
        here = rng.randrange(len(places))
        sites = [
            [*place, *(-math.expm1(-50.0 * r * (1.0 if k == here else 0.3)) for r in rate)]
            for k, place in enumerate(places)
        ]
        site = places[here] if len(places) > 1 else None
        stated = kind if layout == "nrml" or rng.random() < 0.7 else ""  # the name of the file states it as well
        path = folder / (f"hazard_curve-{kind or 'mean'}-{imt}_12.csv" if not stated else "h.csv")
        words = words if kind or stated else "mean"
        if layout == "nrml":
            path, words = folder / "h.xml", words if kind else ""
            path.write_text(nrml(rng, kind, imt, im, sites))
        else:
            path.write_text(openquake(rng, stated, imt, im, sites).replace("kind='',", "").replace("kind=,", ""))
        wanted = np.array(im) * factor
    try:
        hazard = read_hazard(path, site)
    except InputError as error:
        text = sentence(error)
        if not spread or f"of the kind '{kind}'" not in text:
            raise Fault(f"a curve of the kind {kind!r} is refused: {text}") from error
        return "spread, refused"
    if spread:
        raise Fault(f"a spread of the kind {kind!r} is a hazard curve: {path.read_text()[:300]}")
    if hazard.statistic != words:
        raise Fault(f"{words!r} is told as {hazard.statistic!r}: {path.name}: {path.read_text()[:300]}")
    if hazard.unit != unit or not np.allclose(hazard.im, wanted, rtol=1e-5):
        raise Fault(f"other intensities: {hazard.im} {hazard.unit}, written {wanted} {unit}")
    known = np.array(rate) > (0.0 if layout == "own" else 1e-4)  # probabilities may have seven decimals
    if not np.allclose(hazard.rate[known], np.array(rate)[known], rtol=1e-12 if layout == "own" else 1e-3):
        raise Fault(f"other rates: {hazard.rate}, written {rate}")
    return layout


TARGET = Target("hazard_files", 6_000, 60, attempt)
