"""``stylobate survival``: what has stood for long, and what has come down, says about hazard curves."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stylobate.cli import options as o
from stylobate.cli.fragility import Curves
from stylobate.cli.risk import SITE, hazards_of, the_site

if TYPE_CHECKING:
    from ..weighing import Weighing


def survival(
    source: Path = o.argument(
        "SOURCE",
        "Folder or CSV file of runs, as risk takes it; or a file of several sites (TOML) with all that is asked.",
    ),
    age: str | None = o.option("AGE", "Years that it has stood as it is, such as 2400y."),
    hazard: list[Path] | None = o.option("FILE", "Hazard curve; repeat it to compare several."),
    *,
    curves: Curves,
    site: str | None = SITE,
    execution: o.Plain,
) -> None:
    """Survival: the probability that a column would still stand after its age, for each of several hazard curves.

    Of a file of several sites: what all their monuments, standing, damaged and fallen, make of the branches of a logic tree.
    """
    if source.suffix.lower() == ".toml":
        _several(source, age, hazard, execution)
        return
    from stylobate.cli import console
    from stylobate.errors import InputError
    from stylobate.probability.risk import read_hazard
    from stylobate.results.command_request import kept_of

    from ..survival import parse_age
    from ..survival import survival as survive

    if age is None or not hazard:
        raise InputError("of runs of one column `age` and `hazard` are needed; give both.", "hazard" if age else "age")
    years = parse_age(age)
    hazards = [read_hazard(path, the_site(site)) for path in hazard]
    names = [curve.name for curve in hazards]
    if len(set(names)) < len(names):
        raise InputError(
            f"two hazard curves have the same name ({', '.join(names)}); give each file a name of its own.",
            "hazard",
        )
    fragility, used = curves.single(source)
    evidence = survive(fragility, years, hazards)
    result = evidence.summary()
    with execution.files("survival", "survival.csv", "survival.json", "survival") as files:
        if files.wanted:
            import pandas

            from ..pictures.inference import draw_survival

            files.table(pandas.DataFrame(result["hazards"]), "survival.csv")
            files.picture(draw_survival(evidence), "survival")
            files.write_request(**kept_of(used), **hazards_of(hazard, site), state=curves.state, age_y=years)
            files.summary(result, "survival.json")
    if execution.emits(result):
        return
    for row in result["hazards"]:
        low, high = row["survival_probability_low"], row["survival_probability_high"]
        statistic = f" ({row['hazard_statistic']})" if row["hazard_statistic"] else ""
        print(
            f"{row['hazard']}{statistic}: would still stand after {years:g} years with a probability of "
            f"{row['survival_probability']:.2g} (95 %: {low:.2g} to {high:.2g}); weight {row['weight']:.2f}."
        )
    for text in result["warnings"]:
        print(text)
    console.print_files(files)


def _several(source: Path, age: str | None, hazard: list[Path] | None, execution: o.Plain) -> None:
    """Weigh the branches of a file of sites."""
    from stylobate.atomic import digest
    from stylobate.cli import console
    from stylobate.errors import InputError

    from ..monuments import read_sites
    from ..weighing import weigh

    if age is not None or hazard:
        raise InputError(f"{source} says ages and hazards itself; leave out `age` and `hazard`.", "age")
    weighing = weigh(read_sites(source))
    result = weighing.summary() | {"files": []}
    with execution.files("survival", "survival.csv", "hazard.csv", "survival.json", "survival") as files:
        if files.wanted:
            import pandas

            from ..pictures.inference import draw_weighing

            rows = [{key: value for key, value in row.items() if key != "annual_rates"} for row in result["hazards"]]
            files.table(pandas.DataFrame(rows), "survival.csv")
            files.table(pandas.DataFrame(weighing.table()), "hazard.csv")
            files.picture(draw_weighing(weighing), "survival")
            files.write_request(sites=f"{source} (SHA-256 {digest(source)})")
            files.summary(result, "survival.json")
    if not execution.emits(result):
        describe(weighing)
        console.print_files(files)


def describe(weighing: Weighing) -> None:
    """Print what the monuments make of the branches."""
    import pandas

    from stylobate.cli import console

    summary = weighing.summary()
    print(summary["sentence"])
    branches = pandas.DataFrame(summary["hazards"]).drop(columns="annual_rates")
    console.print_table(branches.filter(list(HEADS)).rename(columns=HEADS).head(20), digits=2)
    monuments = pandas.DataFrame(summary["monuments"]).drop(columns=["weights_without", "monument"])
    console.print_table(monuments.rename(columns=HEADS | {"seen": "seen"}), digits=2)
    unit = "" if summary["unit"] == "-" else f" {summary['unit']}"
    for site in summary["sites"]:
        before, after = site["once_in_475_years_before"], site["once_in_475_years"]
        if before is not None and after is not None:
            print(f"  {site['site']}: {before:.3g}{unit} once in 475 years before, {after:.3g}{unit} after.")
    for text in summary["warnings"]:
        print(text)


#: Headings of tables for people.
HEADS = {
    "hazard": "branch", "prior_weight": "before", "weight": "after", "weight_if_own": "if none is shared",
    "weight_if_shared": "if all are shared", "probability": "probability of what is seen", "bits_alone": "bits alone",
    "bits_beside_others": "bits beside the others",
}  # fmt: skip
