"""``stylobate fragility``: the probability of a state over the intensity of the shaking, from runs that are there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..probability.fragility import Fragility
    from ..results.command_request import Source


@dataclass(frozen=True)
class Curves(o.Group):
    """Of what fragilities are, and how they are fitted."""

    im: str | None = o.option("IM", "Intensity measure, such as pga, pgv, sa:1.0s, avgsa.")
    state: str = o.option("STATE", "collapse, or a level such as top:0.35d or drums:0.01d.", "collapse")
    of: list[str] | None = o.option("COLUMN", "Only the runs of this column, or state; may be repeated.")
    records_are_one: bool = o.option(
        None, "Take every run for a record of its own, where there are few records.", False
    )
    seed: int = o.option("N", "Of the bootstrap.", 0)

    def fitted(
        self, sources: Sequence[Path], method: str | None = None, *, single: bool = False
    ) -> tuple[list[Fragility], list[Source]]:
        """The fragilities, one per source and column; and the runs that they rest on, one per source.

        Where a ``single`` curve is wanted, a source of several columns is refused before any is fitted.
        """
        from ..errors import warn
        from ..motion.intensity import DRIFTS
        from ..results.fragilities import fitted

        if method not in (None, "runs", "records"):
            raise InputError(f"`method` is {method!r}; allowed is runs or records.", "method")
        if not 0 <= self.seed < 2**63:
            raise InputError(f"`seed` is {self.seed}; allowed is a whole number from 0.", "seed")
        how = {"method": method, "seed": self.seed, "records_are_one": self.records_are_one}
        curves, used = fitted(sources, self.im, self.state, self.of, single=single, **how)
        warnings = [
            text for source in used if source.request is not None for text in source.request.warnings if DRIFTS in text
        ]
        for text in dict.fromkeys(warnings) if any("pgv" in curve.summary()["im"] for curve in curves) else ():
            warn(text)
        return curves, used

    def single(self, source: Path) -> tuple[Fragility, list[Source]]:
        """The one fragility of a source, for commands that go on from it, and the runs that it rests on."""
        (curve,), used = self.fitted([source], single=True)
        return curve, used


def fragility(
    sources: list[Path] = o.argument(
        "SOURCE...",
        "Folder of a study, an IDA, a suite or states, or a CSV file with the columns record, im, collapsed.",
    ),
    *,
    curves: Curves,
    method: str | None = o.option("M", "runs: every run counts; records: the capacity under each record."),
    nrml: Path | None = o.option("FILE.xml", "Write the curves as NRML 0.5, for OpenQuake; nothing may be there."),
    execution: o.Plain,
) -> None:
    """Fragility: how probable a state is, over the intensity of the shaking.

    A lognormal curve by maximum likelihood with intervals over records; several sources or columns in one picture.
    """
    from ..results.command_request import kept_of
    from ..results.fragilities import check_nrml, write_nrml
    from . import console

    if nrml is not None:
        check_nrml(nrml)
    fragilities, used = curves.fitted(sources, method)
    summaries = [curve.summary() for curve in fragilities]
    result = summaries[0] | ({"curves": summaries} if len(fragilities) > 1 else {})
    if nrml is not None:
        result |= {"nrml": str(write_nrml(fragilities, nrml))}
    with execution.files("fragility", "fragility.csv", "fragility.json", "fragility") as files:
        if files.wanted:
            import pandas

            from .. import plots

            rows = [
                {key: value for key, value in summary.items() if not isinstance(value, (list, dict))}
                for summary in summaries
            ]
            files.table(pandas.DataFrame(rows), "fragility.csv")
            files.picture(plots.draw_fragility(fragilities), "fragility")
            files.write_request(**kept_of(used), state=curves.state, im=curves.im, method=method)
            files.summary(result, "fragility.json")
    if execution.emits(result):
        return
    for doubt in dict.fromkeys(curve.evidence.doubt for curve in fragilities if curve.evidence.doubt):
        print(doubt)
    for fragility_curve in fragilities:
        describe(fragility_curve)
    if nrml is not None:
        print(f"written: {nrml}")
    console.print_files(files)


def describe(curve: Fragility) -> None:
    """A curve in words."""
    from ..probability.fragility import between
    from ..verdicts.limit_states import known_end, median_words, within
    from . import console

    s = curve.summary()
    unit = "" if s["unit"] == "-" else f" {s['unit']}"
    counts = [f"{s[outcome]} {outcome}" for outcome in ("undecided", "failed") if s[outcome]]
    open_ = ""
    if counts:
        low, high = (within(known_end(s, bound), s["levels"]) for bound in ("if_open_exceed", "if_open_do_not"))
        open_ = f"; with the {' and '.join(counts)} all exceeding it {low}, all not exceeding it {high}"
    known = median_words(s) if s["outside"] else f"{s['median']:.4g}{unit}"
    median = f"{known} (95 %: {between(s['median_low'], s['median_high'])}){open_}"
    if s.get("laws"):
        alone = between(s["median_of_columns_low"], s["median_of_columns_high"])
        median += f"; by records and columns alone {alone}, the rest by the law of the joints"
        median += f" ({curve.few_laws})" if curve.few_laws else ""
    limits = between(s["beta_low"], s["beta_high"], digits=2)
    spread = f"not seen in these runs (95 %: {limits})" if s["beta"] is None else f"{s['beta']:.3f} (95 %: {limits})"
    records = ", each taken for a record of its own" if s["records_are_one"] else f" of {s['records']} records"
    fit = "the points lie as a lognormal curve lets expect" if s["p_value"] >= 0.05 else "a lognormal curve fits badly"
    console.say(
        s["sentence"],
        {
            "median": f"middle {median}" if s["bracket"] and not s["outside"] else median,
            "dispersion": spread,
            "from": f"{s['runs']} runs{records}, {s['exceeded']} exceed; by {s['method']}",
            "fit": f"{fit} (largest distance {s['largest_distance']:.2f}, p = {s['p_value']:.2f})",
        },
    )
