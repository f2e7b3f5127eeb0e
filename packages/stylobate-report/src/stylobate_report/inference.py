"""What shaking it was, in a report: posteriors, what each observation tells, and whether the ruin is one of shaking."""

from __future__ import annotations

from stylobate.messages import digits, joined, say
from stylobate.results import Numbers

from .page import Facts, Item, Note
from .pictures import kept
from .tables import table


def inference_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """The sentence of an inference, and its tables and pictures."""
    s, odd = result.summary, [check for check in result.summary["checks"] if check["odd"]]
    rows = [{"parameter": name, **marginal} for name, marginal in s["posterior"].items()]
    keys = ["parameter", "median", "low", "high", "spread_over_prior", "informative"]
    items: list[Item] = [
        table(
            rows,
            keys,
            say(
                "Posterior with the ends of 90 %; the shapes tell what they leave less than 0.9 of the prior's spread."
            ),
        )
    ]
    items += kept(result.pictures, "infer", say("Posterior of the shaking; the prior is grey."))
    if odd:
        listing = joined(
            "; ", (say("{one[observation]}, where the rest predicts {one[expected]}", one=check) for check in odd)
        )
        items.append(Note([say("Not as shaking alone would leave it: {said}.", said=listing)], "verdict bad"))
    seen = [
        observation | {"chance": check["chance"]}
        for observation, check in zip(s["observations"], s["checks"], strict=True)
    ]
    if seen:
        caption = say("Spread of ln PGV over the prior's with an observation alone and without it; chance by all else.")
        items.append(table(seen, ["observation", "spread_alone", "spread_without", "chance"], caption))
    items += kept(result.pictures, "observations", say("Which observation tells what."))
    if s["records"]:
        items.append(
            table(
                s["records"],
                ["record", "probability", "bayes_factor_against_others"],
                say("Records that it may have been."),
            )
        )
    factor = digits(s["bayes_factor_no_earthquake"], ".3g")
    pairs = [
        (
            say("simulations / that match / accepted"),
            " / ".join(str(s[key]) for key in ("simulations", "matching", "accepted")),
        ),
        (
            say("Bayes factor against no earthquake"),
            say("at least {factor}", factor=factor) if s["bayes_factor_is_at_least"] else factor,
        ),
    ]
    if lasted := s.get("survival"):
        year = lasted["earthquake"]
        pairs += [
            (
                say("Chance of having outlasted all other shaking"),
                say("{lasted[chance]:.2g}, by {lasted[hazard]}", lasted=lasted),
            ),
            (
                say("Earthquakes that leave what is seen"),
                say("once in {years:,.3g} years", years=1.0 / lasted["annual_rate_of_such_earthquakes"]),
            ),
            (say("Year of the earthquake"), say("{year[median]:.0f}, {year[low]:.0f} to {year[high]:.0f}", year=year)),
        ]
    items.append(Facts(pairs))
    items += kept(result.pictures, "matches", say("The ruin beside the draws that are nearest to it, in plan."))
    return (s["sentence"], " bad" if odd else ""), items
