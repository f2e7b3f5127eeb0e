"""What the site computes when it is built: validation, other codes, models, commands, Python reference, references.

Tables are written as Markdown and figures as PNG into ``docs/_build/computed``, and included by the pages. What takes
time is computed again only when the code is newer.
"""

from pathlib import Path

import api_pages
import command_pages
import model_pages
import nature_pages
import other_codes_pages
import space_pages
import validation_pages
from sphinx.util import logging

log = logging.getLogger(__name__)


def newest(*folders):
    """Time of the last change of any Python file below some folders."""
    return max(file.stat().st_mtime for folder in folders for file in folder.rglob("*.py"))


def compute(app):
    docs = Path(app.srcdir)
    out = docs / "_build" / "computed"
    out.mkdir(parents=True, exist_ok=True)
    generated = api_pages.texts(docs / "api" / "generated")
    stored = other_codes_pages.texts(out) + space_pages.texts(out)
    for text in generated + command_pages.texts(out) + model_pages.texts(out) + stored:
        write(*text)
    stamp = out / "computed"
    if stamp.exists() and stamp.stat().st_mtime > newest(
        docs.parent / "src", docs.parent / "studies", docs.parent / "tests" / "validation", docs / "_ext"
    ):
        return
    log.info("computing the validation cases and the comparison of the models …")
    for text in (
        validation_pages.computed(out)
        + other_codes_pages.computed(out)
        + model_pages.computed(out)
        + nature_pages.computed(out)
    ):
        write(*text)
    stamp.touch()


def write(path, text):
    """Write a file where its text is another: what is the same is not built again."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def setup(app):
    app.connect("builder-inited", compute)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
