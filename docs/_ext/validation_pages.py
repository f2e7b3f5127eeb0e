"""Tables and figures of the page on validation, from the cases that the tests run."""

import matplotlib.pyplot as plt
from sphinx.util import logging
from validation.case import KINDS, texts
from validation.cases import CASES
from validation.figures import FIGURES

log = logging.getLogger(__name__)


def computed(out):
    """One text for each kind of evidence: its figures and its table."""
    pages = []
    for kind in KINDS:
        name = kind.replace(" ", "_")
        rows = [row(case) for case in CASES if case.kind == kind]
        head = "| model | what is computed | must be | found | tolerance |\n| --- | --- | --- | --- | --- |\n"
        pictures = "".join(picture(draw, words, out) for draw, words in FIGURES[kind].items())
        pages.append((out / f"validation_{name}.md", f"{head}{''.join(rows)}\n{pictures}"))
    return pages


def row(case):
    """A row of the table; a value that is off is a warning, and so an error of the build."""
    value = case.compute()
    if not case.criterion.holds(value):
        log.warning(
            "validation: %s is %s, must be %s %s",
            case.name,
            texts(value),
            case.criterion.expected,
            case.criterion.tolerance,
        )
    criterion = case.criterion
    tolerance = f"{criterion.tolerance}: {case.reason}" if criterion.tolerance else case.reason
    return (
        f"| {case.model} | {case.quantity} | {criterion.expected}<br>{case.source} | {texts(value)} | {tolerance} |\n"
    )


def picture(draw, words, out):
    """A figure, drawn into a file, and the text that shows it."""
    figure = draw()
    figure.savefig(out / f"{draw.__name__}.png", dpi=150, facecolor="white")
    plt.close("all")
    return f"\n```{{figure}} ../_build/computed/{draw.__name__}.png\n:alt: {words}\n\n{words}\n```\n"
