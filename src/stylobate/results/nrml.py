"""Fragility curves as a fragility model of NRML 0.5, which OpenQuake reads."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

from ..analysis.fragility_curve import Fragility
from ..analysis.lognormal import seen
from ..atomic import refuse_existing, replacing
from ..errors import InputError
from ..motion.intensity_specs import parse_measure

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
    states = list(dict.fromkeys(one.evidence.state for one in curves))
    measures = list(dict.fromkeys(one.evidence.measure for one in curves))
    for what, found in (("states", states), ("intensities", measures)):
        if len(found) != 1:
            raise InputError(
                f"the curves are of {len(found)} {what} ({', '.join(found)}); write a file for each.", "nrml"
            )
    names = [one.evidence.name for one in curves]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"two curves are called {twice!r}; results go by their names: write a file for each.", "nrml")
    imt, size = _intensity(measures[0])
    state = re.sub(r"\W+", "_", states[0])
    model = ElementTree.Element("fragilityModel", id="stylobate", assetCategory="structures", lossCategory="structural")
    text = f"Fragility of {', '.join(names)}: {states[0]}, over {measures[0]}, by stylobate."
    ElementTree.SubElement(model, "description").text = text
    ElementTree.SubElement(model, "limitStates").text = state
    for one in curves:
        if seen(one.beta) is None or not math.isfinite(one.log_median):
            raise InputError(
                f"the runs of {one.evidence.name} do not show how capacities scatter, and NRML needs a dispersion; run more "
                "levels between those at which none and all exceed the state.",
                "nrml",
            )
        _add(model, one, state, imt, size)
    root = ElementTree.Element("nrml", xmlns=NAMESPACE)
    root.append(model)
    ElementTree.indent(root)
    with replacing(place) as partial:
        ElementTree.ElementTree(root).write(partial, encoding="utf-8", xml_declaration=True)
    return place


def _intensity(measure: str) -> tuple[str, float]:
    """Name of an intensity in NRML, and the size of our unit in its own."""
    found = None if measure == "im" else parse_measure(measure)
    if found is None or found.kind not in INTENSITIES:
        raise InputError(
            f"the fragility is over {measure!r}; NRML has names for pga, pgv and sa:1.0s: give one of them as `im`.",
            "im",
        )
    name, size = INTENSITIES[found.kind]
    return name.format(*found.periods), size


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
