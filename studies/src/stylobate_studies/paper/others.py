"""Findings of others of columns in space, beside what this package computes: four sentences."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stylobate.column.catalogue import PAPER

from . import cases as c
from .literature import NUMBER, SHAKING, population_name
from .reading import percent
from .sentences import Statement, judged
from .study import PaperResults

TESTS = "Mouzakis et al. 2002"


def others_statements(results: PaperResults) -> list[Statement]:
    """The sentences, with their sources in place of the paper's section."""
    populations = results.literature
    planar = {name: _middle(population, lambda o: o["across"] / o["along"]) for name, population in populations.items()}
    residuals = {
        name: _middle(population, lambda o: o["residual"] / o["peak"]) for name, population in populations.items()
    }
    shaken = population_name(c.DRUMS, "rim", 0.01)
    fell = int(sum(populations[shaken]["collapsed"]))
    peaks = np.array(
        [p for p, down in zip(populations[shaken]["peak"], populations[shaken]["collapsed"], strict=True) if not down]
    )
    spread = float(peaks.max() / peaks.min()) if len(peaks) else np.nan
    out = {name: planar[name] > 0.25 for name in populations}
    small = {name: residuals[name] < 0.5 for name in populations}
    far = {name: _moved(results, name) for name in PAPER}
    return [
        Statement(
            TESTS, "Planar shaking of a round column of drums goes out of its plane, triggered by imperfections.",
            "peak of the top across over its peak along the shaking, medians of those that stand: " + _listed(planar),
            judged(all(out.values()), out),
            "Taken as: a quarter. One per cent of the shaking across is enough; drums on their rims leave the plane from "
            "rounding alone.",
        ),
        Statement(
            TESTS, "Large deformation during the shaking is not necessarily reflected by what is left at its end.",
            f"displacement of the top left {SHAKING[3]:g} s after the shaking over its peak, medians: " + _listed(residuals),
            judged(all(small.values()), small),
            "Taken as: less than half. Undamped columns still wobble then.",
        ),
        Statement(
            TESTS, "The response is very sensitive to small changes of the column or of the motion.",
            f"of {NUMBER} columns of drums within 0.1 %, {fell} collapse; the largest peak of those that stand is "
            f"{spread:.2f} times the smallest",
            judged(0 < fell < NUMBER and spread > 1.2, {"some collapse": 0 < fell < NUMBER, "peaks differ": spread > 1.2}),
            "Taken as: some collapse and some do not, and their peaks differ by a fifth.",
        ),
        Statement(
            "arXiv:0807.2101", "The smallest acceleration that overturns a single round body is nearly the same in the "
            "plane and in space.",
            "mean difference of the share that collapses, between space and its planar twin: "
            + ", ".join(f"{c.SHORT[name]} {percent(far[name])}" for name in PAPER),
            judged(far[c.MONOLITH] < 0.05),
            "Taken as: less than 5 % for the monolith. Thresholds of columns of drums do move: they are less safe in space.",
        ),
    ]  # fmt: skip


def _middle(population: dict[str, list[float]], ratio: Callable[[dict[str, np.ndarray]], np.ndarray]) -> float:
    stands = ~np.array(population["collapsed"], dtype=bool)
    values = ratio({key: np.array(numbers)[stands] for key, numbers in population.items()})
    return float(np.median(values)) if stands.any() else np.nan


def _moved(results: PaperResults, name: str) -> float:
    """Mean difference of the share that collapses in space from that of the planar twin [-]."""
    space, twin = (results.space[name, label].frequency for label in (c.SPACE, c.TWIN))
    return float(np.nanmean(np.abs(space - twin)))


def _listed(values: dict[str, float]) -> str:
    return "; ".join(f"{name} {value:.2f}" for name, value in values.items())
