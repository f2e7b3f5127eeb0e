"""The Python reference: one page for each room of the package, and the table of the public names."""

import importlib
import inspect
import pkgutil
import re

import stylobate

#: Rooms that a reader of the reference enters; kernels and commands have pages of their own.
ROOMS = [
    *("column", "motion", "models", "simulate", "response"),
    *("campaign", "statics", "vibrations", "verdicts", "codes", "probability", "plots", "bibliography"),
    *("outcome", "errors", "constants"),
]

#: Packages beside the core that a reader of the reference enters.
BESIDE = ["strongmotion", "stylobate_report", "stylobate_ruins", "stylobate_studies.calibration"]

#: A cross-reference in a docstring.
ROLE = re.compile(r":\w+:(`[^`]+`)")


def texts(out):
    """The pages of the rooms and the table."""
    rooms = [(room, f"stylobate.{room}") for room in ROOMS] + [(name, name) for name in BESIDE]
    return [(out / f"{room}.md", page(name)) for room, name in rooms] + [(out / "public.txt", public())]


def page(room):
    """All modules of a room or a package but its commands, each with its public members."""
    package = importlib.import_module(room)
    names = [package.__name__]
    if hasattr(package, "__path__"):
        names = [
            module.name
            for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
            if not module.ispkg
        ]
        names = [name for name in names if ".commands." not in name]
    parts = [f"# `{room}`\n"]
    if len(names) > 1:
        parts.append(f"{first_line(package)}\n")
    for name in names:
        body = f"```{{eval-rst}}\n.. automodule:: {name}\n   :members:\n   :ignore-module-all:\n```\n"
        parts.append(f"## `{name.removeprefix('stylobate.')}`\n\n{body}" if len(names) > 1 else body)
    return "\n".join(parts)


def public():
    """Names of the package itself, each with its first sentence."""
    rows = []
    for name in stylobate.__all__:
        value = getattr(stylobate, name)
        if inspect.isclass(value) or inspect.isfunction(value):
            kind = "class" if inspect.isclass(value) else "func"
            home = f"{value.__module__}.{value.__qualname__}"
            rows.append(f"| {{py:{kind}}}`st.{name} <{home}>` | {first_line(value)} |\n")
        else:
            rows.append(f"| `st.{name}` | {value} |\n")
    return f"| name | |\n| --- | --- |\n{''.join(rows)}"


def first_line(thing):
    """First line of a docstring, without the marks of cross-references."""
    return ROLE.sub(r"\1", inspect.getdoc(thing).split("\n")[0])
