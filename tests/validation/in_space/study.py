"""All reference rows beside what is computed here: renewed by ``make references``, and written as tables of a page."""

import json
import re
import sys
import time
from collections import Counter
from datetime import date
from functools import cache
from pathlib import Path

from references import FOLDER
from references import rows as rows_of

from . import engines, frames, impacts, limits, plane, rolling
from .row import FAMILIES, MET, MISSED, NONE, Judged, Rows, family_of

#: What is kept.
FILE = Path(__file__).with_name("rows.json")

#: What is renewed besides the families: plane assemblies in space.
PLANE = "plane"

#: Modules whose families are judged, in the order of the page.
MODULES = (rolling, impacts, limits, frames, engines)


def judged(name: str, rows: Rows) -> list[Judged]:
    """The rows of a family, each beside what is computed."""
    results = list(FAMILIES[name](rows))
    assert len(results) == len(rows), f"{name}: {len(results)} of {len(rows)} rows are judged"
    return results


def families() -> dict[str, Rows]:
    """All rows of the table by family, in its order."""
    groups: dict[str, Rows] = {}
    for row in rows_of(""):
        groups.setdefault(family_of(row), []).append(row)
    return groups


def renew(*names: str) -> None:
    """Compute some families, or all, and write what is kept of them."""
    groups = families()
    every = [*groups, PLANE]
    unknown = [name for name in names if name not in every]
    if unknown:
        known = ", ".join(every)
        sys.exit(f"No family of rows is called {unknown[0]!r}; there are {known}.")
    for name in names or every:
        began = time.process_time()
        if name == PLANE:
            write((stored() if FILE.exists() else {"rows": {}}) | {PLANE: plane.computed()}, name)
            continue
        results = [vars(result) for result in judged(name, groups[name])]
        kept = stored() if FILE.exists() else {"rows": {}}
        kept["date"] = date.today().isoformat()
        kept["rows"][name] = [named(row) | result for row, result in zip(groups[name], results, strict=True)]
        kept["rows"] = {key: kept["rows"][key] for key in groups if key in kept["rows"]}
        write(kept, name)
        counts = Counter(result["verdict"] for result in results)
        print(
            f"{name}: {', '.join(f'{n} {key}' for key, n in counts.items())}; {time.process_time() - began:.0f} s",
            flush=True,
        )


def named(row: dict[str, str]) -> dict[str, str]:
    """What is kept of a row: its name and numbers; what they mean is said where they lie."""
    spread = re.match(r"[\d.e-]+(?: to [\d.]+| %| deg| mm)?", row["spread"])
    azimuth = re.search(r"along (\S+) deg", row["params"]) if row["case"].startswith("limit3d_") else None
    scene = row["case"] + (f", {azimuth[1]}°" if azimuth else "")
    kept = {"scene": scene, "quantity": row["quantity"].partition(" (")[0], "value": row["value"], "unit": row["unit"]}
    return kept | {"spread": spread[0] if spread else ""}


def write(kept: dict, name: str) -> None:
    """Keep what is known now."""
    fresh = FILE.with_suffix(f".{name}")
    fresh.write_text(json.dumps(kept, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
    fresh.replace(FILE)


def stored() -> dict:
    """What is kept."""
    return json.loads(FILE.read_text(encoding="utf-8"))


#: Families by what the table calls them.
TITLES = {
    "drum_rolls_down": "drum rolls down a slope",
    "drum_coasts": "drum coasts on the level",
    "skid_to_roll": "drum skids until it rolls",
    "lying_drum_spins": "lying drum spins until it stops",
    "drum_over_edge": "drum rolls over an edge, and lands",
    "three_lying_drums": "three lying drums",
    "beam_leans_on_wall": "beam leans on a wall",
    "overhang": "five slabs reach out",
    "overhang_diagonal": "five slabs reach out over a corner",
    "portal_push": "portal pushed along and across",
    "podium_push": "four columns under a slab, pushed",
    "single_push": "one column, pushed",
    "arch_thickness": "least thickness of an arch",
    "arch_across": "arch pushed across",
    "drop_flat": "drum falls flat",
    "drop_on_rim": "drum falls on its rim",
    "drop_on_corner": "beam falls on its corner",
    "falling_hits_twin": "monolith falls onto its twin",
    "portal_rocking": "portal rocks",
    "portal_pulse": "portal under pulses",
    "wobbling_frame": "round column wobbles under a slab",
    "wobbling_podium": "four round columns wobble under a slab",
    "dominoes": "dominoes",
    "limit3d_": "multipliers of an independent static programme",
    "engines_portal": "two physics engines: portals",
    "engines_podium": "the same: four columns under a slab",
    "engines_colonnade": "the same: colonnade",
    "engines_temple_corner": "the same: temple corner",
    "engines_row": "the same: monoliths in a row",
    "engines_arch": "the same: arch",
    "engines_wall": "the same: walls",
    "wall_mid_push": "wall pushed at mid-height",
}


def counts() -> str:
    """Rows, met, missed and not applicable by family, in Markdown."""
    lines = ["| family | rows | met | missed | not applicable |", "| --- | --- | --- | --- | --- |"]
    whole: Counter[str] = Counter()
    for name, rows in stored()["rows"].items():
        seen = Counter(row["verdict"] for row in rows)
        whole += seen
        lines.append(f"| {TITLES[name]} | {len(rows)} | {seen[MET]} | {seen[MISSED]} | {seen[NONE]} |")
    lines.append(f"| **all** | **{whole.total()}** | **{whole[MET]}** | **{whole[MISSED]}** | **{whole[NONE]}** |")
    return "\n".join(lines) + "\n"


def verdicts_of_engines() -> tuple[int, int]:
    """Scenes on whose verdict the engines agree, and how many of them have it here."""
    kept = stored()["rows"]
    rows = [row for name in kept if name.startswith("engines_") for row in kept[name] if row["quantity"] == "verdict"]
    return len(rows), sum(row["verdict"] == MET for row in rows)


def summary() -> str:
    """The main numbers in a sentence each."""
    kept = stored()["rows"]
    rows = [row for family in kept.values() for row in family]
    applicable = [row for row in rows if row["verdict"] != NONE]
    agreed, same = verdicts_of_engines()
    met = sum(row["verdict"] == MET for row in applicable)
    text = f"Of {len(rows)} rows {len(applicable)} can be judged, and {met} are met. "
    text += (
        f"Of {agreed} scenes on whose verdict the engines agree, {same} have it here ({100.0 * same / agreed:.0f} %). "
    )
    return text + f"Computed on {stored()['date']}."


def listed(*verdicts: str, only: str = "") -> str:
    """Rows with one of some verdicts, in Markdown."""
    lines = [
        "| scene | quantity | reference | spread | here | difference | why |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name, rows in stored()["rows"].items():
        for row in rows:
            if row["verdict"] in verdicts and name.startswith(only):
                cells = [row["scene"], row["quantity"], f"{row['value']} {row['unit']}".removesuffix(" -").strip()]
                cells += [row["spread"], row["ours"], row["difference"], row["why"]]
                lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


@cache
def present() -> bool:
    """Whether the table of references lies beside the project."""
    return (FOLDER / "assemblies_in_space.csv").is_file()


if __name__ == "__main__":
    if not present():
        sys.exit(
            f"{FOLDER} has no assemblies_in_space.csv: the reference rows lie beside the project, and nothing is renewed."
        )
    renew(*sys.argv[1:])
