"""One part of the cases with one variant of one engine: ``run.py ENGINE VARIANT PART FILE``.

PART is plane, drums, passes or a number of facets.
Every part is a process of its own: an engine that ends the process takes nothing else with it.
"""

import importlib
import json
import math
import sys
from pathlib import Path

import measures


def rounded(value):
    """Numbers with six digits; what is not finite as text."""
    if isinstance(value, dict):
        return {key: rounded(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(entry) for entry in value]
    if isinstance(value, bool):
        return value
    value = float(value)
    return float(f"{value:.6g}") if math.isfinite(value) else str(value)


def main(name: str, variant: str, part: str, file: str) -> None:
    module = importlib.import_module(f"engine_{name}")
    run = module.engine(variant)
    if part == "plane":
        results = measures.plane(run, few=name != "stylobate", free=not variant.endswith("beam"))
    elif part == "drums":
        results = measures.round_stack(run)
    elif part == "passes":
        results = measures.passes(run)
    else:
        facets = int(part)
        results = measures.space(run, facets, whole=facets == 0 or (name == "lmgc90" and facets == 12))
    document = {"version": module.VERSION, "settings": module.SETTINGS, "found": rounded(results)}
    fresh = Path(file).with_suffix(".new")
    fresh.write_text(json.dumps(document, ensure_ascii=False), encoding="utf-8")
    fresh.replace(file)


if __name__ == "__main__":
    main(*sys.argv[1:])
