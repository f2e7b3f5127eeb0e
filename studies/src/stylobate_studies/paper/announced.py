"""Sentences that records judge: the rigid beam under real motions, which the paper announces, and columns in company."""

from __future__ import annotations

from typing import Any

import numpy as np

from stylobate.column.catalogue import PAPER
from stylobate.probability.fragility import FEWEST
from stylobate.probability.studies import StudyResult
from stylobate.verdicts import verdict as v

from .cases import BEAM, DEM, SHORT
from .motions import COMPARED, LEVELS, against, outcome_of
from .reading import percent
from .sentences import FAILS, UNDECIDED, Statement, Verdict, judged


def motions_rows(result: StudyResult) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Header and rows of the table: verdicts of each model, and how far they and peaks are those of distinct elements."""
    header = ("column", "model", "runs", "collapsed", "stands", "undecided", "failed",
              "same verdict as distinct elements", "peak over theirs, median (range)")  # fmt: skip
    body = []
    for name in PAPER:
        for label in COMPARED:
            verdicts, _ = outcome_of(result, name, label)
            counts = [str(int((verdicts == kind).sum())) for kind in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)]
            same, ratios = against(result, name, label)
            agree = "–" if label == DEM else f"{int(same.sum())} of {len(same)}"
            peaks = "–" if label == DEM or not len(ratios) else (
                f"{np.median(ratios):.2f} ({ratios.min():.2f} to {ratios.max():.2f}; {len(ratios)})"
            )  # fmt: skip
            body.append((name, label, str(len(verdicts)), *counts, agree, peaks))
    return header, body


def motions_statement(result: StudyResult) -> Statement:
    """The announced tests of the rigid beam under real motions, judged as its harmonic tests are."""
    agree = {name: against(result, name, BEAM)[0] for name in PAPER}
    enough = {
        f"{SHORT[name]}, {same.sum()} of {same.size}": len(same) > 0 and bool(same.mean() >= 0.8)
        for name, same in agree.items()
    }
    peaks = {name: against(result, name, BEAM)[1] for name in PAPER}
    records = len(result.plan.axes["motions"])
    return Statement(
        "4 ¶2", "The rigid beam agrees with the DEM under real ground motions, too.",
        f"same verdict under {records} records at {len(LEVELS)} levels: "
        + ", ".join(f"{SHORT[name]} {percent(float(same.mean()))} of {len(same)}" for name, same in agree.items())
        + "; median ratio beam/DEM of the peaks where both rock and neither collapses: "
        + ", ".join(f"{SHORT[name]} {_middle(peaks[name])}" for name in PAPER),
        judged(all(enough.values()), enough),
        "The paper announces these tests, and says nothing of how they come out. Taken as: four verdicts in five. Round "
        f"columns, records scaled to PGV {LEVELS[0]:g} to {LEVELS[-1]:g} m/s.",
    )  # fmt: skip


def _middle(ratios: np.ndarray) -> str:
    return f"{np.median(ratios):.2f} ({len(ratios)} cases)" if len(ratios) else "no case"


def company_statement(made: dict[str, Any]) -> Statement:
    """The sentence, judged by intervals of differences from the column alone under the same motions."""
    columns, anything = made["columns"], made["anything"]
    alone, *others = columns
    safer = {name: columns[name]["against_alone"]["high"] < 0.0 for name in others}
    worse = [columns[name]["against_alone"]["low"] > 0.0 for name in others]
    verdict = judged(all(safer.values()), safer)
    if made["records"] < FEWEST or (verdict.kind == FAILS and not any(worse)):
        verdict = Verdict(UNDECIDED)
    differences = ", ".join(_difference(name, columns[name]["against_alone"]) for name in others)
    return Statement(
        "1 ¶1", "Columns that stand free today are more prone to collapse than those that top beams connected.",
        f"columns that lose a drum, over {made['records']} records, two directions and {len(made['levels_m_s'])} levels: "
        f"{alone} {percent(columns[alone]['share'])}; beside that, in company under the same motions (95 %): {differences}",
        verdict,
        f"Taken as: the interval of the difference lies below zero in all {len(others)} structures, from "
        f"{FEWEST} records or "
        "more. That anything falls: "
        + ", ".join(f"{name} {percent(anything[name]['share'])}" for name in columns) + ".",
        "Too few records: the page on columns in company. Where stones strike one another, a fall is one draw of many.",
    )  # fmt: skip


def _difference(name: str, a: dict[str, Any]) -> str:
    low, middle, high = (f"{100.0 * a[key]:+.0f}".replace("-", "−") for key in ("low", "difference", "high"))
    return f"{name} {middle} points ({low} to {high})"
