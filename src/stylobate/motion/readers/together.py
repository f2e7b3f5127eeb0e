"""Whether components are of one record: one station, one earthquake, two directions at right angles, one clock."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ...errors import InputError
from ...messages import joined, say
from ..events import moment_of
from .component import SQUARE, Component, at_right_angles

#: Facts by which a record is told from another, with their nouns. A station that one file alone states is another one.
TOLD_BY = {"station": "station", "network": "network", "location": "location", "event": "event", "event_id": "event"}

#: Facts that each component of a file may state for itself.
OWN_FACTS = (*TOLD_BY, "station_name", "start_time")

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
    for one, other in combinations(components, 2):
        for key, noun in TOLD_BY.items():
            first, second = (" ".join(str(each.facts.get(key) or "").split()) for each in (one, other))
            stated = key == "station" or None not in (one.facts.get(key), other.facts.get(key))
            if stated and first.casefold() != second.casefold():
                told = f"{noun} {first!r}" if first else f"no stated {noun}"
                raise _not_one(f"{_called(one)} is of {told}, {_called(other)} of {repr(second) if second else 'none'}")
        if one.vertical or other.vertical:
            continue
        if one.azimuth is not None and other.azimuth is not None:
            if not at_right_angles(one.azimuth, other.azimuth):
                raise _not_one(
                    f"{_called(one)} points to {one.azimuth:g}°, {_called(other)} to {other.azimuth:g}°; allowed are "
                    f"horizontal components at right angles, within {SQUARE:g}°"
                )
        elif one.named and other.named and one.label.lower() == other.label.lower() not in _NO_DIRECTION:
            raise _not_one(f"{_called(one)} and {_called(other)} have one label; allowed are two directions")


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
    for one, other in combinations(components, 2):
        _check_clocks(one, other, step)
    known = next((one for one in components if one.facts.get("start_time")), components[0])
    begin = [_seconds_after(known, one) for one in components]
    later = [round((at - min(begin)) / step) for at in begin]
    skipped = [round((max(begin) - at) / step) for at in begin]
    lengths = [len(one.values) for one in components]
    count = min(length - skip for length, skip in zip(lengths, skipped))
    values = {axis: one.values[skip : skip + count] for axis, one, skip in zip(axes, components, skipped)}
    if not any(later) and len(set(lengths)) == 1:
        return values, components[0], ""
    told = [f"{axis}: {length}" for axis, length in zip(axes, lengths)]
    begins = say("{axis} begins {time:g} s later")
    told += [begins.of(axis=axis, time=steps * step) for axis, steps in zip(axes, later) if steps]
    span, length_ = (
        say("cut to the common span of {count} samples ({names})"),
        say("cut to the common length of {count} samples ({names})"),
    )
    note = (span if any(later) else length_).of(count=count, names=joined(", ", told))
    return values, components[later.index(max(later))], note


def _seconds_after(one: Component, other: Component) -> float:
    """How long after ``one`` a component begins [s]; zero where their files do not say."""
    apart = 0.0 if one.first is None or other.first is None else other.first - one.first
    first, second = moment_of(_start(one)), moment_of(_start(other))
    return apart if first is None or second is None else apart + (second.at - first.at).total_seconds()


def _check_clocks(one: Component, other: Component, step: float) -> None:
    """Two components overlap, and their files tell to half a sample how far apart they begin."""
    apart = _seconds_after(one, other)
    if abs(apart) >= step * (len((other if apart < 0.0 else one).values) - 1):
        raise _not_one(f"{_called(one)} and {_called(other)} do not overlap, as they begin at {_begins(one, other)}")
    if _start(one) == _start(other) or "" in (_start(one), _start(other)):
        return
    first, second = moment_of(_start(one)), moment_of(_start(other))
    if (
        first is None
        or second is None
        or first.zoned != second.zoned
        or (first.at != second.at and first.digit + second.digit > step)
    ):
        raise _not_one(
            f"{_called(one)} and {_called(other)} begin at {_begins(one, other)}, which does not tell to half a sample "
            f"({0.5 * step:g} s) how far apart that is"
        )


def _start(one: Component) -> str:
    """When a component begins, as its file states it."""
    return " ".join(str(one.facts.get("start_time") or "").split())


def _begins(one: Component, other: Component) -> str:
    """When both begin: their starts, and the times of their first samples where these are not 0."""
    parts = ([_start(each), f"{each.first:g} s" if each.first else ""] for each in (one, other))
    return " and ".join(" + ".join(filter(None, part)) or "0 s" for part in parts)


def _called(one: Component) -> str:
    return f"{one.label or 'a component'} of {one.file}"


def _not_one(what: str) -> InputError:
    return InputError(f"{what}; {_REMEDY}.", "component")
