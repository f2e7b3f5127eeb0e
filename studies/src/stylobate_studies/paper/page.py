"""The page of ``stylobate reproduce``: the paper's study, recomputed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path

import numpy as np

from stylobate.constants import g
from stylobate.verdicts import verdict as v
from stylobate.version import __version__
from stylobate_report.page import Item, Picture, Points, Rows, Section, kinds, part, write_html

from .announced import motions_rows
from .cases import AMPLITUDES, BEAM, DEM, DRUMS, DURATION, FREQUENCIES, MONOLITH, Grids
from .company.shares import KINDS, runs_in_words, share_rows, summary
from .doubt import Doubt
from .reading import percent, share
from .sentences import DONE, FAILS, HOLDS, MEANINGS, PARTLY, UNDECIDED, Statement
from .space import space_rows
from .statements import place
from .study import PaperResults

TITLE = "Freestanding ancient columns: the paper's study, recomputed"

#: The columns, for people.
NAMES = {MONOLITH: "monolith", DRUMS: "12 drums"}

#: Sections of pictures on the page, with the text above them.
OVERVIEW, DOUBT = "The result in one picture", "How sure is a verdict"
LAWS, HISTORIES, BOUNDARIES = "Moment–rotation laws", "Histories of the thirty cases", "First collapse"
CIRCULAR, PUSHOVER, OPEN = "Circular sections", "Pushover", "Open parameters"
IN_SPACE, COMPANY = "Round columns in space", "Columns in company"

OPEN_CHOICES = (
    ("damping", "not printed", "none"),
    ("friction", "not printed", "tan φ = 0.70 (35°)"),
    ("rigid beam: law", "bi- or tri-linear, ξ ≤ 1 not printed", "bi-linear (ξ = 1), in each drum's own rotation and α"),
    ("rigid beam: K_M", "“initial elastic stiffness”, not printed", "k_n J of the joint"),
    ("rigid beam: shape", "prism of mean width", "the same; the true shape in the other models"),
    ("section", "rectangular, 1 m deep", "the same; circular where a figure says so"),
    ("DEM", "UDEC, rigid or deformable blocks", "rigid drums, two contact points per joint"),
    ("collapse", "not defined", "a part of the column has left its support for good"),
)


def write_paper_page(
    path: Path, results: PaperResults, rows: Sequence[Statement], pictures: Mapping[str, Sequence[Picture]]
) -> Path:
    """Write the page.

    Parameters
    ----------
    path : path
    results : PaperResults
    rows : sequence of Statement
    pictures : mapping
        By the section that shows them.
    """
    lead = (
        "Will a freestanding ancient column stand the shaking? Baraldi, Sarhosis and Milani (Numerical models for "
        "simulating the dynamic behaviour of freestanding ancient columns) asked it of two columns of 5 m, one in "
        "one piece and one of twelve drums, under harmonic motion, with three models. This page computes their study "
        f"again and lays it beside what they print. stylobate {__version__}, {'coarse' if results.quick else 'fine'} "
        f"grids, {results.runs} time histories.",
        Points(in_short(results, rows)),
        f"Look first at “{OVERVIEW}”, then at the rows of “What holds” that do not hold or hold in part, "
        f"and at “{DOUBT}” before relying on any single verdict.",
    )
    table = Rows(
        ("the paper says", "computed here", "verdict", "why, and how far open parameters move it"),
        [
            (
                f"{place(r.section)}: {r.sentence}",
                r.ours,
                str(r.verdict),
                "\n".join(filter(None, (r.why, r.sensitivity))),
            )
            for r in rows
        ],
        mark=2,
        looks={HOLDS: "good", PARTLY: "fair", FAILS: "bad", UNDECIDED: "fair", DONE: "good"},
    )
    models = Points(
        (
            "Rigid beam (paper): a chain of rigid beams with a moment–rotation law at each joint; no sliding, no "
            "loss at impact.",
            "Rigid beam with sliding: the paper's announced next step; true shape of the drums, gravity in the equations.",
            "Rigid block: rigid blocks with one elastic–plastic interface per joint; the paper uses it for pushover only.",
            "Distinct elements (DEM): rigid drums on frictional contacts, stepped explicitly; the paper uses UDEC.",
        )
    )
    sections = [
        Section(OVERVIEW, [*pictures[OVERVIEW], models]),
        Section("What holds", [Points([f"{verdict}: {text}." for verdict, text in MEANINGS.items()]), table]),
        Section(DOUBT, [*DOUBT_TEXT, *pictures[DOUBT], doubt_rows(results)]),
        Section("What was chosen", ["Where the paper leaves something open:", chosen(results.grids)]),
        *(Section(heading, pictures[heading]) for heading in (HISTORIES, BOUNDARIES, CIRCULAR)),
        Section(IN_SPACE, [*SPACE_TEXT, *pictures[IN_SPACE], space_table(results)]),
        *_records_sections(results, pictures),
        *(Section(heading, pictures[heading]) for heading in (LAWS, PUSHOVER, OPEN)),
        Section("Domains in numbers", [domain_rows(results)]),
        Section("Files beside this page", [FILES]),
    ]
    return write_page(path, TITLE, lead, sections)


def _records_sections(results: PaperResults, pictures: Mapping[str, Sequence[Picture]]) -> list[Section]:
    """Columns under real motions, and in company; none of the coarse study."""
    if results.motions is None or results.company is None:
        return []
    header, body = motions_rows(results.motions)
    made = summary(results.company)
    tables = [Rows(*share_rows(made, kind), numbers=True) for kind in KINDS]
    return [
        Section("Real motions", [Rows(header, [(NAMES[name], *rest) for name, *rest in body], numbers=True)]),
        Section(COMPANY, [*pictures[COMPANY], *tables, runs_in_words(made), made["doubt"]]),
    ]


DOUBT_TEXT = (
    "Near the boundary a single run is a coin toss. The part of the domain where that matters was computed by "
    "distinct elements as it is, again with half of the time step, and again for columns whose drums, friction and "
    "joint stiffness differ by up to 1 %, which no survey can exclude.",
    "Read a verdict there as a probability. Single cells, islands and the exact place of the boundary mean little; "
    "counts, and what all variations agree on, can be relied on.",
)

SPACE_TEXT = (
    "A round column that is shaken in a plane does not stay in it: it runs round its rim instead of striking its other "
    "edge. "
    "Distinct elements with round drums were computed three times for the same columns and motions: in the plane, in space "
    "but held in the plane, and free in space. Stones, friction and stiffness vary within 1 %, and up to 1 % of the shaking "
    "goes across.",
    "Where the first two maps differ, the law of contact does it (two corners against a rim); where the last two differ, it "
    "is the third dimension.",
)

FILES = Points(
    (
        "figures: every picture as PNG and SVG.",
        "tables: cases.csv (the thirty cases), domains.csv, statements.csv, and certainty.csv.",
        "data: each domain as netCDF and CSV, the histories as netCDF, the pushover curves as CSV.",
        "statements.md: the table of sentences, in Markdown.",
    )
)


def in_short(results: PaperResults, rows: Sequence[Statement]) -> list[str]:
    """Summary for a reader in a hurry."""
    count = Counter(row.verdict.kind for row in rows)
    failed = "; ".join(row.sentence.rstrip(".") for row in rows if row.verdict.kind == FAILS)
    shares = {
        (name, label): percent(share(results.domains[name, label, "rectangular"]))
        for name, label in product(NAMES, (BEAM, DEM))
    }
    return [
        f"Of {len(rows)} sentences, equations and figures of the paper {count[HOLDS]} hold, {count[PARTLY]} hold in part, "
        f"{count[FAILS]} do not hold"
        + (f" ({failed})" if failed else "")
        + f"; undecided: {count[UNDECIDED]}; drawn or announced by it and done here: {count[DONE]}.",
        "Which column is the safer one depends on the model. Rigid beam: the monolith collapses in "
        f"{shares[MONOLITH, BEAM]} of all cells, the drums in {shares[DRUMS, BEAM]}. Distinct elements: "
        f"{shares[MONOLITH, DEM]} and {shares[DRUMS, DEM]}.",
        "Near the boundary verdicts are uncertain: columns that differ by 1 % disagree in "
        + ", ".join(
            f"{percent(doubt.uncertain)} of the cells looked at ({NAMES[name]})"
            for name, doubt in results.doubts.items()
        )
        + ".",
    ]


def chosen(grids: Grids) -> Rows:
    """Points that the paper leaves open, and the choices made here."""
    f = ", ".join(f"{frequency:g}" for frequency in FREQUENCIES)
    a = ", ".join(f"{amplitude / g:g}" for amplitude in AMPLITUDES)
    fine = (
        f"{len(grids.frequencies)} frequencies from {grids.frequencies[0]:g} to {grids.frequencies[-1]:g} Hz, "
        f"{len(grids.amplitudes)} amplitudes from {grids.amplitudes[0] / g:g} to {grids.amplitudes[-1] / g:g} g"
    )
    body = [
        ("the thirty cases", "0.66 to 4 Hz and 0.1 g to 0.5 g; values not printed", f"{f} Hz; {a} g"),
        ("domains", "grid not printed", f"{fine}; “unsafe share” is the part of these cells that collapses"),
        ("motion", "harmonic; length, phase, integration not printed", f"a sin 2πft from rest, {DURATION:g} s"),
        (
            "after the motion",
            "not printed",
            f"followed for {grids.tail:g} s more. The shaking ends abruptly, and some columns fall only then: they "
            "count as collapsed, and are counted apart below",
        ),
        *OPEN_CHOICES,
    ]
    return Rows(("what", "in the paper", "here"), body)


def doubt_rows(results: PaperResults) -> Rows:
    """Reliability of verdicts, in numbers."""
    columns = [_doubt_column(doubt) for doubt in results.doubts.values()]
    body = [(what, *(column[what] for column in columns)) for what in columns[0]]
    return Rows(("distinct elements", *(NAMES[name] for name in results.doubts)), body, numbers=True)


def _doubt_column(doubt: Doubt) -> dict[str, str]:
    s, step, cells = doubt.population.summary(), doubt.steps.summary(), doubt.differing.size
    seen = s["band_width_median_g"] is not None
    return {
        "cells looked at": str(cells),
        "verdicts changed by half of the time step": f"{step['differing']} ({percent(step['differing'] / cells)})",
        "verdicts changed by stones that differ by 1 %": f"{doubt.differing.sum()} ({percent(doubt.differing.mean())})",
        f"cells in which all of {s['replicates']} such columns stand": str(s["all_stand"]),
        "some collapse: the uncertain cells": f"{s['some_collapse']} ({percent(doubt.uncertain)})",
        "all collapse": str(s["all_collapse"]),
        "no verdict": str(s["no_verdict"]),
        "width of the uncertain band, from the lowest amplitude at which any collapses to the highest at which any does not "
        "(median of the frequencies at which both are seen)": (
            f"{s['band_width_median_g']:.2f} g, up to {s['band_width_largest_g']:.2f} g" if seen else "–"
        ),
        "frequencies at which some stand even at the largest amplitude": (
            f"{s['band_open_frequencies']} of {len(doubt.population.frequencies)}"
        ),
    }


def space_table(results: PaperResults) -> Rows:
    """Round columns in the plane, against space."""
    header, body = space_rows(results)
    note = "A cell counts as standing or falling in the plane where all variations agree."
    return Rows(header, [(NAMES[name], *rest) for name, *rest in body], note, numbers=True)


def domain_rows(results: PaperResults) -> Rows:
    """Counts and first collapses of all domains."""
    body = []
    for (name, label, section), domain in results.domains.items():
        first = domain.first_collapse / g
        at_one_hertz = float(np.interp(1.0, domain.frequencies, np.nan_to_num(first, nan=np.inf)))
        counts, late = domain.counts, int((domain.grid("collapse_time_s") > DURATION).sum())
        body.append(
            (
                NAMES[name], label, section, str(len(domain.rows)), str(counts[v.COLLAPSED]), str(late),
                str(counts[v.STANDS]), str(counts[v.UNDECIDED]), str(counts[v.FAILED]),
                f"{np.nanmin(first):.3f}" if np.isfinite(first).any() else "–",
                f"{at_one_hertz:.2f}" if np.isfinite(at_one_hertz) else "–",
            )
        )  # fmt: skip
    header = (
        "column",
        "model",
        "section",
        "cells",
        "collapsed",
        "of these, after the shaking",
        "stands",
        "undecided",
        "failed",
        "smallest collapse [g]",
        "at 1 Hz [g]",
    )
    return Rows(header, body, "Undecided and failed runs are no collapse.", numbers=True)


def case_rows(results: PaperResults) -> list[dict]:
    """The thirty cases of each column and model as rows of a table."""
    rows = []
    for (name, label), data in results.histories.items():
        frequencies, amplitudes = data["frequency"].values, data["amplitude"].values
        for i, j in product(range(len(frequencies)), range(len(amplitudes))):
            case = data.isel(frequency=i, amplitude=j)
            rows.append(
                {
                    "column": name,
                    "model": label,
                    "frequency_hz": float(frequencies[i]),
                    "amplitude_g": float(amplitudes[j] / g),
                    "verdict": v.VERDICTS[int(case["verdict"])],
                    "collapse_time_s": float(case["collapse_time"]),
                    "peak_top_displacement_m": float(case["peak_top"]),
                    "peak_base_displacement_m": float(case["peak_base"]),
                }
            )
    return rows


def write_page(path: Path, title: str, lead: Sequence[Item], sections: Sequence[Section]) -> Path:
    """Write the page, whole or not at all.

    Parameters
    ----------
    path : path
        The HTML file.
    title : str
    lead : sequence of Item
        At the top.
    sections : sequence of Section
    """
    parts = [part(section) for section in sections]
    return write_html(path, Path(__file__).with_name("page.html"), title=title, lead=kinds(lead), sections=parts)
