"""Fragilities of the runs that folders of results hold."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..analysis.evidence import evidence, names_in, read_table, scaled_to, table_of
from ..analysis.fragility import fragility as fit
from ..analysis.fragility_curve import Fragility
from ..analysis.limit_states import parse_state
from ..errors import InputError
from ..motion.intensity_specs import parse_measure
from .sources import Source


def fitted(
    sources: Sequence[Path], im: str | None, state: str, of: Sequence[str] | None = None, *, single: bool = False,
    **how: Any,
) -> tuple[list[Fragility], list[Source]]:  # fmt: skip
    """Fragilities of columns or states, and the runs that they rest on, one per source.

    Parameters
    ----------
    sources : sequence of path
        Folders of a study, an IDA, a suite or states, or CSV files with the columns record, im, collapsed.
    im : str, optional
        Intensity measure as typed; by default that over which the runs were scaled.
    state : str
        As typed.
    of : sequence of str, optional
        Columns or states; all by default.
    single : bool
        Refuse a source of several columns or states before any is fitted.
    **how
        Of :func:`stylobate.analysis.fragility.fragility`.
    """
    asked, level = None if im is None else parse_measure(im), parse_state(state)
    found, used = [], []
    for source in sources:
        table = read_table(source)
        measure = asked
        said = scaled_to(table)
        if measure is None and said not in (None, "factor"):
            measure = parse_measure(str(said))
        who = names_in(table)
        labels = who or [Path(source).stem] * len(table)
        names = list(dict.fromkeys(labels))
        if of:
            missing = [one for one in of if one not in names]
            if missing:
                raise InputError(
                    f"{source} has no runs of a column or state {missing[0]!r}; it has {', '.join(names)}.", "of"
                )
            names = [one for one in names if one in of]
        if single and len(names) > 1:
            raise InputError(
                f"{source} holds runs of {len(names)} columns or states ({', '.join(names)}); choose one with `of`.",
                "of",
            )
        chosen: Any = table[[label in names for label in labels]]
        place = table_of(source)
        used.append(Source(source, place, chosen))
        for name in names:
            rows: Any = table[[label == name for label in labels]]
            shown = f"{name}, {Path(source).stem}" if who and len(sources) > 1 else name
            told = evidence(rows, measure, level, shown, doubt=Source(source, place, rows).doubt)
            found.append(fit(told, **how))
    if len({one.evidence.unit for one in found}) > 1:
        raise InputError("the sources are over different intensities; choose one with `im`.", "im")
    return found, used
