"""``stylobate domain``: the safe-unsafe domain of a column over frequency and amplitude."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..campaign.grid import HarmonicGrid
    from ..verdicts.domain import CollapseProbability, Domain
    from .files import Files


@dataclass(frozen=True)
class Grid(o.Group):
    """Motions of a domain, by frequency and amplitude, and the model."""

    model: str | None = o.option("MODEL", "How it is computed; dem2d by default.")
    frequencies: str | None = o.option("F:F:N", "First, last and number, such as 0.33:4:24.")
    amplitudes: str | None = o.option("A:A:N", "Likewise, such as 0.05g:0.6g:32.")
    duration: float | None = o.option("TIME", "Of each motion; 10s.", read=o.time)
    tail: float | None = o.option("TIME", "Go on for this long after each motion; 0s.", read=o.time)

    def study(self, what: str, modelling: o.Modelling) -> HarmonicGrid:
        """The grid of a study file, or of a column with these options."""
        from ..campaign.grid import HarmonicGrid, is_grid, read_grid
        from ..motion.specs import amplitude_range, frequency_range

        if Path(what).is_file() and is_grid(what):
            given = {
                "set" if name == "settings" else name: value for name, value in (vars(self) | vars(modelling)).items()
            }
            if (name := next((name for name, value in given.items() if value is not None), None)) is not None:
                raise InputError(f"{what} is a study file and `{name}` is given as well; state it in the file.", name)
            return read_grid(what)
        for name, example in (("frequencies", "0.33:4:24"), ("amplitudes", "0.05g:0.6g:32")):
            if getattr(self, name) is None:
                raise InputError(f"`{name}` is missing; a domain of a column needs it, e.g. `{name}={example}`.", name)
        return HarmonicGrid(
            modelling.column(what),
            modelling.model(self.model or "dem2d"),
            frequency_range(self.frequencies or ""),
            amplitude_range(self.amplitudes or ""),
            10.0 if self.duration is None else self.duration,
            self.tail or 0.0,
        )


def domain(
    what: str = o.argument("STUDY|COLUMN", "A study file (TOML), or a column: preset or column file."),
    *,
    motions: Grid,
    population: o.Population,
    motion_scatter: Any = o.option(
        "NAME=SIZE,…",
        "How the motions of a cell differ then; amplitude=1%,phase=0.1,across=1%, nothing by default.",
        read=o.scatter,
    ),
    half_step: bool = o.option(None, "Run it again with half of the time step and count what differs.", False),
    modelling: o.Modelling,
    execution: o.Execution,
) -> None:
    """Safe-unsafe domain over frequency and amplitude.

    With --replicates, the probability of collapse over columns like this one. With --out, a domain that was
    interrupted goes on where it was.
    """
    from ..campaign.runs import Stopped
    from ..verdicts.compare import compare_steps
    from ..verdicts.domain import collapse_domain, collapse_probability
    from ..verdicts.verdict import caveat
    from . import console

    study = motions.study(what, modelling)
    grid: tuple[Any, ...] = study.column, study.model, study.frequencies, study.amplitudes, study.duration
    campaign = execution.campaign(population, tail=study.tail)
    likely = population.replicates is not None
    if likely and half_step:
        raise InputError("`half_step` is for a domain without `replicates`; give one of the two.", "half_step")
    if not likely:
        o.for_replicates("motion_scatter", motion_scatter)
    name, pair = "probability" if likely else "domain", None
    with execution.files("domain", *(f"{name}{end}" for end in (".nc", ".csv", ".json", ""))) as files:
        with files.campaign(campaign, "runs" if likely else "cells") as tracked_campaign:
            if likely:
                result: Any = collapse_probability(
                    *grid, motion_scatter=motion_scatter, out=files.folder, campaign=tracked_campaign
                )
            elif half_step:
                pair = compare_steps(*grid, campaign=tracked_campaign)
                result = pair.domain
            else:
                result = collapse_domain(*grid, campaign=tracked_campaign)
        summary = result.summary() | ({"half_step": pair.summary()} if pair else {})
        summary["doubt"] = caveat([study.column], study.model)
        if not result.complete:
            raise Stopped(summary["runs"], summary["runs"] + summary["not_run"], tracked_campaign.ledger)
        if files.wanted:
            (write_probability if likely else write)(result, summary, files)
            files.write_request(
                structures=[study.column], models=[study.model], duration_s=study.duration, tail_s=study.tail
            )
    if execution.emits(summary | {"files": files.names}):
        return
    console.print_doubt(summary)
    (describe_probability if likely else describe)(result, files)
    if pair:
        step = summary["half_step"]
        print(f"With half of the time step {step['differing']} of {step['comparable']} verdicts are different ones.")


def write(result: Domain, summary: dict, files: Files) -> None:
    """The domain, its summary and its figure."""
    from .. import plots

    files += [result.save(files / "domain.nc"), result.save(files / "domain.csv")]
    files.picture(plots.draw_domain(result), "domain")
    files.json(summary, "domain.json")


def write_probability(result: CollapseProbability, summary: dict, files: Files) -> None:
    """The domain with many columns in every cell, likewise."""
    from .. import plots

    files += [files / "probability.nc", files / "probability.csv"]
    files.picture(plots.draw_probability(result), "probability")
    files.json(summary, "probability.json")


def describe_probability(result: CollapseProbability, files: list[Path]) -> None:
    """Print the probabilities for people."""
    from ..campaign.twins import described
    from ..response.words import to_decide
    from ..verdicts.verdict import open_runs
    from . import console

    s = result.summary()
    sentence = (
        f"Of {s['cells']} cells, all columns stand in {s['all_stand']} and all collapse in {s['all_collapse']}; "
        f"{s['some_collapse']} are uncertain"
    )
    sentence += f", {s['no_verdict']} have no verdict." if s["no_verdict"] else "."
    sentence += open_runs(s)
    if s["undecided"]:
        cure = to_decide(result.column, result.provenance["parameters"], float(result.provenance["tail"]))
        sentence += f" {cure[0].upper()}{cure[1:]}."
    facts = {
        "column": result.column.name,
        "model": result.model,
        "columns like this": described(result.replicates, result.scatter, result.seed, result.provenance["left_out"]),
        "time": f"{result.wall_time:.1f} s",
    }
    if result.motion_scatter.given:
        facts["motions like this"] = f"vary by {result.motion_scatter.describe()}"
    if s["band_width_median_g"] is not None:
        width = f"{s['band_width_median_g']:.3g} g (median), up to {s['band_width_largest_g']:.3g} g"
        facts["uncertain band"] = width
    if s["band_open_frequencies"]:
        facts["top of the band not seen"] = f"at {s['band_open_frequencies']} of {len(result.frequencies)} frequencies"
    console.say(sentence, facts, files)


def describe(result: Domain, files: list[Path]) -> None:
    """Print the domain for people."""
    from ..constants import g
    from ..response.words import to_decide
    from . import console

    counts, cells = result.counts, len(result.rows)
    sentence = f"{counts['collapsed']} of {cells} cells collapse, {counts['stands']} stand."
    cure = to_decide(result.column, result.provenance["parameters"], float(result.provenance["tail"]))
    far = f"ended far from rest ({cure})"
    for outcome, meaning in (("undecided", far), ("failed", "could not be computed")):
        if counts[outcome]:
            sentence += f" {counts[outcome]} {meaning} and are not counted as collapse."
    f, a = result.frequencies, result.amplitudes / g
    facts = {
        "column": result.column.name,
        "model": result.model,
        "frequencies": f"{f[0]:g} to {f[-1]:g} Hz, {len(f)}",
        "amplitudes": f"{a[0]:g} to {a[-1]:g} g, {len(a)}",
        "static uplift": f"{result.column.uplift_acceleration / g:.4g} g",
        "time": f"{result.wall_time:.1f} s",
    }
    console.say(sentence, facts, files)
