"""The paper's columns with circular sections in space: three populations, and which plane model is nearest to them."""

from __future__ import annotations

import numpy as np

from stylobate.column.catalogue import PAPER
from stylobate.verdicts import verdict as v
from stylobate.verdicts.domain import SAFE, UNSAFE, CollapseProbability, Domain

from .cases import BEAM, BLOCKS, DEM, RIVALS, SHORT, SPACE
from .reading import percent
from .sentences import Statement, judged
from .study import PaperResults


def distance(plane: Domain, space: CollapseProbability) -> float:
    """Mean distance of a plane verdict, 0 or 1, from the share that collapses in space, over cells that have both [-]."""
    share, known = space.frequency, np.isin(plane.verdicts, (v.STANDS, v.COLLAPSED))
    known &= ~np.isnan(share)
    return float(np.abs((plane.verdicts == v.COLLAPSED) - share)[known].mean()) if known.any() else np.nan


def wrong_sides(plane: CollapseProbability, space: CollapseProbability) -> tuple[int, int, int]:
    """Cells in which all columns stand in the plane and some fall in space; all fall in the plane and some stand in space;
    cells in all."""
    unsafe = (plane.kinds == SAFE) & (space.count(v.COLLAPSED) > 0)
    safe = (plane.kinds == UNSAFE) & (space.count(v.STANDS) > 0)
    return int(unsafe.sum()), int(safe.sum()), plane.kinds.size


def space_statements(results: PaperResults) -> list[Statement]:
    """The paper's sentence on circular sections (its section 4)."""
    far = {
        (name, *rival): distance(results.rivals[name, *rival], results.space[name, SPACE])
        for name in PAPER
        for rival in RIVALS
    }
    nearer = {
        f"{SHORT[name]}, {label}": far[name, label, "circular"] < far[name, DEM, "rectangular"]
        for name in PAPER
        for label in (BEAM, BLOCKS)
    }
    distances = "; ".join(
        f"{SHORT[name]}: "
        + ", ".join(f"{label}, {section} {_share(far[name, label, section])}" for label, section in RIVALS)
        for name in PAPER
    )
    return [
        Statement(
            "4 ¶1", "With the circular section, rigid beam and rigid block give more accurate results, comparable with "
            "analyses in three dimensions, than the plane DEM with its rectangular section.",
            f"mean distance of the plane verdict from the share of round columns that collapse in space: {distances}",
            judged(all(nearer.values()), nearer),
            "In space: distinct elements with round drums, a population of columns within 1 %. A distance of 0 % is a plane "
            "verdict that is right in every cell and for every column, 50 % a coin toss.",
        )
    ]  # fmt: skip


def _share(value: float) -> str:
    return percent(value) if np.isfinite(value) else "no cell with verdicts"


def space_rows(results: PaperResults) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Header and rows of the table: what the plane says of round columns, against space."""
    header = ("column", "model", "mean share that collapses", "stands in the plane, some fall in space",
              "falls in the plane, some stand in space", "cells", "failed runs")  # fmt: skip
    body = []
    for (name, label), population in results.space.items():
        unsafe, safe, cells = wrong_sides(population, results.space[name, SPACE])
        counts = ("–", "–") if label == SPACE else (str(unsafe), str(safe))
        failed = str(int(population.count(v.FAILED).sum()))
        body.append((name, label, percent(population.mean), *counts, str(cells), failed))
    return header, body
