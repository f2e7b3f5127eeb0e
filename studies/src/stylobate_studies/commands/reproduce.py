"""``stylobate reproduce``: the paper's whole study, its figures, tables and one page."""

from __future__ import annotations

import dataclasses
import time
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from stylobate.cli import options as o
from stylobate.errors import InputError
from stylobate.messages import percent

if TYPE_CHECKING:
    from ..paper.cases import Grids

FOLDER = Path("reproduction")


@dataclass(frozen=True)
class Folder(o.Execution):
    """Where it is computed, and the folder that it needs."""

    out: Path | None = o.option("DIR", "Folder for everything; reproduction, by default reproduction.")


def reproduce(
    quick: bool = o.option(
        None, "Coarser grids, no records: one to two minutes on two cores, instead of thirty.", False
    ),
    records: Path | None = o.option(
        "DIR", "Folder with the nine records of docs/evidence/company.md; the samples without it."
    ),
    *,
    execution: Folder,
) -> None:
    """The paper in one command: both columns, all models, every figure, and what holds.

    What was interrupted goes on where it was.
    """
    from stylobate.campaign.cluster import on_cluster
    from stylobate.cli import console

    if quick and records is not None:
        raise InputError("`quick` takes no records; leave one of `quick` and `records` out.")

    count, dask = execution.count, execution.dask
    folder = execution.out or (FOLDER.with_name("reproduction-quick") if quick else FOLDER)
    with nullcontext() if dask is None else on_cluster(dask, count, console.note):
        summary = build(folder, quick, count, records=records)
    if not execution.emits(summary):
        describe(summary)


def build(folder: Path, quick: bool, threads: int, grids: Grids | None = None, records: Path | None = None) -> dict:
    """Compute, draw and write everything; returns the JSON object."""
    import pandas

    from stylobate.atomic import replacing
    from stylobate.cli import console, signals

    from ..paper.figures import draw
    from ..paper.folder import check_folder
    from ..paper.page import NAMES, case_rows, domain_rows, doubt_rows, write_paper_page
    from ..paper.statements import statements, statements_markdown
    from ..paper.study import run_study
    from .stages import stages

    check_folder(folder)
    started = time.perf_counter()
    kept = f"interrupted; what is finished is kept in {folder}: the same command goes on from there."
    with console.folder(folder), signals.keeping(kept):
        try:
            with stages() as report:
                results = run_study(folder, quick, threads, report, grids, records)
                report("drawing", 0, 0)
                rows = statements(results)
                pictures = draw(results, folder)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(kept) from None
        tables = folder / "tables"
        tables.mkdir(exist_ok=True)
        numbers = {"domains": domain_rows(results), "certainty": doubt_rows(results)}
        frames = {
            "cases": pandas.DataFrame(case_rows(results)),
            "statements": pandas.DataFrame(
                [dataclasses.asdict(row) | {"verdict": row.verdict.kind, "part": row.verdict.part} for row in rows]
            ),
        } | {name: pandas.DataFrame(list(table.body), columns=list(table.header)) for name, table in numbers.items()}
        for name, frame in frames.items():
            console.write_table(frame, tables / f"{name}.csv")
        with replacing(folder / "statements.md") as partial:
            partial.write_text(statements_markdown(rows, quick), encoding="utf-8")
        page = write_paper_page(folder / "index.html", results, rows, pictures)
        summary = {
            "page": str(page),
            "folder": str(folder),
            "quick": quick,
            "statements": len(rows),
            "verdicts": frames["statements"]["verdict"].value_counts().to_dict(),
            "unsafe_share": {
                f"{NAMES[name]}, {label}": domain.counts["collapsed"] / len(domain.rows)
                for (name, label, section), domain in results.domains.items()
                if section == "rectangular"
            },
            "uncertain_share": {NAMES[name]: doubt.uncertain for name, doubt in results.doubts.items()},
            "runs": results.runs,
            "figures": sum(len(group) for group in pictures.values()),
            "wall_s": time.perf_counter() - started,
        }
        console.write_json(folder / "reproduce.json", summary)
    return summary


def describe(summary: dict) -> None:
    """Print for people; the last line is the folder of the figures."""
    from stylobate.cli import console

    folder = Path(summary["folder"]).resolve()
    cells = {name: f"{percent(value)} of the cells collapse" for name, value in summary["unsafe_share"].items()}
    doubt = {
        f"{name}, uncertain": f"{percent(value)} of the cells near the boundary"
        for name, value in summary["uncertain_share"].items()
    }
    console.say(
        f"The paper's two columns by all models: {summary['runs']} histories in {summary['wall_s']:.0f} s.",
        cells | doubt,
    )
    counts = {verdict: f"{number}" for verdict, number in summary["verdicts"].items()}
    console.say(f"{summary['statements']} sentences of the paper, checked against these results:", counts)
    print(f"Open {folder / 'index.html'} in a browser.")
    print(f"{summary['figures']} figures, as PNG and SVG, are in")
    print(folder / "figures")
