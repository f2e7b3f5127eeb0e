"""miniSEED with the sensitivity from a StationXML file, through ObsPy (extra ``seismology``)."""

from __future__ import annotations

import contextlib
import io
import math
import re
import sys
import warnings
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from stylobate.errors import InputError
from stylobate.messages import say
from stylobate.motion.earthquakes import is_station_xml, obspy_for
from stylobate.motion.readers.record import CUT, Component, direction
from stylobate.motion.readers.source import Source
from stylobate.motion.specs import ACCELERATION_UNITS, acceleration_unit

#: StationXML files beside the record that are looked into.
MAX_BESIDE, MAX_XML_BYTES = 50, 20_000_000

#: Tilt of a channel from the horizontal or the vertical beyond which it is neither [degrees].
MOST_TILTED = 15.0

#: Share by which the sensitivity of a channel may depart from the product of the gains of its stages.
GAINS = 0.05

#: Units of acceleration of StationXML beside those that are typed [m/s²].
UNITS = {"nm/s2": 1e-9, "um/s2": 1e-6, "µm/s2": 1e-6}

#: How StationXML files spell the unit of samples.
COUNTS = ("COUNT", "COUNTS", "DIGITAL COUNTS", "CT", "CTS")

#: Longest record that is looked for [bytes].
MAX_RECORD = 1 << 16


def recognises(source: Source) -> bool:
    """Whether the file begins with a miniSEED record: six digits and a quality letter."""
    start = source.data[:8]
    return (
        len(start) == 8 and start[:6].replace(b" ", b"0").isdigit() and start[6:7] in b"DRQM" and start[7:8] in b" \x00"
    )


def read(source: Source, descriptions: Sequence[Source]) -> tuple[list[Component], dict]:
    """Components and what the file and the description of the station say.

    Parameters
    ----------
    source : Source
    descriptions : sequence of Source
        StationXML files. Without one, those in the folder of the record are looked into.

    Raises
    ------
    InputError
        ObsPy is missing, no description covers the channel, two contradict one another, the channel does not measure
        acceleration, gaps.
    """
    obspy = obspy_for(f"{source.name} is miniSEED")
    try:
        with _complaints_raised():
            stream = obspy.read(io.BytesIO(source.data), format="MSEED")
            gap = next((entry for entry in stream.get_gaps() if entry[-1] > 0), None)
            order = list(dict.fromkeys(trace.id for trace in stream))
            if gap is None:
                stream.merge(method=0)  # which sorts
                stream.traces.sort(key=lambda trace: order.index(trace.id))
    except Exception as error:  # ObsPy raises many kinds for a damaged file
        raise InputError(f"{source.name} cannot be decoded as miniSEED ({_one_line(error)}); fetch it again.") from None
    _check_records(source)
    if len(stream) == 0:
        raise InputError(f"{source.name} holds no samples; fetch it again.")
    if gap is not None:
        raise InputError(
            f"{source.name}: channel {'.'.join(gap[:4])} has a gap of {gap[6]:.6g} s from {gap[4]} on; give a record "
            "without gaps."
        )
    components, used = [], set()
    for trace in stream:
        if np.ma.isMaskedArray(trace.data):
            raise InputError(f"{source.name}: channel {trace.id} has records that overlap and differ; fetch it again.")
        channel, name = _channel(trace, descriptions or _beside(source), source.name)
        used.add(name)
        components.append(_component(trace, channel, source.name))
    first = components[0].metadata
    return components, {
        "format": "miniSEED",
        "stage": "raw counts",
        "unit": "counts",
        **{key: first[key] for key in ("station", "network", "start_time")},
        "response": ", ".join(sorted(used)),
    }


def _check_records(source: Source) -> None:
    """The file is whole records to its end; ObsPy itself lets some cuts within a record pass."""
    from obspy.io.mseed.util import get_record_information

    at, data = 0, source.data
    while at < len(data):
        try:
            with _complaints_raised():
                length = int(get_record_information(io.BytesIO(data[at : at + MAX_RECORD]))["record_length"])
        except Exception as error:  # as above
            raise InputError(
                f"{source.name}, byte {at}: no miniSEED record begins here ({_one_line(error)}); {CUT}."
            ) from None
        if (len(data) - at) % length == 0:  # nearly all files are a whole number of records
            return
        at += length
    if at > len(data):
        raise InputError(f"{source.name}, byte {len(data)}: the last miniSEED record is cut; fetch the file again.")


def _component(trace: Any, channel: Any, file: str) -> Component:
    sensitivity = channel.response.instrument_sensitivity if channel.response else None
    if sensitivity is None or not sensitivity.value or not math.isfinite(sensitivity.value):
        raise InputError(f"{file}: the StationXML gives no sensitivity for {trace.id}; give a complete one.")
    size = _unit_size(sensitivity.input_units or "")
    if size is None:
        raise InputError(
            f"{file}: the StationXML gives the sensitivity of {trace.id} per {sensitivity.input_units or 'no unit'}; "
            f"allowed are units of acceleration ({', '.join((*ACCELERATION_UNITS, *UNITS))}): give an accelerometer, or a "
            "StationXML with its sensitivity per M/S**2."
        )
    _check_gains(channel.response, trace.id, file)
    counted = sensitivity.output_units or "no unit"
    if counted.upper() not in COUNTS:
        raise InputError(
            f"{file}: the StationXML gives the sensitivity of {trace.id} in {counted} per {sensitivity.input_units}; "
            "allowed is COUNTS, as samples are: give a StationXML with the sensitivity of sensor and recorder together."
        )
    counts = np.asarray(trace.data, dtype=np.float64)
    zero = float(counts.mean())
    per_m_s2 = sensitivity.value / size
    component = Component((counts - zero) / per_m_s2, float(trace.stats.delta), trace.stats.channel)
    component.metadata = {"unit": "counts", "counts_per_m_s2": float(per_m_s2), "dip": channel.dip}
    component.metadata |= {key: str(trace.stats[key]) for key in ("network", "station", "location")}
    component.metadata["start_time"] = str(trace.stats.starttime)
    component.processing.append(
        say(
            "counts / {per_m_s2:.6g} per m/s², after the zero level of {zero:.6g} counts (their mean) was taken off; "
            "the response is taken as flat",
            per_m_s2=per_m_s2,
            zero=zero,
        )
    )
    dip = channel.dip
    by_code, component.vertical, _ = direction(trace.stats.channel)
    if dip is not None:
        if abs(dip) <= 45.0 if component.vertical else abs(dip) > 45.0 and by_code is not None:
            kind = "vertical" if component.vertical else "horizontal"
            raise InputError(
                f"{file}: the code of channel {trace.id} says that it is {kind}, the Dip in the StationXML is {dip:g}°; "
                "allowed is ±90 of a vertical and 0 of a horizontal channel: mend the one that is wrong."
            )
        component.vertical = abs(dip) > 45.0
        if MOST_TILTED < abs(dip) < 90.0 - MOST_TILTED:
            raise InputError(
                f"{file}: channel {trace.id} is inclined, with a Dip of {dip:g}°; allowed is up to {MOST_TILTED:g}° from "
                "the horizontal or the vertical: turn the three channels to north, east and up first."
            )
    if dip is not None and dip > 45.0:  # SEED counts the dip downward
        component.values = -component.values
        component.processing.append(say("sign turned: the channel counts downward as positive, here upward is"))
    azimuth = by_code if channel.azimuth is None else channel.azimuth
    component.azimuth = None if component.vertical or azimuth is None else float(azimuth) % 360.0
    return component


def _unit_size(text: str) -> float | None:
    """Size of a unit of acceleration as StationXML spells it [m/s²]: M/S**2, cm/s^2, M/SEC**2, nm/s/s, G."""
    key = re.sub(r"[*^() ]", "", text.lower().replace("sec", "s")).replace("/s/s", "/s2")
    if key in UNITS:
        return UNITS[key]
    try:
        return acceleration_unit(key)[1]
    except InputError:
        return None


def _check_gains(response: Any, channel: str, file: str) -> None:
    """The sensitivity is the product of the gains of all stages, where they are stated from the ground to the counts."""
    stages, overall = response.response_stages or [], response.instrument_sensitivity
    first = (stages[0].input_units if stages else None) or overall.input_units
    gains = [stage.stage_gain for stage in stages]
    if not gains or None in gains or first.upper() != overall.input_units.upper():
        return
    product = math.prod(gains)
    if not abs(product / overall.value - 1.0) <= GAINS:
        raise InputError(
            f"{file}: the StationXML gives {channel} a sensitivity of {overall.value:.6g} {overall.output_units} per "
            f"{overall.input_units}, and stages whose gains make {product:.6g}; allowed is a difference of "
            f"{100.0 * GAINS:g} %: ask the network which is right, and mend the other in the file."
        )


def _channel(trace: Any, descriptions: Sequence[Source], file: str) -> tuple[Any, str]:
    """Description of a trace's channel at its time, and the file it stands in; all that describe it must agree."""
    obspy = obspy_for(f"{file} is miniSEED")
    stats = trace.stats
    candidates: list[tuple[Any, str]] = []
    for description in descriptions:
        if stats.station.encode() not in description.data:
            continue
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                inventory = obspy.read_inventory(io.BytesIO(description.data), format="STATIONXML")
                selected = inventory.select(
                    network=stats.network,
                    station=stats.station,
                    location=stats.location,
                    channel=stats.channel,
                    time=stats.starttime,
                )
        except Exception as error:  # as above
            raise InputError(f"{description.name} cannot be read as StationXML ({_one_line(error)}).") from None
        candidates += [
            (channel, description.name) for network in selected for station in network for channel in station.channels
        ]
    if not candidates:
        raise InputError(
            f"{file}: counts of {trace.id} without their sensitivity; put the station's StationXML beside the file, "
            "or give both."
        )
    first, name = candidates[0]
    for other, where in candidates[1:]:
        if _conversion_words(other) != _conversion_words(first):
            raise InputError(
                f"{file}: channel {trace.id} is described as {_conversion_words(first)} in {name} and as "
                f"{_conversion_words(other)} in {where}, at one time; keep the description that is right."
            )
    return first, name


def _conversion_words(channel: Any) -> str:
    """What turns the counts of a channel into a motion, in words."""
    sensitivity = channel.response.instrument_sensitivity if channel.response else None
    size = "no sensitivity"
    if sensitivity is not None and sensitivity.value is not None:
        size = f"{sensitivity.value:.6g} {sensitivity.output_units} per {sensitivity.input_units}"
    azimuth, dip = ("?" if angle is None else f"{angle:g}°" for angle in (channel.azimuth, channel.dip))
    return say("{size}, azimuth {azimuth}, dip {dip}", size=size, azimuth=azimuth, dip=dip)


def _beside(source: Source) -> list[Source]:
    descriptions = []
    for path in sorted(source.path.parent.glob("*.xml"))[:MAX_BESIDE]:
        if path.is_file() and path.stat().st_size <= MAX_XML_BYTES:
            candidate = Source(path, path.read_bytes())
            if is_station_xml(candidate):
                descriptions.append(candidate)
    return descriptions


@contextlib.contextmanager
def _complaints_raised() -> Iterator[None]:
    """Warnings of ObsPy (records that are cut or skipped, samples that disagree with their checks) are errors.

    The traces that its callbacks print on a damaged header are kept quiet; the error itself comes through.
    """
    hook = sys.unraisablehook
    sys.unraisablehook = lambda _: None
    try:
        with warnings.catch_warnings(record=True) as complaints:
            warnings.simplefilter("always")
            yield
        for complaint in complaints:
            if not issubclass(complaint.category, (DeprecationWarning, PendingDeprecationWarning, FutureWarning)):
                raise ValueError(str(complaint.message))
    finally:
        sys.unraisablehook = hook


def _one_line(error: Exception) -> str:
    text = " ".join(str(error).split()) or type(error).__name__
    return text if len(text) <= 120 else text[:120] + "…"
