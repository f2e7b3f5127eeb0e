"""``stylobate study``: columns × records × levels × models × realisations, from one file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from . import options as o

if TYPE_CHECKING:
    from ..probability.studies import StudyResult

STUDY_NAME = o.argument("FILE", "A study file (TOML).")
STUDY_FOLDER = o.argument("DIR", "The folder of a study.")


def run(
    file: Path = STUDY_NAME,
    out: Path = o.option("DIR", "Folder that keeps the runs, for good.", ...),
    *,
    execution: Annotated[o.Execution, o.Without("out")],
) -> None:
    """Run a study, or what is missing of it.

    Finished runs are kept in the folder: a study that was stopped goes on, one that has grown computes only what is new.
    """
    from ..campaign.study_files import read_plan
    from ..probability.studies import TABLES, keep_histories, run_study, write_table
    from . import console
    from .files import files as files_of

    campaign = execution.campaign()
    study, refused = read_plan(file)
    with files_of(out, "study", "study.parquet", "study.csv", "study.json") as files:
        another = f"another process is at work in {out}; this one goes on when that one ends."
        with files.campaign(campaign, in_folder=True, waits=True) as tracked_campaign:
            result = run_study(study, out, waiting=lambda: console.note(another), campaign=tracked_campaign)
        with console.progress("histories") as progress:
            files += keep_histories(study, result, out, progress)
        files.append(write_table(result.table, out / f"study{TABLES[0] if has_parquet() else TABLES[1]}"))
        (model, *more), motions = study.models, study.motions
        what = {"structures": study.columns, "models": study.models, "runs": result.table}
        what |= {"motions": motions if more else [model.taken(motion) for motion in motions]}
        files.write_request(**what, tail_s=study.campaign.tail)
        summary = result.summary() | {"refused": refused}
        files.summary(summary, "study.json")
    if execution.emits(summary):
        return
    console.print_doubt(summary)
    print(sentence(result))
    console.print_refused(refused)
    tables, histories = files[-3:], len(files) - 3
    named = ", ".join(table.name for table in tables)
    print(f"{console.counted(len(files), 'file')} in {out}: {named}, histories of {histories} runs")


def status(directory: Path = STUDY_FOLDER, *, execution: o.Plain) -> None:
    """State of a study, which may be running."""
    from ..campaign.cases import PLAN_FILE
    from ..campaign.ledger import RUNS_FILE
    from ..probability.studies import StudyResult
    from . import console

    result = StudyResult.in_folder(directory)
    written = directory / "study.json"
    last = json.loads(written.read_text()).get("wall_s") if written.is_file() else None
    names = (*(path.name for path in sorted(directory.glob("study.*"))), PLAN_FILE, RUNS_FILE)
    summary = result.summary() | {"wall_s": last, "files": [str(directory / name) for name in names]}
    summary.pop("computed")
    with execution.files("study status", "status.json") as files:
        if files.wanted:
            files.json(summary, "status.json")
    if not execution.emits(summary):
        console.print_doubt(summary)
        print(sentence(result))


def export(
    directory: Path = STUDY_FOLDER,
    to: Path = o.option("FILE", "Table to write: .parquet or .csv.", ...),
    *,
    execution: o.Plain,
) -> None:
    """Write the table of a study, one row per finished case; of one that is not finished as well."""
    from ..probability.studies import StudyResult, write_table
    from . import console

    result = StudyResult.in_folder(directory)
    to = execution.place(to)
    if to.exists():
        from ..errors import InputError

        raise InputError(f"{to} is there already; choose another name.", "to")
    written = write_table(result.table, to)
    if not execution.emits(result.summary() | {"files": [str(written)]}):
        console.print_doubt(result.summary())
        print(f"{result.rows.finished} of {len(result.plan)} cases in {written}")


def sentence(result: StudyResult) -> str:
    """State and results of a study."""
    summary = result.summary()
    text = f"{summary['finished']} of {summary['cases']} cases are finished: "
    text += f"{summary['collapsed']} collapse, {summary['stands']} stand"
    for outcome in ("undecided", "failed"):
        if summary[outcome]:
            text += f", {summary[outcome]} {'are ' if outcome == 'undecided' else ''}{outcome}"
    text += "."
    if summary["computed"]:
        text += f" {summary['computed']} were computed now, in {summary['wall_s']:.1f} s."
    return text


def has_parquet() -> bool:
    """Whether Parquet files can be written here."""
    from importlib.util import find_spec

    return find_spec("pyarrow") is not None
