"""Sentences of the paper, one by one, beside what this package computes."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

from .announced import company_statement, motions_statement
from .cases import DEM, DRUMS
from .company.shares import summary
from .conclusions import conclusions
from .contacts import contacts_statement, time_statement
from .drums import drum_statements
from .equations import equation_statements
from .forces import forces_statement
from .mechanisms import mechanisms_statement, openings
from .monolith import monolith_statements
from .others import others_statements
from .reading import Reader
from .sentences import MEANINGS, Statement, Verdict
from .shown import shown_statements
from .space import space_statements
from .statics import static_statements
from .study import PaperResults


def statements(results: PaperResults) -> list[Statement]:
    """All checkable sentences by section; values and verdicts from the results."""
    r = Reader(results)
    rows = [
        *equation_statements(),
        *shown_statements(r),
        *monolith_statements(r),
        *static_statements(),
        *drum_statements(r),
        *conclusions(r),
        forces_statement(),
        mechanisms_statement(results.mechanisms, openings(r.domain(DRUMS, DEM))),
        time_statement(results.cost),
        *space_statements(results),
        *others_statements(results),
        *([contacts_statement(results.contacts)] if results.contacts else []),
        *([] if results.motions is None else [motions_statement(results.motions)]),
        *([] if results.company is None else [company_statement(summary(results.company))]),
    ]
    return sorted(rows, key=lambda row: order(row.section))


def order(section: str) -> tuple[int, float, int]:
    """Place of a row: the abstract, sections with their paragraphs, other sources."""
    part = re.match(r"(Abstract|\d(?:\.\d)?)(?: ¶(\d))?(?:,|$)", section)
    if part is None:
        return 2, 0.0, 0
    number = 0.0 if part[1] == "Abstract" else float(part[1])
    return int(number > 0.0), number, int(part[2] or 0)


def place(section: str) -> str:
    """Place in the paper, for a reader."""
    return f"§{section}" if section[0].isdigit() else section


def statements_markdown(rows: Sequence[Statement], quick: bool) -> str:
    """The statements as a page in Markdown."""
    count = Counter(row.verdict.kind for row in rows)
    lines = [
        "# The paper, sentence by sentence",
        "",
        "Sentences of Baraldi, Sarhosis and Milani that can be checked, in our words, beside what this package "
        "computes: section and paragraph (¶; text that goes on behind an equation counts as one), with the equations and "
        f"figures that it speaks of. Written by `stylobate reproduce{' --quick' if quick else ''}`; nothing "
        f"in it is edited by hand. "
        "Rows with another source than the paper's sections are what others found of columns in space.",
        "",
        *(f"- **{verdict}** ({count[verdict]}): {meaning}." for verdict, meaning in MEANINGS.items()),
        "",
        "| paper | sentence | here | verdict | why | open parameters |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    return "\n".join([*lines, *map(markdown_row, rows)]) + "\n"


def mark(verdict: Verdict) -> str:
    """The verdict in bold, and for which part it holds."""
    return f"**{verdict.kind}**" + (f": {verdict.part}" if verdict.part else "")


def markdown_row(row: Statement) -> str:
    """One line of the table."""
    cells = (place(row.section), row.sentence, row.ours, mark(row.verdict), row.why, row.sensitivity)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
