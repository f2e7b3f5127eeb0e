"""What a catalogue says of an earthquake, and how far from it a station stands (QuakeML and StationXML, through ObsPy)."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import InputError
from ..text_tables import read_bytes
from .readers.source import Source

#: Largest catalogue that is read [bytes].
MAX_BYTES = 20_000_000

#: Kinds of magnitude, the one nearest to the moment magnitude first.
KINDS = ("mw", "ms", "mb", "ml", "md", "m")


class Earthquake(NamedTuple):
    """Time (ISO 8601, UTC), epicentre [degrees] and magnitude."""

    name: str
    time: str
    latitude: float
    longitude: float
    magnitude: float
    magnitude_kind: str

    @property
    def words(self) -> str:
        """The earthquake in a few words."""
        north, east = "N" if self.latitude >= 0.0 else "S", "E" if self.longitude >= 0.0 else "W"
        return (
            f"{self.name}, {self.time[:19].replace('T', ' ')} UTC, {self.magnitude_kind} {self.magnitude:.1f}, "
            f"{abs(self.latitude):.3f}° {north} {abs(self.longitude):.3f}° {east}"
        )

    def distance_km(self, latitude: float, longitude: float) -> float:
        """Distance of a place from the epicentre on the ellipsoid WGS 84 [km]."""
        from obspy.geodetics import gps2dist_azimuth

        return float(gps2dist_azimuth(self.latitude, self.longitude, latitude, longitude)[0]) / 1e3


def is_catalogue(path: Path) -> bool:
    """Whether a file is QuakeML, by its content."""
    try:
        with path.open("rb") as file:
            return b"quakeml" in file.read(4000).lower()
    except OSError:
        return False


def read_earthquake(path: str | Path) -> Earthquake:
    """The only earthquake of a QuakeML file.

    Raises
    ------
    InputError
        ObsPy is missing; the file is not QuakeML, holds several earthquakes, or not one with an origin and a magnitude.
    """
    return earthquake_of(read_bytes(Path(path), MAX_BYTES), str(path))


def earthquake_of(data: bytes, name: str) -> Earthquake:
    """As :func:`read_earthquake`, of what a file or an answer of that name holds."""
    obspy = obspy_for(f"{name} is QuakeML")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            events = obspy.read_events(io.BytesIO(data), format="QUAKEML")
    except Exception as error:  # ObsPy raises many kinds for a damaged file
        raise InputError(f"{name} cannot be read as QuakeML ({' '.join(str(error).split())[:120]}).") from None
    if len(events) != 1:
        raise InputError(f"{name} holds {len(events)} earthquakes; give a file of one.")
    (event,) = events
    origin = event.preferred_origin() or _only(event.origins, f"{name}: origins")
    magnitude = event.preferred_magnitude() or _nearest_to_moment(event.magnitudes, name)
    wanted = {
        "time": origin.time,
        "latitude": origin.latitude,
        "longitude": origin.longitude,
        "magnitude": magnitude.mag,
    }
    if missing := [word for word, value in wanted.items() if value is None]:
        raise InputError(f"{name}: the earthquake has no {missing[0]}; give a complete catalogue entry.")
    called = event.event_descriptions[0].text if event.event_descriptions else str(event.resource_id).rpartition("/")[2]
    return Earthquake(
        str(called), str(origin.time), float(origin.latitude), float(origin.longitude), float(magnitude.mag),
        str(magnitude.magnitude_type or "M"),
    )  # fmt: skip


def _only(many: list[Any], what: str) -> Any:
    if len(many) != 1:
        raise InputError(f"{what}: there are {len(many)}, and none is marked as preferred; leave one.")
    return many[0]


def _nearest_to_moment(magnitudes: list[Any], name: str) -> Any:
    """The magnitude of the kind that comes first in :data:`KINDS`, where none is marked as preferred."""
    ranked: dict[int, list[Any]] = {}
    for magnitude in magnitudes:
        kind = (magnitude.magnitude_type or "m").lower()
        ranked.setdefault(next(k for k, known in enumerate((*KINDS, "")) if kind.startswith(known)), []).append(
            magnitude
        )
    return _only(ranked[min(ranked)] if ranked else [], f"{name}: magnitudes of the best kind")


def places_of(files: Iterable[Source]) -> dict[str, tuple[float, float]]:
    """Latitude and longitude of stations by ``NET.STA``, of StationXML among files."""
    places: dict[str, tuple[float, float]] = {}
    for source in filter(is_station_xml, files):
        obspy = obspy_for(f"{source.name} is StationXML")
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                inventory = obspy.read_inventory(io.BytesIO(source.data), format="STATIONXML", level="station")
        except Exception as error:  # as above
            raise InputError(
                f"{source.name} cannot be read as StationXML ({' '.join(str(error).split())[:120]})."
            ) from None
        for network in inventory:
            for station in network:
                places[f"{network.code}.{station.code}"] = (float(station.latitude), float(station.longitude))
    return places


def station_of(metadata: Mapping[str, Any]) -> str | None:
    """``NET.STA`` of a record, where its file says both."""
    network, station = metadata.get("network"), metadata.get("station")
    return f"{network}.{station}" if network and station else None


def is_station_xml(source: Source) -> bool:
    """Whether the file is a StationXML."""
    return b"FDSNStationXML" in source.data[:4000]


def obspy_for(what: str) -> Any:
    """ObsPy, or the sentence that it is missing; ``what`` needs it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            import obspy
    except ImportError:
        raise InputError(f"{what}, which needs ObsPy; install it with  pip install 'stylobate[seismology]'.") from None
    return obspy
