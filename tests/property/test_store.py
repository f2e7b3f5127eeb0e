"""Files of results: damaged files are refused in a sentence, a full disk leaves nothing."""

import errno
import hashlib
import io
import subprocess
import sys

import numpy as np
import pytest

import stylobate as st
from stylobate import store
from stylobate.atomic import replacing
from stylobate.column.catalogue import preset
from stylobate.errors import InputError, StylobateError
from stylobate.response import Response
from stylobate.verdicts.domain import Domain


@pytest.fixture(scope="module")
def response():
    return st.simulate(preset("paper-monolithic"), st.harmonic(1.0, 0.25 * st.g, 1.0), st.HousnerBlock())


@pytest.fixture(scope="module")
def domain():
    return st.collapse_domain(preset("paper-monolithic"), st.HousnerBlock(), (1.0,), (1.0, 3.0), 1.0)


def test_a_kind_for_another_is_refused(response, domain, tmp_path):
    path = response.save(tmp_path / "response.nc")
    with pytest.raises(st.InputError, match="is a response, not a domain"):
        Domain.load(path)
    with pytest.raises(st.InputError, match="is a domain, not a response"):
        Response.load(domain.save(tmp_path / "domain.nc"))


@pytest.mark.parametrize("inside", [True, False])
def test_a_format_of_the_future_is_refused_by_its_number(response, tmp_path, monkeypatch, inside):
    monkeypatch.setattr(store, "FORMAT", 7)
    path = response.save(tmp_path / "response.nc")
    if not inside:  # without the line behind it
        path.write_bytes(path.read_bytes()[: -store.LINE])
    monkeypatch.undo()
    with pytest.raises(st.InputError, match=r"is of format 7; this version of stylobate reads 2: update"):
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


def test_a_file_of_another_program_is_refused_unopened(tmp_path, monkeypatch):
    import h5py

    with h5py.File(tmp_path / "response.nc", "w") as file:
        file["x"] = np.zeros(3)
    monkeypatch.setattr(h5py, "File", None)
    with pytest.raises(st.InputError, match=r"is no result of this package, or damaged; give a file that"):
        Response.load(tmp_path / "response.nc")


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
    messages = done.stderr.strip().splitlines()
    assert len(messages) == 1
    assert "cannot be written" in messages[0]
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
    assert not [message for message in refused if "\n" in message]
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
