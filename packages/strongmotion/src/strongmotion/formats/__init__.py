"""Formats of strong-motion networks: each a file of this folder, and a row of the one list of them."""

from collections.abc import Callable, Sequence

from stylobate.motion.earthquakes import is_station_xml
from stylobate.motion.readers import Format
from stylobate.motion.readers.record import Component
from stylobate.motion.readers.source import Source

from . import afad, bhrc, cosmos, csmip, esm, geonet, knet, miniseed, peer, renadic, smc, taiwan, unam, usc


def _without_station(
    read: Callable[[Source], tuple[list[Component], dict]],
) -> Callable[..., tuple[list[Component], dict]]:
    """A reader of files that need no description of their station."""

    def reader(source: Source, descriptions: Sequence[Source] = ()) -> tuple[list[Component], dict]:
        del descriptions
        return read(source)

    return reader


#: All formats that are read here: each states unit and step itself.
FORMATS: tuple[Format, ...] = (
    Format("CSMIP V1, V2", csmip.recognises, _without_station(csmip.read)),
    Format("COSMOS V0, V1, V2", cosmos.recognises, _without_station(cosmos.read)),
    Format("USGS SMC V1, V2", smc.recognises, _without_station(smc.read)),
    Format("GeoNet V1A, V2A", geonet.recognises, _without_station(geonet.read)),
    Format("USC V1", usc.recognises, _without_station(usc.read)),
    Format("PEER AT2", peer.recognises, _without_station(peer.read)),
    Format("ESM / ITACA ASCII", esm.recognises, _without_station(esm.read)),
    Format("K-NET / KiK-net", knet.recognises, _without_station(knet.read)),
    Format("AFAD text", afad.recognises, _without_station(afad.read)),
    Format("TSMIP text", taiwan.recognises, _without_station(taiwan.read)),
    Format("UNAM ASA", unam.recognises, _without_station(unam.read)),
    Format("RENADIC V1", renadic.recognises, _without_station(renadic.read)),
    Format("BHRC V1", bhrc.recognises, _without_station(bhrc.read)),
    Format("miniSEED", miniseed.recognises, miniseed.read, text=False, describes=is_station_xml),
)
