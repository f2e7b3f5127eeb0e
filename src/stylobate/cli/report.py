"""``stylobate report``: one page about any results, to read, print and sign."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from . import options as o


def report(
    folders: Annotated[
        list[Path],
        typer.Argument(metavar="DIR...", help="Folders that commands wrote with --out, in the order of the report."),
    ],
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE.html", help="The page, one file that needs nothing else.")
    ],
    title: Annotated[str | None, typer.Option("--title", metavar="TEXT", help="What stands, if not given.")] = None,
    pdf: Annotated[
        bool, typer.Option("--pdf", help="Print it to a PDF beside it; needs a Chromium on this machine.")
    ] = False,
    threads: o.Threads = None,
    as_json: o.Json = False,
) -> None:
    """A report of any results: one page that prints on A4, for an engineer who signs it.

    What was asked, what stands as a dimensioned elevation, the motion, the verdict and how sure it is, what the model
    assumes and where it ends, versions and digests, and what to cite. Several folders make one report.
    """
    from ..report.case import write_report
    from ..report.pdf import is_root, needs_browser
    from ..results import read_results
    from . import console

    o.the_threads(threads)
    if pdf:
        needs_browser()
    found = read_results(folders)
    files = write_report(found, out, title=title, pdf=pdf)
    if as_json:
        results = [{"kind": one.kind.value, "folder": str(one.folder), "name": one.name} for one in found]
        console.emit({"results": results, "files": [str(one) for one in files]})
        return
    for one in found:
        print(f"{one.kind.value}: {one.name} ({one.folder})")
    if pdf and is_root():
        print(
            "printed as root, to whom Chromium refuses its sandbox; the page has no scripts and was read from this disk."
        )
    print(f"{len(files)} {'file' if len(files) == 1 else 'files'}: {', '.join(map(str, files))}")
