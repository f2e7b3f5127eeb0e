"""Small files in every published format: read as meant, with their traps; damaged ones are refused, never crash."""

import contextlib
import itertools
import tracemalloc
import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from records import FOLDER, SHIPPED

from stylobate.constants import g
from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.motion import MAX_SAMPLES, read_motion

COUNT, DT = 23, 0.01
WAVES = [
    np.round(np.sin(np.arange(COUNT) * 0.9 + phase) * size, 3) for phase, size in ((0.0, 1.5), (1.0, -1.2), (2.0, 0.7))
]


def rows(values, per_line, form, glue=""):
    texts = [form % value for value in values]
    return "\n".join(glue.join(texts[i : i + per_line]) for i in range(0, len(texts), per_line)) + "\n"


def integers(places, lines, per_line, width):
    values = [places.get(i, 0) for i in range(100 if per_line > 8 else lines * per_line)]
    return rows(values, per_line, f"%{width}d")


# -- one small file per format: name → (text, unit of the numbers in m/s², azimuths, axes) ---------------------------


def csmip_v2(end="\n"):
    text = ""
    for i, label in enumerate(("90 Deg", "Up", "360 Deg")):
        count = COUNT - (i == 2)
        head = [
            "Corrected accelerogram   12345-A1",
            "Uncorrected Accelerogram Data   Processed: today",
            "SMALL EARTHQUAKE",
        ]
        head += [
            "May 2, 1983",
            "12345-A1   Start time: 05/02/83, 23:42:48 UTC",
            "Station No. 12345  35.9N, 120.5W",
            "A PLACE",
        ]
        head += [f"Chan  {i + 1}: {label}", *(["line"] * 17)]
        text += "\n".join(head) + "\n" + integers({}, 7, 16, 5) + rows([0.0] * 100, 8, "%10.3f")
        for what, unit in (("accel", "cm/sec/sec"), ("veloc", "cm/sec"), ("displ", "cm")):
            text += f" {count} points of {what} data equally spaced at  .010 sec.  (units: {unit})\n"
            text += rows(WAVES[i][:count], 8, "%10.3f")
        text += f"/&  ----------  End of data for channel  {i + 1}  ----------\n"
    return text.replace("\n", end)


def csmip_v1():
    """Pairs of time and g/10, film steps, numbers that touch."""
    head = [
        "UNCORRECTED ACCELEROGRAM DATA   PROCESSED",
        "SMALL EARTHQUAKE",
        "date",
        "A   TRIGGER TIME: 1",
        "STATION NO. 1",
    ]
    head += ["A PLACE", "CHAN  1: N10E", "e", "h", "i", f"NO. OF POINTS = {COUNT}  RECORD LENGTH = 0.22 SEC"]
    head += ["UNITS OF UNCOR ACCEL ARE SEC AND G/10.  MAX = 1", "rms"]
    times = 99.9 + DT * np.arange(COUNT) + 0.001 * (np.arange(COUNT) % 3)
    pairs = np.column_stack([times, WAVES[0]]).ravel()
    return (
        "\n".join(head)
        + "\n"
        + integers({}, 7, 16, 5)
        + rows([0.0] * 50, 8, "%10.3f")
        + rows(pairs, 10, "%7.3f")
        + "/&\n"
    )


def cosmos(real62=10.0):
    reals = [-999.0] * 100
    reals[33], reals[61] = 0.005, real62  # the recorder's step is another one
    text = "Corrected acceleration  (Format v01.20 with 13 text lines)\nRecord of Small Earthquake\n" + "x\n" * 2
    text += "Statn No: 01-1 Code:CE-ABC  Net A Place\nCoords: 1 2\nRecorder: x\n"
    text += "Rcrd start time: 2019/05/05 06:47:39 (Q=5)\n"
    text += "Sta Chan   1: 340 deg (Rcrdr Chan  1) Location:\n" + "x\n" * 4
    text += " 100 Integer-header values follow on  10 lines, Format= (10I8)\n" + rows([1] + [-999] * 99, 10, "%8d")
    text += " 100 Real-header values follow on  20 lines, Format= (5F15.6)\n" + rows(reals, 5, "%15.6f")
    text += '  1 Comment line(s) follow, each starting with a "|":\n| nothing\n'
    text += f"   {COUNT} acceleration pts, approx  0 secs, units=cm/sec2(04),Format=(8F10.5)\n" + rows(
        WAVES[0], 8, "%10.5f"
    )
    return text + "End-of-data for channel\n"


def smc():
    ints = [-32768] * 48
    ints[12], ints[13], ints[15], ints[16] = 90, 65, 2, COUNT
    reals = [1.7e38] * 50
    reals[1] = 100.0
    text = "2 CORRECTED ACCELEROGRAM\n*\nABC\n 1989 10 18 0004 Small, CA\nMoment Mag= 7\n"
    text += "station = A Place  component=     65\n"
    text += "epicentral dist = 1\ninst type=SMA-1      data source = USGS\n*\n*\n*\n"
    text += rows(ints, 8, "%10d") + rows(reals, 5, "%15.7E") + "|\n|a comment\n"
    return text + "".join("".join(fortran(v) for v in WAVES[0][i : i + 8]) + "\n" for i in range(0, COUNT, 8))


def fortran(value):
    """Ten wide with a one-digit exponent, so that numbers touch: 1p, e10.4e1."""
    mantissa, exponent = f"{value:.4E}".split("E")
    return f"{mantissa:>7}E{int(exponent):+d}"


def geonet():
    text = ""
    for i, label in enumerate(("N10E", "N80W", "Up")):
        reals = [0.0] * 60
        reals[24], reals[25] = 0.005, DT
        ints = [0] * 40
        ints[33] = COUNT
        head = [
            "Uncorrected accelerogram 1_ABC_20 GNS Science",
            "Site ABC     42 31 24S  172 49 50E",
            "A Place",
            "Instrument",
        ]
        head += [
            "Resolution",
            "Accelerogram",
            "5 km off",
            "2016 November 13  11:02:56 UT",
            "Epicentre",
            f"Number of points {COUNT}",
        ]
        head += [
            "Raw readings in units of 2.00 mm/s/s  at intervals of 0.010 s",
            "Data is unfiltered",
            f"Component {label}",
        ]
        head += ["Acceleration:  Peak 1 mm/s/s", "Velocity", "Displacement"]
        text += "\n".join(head) + "\n" + rows(ints, 10, "%8d") + rows(reals, 10, "%8.3f") + rows(WAVES[i], 10, "%8.3f")
    return text


def usc():
    text = ""
    for code, wave in ((90, 0), (500, 2)):
        reals = [0.0] * 50
        reals[2], reals[4] = 0.22, 0.1
        head = [
            "VOLUME I   OF UNCORRECTED ACCELEROGRAM DATA OF A QUAKE",
            "SMALL EARTHQUAKE        10",
            *["x"] * 3,
            "A PLACE      7",
            *["x"] * 7,
        ]
        pairs = np.column_stack([DT * np.arange(COUNT) + 0.001 * (np.arange(COUNT) % 2), WAVES[wave]]).ravel()
        text += "\n".join(head) + "\n" + integers({8: 54, 26: code, 27: COUNT}, 7, 16, 5) + rows(reals, 8, "%10.3f")
        text += rows(pairs, 10, "%7.3f") + "------- END OF RECORD -------\n"
    return text


def peer_nga():
    text = "PEER NGA STRONG MOTION DATABASE RECORD\nSmall Quake-06, 10/15/1979, A Place, 230\n"
    text += f"ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=   {COUNT}, DT=   .0100 SEC,\n"
    return text + rows(WAVES[0], 5, "%15.7E")


def peer_old():
    """Lower case, lines in another order, the count before its name."""
    text = "PACIFIC ENGINEERING AND ANALYSIS STRONG-MOTION DATA\n acceleration time history in units of g\n"
    text += f" SMALL QUAKE 10/15/79 2319, A PLACE, 230\n npts=  {COUNT}, dt= .01000 sec\n"
    return text + rows(WAVES[0], 5, "%15.7E")


def esm():
    head = [
        "EVENT_NAME: SMALL",
        "NETWORK: IT",
        "STATION_CODE: ABC",
        "STATION_NAME: Città",
        "SAMPLING_INTERVAL_S: 0.010000",
    ]
    head += [
        f"NDATA: {COUNT}",
        "STREAM: HNE",
        "UNITS: cm/s^2",
        "DATA_TYPE: ACCELERATION",
        "PROCESSING: manual",
        "DATA_LICENSE: CC BY 4.0",
    ]
    return "\n".join(head) + "\n" + rows(WAVES[0], 1, "%.6f")


def knet():
    fields = [("Origin Time", "2003/07/26"), ("Lat.", "38"), ("Long.", "141"), ("Depth. (km)", "12"), ("Mag.", "6.2")]
    fields += [("Station Code", "MYG007"), ("Station Lat.", "1"), ("Station Long.", "1"), ("Station Height(m)", "1")]
    fields += [
        ("Record Time", "2003/07/26 00:13:24"),
        ("Sampling Freq(Hz)", "100Hz"),
        ("Duration Time(s)", "0"),
        ("Dir.", "N-S"),
    ]
    fields += [("Scale Factor", "2000(gal)/1000"), ("Max. Acc. (gal)", "3"), ("Last Correction", "x"), ("Memo.", "")]
    counts = np.round(WAVES[0] * 1000).astype(int) + 5000  # a zero level left in
    return "".join(f"{key:<18}{value}\n" for key, value in fields) + rows(counts, 8, "%9d")


def afad():
    head = [
        "STRONG GROUND MOTION RECORDS OF TURKIYE",
        "PLACE\t:\tA PLACE",
        "EARTHQUAKE DATE : 17/08/1999 00:01:39 (GMT)",
    ]
    head += [
        "STATION ID : 8101",
        "RECORD TIME : 17/08/1999",
        f"NUMBER OF DATA : {COUNT}",
        "SAMPLING INTERVAL (sec) : 0.01",
    ]
    head += ["RAW PGA VALUES (gal): 1 1 1", "", "  N-S   E-W   U-D"]
    return "\n".join(head) + "\n" + rows(np.column_stack(WAVES).ravel(), 3, "%12.3f")


def unam():
    head = ["RED", "x", "x", "x", "x", "x", "     ARCHIVO ESTANDAR DE ACELERACION", "CLAVE DE LA ESTACION  : ABCD"]
    head += [
        "ORIENTACION C1-C6 (rumbo;orientacion)   : /S00E;+L/+V/N90W;+T/",
        "INTERVALO DE MUESTREO, C1-C6 (s) : /.01/.01/.01/",
    ]
    head += [
        f"NUM. TOTAL DE MUESTRAS, C1-C6 : /{COUNT}/{COUNT}/{COUNT}/",
        "FECHA DEL SISMO [GMT] : 1985/09/19",
        "-----",
    ]
    head += ["   CANAL-1     CANAL-2     CANAL-3", "   S00E      V       N90W"]
    return "\n".join(head) + "\n" + rows(np.column_stack([WAVES[0], WAVES[2], WAVES[1]]).ravel(), 3, "%10.3f")


def renadic():
    text = ""
    for label, wave in (("NS", 0), ("EW", 1), ("Z", 2)):
        head = [
            "PROCESSED: 1",
            "SMALL EARTHQUAKE",
            "x",
            "2/27/2010 06:34:11 GMT",
            "x",
            "VIÑA DEL MAR   S/N 675",
            f"CHANNEL: {label}",
        ]
        head += [
            "UNIVERSIDAD DE CHILE - RENADIC",
            "x",
            "INSTR PERIOD = 1",
            f"NO. OF POINTS = {COUNT}  DURATION = 0.22 SEC",
        ]
        head += ["UNITS ARE SEC AND G/10", "x"]
        pairs = np.column_stack([DT * np.arange(COUNT), WAVES[wave]]).ravel()
        text += (
            "\n".join(head) + "\n" + integers({}, 7, 16, 5) + rows([0.0] * 50, 8, "%10.3f") + rows(pairs, 10, "%7.3f")
        )
        text += f"/&  END OF DATA {label}\n"
    return text


def bhrc():
    text = ""
    for label, wave in (("L", 0), ("V", 2), ("T", 1)):
        head = ["* VOL1DS  REC NO : 3333-01/02", "INSTR = SSA-2", "SMALL QUAKE", "x", label, "x", f"COMP {label}"]
        head += ["A PLACE   Station 35.1 51.2 1200 L 40 T 130", "x", "PERIOD 0.02 DAMPING 0.7"]
        head += [f"NO. OF POINTS {COUNT} DURATION 0.22 SEC", "UNITS ARE SEC AND G/10", "x"]
        text += "\n".join(head) + "\n" + integers({}, 7, 16, 5) + rows([0.0] * 50, 8, "%10.3f")
        text += rows(WAVES[wave], 10, "%13.5f") + "*END OF RECORD\n"
    return text


# name: text, m/s² per number, label of the format, azimuths of x and y, whether there is a z
FORMATS = {
    "csmip_v2": (csmip_v2(), 0.01, "CSMIP V2", (90.0, 0.0), True),
    "csmip_v1": (csmip_v1(), g / 10, "CSMIP V1", (10.0,), False),
    "cosmos": (cosmos(), 0.01, "COSMOS 1.20", (340.0,), False),
    "smc": (smc(), 0.01, "USGS SMC V2", (65.0,), False),
    "geonet": (geonet(), 0.002, "GeoNet V1A", (10.0, 280.0), True),
    "usc": (usc(), g / 10, "USC V1", (90.0,), True),
    "peer_nga": (peer_nga(), g, "PEER AT2", (230.0,), False),
    "peer_old": (peer_old(), g, "PEER AT2", (230.0,), False),
    "esm": (esm(), 0.01, "ESM / ITACA ASCII (DYNA)", (90.0,), False),
    "afad": (afad(), 0.01, "AFAD text", (0.0, 90.0), True),
    "unam": (unam(), 0.01, "UNAM ASA", (180.0, 270.0), True),
    "renadic": (renadic(), g / 10, "RENADIC V1", (0.0, 90.0), True),
    "bhrc": (bhrc(), g / 10, "BHRC V1", (40.0, 130.0), True),
}
FILM = ("csmip_v1", "usc")


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


@pytest.mark.parametrize("name", sorted(FORMATS))
def test_every_format_is_recognised_and_read(name, put):
    text, size, label, azimuths, has_z = FORMATS[name]
    motion = read(put(text))
    assert motion.metadata["format"] == label
    assert [motion.metadata["azimuths"][axis] for axis in "xy"[: len(azimuths)]] == list(azimuths)
    assert (motion.vertical is not None) == has_z
    assert motion.metadata["unit"]
    waves = [WAVES[0], WAVES[1]][: len(azimuths)] + [WAVES[2]] * has_z
    if name == "csmip_v2":
        waves = [WAVES[0], WAVES[2], WAVES[1]]
    for wave, found in zip(waves, motion.components.values()):
        if name in FILM:
            times = DT * np.arange(COUNT) + 0.001 * (np.arange(COUNT) % (3 if name == "csmip_v1" else 2))
            assert np.interp(times, motion.time, found) == pytest.approx(wave * size, abs=1e-9)
        else:
            assert motion.dt == pytest.approx(DT, rel=1e-12)
            assert found == pytest.approx(wave[: len(found)] * size, rel=1e-6, abs=1e-12)


def test_knet_counts_lose_their_zero_level_and_say_so(put):
    motion = read(put(knet()))
    assert motion.acceleration == pytest.approx((WAVES[0] - WAVES[0].mean()) * 20.0, abs=0.011)
    assert motion.metadata["azimuths"] == {"x": 0.0}
    assert "zero level" in motion.processing[0]
    assert motion.metadata["start_time"] == "2003-07-26 00:13:09"  # the record time counts 15 s of delay


@pytest.mark.parametrize("end", ["\r\n", "\r\r\n", "\r"])
def test_line_ends(end, put):
    assert read(put(csmip_v2(end))).digest == read(put(csmip_v2(), "other")).digest


def test_unequal_components_are_cut_with_a_warning(put):
    with pytest.warns(OutOfRangeWarning, match="common length of 22"):
        read_motion(put(csmip_v2()))


def test_components_in_separate_files_make_one_motion(put):
    north = esm().replace("HNE", "HNN").replace("STREAM: HNN", "STREAM: HNN")
    up = esm().replace("HNE", "HNZ")
    motion = read([put(esm(), "e"), put(north, "n"), put(up, "z")])
    assert list(motion.components) == ["x", "y", "z"]
    assert motion.metadata["azimuths"] == {"x": 90.0, "y": 0.0, "z": None}
    assert motion.metadata["terms"] == "CC BY 4.0"
    with pytest.raises(InputError, match="components of one record"):
        read([put(esm(), "e"), put(esm().replace("ABC", "XYZ"), "n")])
    with pytest.raises(InputError, match="only the vertical"):
        read(put(up, "z"))
    with pytest.raises(InputError, match="more than one place's"):
        read([put(esm(), "a"), put(esm(), "b"), put(north, "c")])


def test_downward_components_are_turned_upward(put):
    motion = read(put(geonet().replace("Component Up", "Component Down")))
    assert motion.vertical == pytest.approx(-WAVES[2] * 0.002)
    assert any("sign turned" in step for step in motion.processing)


def test_components_by_number_label_and_azimuth(put):
    path = put(geonet())
    for wanted in (2, "2", "N80W", "280"):
        assert read(path, component=wanted).acceleration == pytest.approx(WAVES[1] * 0.002)
    with pytest.raises(InputError, match=r"no component '7'; it holds 1 \(N10E\)"):
        read(path, component=7)


def test_azimuth_that_the_file_does_not_know(put):
    motion = read(put(csmip_v2().replace("90 Deg", "H1").replace("360 Deg", "H2")))
    assert motion.metadata["azimuths"] == {"x": None, "y": None, "z": None}
    assert motion.metadata["labels"]["x"] == "H1"


@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        ("peer_nga", "NPTS=   23", "NPTS=   24", "promises 24 numbers"),
        ("peer_nga", "NPTS=   23", "NPTS=   1e9", "promises"),
        ("peer_nga", "NPTS=   23", "NPTS=   99999999", "whole number from 2"),
        ("peer_nga", "OF G", "OF FURLONGS", "allowed is g, m/s2"),
        ("peer_nga", "ACCELERATION", "VELOCITY", "give the file of accelerations"),
        ("peer_nga", "DT=   .0100", "DT=   0", "expected the step"),
        ("esm", "UNITS: cm/s^2", "UNITS:", "states no UNITS"),
        ("esm", "NDATA: 23", "NDATA: 22", "promises 22 numbers"),
        ("esm", "DATA_TYPE: ACCELERATION", "DATA_TYPE: VELOCITY", "data_type is VELOCITY"),
        ("esm", "0.010000", "0.000000", "step of"),
        ("esm", "0.010000", "nothing", "expected a number after"),
        ("cosmos", "units=cm/sec2(04)", "units=counts(50)", "counts without the recorder's step"),
        ("cosmos", "  23 acceleration", "  25 acceleration", "promises 25 numbers"),
        ("cosmos", "acceleration pts", "velocity pts", "not acceleration"),
        ("smc", "2 CORRECTED ACCELEROGRAM", "3 VELOCITY", "expected an accelerogram"),
        ("usc", "   23", "   29", "promises 58 numbers"),
        ("afad", "DATA : 23", "DATA : 21", "promises 63 numbers"),
        ("unam", "/23/23/23/", "/23/23/2x/", "where a number is expected"),
        ("bhrc", "0.22 SEC", "nothing", "length of the record"),
        ("csmip_v1", "G/10.", "LBS.", "no unit of acceleration"),
        ("csmip_v1", "99.911", " 0.000", "time falls"),
        ("csmip_v2", "(units: cm/sec/sec)", "(units: lbs)", "no unit of acceleration"),
        ("geonet", "units of 2.00 mm/s/s", "units of 2.00 lbs", "unit of acceleration"),
    ],
)
def test_damaged_files_are_refused_with_the_reason(name, old, new, said, put):
    text = FORMATS[name][0]
    assert old in text
    with pytest.raises(InputError, match=said):
        read(put(text.replace(old, new)))


def test_knet_that_is_cut_is_refused(put):
    with pytest.raises(InputError, match="the file is cut"):
        read(put(knet().replace("Duration Time(s)  0", "Duration Time(s)  300")))


def test_a_file_of_two_formats_is_refused(put):
    both = esm().replace("EVENT_NAME: SMALL", "EVENT_NAME: STRONG GROUND MOTION RECORDS OF TURKIYE")
    with pytest.raises(InputError, match="looks like ESM / ITACA ASCII and like AFAD text"):
        read(put(both))


def test_a_stated_unit_is_not_overruled(put):
    with pytest.raises(InputError, match="leave the unit out"):
        read(put(esm()), unit="g")


def test_a_step_that_contradicts_the_length_is_refused(put):
    with pytest.raises(InputError, match="disagree with the step"):
        read(put(cosmos(5000.0).replace("approx  0 secs", "approx  9 secs")))


@pytest.mark.parametrize("name", sorted(FORMATS))
def test_a_file_that_ends_early_is_refused(name, put):
    lines = FORMATS[name][0].splitlines(keepends=True)
    for share in (0.45, 0.7, 0.9):  # within a component: nothing says how many of them there should be
        with pytest.raises(InputError):
            read(put("".join(lines[: int(len(lines) * share)])))


@pytest.mark.parametrize("order", list(itertools.permutations(range(4)))[1::5])
def test_header_lines_in_any_order(order, put):
    for text, count in ((peer_nga(), 4), (esm(), 11)):
        lines = text.splitlines(keepends=True)
        turned = list(range(count))
        turned[:4] = order
        mixed = "".join([*(lines[i] for i in turned), *lines[count:]])
        assert read(put(mixed, "mixed")).digest == read(put(text)).digest


def test_several_records_in_one_file_are_refused_with_the_way_to_choose(put):
    path = put(csmip_v2() + csmip_v2())
    with pytest.raises(InputError, match=r"holds 6 components .*component='1' \(--component 1\)"):
        read(path)
    assert read(path, component=4).acceleration == pytest.approx(WAVES[0] * 0.01)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("csmip_v2", "23 points of accel", "0 points of accel"),
        ("csmip_v1", "NO. OF POINTS = 23", "NO. OF POINTS = 0"),
        ("cosmos", "  23 acceleration", "  0 acceleration"),
        ("smc", "        23", "         0"),
        ("geonet", "      23", "       0"),
        ("usc", "   23", "    0"),
        ("peer_nga", "NPTS=   23", "NPTS=   0"),
        ("esm", "NDATA: 23", "NDATA: 0"),
        ("afad", "DATA : 23", "DATA : 0"),
        ("unam", "/23/23/23/", "/0/23/23/"),
        ("renadic", "NO. OF POINTS = 23", "NO. OF POINTS = 0"),
        ("bhrc", "NO. OF POINTS 23", "NO. OF POINTS 0"),
    ],
)
def test_empty_components_are_refused(name, old, new, put):
    text = FORMATS[name][0]
    assert old in text
    with pytest.raises(InputError):
        read(put(text.replace(old, new)))


def test_a_promise_of_a_hundred_million_samples_takes_no_memory(put):
    paths = [
        put(FORMATS[name][0].replace(old, new), name)
        for name, old, new in (
            ("peer_nga", "NPTS=   23", "NPTS=   100000000"),
            ("esm", "NDATA: 23", "NDATA: 19000000"),
            ("csmip_v1", "NO. OF POINTS = 23", "NO. OF POINTS = 19000000"),
            ("afad", "DATA : 23", "DATA : 19000000"),
        )
    ]
    tracemalloc.start()
    try:
        for path in paths:
            with pytest.raises(InputError, match="promises"):
                read(path)
        assert tracemalloc.get_traced_memory()[1] < 2_000_000
    finally:
        tracemalloc.stop()


# -- fuzzing: whatever is in a file, it is read, or refused with our own error -----------------------------------------

SEEDS = [text.encode("latin-1") for text, *_ in FORMATS.values()] + [knet().encode()]
SEEDS += [b"time_s,ax_g\n0,1\n0.1,-1\n0.2,0\n", b"0 1\n1 2\n2 -3\n"]
REAL = [one.data[:20_000] for one in SHIPPED.values()]
REAL += [path.read_bytes()[:20_000] for path in sorted(FOLDER.glob("*.*")) if path.name not in SHIPPED]

edits = st.lists(
    st.tuples(
        st.sampled_from(["replace", "delete", "insert", "double", "cut", "swap"]),
        st.floats(0.0, 1.0),
        st.floats(0.0, 1.0),
        st.sampled_from(
            [
                b"",
                b"\x00",
                b"-",
                b"nan",
                b"1e999",
                b"99999999999",
                b"\n",
                b"\xff\xfe",
                b" ",
                b"g",
                b"=",
                b":",
                b"0",
                b"-1",
                b".",
            ]
        )
        | st.binary(max_size=6),
    ),
    min_size=1,
    max_size=6,
)


def mutated(data, changes):
    for kind, a, b, piece in changes:
        i, j = sorted((int(a * len(data)), int(b * len(data))))
        j = min(j, i + 400)
        if kind == "replace":
            data = data[:i] + piece + data[i + len(piece) :]
        elif kind == "delete":
            data = data[:i] + data[j:]
        elif kind == "insert":
            data = data[:i] + piece + data[i:]
        elif kind == "double":
            data = data[:j] + data[i:j] + data[j:]
        elif kind == "cut":
            data = data[: max(i, len(data) // 4)]
        else:
            lines = data.split(b"\n")
            k, m = int(a * (len(lines) - 1)), int(b * (len(lines) - 1))
            lines[k], lines[m] = lines[m], lines[k]
            data = b"\n".join(lines)
    return data


def read_or_refuse(data, folder):
    path = folder / "fuzzed"
    path.write_bytes(data)
    for options in ({}, {"unit": "g", "dt": 0.01}, {"component": 1}):
        with warnings.catch_warnings(), contextlib.suppress(InputError):
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", OutOfRangeWarning)
            motion = read_motion(path, **options)
            assert all(np.isfinite(values).all() for values in motion.components.values())
            assert motion.steps <= (MAX_SAMPLES if "dt" in options else 100 * len(data) + 1000)


@settings(max_examples=250, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.sampled_from(SEEDS), changes=edits)
def test_mutated_files_are_read_or_refused(seed, changes, tmp_path):
    read_or_refuse(mutated(seed, changes), tmp_path)


@settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.sampled_from(REAL), changes=edits)
def test_mutated_real_files_are_read_or_refused(seed, changes, tmp_path):
    read_or_refuse(mutated(seed, changes), tmp_path)


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.binary(max_size=300) | st.text(max_size=300).map(lambda text: text.encode("utf-8", "ignore")))
def test_anything_is_read_or_refused(data, tmp_path):
    read_or_refuse(data, tmp_path)
