"""States of a column side by side in a report: the advice first, what it rests on, and what the states differ by."""

from __future__ import annotations

from typing import Any

from stylobate.analysis.difference import NOT_TOLD, STRONGER, WEAKER
from stylobate.analysis.evidence import evidence
from stylobate.analysis.fragility_checks import FEWEST
from stylobate.analysis.side_by_side import median_name, median_words, shares
from stylobate.motion.intensity_specs import parse_measure
from stylobate.percent import percents
from stylobate.response.links import YIELDS
from stylobate.results import Numbers

from . import numbers as n
from .design import design_items, design_of
from .page import Item, Note, Points, Rows
from .pictures import kept
from .tables import table

#: Style of the notes on conclusions.
LOOKS = {STRONGER: "", WEAKER: "bad", NOT_TOLD: "fair"}


def advice_notes(result: Numbers) -> list[Item]:
    """The advice on every state, which is read before anything else."""
    found = [(difference["advice"], LOOKS[difference["conclusion"]]) for difference in result.summary["differences"]]
    if result.summary["doubt"]:
        found.insert(0, (result.summary["doubt"], LOOKS[NOT_TOLD]))
    return [Note([advice], f"verdict {look}".rstrip()) for advice, look in found]


def states_items(result: Numbers) -> list[Item]:
    """The paired results, the counts over the same runs, the picture, and what the links bore."""
    s = result.summary
    verb = "collapse" if s["state"] == "collapse" else f"exceed {s['state']}"
    basis = [
        f"“{difference['state']}” against “{difference['against']}”. {difference['basis']}"
        for difference in s["differences"]
    ]
    items: list[Item] = [Points(basis + _at_capacity(s["links"]))]
    shown = verb.replace("collapse", "collapses").replace("exceed ", "exceeds ")
    header = ["state", "same runs", verb, "do not", "undecided", f"share that {shown}", "95 % of the share", "failed"]
    header.append(
        median_name(*(state["fragility"] or None for state in s["states"])).replace("median", "median intensity")
    )
    body = []
    for state in s["states"]:
        row = [state["label"], *(n.plain(state[key]) for key in ("same_runs", "exceeded", "not_exceeded", "undecided"))]
        body.append(
            [*row, _share(state, "share"), _share(state, "interval"), str(state["failed"]),
             median_words(state["fragility"]) if state["fragility"] else "no curve"]
        )  # fmt: skip
    caption = (
        "The same motions and levels for every state, and the same slightly different columns or assemblies where these "
        "are drawn; runs that failed in one of them are left out of all. Undecided: the run ended before its verdict was "
        "certain; share, interval and median are with none and with all of them counted in; the interval is over records. "
        "A pair of runs is undecided where either of them is. Shares are of all levels together, as many as were asked for: "
        "they compare states, and are no probability of collapse."
    )
    if not all(state["fragility"] for state in s["states"]):
        caption += f" No curve: all runs of a state end alike, or they are of fewer than {FEWEST} records."
    items.append(Rows(header, body, caption, numbers=True))
    items += _by_level(result)
    banded = next((state["label"] for state in s["states"] if state["fragility"]), None)
    band = "" if banded is None else f", the band that of “{banded}”"
    left = f"Left: fragility curves{band}; two thin ones where runs are undecided: if all exceeded, and if none did. "
    right = f"{'Right: difference' if banded else 'Difference'} of the share, pair by pair; left of zero is better. "
    right += "Thick: undecided runs counted both ways"
    wide = any(difference["records"] >= FEWEST for difference in s["differences"])
    items += kept(
        result.pictures,
        "states",
        f"{left if banded else ''}{right}{'; thin: 95 % interval over records' if wide else ''}.",
    )
    if s["links"]:
        items.append(_links(s["links"]))
    if best := s.get("best"):
        keys = ("candidate", "share_low", "share_high", "use", "use_high", "difference_low", "difference_high", "alike")
        items.append(table(best["candidates"], keys, best["words"]))
    return items + design_items(design_of(result), result.pictures)


def _at_capacity(links: list[dict[str, Any]]) -> list[str]:
    """Of each state the link that bore its whole capacity in most runs, and the one that broke in most."""
    said = []
    for state in dict.fromkeys(link["state"] for link in links):
        mine = [link for link in links if link["state"] == state]
        full, broken = (max(mine, key=lambda one: one.get(key, 0)) for key in ("at_capacity", "broken"))
        if full.get("at_capacity", 0):
            words = f"“{state}”: {full['link']}{', most of all,' * (len(mine) > 1)} was at its capacity in "
            words += f"{full['at_capacity']} of {full['runs']} runs"
            words += f"; {broken['link']} broke in {broken['broken']}" if broken["broken"] else ", and none broke"
            said.append(f"{words}. {YIELDS}")
    return said


def _share(one: dict[str, Any], name: str) -> str:
    low, high = one.get(f"{name}_low"), one.get(f"{name}_high")
    return n.NONE if low is None or high is None else percents(low, high)


def _by_level(result: Numbers) -> list[Item]:
    table, s = result.tables.get("states"), result.summary
    if table is None:
        return []
    labels = [state["label"] for state in s["states"]]
    size = len(table) // len(labels)  # the runs of one state after those of the other
    each = [table.iloc[k * size : (k + 1) * size] for k in range(len(labels))]
    told = [evidence(one, None, s["state"], label) for one, label in zip(each, labels, strict=True)]
    levels = sorted(set(told[0].im.tolist()))
    if len(levels) < 2:
        return []
    body = []
    for level in levels:
        found = shares({one.name: one.codes[one.im == level] for one in told}, told[0].records[told[0].im == level])
        words = (f"{one.words} ({one.interval_words})" if one.runs else n.NONE for one in found)
        body.append([f"{level:.4g}", str(found[0].runs), *words])
    measure = str(table["measure"].iloc[0])
    unit = f" [{parse_measure(measure).unit}]" if measure != "factor" else ""
    caption = (
        "Share by level, of the same runs; from which to which where runs are undecided. In brackets its 95 % interval over "
        "records."
    )
    return [Rows([f"{measure}{unit}", "same runs", *labels], body, caption, numbers=True)]


def _links(links: list[dict[str, Any]]) -> Rows:
    body = [[n.plain(link.get(key)) for key in BORNE.values()] for link in links[:MOST]]
    left_out = f" The first {MOST} of {len(links)}; links.csv holds all." if len(links) > MOST else ""
    return Rows(list(BORNE), body, BORE + left_out, numbers=True)


#: Columns of the table of links, by heading, and its caption.
BORNE = {
    "state": "state", "link": "link", "runs": "runs", "broke in": "broken", "at capacity in": "at_capacity",
    "largest force over capacity": "largest_over_capacity", "median": "median_over_capacity", "limited by": "limited_by",
}  # fmt: skip
BORE = (
    "What the links bore; 1: at its capacity, it yields or breaks. The capacity is that of the link in its stone: of bar, "
    "anchor and stone the least, as far as these are known."
)

#: Most rows of a table of links.
MOST = 40
