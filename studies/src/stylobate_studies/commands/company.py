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
    from stylobate.cli import console

    from ..company import records, shares, study
    from ..company.pictures import draw_shares

    sizes = _levels(levels)
    found = records.read_records(folder)
    with console.folder(execution.out, *WRITES) as place, console.progress("runs") as progress:
        table = study.run(found, sizes, threads=execution.count, progress=progress, ledger=console.ledger(place))
        summary = shares.summary(table)
        files: list[Path] = []
        if place is not None:
            files.append(console.write_table(table, place / "company.csv"))
            files.append(console.write_json(place / "company.json", summary))
            files += plots.save(draw_shares(table), place / "company")
    if execution.emits(summary | {"files": [str(file) for file in files]}):
        return
    print(shares.markdown(summary))
    print(shares.runs_told(summary))
    print(summary["doubt"])
    if files:
        print(f"{len(files)} files in {shown(files[0].parent)}")


def _levels(text: str) -> tuple[float, ...]:
    try:
        found = tuple(float(one) for one in text.split(","))
    except ValueError:
        found = ()
    low, high = LEVELS
    if not found or not all(low <= one <= high for one in found) or len(set(found)) < len(found):
        raise InputError(
            f"--levels is {text!r}; allowed are different numbers from {low:g} to {high:g} m/s, such as 0.4,0.8."
        )
    return found
