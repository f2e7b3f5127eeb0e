"""``stylobate fetch`` against a data centre on the loopback that answers what was written for it; QuakeML as ``--about``."""

import io
import json
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import parse_qs, urlsplit

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.codes.records import facts_of_records
from stylobate.errors import InputError
from stylobate.motion.earthquakes import read_earthquake

obspy = pytest.importorskip("obspy")
from obspy.clients.fdsn.header import DEFAULT_PARAMETERS, OPTIONAL_PARAMETERS  # noqa: E402

ORIGIN = "2024-03-01T10:00:00"
STATIONS = {"AAA": (38.0, 22.0), "GAP": (38.1, 22.0), "VEL": (38.2, 22.0), "FAR": (39.5, 22.0)}

EPICENTRE = (38.0, 22.1)


def quakeml(number: int = 1) -> bytes:
    from obspy.core.event import Catalog, Event, Magnitude, Origin

    def event() -> object:
        origin = Origin(time=obspy.UTCDateTime(ORIGIN), latitude=EPICENTRE[0], longitude=EPICENTRE[1], depth=8000.0)
        sizes = [Magnitude(mag=5.9, magnitude_type="ML"), Magnitude(mag=6.1, magnitude_type="Mw")]
        return Event(origins=[origin], magnitudes=sizes)

    answer = io.BytesIO()
    Catalog([event() for _ in range(number)]).write(answer, format="QUAKEML")
    return answer.getvalue()


def station_xml(names: list[str], level: str) -> bytes:
    from obspy.core.inventory import Channel, Inventory, Network, Station
    from obspy.core.inventory.response import InstrumentSensitivity, Response

    def channel(station: str, code: str, azimuth: float, dip: float, place: tuple[float, float]) -> Channel:
        unit = "M/S" if station == "VEL" else "M/S**2"
        response = Response(instrument_sensitivity=InstrumentSensitivity(1e5, 1.0, unit, "COUNTS"))
        return Channel(code, "", *place, 0.0, 0.0, azimuth=azimuth, dip=dip, sample_rate=100.0, response=response)

    stations = []
    for name in names:
        place = STATIONS[name]
        ways = (("HNE", 90.0, 0.0), ("HNN", 0.0, 0.0), ("HNZ", 0.0, -90.0)) if level == "response" else ()
        stations.append(Station(name, *place, 0.0, channels=[channel(name, *way, place) for way in ways]))
    answer = io.BytesIO()
    Inventory([Network("XX", stations=stations)], source="test").write(answer, format="STATIONXML")
    return answer.getvalue()


def mini_seed(name: str, start: str) -> bytes:
    rng = np.random.default_rng(len(name) + ord(name[0]))
    stream = obspy.Stream()
    for code in ("HNE", "HNN", "HNZ"):
        counts = (1e5 * rng.normal(size=3000)).astype(np.int32)
        head = {"network": "XX", "station": name, "channel": code, "sampling_rate": 100.0}
        head["starttime"] = obspy.UTCDateTime(start)
        trace = obspy.Trace(counts, head)
        stream += obspy.Stream([trace])
    if name == "GAP":
        begin = stream[0].stats.starttime
        stream = stream.slice(begin, begin + 10.0) + stream.slice(begin + 12.0)
    answer = io.BytesIO()
    stream.write(answer, format="MSEED")
    return answer.getvalue()


WADL = """<?xml version="1.0"?>
<application xmlns="http://wadl.dev.java.net/2009/02"><resources base="http://127.0.0.1/{0}/"><resource path="/">
<resource path="query"><method id="query" name="GET"><request>{1}</request></method></resource>
</resource></resources></application>"""


class Answers(BaseHTTPRequestHandler):
    def log_message(self, *_: object) -> None: ...

    def do_GET(self) -> None:
        parts = urlsplit(self.path)
        _, _, service, _, what = parts.path.split("/")
        query = {name: values[0] for name, values in parse_qs(parts.query).items()}
        answer = b""
        if what == "application.wadl":
            style = 'style="query" type="xs:string" xmlns:xs="http://www.w3.org/2001/XMLSchema"'
            words = DEFAULT_PARAMETERS[service] + OPTIONAL_PARAMETERS[service]
            answer = WADL.format(
                service, "".join(f'<param name="{parameter}" {style}/>' for parameter in words)
            ).encode()
        elif service == "event" and query.get("eventid") == "42":
            answer = quakeml()
        elif service == "station":
            names = [query["station"]] if "station" in query else list(STATIONS)
            answer = station_xml(names, query.get("level", "station"))
        elif service == "dataselect":
            answer = mini_seed(query["station"], query["starttime"])
        self.send_response(200 if answer else 204)
        self.end_headers()
        self.wfile.write(answer)


@pytest.fixture
def run(capsys):
    def run(*arguments):
        code = call(list(arguments))
        return code, *capsys.readouterr()

    return run


@pytest.fixture(scope="module")
def centre():
    server = ThreadingHTTPServer(("127.0.0.1", 0), Answers)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()


def test_records_of_an_earthquake_arrive_whole(run, centre, tmp_path):
    """What is written is read as a motion with its axes, and told of in about.csv; gaps and velocities are left out.

    AAA is a tenth of a degree of longitude away at 38° N, a/√(1 − e² sin² φ) cos φ Δλ = 8.78 km on the ellipsoid WGS 84.
    """
    out = tmp_path / "records"
    code, printed, errors = run("fetch", "42", "--service", centre, "--within", "60km", "--out", str(out), "--json")
    assert code == 0, errors
    summary = json.loads(printed)
    assert summary["earthquake"]["magnitude"] == 6.1  # the moment magnitude before the local one
    assert [row["station"] for row in summary["stations"]] == ["XX.AAA", "XX.GAP", "XX.VEL"]
    assert summary["stations"][0]["distance_km"] == pytest.approx(8.78, abs=0.02)
    assert "gaps" in summary["refused"]["XX.GAP"]
    assert "per M/S; allowed are units of acceleration" in summary["refused"]["XX.VEL"]
    motion = st.read_motion(out / "XX.AAA.HN.mseed")
    assert (motion.metadata["azimuths"]["x"], motion.metadata["azimuths"]["y"]) == (90.0, 0.0)
    assert motion.duration == pytest.approx(29.99)
    table = (out / "about.csv").read_text().splitlines()
    assert table == ["record,magnitude,distance_km", "XX.AAA.HN.mseed,6.1,8.78"]
    for about in ("about.csv", "earthquake.xml"):
        facts = facts_of_records(out / about, [out], [motion])[motion.name]
        assert facts["magnitude"] == 6.1
        assert facts["distance_km"] == pytest.approx(8.78, abs=0.01)
    code, _, errors = run("fetch", "42", "--service", centre, "--out", str(out))
    assert code == 2
    assert "XX.AAA.HN.mseed of an earlier request" in errors


def test_without_a_folder_it_says_what_there_is(run, centre):
    code, printed, errors = run("fetch", "42", "--service", centre, "--within", "300km", "--stations", "XX.FAR")
    assert code == 0, errors
    assert "Mw 6.1" in printed
    assert "XX.FAR" in printed
    assert "XX.AAA" not in printed


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("43",), "does not have earthquake '43'"),
        (("42", "--stations", "XX.NON"), "has no station XX.NON"),
        (("42", "--within", "0km"), "within is 0"),
        (("42", "--lasts", "5s"), "--lasts 5s"),
        (("42", "--channels", "HN"), "three characters"),
    ],
)
def test_what_is_not_there_is_said(run, centre, words, sentence):
    code, printed, errors = run("fetch", *words, "--service", centre)
    assert code == 2
    assert sentence in errors
    assert not printed


def test_no_data_centre(run):
    code, _, errors = run("fetch", "42", "--service", "NOWHERE")
    assert code == 2
    assert "no data centre is called 'NOWHERE'" in errors
    code, _, errors = run("fetch", "42", "--service", "http://127.0.0.1:9")
    assert code == 2
    assert "'http://127.0.0.1:9' is no address of a data centre" in errors
    code, _, errors = run("fetch", "42", "--service", "http://127.0.0.1:59999")
    assert code == 1
    assert "gives no answer" in errors


def test_a_catalogue_of_two_earthquakes_is_refused(tmp_path):
    file = tmp_path / "two.xml"
    file.write_bytes(quakeml(2))
    with pytest.raises(InputError, match="holds 2 earthquakes"):
        read_earthquake(file)
