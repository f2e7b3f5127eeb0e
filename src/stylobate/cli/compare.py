"""``stylobate compare``: several models side by side, under one motion or over one domain."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

from ..errors import InputError
from . import options as o
from .files import WRITES, describe_design, write_design

if TYPE_CHECKING:
    from .files import Files


@dataclass(frozen=True)
class Several(o.Modelling):
    """How what stands is computed by each of several models."""

    settings: list[str] | None = o.option(
        "MODEL.NAME=VALUE", "Option of one of the models; may be repeated.", flag="--set"
    )


def compare(
    column: str = o.argument(
        "COLUMN", "Name of a preset, or a file (TOML) of a column; under one motion also of an assembly."
    ),
    models: str = o.option(
        "A,B,C", "Models to compare, such as housner,dem2d; with options, such as dem3d:planar=true,dem3d.", ...
    ),
    *,
    motions: Annotated[o.Motions, o.Without(*o.SEVERAL)],
    frequencies: str | None = o.option("F:F:N", "Compare domains: such as 0.33:4:24."),
    amplitudes: str | None = o.option("A:A:N", "Compare domains: such as 0.05g:0.6g:32."),
    duration: float = o.option("TIME", "Of each motion of a domain.", "10s", read=o.time),
    following: o.Following,
    modelling: Several,
    execution: o.Execution,
) -> None:
    """Several models side by side: histories and measures under one motion, or verdicts over a domain.

    States of one column, as built, as found and with a measure, are compared by 'stylobate states'.
    """
    import pandas

    from ..motion.orientation import keep_axes
    from ..motion.specs import amplitude_range, frequency_range
    from ..probability.design import design_values
    from ..verdicts.compare import compare_domains, compare_models
    from ..verdicts.verdict import caveat
    from . import console

    names = [name.strip() for name in models.split(",")]
    if len(set(names)) != len(names):
        raise InputError(f"`models` is {models!r}, with a model given twice; give each once.", "models")
    campaign = execution.campaign(following)
    over_domain = frequencies is not None or amplitudes is not None
    stone: Any = (modelling.column if over_domain else modelling.structure)(column)
    chosen = modelling.models([_chosen(name, names, modelling.settings) for name in names])
    result: dict[str, Any] = {"models": names, "doubt": caveat([stone], *chosen)}
    facts: dict[str, str] = {}
    designed = pandas.DataFrame()
    what: dict[str, Any] = {"structures": [stone], "models": chosen, "labels": names, "tail_s": campaign.tail}
    if over_domain:
        if frequencies is None or amplitudes is None:
            raise InputError("a domain needs both `frequencies` and `amplitudes`; give both.", "frequencies")
        if motions.harmonic or motions.pulse or motions.synthetic or motions.motion:
            raise InputError(
                "both a motion and a domain are given; give a motion, or `frequencies` and `amplitudes`.", "frequencies"
            )
        if following.whole:
            raise InputError("`whole` is for records, and a domain has none; leave it out.", "whole")
        grid = frequency_range(frequencies), amplitude_range(amplitudes), duration
        each = [file_name for name in names for file_name in (f"domain-{_stem(name)}.nc", f"domain-{_stem(name)}")]
        with execution.files("compare", "comparison.csv", "comparison", *each) as files:
            with files.campaign(campaign, "cells") as tracked_campaign:
                domains = compare_domains(stone, chosen, *grid, labels=names, campaign=tracked_campaign)
            if files.wanted:
                _write_domains(domains, files)
                files.write_request(**what, duration_s=grid[2])
        table = domains.table
        result |= {"domains": [domain.summary() for domain in domains.domains], "differences": table.to_dict("records")}
    else:
        execution.refuse_for_one("is for domains, and one motion is run here; leave it out.")
        shaking = motions.request().motion(stone.frequency_parameter)
        each = [f"response-{_stem(name)}.nc" for name in names]
        with execution.files("compare", "comparison.csv", "comparison", *WRITES, *each) as files:
            places = [files / file_name for file_name in each] if files.wanted else []
            with files.campaign(campaign.of_runs, "models") as tracked_campaign:
                comparison = compare_models(
                    stone, shaking, chosen, labels=names, files=places, campaign=tracked_campaign
                )
            designed = design_values(comparison)
            if files.wanted:
                from .. import plots

                files.table(comparison.table, "comparison.csv")
                files += places
                files.picture(plots.draw_comparison(comparison.responses, labels=comparison.labels), "comparison")
                write_design(designed, files)
                files.write_request(**what, motions=[shaking])
        runs = [
            response.summary() | {"left_out": o.input_facts(model.taken(shaking))["left_out"]}
            for model, response in zip(chosen, comparison.responses, strict=True)
        ]
        shared = keep_axes(shaking, "".join(model.axes for model in chosen))  # what some of the models take
        table, facts = comparison.table, o.input_lines(shared)
        result |= o.input_facts(shared) | {"runs": runs, "design_values": designed.to_dict("records")}
    result["files"] = files.names
    if execution.emits(result):
        return
    console.print_doubt(result)
    for name, text in facts.items():
        print(f"{name}: {text}")
    if over_domain:
        console.print_table(table)
    else:
        shown_table = table.drop(
            columns="bodies", errors="ignore"
        )  # each has measures of its own, which the files hold
        console.print_side_by_side(shown_table)
        describe_design(designed)
    console.print_files(files)


def _chosen(label: str, labels: list[str], settings: list[str] | None) -> tuple[str, list[str]]:
    """The model that a label names, with its options: those behind colons, and those of --set."""
    name, *own = label.split(":")
    return name, [*own, *_settings_of(label, labels, settings)]


def _stem(label: str) -> str:
    """A label as a part of a file's name."""
    return label.replace(":", "-").replace("=", "-")


def _settings_of(name: str, names: list[str], settings: list[str] | None) -> list[str]:
    mine = []
    for text in settings or []:
        model, dot, setting = text.partition(".")
        if not dot or model not in names:
            raise InputError(
                f"`set` is {text!r}; write it as model.name=value, the model one of {', '.join(names)}.", "set"
            )
        if model == name:
            mine.append(setting)
    return mine


def _write_domains(comparison: Any, files: Files) -> None:
    from .. import plots

    files.table(comparison.table, "comparison.csv")
    for label, domain in zip(comparison.labels, comparison.domains, strict=True):
        files.append(domain.save(files / f"domain-{_stem(label)}.nc"))
        files.picture(plots.draw_domain(domain), f"domain-{_stem(label)}")
    named = [replace(domain, model=label) for label, domain in zip(comparison.labels, comparison.domains)]
    files.picture(plots.draw_boundaries(named), "comparison")
