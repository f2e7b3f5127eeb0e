"""Consequences of the runs of other commands: fragility, risk under a hazard, survival over the years."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stylobate.analysis.fragility_curve import between
from stylobate.analysis.risk import years
from stylobate.analysis.side_by_side import median_words
from stylobate.analysis.verdicts import open_runs
from stylobate.results import Numbers

from . import numbers as n
from .page import Facts, Item, Note
from .pictures import kept
from .tables import table


def fragility_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Median, interval and fit of fragility curves."""
    curves = result.summary.get("curves") or [result.summary]
    one = curves[0]
    said = [_of_curve(each) for each in curves[:MOST_TOLD]]
    if len(curves) > MOST_TOLD:
        said.append(f"{len(curves) - MOST_TOLD} more curves stand in the table.")
    for each in curves:
        each["records"] = None if each.get("records_are_one") else each["records"]
        each["known of the median"] = median_words(each) if each.get("outside") else None
        if each.get("undecided") or each.get("failed"):
            each["median_undecided_both_ways"] = median_words(each)
    keys = ["name", "im", "levels", "known of the median", "median", "median_low", "median_high"]
    keys += ["median_undecided_both_ways", "beta", "records", "runs", "undecided", "p_value"]
    items: list[Item] = [table(curves, keys, "Lognormal curves: median, its interval, dispersion β, and p of the fit.")]
    items += kept(result.pictures, "fragility", f"Probability over the intensity, with its interval over {_over(one)}.")
    if float(one.get("p_value") or 1.0) < 0.05:
        items.append(Note(["A lognormal curve fits these points badly; read the points, not the curve."], "fair"))
    items.append(_HOLDS.format(_over(one)))
    return ("\n".join(said), ""), items


def _of_curve(one: Mapping[str, Any]) -> str:
    """What one curve says, in sentences."""
    unit = "" if one.get("unit") in (None, "-") else f" {one['unit']}"
    limits = between(one.get("median_low"), one.get("median_high"), one.get("unit") or "-")
    sentence = f"{one['sentence']} The 95 % interval of the median is {limits}."
    if one.get("outside"):
        levels = " to ".join(f"{level:.3g}" for level in one["levels"])
        where = "above" if one["median"] > one["levels"][1] else "below"
        sentence = (
            f"{one['name']}: the fitted median of {one['state']} ({one['im']}) lies {where} all runs ({levels}{unit}); "
        )
        sentence += f"95 % interval: {limits}."
    elif one.get("bracket"):
        sentence += " How capacities scatter is not seen."
    return sentence + open_runs(one, "left out of the curve, and counted both ways in its interval")


#: Most curves whose medians are told in sentences.
MOST_TOLD = 6

#: Limits of the intervals of a fragility.
_HOLDS = "The interval is over {}: it does not hold what the model or the survey may be wrong about."


def _over(curve: Mapping[str, Any]) -> str:
    """Population of the interval of a curve."""
    return "runs" if curve.get("records_are_one") else "records"


def risk_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Rate per year, and its basis."""
    s = result.summary
    period = s.get("return_period_y")
    sentence = f"{s.get('name', 'The column')}: {s.get('state', 'collapse')} " + (
        f"once in {years(period)} on average." if isinstance(period, float) else "never, under this hazard."
    )
    low, high = n.plain(s.get("annual_rate_low")), n.plain(s.get("annual_rate_high"))
    known, unit = s.get("fragility") or {}, "" if s.get("unit") in (None, "-") else f" {s['unit']}"
    if s.get("hazard_statistic"):
        sentence += f" The hazard curve is the {s['hazard_statistic']}."
    if n.NONE not in (low, high):
        sentence += f" The annual rate lies between {low} and {high} (95 %)."
    pairs = [
        ("annual rate [1/year]", f"{n.plain(s['annual_rate'])} ({low} to {high}, 95 %)"),
        ("hazard", n.plain(s.get("hazard"))),
        *([("statistic of the hazard", s["hazard_statistic"])] if s.get("hazard_statistic") else []),
        ("intensity", f"{n.plain(s.get('im'))}{unit and f' [{unit.strip()}]'}"),
    ]
    if known:
        median, beta = (between(known[f"{one}_low"], known[f"{one}_high"]) for one in ("median", "beta"))
        levels = " to ".join(f"{level:.3g}" for level in known["levels"])
        counted = [*(["records"] * (_over(known) == "records")), "runs", "exceeded", "undecided", "failed"]
        pairs += [
            ("median of the fragility", f"{median_words(known)} ({median}, 95 %)"),
            ("dispersion β of the fragility", f"{n.plain(known['beta'])} ({beta}, 95 %)"),
            ("intensities of its runs", f"{levels}{unit}"),
            (" / ".join(counted), " / ".join(str(known[one]) for one in counted)),
            ("p of its fit", n.plain(known["p_value"])),
        ]  # fmt: skip
    items: list[Item] = [Facts(pairs), *kept(result.pictures, "risk", "Where the rate comes from, by intensity.")]
    items.append(_HOLDS.format(_over(known)))
    return (sentence, ""), items


def survival_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """The chance of having stood so long, under each hazard curve."""
    s = result.summary
    if "monuments" in s:
        return _weighing(result)
    keys = [
        "hazard",
        *(["hazard_statistic"] if any(one.get("hazard_statistic") for one in s["hazards"]) else []),
        "annual_rate",
        "survival_probability",
        "survival_probability_low",
        "survival_probability_high",
        "weight",
    ]
    said = ", ".join(f"{hazard['hazard']}: {_survives(hazard)}" for hazard in s["hazards"])
    sentence = (
        f"Probability that the column would still stand after {n.plain(s.get('age_y'))} years, by hazard curve: {said}."
    )
    items: list[Item] = [table(s["hazards"], keys, "Hazard curves compared.")]
    items += kept(result.pictures, "survival", "Probability of having stood, over the years.")
    return (sentence, ""), items


def _survives(hazard: Mapping[str, Any]) -> str:
    """A probability with its interval, where it has one."""
    best, low, high = (hazard.get(f"survival_probability{end}") for end in ("", "_low", "_high"))
    return f"{best:.2g}" + (f" ({low:.2g}–{high:.2g}, 95 %)" if low is not None and high is not None else "")


def _weighing(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Branches, monuments and sites of a logic tree that several monuments weigh."""
    s = result.summary
    keys = ["hazard", "prior_weight", "weight", "weight_if_own", "weight_if_shared"]
    keys += ["probability", "probability_low", "probability_high"]
    shown = sorted(s["hazards"], key=lambda one: -max(one["prior_weight"], one["weight"]))
    items: list[Item] = [
        table(
            shown,
            keys,
            "Branches: weight before and after, if each site had its own earthquakes and if all shook every site; and the "
            "probability of what is seen, with 95 % over what is not known of fragilities and ages.",
        )
    ]
    items += kept(result.pictures, "survival", "Branches, monuments and hazard curves, grey before and blue after.")
    caption = "What each monument tells of the branches, by itself and beside the others [bits]."
    items.append(table(s["monuments"], ["monument", "seen", "bits_alone", "bits_beside_others"], caption))
    caption = f"Exceeded once in 475 years, by the mean curve [{s['unit']}]."
    items.append(table(s["sites"], ["site", "once_in_475_years_before", "once_in_475_years"], caption))
    items.append(f"Earthquakes are taken as {s['earthquakes']}. Hazards beyond the branches are not in it.")
    return (str(s["sentence"]), ""), items
