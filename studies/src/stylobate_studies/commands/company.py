"""``stylobate company``: what stands more safely, a column alone or under architraves; a study of four structures."""

from __future__ import annotations

from pathlib import Path

from stylobate.cli import options as o
from stylobate.errors import InputError
from stylobate.reading import shown

#: Files that are always the same ones.
WRITES = ("company.json", "company.csv", "company")

#: Levels that are allowed [m/s].
LEVELS = 0.01, 5.0


def company(
    folder: Path | None = o.argument("RECORDS", "Folder with the nine records; the samples without it.", None),
    levels: str = o.option("V,V", "Peak velocities to which the records are scaled, in m/s.", "0.4,0.6,0.8,1.0"),
    *,
    execution: o.Plain,
) -> None:
    """Shake the same columns alone, two under an architrave, four in a row, and in a corner, and count what falls.

    A table of every run; with --out, the table, what it comes to, and a picture.
    """
    from stylobate import plots
    from stylobate.analysis.studies import run_study
    from stylobate.cli import console

    from ..paper.company import records, shares, study
    from ..paper.pictures.company import draw_shares

    asked = study.study_of(records.read_records(folder), _levels(levels))
    with console.folder(execution.out, *WRITES) as place, console.progress("runs") as progress:
        table = study.falls(run_study(asked, place, threads=execution.count, progress=progress))
        summary = shares.summary(table)
        files: list[Path] = []
        if place is not None:
            files.append(console.write_table(table, place / "company.csv"))
            files.append(console.write_json(place / "company.json", summary))
            files += plots.save(draw_shares(table), place / "company")
    if execution.emits(summary | {"files": [str(file) for file in files]}):
        return
    print(shares.markdown(summary))
    print(shares.runs_in_words(summary))
    print(summary["doubt"])
    if files:
        print(f"{len(files)} files in {shown(files[0].parent)}")


def _levels(text: str) -> tuple[float, ...]:
    try:
        levels = tuple(float(part) for part in text.split(","))
    except ValueError:
        levels = ()
    low, high = LEVELS
    if not levels or not all(low <= level <= high for level in levels) or len(set(levels)) < len(levels):
        raise InputError(
            f"--levels is {text!r}; allowed are different numbers from {low:g} to {high:g} m/s, such as 0.4,0.8."
        )
    return levels
