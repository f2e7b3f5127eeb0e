"""What other packages add to this one, each by an entry point of its ``pyproject.toml``.

====================== ==================================================================================================
group                  an entry is
====================== ==================================================================================================
``stylobate.commands`` a command of the program under its name: a function whose parameters are those of the command
``stylobate.names``    a public name: ``infer`` becomes ``stylobate.infer``, ``plots.draw_shaking`` becomes
                       ``stylobate.plots.draw_shaking``
``stylobate.records``  formats of record files: a sequence of :class:`stylobate.motion.readers.Format`
``stylobate.devices``  what steps columns instead of threads of the processor: ``gpu`` is a function that returns a
                       :class:`stylobate.models.devices.Device`
``stylobate.schemas``  tables that files follow, for ``stylobate schema``: by the kind of file, ``KIND`` or ``KIND.which``
====================== ==================================================================================================

Anybody's package may have such entries. What the packages of this repository would add is listed here as well, so that
whoever asks for something of a package that is not installed reads where it is.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint, EntryPoints

COMMANDS, NAMES = "stylobate.commands", "stylobate.names"
RECORDS, DEVICES, SCHEMAS = "stylobate.records", "stylobate.devices", "stylobate.schemas"


class Package(NamedTuple):
    """A package of this repository beside the core, and what it adds, by name."""

    name: str
    folder: str
    commands: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    devices: tuple[str, ...] = ()
    records: tuple[str, ...] = ()
    schemas: tuple[str, ...] = ()

    @property
    def is_missing(self) -> str:
        """That it is not installed, and how to install it."""
        return (
            f"{self.name}, which is not installed here; it is the folder {self.folder} of stylobate's source tree, and "
            "'make install' there installs it with all others."
        )


#: Packages of this repository; a test compares them with the entry points that they declare.
PACKAGES = (
    Package("strongmotion", "packages/strongmotion", commands=("fetch",), records=("networks",)),
    Package(
        "stylobate-studies",
        "studies",
        commands=("reproduce", "experiments", "bench", "calibrate"),
        names=("FreeHistory", "calibrate", "plots.draw_calibration", "read_free_history"),
    ),
    Package("stylobate-exchange", "packages/stylobate-exchange", commands=("convert", "export")),
    Package("stylobate-gpu", "packages/stylobate-gpu", devices=("gpu",)),
    Package("stylobate-page", "packages/stylobate-page", commands=("serve",)),
    Package(
        "stylobate-report",
        "packages/stylobate-report",
        commands=("draw", "report"),
        names=("plots.sheets_to_scale",),
        schemas=("project",),
    ),
    Package(
        "stylobate-ruins",
        "packages/stylobate-ruins",
        commands=("infer", "survival"),
        names=(
            "Observed",
            "Outlasted",
            "Prior",
            "Ruin",
            "infer",
            "plots.draw_matches",
            "plots.draw_observations",
            "plots.draw_posterior",
            "plots.draw_survival",
            "plots.draw_weighing",
            "read_ruin",
            "read_sites",
            "survival",
            "weigh",
        ),
        schemas=("ruin",),
    ),
)


def entry_points(group: str) -> EntryPoints:
    """Entry points of a group, of all packages that are installed."""
    from importlib.metadata import entry_points  # takes a fiftieth of a second, which ``import stylobate`` does without

    return entry_points(group=group)


def entries(group: str) -> dict[str, EntryPoint]:
    """Entry points of a group by their names; of two with the same name, the first."""
    entries_by_name: dict[str, EntryPoint] = {}
    for entry in entry_points(group=group):
        entries_by_name.setdefault(entry.name, entry)
    return entries_by_name


def added_commands(taken: Collection[str]) -> dict[str, Callable[..., None]]:
    """Commands of the packages that are installed, by name; one that cannot be had is left out with a warning.

    Parameters
    ----------
    taken : collection of str
        Names that the program has already.
    """
    commands: dict[str, Callable[..., None]] = {}
    for entry in entry_points(group=COMMANDS):
        try:
            if entry.name in taken or entry.name in commands:
                raise ValueError("there is a command of this name already")
            commands[entry.name] = entry.load()
        except Exception as error:  # of somebody else's package, which may raise anything
            print(f"stylobate: warning: the command {_named(entry)} is left out: {error}.", file=sys.stderr)
    return commands


def missing(kind: str, name: str) -> str | None:
    """Which package of this repository has something that is not installed, and how to install it; None if none has it.

    Parameters
    ----------
    kind : str
        ``commands``, ``names``, ``records``, ``devices`` or ``schemas``.
    name : str
    """
    return next((package.is_missing for package in PACKAGES if name in getattr(package, kind)), None)


def public_name(module: str, name: str) -> Any:
    """A public name of a module that a package adds.

    Parameters
    ----------
    module : str
        ``stylobate`` or a module of it.
    name : str

    Raises
    ------
    AttributeError
        No package that is installed has it; the message says which one of this repository would.
    """
    path = f"{module}.{name}".removeprefix("stylobate.")
    if not name.startswith("_"):  # names that Python itself looks for
        entry = entries(NAMES).get(path)
        if entry is not None:
            return entry.load()
        if place := missing("names", path):
            raise AttributeError(f"{module}.{name} is of {place}", name=name)
    raise AttributeError(f"module {module!r} has no attribute {name!r}", name=name)


def public_names(module: str) -> list[str]:
    """Public names of a module that the installed packages add."""
    inside = module.removeprefix("stylobate").removeprefix(".")
    paths = (path.rpartition(".") for path in entries(NAMES))
    return [name for room, _, name in paths if room == inside]


def with_added(module: str, stub: tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]) -> tuple[Any, Any]:
    """``__getattr__`` and ``__dir__`` of a module that has names of its own and names that packages add.

    Parameters
    ----------
    module : str
        Its name.
    stub : tuple
        What ``lazy_loader.attach_stub`` returns for its own names.
    """
    own, _, names = stub

    def get(name: str) -> Any:
        if name == "__all__":
            return [*names, *public_names(module)]
        return own(name) if name in names else public_name(module, name)

    return get, lambda: [*names, *public_names(module)]


def _named(entry: Any) -> str:
    return f"{entry.name} of {entry.dist.name}" if entry.dist is not None else entry.name
