"""What titles and comment lines above columns of numbers say: order and sense of the components, unit, counts, step."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from ...errors import InputError
from ..specs import acceleration_unit
from .numbers import NUMBER, number_in
from .record import direction

_TIME = {"TIME", "T", "SEC", "SECONDS"}
_DIRECTIONS = {
    "U", "UP", "UD", "U-D", "Z", "V", "VERT", "VERTICAL", "DOWN", "DN", "UPDOWN", "UP-DOWN",
    "N", "NS", "N-S", "NORTH", "S", "SN", "S-N", "SOUTH",
    "E", "EW", "E-W", "EAST", "W", "WE", "W-E", "WEST",
    "H1", "H2", "X", "Y", "L", "LONG", "TRAN", "TRANS",
}  # fmt: skip
_CODE = re.compile(r"[BHEC][NLG][NEZ12]")
_SPELLING = r"[a-z]+/s(?:ec)?(?:\^?2|\*\*2|/s(?:ec)?|²)|gals?|milli-g|mg|g/10|g"
_UNIT = re.compile(rf"(?:\bin|\bunits?(?:\s+of)?\s*[:=]?)\s+(?P<word>{_SPELLING})(?![\w/^])", re.IGNORECASE)
_BRACKETED = re.compile(rf"[(\[]\s*(?P<word>{_SPELLING})\s*[)\]]", re.IGNORECASE)
_UNIT_KEY = re.compile(r"^\W*[\w ]*unit[\w ()]*[:=]\s*(?P<value>.*\S)", re.IGNORECASE)
_COUNT = re.compile(
    r"\b(?:npts|ndata|(?:number|no\.?)\s+of\s+(?:points|samples|data)|samples)\s*[:=]?\s*(?P<count>\d+)(?![\w.])",
    re.IGNORECASE,
)
_STEP = re.compile(
    rf"\b(?:dt|time\s*step|sampling\s+interval|delta)\s*(?:\(s(?:ec)?\))?\s*[:=]\s*(?P<step>{NUMBER})(?!\w)",
    re.IGNORECASE,
)
_COUNT_STEP = re.compile(rf"^\W*(?P<count>\d+)[\s,]+(?P<step>{NUMBER})[\s,]+npts\s*,\s*dt", re.IGNORECASE)
_RATE = re.compile(
    rf"\bsampl\w*\s*(?:rate|freq\w*)\s*(?:\(hz\))?\s*[:=]\s*(?P<rate>{NUMBER})(?=\s|hz|$)", re.IGNORECASE
)
_LENGTH = re.compile(
    rf"\b(?:record\s*length|duration)\s*(?:\(s(?:ec)?\))?\s*[:=]\s*(?P<length>{NUMBER})(?=\s|s|$)", re.IGNORECASE
)
_EXTREMES = re.compile(
    rf"\bamplitudemax\.?\s*(?P<label>[a-z]+)\s*[:=]\s*(?P<high>{NUMBER})\s*~\s*(?P<low>{NUMBER})", re.IGNORECASE
)
_ONE = re.compile(r"^\W*(?:component|channel|stream|direction|orientation)\s*[:=]\s*(?P<label>\S.*)$", re.IGNORECASE)


@dataclass(frozen=True)
class Stated:
    """What the lines above the numbers state, None where they state nothing.

    Parameters
    ----------
    order : tuple of (str, float)
        Label (``time``, ``U``, ``N``) and sign of each column.
    order_line, unit_line : str
        The lines they were read from, for messages.
    unit : str
        Of acceleration.
    count : int
    step : float
        [s]
    length : str
        Of the record, as printed [s].
    extremes : dict
        Largest and smallest value as printed, by label.
    """

    order: tuple[tuple[str, float], ...] | None = None
    order_line: str = ""
    unit: str | None = None
    unit_line: str = ""
    count: int | None = None
    step: float | None = None
    length: str | None = None
    extremes: dict[str, tuple[str, str]] | None = None


def stated(titles: Sequence[str], file: str) -> Stated:
    """Read the lines above the numbers.

    Raises
    ------
    InputError
        Two lines contradict one another, or a line names a unit of acceleration that is not known.
    """
    orders = {order: line for line in titles if (order := _order(line)) is not None}
    if len(orders) > 1:
        shown = " and ".join(repr(line) for line in orders.values())
        raise InputError(f"{file}: {shown} name different columns; keep the one that is right.")
    unit, unit_line = _unit(titles, file)
    counts = [int(found["count"]) for line in titles if (found := _COUNT_STEP.search(line) or _COUNT.search(line))]
    steps = [number_in(found["step"]) for line in titles if (found := _COUNT_STEP.search(line) or _STEP.search(line))]
    rates = [number_in(found["rate"]) for line in titles if (found := _RATE.search(line))]
    steps += [1.0 / rate for rate in rates if rate is not None and rate > 0.0]
    lengths = [found["length"] for line in titles if (found := _LENGTH.search(line))]
    extremes = {
        found["label"].upper(): (found["high"], found["low"]) for line in titles if (found := _EXTREMES.search(line))
    }
    order = next(iter(orders), None)
    return Stated(
        order,
        orders[order] if order is not None else "",
        unit,
        unit_line,
        counts[0] if len(set(counts)) == 1 else None,
        steps[0] if steps else None,
        lengths[0] if lengths else None,
        extremes or None,
    )


def _order(line: str) -> tuple[tuple[str, float], ...] | None:
    """Labels and signs of the columns, if the line is a list of directions."""
    text = line.strip().lstrip("#%!;*/'\" ")
    if (one := _ONE.match(text)) and re.fullmatch(r"\S+", label := one["label"].strip()):
        azimuth, vertical, _ = direction(label)
        known = vertical or (azimuth is not None and not (label.isdigit() and "chan" in text[:8].lower()))
        return ((label, 1.0),) if known else None
    text = text.rpartition(":")[2] if ":" in text else text
    signs_kept = re.sub(r"\(\s*([+-])\s*\)", r"\1", text)
    bare = re.sub(r"[(\[][^)\]]*[)\]]", " ", signs_kept)
    words = [word for word in re.split(r"[;,|\t ]+", bare) if word]
    found = []
    for word in words:
        sign = -1.0 if word.endswith("-") else 1.0
        name = word.rstrip("+-").upper().strip(".")
        if name in _TIME:
            found.append(("time", 1.0))
        elif name in _DIRECTIONS or _CODE.fullmatch(name):
            found.append((name, sign))
        else:
            return None
    labels = [name for name, _ in found]
    if len(set(labels)) != len(labels) or len(labels) < 2:
        return None
    return tuple(found)


def _unit(titles: Sequence[str], file: str) -> tuple[str | None, str]:
    """The one unit of acceleration that the lines name."""
    seen: dict[float, tuple[str, str]] = {}
    for line in titles:
        if found := _UNIT_KEY.match(line):
            words = [word.strip(".,;()[]") for word in re.split(r"[\s,;]+", found["value"])]
            units = [unit for word in words if word and (unit := _known(word)) is not None]
            if not units and re.search(r"acc|ampl|data", line, re.IGNORECASE):
                raise InputError(
                    f"{file}: the line {line!r} names a unit that is not known here; allowed is g, m/s2, gal, mm/s2: "
                    "convert the file to columns under a header such as time_s,ax_g."
                )
            for label, size in units:
                seen.setdefault(size, (label, line))
            continue
        for pattern in (_UNIT, _BRACKETED):
            for found in pattern.finditer(line):
                unit = _known(found["word"])
                if unit is not None and not re.search(r"peak|pga|max", line, re.IGNORECASE):
                    seen.setdefault(unit[1], (unit[0], line))
    if len(seen) > 1:
        shown = " and ".join(repr(line) for _, line in seen.values())
        raise InputError(f"{file}: {shown} name different units; keep the one that is right.")
    return next(iter(seen.values()), (None, ""))


def _known(word: str) -> tuple[str, float] | None:
    try:
        return acceleration_unit(word)
    except InputError:
        return None
