"""Results of a study: its table, its counts, and the runs that are worth their histories."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..atomic import replacing
from ..campaign.campaign import RUNS, Campaign
from ..campaign.cases import Plan, Study
from ..campaign.ledger import RUNS_FILE, finished_runs_in
from ..campaign.runs import Runs, Stopped, its_turn
from ..errors import InputError, check_kind
from ..notebook import NotebookSummary
from ..response import Response
from ..response.rows import Rows
from ..simulate import simulate
from ..verdicts import verdict as v
from ..verdicts.directions import harm
from ..verdicts.verdict import caveat

if TYPE_CHECKING:
    import pandas


#: Endings of tables.
TABLES = (".parquet", ".csv")


@dataclass(frozen=True, eq=False)
class StudyResult(NotebookSummary):
    """A study as far as it has been run.

    Parameters
    ----------
    plan : Plan
    rows : Rows
        One per case, with the keys of ``Measures.row()``.
    wall_time : float
        [s], of this call.
    computed : int
        Runs made in this call.
    """

    plan: Plan
    rows: Rows
    wall_time: float = 0.0
    computed: int = 0

    @property
    def verdicts(self) -> np.ndarray:
        """Verdict of each case."""
        return v.verdicts_of(self.rows)

    @property
    def doubt(self) -> str:
        """Caveat before all that rests on its runs, because of their models; empty where nothing does."""
        return str(self.plan.axes.get("doubt") or "")

    @property
    def table(self) -> pandas.DataFrame:
        """One row per finished case: what it is, its verdict (``collapsed`` is empty where there is none), its measures.

        The caveat before all of them is ``attrs["doubt"]``.
        """
        labels = self.plan.labels()[self.rows.made].reset_index(drop=True)
        measures, verdicts = self.rows.table(), self.verdicts[self.rows.made]
        labels["verdict"] = verdicts
        begins = [motion.get("begins_s") or [] for motion in self.plan.axes["motions"]]
        if any(begins):  # the number of the earthquake in which it fell, of a sequence
            which = np.unravel_index(np.flatnonzero(self.rows.made), self.plan.shape)[2]
            when = np.where(verdicts == v.COLLAPSED, self.rows.floats("collapse_time_s")[self.rows.made], np.nan)
            fell = [np.searchsorted(begins[k], time, "right") for k, time in zip(which, when, strict=True)]
            there = np.isfinite(when) & np.array([bool(begins[k]) for k in which])
            labels["fell_in_earthquake"] = np.where(there, fell, np.nan)
        table = labels.join(measures)
        table.attrs["doubt"] = self.doubt
        return table

    def summary(self) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate study``."""
        counts = v.count(self.verdicts)
        return {
            "cases": len(self.plan),
            "finished": self.rows.finished,
            "failed": counts[v.FAILED],
            "undecided": counts[v.UNDECIDED],
            "collapsed": counts[v.COLLAPSED],
            "stands": counts[v.STANDS],
            "computed": self.computed,
            "wall_s": self.wall_time,
            "doubt": self.doubt,
        }

    def ranked(self) -> list[int]:
        """Cases with a verdict from the least harm to the most (:func:`stylobate.verdicts.directions.harm`)."""
        sound: list[int] = np.flatnonzero(self.rows.made & (self.verdicts != v.FAILED)).tolist()
        return sorted(sound, key=lambda number: harm(_there(self.rows[number])))

    @classmethod
    def in_folder(cls, folder: str | Path) -> StudyResult:
        """Present state of a study's folder; a study may be at work there.

        Raises
        ------
        InputError
            It is not the folder of a study.
        """
        plan = Plan.load(folder)
        return cls(plan, plan.known(Path(folder) / RUNS_FILE))


def run_study(
    study: Study,
    out: str | Path | None = None,
    *,
    waiting: Callable[[], None] | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> StudyResult:
    """Run a study; what its folder holds already is not computed again.

    One process at a time computes in a folder: it uses this machine's cores, and an SQLite ledger with several writers must
    not leave it. Another one waits, reads along, and goes on with what is missing when the first has ended or was killed.

    Parameters
    ----------
    study : Study
    out : path, optional
        Folder that keeps every finished run within half a second, for good: a study that was stopped goes on, one that has
        grown computes only what is new. Without it nothing is kept.
    waiting : callable, optional
        Called once if another process is at work in the folder; this one goes on when that one ends, however it ends.
    campaign, **settings : Campaign, optional
        Where the study is computed and who is told; the rest is the study's own.

    Raises
    ------
    InputError
        Input that a model refuses, or a folder that cannot be used.
    Stopped
        Interrupted (Ctrl-C); a KeyboardInterrupt that says what is kept.
    """
    campaign = Campaign.of("run_study", campaign, settings, (*RUNS, "tail", "ledger"))
    check_kind("study", study, Study)
    check_kind("out", out, (str, Path), optional=True)
    folder = None if out is None else Path(out)
    if folder is not None and not folder.is_dir():
        raise InputError(f"folder {folder} does not exist; create it first.")
    started, plan = time.perf_counter(), study.plan()
    plan = replace(plan, axes=plan.axes | {"doubt": caveat(study.columns, *study.of_one_law)})
    ledger = None if folder is None else folder / RUNS_FILE
    turn = None if ledger is None else its_turn(ledger, plan.digests, campaign.progress, waiting)
    request = study.request(plan)
    try:
        with closing(Runs(replace(campaign, ledger=ledger), turn)) as runs:
            runs.open(request)
            if folder is not None:
                plan.save(folder)
            rows = runs.rows(request)
    except Stopped:
        raise
    except KeyboardInterrupt:  # while another process was at work
        done = 0 if ledger is None else finished_runs_in(ledger, plan.digests.keys)
        raise Stopped(done, len(plan), ledger) from None
    return StudyResult(plan, rows, time.perf_counter() - started, runs.made)


def histories_of(study: Study, number: int, **options: Any) -> Response:
    """A case of a study once more, with its histories; further options are those of ``simulate``."""
    column, motion = study.case(number)
    tail, quiet = study.campaign.tail, study.campaign.quiet
    return simulate(column, motion, study.model_of(number), tail=tail, quiet=quiet, until_decided=True, **options)


def keep_histories(
    study: Study, result: StudyResult, folder: Path, progress: Callable[[int, int], None] | None
) -> list[Path]:
    """Files of the histories of the worst and of the median run, and of all of them where the study asks for that.

    A file that is there already is not computed again: it is called after the digest of its case.
    """
    ranked = result.ranked()
    if not ranked:
        return []
    wanted = {"median": ranked[(len(ranked) - 1) // 2], "worst": ranked[-1]}
    files = []
    place = folder / "histories"
    numbers: list[int] = sorted({*wanted.values(), *(ranked if study.keep == "histories" else [])})
    place.mkdir(exist_ok=True)
    for done, number in enumerate(numbers):
        target = place / f"{result.plan.digests[number]}.nc"
        if not target.is_file():
            histories_of(study, number).save(target)
        files.append(target)
        if progress:
            progress(done + 1, len(numbers))
    return files


def write_table(table: pandas.DataFrame, path: str | Path) -> Path:
    """Write a table as Parquet or CSV, whole or not at all.

    Raises
    ------
    InputError
        Another ending, or Parquet without the library for it.
    """
    target = Path(path)
    if target.suffix not in TABLES:
        raise InputError(f"{target} ends in {target.suffix!r}; a table is written as {' or '.join(TABLES)}.")
    if not target.parent.is_dir():
        raise InputError(f"folder {target.parent} does not exist; create it first.")
    with replacing(target) as partial:
        if target.suffix == ".csv":
            table.to_csv(partial, index=False)
            return target
        try:
            import pyarrow  # noqa: F401
        except ImportError:
            raise InputError(
                f"{target} is Parquet, which takes pyarrow; install stylobate[parquet], or write a .csv file."
            ) from None
        plain = table.apply(lambda column: column.map(str) if column.map(type).isin([list, dict]).any() else column)
        plain.to_parquet(partial, index=False, engine="pyarrow")
    return target


def _there(row: Mapping[str, Any] | None) -> Mapping[str, Any]:
    assert row is not None
    return row
