"""A record before it becomes a motion: components with their direction and times, and facts of the header, checked."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from ...constants import g
from ...errors import InputError, OutOfRangeWarning, warn
from ...messages import joined, percent, say
from ..conditioning import best_of, cure_request, cures_of
from ..events import moment_of
from ..motion import MAX_SAMPLES, STRONGEST, Motion, integrate

#: Steps of accelerographs [s]: 5000 to 5 samples per second.
SHORTEST_STEP, LONGEST_STEP = 2e-4, 0.2

#: A step of film this many times the steps of its neighbours, so many on either side, may be a lost line.
GAP, NEIGHBOURS = 2.8, 3

CUT = "the file is damaged or cut, fetch it again"


def check_sampling(dt: float, what: str) -> float:
    """A step of samples that is one of accelerographs, wherever it comes from; milliseconds are no seconds.

    Parameters
    ----------
    dt : float
        [s]
    what : str
        Whose step, for the message.
    """
    if not SHORTEST_STEP <= dt <= LONGEST_STEP:
        thousandth = dt > LONGEST_STEP and 1e-3 * dt >= SHORTEST_STEP
        remedy = (
            f"if it counts milliseconds, name the column time_ms (without times: `dt={1e-3 * dt:g}`)"
            if thousandth
            else "mend it"
        )
        raise InputError(
            f"{what} is {dt:g} s; allowed is {SHORTEST_STEP:g} to {LONGEST_STEP:g} s, as accelerographs have: {remedy}."
        )
    return dt


def rising_pairs(numbers: np.ndarray, file: str, start: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of pairs, refused where a time falls, or where samples are missing between two of them.

    Parameters
    ----------
    numbers : array
        Time [s] and value in turn, shape (2 N,).
    file : str
    start, rows : int
        Lines above the pairs, and lines that hold them, the last one perhaps fewer than the others.
    """
    time, values = numbers.reshape(-1, 2).T.copy()
    steps = np.diff(time)
    per_row = -(-len(time) // rows)

    def where(at: int) -> str:
        line = start + (at + 1) // per_row + 1
        words = say("{file}, line {line}: the time goes from {before:g} s to {after:g} s")
        return words.of(file=file, line=line, before=time[at], after=time[at + 1])

    if (steps < 0.0).any():
        raise InputError(f"{where(int((steps < 0.0).argmax()))}, where it may not fall; mend it.")
    at = int(steps.argmax())
    if steps[at] > LONGEST_STEP:
        raise InputError(f"{where(at)}, a gap beyond the {LONGEST_STEP:g} s that records have between samples; {CUT}.")
    largest = np.lib.stride_tricks.sliding_window_view(np.pad(steps, NEIGHBOURS, mode="edge"), NEIGHBOURS).max(axis=1)
    around = np.maximum(largest[: len(steps)], largest[NEIGHBOURS + 1 :])  # of those before, and of those behind
    bad = np.flatnonzero(steps > GAP * around)
    if bad.size:
        warn(
            say(
                "{where}, {times:g} times the steps before and behind it and more; check that no line is missing.",
                where=where(int(bad[0])),
                times=GAP,
            ),
            OutOfRangeWarning,
        )
    return time, values


def check_same_step(first: float, second: float, file: str, line: int) -> None:
    """Two statements of one step agree, but for rounding."""
    if abs(first - second) > 0.01 * first:
        raise InputError(
            f"{file}, line {line}: the header states a step of {first:g} s and one of {second:g} s; {CUT}."
        )


def check_whole(lines: Sequence[str], ends_with_newline: bool, file: str) -> None:
    """The last number of a text was not cut: its digits are those of the numbers before it."""
    if ends_with_newline or not lines:
        return
    tokens = [token for line in lines[-8:] for token in re.split(r"[\s,;]+|(?<=[0-9.])(?=[+-])", line.strip()) if token]
    shapes = [_decimals(token) for token in tokens]
    if len(shapes) < 5 or any(shape is None for shape in shapes):
        return
    if len(set(shapes[:-1])) == 1 and shapes[-1] != shapes[0]:
        raise InputError(
            f"{file}, line {len(lines)}: the last number, {tokens[-1]!r}, has other digits than those before it and no "
            f"line end follows; {CUT}."
        )


def _decimals(token: str) -> tuple[int, int] | None:
    """Digits after the point and of the exponent, or None where the token is no plain number."""
    match = re.fullmatch(r"[+-]?[0-9]*(?:\.(?P<after>[0-9]*))?(?:[eEdD][+-]?(?P<power>[0-9]+))?", token)
    if match is None or "." not in token:
        return None
    return len(match["after"] or ""), len(match["power"] or "")


# -- One component of a record as a reader finds it, before it becomes part of a motion -------------------------------


class UnstatedError(InputError):
    """The file leaves its unit or its step open, which the caller can state."""


#: Departure from a right angle of two horizontal components of one record [degrees].
SQUARE = 5.0


def at_right_angles(azimuth: float, other: float) -> bool:
    """Whether two azimuths are those of two horizontal components of one record [degrees]."""
    return abs((azimuth - other) % 180.0 - 90.0) <= SQUARE


@dataclass
class Component:
    """One component of a record.

    Parameters
    ----------
    values : array
        Acceleration [m/s²], shape (steps,).
    dt : float
        Step [s]; NaN where ``time`` holds unequal steps, or where no step is known.
    label : str
        Direction as the file states it: ``90 DEG``, ``Up``, ``H1``.
    azimuth : float, optional
        Direction of positive acceleration, clockwise from north [degrees].
    vertical : bool
        Upward or downward; the sign is turned so that upward is positive.
    time : array, optional
        Times of irregular samples [s], shape (steps,).
    metadata : dict
        What this component's own header says.
    processing : list of str
        What the reader did to the values.
    history : list of str
        What was done to the whole record before, as its file says.
    file : str
        Name of the file it was read from.
    first : float, optional
        Time of the first sample on the file's own clock [s], where it states times.
    named : bool
        The label is the file's own; one that was given for its place in the file does not tell a direction.
    facts : dict
        What its file says of the whole record.
    proven : bool
        Step and samples are those that this package wrote, as their digest proves: the step may be any.
    """

    values: np.ndarray
    dt: float
    label: str = ""
    azimuth: float | None = None
    vertical: bool = False
    time: np.ndarray | None = None
    metadata: dict = field(default_factory=dict)
    processing: list[str] = field(default_factory=list)
    history: list[str] = field(default_factory=list)
    file: str = ""
    first: float | None = None
    named: bool = True
    facts: dict = field(default_factory=dict)
    proven: bool = False


# -- Time columns -----------------------------------------------------------------------------------------------------


#: Departure from equal steps that is rounding of the printed times, as a share of the step.
ROUNDING_SHARE = 0.05


def step_of(time: np.ndarray) -> float | None:
    """Step of times that are equally spaced but for rounding [s], or None."""
    if len(time) < 2 or not time[-1] > time[0]:
        return None
    dt = float((time[-1] - time[0]) / (len(time) - 1))
    grid = time[0] + dt * np.arange(len(time))
    if np.abs(time - grid).max() > ROUNDING_SHARE * dt:
        return None
    # The step as it was meant: the shortest decimal that fits all the times as well.
    for digits in range(1, 13):
        short = float(f"{dt:.{digits}g}")
        if abs(short - dt) * (len(time) - 1) <= 1e-3 * dt:
            return short
    return dt


def first_bad_step(time: np.ndarray) -> int:
    """Index of the first sample that does not lie one step after the one before it."""
    steps = np.diff(time)
    dt = float(np.median(steps))
    bad = np.flatnonzero(np.abs(steps - dt) > ROUNDING_SHARE * abs(dt))
    return int(bad[0]) + 1 if bad.size else len(time) - 1


def resampled(time: np.ndarray, values: np.ndarray, dt: float | None, name: str) -> tuple[float, np.ndarray, str]:
    """Values at equal steps, linear between the given ones.

    Parameters
    ----------
    time : array
        Increasing times [s], shape (steps,); equal neighbours are merged.
    values : array
        Shape (steps,).
    dt : float, optional
        Step [s]. By default the decimal in which the times are given, if a median step holds few of it: that keeps
        every sample. Else the median step, halved until the samples are kept to 0.1 % of the peak, at most four times.
    name : str
        For messages.

    Returns
    -------
    dt : float
    values : array
    note : str
        What was done, for the processing history.
    """
    keep = np.concatenate([[True], np.diff(time) > 0.0])
    time, values = time[keep], values[keep]
    if len(time) < 2:
        raise InputError(f"{name}: the times do not increase; give a record with increasing times.")
    steps = np.diff(time)
    median = float(f"{np.median(steps):.6g}")
    span = float(time[-1] - time[0])
    peak = max(float(np.abs(values).max()), 1e-300)

    def at(step: float) -> tuple[np.ndarray, float]:
        count = math.floor(span / step + 1e-6) + 1
        if count > MAX_SAMPLES:
            raise InputError(f"{name}: {count} samples at a step of {step:g} s; allowed is up to {MAX_SAMPLES}.")
        if dt is None and count > 100 * len(time) + 1000:
            raise InputError(
                f"{name}: the steps of the times range from {steps.min():.4g} to {steps.max():.4g} s, which is a "
                "gap, not film; mend the times, or state a step to resample to: `dt=0.01`.",
                "dt",
            )
        grid = time[0] + step * np.arange(count)
        samples = np.interp(grid, time, values)
        return samples, float(
            np.abs(np.interp(time[time <= grid[-1]], grid, samples) - values[time <= grid[-1]]).max()
        ) / peak

    if dt is not None:
        step = check_sampling(dt, "`dt`")
        new, departure = at(step)
    else:
        step = decimal_of(time, median)
        if step is None:
            step = median
            for _ in range(4):
                if at(step)[1] <= 1e-3:
                    break
                step *= 0.5
        new, departure = at(step)
    note = say(
        "resampled linearly from unequal steps ({min:.4g} to {max:.4g} s, median {median:.4g} s) to {step:.6g} "
        "s; departs by up to {departure:.2%} of the peak at the original times",
        min=steps.min(),
        max=steps.max(),
        median=median,
        step=step,
        departure=departure,
    )
    return step, new, note


def decimal_of(time: np.ndarray, median: float) -> float | None:
    """The decimal (0.001 s …) of which all times are multiples, if a median step holds no more than 16 of it."""
    for digits in range(1, 7):
        unit = 10.0**-digits
        if median / unit > 16.0:
            return None
        if np.abs(time / unit - np.round(time / unit)).max() < 1e-3:
            return unit
    return None


def same_step(components: list[Component], name: str, dt: float | None, processing: list[str]) -> float:
    """Bring all components to one step; irregular ones are resampled, and ``processing`` says so."""
    irregular = [component for component in components if component.time is not None]
    if irregular:
        wanted = dt
        for component in irregular:
            assert component.time is not None
            check_sampling(float(np.median(np.diff(component.time))), f"the median step of the times of {name}")
            step, component.values, note = resampled(component.time, component.values, wanted, name)
            component.dt = wanted = step
            component.processing.append(note)
    steps = [component.dt for component in components]
    if any(math.isnan(step) for step in steps):
        if dt is None:
            raise InputError(f"{name} has no time column and states no step; state it: `dt=0.01`.", "dt")
        return check_sampling(dt, f"the step of {name}, `dt`,")
    if max(steps) - min(steps) > 1e-6 * max(steps):
        shown = ", ".join(f"{step:g} s" for step in steps)
        raise InputError(f"components of {name} have different steps ({shown}); resample them to one step before use.")
    if dt is not None and not irregular and abs(dt - steps[0]) > 1e-3 * steps[0]:
        raise InputError(f"{name} states a step of {steps[0]:g} s, but dt is given as {dt:g} s; leave dt out.")
    if irregular or all(component.proven for component in components):
        return steps[0]
    return check_sampling(steps[0], f"the step of {name}")


# -- Whether components are of one record -----------------------------------------------------------------------------


#: Facts by which a record is told from another, with their nouns. A station that one file alone states is another one.
IDENTITY = {"station": "station", "network": "network", "location": "location", "event": "event", "event_id": "event"}

#: Facts that each component of a file may state for itself.
OWN_FACTS = (*IDENTITY, "station_name", "start_time")

#: Labels of a channel that state no direction.
_NO_DIRECTION = ("", "other")

_REMEDY = "give the components of one record, or choose one by its number with `component='1'`"


def check_one_record(components: Sequence[Component]) -> None:
    """Components of one station and earthquake, of which no two point the same way.

    Raises
    ------
    InputError
        They name two stations, networks, locations or events; two horizontal ones are not at right angles, or
        have one label.
    """
    for component, other in combinations(components, 2):
        for key, noun in IDENTITY.items():
            first, second = (" ".join(str(each.facts.get(key) or "").split()) for each in (component, other))
            stated = key == "station" or None not in (component.facts.get(key), other.facts.get(key))
            if stated and first.casefold() != second.casefold():
                words = f"{noun} {first!r}" if first else f"no stated {noun}"
                raise _not_one(
                    f"{_called(component)} is of {words}, {_called(other)} of {repr(second) if second else 'none'}"
                )
        if component.vertical or other.vertical:
            continue
        if component.azimuth is not None and other.azimuth is not None:
            if not at_right_angles(component.azimuth, other.azimuth):
                raise _not_one(
                    f"{_called(component)} points to {component.azimuth:g}°, {_called(other)} to {other.azimuth:g}°; "
                    f"allowed are horizontal components at right angles, within {SQUARE:g}°"
                )
        elif component.named and other.named and component.label.lower() == other.label.lower() not in _NO_DIRECTION:
            raise _not_one(f"{_called(component)} and {_called(other)} have one label; allowed are two directions")


def common_span(
    components: Sequence[Component], axes: Sequence[str], step: float
) -> tuple[dict[str, np.ndarray], Component, str]:
    """The samples of the time in which all components were recorded.

    Parameters
    ----------
    components : sequence of Component
        Of one record.
    axes : sequence of str
        Theirs.
    step : float
        Of the samples [s].

    Returns
    -------
    values : dict of array
        Accelerations by axis [m/s²], all of one length.
    last : Component
        The one that begins last; the first one where all begin within half a sample.
    note : str
        What was cut; empty where nothing was.

    Raises
    ------
    InputError
        Two components do not overlap, or their files do not tell to half a sample how far apart they begin.
    """
    for component, other in combinations(components, 2):
        _check_clocks(component, other, step)
    known = next((component for component in components if component.facts.get("start_time")), components[0])
    begin = [_seconds_after(known, component) for component in components]
    later = [round((at - min(begin)) / step) for at in begin]
    skipped = [round((max(begin) - at) / step) for at in begin]
    lengths = [len(component.values) for component in components]
    count = min(length - skip for length, skip in zip(lengths, skipped))
    values = {axis: component.values[skip : skip + count] for axis, component, skip in zip(axes, components, skipped)}
    if not any(later) and len(set(lengths)) == 1:
        return values, components[0], ""
    details = [f"{axis}: {length}" for axis, length in zip(axes, lengths)]
    begins = say("{axis} begins {time:g} s later")
    details += [begins.of(axis=axis, time=steps * step) for axis, steps in zip(axes, later) if steps]
    span, length_ = (
        say("cut to the common span of {count} samples ({names})"),
        say("cut to the common length of {count} samples ({names})"),
    )
    note = (span if any(later) else length_).of(count=count, names=joined(", ", details))
    return values, components[later.index(max(later))], note


def _seconds_after(reference: Component, component: Component) -> float:
    """How long after ``reference`` a component begins [s]; zero where their files do not say."""
    apart = 0.0 if reference.first is None or component.first is None else component.first - reference.first
    first, second = moment_of(_start(reference)), moment_of(_start(component))
    return apart if first is None or second is None else apart + (second.at - first.at).total_seconds()


def _check_clocks(component: Component, other: Component, step: float) -> None:
    """Two components overlap, and their files tell to half a sample how far apart they begin."""
    apart = _seconds_after(component, other)
    if abs(apart) >= step * (len((other if apart < 0.0 else component).values) - 1):
        raise _not_one(
            f"{_called(component)} and {_called(other)} do not overlap, as they begin at {_begins(component, other)}"
        )
    if _start(component) == _start(other) or "" in (_start(component), _start(other)):
        return
    first, second = moment_of(_start(component)), moment_of(_start(other))
    if (
        first is None
        or second is None
        or first.zoned != second.zoned
        or (first.at != second.at and first.digit + second.digit > step)
    ):
        raise _not_one(
            f"{_called(component)} and {_called(other)} begin at {_begins(component, other)}, which does not tell to half a "
            f"sample ({0.5 * step:g} s) how far apart that is"
        )


def _start(component: Component) -> str:
    """When a component begins, as its file states it."""
    return " ".join(str(component.facts.get("start_time") or "").split())


def _begins(component: Component, other: Component) -> str:
    """When both begin: their starts, and the times of their first samples where these are not 0."""
    parts = ([_start(each), f"{each.first:g} s" if each.first else ""] for each in (component, other))
    return " and ".join(" + ".join(filter(None, part)) or "0 s" for part in parts)


def _called(component: Component) -> str:
    return f"{component.label or 'a component'} of {component.file}"


def _not_one(what: str) -> InputError:
    return InputError(f"{what}; {_REMEDY}.", "component")


# -- Contents of a file before it becomes a motion --------------------------------------------------------------------


#: A mean beyond this share of the peak is not an earthquake: an instrument's offset was left in.
OFFSET_SHARE = 0.1

#: A smaller peak is not recorded on purpose [g]: the unit is wrong, or the numbers are raw counts.
SMALLEST_PEAK = 1e-3

#: A velocity beyond every recorded one [m/s]: the unit is wrong, or the baseline has drifted away.
LARGEST_VELOCITY = 10.0


_ANGLE = r"(?P<angle>\d{1,3}(?:\.\d*)?)\s*(?:°|DEG\.?)?"
#: ``N10.5E`` anywhere; ``N345`` and ``90 DEG`` at the beginning of a label.
_BEARING = re.compile(rf"\b(?P<pole>[NS])\s*{_ANGLE}\s*(?P<side>[EW])\b")
_FROM_NORTH = re.compile(rf"N\.?\s*(?=\d\d){_ANGLE}(?!\w)")
_DEGREES = re.compile(rf"[+]?{_ANGLE}(?=[\s,;:]|$)")
_POINTS = {
    "N": 0.0, "NS": 0.0, "E": 90.0, "EW": 90.0, "S": 180.0, "SN": 180.0, "W": 270.0, "WE": 270.0,
    "NE": 45.0, "SE": 135.0, "SW": 225.0, "NW": 315.0,
}  # fmt: skip
#: SEED codes of accelerometers whose last letter is a direction; any code that ends in Z is vertical. The two signs of a
#: location may touch the code, as in HNZ00 and 00HNZ.
_CODE = re.compile(r"(?:\d\d)?(?:[BCDEFGHLMS][NLG](?P<way>[NEV])|[A-Z]{2}(?P<up>Z))(?:\d[A-Z0-9]|[A-Z]\d)?")
#: A vertical of a sensor, wherever its code stands in a label: XX.HILL.00.HNZ.
_CODE_UP = re.compile(r"(?:\d\d)?[BCDEFGHLMS][HLNG]Z(?:\d[A-Z0-9]|[A-Z]\d)?")
#: Words of the vertical that leave its sense open, which then is upward; and those that state it.
_UPRIGHT = {"V", "Z", "VER", "VRT", "VERT", "VERTIC", "VERTICAL"}
_UP = {"U", "UP", "UD", "UPDN", "UPDOWN", "UPWARD", "UPWARDS"}
_DOWN = {"D", "DN", "DWN", "DU", "DOWN", "DNUP", "DOWNUP", "DOWNWARD", "DOWNWARDS"}


def direction(label: str) -> tuple[float | None, bool, float]:
    """Azimuth [degrees], whether vertical, and the sign that makes upward positive, from a label of any network.

    ``90 DEG``, ``N10.5E``, ``S74E``, ``N345``, ``Up``, ``-UP``, ``Vert(Down)``, ``Roof UP``, ``NORTH-SOUTH``, ``HNZ``,
    ``H1`` (azimuth unknown).
    """
    text = re.sub(r"COMP(?:ONENT)?", " ", label.upper().replace("_", " ")).strip(" .:;")
    text = re.sub(r"\b([NSEW])(?:ORTH|OUTH|AST|EST)\b", r"\1", text)
    words = re.findall(r"[A-Z0-9]+", text)
    minus = -1.0 if re.match(r"-\s*[A-Z]", text) or re.search(r"[A-Z](?:;?-|\s?\(-\))$", text) else 1.0
    bare = words[0].rstrip("0123456789") if words else ""
    if bare in (_UPRIGHT | _UP | _DOWN) - {"U", "D", "V"}:  # UP1, VERT00, Z00
        words[0] = bare
    code = _CODE.fullmatch(words[0]) if words else None
    if words and (words[0] in _UPRIGHT or (code and (code["up"] or code["way"] == "V"))):
        return None, True, -minus if len(words) > 1 and words[1] in _DOWN and len(words[1]) > 1 else minus
    if words and words[0] in _UP | _DOWN:
        return None, True, -minus if words[0] in _DOWN else minus
    if any(map(_CODE_UP.fullmatch, words)):
        return None, True, minus
    if minus < 0.0 or re.match(r"-\s*\d", text):  # against a direction that is not vertical: whose, is not known
        return None, False, 1.0
    if (match := _BEARING.search(text)) and float(match["angle"]) <= 90.0:
        angle = float(match["angle"])
        angle = angle if match["pole"] == "N" else 180.0 - angle
        return (angle if match["side"] == "E" else -angle) % 360.0, False, 1.0
    if (match := _FROM_NORTH.match(text) or _DEGREES.match(text)) and float(match["angle"]) <= 360.0:
        return float(match["angle"]) % 360.0, False, 1.0
    if code:
        return _POINTS[code["way"]], False, 1.0
    first = re.split(r"[\s,.;:]", text)[0].replace("-", "", not text.startswith("-")).replace("/", "")
    if first in _POINTS and not re.search(r"^\w+\W+\d|\d\s*(?:°|DEG)", text):  # of N 5 the angle is not known
        return _POINTS[first], False, 1.0
    if upright := [word for word in words if len(word) > 1 and word in _UPRIGHT | _UP | _DOWN]:  # Roof UP
        return None, True, -minus if upright[-1] in _DOWN else minus
    return None, False, 1.0


def assemble(
    components: list[Component], name: str, *, component: str | None = None, dt: float | None = None
) -> Motion:
    """Make a motion of the components of one record: the first two horizontal ones are x and y, the vertical one z.

    Parameters
    ----------
    components : list of Component
        With the facts of their files; those of x hold for the motion.
    name : str
        Of the motion and in messages.
    component : str, optional
        Label, azimuth in degrees or number (from 1) of the one component that is to be x.
    dt : float, optional
        Step for a record whose steps are unequal [s].

    Raises
    ------
    InputError
        No horizontal component, several records, components of different steps, or whose times do not overlap.
    """
    if component is not None:
        chosen = _choose(components, component, name)
        name = chosen.file or name
        components, rest = [chosen], [channel for channel in components if channel is not chosen]
        chosen.vertical = False
        dropped = [channel.label or "?" for channel in rest]
    else:
        dropped = []
    horizontal = [channel for channel in components if not channel.vertical]
    vertical = [channel for channel in components if channel.vertical]
    if not horizontal:
        raise InputError(
            f"{name} holds only the vertical component {vertical[0].label!r}, and a motion needs a horizontal one; "
            "give the horizontal files with it.",
            "component",
        )
    if len(horizontal) > 2 or len(vertical) > 1:
        raise InputError(
            f"{name} holds {len(components)} components ({', '.join(channel.label or '?' for channel in components)}), more "
            "than one place's two horizontal ones and the vertical; choose one by its number with `component='1'`.",
            "component",
        )
    used = horizontal + vertical
    check_one_record(used)
    histories = {tuple(channel.history): channel.file for channel in used}
    processing = [
        text if len(histories) == 1 else f"{file}: {text}" for steps, file in histories.items() for text in steps
    ]
    axes = [axis for axis, _ in zip(["x", "y"], horizontal)] + ["z"] * len(vertical)
    step = same_step(used, name, dt, processing)
    values, last, note = common_span(used, axes, step)
    if note:
        processing.append(note)
        warn(say("{name}: {note}.", name=name, note=note))
    for axis, channel in zip(axes, used):
        processing += [say("{axis}: {text}", axis=axis, text=text) for text in channel.processing]
    _warn_of_peak(values, step, name)
    _warn_of_offset(values, name)
    facts = used[0].facts | {key: last.facts[key] for key in ("start_time", "first_time") if key in last.facts}
    facts |= {
        "azimuths": {axis: channel.azimuth for axis, channel in zip(axes, used)},
        "labels": {axis: channel.label for axis, channel in zip(axes, used)},
        "dt_found": step if all(channel.time is None for channel in used) else None,
        "components": {axis: dict(channel.metadata) for axis, channel in zip(axes, used) if channel.metadata},
    }
    if dropped:
        facts["components_left_out"] = dropped
    return Motion(
        step,
        values["x"],
        values.get("y"),
        values.get("z"),
        name=name,
        metadata=facts,
        processing=tuple(processing),
    )


def _choose(components: list[Component], wanted: str, name: str) -> Component:
    """The component of a label, a number, an azimuth or an axis x, y, z as the whole record would have it."""
    text = str(wanted).strip()
    folded = " ".join(text.lower().split())
    exact = [component for component in components if " ".join(component.label.lower().split()) == folded]
    if len(exact) == 1:
        return exact[0]
    if re.fullmatch(r"[0-9]{1,3}", text) and 1 <= int(text) <= len(components):
        return components[int(text) - 1]
    if re.fullmatch(r"[0-9]{1,3}(\.[0-9]+)?", text):
        near = [
            component
            for component in components
            if component.azimuth is not None and abs(component.azimuth - float(text) % 360.0) < 0.5
        ]
        if len(near) == 1:
            return near[0]
    horizontal = [component for component in components if not component.vertical]
    vertical = [component for component in components if component.vertical]
    axes = dict(zip("xy", horizontal)) | ({"z": vertical[0]} if len(vertical) == 1 else {})
    if folded in axes and len(horizontal) <= 2:
        return axes[folded]
    azimuth, upright, _ = direction(text)
    alike = (
        vertical
        if upright
        else [component for component in horizontal if azimuth is not None and component.azimuth == azimuth]
    )
    if len(alike) == 1 and not text[:1].isdigit():
        return alike[0]
    by_axis = {id(component): axis for axis, component in axes.items()}
    labels = ", ".join(
        f"{i} ({component.label or 'no label'}{', axis ' + by_axis[id(component)] if id(component) in by_axis else ''})"
        for i, component in enumerate(components, 1)
    )
    raise InputError(
        f"{name} has no component {wanted!r}; it holds {labels}: give a number, a label or an axis.", "component"
    )


def _warn_of_peak(values: dict[str, np.ndarray], step: float, name: str) -> None:
    peaks = {axis: float(np.abs(array).max(initial=0.0)) / g for axis, array in values.items()}
    for axis, peak in peaks.items():
        if peak > STRONGEST:
            words = say(
                "{name}: the peak of component {axis} is {peak:.3g} g, more than was ever recorded; check the unit."
            )
            warn(words.of(name=name, axis=axis, peak=peak))
    if 0.0 < max(peaks.values()) < SMALLEST_PEAK:
        warn(
            say(
                "{name}: the peak is {max:.3g} g, which shakes no column; check the unit, and whether these are "
                "accelerations.",
                name=name,
                max=max(peaks.values()),
            )
        )
    for axis, array in values.items():
        fastest = float(np.abs(integrate(array, step)).max())
        if fastest > LARGEST_VELOCITY and peaks[axis] <= STRONGEST:
            cure = best_of(cures_of(array, step, LARGEST_VELOCITY))
            words = say(
                "{name}: component {axis} reaches a velocity of {fastest:.3g} m/s, more than was ever recorded; check the "
                "unit and the step{drift}."
            )
            drift = (
                "" if cure is None else say(", or take off the drift of the baseline ({cure})", cure=cure_request(cure))
            )
            warn(words.of(name=name, axis=axis, fastest=fastest, drift=drift))


def _warn_of_offset(values: dict[str, np.ndarray], name: str) -> None:
    for axis, array in values.items():
        peak = float(np.abs(array).max(initial=0.0))
        mean = float(array.mean()) if array.size else 0.0
        if peak > 0.0 and abs(mean) > OFFSET_SHARE * peak:
            warn(
                say(
                    "{name}: the mean of component {axis} is {mean:.3g} g, {share} of its peak, as when an "
                    "instrument's offset was left in; take it off ({step}) unless it is meant.",
                    name=name,
                    axis=axis,
                    mean=mean / g,
                    share=percent(abs(mean) / peak),
                    step="`condition='demean'`",
                )
            )
