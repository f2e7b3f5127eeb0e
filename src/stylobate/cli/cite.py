"""``stylobate cite``: what to cite for a result, a model, or the package."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..bibliography import Citation


def cite(
    result: Path | None = o.argument("[RESULT]", "Response, domain or probabilities (netCDF).", None),
    model: str | None = o.option("MODEL", "A model instead of a result: dem2d, housner …"),
    everything: bool = o.option(None, "The whole bibliography.", False, flag="--all"),
    bibtex: bool = o.option(None, "Print BibTeX.", False),
    *,
    execution: o.Plain,
) -> None:
    """Citations: the package, the sources of the model, and where the motion comes from.

    With --out, writes citation.txt and citation.bib.
    """
    from . import console

    given = [
        name
        for name, value in (("RESULT", result), ("`model`", model), ("`all`", everything))
        if value not in (None, False)
    ]
    if len(given) > 1:
        raise InputError(f"{' and '.join(given)} are both given; give one of RESULT, `model` and `all`.", "result")
    citation = _citation(result, model, everything)
    with execution.files("cite", "citation.txt", "citation.bib") as files:
        if files.wanted:
            files.append(console.write_text(files / "citation.txt", citation.text))
            files.append(console.write_text(files / "citation.bib", citation.bibtex))
    if execution.emits(citation.summary() | {"files": files.names}):
        return
    print(citation.bibtex if bibtex else citation.text)
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
