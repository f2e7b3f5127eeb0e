"""``stylobate states``: states of one column under the same records: was a measure worth it?"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..analysis.states import StateComparison
    from ..column import Column
    from ..models.base import Model
    from ..motion.request import MotionRequest


def the_states(as_built: str | None, as_found: str | None, strengthened: list[str] | None) -> dict[str, str]:
    """Columns to be compared, by label; those with a measure are called after their files."""
    found = {name: text for name, text in (("as built", as_built), ("as found", as_found)) if text is not None}
    for text in strengthened or ():
        label = Path(text).stem
        if label in found:
            raise InputError(f"two of the states are called {label!r}; rename one of the files.")
        found[label] = text
    if len(found) < 2:
        given = f"only the state {next(iter(found))!r} is given" if found else "no state is given"
        raise InputError(f"{given}; give two or more of --as-built, --as-found and --with.")
    return found


def states(
    context: typer.Context,
    records: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[DIR|FILE]...", help="Folders of records, or records; or sample:NAME."),
    ] = None,
    as_built: Annotated[
        str | None, typer.Option("--as-built", metavar="COLUMN", help="Name of a preset, or a column file (TOML).")
    ] = None,
    as_found: Annotated[
        str | None, typer.Option("--as-found", metavar="COLUMN", help="The column as it is found today.")
    ] = None,
    strengthened: Annotated[
        list[str] | None, typer.Option("--with", metavar="COLUMN", help="With a measure; may be repeated.")
    ] = None,
    model: Annotated[str, typer.Option("--model", metavar="MODEL", help="How it is computed.")] = "dem2d",
    im: Annotated[
        str | None, typer.Option("--im", metavar="MEASURE", help="Scale the records to it, such as pgv.")
    ] = None,
    levels: Annotated[
        str | None, typer.Option("--levels", metavar="A:A:N", help="Its levels, such as 0.2m/s:1.6m/s:8.")
    ] = None,
    state: Annotated[
        str, typer.Option("--state", metavar="STATE", help="Limit state, such as collapse or top:0.35d.")
    ] = "collapse",
    replicates: o.Replicates = None,
    scatter: o.ScatterSizes = None,
    seed: o.Seed = None,
    harmonic: o.Harmonic = None,
    across: o.Across = None,
    pulse: o.Pulse = None,
    synthetic: o.Synthetic = None,
    motion: o.MotionFiles = None,
    unit: o.Unit = None,
    dt: o.Step = None,
    component: o.ComponentName = None,
    azimuth: o.Azimuth = None,
    condition: o.Condition = None,
    scale: o.Scale = None,
    pga: o.Pga = None,
    vertical: o.Vertical = "on",
    tail: o.Tail = "0s",
    settings: o.Settings = None,
    project: o.Project = None,
    threads: o.Threads = None,
    dask: o.Dask = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """States of one column side by side: as built, as found, with a measure. Was it worth it?

    Fragility curves under the same records with paired differences, and what the links bore.
    """
    if records and motion:
        raise InputError("records are given before the options and after --motion; give them once.")
    files = records or motion
    if not (files or harmonic or pulse or synthetic):
        raise InputError("no record is given; name a folder of records, or files, before the options.")
    named = the_states(as_built, as_found, strengthened)
    twins = o.the_population(replicates, scatter, seed)
    how = o.the_model(model, settings)
    workers = o.the_threads(threads)
    request = o.the_request(context, motion=files, separate=bool(files))
    after = o.the_tail(tail)
    columns = {label: o.the_column(text, project) for label, text in named.items()}
    o.the_engine(context, dask, workers)
    _run(columns, request, how, im, levels, state, twins, after, workers, out, as_json)


def _run(
    columns: dict[str, Column],
    request: MotionRequest,
    model: Model,
    im: str | None,
    levels: str | None,
    state: str,
    twins: dict[str, Any] | None,
    tail: float,
    threads: int,
    out: Path | None,
    as_json: bool,
) -> None:
    """Compare states of a column and tell what came of it."""
    from ..analysis.limit_states import parse_state
    from ..analysis.states import compare_states
    from ..campaign.study_files import levels_of
    from ..column.scatter import usual_scatter
    from . import console

    if (im is None) != (levels is None):
        raise InputError("records are scaled by --im and --levels together; give both, such as --im pgv --levels "
                         "0.2m/s:1.6m/s:8.")  # fmt: skip
    parse_state(state)
    measure, sizes = (None, [1.0]) if im is None or levels is None else levels_of(im, levels)
    motions = request.expand()
    how, population = {}, {}
    if twins is not None:
        how = {"realisations": twins["replicates"], "scatter": twins["scatter"], "seed": twins["seed"]}
        sizes_of = {label: (twins["scatter"] or usual_scatter(one)).describe() for label, one in columns.items()}
        same = len(set(sizes_of.values())) == 1
        told = sizes_of.values() if same else (f"{label}: {one}" for label, one in sizes_of.items())
        population = twins | {"scatter": "; ".join(dict.fromkeys(told))}
    with console.folder(out, "states.csv", "links.csv", "states.json", "asked-states.json", "states") as folder:
        if folder is not None:
            console.ledger(folder)
        with console.progress("runs") as progress:
            found = compare_states(
                columns, motions.motions, model, sizes, measure, **how, state=state, tail=tail, threads=threads,
                progress=progress, out=folder,
            )  # fmt: skip
        summary = found.summary() | {"model": model.name, "refused": motions.refused, "files": []}
        if folder is not None:
            from .. import plots

            what = {"structures": list(columns.values()), "models": [model]}
            what |= {
                "motions": [model.taken(one) for one in motions.motions],
                "states": list(columns),
                "runs": found.table,
            }
            what |= {"im": im, "levels": levels, "limit_state": state, "tail_s": tail}
            files = [
                console.write_table(found.table, folder / "states.csv"),
                console.write_table(found.links, folder / "links.csv"),
                *plots.save(plots.draw_states(found), folder / "states"),
                console.asked(folder, "states", **what, **population),
            ]
            console.write_summary(summary, files, folder / "states.json")
    if as_json:
        console.emit(summary)
        return
    describe(found)
    console.print_refused(motions.refused)
    if summary["files"]:
        print(f"{len(summary['files'])} files in {out}")


def describe(found: StateComparison) -> None:
    """Print the answer for people."""
    import pandas

    from ..analysis.side_by_side import median_name, median_words
    from . import console

    if found.doubt:
        print(found.doubt)
    for one in found.differences:
        print(one.sentence)
    how = "collapse" if found.state == "collapse" else "exceed"
    rows, curves = [], [None if one is None else one.summary() for one in found.curves]
    for one, curve in zip(found.shares, curves, strict=True):
        row = {"state": one.label, "same runs": one.runs, how: one.exceeded, "do not": one.not_exceeded}
        row |= {"undecided": one.undecided, "failed": one.failed, f"share that {how}s": one.words or console.MISSING}
        row["95 % of the share"] = one.interval_words or console.MISSING
        row[median_name(*curves)] = console.MISSING if curve is None else median_words(curve)
        rows.append(row)
    console.print_table(pandas.DataFrame(rows), digits=3)
    links = found.links
    if len(links):
        worst = links.sort_values(["broken", "largest_over_capacity"], ascending=False).groupby("state", sort=False)
        console.print_table(worst.head(3), digits=3)
