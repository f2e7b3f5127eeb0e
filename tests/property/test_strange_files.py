"""Files that strangers hand in: pipes, devices, giants, deep nesting, endless numbers are refused before they are read."""

import os
import time

import pytest

import stylobate as st
from stylobate.column.assembly_files import is_assembly, load_structure
from stylobate.column.files import load_column, read_column
from stylobate.motion.readers import read_suite
from stylobate.text_tables import SETTINGS, printable, read_bytes

COLUMN = """\
density = 1600.0
[tapered]
height = 5.0
bottom_width = 0.96
top_width = 0.66
drums = 2
[joint]
normal_stiffness = 5.0e10
shear_stiffness = 2.5e10
friction_angle = 35.0
"""
READERS = [load_column, load_structure, is_assembly, st.read_motion]


@pytest.mark.parametrize("read", READERS)
def test_pipes_devices_folders_and_giants_are_refused_at_once(read, tmp_path):
    pipe, giant = tmp_path / "pipe.toml", tmp_path / "giant.toml"
    os.mkfifo(pipe)
    with giant.open("wb") as file:
        file.truncate(2**31)  # holds nothing: takes no room on the disk
    started = time.monotonic()
    for path, words in (
        (pipe, "a pipe or a device"),
        ("/dev/zero", "a pipe or a device"),
        (giant, "holds 2147483648 bytes"),
    ):
        with pytest.raises(st.InputError, match=words):
            read(path)
    with pytest.raises(st.InputError, match="is a folder"):
        read(tmp_path)
    assert time.monotonic() - started < 5.0


def test_no_more_than_the_most_is_read(tmp_path):
    path = tmp_path / "some"
    path.write_bytes(b"x" * 100)
    assert read_bytes(path, 100) == b"x" * 100
    with pytest.raises(st.InputError, match="allowed is up to 99: give another file"):
        read_bytes(path, 99)
    with pytest.raises(st.InputError, match="holds more than 10 bytes"):
        read_bytes("/proc/self/status", 10)  # tells a size of zero


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("density = " + "9" * 5000, "thousands of digits"),
        ("density = " + "9" * 400, "whole number beyond"),
        ("density = 0x" + "f" * 6000, "whole number beyond"),
        ("density = " + "[" * 20_000 + "]" * 20_000, "nested too deeply"),
        ("density = " + "[" * 40 + "]" * 40, "nested too deeply"),
        ("density = " + "{a=" * 20_000 + "1" + "}" * 20_000, "nested too deeply"),
        ("[" + ".".join("a" * 500) + "]", "nested too deeply"),
        ("#" * (SETTINGS + 1), "allowed is up to"),
    ],
    ids=range(8),
)
def test_toml_that_no_one_writes_is_refused(text, words, tmp_path):
    path = tmp_path / "odd.toml"
    path.write_text(text)
    with pytest.raises(st.InputError, match=words) as error:
        read_column(path)
    assert len(str(error.value)) < 500


def test_names_that_are_not_utf8_can_be_shown_and_their_files_read(tmp_path):
    path = os.fsencode(tmp_path) + b"/s\xe4ule\x1b.toml"
    with open(path, "w") as file:
        file.write(COLUMN)
    column = read_column(os.fsdecode(path))
    assert column.name == r"s\xe4ule\x1b"
    assert column.digest
    assert printable("Säule 柱.toml") == "Säule 柱.toml"
    record = os.fsencode(tmp_path) + b"/record\xff.csv"
    with open(record, "w") as file:
        file.write("time_s,ax_g\n0,0\n0.01,0.1\n0.02,-0.1\n0.03,0.0\n")
    motion = st.read_motion(os.fsdecode(record))
    assert r"record\xff" in motion.name
    assert motion.digest
    suite = read_suite([os.fsdecode(record), os.fsdecode(path)])
    assert len(suite.motions) == 1
    assert list(suite.refused) == [r"s\xe4ule\x1b.toml"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("bottom_width = 0.96", "bottom_width = 1e-308"),
        ("height = 5.0", "height = 1e-9"),
        ("density = 1600.0", "density = 5e-324"),
        ("normal_stiffness = 5.0e10", "normal_stiffness = 1e-300"),
        ("density = 1600.0", "density = 1600.0\ngravity = 1e-300"),
    ],
)
def test_what_is_not_physical_is_refused(old, new, tmp_path):
    path = tmp_path / "tiny.toml"
    path.write_text(COLUMN.replace(old, new))
    with pytest.raises(st.InputError, match="allowed is"):
        read_column(path)
