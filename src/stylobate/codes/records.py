"""Records for a code: what is known of them, and the set that follows a spectrum."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from .. import text_tables as tables
from ..constants import g
from ..errors import InputError, check_choice, check_range, check_whole
from ..messages import joined, say
from ..motion import Motion
from ..motion.conditioning import cure_of
from ..motion.earthquakes import MAX_BYTES, is_catalogue, places_of, read_earthquake, station_of
from ..motion.events import events_of, recorded_again, unknown_events
from ..motion.intensity import IntensityMeasure, displacement_drift
from ..motion.readers.source import Source
from ..motion.spectra import pseudo_acceleration, rotated_pga, rotated_spectrum
from ..notebook import NotebookSummary
from .spectra import TargetSpectrum

#: What may be told of a record.
ABOUT = ("magnitude", "distance_km")

_MAGNITUDE = re.compile(r"\bM[wWlLsS]?\s?(\d\.\d)\b")


def facts_of_records(
    about: Path | None, sources: Sequence[Path], motions: Sequence[Motion]
) -> dict[str, dict[str, float]]:
    """Magnitude and distance [km] by record.

    Parameters
    ----------
    about : path, optional
        A table with the columns record, and magnitude or distance_km; a ``manifest.csv``; or the QuakeML of the one
        earthquake of all records,
        whose distance is that from the epicentre to stations whose StationXML lies with the records.
    sources : sequence of path
        Records, or folders of them; without ``about`` the ``manifest.csv`` of each is read.
    motions : sequence of Motion
        The records.

    Raises
    ------
    InputError
        The table cannot be read, or tells nothing.
    """
    names = {name for motion in motions for name in (motion.name, motion.record)}
    facts: dict[str, dict[str, float]] = {}
    for folder in (source for source in sources if about is None and (source / "manifest.csv").is_file()):
        facts |= _of_manifest(folder / "manifest.csv", names)
    if about is not None and is_catalogue(about):
        return _of_one_earthquake(about, sources, motions)
    if about is not None and _is_manifest(about):
        if not (facts := _of_manifest(about, names)):
            raise InputError(
                f"{about} tells the magnitude of none of these records; allowed is a column file with their names, and a "
                "magnitude such as Mw7.1 in the row; or give a table of record, magnitude, distance_km.",
                "about",
            )
    elif about is not None:
        table = tables.read(about, 10_000_000, "record", "the columns record, and magnitude or distance_km")
        known = [fact for fact in ABOUT if fact in table.columns]
        if not known:
            raise InputError(f"{about} needs the columns record, and magnitude or distance_km.", "about")
        for name, *values in zip(
            table.texts("record"), *(table.numbers(fact, math.nan) for fact in known), strict=True
        ):
            facts[name] = dict(zip(known, values, strict=True))
    return facts


def _is_manifest(path: Path) -> bool:
    """Whether the first line of a table names a column of files and none of records."""
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as file:
            names = file.readline(4000).strip().split(",")
    except OSError:
        return False
    return "file" in names and "record" not in names


def _of_manifest(path: Path, names: set[str]) -> dict[str, dict[str, float]]:
    """Magnitudes by file, of the rows of a manifest in which one is written."""
    import pandas

    try:
        rows = pandas.read_csv(path, dtype=str).fillna("").to_dict("records")
    except (OSError, ValueError) as error:
        raise InputError(f"{path} cannot be read as CSV ({' '.join(str(error).split())[:120]}).", "about") from None
    matches = {str(row.get("file")): _MAGNITUDE.search(" ".join(map(str, row.values()))) for row in rows}
    return {file: {"magnitude": float(match[1])} for file, match in matches.items() if match and file in names}


def _of_one_earthquake(about: Path, sources: Sequence[Path], motions: Sequence[Motion]) -> dict[str, dict[str, float]]:
    """Magnitude of an earthquake and distances from its epicentre, of stations that are described beside the records."""
    earthquake = read_earthquake(about)
    folders = [source if source.is_dir() else source.parent for source in sources]
    beside = dict.fromkeys(path for folder in folders for path in sorted(folder.glob("*.xml")) if path != about)
    places = places_of(Source(path, path.read_bytes()) for path in beside if path.stat().st_size <= MAX_BYTES)
    facts = {}
    for motion in motions:
        place = places.get(station_of(motion.metadata) or "")
        known = {"magnitude": earthquake.magnitude}
        if place is not None:
            known["distance_km"] = earthquake.distance_km(*place)
        facts |= dict.fromkeys((motion.name, motion.record), known)
    return facts


#: Weight of the records' own misfits beside that of their mean, where sets are compared.
OWN_MISFIT = 0.2


def best_set(
    logs: np.ndarray, ratios: np.ndarray, count: int, events: Sequence[int], per_event: int | None
) -> list[int]:
    """Indices of the set of least misfit that exchanges of single records lead to."""
    own = np.sqrt((logs**2).mean(axis=1))

    def allowed(chosen: list[int], k: int) -> bool:
        return k not in chosen and (
            per_event is None or sum(events[member] == events[k] for member in chosen) < per_event
        )

    def misfit(chosen: list[int]) -> float:
        mean = ratios[chosen].mean(axis=0)
        level = np.exp(np.log(mean).mean())  # one factor brings the whole set up or down
        return float(np.sqrt(((mean / level - 1.0) ** 2).mean()) + OWN_MISFIT * own[chosen].mean())

    chosen: list[int] = []
    for _ in range(count):
        open_ = [k for k in range(len(own)) if allowed(chosen, k)]
        if not open_:
            raise InputError(
                f"{len(chosen)} records can be chosen with at most {per_event} of one event, and {count} are asked for; "
                "allow more of one event, or ask for fewer.",
                "per_event",
            )
        chosen.append(min(open_, key=lambda k: misfit([*chosen, k])))
    while True:
        tried = [
            (misfit([*rest, k]), place, k)
            for place in range(count)
            for rest in [chosen[:place] + chosen[place + 1 :]]
            for k in range(len(own))
            if allowed(rest, k) and k != chosen[place]
        ]
        better = min(tried, default=(np.inf, 0, 0))
        if not better[0] < misfit(chosen) - 1e-12:
            return sorted(chosen)
        chosen[better[1]] = better[2]


def lifted(
    own: np.ndarray,
    spectra: np.ndarray,
    peaks: np.ndarray,
    aim: np.ndarray,
    zero: float | None,
    least: float,
    largest: float,
) -> np.ndarray:
    """Factors of the records when all are multiplied by one that lifts their mean onto its bounds, as the limit allows."""
    size = own
    for _ in range(50):
        short = (least * aim / (size[:, None] * spectra).mean(axis=0)).max()
        if zero is not None:
            short = max(short, zero / (size * peaks).mean())
        if short <= 1.0 or (size >= largest).all():
            return size
        size = np.minimum(size * short, largest)
    return size


#: The one number for two horizontal components at a period by which records are compared.
HORIZONTAL = ("geomean", "larger", "rotd50", "rotd100", "x")

#: Periods at which spectra are compared, evenly spaced in their logarithm.
POINTS = 100

#: Words by which the name of a station tells that it stands on a structure.
ON_A_STRUCTURE = re.compile(r"\b(dam|crest|abutment|roof|floor|overpass|bldg)\b", re.IGNORECASE)

#: Fewest records of which EN 1998-1 and NTC 2018 take the mean of the responses.
FOR_MEANS = 7


@dataclass(frozen=True)
class RecordRange:
    """Range of a measure that a record must have, as recorded; ``magnitude`` and ``distance_km`` are told of it.

    Parameters
    ----------
    measure : IntensityMeasure or str
    low, high : float
        In the unit of the measure.
    """

    measure: IntensityMeasure | str
    low: float
    high: float

    @property
    def name(self) -> str:
        """As it is typed."""
        return self.measure if isinstance(self.measure, str) else self.measure.name

    def refusal(self, motion: Motion, about: Mapping[str, float]) -> str | None:
        """Why a record is not wanted, in a sentence; None where it is."""
        if isinstance(self.measure, str):
            value = about.get(self.measure, np.nan)
            if not np.isfinite(value):
                return say("its {w.measure} is not told, and {w.low:g} to {w.high:g} is asked for", w=self)
        else:
            value = self.measure.of(motion)
        inside = self.low <= value <= self.high
        reason = say("its {w.name} is {value:.3g}, and {w.low:g} to {w.high:g} is asked for", w=self, value=value)
        return None if inside else reason


@dataclass(frozen=True, eq=False)
class RecordSelection(NotebookSummary):
    """Result of :func:`select_records`.

    Parameters
    ----------
    target : TargetSpectrum
    periods : array
        [s], shape (P,).
    wanted : array
        Target at these periods [m/s²], shape (P,).
    motions : tuple of Motion
        Chosen ones, scaled; shape (K,).
    spectra : array
        Of these, by the one number for both components [m/s²], shape (K, P).
    table : pandas.DataFrame
        A row for each.
    least, most : float
        Bounds of the mean over the target [-]; infinite where there is none above.
    pga_over_target : float, optional
        Mean of their peak accelerations over the target's at a period of 0, where its code wants it [-].
    refused : dict of str to str
        Records that were not considered, with the reason.
    unknown_events : tuple of str
        Chosen records of which it is not known whether they are of one earthquake with others.
    """

    target: TargetSpectrum
    periods: np.ndarray
    wanted: np.ndarray
    motions: tuple[Motion, ...]
    spectra: np.ndarray
    table: pandas.DataFrame
    least: float
    most: float
    pga_over_target: float | None
    refused: dict[str, str]
    unknown_events: tuple[str, ...] = ()

    @property
    def events(self) -> int:
        """Earthquakes that the chosen records are of; one that does not tell counts as one of its own."""
        return len(set(events_of(self.motions)))

    @property
    def mean(self) -> np.ndarray:
        """Mean spectrum [m/s²], shape (P,)."""
        return self.spectra.mean(axis=0)

    @property
    def ratio(self) -> np.ndarray:
        """Mean over the target [-], shape (P,)."""
        return self.mean / self.wanted

    @property
    def meets(self) -> bool:
        """Whether the mean keeps to its bounds over all periods, and to the target at a period of 0 where that is asked."""
        slack = 1e-9  # the common factor brings the mean onto its bound, to the last bit or one below
        above = self.pga_over_target is None or self.pga_over_target >= 1.0 - slack
        above = above and len(self.motions) >= self.target.fewest
        return bool(above and self.ratio.min() >= self.least - slack and self.ratio.max() <= self.most + slack)

    @property
    def sentence(self) -> str:
        """What the set does, in two or three sentences."""
        count, fewest = len(self.motions), self.target.fewest
        bounds = say("at least {low:g}", low=self.least)
        if np.isfinite(self.most):
            bounds = say("at least {low:g}, at most {high:g}", low=self.least, high=self.most)
        alone = say("The record is {low:.2f} to {high:.2f} times the target between {first:g} and {last:g} s "
                    "({bounds} is asked for)")  # fmt: skip
        several = say("The mean of {count} records is {low:.2f} to {high:.2f} times the target between {first:g} and "
                      "{last:g} s ({bounds} is asked for)")  # fmt: skip
        text = (alone if count == 1 else several).of(
            count=count,
            low=self.ratio.min(),
            high=self.ratio.max(),
            first=self.periods[0],
            last=self.periods[-1],
            bounds=bounds,
        )
        if self.pga_over_target is not None:
            text += say(", and {zero:.2f} times it at a period of 0 (at least 1)", zero=self.pga_over_target)
        no = say(": the set does not meet it; allow larger factors, a shorter range of periods, or give more records.")
        words = [text + (say(": the set meets it.") if self.meets else no)]
        if count < fewest:
            words.append(say("The code wants {count} records at least.", count=fewest))
        elif count < FOR_MEANS:
            fewer = say(
                "With fewer than {count} records codes take the largest response, not the mean.", count=FOR_MEANS
            )
            words.append(fewer)
        if count > 1 and not self.unknown_events:
            same_event = say("They are of one earthquake.")
            words.append(say("They are of {count} earthquakes.", count=self.events) if self.events > 1 else same_event)
        if self.unknown_events:
            unknown = say(
                "The files of {names} do not tell of which earthquake they are: see that it is none of the others'."
            )
            words.append(unknown.of(names=joined(", ", self.unknown_events)))
        if on_structures := self.table["record"][self.table["on_structure"]].tolist():
            taken = say("By the names of their stations these records were taken on structures, which shake otherwise than "
                        "the ground: {names}.")  # fmt: skip
            words.append(taken.of(names=joined(", ", on_structures)))
        return joined(" ", words)

    def summary(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "target": self.target.name,
            "target_words": self.target.words,
            "meets": self.meets,
            "sentence": self.sentence,
            "least_ratio": float(self.ratio.min()),
            "largest_ratio": float(self.ratio.max()),
            "pga_over_target": self.pga_over_target,
            "bounds": [self.least, self.most if np.isfinite(self.most) else None],
            "period_s": self.periods.tolist(),
            "target_g": (self.wanted / g).tolist(),
            "mean_g": (self.mean / g).tolist(),
            "records": self.table.astype(object).where(self.table.notna(), None).to_dict("records"),
            "refused": self.refused,
            "events": self.events,
            "unknown_events": list(self.unknown_events),
        }


def select_records(
    motions: Sequence[Motion],
    target: TargetSpectrum,
    count: int = FOR_MEANS,
    *,
    periods: tuple[float, float] = (0.2, 3.0),
    horizontal: str = "geomean",
    factors: tuple[float, float] = (0.5, 2.0),
    least: float = 0.9,
    per_event: int | None = None,
    wanted: Sequence[RecordRange] = (),
    about: Mapping[str, Mapping[str, float]] | None = None,
) -> RecordSelection:
    """Choose and scale records so that their mean spectrum follows a target.

    Parameters
    ----------
    motions : sequence of Motion
    target : TargetSpectrum
    count : int
        Records that are chosen.
    periods : (float, float)
        Between which spectra are compared [s]. A rocking column has no period of its own: it answers to long ones.
    horizontal : {"geomean", "larger", "rotd50", "rotd100", "x"}
        The one number for two components at a period; records with one component are compared by that.
    factors : (float, float)
        Between which a record may be multiplied, all its components by the same [-].
    least : float
        Least mean over the target at any of the periods [-]: 0.9 of EN 1998-1:2004, 3.2.3.1.2(4), and of NTC 2018, 3.2.3.6.
    per_event : int, optional
        Most records of one earthquake, by its name and by the time in their headers
        (:func:`stylobate.motion.events.events_of`); without a limit by default.
    wanted : sequence of Wanted
        Ranges that a record must keep to, as recorded.
    about : dict of str to dict, optional
        ``magnitude`` and ``distance_km`` by the names of records.

    Raises
    ------
    InputError
        Fewer records can be used than are asked for, or a parameter out of its range.

    Notes
    -----
    Each record is first multiplied so that it follows the target best (least squares of logarithms), within the limits. Sets
    are then grown record by record, and records exchanged for others as long as the misfit of the mean, with a fifth of
    the records' own, becomes less. At last all are multiplied by the one factor that lifts the mean onto its lower bound
    where it lies below, as far as the limits allow.
    """
    check_whole("count", count, 1, 1000)
    check_choice("horizontal", horizontal, HORIZONTAL)
    low, high = periods
    check_range("first period", low, 0.01, 10.0, unit="s")
    check_range("last period", high, low, 10.0, unit="s", open_low=True)
    check_range("smallest factor", factors[0], 0.01, 1.0)
    check_range("largest factor", factors[1], 1.0, 100.0)
    if per_event is not None:
        check_whole("per_event", per_event, 1)
    check_range("least mean over the target", least, 0.1, 2.0)
    t = np.geomspace(low, high, POINTS)
    aim = target.at(t)
    known = about or {}
    refused: dict[str, str] = {}
    usable: list[tuple[Motion, np.ndarray, float]] = []
    beyond: list[tuple[Motion, float]] = []  # whose best factor is outside the limits, with that factor
    for motion in motions:
        reason, spectrum, size = _considered(motion, t, aim, horizontal, wanted, known.get(motion.name, {}))
        if reason is not None:
            refused[motion.name] = reason
        elif factors[0] <= size <= factors[1]:
            usable.append((motion, spectrum, size))
        else:
            beyond.append((motion, size))
            refused[motion.name] = say(
                "it would have to be multiplied by {factor:.3g}, and {f[0]:g} to {f[1]:g} is allowed",
                factor=size,
                f=factors,
            )
    again = recorded_again([motion for motion, _, _ in usable])
    for k, other in again.items():
        name = usable[other][0].name
        refused[usable[k][0].name] = say("it is the recording of {name!r} once more; a record counts once", name=name)
    chosen_from = [candidate for k, candidate in enumerate(usable) if k not in again]
    kept = [motion for motion, _, _ in chosen_from]
    spectra, sizes = [spectrum for _, spectrum, _ in chosen_from], [size for _, _, size in chosen_from]
    if len(kept) < count:
        first = (
            f" The first reason: {next(iter(refused.items()))[0]}: {next(iter(refused.values()))}." if refused else ""
        )
        raise InputError(
            f"{len(kept)} of {len(motions)} records can be used, and {count} are asked for; ask for fewer, or give more."
            f"{_other_factors(kept, beyond, count, factors)}{first}",
            "count",
        )
    scaled = np.array(sizes)[:, None] * np.array(spectra)
    events = events_of(kept) if per_event is not None else range(len(kept))
    chosen = best_set(np.log(scaled / aim), scaled / aim, count, events, per_event)
    unknown = tuple(unknown_events([kept[k] for k in chosen]))
    zero = target.acceleration(0.0) if target.from_zero else None
    peaks = np.array([_peak(kept[k], horizontal) for k in chosen])
    own = np.array([sizes[k] for k in chosen])
    size = lifted(own, np.array([spectra[k] for k in chosen]), peaks, aim, zero, least, factors[1])
    scaled_motions = tuple(_scaled(kept[k], float(x)) for k, x in zip(chosen, size, strict=True))
    rows = size[:, None] * np.array([spectra[k] for k in chosen])
    table = pandas.DataFrame(
        [
            _row(kept[k], float(x), row / aim, horizontal, known.get(kept[k].name, {}))
            for k, x, row in zip(chosen, size, rows, strict=True)
        ]
    )
    ratio = None if zero is None else float((size * peaks).mean() / zero)
    most = np.inf if target.most is None else target.most
    return RecordSelection(target, t, aim, scaled_motions, rows, table, least, most, ratio, refused, unknown)


def _considered(
    motion: Motion,
    periods: np.ndarray,
    aim: np.ndarray,
    horizontal: str,
    wanted: Sequence[RecordRange],
    about: Mapping[str, float],
) -> tuple[str | None, np.ndarray, float]:
    """Why a record is left out, or None; its spectrum [m/s²], and the factor that makes it follow the target best."""
    reason = next(
        (refusal for record_range in wanted if (refusal := record_range.refusal(motion, about)) is not None), None
    )
    if reason is not None:
        return reason, aim, 1.0
    spectrum = _spectrum(motion, periods, horizontal)
    if not (spectrum > 0.0).all():
        return say("it has nothing along a component"), aim, 1.0
    return None, spectrum, float(np.exp(np.log(aim / spectrum).mean()))


def _other_factors(
    kept: Sequence[Motion], beyond: Sequence[tuple[Motion, float]], count: int, factors: tuple[float, float]
) -> str:
    """Limits of the factor within which as many records can be used as are asked for; empty where none would do."""
    nearest = sorted(beyond, key=lambda pair: abs(np.log(pair[1])))
    again = recorded_again([*kept, *(motion for motion, _ in nearest)])
    recordings = {again.get(k, k) for k in range(len(kept))}
    wider: list[float] = []  # a record that is one of those again lets in no other
    for k, (_, size) in enumerate(nearest, len(kept)):
        if len(recordings) < count and again.get(k, k) not in recordings:
            recordings.add(again.get(k, k))
            wider.append(size)
    if len(recordings) < count:
        return ""
    low = min(factors[0], *(np.floor(1000.0 * size) / 1000.0 for size in wider))
    high = max(factors[1], *(np.ceil(100.0 * size) / 100.0 for size in wider))
    if not (low >= 0.01 and high <= 100.0):
        return ""
    return f" Factors from {low:.3g} to {high:.4g} would let in as many; what they do to a record is for you to judge."


def _spectrum(motion: Motion, periods: np.ndarray, horizontal: str) -> np.ndarray:
    x = pseudo_acceleration(motion, periods)
    if motion.lateral is None or horizontal == "x":
        return x
    if horizontal.startswith("rotd"):
        share = 50.0 if horizontal == "rotd50" else 100.0
        return rotated_spectrum(motion, (share,), periods)[share]
    y = pseudo_acceleration(motion, periods, component="y")
    return np.sqrt(x * y) if horizontal == "geomean" else np.maximum(x, y)


def _peak(motion: Motion, horizontal: str) -> float:
    if motion.lateral is None or horizontal == "x":
        return motion.pga
    if horizontal.startswith("rotd"):
        share = 50.0 if horizontal == "rotd50" else 100.0
        return rotated_pga(motion, (share,))[share]
    across = motion.peaks["y"]
    return float(np.sqrt(motion.pga * across)) if horizontal == "geomean" else max(motion.pga, across)


def _scaled(motion: Motion, factor: float) -> Motion:
    note = say("multiplied by {factor:.6g}: scaled to a target spectrum", factor=factor)
    return motion.scaled(factor).replace(processing=(*motion.processing, note))


def _row(
    motion: Motion, factor: float, ratio: np.ndarray, horizontal: str, about: Mapping[str, float]
) -> dict[str, Any]:
    axes = motion.components if "file" in motion.metadata else ()
    drift = max((displacement_drift(motion, axis) for axis in axes), key=abs, default=0.0)
    return {
        "record": motion.name,
        "factor": factor,
        "compared_by": "x" if motion.lateral is None else horizontal,
        "misfit": float(np.sqrt((np.log(ratio) ** 2).mean())),
        "least_ratio": float(ratio.min()),
        "largest_ratio": float(ratio.max()),
        "pga_g": factor * motion.pga / g,
        "pgv_m_s": factor * motion.pgv,
        "event": motion.metadata.get("event"),
        "magnitude": about.get("magnitude"),
        "distance_km": about.get("distance_km"),
        "on_structure": on_a_structure(motion),
        "drift_m": drift,
        "cure": cure_of(motion) if drift else None,
    }


def on_a_structure(motion: Motion) -> bool:
    """Whether the name of the station of a record says that it stands on a structure, and not on the ground."""
    texts = (str(motion.metadata.get(key) or "") for key in ("station", "station_name", "location"))
    return bool(ON_A_STRUCTURE.search(" ".join(texts)))
