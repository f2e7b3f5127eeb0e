"""Certainty of a verdict, in words and in a table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stylobate.messages import digits, joined, percent, percents, say
from stylobate.response.measures import JOINT, SPREAD
from stylobate.verdicts.population import OVER_ALL, only_as_seen, set_against

from . import numbers as n
from .page import Facts, Item, Rows, Section

#: Scattered parts in words, by what the twins are.
PARTS = {
    "columns": {
        "friction": say("friction of each joint"),
        "joint_stiffness": say("stiffness of each joint"),
        "density": say("density of each drum"),
        "width": say("width of each drum"),
        "height": say("height of each drum"),
        "offset": say("place of each drum on the one below, over the width"),
        "stiffness_damping": say("damping of the joints, half of it common to three"),
        "rolling_resistance": say("resistance to rolling, half of it common to three"),
        "law": say("laws by which round faces carry otherwise, their share"),
        "unknown_stiffness": say("how far the stiffness common to three is unknown, from 1e9 N/m³ to that of stone"),
    },
    "assemblies": {
        "friction": say("friction of each stone's contacts"),
        "joint_stiffness": say("stiffness of each stone's contacts"),
        "density": say("density of each stone"),
        "offset": say("place in plan of each stone, or group that moves together, over the side of its smallest joint"),
    },
}

#: One of several of a kind, with its article.
ONE_OF = {"columns": say("a column"), "assemblies": say("an assembly")}

#: Text of a cell with the columns like one.
OF_TWINS = say(
    "Those like it that collapse: their share, of how many, and in brackets its 95 % interval; from which to "
    "which where some are undecided."
)

#: Words for a spread.
PERCENTILES = say(", 16th / 50th / 84th percentile")


def certainty_sentence(summary: Mapping[str, Any]) -> str:
    """Certainty of the verdict of a run, in one or two sentences."""
    known = summary.get("certainty")
    if not isinstance(known, Mapping):
        return say(
            "How sure this verdict is was not computed: it is that of exactly this geometry, these properties "
            "and this motion, and near collapse small differences decide."
        )
    fell, stood, open_ = (int(known.get(key, 0)) for key in ("collapsed", "stands", "undecided"))
    number, like = fell + stood + open_, str(known.get("like", "columns"))
    if not number:
        none = say("How sure this verdict is, is not known: none of the {like} like this one could be computed.")
        return none.of(like=say(like))
    low, high = summary.get("collapse_interval_low"), summary.get("collapse_interval_high")
    how_many = say("none") if not fell else say("all") if fell == number else str(fell)
    words = say("Of {count} {like} like this one, {fell} collapse")
    sentence = (say("Of {count} {like} like this one, {fell} collapses") if fell == 1 else words).of(
        count=number, like=say(like), fell=how_many
    )
    if low is not None and high is not None:
        sentence += say(
            " ({share}): under this motion and in this model the probability of collapse is {range}, with "
            "{level} confidence",
            share=percents(fell / number, (fell + open_) / number), range=percents(low, high),
            level=percent(known.get("confidence", 0.95)),
        )  # fmt: skip
        if alone := known.get("interval_of_columns"):
            sentence += say(" ({alone} if the law of its joints were known)", alone=percents(*alone))
    texts = [sentence + "."]
    if open_:
        both = say("{count} of them had not come to rest and are counted both ways.")
        texts.append(
            (say("1 of them had not come to rest and is counted both ways.") if open_ == 1 else both).of(count=open_)
        )
    if known.get("failed"):
        texts.append(say("{count} more could not be computed.", count=known["failed"]))
    return joined(" ", [*texts, beside_them(summary)])


def beside_them(summary: Mapping[str, Any]) -> str:
    """Caveat on a run that is no example of the columns like it; empty where it is one."""
    known = summary.get("certainty")
    if not isinstance(known, Mapping):
        return ""
    limits = tuple(known["interval"]) if known.get("interval") else None
    sentence = set_against(summary, known, float(known.get("confidence") or 0.95), limits)
    return sentence or str(known.get("beside") or "")


def certainty_section(summary: Mapping[str, Any]) -> Section | None:
    """Columns like this one, and their verdicts; None where none were computed."""
    known = summary.get("certainty")
    if not isinstance(known, Mapping):
        return None
    low, high = summary.get("collapse_interval_low"), summary.get("collapse_interval_high")
    like = str(known.get("like", "columns"))
    singular = ONE_OF.get(like, "structure")
    counts = joined(" / ", (str(known.get(name, 0)) for name in ("collapsed", "stands", "undecided", "failed")))
    pairs = [
        (say("{like} computed: collapse / stand / undecided / could not be computed", like=say(like)), counts),
        (say("probability of collapse, estimated"), n.plain(summary.get("collapse_probability"))),
    ]
    if low is not None and high is not None:
        level = say("{level} interval of it, from their number alone", level=percent(known.get("confidence", 0.95)))
        pairs.append((level + (say(" and that of their laws") if "laws" in known else ""), percents(low, high)))
    if alone := known.get("interval_of_columns"):
        pairs.append(
            (say("the same if the law of its joints were known; {known[laws]} laws", known=known), percents(*alone))
        )
    if laws := summary.get("under_other_laws"):
        pairs.append((say("under other laws"), laws))
    for measure in SPREAD:
        if measure.of == JOINT:  # slips have a table of their own
            continue
        key, unit = measure.key, "" if measure.unit == "m" else f" [{measure.unit}]"
        words = measure.phrase + unit + PERCENTILES
        spread = known.get(key)
        if isinstance(spread, list):
            shown = [
                say("collapse") if value is None else n.length(value) if key.endswith("_m") else digits(value, ".4f")
                for value in spread
            ]
            own = None if summary.get("collapsed") else summary.get(key)
            far = n.length(own) if key.endswith("_m") else digits(own or 0.0, ".4f")
            here = "" if own is None else say("; this run {value}", value=far)
            pairs.append((words, joined(" / ", shown) + here))
    scatter = known.get("scatter") or {}
    parts = PARTS.get(like, {})
    size_of = say("{part}: {size:.3g} %")
    sizes = [
        size_of.of(part=parts.get(key, say(key)), size=100.0 * float(size)) for key, size in scatter.items() if size
    ]
    pairs.append((say("what varies (coefficient of variation)"), joined("\n", sizes) or say("nothing")))
    if known.get("left_out"):
        pairs.append(
            (
                say("does not vary, because the model does not take it"),
                joined(", ", (say(name.replace("_", " ")) for name in known["left_out"])),
            )
        )
    if known.get("offsets_reduced"):
        pairs.append(
            (say("with offsets halved or left out, as stones would overlap"), n.plain(known["offsets_reduced"]))
        )
    pairs.append((say("seed of the random numbers"), n.plain(known.get("seed"))))
    items: list[Item] = [
        say(
            "Nobody knows {one} to the last digit. The same motion was computed for {like} that differ from this one "
            "by as much as a survey leaves open; the share of them that collapses says how far the verdict can be "
            "relied on. It does not say how probable this earthquake is, nor how well the model fits nature.",
            one=singular,
            like=say(like),
        ),
        Facts(pairs),
        *_bodies(known),
    ]
    return Section(say("How sure the verdict is"), items)


def _bodies(known: Mapping[str, Any]) -> list[Item]:
    """Of each body of an assembly that fell or is undecided in some of those like it, in how many, and where it was."""
    bodies = {
        key: body for key, body in (known.get("bodies") or {}).items() if body.get("fell") or body.get("undecided")
    }
    if not bodies:
        return []
    header = [
        say("body"),
        say("fell"),
        say("undecided"),
        say("probability"),
        say("at the end, along x [m]"),
        say("along y [m]"),
        "50 % within [m]",
        "90 % within [m]",
    ]
    rows = [
        [
            name,
            str(body["fell"]),
            str(body["undecided"]),
            percents(body["interval_low"], body["interval_high"]),
            *(digits(body[key], ".2f") for key in ("middle_x_m", "middle_y_m", "region_50_m", "region_90_m")),
        ]
        for name, body in sorted(bodies.items(), key=lambda pair: (-pair[1]["fell"], -pair[1]["undecided"]))
    ]
    seen = only_as_seen(max(sum(body[key] for key in ("fell", "stood", "undecided")) for body in bodies.values()))
    caption = (
        say(
            "Bodies that fell, or are undecided, in some of them: {over}, the median way in plan from where each "
            "stood to where it was when its run ended, and within which distances of that half and 90 % of the runs "
            "left it. Where a body lies in one run is one draw.",
            over=OVER_ALL,
        )
    ) + (say(" {seen:capital}.", seen=seen) if seen else "")
    return [Rows(header, rows, caption, numbers=True)]
