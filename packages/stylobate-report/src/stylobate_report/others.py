"""Results of many runs, and of forces at rest, in a report: each kind with its sentence, numbers, picture and limits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from stylobate.analysis.efficiency import FEWEST
from stylobate.analysis.ida_curves import median_of
from stylobate.analysis.population import CHANCE, chance_words
from stylobate.analysis.probability import CollapseProbability
from stylobate.analysis.side_by_side import codes_of, shares
from stylobate.analysis.studies import StudyResult
from stylobate.analysis.suite import suite_shares
from stylobate.analysis.verdicts import open_runs
from stylobate.bibliography import cite, cite_run
from stylobate.campaign.twins import described
from stylobate.column import Column
from stylobate.constants import g
from stylobate.results import Comparison, Kind, Numbers, Result, RunResult, StudyFolder
from stylobate.results.kinds import Grid

from . import numbers as n
from .certainty import OF_TWINS
from .chosen import calibration_result, records_result
from .critical import critical_result
from .design import design_items, design_of
from .inference import inference_result
from .page import Facts, Item, Note, Rows, Section
from .pictures import kept
from .record import (
    asked_section,
    basis_section,
    known_model,
    model_section,
    record_section,
    sources_section,
    versions_of,
    warnings_of,
)
from .risk import fragility_result, risk_result, survival_result
from .sequence import until_fall_result
from .shaking import motions_section
from .states import advice_notes, states_items
from .statics import code_check, limit_result, pushover_result, static_model, statics_of_states, statics_section
from .structure import state_section, structure_section
from .tables import COUNTED, COUNTED_HOW, MOST, counts_of, table

#: Kinds that rest on the runs of another command.
FROM_RUNS = (Kind.FRAGILITY, Kind.RISK, Kind.SURVIVAL)


def sections_of(result: Result, run: RunResult | None = None) -> list[Section]:
    """All sections of a result that is not a run.

    Parameters
    ----------
    result : Result
    run : RunResult, optional
        Of the same column in the same report: its motion is the demand in the capacity spectrum check of a pushover.
    """
    asked = result.asked
    columns = [structure.stack for structure in result.structures if structure.stack is not None]
    labels = _labels(result)
    if result.kind is Kind.STATES:
        parts = _states(result, columns)
    else:
        verdict, body = _TELL[result.kind](result)
        note = Note([verdict[0], _scope(result.kind)], f"verdict{verdict[1]}")
        parts = [Section("Result", [note, *warnings_of(result, _doubts(result))]), asked_section(result)]
        alone = (
            result.kind in FROM_RUNS and "monuments" not in result.summary
        )  # several sites name no runs of one column
        parts += [basis_section(result)] if alone else []
        for label, structure in zip(labels, result.structures[:5], strict=False):
            section = structure_section(structure)
            section = replace(section, title=f"The state “{label}”") if label else section
            parts.append(section)
        parts += [motions_section(result)] if asked is not None and asked.motions else []
        parts.append(Section("What was found", body))
    if result.kind is Kind.PUSHOVER and columns:
        parts.append(code_check(columns[0], result, run))
    if columns and result.kind not in (Kind.LIMIT, Kind.PUSHOVER, Kind.STATES):
        statics = statics_section(columns[0], None)
        if labels[0]:
            statics = replace(statics, items=[f"Of the state “{labels[0]}”.", *statics.items])
        parts.append(statics)
    models = [str(model["name"]) for model in asked.models] if asked is not None else []
    models = models or [str(result.summary[key]) for key in ("model",) if key in result.summary]
    if result.kind in (Kind.PUSHOVER, Kind.LIMIT):
        parts.append(static_model())
    elif models:
        parts.append(model_section(models))
    parameters = asked.models[0]["parameters"] if asked is not None and len(asked.models) == 1 else {}
    parts.append(record_section(result, parameters, versions_of(result)))
    keys = [key for name in models if (kind := known_model(name)) for key in kind.references]
    if isinstance(result, Grid) and result.data.provenance:
        parts.append(sources_section(cite_run(result.data.provenance)))
    else:
        keys += [key for motion in (asked.motions if asked is not None else ()) for key in motion.get("references", ())]
        keys += ["beaumont2002", "fearnhead2012", "mavroeidis2003", "anderson1999"] if result.kind is Kind.INFER else []
        keys += ["baraldi"] if result.kind in (Kind.PUSHOVER, Kind.LIMIT) else []
        parts.append(sources_section(cite(keys)))
    return parts


def _labels(result: Result) -> list[str]:
    """Of each structure the state that it was computed as; empty where there is one, or where its runs name none."""
    kept = result.asked.structures if result.asked is not None else ()
    names = [str(one.get("state") or "") for one in kept]
    return names if len(names) == len(result.structures) > 1 else [""] * max(len(result.structures), 1)


def _states(result: Result, columns: Sequence[Column]) -> list[Section]:
    """Advice and what it rests on; the first state in full, of the others what they differ by."""
    assert isinstance(result, Numbers)
    labels = [str(state["label"]) for state in result.summary["states"]]
    lead = [*advice_notes(result), _scope(result.kind), *warnings_of(result)]
    parts = [Section("Result", lead), Section("What was found", states_items(result)), asked_section(result)]
    parts += [motions_section(result)] if result.asked is not None and result.asked.motions else []
    for number, (label, structure) in enumerate(zip(labels, result.structures)):
        column = structure.stack
        if number == 0 or column is None or not columns:
            whole = structure_section(structure)
            parts.append(replace(whole, title=f"The state “{label}”"))
        else:
            parts.append(state_section(column, label, columns[0], labels[0]))
    return [*parts, *([statics_of_states(dict(zip(labels, columns)))] if columns else [])]


def _doubts(result: Result) -> list[str]:
    """Doubts about a result: because of its model, or of the runs of others that it rests on."""
    if result.kind not in FROM_RUNS:
        return [str(result.summary["doubt"])] if result.summary.get("doubt") else []
    curves = result.summary.get("curves") or [result.summary]
    return list(dict.fromkeys(str(text) for curve in curves for text in curve.get("warnings") or ()))


def _scope(kind: Kind) -> str:
    """Limits of a result."""
    if kind in (Kind.PUSHOVER, Kind.LIMIT):
        return (
            "Forces at rest tell when rocking begins and how far the column can lean; whether it stands an earthquake, only "
            "runs in time tell."
        )
    if kind is Kind.RECORDS:
        return "This says how the records follow the target. It says nothing about any column under them."
    return (
        "This holds for the columns, motions and models named below; what they leave out stands under them. It is no check "
        "against a code."
    )


# -- many runs -----------------------------------------------------------------------------------------------------


def _grid(result: Grid) -> tuple[tuple[str, str], list[Item]]:
    s, data = result.summary, result.data
    if result.kind is Kind.DOMAIN:
        sentence = (
            f"{s['collapsed']} of {s['cells']} cells of frequency and amplitude collapse the column, {s['stands']} leave it "
            "standing."
        )
        caption = "Safe–unsafe domain: verdict of each cell over frequency and amplitude."
    else:
        sentence = (
            f"Of {s['cells']} cells, all {s['replicates']} columns like this one stand in {s['all_stand']} and all "
            f"collapse in {s['all_collapse']}; in {s['some_collapse']} it hangs on small differences"
            + (f", and {s['no_verdict']} have no verdict." if s["no_verdict"] else ".")
        )
        caption = f"Probability of collapse from {s['replicates']} columns like this one in every cell."
    f, a = data.frequencies, data.amplitudes / g
    pairs = [
        ("frequencies", f"{f[0]:g} to {f[-1]:g} Hz, {len(f)}"),
        ("amplitudes", f"{a[0]:g} to {a[-1]:g} g, {len(a)}"),
        ("motion of each cell", f"harmonic from rest, {float(data.provenance['duration']):g} s"),
        ("undecided / failed", f"{s.get('undecided', 0)} / {s.get('failed', 0)}"),
        ("static acceleration that opens the first joint", f"{float(s['uplift_g']):.4g} g"),
    ]
    if isinstance(data, CollapseProbability):
        left_out = data.provenance["left_out"]
        pairs.insert(3, ("columns like this one", described(data.replicates, data.scatter, data.seed, left_out)))
        if data.motion_scatter.given:
            pairs.insert(4, ("motions of a cell", f"vary by {data.motion_scatter.describe()}"))
    text = "The motions are harmonic. They show how the column answers to frequency and amplitude; they are no earthquakes."
    return (sentence + open_runs(s), ""), [Facts(pairs), *kept(result.pictures, result.kind.value, caption), text]


def _suite(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    runs = result.summary["runs"]
    found = suite_shares(runs)
    rows = [{"motion": run["record"], **run, CHANCE: chance_words(run)} for run in runs]
    keys = ["column", "motion", "factor", "pga_g", "pgv_m_s", "verdict", CHANCE, "peak_top_displacement_m"]
    if "peak_displacement_m" in (runs or [{}])[0]:
        keys[-1] = "peak_displacement_m"
    body = [[one.label, *counts_of(one)] for one in found]
    items: list[Item] = [
        Rows(["column", *COUNTED], body, f"Of the same motions for every column. {COUNTED_HOW}", numbers=True)
    ]
    caption = "One row per motion; all measures are in suite.csv."
    if any(row[CHANCE] for row in rows):
        caption += f" {OF_TWINS}"
    items.append(table(rows, keys, caption, "verdict"))
    items += kept(result.pictures, "suite", "Peak response against a measure of the records.")
    items += kept(result.pictures, "directions", "Share of collapses by direction.")
    items += design_items(design_of(result), result.pictures)
    return (" ".join(one.collapses for one in found), " bad" if any(one.exceeded for one in found) else ""), items


def _ida(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    s = result.summary
    fell = sum(capacity.get("collapses_from") is not None for capacity in s["capacities"])
    sentence = f"Scaled upwards, {fell} of {len(s['capacities'])} curves end in collapse"
    sentence += f"; {median_of(s)}." if s["capacities"] else "."
    rows = [{"motion": capacity["record"], **capacity} for capacity in s["capacities"]]
    keys = ["motion", "realisation", "stands_until", "collapses_from", "resurrections", "runs", "open"]
    items: list[Item] = [table(rows, keys, "Capacity under each motion.")]
    items += kept(result.pictures, "ida", "Response over the intensity, a curve for each record.")
    if max((one.get("records") or 0 for one in s.get("measures") or ()), default=0) >= FEWEST:
        items.append(
            table(
                s["measures"],
                ["measure", "unit", "beta", "beta_low", "beta_high", "sigma_ln_edp", "records"],
                "Which measure of the motions tells most: the smaller its dispersion β, the more.",
            )
        )
        items += kept(result.pictures, "measures", "Dispersion of the capacities in each measure.")
    return (sentence + open_runs(s), ""), items


def _compare(result: Comparison) -> tuple[tuple[str, str], list[Item]]:
    rows = result.table.astype(object).where(result.table.notna(), None).to_dict("records")
    if result.responses:
        for row in rows:
            open_ = "" if row["decided"] or row["outcome"] == "failed" else ", undecided"
            row["outcome"] = str(row["outcome"]).replace("_", " ") + open_
        said = "; ".join(f"{row['model']} {row['outcome']}" for row in rows)
        top = "peak_top_displacement_m" in result.table
        moves = "Top displacement" if top else "Displacement of the body that has moved farthest"
        sentence, caption = f"Models under one motion: {said}.", f"{moves} of each model under the same motion."
        went = [f"{when}_{'top_' * top}displacement_m" for when in ("peak", "residual")]
        keys = ["model", "outcome", "collapse_time_s", *went, "energy_imbalance"]
    else:
        said = ", ".join(
            f"{row.get('first')} and {row.get('second')} differ in {row.get('differing')} of {row.get('comparable')} cells"
            + (f" and are undecided in {row['undecided']} more" if row.get("undecided") else "")
            for row in rows
        )
        sentence, caption = f"Models over one domain: {said}.", "Boundaries of the domains."
        keys = list(rows[0])[:7] if rows else []
    text = "Where models differ, the difference says how far a verdict hangs on the model; none of them is nature."
    return (sentence, ""), [
        table(rows, keys, "Measures side by side."),
        *kept(result.pictures, "comparison", caption),
        *design_items(design_of(result), result.pictures),
        text,
    ]


def _study(result: StudyFolder) -> tuple[tuple[str, str], list[Item]]:
    from stylobate import plots

    from .pictures import picture

    s = result.summary
    sentence = f"{s['finished']} of {s['cases']} cases of the study are finished: "
    sentence += f"{s['collapsed']} collapse, {s['stands']} stand."
    axes = result.study.plan.axes
    pairs = [(name, str(len(axes[name]))) for name in ("columns", "motions", "levels", "models")]
    pairs.append(("realisations of each column", str(axes["realisations"] or "none: each column as given")))
    items: list[Item] = [Facts(pairs)]
    items.append(_shares_of_study(result.study))
    for name, response in result.histories.items():
        items.append(picture(plots.draw_filmstrip(response), f"Film strip of the {name} case: {response.sentence}"))
    return (sentence + open_runs(s), ""), items


def _shares_of_study(study: StudyResult) -> Rows:
    """Shares by column, model and level: at each level of the cases that are finished for every column and model."""
    axes, codes = study.plan.axes, codes_of(study.verdicts).reshape(study.plan.shape)
    records = np.repeat([str(motion["record"]) for motion in axes["motions"]], study.plan.shape[-1])
    names = [(one["column"], model["model"]) for model in axes["models"] for one in axes["columns"]]
    rows = []
    for place, level in enumerate(axes["levels"]):
        each = codes[:, :, :, place].reshape(len(names), -1)
        for (column, model), share in zip(names, shares(dict(enumerate(each)), records)):
            rows.append([column, model, n.plain(level), *counts_of(share)])
    caption = f"Of the cases that are finished and could be computed for every column and model. {COUNTED_HOW}"
    left_out = f" The first {MOST} of {len(rows)} rows." if len(rows) > MOST else ""
    rows.sort(key=lambda row: row[:2])
    header = ["column", "model", f"level ({axes.get('measure')})", *COUNTED]
    return Rows(header, rows[:MOST], caption + left_out, numbers=True)


_TELL: dict[Kind, Callable[[Any], tuple[tuple[str, str], list[Item]]]] = {
    Kind.PUSHOVER: pushover_result,
    Kind.LIMIT: limit_result,
    Kind.CRITICAL: critical_result,
    Kind.DOMAIN: _grid,
    Kind.PROBABILITY: _grid,
    Kind.SUITE: _suite,
    Kind.IDA: _ida,
    Kind.FRAGILITY: fragility_result,
    Kind.RISK: risk_result,
    Kind.SURVIVAL: survival_result,
    Kind.INFER: inference_result,
    Kind.UNTIL_FALL: until_fall_result,
    Kind.COMPARE: _compare,
    Kind.STUDY: _study,
    Kind.RECORDS: records_result,
    Kind.CALIBRATE: calibration_result,
}
