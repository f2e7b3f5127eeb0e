"""Docstrings read as the prose that they are: |x| is an absolute value there, and a colon is a colon."""

import inspect
import re

LITERAL = re.compile(r"(``.*?``)")


def escape(app, what, name, thing, options, lines):
    """Escape bars outside literals, which reStructuredText would take for substitutions."""
    lines[:] = [
        "".join(part if part.startswith("``") else part.replace("|", "\\|") for part in LITERAL.split(line))
        for line in lines
    ]


def restore(app, what, name, thing, options, lines):
    """Take back what napoleon makes of "Words: more words" in a property, which it reads as type and description."""
    if what == "property":
        lines[:] = [*inspect.getdoc(thing).split("\n"), ""]
        escape(app, what, name, thing, options, lines)


def setup(app):
    app.connect("autodoc-process-docstring", escape, priority=400)
    app.connect("autodoc-process-docstring", restore, priority=600)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
