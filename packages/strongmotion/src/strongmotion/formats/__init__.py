"""Formats of strong-motion networks: each a file of this folder, and a row of the one list of them."""

from collections.abc import Callable, Sequence

from stylobate.motion.earthquakes import is_station_xml
from stylobate.motion.readers import Format
from stylobate.motion.readers.record import Component
from stylobate.motion.readers.source import Source

from . import afad, bhrc, cosmos, csmip, esm, geonet, knet, miniseed, peer, renadic, smc, taiwan, unam, usc


def _alone(read: Callable[[Source], tuple[list[Component], dict]]) -> Callable[..., tuple[list[Component], dict]]:
    """A reader of files that need no description of their station."""

    def reader(source: Source, descriptions: Sequence[Source] = ()) -> tuple[list[Component], dict]:
        del descriptions
        return read(source)

    return reader


#: All formats that are read here: each states unit and step itself.
FORMATS: tuple[Format, ...] = (
    Format("CSMIP V1, V2", csmip.recognises, _alone(csmip.read)),
    Format("COSMOS V0, V1, V2", cosmos.recognises, _alone(cosmos.read)),
    Format("USGS SMC V1, V2", smc.recognises, _alone(smc.read)),
    Format("GeoNet V1A, V2A", geonet.recognises, _alone(geonet.read)),
    Format("USC V1", usc.recognises, _alone(usc.read)),
    Format("PEER AT2", peer.recognises, _alone(peer.read)),
    Format("ESM / ITACA ASCII", esm.recognises, _alone(esm.read)),
    Format("K-NET / KiK-net", knet.recognises, _alone(knet.read)),
    Format("AFAD text", afad.recognises, _alone(afad.read)),
    Format("TSMIP text", taiwan.recognises, _alone(taiwan.read)),
    Format("UNAM ASA", unam.recognises, _alone(unam.read)),
    Format("RENADIC V1", renadic.recognises, _alone(renadic.read)),
    Format("BHRC V1", bhrc.recognises, _alone(bhrc.read)),
    Format("miniSEED", miniseed.recognises, miniseed.read, text=False, describes=is_station_xml),
)
