"""What the page on nature shows: computed where the measurements lie beside the project, else from the stored numbers."""

import json
from contextlib import nullcontext
from pathlib import Path

from stylobate.errors import InputError
from stylobate.plots.film import write_player
from stylobate_studies.experiments import study
from stylobate_studies.experiments.choices import CHOICES
from stylobate_studies.experiments.granite import again

HERE = Path(__file__).parent

#: Beside the project, and the numbers that are stored.
BESIDE, STORED = HERE.parents[2] / "shared" / "experiments", HERE.parent / "evidence" / "nature.json"


def computed(out):
    """The tables of the page."""
    stored = json.loads(STORED.read_text(encoding="utf-8"))
    summary, wrong = stored["summary"], stored["worst"]
    note = f"Computed on {summary['date']}; digest of the tables {stored['digest'][:12]}."
    shown = "Their films are on the page where the files lie beside the project when it is built."
    try:
        experiments = study.read(BESIDE)
        results = study.compute(experiments, calibrate=False, bars=lambda _: nullcontext(), ledger=None)
        if {"granite", "cube"} <= set(results.summary):
            summary, note = results.summary, "Computed when this page was built, from the files beside the project."
            wrong = results.tables["granite_worst"].to_dict("records")
            shown = films(experiments.granite, wrong, out / "static" / "films")
    except InputError:
        pass
    return [
        (out / "nature_choices.md", choices()),
        (out / "nature_granite.md", granite(summary) + f"\n{note}\n"),
        (out / "nature_cube.md", cube(summary) + f"\n{note}\n"),
        (out / "nature_worst.md", worst(wrong) + f"\n{shown}\n"),
        (out / "nature_probabilities.md", probabilities(stored["probabilities"])),
    ]


def films(granite, rows, folder):
    """Films of some tests as they are computed, and the text that shows them."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["```{raw} html"]
    for row in rows:
        name, number = row["specimen"], row["test"]
        file = f"{name}_{number}.html"
        write_player(again(granite, name, number), folder / file, frames_per_second=20.0)
        verdicts = ["toppled" if row[key] else "stood" for key in ("observed", "computed")]
        lines += [
            f"<details><summary>Film: {name}, test {number}, computed ({verdicts[1]}; the stone {verdicts[0]})</summary>",
            f'<iframe src="../_static/films/{file}" loading="lazy" width="100%" height="660" '
            f'title="{name}, test {number}"></iframe></details>',
        ]
    return "\n".join([*lines, "```"])


def probabilities(stored):
    """Scores of the probabilities, and how they stand to what was observed."""
    lines = ["| | Brier score | of the mean share | of the logistic fit |", "| --- | --- | --- | --- |"]
    for name in ("SP1", "SP2"):
        lines.append(f"| {name} | {' | '.join(f'{score:.3f}' for score in stored['brier'][name])} |")
    lines += [
        "",
        "| computed probability | SP1: tests | toppled | SP2: tests | toppled |",
        "| --- | --- | --- | --- | --- |",
    ]
    for k, (low, high) in enumerate(zip((0, 0.2, 0.4, 0.6, 0.8), (0.2, 0.4, 0.6, 0.8, 1))):
        cells = [cell for name in ("SP1", "SP2") for cell in stored["reliability"][name][k]]
        shown = [str(cell) if isinstance(cell, int) else "–" if cell is None else f"{cell:.2f}" for cell in cells]
        lines.append(f"| {low:g} to {high:g} | {' | '.join(shown)} |")
    note = f"{stored['realisations']} realisations of all 252 tests, computed on {stored['date']}."
    return "\n".join([*lines, "", note]) + "\n"


def choices():
    """What was fixed by argument."""
    rows = [f"| {choice.what} | {choice.value} | {choice.reason} | {choice.date} |" for choice in CHOICES]
    return "\n".join(["| | fixed at | reason | date |", "| --- | --- | --- | --- |", *rows]) + "\n"


def granite(summary):
    """Scores of the two specimens."""
    lines = [
        "| | tests | right | 95 % | hard | right | Matthews | predicted / observed topplings | missed | false |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name in ("SP1", "SP2"):
        row = summary["granite"][name]
        lines.append(
            f"| {name} | {row['tests']} | {row['accuracy']:.3f} | {row['accuracy_low']:.3f} to {row['accuracy_high']:.3f} "
            f"| {row['hard_tests']} | {row['hard_accuracy']:.3f} | {row['matthews']:.3f} "
            f"| {row['predicted']} / {row['observed']} = {row['predicted_over_observed']:.2f} "
            f"| {row['toppled_but_predicted_to_stand']} | {row['stood_but_predicted_to_topple']} |"
        )
    lines += ["", "| PGV at half toppled [m/s] | observed | computed |", "| --- | --- | --- |"]
    for name in ("SP1", "SP2"):
        both = summary["granite"][name]["fragility_pgv_m_s"]
        cells = [
            f"{both[k]['median']:.3f} ({both[k]['median_low']:.3f} to {both[k]['median_high']:.3f}), β {both[k]['beta']:.2f}"
            for k in ("observed", "computed")
        ]
        lines.append(f"| {name} | {cells[0]} | {cells[1]} |")
    return "\n".join(lines) + "\n"


def cube(summary):
    """Errors of the tosses."""
    lines = [
        "| after | tosses | error of position [widths]: median (90 %) | of rotation [°]: median (90 %) |",
        "| --- | --- | --- | --- |",
    ]
    for when, row in summary["cube"]["after"].items():
        lines.append(
            f"| {when} | {row['tosses']} | {row['position_error_widths']:.3f} ({row['position_error_widths_90']:.2f}) "
            f"| {row['rotation_error_deg']:.1f} ({row['rotation_error_deg_90']:.0f}) |"
        )
    share = summary["cube"]["rest_face_accuracy"]
    lines += ["", f"{summary['cube']['tosses']} tosses; {share:.1%} come to rest on the face on which the cube did."]
    return "\n".join(lines) + "\n"


def worst(rows):
    """The tests that are worst computed."""
    lines = [
        "| specimen, test | record | PGA [g] | PGV [m/s] | observed | computed, largest tilt | logistic fit |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for row in rows:
        verdicts = ["toppled" if row[key] else "stood" for key in ("observed", "computed")]
        lines.append(
            f"| {row['specimen']}, {row['test']} | {row['record']} | {row['pga_10hz_g']:.2f} | {row['pgv_m_s']:.2f} "
            f"| {verdicts[0]} | {verdicts[1]}, {row['peak_tilt_deg']:.1f}° | {row['logit']:.2f} |"
        )
    return "\n".join(lines) + "\n"
