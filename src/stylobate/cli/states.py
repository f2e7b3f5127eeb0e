"""``stylobate states``: states of one column under the same records: was a measure worth it?"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from ..errors import InputError
from . import options as o
from .files import WRITES, describe_design, write_design

if TYPE_CHECKING:
    from ..campaign.campaign import Campaign
    from ..column.structure import Structure
    from ..models.base import Model
    from ..probability.states import StateComparison


def the_states(
    as_built: str | None, as_found: str | None, strengthened: list[str] | None, fewest: int = 2
) -> dict[str, str]:
    """Columns to be compared, by label; those with a measure are called after their files."""
    columns = {name: text for name, text in (("as built", as_built), ("as found", as_found)) if text is not None}
    for text in strengthened or ():
        label = Path(text).stem
        if label in columns:
            raise InputError(f"two of the states are called {label!r}; rename one of the files.", "states")
        columns[label] = text
    if len(columns) < fewest:
        given = f"only the state {next(iter(columns))!r} is given" if columns else "no state is given"
        raise InputError(f"{given}; give two or more of `as_built`, `as_found` and `with`.", "states")
    return columns


def the_candidates(
    vary: list[str] | None, strengthened: list[str], columns: dict[str, Structure]
) -> dict[str, Structure]:
    """Columns with numbers as typed, ``kind.field=values``, in place of those of the one measure; none without."""
    from ..motion.specs import values_of
    from ..probability.design import candidates

    if not vary:
        return {}
    if len(strengthened) != 1:
        raise InputError(f"`vary` is for one measure, and {len(strengthened)} are given; give one `with`.", "vary")

    def number(text: str) -> float:
        try:
            return float(text)
        except ValueError:
            raise InputError(f"{text!r} is no number; write it in SI without a unit, such as 0.02.", "vary") from None

    variations: dict[str, list[float]] = {}
    for text in vary:
        name, equals, values = text.partition("=")
        if not equals or name in variations:
            why = "is given twice" if equals else "has no values"
            raise InputError(f"{name!r} of `vary` {why}; write each once, such as dowel.diameter=0.02:0.06:5.", "vary")
        variations[name] = values_of("vary", values, number, "0.02:0.06:5").tolist()
    return candidates(columns[Path(strengthened[0]).stem], variations)


def the_design_level(text: str, im: str | None, levels: list[float]) -> float:
    """Level at which design values are told, one of those that run."""
    from ..campaign.study_files import levels_of

    if im is None:
        raise InputError("`design_level` is one of `levels`; give `im` and `levels` with it.", "design_level")
    level = levels_of(im, text)[1][0]
    design_level = next((run_level for run_level in levels if abs(run_level - level) < 1e-6 * level), None)
    if design_level is None:
        known = ", ".join(f"{run_level:g}" for run_level in levels)
        raise InputError(f"`design_level` is {text}; allowed is one of `levels`: {known}.", "design_level")
    return design_level


def states(
    records: list[Path] | None = o.argument("[DIR|FILE]...", "Folders of records, or records; or sample:NAME.", None),
    as_built: str | None = o.option("COLUMN", "Name of a preset, or a file (TOML) of a column or an assembly."),
    as_found: str | None = o.option("COLUMN", "The column as it is found today."),
    strengthened: list[str] | None = o.option("COLUMN", "With a measure; may be repeated.", flag="--with"),
    model: str = o.option("MODEL", "How it is computed.", "dem2d"),
    im: str | None = o.option("MEASURE", "Scale the records to it, such as pgv."),
    levels: str | None = o.option("A:A:N", "Its levels, such as 0.2m/s:1.6m/s:8."),
    design_level: str | None = o.option(
        "A",
        "At which of the levels design values of links are told, such as 0.4m/s; by default one at which few collapse.",
    ),
    vary: list[str] | None = o.option(
        "KIND.FIELD=A:B:N",
        "Candidates for a number or place of the links [SI], such as dowel.diameter=0.02:0.06:5 or dowel.at.x=0,0.1; may be "
        "repeated.",
    ),
    state: str = o.option("STATE", "Limit state, such as collapse or top:0.35d.", "collapse"),
    *,
    population: o.Population,
    motions: Annotated[o.Motions, o.Without(*o.SEVERAL)],
    following: o.Following,
    modelling: o.Modelling,
    execution: o.Execution,
) -> None:
    """States of one column or assembly side by side: as built, as found, with a measure. Was it worth it?

    Fragility curves under the same records with paired differences, and what the links bore.
    """
    from ..campaign.study_files import levels_of
    from ..probability.design import best_of, design_values
    from ..probability.states import NO_MEASURE, compare_states
    from ..verdicts.limit_states import parse_state
    from . import console

    if records and motions.motion:
        raise InputError("records are given before the options and after `motion`; give them once.", "records")
    sources = records or motions.motion
    if not (sources or motions.harmonic or motions.pulse or motions.synthetic):
        raise InputError("no record is given; name a folder of records, or files, before the options.", "records")
    named = the_states(as_built, as_found, strengthened, 1 if vary else 2)
    how = modelling.model(model)
    campaign = execution.campaign(following, population)
    request = motions.request(motion=sources, separate=bool(sources))
    columns = {label: modelling.structure(text) for label, text in named.items()}
    if as_built is not None and getattr(columns["as built"], "as_found", None):
        raise InputError(
            f"`as_built` is {as_built}, and its [as_found] has offsets, tilts or chips; give it with `as_found`, or a file "
            "without them.",
            "as_built",
        )
    tried = the_candidates(vary, strengthened or [], columns)
    columns = {label: column for label, column in columns.items() if not tried or label in NO_MEASURE} | tried
    if (im is None) != (levels is None):
        raise InputError("records are scaled by `im` and `levels` together; give both, such as `im` pgv `levels` "
                         "0.2m/s:1.6m/s:8.", "im")  # fmt: skip
    parse_state(state)
    measure, sizes = (None, [1.0]) if im is None or levels is None else levels_of(im, levels)
    level = None if design_level is None else the_design_level(design_level, im, sizes)
    suite = request.expand()
    with execution.files("states", "states.csv", "links.csv", "states.json", "states", *WRITES) as files:
        with files.campaign(campaign, in_folder=True) as tracked_campaign:
            comparison = compare_states(
                columns, suite.motions, how, sizes, measure, state=state, out=files.folder, campaign=tracked_campaign
            )
        if not execution.as_json:
            describe(comparison)  # first: for design values the runs that govern are computed once more
            sys.stdout.flush()
        designed = design_values(comparison, level=level)
        summary = comparison.summary() | {
            "design_values": designed.to_dict("records"),
            "model": how.name,
            "refused": suite.refused,
            "files": [],
        }
        best = best_of(comparison, list(tried), seed=campaign.seed) if tried else None
        summary |= {} if best is None else {"best": best.summary()}
        if files.wanted:
            from .. import plots

            files.table(comparison.table, "states.csv")
            files.table(comparison.links, "links.csv")
            files.picture(plots.draw_states(comparison), "states")
            write_design(designed, files)
            what: dict[str, Any] = {"structures": list(columns.values()), "models": [how], "states": list(columns)}
            what |= {"motions": [how.taken(motion) for motion in suite.motions], "runs": comparison.table}
            what |= {"im": im, "levels": levels, "limit_state": state, "tail_s": campaign.tail}
            files.write_request(**what, **_twins(columns, how, campaign) if population.replicates is not None else {})
            files.summary(summary, "states.json")
    if execution.emits(summary):
        return
    describe_design(designed)
    if best is not None:
        console.print_table(best.table.dropna(axis=1, how="all"), digits=3)
        print(best.words)
    console.print_refused(suite.refused)
    if files:
        print(f"{console.counted(len(files), 'file')} in {execution.out}")


def _twins(columns: dict[str, Structure], model: Model, campaign: Campaign) -> dict[str, Any]:
    """How twins of the columns are drawn, as it is kept beside the results."""
    from ..campaign.twins import usual_with_laws

    sizes = {
        label: (campaign.scatter or usual_with_laws(column, model)).describe() for label, column in columns.items()
    }
    same = len(set(sizes.values())) == 1
    descriptions = sizes.values() if same else (f"{label}: {size}" for label, size in sizes.items())
    return {"replicates": campaign.replicates, "scatter": "; ".join(dict.fromkeys(descriptions)), "seed": campaign.seed}


def describe(comparison: StateComparison) -> None:
    """Print the answer for people."""
    import pandas

    from ..verdicts.limit_states import median_name, median_words
    from . import console

    if comparison.doubt:
        print(comparison.doubt)
    for difference in comparison.differences:
        print(difference.sentence)
    how = "collapse" if comparison.state == "collapse" else "exceed"
    rows, curves = [], [None if fragility is None else fragility.summary() for fragility in comparison.curves]
    for share, curve in zip(comparison.shares, curves, strict=True):
        row = {"state": share.label, "same runs": share.runs, how: share.exceeded, "do not": share.not_exceeded}
        row |= {
            "undecided": share.undecided,
            "failed": share.failed,
            f"share that {how}s": share.words or console.MISSING,
        }
        row["95 % of the share"] = share.interval_words or console.MISSING
        row[median_name(*curves)] = console.MISSING if curve is None else median_words(curve)
        rows.append(row)
    console.print_table(pandas.DataFrame(rows), digits=3)
    links = comparison.links
    if len(links):
        worst = links.sort_values(["broken", "largest_over_capacity"], ascending=False).groupby("state", sort=False)
        console.print_table(most_used := worst.head(3), digits=3)
        if len(most_used) < len(links):
            print(f"{len(most_used)} of {len(links)} links, those used most of each state; links.csv in --out has all.")
