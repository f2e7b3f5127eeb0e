"""Accelerograms of an earthquake from a data centre (web services of the FDSN), through ObsPy (extra ``seismology``)."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stylobate.errors import InputError, StylobateError, check_range, check_whole
from stylobate.motion.earthquakes import Earthquake, earthquake_of, obspy_for
from stylobate.motion.readers.source import Source

from .formats import miniseed

#: Channels of accelerometers, of broad and of short band, by their SEED codes; the first that a station has are taken.
CHANNELS = ("HN?", "EN?", "HL?", "HG?")

#: Most stations of one request.
MAX_STATIONS = 200

#: Time that a data centre has for an answer [s].
PATIENCE = 60


@dataclass(frozen=True, eq=False)
class StationRecord:
    """What one station recorded, as the data centre keeps it.

    Parameters
    ----------
    station : str
        ``NET.STA``
    distance_km : float
        From the epicentre.
    name : str
        Of the files, without their endings.
    counts : bytes
        miniSEED.
    description : bytes
        StationXML.
    """

    station: str
    distance_km: float
    name: str
    counts: bytes
    description: bytes


class DataCentre:
    """A data centre by the name that ObsPy knows it by (``INGV``), or by the address of its services.

    Raises
    ------
    InputError
        ObsPy is missing, or knows no such centre.
    StylobateError
        It does not answer.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        obspy = obspy_for(f"a request to {name}")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            from obspy.clients.fdsn import Client
            from obspy.clients.fdsn.header import URL_MAPPINGS
        if "://" not in name and name.upper() not in URL_MAPPINGS:
            raise InputError(
                f"no data centre is called {name!r}; known are {', '.join(sorted(URL_MAPPINGS))}, and any address that "
                "begins with http:// or https://."
            )
        self._time = obspy.UTCDateTime
        with self._answering("its services"):
            try:
                known = name if "://" in name else name.upper()
                self._client: Any = Client(known, timeout=PATIENCE, user_agent="stylobate")
            except ValueError:
                raise InputError(
                    f"{name!r} is no address of a data centre; give one such as https://eida.example.org, or its name "
                    f"({', '.join(sorted(URL_MAPPINGS))})."
                ) from None

    def earthquake(self, number: str) -> tuple[Earthquake, bytes]:
        """The earthquake that has this number in the catalogue of the centre, and its QuakeML."""
        answer = io.BytesIO()
        with self._answering(f"earthquake {number!r}"):
            self._client.get_events(eventid=number, filename=answer)
        return earthquake_of(answer.getvalue(), f"{self.name}, earthquake {number}"), answer.getvalue()

    def stations(
        self, earthquake: Earthquake, within_km: float, only: Sequence[str] = (), channels: Sequence[str] = CHANNELS
    ) -> list[tuple[str, float]]:
        """Stations with accelerometers that ran at its time, the nearest first, with their distances [km].

        Parameters
        ----------
        earthquake : Earthquake
        within_km : float
            Largest distance from the epicentre, above 0 to 1,000 [km].
        only : sequence of str
            ``NET.STA``; all by default.
        channels : sequence of str
            SEED codes.
        """
        check_range("within", within_km, 0.0, 1000.0, open_low=True)
        begin = self._time(earthquake.time)
        place = {"latitude": earthquake.latitude, "longitude": earthquake.longitude}
        with self._answering(f"stations within {within_km:g} km"):
            inventory = self._client.get_stations(
                starttime=begin, endtime=begin + 1.0, maxradius=within_km / 111.0, channel=",".join(channels),
                level="station", **place,
            )  # fmt: skip
        distances = {
            f"{network.code}.{station.code}": earthquake.distance_km(station.latitude, station.longitude)
            for network in inventory
            for station in network
        }
        if missing := [name for name in only if name not in distances]:
            raise InputError(
                f"{self.name} has no station {missing[0]} with {', '.join(channels)} within {within_km:g} km; there are "
                f"{', '.join(sorted(distances)) or 'none'}.",
                "stations",
            )
        near = [(name, far) for name, far in distances.items() if far <= within_km and (not only or name in only)]
        check_whole(
            "number of stations", len(near), 0, MAX_STATIONS, remedy="ask for a smaller distance, or name stations"
        )
        return sorted(near, key=lambda pair: pair[1])

    def record(
        self, earthquake: Earthquake, station: str, distance_km: float, before: float, lasts: float,
        channels: Sequence[str] = CHANNELS,
    ) -> StationRecord:  # fmt: skip
        """What the first accelerometer of a station recorded.

        Parameters
        ----------
        earthquake : Earthquake
        station : str
        distance_km : float
        before, lasts : float
            Begin before the time of origin, and length [s].
        channels : sequence of str

        Raises
        ------
        InputError
            Nothing was recorded, or what was is no whole accelerogram (gaps, another quantity).
        StylobateError
            The data centre does not answer.
        """
        begin = self._time(earthquake.time) - before
        network, code = station.split(".")
        which = {"network": network, "station": code, "starttime": begin, "endtime": begin + lasts}
        description, every = io.BytesIO(), ",".join(channels)
        with self._answering(f"the description of {station}"):
            self._client.get_stations(channel=every, level="response", filename=description, **which)
        with self._answering(f"the record of {station}"):
            stream = self._client.get_waveforms(location="*", channel=every, **which)
        instruments = sorted(
            {(trace.stats.location, trace.stats.channel[:2]) for trace in stream}, key=_order(channels)
        )
        if not instruments:
            raise InputError(f"{station}: nothing was recorded.")
        location, band = instruments[0]
        stream = stream.select(location=location, channel=f"{band}?")
        counts = io.BytesIO()
        stream.write(counts, format="MSEED")
        name = ".".join(part for part in (station, location, band) if part)
        record = StationRecord(station, distance_km, name, counts.getvalue(), description.getvalue())
        miniseed.read(Source(Path(f"{name}.mseed"), record.counts), [Source(Path(f"{name}.xml"), record.description)])
        return record

    @contextmanager
    def _answering(self, what: str) -> Iterator[None]:
        """Around a request: what the centre does not have is bad input, and its silence is no fault of the input."""
        from obspy.clients.fdsn.header import FDSNException, FDSNNoDataException

        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                yield
        except FDSNNoDataException:
            raise InputError(f"{self.name} does not have {what}; ask for another, or another data centre.") from None
        except (FDSNException, OSError, ValueError, NotImplementedError) as error:
            if isinstance(error, StylobateError):
                raise
            reason = (" ".join(str(error).split()) or type(error).__name__)[:160]
            raise StylobateError(f"{self.name} gives no answer about {what} ({reason}); try again later.") from None


def _order(channels: Sequence[str]) -> Callable[[tuple[str, str]], tuple[int, str]]:
    """Instruments in the order of the channels asked for, then of their locations."""
    bands = [code[:2] for code in channels]
    return lambda instrument: (bands.index(instrument[1]) if instrument[1] in bands else len(bands), instrument[0])
