"""Certainty of a verdict, in words and in a table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stylobate.analysis.debris import OVER_ALL, only_as_seen
from stylobate.analysis.population import set_against
from stylobate.percent import percent, percents

from . import numbers as n
from .page import Facts, Item, Rows, Section

#: Scattered parts in words, by what the twins are.
PARTS = {
    "columns": {
        "friction": "friction of each joint",
        "joint_stiffness": "stiffness of each joint",
        "density": "density of each drum",
        "width": "width of each drum",
        "height": "height of each drum",
        "offset": "place of each drum on the one below, over the width",
        "stiffness_damping": "damping of the joints, half of it common to three",
        "rolling_resistance": "resistance to rolling, half of it common to three",
        "law": "laws by which round faces carry otherwise, their share",
    },
    "assemblies": {
        "friction": "friction of each stone's contacts",
        "joint_stiffness": "stiffness of each stone's contacts",
        "density": "density of each stone",
        "offset": "place in plan of each stone, or group that moves together, over the side of its smallest joint",
    },
}

#: One of several of a kind, with its article.
ONE_OF = {"columns": "a column", "assemblies": "an assembly"}

#: Text of a cell with the columns like one.
OF_TWINS = (
    "Those like it that collapse: their share, of how many, and in brackets its 95 % interval; from which to which where "
    "some are undecided."
)

#: Words for a spread.
PERCENTILES = "16th / 50th / 84th percentile"


def certainty_sentence(summary: Mapping[str, Any]) -> str:
    """Certainty of the verdict of a run, in one or two sentences."""
    known = summary.get("certainty")
    if not isinstance(known, Mapping):
        return (
            "How sure this verdict is was not computed: it is that of exactly this geometry, these properties and this "
            "motion, and near collapse small differences decide."
        )
    fell, stood, open_ = (int(known.get(key, 0)) for key in ("collapsed", "stands", "undecided"))
    number, like = fell + stood + open_, str(known.get("like", "columns"))
    if not number:
        return f"How sure this verdict is, is not known: none of the {like} like this one could be computed."
    low, high = summary.get("collapse_interval_low"), summary.get("collapse_interval_high")
    level = percent(known.get("confidence", 0.95))
    how_many = "none" if not fell else "all" if fell == number else str(fell)
    said = f"Of {number} {like} like this one, {how_many} collapse{'s' if fell == 1 else ''}"
    if low is not None and high is not None:
        share = percents(fell / number, (fell + open_) / number)
        said += (
            f" ({share}): under this motion and in this model the probability of collapse is {percents(low, high)}, "
        )
        said += f"with {level} confidence"
        if alone := known.get("interval_of_columns"):
            said += f" ({percents(*alone)} if the law of its joints were known)"
    said += f". {open_} of them had not come to rest and {'is' if open_ == 1 else 'are'} counted both ways." * bool(
        open_
    )
    said += "." * (not open_)
    if known.get("failed"):
        said += f" {known['failed']} more could not be computed."
    beside = beside_them(summary)
    return f"{said} {beside}" if beside else said


def beside_them(summary: Mapping[str, Any]) -> str:
    """Caveat on a run that is no example of the columns like it; empty where it is one."""
    known = summary.get("certainty")
    if not isinstance(known, Mapping):
        return ""
    limits = tuple(known["interval"]) if known.get("interval") else None
    said = set_against(summary, known, float(known.get("confidence") or 0.95), limits)
    return said or str(known.get("beside") or "")


def certainty_section(summary: Mapping[str, Any]) -> Section | None:
    """Columns like this one, and their verdicts; None where none were computed."""
    known = summary.get("certainty")
    if not isinstance(known, Mapping):
        return None
    low, high = summary.get("collapse_interval_low"), summary.get("collapse_interval_high")
    like = str(known.get("like", "columns"))
    one = ONE_OF.get(like, "structure")
    pairs = [
        (
            f"{like} computed: collapse / stand / undecided / could not be computed",
            " / ".join(str(known.get(one, 0)) for one in ("collapsed", "stands", "undecided", "failed")),
        ),
        ("probability of collapse, estimated", n.plain(summary.get("collapse_probability"))),
    ]
    if low is not None and high is not None:
        pairs.append(
            (
                f"{percent(known.get('confidence', 0.95))} interval of it, from their number alone"
                + (" and that of their laws" if "laws" in known else ""),
                percents(low, high),
            )
        )
    if alone := known.get("interval_of_columns"):
        pairs.append((f"the same if the law of its joints were known; {known['laws']} laws", percents(*alone)))
    if laws := summary.get("under_other_laws"):
        pairs.append(("under other laws", str(laws)))
    for key, words in (
        ("peak_top_displacement_m", f"peak displacement of the top, {PERCENTILES}"),
        ("residual_top_displacement_m", f"residual displacement of the top, {PERCENTILES}"),
        ("peak_displacement_m", f"peak displacement of a body, {PERCENTILES}"),
        ("residual_displacement_m", f"residual displacement of a body, {PERCENTILES}"),
        ("peak_rotation_rad", f"peak rotation [rad], {PERCENTILES}"),
    ):
        spread = known.get(key)
        if isinstance(spread, list):
            shown = [
                "collapse" if one is None else n.length(one) if key.endswith("_m") else f"{one:.4f}" for one in spread
            ]
            own = None if summary.get("collapsed") else summary.get(key)
            here = "" if own is None else f"; this run {n.length(own) if key.endswith('_m') else f'{own:.4f}'}"
            pairs.append((words, " / ".join(shown) + here))
    scatter = known.get("scatter") or {}
    parts = PARTS.get(like, {})
    sizes = [f"{parts.get(key, key)}: {100.0 * float(size):g} %" for key, size in scatter.items() if size]
    pairs.append(("what varies (coefficient of variation)", "\n".join(sizes) or "nothing"))
    if known.get("left_out"):
        pairs.append(("does not vary, because the model does not take it", ", ".join(map(str, known["left_out"]))))
    if known.get("offsets_reduced"):
        pairs.append(("with offsets halved or left out, as stones would overlap", n.plain(known["offsets_reduced"])))
    pairs.append(("seed of the random numbers", n.plain(known.get("seed"))))
    items: list[Item] = [
        f"Nobody knows {one} to the last digit. The same motion was computed for {like} that differ from this one by as "
        "much as a survey leaves open; the share of them that collapses says how far the verdict can be relied on. It does "
        "not say how probable this earthquake is, nor how well the model fits nature.",
        Facts(pairs),
        *_bodies(known),
    ]
    return Section("How sure the verdict is", items)


def _bodies(known: Mapping[str, Any]) -> list[Item]:
    """Of each body of an assembly that fell or is undecided in some of those like it, in how many, and where it was."""
    bodies = {key: one for key, one in (known.get("bodies") or {}).items() if one.get("fell") or one.get("undecided")}
    if not bodies:
        return []
    header = [
        "body",
        "fell",
        "undecided",
        "probability",
        "at the end, along x [m]",
        "along y [m]",
        "50 % within [m]",
        "90 % within [m]",
    ]
    rows = [
        [
            name,
            str(one["fell"]),
            str(one["undecided"]),
            percents(one["interval_low"], one["interval_high"]),
            *(f"{one[key]:.2f}" for key in ("middle_x_m", "middle_y_m", "region_50_m", "region_90_m")),
        ]
        for name, one in sorted(bodies.items(), key=lambda pair: (-pair[1]["fell"], -pair[1]["undecided"]))
    ]
    seen = only_as_seen(max(sum(one[key] for key in ("fell", "stood", "undecided")) for one in bodies.values()))
    said = (
        f"Bodies that fell, or are undecided, in some of them: {OVER_ALL}, the median way in plan from where each stood to "
        "where it was when its run ended, and within which distances of that half and 90 % of the runs left it. Where a "
        "body lies in one run is one draw."
    ) + f" {seen[:1].upper()}{seen[1:]}." * bool(seen)
    return [Rows(header, rows, said, numbers=True)]
