"""Small files in every published format: read as meant, with their traps; damaged ones are refused, never crash."""

import contextlib
import itertools
import tracemalloc
import warnings

import numpy as np
import pytest
from fuzz.record_files import COUNT, DT, FILM, FORMATS, WAVES, cosmos, csmip_v2, esm, geonet, knet, peer_nga
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from records import FOLDER, SHIPPED

from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.motion import MAX_SAMPLES, read_motion


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
    for wave, values in zip(waves, motion.components.values()):
        if name in FILM:
            times = DT * np.arange(COUNT) + 0.001 * (np.arange(COUNT) % (3 if name == "csmip_v1" else 2))
            assert np.interp(times, motion.time, values) == pytest.approx(wave * size, abs=1e-9)
        else:
            assert motion.dt == pytest.approx(DT, rel=1e-12)
            assert values == pytest.approx(wave[: len(values)] * size, rel=1e-6, abs=1e-12)


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
        read([put(esm(), "a"), put(esm().replace("manual", "none"), "b"), put(north, "c")])


def test_downward_components_are_turned_upward(put):
    motion = read(put(geonet().replace("Component Up", "Component Down")))
    assert motion.vertical == pytest.approx(-WAVES[2] * 0.002)
    assert any("sign turned" in step for step in motion.processing)


def test_components_by_number_label_and_azimuth(put):
    path = put(geonet())
    for wanted in (2, "2", "N80W", "280"):
        assert read(path, component=wanted).acceleration == pytest.approx(WAVES[1] * 0.002)
    with pytest.raises(InputError, match=r"no component '7'; it holds 1 \(N10E, axis x\)"):
        read(path, component=7)


def test_azimuth_that_the_file_does_not_know(put):
    motion = read(put(csmip_v2().replace("90 Deg", "H1").replace("360 Deg", "H2")))
    assert motion.metadata["azimuths"] == {"x": None, "y": None, "z": None}
    assert motion.metadata["labels"]["x"] == "H1"


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("peer_nga", "NPTS=   23", "NPTS=   24", "promises 24 numbers"),
        ("peer_nga", "NPTS=   23", "NPTS=   1e9", "promises"),
        ("peer_nga", "NPTS=   23", "NPTS=   99999999", "whole number from 2"),
        ("peer_nga", "OF G", "OF FURLONGS", "allowed are g, m/s2"),
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
        ("bhrc", "DURATION =   0.230", "nothing", "length of the record"),
        ("csmip_v1", "G/10.", "LBS.", "no unit of acceleration"),
        ("csmip_v1", "99.911", " 0.000", "where it may not fall"),
        ("csmip_v2", "(units: cm/sec/sec)", "(units: lbs)", "no unit of acceleration"),
        ("geonet", "units of 2.00 mm/s/s", "units of 2.00 lbs", "unit of acceleration"),
    ],
)
def test_damaged_files_are_refused_with_the_reason(name, old, new, message, put):
    text = FORMATS[name][0]
    assert old in text
    with pytest.raises(InputError, match=message):
        read(put(text.replace(old, new)))


def test_knet_that_is_cut_is_refused(put):
    with pytest.raises(InputError, match="promises 300 s"):
        read(put(knet().replace("Duration Time(s)  1", "Duration Time(s)  300")))


def test_a_file_of_two_formats_is_refused(put):
    both = esm().replace("EVENT_NAME: SMALL", "EVENT_NAME: STRONG GROUND MOTION RECORDS OF TURKIYE")
    with pytest.raises(InputError, match="looks like ESM / ITACA ASCII and like AFAD text"):
        read(put(both))


def test_a_stated_unit_is_not_overruled(put):
    with pytest.raises(InputError, match="leave `unit` out"):
        read(put(esm()), unit="g")
    with pytest.raises(InputError, match="states its columns; leave `columns` out"):
        read(put(esm()), columns="x [g]")


def test_a_step_that_contradicts_the_length_is_refused(put):
    with pytest.raises(InputError, match="disagree with the step"):
        read(put(cosmos(100.0).replace("approx  0 secs", "approx  9 secs")))


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
    with pytest.raises(InputError, match=r"holds 6 components .*`component='1'`"):
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
        ("renadic", "NO. OF POINTS =     23", "NO. OF POINTS = 0"),
        ("bhrc", "NO. OF POINTS =     23", "NO. OF POINTS = 0"),
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
REAL = [source.data[:20_000] for source in SHIPPED.values()]
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
