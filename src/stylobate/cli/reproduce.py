"""``stylobate reproduce``: the paper's whole study, its figures, tables and one page."""

from __future__ import annotations

import dataclasses
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from . import options as o

if TYPE_CHECKING:
    from ..analysis.paper_study import Grids, PaperResults
    from ..report.page import Picture

FOLDER = Path("reproduction")


def reproduce(
    quick: Annotated[bool, typer.Option("--quick", help="Coarser grids: minutes instead of many.")] = False,
    threads: o.Threads = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Folder for everything; reproduction, by default reproduction."),
    ] = None,
    as_json: o.Json = False,
) -> None:
    """The paper in one command: both columns, all models, every figure, and what holds.

    What was interrupted goes on where it was.
    """
    from . import console

    count = o.the_threads(threads)
    folder = out or (FOLDER.with_name("reproduction-quick") if quick else FOLDER)
    summary = build(folder, quick, count)
    if as_json:
        console.emit(summary)
        return
    facts = {one: str(number) for one, number in summary["verdicts"].items()} | {"time": f"{summary['wall_s']:.0f} s"}
    console.say(f"{summary['statements']} sentences of the paper checked; the page is {summary['page']}.", facts)


def build(folder: Path, quick: bool, threads: int, grids: Grids | None = None) -> dict:
    """Compute, draw and write everything; returns the JSON object."""
    import pandas

    from ..analysis.paper_statements import statements, statements_markdown
    from ..analysis.paper_study import run_study
    from ..atomic import replacing
    from ..report.paper import case_rows, domain_rows, write_paper_page
    from . import console

    started = time.perf_counter()
    with console.folder(folder):
        with console.progress("runs of this piece") as bar:
            report = None if bar is None else lambda _, done, total: bar(done, total)
            try:
                results = run_study(folder, quick, threads, report, grids)
            except KeyboardInterrupt:
                raise console.Interrupted(
                    f"interrupted; what is finished is kept in {folder}: the same command goes on from there."
                ) from None
        rows = statements(results)
        pictures = draw(results, folder)
        tables = folder / "tables"
        tables.mkdir(exist_ok=True)
        numbers = domain_rows(results)
        frames = {
            "cases": pandas.DataFrame(case_rows(results)),
            "domains": pandas.DataFrame(list(numbers.body), columns=list(numbers.header)),
            "statements": pandas.DataFrame([dataclasses.asdict(row) for row in rows]),
        }
        for name, frame in frames.items():
            with replacing(tables / f"{name}.csv") as partial:
                frame.to_csv(partial, index=False)
        with replacing(folder / "statements.md") as partial:
            partial.write_text(statements_markdown(rows), encoding="utf-8")
        page = write_paper_page(folder / "index.html", results, rows, pictures)
        verdicts = frames["statements"]["verdict"].value_counts().to_dict()
        summary = {
            "page": str(page),
            "folder": str(folder),
            "quick": quick,
            "statements": len(rows),
            "verdicts": verdicts,
            "runs": sum(
                len(one.rows) for part in (results.domains, results.variants, results.limits) for one in part.values()
            ),
            "figures": sum(len(some) for some in pictures.values()),
            "wall_s": time.perf_counter() - started,
        }
        console.write_json(folder / "reproduce.json", summary)
    return summary


def draw(results: PaperResults, folder: Path) -> dict[str, list[Picture]]:
    """All figures as PNG and SVG; pictures of the page by section."""
    import numpy as np

    from .. import plots
    from ..analysis.paper_study import BEAM, DEM, DRUMS, MONOLITH, paper_column, slug
    from ..column.presets import PRESETS
    from ..constants import g
    from ..plots import paper as p
    from ..report.page import Picture

    place = folder / "figures"
    place.mkdir(exist_ok=True)

    def keep(name: str, figure: Any, caption: str) -> Picture:
        return Picture(plots.save(figure, place / name)[0], caption)

    sections: dict[str, list[Picture]] = {}
    sections["Moment–rotation laws"] = [
        keep("figure-3-moment-rotation", p.draw_moment_laws(), "As the paper's Figure 3: left, the branch that falls to the "
             "critical angle; right, the first elastic branch, a thousand times smaller.")
    ]  # fmt: skip
    numbers = {(MONOLITH, BEAM): 4, (MONOLITH, DEM): 5, (DRUMS, BEAM): 7, (DRUMS, DEM): 8}
    some = sections["Histories of the thirty cases"] = []
    for (name, label), number in numbers.items():
        figure = p.draw_history_grid(results.histories[name, label], paper_column(name), f"{name}, {label}")
        caption = (
            f"As the paper's Figure {number}: base (red) and top (dashed), relative to the ground; tinted: collapse."
        )
        if label == BEAM:
            caption += " The base of this model is the ground."
        some.append(keep(f"figure-{number}-{slug(name, label)}", figure, caption))
    for name, number in ((MONOLITH, 6), (DRUMS, 9)):
        some = sections[f"Safe–unsafe domains, {name}"] = []
        for section in ("rectangular", "circular"):
            found = {
                label: d for (column, label, shape), d in results.domains.items() if (column, shape) == (name, section)
            }
            named = [dataclasses.replace(domain, model=label) for label, domain in found.items()]
            stem = f"figure-{number}-{section}"
            if len(named) > 1:
                figure = plots.draw_boundaries(named, f"{name}, {section}: first collapse")
                caption = f"As the paper's Figure {number}, {section} section: first collapse of each model."
                some.append(keep(f"{stem}-boundaries", figure, caption))
            for domain in named:
                figure = plots.draw_domain(domain, f"{name}, {section}: {domain.model}")
                caption = f"Verdict of every cell, {domain.model}, {section} section."
                some.append(keep(f"{stem}-{slug(domain.model)}", figure, caption))
    paths = [(f"{name}, {section}", path) for (name, section), path in results.paths.items()]
    for (name, section), path in results.paths.items():
        path.save(folder / "data" / f"pushover-{slug(name, section)}.csv")
    sections["Pushover"] = [
        keep("pushover", p.draw_pushover_paths(paths, "Pushover of the rigid block model"),
             "Load multiplier over the displacement of the top; right, near the peak.")
    ]  # fmt: skip
    some = sections["Open parameters"] = []
    for name in PRESETS:
        first = {key: results.variants[name, key].first_collapse / g for key in results.grids.variants}
        frequencies = np.asarray(results.grids.variant_frequencies)
        figure = p.draw_sensitivity(first, frequencies, f"{name}: first collapse with one parameter changed")
        some.append(
            keep(f"sensitivity-{slug(name)}", figure, f"Smallest collapsing amplitude, {name}; none: not up to 0.6 g.")
        )
    return sections
