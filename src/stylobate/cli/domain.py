"""``stylobate domain``: the safe-unsafe domain of a column over frequency and amplitude."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..analysis.domain import Domain
    from ..campaign.study import Study


def domain(
    what: Annotated[
        str, typer.Argument(metavar="STUDY|COLUMN", help="A study file (TOML), or a column: preset or column file.")
    ],
    model: Annotated[str | None, typer.Option("--model", metavar="MODEL", help="How it is computed.")] = None,
    frequencies: Annotated[
        str | None, typer.Option("--frequencies", metavar="F:F:N", help="First, last and number, such as 0.33:4:24.")
    ] = None,
    amplitudes: Annotated[
        str | None, typer.Option("--amplitudes", metavar="A:A:N", help="Likewise, such as 0.05g:0.6g:32.")
    ] = None,
    duration: Annotated[str | None, typer.Option("--duration", metavar="TIME", help="Of each motion; 10s.")] = None,
    tail: Annotated[
        str | None, typer.Option("--tail", metavar="TIME", help="Go on for this long after each motion; 0s.")
    ] = None,
    settings: o.Settings = None,
    threads: o.Threads = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Safe-unsafe domain over frequency and amplitude.

    With --out, a domain that was interrupted goes on where it was.
    """
    from ..analysis.domain import collapse_domain
    from . import console

    count = o.the_threads(threads)
    study = _study(what, model, frequencies, amplitudes, duration, tail, settings)
    with console.folder(out) as folder:
        with console.progress("cells") as progress:
            result = collapse_domain(
                study.column,
                study.model,
                study.frequencies,
                study.amplitudes,
                study.duration,
                tail=study.tail,
                threads=count,
                progress=progress,
                out=folder,
            )
        if not result.complete:
            raise console.Interrupted(_what_is_kept(result, folder))
        files = [] if folder is None else write(result, folder)
    summary = result.summary() | {"files": [str(file) for file in files]}
    if as_json:
        console.emit(summary)
    else:
        describe(result, files)


def write(result: Domain, folder: Path) -> list[Path]:
    """Summary and figure, beside the files of the domain itself."""
    from .. import plots
    from . import console

    return [
        folder / "domain.nc",
        folder / "domain.csv",
        *plots.save(plots.draw_domain(result), folder / "domain"),
        console.write_json(folder / "domain.json", result.summary()),
    ]


def describe(result: Domain, files: list[Path]) -> None:
    """Print the domain for people."""
    from ..constants import g
    from . import console

    counts, cells = result.counts, len(result.rows)
    sentence = f"{counts['collapsed']} of {cells} cells collapse, {counts['stands']} stand."
    for one, meaning in (("undecided", "ended far from rest (try --tail 5s)"), ("failed", "could not be computed")):
        if counts[one]:
            sentence += f" {counts[one]} {meaning} and are not counted as collapse."
    f, a = result.frequencies, result.amplitudes / g
    facts = {
        "column": result.column.name,
        "model": result.model,
        "frequencies": f"{f[0]:g} to {f[-1]:g} Hz, {len(f)}",
        "amplitudes": f"{a[0]:g} to {a[-1]:g} g, {len(a)}",
        "static uplift": f"{result.column.uplift_acceleration / g:.4g} g",
        "time": f"{result.wall_time:.1f} s",
    }
    console.say(sentence, facts, files)


def _study(
    what: str,
    model: str | None,
    frequencies: str | None,
    amplitudes: str | None,
    duration: str | None,
    tail: str | None,
    settings: list[str] | None,
) -> Study:
    from ..campaign.study import Study, amplitude_range, frequency_range, is_study, read_study
    from ..column.files import load_column
    from ..motion.specs import parse_time

    given = {
        "--model": model,
        "--frequencies": frequencies,
        "--amplitudes": amplitudes,
        "--duration": duration,
        "--tail": tail,
        "--set": settings,
    }
    if Path(what).is_file() and is_study(what):
        for option, value in given.items():
            if value:
                raise InputError(f"{what} is a study file and {option} is given as well; state it in the file.")
        return read_study(what)
    column = load_column(what)
    return Study(
        column,
        o.the_model(_needed("--model", model, "dem2d"), settings),
        frequency_range(_needed("--frequencies", frequencies, "0.33:4:24")),
        amplitude_range(_needed("--amplitudes", amplitudes, "0.05g:0.6g:32")),
        parse_time(duration or "10s"),
        parse_time(tail or "0s"),
    )


def _needed(option: str, value: str | None, example: str) -> str:
    if value is None:
        raise InputError(f"{option} is missing; a domain of a column needs it, e.g. {option} {example}.")
    return value


def _what_is_kept(result: Domain, folder: Path | None) -> str:
    done, cells = len(result.rows) - result.counts["not run"], len(result.rows)
    if folder is None:
        return f"interrupted after {done} of {cells} cells; nothing is kept: with --out DIR it would go on from there."
    return f"interrupted; {done} of {cells} cells are kept in {folder}: the same command goes on from there."
