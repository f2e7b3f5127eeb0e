"""Numbers with their units, as an engineer writes them."""

from __future__ import annotations

import math
from typing import Any

from stylobate.constants import g
from stylobate.messages import Message, digits, joined, say

from .page import Own

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
UNITS = {"_m_s": "m/s", "_m": "m", "_s": "s", "_g": "g", "_y": "years", "_rad": "rad", "_deg": "°"}


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
            joined(", ", (say("{key}: {value}", key=say(key), value=plain(one)) for key, one in value.items())) or NONE
        )
    return value if isinstance(value, (Message, Own)) else say(str(value))


def first_of(most: int, all_: int) -> str:
    """That a table holds the first of so many rows; empty where it holds them all."""
    return say("The first {most} of {all}.", most=most, all=all_) if all_ > most else ""


#: Words that columns of tables, options and outcomes are called by, here for the catalogues alone.
WORDS = (
    say("client"), say("computed"), say("age"), say("labels"), say("edp"), say("site"), say("engineer"), say("reference"), say("date"), say("displaced"), say("rocked"),
    say("collapsed"), say("stands"), say("undecided"), say("failed"), say("at rest"), say("circular"),
    say("rectangular"), say("stone"), say("link"), say("steel"), say("bronze"), say("iron"), say("lead"),
    say("titanium"), say("stainless steel"), say("iron in lead"), say("machine"), say("digest of what stood"),
    say("digest of the motion"), say("states recorded every"), say("shear"), say("tension"), say("peak shear"),
    say("peak tension"), say("peak slip"), say("peak elongation"), say("parameter"), say("spread over prior"),
    say("informative"), say("observation"), say("spread alone"), say("spread without"), say("chance"),
    say("probability"), say("bayes factor against others"), say("im"), say("level"), say("levels"), say("median low"),
    say("median high"), say("median undecided both ways"), say("p value"), say("known of the median"),
    say("associated"), say("non-associated"), say("flow"), say("tail"), say("simulations"), say("seed"),
    say("hazards"), say("limit state"), say("replicates"), say("shear force"), say("slip"), say("elongation"),
    say("against"), say("station"), say("station name"), say("network"), say("event"), say("start time"),
    say("stage"), say("terms"), say("uncorrected"), say("corrected"), say("simulated"), say("raw counts"),
    say("rocking"), say("rocking right"), say("rocking left"), say("sliding"), say("sliding right"),
    say("sliding left"), say("twisting"), say("dowel"), say("dowels"), say("tie"), say("ties"), say("clamp"),
    say("clamps"), say("core"), say("cores"), say("layer"), say("layers"), say("bar"), say("bars"), say("drum"),
    say("column"), say("capital"), say("architrave"), say("block"), say("columns"), say("assemblies"),
    say("assembly"), say("specimen"), say("friction"), say("joint stiffness"), say("density"), say("width"),
    say("height"), say("offset"), say("depth"), say("law"), say("stiffness damping"), say("rolling resistance"),
    say("clearance"), say("shear stiffness"), say("shear capacity"), say("axial stiffness"), say("axial capacity"),
    say("pretension"), say("ultimate slip"), say("ultimate elongation"), say("damping"), say("thickness"),
    say("area"), say("friction coefficient"), say("from height"), say("to height"), say("modulus"),
    say("yield strength"), say("stone strength"), say("stone modulus"), say("edge"), say("hole"), say("bond"),
    say("shape factor"), say("shear modulus"), say("ultimate strain"), say("shear strength"), say("normal stiffness"),
    say("stroke"), say("length"), say("material"), say("diameter"), say("embedment"), say("kind"), say("at"),
    say("as recorded"), say("critical"), say("critical factor"), say("all collapse above"), say("lowest collapse"),
    say("lowest collapse factor"), say("critical 16"), say("critical 50"), say("critical 84"), say("compared by"),
    say("misfit"), say("least ratio"), say("largest ratio"), say("pga"), say("pgv"), say("magnitude"),
    say("distance km"), say("drift"), say("factor"), say("outcome"), say("verdict"), say("peak top displacement"),
    say("residual top displacement"), say("peak displacement"), say("residual displacement"), say("collapse time"),
    say("energy imbalance"), say("stands until"), say("collapses from"), say("resurrections"), say("runs"),
    say("open"), say("beta"), say("beta low"), say("beta high"), say("hazard statistic"), say("survival probability"),
    say("survival probability low"), say("survival probability high"), say("weight"), say("mean"), say("max"),
    say("median"), say("measure"), say("unit"), say("records"), say("record"), say("motion"), say("motions"),
    say("models"), say("realisation"), say("states"), say("factors"), say("count"), say("periods"), say("as built"),
    say("as found"), say("second horizontal component"), say("vertical component"), say("left"), say("right"),
    say("front"), say("back"), say("low"), say("high"), say("value"), say("name"), say("hazard"), say("control"),
    say("displacement"), say("force n"), say("capacity n"), say("yields"), say("action"), say("not fallen"),
    say("most"), say("earthquakes"), say("interval low"), say("interval high"), say("monument"), say("seen"),
    say("years"), say("condition"), say("signs"), say("azimuths"), say("vertical"), say("horizontal"),
    say("limit analysis g"), say("pattern"), say("direction"), say("collapse"), say("share low"), say("share high"),
    say("use"), say("use high"), say("difference low"), say("difference high"), say("alike"), say("candidate"),
    say("bits alone"), say("bits beside others"), say("sigma ln edp"), say("reversed"), say("amplitudes"),
    say("frequencies"), say("duration"),
)  # fmt: skip
