"""``stylobate ida``: every record scaled until the column collapses, in levels that are hunted and filled."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

from . import options as o


def ida(
    column: str = o.STRUCTURE,
    sources: list[Path] = o.argument("RECORDS...", "Records, or folders of them; or sample:NAME."),
    model: str = o.model(),
    im: str = o.option("IM", "Measure that is scaled: pga, pgv, sa:1.0s, avgsa, pgv@geomean …", "pgv"),
    edp: str | None = o.option(
        "MEASURE", "Measure of the response, as a JSON key of stylobate run; the peak displacement by default."
    ),
    levels: str | None = o.option("A:A:N", "Stripes instead of a hunt, such as 0.1m/s:1.0m/s:10."),
    runs: int = o.option("N", "Runs of each record.", 14),
    largest: float = o.option("X", "A record is multiplied by at most this.", 20.0, flag="--largest-factor"),
    about: Path | None = o.option("FILE", "CSV about the records: record, magnitude, distance_km; or QuakeML."),
    *,
    population: o.Population,
    motions: Annotated[o.Motions, o.Without(*o.FILES_NAMED, "azimuths", "scale", "pga")],
    following: o.Following,
    modelling: o.Modelling,
    execution: o.Execution,
) -> None:
    """Incremental dynamic analysis: the response over the intensity, each record scaled until the column collapses.

    Levels are hunted and filled, all records at a time; with the table of which intensity measure tells most.
    """
    from ..codes.records import facts_of_records
    from ..motion.intensity import parse_levels, parse_measure
    from ..probability.evidence import check_response, median_of
    from ..probability.ida import FEWEST, which_tells_most
    from ..probability.ida import ida as analyse
    from ..response.words import to_decide
    from . import console

    campaign = execution.campaign(following, population)
    measure, stone, how = parse_measure(im), modelling.structure(column), modelling.model(model)
    edp = ("peak_displacement_m" if stone.base_width is None else "peak_top_displacement_m") if edp is None else edp
    check_response(edp, stone, how)
    stripes = None if levels is None else parse_levels(levels, measure)
    records = motions.request(motion=sources, separate=True).expand()
    known = facts_of_records(about, sources, records.motions)
    names = "runs.csv", "capacities.csv", "fractiles.csv", "measures.csv", "ida.json", "ida", "measures"
    with execution.files("ida", *names) as files:
        with files.campaign(campaign) as tracked_campaign:
            analysis = analyse(
                stone, records.motions, how, measure, levels=stripes, runs=runs, largest_factor=largest, about=known,
                watch=console.show, campaign=tracked_campaign,
            )  # fmt: skip
        curves = analysis.curves(edp)
        best = which_tells_most(analysis.runs, edp=edp)
        result = analysis.summary() | {
            "edp": edp,
            "measures": best.astype(object).where(best.notna(), None).to_dict("records"),
            "refused": records.refused,
        }
        if files.wanted:
            from .. import plots

            files.table(analysis.runs, "runs.csv")
            files.table(analysis.capacities, "capacities.csv")
            files.table(analysis.fractiles(edp), "fractiles.csv")
            files.picture(plots.draw_ida(analysis, edp), "ida")
            if len(best):
                files.table(best, "measures.csv")
                if any(math.isfinite(beta) for beta in best["beta"]):
                    files.picture(plots.draw_efficiency(best), "measures")
            what = {
                "structures": [stone],
                "models": [how],
                "motions": [how.taken(motion) for motion in records.motions],
            }
            files.write_request(**what, runs=analysis.runs, im=measure.name, edp=edp, tail_s=campaign.tail)
            files.summary(result, "ida.json")
    if execution.emits(result):
        return
    console.print_doubt(result)
    fell = sum(capacity["collapses_from"] is not None for capacity in result["capacities"])
    facts = {
        "runs": f"{result['runs']} of {console.counted(result['records'], 'record')}, {result['wall_s']:.1f} s",
        "collapses": f"{fell} of {console.counted(len(curves), 'curve')} end in collapse",
        "median capacity": f"{median_of(result)}; counted, fragility fits a curve and its interval",
        "resurrections": f"{console.counted(result['resurrections'], 'run')} above a collapse that stand, in "
        f"{console.counted(result['curves_with_resurrections'], 'curve')}",
    }
    if (drawn := analysis.twins) is not None:
        facts[f"{drawn.like} like this"] = drawn.words
    if result["undecided"] or result["failed"]:
        facts["open"] = (
            f"{result['undecided']} undecided, {result['failed']} failed; "
            f"{to_decide(stone, how.parameters(), campaign.tail)}"
        )
    console.say(
        f"{stone.name}, {how.name}: {console.counted(len(curves), 'curve')} over {measure.words}.", facts, files
    )
    if len(best) and (most := int(best["records"].to_numpy().max())) < FEWEST:
        print(f"Which measure tells most is told from {FEWEST} records; there are {most}.")
    elif len(best):
        console.print_table(best.drop(columns=["median", "unit"]).dropna(axis=1, how="all"), digits=3)
    console.print_refused(records.refused)
