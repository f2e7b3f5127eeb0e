"""Numbers with their units, as an engineer writes them."""

from __future__ import annotations

import math
import re
from typing import Any

from stylobate.constants import g
from stylobate.messages import Message, digits, joined, say

from .page import Exact

#: Name of a motion that a request has turned, reversed or scaled: that of its record, azimuth, reversed, peak [g].
TURNED = re.compile(r"(.+?)(?: at (-?\d+(?:\.\d+)?)°)?( reversed)?(?:, scaled to (\d+(?:\.\d+)?(?:e[+-]\d+)?) g)?")

#: Names of links that have none of the reader's: of what spans drums, of what is between two blocks, and of what lies in a
#: joint; with a number where there are several.
SPANNING = re.compile(r"(?P<kind>\w+) from (?:the base|drum (?P<lower>\d+)) to drum (?P<upper>\d+)")
BETWEEN = re.compile(r"(clamp|dowel|tie|bar|layer|pad|core) between (.+) and (.+?)((?:, \d+)?)")
IN_JOINT = re.compile(r"(dowel|bar|layer|pad) in joint (\d+)((?:, \d+)?)")

#: Text where there is no value.
NONE = "–"


def length(value: float | None) -> str:
    """A length in m, or in mm below a tenth of a metre."""
    if value is None or not math.isfinite(value):
        return NONE
    if value == 0.0 or abs(value) >= 0.1:
        return say("{value:.3f} m", value=value)
    return say("{value:.3g} mm", value=1000.0 * value)


def acceleration(value: float | None) -> str:
    """An acceleration given in m/s², in g."""
    return NONE if value is None or not math.isfinite(value) else say("{value:.3g} g", value=value / g)


def angle(value: float | None) -> str:
    """An angle given in rad, in rad and degrees."""
    if value is None or not math.isfinite(value):
        return NONE
    return say("{angle:.4f} rad ({degrees:.2f}°)", angle=value, degrees=math.degrees(value))


#: Units that names of keys end in.
UNITS = {"_m_s": "m/s", "_m": "m", "_s": "s", "_g": "g", "_y": "years", "_rad": "rad", "_deg": "°", "_hz": "Hz"}


def named(key: str) -> str:
    """A key of a JSON object or a table as a name, its unit behind: ``tail_s`` is ``tail [s]``."""
    end = next((unit for unit in UNITS if key.endswith(unit) and key != unit), "")
    name = say(key.removesuffix(end).replace("_", " "))
    return say("{name} [{unit}]", name=name, unit=say(UNITS[end])) if end else name


def plain(value: Any) -> str:
    """Any value of a JSON object or a table; a text is a word of the program, or a message."""
    if value is None or value == "" or (isinstance(value, float) and math.isnan(value)):
        return NONE
    if isinstance(value, bool):
        return say("yes") if value else say("no")
    if isinstance(value, float):
        return digits(value, ".4g")
    if isinstance(value, (list, tuple)):
        return joined(", ", map(plain, value)) or NONE
    if isinstance(value, dict):
        return (
            joined(", ", (say("{key}: {value}", key=say(key), value=plain(part)) for key, part in value.items()))
            or NONE
        )
    if isinstance(value, (Message, Exact)):
        return value
    if isinstance(value, str) and any(form.fullmatch(value) for form in (SPANNING, BETWEEN, IN_JOINT)):
        return value
    return say(value) if isinstance(value, str) and re.fullmatch("[A-Za-z -]+", value) else Exact(value)


def first_of(most: int, all_: int) -> str:
    """That a table holds the first of so many rows; empty where it holds them all."""
    return say("The first {most} of {all}.", most=most, all=all_) if all_ > most else ""


#: Words that columns of tables, options and outcomes are called by, for the catalogues alone.
WORDS = (
    "client|computed|age|labels|edp|site|engineer|reference|date|displaced|rocked|collapsed|stands|undecided|"
    "failed|at rest|circular|rectangular|stone|link|steel|bronze|iron|lead|titanium|stainless steel|"
    "iron in lead|machine|digest of what stood|digest of the motion|states recorded every|shear|tension|"
    "peak shear|peak tension|peak slip|peak elongation|parameter|spread over prior|informative|observation|"
    "spread alone|spread without|chance|probability|bayes factor against others|im|level|levels|median low|"
    "median high|median undecided both ways|p value|known of the median|associated|non-associated|flow|tail|"
    "simulations|seed|hazards|limit state|replicates|shear force|slip|elongation|against|station|station name|"
    "network|event|start time|stage|terms|uncorrected|corrected|simulated|raw counts|rocking|rocking right|"
    "rocking left|sliding|sliding right|sliding left|twisting|dowel|dowels|tie|ties|clamp|clamps|core|cores|"
    "layer|layers|bar|bars|drum|column|capital|architrave|block|columns|assemblies|assembly|specimen|friction|"
    "joint stiffness|density|width|height|offset|depth|law|stiffness damping|rolling resistance|clearance|"
    "shear stiffness|shear capacity|axial stiffness|axial capacity|pretension|ultimate slip|"
    "ultimate elongation|damping|thickness|area|friction coefficient|from height|to height|modulus|"
    "yield strength|stone strength|stone modulus|edge|hole|bond|shape factor|shear modulus|ultimate strain|"
    "shear strength|normal stiffness|stroke|length|material|diameter|embedment|kind|at|as recorded|critical|"
    "critical factor|all collapse above|lowest collapse|lowest collapse factor|critical 16|critical 50|"
    "critical 84|compared by|misfit|least ratio|largest ratio|pga|pgv|magnitude|distance km|drift|factor|"
    "outcome|verdict|peak top displacement|residual top displacement|peak displacement|residual displacement|"
    "collapse time|energy imbalance|stands until|collapses from|resurrections|runs|open|beta|beta low|"
    "beta high|hazard statistic|survival probability|survival probability low|survival probability high|weight|"
    "mean|max|median|measure|unit|records|record|motion|motions|models|realisation|states|factors|count|"
    "periods|as built|as found|second horizontal component|vertical component|left|right|front|back|low|high|"
    "value|name|hazard|control|displacement|force n|capacity n|yields|action|not fallen|most|earthquakes|"
    "interval low|interval high|monument|seen|years|condition|signs|azimuths|vertical|horizontal|"
    "limit analysis g|pattern|direction|collapse|share low|share high|use|use high|difference low|"
    "difference high|alike|candidate|bits alone|bits beside others|sigma ln edp|reversed|amplitudes|"
    "frequencies|duration|bending|across|torsion|axial|opens|slides|twists|number|frequency|standard deviation|"
    "bent joint|holds to|limited by|best|first|second|comparable|differing|only first collapses|only second collapses|"
    "prior weight|weight error|weight if own|weight if shared|probability low|probability high|lift|reach|annual rate"
)
