"""Docstrings read as the prose that they are: |x| is an absolute value there, and a colon is a colon."""

import re

LITERAL = re.compile(r"(``.*?``)")

#: What napoleon reads as "type: description" where it says "Words: more words".
PROSE = ("property", "attribute", "data")

_kept: dict[str, list[str]] = {}


def escape(app, what, name, thing, options, lines):
    """Escape bars outside literals, which reStructuredText would take for substitutions."""
    lines[:] = [
        "".join(part if part.startswith("``") else part.replace("|", "\\|") for part in LITERAL.split(line))
        for line in lines
    ]
    if what in PROSE:
        _kept[name] = list(lines)


def restore(app, what, name, thing, options, lines):
    """Give prose back as it was before napoleon."""
    if what in PROSE:
        lines[:] = _kept.pop(name)


def setup(app):
    app.connect("autodoc-process-docstring", escape, priority=400)
    app.connect("autodoc-process-docstring", restore, priority=600)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
