"""Columns of text: read as meant, to the bit where written by this package, or refused with the remedy."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stylobate.constants import g
from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.motion import Motion, bandpass, read_motion, write_csv

VALUES = st.floats(-40.0, 40.0, allow_nan=False)


@pytest.fixture
def put(tmp_path):
    def write(text, name="record.txt"):
        path = tmp_path / name
        path.write_bytes(text.encode("utf-8") if isinstance(text, str) else text)
        return path

    return write


@settings(max_examples=40, deadline=None)
@given(
    st.floats(1e-4, 2.0),
    st.integers(1, 3),
    st.lists(st.tuples(VALUES, VALUES, VALUES), min_size=2, max_size=50),
    st.floats(0.1, 3.0),
)
def test_written_and_read_back_to_the_same_bits(tmp_path_factory, dt, count, rows, factor):
    table = np.array(rows)
    parts = [table[:, i] for i in range(count)] + [None] * (3 - count)
    done = ("mean of the record taken off", "x: sign turned", "scaled by 2: dt = 0.1, 3 samples in cm/s2")[:count]
    facts = {"azimuths": {"x": 12.5}, "station": "ABC"}
    motion = Motion(dt, *parts, factor=factor, metadata=facts, processing=done)
    path = write_csv(motion, tmp_path_factory.mktemp("csv") / "motion.csv")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutOfRangeWarning)  # random numbers may have a large mean
        back = read_motion(path)
    assert back.dt == motion.dt
    for axis, values in motion.components.items():
        assert np.array_equal(back.components[axis], values)
    assert back.metadata["azimuths"]["x"] == 12.5
    assert back.metadata["station"] == "ABC"
    assert back.processing == done


def test_what_was_done_to_a_record_is_read_whole_or_refused(tmp_path):
    """A step that is lost would leave a scaled record looking as recorded; steps of several files say of which."""
    wave = np.sin(np.arange(200) * 0.1)
    paths = [
        write_csv(
            Motion(0.01, wave * k, metadata={"station": "A"}, processing=("detrended", f"times {k}")),
            tmp_path / f"{k}.csv",
        )
        for k in (1, 2)
    ]
    assert read_motion(paths).processing == ("1.csv: detrended", "1.csv: times 1", "2.csv: detrended", "2.csv: times 2")
    text = paths[0].read_text()
    for lost in (text.replace("# processing 1: detrended\n", ""), text.replace("processing 2", "processing 1")):
        paths[0].write_text(lost)
        with pytest.raises(InputError, match=r"'# processing N: …' are numbered .*; allowed is 1, 2, 3"):
            read_motion(paths[0])


def test_a_report_on_a_filtered_record_tells_its_filter_and_of_a_drifting_one_how_far(tmp_path):
    """Both are uncorrected by their source; only what was done since, and what is left, tells them apart."""
    Note = pytest.importorskip("stylobate_report.page").Note
    motion_section = pytest.importorskip("stylobate_report.shaking").motion_section
    time = np.arange(4000) * 0.01
    raw = Motion(0.01, np.sin(6.0 * time) + 0.01, metadata={"stage": "uncorrected", "station": "A"})
    filtered = bandpass(raw, 0.2, None)
    notes = {}
    for name, motion in (("raw", raw), ("filtered", filtered)):
        back = read_motion(write_csv(motion, tmp_path / f"{name}.csv"))
        items = motion_section(back, None, {"metadata": dict(back.metadata)}, None).items
        notes[name] = " ".join(text for item in items if isinstance(item, Note) for text in item.texts)
    assert "may drift" not in notes["filtered"]
    assert "Integrated twice" not in notes["filtered"]
    assert "what was corrected stands under processing" in notes["filtered"]
    assert "its baseline was not corrected here either" in notes["raw"]
    # 0.01 m/s² over 40 s: 8 m, and 1/6 m/s of the sine's mean velocity over as long: 6.7 m
    assert "ends 15 m from where it began" in notes["raw"]


@pytest.mark.parametrize(
    "text",
    [
        "time_s,ax_g\n0.00,0.1\n0.01,-0.2\n0.02,0.1\n",
        "time_s,ax_m_s2\n0.00,0.981\n0.01,-1.962\n0.02,0.981\n",
        "# a comment\n\ntime_s,ax_gal\r\n0.00,98.1\r\n0.01,-196.2\r\n0.02,98.1\r\n",
        "time_s;ax_g\n0,00;0,1\n0,01;-0,2\n0,02;0,1\n",
        "time_ms\tax_g\n0\t0.1\n10\t-0.2\n20\t0.1\n",
        "sep=,\ntime_s, ax_cm/s^2\n0.00, 98.1\n0.01, -196.2\n0.02, 98.1\n",
        "# time_s ax_g\n0.00 0.1\n0.01 -0.2\n0.02 0.1\n*** End Data ***\n",
        "\ufefftime_s,ax_g\r\r\n0.00,0.1\r\r\n0.01,-0.2\r\r\n0.02,0.1\r\r\n",
        "ax_g,time_s\n0.1,0.00\n-0.2,0.01\n0.1,0.02\n",
    ],
)
def test_headers_that_name_the_unit(put, text):
    motion = read_motion(put(text))
    assert motion.dt == 0.01
    assert motion.acceleration == pytest.approx([0.1 * g, -0.2 * g, 0.1 * g])


def test_three_components_and_the_vertical(put):
    motion = read_motion(put("time_s,ax_g,ay_g,az_m_s2\n0,1,2,3\n0.05,-1,-2,-3\n0.10,0,0,0\n"))
    assert list(motion.components) == ["x", "y", "z"]
    assert motion.vertical == pytest.approx([3.0, -3.0, 0.0])
    assert motion.metadata["unit"] == "g, m/s2"


def test_bare_columns(put):
    two = read_motion(put("0.00 0.1\n0.02 -0.1\n0.04 0.0\n"), unit="g")
    assert (two.dt, two.pga) == (0.02, pytest.approx(0.1 * g))
    untimed = read_motion(put("# title: Athens 1999\nax_m_s2\n0.1\n-0.1\n0.0\n"), dt=0.01)
    assert (untimed.dt, untimed.pga, untimed.metadata["header"]) == (0.01, 0.1, ("# title: Athens 1999", "ax_m_s2"))
    glued = read_motion(put("0.00-0.1\n0.02-0.2\n0.04 0.3\n"), unit="g")
    assert glued.acceleration == pytest.approx([-0.1 * g, -0.2 * g, 0.3 * g])
    fortran = read_motion(put("0.1D+01\n-1.0d0\n0.0\n"), unit="gal", dt=0.01)
    assert fortran.acceleration == pytest.approx([0.01, -0.01, 0.0])


def test_other_code_pages(put):
    assert read_motion(put("# Mexicali, Hidr\xe1ulica\ntime_s,ax_g\n0,1\n0.1,-1\n".encode("latin-1"))).dt == 0.1
    assert read_motion(put("time_s,ax_g\n0,1\n0.1,-1\n".encode("utf-16"))).dt == 0.1


def test_rounded_times_are_equal_steps(put):
    rows = "".join(f"{i / 300:.4f} {(-1) ** i}\n" for i in range(400))
    assert read_motion(put(rows), unit="g").dt == pytest.approx(1 / 300, rel=1e-4)


def test_unequal_steps_are_refused_or_resampled_on_demand(put):
    path = put("time_s,ax_g\n0.00,0.0\n0.01,1.0\n0.03,-1.0\n0.04,0.0\n")
    with pytest.raises(InputError, match=r"line 4: the time goes from 0\.01 s to 0\.03 s"):
        read_motion(path)
    motion = read_motion(path, dt=0.01)
    assert motion.acceleration == pytest.approx([0.0, g, 0.0, -g, 0.0], abs=1e-12)
    assert "resampled linearly from unequal steps" in motion.processing[0]
    with pytest.raises(InputError, match=r"the time goes from 0\.03 s to 7\.03 s, a gap beyond the 0\.2 s"):
        read_motion(put("time_s,ax_g\n0.00,0.0\n0.01,1.0\n0.03,-1.0\n7.03,0.0\n"), dt=0.01)


def test_an_offset_is_noticed(put):
    with pytest.warns(OutOfRangeWarning, match="mean of component x is 0.5 g"):
        read_motion(put("time_s,ax_g\n0,0.4\n0.1,0.6\n"))


def test_a_peak_beyond_all_records_is_noticed(put):
    path = put("0 100\n0.01 -200\n0.02 100\n")
    with pytest.warns(OutOfRangeWarning, match="200 g, more than was ever recorded; check the unit"):
        read_motion(path, unit="g")
    assert read_motion(path, unit="gal").pga == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("0 0.1\n1 0.2\n", {}, "`unit='g'`"),
        ("time_s,ax\n0,0.1\n1,0.2\n", {}, "`unit='g'`"),
        ("0.1\n0.2\n0.1\n", {"unit": "g"}, "no time column"),
        ("0.1\n0.2\n0.1\n", {"unit": "g", "dt": 0.0}, "dt"),
        ("0 0.1\n1 abc\n2 0\n", {"unit": "g"}, "line 2: expected numbers"),
        ("0 0.1\n1 nan\n2 0\n", {"unit": "g"}, "line 2: expected numbers"),
        ("0 0.1\n1 1e999\n2 0\n", {"unit": "g"}, "line 2: expected numbers"),
        ("0 0.1\n1\n2 0\n", {"unit": "g"}, "line 2: 1 numbers where the rows above have 2"),
        ("0 0.1\n1 2 3\n2\n", {"unit": "g"}, "line 2: 3 numbers"),
        ("0 0.1\n1 0.1\n", {"unit": "furlong"}, "allowed are g, m/s2"),
        ("time_s,ax_furlong\n0,1\n1,1\n", {}, "allowed are g, m/s2"),
        ("time_s,ax_g,ax_g\n0,1,1\n1,1,1\n", {}, "names 2 columns x"),
        ("time_s,ay_g\n0,1\n1,1\n", {}, "names a column y and none x"),
        ("time_s,ax_g\n0,1\n1,1\n", {"unit": "m/s2"}, "leave the unit out"),
        ("time_s,ax_g\n0,1,2\n1,1,2\n", {}, "names 2 columns, the rows hold 3 numbers"),
        ("time_s,ax_g\n0,00,0,10\n0,01,0,20\n", {}, "by semicolons where a comma is the sign"),
        ("1 2 3 4 5 6\n1 2 3 4 5 6\n", {"unit": "g", "dt": 0.01}, "6 columns of numbers without names"),
        ("time_s,ax_g\n0,1\n0,1\n", {}, "time goes from 0 s to 0 s"),
        ("time_s,ax_g\n0,1\n0.1,1\n0.2,0\n", {"dt": 0.05}, "leave dt out"),
        ("0,15\n0,25\n1,35\n", {"unit": "g", "dt": 0.01}, "one number with a decimal comma or two numbers"),
        (
            "time_s;ax_m/s2\n0,00;0,1\n0,02;1.234\n0,04;999,5\n",
            {},
            "line 3: '0,02;1.234' holds a point, and other numbers",
        ),
        ("words only\n", {}, "no format that is known"),
        ("", {}, "empty"),
        ("0.1\n", {"unit": "g", "dt": 0.1}, "one row"),
        (b"\x1f\x8b\x08\x00rest", {}, "compressed .gzip."),
        (b"PK\x03\x04rest", {}, "compressed .zip."),
        (b"\x00\x01\x02\x03" * 100, {}, "binary"),
        ("1 " * 600_000, {"unit": "g", "dt": 0.1}, "break the numbers into lines"),
    ],
)
def test_files_that_are_refused(put, text, options, message):
    with pytest.raises(InputError, match=message):
        read_motion(put(text), **options)


# -- steps that no accelerograph has --------------------------------------------------------------------------------

MILLISECONDS = "".join(f"{10 * i},{(-1) ** i}\n" for i in range(20))


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("time_s,ax_g\n" + MILLISECONDS, {}, r"is 10 s; allowed is 0\.0002 to 0\.2 s.*name the column time_ms"),
        (MILLISECONDS, {"unit": "g"}, "is 10 s; allowed"),
        ("time_s,ax_g\n0,1\n10,-1\n20,1\n31,0\n", {"dt": 0.01}, "the median step of the times of record.txt is 10 s"),
        ("time_ms,ax_g\n0,1\n0.01,-1\n0.02,1\n", {}, "is 1e-05 s"),
        ("ax_g\n1\n-1\n", {"dt": 10.0}, "is 10 s"),
        ("1\n-1\n", {"unit": "g", "dt": 10.0}, "is 10 s"),
    ],
)
def test_steps_that_no_accelerograph_has_are_refused_wherever_they_come_from(put, text, options, message):
    with pytest.raises(InputError, match=message):
        read_motion(put(text), **options)


def test_milliseconds_that_are_named_are_read(put):
    assert read_motion(put("time_ms,ax_g\n" + MILLISECONDS)).dt == 0.01


def test_decimal_commas_between_blanks_are_read(put):
    motion = read_motion(put("time_s ax\n0,00\t0,1\n0,01\t-0,2\n0,02\t0,1\n"), unit="g")
    assert motion.acceleration == pytest.approx([0.1 * g, -0.2 * g, 0.1 * g])


def test_a_folder_and_a_missing_file_are_refused(tmp_path):
    for path in (tmp_path, tmp_path / "missing.csv", tmp_path / "nul\0byte"):
        with pytest.raises(InputError):
            read_motion(path)


def test_files_that_are_too_large_are_refused_before_they_are_read(tmp_path):
    path = tmp_path / "huge.txt"
    with path.open("wb") as file:
        file.truncate(100_000_001)  # no bytes on the disk
    with pytest.raises(InputError, match="cut the record"):
        read_motion(path)


def test_nothing_half_written(tmp_path):
    with pytest.raises(InputError, match="cannot be written"):
        write_csv(Motion(0.1, np.zeros(3)), tmp_path / "missing" / "motion.csv")
    assert list(tmp_path.iterdir()) == []
