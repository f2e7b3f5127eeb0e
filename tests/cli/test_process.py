"""The command as a process: what starting it loads, and what an interrupt leaves."""

import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import pytest

STYLOBATE = [sys.executable, "-c", "from stylobate.cli.start import main; main()"]
HEAVY = ("numpy", "numba", "scipy", "matplotlib", "pandas", "xarray", "pydantic")


def python(script):
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_importing_the_package_is_cheap():
    loaded = python(f"import sys, stylobate; print([one for one in {HEAVY} if one in sys.modules])")
    assert loaded.strip() == "[]"


def test_help_loads_nothing_heavy():
    script = f"""
import sys
from stylobate.cli.main import call
code = call(["--help"])
print(code, [one for one in {HEAVY} if one in sys.modules])
"""
    assert python(script).splitlines()[-1] == "0 []"


def test_columns_need_no_model_and_no_picture():
    script = """
import sys
from stylobate.cli.main import call
call(["columns"])
print([one for one in ("numba", "scipy", "matplotlib", "pandas", "xarray") if one in sys.modules])
"""
    assert python(script).splitlines()[-1] == "[]"


def test_public_names_are_what_they_say():
    script = """
import stylobate as st
import stylobate.simulate  # binds the module over the verb, were it not watched
for name in st.__all__:
    assert getattr(st, name) is not None, name
assert callable(st.simulate) and st.simulate is getattr(stylobate.simulate, "simulate", st.simulate)
assert set(st.__all__) <= set(dir(st))
assert st.pulses.ricker is st.ricker and st.__version__
try:
    st.nonsense
except AttributeError as error:
    assert "nonsense" in str(error)
else:
    raise AssertionError
print(st.simulate.__module__, st.g)
"""
    assert python(script).split() == ["stylobate.simulate", "9.81"]


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_keeps_finished_cells_and_the_same_command_goes_on(tmp_path):
    command = [
        *STYLOBATE, "domain", "paper-12-drums", "--model", "dem2d", "--frequencies", "0.5:4:6", "--amplitudes",
        "0.1g:0.5g:16", "--duration", "15s", "--threads", "1", "--out", str(tmp_path), "--json",
    ]  # fmt: skip
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a shell's background jobs ignore it
    )  # fmt: skip
    ledger = tmp_path / "runs.sqlite"
    deadline = time.monotonic() + 300
    while kept(ledger) == 0:
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=300)
    assert process.returncode == 130
    assert out == ""
    finished = kept(ledger)
    assert 0 < finished < 96
    assert f"interrupted; {finished} of 96 runs are kept in {tmp_path}" in err
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert (result["cells"], result["runs"]) == (96, 96)
    assert kept(ledger) == 96


def kept(path):
    if not path.exists():
        return 0
    try:
        with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as ledger:
            return ledger.execute("SELECT count(*) FROM runs").fetchone()[0]
    except sqlite3.OperationalError:  # not made yet
        return 0


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("stylobate rep", {"report", "reproduce"}),
        ("stylobate run paper-m", {"paper-monolithic"}),
        ("stylobate run paper-monolithic --model dem", {"dem2d", "dem3d"}),
        (
            "stylobate run gallery/assemblies/por",
            {"gallery/assemblies/portal.toml", "gallery/assemblies/portal_in_space.toml"},
        ),
    ],
)
def test_the_tab_key_completes(line, offered):
    words = {"COMP_WORDS": line, "COMP_CWORD": str(len(line.split()) - 1), "_STYLOBATE_COMPLETE": "complete_bash"}
    root = Path(__file__).parents[2]
    done = subprocess.run(STYLOBATE, env=os.environ | words, capture_output=True, text=True, cwd=root, check=True)
    assert set(done.stdout.split()) == offered
