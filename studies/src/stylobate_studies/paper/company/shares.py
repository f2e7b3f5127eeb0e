"""What the runs come to: medians and shares of each structure, and differences from the column alone, with intervals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stylobate.probability.lognormal import bootstrap, fit
from stylobate.probability.states import share_limits
from stylobate.response.words import STRUCK_IN_SPACE

#: What counts: that a column loses a drum, each column of a run by itself, or that anything of the structure falls.
KINDS = {"columns": "columns that lose a drum", "anything": "runs in which anything falls"}

#: Samples of the bootstrap over records, and its seed.
SAMPLES, SEED = 1000, 0


def counts(table: Any, kind: str) -> Any:
    """A row per run that has a verdict, with how many could fall (``of``) and fell (``fell``)."""
    sound = table[~(table["failed"] | table["open"])]
    if kind == "columns":
        return sound.assign(of=sound["columns"], fell=sound["columns_fallen"])
    return sound.assign(of=1, fell=(sound["bodies_fallen"] > 0).astype(int))


def median(table: Any, kind: str, structure: str) -> tuple[float, float, float]:
    """Level at which half of them fall, by a lognormal fit, and its 95 % interval over records, [m/s].

    Infinite or zero where a sample of the records knows no such level.
    """
    mine = counts(table[table["structure"] == structure], kind)
    of = mine["of"].to_numpy(dtype=int)
    level = np.repeat(np.log(mine["pgv_m_s"].to_numpy(dtype=float)), of)
    down = np.concatenate([np.arange(n) < fell for n, fell in zip(of, mine["fell"], strict=True)])
    ends = np.where(down, -np.inf, level), np.where(down, level, np.inf)
    best = float(fit(*ends).log_median[0])
    owner = np.repeat(mine["record"].to_numpy(dtype=str), of)
    drawn = bootstrap(*ends, owner, SAMPLES, np.random.default_rng(SEED))[:, 0]
    low, high = np.quantile(drawn, [0.025, 0.975], method="nearest")
    return math.exp(best), float(np.exp(low)), float(np.exp(high))


def share(table: Any, kind: str, structure: str) -> float:
    """Share of all of them that fall, over all records, directions and levels."""
    mine = counts(table[table["structure"] == structure], kind)
    return float(mine["fell"].sum() / mine["of"].sum())


def difference(table: Any, kind: str, structure: str, against: str) -> dict[str, Any]:
    """Share that falls less that of another structure under the same motions, and its 95 % interval over records.

    Runs without a verdict are left out with those that they are paired with.
    """
    keys = ["record", "azimuth_deg", "pgv_m_s"]
    mine, other = (
        counts(table[table["structure"] == name], kind)[[*keys, "fell", "of"]] for name in (structure, against)
    )
    both = mine.merge(other, on=keys, suffixes=("_mine", "_other"))
    change = (both["fell_mine"] / both["of_mine"] - both["fell_other"] / both["of_other"]).to_numpy(dtype=float)
    names, owner = np.unique(both["record"].to_numpy(dtype=str), return_inverse=True)
    sums, runs = np.bincount(owner, change), np.bincount(owner)
    even = np.full(len(names), 1.0 / len(names))
    weight = np.random.default_rng(SEED).multinomial(len(names), even, SAMPLES)
    drawn = (weight @ sums) / (weight @ runs)
    low, high = share_limits(sums, runs, float(both["pgv_m_s"].nunique()), drawn)
    return {
        "pairs": len(change),
        "records": len(names),
        "difference": float(change.mean()),
        "low": low,
        "high": high,
        "better": int((change < 0.0).sum()),
        "worse": int((change > 0.0).sum()),
    }


def summary(table: Any) -> dict[str, Any]:
    """All of it under the names of the JSON object."""
    labels = list(dict.fromkeys(table["structure"]))
    decided = ~(table["failed"] | table["open"])
    made: dict[str, Any] = {
        "runs": len(table),
        "failed": int(table["failed"].sum()),
        "undecided": int(table["open"].sum()),
        "fell_and_moving": int((decided & ~table["at_rest"]).sum()),
        "records": int(table["record"].nunique()),
        "levels_m_s": sorted(float(level) for level in table["pgv_m_s"].unique()),
        "doubt": STRUCK_IN_SPACE,
    }
    for kind in KINDS:
        made[kind] = {}
        for label in labels:
            middle, low, high = median(table, kind, label)
            row: dict[str, Any] = {"share": share(table, kind, label), "median_m_s": middle}
            row |= {"median_low": low, "median_high": high}
            if label != labels[0]:
                row["against_alone"] = difference(table, kind, label, labels[0])
            made[kind][label] = row
    return made


def runs_in_words(made: dict[str, Any]) -> str:
    """How many runs there are, and how many of them have no verdict, or one that may change."""
    return (
        f"{made['runs']} runs: {made['failed']} failed and {made['undecided']} are undecided (nothing has fallen, and "
        f"not all lies still a minute after the motion); these are left out. In {made['fell_and_moving']} something has "
        "fallen, and not all lies still at the end of the motion; what has not fallen by then counts as standing."
    )


def share_rows(made: dict[str, Any], kind: str) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Header and rows of a table: shares of each structure, and differences from the column alone."""
    header = (
        KINDS[kind],
        "share of all",
        "half of them at PGV (95 %)",
        "against the column alone (95 %)",
        "better, worse",
    )
    body = []
    for label, row in made[kind].items():
        half = f"{row['median_m_s']:.2f} m/s ({row['median_low']:.2f} to {row['median_high']:.2f})"
        cells = [label, f"{100.0 * row['share']:.0f} %", half, "", ""]
        if "against_alone" in row:
            a = row["against_alone"]
            points = [f"{100.0 * a[key]:+.0f}".replace("-", "−") for key in ("difference", "low", "high")]
            cells[3:] = [f"{points[0]} points ({points[1]} to {points[2]})", f"{a['better']}, {a['worse']}"]
        body.append(tuple(cells))
    return header, body
