"""A suite of records: what each does to each column or assembly, beside how strong it is."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.campaign import Campaign
from ..campaign.cases import RELATIVE, must_be_alike
from ..campaign.digests import Hasher
from ..campaign.runs import Request, run_all
from ..campaign.twins import the_twins
from ..column.structure import Structure
from ..errors import InputError, check_all, check_choice, check_kind
from ..messages import say
from ..models.base import Case, Model
from ..motion import Motion
from ..motion.intensity import motion_summary, rocking_measures
from ..motion.orientation import record_of
from ..response.response import Response
from ..simulate import simulate
from ..verdicts.directions import direction_of
from ..verdicts.limit_states import Share, codes_of, shares
from ..verdicts.population import Population
from ..verdicts.verdict import NOT_RUN, caveat, verdict
from .design import FINE, values_of_runs

if TYPE_CHECKING:
    import pandas


#: Measures along x that go into the table, by their key in the summary of a motion.
MEASURES = ("pga_g", "pgv_m_s", "arias_m_s", "cav_m_s", "duration_5_75_s", "duration_5_95_s")

SCALARS = ("pgv_over_pga_s", "pulse_period_s", "pulse_energy_share", "housner_intensity_m")

#: Intensity measures that a table holds, by column, in words and with their unit.
INTENSITIES = {
    "pga_g": "peak ground acceleration [g]",
    "pgv_m_s": "peak ground velocity [m/s]",
    "pgv_over_pga_s": "PGV/PGA [s]",
    "arias_m_s": "Arias intensity [m/s]",
    "cav_m_s": "cumulative absolute velocity [m/s]",
    "duration_5_75_s": "significant duration 5–75 % [s]",
    "duration_5_95_s": "significant duration 5–95 % [s]",
    "pulse_period_s": "period of the strongest pulse [s]",
    "pulse_energy_share": "energy share of the strongest pulse [-]",
    "housner_intensity_m": "Housner intensity [m]",
    **{f"psa_{t}s_g": f"pseudo-acceleration at {t} s, 5 % damping [g]" for t in ("0.1", "0.2", "0.5", "1", "2", "4")},
    "pga_over_g_tan_alpha": "PGA/(g tan α) [-]",
    "omega_g_over_p": "ω_g/p [-]",
    "uniform_duration_s": "uniform duration above g tan α [s]",
    "pgv_p_over_g_tan_alpha": "p PGV/(g tan α) [-]",
}


def check_measure(against: str, columns: Sequence[Structure]) -> None:
    """Refuse a measure of records that there is not, or not of assemblies.

    Raises
    ------
    InputError
        The message names those that there are.
    """
    related = all(column.slenderness is not None for column in columns)
    known = [name for name in INTENSITIES if related or name not in RELATIVE]
    check_choice("`against`", against, known)


def suite_table(
    columns: Structure | Sequence[Structure],
    motions: Sequence[Motion],
    model: Model,
    *,
    campaign: Campaign | None = None,
    **settings: Any,
) -> pandas.DataFrame:
    """Shake every column, or every assembly, with every record.

    Parameters
    ----------
    columns : Column or sequence of Column, or the same of Assembly
    motions : sequence of Motion
        E.g. ``read_suite(folder).motions``. The vertical component acts where a motion has one.
    model : Model
    campaign, **settings : Campaign, optional
        With replicates, twins of every column are run under every record as well.

    Returns
    -------
    pandas.DataFrame
        One row per column and motion, ``number`` that of the motion; ``record`` is the same for all directions and signs of
        one: outcome and measures as the JSON keys of
        ``stylobate run``, the factor by which the record was multiplied, and its intensity measures along x, with
        those that relate it to the column (:data:`INTENSITIES`); an assembly has no slenderness. With twins, the probability
        of collapse with its interval, and what 16, 50 and 84 % of them do not exceed; ``attrs["twins"]`` tells by column how
        they differ. Where links act, ``attrs["design_values"]`` has the rows of :func:`stylobate.design_values`, over all
        runs and twins.

    Raises
    ------
    InputError
        Columns and assemblies in one suite, or twins of an assembly in the plane.
    Stopped
        Interrupted (Ctrl-C); a KeyboardInterrupt that says what is kept.
    """
    campaign = Campaign.of("suite_table", campaign, settings)
    import pandas

    stands = check_all("columns", columns, Structure)
    motions = check_all("motions", motions, Motion)
    check_kind("model", model, Model)
    if not stands or not motions:
        what = "record" if stands else "column"
        raise InputError(f"no {what} is given, and a suite without one has no runs; give at least one.")
    must_be_alike(stands, "suite")
    records = [_record(motion) for motion in motions]
    rows: list[dict[str, Any]] = []
    for column in stands:
        for place, (motion, record) in enumerate(zip(motions, records, strict=True), 1):
            named = {"number": place, "record": record_of(motion), "motion": motion.name, "column": column.name}
            named |= direction_of(motion)
            rows.append(named | _of_column(column, motion, record))
    cases = [Case(column, motion) for column in stands for motion in motions]
    own = len(cases)
    number = campaign.replicates
    drawn = [the_twins(column, model, campaign) for column in stands] if number else []
    cases += [Case(twin, motion) for twin_set in drawn for motion in motions for twin in twin_set.columns]
    request = Request.of(cases, Hasher(model, campaign.options), campaign.quiet)
    results = run_all(request, campaign)
    linked: list[dict[str, Any]] = []
    of_linked: list[Case] = []
    for i, (case, row, line) in enumerate(zip(cases[:own], results, rows, strict=False)):
        of_twins: list[dict[str, Any]] = []
        twins = slice(own + i * number, own + (i + 1) * number)
        if row is not None:
            line |= row | {"verdict": verdict(row), "model": model.name}
            if (width := case.column.base_width) is not None:
                line["peak_top_over_base_width"] = row["peak_top_displacement_m"] / width
        if drawn:
            twin_set = drawn[i // len(motions)]
            of_twins = [twin_row for twin_row in results[twins] if twin_row is not None]
            line |= Population(twin_set, tuple(of_twins)).columns
            of_twins = [twin_row | twin_set.law_of(k) for k, twin_row in enumerate(of_twins)]
        if case.column.links:
            own_run = [row] if row is not None else []
            named = {"state": case.column.name, "im": 1.0, "record": line["record"]}
            linked += [run | named | {"verdict": verdict(run)} for run in own_run + of_twins]
            of_linked += [cases[k] for k in (i, *range(twins.start, twins.stop)) if results[k] is not None]
    table = pandas.DataFrame(rows)

    def again(row: int) -> Response:
        case = of_linked[row]
        fine: Any = {"output_interval": FINE, "until_decided": True, "tail": campaign.tail, "quiet": campaign.quiet}
        return simulate(case.column, case.motion, model, **fine)

    values = values_of_runs({column.name: column for column in stands}, pandas.DataFrame(linked), again=again)
    table.attrs["design_values"] = values.to_dict("records")
    table.attrs["doubt"] = caveat(stands, model)
    table.attrs["twins"] = {
        column.name: {"words": twin_set.words, **twin_set.facts} for column, twin_set in zip(stands, drawn)
    }
    return table


def suite_shares(rows: Sequence[Mapping[str, Any]]) -> list[Share]:
    """Shares of the motions that collapse each column of a suite, side by side.

    Parameters
    ----------
    rows : sequence of mapping
        Of the table of a suite.
    """
    names = list(dict.fromkeys(str(row["column"]) for row in rows))
    each = {name: [row for row in rows if str(row["column"]) == name] for name in names}
    codes = {name: codes_of(np.array([row.get("verdict") or NOT_RUN for row in mine])) for name, mine in each.items()}
    return shares(codes, [str(row["record"]) for row in each[names[0]]]) if names else []


def factors_in_words(rows: Sequence[Mapping[str, Any]]) -> str:
    """By how much the motions of a suite are multiplied, from the rows of its table; empty where none is."""
    factors = [float(row["factor"]) for row in rows if row.get("factor") is not None] or [1.0]
    least, most = min(factors), max(factors)
    if least == most == 1.0:
        return ""
    if least == most:
        return say("The motions are multiplied by {least:.3g}.", least=least)
    return say("The motions are multiplied by {least:.3g} to {most:.3g}.", least=least, most=most)


def _of_column(column: Structure, motion: Motion, record: dict[str, Any]) -> dict[str, Any]:
    """Measures of a record, with widths of the column and those that relate it to them; an assembly has none."""
    if column.slenderness is None:
        return record
    return column.widths | record | rocking_measures(motion, math.tan(column.slenderness), column.frequency_parameter)


def _record(motion: Motion) -> dict[str, Any]:
    summary = motion_summary(motion)
    fields: dict[str, Any] = {
        "factor": motion.factor,
        "vertical": motion.vertical is not None,
        "duration_s": motion.duration,
    }
    fields |= {key: summary[key]["x"] for key in MEASURES}
    fields |= {key: summary.get(key) for key in SCALARS}
    return fields | {
        f"psa_{key.replace(' ', '')}_g": value for key, value in summary.get("psa_5_percent_g", {}).items()
    }
