"""``stylobate schema``: JSON schemas of the files that people write, from the tables by which they are read."""

from __future__ import annotations

import json
from typing import Any

from .. import added
from ..errors import InputError, suggest
from . import options as o


def schema(
    which: list[str] | None = o.argument("[KIND]...", "Such as column, assembly, study. All by default.", None),
    *,
    execution: o.Plain,
) -> None:
    """JSON schemas of column, assembly, study, ruin and project files, by which editors complete and check them.

    Write them with --out DIR, and name one in the first line of a file: #:schema DIR/column.schema.json
    """
    result = schemas()
    unknown = next((kind for kind in which or () if kind not in result), None)
    if unknown is not None:
        if place := added.missing("schemas", unknown):
            raise InputError(f"{unknown} files are read by {place}", "which")
        raise InputError(
            f"there is no kind of file {unknown!r}; {suggest(unknown, result)}kinds are {', '.join(result)}.", "which"
        )
    chosen = {kind: result[kind] for kind in which or result}
    summary: dict[str, Any] = {"schemas": chosen, "files": []}
    with execution.files("schema", *(f"{kind}.schema.json" for kind in chosen)) as files:
        if files.wanted:
            for kind, item in chosen.items():
                files.json(item, f"{kind}.schema.json")
            summary["files"] = files.names
    if execution.emits(summary):
        return
    if summary["files"]:
        print(*summary["files"], sep="\n")
        print("Name one in the first line of a TOML file, relative to it:  #:schema column.schema.json")
        for package in added.PACKAGES:
            for kind in () if which else package.schemas:
                if kind not in result:
                    print(f"Not here: {kind} files are read by {package.is_missing}")
    else:
        print(json.dumps(next(iter(chosen.values())) if len(chosen) == 1 else chosen, indent=2, ensure_ascii=False))


def schemas() -> dict[str, dict[str, Any]]:
    """JSON schemas by the kind of file."""
    from ..column.toml import json_schema

    tables: dict[str, list[Any]] = {}
    for entry in sorted(added.entry_points(added.SCHEMAS), key=lambda entry: entry.name):
        tables.setdefault(entry.name.partition(".")[0], []).append(entry.load())
    return {kind: json_schema(those, f"stylobate {kind} file") for kind, those in tables.items()}
