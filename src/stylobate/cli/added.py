"""Commands that other packages add to the program: the entry point group ``stylobate.commands``."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection
from importlib.metadata import entry_points
from typing import Any

GROUP = "stylobate.commands"

#: Commands of the studies, a package of its own in the source tree.
STUDIES = ("reproduce", "experiments", "bench")


def added_commands(taken: Collection[str]) -> dict[str, Callable[..., None]]:
    """Commands of the packages that are installed, by name; one that cannot be had is left out with a warning.

    Parameters
    ----------
    taken : collection of str
        Names that the program has already.
    """
    found: dict[str, Callable[..., None]] = {}
    for entry in entry_points(group=GROUP):
        try:
            if entry.name in taken or entry.name in found:
                raise ValueError("there is a command of this name already")
            found[entry.name] = entry.load()
        except Exception as error:  # of somebody else's package, which may raise anything
            print(f"stylobate: warning: the command {_named(entry)} is left out: {error}.", file=sys.stderr)
    return found


def missing_command(name: str) -> str:
    """Place of a command of the studies, which are not installed."""
    return (
        f"{name} is a command of stylobate-studies, which is not installed here; it is the folder studies of stylobate's "
        "source tree, and 'make install' there installs both."
    )


def _named(entry: Any) -> str:
    return f"{entry.name} of {entry.dist.name}" if entry.dist is not None else entry.name
