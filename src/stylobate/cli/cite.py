"""``stylobate cite``: what to cite for a result, a model, or the package."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..bibliography import Citation


def cite(
    result: Annotated[
        Path | None, typer.Argument(metavar="[RESULT]", help="Response, domain or probabilities (netCDF).")
    ] = None,
    model: Annotated[
        str | None, typer.Option("--model", metavar="MODEL", help="A model instead of a result: dem2d, housner …")
    ] = None,
    everything: Annotated[bool, typer.Option("--all", help="The whole bibliography.")] = False,
    bibtex: Annotated[bool, typer.Option("--bibtex", help="Print BibTeX.")] = False,
    threads: o.Threads = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """What to cite: the package, the sources of the model, and where the motion comes from.

    With --out, writes citation.txt and citation.bib.
    """
    from . import console

    o.the_threads(threads)
    given = [
        name
        for name, one in (("RESULT", result), ("--model", model), ("--all", everything))
        if one not in (None, False)
    ]
    if len(given) > 1:
        raise InputError(f"{' and '.join(given)} are both given; give one of RESULT, --model and --all.")
    found = _citation(result, model, everything)
    summary, files = found.summary(), []
    with console.folder(out, "citation.txt", "citation.bib") as folder:
        if folder is not None:
            files = [
                console.write_text(folder / "citation.txt", found.text),
                console.write_text(folder / "citation.bib", found.bibtex),
            ]
    if as_json:
        console.emit(summary | {"files": [str(file) for file in files]})
        return
    print(found.bibtex if bibtex else found.text)
    if not given and not bibtex:
        print("\nFor what a result rests on: stylobate cite RESPONSE.nc; for a model: --model NAME; BibTeX: --bibtex.")


def _citation(result: Path | None, model: str | None, everything: bool) -> Citation:
    from ..bibliography import bibliography, cite, cite_run

    if result is not None:
        from ..store import read_provenance

        return cite_run(read_provenance(result))
    if model is not None:
        from ..models.registry import model_class

        return cite(model_class(model).references, f"model {model}")
    return cite(bibliography(), "the whole bibliography") if everything else cite()
