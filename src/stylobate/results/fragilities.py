"""Fragilities of results, and as NRML for other programs."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from ..atomic import refuse_existing, replacing
from ..errors import InputError
from ..motion.intensity import parse_measure
from ..probability.evidence import evidence, names_in, read_table, scaled_to, table_of
from ..probability.fragility import Fragility
from ..probability.fragility import fragility as fit
from ..probability.lognormal import resolved_beta
from ..verdicts.limit_states import parse_state
from .command_request import Source


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
        Of :func:`stylobate.probability.fragility.fragility`.
    """
    intensity, level = None if im is None else parse_measure(im), parse_state(state)
    curves, used = [], []
    for source in sources:
        table = read_table(source)
        measure = intensity
        scaling = scaled_to(table)
        if measure is None and scaling not in (None, "factor"):
            measure = parse_measure(str(scaling))
        who = names_in(table)
        labels = who or [Path(source).stem] * len(table)
        names = list(dict.fromkeys(labels))
        if of:
            missing = [label for label in of if label not in names]
            if missing:
                raise InputError(
                    f"{source} has no runs of a column or state {missing[0]!r}; it has {', '.join(names)}.", "of"
                )
            names = [label for label in names if label in of]
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
            run_evidence = evidence(rows, measure, level, shown, doubt=Source(source, place, rows).doubt)
            curves.append(fit(run_evidence, **how))
    if len({curve.evidence.unit for curve in curves}) > 1:
        raise InputError("the sources are over different intensities; choose one with `im`.", "im")
    return curves, used


NAMESPACE = "http://openquake.org/xmlns/nrml/0.5"

#: Name of an intensity in NRML, and how many of its unit are one of ours: PGA and SA in g, PGV in cm/s.
INTENSITIES = {"pga": ("PGA", 1.0), "pgv": ("PGV", 100.0), "sa": ("SA({:g})", 1.0)}

#: Dispersions on either side of the median to which a curve reaches: OpenQuake goes on from its ends as if it were level.
WIDE = 4.0


def check_nrml(path: str | Path) -> Path:
    """The place of a file to be, before anything is computed.

    Raises
    ------
    InputError
        It does not end in .xml, or something is there.
    """
    place = Path(path)
    if place.suffix.lower() != ".xml":
        raise InputError(f"`nrml` is {str(path)!r}; allowed is a name that ends in .xml.", "nrml")
    refuse_existing(place)
    return place


def write_nrml(curves: Sequence[Fragility], path: str | Path) -> Path:
    """Write fragility curves of one state and one intensity.

    Parameters
    ----------
    curves : sequence of Fragility
    path : path
        Ends in .xml; nothing may be there.

    Returns
    -------
    Path
        The file. It appears whole or not at all.

    Raises
    ------
    InputError
        Curves of several states or intensities, an intensity that NRML has no name for, or a curve without a dispersion.
    """
    place = check_nrml(path)
    states = list(dict.fromkeys(curve.evidence.state for curve in curves))
    measures = list(dict.fromkeys(curve.evidence.measure for curve in curves))
    for what, values in (("states", states), ("intensities", measures)):
        if len(values) != 1:
            raise InputError(
                f"the curves are of {len(values)} {what} ({', '.join(values)}); write a file for each.", "nrml"
            )
    names = [curve.evidence.name for curve in curves]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"two curves are called {twice!r}; results go by their names: write a file for each.", "nrml")
    imt, size = _intensity(measures[0])
    state = re.sub(r"\W+", "_", states[0])
    model = ElementTree.Element("fragilityModel", id="stylobate", assetCategory="structures", lossCategory="structural")
    text = f"Fragility of {', '.join(names)}: {states[0]}, over {measures[0]}, by stylobate."
    ElementTree.SubElement(model, "description").text = text
    ElementTree.SubElement(model, "limitStates").text = state
    for curve in curves:
        if resolved_beta(curve.beta) is None or not math.isfinite(curve.log_median):
            raise InputError(
                f"the runs of {curve.evidence.name} do not show how capacities scatter, and NRML needs a dispersion; run "
                "more levels between those at which none and all exceed the state.",
                "nrml",
            )
        _add(model, curve, state, imt, size)
    root = ElementTree.Element("nrml", xmlns=NAMESPACE)
    root.append(model)
    ElementTree.indent(root)
    with replacing(place) as partial:
        ElementTree.ElementTree(root).write(partial, encoding="utf-8", xml_declaration=True)
    return place


def _intensity(measure: str) -> tuple[str, float]:
    """Name of an intensity in NRML, and the size of our unit in its own."""
    intensity = None if measure == "im" else parse_measure(measure)
    if intensity is None or intensity.kind not in INTENSITIES:
        raise InputError(
            f"the fragility is over {measure!r}; NRML has names for pga, pgv and sa:1.0s: give one of them as `im`.",
            "im",
        )
    name, size = INTENSITIES[intensity.kind]
    return name.format(*intensity.periods), size


def _add(model: ElementTree.Element, curve: Fragility, state: str, imt: str, size: float) -> None:
    """One curve, by the mean and the standard deviation of its capacity, which is lognormal."""
    reach = math.exp(WIDE * curve.beta)
    low, high = (size * limit for limit in curve.levels)
    median = size * math.exp(curve.log_median)
    mean = median * math.exp(0.5 * curve.beta**2)
    function = ElementTree.SubElement(
        model, "fragilityFunction", id=curve.evidence.name, format="continuous", shape="logncdf"
    )
    ends: dict[str, str] = {
        "imt": imt,
        "minIML": repr(float(min(low, median / reach))),
        "maxIML": repr(float(max(high, median * reach))),
    }
    ElementTree.SubElement(function, "imls", ends)
    stddev = mean * math.sqrt(math.expm1(curve.beta**2))
    ElementTree.SubElement(function, "params", ls=state, mean=repr(mean), stddev=repr(stddev))
