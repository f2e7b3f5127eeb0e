"""Files of results: the former format is read, damaged files are refused in a sentence, a full disk leaves nothing."""

import errno
import hashlib
import io
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import stylobate as st
from stylobate import store
from stylobate.analysis.domain import Domain
from stylobate.analysis.probability import CollapseProbability
from stylobate.atomic import replacing
from stylobate.column.presets import preset
from stylobate.errors import InputError, StylobateError
from stylobate.response import Response, load_response

FORMER = Path(__file__).parent / "format_1"


@pytest.fixture(scope="module")
def facts():
    """What version 0.1.0 said of what is in its files."""
    return json.loads((FORMER / "facts.json").read_text())


@pytest.fixture(scope="module")
def response():
    return st.simulate(preset("paper-monolithic"), st.harmonic(1.0, 0.25 * st.g, 1.0), st.HousnerBlock())


# What has fallen has no residuals any more, peaks of joints end with the collapse.
NEW_WORDS = {
    "residual_top_displacement_m", "residual_joint_slip_m", "residual_slip_per_joint_m", "peak_opening_per_joint_m",
    "residual_displacement_m", "collapse",
}  # fmt: skip


@pytest.mark.parametrize("name", ["response", "assembly"])
def test_responses_of_the_former_format_are_read(name, facts):
    loaded = load_response(FORMER / f"{name}.nc")
    said = json.loads(json.dumps(loaded.summary(), default=float))
    told = facts[name]
    for key in told.keys() & said.keys() - NEW_WORDS:
        assert said[key] == told[key], key
    for key in ("drum_x", "drum_rotation", "x"):
        if key in told:
            assert getattr(loaded, key)[-1].tolist() == told[key]
    if name == "response":
        assert loaded.mechanism.fallen == (1,)
        assert loaded.followed
    assert loaded.collapsed


def test_domains_and_probabilities_of_the_former_format_are_read(facts):
    for kind, name in ((Domain, "domain"), (CollapseProbability, "probability")):
        said = kind.load(FORMER / f"{name}.nc").summary()
        assert {key: said[key] for key in ("cells", "collapsed", "runs")} == {
            key: facts[name][key] for key in ("cells", "collapsed", "runs")
        }


def test_a_kind_for_another_is_refused(response, tmp_path):
    path = response.save(tmp_path / "response.nc")
    with pytest.raises(st.InputError, match="is a response, not a domain"):
        Domain.load(path)
    with pytest.raises(st.InputError, match="is a domain, not a response"):
        Response.load(FORMER / "domain.nc")


@pytest.mark.parametrize("inside", [True, False])
def test_a_format_of_the_future_is_refused_by_its_number(response, tmp_path, monkeypatch, inside):
    monkeypatch.setattr(store, "FORMAT", 7)
    path = response.save(tmp_path / "response.nc")
    if not inside:  # without the line behind it
        path.write_bytes(path.read_bytes()[: -store.LINE])
    monkeypatch.undo()
    with pytest.raises(st.InputError, match=r"is of format 7; this version of stylobate reads up to 2: update"):
        Response.load(path)


def test_any_program_reads_the_files(response, tmp_path):
    import xarray

    path = response.save(tmp_path / "response.nc")
    with xarray.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
        np.testing.assert_array_equal(data["drum_x"], response.drum_x)
        assert data.attrs["kind"] == "response"
        assert data["drum_x"].attrs["units"] == "m"


def test_damaged_files_are_refused_in_a_sentence(response, tmp_path):
    whole = response.save(tmp_path / "response.nc").read_bytes()
    path, random = tmp_path / "damaged.nc", np.random.default_rng(4)
    for _ in range(100):
        content = bytearray(whole)
        kind = int(random.integers(3))
        if kind == 0:  # a bit
            content[int(random.integers(len(content) - store.LINE))] ^= 1 << int(random.integers(8))
        elif kind == 1:  # cut off
            content = content[: int(random.integers(9, len(content)))]
        else:  # a block of zeros, as after a power cut
            start = int(random.integers(len(content) - 600))
            content[start : start + 512] = bytes(512)
        if bytes(content) == whole:
            continue
        path.write_bytes(content)
        with pytest.raises(st.InputError, match=r"^[^\n]*(damaged|cannot be read as netCDF)[^\n]*\.$"):
            Response.load(path)


def test_what_cannot_be_opened_in_time_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "_PROBE", "while True: pass")
    monkeypatch.setattr(store, "PATIENCE", 0.5)
    with pytest.raises(st.InputError, match="could not be opened in"):
        Response.load(FORMER / "response.nc")


def test_what_crashes_the_library_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "_PROBE", "import os; os.abort()")
    with pytest.raises(st.InputError, match="the library ended with code"):
        Response.load(FORMER / "response.nc")


def test_what_lies_in_memory_is_what_is_written(response):
    """The library writes to memory only; nothing of it is left open."""
    import xarray

    image = store._image(response.to_xarray(), {"kind": "response"})
    with xarray.open_dataset(io.BytesIO(image), engine="h5netcdf", decode_times=False) as data:
        assert data.sizes["time"] == len(response.time)


FULL = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
from stylobate.cli.main import call
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
sys.exit(call(sys.argv[1:]))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
def test_a_full_disk_leaves_nothing_and_says_so(tmp_path):
    arguments = [
        "run",
        "paper-monolithic",
        "--model",
        "housner",
        "--harmonic",
        "1Hz,0.25g,5s",
        "--out",
        str(tmp_path / "out"),
    ]
    done = subprocess.run([sys.executable, "-c", FULL, *arguments], capture_output=True, text=True)
    assert done.returncode == 1  # no signal: the library crashes at the end of a process that could not finish a file
    said = done.stderr.strip().splitlines()
    assert len(said) == 1
    assert "cannot be written" in said[0]
    assert "Traceback" not in done.stderr
    assert not list((tmp_path / "out").glob("*.nc")) if (tmp_path / "out").exists() else True


def test_what_the_library_cannot_open_is_one_sentence_and_no_traceback(tmp_path, monkeypatch):
    """A file that is damaged under a digest that is right: attributes of its root that h5netcdf asks for first."""
    import gc

    import xarray

    data = xarray.Dataset({"a": ("x", np.arange(4.0))}, {"x": np.arange(4.0)})
    image = store.write(data, "response", tmp_path / "r.nc").read_bytes()[: -store.LINE]
    printed = []
    monkeypatch.setattr(sys, "unraisablehook", printed.append)
    refused = []
    for place in range(8, min(len(image), 2400), 56):
        content = image[:place] + bytes(56) + image[place + 56 :]
        line = f"\nstylobate result 0002 sha256 {hashlib.sha256(content).hexdigest()}\n"
        (tmp_path / "r.nc").write_bytes(content + line.encode())
        try:
            store.read(tmp_path / "r.nc")
        except InputError as error:
            refused.append(str(error))
    gc.collect()
    assert len(refused) > 5
    assert not [one for one in refused if "\n" in one]
    assert not printed


def test_a_disk_that_fills_up_is_told_with_the_file(tmp_path):
    def fill():
        with replacing(tmp_path / "report.html") as partial:
            partial.write_text("half")
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(
        StylobateError, match=r"report\.html cannot be written: No space left on device; nothing is left"
    ):
        fill()
    assert not list(tmp_path.iterdir())
