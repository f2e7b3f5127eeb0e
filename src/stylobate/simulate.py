"""The two verbs: one run with its histories, many runs with their measures."""

from __future__ import annotations

import dataclasses
import logging
import math
import os
import platform
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .column.structure import Structure
from .errors import InputError, check_all, check_choice, check_kind, check_range, warn
from .messages import say
from .models import devices
from .models.base import Case, Cases, Model, RunOptions, duration
from .models.engine import engine_for
from .models.shared.ground import share_of
from .models.start import Start, Toss
from .motion import Motion
from .response import Measures, Response
from .response.measures import CPU, DEVICES, GPU
from .response.rows import Rows
from .version import __version__

if TYPE_CHECKING:
    import pandas

    from .column import Column


def simulate(
    column: Structure,
    motion: Motion,
    model: Model,
    *,
    tail: float = 0.0,
    output_interval: float = 0.01,
    until_end: bool = False,
    until_rest: bool = False,
    until_decided: bool = False,
    start: Start | Toss | None = None,
    twins: Sequence[Column] = (),
    quiet: float | None = None,
    progress: Callable[[float, float], None] | None = None,
) -> Response:
    """Shake one column once and record what happens.

    Parameters
    ----------
    column : Column, Specimen or Assembly
        An assembly always goes on to the end of the run, whatever falls.
    motion : Motion
    model : Model
        e.g. ``DistinctElement2D()``.
    tail : float
        Time to go on after the motion has ended [s].
    output_interval : float
        Time between recorded states [s].
    until_end : bool
        Go on after the collapse is certain.
    until_rest : bool
        Go on until everything lies still, on the ground if need be (``DistinctElement2D`` and ``DistinctElement3D``; others
        refuse). In space a column is an assembly of its drums then, and so is the structure of the response.
    until_decided : bool
        Go on after motion and tail, a minute at most: columns of models that step drums as long as they move and their
        verdict could change, assemblies as long as nothing has fallen and not all lies still. Commands and campaigns do.
    start : Start or Toss, optional
        Release the column from a pose (``Start``), with a velocity, instead of rest (``DistinctElement2D`` and
        ``DistinctElement3D``; others refuse); or a specimen from anywhere over the base (``Toss``; ``DistinctElement3D``).
    twins : sequence of Column
        Columns to be computed beside this one, as many as the model carries along; what they come down to is in
        ``Response.twins``. :func:`stylobate.certainty` draws them and says what they mean.
    quiet : float, optional
        Share of what opens a joint below which the lead-in, the pauses and the end of a motion are not stepped [-], by
        models that step drums; 0 steps all of it. By default 0.1 of records and 0 of computed motions, as of every command.
        The histories hold the state in which the column lies at rest while the quiet is left out.
    progress : callable, optional
        Called with (time so far, time of the whole run) [s], by models that step drums.

    Raises
    ------
    InputError
        The input cannot be used. A collapse or a failed computation is a result, not an exception.
    """
    check_kind("column", column, Structure)
    check_kind("motion", motion, Motion)
    check_kind("model", model, Model)
    check_kind("progress", progress, Callable, optional=True)
    check_kind("start", start, (Start, Toss), optional=True)
    twins = check_all("twins", twins, Structure)
    if until_rest:
        column = engine_for(model, column).followed()
    engine = engine_for(model, column)
    share = share_of(motion) if quiet is None else quiet
    cut = share if column.moving_acceleration is not None else 0.0  # nobody knows what is quiet for anything else
    following = run_options(tail, output_interval, until_end, until_rest, cut, until_decided)
    options = dataclasses.replace(following, start=start, twins=tuple(twins), progress=progress)
    if len(options.twins) > engine.twins:
        raise InputError(
            f"{len(options.twins)} twins are given; {model.name} carries up to {engine.twins}: use simulate_many."
        )
    check_cases([Case(column, motion)], model, options)
    _log_expected_time([Case(column, motion)], model, options)
    started = time.perf_counter()
    response = engine.run(model.taken(motion), options)
    wall = time.perf_counter() - started
    provenance = {column.kind: column.to_dict(), f"{column.kind}_digest": column.digest}
    provenance |= _provenance(model, motion, options, response.followed)
    return response.with_provenance(provenance, wall)


def run_cases(
    cases: Sequence[Case],
    model: Model,
    *,
    tail: float = 0.0,
    until_end: bool = False,
    until_rest: bool = False,
    quiet: float = 0.0,
    threads: int | None = None,
    device: str = CPU,
) -> Generator[tuple[int, Measures], None, None]:
    """Run many cases; yields (index, measures) as they finish, in any order.

    Parameters
    ----------
    cases : sequence of Case
    model : Model
    tail, until_end, until_rest
        As in :func:`simulate`.
    quiet : float
        Share of what opens a joint below which the lead-in and the end of a motion are not stepped [-]; 0 steps all of it.
    threads : int, optional
        All cores by default.
    device : {"cpu", "gpu"}
        ``gpu`` lets the graphics card of this machine step the columns for which it has kernels, and threads the rest:
        ``Measures.computed_by`` says which. Other last digits than by ``cpu``.
    """
    options = run_options(tail, until_end=until_end, until_rest=until_rest, quiet=quiet)
    check_choice("`device`", device, DEVICES)
    check_cases(cases, model, options)
    yield from (run_on_card if device == GPU else run_checked)(cases, model, options, threads)


def check_cases(cases: Sequence[Case], model: Model, options: RunOptions) -> None:
    """Refuse or warn of cases before any is computed; all of a batch are of one engine."""
    check_kind("model", model, Model)
    first: Any = None
    for column, motion in _to_check(cases):
        engine = engine_for(model, column)
        first = engine if first is None else first
        if type(engine) is not type(first):
            raise InputError(
                f"{first.structure.name!r} is {first.structure.described} and {column.name!r} is {column.described}, and a "
                "batch is of one kind; run them in batches of their own."
            )
        if options.start is not None:
            engine.check_start()
        if options.until_rest:
            engine.followed()
        engine.check(motion)
        engine.check_length(motion, options)
        warn_of_north(column, motion)


def warn_of_north(column: Structure, motion: Motion) -> None:
    """Warn of a record that is not in the axes of a column whose bearing is known, where nobody chose its azimuth."""
    azimuths = motion.metadata.get("azimuths") or {}
    x, y = azimuths.get("x"), azimuths.get("y")
    if column.north is None or x is None or (motion.metadata.get("direction") or {}).get("azimuth") is not None:
        return
    apart = [x - column.north] + ([] if y is None else [y - column.north + 90.0])
    if all(abs(math.remainder(angle, 360.0)) <= 1.0 for angle in apart):
        return
    words = say(
        "{motion}: x of the record points to {x:g}° clockwise from north, y to {y}, and x and y of what is shaken to "
        "{north:g}° and {across:g}°, so that it is not shaken from where the ground was; `azimuth={north:g}deg` turns a "
        "record of two horizontal components into its axes."
    )
    along = column.north % 360.0
    across, to_y = (along - 90.0) % 360.0, "–" if y is None else f"{y:g}°"
    warn(words.of(motion=motion.name, x=x, y=to_y, north=along, across=across))


def run_checked(
    cases: Sequence[Case], model: Model, options: RunOptions, threads: int | None = None
) -> Generator[tuple[int, Measures], None, None]:
    """Run cases that :func:`check_cases` has let pass; yields as :func:`run_cases` does."""
    count = thread_count(threads)
    _log_expected_time(cases, model, options, count)
    if len(cases):
        yield from engine_for(model, cases[0].column).run_many(cases, options, count)


def run_on_card(
    cases: Sequence[Case], model: Model, options: RunOptions, threads: int | None = None
) -> Generator[tuple[int, Measures], None, None]:
    """As :func:`run_checked`, by the graphics card of this machine as far as it has kernels; says how many it has not.

    Raises
    ------
    InputError
        There is no card that can be used.
    StylobateError
        It computes otherwise than the processor, or has failed on the way.
    """
    finished = on_processor = 0
    engine = engine_for(model, cases[0].column)
    for index, measures in engine.run_on_card(devices.gpu(), cases, options, thread_count(threads)):
        finished += 1
        on_processor += measures.computed_by == CPU
        yield index, measures
    if on_processor:
        logging.getLogger("stylobate").info(
            "%d of %d runs were computed by the processor: the graphics card has no kernel for what they need.",
            on_processor,
            finished,
        )


def simulate_many(
    column: Structure | Sequence[Structure],
    motions: Sequence[Motion],
    model: Model,
    *,
    tail: float = 0.0,
    until_end: bool = False,
    quiet: float | None = None,
    threads: int | None = None,
    device: str = CPU,
) -> pandas.DataFrame:
    """Shake many columns many times; histories are not kept.

    Parameters
    ----------
    column : Column, Specimen, Assembly or sequence of them
        One for all motions, or one for each motion.
    motions : sequence of Motion
    model : Model
    tail, until_end, quiet
        As in :func:`simulate`.
    threads : int, optional
        All cores by default.
    device : {"cpu", "gpu"}
        As in :func:`run_cases`; the column ``computed_by`` says what computed a run.

    Returns
    -------
    pandas.DataFrame
        One row per run in the order given, columns named as the JSON keys of ``stylobate run``.
    """
    motions = check_all("motions", motions, Motion)
    columns = [column] * len(motions) if isinstance(column, Structure) else check_all("column", column, Structure)
    if not len(motions):
        raise InputError("no motion is given; give at least one.", "motions")
    if len(columns) != len(motions):
        raise InputError(
            f"{len(columns)} columns are given for {len(motions)} motions; give one column, or one for each motion."
        )
    started = time.perf_counter()
    rows = Rows(len(columns))
    shares = [share_of(motion) if quiet is None else quiet for motion in motions]
    options = {"tail": tail, "until_end": until_end, "threads": threads, "device": device}
    for share in sorted(set(shares)):
        numbers = [number for number, quiet_share in enumerate(shares) if quiet_share == share]
        cases = Cases(len(numbers), lambda k, numbers=numbers: Case(columns[numbers[k]], motions[numbers[k]]))
        for index, measures in run_cases(cases, model, quiet=share, **options):
            rows[numbers[index]] = measures.row()
    wall = (time.perf_counter() - started) / len(columns)
    return rows.table().assign(wall_s=wall, model=model.name, version=__version__)


#: Cases that are compared at a time, to check only one of those that share column and samples.
CHECKED_TOGETHER = 1000


def _to_check(cases: Sequence[Case]) -> Iterator[Case]:
    # Of all cases that share column and samples, check the one with the largest factor of each sign: if it passes, all do.
    # In chunks, because every case may have its own column, and all of them would not fit into memory.
    largest: dict[tuple, Case] = {}
    for case in cases:
        motion = case.motion
        samples = (id(motion.samples), id(motion.y_samples), id(motion.z_samples))
        key = (id(case.column), *samples, motion.dt, motion.factor < 0.0)
        if key not in largest or abs(motion.factor) > abs(largest[key].motion.factor):
            largest[key] = case
        if len(largest) >= CHECKED_TOGETHER:
            yield from largest.values()
            largest.clear()
    yield from largest.values()


def thread_count(threads: int | None) -> int:
    """Number of threads to use: as asked, or one per core."""
    if threads is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return int(check_range("`threads`", threads, 1, 1024, remedy="leave it out to use all cores"))


#: Shortest wait that is logged before it begins [s], and most cases of a batch from which it is guessed.
LONG_WAIT, PROBES = 10.0, 20


def expected_wait(cases: Sequence[Case], model: Model, options: RunOptions, threads: int = 1) -> float:
    """About how long cases will take where nothing else runs on this machine [s]; 0 where that is not known.

    Lanes are filled in the order in which they become free: all end by their mean load and the longest run besides [1].

    References
    ----------
    .. [1] Graham, R. L. (1969). Bounds on multiprocessing timing anomalies. SIAM J. Appl. Math. 17(2), 416-429.
    """
    if not len(cases):
        return 0.0
    each = []
    for number in np.unique(np.linspace(0, len(cases) - 1, PROBES).astype(int)).tolist():
        column, motion = cases[number]
        each.append(engine_for(model, column).expected_time(motion, options, alone=len(cases) == 1))
    lanes = (1 + engine_for(model, cases[0].column).twins) * threads
    return float(np.mean(each)) * len(cases) / lanes + max(each) * (1.0 - 1.0 / lanes)


def log_expected_time(runs: str, wait: float, column: Structure) -> None:
    """Log before a long computation about how long it will take.

    Parameters
    ----------
    runs : str
        What takes so long: subject and verb.
    wait : float
        [s]
    column : Structure
        What is shaken.
    """
    if wait > LONG_WAIT:
        falls = "" if column.moving_acceleration is not None else ", and longer once something falls"
        logging.getLogger("stylobate").info(
            "%s about %s where nothing else runs on this machine%s.", runs, duration(wait), falls
        )


def _log_expected_time(cases: Sequence[Case], model: Model, options: RunOptions, threads: int = 1) -> None:
    if len(cases):
        runs = "this run takes" if len(cases) == 1 else f"{len(cases)} runs take"
        log_expected_time(runs, expected_wait(cases, model, options, threads), cases[0].column)


def _provenance(model: Model, motion: Motion, options: RunOptions, bed: bool) -> dict[str, Any]:
    # Keys of the bibliography: the model's, those of a computed motion, and that of the contact bed of followed collapses.
    references = [*model.references, *motion.metadata.get("references", ()), *(["feng2004"] if bed else [])]
    return {
        "version": __version__,
        "model": model.name,
        "parameters": model.parameters(),
        "references": list(dict.fromkeys(references)),
        "motion": motion.name,
        "motion_digest": motion.digest,
        "motion_metadata": {str(key): str(value) for key, value in motion.metadata.items() if key != "references"},
        "motion_processing": list(motion.processing),
        "left_out": list(model.taken(motion).metadata.get("left_out", ())),
        "tail_s": options.tail,
        "until_rest": options.until_rest,
        "until_decided": options.until_decided,
        "output_interval_s": options.output_interval,
        "quiet_share": options.quiet,
        "computed_by": CPU,
        "python": platform.python_version(),
        "machine": platform.machine(),
    }


def run_options(
    tail: float = 0.0,
    output_interval: float = 0.01,
    until_end: bool = False,
    until_rest: bool = False,
    quiet: float = 0.0,
    until_decided: bool = False,
) -> RunOptions:
    """Options of runs, checked; parameters as in :func:`simulate`."""
    return RunOptions(
        check_range("`tail`", tail, 0.0, 1e4, unit="s"),
        check_range("`output_interval`", output_interval, 0.0, 1e3, unit="s", open_low=True),
        until_end,
        until_rest,
        until_decided,
        quiet=check_range("quiet", quiet, 0.0, 0.5, remedy="0 steps the whole motion"),
    )
