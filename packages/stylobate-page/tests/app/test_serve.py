"""The command: its address first, one sentence about what is missing, and an end that leaves nothing behind."""

import os
import signal
import socket
import subprocess
import sys

import httpx
import pytest

from stylobate.cli.main import call
from stylobate.errors import InputError
from stylobate_page.records import locked_folder


def test_the_address_comes_first_and_the_end_is_clean(tmp_path):
    command = [
        sys.executable,
        "-c",
        "from stylobate.cli.start import main; main()",
        "serve",
        "--port",
        "0",
        "--no-browser",
    ]
    environment = os.environ | {"TMPDIR": str(tmp_path)}
    page = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
    try:
        address = page.stdout.readline().strip()
        assert address.startswith("http://127.0.0.1:")
        assert "stylobate" in httpx.get(address).text
        assert httpx.get(address.partition("?")[0]).status_code == 403
        (place,) = tmp_path.iterdir()  # where records and jobs are kept until the end
        assert place.stat().st_mode & 0o077 == 0
        page.send_signal(signal.SIGINT)
        _, complaints = page.communicate(timeout=20)
    finally:
        page.kill()
        page.communicate()
    assert (page.returncode, complaints) == (0, "")
    assert list(tmp_path.iterdir()) == []


def test_a_port_that_is_taken_is_said_in_one_sentence(capsys):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        assert call(["serve", "--port", str(taken.getsockname()[1]), "--no-browser"]) == 2
    assert "choose another --port" in capsys.readouterr().err


@pytest.mark.parametrize("missing", ["starlette", "uvicorn"])
def test_a_missing_extra_is_said_in_one_sentence(capsys, monkeypatch, missing):
    for name in [module for module in sys.modules if module.startswith(("stylobate_page", missing))]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, missing, None)
    assert call(["serve", "--no-browser"]) == 2
    message = capsys.readouterr().err
    assert missing in message
    assert "pip install stylobate-page" in message


def test_a_folder_is_of_one_page_at_a_time(tmp_path, capsys, monkeypatch):
    """A second one would end the jobs of the first; what this one keeps, nobody else on the machine can read."""
    monkeypatch.setattr("uvicorn.Server.run", lambda *_: pytest.fail("it was served"))
    kept = tmp_path / "kept"
    with locked_folder(kept):
        assert kept.stat().st_mode & 0o777 == 0o700
        assert call(["serve", "--port", "0", "--no-browser", "--out", str(kept)]) == 2
        message = capsys.readouterr().err
        assert message.startswith(f"stylobate: {kept} is not free: a page is served from it already; ")
        assert message.count("\n") == 1
    with locked_folder(kept):  # it is free again
        pass


def test_parts_of_a_folder_are_made_private_or_refused(tmp_path):
    for name in ("jobs", "records"):
        (tmp_path / name).mkdir(mode=0o755)
    with locked_folder(tmp_path):
        assert {(tmp_path / name).stat().st_mode & 0o777 for name in ("jobs", "records")} == {0o700}
    (tmp_path / "jobs").rmdir()
    (tmp_path / "jobs").symlink_to(tmp_path / "records")
    with pytest.raises(InputError, match="is a link"), locked_folder(tmp_path):
        pass


def test_a_port_that_cannot_be_is_refused(capsys):
    assert call(["serve", "--port", "70000"]) == 2
    assert "0 to 65535" in capsys.readouterr().err


def test_a_job_has_its_share_of_the_memory_alone():
    """What asks for more gets an error, and not the memory of all others."""
    pytest.importorskip("resource")
    code = (
        "from stylobate_page.worker import limit_memory; limit_memory(0.05); import os\n"
        "whole = os.sysconf('SC_PHYS_PAGES') * os.sysconf('SC_PAGE_SIZE')\n"
        "try: bytearray(int(0.06 * whole))\n"
        "except MemoryError: print('refused')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    if not sys.platform.startswith("linux"):
        pytest.skip("only Linux counts all of it")
    assert done.stdout == "refused\n"


def test_too_little_memory_is_said_in_one_sentence(capsys, monkeypatch):
    def much(*_, **__):
        raise MemoryError

    monkeypatch.setattr("stylobate.cli.run.Settings.run", much)
    assert call(["run", "paper-monolithic", "--harmonic", "1Hz,0.1g,0.1s", "--replicates", "0"]) == 1
    assert capsys.readouterr().err == (
        "stylobate: the memory is not enough for this; ask for less at once, such as a shorter motion.\n"
    )
