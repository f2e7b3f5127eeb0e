"""The smallest amplitudes that collapse a column, and columns like it, in a report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from stylobate.messages import digits, joined, percents, say
from stylobate.results import Numbers
from stylobate.verdicts import verdict as v
from stylobate.verdicts.critical import as_recorded

from . import numbers as n
from .page import Facts, Item, Rows
from .pictures import kept

#: Most rows of a table; the CSV files in the folder hold them all.
MOST = 40

#: Facts of each motion; those that only columns like it add are left out where there are none.
BY_RECORD = (
    *("motion", "pga_g", "pgv_m_s", "as_recorded", "critical_g", "critical_factor", "all_collapse_above_g"),
    *("lowest_collapse_g", "lowest_collapse_factor", "critical_16_g", "critical_50_g", "critical_84_g"),
    *(v.UNDECIDED, v.FAILED),
)


def critical_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Amplitudes that brought down the column, and columns like it; under one motion or several."""
    s = result.summary
    records = s.get("records") or []
    pairs = [
        (say("runs"), n.plain(s["runs"])),
        (joined(" / ", map(say, v.COMPUTED)), joined(" / ", (n.plain(s.get(name)) for name in v.COMPUTED))),
    ]
    if (own := s.get("as_recorded")) is not None:
        pairs.append((say("the record as it is"), as_recorded(own)))
    items: list[Item] = [Facts(pairs)]
    if s.get("collapse_probability"):
        items += _twins(s)
    if s.get("alternation"):
        rows = [
            [
                digits(stretch["from_g"], ".4g"),
                digits(stretch["to_g"], ".4g"),
                say(stretch["verdict"]),
                str(stretch["runs"]),
            ]
            for stretch in s["alternation"]
        ]
        items.append(
            Rows(
                [say("from [g]"), say("to [g]"), say("verdict"), say("runs")],
                rows[:MOST],
                say("How verdicts on the column itself follow one another with growing amplitude."),
                numbers=True,
            )
        )
    if records:
        items.append(_by_record(records))
    items += kept(result.pictures, "critical", say("Verdict and response at every amplitude of the grid."))
    items += kept(
        result.pictures,
        "probability",
        say("Share of those like this one that collapse, over the amplitude, with its interval."),
    )
    items += kept(result.pictures, "directions", say("By direction of the motion."))
    recorded = say("The record as it is, {recorded}.", recorded=as_recorded(own)) if own is not None else ""
    sentence = joined(" ", [s["sentence"], recorded])
    return (sentence, "" if s["lowest_collapse_g"] is None else " bad"), items


def _twins(s: dict[str, Any]) -> list[Item]:
    """Columns like the one of a critical amplitude: by which amplitude shares of them fall, and the share at each."""
    certainty, scale = s["certainty"], [None] * len(s["amplitudes_g"]) if s.get("factors") is None else s["factors"]
    shown, like = certainty | certainty.get("bounds", {}), certainty.get("like", "columns")
    fallen = say("{share} % of {count} {like} like this one have fallen by")
    pairs = [
        (fallen.of(share=share, count=s["replicates"], like=say(like)), say("{at} g", at=n.plain(shown[name])))
        for share in (16, 50, 84)
        if shown.get(name := f"critical_{share}_g") is not None
    ]
    limits = zip(s["collapse_interval_low"], s["collapse_interval_high"])
    counts = zip(*(s[f"twins_{name}"] for name in v.COMPUTED))
    rows = [
        [digits(a, ".4g"), n.plain(factor), *map(str, verdicts), _share(*verdicts[:3]), percents(*interval)]
        for a, factor, verdicts, interval in zip(s["amplitudes_g"], scale, counts, limits)
    ]
    header = [
        say("amplitude [g]"),
        say("factor of the record"),
        *map(say, v.COMPUTED),
        say("share that collapses"),
        say("95 % interval of it"),
    ]
    left_out = say(" A share from which to which counts the undecided both ways.") if any(s["twins_undecided"]) else ""
    left_out += say(" The first {MOST} of {rows}.", MOST=MOST, rows=len(rows)) if len(rows) > MOST else ""
    return [
        Facts(pairs),
        Rows(header, rows[:MOST], say("Those like this one, by amplitude.") + left_out, numbers=True),
    ]


def _share(fell: int, stood: int, undecided: int) -> str:
    number = fell + stood + undecided
    return percents(fell / number, (fell + undecided) / number) if number else n.NONE


def _by_record(records: Sequence[Mapping[str, Any]]) -> Rows:
    alone = "critical_50_g" not in records[0]
    keys = [key for key in BY_RECORD if key in records[0] and not (alone and key.startswith("lowest"))]
    rows = [[n.plain(record.get("bounds", {}).get(key, record.get(key))) for key in keys] for record in records[:MOST]]
    caption = say(
        "By motion; ≤ and > mark bounds, where no amplitude on the other side was stood, or brought collapse."
    )
    left_out = say(" The first {MOST} of {records}.", MOST=MOST, records=len(records)) if len(records) > MOST else ""
    return Rows([n.named(key) for key in keys], rows, caption + left_out, numbers=True)
