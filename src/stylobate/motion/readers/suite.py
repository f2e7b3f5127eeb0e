"""Many records at once: a folder, or a list of files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...errors import InputError, check_all, warn
from ...messages import say
from ...reading import shown
from ..motion import Motion
from ..recordings import recorded_again
from .component import UnstatedError
from .registry import read_motion

#: Largest number of files looked into.
MAX_FILES = 10_000

#: Most records that a warning names.
TOLD = 3


@dataclass(frozen=True)
class Suite:
    """Records that were read, and files that were not; a list of its motions wherever one is wanted.

    Parameters
    ----------
    motions : tuple of Motion
        In the order of the files.
    refused : dict of str to str
        Reason by file name, for files that hold no record that can be used.
    """

    motions: tuple[Motion, ...]
    refused: dict[str, str]

    def __iter__(self) -> Iterator[Motion]:
        return iter(self.motions)

    def __len__(self) -> int:
        return len(self.motions)


def read_suite(
    source: str | Path | Sequence[str | Path],
    unit: str | None = None,
    dt: float | None = None,
    *,
    columns: str | None = None,
    component: str | int | None = None,
) -> Suite:
    """Read all records of a folder, or of a list of files.

    Parameters
    ----------
    source : path, or sequence of paths
        A folder (its files, not those of folders in it), or files.
    unit : str, optional
        Unit of those files that state none.
    dt : float, optional
        Step of those files that have no time column [s].
    columns : str, optional
        Columns of those text files whose header is not ours, as for :func:`read_motion`.
    component : str or int, optional
        The one component of each file that is to be the horizontal input, as for :func:`read_motion`.

    Returns
    -------
    Suite

    Raises
    ------
    InputError
        No such folder, or not one file in it that can be used.

    Warns
    -----
    OutOfRangeWarning
        Some are one recording in several files, by the shapes of their spectra.
    """
    folder = Path(source) if isinstance(source, (str, Path)) else None
    if folder is not None:
        if not folder.is_dir():
            raise InputError(f"{folder} is not a folder; give a folder of records, or a list of files.")
        paths = sorted(path for path in folder.iterdir() if path.is_file() and not path.name.startswith("."))
    else:
        paths = [Path(path) for path in check_all("source", source, (str, Path))]
        if not paths:
            raise InputError("source is an empty list; give a folder of records, or a list of files.", "source")
    if len(paths) > MAX_FILES:
        raise InputError(f"{len(paths)} files are given; allowed is up to {MAX_FILES}: split the suite.")
    motions, refused = [], {}
    names: dict[str, str] = {}  # by digests; intervals are over records, and one that is there twice is one
    for path in paths:
        try:
            motion = _read(path, unit, dt, columns, component)
        except InputError as error:
            refused[shown(path.name)] = str(error)
            continue
        if motion.digest in names:
            refused[shown(path.name)] = say(
                "it holds the motion of {names!r} once more; a record counts once", names=names[motion.digest]
            )
        elif motion.name in names.values():
            raise InputError(f"two records are called {motion.name!r}; results go by names: rename one of the files.")
        else:
            names[motion.digest] = motion.name
            motions.append(motion)
    if not motions:
        first = next(iter(refused.items()), ("", "it is empty"))
        where = [folder] if folder is not None else [*paths[:3], *["other files"] * (len(paths) > 3)]
        given = " and ".join(map(shown, where))
        raise InputError(
            f"{given} {'hold' if len(where) > 1 else 'holds'} no record that can be used; the first reason: {first[1]}"
        )
    again = recorded_again(motions)
    if again:
        pairs = [f"{motions[one].name!r} of {motions[other].name!r}" for one, other in again.items()]
        named = ", ".join(pairs[:TOLD]) + (", …" if len(pairs) > TOLD else "")
        warn(
            f"{len(again)} of {len(motions)} records are recordings of others once more, scaled, turned, filtered or "
            f"written otherwise ({named}): a selection for a target takes each recording once; elsewhere they count as "
            "records of their own, and intervals are narrower than what is known: leave them out."
        )
    return Suite(tuple(motions), refused)


def _read(path: Path, unit: str | None, dt: float | None, columns: str | None, component: str | int | None) -> Motion:
    """A file of its own unit, step and columns, or else one with those stated."""
    try:
        return read_motion(path, component=component)
    except UnstatedError:
        if unit is None and dt is None and columns is None:
            raise
        return read_motion(path, unit, dt, columns=columns, component=component)
