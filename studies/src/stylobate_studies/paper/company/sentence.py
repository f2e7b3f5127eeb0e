"""The paper's sentence on top beams, beside what the same columns alone and in company come to."""

from __future__ import annotations

from typing import Any

from ..reading import CHOICES, FAILS, HOLDS, UNDECIDED, Statement


def company_statement(made: dict[str, Any]) -> Statement:
    """The sentence, judged by intervals of differences from the column alone under the same motions."""
    columns, anything = made["columns"], made["anything"]
    alone, *others = columns
    safer = [columns[name]["against_alone"]["high"] < 0.0 for name in others]
    worse = [columns[name]["against_alone"]["low"] > 0.0 for name in others]
    verdict = HOLDS if all(safer) else CHOICES if any(safer) else FAILS if any(worse) else UNDECIDED
    differences = ", ".join(_difference(name, columns[name]["against_alone"]) for name in others)
    return Statement(
        "1", "Columns that stand free today are more prone to collapse than those that top beams connected.",
        f"columns that lose a drum, over {made['records']} records, two directions and {len(made['levels_m_s'])} levels: "
        f"{alone} {columns[alone]['share']:.0%}; less than that by the same motions in company (95 %): {differences}"
        .replace("%", " %"),
        verdict,
        f"Taken as: the interval of the difference lies below zero in all {len(others)} structures. That anything falls: "
        + ", ".join(f"{name} {anything[name]['share']:.0%}".replace("%", " %") for name in columns) + ".",
        "Nine records: the page on columns in company. Where stones strike one another, a fall is one draw of many.",
    )  # fmt: skip


def _difference(name: str, a: dict[str, Any]) -> str:
    low, middle, high = (f"{100.0 * a[key]:+.0f}".replace("-", "−") for key in ("low", "difference", "high"))
    return f"{name} {middle} points ({low} to {high})"
