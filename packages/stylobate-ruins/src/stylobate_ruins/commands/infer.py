"""``stylobate infer``: what shaking left a ruin as it is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate.cli import options as o

if TYPE_CHECKING:
    from ..infer import Inference


def infer(
    ruin: Path = o.argument("RUIN", "A ruin file (TOML): columns, what is seen of them, a prior."),
    *,
    tail: float = o.option("TIME", "Go on for this long after the motion, such as 5s.", "3s", read=o.time),
    pictures: bool = o.option(None, "Whether --out has figures too.", True, flag="--pictures/--no-pictures"),
    execution: o.Execution,
) -> None:
    """What shaking was it? Past shaking from columns that stand, have fallen and are out of place.

    Shakes the columns of the ruin by motions drawn from its prior, accepts those that leave it as it is seen, and tells
    their PGV, PGA, period and azimuth. With --out the simulations are kept: the next question to them takes seconds, a
    stopped command goes on, and a larger number of simulations adds to those that are there.
    """
    from stylobate.cli import console
    from stylobate.cli.risk import hazards_of

    from ..infer import infer as infer_from
    from ..ruin_files import read_ruin

    ruin_data, data_files = read_ruin(ruin), ("infer.json", "draws.csv", "observations.csv")
    campaign = execution.campaign(tail=tail)
    with execution.files("infer", *data_files, "infer", "observations", "matches") as files:
        with files.campaign(campaign, "simulations") as kept:
            answer = infer_from(ruin_data, out=files.folder, campaign=kept)
        summary = answer.summary() | {"files": []}
        if files.wanted:
            import pandas

            files.table(answer.draws, "draws.csv")
            files.table(pandas.DataFrame(answer.information), "observations.csv")
            if pictures:
                from ..pictures.inference import draw_matches, draw_observations, draw_posterior

                files.picture(draw_posterior(answer), "infer")
                files.picture(draw_matches(answer), "matches")
                if answer.information:
                    files.picture(draw_observations(answer), "observations")
            what: dict[str, Any] = {
                "structures": list(ruin_data.structures),
                "models": [ruin_data.model],
                "motions": list(ruin_data.prior.records),
            }
            if ruin_data.survival is not None:
                what |= hazards_of([Path(ruin_data.survival.hazard)], None)
            files.write_request(**what, tail_s=campaign.tail, simulations=ruin_data.simulations, seed=ruin_data.seed)
            files.summary(summary, "infer.json")
    if not execution.emits(summary):
        describe(answer)
        console.print_files(files)


def describe(answer: Inference) -> None:
    """Print what the shapes tell, and which of them."""
    import pandas

    from stylobate.cli import console

    print(answer.sentence)
    console.print_table(answer.table.drop(columns="informative").rename(columns=HEADS), digits=3)
    if answer.information:
        rows = [row | {"chance": check.chance} for row, check in zip(answer.information, answer.checks, strict=True)]
        console.print_table(pandas.DataFrame(rows).rename(columns=HEADS), digits=2)
    if answer.records:
        console.print_table(pandas.DataFrame(answer.records).rename(columns=HEADS), digits=3)
    taken, table = answer.taken, answer.answers.table
    matching = len(answer.answers.matching(answer.answers.facts))
    failed = f"; {answer.failed} more could not be computed" if answer.failed else ""
    print(f"{len(taken.which)} accepted of {matching} that match, of {len(table)} simulations{failed}.")


#: Headings of tables for people.
HEADS = {
    "low": "5 %", "high": "95 %", "spread_over_prior": "spread over prior's", "spread_alone": "PGV with it alone",
    "spread_without": "PGV without it", "chance": "chance by the rest", "bayes_factor_against_others": "Bayes factor",
}  # fmt: skip
