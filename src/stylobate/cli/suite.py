"""``stylobate suite``: what every record of a folder does to a column or an assembly."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Annotated, Any

import typer

from ..percent import percent
from . import options as o

#: Columns of the table that are printed.
SHOWN = (
    "number",
    "motion",
    "factor",
    "pga_g",
    "pgv_m_s",
    "pga_over_g_tan_alpha",
    "verdict",
    "outcome",
    "chance",
    "peak_top_displacement_m",
    "peak_displacement_m",
    "links_broken",
)


def suite(
    context: typer.Context,
    column: o.ColumnName,
    sources: Annotated[list[Path], typer.Argument(metavar="DIR|FILE...", help="Folders of records, or records.")],
    model: o.ModelName = "dem2d",
    also: Annotated[
        list[str] | None,
        typer.Option("--also", metavar="COLUMN", help="A further column, or assembly; may be repeated."),
    ] = None,
    against: Annotated[
        str, typer.Option("--against", metavar="MEASURE", help="Measure of the records on the axis of the figure.")
    ] = "pgv_m_s",
    unit: o.Unit = None,
    dt: o.Step = None,
    component: o.ComponentName = None,
    azimuth: o.Azimuth = None,
    azimuths: o.Azimuths = None,
    signs: o.Signs = "+",
    condition: o.Condition = None,
    scale: o.Scale = None,
    pga: o.Pga = None,
    vertical: o.Vertical = "on",
    tail: o.Tail = "0s",
    whole: o.Whole = False,
    settings: o.Settings = None,
    project: o.Project = None,
    replicates: o.Replicates = None,
    scatter: o.ScatterSizes = None,
    seed: o.Seed = None,
    threads: o.Threads = None,
    dask: o.Dask = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Shake a column, or an assembly of blocks (dem2d), with every record of a folder.

    A table of outcomes and of measures of the records; with --out, a figure of the peak response against one of them. With
    --replicates, how sure each verdict is; with --azimuths or --signs, from where the shaking does most harm.
    """
    from ..analysis.certainty import CHANCE, chance_words
    from ..analysis.difference import round_drums
    from ..analysis.directions import compass_of_shares, harm_words, worst
    from ..analysis.suite import must_be_told, suite_shares, suite_table
    from ..errors import InputError
    from ..models.shared.quiet import share_of
    from . import console

    workers, after = o.the_threads(threads), o.the_tail(tail)
    stones: list[Any] = [o.the_structure(name, project) for name in (column, *(also or ()))]
    must_be_told(against, stones)
    names = [stone.name for stone in stones]
    if len(set(names)) < len(names):
        raise InputError(f"two columns have the same name ({', '.join(names)}); give each a name of its own.")
    how = o.the_model(model, settings)
    records = o.the_request(context, motion=sources, separate=True).expand()
    twins = o.the_population(replicates, scatter, seed) or {}
    o.the_engine(context, dask, workers)
    with console.folder(out, "suite.csv", "suite.json", "suite", "directions", "asked-suite.json") as folder:
        ledger = console.ledger(folder)
        with console.progress("runs") as progress:
            table = suite_table(
                stones,
                records.motions,
                how,
                **twins,
                tail=after,
                whole=whole,
                threads=workers,
                progress=progress,
                ledger=ledger,
            )
        turned = any(
            "direction" in motion.metadata for motion in records.motions
        )  # else azimuths are those of instruments
        swept = turned and len(table[["azimuth_deg", "reversed"]].drop_duplicates()) > 1
        counts = {name: Counter(rows["verdict"]) for name, rows in table.groupby("column", sort=False)}
        result = {
            "runs": table.astype(object).where(table.notna(), None).to_dict("records"),
            "verdicts": counts,
            "inputs": [o.input_facts(how.taken(motion)) for motion in records.motions],
            "quiet_share": share_of(records.motions, whole),
            "refused": records.refused,
            "model": how.name,
        }
        result["doubt"] = round_drums(stones, how)
        compass = compass_of_shares(result["runs"])
        result["worst"] = worst(result["runs"], compass if swept else None)
        found = suite_shares(result["runs"])
        result["shares"] = [{"column": one.label, **one.counts} for one in found]
        files = []
        if folder is not None:
            from .. import plots

            files = [
                console.write_table(table, folder / "suite.csv"),
                console.write_json(folder / "suite.json", result),
                *plots.save(plots.draw_suite(table, against), folder / "suite"),
            ]
            if swept and len(compass.bearings) > 1:
                files += plots.save(
                    plots.draw_directions(compass, f"{', '.join(names)}, {how.name}"), folder / "directions"
                )
            taken = [how.taken(motion) for motion in records.motions]
            what = {"structures": stones, "models": [how], "motions": taken}
            files.append(console.asked(folder, "suite", **what, against=against, tail_s=after))
            result["files"] = [str(file) for file in files]
    if as_json:
        console.emit(result)
        return
    console.print_doubt(result)
    table["chance"] = [chance_words(row) for row in result["runs"]]
    for one, (_, rows) in zip(found, table.groupby("column", sort=False), strict=True):
        print(one.collapses)
        shown = rows.filter(list(SHOWN))
        shown = shown.rename(columns={"chance": CHANCE}) if any(shown["chance"]) else shown.drop(columns="chance")
        console.print_table(shown, digits=3)
    if swept and result["worst"] is not None:
        print(harm_words(result["worst"], compass))
    console.print_left_out(result["inputs"])
    if "stepped_s" in table:
        share: Any = table["stepped_s"].sum() / table["duration_s"].sum()
        print(f"stepped: {percent(share)} of the records, without what is quiet (--whole steps all)")
    console.print_refused(records.refused)
    console.print_files(files)
