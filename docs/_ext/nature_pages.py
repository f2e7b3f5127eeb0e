"""What the page on nature shows: computed where the measurements lie beside the project, else from the stored numbers."""

import json
from contextlib import nullcontext
from pathlib import Path

from stylobate.errors import InputError
from stylobate.experiments import study
from stylobate.experiments.choices import CHOICES

HERE = Path(__file__).parent

#: Beside the project, and the numbers that are stored.
BESIDE, STORED = HERE.parents[2] / "shared" / "experiments", HERE.parent / "nature.json"


def computed(out):
    """The tables of the page."""
    stored = json.loads(STORED.read_text(encoding="utf-8"))
    summary, said = (
        stored["summary"],
        f"Computed on {stored['summary']['date']}; digest of the tables {stored['digest'][:12]}.",
    )
    try:
        found = study.read(BESIDE)
        results = study.compute(found, calibrate=False, bars=lambda _: nullcontext(), ledgers=lambda _: None)
        if {"granite", "cube"} <= set(results.summary):
            summary, said = results.summary, "Computed when this page was built, from the files beside the project."
    except InputError:
        pass
    return [
        (out / "nature_choices.md", choices()),
        (out / "nature_granite.md", granite(summary) + f"\n{said}\n"),
        (out / "nature_cube.md", cube(summary) + f"\n{said}\n"),
        (out / "nature_worst.md", worst(stored["worst"])),
    ]


def choices():
    """What was fixed by argument."""
    rows = [f"| {one.what} | {one.value} | {one.reason} | {one.date} |" for one in CHOICES]
    return "\n".join(["| | fixed at | reason | date |", "| --- | --- | --- | --- |", *rows]) + "\n"


def granite(summary):
    """Scores of the two specimens."""
    lines = [
        "| | tests | right | 95 % | hard | right | Matthews | predicted / observed topplings | missed | false |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name in ("SP1", "SP2"):
        one = summary["granite"][name]
        lines.append(
            f"| {name} | {one['tests']} | {one['accuracy']:.3f} | {one['accuracy_low']:.3f} to {one['accuracy_high']:.3f} "
            f"| {one['hard_tests']} | {one['hard_accuracy']:.3f} | {one['matthews']:.3f} "
            f"| {one['predicted']} / {one['observed']} = {one['predicted_over_observed']:.2f} "
            f"| {one['toppled_but_predicted_to_stand']} | {one['stood_but_predicted_to_topple']} |"
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
    for when, one in summary["cube"]["after"].items():
        lines.append(
            f"| {when} | {one['tosses']} | {one['position_error_widths']:.3f} ({one['position_error_widths_90']:.2f}) "
            f"| {one['rotation_error_deg']:.1f} ({one['rotation_error_deg_90']:.0f}) |"
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
    for one in rows:
        verdicts = ["toppled" if one[key] else "stood" for key in ("observed", "computed")]
        lines.append(
            f"| {one['specimen']}, {one['test']} | {one['record']} | {one['pga_10hz_g']:.2f} | {one['pgv_m_s']:.2f} "
            f"| {verdicts[0]} | {verdicts[1]}, {one['peak_tilt_deg']:.1f}° | {one['logit']:.2f} |"
        )
    return "\n".join(lines) + "\n"
