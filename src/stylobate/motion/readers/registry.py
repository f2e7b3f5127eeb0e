"""Records of any known format by their path, and many of them at once."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from numbers import Real
from pathlib import Path

from ...added import RECORDS, entries, missing
from ...errors import InputError, check_all, check_kind, warn
from ...messages import joined, say
from ...text_tables import printable
from ..events import recorded_again
from ..motion import Motion
from . import columns as columns_of_text
from .record import OWN_FACTS, Component, UnstatedError, assemble, check_whole
from .source import PREFIX, Source


@dataclass(frozen=True)
class Format:
    """A format of record files.

    Parameters
    ----------
    name : str
    recognises : callable
        Whether a file's content is of this format.
    read : callable
        Its components and metadata, of the file and of those files that describe the station.
    text : bool
        It is text, of which no line may be missing.
    describes : callable, optional
        Whether a file's content describes the station of a record of this format, and is no record.
    """

    name: str
    recognises: Callable[[Source], bool]
    read: Callable[[Source, Sequence[Source]], tuple[list[Component], dict]]
    text: bool = True
    describes: Callable[[Source], bool] | None = None


@cache
def formats() -> tuple[Format, ...]:
    """Formats that state unit and step themselves, of the packages that are installed: the entry point group
    ``stylobate.records``, whose entries are sequences of :class:`Format`. Columns of text are what none of them recognises.
    """
    return tuple(file_format for entry in entries(RECORDS).values() for file_format in entry.load())


#: First words of files of networks that hold something else than a record, what that is, and what to give.
NOT_READ = (
    (
        re.compile(r"\s*corrected accelerogram"),
        "is a corrected accelerogram, which this network gives with velocity and displacement (volume 2 of USC), and is not "
        "read; give the uncorrected one of the same record (volume 1, which begins FILE … OF UNCORRECTED ACCELEROGRAM DATA "
        "OF VOLUME I), or its accelerations as columns under a header such as time_s,ax_g",
    ),
    (
        re.compile(r"\s*(?:volume\s+(?:iii|3)\b|[^\n]{0,60}\b(?:response|fourier)\b[^\n]{0,40}\bspectr)"),
        "holds spectra (volume 3 of CSMIP, USC and others), and no record; give the accelerogram of the same record "
        "(volume 2, or 1)",
    ),
)


def read_motion(
    path: str | Path | Sequence[str | Path],
    unit: str | None = None,
    dt: float | None = None,
    *,
    columns: str | None = None,
    component: str | int | None = None,
) -> Motion:
    """Read a recorded motion from a file of any format that is known here.

    Parameters
    ----------
    path : path, or sequence of paths
        One file, or the files of the components of one record (and of the StationXML that belongs to miniSEED);
        ``sample:NAME`` is a record that comes with the package.
    unit : str, optional
        Unit of a file that states none: ``g``, ``m/s2``, ``gal``, ``mm/s2`` …
    dt : float, optional
        Step of a file that has no time column, or the step to resample unequal steps to [s].
    columns : str, optional
        What each column of a text file holds, where its header is not ours (``time_s,ax_g``): ``t [s], x [g], -, z [g]``,
        with z upward and ``-`` for a column to leave out. One name alone, ``x [g]``, may be a series of several numbers to a
        line.
    component : str or int, optional
        The one component that is to be the horizontal input: its number in the file (from 1), its label or its azimuth.

    Returns
    -------
    Motion
        SI; x and y are the file's first and second horizontal component, z its vertical one, upward positive.
        ``metadata`` holds what the file says, ``processing`` what was done to the samples.

    Raises
    ------
    InputError
        The file cannot be read with certainty: one sentence that names the line, what was expected and what to do.
    """
    paths = check_all("path", path, (str, Path))
    check_kind("unit", unit, str, optional=True)
    check_kind("dt", dt, Real, optional=True)
    check_kind("columns", columns, str, optional=True)
    if columns is not None:
        columns_of_text.parse_columns(columns)
    if not paths:
        raise InputError("no file is given; give the path of a record.")
    components, records = components_of([Source.open(file) for file in paths], unit, dt, columns)
    wanted = None if component is None else str(component)
    return assemble(components, records[0].name, component=wanted, dt=dt)


def components_of(
    sources: Sequence[Source], unit: str | None = None, dt: float | None = None, columns: str | None = None
) -> tuple[list[Component], list[Source]]:
    """Components of the files of a record as they stand there, each with the facts of its file; and these files.

    Parameters
    ----------
    sources : sequence of Source
        With those that describe the station of others.
    unit, dt, columns
        As for :func:`read_motion`.

    Raises
    ------
    InputError
        One cannot be read with certainty.
    """
    descriptions = [
        source for source in sources if any(each.describes is not None and each.describes(source) for each in formats())
    ]
    records = [source for source in sources if source not in descriptions]
    if not records:
        raise InputError(f"{sources[0].name} describes a station (StationXML); give the miniSEED files with it.")
    for part, other in combinations(records, 2):
        if part.data == other.data:
            raise InputError(f"{part.name} and {other.name} hold the same bytes; give each component once.", "path")
    defaults = {"station": None, "network": None, "event": None, "start_time": None, "terms": None}
    files = {"file": ", ".join(record.name for record in records)}
    components: list[Component] = []
    for source in records:
        parts, metadata = _read_file(source, descriptions, unit, dt, columns)
        if source.sample is not None:
            metadata = metadata | {key: value for key, value in source.sample.facts.items() if not metadata.get(key)}
        for part in parts:
            part.file = source.name
            own = {key: part.metadata[key] for key in OWN_FACTS if part.metadata.get(key) is not None}
            part.facts = defaults | metadata | own | files
        components += parts
    return components, records


def sample_motion(name: str) -> Motion:
    """A motion that comes with the package, by its name: ``el-centro-1940``.

    Parameters
    ----------
    name : str
        One of the names that ``stylobate motion --samples`` lists.

    Returns
    -------
    Motion
        As ``read_motion("sample:NAME")`` gives it.

    Raises
    ------
    InputError
        There is no sample of this name.
    """
    return read_motion(PREFIX + name)


def _read_file(
    source: Source, descriptions: Sequence[Source], unit: str | None, dt: float | None, columns: str | None
) -> tuple[list[Component], dict]:
    binary = next(
        (file_format for file_format in formats() if not file_format.text and file_format.recognises(source)), None
    )
    if binary is not None:
        return binary.read(source, descriptions)
    if source.is_text:
        check_whole(source.lines, source.ends_with_newline, source.name)
    matches = [file_format for file_format in formats() if file_format.text and file_format.recognises(source)]
    if len(matches) > 1:
        raise InputError(
            f"{source.name} looks like {' and like '.join(match.name for match in matches)}; "
            "convert it to columns under a header such as time_s,ax_g."
        )
    if matches:
        for name, value in (("unit", unit), ("columns", columns)):
            if value is not None:
                raise InputError(
                    f"{source.name} is of format {matches[0].name}, which states its {name}; leave `{name}` out.", name
                )
        components, metadata = matches[0].read(source, descriptions)
        if not components:
            raise InputError(f"{source.name} is of format {matches[0].name} but holds no component; fetch it again.")
        return components, metadata
    if not source.is_text:
        _ = source.lines  # refuses binary files
    if columns_of_text.recognises(source):
        known = source.sample.unit if source.sample is not None else None
        if known is not None and unit is not None:
            raise InputError(f"the sample {source.name} is in {known}, as is known; leave the unit out.", "unit")
        try:
            return columns_of_text.read(source, unit or known, dt, columns)
        except InputError as error:
            if columns is None and (place := _networks()):
                raise InputError(f"{error} {place}", error.field) from None
            other = next((reason for begins, reason in NOT_READ if begins.match(source.head)), None)
            if other is None or columns is not None:
                raise
            raise InputError(f"{source.name} {other}.") from None
    if source.name.lower().endswith(".toml"):
        raise InputError(f"{source.name} is a TOML file, as of a column or a study, and no record; give a record.")
    raise InputError(
        f"{source.name} is in no format that is known here "
        f"({', '.join([*(file_format.name for file_format in formats()), 'columns of text'])}); "
        f"convert it to columns under a header such as time_s,ax_g. {_networks()}".rstrip()
    )


def _networks() -> str:
    """Which package reads the files of networks, where it is not installed."""
    return "" if formats() else f"Files of networks are read by {missing('records', 'networks')}"


# -- Many records at once ---------------------------------------------------------------------------------------------


#: Largest number of files looked into.
MAX_FILES = 10_000

#: Most records that a warning names.
MOST_NAMED = 3


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
            refused[printable(path.name)] = str(error)
            continue
        if motion.digest in names:
            refused[printable(path.name)] = say(
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
        given = " and ".join(map(printable, where))
        raise InputError(
            f"{given} {'hold' if len(where) > 1 else 'holds'} no record that can be used; the first reason: {first[1]}"
        )
    again = recorded_again(motions)
    if again:
        pair = say("{one!r} of {other!r}")
        pairs = [pair.of(one=motions[number].name, other=motions[other].name) for number, other in again.items()]
        named = joined(", ", pairs[:MOST_NAMED]) + (", …" if len(pairs) > MOST_NAMED else "")
        words = say(
            "{count} of {all} records are recordings of others once more, scaled, turned, filtered or "
            "written otherwise ({names}): a selection for a target takes each recording once; elsewhere they "
            "count as records of their own, and intervals are narrower than what is known: leave them out."
        )
        warn(words.of(count=len(again), all=len(motions), names=named))
    return Suite(tuple(motions), refused)


def _read(path: Path, unit: str | None, dt: float | None, columns: str | None, component: str | int | None) -> Motion:
    """A file of its own unit, step and columns, or else one with those stated."""
    try:
        return read_motion(path, component=component)
    except UnstatedError:
        if unit is None and dt is None and columns is None:
            raise
        return read_motion(path, unit, dt, columns=columns, component=component)
