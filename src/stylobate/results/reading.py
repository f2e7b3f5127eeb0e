"""Reads folders of results: what a folder holds is told by the files that commands leave there."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..atomic import LIST, OwnFiles, digest
from ..campaign.cases import PLAN_FILE
from ..campaign.ledger import FORMER_FILES, RUNS_FILE, refuse_former
from ..column import Column
from ..column.structure import Structure
from ..errors import InputError, OutOfRangeWarning
from ..motion import Motion
from ..motion.readers import read_motion
from ..probability.studies import StudyResult
from ..response import Response, load_response
from ..text_tables import check_file, printable
from ..verdicts.domain import CollapseProbability, Domain
from .command_request import CommandRequest, read_json, request_file_name

if TYPE_CHECKING:
    import pandas


class Kind(Enum):
    """The kinds, by the command that makes them; ``states`` are those that ``compare`` sets side by side."""

    RUN = "run"
    RUNS = "runs"
    CRITICAL = "critical"
    DOMAIN = "domain"
    PROBABILITY = "probability"
    PUSHOVER = "pushover"
    LIMIT = "limit"
    MODES = "modes"
    COMPARE = "compare"
    STATES = "states"
    SUITE = "suite"
    IDA = "ida"
    FRAGILITY = "fragility"
    RISK = "risk"
    SURVIVAL = "survival"
    INFER = "infer"
    UNTIL_FALL = "sequence"
    STUDY = "study"
    RECORDS = "records"
    CALIBRATE = "calibrate"


@dataclass(frozen=True)
class FileFact:
    """A file of a result.

    Parameters
    ----------
    name : str
        In the folder.
    digest : str
        SHA-256 of what it holds now.
    unchanged : bool or None
        Whether that is what stylobate wrote; None where the folder has no list that tells.
    """

    name: str
    digest: str
    unchanged: bool | None


@dataclass(frozen=True, eq=False)
class Result:
    """A result: what it is, where it lies, and what was asked.

    Parameters
    ----------
    kind : Kind
    folder : Path
    request : CommandRequest or None
        None in folders of versions that did not keep it.
    files : tuple of FileFact
        Those that belong to it.
    summary : dict
        The JSON object of its command.
    """

    kind: Kind
    folder: Path
    request: CommandRequest | None
    files: tuple[FileFact, ...]
    summary: dict[str, Any]

    @property
    def structures(self) -> Sequence[Structure]:
        """Subject, as far as the folder tells."""
        return [] if self.request is None else self.request.stood

    @property
    def name(self) -> str:
        """Of what stood; the folder's where that is not known."""
        return ", ".join(dict.fromkeys(structure.name for structure in self.structures)) or self.folder.name

    @property
    def pictures(self) -> dict[str, Path]:
        """Pictures (PNG) as stylobate wrote them, by their names; one that was changed since is left out."""
        named = [file for file in self.files if file.name.endswith(".png") and file.unchanged is not False]
        return {Path(picture.name).stem: self.folder / picture.name for picture in named}


@dataclass(frozen=True, eq=False)
class RunResult(Result):
    """One run of a column or an assembly.

    Parameters
    ----------
    response : Response
    motion : Motion or None
        What acted, all of it; None in folders of versions that did not keep it.
    replicates : pandas.DataFrame or None
        Columns like this one, a row each.
    """

    response: Response
    motion: Motion | None = None
    replicates: pandas.DataFrame | None = None

    @property
    def structures(self) -> Sequence[Structure]:
        """Structure."""
        return [self.response.structure]


@dataclass(frozen=True, eq=False)
class SeveralRuns(Result):
    """Runs of one column under several motions, each in a folder of its own; in the order of their names."""

    runs: tuple[RunResult, ...] = ()

    @property
    def structures(self) -> Sequence[Structure]:
        """Structure."""
        return [self.runs[0].response.structure]


@dataclass(frozen=True, eq=False)
class Grid(Result):
    """A domain over frequency and amplitude, or probabilities over it."""

    data: Domain | CollapseProbability

    @property
    def structures(self) -> Sequence[Column]:
        """Structure."""
        return [self.data.column]


@dataclass(frozen=True, eq=False)
class Comparison(Result):
    """Several models side by side, under one motion or over one domain."""

    table: pandas.DataFrame
    responses: dict[str, Response] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Numbers(Result):
    """A result that is its JSON object, tables and pictures.

    Parameters
    ----------
    tables : dict of str to pandas.DataFrame
        By the names of their files without ending.
    """

    tables: dict[str, pandas.DataFrame] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class StudyFolder(Result):
    """A study as far as it is.

    Parameters
    ----------
    study : StudyResult
    histories : dict of str to Response
        ``median`` and ``worst``, where they are there.
    """

    study: StudyResult
    histories: dict[str, Response] = field(default_factory=dict)


#: Largest table that is read [bytes].
MOST = 500_000_000

#: Most folders in a folder of runs.
MOST_RUNS = 10_000


class Files(NamedTuple):
    """Files of a kind of result, besides those that are called after the kind.

    ``keys`` that its JSON object must hold: with other ones it was not written by stylobate; ``tables`` beside the object;
    ``further`` files, a picture by its name without an ending.
    """

    keys: tuple[str, ...] = ()
    tables: tuple[str, ...] = ()
    further: tuple[str, ...] = ()


#: Files of each kind.
FILES = {
    Kind.RUN: Files(("outcome", "collapsed", "decided", "energy_imbalance")),
    Kind.RUNS: Files(further=("directions",)),
    Kind.CRITICAL: Files(("runs", "lowest_collapse_g", "sentence"), ("critical",), ("probability", "directions")),
    Kind.DOMAIN: Files(("cells", "collapsed")),
    Kind.PROBABILITY: Files(("cells", "replicates")),
    Kind.LIMIT: Files(("collapse_multiplier_g", "active_joints"), further=("directions",)),
    Kind.MODES: Files(("modes", "solid_modulus_pa", "sentence"), ("drops",), ("column.toml", "scatter.toml")),
    Kind.PUSHOVER: Files(("collapse_multiplier_g", "peaked", "curve")),
    Kind.STATES: Files(
        ("state", "states", "differences", "links", "records", "doubt"), ("states", "design"), ("links.csv", "design")
    ),
    Kind.SUITE: Files(("runs", "verdicts"), ("suite", "design"), ("directions", "design")),
    Kind.IDA: Files(("runs", "records", "capacities"), ("capacities", "fractiles", "measures"), ("measures",)),
    Kind.FRAGILITY: Files(("median", "beta", "im", "state", "sentence")),
    Kind.RISK: Files(("annual_rate", "return_period_y"), ("risk",)),
    Kind.SURVIVAL: Files(("hazards",), ("survival", "hazard")),
    Kind.INFER: Files(
        ("posterior", "accepted", "bayes_factor_no_earthquake"), ("draws", "observations"), ("observations", "matches")
    ),
    Kind.UNTIL_FALL: Files(("until_fall", "motions"), ("until_fall",)),
    Kind.RECORDS: Files(("target_words", "meets", "records", "sentence")),
    Kind.CALIBRATE: Files(
        ("stiffness_damping", "decrements", "reached", "sentence"), further=("losses.toml", "calibration")
    ),
}


def read_results(folders: Iterable[str | Path]) -> list[Result]:
    """Everything that folders of results hold, in the order given, each folder once.

    Raises
    ------
    InputError
        A folder is missing, empty, or holds no result of this package; or a result that is damaged or of a later version.
    """
    places: dict[Path, str | Path] = {}
    for folder in folders:
        places.setdefault(Path(folder).resolve(), folder)
    results = [result for folder in places.values() for result in read_folder(folder)]
    if not results:
        raise InputError("no folder of results is given; give one in which a command wrote its files.")
    return results


def read_folder(folder: str | Path) -> list[Result]:
    """Everything that one folder holds: usually one result, several where commands wrote into the same folder.

    Raises
    ------
    InputError
        As :func:`read_results`.
    """
    place = Path(folder)
    if not place.exists():
        raise InputError(f"there is no folder {printable(place)}; give one in which a command wrote its files.")
    if not place.is_dir():
        raise InputError(f"{printable(place)} is a file; give the folder in which a command wrote its files.")
    markers = [reader for reader in _READERS if (place / reader).is_file()]
    finished = (place / "study.json").is_file() and "states.json" not in markers
    if PLAN_FILE in markers and len(markers) > 1 and not finished:
        markers.remove(PLAN_FILE)  # the runs of the states, which are compared, or will be
    results: list[Result] = [_READERS[marker](place) for marker in markers]
    if not results and (runs := _runs_in(place)):
        results = [_several(place, runs)]
    if not results:
        raise InputError(_foreign(place))
    return results


def _foreign(place: Path) -> str:
    if not any(place.iterdir()):
        return f"folder {printable(place)} is empty; give one in which a command wrote its files."
    if (place / "data" / "study.json").is_file() or (place / "index.html").is_file():
        return f"{printable(place)} holds no result of a command, but a page or the paper's study; open its HTML file."
    refuse_former(*place.glob(FORMER_FILES))
    if (place / RUNS_FILE).is_file():
        return (
            f"{printable(place)} holds runs of a command that has written no result; give the same command again: it goes "
            "on, or says why there is none."
        )
    return f"{printable(place)} holds no result of stylobate; give a folder in which a command wrote its files."


# -- kinds ---------------------------------------------------------------------------------------------------------


def _read_run(place: Path) -> RunResult:
    response = load_response(place / "response.nc")
    summary = _object(place, "run.json", Kind.RUN) if (place / "run.json").is_file() else response.summary()
    names = ("response.nc", "run.json", "motion.csv", "replicates.csv")
    record = place / "motion.csv"
    return RunResult(
        **_common(place, Kind.RUN, "run", names, summary),
        response=response,
        motion=_motion(record) if record.is_file() else None,
        replicates=_table(place / "replicates.csv") if (place / "replicates.csv").is_file() else None,
    )


def _motion(path: Path) -> Motion:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutOfRangeWarning)  # they were given when it was run
        return read_motion(path)


def _runs_in(place: Path) -> list[Path]:
    folders = sorted(path for path in place.iterdir() if path.is_dir() and not path.is_symlink())
    if len(folders) > MOST_RUNS:
        raise InputError(f"{printable(place)} holds {len(folders)} folders; allowed is up to {MOST_RUNS} runs.")
    return [folder for folder in folders if (folder / "response.nc").is_file()]


def _several(place: Path, runs: Sequence[Path]) -> SeveralRuns:
    read = tuple(_read_run(run) for run in runs)
    if len({run.response.structure.digest for run in read}) > 1:
        raise InputError(
            f"the runs in {printable(place)} are not all of one column; name their folders one by one to report "
            "them together."
        )
    facts: dict[str, Any] = _common(place, Kind.RUNS, "run", FILES[Kind.RUNS].further, {}) | {
        "request": read[0].request
    }
    return SeveralRuns(**facts, runs=read)


def _read_grid(kind: Kind, load: Callable[[Path], Any]) -> Callable[[Path], Grid]:
    def read(place: Path) -> Grid:
        data, stem = load(place / f"{kind.value}.nc"), kind.value
        written = place / f"{stem}.json"
        summary = data.summary() | (_object(place, written.name, kind) if written.is_file() else {})
        return Grid(**_common(place, kind, "domain", (f"{stem}.nc", f"{stem}.json", stem), summary), data=data)

    return read


def _read_numbers(kind: Kind) -> Callable[[Path], Numbers]:
    def read(place: Path) -> Numbers:
        stem, files = kind.value, FILES[kind]
        summary = _object(place, f"{stem}.json", kind)
        tables = {name: _table(place / f"{name}.csv") for name in files.tables if (place / f"{name}.csv").is_file()}
        names = [f"{stem}.json", stem, f"{stem}.csv", *(f"{table}.csv" for table in tables), *files.further]
        return Numbers(**_common(place, kind, stem, names, summary), tables=tables)

    return read


def _read_study(place: Path) -> StudyFolder:
    study = StudyResult.in_folder(place)
    summary = study.summary()
    if (place / "study.json").is_file():
        written = read_json(place / "study.json")
        summary |= {name: written[name] for name in ("wall_s", "doubt") if name in written}
    ranked, kept, names = study.ranked(), {}, [PLAN_FILE, "study.json", "study.csv", "study.parquet"]
    for name, number in {"median": (len(ranked) - 1) // 2, "worst": -1}.items() if ranked else ():
        file = f"histories/{study.plan.digests[ranked[number]]}.nc"
        if (place / file).is_file():
            kept[name] = load_response(place / file)
            names.append(file)
    return StudyFolder(**_common(place, Kind.STUDY, "study", names, summary), study=study, histories=kept)


def _read_comparison(place: Path) -> Comparison:
    table = _table(place / "comparison.csv")
    files = sorted(path.name for path in place.glob("response-*.nc"))
    responses = {name.removeprefix("response-").removesuffix(".nc"): load_response(place / name) for name in files}
    names = ["comparison.csv", "comparison", "design.csv", "design", *files]
    names += [path.name for path in sorted(place.glob("domain-*.nc"))]
    return Comparison(**_common(place, Kind.COMPARE, "compare", names, {}), table=table, responses=responses)


#: The file that tells a kind, and its reader; a folder's results come in this order.
_READERS: dict[str, Callable[[Path], Result]] = {
    "response.nc": _read_run,
    "critical.json": _read_numbers(Kind.CRITICAL),
    "domain.nc": _read_grid(Kind.DOMAIN, Domain.load),
    "probability.nc": _read_grid(Kind.PROBABILITY, CollapseProbability.load),
    "limit.json": _read_numbers(Kind.LIMIT),
    "modes.json": _read_numbers(Kind.MODES),
    "pushover.json": _read_numbers(Kind.PUSHOVER),
    "comparison.csv": _read_comparison,
    **{f"{kind.value}.json": _read_numbers(kind) for kind in (Kind.STATES, Kind.SUITE, Kind.IDA)},
    PLAN_FILE: _read_study,
    **{
        f"{kind.value}.json": _read_numbers(kind)
        for kind in (
            Kind.FRAGILITY,
            Kind.RISK,
            Kind.SURVIVAL,
            Kind.INFER,
            Kind.UNTIL_FALL,
            Kind.RECORDS,
            Kind.CALIBRATE,
        )
    },
}


# -- parts ---------------------------------------------------------------------------------------------------------


def _common(place: Path, kind: Kind, command: str, names: Iterable[str], summary: dict[str, Any]) -> dict[str, Any]:
    """Fields that every result has; a name without an ending is a picture."""
    request_file = place / request_file_name(command)
    files = [name if "." in name else f"{name}.png" for name in (*names, request_file.name)]
    return {
        "kind": kind,
        "folder": place,
        "request": CommandRequest.read(request_file) if request_file.is_file() else None,
        "files": _facts(place, dict.fromkeys(files)),
        "summary": summary,
    }


def _facts(place: Path, names: Iterable[str]) -> tuple[FileFact, ...]:
    listed = (place / LIST).is_file()
    own = OwnFiles(place)
    facts = []
    for name in names:
        path = place / name
        if path.is_file() and name != RUNS_FILE:
            unchanged = own.holds(path) if listed and own.lists(path) else None
            facts.append(FileFact(name, digest(path), unchanged))
    return tuple(facts)


def _object(place: Path, name: str, kind: Kind) -> dict[str, Any]:
    document = read_json(place / name)
    missing = [key for key in FILES[kind].keys if key not in document]
    if missing:
        raise InputError(
            f"{printable(place / name)} is not what 'stylobate {kind.value}' of this version writes: it has "
            f"no {missing[0]!r}; run again."
        )
    return document


def _table(path: Path) -> Any:
    import pandas

    check_file(path, MOST)
    try:
        return pandas.read_csv(path)
    except (ValueError, OSError, pandas.errors.ParserError) as error:
        raise InputError(
            f"{printable(path)} is no table that can be read ({str(error).splitlines()[0]}); run again."
        ) from None
