"""States of a column side by side in a report: the advice first, what it rests on, and what the states differ by."""

from __future__ import annotations

from typing import Any

from stylobate.messages import digits, joined, percents, say
from stylobate.motion.intensity import parse_measure
from stylobate.probability.evidence import evidence
from stylobate.probability.fragility import FEWEST
from stylobate.probability.states import INCONCLUSIVE, STRONGER, WEAKER
from stylobate.response.links import YIELDS
from stylobate.results import Numbers
from stylobate.verdicts.limit_states import median_words, shares

from . import numbers as n
from .design import design_items, design_of
from .page import Item, Note, Points, Rows
from .pictures import kept
from .record import headline
from .tables import table

#: Style of the notes on conclusions.
LOOKS = {STRONGER: "", WEAKER: "bad", INCONCLUSIVE: "fair"}


def advice_notes(result: Numbers) -> list[Item]:
    """The advice on every state, which is read before anything else."""
    return [
        Note([headline(result, difference["advice"])], f"verdict {LOOKS[difference['conclusion']]}".rstrip())
        for difference in result.summary["differences"]
    ]


def states_items(result: Numbers) -> list[Item]:
    """The paired results, the counts over the same runs, the picture, and what the links bore."""
    s = result.summary
    verb = say("collapse") if s["state"] == "collapse" else say("exceed {s[state]}", s=s)
    basis = [
        say("“{difference[state]}” against “{difference[against]}”. {difference[basis]}", difference=difference)
        for difference in s["differences"]
    ]
    items: list[Item] = [Points(basis + _at_capacity(s["links"]))]
    share = say("share that collapses") if s["state"] == "collapse" else say("share that exceeds {s[state]}", s=s)
    header = [say("state"), say("same runs"), verb, say("do not"), say("undecided"), share, say("95 % of the share")]
    open_ = any(
        state["fragility"] and state["fragility"]["undecided"] + state["fragility"]["failed"] for state in s["states"]
    )
    header += [say("failed"), say("median intensity (undecided both ways)") if open_ else say("median intensity")]
    body = []
    for state in s["states"]:
        row = [state["label"], *(n.plain(state[key]) for key in ("same_runs", "exceeded", "not_exceeded", "undecided"))]
        body.append(
            [*row, _share(state, "share"), _share(state, "interval"), str(state["failed"]),
             median_words(state["fragility"]) if state["fragility"] else say("no curve")]
        )  # fmt: skip
    caption = say(
        "The same motions and levels for every state, and the same slightly different columns or assemblies "
        "where these are drawn; runs that failed in one of them are left out of all. Undecided: the run ended "
        "before its verdict was certain; share, interval and median are with none and with all of them counted "
        "in; the interval is over records. A pair of runs is undecided where either of them is. Shares are of "
        "all levels together, as many as were asked for: they compare states, and are no probability of collapse."
    )
    if not all(state["fragility"] for state in s["states"]):
        few = say("No curve: all runs of a state end alike, or they are of fewer than {fewest} records.", fewest=FEWEST)
        caption = joined(" ", [caption, few])
    items.append(Rows(header, body, caption, numbers=True))
    items += _by_level(result)
    banded = next((state["label"] for state in s["states"] if state["fragility"]), None)
    curves = say(
        "Left: fragility curves, the band that of “{state}”; two thin ones where runs are undecided: if all "
        "exceeded, and if none did.", state=banded,
    )  # fmt: skip
    right = say(
        "Right: difference of the share, pair by pair; left of zero is better. Thick: undecided runs counted both ways"
    )
    alone = say(
        "Difference of the share, pair by pair; left of zero is better. Thick: undecided runs counted both ways"
    )
    wide = any(difference["records"] >= FEWEST for difference in s["differences"])
    thin = say("; thin: 95 % interval over records") if wide else ""
    texts = [curves, right + thin + "."] if banded else [alone + thin + "."]
    items += kept(result.pictures, "states", joined(" ", texts))
    if s["links"]:
        items.append(_links(s["links"]))
    if best := s.get("best"):
        keys = ("candidate", "share_low", "share_high", "use", "use_high", "difference_low", "difference_high", "alike")
        items.append(table(best["candidates"], keys, best["words"]))
    return items + design_items(design_of(result), result.pictures)


def _at_capacity(links: list[dict[str, Any]]) -> list[str]:
    """Of each state the link that bore its whole capacity in most runs, and the one that broke in most."""
    sentences = []
    for state in dict.fromkeys(link["state"] for link in links):
        mine = [link for link in links if link["state"] == state]
        full, broken = (max(mine, key=lambda link: link.get(key, 0)) for key in ("at_capacity", "broken"))
        if full.get("at_capacity", 0):
            most = say("“{state}”: {f[link]}, most of all, was at its capacity in {f[at_capacity]} of {f[runs]} runs")
            only = say("“{state}”: {f[link]} was at its capacity in {f[at_capacity]} of {f[runs]} runs")
            words = (most if len(mine) > 1 else only).of(state=state, f=full)
            broke = say("; {b[link]} broke in {b[broken]}.", b=broken) if broken["broken"] else say(", and none broke.")
            sentences.append(joined(" ", [words + broke, YIELDS]))
    return sentences


def _share(row: dict[str, Any], name: str) -> str:
    low, high = row.get(f"{name}_low"), row.get(f"{name}_high")
    return n.NONE if low is None or high is None else percents(low, high)


def _by_level(result: Numbers) -> list[Item]:
    table, s = result.tables.get("states"), result.summary
    if table is None:
        return []
    labels = [state["label"] for state in s["states"]]
    size = len(table) // len(labels)  # the runs of one state after those of the other
    each = [table.iloc[k * size : (k + 1) * size] for k in range(len(labels))]
    state_evidence = [evidence(frame, None, s["state"], label) for frame, label in zip(each, labels, strict=True)]
    levels = sorted(set(state_evidence[0].im.tolist()))
    if len(levels) < 2:
        return []
    body = []
    for level in levels:
        level_shares = shares(
            {sample.name: sample.codes[sample.im == level] for sample in state_evidence},
            state_evidence[0].records[state_evidence[0].im == level],
        )
        words = (
            say("{one.words} ({one.interval_words})", one=share) if share.runs else n.NONE for share in level_shares
        )
        body.append([digits(level, ".4g"), str(level_shares[0].runs), *words])
    measure = str(table["measure"].iloc[0])
    level = say("factor") if measure == "factor" else f"{measure} [{parse_measure(measure).unit}]"
    caption = say(
        "Share by level, of the same runs; from which to which where runs are undecided. In brackets its 95 % "
        "interval over records."
    )
    return [Rows([level, say("same runs"), *labels], body, caption, numbers=True)]


def _links(links: list[dict[str, Any]]) -> Rows:
    body = [[n.plain(link.get(key)) for key in BORNE.values()] for link in links[:MOST]]
    first = say("The first {most} of {all}; links.csv holds all.", most=MOST, all=len(links))
    return Rows(list(BORNE), body, joined(" ", [BORE, first if len(links) > MOST else ""]), numbers=True)


#: Columns of the table of links, by heading, and its caption.
BORNE = {
    say("state"): "state", say("link"): "link", say("runs"): "runs", say("broke in"): "broken",
    say("at capacity in"): "at_capacity", say("largest force over capacity"): "largest_over_capacity",
    say("median"): "median_over_capacity", say("limited by"): "limited_by",
}  # fmt: skip
BORE = say(
    "What the links bore; 1: at its capacity, it yields or breaks. The capacity is that of the link in its "
    "stone: of bar, anchor and stone the least, as far as these are known."
)

#: Most rows of a table of links.
MOST = 40
