"""Tests of columns and assemblies in a folder of the documented form, computed as studies and scored as statistics."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.campaign.campaign import Campaign, Progress
from stylobate.campaign.runs import run_all
from stylobate.constants import g
from stylobate.response.rows import Rows
from stylobate.verdicts import verdict as v

from . import distributions
from .measured_files import COLLAPSED, Measured

#: Columns of the table of scores.
COLUMNS = (
    "measure", "score", "tests", "undecided", "measured", "measured_low", "measured_high", "computed", "computed_low",
    "computed_high", "value", "low", "high", "tolerance", "verdict",
)  # fmt: skip


def computed(
    experiment: Measured, *, threads: int | None = None, progress: Progress | None = None, ledger: Path | None = None
) -> Any:
    """One row per test and realisation: verdict and the measures that are scored; resumes from its ledger.

    Raises
    ------
    Stopped
        It was interrupted; what is finished is in the ledger.
    """
    import pandas

    rows, wanted = [], sorted({score.measure for score in experiment.file.scores} - {COLLAPSED})
    for tests, study in experiment.studies():
        campaign = Campaign(threads=threads, progress=progress, ledger=ledger)
        made = run_all(study.request(study.plan()), campaign)
        each = study.shape[-1]
        verdicts, seen = v.verdicts_of(made), {measure: _values(made, measure) for measure in wanted}
        for number, test in enumerate(tests):
            for realisation in range(each):
                k = number * each + realisation
                row = {
                    "test": test.name,
                    "structure": test.structure,
                    "realisation": realisation,
                    "verdict": verdicts[k],
                }
                rows.append(row | {measure: float(seen[measure][k]) for measure in wanted})
    return pandas.DataFrame(rows)


def _values(made: Rows, measure: str) -> np.ndarray:
    """A measure of every run, of a body too; NaN where there is none."""
    body, _, name = measure.rpartition(".")
    if not body:
        return np.abs(made.floats(name))
    values = [None if row is None else row["bodies"][body][name] for row in made]
    return np.array([math.nan if value is None else abs(value) for value in values])


def scores(experiment: Measured, runs: Any) -> Any:
    """One row per score: what was measured and computed, the score with its interval, and its verdict.

    What collapses exceeds every size; an undecided run counts as it stands and as if it collapsed, and a test of which a
    run failed is left out.
    """
    import pandas

    verdicts = _by_test(experiment, runs, "verdict")
    fell, open_ = verdicts == v.COLLAPSED, verdicts == v.UNDECIDED
    sound = ~np.isin(verdicts, (v.FAILED, v.NOT_RUN)).any(axis=1)
    rows = []
    for score in experiment.file.scores:
        measured = np.array([test.measured[score.measure] for test in experiment.tests])
        if score.measure == COLLAPSED:
            low, high = fell.astype(float), (fell | open_).astype(float)
        else:
            low = np.where(fell, math.inf, _by_test(experiment, runs, score.measure).astype(float))
            high = np.where(open_, math.inf, low)
        used = sound & ~np.isnan(measured) & ~np.isnan(low).any(axis=1)
        row: dict[str, Any] = {"measure": score.measure, "score": score.score, "tests": int(used.sum())}
        if used.any():
            row |= distributions.compared(score.score, measured[used], low[used], high[used])
        row |= {"tolerance": score.tolerance, "undecided": int(open_[used].sum())}
        row["verdict"] = distributions.verdict(score.score, row, score.tolerance) if used.any() else "open"
        rows.append(row)
    return pandas.DataFrame(rows, columns=COLUMNS)


def _by_test(experiment: Measured, runs: Any, column: str) -> np.ndarray:
    """A column of the table of runs, shape (tests, realisations), in the order of the tests."""
    each = max(1, experiment.campaign.replicates)
    place = {name: k for k, name in enumerate(runs["test"].to_numpy()[::each])}
    return runs[column].to_numpy().reshape(-1, each)[[place[test.name] for test in experiment.tests]]


def tests_table(experiment: Measured, runs: Any) -> Any:
    """One row per test: what was measured, and the share and medians of its realisations; what fell is infinitely far."""
    import pandas

    verdicts, rows = _by_test(experiment, runs, "verdict"), []
    fell = verdicts == v.COLLAPSED
    for k, test in enumerate(experiment.tests):
        row: dict[str, Any] = {"test": test.name, "structure": test.structure, "pga_g": test.motion.pga / g}
        row |= {f"measured {name}": value for name, value in sorted(test.measured.items())}
        row[f"computed {COLLAPSED}"] = float(fell[k].mean())
        for name in sorted({score.measure for score in experiment.file.scores} - {COLLAPSED}):
            values = np.where(fell[k], math.inf, _by_test(experiment, runs, name)[k].astype(float))
            row[f"computed {name}"] = distributions.median(values)
        rows.append(row)
    return pandas.DataFrame(rows)


def sentences(summary: dict[str, Any]) -> list[str]:
    """What was fixed, and what came of each score, for people."""
    fixed = summary["fixed"]
    twins = f", {fixed['realisations']} realisations of each" if fixed["realisations"] else ""
    lines = [
        f"{summary['tests']} tests; fixed on {fixed['on']}, as the folder says: {fixed['model']}{twins}, "
        f"{len(fixed['scores'])} scores (digest {fixed['digest'][:12]})"
    ]
    if summary["changed_since"]:
        lines.append(
            f"what is fixed has been changed since {summary['changed_since']}, when its scores were first seen"
        )
    return lines
