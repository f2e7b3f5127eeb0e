"""``stylobate experiments``: open measurements from beside the project, computed again and scored."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate.cli import options as o
from stylobate.errors import InputError

if TYPE_CHECKING:
    from ..experiments.study import Experiments, Results

#: Scores that are printed.
SHOWN = ("tests", "accuracy", "hard_tests", "hard_accuracy", "matthews", "predicted_over_observed", "brier")

#: Most realisations.
MOST = 1000

#: Files that are always the same ones.
WRITES = (
    "experiments.json",
    "granite_tests.csv",
    "granite_verdicts",
    "granite_fragility",
    "cube_tosses.csv",
    "cube_errors",
)


def experiments(
    folder: Path = o.argument("DIR", "Folder that holds experiments, or one of them."),
    realisations: str = o.option("N", "Of what is uncertain about the boulders: a probability each.", "0"),
    calibration: str = o.option("on|off", "Also choose friction and restitution on a part, test on another.", "on"),
    films: bool = o.option(None, "Films (GIF) of the ten worst tests beside their strips.", False),
    *,
    execution: o.Plain,
) -> None:
    """Compute shaking-table tests, of columns in a folder of one form too, and tosses; score them against what was measured.

    A table per experiment; with --out, all tables, pictures, and strips of the ten worst tests of boulders.
    """
    from stylobate.cli import console

    from ..experiments import study

    if not realisations.isdecimal() or int(realisations) > MOST:
        raise InputError(f"`realisations` is {realisations!r}; allowed is a whole number from 0 to {MOST}.")
    if calibration not in ("on", "off"):
        raise InputError(f"`calibration` is {calibration!r}; allowed are on, off.")
    experiments = study.read(folder)
    with console.folder(execution.out, *WRITES) as place:
        results = study.compute(
            experiments,
            realisations=int(realisations),
            calibrate=calibration == "on",
            threads=execution.count,
            bars=console.progress,
            ledger=console.ledger(place),
            earlier=_earlier(place),
        )
        files = [] if place is None else _write(results, experiments, place, films)
    if execution.emits(results.summary | {"files": [str(file) for file in files]}):
        return
    _say(results)
    for why in experiments.refused:
        print(f"not used: {why}")
    if files:
        print(f"{len(files)} files in {files[0].parent}")


def _earlier(place: Path | None) -> dict[str, Any]:
    """What an earlier run of the command wrote into a folder."""
    written = None if place is None else place / WRITES[0]
    return json.loads(written.read_text(encoding="utf-8")) if written is not None and written.is_file() else {}


def _write(results: Results, experiments: Experiments, place: Path, films: bool) -> list[Path]:
    from stylobate import plots
    from stylobate.cli import console

    from ..experiments import pictures

    files = [console.write_table(table, place / f"{name}.csv") for name, table in results.tables.items()]
    files.append(console.write_json(place / "experiments.json", results.summary))
    tables, summary = results.tables, results.summary
    if "granite_tests" in tables:
        table = tables["granite_tests"]
        files += plots.save(pictures.draw_verdicts(table), place / "granite_verdicts")
        drawn = pictures.draw_boulder_fragility(table, tables["granite_half"], summary["granite"])
        files += plots.save(drawn, place / "granite_fragility")
        if "granite_reliability" in tables:
            files += plots.save(pictures.draw_reliability(tables["granite_reliability"]), place / "granite_reliability")
        files += _worst(results, experiments, place, films)
    if "cube_tosses" in tables:
        files += plots.save(pictures.draw_toss_errors(tables["cube_tosses"]), place / "cube_errors")
    for name, experiment in summary.get("tested", {}).items():
        files += plots.save(pictures.draw_tests(tables[f"{name}_tests"], experiment["scores"]), place / f"{name}_tests")
    return files


def _worst(results: Results, experiments: Experiments, place: Path, films: bool) -> list[Path]:
    """Strips, and films, of the worst tests as they are computed."""
    from stylobate import plots
    from stylobate.plots.film import write_gif

    from ..experiments.granite import again

    files: list[Path] = []
    assert experiments.granite is not None
    for rank, row in enumerate(results.tables["granite_worst"].itertuples(), 1):
        trial: Any = row
        response = again(experiments.granite, trial.specimen, trial.test)
        observed, computed = ("toppled" if verdict else "stood" for verdict in (trial.observed, trial.computed))
        title = f"{trial.specimen}, test {trial.test} ({trial.record}): {observed}; computed: {computed}"
        stem = place / f"worst_{rank:02d}_{trial.specimen}_{trial.test}"
        files += plots.save(plots.draw_filmstrip(response, title=title), stem)
        if films:
            target = stem.with_suffix(".gif")
            write_gif(response, target, frames_per_second=10.0)
            files.append(target)
    return files


def _say(results: Results) -> None:
    import pandas

    from stylobate.cli import console

    from ..experiments.measured import sentences

    summary = results.summary
    if "granite" in summary:
        rows = [
            {"specimen": name} | {key: scores[key] for key in SHOWN}
            for name, scores in summary["granite"].items()
            if isinstance(scores, dict)
        ]
        print("Boulders on the shaking table, toppled or not:")
        console.print_table(pandas.DataFrame(rows), digits=3)
        for entry in summary["granite"].get("calibration", ()):
            print(
                f"calibrated on {entry['calibrated_on']}: friction {entry['friction']:g}, "
                f"restitution {entry['restitution']:g}, edges worn to {1e3 * entry['edges_m']:g} mm; "
                f"right on {entry.get('tested_on', 'no other')}: {entry.get('accuracy', float('nan')):.3f}"
            )
    if "cube" in summary:
        entry = summary["cube"]
        print(
            f"{entry['tosses']} tosses of a cube: {entry['rest_face_accuracy']:.1%} rest on the face on which they did."
        )
        rows = [{"after": when} | values for when, values in entry["after"].items()]
        console.print_table(pandas.DataFrame(rows), digits=3)
    for name, entry in summary.get("tested", {}).items():
        for sentence in sentences(entry):
            print(f"{name}: {sentence}")
        console.print_table(results.tables[f"{name}_scores"], digits=3)
