"""``stylobate survival``: what the age of a column that still stands says about hazard curves."""

from __future__ import annotations

from pathlib import Path

from . import options as o
from .fragility import Curves
from .risk import Site, Source, hazards_of, the_site


def survival(
    source: Source,
    age: str = o.option("AGE", "Years that it has stood as it is, such as 2400y.", ...),
    hazard: list[Path] = o.option("FILE", "Hazard curve; repeat it to compare several.", ...),
    *,
    asked: Curves,
    site: Site = None,
    execution: o.Plain,
) -> None:
    """Survival: the probability that a column would still stand after its age, for each of several hazard curves."""
    from ..analysis.hazard import read_hazard
    from ..analysis.risk import parse_age
    from ..analysis.risk import survival as survive
    from ..errors import InputError
    from ..results.sources import kept_of
    from . import console

    years = parse_age(age)
    hazards = [read_hazard(one, the_site(site)) for one in hazard]
    names = [one.name for one in hazards]
    if len(set(names)) < len(names):
        raise InputError(
            f"two hazard curves have the same name ({', '.join(names)}); give each file a name of its own.",
            "hazard",
        )
    fragility, used = asked.one(source)
    found = survive(fragility, years, hazards)
    result = found.summary()
    with execution.files("survival", "survival.csv", "survival.json", "survival") as files:
        if files.wanted:
            import pandas

            from .. import plots

            files.table(pandas.DataFrame(result["hazards"]), "survival.csv")
            files.picture(plots.draw_survival(found), "survival")
            files.asked(**kept_of(used), **hazards_of(hazard, site), state=asked.state, age_y=years)
            files.summary(result, "survival.json")
    if execution.emits(result):
        return
    for one in result["hazards"]:
        low, high = one["survival_probability_low"], one["survival_probability_high"]
        print(
            f"{one['hazard']}: would still stand after {years:g} years with a probability of "
            f"{one['survival_probability']:.2g} (95 %: {low:.2g} to {high:.2g}); weight {one['weight']:.2f}."
        )
    for text in result["warnings"]:
        print(text)
    console.print_files(files)
