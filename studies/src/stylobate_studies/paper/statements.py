"""Sentences of the paper, one by one, beside what this package computes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from .announced import company_statement, motions_statement
from .company.shares import summary
from .conclusions import conclusions
from .drums import drum_statements
from .monolith import monolith_statements
from .others import others_statements
from .reading import MEANINGS, Reader, Statement
from .space import space_statements
from .statics import static_statements
from .study import PaperResults


def statements(results: PaperResults) -> list[Statement]:
    """All checkable sentences by section; values and verdicts from the results."""
    r = Reader(results)
    rows = [
        *monolith_statements(r),
        *static_statements(),
        *drum_statements(r),
        *conclusions(r),
        *space_statements(results),
        *others_statements(results),
        *([] if results.motions is None else [motions_statement(results.motions)]),
        *([] if results.company is None else [company_statement(summary(results.company))]),
    ]
    return sorted(rows, key=lambda row: (not row.section[0].isdigit(), row.section[:3]))


def place(section: str) -> str:
    """Place in the paper, for a reader."""
    return f"§{section}" if section[0].isdigit() else section


def statements_markdown(rows: Sequence[Statement], quick: bool) -> str:
    """The statements as a page in Markdown."""
    count = Counter(row.verdict for row in rows)
    lines = [
        "# The paper, sentence by sentence",
        "",
        "Every checkable sentence of Baraldi, Sarhosis and Milani, in our words, beside what this package computes. "
        f"Written by `stylobate reproduce{' --quick' if quick else ''}`; nothing in it is edited by hand. "
        "Rows with another source than the paper's sections are what others found of columns in space.",
        "",
        *(f"- **{one}** ({count[one]}): {meaning}." for one, meaning in MEANINGS.items()),
        "",
        "| paper | sentence | here | verdict | why | open parameters |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    return "\n".join([*lines, *map(markdown_row, rows)]) + "\n"


def markdown_row(row: Statement) -> str:
    """One line of the table."""
    cells = (place(row.section), row.sentence, row.ours, f"**{row.verdict}**", row.why, row.sensitivity)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
