"""The Python reference: one page for each room of the package, and the table of the public names."""

import importlib
import inspect
import pkgutil

import stylobate

#: Rooms in the order of the data's way.
ROOMS = (
    "column",
    "motion",
    "models",
    "simulate",
    "response",
    "campaign",
    "analysis",
    "plots",
    "report",
    "bibliography",
)


def texts(out):
    """The pages of the rooms and the table."""
    return [(out / f"{room}.md", page(room)) for room in ROOMS] + [(out / "public.txt", public())]


def page(room):
    """All modules of a room, each with its public members."""
    package = importlib.import_module(f"stylobate.{room}")
    package = inspect.getmodule(package) if inspect.ismodule(package) else importlib.sys.modules[f"stylobate.{room}"]
    names = [package.__name__]
    if hasattr(package, "__path__"):
        names = [one.name for one in pkgutil.walk_packages(package.__path__, f"{package.__name__}.") if not one.ispkg]
    title = package.__doc__.split("\n")[0].rstrip(".")
    parts = [f"# `stylobate.{room}`\n\n{title}.\n"]
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
            home, first = f"{value.__module__}.{value.__qualname__}", inspect.getdoc(value).split("\n")[0]
            kind = "class" if inspect.isclass(value) else "func"
            rows.append(f"| {{py:{kind}}}`stylobate.{name} <{home}>` | {first} |\n")
        else:
            rows.append(f"| `stylobate.{name}` | {value} |\n")
    return f"| name | |\n| --- | --- |\n{''.join(rows)}"
