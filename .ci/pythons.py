"""The project with every supported Python that is found here, and with the oldest requirements that it admits.

`make test-pythons`: for each Python the pinned requirements go into an environment of its own under .venv-pythons, the
demonstration is run, then the tests. `--smoke` is the short form for continuous integration: one other Python than the
one that runs this, `stylobate run` with every model and the sensitive tests that take less than a few seconds.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SUPPORTED = ("3.11", "3.12", "3.13")
OLDEST = "oldest"


def pythons() -> dict[str, Path]:
    """An interpreter of each supported version: on the path, or where pyenv keeps them."""
    folders = sorted((Path.home() / ".pyenv" / "versions").glob("3.*"), key=lambda p: _numbers(p.name), reverse=True)
    interpreters = {}
    for version in SUPPORTED:
        kept = [folder / "bin" / "python3" for folder in folders if folder.name.startswith(f"{version}.")]
        on_path = shutil.which(f"python{version}")
        for candidate in [*([Path(on_path)] if on_path else []), *kept]:
            if _version(candidate) == version:
                interpreters[version] = candidate
                break
    return interpreters


def environment(name: str, python: Path, lock: Path) -> Path:
    """The environment of this name with what the lock pins and the package itself; its interpreter."""
    folder = ROOT / ".venv-pythons" / name
    made = folder / ".installed"
    inside = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    if not made.is_file() or made.read_text() != lock.read_text() or not inside.exists():
        shutil.rmtree(folder, ignore_errors=True)
        print(f"== {name}: installing {lock.name}", flush=True)
        run([python, "-m", "venv", folder])
        pip = [inside, "-m", "pip", "--disable-pip-version-check", "-qq", "install"]
        run([*pip, "--require-hashes", "-r", lock])
        folders = [
            project.parent for project in (*ROOT.glob("packages/*/pyproject.toml"), *ROOT.glob("*/pyproject.toml"))
        ]
        beside = [part for folder in folders for part in ("-e", folder)]
        run([*pip, "--no-deps", "--no-build-isolation", "-e", ROOT, *beside])
        made.write_text(lock.read_text())
    return inside


def run(command: list, **options) -> None:
    subprocess.run([str(part) for part in command], check=True, cwd=ROOT, **options)


def check(name: str, python: Path, smoke: bool, arguments: list[str]) -> bool:
    """Demonstration and tests with one interpreter; whether all went well."""
    version = subprocess.run([python, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    print(f"== {name}: {version}", flush=True)
    if name == OLDEST:  # what an old library calls and a newer one deprecates is neither's fault here
        arguments = ["-W", "ignore::DeprecationWarning", *arguments]
    stylobate = python.with_name("stylobate")
    with tempfile.TemporaryDirectory() as folder:
        try:
            if smoke:
                for model in ("dem2d", "rigid-block", "rigid-beam", "housner"):
                    shaken = ["--harmonic", "1.0Hz,0.25g,3s", "--model", model, "--json"]
                    run([stylobate, "run", "paper-monolithic", *shaken], stdout=subprocess.DEVNULL)
                few = "processor and not slow", "-k", "not dem3d and not space"  # the longest to compile
                run([python, "-m", "pytest", "-q", "-m", *few, "tests/analytic", *arguments])
            else:
                run([stylobate, "reproduce", "--quick", "--out", Path(folder) / "demo"])
                run([python, "-m", "pytest", "-q", *arguments])
        except subprocess.CalledProcessError as error:
            print(f"== {name}: FAILED: {' '.join(error.cmd)}", flush=True)
            return False
    print(f"== {name}: passed", flush=True)
    return True


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--smoke", action="store_true")
    parser.add_argument("--only", help="one of them: 3.11, 3.12, 3.13 or oldest")
    options, rest = parser.parse_known_args(arguments)
    interpreters = pythons()
    for missing in sorted(set(SUPPORTED) - set(interpreters)):
        print(f"Python {missing} is not here: left out", flush=True)
    base, oldest = ROOT / "requirements" / "base.lock", ROOT / "requirements" / "oldest.lock"
    wanted = {name: (python, base) for name, python in interpreters.items()}
    if SUPPORTED[0] in interpreters:
        wanted[OLDEST] = (interpreters[SUPPORTED[0]], oldest)
    if options.smoke:
        own = f"{sys.version_info[0]}.{sys.version_info[1]}"
        others = [name for name in wanted if name not in (own, OLDEST)]
        wanted = {name: wanted[name] for name in others[-1:]}
        if not wanted:
            print(f"no other Python than {own} is here: nothing to run", flush=True)
    if options.only:
        wanted = {name: setup for name, setup in wanted.items() if name == options.only}
    passed = [check(name, environment(name, *setup), options.smoke, rest) for name, setup in wanted.items()]
    return 0 if all(passed) else 1


def _version(python: Path) -> str:
    try:
        done = subprocess.run([python, "-c", "import sys; print('%d.%d' % sys.version_info[:2])"],
                              capture_output=True, text=True, check=True)  # fmt: skip
    except (OSError, subprocess.CalledProcessError):
        return ""
    return done.stdout.strip()


def _numbers(name: str) -> list[int]:
    return [int(part) for part in re.findall(r"\d+", name)]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
