"""Which records are of one earthquake, and which files hold one recording."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta
from typing import NamedTuple

import numpy as np

from .motion import Motion
from .spectra import pseudo_acceleration

#: Records whose spans come within so much of one another are of one earthquake: waves take it to stations at 400 km [s].
BETWEEN_STATIONS = 120.0

#: Records that name one event and were taken further apart are of two: sequences go by one name [s].
ONE_NAME = 86400.0

#: Where a file states no zone of time, by so much its clock may differ from UTC either way [s].
ZONES_APART = 14 * 3600.0

#: Length of a day [s].
DAY = 86400.0

#: Zones of time that files name, in hours from UTC.
ZONES = {"UTC": 0, "UT": 0, "GMT": 0, "GPS": 0, "Z": 0, "PDT": -7, "PST": -8, "JST": 9, "NZST": 12, "NZDT": 13}

_MONTHS = ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec")
_DATES = (
    re.compile(r"(?<!\d)(?P<year>\d{4})[-/ ]+(?P<month>\d{1,2}|[A-Za-z]{3,9})[-/ ]+(?P<day>\d{1,2})(?!\d)"),
    re.compile(r"(?<!\d)(?P<year>\d{4})(?P<month>\d{2})(?P<day>\d{2})(?!\d{3})"),
    re.compile(r"(?<!\d)(?P<month>\d{1,2})/(?P<day>\d{1,2})/(?P<year>\d{4}|\d{2})(?!\d)"),
    re.compile(r"(?P<month>[A-Za-z]{3,9})\.? +(?P<day>\d{1,2}), *(?P<year>\d{4})"),
)
_CLOCK = re.compile(r"(?<!\d)(?P<hour>\d{1,2}):\s?(?P<minute>\d{2})(?::\s?(?P<second>\d{1,2}(?:\.\d+)?))?")
_COMPACT = re.compile(r"\d{8}[_ T](?P<hour>\d{2})(?P<minute>\d{2})(?P<second>\d{2}(?:\.\d+)?)")
_ZONE = re.compile(rf"(?:\d\s*|\b)(?P<zone>{'|'.join(ZONES)})\b")


class Moment(NamedTuple):
    """A time that a file states: in UTC where it names a zone, and the unit of its last digit [s], a day without a clock."""

    at: datetime
    zoned: bool
    digit: float


class Span(NamedTuple):
    """Between which times a record was taken, in UTC, and whether its file states them to the second."""

    first: datetime
    last: datetime
    exact: bool


def moment_of(line: str) -> Moment | None:
    """The time that a line states; None where it states no date."""
    day = next((match for pattern in _DATES if (match := pattern.search(line))), None)
    if day is None:
        return None
    year, month = int(day["year"]), day["month"].lower()
    year += 0 if year > 99 else 1900 if year > 50 else 2000
    try:
        at = datetime(year, int(month) if month.isdecimal() else _MONTHS.index(month[:3]) + 1, int(day["day"]))
        digit = DAY
        if (clock := _COMPACT.search(line) or _CLOCK.search(line, day.end())) is not None:
            second = clock["second"] or ""
            at += timedelta(hours=int(clock["hour"]), minutes=int(clock["minute"]), seconds=float(second or 0.0))
            digit = 10.0 ** -len(second.partition(".")[2]) if second else 60.0
        zone = _ZONE.search(line, day.end())
        return Moment(at - timedelta(hours=ZONES[zone["zone"]] if zone else 0), zone is not None, digit)
    except (ValueError, OverflowError):
        return None


def span_of(motion: Motion) -> Span | None:
    """When a record was taken; None where its file states no date."""
    start = moment_of(str(motion.metadata.get("start_time") or "") or str(motion.metadata.get("event") or ""))
    if start is None:
        return None
    clocked = start.digit < DAY
    apart = timedelta(seconds=0.0 if start.zoned else ZONES_APART)
    try:
        last = start.at + timedelta(seconds=motion.duration if clocked else DAY)
        return Span(start.at - apart, last + apart, clocked and start.zoned)
    except OverflowError:
        return None


def events_of(motions: Sequence[Motion]) -> list[int]:
    """A number for each record, the same for those of one earthquake, shape (N,).

    Records are of one earthquake where their files give the same number of the event (``event_id``), or else the same name
    and no dates more than a day apart; or where they were taken at the same time: at times stated to the second, or else,
    where one of the two names no event, as far as their dates go.
    """
    names = [str(motion.metadata.get("event") or "") for motion in motions]
    ids = [str(motion.metadata.get("event_id") or "") for motion in motions]
    spans = [span_of(motion) for motion in motions]
    numbers = list(range(len(motions)))
    for index in range(len(motions)):
        for other in range(index):
            if ids[index] and ids[other]:
                alike = ids[index] == ids[other]
            else:
                alike = names[index] == names[other] != "" and not _far(spans[index], spans[other])
            if alike or _meet(spans[index], spans[other], bool(names[index] and names[other])):
                old, new = numbers[index], numbers[other]
                numbers = [new if number == old else number for number in numbers]
    return numbers


def unknown_events(motions: Sequence[Motion]) -> list[str]:
    """Names of the records that name no event, and whose time is not stated, or cannot be held against that of others."""
    unnamed = [motion for motion in motions if not motion.metadata.get("event")]
    open_ = any(motion.metadata.get("event") and span_of(motion) is None for motion in motions)
    return [motion.name for motion in unnamed if open_ or span_of(motion) is None] if len(motions) > 1 else []


def _meet(span: Span | None, other: Span | None, named: bool) -> bool:
    """Whether two records were taken at one time."""
    if span is None or other is None or (named and not (span.exact and other.exact)):
        return False
    return _gap(span, other) <= BETWEEN_STATIONS


def _far(span: Span | None, other: Span | None) -> bool:
    """Whether two records that name one event were taken so far apart that they are of two."""
    return span is not None and other is not None and _gap(span, other) > ONE_NAME


def _gap(span: Span, other: Span) -> float:
    """Time between the end of one span and the beginning of the other [s], negative where they meet."""
    return max(span.first - other.last, other.first - span.last).total_seconds()


# Which records are one recording in several files: by the shapes of their spectra, and by their course in time.

#: Periods at which shapes of spectra are compared [s], and their bounds for the bands of those of both components together.
PERIODS, BANDS = np.geomspace(0.1, 3.0, 24), np.geomspace(1.0 / 3.0, 10.0, 25)

#: Kinds of shapes: of the spectrum of a component, and of both components together.
KINDS = ALONE, TOGETHER = range(2)

#: Distance of logarithms within which shapes agree at a period, and share of the periods at which those of one recording do:
#: other filters, base lines and sampling change its ends. At two stations it is a fifth.
ALIKE, SHARE = 0.02, 0.6

#: Least correlation of the accelerations of one recording, at the best time lag.
CORRELATED = 0.8

#: Resolution of spectra of both components [Hz].
RESOLUTION = 0.005


def recorded_again(motions: Sequence[Motion]) -> dict[int, int]:
    """Numbers of the records that are another one once more, in another file, with the number of that one.

    Scaled, turned in plan, cut, sampled or filtered otherwise, or in another format. Spectra of a horizontal component of
    each, or of both together, which do not hang on the axes, have one shape then, and the accelerations one course: at
    stations a street apart they differ. Of two files that with more components is the record.
    """
    order = sorted(range(len(motions)), key=lambda k: -len(motions[k].peaks))
    rank = {k: place for place, k in enumerate(order)}
    own = {k: list(_shapes(motions[k])) for k in order}
    seen = {
        kind: _SpectrumShapes(sum(own_kind == kind for shapes in own.values() for own_kind, _ in shapes))
        for kind in KINDS
    }
    again: dict[int, int] = {}
    for k in order:
        near = {other for kind, shape in own[k] for other in seen[kind].near(shape)}
        owner = next(
            (number for number in sorted(near, key=rank.__getitem__) if _correlated(motions[number], motions[k])), None
        )
        if owner is not None:
            again[k] = owner
            continue
        for kind, shape in own[k]:
            seen[kind].add(k, shape)
    return again


class _SpectrumShapes:
    """Shapes of one kind of the records that were looked at, with room for so many."""

    def __init__(self, room: int) -> None:
        self.shapes, self.owner, self.count = np.empty((room, len(PERIODS))), np.zeros(room, int), 0

    def add(self, number: int, shape: np.ndarray) -> None:
        """Keep the shape of a record."""
        self.shapes[self.count], self.owner[self.count] = shape, number
        self.count += 1

    def near(self, shape: np.ndarray) -> list[int]:
        """Numbers of records with a shape like this one, whatever its size."""
        apart = self.shapes[: self.count] - shape
        apart -= np.median(apart, axis=1, keepdims=True)
        return self.owner[: self.count][(np.abs(apart) < ALIKE).mean(axis=1) >= SHARE].tolist()


def _shapes(motion: Motion) -> Iterator[tuple[int, np.ndarray]]:
    """Kinds and logarithms of spectra of a motion, each of as many numbers."""
    axes = [axis for axis in "xy" if axis in motion.peaks]
    for axis in axes:
        spectrum = pseudo_acceleration(motion, PERIODS, component=axis)
        if spectrum.min() > 0.0:
            yield ALONE, np.log(spectrum)
    if len(axes) < 2:
        return
    count = 1 << int(np.ceil(np.log2(max(1.0 / (RESOLUTION * motion.dt), motion.steps + 1))))
    power = np.sum([np.abs(np.fft.rfft(samples, count)) ** 2 for samples in _horizontal(motion)], axis=0)
    edges = np.searchsorted(np.fft.rfftfreq(count, motion.dt), BANDS)
    bands = np.diff(np.concatenate([[0.0], np.cumsum(power)])[edges])
    if bands.min(initial=np.inf) > 0.0:
        yield TOGETHER, 0.5 * np.log(bands)


def _correlated(motion: Motion, other: Motion) -> bool:
    """Whether the accelerations of two motions have one course, at some lag: of a component of each, or of both in plan.

    Components in plan are a complex number, so that a turn is a factor of length 1.
    """
    mine, theirs = _horizontal(motion), _horizontal(other)
    pairs = [(a, b) for a in mine for b in theirs]
    if len(mine) == len(theirs) == 2:
        pairs += [(mine[0] + 1j * mine[1], theirs[0] + sign * 1j * theirs[1]) for sign in (1.0, -1.0)]
    return any(_correlation(a, motion.dt, b, other.dt) >= CORRELATED for a, b in pairs)


def _correlation(a: np.ndarray, dt_a: float, b: np.ndarray, dt_b: float) -> float:
    """Largest correlation of two signals with steps [s] over all lags [-]."""
    dt = min(dt_a, dt_b)
    a, b = (
        np.interp(np.arange(0.0, len(x) * own, dt), own * np.arange(len(x)), x) for x, own in ((a, dt_a), (b, dt_b))
    )
    size = float(np.linalg.norm(a) * np.linalg.norm(b))
    count = 1 << int(np.ceil(np.log2(len(a) + len(b))))
    most = np.abs(np.fft.ifft(np.fft.fft(a, count) * np.conj(np.fft.fft(b, count)))).max()
    return float(most) / size if size > 0.0 else 0.0


def _horizontal(motion: Motion) -> list[np.ndarray]:
    """Samples along the horizontal axes; those of one motion have one factor."""
    return [samples for samples in (motion.samples, motion.y_samples) if samples is not None]
