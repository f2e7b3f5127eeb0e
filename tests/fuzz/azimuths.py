"""Records from all directions near the boundary of collapse: the worst, and those that may collapse, are what runs say."""

from __future__ import annotations

import json
import math
import random
from pathlib import Path

import numpy as np

from stylobate.motion import Motion, write_csv

from .command import command
from .target import Fault, Target


def attempt(rng: random.Random, folder: Path) -> str:
    """A record of a few cycles that ends early, turned to several azimuths, at a peak near that which overturns."""
    time = 0.01 * np.arange(rng.randint(100, 400))
    parts = [
        rng.uniform(0.2, 1.0) * np.sin(2.0 * math.pi * rng.uniform(0.3, 1.5) * time + rng.uniform(0.0, 6.0))
        for _ in "xy"
    ]
    record = write_csv(Motion(0.01, *parts), folder / "r.csv")
    number, reversed_too = rng.choice((2, 4, 12)), rng.random() < 0.3
    step = (180.0 if reversed_too else 360.0) / number
    peak = 0.19 * 9.80665 * rng.choice((1.1, 1.5, 2.0, 3.0, 4.0))
    turned = ["--azimuths", f"0:{360.0 - 360.0 / number}:{number}"]
    if reversed_too:
        turned = ["--azimuths", f"0:{180.0 - step}:{number}", "--signs", "both"]
    line = ["suite", "paper-monolithic", str(record), "--model", "housner", *turned, "--pga", f"{peak / 9.80665}g"]
    answer = json.loads(command([*line, "--json"]).out)
    runs, all_ways = answer["runs"], 2 * number if reversed_too else number
    if len(runs) != all_ways:
        raise Fault(f"{len(runs)} runs of {all_ways} directions")
    towards = np.radians([row["azimuth_deg"] for row in runs])
    along = np.abs(np.outer(np.cos(towards), parts[0]) - np.outer(np.sin(towards), parts[1])).max(axis=1)
    wanted = peak / 9.80665 * along / along.max()
    if not np.allclose([row["pga_g"] for row in runs], wanted, rtol=1e-6):
        raise Fault(f"peaks of {[row['pga_g'] for row in runs]}, and by projection {wanted}")
    fell = [row for row in runs if row["collapsed"]]
    most = min(fell, key=lambda row: row["collapse_time_s"]) if fell else None
    most = most or max(runs, key=lambda row: abs(row["peak_top_displacement_m"]))
    open_ = sorted({bearing(row) for row in runs if not row["decided"] and not row["collapsed"]})
    if abs(measure(answer["worst"]) - measure(most)) > 1e-12:
        raise Fault(f"the worst is {answer['worst']}, and by its runs {most}")
    if sorted(answer["undecided_directions_deg"]) != open_:
        raise Fault(f"undecided are {answer['undecided_directions_deg']}, and by the runs {open_}")
    if f"turned to {bearing(answer['worst']):g}°, " not in answer["sentence"]:
        raise Fault(f"{bearing(answer['worst'])}° is not in {answer['sentence']!r}")
    ways = len({bearing(row) for row in runs})
    if (f"From {len(open_)} of {ways} directions runs are undecided" in answer["sentence"]) != bool(open_):
        raise Fault(f"{len(open_)} of {ways} directions are undecided: {answer['sentence']!r}")
    return f"{'collapse' if fell else 'none collapses'}, {'some' if open_ else 'none'} undecided"


def bearing(row: dict) -> float:
    """Direction of a run [degrees]."""
    return (float(row["azimuth_deg"]) + 180.0 * bool(row["reversed"])) % 360.0


def measure(row: dict) -> float:
    """How soon a run collapses, or else how far it moves."""
    return -1e3 / (1.0 + row["collapse_time_s"]) if row["collapsed"] else abs(row["peak_top_displacement_m"])


TARGET = Target("azimuths", 1_000, 12, attempt, limit=120.0)
