"""What shaking it was, in a report: posteriors, what each observation tells, and whether the ruin is one of shaking."""

from __future__ import annotations

from stylobate.results import Numbers

from .page import Facts, Item, Note
from .pictures import kept
from .tables import table


def inference_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """The sentence of an inference, and its tables and pictures."""
    s, odd = result.summary, [one for one in result.summary["checks"] if one["odd"]]
    rows = [{"parameter": name, **one} for name, one in s["posterior"].items()]
    keys = ["parameter", "median", "low", "high", "spread_over_prior", "informative"]
    items: list[Item] = [
        table(
            rows,
            keys,
            "Posterior with the ends of 90 %; the shapes tell what they leave less than 0.9 of the prior's spread.",
        )
    ]
    items += kept(result.pictures, "infer", "Posterior of the shaking; the prior is grey.")
    if odd:
        said = "; ".join(f"{one['observation']}, where the rest predicts {one['expected']}" for one in odd)
        items.append(Note([f"Not as shaking alone would leave it: {said}."], "verdict bad"))
    seen = [one | {"chance": check["chance"]} for one, check in zip(s["observations"], s["checks"], strict=True)]
    if seen:
        caption = "Spread of ln PGV over the prior's with an observation alone and without it; chance by all else."
        items.append(table(seen, ["observation", "spread_alone", "spread_without", "chance"], caption))
    items += kept(result.pictures, "observations", "Which observation tells what.")
    if s["records"]:
        items.append(
            table(
                s["records"], ["record", "probability", "bayes_factor_against_others"], "Records that it may have been."
            )
        )
    least = "at least " * bool(s["bayes_factor_is_at_least"])
    pairs = [
        ("simulations / that match / accepted", f"{s['simulations']} / {s['matching']} / {s['accepted']}"),
        ("Bayes factor against no earthquake", f"{least}{s['bayes_factor_no_earthquake']:.3g}"),
    ]
    if lasted := s.get("survival"):
        year = lasted["earthquake"]
        pairs += [
            ("Chance of having outlasted all other shaking", f"{lasted['chance']:.2g}, by {lasted['hazard']}"),
            (
                "Earthquakes that leave what is seen",
                f"once in {1.0 / lasted['annual_rate_of_such_earthquakes']:,.3g} years",
            ),
            ("Year of the earthquake", f"{year['median']:.0f}, {year['low']:.0f} to {year['high']:.0f}"),
        ]
    items.append(Facts(pairs))
    items += kept(result.pictures, "matches", "The ruin beside the draws that are nearest to it, in plan.")
    return (str(s["sentence"]), " bad" if odd else ""), items
