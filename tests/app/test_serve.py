"""The command: its address first, one sentence about what is missing, and an end that leaves nothing behind."""

import os
import signal
import socket
import subprocess
import sys

import httpx
import pytest

from stylobate.cli.main import call


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
        assert len(list(tmp_path.iterdir())) == 1  # where records and jobs are kept until the end
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
    for name in [one for one in sys.modules if one.startswith(("stylobate.app", missing))]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, missing, None)
    assert call(["serve", "--no-browser"]) == 2
    said = capsys.readouterr().err
    assert missing in said
    assert "pip install stylobate[app]" in said


def test_a_port_that_cannot_be_is_refused(capsys):
    assert call(["serve", "--port", "70000"]) == 2
    assert "0 to 65535" in capsys.readouterr().err
