"""``stylobate records``: records for a code, chosen and scaled to a target spectrum."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..codes.records import RecordRange

#: Columns of the table that are printed.
PRINTED_COLUMNS = ("record", "factor", "compared_by", "misfit", "pga_g", "pgv_m_s", "magnitude", "distance_km")


def records(
    sources: list[Path] = o.argument("DIR|FILE...", "Folders of records, or records."),
    target: str = o.option(
        "TARGET",
        "ec8,ag=0.25g,soil=B; ec8-2,S_alpha=0.6g,S_beta=0.2g; ntc2018,…; a CSV of period_s and sa_g; or "
        "cms:FILE.csv,T=1s,sa=0.4g.",
        ...,
    ),
    count: int = o.option("N", "Records to choose.", 7),
    periods: str = o.option("T:T", "Periods at which the mean follows the target.", "0.2s:3s"),
    horizontal: str = o.option("HOW", "Of two components: geomean, larger, rotd50, rotd100, x.", "geomean"),
    factors: str = o.option("X:X", "Least and largest factor of a record.", "0.5:2"),
    least: float = o.option("SHARE", "Least mean over the target.", 0.9),
    per_event: int | None = o.option("N", "Most records of one event."),
    where: list[str] | None = o.option(
        "MEASURE=A:A", "As recorded, such as pgv=0.1m/s:0.8m/s, pulse_period=0.5s:2s, magnitude=6:7; may be repeated."
    ),
    about: Path | None = o.option("FILE", "CSV about the records: record, magnitude, distance_km; or QuakeML."),
    *,
    motions: Annotated[o.Motions, o.Without(*o.FILES_NAMED, *o.SEVERAL, "scale", "pga", "azimuth")],
    execution: o.Plain,
) -> None:
    """Records for a code: chosen from folders and scaled so that their mean spectrum follows a target.

    Every record is multiplied by one factor. With --out, the scaled records in a folder for suite, ida and studies, their
    table, and a picture of spectra and misfit.
    """
    from ..codes.records import facts_of_records, select_records
    from ..codes.spectra import target_spectrum
    from ..motion.conditioning import THEN, scales
    from ..motion.specs import parse_number, parse_time
    from . import console

    aim = target_spectrum(target)
    between = _pair("periods", periods, parse_time, "0.2s:3s")
    limits = _pair("factors", factors, lambda text: parse_number("`factors`", text), "0.5:2")
    ranges = [_range_of_measure(text) for text in where or ()]
    scaling = next((step for step in motions.condition or () if scales(step)), None)
    if scaling is not None:
        raise InputError(
            f"`condition` {scaling} scales every record before it is chosen, and `factors` and `where` are of records as "
            "they were recorded; leave it out: the chosen are scaled to the target.",
            "condition",
        )
    suite = motions.request(motion=sources, separate=True).expand()
    known = facts_of_records(about, sources, suite.motions)
    selection = select_records(
        suite.motions, aim, count, periods=between, horizontal=horizontal, factors=limits, least=least,
        per_event=per_event, wanted=ranges, about=known,
    )  # fmt: skip
    names = _file_names([str(name) for name in selection.table["record"]])
    summary = selection.summary()
    summary["refused"] = refused = suite.refused | selection.refused
    with execution.files("records", "records.csv", "records.json", "records") as files:
        if files.wanted:
            from .. import plots
            from ..atomic import output_folder
            from ..motion.motion import write_csv

            place = files / "scaled"
            there = sorted(path.name for path in place.iterdir()) if place.is_dir() else []
            others = [name for name in there if name[0] != "." and name not in names]
            if others:
                raise InputError(
                    f"{place} holds {others[0]}, which is not of these records and would be read with them; choose another "
                    "folder for `out`.",
                    "out",
                )
            with output_folder(place, names):
                for motion, name in zip(selection.motions, names, strict=True):
                    files.append(write_csv(motion, place / name))
            files.table(selection.table.assign(file=[f"scaled/{name}" for name in names]), "records.csv")
            files.picture(plots.draw_record_selection(selection), "records")
            chosen: dict[str, object] = {"target": target, "count": count, "periods_s": list(between)}
            files.write_request(motions=list(selection.motions), factors=list(limits), **chosen)
            files.summary(summary, "records.json")
    if execution.emits(summary):
        return
    print(f"Target: {aim.words}. {selection.sentence}")
    shown = selection.table.filter(list(PRINTED_COLUMNS)).dropna(axis="columns", how="all")
    console.print_table(shown, digits=3)
    for row in selection.table.to_dict("records"):
        if row["drift_m"]:
            cure = row["cure"]
            steps = cure.split(THEN) if isinstance(cure, str) else []
            remedy = " ".join(f"--condition {step}" for step in steps) or "no conditioning that is known here mends it"
            print(f"{row['record']}: displacements drift by {row['drift_m']:.2g} m after double integration; {remedy}")
    console.print_refused(refused)
    console.print_files(files)


def _pair(name: str, text: str, parse: Callable[[str], float], example: str) -> tuple[float, float]:
    """Two values as typed, the smaller first."""
    low, colon, high = text.partition(":")
    if not colon or ":" in high:
        raise InputError(f"`{name}` is {text!r}; write it as {example}.", name)
    first, last = parse(low.strip()), parse(high.strip())
    if not first < last:
        raise InputError(f"`{name}` is {text!r}; the first value must be below the second, such as {example}.", name)
    return first, last


def _range_of_measure(text: str) -> RecordRange:
    """A range of a measure as typed: ``pgv=0.1m/s:0.8m/s``."""
    from ..codes.records import ABOUT, RecordRange
    from ..motion.intensity import parse_level, parse_measure
    from ..motion.specs import parse_number

    name, sign, span = (part.strip() for part in text.partition("="))
    if not sign:
        raise InputError(f"`where` is {text!r}; write it as pgv=0.1m/s:0.8m/s.", "where")
    if name in ABOUT:
        return RecordRange(name, *_pair("where", span, lambda bound: parse_number(name, bound), f"{name}=6:7"))
    measure = parse_measure(name)
    return RecordRange(measure, *_pair("where", span, lambda bound: parse_level(bound, measure), "pgv=0.1m/s:0.8m/s"))


def _file_names(names: list[str]) -> list[str]:
    """A file for each record, called after it; numbered, so that no two are one."""
    plain = ["".join(c if c.isalnum() or c in "-_." else "-" for c in Path(name).name)[:80] for name in names]
    return [f"{k:02d}-{name.removesuffix('.csv')}.csv" for k, name in enumerate(plain, 1)]
