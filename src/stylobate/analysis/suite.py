"""A suite of records: what each does to each column, beside how strong it is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..column import Column
from ..models.base import Case, Model
from ..motion import Motion
from ..motion.intensity import motion_summary, rocking_measures
from ..simulate import simulate_iter

if TYPE_CHECKING:
    import pandas

#: Measures along x that go into the table, by their key in the summary of a motion.
MEASURES = ("pga_g", "pgv_m_s", "arias_m_s", "cav_m_s", "duration_5_75_s", "duration_5_95_s")
SCALARS = ("pgv_over_pga_s", "pulse_period_s", "pulse_energy_share", "housner_intensity_m")


def suite_table(
    columns: Column | Sequence[Column],
    motions: Sequence[Motion],
    model: Model,
    *,
    tail: float = 0.0,
    threads: int | None = None,
) -> pandas.DataFrame:
    """Shake every column with every record.

    Parameters
    ----------
    columns : Column or sequence of Column
    motions : sequence of Motion
        E.g. ``read_suite(folder).motions``. The vertical component acts where a motion has one.
    model : Model
    tail : float
        Time to go on after each motion [s].
    threads : int, optional
        All cores by default.

    Returns
    -------
    pandas.DataFrame
        One row per column and record: outcome and measures as the JSON keys of ``stylobate run``, and the intensity
        measures of the record along x, with those that relate it to the column.
    """
    import pandas

    stands = [columns] if isinstance(columns, Column) else list(columns)
    records = [_record(motion) for motion in motions]
    rows: list[dict[str, Any]] = []
    for column in stands:
        for motion, record in zip(motions, records, strict=True):
            relation = rocking_measures(motion, math.tan(column.slenderness), column.frequency_parameter)
            rows.append({"record": motion.name, "column": column.name} | record | relation)
    cases = [Case(column, motion) for column in stands for motion in motions]
    for index, measures in simulate_iter(cases, model, tail=tail, threads=threads):
        rows[index] |= measures.row() | {"model": model.name}
    return pandas.DataFrame(rows)


def _record(motion: Motion) -> dict[str, Any]:
    summary = motion_summary(motion)
    found: dict[str, Any] = {"vertical": motion.vertical is not None, "duration_s": motion.duration}
    found |= {key: summary[key]["x"] for key in MEASURES}
    found |= {key: summary.get(key) for key in SCALARS}
    return found | {f"psa_{key.replace(' ', '')}_g": value for key, value in summary.get("psa_5_percent_g", {}).items()}
