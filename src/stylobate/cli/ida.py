"""``stylobate ida``: every record scaled until the column collapses, in levels that are hunted and filled."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Annotated

import typer

from ..errors import InputError
from . import options as o

_MAGNITUDE = re.compile(r"\bM[wWlLsS]?\s?(\d\.\d)\b")


def ida(
    context: typer.Context,
    column: o.ColumnName,
    sources: Annotated[
        list[Path], typer.Argument(metavar="RECORDS...", help="Records, or folders of them; or sample:NAME.")
    ],
    model: o.ModelName = "dem2d",
    im: Annotated[
        str, typer.Option("--im", metavar="IM", help="Measure that is scaled: pga, pgv, sa:1.0s, avgsa, pgv@geomean …")
    ] = "pgv",
    edp: Annotated[
        str, typer.Option("--edp", metavar="MEASURE", help="Measure of the response, as a JSON key of stylobate run.")
    ] = "peak_top_displacement_m",
    levels: Annotated[
        str | None,
        typer.Option("--levels", metavar="A:A:N", help="Stripes instead of a hunt, such as 0.1m/s:1.0m/s:10."),
    ] = None,
    runs: Annotated[int, typer.Option("--runs", metavar="N", help="Runs of each record.")] = 14,
    largest: Annotated[
        float, typer.Option("--largest-factor", metavar="X", help="A record is multiplied by at most this.")
    ] = 20.0,
    about: Annotated[
        Path | None,
        typer.Option("--about", metavar="FILE", help="CSV about the records: record, magnitude, distance_km."),
    ] = None,
    replicates: o.Replicates = None,
    scatter: o.ScatterSizes = None,
    seed: o.Seed = None,
    unit: o.Unit = None,
    dt: o.Step = None,
    component: o.ComponentName = None,
    azimuth: o.Azimuth = None,
    condition: o.Condition = None,
    vertical: o.Vertical = "on",
    tail: o.Tail = "0s",
    whole: o.Whole = False,
    settings: o.Settings = None,
    project: o.Project = None,
    threads: o.Threads = None,
    dask: o.Dask = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Incremental dynamic analysis: the response over the intensity, each record scaled until the column collapses.

    Levels are hunted and filled, all records at a time; with the table of which intensity measure tells most.
    """
    from ..analysis.difference import round_drums
    from ..analysis.efficiency import which_tells_most
    from ..analysis.ida import ida as analyse
    from ..analysis.ida_curves import check_response, median_of
    from ..campaign.twins import described
    from ..motion.intensity_specs import parse_levels, parse_measure
    from ..motion.orientation import record_of
    from ..response.words import longer_tail
    from . import console

    workers, after = o.the_threads(threads), o.the_tail(tail)
    measure, stone, how = parse_measure(im), o.the_column(column, project), o.the_model(model, settings)
    check_response(edp, stone, how)
    twins = o.the_population(replicates, scatter, seed) or {}
    stripes = None if levels is None else parse_levels(levels, measure)
    records = o.the_request(context, motion=sources, separate=True).expand()
    known = the_facts(about, sources, [name for one in records.motions for name in (one.name, record_of(one))])
    o.the_engine(context, dask, workers)
    names = (
        "runs.csv",
        "capacities.csv",
        "fractiles.csv",
        "measures.csv",
        "ida.json",
        "ida",
        "measures",
        "asked-ida.json",
    )
    with console.folder(out, *names) as folder:
        ledger = console.ledger(folder)
        with console.progress("runs") as progress:
            found = analyse(
                stone, records.motions, how, measure, **twins, levels=stripes, runs=runs, largest_factor=largest,
                about=known, tail=after, whole=whole, threads=workers, progress=progress,
                ledger=ledger,
            )  # fmt: skip
        curves = found.curves(edp)
        best = which_tells_most(found.runs, edp=edp)
        result = found.summary() | {
            "edp": edp,
            "doubt": round_drums([stone], how),
            "measures": best.astype(object).where(best.notna(), None).to_dict("records"),
            "refused": records.refused,
        }
        files: list[Path] = []
        if folder is not None:
            from .. import plots

            files = [
                console.write_table(found.runs, folder / "runs.csv"),
                console.write_table(found.capacities, folder / "capacities.csv"),
                console.write_table(found.fractiles(edp), folder / "fractiles.csv"),
                *plots.save(plots.draw_ida(found, edp), folder / "ida"),
            ]
            if len(best):
                files.append(console.write_table(best, folder / "measures.csv"))
                files += plots.save(plots.draw_efficiency(best), folder / "measures")
            taken = [how.taken(motion) for motion in records.motions]
            what = {"structures": [stone], "models": [how], "motions": taken, "runs": found.runs}
            files.append(console.asked(folder, "ida", **what, im=measure.name, edp=edp, tail_s=after))
            console.write_summary(result, files, folder / "ida.json")
    if as_json:
        console.emit(result)
        return
    console.print_doubt(result)
    fell = sum(one["collapses_from"] is not None for one in result["capacities"])
    facts = {
        "runs": f"{result['runs']} of {_count(result['records'], 'record')}, {result['wall_s']:.1f} s",
        "collapses": f"{fell} of {_count(len(curves), 'curve')} end in collapse",
        "median capacity": f"{median_of(result)}; counted, fragility fits a curve and its interval",
        "resurrections": f"{_count(result['resurrections'], 'run')} above a collapse that stand, in "
        f"{_count(result['curves_with_resurrections'], 'curve')}",
    }
    if (drawn := found.twins) is not None:
        facts["columns like this"] = described(len(drawn.columns), drawn.scatter, drawn.seed, drawn.left_out)
    if result["undecided"] or result["failed"]:
        facts["open"] = f"{result['undecided']} undecided, {result['failed']} failed; go on with {longer_tail(after)}"
    console.say(f"{stone.name}, {how.name}: {_count(len(curves), 'curve')} over {measure.words}.", facts, files)
    if len(best):
        console.print_table(best.drop(columns=["median", "unit", "beta_low", "beta_high"]), digits=3)
    console.print_refused(records.refused)


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def the_facts(about: Path | None, sources: list[Path], names: list[str]) -> dict[str, dict[str, float]]:
    """Magnitude and distance by record: of a file, or of a manifest beside the records."""
    import pandas

    from ..analysis import tables

    found: dict[str, dict[str, float]] = {}
    for folder in (one for one in sources if about is None and (one / "manifest.csv").is_file()):
        table = pandas.read_csv(folder / "manifest.csv", dtype=str).fillna("")
        for row in table.to_dict("records"):
            told = _MAGNITUDE.search(" ".join(str(one) for one in row.values()))
            if told and row.get("file"):
                found[str(row["file"])] = {"magnitude": float(told[1])}
    if about is not None:
        table = tables.read(about, 10_000_000, "record", "the columns record, and magnitude or distance_km")
        known = [one for one in ("magnitude", "distance_km") if one in table.columns]
        if not known:
            raise InputError(f"{about} needs the columns record, and magnitude or distance_km.")
        for name, *values in zip(table.texts("record"), *(table.numbers(one, math.nan) for one in known), strict=True):
            found[name] = dict(zip(known, values, strict=True))
        if not set(found) & set(names):
            raise InputError(f"{about} names none of the records; they are {', '.join(names[:5])} …")
    return found
