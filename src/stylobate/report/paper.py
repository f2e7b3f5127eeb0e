"""The page of ``stylobate reproduce``: the paper's study, recomputed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path

import numpy as np

from .. import __version__
from ..analysis import verdicts as v
from ..analysis.paper_statements import Statement
from ..analysis.paper_study import AMPLITUDES, DURATION, FREQUENCIES, PaperResults
from ..constants import g
from .page import Picture, Rows, Section, write_page

TITLE = "Freestanding ancient columns: the paper's study, recomputed"

CHOICES = (
    ("the thirty cases", "0.66 to 4 Hz and 0.1 g to 0.5 g; values not printed", None),
    ("motion", "harmonic; length, phase, integration not printed", f"a sin 2πft from rest, {DURATION:g} s"),
    ("friction", "not printed", "tan φ = 0.70 (35°)"),
    ("damping", "not printed", "none"),
    ("rigid beam: law", "bi- or tri-linear, ξ ≤ 1 not printed", "bi-linear (ξ = 1), in each drum's own rotation and α"),
    ("rigid beam: K_M", "“initial elastic stiffness”, not printed", "k_n J of the joint"),
    ("rigid beam: shape", "prism of mean width", "the same; the true shape in the other models"),
    ("section", "rectangular, 1 m deep", "the same; circular in figures that say so"),
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
        By the title of the section that shows them.
    """
    count = Counter(row.verdict for row in rows)
    said = ", ".join(f"{number} {one}" for one, number in sorted(count.items(), key=lambda item: -item[1]))
    lead = (
        f"Baraldi, Sarhosis and Milani, Numerical models for simulating the dynamic behaviour of freestanding ancient "
        f"columns. Recomputed by stylobate {__version__}, {'coarse' if results.quick else 'fine'} grids.",
        f"Of {len(rows)} checkable sentences: {said}.",
    )
    table = Rows(
        ("paper", "what it says", "what is computed here", "verdict", "why", "open parameters"),
        [
            (
                f"§{r.section}" if r.section[0].isdigit() else r.section,
                r.sentence,
                r.ours,
                r.verdict,
                r.why,
                r.sensitivity,
            )
            for r in rows
        ],
        mark=3,
    )
    f = ", ".join(f"{one:g}" for one in FREQUENCIES)
    a = ", ".join(f"{one / g:g}" for one in AMPLITUDES)
    cases = f"{f} Hz; {a} g"
    choices = Rows(("what", "in the paper", "here"), [(what, paper, here or cases) for what, paper, here in CHOICES])
    sections = [
        Section("What holds", ["Values and verdicts are computed from the results on this page.", table]),
        Section("What was chosen", ["Where the paper leaves something open:", choices]),
        *(Section(title, some) for title, some in pictures.items()),
        Section("Domains in numbers", [domain_rows(results)]),
    ]
    return write_page(path, TITLE, lead, sections)


def domain_rows(results: PaperResults) -> Rows:
    """Counts and first collapses of all domains."""
    body = []
    for (name, label, section), domain in results.domains.items():
        first = domain.first_collapse / g
        one = float(np.interp(1.0, domain.frequencies, np.nan_to_num(first, nan=np.inf)))
        counts = domain.counts
        body.append(
            (
                name, label, section, str(len(domain.rows)), str(counts[v.COLLAPSED]), str(counts[v.STANDS]),
                str(counts[v.UNDECIDED]), str(counts[v.FAILED]),
                f"{np.nanmin(first):.3f}" if np.isfinite(first).any() else "–",
                f"{one:.2f}" if np.isfinite(one) else "–",
            )
        )  # fmt: skip
    header = (
        "column",
        "model",
        "section",
        "cells",
        "collapsed",
        "stands",
        "undecided",
        "failed",
        "smallest collapse [g]",
        "at 1 Hz [g]",
    )
    return Rows(header, body, "Undecided and failed runs are no collapse.")


def case_rows(results: PaperResults) -> list[dict]:
    """The thirty cases of each column and model as rows of a table."""
    rows = []
    for (name, label), data in results.histories.items():
        frequencies, amplitudes = data["frequency"].values, data["amplitude"].values
        for i, j in product(range(len(frequencies)), range(len(amplitudes))):
            one = data.isel(frequency=i, amplitude=j)
            rows.append(
                {
                    "column": name,
                    "model": label,
                    "frequency_hz": float(frequencies[i]),
                    "amplitude_g": float(amplitudes[j] / g),
                    "verdict": v.VERDICTS[int(one["verdict"])],
                    "collapse_time_s": float(one["collapse_time"]),
                    "peak_top_displacement_m": float(one["peak_top"]),
                    "peak_base_displacement_m": float(one["peak_base"]),
                }
            )
    return rows
