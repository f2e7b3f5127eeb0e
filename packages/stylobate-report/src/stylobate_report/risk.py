"""Consequences of the runs of other commands: fragility, risk under a hazard, survival over the years."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stylobate.messages import digits, joined, say
from stylobate.probability.fragility import between
from stylobate.probability.risk import years
from stylobate.results import Numbers
from stylobate.verdicts.limit_states import median_words
from stylobate.verdicts.verdict import open_runs

from . import numbers as n
from .page import Exact, Facts, Item, Note
from .pictures import kept
from .tables import table


def fragility_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Median, interval and fit of fragility curves."""
    curves = result.summary.get("curves") or [result.summary]
    first_curve = curves[0]
    sentences = [_of_curve(each) for each in curves[:MOST_LISTED]]
    if len(curves) > MOST_LISTED:
        sentences.append(say("{most_told} more curves stand in the table.", most_told=len(curves) - MOST_LISTED))
    for each in curves:
        each["records"] = None if each.get("records_are_one") else each["records"]
        each["known of the median"] = median_words(each) if each.get("outside") else None
        if each.get("undecided") or each.get("failed"):
            each["median_undecided_both_ways"] = median_words(each)
    keys = ["name", "im", "levels", "known of the median", "median", "median_low", "median_high"]
    keys += ["median_undecided_both_ways", "beta", "records", "runs", "undecided", "p_value"]
    items: list[Item] = [
        table(curves, keys, say("Lognormal curves: median, its interval, dispersion β, and p of the fit."))
    ]
    items += kept(
        result.pictures,
        "fragility",
        say("Probability over the intensity, with its interval over {over}.", over=_over(first_curve)),
    )
    if float(first_curve.get("p_value") or 1.0) < 0.05:
        items.append(Note([say("A lognormal curve fits these points badly; read the points, not the curve.")], "fair"))
    items.append(_HOLDS.of(what=_over(first_curve)))
    return (joined("\n", sentences), ""), items


def _of_curve(curve: Mapping[str, Any]) -> str:
    """What one curve says, in sentences."""
    limits = between(curve.get("median_low"), curve.get("median_high"), curve.get("unit") or "-")
    texts = [curve["sentence"], say("The 95 % interval of the median is {limits}.", limits=limits)]
    if curve.get("outside"):
        above = say(
            "{one[name]}: the fitted median of {state} ({one[im]}) lies above all runs ({levels}); 95 % interval: {limits}."
        )
        below = say(
            "{one[name]}: the fitted median of {state} ({one[im]}) lies below all runs ({levels}); 95 % interval: {limits}."
        )
        words = above if curve["median"] > curve["levels"][1] else below
        texts = [
            words.of(
                one=curve,
                state=say(curve["state"]),
                levels=between(*curve["levels"], curve.get("unit") or "-", 3),
                limits=limits,
            )
        ]
    elif curve.get("bracket"):
        texts.append(say("How capacities scatter is not seen."))
    return joined(" ", texts) + open_runs(curve, say("left out of the curve, and counted both ways in its interval"))


#: Most curves whose medians are told in sentences.
MOST_LISTED = 6

#: Limits of the intervals of a fragility.
_HOLDS = say("The interval is over {what}: it does not hold what the model or the survey may be wrong about.")


def _over(curve: Mapping[str, Any]) -> str:
    """Population of the interval of a curve."""
    return say("runs") if curve.get("records_are_one") else say("records")


def risk_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Rate per year, and its basis."""
    s = result.summary
    period = s.get("return_period_y")
    once, never = say("{name}: {state} once in {years} on average."), say("{name}: {state} never, under this hazard.")
    state, rare = say(s.get("state", "collapse")), isinstance(period, float)
    sentence = (once if rare else never).of(
        name=s.get("name", say("The column")), state=state, years=years(period) if rare else ""
    )
    low, high = n.plain(s.get("annual_rate_low")), n.plain(s.get("annual_rate_high"))
    known, unit = s.get("fragility") or {}, "" if s.get("unit") in (None, "-") else f" {s['unit']}"
    if s.get("hazard_statistic"):
        sentence += say(" The hazard curve is the {statistic}.", statistic=say(s["hazard_statistic"]))
    if n.NONE not in (low, high):
        sentence += say(" The annual rate lies between {low} and {high} (95 %).", low=low, high=high)
    pairs = [
        (
            say("annual rate [1/year]"),
            say("{annual_rate} ({low} to {high}, 95 %)", annual_rate=n.plain(s["annual_rate"]), low=low, high=high),
        ),
        (say("hazard"), Exact(s.get("hazard"))),
        *([(say("statistic of the hazard"), say(s["hazard_statistic"]))] if s.get("hazard_statistic") else []),
        (
            say("intensity"),
            f"{s.get('im')}{unit and f' [{unit.strip()}]'}",
        ),
    ]
    if known:
        median, beta = (between(known[f"{name}_low"], known[f"{name}_high"]) for name in ("median", "beta"))
        levels = between(*known["levels"], digits=3)
        counted = [*(["records"] * (_over(known) == "records")), "runs", "exceeded", "undecided", "failed"]
        limited = say("{value} ({limits}, 95 %)")
        pairs += [
            (say("median of the fragility"), limited.of(value=median_words(known), limits=median)),
            (say("dispersion β of the fragility"), limited.of(value=n.plain(known["beta"]), limits=beta)),
            (say("intensities of its runs"), say("{levels}{unit}", levels=levels, unit=unit)),
            (joined(" / ", map(say, counted)), joined(" / ", (str(known[key]) for key in counted))),
            (say("p of its fit"), n.plain(known["p_value"])),
        ]  # fmt: skip
    items: list[Item] = [Facts(pairs), *kept(result.pictures, "risk", say("Where the rate comes from, by intensity."))]
    items.append(_HOLDS.of(what=_over(known)))
    return (sentence, ""), items


def survival_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """The chance of having stood so long, under each hazard curve."""
    s = result.summary
    if "monuments" in s:
        return _weighing(result)
    keys = [
        "hazard",
        *(["hazard_statistic"] if any(hazard.get("hazard_statistic") for hazard in s["hazards"]) else []),
        "annual_rate",
        "survival_probability",
        "survival_probability_low",
        "survival_probability_high",
        "weight",
    ]
    listing = joined(
        ", ",
        (say("{hazard[hazard]}: {survives}", hazard=hazard, survives=_survives(hazard)) for hazard in s["hazards"]),
    )
    sentence = say(
        "Probability that the column would still stand after {age_y} years, by hazard curve: {said}.",
        age_y=n.plain(s.get("age_y")),
        said=listing,
    )
    items: list[Item] = [table(s["hazards"], keys, say("Hazard curves compared."))]
    items += kept(result.pictures, "survival", say("Probability of having stood, over the years."))
    return (sentence, ""), items


def _survives(hazard: Mapping[str, Any]) -> str:
    """A probability with its interval, where it has one."""
    best, low, high = (hazard.get(f"survival_probability{end}") for end in ("", "_low", "_high"))
    return digits(best, ".2g") + (
        say(" ({low:.2g}–{high:.2g}, 95 %)", low=low, high=high) if low is not None and high is not None else ""
    )


def _weighing(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Branches, monuments and sites of a logic tree that several monuments weigh."""
    s = result.summary
    keys = ["hazard", "prior_weight", "weight", "weight_if_own", "weight_if_shared"]
    keys += ["probability", "probability_low", "probability_high"]
    shown = sorted(s["hazards"], key=lambda hazard: -max(hazard["prior_weight"], hazard["weight"]))
    items: list[Item] = [
        table(
            shown,
            keys,
            say(
                "Branches: weight before and after, if each site had its own earthquakes and if all shook every "
                "site; and the probability of what is seen, with 95 % over what is not known of fragilities and ages."
            ),
        )
    ]
    items += kept(
        result.pictures, "survival", say("Branches, monuments and hazard curves, grey before and blue after.")
    )
    caption = say("What each monument tells of the branches, by itself and beside the others [bits].")
    items.append(table(s["monuments"], ["monument", "seen", "bits_alone", "bits_beside_others"], caption))
    caption = say("Exceeded once in 475 years, by the mean curve [{s[unit]}].", s=s)
    items.append(table(s["sites"], ["site", "once_in_475_years_before", "once_in_475_years"], caption))
    items.append(say("Earthquakes are taken as {s[earthquakes]}. Hazards beyond the branches are not in it.", s=s))
    return (s["sentence"], ""), items
