"""Ruins for the page: the text of a ruin file, whose columns are presets and what stands on the page."""

from __future__ import annotations

import tempfile
from pathlib import Path

from stylobate.column.files import write_column
from stylobate.column.presets import PRESETS
from stylobate.column.structure import Structure
from stylobate.column.toml import parse_toml
from stylobate.errors import InputError
from stylobate_ruins.ruin import Ruin
from stylobate_ruins.ruin_files import read_ruin

from .asked import ASSEMBLY, COLUMN, RUIN
from .lines import point_to

#: Largest ruin file: the address in the browser holds it [characters]; most simulations.
LARGEST, MOST = 50_000, 20_000


def ruin_of(text: str | None, stone: Structure, assembly: str | None) -> Ruin:
    """The ruin of a file.

    Parameters
    ----------
    text : str or None
    stone : Structure
        What stands on the page: ``column.toml`` in the file, or ``assembly.toml``.
    assembly : str or None
        Its file, where it is an assembly.

    Raises
    ------
    InputError
        The text describes none, or names another file: of this machine nothing else is read.
    """
    if not text or len(text) > LARGEST:
        raise InputError(f"the ruin file has {len(text or '')} characters; allowed are 1 to {LARGEST}.", "ruin")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / RUIN
        path.write_text(text, encoding="utf-8")
        try:
            data = parse_toml(path)
            _only_what_is_here(data, COLUMN if assembly is None else ASSEMBLY)
            if assembly is None:
                write_column(stone.stack, Path(folder) / COLUMN)
            else:
                (Path(folder) / ASSEMBLY).write_text(assembly, encoding="utf-8")
            found = read_ruin(path)
        except InputError as error:
            error.without(f"{folder}/")
            error.without(f"{RUIN}: ")
            point_to(error, text, "ruin")
            raise
    if found.simulations > MOST:
        raise InputError(f"{found.simulations} simulations are asked for; the page takes up to {MOST}.", "ruin")
    return found


def _only_what_is_here(data: dict[str, object], here: str) -> None:
    columns, prior = data.get("columns"), data.get("prior")
    for name in columns if isinstance(columns, list) else []:
        if name != here and name not in PRESETS:
            raise InputError(
                f"a column of the ruin comes from {str(name)[:100]!r}; the page has {here}, which stands on it, and presets "
                f"({', '.join(PRESETS)}): give such a name."
            )
    if isinstance(prior, dict) and "records" in prior:
        raise InputError("the prior of the ruin names records, which the page has not at hand; give pgv and period.")
    if "survival" in data:
        raise InputError("the ruin names a hazard curve, which the page has not at hand; leave survival out.")
