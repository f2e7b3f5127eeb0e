"""Results of many runs, and of forces at rest, in a report: each kind with its sentence, numbers, picture and limits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from stylobate.bibliography import cite, cite_run
from stylobate.campaign.twins import described
from stylobate.column import Column
from stylobate.constants import g
from stylobate.messages import joined, say
from stylobate.probability.evidence import median_of
from stylobate.probability.ida import FEWEST
from stylobate.probability.studies import StudyResult
from stylobate.probability.suite import factors_in_words, suite_shares
from stylobate.results import Comparison, Kind, Numbers, Result, RunResult, StudyFolder
from stylobate.results.reading import Grid
from stylobate.verdicts.domain import CollapseProbability
from stylobate.verdicts.limit_states import codes_of, shares
from stylobate.verdicts.population import CHANCE, chance_words
from stylobate.verdicts.verdict import open_runs

from . import numbers as n
from .certainty import OF_TWINS
from .chosen import calibration_result, modes_result, records_result
from .critical import critical_result
from .design import design_items, design_of
from .inference import inference_result
from .page import Exact, Facts, Item, Note, Rows, Section
from .pictures import kept
from .record import (
    basis_section,
    headline,
    known_model,
    model_section,
    record_section,
    request_section,
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
    request = result.request
    columns = [structure.stack for structure in result.structures if structure.stack is not None]
    labels = _labels(result)
    if result.kind is Kind.STATES:
        parts = _states(result, columns)
    else:
        verdict, body = _TELL[result.kind](result)
        note = Note([headline(result, verdict[0]), _scope(result.kind)], f"verdict{verdict[1]}")
        parts = [Section(say("Result"), [note, *warnings_of(result, _doubts(result))]), request_section(result)]
        alone = (
            result.kind in FROM_RUNS and "monuments" not in result.summary
        )  # several sites name no runs of one column
        parts += [basis_section(result)] if alone else []
        for label, structure in zip(labels, result.structures[:5], strict=False):
            section = structure_section(structure)
            section = replace(section, title=say("The state “{label}”", label=label)) if label else section
            parts.append(section)
        parts += [motions_section(result)] if request is not None and request.motions else []
        parts.append(Section(say("What was found"), body))
    if result.kind is Kind.PUSHOVER and columns:
        parts.append(code_check(columns[0], result, run))
    if columns and result.kind not in (Kind.LIMIT, Kind.PUSHOVER, Kind.STATES):
        statics = statics_section(columns[0], None)
        if labels[0]:
            statics = replace(statics, items=[say("Of the state “{label}”.", label=labels[0]), *statics.items])
        parts.append(statics)
    models = [str(model["name"]) for model in request.models] if request is not None else []
    models = models or [str(result.summary[key]) for key in ("model",) if key in result.summary]
    if result.kind in (Kind.PUSHOVER, Kind.LIMIT):
        parts.append(static_model())
    elif models:
        parts.append(model_section(models))
    parameters = request.models[0]["parameters"] if request is not None and len(request.models) == 1 else {}
    parts.append(record_section(parameters, versions_of(result)))
    keys = [key for name in models if (kind := known_model(name)) for key in kind.references]
    if isinstance(result, Grid) and result.data.provenance:
        parts.append(sources_section(cite_run(result.data.provenance)))
    else:
        keys += [
            key for motion in (request.motions if request is not None else ()) for key in motion.get("references", ())
        ]
        keys += ["beaumont2002", "fearnhead2012", "mavroeidis2003", "anderson1999"] if result.kind is Kind.INFER else []
        keys += ["baraldi"] if result.kind in (Kind.PUSHOVER, Kind.LIMIT) else []
        parts.append(sources_section(cite(keys)))
    return parts


def _labels(result: Result) -> list[str]:
    """Of each structure the state that it was computed as; empty where there is one, or where its runs name none."""
    kept = result.request.structures if result.request is not None else ()
    names = [str(structure.get("state") or "") for structure in kept]
    return names if len(names) == len(result.structures) > 1 else [""] * max(len(result.structures), 1)


def _states(result: Result, columns: Sequence[Column]) -> list[Section]:
    """Advice and what it rests on; the first state in full, of the others what they differ by."""
    assert isinstance(result, Numbers)
    labels = [str(state["label"]) for state in result.summary["states"]]
    lead = [*advice_notes(result), _scope(result.kind), *warnings_of(result, _doubts(result))]
    parts = [
        Section(say("Result"), lead),
        Section(say("What was found"), states_items(result)),
        request_section(result),
    ]
    parts += [motions_section(result)] if result.request is not None and result.request.motions else []
    for number, (label, structure) in enumerate(zip(labels, result.structures)):
        column = structure.stack
        if number == 0 or column is None or not columns:
            whole = structure_section(structure)
            parts.append(replace(whole, title=say("The state “{label}”", label=label)))
        else:
            parts.append(state_section(column, label, columns[0], labels[0]))
    return [*parts, *([statics_of_states(dict(zip(labels, columns)))] if columns else [])]


def _doubts(result: Result) -> list[str]:
    """Doubts about a result: because of its model, or of the runs of others that it rests on."""
    if result.kind not in FROM_RUNS:
        doubt = result.summary.get("doubt") or ""
        return [part for part in getattr(doubt, "parts", ()) or (doubt,) if part.strip()]
    curves = result.summary.get("curves") or [result.summary]
    return list(dict.fromkeys(text for curve in curves for text in curve.get("warnings") or ()))


def _scope(kind: Kind) -> str:
    """Limits of a result."""
    if kind in (Kind.PUSHOVER, Kind.LIMIT):
        return say(
            "Forces at rest tell when rocking begins and how far the structure can lean; whether it stands an "
            "earthquake, only runs in time tell."
        )
    if kind is Kind.RECORDS:
        return say("This says how the records follow the target. It says nothing about any column under them.")
    if kind is Kind.MODES:
        return say(
            "Frequencies are of small motions on closed joints. They say how stiff joints are, nothing of how the column "
            "rocks or falls."
        )
    return say(
        "This holds for the columns, motions and models named below; what they leave out stands under them. It "
        "is no check against a code."
    )


# -- many runs -----------------------------------------------------------------------------------------------------


def _grid(result: Grid) -> tuple[tuple[str, str], list[Item]]:
    s, data = result.summary, result.data
    if result.kind is Kind.DOMAIN:
        sentence = say(
            "{s[collapsed]} of {s[cells]} cells of frequency and amplitude collapse the column, {s[stands]} "
            "leave it standing.",
            s=s,
        )
        caption = say("Safe–unsafe domain: verdict of each cell over frequency and amplitude.")
    else:
        sentence = say(
            "Of {s[cells]} cells, all {s[replicates]} columns like this one stand in {s[all_stand]} and all "
            "collapse in {s[all_collapse]}; in {s[some_collapse]} it hangs on small differences{rest}",
            s=s, rest=say(", and {count} have no verdict.", count=s["no_verdict"]) if s["no_verdict"] else ".",
        )  # fmt: skip
        caption = say("Probability of collapse from {s[replicates]} columns like this one in every cell.", s=s)
    f, a = data.frequencies, data.amplitudes / g
    pairs = [
        (say("frequencies"), say("{low:g} to {high:g} Hz, {count}", low=f[0], high=f[-1], count=len(f))),
        (say("amplitudes"), say("{low:g} to {high:g} g, {count}", low=a[0], high=a[-1], count=len(a))),
        (
            say("motion of each cell"),
            say("harmonic from rest, {duration:g} s", duration=float(data.provenance["duration"])),
        ),
        (
            say("undecided / failed"),
            f"{s.get('undecided', 0)} / {s.get('failed', 0)}",
        ),
        (say("static acceleration that opens the first joint"), say("{uplift_g:.4g} g", uplift_g=float(s["uplift_g"]))),
    ]
    if isinstance(data, CollapseProbability):
        left_out = data.provenance["left_out"]
        pairs.insert(3, (say("columns like this one"), described(data.replicates, data.scatter, data.seed, left_out)))
        if data.motion_scatter.given:
            pairs.insert(
                4, (say("motions of a cell"), say("vary by {scatter}", scatter=data.motion_scatter.describe()))
            )
    text = say(
        "The motions are harmonic. They show how the column answers to frequency and amplitude; they are no "
        "earthquakes."
    )
    return (sentence + open_runs(s), ""), [Facts(pairs), *kept(result.pictures, result.kind.value, caption), text]


def _suite(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    runs = result.summary["runs"]
    shares = suite_shares(runs)
    rows = [{"motion": run["record"], **run, CHANCE: chance_words(run)} for run in runs]
    keys = ["column", "motion", "factor", "pga_g", "pgv_m_s", "verdict", CHANCE, "peak_top_displacement_m"]
    if "peak_displacement_m" in (runs or [{}])[0]:
        keys[-1] = "peak_displacement_m"
    body = [[share.label, *counts_of(share)] for share in shares]
    items: list[Item] = [
        Rows(
            [say("column"), *COUNTED],
            body,
            joined(" ", [say("Of the same motions for every column."), COUNTED_HOW]),
            numbers=True,
        )
    ]
    caption = say("One row per motion; all measures are in suite.csv.")
    if any(row[CHANCE] for row in rows):
        caption = joined(" ", [caption, OF_TWINS])
    items.append(table(rows, keys, caption, "verdict"))
    items += kept(result.pictures, "suite", say("Peak response against a measure of the records."))
    items += kept(result.pictures, "directions", say("Share of collapses by direction."))
    items += design_items(design_of(result), result.pictures)
    sentences = [*(share.collapses for share in shares), factors_in_words(runs)]
    sentences.append(result.summary.get("sentence") or result.summary.get("undecided", ""))
    return (joined(" ", sentences), " bad" if any(share.exceeded for share in shares) else ""), items


def _ida(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    s = result.summary
    fell = sum(capacity.get("collapses_from") is not None for capacity in s["capacities"])
    curves = s["capacities"]
    sentence = say("Scaled upwards, {fell} of {all} curves end in collapse", fell=fell, all=len(curves))
    sentence = joined("; ", [sentence, median_of(s) if curves else ""]) + "."
    rows = [{"motion": capacity["record"], **capacity} for capacity in s["capacities"]]
    keys = ["motion", "realisation", "stands_until", "collapses_from", "resurrections", "runs", "open"]
    items: list[Item] = [table(rows, keys, say("Capacity under each motion."))]
    items += kept(result.pictures, "ida", say("Response over the intensity, a curve for each record."))
    if max((measure.get("records") or 0 for measure in s.get("measures") or ()), default=0) >= FEWEST:
        items.append(
            table(
                s["measures"],
                ["measure", "unit", "beta", "beta_low", "beta_high", "sigma_ln_edp", "records"],
                say("Which measure of the motions tells most: the smaller its dispersion β, the more."),
            )
        )
        items += kept(result.pictures, "measures", say("Dispersion of the capacities in each measure."))
    return (sentence + open_runs(s), ""), items


def _compare(result: Comparison) -> tuple[tuple[str, str], list[Item]]:
    rows = result.table.astype(object).where(result.table.notna(), None).to_dict("records")
    if result.responses:
        for row in rows:
            open_ = "" if row["decided"] or row["outcome"] == "failed" else say(", undecided")
            row["model"], row["outcome"] = Exact(row["model"]), say(str(row["outcome"]).replace("_", " ")) + open_
        comparison = joined("; ", (say("{row[model]} {row[outcome]}", row=row) for row in rows))
        top = "peak_top_displacement_m" in result.table
        farthest = say("Displacement of the body that has moved farthest of each model under the same motion.")
        caption = say("Top displacement of each model under the same motion.") if top else farthest
        sentence = say("Models under one motion: {said}.", said=comparison)
        went = [f"{when}_{'top_' * top}displacement_m" for when in ("peak", "residual")]
        keys = ["model", "outcome", "collapse_time_s", *went, "energy_imbalance"]
    else:
        differ = say("{row[first]} and {row[second]} differ in {row[differing]} of {row[comparable]} cells{open}")
        more = say(" and are undecided in {count} more")
        open_ = [more.of(count=row["undecided"]) if row.get("undecided") else "" for row in rows]
        comparison = joined(", ", (differ.of(row=row, open=text) for row, text in zip(rows, open_, strict=True)))
        sentence, caption = say("Models over one domain: {said}.", said=comparison), say("Boundaries of the domains.")
        keys = list(rows[0])[:7] if rows else []
    text = say("Where models differ, the difference says how far a verdict hangs on the model; none of them is nature.")
    return (sentence, ""), [
        table(rows, keys, say("Measures side by side.")),
        *kept(result.pictures, "comparison", caption),
        *design_items(design_of(result), result.pictures),
        text,
    ]


def _study(result: StudyFolder) -> tuple[tuple[str, str], list[Item]]:
    from stylobate import plots

    from .pictures import picture

    s = result.summary
    words = say(
        "{s[finished]} of {s[cases]} cases of the study are finished: {s[collapsed]} collapse, {s[stands]} stand."
    )
    sentence = words.of(s=s)
    axes = result.study.plan.axes
    pairs = [(say(name), str(len(axes[name]))) for name in ("columns", "motions", "levels", "models")]
    pairs.append((say("realisations of each column"), str(axes["realisations"] or say("none: each column as given"))))
    items: list[Item] = [Facts(pairs)]
    items.append(_shares_of_study(result.study))
    for name, response in result.histories.items():
        film = (
            say("Film strip of the median case: {said}")
            if name == "median"
            else say("Film strip of the worst case: {said}")
        )
        items.append(picture(plots.draw_filmstrip(response), film.of(said=response.sentence)))
    return (sentence + open_runs(s), ""), items


def _shares_of_study(study: StudyResult) -> Rows:
    """Shares by column, model and level: at each level of the cases that are finished for every column and model."""
    axes, codes = study.plan.axes, codes_of(study.verdicts).reshape(study.plan.shape)
    records = np.repeat([str(motion["record"]) for motion in axes["motions"]], study.plan.shape[-1])
    names = [(column["column"], model["model"]) for model in axes["models"] for column in axes["columns"]]
    rows = []
    for place, level in enumerate(axes["levels"]):
        each = codes[:, :, :, place].reshape(len(names), -1)
        for (column, model), share in zip(names, shares(dict(enumerate(each)), records)):
            rows.append([column, model, n.plain(level), *counts_of(share)])
    caption = joined(
        " ", [say("Of the cases that are finished and could be computed for every column and model."), COUNTED_HOW]
    )
    left_out = say(" The first {MOST} of {rows} rows.", MOST=MOST, rows=len(rows)) if len(rows) > MOST else ""
    rows.sort(key=lambda row: row[:2])
    header = [say("column"), say("model"), say("level ({measure})", measure=axes.get("measure")), *COUNTED]
    return Rows(header, rows[:MOST], caption + left_out, numbers=True)


_TELL: dict[Kind, Callable[[Any], tuple[tuple[str, str], list[Item]]]] = {
    Kind.PUSHOVER: pushover_result,
    Kind.LIMIT: limit_result,
    Kind.MODES: modes_result,
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
