"""The core's wheel alone: in a bare environment, imported without POSIX, put to work; then the packages with it.

Where it carries compiled kernels for this machine, first verdicts are timed, and nothing may be compiled for them.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
import venv
from pathlib import Path

from stylobate.added import PACKAGES
from stylobate.kernels.cache import SHIPPED
from stylobate.kernels.levels import levels_here
from stylobate_gpu.kinds import kinds, missing

ROOT = Path(__file__).resolve().parents[1]

#: Modules that Windows does not have: the package may use them where they are, not need them.
POSIX = ("fcntl", "resource", "pwd", "grp", "termios", "tty", "pty", "syslog", "posix_ipc")

#: Packages beside the core as they are imported, but for stylobate_compas: not every machine has wheels for what it needs.
BESIDE = [path.name for path in sorted(ROOT.glob("packages/*/src/*")) if (path / "__init__.py").is_file()]

IMPORT = f"""
import importlib.util, pkgutil, sys
for name in {POSIX}:
    sys.modules[name] = None
import stylobate
from pathlib import Path
assert "site-packages" in Path(stylobate.__file__).parts, stylobate.__file__
failed = []
for module in pkgutil.walk_packages(stylobate.__path__, "stylobate."):
    if module.name.endswith("__main__"):
        continue
    try:
        importlib.import_module(module.name)
    except ImportError as error:
        failed.append(f"{{module.name}}: {{error}}")
for name in stylobate.__all__:
    getattr(stylobate, name)
assert not failed, failed
for name in {BESIDE}:
    assert importlib.util.find_spec(name) is None, name
"""

#: Every module of the packages.
PACKAGES_IMPORT = f"""
import importlib, pkgutil
for name in {BESIDE}:
    for module in pkgutil.walk_packages(importlib.import_module(name).__path__, f"{{name}}."):
        importlib.import_module(module.name)
"""


def main() -> int:
    (wheel,) = (ROOT / "dist").glob("stylobate-*.whl")
    others = [path for path in (ROOT / "dist").glob("*.whl") if path != wheel and "compas" not in path.name]
    with tempfile.TemporaryDirectory() as text:
        folder = Path(text)
        venv.create(folder / "env", with_pip=True)
        scripts = folder / "env" / ("Scripts" if os.name == "nt" else "bin")
        python, command = scripts / "python", scripts / "stylobate"
        constraints = pinned(folder)
        environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME")}

        def run(*parts: str | Path) -> None:
            subprocess.run([str(part) for part in parts], check=True, cwd=folder, env=environment,
                           stdout=subprocess.DEVNULL)  # fmt: skip

        run(python, "-m", "pip", "--disable-pip-version-check", "-qq", "install", "-c", constraints, wheel)
        run(python, "-c", IMPORT)
        first_verdicts(command, folder, environment)
        run(command, "--help")
        for package in PACKAGES:
            for name in package.commands:
                done = subprocess.run(
                    [command, name], capture_output=True, text=True, cwd=folder, env=environment, check=False
                )
                assert done.returncode == 2, done
                assert package.name in done.stderr, done.stderr
        run(command, "columns")
        run(command, "motion", "--samples")
        run(
            command,
            "run",
            "paper-12-drums",
            "--motion",
            "sample:el-centro-1940",
            "--model",
            "rigid-beam",
            "--out",
            "run",
        )
        assert any((folder / "run").iterdir())
        shutil.rmtree(folder / "run")
        run(python, "-m", "pip", "--disable-pip-version-check", "-qq", "install", "-c", constraints, *others)
        run(python, "-c", PACKAGES_IMPORT)
        built = set(kinds()) - set(missing())  # here; the wheel must carry them
        run(python, "-c", f"from stylobate_gpu.kinds import missing; assert not {built!r} & set(missing())")
        for package in PACKAGES:
            for name in package.commands:
                run(command, name, "--help")
    print(f"{wheel.name} works alone, and {len(others)} packages with it")
    return 0


def first_verdicts(command: Path, folder: Path, environment: dict[str, str]) -> None:
    """The first run of a new user, in the plane and in space, with nothing compiled on this machine."""
    shipped = [name for name in levels_here()[-1:] if (SHIPPED / name).is_dir()]
    if not shipped:
        print("no compiled kernels here for this machine (make kernels): they are not tried")
        return
    # ten seconds in space take half a minute of stepping, whatever is compiled
    for model, motion in (("dem2d", "1.0Hz,0.3g,10s"), ("dem3d", "1.0Hz,0.3g,1s")):
        cache = folder / f"cache-{model}"
        line = [command, "run", "paper-12-drums", "--model", model, "--harmonic", motion, "--json"]
        started = time.monotonic()
        subprocess.run(list(map(str, line)), check=True, cwd=folder, stdout=subprocess.DEVNULL,
                       env=environment | {"STYLOBATE_CACHE": str(cache)})  # fmt: skip
        print(f"first verdict of {model} by the wheel: {time.monotonic() - started:.1f} s")
        compiled = sorted(path.name for path in cache.rglob("*.kernel"))
        assert not compiled, compiled


def pinned(folder: Path) -> Path:
    """The locked versions as constraints, without digests: only what the wheel itself asks for is installed."""
    locks = [ROOT / "requirements" / name for name in ("base.lock", "gpu.lock")]
    lines = dict.fromkeys(line for lock in locks for line in lock.read_text(encoding="utf-8").splitlines())
    path = folder / "constraints.txt"
    path.write_text("".join(line.rstrip(" \\") + "\n" for line in lines if line[:1].isalnum()), encoding="utf-8")
    return path


if __name__ == "__main__":
    sys.exit(main())
