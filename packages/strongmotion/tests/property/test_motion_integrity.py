"""Records that are damaged, cut or odd: what a header states is compared with what was read, and nothing is guessed."""

import io
import re
import tracemalloc
import warnings
from pathlib import Path

import numpy as np
import pytest
from fuzz.record_files import (
    COUNT,
    DT,
    FORMATS,
    WAVES,
    bhrc,
    csmip_v2,
    esm,
    fortran,
    geonet,
    itaca,
    knet,
    peak_of,
    renadic,
    taiwan,
)

from stylobate.constants import g
from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.motion import Motion, read_motion, read_suite, rotated, turned, write_csv
from stylobate.motion.readers.numbers import read_numbers
from stylobate.motion.readers.record import direction

RECORDS = Path(__file__).resolve().parents[4].parent / "shared" / "records"


@pytest.fixture
def put(tmp_path):
    def write(text, name="record.txt"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode("latin-1"))
        return path

    return write


def read(path, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutOfRangeWarning)
        return read_motion(path, **options)


def warned(path, **options):
    """All warnings of a reading, in one text."""
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        read_motion(path, **options)
    assert all(issubclass(warning.category, OutOfRangeWarning) for warning in seen)
    return "\n".join(str(warning.message) for warning in seen)


# -- miniSEED -------------------------------------------------------------------------------------------------------


COUNTS = np.round(1e5 * np.sin(np.arange(6000) * 0.05)).astype(np.int32)


def mseed(put, *channels, dips=None, name="ABC.xml", sensitivities=(1e5,), output="COUNTS", unit="M/S**2", gains=()):
    """A miniSEED file made here, with a StationXML of all its channels beside it.

    Each channel is a code, station, location, start [s] and counts, of which the last ones may be left out. ``dips`` of
    codes [degrees] are those of their letters otherwise; each of ``sensitivities`` is an epoch of its own, ``gains`` are
    those of the stages.
    """
    obspy = pytest.importorskip("obspy")
    from obspy.core.inventory import Channel, Inventory, Network, Response, Site, Station
    from obspy.core.inventory.response import CoefficientsTypeResponseStage, InstrumentSensitivity

    stream, stations = obspy.Stream(), {}
    for given in channels or (("HNE",),):
        code, station, location, start, counts = (*given, *("", "ABC", "", 0.0, COUNTS)[len(given) :])
        header = {"network": "XX", "station": station, "location": location, "channel": code, "sampling_rate": 100.0}
        stream.append(obspy.Trace(counts, header | {"starttime": obspy.UTCDateTime(2019, 7, 6) + start}))
        dip = (dips or {}).get(code, -90.0 if code[-1] == "Z" else 0.0)
        turned = {"azimuth": {"N": 0.0}.get(code[-1], 90.0), "dip": dip}
        stations.setdefault(station, Station(station, 0.0, 0.0, 0.0, channels=[], site=Site("A Place")))
        for size in sensitivities:
            stages = [
                CoefficientsTypeResponseStage(k, gain, 1.0, *units, "DIGITAL", numerator=[1.0], denominator=[])
                for k, (gain, *units) in enumerate(gains, 1)
            ]
            overall = InstrumentSensitivity(size, 1.0, unit, output)
            response = Response(instrument_sensitivity=overall, response_stages=stages)
            channel = Channel(code, location, 0.0, 0.0, 0.0, 0.0, **turned, sample_rate=100.0, response=response)
            stations[station].channels.append(channel)
    data, text = io.BytesIO(), io.BytesIO()
    stream.write(data, format="MSEED", encoding="STEIM2", reclen=512)
    Inventory([Network("XX", stations=list(stations.values()))], source="test").write(text, format="STATIONXML")
    put(text.getvalue(), name)
    return data.getvalue()


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize(
    ("unit", "size"),
    [
        ("nm/s**2", 1e-9),
        ("cm/s^2", 0.01),
        ("g", g),
        ("M/SEC**2", 1.0),
        ("m/s/s", 1.0),
        ("GAL", 0.01),
        ("UM/S**2", 1e-6),
    ],
)
def test_counts_per_any_unit_of_acceleration_are_read(unit, size, put):
    """A sensitivity of 1e5 counts per m/s² is one of 1e5 times the unit's size per that unit."""
    motion = read(put(mseed(put, unit=unit, sensitivities=(1e5 * size,)), "a.mseed"))
    assert motion.acceleration == pytest.approx((COUNTS - COUNTS.mean()) / 1e5, rel=1e-9)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize("unit", ["M/S", "M", "PA", ""])
def test_counts_of_another_quantity_are_refused_with_its_unit(unit, put):
    with pytest.raises(InputError, match=f"per {unit or 'no unit'}; allowed are units of acceleration"):
        read(put(mseed(put, unit=unit), "a.mseed"))


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize(
    ("gains", "message"),
    [
        ([(0.5, "M/S**2", "V"), (2e5, "V", "COUNTS")], ""),
        ([(0.5, "M/S**2", "V"), (2e5, "V", "COUNTS"), (1.04, "COUNTS", "COUNTS")], ""),
        (
            [(0.5, "M/S**2", "V"), (2e6, "V", "COUNTS")],
            "a sensitivity of 100000 COUNTS per .* stages whose gains make 1e.06",
        ),
        ([(0.5, "M/S**2", "V"), (2e5, "V", "COUNTS"), (1.06, "COUNTS", "COUNTS")], "allowed is a difference of 5 %"),
        ([(2e5, "V", "COUNTS")], ""),  # the stage of the sensor is not stated
    ],
)
def test_a_sensitivity_is_the_product_of_the_gains_of_its_stages(gains, message, put):
    path = put(mseed(put, gains=gains), "a.mseed")
    if not message:
        assert read(path).metadata["components"]["x"]["counts_per_m_s2"] == 1e5
        return
    with pytest.raises(InputError, match=message):
        read(path)


@pytest.mark.parametrize("order", ["EN", "NE", "ZNE"])
def test_components_of_miniseed_stand_in_the_order_of_the_file(order, put):
    path = put(mseed(put, *((f"HN{letter}",) for letter in order)), "a.mseed")
    flat = [f"HN{letter}" for letter in order if letter != "Z"]
    motion = read(path)
    assert [motion.metadata["labels"][axis] for axis in "xy"] == flat
    assert read(path, component=1 + order.index("N")).metadata["labels"] == {"x": "HNN"}


def test_a_gap_of_a_year_in_miniseed_is_refused_before_it_is_filled(put):
    path = put(mseed(put, ("HNE",), ("HNE", "ABC", "", 366 * 86400.0)), "a.mseed")
    tracemalloc.start()
    try:
        with pytest.raises(InputError, match=r"channel XX.ABC..HNE has a gap of 3.1622\d*e\+07 s from 2019-07-06"):
            read(path)
        assert tracemalloc.get_traced_memory()[1] < 20_000_000
    finally:
        tracemalloc.stop()


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_damaged_miniseed_is_refused_with_what_obspy_says(put):
    data = mseed(put)
    assert read(put(data, "a.mseed")).steps == 6000
    for bytes_left in (40, 130, 300):  # ObsPy itself says nothing of the last
        with pytest.raises(InputError, match=r"Unexpected end of file|Last record only|is cut"):
            read(put(data[: 512 * 5 + bytes_left], "cut.mseed"))
    middle = bytearray(data)
    middle[512 * 3 + 200] ^= 0x10  # within the samples of the fourth record
    with pytest.raises(InputError, match="integrity check"):
        read(put(bytes(middle), "flipped.mseed"))


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_channel_is_vertical_by_its_code_and_its_dip_which_must_agree(put):
    for dip, sign in ((None, 1.0), (-90.0, 1.0), (90.0, -1.0)):
        motion = read(put(mseed(put, ("HNN",), ("HNZ",), dips={"HNZ": dip}), "a.mseed"))
        assert list(motion.components) == ["x", "z"]
        assert motion.metadata["azimuths"] == {"x": 0.0, "z": None}
        assert np.array_equal(motion.vertical, sign * motion.acceleration)
    with pytest.raises(InputError, match="only the vertical component 'HNZ'"):
        read(put(mseed(put, ("HNZ",), dips={"HNZ": None}), "a.mseed"))
    with pytest.raises(InputError, match=r"HN3 is inclined, with a Dip of -35°"):
        read(put(mseed(put, ("HNN",), ("HN3",), dips={"HN3": -35.0}), "a.mseed"))
    for code, dip in (("HNZ", 0.0), ("HNE", -90.0)):
        with pytest.raises(InputError, match=rf"{code} says that it is .*, the Dip in the StationXML is"):
            read(put(mseed(put, ("HNN",), (code,), dips={code: dip}), "a.mseed"))


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_stationxml_files_that_contradict_one_another_or_give_volts_are_refused(put):
    record = put(mseed(put), "a.mseed")
    once = read(record)
    mseed(put, name="again.xml")
    assert read(record).digest == once.digest
    mseed(put, name="0.xml", sensitivities=(2e5,))
    with pytest.raises(
        InputError, match=r"200000 COUNTS per M/S\*\*2, azimuth 90°, dip 0° in 0\.xml and as 100000 COUNTS"
    ):
        read(record)
    assert read([record, record.with_name("ABC.xml")]).digest == once.digest
    for xml in record.parent.glob("*.xml"):
        xml.unlink()
    mseed(put, sensitivities=(1e5, 2e5))  # two epochs at one time
    with pytest.raises(InputError, match=r"in ABC\.xml and as 200000 COUNTS"):
        read(record)
    mseed(put, output="V", sensitivities=(0.25,))
    with pytest.raises(InputError, match=r"the sensitivity of XX\.ABC\.\.HNE in V per M/S\*\*2; allowed is COUNTS"):
        read(record)


# -- one record -----------------------------------------------------------------------------------------------------

REMEDY = "give the components of one record, or choose one by its number with `component='1'`"


def table(azimuth, values, first=0.0):
    """Accelerations along x in m/s² at steps of 0.01 s, whose times begin at ``first`` [s]."""
    stated = [] if azimuth is None else [f"# azimuth_x_deg: {azimuth}"]
    rows = (f"{first + DT * i:.4f} {value:.4f}" for i, value in enumerate(values))
    return "\n".join([*stated, "time_s ax_m_s2", *rows, ""])


def esm_at(start, stream="HNE"):
    """A file of ESM that says when it begins."""
    return esm().replace("STREAM: HNE", f"STREAM: {stream}\nDATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS: {start}")


@pytest.mark.parametrize(("start", "counts"), [(5.0, COUNTS[500:]), (0.5, COUNTS)])
def test_components_of_miniseed_that_begin_at_different_times_are_cut_to_their_common_span(start, counts, put):
    skip = round(start * 100)
    path = put(mseed(put, ("HNE",), ("HNN", "ABC", "", start, counts)), "a.mseed")
    motion = read(path)
    kept = len(COUNTS) - skip
    for actual, wanted in ((motion.acceleration, COUNTS[skip:]), (motion.lateral, counts[:kept])):
        assert np.ptp(actual - wanted / 1e5) < 1e-12  # all but the zero level
    assert motion.metadata["start_time"] == f"2019-07-06T00:00:0{start:.6f}Z"
    note = f"cut to the common span of {kept} samples (x: 6000, y: {len(counts)}, y begins {start:g} s later)"
    assert note in motion.processing
    assert note in warned(path)


def test_components_of_other_formats_that_begin_at_different_times_are_cut_as_well(put):
    note = "cut to the common span of 20 samples (x: 23, y: 23, y begins 0.03 s later)"
    columns = [put(table(0, WAVES[0]), "n"), put(table(90, WAVES[1], first=0.03), "e")]
    files = [put(esm_at("20160824_013600.000"), "a"), put(esm_at("20160824_013600.030", "HNN"), "b")]
    for paths, size in ((columns, (1.0, WAVES[1])), (files, (0.01, WAVES[0]))):
        motion = read(paths)
        assert motion.acceleration == pytest.approx(WAVES[0][3:] * size[0])
        assert motion.lateral == pytest.approx(size[1][:20] * size[0])
        assert note in motion.processing
    assert motion.metadata["start_time"] == "20160824_013600.030"
    three = csmip_v2().replace("05/02/83, 23:42:48 UTC", "05/02/83, 23:42:48.000 UTC")
    at = three.rindex("23:42:48.000 UTC")
    assert "y begins 0.05 s later" in warned(put(three[:at] + "23:42:48.050 UTC" + three[at + 16 :]))


def test_less_than_half_a_sample_is_one_clock(put):
    paths = [put(table(0, WAVES[0]), "n"), put(table(90, WAVES[1], first=0.004), "e")]
    motion = read(paths)
    assert motion.steps == COUNT
    assert motion.processing == ()
    zones = csmip_v2().replace("23:42:48 UTC", "16:42:48 PDT", 1)
    assert "begins" not in warned(put(zones))


@pytest.mark.parametrize(
    ("start", "message"),
    [
        ("20161030_064018.000", "do not overlap, as they begin at 20160824_013600.000 and 20161030_064018.000"),
        ("20160824_013600.230", "do not overlap"),
        ("20160824_013600.1", r"begin at .*, which does not tell to half a sample \(0.005 s\)"),
        ("20160824_013600.030 UTC", "does not tell to half a sample"),
        ("this morning", "does not tell to half a sample"),
    ],
)
def test_components_whose_times_do_not_go_together_are_refused(start, message, put):
    paths = [put(esm_at("20160824_013600.000"), "a"), put(esm_at(start, "HNN"), "b")]
    with pytest.raises(InputError, match=f"HNE of a and HNN of b .*{message}.*{re.escape(REMEDY)}"):
        read(paths)
    assert read(paths, component=2).metadata["start_time"] == start  # one alone is on no other's clock


def test_columns_whose_times_do_not_overlap_are_refused(put):
    paths = [put(table(0, WAVES[0]), "n"), put(table(90, WAVES[1], first=5.0), "e")]
    with pytest.raises(InputError, match="do not overlap, as they begin at 0 s and 5 s"):
        read(paths)


@pytest.mark.parametrize(
    ("channels", "message"),
    [
        ((("HNE",), ("HNN", "XYZ")), "HNE of a.mseed is of station 'ABC', HNN of a.mseed of 'XYZ'"),
        ((("HNE",), ("HNZ", "XYZ")), "of station 'ABC', HNZ of a.mseed of 'XYZ'"),
        ((("HNE",), ("HNN", "ABC", "10")), "of no stated location, HNN of a.mseed of '10'"),
        ((("HNE",), ("BNE",)), "HNE of a.mseed points to 90°, BNE of a.mseed to 90°; allowed .* within 5°"),
        ((("HNE",), ("HNN", "ABC", "", 180 * 86400.0)), "do not overlap"),
    ],
)
def test_channels_of_several_records_in_one_miniseed_are_refused(channels, message, put):
    path = put(mseed(put, *channels), "a.mseed")
    with pytest.raises(InputError, match=f"{message}.*{re.escape(REMEDY)}"):
        read(path)
    assert read(path, component=1).metadata["station"] == "ABC"
    if channels[1][1:2] == ("XYZ",):
        assert read(path, component=2).metadata["station"] == "XYZ"


def blocks(name):
    """The channels of a file, each with its header."""
    mark = {"csmip_v2": "Corrected accel", "geonet": "Uncorrected", "renadic": "UNCORRECTED", "bhrc": "* VOL1DS"}
    parts = re.split(f"(?={re.escape(mark.get(name, 'VOLUME I'))})", FORMATS[name][0])
    return [part for part in parts if part.strip()]


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("csmip_v2", "No. 12345", "No. 54321", "of station '12345', .* of '54321'"),
        ("csmip_v2", "SMALL EARTHQUAKE", "OTHER EARTHQUAKE", "of event 'SMALL EARTHQUAKE', .* of 'OTHER EARTHQUAKE'"),
        ("csmip_v2", "05/02/83, 23", "05/03/83, 23", "do not overlap"),
        ("geonet", "Site ABC", "Site XYZ", "of station 'ABC', .* of 'XYZ'"),
        ("geonet", "2016 November 13", "2017 November 13", "do not overlap"),
        ("renadic", "VIÑA DEL MAR", "SANTIAGO", "of station 'VIÑA DEL MAR', .* of 'SANTIAGO'"),
        ("renadic", "6:35:40.800", "6:45:40.800", "do not overlap"),
        ("usc", "SMALL EARTHQUAKE  ", "OTHER EARTHQUAKE  ", "of event 'SMALL EARTHQUAKE', .* of 'OTHER"),
        ("bhrc", "3333/01", "4444/01", "of station '3333', .* of '4444'"),
    ],
)
def test_channels_of_several_records_in_one_file_are_refused(name, old, new, message, put):
    *parts, last = blocks(name)
    assert old in last
    path = put("".join([*parts, last.replace(old, new)]))
    with pytest.raises(InputError, match=f"{message}.*{re.escape(REMEDY)}"):
        read(path)
    assert read(path, component=len(parts) + 1).steps > 1


def test_two_stations_one_behind_the_other_in_a_cosmos_file_are_refused(put):
    first = FORMATS["cosmos"][0]
    other = first.replace("CE-ABC", "CE-XYZ").replace("340 deg", "70 deg").replace("06:47:39", "06:47:59")
    with pytest.raises(InputError, match=r"340 deg of .* is of station 'ABC', 70 deg of .* of 'XYZ'"):
        read(put(first + other))
    with pytest.raises(InputError, match="do not overlap"):
        read(put(first + other.replace("CE-XYZ", "CE-ABC")))
    with pytest.raises(InputError, match=r"points to 340°, 340 deg of .* to 340°"):
        read(put(first + first))


def test_files_of_two_earthquakes_are_refused(put):
    north = esm().replace("HNE", "HNN").replace("EVENT_NAME: SMALL", "EVENT_NAME: SMALL\nEVENT_ID: 2")
    with pytest.raises(InputError, match="of event '1', HNN of b of '2'"):
        read([put(esm().replace("EVENT_NAME: SMALL", "EVENT_NAME: SMALL\nEVENT_ID: 1"), "a"), put(north, "b")])
    west = knet().replace("N-S", "E-W").replace("2003/07/26", "2011/03/11")
    with pytest.raises(InputError, match="of event '2003/07/26', E-W of b of '2011/03/11'"):
        read([put(knet(), "a"), put(west, "b")])
    with pytest.raises(InputError, match="of station 'ABC', x of n of none"):
        read([put(esm(), "a"), put(table(0, WAVES[1]), "n")])
    peer = FORMATS["peer_nga"][0]
    with pytest.raises(InputError, match="of event 'Small Quake-06', 320 of b of 'Large Quake'"):
        read([put(peer, "a"), put(peer.replace("Small Quake-06", "Large Quake").replace(", 230", ", 320"), "b")])
    with pytest.raises(
        InputError, match="230 of a and 320 of b do not overlap, as they begin at 10/15/1979 and 10/16/1979"
    ):
        read([put(peer, "a"), put(peer.replace("10/15/", "10/16/").replace(", 230", ", 320"), "b")])
    assert read([put(peer, "a"), put(peer.replace(", 230", ", 320"), "b")]).metadata["azimuths"] == {"x": 230, "y": 320}


@pytest.mark.parametrize(
    ("azimuths", "message"),
    [
        ((None, None), "x of a and x of b have one label"),
        ((0, 0), "x of a points to 0°, x of b to 0°"),
        ((0, 180), "x of a points to 0°, x of b to 180°"),
        ((0, 84), "x of a points to 0°, x of b to 84°"),
    ],
)
def test_parallel_components_are_refused(azimuths, message, put):
    paths = [put(table(azimuth, wave), file) for azimuth, wave, file in zip(azimuths, WAVES, "ab")]
    with pytest.raises(InputError, match=f"{message}.*{re.escape(REMEDY)}"):
        read(paths)


def test_components_at_right_angles_and_without_a_direction_are_read(put):
    motion = read([put(table(azimuth, wave), file) for azimuth, wave, file in zip((0, 85), WAVES, "ab")])
    assert motion.lateral == pytest.approx(WAVES[1])
    bare = [put("".join(f"{DT * i:.2f} {value}\n" for i, value in enumerate(wave)), f"{wave[1]}") for wave in WAVES[:2]]
    assert read(bare, unit="m/s2").lateral == pytest.approx(WAVES[1])
    with pytest.raises(InputError, match="hold the same bytes; give each component once"):
        read([bare[0], bare[0]], unit="m/s2")


# -- cut files ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["csmip_v2", "csmip_v1", "cosmos", "renadic", "bhrc"])
def test_a_missing_end_mark_is_a_cut_file(name, put):
    lines = FORMATS[name][0].rstrip("\n").splitlines(keepends=True)
    with pytest.raises(InputError, match="without the mark"):
        read(put("".join(lines[:-1])))


def test_a_usc_file_with_all_its_points_is_whole_without_a_mark(put):
    text = FORMATS["usc"][0]
    lines = text.rstrip("\n").splitlines(keepends=True)
    whole = read(put(text))
    assert read(put("".join(lines[:-1]))).digest == whole.digest
    marks = "------- END OF RECORD -------\n"
    assert read(put(text.replace(marks, ""))).digest == whole.digest  # between two channels neither
    with pytest.raises(InputError, match="promises 46 numbers"):
        read(put("".join(lines[:-2])))
    with pytest.raises(InputError, match="without the mark"):
        read(put("".join(lines[:-1]).rstrip("\n")[:-1] + "\n"))


def published_usc(seconds=0.0):
    """The same with rows that begin with a blank (1X,10F7.3), times from ``seconds`` on, and no marks."""
    lines = FORMATS["usc"][0].replace("------- END OF RECORD -------\n", "").splitlines(keepends=True)
    output = []
    for line in lines:
        numbers = [line[i : i + 7] for i in range(0, len(line) - 1, 7)] if len(line) in (71, 43) else []
        if numbers and all(re.fullmatch(r" *-?\d+\.\d{3}", number) for number in numbers):
            pairs = ((f"{float(t) + seconds:7.3f}", a) for t, a in zip(numbers[::2], numbers[1::2]))
            line = " " + "".join(t + a for t, a in pairs) + "\n"
        output.append(line)
    return "".join(output)


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_usc_file_as_published_is_whole_where_all_its_points_are_there(end, put):
    text = published_usc().replace("\n", end)
    assert read(put(text)).digest == read(put(FORMATS["usc"][0])).digest
    late = published_usc(100.0).replace("     0.220     0.000     0.100", "   100.220     0.000     0.100")
    assert "100.000" in late  # numbers of seven characters touch
    assert read(put(late)).acceleration == pytest.approx(read(put(text)).acceleration, abs=1e-9)
    for cut, message in (
        (text.rstrip()[:-1] + end, "without the mark"),
        (text.rstrip()[:-15] + end, "promises 46 numbers"),
    ):
        with pytest.raises(InputError, match=message):
            read(put(cut))


def smc_rows(per_row, first="2 CORRECTED ACCELEROGRAM"):
    """An SMC file with so many numbers to a row of samples, and no words on the station, as converting programs write it."""
    lines = FORMATS["smc"][0].splitlines(keepends=True)
    at = next(i for i, line in enumerate(lines) if line.startswith("|a comment")) + 1
    head = [f"{first}\n", *["*\n"] * 10, *lines[11:at]]
    return "".join(head) + "".join(
        "".join(f"{value:14.7E}" for value in WAVES[0][i : i + per_row]) + "\n" for i in range(0, COUNT, per_row)
    )


@pytest.mark.parametrize("per_row", [1, 5, 6, 8])
def test_smc_files_with_rows_of_any_length_are_read(per_row, put):
    motion = read(put(smc_rows(per_row)))
    assert motion.acceleration == pytest.approx(0.01 * WAVES[0])
    assert motion.metadata["event"] is None
    unknown = put(smc_rows(per_row, "0 UNKNOWN"))
    assert read(unknown).digest == motion.digest
    assert read(unknown).metadata["stage"] == "not stated"
    assert "does not say what the numbers are; they are read as accelerations in cm/s²" in warned(unknown)
    lines = smc_rows(per_row).splitlines(keepends=True)
    with pytest.raises(InputError, match="promises 23 numbers"):
        read(put("".join(lines[:-1])))


def test_what_networks_give_beside_records_is_named_with_what_to_give_instead(put):
    """Corrected accelerograms of USC, and spectra: the advice, a volume 1, is read."""
    numbers = "".join("".join(f"{value:10.3f}" for value in WAVES[0][:8]) + "\n" for _ in range(3))
    block = f"   24 POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.\n{numbers}"
    corrected = f"CORRECTED ACCELEROGRAM  IIXX001  COMP N90E\n{FORMATS['usc'][0].splitlines()[0]}\n{numbers}{block}"
    spectra = f"RESPONSE AND FOURIER AMPLITUDE SPECTRA   CHAN 1\nA PLACE\n{numbers}  DAMPING .05\n{numbers}"
    with pytest.raises(InputError, match=r"is a corrected accelerogram.*volume 1"):
        read(put(corrected))
    with pytest.raises(InputError, match=r"holds spectra .* give the accelerogram"):
        read(put(spectra))
    assert read(put(FORMATS["usc"][0])).metadata["format"] == "USC V1"
    title = "Response spectrum compatible motion\ntime_s,ax_g\n0,0.1\n0.01,-0.1\n"
    assert read(put(title)).steps == 2


@pytest.mark.parametrize("lost", ["data", "comment", "last"])
def test_a_line_that_is_lost_from_film_does_not_vanish_in_the_tolerance_at_its_end(lost, put):
    text = smc_v1()
    assert "8 numbers beyond the 80" in read(put(text)).processing[0]
    lines = text.splitlines(keepends=True)
    first = next(k for k, line in enumerate(lines) if line.startswith("|")) + 2
    gone = {"data": first + 4, "comment": first - 1, "last": len(lines) - 2}[lost]
    message = "comment lines that the header promises" if lost == "comment" else "a gap beyond"
    with pytest.raises(InputError, match=message):
        read(put("".join(lines[:gone] + lines[gone + 1 :])))


def test_a_gap_in_the_times_of_film_is_warned_about(put):
    text = smc_v1(stray=0.41)  # the stray line goes on at the steps before it
    assert "is missing" not in warned(put(text))
    lines = text.splitlines(keepends=True)
    assert "line 33: the time goes from" in warned(put("".join(lines[:32] + lines[33:])))


def film(name, lost=0, later=0.0):
    """Film of a channel without ``lost`` lines of five pairs after the second, and the rest ``later`` on the clock [s]."""
    text = re.split(r"(?<=RECORD -------\n)|(?<=CHANNEL  1  ----------\n)", FORMATS[name][0])[0]
    lines = text.splitlines(keepends=True)
    first = next(k for k, line in enumerate(lines) if len(line) == 71 and line.count(".") == 10)
    for k in range(first + 2, first + 5):
        fields = re.findall(r".{7}", lines[k])
        fields[::2] = [f"{float(time) + later:7.3f}" for time in fields[::2]]
        lines[k] = "".join(fields) + "\n"
    count, end = COUNT - 5 * lost, 0.23 + later
    head = "".join(lines[: first + 2])
    head = head.replace(f"POINTS = {COUNT}", f"POINTS = {count}").replace(f"{COUNT:5d}", f"{count:5d}")
    head = re.sub(r"(LENGTH = +)0\.2[23]", rf"\g<1>{end:.2f}", head).replace(f"{0.22:10.3f}", f"{end:10.3f}")
    return head + "".join(lines[first + 2 + lost :])


@pytest.mark.parametrize("name", ["csmip_v1", "usc", "renadic"])
def test_a_gap_in_film_of_every_network_is_seen(name, put):
    assert "is missing" not in warned(put(film(name)))
    assert "the time goes from" in warned(put(film(name, lost=1)))
    with pytest.raises(InputError, match=r"line \d+: the time goes from .* a gap beyond the 0.2 s"):
        read(put(film(name, later=5.0)))
    with pytest.raises(InputError, match=r"line \d+: the time goes from .*, where it may not fall"):
        read(put(film(name, later=-0.15)))


def smc_v1(stray=0.8):
    """Ten lines of four times and accelerations each, and a stray line behind them."""
    text = FORMATS["smc"][0]
    head = text[: text.index("|a comment\n") + len("|a comment\n")].replace("2 CORRECTED", "1 UNCORRECTED")
    head = head.replace(f"{COUNT:10d}", f"{80:10d}")
    lines = head.splitlines(keepends=True)
    lines[22:24] = [re.sub(r"-?\d\.\d{7}E[+-]\d\d", " 1.7000000E+38", line) for line in lines[22:24]]
    times = np.concatenate([0.01 * np.arange(40), stray + 0.01 * np.arange(4)])
    values = np.round(np.sin(times * 20.0), 3)
    numbers = [fortran(value) for pair in zip(times, values) for value in pair]
    return "".join(lines) + "".join("".join(numbers[i : i + 8]) + "\n" for i in range(0, 88, 8))


def test_blocks_of_velocity_and_displacement_are_counted(put):
    text = csmip_v2()
    lines = text.splitlines(keepends=True)
    block = max(i for i, line in enumerate(lines) if "displ data" in line)
    with pytest.raises(InputError, match=r"promises 22 numbers \(displacements\)"):
        read(put("".join(lines[: block + 2] + lines[block + 3 :])))
    two = geonet_v2()
    assert read(put(two)).steps == COUNT
    with pytest.raises(InputError, match=r"promises 23 numbers \(displacements\)"):
        read(put("".join(two.splitlines(keepends=True)[:-1])))


def geonet_v2():
    """Three components with velocities and displacements after the accelerations."""
    parts = geonet().split("Uncorrected")[1:]
    text = ""
    for part in parts:
        lines = ("Corrected" + part).splitlines(keepends=True)
        numbers = lines[26:]
        old = lines[19].split()
        lines[19] = "".join(f"{int(number):8d}" for number in [*old[:3], COUNT, COUNT, COUNT, *old[6:]]) + "\n"
        text += "".join(lines[:26] + numbers * 3)
    return text


@pytest.mark.parametrize("real62", [-999.0, 0.0])
def test_cosmos_without_a_step_is_refused_whatever_its_length(real62, put):
    text = (
        FORMATS["cosmos"][0]
        .replace(f"{10.0:15.6f}", f"{real62:15.6f}")
        .replace(f"{COUNT * DT:15.6f}", f"{-999.0:15.6f}")
    )
    with pytest.raises(InputError, match=rf"states a step of {real62:g} ms \(real 62\), where one above 0 is expected"):
        read(put(text.replace("approx  0 secs", "approx  1 secs")))


def test_fewer_components_than_the_header_speaks_of_are_warned_about(put):
    text = renadic()
    first = text[: text.index("/&") + len(text[text.index("/&") :].split("\n")[0]) + 1]
    assert "speaks of 3 components, the file holds 1" in warned(put(first))
    geonet_text = geonet()
    assert "speaks of 3 components, the file holds 2" in warned(put(geonet_text[: geonet_text.rindex("Uncorrected")]))


def test_counts_that_are_missing_from_knet_are_seen(put):
    assert read(put(knet())).steps == COUNT
    with pytest.raises(InputError, match="promises 1 s"):
        read(put("".join(knet().splitlines(keepends=True)[:-1])))  # 16 of 23 counts, less than a second


@pytest.mark.parametrize("end", [-2, -3])
def test_a_number_cut_in_the_middle_is_seen(end, put):
    with pytest.raises(InputError, match="other digits than those before it"):
        read(put(esm()[:end]))
    assert read(put(esm()[:-1])).steps == COUNT  # only the line end is missing


# -- what headers state ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("esm", "SAMPLING_INTERVAL_S: 0.010000", "SAMPLING_INTERVAL_S: 500", "states a step of 500 s"),
        ("esm", "SAMPLING_INTERVAL_S: 0.010000", "SAMPLING_INTERVAL_S: 0.020000", "the header states 0.23 s"),
        ("esm", "SAMPLING_INTERVAL_S: 0.010000", "SAMPLING_INTERVAL_S: 1d3", "states a step of 1000 s"),
        ("esm", "NDATA: 23", "NDATA: 2d1", "promises 20 numbers"),
        ("esm", "PGA_CM/S^2: -", "PGA_CM/S^2: -1", "states a peak of"),
        ("afad", "(sec) : 0.01", "(sec) : 10", "states a step of 10 s"),
        ("afad", "(sec) : 0.01", "(sec) : 1d3", "states a step of 1000 s"),
        ("peer_nga", "DT=   .0100", "DT=   1d3", "states a step of 1000 s"),
        ("peer_nga", "NPTS=   23", "NPTS=   2d1", "promises"),
        ("knet", "23Hz", "1Hz", "states a step of 1 s"),
        ("unam", "/.01/.01/.01/", "/10/10/10/", "states a step of 10 s"),
        ("smc", "  1.0000000E+02", "  1.0000000E-02", "states a step of 100 s"),
        (
            "csmip_v2",
            "At equally-spaced intervals of    .010",
            "At equally-spaced intervals of    .020",
            "one of 0.02 s",
        ),
        ("csmip_v2", "Record length = 0.230", "Record length = 0.330", "states 0.33 s"),
        ("csmip_v2", "Peak acceleration =     1.", "Peak acceleration =     7.", "states a peak of 7"),
        ("csmip_v1", "RECORD LENGTH = 0.22", "RECORD LENGTH = 0.52", "length of 0.52 s"),
        ("csmip_v1", "MAX = .150 G", "MAX = .950 G", "states a peak of 0.95"),
        ("cosmos", "      10.000000", "      20.000000", "the header states 0.23 s"),
        ("geonet", "Number of points 23", "Number of points 28", "28 points, but 23"),
        ("geonet", "Duration 0.23", "Duration 0.83", "states 0.83 s"),
        ("geonet", "intervals of 0.010", "intervals of 0.020", "one of 0.02 s"),
        ("geonet", "      10      10", "      10      70", "states the direction 'N10E', the numbers 70"),
        ("usc", "     0.220     0.000     0.100", "     0.720     0.000     0.100", "length of 0.72 s"),
        ("renadic", "RECORD LENGTH =   0.230", "RECORD LENGTH =   0.930", "length of 0.93 s"),
        (
            "renadic",
            "UNITS OF UNCOR ACCEL ARE SEC AND G/10.",
            "UNITS OF UNCOR ACCEL ARE SEC AND LBS.",
            "allowed are g, m/s2",
        ),
        ("bhrc", "DURATION =   0.230", "DURATION =   0.930", "states 0.93 s"),
        ("bhrc", "COMP L1", "COMP T1", "the component is 'L' and 'T'"),
        ("taiwan", "SampleRate(Hz): 100", "SampleRate(Hz): 200", "one of 0.01 s"),
        ("taiwan", "RecordLength(sec):   0.230", "RecordLength(sec):   9.230", "states 9.23 s"),
    ],
)
def test_what_is_stated_twice_must_agree(name, old, new, message, put):
    text = knet() if name == "knet" else FORMATS[name][0]
    assert old in text
    with pytest.raises(InputError, match=message):
        read(put(text.replace(old, new)))


def test_a_peak_at_another_time_is_warned_about(put):
    stated = f"TIME_PGA_S: {peak_of(WAVES[0])[1]:.6f}"
    assert stated in esm()
    assert "states its peak at 0.07 s" in warned(put(esm().replace(stated, "TIME_PGA_S: 0.070000")))


@pytest.mark.parametrize("text", ["1_0 0.1\n20 0.2\n", "0 0.1\n\u0661 0.2\n"])
def test_what_only_python_takes_for_numbers_is_refused(text, tmp_path):
    path = tmp_path / "odd.txt"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError):
        read(path, unit="g")


def test_a_blank_inside_a_fixed_field_is_no_digit_separator(put):
    text = FORMATS["cosmos"][0]
    value = f"{WAVES[0][1]:10.5f}"
    with pytest.raises(InputError, match="promises 23 numbers"):
        read(put(text.replace(value, value[:-2] + " " + value[-1:], 1)))


# -- real headers of other networks ---------------------------------------------------------------------------------


def test_bhrc_takes_the_step_that_its_rate_states(put):
    assert read(put(bhrc())).dt == DT
    # 0.23 s of 23 samples: to the step after the last one. Without the rate, the shorter decimal counts.
    assert read(put(bhrc().replace("1.000000E+02", "0.000000E+00"))).dt == pytest.approx(DT, rel=1e-12)


def test_renadic_keeps_its_equal_steps(put):
    motion = read(put(renadic()))
    assert motion.dt == DT
    assert not any("resampled" in text for text in motion.processing)


def test_the_older_itaca_counts_west_to_east(put):
    motion = read(put(itaca()))
    assert motion.metadata["labels"]["x"] == "EW"
    assert motion.acceleration == pytest.approx(WAVES[0] * 0.01)
    with pytest.raises(InputError, match="states no UNITS"):
        read(put(itaca().replace("Units : cm/s^2\n", "")))


def test_europe_s_cdrom_files_with_three_blocks(put):
    head = ["file:                 000001xa.cor", "orientation of transducer:    NS", "sampling period:  0.010000s"]
    head += [f"number of samples:   {COUNT}", f"record length:    {COUNT * DT:.3f}s", "units:    m/s*s, m/s & s"]
    numbers = "".join("".join(f"{v:14.5E}" for v in WAVES[0][i : i + 5]) + "\n" for i in range(0, COUNT, 5))
    blocks = "".join(f"-> corrected {what} time histories\n{numbers}" for what in ("acceleration", "velocity"))
    motion = read(put("\n".join(head) + "\n" + blocks + "STOP\n"))
    assert motion.acceleration == pytest.approx(WAVES[0], abs=1e-5)
    assert motion.metadata["azimuths"] == {"x": 0.0}
    lines = blocks.splitlines(keepends=True)
    with pytest.raises(InputError, match="promises 23 numbers"):
        read(put("\n".join(head) + "\n" + "".join(lines[:-1])))


def test_columns_of_tsmip_are_read_with_their_sense(put):
    motion = read(put(taiwan()))
    assert motion.vertical == pytest.approx(WAVES[2] * 0.01)
    assert motion.metadata["azimuths"] == {"x": 0.0, "y": 90.0, "z": None}
    turned = read(put(taiwan().replace("U(+)", "U(-)").replace("E(+)", "E(-)").replace("#AmplitudeMAX. U", "#x")))
    assert turned.vertical == pytest.approx(-WAVES[2] * 0.01)
    assert turned.lateral == pytest.approx(-WAVES[1] * 0.01)
    for old, new, message in (
        ("Time U(+); N(+); E(+)", "Time U(+); N(+); N(+)", "expected the columns Time U"),
        ("gal. DCoffset", "cm. DCoffset", "AmplitudeUnit is|allowed are g, m/s2"),
        (f"AmplitudeMAX. U: {WAVES[2].max():8.3f}", "AmplitudeMAX. U:    9.000", "states a peak of 9"),
    ):
        with pytest.raises(InputError, match=message):
            read(put(taiwan().replace(old, new)))


# -- directions -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("labels", "azimuth", "sign"),
    [
        ("Up,+UP,UP-DN,UPDN,U-D,UD,V,Z,VERTIC,Vert(Up),Vertical-Up,Roof UP,HNV,HNZ,BHZ,UP1", None, 1.0),
        ("HNZ00,BHZ10,HNZ2C,00HNZ,Z00,UP00,VERT1,HLZ--,HNZ 00,XX.HILL.00.HNZ,XX_HILL_HGZ10", None, 1.0),
        ("Down,-UP,-V,V;-,V-,Z(-),D-U,DN-UP,Vert(Down),Vertical Down,Roof DN,DWN00", None, -1.0),
        ("N 10.5 E,N10.5E,N 10.5° E,N10.5,NORTH 10.5 EAST,10.5 deg", 10.5, 0.0),
        ("N45°E,N45E,NE,North-East,45", 45.0, 0.0),
        ("N345,N 345,N15W,345 DEG", 345.0, 0.0),
        ("NORTH-SOUTH,N-S,NS,North,N,HNN,HGN,HLN,BNN,ENN,HNN00,360 Deg,0 deg", 0.0, 0.0),
        ("EAST-WEST,E-W,EW,East,HNE,HGE,HLE,BNE,ENE,090", 90.0, 0.0),
        ("N 5,-N,-S00E,-90,H1,HN1,HN100,HN210,L,Horiz. 1,Other,N Abutment 30 deg,400", None, 0.0),
    ],
)
def test_a_label_states_the_azimuth_or_that_the_component_is_vertical(labels, azimuth, sign):
    for label in labels.split(","):
        vertical = sign != 0.0
        assert direction(label) == (azimuth, vertical, sign if vertical else 1.0), label


def test_a_vertical_component_under_any_of_its_names_is_z(put):
    text = FORMATS["peer_nga"][0]
    flat, up = put(text), put(text.replace(", 230", ", -UP"), "up.at2")
    motion = read([flat, up])
    assert list(motion.components) == ["x", "z"]
    assert np.array_equal(motion.vertical, -motion.acceleration)
    with pytest.raises(InputError, match="only the vertical component '-UP'"):
        read(up)
    parts = [put(text.replace(", 230", f", {code}00"), f"{code}.at2") for code in ("HN1", "HN2", "HNZ")]
    assert read(parts).metadata["labels"] == {
        "x": "HN100",
        "y": "HN200",
        "z": "HNZ00",
    }  # NGA-East: a location behind it


@pytest.mark.parametrize(
    ("heading", "azimuths", "waves"),
    [
        ("UP N-S E-W", (0.0, 90.0), (1, 2, 0)),
        ("EW NS UD", (90.0, 0.0), (0, 1, 2)),
        ("E N Z", (90.0, 0.0), (0, 1, 2)),
        ("(E-W) (N-S) (U-D)", (90.0, 0.0), (0, 1, 2)),
        ("Up East North", (90.0, 0.0), (1, 2, 0)),
        ("", (0.0, 90.0), (0, 1, 2)),
    ],
)
def test_afad_columns_are_what_their_heading_says(heading, azimuths, waves, put):
    lines = FORMATS["afad"][0].splitlines(keepends=True)
    head = "".join(line for line in lines[:8] if "PGA" not in line) + "RAW PGA VALUES (gal):\n"
    motion = read(put(head + heading + "\n" + "".join(lines[-COUNT:])))
    assert motion.metadata["azimuths"] == {"x": azimuths[0], "y": azimuths[1], "z": None}
    for axis, wave in zip("xyz", waves):
        assert motion.components[axis] == pytest.approx(0.01 * WAVES[wave])


@pytest.mark.parametrize(
    ("heading", "message"), [("N-S E-W foo", "'N-S E-W foo' does not name"), ("N-S E-W U(-)", "does not name")]
)
def test_an_afad_heading_that_is_not_understood_is_refused(heading, message, put):
    with pytest.raises(InputError, match=message):
        read(put(FORMATS["afad"][0].replace("  N-S   E-W   U-D", heading)))


@pytest.mark.parametrize(
    ("integers", "text", "expected"),
    [
        ((90, 65), "65", 65.0),
        ((-32768, 65), "L", 65.0),
        ((90, -32768), "S74E", 106.0),
        ((-32768, 0), "UP", "z"),
        ((0, 0), "UP", "z"),
        ((90, 90), "360", "states the direction '360', integers 13 and 14 '90 deg'"),
        ((90, 0), "UP", "states the direction 'UP', integers 13 and 14 '0 deg'"),
        ((180, 0), "UP", "states the direction 'UP', integers 13 and 14 'Down'"),
    ],
)
def test_the_direction_of_smc_is_that_of_its_text_and_of_its_integers(integers, text, expected, put):
    file = put(
        FORMATS["smc"][0]
        .replace(f"{90:10d}{65:10d}", "".join(f"{number:10d}" for number in integers))
        .replace("component=     65", f"component=     {text}")
    )
    if isinstance(expected, float):
        assert read(file).metadata["azimuths"] == {"x": expected}
    else:
        with pytest.raises(InputError, match="only the vertical component" if expected == "z" else expected):
            read(file)


@pytest.mark.parametrize(
    ("text", "code", "number", "azimuth"),
    [
        ("Other", "", 90, 90.0),
        ("H1", "", 360, 0.0),
        ("", "", 30, 30.0),
        ("Other", "BNE", -999, 90.0),
        ("Other", "", 0, None),
    ],
)
def test_the_azimuth_of_cosmos_is_that_of_integer_54_where_text_and_code_state_none(text, code, number, azimuth, put):
    whole = FORMATS["cosmos"][0].replace("340 deg", text).replace("| nothing", f"|<SCNL>ABC.{code}.CE.--")
    lines = whole.splitlines(keepends=True)
    lines[19] = lines[19][:24] + f"{number:8d}" + lines[19][32:]  # integers 51 to 60
    assert read(put("".join(lines))).metadata["azimuths"] == {"x": azimuth}


def test_azimuths_in_comments_of_our_own_are_read(put):
    numbers = "time_s,ax_g,ay_g\n0,0.1,0.2\n0.01,-0.1,-0.2\n"
    stated = "# azimuth_x_deg: 0.4\n# azimuth_y_deg: 90.4\n"
    assert read(put(stated + numbers)).metadata["azimuths"] == {"x": 0.4, "y": 90.4}
    upward = read(put(stated + numbers.replace("ay_g", "az_g")))
    assert upward.metadata["azimuths"] == {"x": 0.4, "z": None}


def test_a_unam_file_is_in_the_unit_that_it_states(put):
    text = FORMATS["unam"][0]

    def stating(unit):
        return put(text.replace("FECHA DEL SISMO", f"UNIDADES DE LOS DATOS : {unit}\nFECHA DEL SISMO"))

    assert read(stating("Gales (cm/s/s)")).digest == read(put(text)).digest
    assert read(stating("mm/s/s")).acceleration == pytest.approx(WAVES[0] * 1e-3)
    for odd in ("gal*10 (FACTOR 0.1)", "cuentas", "gal, factor 10"):
        with pytest.raises(InputError, match="line 12: unit of acceleration is"):
            read(stating(odd))
    with pytest.raises(InputError, match=r"states the units 'gal \(m/s2\)'"):
        read(stating("gal (m/s2)"))


def test_unam_peaks_and_the_heading_of_the_columns_are_compared(put):
    text = FORMATS["unam"][0]
    peaks = [np.abs(WAVES[wave]).max() for wave in (0, 2, 1)]

    def stating(*peaks):
        line = "ACEL. MAX.(GAL), C1-C6, : /" + "/".join(f"{peak:.2f}" for peak in peaks) + "/"
        return put(
            text.replace("FECHA DEL SISMO", f"{line}\nACEL. MAX. C1-C6, EN LA MUESTRA : /1/2/3/\nFECHA DEL SISMO")
        )

    assert read(stating(*peaks)).digest == read(put(text)).digest
    with pytest.raises(InputError, match="line 12: the header states a peak of"):
        read(stating(peaks[0], 7.0 * peaks[1], peaks[2]))
    with pytest.raises(InputError, match="the columns are named N90W V S00E, ORIENTACION C1-C6 states S00E V N90W"):
        read(put(text.replace("   S00E      V       N90W", "   N90W      V       S00E")))


@pytest.mark.parametrize("down", ["-V", "V;-", "V-"])
def test_a_unam_channel_keeps_its_sign(down, put):
    text = FORMATS["unam"][0]
    assert np.array_equal(read(put(text.replace("/+V/", f"/{down}/"))).vertical, -read(put(text)).vertical)
    with pytest.raises(InputError, match="ORIENTACION holds 'N90W;-'"):
        read(put(text.replace("/N90W;+T/", "/N90W;-/")))


@pytest.mark.parametrize("bearing", ["N10E", "N 10 E", "N 10.4 E", "n10e"])
def test_a_bearing_in_several_words_is_read_to_its_end(bearing, put):
    azimuth = 10.4 if "." in bearing else 10.0
    for name, label in (("geonet", "N10E"), ("renadic", "NS"), ("smc", "65")):
        text = FORMATS[name][0].replace(f"{65:10d}", f"{-32768:10d}")
        file, changed = re.subn(rf"((?:Component|CHAN +1:|component=) *){label}", rf"\g<1>{bearing}", text, count=1)
        assert changed == 1
        assert read(put(file), component=1).metadata["azimuths"]["x"] == pytest.approx(azimuth)


@pytest.mark.parametrize(("x", "y"), [(90.0, None), (None, 0.0)])
def test_a_motion_of_which_one_azimuth_is_stated_is_not_turned_to_another(x, y, tmp_path):
    motion = Motion(DT, WAVES[0], WAVES[1], metadata={"azimuths": {"x": x, "y": y}})
    stated, other = ("x", "y") if y is None else ("y", "x")
    with pytest.raises(InputError, match=rf"{stated} of 'motion' points to .* add the line '# azimuth_{other}_deg: …'"):
        rotated(motion, 0.0)
    assert turned(motion, 30.0).metadata["azimuths"] == {"x": None, "y": None}
    path = write_csv(motion, tmp_path / "a.csv")
    path.write_text(f"# azimuth_{other}_deg: {0 if other == 'y' else 90}\n" + path.read_text())
    assert rotated(read_motion(path), 0.0).acceleration == pytest.approx(WAVES[1])


# -- what nobody meant ----------------------------------------------------------------------------------------------


def test_a_peak_below_a_thousandth_of_g_and_a_velocity_beyond_all_are_noticed(put):
    assert "which shakes no column; check the unit" in warned(put("0 0.0001\n0.01 -0.0001\n"), unit="g")
    slow = "".join(f"{i * 0.1:.1f} 1.0\n" for i in range(400))
    assert "velocity of 39.9 m/s, more than was ever recorded" in warned(put(slow), unit="m/s2")


def test_our_own_files_are_known_to_be_whole(put, tmp_path):
    path = write_csv(Motion(0.01, WAVES[0], vertical=WAVES[2]), tmp_path / "a.csv")
    text = path.read_text()
    assert read(path).steps == COUNT
    for damaged in (text.replace("0.22,1.221", "0.22,1.231"), "\n".join(text.splitlines()[:-1]) + "\n"):
        assert damaged != text
        with pytest.raises(InputError, match="not those that were written"):
            read(put(damaged))


def test_the_motion_has_the_name_of_the_file_whose_component_it_is(put):
    files = [put(esm(), "east.asc"), put(esm().replace("HNE", "HNN"), "north.asc")]
    assert read(files, component=2).name == "north.asc"
    assert read(files).name == "east.asc"


@pytest.mark.parametrize("wanted", ["x", "y", "z", "N80W", "n80w", "Up", "UD"])
def test_components_by_axis_and_label(wanted, put):
    wave = {"x": 0, "y": 1, "z": 2, "n80w": 1, "up": 2, "ud": 2}[wanted.lower()]
    assert read(put(geonet()), component=wanted).acceleration == pytest.approx(WAVES[wave] * 0.002)


def test_a_suite_with_a_damaged_record_names_it(put, tmp_path):
    put(esm(), "whole.asc")
    put(esm()[:-3], "cut.asc")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutOfRangeWarning)
        suite = read_suite(tmp_path)
    assert [motion.name for motion in suite.motions] == ["whole.asc"]
    assert "damaged or cut" in suite.refused["cut.asc"]


@pytest.mark.parametrize("end", ["1.2", "1.2210000", "1.2210000E-0"])
def test_a_number_that_is_cut_at_the_end_of_a_file_is_seen(end):
    lines = ["  5.9500000E-01 -7.0900000E-01", f" -1.1260000E+00  {end}"]
    with pytest.raises(InputError, match=r"line 8: the last number .* is shorter than those before it"):
        read_numbers(lines, 6, "record.at2", "accelerations", count=4)
    assert read_numbers([*lines[:1], " 1.0E+00 2.0E-10"], 6, "record.at2", "accelerations", count=4)[3] == 2e-10
    assert read_numbers(["0.5 0.25", "0.125 1"], 6, "record.at2", "accelerations", count=4)[3] == 1.0
