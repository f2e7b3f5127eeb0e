"""``stylobate suite``: what every record of a folder does to a column or an assembly."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Annotated, Any

from . import options as o
from .files import WRITES, describe_design, write_design

#: Columns of the table that are printed.
PRINTED_COLUMNS = (
    "number",
    "motion",
    "factor",
    "pga_g",
    "pgv_m_s",
    "pga_over_g_tan_alpha",
    "verdict",
    "outcome",
    "chance",
    "peak_top_displacement_m",
    "peak_displacement_m",
    "links_broken",
)


def suite(
    column: str = o.COLUMN,
    sources: list[Path] = o.argument("DIR|FILE...", "Folders of records, or records."),
    model: str = o.model(),
    also: list[str] | None = o.option("COLUMN", "A further column, or assembly; may be repeated."),
    against: str = o.option("MEASURE", "Measure of the records on the axis of the figure.", "pgv_m_s"),
    *,
    motions: Annotated[o.Motions, o.Without(*o.FILES_NAMED)],
    following: o.Following,
    modelling: o.Modelling,
    population: o.Population,
    execution: o.Execution,
) -> None:
    """Shake a column, or an assembly of blocks (dem2d, in space dem3d), with every record of a folder.

    A table of outcomes and of measures of the records; with --out, a figure of the peak response against one of them. With
    --replicates, how sure each verdict is; with --azimuths or --signs, from where the shaking does most harm.
    """
    import pandas

    from ..errors import InputError
    from ..messages import say
    from ..models.shared.ground import share_of
    from ..probability.suite import check_measure, factors_in_words, suite_shares, suite_table
    from ..response.words import to_decide
    from ..verdicts.directions import compass_of_shares, harm_words, may_collapse, worst
    from ..verdicts.population import CHANCE, chance_words
    from . import console

    campaign = execution.campaign(following, population)
    stones: list[Any] = [modelling.structure(name) for name in (column, *(also or ()))]
    check_measure(against, stones)
    names = [stone.name for stone in stones]
    if len(set(names)) < len(names):
        raise InputError(f"two columns have the same name ({', '.join(names)}); give each a name of its own.", "also")
    how = modelling.model(model)
    records = motions.request(motion=sources, separate=True).expand()
    with execution.files("suite", "suite.csv", "suite.json", "suite", "directions", *WRITES) as files:
        with files.campaign(campaign) as tracked_campaign:
            table = suite_table(stones, records.motions, how, campaign=tracked_campaign)
        turned = any(
            "direction" in motion.metadata for motion in records.motions
        )  # else azimuths are those of instruments
        swept = turned and len(table[["azimuth_deg", "reversed"]].drop_duplicates()) > 1
        counts = {name: Counter(rows["verdict"]) for name, rows in table.groupby("column", sort=False)}
        result = {
            "runs": table.astype(object).where(table.notna(), None).to_dict("records"),
            "verdicts": counts,
            "inputs": [o.input_facts(how.taken(motion)) for motion in records.motions],
            "quiet_share": max(share_of(motion, following.whole) for motion in records.motions),
            "refused": records.refused,
            "model": how.name,
            "doubt": table.attrs["doubt"],
            "design_values": table.attrs["design_values"],
        }
        designed = pandas.DataFrame(table.attrs["design_values"])
        if twins := table.attrs["twins"]:
            result |= {"replicates": campaign.replicates, "twins": twins}
        cure = to_decide(stones[0], how.parameters(), campaign.tail)
        open_ = any(map(may_collapse, result["runs"]))
        result["undecided"] = say("What is undecided: {cure}.", cure=cure) if open_ else ""
        compass = compass_of_shares(result["runs"], cure)
        result["worst"] = worst(result["runs"], compass if swept else None)
        if swept and result["worst"] is not None:
            result |= {"sentence": harm_words(result["worst"], compass), "undecided_directions_deg": compass.undecided}
        shares = suite_shares(result["runs"])
        result["shares"] = [{"column": share.label, **share.counts} for share in shares]
        if files.wanted:
            from .. import plots

            files.table(table, "suite.csv")
            write_design(designed, files)
            files.json(result, "suite.json")
            files.picture(plots.draw_suite(table, against), "suite")
            if swept and len(compass.bearings) > 1:
                files.picture(plots.draw_directions(compass, f"{', '.join(names)}, {how.name}"), "directions")
            taken = [how.taken(motion) for motion in records.motions]
            files.write_request(structures=stones, models=[how], motions=taken, against=against, tail_s=campaign.tail)
            result["files"] = files.names
    if execution.emits(result):
        return
    console.print_doubt(result)
    table["chance"] = [chance_words(row) for row in result["runs"]]
    for column_share, (_, rows) in zip(shares, table.groupby("column", sort=False), strict=True):
        print(column_share.collapses)
        shown = rows.filter(list(PRINTED_COLUMNS))
        shown = shown.rename(columns={"chance": CHANCE}) if any(shown["chance"]) else shown.drop(columns="chance")
        console.print_table(shown, digits=3)
    if scaled := factors_in_words(result["runs"]):
        print(scaled)
    describe_design(designed)
    for name, drawn in twins.items():
        print(f"{drawn['like']} like {name}: {drawn['words']}")
    if "sentence" in result:
        print(result["sentence"])
    elif result["undecided"]:
        print(result["undecided"])
    console.print_left_out(result["inputs"])
    console.print_refused(records.refused)
    console.print_files(files)
