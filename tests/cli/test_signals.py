"""Told to stop: every signal ends the process within a second, with one sentence and nothing else, wherever it comes."""

import os
import signal
import subprocess
import sys
import time

import pytest

from stylobate.cli import signals

pytestmark = pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")

#: Says on standard output how it was stopped; the signal comes where ``{where}`` has put it.
STOPPED = """
import signal, time, weakref
from stylobate.cli import signals
signals.listen()
class Thing:
    pass
def told(*_):
    signal.raise_signal(signal.{name})
{where}
began = time.monotonic()
try:
    for _ in range(60):
        time.sleep(1.0)
except KeyboardInterrupt:
    print("stopped" if time.monotonic() - began < signals.PATIENCE else "late")
"""

CLEARING = {
    "weak reference": "thing = Thing()\nkept = weakref.ref(thing, told)\ndel thing",
    "destructor": "Thing.__del__ = told\nthing = Thing()\ndel thing",
    "ten in a row": "Thing.__del__ = told\nthings = [Thing() for _ in range(10)]\ndel things",
}


def python(script):
    return subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=60,
        preexec_fn=lambda: [signal.signal(signum, signal.SIG_DFL) for signum in (signal.SIGINT, signal.SIGHUP)],
    )  # fmt: skip


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT"])
@pytest.mark.parametrize("where", CLEARING)
def test_a_signal_that_comes_while_python_clears_an_object_away_stops_all_the_same(name, where):
    done = python(STOPPED.format(name=name, where=CLEARING[where]))
    assert (done.returncode, done.stdout, done.stderr) == (0, "stopped\n", "")


def test_other_exceptions_that_python_throws_away_are_told_as_ever():
    done = python(
        "from stylobate.cli import signals\nsignals.listen()\n"
        "class Thing:\n    def __del__(self):\n        raise ValueError('odd')\n"
        "Thing()\n"
    )
    assert "ValueError: odd" in done.stderr
    assert done.returncode == 0


def test_a_second_signal_does_not_break_the_clean_up_of_the_first():
    done = python(
        "import signal\nfrom stylobate.cli import signals\nsignals.listen()\n"
        "try:\n    signal.raise_signal(signal.SIGINT)\n"
        "except KeyboardInterrupt:\n    signal.raise_signal(signal.SIGINT)\n    print('cleaned up')\n"
    )
    assert (done.stdout, done.stderr) == ("cleaned up\n", "")


def test_a_signal_while_the_commands_are_loaded_is_one_sentence():
    done = python(
        "import os, signal, sys\n"
        "class Finder:\n"
        "    def find_spec(self, name, path, target=None):\n"
        "        if name == 'typer':\n            os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.meta_path.insert(0, Finder())\n"
        "from stylobate.cli.start import main\nmain()\n"
    )
    assert (done.returncode, done.stderr) == (130, "stylobate: interrupted; nothing is kept.\n")


def test_a_signal_after_the_command_has_ended_changes_nothing():
    done = python(
        "import signal, sys\nfrom stylobate.cli import main, signals\n"
        "mark_ended = signals.mark_ended\n"
        "def late():\n    mark_ended()\n    signal.raise_signal(signal.SIGTERM)\n"
        "signals.mark_ended = late\nsys.argv[1:] = ['--version']\nmain.main()\n"
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("stylobate ")


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT"])
def test_a_signal_ends_even_what_does_not_listen_within_a_second(name):
    script = (
        "import time\n"
        "from stylobate.cli import signals\n"
        "signals.listen(130)\n"
        "said = False\n"
        "while True:\n"
        "    try:\n"
        "        if not said:\n"
        "            print('ready', flush=True)\n"
        "            said = True\n"
        "        time.sleep(100)\n"
        "    except KeyboardInterrupt:\n"
        "        pass\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        preexec_fn=lambda: [signal.signal(signum, signal.SIG_DFL) for signum in (signal.SIGINT, signal.SIGHUP)],
    )  # fmt: skip
    assert process.stdout.readline() == "ready\n"
    started = time.monotonic()
    process.send_signal(getattr(signal, name))
    _, message = process.communicate(timeout=60)
    assert process.returncode == 130
    assert message == "stylobate: interrupted; nothing is kept.\n"
    assert signals.PATIENCE < 1.0
    assert time.monotonic() - started < 10.0  # a second, where nothing else is running


def test_what_is_ignored_stays_ignored():
    script = (
        "import signal\nfrom stylobate.cli import signals\nsignals.listen(130)\n"
        "print(signal.getsignal(signal.SIGHUP) == signal.SIG_IGN)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True,
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN),
    )  # fmt: skip
    assert done.stdout == "True\n"
