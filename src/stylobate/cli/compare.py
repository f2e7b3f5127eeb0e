"""``stylobate compare``: several models side by side, under one motion or over one domain."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..models.base import Model


def compare(
    context: typer.Context,
    column: Annotated[str, typer.Argument(metavar="COLUMN", help="Name of a preset, or a column file (TOML).")],
    models: Annotated[
        str,
        typer.Option(
            "--models",
            metavar="A,B,C",
            help="Models to compare, such as housner,dem2d; with options, such as dem3d:planar=true,dem3d.",
        ),
    ],
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
    frequencies: Annotated[
        str | None, typer.Option("--frequencies", metavar="F:F:N", help="Compare domains: such as 0.33:4:24.")
    ] = None,
    amplitudes: Annotated[
        str | None, typer.Option("--amplitudes", metavar="A:A:N", help="Compare domains: such as 0.05g:0.6g:32.")
    ] = None,
    duration: Annotated[str, typer.Option("--duration", metavar="TIME", help="Of each motion of a domain.")] = "10s",
    tail: o.Tail = "0s",
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="MODEL.NAME=VALUE", help="Option of one of the models; may be repeated."),
    ] = None,
    project: o.Project = None,
    threads: o.Threads = None,
    dask: o.Dask = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Several models side by side: histories and measures under one motion, or verdicts over a domain.

    States of one column, as built, as found and with a measure, are compared by 'stylobate states'.
    """
    from ..analysis.compare import compare_domains, compare_models
    from ..analysis.difference import round_drums
    from ..motion.orientation import keep_axes
    from ..motion.ranges import amplitude_range, frequency_range
    from ..motion.specs import parse_time
    from . import console

    names = [name.strip() for name in models.split(",")]
    if len(set(names)) != len(names):
        raise InputError(f"--models is {models!r}, with a model given twice; give each once.")
    count, after = o.the_threads(threads), o.the_tail(tail)
    stone = o.the_column(column, project)
    chosen = [_chosen(name, names, settings) for name in names]
    over_domain = frequencies is not None or amplitudes is not None
    doubts = (round_drums([stone], one) for one in chosen)
    result: dict[str, Any] = {"models": names, "doubt": next(filter(None, doubts), "")}
    said: dict[str, str] = {}
    if over_domain:
        if frequencies is None or amplitudes is None:
            raise InputError("a domain needs both --frequencies and --amplitudes; give both.")
        if harmonic or pulse or synthetic or motion:
            raise InputError("both a motion and a domain are given; give a motion, or --frequencies and --amplitudes.")
        grid = frequency_range(frequencies), amplitude_range(amplitudes), parse_time(duration)
        o.the_engine(context, dask, count)
        each = [one for name in names for one in (f"domain-{_stem(name)}.nc", f"domain-{_stem(name)}")]
        with (
            console.folder(out, "comparison.csv", "comparison", "asked-compare.json", *each) as folder,
            console.progress("cells") as progress,
        ):
            ledger = console.ledger(folder)
            domains = compare_domains(
                stone, chosen, *grid, labels=names, tail=after, threads=count, progress=progress, ledger=ledger
            )
            files = [] if folder is None else _write_domains(domains, folder)
            if folder is not None:
                what = {"structures": [stone], "models": chosen}
                files.append(console.asked(folder, "compare", **what, labels=names, duration_s=grid[2], tail_s=after))
        table = domains.table
        result |= {"domains": [one.summary() for one in domains.domains], "differences": table.to_dict("records")}
    else:
        shaking = o.the_request(context).motion(stone.frequency_parameter)
        each = [f"response-{_stem(name)}.nc" for name in names]
        with (
            console.folder(out, "comparison.csv", "comparison", "asked-compare.json", *each) as folder,
            console.progress("models") as progress,
        ):
            ledger = console.ledger(folder)
            places = [] if folder is None else [folder / one for one in each]
            comparison = compare_models(
                stone, shaking, chosen, labels=names, tail=after, progress=progress, ledger=ledger, files=places
            )
            files = [] if folder is None else _write_histories(comparison, folder, places)
            if folder is not None:
                what = {"structures": [stone], "models": chosen, "motions": [shaking]}
                files.append(console.asked(folder, "compare", **what, labels=names, tail_s=after))
        runs = [
            response.summary() | {"left_out": o.input_facts(one.taken(shaking))["left_out"]}
            for one, response in zip(chosen, comparison.responses, strict=True)
        ]
        shared = keep_axes(shaking, "".join(one.axes for one in chosen))  # what some of the models take
        table, said = comparison.table, o.input_lines(shared)
        result |= o.input_facts(shared) | {"runs": runs}
    result["files"] = [str(file) for file in files]
    if as_json:
        console.emit(result)
    else:
        console.print_doubt(result)
        for name, text in said.items():
            print(f"{name}: {text}")
        (console.print_table if over_domain else console.print_side_by_side)(table)
        console.print_files(files)


def _chosen(label: str, labels: list[str], settings: list[str] | None) -> Model:
    """The model that a label names, with its options: those behind colons, and those of --set."""
    name, *own = label.split(":")
    return o.the_model(name, [*own, *_settings_of(label, labels, settings)])


def _stem(label: str) -> str:
    """A label as a part of a file's name."""
    return label.replace(":", "-").replace("=", "-")


def _settings_of(name: str, names: list[str], settings: list[str] | None) -> list[str]:
    mine = []
    for text in settings or []:
        model, dot, setting = text.partition(".")
        if not dot or model not in names:
            raise InputError(f"--set is {text!r}; write it as model.name=value, the model one of {', '.join(names)}.")
        if model == name:
            mine.append(setting)
    return mine


def _write_histories(comparison: Any, folder: Path, responses: list[Path]) -> list[Path]:
    from .. import plots
    from . import console

    figure = plots.draw_comparison(comparison.responses, labels=comparison.labels)
    table = console.write_table(comparison.table, folder / "comparison.csv")
    return [table, *responses, *plots.save(figure, folder / "comparison")]


def _write_domains(comparison: Any, folder: Path) -> list[Path]:
    from .. import plots
    from . import console

    files = [console.write_table(comparison.table, folder / "comparison.csv")]
    for label, one in zip(comparison.labels, comparison.domains, strict=True):
        files.append(one.save(folder / f"domain-{_stem(label)}.nc"))
        files += plots.save(plots.draw_domain(one), folder / f"domain-{_stem(label)}")
    named = [dataclasses.replace(one, model=label) for label, one in zip(comparison.labels, comparison.domains)]
    return files + plots.save(plots.draw_boundaries(named), folder / "comparison")
