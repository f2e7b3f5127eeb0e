"""``stylobate report``: one page about any results, to read, print and sign."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from stylobate.cli import options as o


def report(
    folders: list[Path] | None = o.argument(
        "DIR...", "Folders that commands wrote with --out, in the order of the report.", None
    ),
    out: Path | None = o.option("FILE.html", "The page, one file that needs nothing else."),
    title: str | None = o.option("TEXT", "What stands, if not given."),
    project: Path | None = o.option("FILE.toml", "Begin with a page of this project, to sign: client, site, engineer."),
    pdf: bool = o.option(None, "Print it to a PDF beside it; needs a Chromium on this machine.", False),
    template: Path | None = o.option(
        "FILE.po",
        "Write the messages of a report to translate, for `language` in the project file; nothing else.",
        flag="--translation-template",
    ),
    *,
    execution: Annotated[o.Execution, o.Without(*o.CAMPAIGNS, "out")],
) -> None:
    """A report of any results: one page that prints on A4, for an engineer who signs it.

    What was asked, what stands as a dimensioned elevation, the motion, the verdict and how sure it is, what the model
    assumes and where it ends, versions and digests, and what to cite. Several folders make one report.
    """
    from stylobate.atomic import output_folder
    from stylobate.errors import InputError
    from stylobate.results import read_results

    from ..case import write_report
    from ..language import write_template
    from ..page import is_root, needs_browser
    from ..project import read_project

    if template is not None:
        with output_folder(template.parent, [template.name]) as folder:
            file = write_template(folder / template.name)
        if not execution.emits({"files": [str(file)]}):
            print(f"1 file: {file}")
        return
    if not folders or out is None:
        raise InputError(
            "give the folders of the results and `out=FILE.html`, or `translation_template=FILE.po` alone.", "out"
        )
    signed = None if project is None else read_project(project)
    if pdf:
        needs_browser()
    cases = read_results(folders)
    files = write_report(cases, out, title=title, pdf=pdf, project=signed)
    results = [{"kind": case.kind.value, "folder": str(case.folder), "name": case.name} for case in cases]
    if execution.emits({"results": results, "files": [str(file) for file in files]}):
        return
    for case in cases:
        print(f"{case.kind.value}: {case.name} ({case.folder})")
    if pdf and is_root():
        print(
            "printed as root, to whom Chromium refuses its sandbox; the page has no scripts and was read from this disk."
        )
    print(f"{len(files)} {'file' if len(files) == 1 else 'files'}: {', '.join(map(str, files))}")
