"""Facts of the record in the lines above columns of numbers: unit, counts, step; and the line that names the columns."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from ...errors import InputError
from ..specs import acceleration_unit
from .headers import MARKS, Header, is_filler
from .numbers import NUMBER, number_in
from .vocabulary import folded, time_unit, unit_kind

_SPELLING = r"[a-z]+/s(?:ec)?(?:\^?2|\*\*2|/s(?:ec)?|²)|gals?|milli-g|mg|g/10|g"
_UNIT = re.compile(rf"(?:\bin|\bunits?(?:\s+of)?\s*[:=]?)\s+(?P<word>{_SPELLING})(?![\w/^])", re.IGNORECASE)
_BRACKETED = re.compile(rf"[(\[]\s*(?P<word>{_SPELLING})\s*[)\]]", re.IGNORECASE)
_UNIT_KEY = re.compile(r"^\W*[\w ]*unit[\w ()]*[:=]\s*(?P<value>.*\S)", re.IGNORECASE)
_COUNT = re.compile(
    r"\b(?:npts|ndata|(?:number|no\.?)\s+of\s+(?:points|samples|data)|samples)\s*[:=]?\s*(?P<count>\d+)(?![\w.])",
    re.IGNORECASE,
)
_TIME = r"(?:\s*[(\[]?\s*(?P<unit>milli\w*|micro\w*|[mµu]?s(?:ecs?|econds?)?|min\w*|k?hz|sps)\b)?"
_STEP = re.compile(
    rf"\b(?:dt(?:_s)?|time\s*step|sampling\s+interval|delta)\s*(?:\(s(?:ec)?\))?\s*[:=]\s*(?P<step>{NUMBER})(?![\w.])"
    + _TIME,
    re.IGNORECASE,
)
_COUNT_STEP = re.compile(rf"^\W*(?P<count>\d+)[\s,]+(?P<step>{NUMBER})[\s,]+npts\s*,\s*dt", re.IGNORECASE)
_RATE = re.compile(
    rf"\bsampl\w*\s*(?:rate|freq\w*)\s*(?:\(hz\))?\s*[:=]\s*(?P<rate>{NUMBER})(?=\s|k?hz|sps|$)" + _TIME,
    re.IGNORECASE,
)
_LENGTH = re.compile(
    rf"\b(?:record\s*length|duration)\s*(?:\(s(?:ec)?\))?\s*[:=]\s*(?P<length>{NUMBER})(?=\s|s|$)", re.IGNORECASE
)
_EXTREMES = re.compile(
    rf"\bamplitudemax\.?\s*(?P<label>[a-z]+)\s*[:=]\s*(?P<high>{NUMBER})\s*~\s*(?P<low>{NUMBER})", re.IGNORECASE
)
_PEAK = re.compile(
    rf"\b(?:pga|(?:peak|max)\w*\.?(?:\s+(?:ground\s+)?acc\w*\.?)?)\s*(?:\([^)]*\))?\s*[:=]\s*{NUMBER}(?:\s*{_SPELLING})?"
    rf"(?:\s*,?\s*(?:at|@)\s*{NUMBER}\s*s(?:ec)?\b)?",
    re.IGNORECASE,
)
#: What is done to a unit beside it, as in "10^-2 m/s2", "g x 0.001", "% g".
_SCALED = re.compile(
    r"\d|%|[*×/]|(?:^|\s)x(?=\s|$)|\b(?:per\s*cent|milli|micro|thousand\w*|hundred\w*|tenth\w*|times|multiplied|divided)\b",
    re.IGNORECASE,
)
#: How large a unit is, which may be said beside it.
_SIZE = re.compile(rf"[(\[,;]?\s*1?(?:\.0*)?\s*g\s*=\s*{NUMBER}\s*(?:{_SPELLING})?\s*[)\]]?", re.IGNORECASE)
#: Marks of lines whose unit is that of another number than the samples.
_OF_OTHERS = re.compile(
    r"peak|pga|max|trigger|range|full\W*scale|threshold|resolution|sensitiv|convert|scaled", re.IGNORECASE
)
#: Words of lines that speak of the samples, and a value of its own behind a unit.
_OF_SAMPLES = re.compile(
    r"acc|ampl|value|data|series|histor|sample|unit|ordinate|motion|signal|component", re.IGNORECASE
)
_OF_NUMBER = re.compile(rf"\s*[:=]\s*{NUMBER}")
_KEYED = re.compile(r"(?P<key>[^\W\d][\w .()/-]*?)\s*[:=]\s*(?P<value>.*)")
_FORMAT = re.compile(r"\W*\d*\s*[feg]\d+(?:\.\d+)?\W*", re.IGNORECASE)
#: Marks, in the words before a colon, of a record as a whole, so that its value names no column.
_FACTS = re.compile(
    r"(?:processing\d*|name|title|file(?:name)?|event\w*|earthquake\w*|station\w*|site\w*|network\w*|location|place|"
    r"region|country|instrument\w*|recorder\w*|sensor\w*|serial\w*|source|reference|author|licen[cs]e|terms|stage|filter\w*|"
    r"start(?:time)?|origintime|date|magnitude\w*|m[wsl]|depth\w*|latitude|longitude|elevation|epicent\w*|distance\w*|"
    r"software|version|project|id|dts|azimuth[xyz]deg|sha256)"
)


@dataclass(frozen=True)
class Stated:
    """Facts in the lines above the numbers, None where they state nothing.

    Parameters
    ----------
    unit : str
        Of acceleration.
    unit_line : str
        The line it was read from, for messages.
    count : int
    step : float
        [s]
    time_unit : str
        Of the times, where a line names it apart from them.
    length : str
        Of the record, as printed [s].
    extremes : dict
        Largest and smallest value as printed, by label.
    """

    unit: str | None = None
    unit_line: str = ""
    count: int | None = None
    step: float | None = None
    time_unit: str | None = None
    length: str | None = None
    extremes: dict[str, tuple[str, str]] | None = None


def stated(titles: Sequence[str], file: str) -> Stated:
    """Read the lines above the numbers.

    Raises
    ------
    InputError
        Two lines contradict one another, or a line names a unit of acceleration that is not known.
    """
    unit, unit_line = _unit(titles, file)
    times = list(dict.fromkeys(word for line in titles for word in _time_units(line)))
    if len({time_unit(word) for word in times}) > 1:
        raise InputError(f"{file}: its lines name {' and '.join(times)} as units of time; keep the one that is right.")
    counts = [int(found["count"]) for line in titles if (found := _COUNT_STEP.search(line) or _COUNT.search(line))]
    steps = _steps(titles, file)
    lengths = [found["length"] for line in titles if (found := _LENGTH.search(line))]
    extremes = {
        found["label"].upper(): (found["high"], found["low"]) for line in titles if (found := _EXTREMES.search(line))
    }
    return Stated(
        unit,
        unit_line,
        counts[0] if len(set(counts)) == 1 else None,
        steps[0] if steps else None,
        times[0] if times else None,
        lengths[0] if lengths else None,
        extremes or None,
    )


def _steps(titles: Sequence[str], file: str) -> list[float]:
    """Steps that the lines state, themselves or by a rate, which are one [s]."""
    steps: list[float] = []
    for line in titles:
        for found, key in ((_COUNT_STEP.search(line) or _STEP.search(line), "step"), (_RATE.search(line), "rate")):
            if found is None or not (number := number_in(found[key])):
                continue
            unit = (found.groupdict().get("unit") or "").lower()
            by_rate = unit in ("hz", "khz", "sps") if unit else key == "rate"
            size = {"khz": 1e3, "hz": 1.0, "sps": 1.0, "": 1.0}.get(unit, time_unit(unit))
            if size is None or number < 0.0 or (by_rate and key == "step"):
                raise InputError(
                    f"{file}: the line {line!r} states a step or a rate that is not understood; write it as 'dt: 0.01' [s] "
                    "or 'sampling rate: 100' [Hz]."
                )
            steps.append(1.0 / (number * size) if by_rate else number * size)
    if steps and max(steps) - min(steps) > 0.01 * min(steps):
        shown = " and ".join(f"{one:g}" for one in dict.fromkeys(steps))
        raise InputError(f"{file}: its lines state steps of {shown} s; keep the one that is right.")
    return steps


def _time_units(line: str) -> list[str]:
    """Units of time that a line of units names."""
    found = _UNIT_KEY.match(line)
    words = [] if found is None else re.split(r"[\s,;()\[\]]+", found["value"])
    return [word for word in words if word and time_unit(word) is not None]


def header_of(titles: Sequence[str]) -> tuple[Header | None, list[str] | None]:
    """The line that names the columns, and the units of the line below it.

    Whatever stands last above the numbers is that line, unless it states a fact of the whole record; above such facts it is
    a line most of whose words are names of columns.
    """
    units, last = None, True
    for line in reversed(titles):
        header = Header(line)
        if not re.search(r"\w", line):
            continue
        if is_fact(line):
            last = False
        elif units is None and header.units is not None and len(header.units) > 1:
            units = header.units
        elif last or header.seems_to_name:
            return header, units
    return (Header(" ".join(units)), None) if units else (None, None)


def is_fact(line: str) -> bool:
    """Whether a line tells something of the whole record, and nothing of which column is which."""
    text = line.strip().lstrip(MARKS).strip()
    keyed = _KEYED.fullmatch(text)
    key = re.sub(r"\([^)]*\)|[^a-z0-9]", "", folded(keyed["key"])) if keyed else ""
    if keyed and _FACTS.fullmatch(key):
        value = Header(keyed["value"])
        return len(value.words) < 2 or value.unknown is not None or not value.seems_to_name
    if keyed and key in ("data", "format", "dataformat") and _FORMAT.fullmatch(keyed["value"]):
        return True
    rest = text
    for pattern in (_COUNT_STEP, _COUNT, _STEP, _RATE, _LENGTH, _EXTREMES, _PEAK):
        rest = pattern.sub(" ", rest)
    if (unit := _UNIT_KEY.match(line)) is not None:
        rest = unit["value"]
    elif rest == text and not re.fullmatch(r"\s*(?:in|units? of|values? in|data in)\s+\S+", text, re.IGNORECASE):
        return False
    words = [word for word in re.split(r"[\s,;()\[\].]+", rest) if re.search(r"\w", word)]
    return all(unit_kind(word) in ("time", "acceleration") or is_filler(word) or word.lower() == "hz" for word in words)


def _unit(titles: Sequence[str], file: str) -> tuple[str | None, str]:
    """The one unit of acceleration that the lines name."""
    seen: dict[float, tuple[str, str]] = {}
    for line in titles:
        keyed = _KEYED.fullmatch(line.strip().lstrip(MARKS).strip())
        found = _UNIT_KEY.match(line)
        if _OF_OTHERS.search(line if found is None else line[: found.start("value")]):
            continue
        if keyed and _FACTS.fullmatch(re.sub(r"[^a-z0-9]", "", folded(keyed["key"]))):
            continue
        if found is not None:
            value = _SIZE.sub(" ", found["value"])
            words = [word.strip(".,;()[]") for word in re.split(r"[\s,;]+", value)]
            units = [unit for word in words if word and (unit := _known(word)) is not None]
            rest = " ".join(word for word in words if word and _known(word) is None)
            if units and _SCALED.search(rest):
                raise _scaled_unit(line, file)
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
                unit, rest = _known(found["word"]), line[found.end() :]
                if unit is None or _OF_NUMBER.match(rest) or re.search(rf"{NUMBER}\s*$", line[: found.start()]):
                    continue
                alone = not re.search(r"\w", line[: found.start()])
                if pattern is _UNIT and not (alone or _OF_SAMPLES.search(line[: found.end()])):
                    continue
                if re.match(r"\s*(?:[*×/]|x\b|times\b)", rest, re.IGNORECASE):
                    raise _scaled_unit(line, file)
                seen.setdefault(unit[1], (unit[0], line))
    if len(seen) > 1:
        shown = " and ".join(repr(line) for _, line in seen.values())
        raise InputError(f"{file}: {shown} name different units; keep the one that is right.")
    return next(iter(seen.values()), (None, ""))


def _scaled_unit(line: str, file: str) -> InputError:
    return InputError(
        f"{file}: the line {line!r} says that numbers are some times a unit, which is not understood; multiply them, and "
        "name g, m/s2, gal or mm/s2."
    )


def _known(word: str) -> tuple[str, float] | None:
    try:
        return acceleration_unit(word)
    except InputError:
        return None
